//! `NanoDLP`: masks `1.png` and so on, three pixels of the screen in a pixel of the image, and settings as JSON, with one
//! thickness for all layers.
//!
//! Fields that nothing is known to depend on are 0 or empty, as in files of other slicers. Readers disagree on which
//! numbers may have a fraction, so whole ones are written without a decimal point.

use serde_json::{Value, json};

use super::{Container, File, LayerEntry, joined_bounds, json_file};
use crate::archive::png::{self, Depth};
use crate::archive::survey::Survey;
use crate::archive::{ArchiveError, PrintJob, Screen, tidy};
use crate::mask::Run;

pub struct Nanodlp;

/// Columns and rows of the preview.
const PREVIEW: [u32; 2] = [607, 487];

impl Container for Nanodlp {
    fn mask_name(&self, layer: usize) -> String {
        format!("{}.png", layer + 1)
    }

    fn mask(&self, screen: &Screen, runs: &mut dyn Iterator<Item = Run>) -> Vec<u8> {
        png::encode(runs, screen.pixels, Depth::Thirds)
    }

    fn needs_survey(&self) -> bool {
        true
    }

    fn files(&self, job: &PrintJob<'_>, layers: &[LayerEntry]) -> Result<Vec<File>, ArchiveError> {
        let look = (job.look)();
        let boundary = boundary(job, layers);
        let info = layers.iter().map(|layer| info(&job.screen, layer));
        let options = options(job, &boundary);
        Ok(vec![
            json_file("meta.json", &meta())?,
            json_file("info.json", &info.collect())?,
            json_file("plate.json", &plate(job, boundary))?,
            json_file("profile.json", &profile(job))?,
            // Some programs read one, some the other.
            json_file("options.json", &options)?,
            json_file("slicer.json", &options)?,
            ("3d.png".to_owned(), look.png(PREVIEW)),
        ])
    }
}

/// A number, without a decimal point if it is whole.
fn number(value: f64) -> Value {
    let value = tidy(value);
    if value.fract() == 0.0 {
        json!(value as i64)
    } else {
        json!(value)
    }
}

/// Gives fields of an object the same value. `fields` is their names with spaces between.
fn set_all(object: &mut Value, fields: &str, value: &Value) {
    for field in fields.split(' ') {
        object[field] = value.clone();
    }
}

fn meta() -> Value {
    json!({
        "FormatVersion": 2,
        "Distro": "generic",
        "Program": "Cusp",
        "Version": env!("CARGO_PKG_VERSION"),
        "OS": "",
        "Arch": "",
        // The printer keeps to the resin profile that its user chooses.
        "Profile": false,
    })
}

/// Areas of a layer in mm², and the first and last lit columns and rows.
fn info(screen: &Screen, layer: &LayerEntry) -> Value {
    let Survey { bounds, areas } = layer.survey();
    let mm2 = |pixels: u64| number(pixels as f64 * screen.pitch_mm[0] * screen.pitch_mm[1]);
    let [left, top, right, bottom] = bounds.unwrap_or([0, 0, 1, 1]);
    json!({
        "TotalSolidArea": mm2(layer.lit_pixels),
        "LargestArea": mm2(areas.iter().max().copied().unwrap_or(0)),
        "SmallestArea": mm2(areas.iter().min().copied().unwrap_or(0)),
        "MinX": left,
        "MinY": top,
        "MaxX": right - 1,
        "MaxY": bottom - 1,
        "AreaCount": areas.len(),
    })
}

