//! The crates that read GOO files, both by the author of mslicer: their results, as one type.

use msla_format::serde::SliceDeserializer;

use crate::common::Runs;

/// The head of a file.
#[derive(Debug, PartialEq)]
pub struct Head {
    pub texts: Vec<String>,
    pub antialias: u16,
    pub layers: u32,
    pub pixels: [u16; 2],
    pub is_mirrored: [bool; 2],
    pub volume_mm: [f32; 3],
    pub layer_mm: f32,
    pub exposure_s: f32,
    pub bottom_exposure_s: f32,
    pub bottom_layers: u32,
    pub has_waits: bool,
    /// Without light; before the lift, after it and after the return, of bottom layers and of others.
    pub waits_s: [f32; 7],
    /// Lengths and speeds of lift and return, of bottom layers and of others, then the same of a second stage.
    pub moves: [[f32; 2]; 8],
    pub light: [u16; 2],
    pub has_layer_settings: bool,
    pub time_s: u32,
    pub volume_mm3: f32,
    pub weight_g: f32,
    pub has_8_bit_greys: bool,
    pub transition_layers: u16,
}

/// A layer of a file.
#[derive(Debug, PartialEq)]
pub struct LayerHead {
    pub pause: bool,
    pub z_mm: f32,
    pub exposure_s: f32,
    /// Without light; before the lift, after it and after the return.
    pub waits_s: [f32; 4],
    /// Lengths and speeds of lift and return, then the same of a second stage.
    pub moves: [[f32; 2]; 4],
    pub light: u16,
}

/// A file as a crate reads it.
pub struct Print {
    pub head: Head,
    pub previews: [Vec<u16>; 2],
    pub layers: Vec<(LayerHead, Runs)>,
}

pub fn by_goo(bytes: &[u8]) -> Print {
    let goo::GooFile { header, layers } = goo::GooFile::deserialize(bytes).unwrap();
    let quoted = [
        format!("{:?}", header.software_info),
        format!("{:?}", header.printer_name),
        format!("{:?}", header.profile_name),
        format!("{:?}", header.price_unit),
    ];
    let head = Head {
        texts: quoted.map(|text| text.replace('"', "")).to_vec(),
        antialias: header.anti_aliasing_level,
        layers: header.layer_count,
        pixels: [header.x_resolution, header.y_resolution],
        is_mirrored: [header.x_mirror, header.y_mirror],
        volume_mm: [header.x_size, header.y_size, header.z_size],
        layer_mm: header.layer_thickness,
        exposure_s: header.exposure_time,
        bottom_exposure_s: header.bottom_exposure_time,
        bottom_layers: header.bottom_layers,
        has_waits: header.exposure_delay_mode,
        waits_s: [
            header.turn_off_time,
            header.bottom_before_lift_time,
            header.bottom_after_lift_time,
            header.bottom_after_retract_time,
            header.before_lift_time,
            header.after_lift_time,
            header.after_retract_time,
        ],
        moves: [
            [header.bottom_lift_distance, header.bottom_lift_speed],
            [header.lift_distance, header.lift_speed],
            [header.bottom_retract_distance, header.bottom_retract_speed],
            [header.retract_distance, header.retract_speed],
            [
                header.bottom_second_lift_distance,
                header.bottom_second_lift_speed,
            ],
            [header.second_lift_distance, header.second_lift_speed],
            [
                header.bottom_second_retract_distance,
                header.bottom_second_retract_speed,
            ],
            [header.second_retract_distance, header.second_retract_speed],
        ],
        light: [header.bottom_light_pwm, header.light_pwm],
        has_layer_settings: header.advance_mode,
        time_s: header.printing_time,
        volume_mm3: header.total_volume,
        weight_g: header.total_weight,
        has_8_bit_greys: header.grey_scale_level,
        transition_layers: header.transition_layers,
    };
    let layers = layers.iter().map(|layer| {
        let head = LayerHead {
            pause: layer.pause_flag != 0,
            z_mm: layer.layer_position_z,
            exposure_s: layer.layer_exposure_time,
            waits_s: [
                layer.layer_off_time,
                layer.before_lift_time,
                layer.after_lift_time,
                layer.after_retract_time,
            ],
            moves: [
                [layer.lift_distance, layer.lift_speed],
                [layer.retract_distance, layer.retract_speed],
                [layer.second_lift_distance, layer.second_lift_speed],
                [layer.second_retract_distance, layer.second_retract_speed],
            ],
            light: layer.light_pwm,
        };
        let decoder = goo::LayerDecoder::new(&layer.data);
        assert_eq!(layer.checksum, decoder.checksum());
        (head, decoder.map(|run| (run.value, run.length)).collect())
    });
    Print {
        head,
        previews: [
            header.small_preview.inner_data().to_vec(),
            header.big_preview.inner_data().to_vec(),
        ],
        layers: layers.collect(),
    }
}

