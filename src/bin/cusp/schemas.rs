//! Schemas of the JSON that `--json` prints and of the files that users write. `tests/interop/cluster/test_schemas.py`
//! validates real output against them.

use std::path::Path;
use std::sync::Arc;

use clap::builder::PossibleValuesParser;
use cusp_slicer::archive::read::Inspection;
use cusp_slicer::inspect::Limits;
use cusp_slicer::job::{JobReport, MeshInfo, Options, OrientationReport, Report, Tradeoff};
use cusp_slicer::price::Prices;
use cusp_slicer::printer::Printer;
use cusp_slicer::resin::Resin;
use cusp_slicer::simulation::Simulation;
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde_json::{Value, json};

use crate::batch::BatchLine;
use crate::calibrate::Calibrated;
use crate::check::Checked;
use crate::contours::Contoured;
use crate::convert::Converted;
use crate::failure::{Failed, Failure};
use crate::files::{Output, make_folder};
use crate::job_file::JobFile;
use crate::models::Weighed;
use crate::price::Priced;
use crate::study::{ComparedPlate, Studied};
use crate::terminal::print;
use crate::verify::Verified;

/// Draft 7, which most validators know.
fn generator() -> SchemaGenerator {
    SchemaSettings::draft07().for_serialize().into_generator()
}

fn output<T: JsonSchema>() -> Value {
    generator().into_root_schema_for::<T>().to_value()
}

/// Schema of a file that users write, in which fields have defaults.
fn input<T: JsonSchema>() -> Value {
    let settings = SchemaSettings::draft07().for_deserialize();
    settings
        .into_generator()
        .into_root_schema_for::<T>()
        .to_value()
}

/// A report without what depends on the machine, and its layers.
fn manifest() -> Value {
    let mut schema = output::<Report>();
    let is_kept = |key: &str| !cusp_slicer::job::OF_THE_MACHINE.contains(&key);
    if let Some(properties) = schema["properties"].as_object_mut() {
        properties.retain(|key, _| is_kept(key));
    }
    if let Some(definitions) = schema["definitions"].as_object_mut() {
        definitions.remove("Timings");
    }
    if let Some(required) = schema["required"].as_array_mut() {
        required.retain(|key| key.as_str().is_some_and(is_kept));
        required.push(json!("layer_files"));
    }
    let number = |description: &str| json!({ "description": description, "type": "number" });
    schema["definitions"]["LayerEntry"] = json!({
        "description": "A layer of the print file.",
        "type": "object",
        "properties": {
            "file": { "description": "Name of the mask in the zip.", "type": "string" },
            "z_mm": number("Top of the layer, in millimetres above the plate."),
            "thickness_mm": number("Thickness of the layer in millimetres."),
            "exposure_s": number("Exposure in seconds."),
            "lit_pixels": {
                "description": "Number of pixels of the mask that are not black.",
                "type": "integer",
                "minimum": 0,
            },
        },
        "required": ["file", "z_mm", "thickness_mm", "exposure_s", "lit_pixels"],
        "additionalProperties": false,
    });
    schema["properties"]["layer_files"] = json!({
        "description": "The layers, from the plate upward.",
        "type": "array",
        "items": { "$ref": "#/definitions/LayerEntry" },
    });
    schema["title"] = json!("Manifest");
    schema["description"] = json!(
        "What `manifest.json` in a zip of masks says: a report without what depends on the machine, and the layers."
    );
    schema
}

/// The settings of a file, as JSON has them.
fn settings() -> Value {
    let mut schema = input::<Options>();
    schema["title"] = json!("Settings");
    schema["description"] = json!("What `--config` reads, as TOML. Lengths are in millimetres.");
    let properties = &mut schema["properties"];
    properties["weights"] = json!({
        "description": "Path of a file of weights, from the folder of these settings.",
        "type": "string",
    });
    let resin = properties["resin"].take();
    properties["resin"] = json!({
        "description": "The resin, or the path of a file that describes it.",
        "anyOf": [resin, { "type": "string" }],
    });
    schema
}

/// Makes a schema.
type Make = fn() -> Value;

/// The names of schemas, and what makes each.
const SCHEMAS: [(&str, Make); 25] = [
    ("batch-info", output::<BatchLine<MeshInfo>>),
    ("batch-plan", output::<BatchLine<JobReport>>),
    ("calibrate", output::<Calibrated>),
    ("check", output::<Checked>),
    ("compare", output::<Studied<ComparedPlate>>),
    ("contours", output::<Contoured>),
    ("convert", output::<Converted>),
    ("error", output::<Failed>),
    ("info", output::<MeshInfo>),
    ("inspect", output::<Inspection>),
    ("limits", input::<Limits>),
    ("manifest", manifest),
    ("orient", output::<OrientationReport>),
    ("plan", output::<JobReport>),
    ("plate", input::<JobFile>),
    ("price", output::<Priced>),
    ("prices", input::<Prices>),
    ("printer", input::<Printer>),
    ("printers", output::<Vec<Arc<Printer>>>),
    ("resin", input::<Resin>),
    ("saliency", output::<Weighed>),
    ("settings", settings),
    ("simulate", output::<Simulation>),
    ("tradeoff", output::<Studied<Tradeoff>>),
    ("verify", output::<Verified>),
];

/// Completes and checks the name of a schema.
pub fn schema_name() -> PossibleValuesParser {
    PossibleValuesParser::new(SCHEMAS.map(|(name, _)| name))
}

/// Prints the schema with this name, or writes all to a folder, as `plan.schema.json`.
pub fn schema(name: Option<&str>, folder: Option<&Path>) -> Result<(), Failure> {
    if let Some(folder) = folder {
        make_folder(folder)?;
        for (name, make) in SCHEMAS {
            let file = folder.join(format!("{name}.schema.json"));
            Output::new(&file, None, "")?.write_bytes(text(make)?.as_bytes())?;
        }
        return Ok(());
    }
    for (_, make) in SCHEMAS.iter().filter(|(of, _)| Some(*of) == name) {
        print(text(*make)?.trim_end())?;
    }
    Ok(())
}

fn text(make: Make) -> Result<String, String> {
    // Its keys in the order that schemas have.
    let schema = Schema::try_from(make()).map_err(|error| error.to_string())?;
    let text = serde_json::to_string_pretty(&schema).map_err(|error| error.to_string())?;
    Ok(text + "\n")
}
