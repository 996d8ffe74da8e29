//! Anycubic's zips of 2024 and later, pm7 and pwsz for example: masks in pw0, settings as JSON with a thickness and an
//! exposure for each layer, and a table of the layers' areas.
//!
//! Firmware is said to be strict about types of numbers. What is a fraction in files of Anycubic's own slicer is written
//! with a decimal point, `46.0` say, and what is an integer there, without.

use serde_json::{Value, json};

use super::{Container, File, LayerEntry, joined_bounds, json_file};
use crate::archive::fields::{ByteOrder, Fields};
use crate::archive::survey::Survey;
use crate::archive::{ArchiveError, PrintJob, Screen, pw0, tidy};
use crate::mask::Run;
use crate::printer::Printer;

pub struct Anycubic;

/// What the format calls its masks.
const IMAGE_FORMAT: &str = "pw0Img";
/// The kind of masks that printers expect to be named in the settings, whatever the masks are.
const KEY_IMAGE_FORMAT: &str = "pwszImg";
/// The extension for printers that do not say.
const USUAL_SUFFIX: &str = "pwsz";
/// Columns and rows of the previews: two on the printer, one in the maker's cloud.
const PREVIEWS: [[u32; 2]; 3] = [[224, 168], [336, 252], [800, 600]];
/// The most levels of anti-aliasing.
const MOST_LEVELS: u32 = 16;
const CURRENCY: &str = "$";
const SOFTWARE: &str = concat!("Cusp ", env!("CARGO_PKG_VERSION"));

impl Container for Anycubic {
    fn mask_name(&self, layer: usize) -> String {
        format!("layer_images/layer_{layer}.{IMAGE_FORMAT}")
    }

    fn mask(&self, screen: &Screen, runs: &mut dyn Iterator<Item = Run>) -> Vec<u8> {
        pw0::encode(runs, screen.area())
    }

    fn needs_survey(&self) -> bool {
        true
    }

    fn files(&self, job: &PrintJob<'_>, layers: &[LayerEntry]) -> Result<Vec<File>, ArchiveError> {
        let look = (job.look)();
        let mut files = vec![
            json_file("anycubic_photon_resins.pwsp", &settings(job))?,
            json_file("layers_controller.conf", &layers_controller(job, layers))?,
            json_file("print_info.json", &print_info(job, layers.len()))?,
            json_file("lcd_function.json", &lcd_function())?,
            json_file("software_info.conf", &software_info())?,
        ];
        for (index, size) in PREVIEWS.into_iter().enumerate() {
            let name = format!("preview_images/preview_{index}.png");
            files.push((name, look.png(size)));
        }
        files.push(("scene.slice".to_owned(), scene(&job.screen, layers)));
        Ok(files)
    }
}

/// The printer and the resin.
fn settings(job: &PrintJob<'_>) -> Value {
    let machine = job.printer.map_or("Unknown", Printer::machine);
    let resin = resin(job);
    json!({
        "version": "3",
        "machine_type": machine_type(job, machine),
        "machine_extern": {
            "version": "3",
            "alias": machine,
            "picture": "",
            "cloud_property": 0,
            "device_cn_code": "",
            "factory_resins": [],
            "user_resins": [resin],
            "active_resins": [resin["property"]["name"]],
            "firmware_calc_print_time": 1,
            "firmware_calc_print_time_paras": print_time_constants(),
            "firmware_calc_exp_time_paras": {
                "precision_range_branch": [0.0, 5.0, 25.0],
                "precision_per_volume": 5.0,
                "precision_coeff_value": [0.024, 0.01, -0.2],
                "energy_coeff": 0.0,
                "machine_exposure_ton": 0.4,
            },
        },
    })
}

fn machine_type(job: &PrintJob<'_>, machine: &str) -> Value {
    let screen = &job.screen;
    let [columns, rows] = screen.pixels;
    let [x_mm, y_mm] = screen.size_mm();
    let [_, _, z_mm] = job.volume_mm();
    let suffix = job.printer.and_then(|printer| printer.reads.first());
    json!({
        "version": "3",
        "name": machine,
        "key_suffix": suffix.map_or(USUAL_SUFFIX, String::as_str),
        "key_image_format": KEY_IMAGE_FORMAT,
        "res_x": columns,
        "res_y": rows,
        "xy_pixel": tidy(screen.pitch_mm[0] * 1e3),
        "xy_pixel_y": tidy(screen.pitch_mm[1] * 1e3),
        "rotate_z": 0.0,
        "max_samples": MOST_LEVELS,
        "property": 119,
        "print_xsize": tidy(x_mm),
        "print_ysize": tidy(y_mm),
        "print_zsize": tidy(z_mm),
        "max_file_version": 518,
        "prev_back_color": [0.0, 0.28, 0.39],
        "prev_model_color": [0.8, 0.8, 0.8],
        "prev_supports_color": [0.07, 0.93, 0.93],
        "prev_image_size": PREVIEWS[0],
        "child_screen": [{ "x": 0, "y": 0, "width": columns, "height": rows }],
        "prev2_back_color": [0.08, 0.11, 0.16],
        "prev2_image_size": PREVIEWS[1],
        // Room for outlines, which only other kinds of masks have.
        "raster_segments_capacity": 0,
        "raster_antialiasing": screen.antialias.min(MOST_LEVELS),
        "cloudprev_back_color": [0.0, 0.28, 0.39],
        "cloudprev_imag_size": PREVIEWS[2],
        "print_platform_zheights": [0.0],
    })
}