pub fn by_msla_format(bytes: &[u8]) -> Print {
    let file = msla_format::goo::File::deserialize(&mut SliceDeserializer::new(bytes));
    let msla_format::goo::File { header, layers } = file.unwrap();
    let head = Head {
        texts: vec![
            header.software_info.to_string(),
            header.printer_name.to_string(),
            header.profile_name.to_string(),
            header.price_unit.to_string(),
        ],
        antialias: header.anti_aliasing_level,
        layers: header.layer_count,
        pixels: [header.x_resolution, header.y_resolution],
        is_mirrored: [header.x_mirror, header.y_mirror],
        volume_mm: [header.x_size, header.y_size, header.z_size].map(|mm| mm.raw()),
        layer_mm: header.layer_thickness.raw(),
        exposure_s: header.exposure_time.raw(),
        bottom_exposure_s: header.bottom_exposure_time.raw(),
        bottom_layers: header.bottom_layers,
        has_waits: matches!(
            header.exposure_delay_mode,
            msla_format::goo::ExposureDelayMode::StaticTime
        ),
        waits_s: [
            header.turn_off_time,
            header.bottom_before_lift_time,
            header.bottom_after_lift_time,
            header.bottom_after_retract_time,
            header.before_lift_time,
            header.after_lift_time,
            header.after_retract_time,
        ]
        .map(|wait| wait.raw()),
        moves: [
            (header.bottom_lift_distance, header.bottom_lift_speed),
            (header.lift_distance, header.lift_speed),
            (header.bottom_retract_distance, header.bottom_retract_speed),
            (header.retract_distance, header.retract_speed),
            (
                header.bottom_second_lift_distance,
                header.bottom_second_lift_speed,
            ),
            (header.second_lift_distance, header.second_lift_speed),
            (
                header.bottom_second_retract_distance,
                header.bottom_second_retract_speed,
            ),
            (header.second_retract_distance, header.second_retract_speed),
        ]
        .map(|(distance, speed)| [distance.raw(), speed.raw()]),
        light: [header.bottom_light_pwm, header.light_pwm].map(u16::from),
        has_layer_settings: header.per_layer_settings,
        time_s: header.printing_time,
        volume_mm3: header.total_volume,
        weight_g: header.total_weight,
        has_8_bit_greys: header.grey_scale_level,
        transition_layers: header.transition_layers,
    };
    let layers = layers.iter().map(|layer| {
        let head = LayerHead {
            pause: layer.pause,
            z_mm: layer.layer_position_z.raw(),
            exposure_s: layer.layer_exposure_time.raw(),
            waits_s: [
                layer.layer_off_time,
                layer.before_lift_time,
                layer.after_lift_time,
                layer.after_retract_time,
            ]
            .map(|wait| wait.raw()),
            moves: [
                (layer.lift_distance, layer.lift_speed),
                (layer.retract_distance, layer.retract_speed),
                (layer.second_lift_distance, layer.second_lift_speed),
                (layer.second_retract_distance, layer.second_retract_speed),
            ]
            .map(|(distance, speed)| [distance.raw(), speed.raw()]),
            light: u16::from(layer.light_pwm),
        };
        let decoder = msla_format::goo::LayerDecoder::new(&layer.data);
        assert_eq!(layer.checksum, decoder.checksum());
        (head, decoder.map(|run| (run.value, run.length)).collect())
    });
    Print {
        head,
        previews: [
            header.small_preview.inner_data().to_vec(),
            header.big_preview.inner_data().to_vec(),
        ],
        layers: layers.collect(),
    }
}

/// A crate's name, and how it reads a file.
type Reader = (&'static str, fn(&[u8]) -> Print);

pub const READERS: [Reader; 2] = [("goo", by_goo), ("msla_format", by_msla_format)];