type Boundary = [(&'static str, Value); 6];

/// The box of the print from the middle of the plate, in millimetres.
fn boundary(job: &PrintJob<'_>, layers: &[LayerEntry]) -> Boundary {
    let [x_min, y_min, x_max, y_max] = job.screen.bounds_mm(joined_bounds(layers));
    let z_max = layers.last().map_or(0.0, |layer| layer.z_mm);
    [
        ("XMin", number(x_min)),
        ("XMax", number(x_max)),
        ("YMin", number(y_min)),
        ("YMax", number(y_max)),
        ("ZMin", number(0.0)),
        ("ZMax", number(z_max)),
    ]
}

/// Several exposures on one plate: none.
fn multi_cure() -> Value {
    json!({
        "StartX": 0,
        "StartY": 0,
        "Width": 0,
        "Height": 0,
        "X": null,
        "Y": null,
        "MultiCureGap": 0,
        "Count": 0,
    })
}

fn plate(job: &PrintJob<'_>, boundary: Boundary) -> Value {
    const ZERO: &str = "\
        PlateID ProfileID CreatedDate LowQualityLayerNumber AutoCenter Updated LastPrint \
        ImageRotate MaskEffect XRes YRes ZRes Offset PrintID";
    const EMPTY: &str = "StopLayers Path MultiCure MultiThickness BlackoutData";
    const FALSE: &str = "\
        Risky IsFaulty Repaired Corrupted Feedback ReSliceNeeded MultiMaterial";
    const NULL: &str = "Profile CureTimes DynamicThickness OverHangs FaultyLayers";
    let time_s = job.print_time_s().round() as u64;
    let mut plate = json!({
        "LayersCount": job.layers.len(),
        "Processed": true,
        "PrintTime": time_s,
        "PrintEst": time_s,
        // Millilitres of resin, whatever the name says.
        "TotalSolidArea": number(job.resin_ml),
        "MC": multi_cure(),
    });
    for (field, value) in boundary {
        plate[field] = value;
    }
    set_all(&mut plate, ZERO, &json!(0));
    set_all(&mut plate, EMPTY, &json!(""));
    set_all(&mut plate, FALSE, &json!(false));
    set_all(&mut plate, NULL, &Value::Null);
    plate
}

/// What the slicers of options and profiles could do and this file does not: fields of both that are 0.
const UNUSED: &str = "\
    AdaptSlicing AdaptSlicingMin AdaptSlicingMax SupportOffset Offset DimAmount DimWall \
    DimSkip PixelDiming HatchingType HatchingWall HatchingGap HatchingOuterWall \
    HatchingTopCap HatchingBottomCap ElephantMidExposure ElephantType ElephantAmount \
    ElephantWall ElephantLayers MultiCureGap AntiAlias AntiAlias3D AntiAlias3DDistance \
    AntiAlias3DMin AntiAliasThreshold ImageRotate XYRes ZResPerc";

/// How the printer treats the resin. The g-code around layers stays empty: it is the machine's own, not the slicer's.
fn profile(job: &PrintJob<'_>) -> Value {
    const ZERO: &str = "\
        ResinID ProfileID ResinPrice OptimumTemperature SupportTopWait SupportWaitAfterPrint \
        TransitionalLayer Updated Type ZStepWait TopWait WaitAfterPrint YRes SlowSectionHeight \
        SlowSectionStepWait JumpPerLayer JumpHeight LowQualityCureTime LowQualitySkipPerLayer \
        XYResPerc";
    const EMPTY: &str = "\
        Desc Color DynamicCureTime DynamicSpeed ShieldBeforeLayer ShieldAfterLayer \
        ShieldDuringCure ShieldStart ShieldResume ShieldFinish LaserCode ShutterOpenGcode \
        ShutterCloseGcode SeparationDetection ResinLevelDetection CrashDetection DynamicWait \
        DynamicWaitAfterLift DynamicLift";
    let resin = job.resin;
    let usual_mm = job.usual_mm();
    let mut profile = json!({
        "Title": resin.name,
        "Depth": number(usual_mm * 1e3),
        "SupportDepth": number(usual_mm * 1e3),
        "CureTime": number(resin.exposure_s(usual_mm)),
        "SupportCureTime": number(resin.bottom_exposure_s),
        "SupportLayerNumber": resin.bottom_layers.min(job.layers.len()),
        "WaitBeforePrint": number(resin.wait_s),
        "SupportWaitBeforePrint": number(resin.wait_s),
        "WaitHeight": number(resin.lift_mm),
        "SupportWaitHeight": number(resin.lift_mm),
        // In mm/min.
        "LiftSpeed": number(resin.lift_mm_min),
        "RetractSpeed": number(resin.return_mm_min),
        "FillColor": "#ffffff",
        "BlankColor": "#000000",
        "IgnoreMask": 1,
        "CustomValues": {},
    });
    set_all(&mut profile, UNUSED, &json!(0));
    set_all(&mut profile, ZERO, &json!(0));
    set_all(&mut profile, EMPTY, &json!(""));
    profile
}

/// How the masks were made.
fn options(job: &PrintJob<'_>, boundary: &Boundary) -> Value {
    const ZERO: &str = "\
        ScaleFactor StartLayer ZOffset AutoCenter FileSize BarrelFactor BarrelX BarrelY PlateID \
        LayerID ExportType SkipEmpty";
    const EMPTY: &str = "\
        Type URL AdaptExport PreviewColor MultiThickness ExportPath NetworkSave File \
        LightOutputFormula UUID OutputPath Suffix";
    const FALSE: &str = "\
        SliceFromZero DisableValidator PreviewGenerate Running Debug IsFaulty Corrupted \
        MultiMaterial";
    const NULL: &str = "Mask FaultyLayers OverhangLayers LayerStatus DynamicThickness";
    let Screen {
        pixels: [columns, rows],
        pitch_mm: [x_mm, y_mm],
        is_mirrored,
        ..
    } = job.screen;
    let thickness_um = number(job.usual_mm() * 1e3);
    let mut options = json!({
        "PWidth": columns,
        "PHeight": rows,
        "SupportDepth": thickness_um,
        "SupportLayerNumber": job.resin.bottom_layers.min(job.layers.len()),
        "Thickness": thickness_um,
        "XOffset": columns / 2,
        "YOffset": rows / 2,
        "XPixelSize": number(x_mm),
        "YPixelSize": number(y_mm),
        "XRes": number(x_mm * 1e3),
        "YRes": number(y_mm * 1e3),
        "Boundary": Value::from_iter(boundary.clone()),
        "MC": multi_cure(),
        "FillColor": "#ffffff",
        "BlankColor": "#000000",
        "FillColorRGB": { "R": 255, "G": 255, "B": 255, "A": 255 },
        "BlankColorRGB": { "R": 0, "G": 0, "B": 0, "A": 255 },
        "IgnoreMask": 1,
        "PreviewWidth": PREVIEW[0],
        "PreviewHeight": PREVIEW[1],
        "ImageMirror": u8::from(is_mirrored),
        // Three pixels of the screen in a pixel of the image.
        "DisplayController": 1,
        "LayerCount": job.layers.len(),
    });
    set_all(&mut options, UNUSED, &json!(0));
    set_all(&mut options, ZERO, &json!(0));
    set_all(&mut options, EMPTY, &json!(""));
    set_all(&mut options, FALSE, &json!(false));
    set_all(&mut options, NULL, &Value::Null);
    options
}