/// What the printer estimates the print time from, as it is for most printers.
fn print_time_constants() -> Value {
    json!({
        "version": "2",
        "MACHINE_AXIS_STEPS_PER_UNIT": [100.0, 100.0, 3200.0, 94.0],
        "MACHINE_BLOCK_BUFFER_SIZE": 32,
        "MACHINE_DEFAULT_ACCELERATION": 1000.0,
        "MACHINE_DEFAULT_MINSEGMENTTIME": 20000,
        "MACHINE_DEFAULT_XYJERK": 20.0,
        "MACHINE_DEFAULT_ZJERK": 0.2,
        "MACHINE_GENERATE_FRAME_TIME": 450.0,
        "MACHINE_MAX_ACCELERATION": [1000, 1000, 160, 1000],
        "MACHINE_MAX_FEEDRATE": [200.0, 200.0, 20.0, 45.0],
        "MACHINE_MAX_STEP_FREQUENCY": 256_000,
        "MACHINE_MINIMUM_PLANNER_SPEED": 0.05,
        "MACHINE_NOR_LAYER_DOWN_HEIGHT_DIV": 0.25,
        "MACHINE_NOR_LAYER_DOWN_SPEED_DIV": 0.5,
        "MACHINE_NOR_LAYER_UP_HEIGHT_DIV": 0.25,
        "MACHINE_NOR_LAYER_UP_SPEED_DIV": 0.5,
        "MACHINE_STEP_MUL": 1,
        "MACHINE_TIME_COMPENSATE": 0.0,
        "MACHINE_TIM_PRES": 30.0,
        "MACHINE_TIM_RCC_CLK": 60.0,
        "FUNCTION": 1,
        "MACHINE_MODE_ACCELERATION": [0, 0, 0, 0],
        "LAYER_COMPENSATE": [0, 0, 0, 0],
        "HEIGHT_COMPENSATE": [0, 0, 0, 0],
        "TIMES_COMPENSATE": [0, 0, 0, 0],
    })
}

fn resin(job: &PrintJob<'_>) -> Value {
    const BRAND: &str = "Generic";
    const FILM: &str = "Unknown";
    const SETTING: &str = "Cusp";
    // The sign parts the four names from one another.
    let resin_name = job.resin.name.replace('@', " ");
    let name = [BRAND, &resin_name, FILM, SETTING].join("@");
    json!({
        "version": "2",
        "property": {
            "version": "4",
            "code": "10",
            "currency": CURRENCY,
            "name": name,
            "price": 0.0,
            "type": "Standard resin",
            "volume": 1000.0,
            "subfunc_code": 0,
            "density": tidy(job.resin.density_g_ml),
            "target_temperature": 25.0,
            "brand_name": BRAND,
            "resin_name": resin_name,
            "film_name": FILM,
            "setting_name": SETTING,
        },
        // No curve is selected: exposures are those of this file.
        "depth_penetration_curve": {
            "zthick_min": 0.01,
            "zthick_max": 0.2,
            "light_intensity": 9000.0,
            "safety_coefficient": 1.6,
            "current_tempcurve_selector": -1,
            "temperature_coefficients": [],
        },
        "slice_extpara": moves(job),
        "slicepara": exposures(job),
    })
}

/// Lifts, of one stage for bottom layers and others: the second has no height.
fn moves(job: &PrintJob<'_>) -> Value {
    let resin = job.resin;
    let stage = |lift_mm: f64| {
        json!({
            "height": tidy(lift_mm),
            "up_speed": mm_s(resin.lift_mm_min),
            "down_speed": mm_s(resin.return_mm_min),
        })
    };
    json!({
        "version": "3",
        "multi_state_used": 0,
        "transition_layercount": 0,
        "transition_type": 0,
        "multi_state_paras": {
            "bott_0": stage(resin.lift_mm),
            "bott_1": stage(0.0),
            "normal_0": stage(resin.lift_mm),
            "normal_1": stage(0.0),
        },
        "exposure_compensate": 0.0,
        // The printer keeps to these exposures and speeds.
        "intelli_mode": 0,
        "max_acceleration": 20.0,
        "separate_support_exposure_delayed": 0.0,
        "material_scale_coeffs": [],
        "material_scale_coeffs_mode": 0,
        "material_scale_xyz": { "x": 1.0, "y": 1.0, "z": 1.0 },
    })
}

