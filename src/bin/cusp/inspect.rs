//! Shows the contents of a print file, and checks that it is whole.

use std::path::{Path, PathBuf};

use clap::Args;
use cusp_slicer::archive::read::{Inspection, Metadata, PrintFile, inspect as look_through};

use crate::failure::{Failure, in_file};
use crate::files::{Output, read};
use crate::progress::Bar;
use crate::terminal::{duration, print, print_json, warn};
use crate::usage::check_json;
use crate::visible::visible;
use crate::watch::stop_on_interrupt;

/// A print file, and perhaps one of its layers.
#[derive(Args)]
pub struct Inspecting {
    /// Print file: goo, prz, ctb, pwmx and its kin, pwsz and its kin, nanodlp, sl1, uvj, or a zip of masks; - is standard input
    #[arg(value_name = "PRINTFILE")]
    print: PathBuf,
    /// Print one JSON object, with the values of every layer
    #[arg(long)]
    pub json: bool,
    /// Write the mask of this layer as well, as stored; the first is 1
    #[arg(long, value_name = "N", requires = "output", value_parser = clap::value_parser!(u32).range(1..))]
    layer: Option<u32>,
    /// PNG to write the mask to; - is standard output
    #[arg(short, long, value_name = "FILE", requires = "layer")]
    output: Option<PathBuf>,
}

pub fn inspect(inspecting: &Inspecting) -> Result<(), Failure> {
    let path = &*inspecting.print;
    let output = inspecting.output.as_deref();
    check_json("inspect", output, inspecting.json);
    let output = output.map(|output| Output::new(output, Some(path), "print file"));
    let output = output.transpose()?;
    let bytes = read(path)?;
    let file = PrintFile::open(&*bytes).map_err(|error| in_file(path, &error))?;
    stop_on_interrupt();
    if let (Some(layer), Some(output)) = (inspecting.layer, &output) {
        write_mask(&file, path, layer as usize, output)?;
    }
    let bar = Bar::new();
    let mut progress = |fraction| bar.show("inspect", fraction);
    let inspection = look_through(&file, &mut progress).map_err(|_| Failure::interrupted())?;
    drop(bar);
    warn(&inspection.warnings);
    if inspecting.json {
        return Ok(print_json(&inspection)?);
    }
    Ok(print(&describe(&inspection))?)
}

/// Writes the mask of a layer, from 1.
fn write_mask(
    file: &PrintFile<'_>,
    path: &Path,
    layer: usize,
    output: &Output<'_>,
) -> Result<(), Failure> {
    let layers = file.layers().len();
    if layer > layers {
        let reason = format!("there is no layer {layer}; it has {layers}");
        return Err(in_file(path, &reason).into());
    }
    output.write(|mut writer| {
        let written = file.write_png(layer - 1, &mut writer);
        let decoded = written.map_err(|error| output.failed(&error))?;
        decoded.map_err(|error| in_file(path, &error))?;
        Ok((writer, ()))
    })
}

fn describe(inspection: &Inspection) -> String {
    let metadata = &inspection.metadata;
    let mut lines = vec![("format", format_line(metadata))];
    lines.extend(metadata.printer.clone().map(|printer| ("printer", printer)));
    if let [Some(x), Some(y), z] = metadata.plate_mm {
        let z = z.map_or(String::new(), |z| format!(" × {z}"));
        lines.push(("plate", format!("{} × {}{z} mm", rounded(x), rounded(y))));
    }
    lines.push(("masks", masks_line(metadata)));
    lines.push(("layers", layers_line(inspection)));
    lines.extend(exposure_line(inspection).map(|line| ("exposure", line)));
    let time = metadata.print_time_s.filter(|&time_s| time_s > 0.0);
    lines.extend(time.map(|time_s| ("time", duration(time_s))));
    lines.push(("resin", resin_line(inspection)));
    if !inspection.previews.is_empty() {
        let sizes = inspection.previews.iter();
        let sizes = sizes.map(|size| format!("{} × {}", size.width, size.height));
        lines.push(("previews", sizes.collect::<Vec<_>>().join(", ")));
    }
    let lines = lines
        .iter()
        .map(|(name, line)| format!("{name:<9} {}", visible(line)));
    lines.collect::<Vec<_>>().join("\n")
}

fn format_line(metadata: &Metadata) -> String {
    let version = metadata.version.as_ref();
    let version = version.map_or(String::new(), |version| format!(" {version}"));
    let software = metadata.software.as_ref();
    let software = software.map_or(String::new(), |software| format!(", by {software}"));
    format!("{}{version}{software}", metadata.format.name())
}

fn masks_line(metadata: &Metadata) -> String {
    let [width, height] = metadata.pixels;
    let [pitch_x, pitch_y] = metadata.pixel_mm;
    let mirrored = match (metadata.is_mirrored_x, metadata.is_mirrored_y) {
        (Some(true), Some(true)) => ", mirrored in x and y",
        (Some(true), _) => ", mirrored in x",
        (_, Some(true)) => ", mirrored in y",
        (None, None) => "",
        _ => ", not mirrored",
    };
    format!("{width} × {height} pixels of {pitch_x:.4} × {pitch_y:.4} mm{mirrored}")
}

fn layers_line(inspection: &Inspection) -> String {
    let thickness = inspection
        .thickness_range_mm
        .map_or(String::new(), |range| format!(" of {} mm", from_to(range)));
    let counts = match inspection.metadata.uses_layer_values {
        Some(false) => ", whose own values the printer ignores",
        _ => "",
    };
    format!(
        "{}{thickness}, {:.3} mm high{counts}",
        inspection.layers, inspection.height_mm
    )
}

fn exposure_line(inspection: &Inspection) -> Option<String> {
    let metadata = &inspection.metadata;
    let range = inspection.exposure_range_s;
    let usual = range.or(metadata.exposure_s.map(|usual_s| [usual_s; 2]))?;
    let bottom = match (metadata.bottom_layers, metadata.bottom_exposure_s) {
        (Some(1..), Some(bottom_s)) => format!("bottom layers {} s", rounded(bottom_s)),
        (None, Some(bottom_s)) => format!("first layer {} s", rounded(bottom_s)),
        _ => return Some(format!("{} s", from_to(usual))),
    };
    Some(format!("{} s, {bottom}", from_to(usual)))
}

fn resin_line(inspection: &Inspection) -> String {
    let metadata = &inspection.metadata;
    let name = metadata.resin.as_ref();
    let name = name.map_or(String::new(), |name| format!("{name}, "));
    let stated = metadata.volume_ml.filter(|&volume_ml| volume_ml > 0.0);
    let stated = stated.map_or(String::new(), |volume_ml| {
        format!("{volume_ml:.1} ml by the file, ")
    });
    format!(
        "{name}{stated}{:.1} ml by the masks",
        inspection.lit_volume_ml
    )
}

/// Both ends of a range, or the one that they are.
fn from_to([least, greatest]: [f64; 2]) -> String {
    let (least, greatest) = (rounded(least), rounded(greatest));
    if least == greatest {
        least
    } else {
        format!("{least} to {greatest}")
    }
}

/// To the thousandth, without trailing zeros.
fn rounded(value: f64) -> String {
    ((value * 1e3).round() / 1e3).to_string()
}
