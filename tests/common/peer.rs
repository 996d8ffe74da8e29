//! Runs `prusa-slicer` on the same model, pixels and layers, as an independent source of masks.

use std::fs;
use std::io::Cursor;
use std::path::Path;
use std::process::Command;

/// Writes settings to `folder`, and returns the command that slices `model` into the SL1 file `output`: uniform layers of
/// 0.05 mm, on a square screen of `side_mm` and `pixels` a side, with the model centred.
pub fn prusa_slicer(
    model: &Path,
    output: &Path,
    folder: &Path,
    side_mm: f64,
    pixels: u32,
) -> Command {
    let settings = folder.join("sla.ini");
    let lines = [
        "printer_technology = SLA".to_owned(),
        format!("display_width = {side_mm}\ndisplay_height = {side_mm}"),
        format!("display_pixels_x = {pixels}\ndisplay_pixels_y = {pixels}"),
        "display_orientation = landscape\nsupports_enable = 0\npad_enable = 0".to_owned(),
        format!(
            "bed_shape = 0x0,{side_mm}x0,{side_mm}x{side_mm},0x{side_mm}\ndisplay_mirror_x = 0"
        ),
        "layer_height = 0.05\ninitial_layer_height = 0.05\ngamma_correction = 0".to_owned(),
    ];
    fs::write(&settings, lines.join("\n")).expect("the settings");
    let mut peer = Command::new("prusa-slicer");
    let middle = format!("{0},{0}", side_mm / 2.0);
    peer.args(["--export-sla", "--center", &middle])
        .arg("--load")
        .arg(&settings)
        .arg("-o")
        .arg(output)
        .arg(model);
    peer
}

/// The masks of an SL1 file from the plate upward, one byte per pixel.
pub fn sl1_masks(path: &Path) -> Vec<Vec<u8>> {
    let mut zip = zip::ZipArchive::new(fs::File::open(path).expect("a file")).expect("a zip");
    let mut names: Vec<String> = zip
        .file_names()
        .map(|name| name.expect("a name").into_owned())
        .collect();
    names.retain(|name| !name.contains("thumbnail") && !name.contains("ini"));
    names.sort();
    let decode = |name: &String| {
        let mut bytes = Vec::new();
        std::io::copy(&mut zip.by_name(name).expect("a mask"), &mut bytes).expect("a mask");
        let decoder = png::Decoder::new(Cursor::new(bytes));
        let mut reader = decoder.read_info().expect("a PNG");
        let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
        reader.next_frame(&mut pixels).expect("pixels");
        pixels
    };
    names.iter().map(decode).collect()
}