fn exposures(job: &PrintJob<'_>) -> Value {
    let resin = job.resin;
    let usual_mm = job.usual_mm();
    json!({
        "anti_count": job.screen.antialias.min(MOST_LEVELS),
        "blur_level": 0,
        "bott_layers": resin.bottom_layers.min(job.layers.len()),
        "bott_off_time": tidy(resin.wait_s),
        "bott_time": tidy(resin.bottom_exposure_s),
        "bott_time_dual": tidy(resin.bottom_exposure_s),
        "bott_wait_after_lift": 0.0,
        "bott_wait_before_lift": 0.0,
        "exposure_time": tidy(resin.exposure_s(usual_mm)),
        "gray_level": 0,
        "off_time": tidy(resin.wait_s),
        "use_indivi_layerpara": u8::from(job.needs_layer_settings()),
        "use_random_erode": 0,
        "wait_after_lift": 0.0,
        "wait_before_lift": 0.0,
        "zthick": tidy(usual_mm),
        "zup_height": tidy(resin.lift_mm),
        "zup_speed": mm_s(resin.lift_mm_min),
        "zdown_speed": mm_s(resin.return_mm_min),
    })
}

/// Speeds are in millimetres per second here.
fn mm_s(mm_min: f64) -> f64 {
    tidy(mm_min / 60.0)
}

fn layers_controller(job: &PrintJob<'_>, layers: &[LayerEntry]) -> Value {
    let resin = job.resin;
    let layers = layers.iter().enumerate().map(|(index, layer)| {
        json!({
            "exposure_time": tidy(layer.exposure_s),
            "layer_index": index,
            "layer_minheight": tidy(layer.z_mm - layer.thickness_mm),
            "layer_thickness": tidy(layer.thickness_mm),
            "zup_height": tidy(resin.lift_mm),
            "zup_speed": mm_s(resin.lift_mm_min),
        })
    });
    json!({ "count": layers.len(), "paras": layers.collect::<Value>() })
}

fn print_info(job: &PrintJob<'_>, layers: usize) -> Value {
    let time_s = job.print_time_s().round() as u64;
    let volume_ml = tidy(job.resin_ml);
    let weight_g = tidy(job.resin_ml * job.resin.density_g_ml);
    json!({
        "model_layers_count": layers,
        "cost": 0.0,
        "currency": CURRENCY,
        "print_time": time_s,
        "volume": volume_ml,
        "weight": weight_g,
        "sub_estimated_infos": [{
            "model_layers_count": layers,
            "estimated_cost": 0.0,
            "estimated_cost_currency": CURRENCY,
            "estimated_time": time_s,
            "estimated_volume": volume_ml,
            "estimated_weight": weight_g,
        }],
    })
}

/// One model that the slicer has not changed, and no exposure test.
fn lcd_function() -> Value {
    json!({
        "models_processed_info": {
            "models": [{
                "name": "",
                "source_from": 0,
                "makeronline_sourceid": -1,
                "auto_support": 0,
                "manual_support": 0,
                "hollow": 0,
                "punch": 0,
            }],
            "scene_models_from": 0,
            "slice_paras_process": 0,
            "software_version": SOFTWARE,
        },
        "rerf_function": {
            "enable": false,
            "model_name": "",
            "model_type": 1,
            "partition_exposure_array": [],
            "partition_num": 0,
        },
    })
}

fn software_info() -> Value {
    json!({
        "mark": "Cusp",
        "opengl": "3.3-CoreProfile",
        "os": "",
        "version": env!("CARGO_PKG_VERSION"),
    })
}

/// The table of layers: heights, areas and boxes.
fn scene(screen: &Screen, layers: &[LayerEntry]) -> Vec<u8> {
    let count = layers.len() as u32;
    let pixel_mm2 = screen.pitch_mm[0] * screen.pitch_mm[1];
    let mut bytes = Vec::with_capacity(400 + 64 * layers.len());
    let mut fields = Fields::new(&mut bytes, ByteOrder::Little);
    fields.text("ANYCUBIC-PWSZ", 16);
    fields.text(SOFTWARE, 64);
    // The kind of file that printers expect, its version, the kind of slices, and millimetres.
    for number in [3, 1, 0, 0] {
        fields.u32(number);
    }
    fields.f32(1.0);
    fields.u32(count);
    let [left_mm, first_mm, right_mm, last_mm] = screen.bounds_mm(joined_bounds(layers));
    let top_mm = layers.last().map_or(0.0, |layer| layer.z_mm);
    for number in [left_mm, first_mm, 0.0, right_mm, last_mm, top_mm] {
        fields.f32(number);
    }
    fields.u32(0);
    fields.zeros(4 * 64);
    fields.bytes(b"<---");
    fields.u32(count);
    for layer in layers {
        let Survey { bounds, areas } = layer.survey();
        fields.f32(layer.z_mm);
        fields.f32(layer.lit_pixels as f64 * pixel_mm2);
        for number in screen.bounds_mm(*bounds) {
            fields.f32(number);
        }
        fields.u32(areas.len() as u32);
        let largest = areas.iter().max().copied().unwrap_or(0);
        fields.f32(largest as f64 * pixel_mm2);
        fields.zeros(4 * 8);
    }
    fields.bytes(b"--->");
    bytes
}
