//! Anycubic's zip: pm4u, pm7, pm7m, pwsz, pp1 and pp1m. JSON says everything, and gives each layer a place and a thickness.

use serde_json::Value;

use super::bytes::clean;
use super::container::{Archive, any_number, number};
use super::preview::Picture;
use super::{
    Coding, Contents, Format, Layer, Metadata, Places, PrintFileError, UnreadKind, positive,
};

const RESINS: &str = "anycubic_photon_resins.pwsp";
const LAYERS: &str = "layers_controller.conf";
const INFO: &str = "print_info.json";

pub fn read(archive: &mut Archive<'_>) -> Result<Contents, PrintFileError> {
    let resins = archive.read_json(RESINS)?;
    let controller = archive.read_json(LAYERS)?;
    let info = archive.read_json_if_any(INFO)?;
    let machine = &resins["machine_type"];
    let bad = |setting: &str| PrintFileError::bad_setting(RESINS, setting);
    let pixels = |key: &str| {
        let pixels = number(&machine[key]).filter(|pixels| (0.0..=1e9).contains(pixels));
        pixels.map(|pixels| pixels as u32).ok_or_else(|| bad(key))
    };
    let pitch_um = |key: &str| positive(number(&machine[key]));
    let pitch_x = pitch_um("xy_pixel").ok_or_else(|| bad("xy_pixel"))?;
    let pixel_mm = [pitch_x, pitch_um("xy_pixel_y").unwrap_or(pitch_x)].map(|um| um / 1000.0);

    let entries = controller["paras"].as_array();
    let entries = entries.ok_or_else(|| PrintFileError::bad_setting(LAYERS, "paras"))?;
    let extern_ = &resins["machine_extern"];
    let resin = active_resin(extern_);
    let slicing = &resin["slicepara"];
    let layers: Option<Vec<Layer>> = entries.iter().map(|entry| layer(entry, slicing)).collect();
    let layers = layers.ok_or_else(|| {
        PrintFileError::bad_setting(LAYERS, "layer_minheight and layer_thickness")
    })?;
    let masks = (0..layers.len()).map(|layer| format!("layer_images/layer_{layer}.pw0Img"));
    if !archive.has("layer_images/layer_0.pw0Img") && archive.has("layer_images/layer_0.pwszImg") {
        return Err(PrintFileError::Unread {
            kind: UnreadKind::Outlines,
        });
    }
    let previews = (0..3).map(|place| format!("preview_images/preview_{place}.png"));
    let previews = previews.filter(|name| archive.has(name));
    let text = |value: &Value| value.as_str().and_then(clean);
    let plate = |key: &str| positive(number(&machine[key]));
    Ok(Contents {
        metadata: Metadata {
            version: number(&resins["version"]).map(|version| version.to_string()),
            printer: text(&machine["name"]),
            resin: text(&extern_["active_resins"]),
            plate_mm: [
                plate("print_xsize"),
                plate("print_ysize"),
                plate("print_zsize"),
            ],
            layer_mm: positive(number(&slicing["zthick"])),
            exposure_s: any_number(&slicing["exposure_time"]),
            bottom_exposure_s: any_number(&slicing["bott_time"]),
            bottom_layers: number(&slicing["bott_layers"]).map(|layers| layers as u32),
            transition_layers: number(&resin["slice_extpara"]["transition_layercount"])
                .map(|layers| layers as u32),
            print_time_s: number(&info["print_time"]),
            volume_ml: number(&info["volume"]),
            weight_g: number(&info["weight"]),
            uses_layer_values: number(&slicing["use_indivi_layerpara"]).map(|flag| flag != 0.0),
            ..Metadata::new(
                Format::AnycubicZip,
                [pixels("res_x")?, pixels("res_y")?],
                pixel_mm,
            )
        },
        layers,
        coding: Coding::Pw0,
        places: Places::InZip(masks.collect()),
        pictures: previews.map(Picture::Png).collect(),
        copies: None,
        findings: Vec::new(),
    })
}

/// A layer, which says its bottom and thickness.
fn layer(entry: &Value, slicing: &Value) -> Option<Layer> {
    let thickness_mm = number(&entry["layer_thickness"])?;
    // To the nanometre, as sums of decimals are not.
    let z_mm = number(&entry["layer_minheight"])? + thickness_mm;
    let by_minute = |value: &Value| number(value).map(|speed| speed * 60.0);
    Some(Layer {
        z_mm: (z_mm * 1e6).round() / 1e6,
        thickness_mm,
        exposure_s: any_number(&entry["exposure_time"]),
        wait_before_exposure_s: number(&slicing["off_time"]),
        lift_mm: number(&entry["zup_height"]),
        lift_mm_min: by_minute(&entry["zup_speed"]),
        retract_mm_min: by_minute(&slicing["zdown_speed"]),
        ..Layer::default()
    })
}

/// The resin that counts, or the first one.
fn active_resin(machine: &Value) -> &Value {
    let lists = ["user_resins", "factory_resins"].map(|list| &machine[list]);
    let resins = || {
        let lists = lists.iter().filter_map(|list| list.as_array());
        lists.flatten()
    };
    let active = machine["active_resins"].as_str();
    let is_active = |resin: &&Value| {
        let named = |object: &Value| {
            let mut values = object.as_object().into_iter().flat_map(|it| it.values());
            active.is_some() && values.any(|value| value.as_str() == active)
        };
        named(resin) || named(&resin["property"])
    };
    let active = resins().find(is_active);
    active.or_else(|| resins().next()).unwrap_or(&Value::Null)
}
