//! NanoDLP: a zip of JSON and PNGs, in which each colour of a pixel is a pixel of the screen. Layers have one thickness,
//! or two if bottom layers have their own.

use super::bytes::clean;
use super::container::{Archive, any_number, number};
use super::metadata::with_tops;
use super::preview::Picture;
use super::{Coding, Contents, Format, Layer, Metadata, Places, PrintFileError, positive};

const PLATE: &str = "plate.json";
const PROFILE: &str = "profile.json";
/// The same twice: programs read one or the other.
const OPTIONS: [&str; 2] = ["options.json", "slicer.json"];
const PREVIEW: &str = "3d.png";

pub fn read(archive: &mut Archive<'_>) -> Result<Contents, PrintFileError> {
    let plate = archive.read_json(PLATE)?;
    let profile = archive.read_json(PROFILE)?;
    let options_file = OPTIONS.into_iter().find(|name| archive.has(name));
    let options_file = options_file.unwrap_or(OPTIONS[0]);
    let options = archive.read_json(options_file)?;
    let meta = archive.read_json_if_any("meta.json")?;

    let count = plate["LayersCount"].as_u64();
    let count = count.ok_or_else(|| PrintFileError::bad_setting(PLATE, "LayersCount"))?;
    // Each layer has a file.
    let most = archive.len() as u64;
    if count > most {
        return Err(PrintFileError::TooManyLayers {
            layers: count,
            most,
        });
    }
    let bad = |setting: &str| PrintFileError::bad_setting(options_file, setting);
    let side = |pixels: &str, millimetres: &str, micrometres: &str| {
        let columns = options[pixels]
            .as_u64()
            .and_then(|side| side.try_into().ok());
        let columns: u32 = columns.ok_or_else(|| bad(pixels))?;
        let side_mm = positive(number(&options[millimetres]));
        let side_um = positive(number(&options[micrometres]));
        let side_mm = side_mm.or(side_um.map(|um| um / 1000.0));
        Ok::<_, PrintFileError>((columns, side_mm.ok_or_else(|| bad(millimetres))?))
    };
    let (width, pitch_x) = side("PWidth", "XPixelSize", "XRes")?;
    let (height, pitch_y) = side("PHeight", "YPixelSize", "YRes")?;

    let thickness = |key: &str| positive(number(&profile[key])).map(|um| um / 1000.0);
    let usual_mm = thickness("Depth")
        .or_else(|| positive(number(&options["Thickness"])).map(|um| um / 1000.0));
    let usual_mm = usual_mm.ok_or_else(|| PrintFileError::bad_setting(PROFILE, "Depth"))?;
    let bottom_mm = thickness("SupportDepth").unwrap_or(usual_mm);
    let bottom_layers = profile["SupportLayerNumber"].as_u64();
    let (usual_s, bottom_s) = (
        any_number(&profile["CureTime"]),
        any_number(&profile["SupportCureTime"]),
    );
    let layers = (0..count).map(|layer| {
        let is_bottom = bottom_layers.is_some_and(|bottom| layer < bottom);
        Layer {
            thickness_mm: if is_bottom { bottom_mm } else { usual_mm },
            exposure_s: if is_bottom { bottom_s } else { usual_s },
            wait_before_exposure_s: number(&profile["WaitBeforePrint"]),
            ..Layer::default()
        }
    });
    let preview = Some(PREVIEW).filter(|name| archive.has(name));
    let text = |value: &serde_json::Value| value.as_str().and_then(clean);
    Ok(Contents {
        metadata: Metadata {
            version: number(&meta["FormatVersion"]).map(|version| version.to_string()),
            software: super::joined(&[text(&meta["Program"]), text(&meta["Version"])]),
            resin: text(&profile["Title"]),
            layer_mm: Some(usual_mm),
            exposure_s: usual_s,
            bottom_exposure_s: bottom_s,
            bottom_layers: bottom_layers.map(|layers| layers as u32),
            transition_layers: profile["TransitionalLayer"]
                .as_u64()
                .map(|layers| layers as u32),
            print_time_s: number(&plate["PrintTime"]),
            ..Metadata::new(Format::Nanodlp, [width, height], [pitch_x, pitch_y])
        },
        layers: with_tops(layers.collect()),
        coding: Coding::PngOfSubpixels,
        places: Places::InZip((1..=count).map(|layer| format!("{layer}.png")).collect()),
        pictures: preview
            .map(|name| Picture::Png(name.to_owned()))
            .into_iter()
            .collect(),
        copies: None,
        findings: Vec::new(),
    })
}
