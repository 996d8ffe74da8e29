//! Facts that forms and documents need before anything is sliced: defaults, bounds, formats, and the options that rays depend on.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::arrange::Arranging;
use crate::calibration::Calibration;
use crate::filament::{FilamentSlicer, LayerRule, NOZZLES_MM, USUAL_NOZZLE_MM};
use crate::format::Format;
use crate::inspect::Limits;
use crate::job::Options;
use crate::prepare::{
    AutoDrain, LEAST_GAP_MM, LEAST_WALL_MM, MOST_SUPPORT_MM, SupportProfile, SupportStrength,
};
use crate::profile::Metric;
use crate::quantity::Quantity;

/// The options that rays depend on. A change of any other repeats the plan or the print file alone.
const RAY_OPTIONS: [&str; 13] = [
    "rotation",
    "height_mm",
    "unit",
    "hollow",
    "supports",
    "printer",
    "pixels",
    "pitch_mm",
    "pitch_y_mm",
    "rays",
    "antialias",
    "backend",
    "gpu_method",
];

/// Decisions of the core that forms repeat: the build writes them to `www/pkg/facts.json`. Lengths are in millimetres.
#[derive(Debug, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Facts {
    /// The default options, with the limits of layers that apply if none are given.
    #[cfg_attr(
        target_arch = "wasm32",
        tsify(
            type = "Required<Options> & { layer_min_mm: number; layer_max_mm: number; resin: Required<Resin> }"
        )
    )]
    pub defaults: Options,
    /// Default rules by which copies are arranged.
    #[cfg_attr(target_arch = "wasm32", tsify(type = "Required<Arranging>"))]
    pub arranging: Arranging,
    /// Default thresholds of a check.
    #[cfg_attr(target_arch = "wasm32", tsify(type = "Required<Limits>"))]
    pub limits: Limits,
    /// The metrics, in the order of lists.
    pub metrics: [MetricFacts; Metric::ALL.len()],
    /// The print formats, in the order of lists.
    pub formats: Vec<FormatFacts>,
    /// Width of most nozzles of filament printers.
    pub nozzle_mm: f64,
    /// Usual values of numbers that people type.
    pub usual: Usual,
    /// Sizes of supports by their strength.
    pub supports: StrengthProfiles,
    /// Least values of the sizes of supports, by their names.
    #[cfg_attr(
        target_arch = "wasm32",
        tsify(type = "Record<Exclude<keyof SupportProfile, 'raft'>, number>")
    )]
    pub support_least: BTreeMap<&'static str, f64>,
    /// The largest size of any part of supports.
    pub support_most_mm: f64,
    /// Least distance between a raft and the model.
    pub raft_gap_mm: f64,
    /// Default diameter of drain holes.
    pub drain_mm: f64,
    /// Numbers of layers of the bridges that measure print-through.
    pub bridges: [u8; Calibration::BRIDGES.len()],
    /// Usual thicknesses of their layers.
    pub bridges_mm: [f64; 2],
    /// The options that rays depend on.
    #[cfg_attr(target_arch = "wasm32", tsify(type = "(keyof Options)[]"))]
    pub ray_options: [&'static str; RAY_OPTIONS.len()],
}

/// Usual values of numbers that people type, from and to, by option. A number beyond them is probably in another unit: someone
/// who types layers of 50 mm means 50 µm. Except for walls, nozzles, overcure and retained doses, the core accepts more.
#[derive(Debug, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[expect(missing_docs, reason = "the fields are the options")]
pub struct Usual {
    pub bottom_layers: [f64; 2],
    pub copies: [f64; 2],
    pub exposure_s: [f64; 2],
    pub height_mm: [f64; 2],
    pub layer_mm: [f64; 2],
    pub nozzle_mm: [f64; 2],
    pub overcure_mm: [f64; 2],
    pub penetration_mm: [f64; 2],
    pub retained: [f64; 2],
    pub step_mm: [f64; 2],
    pub wall_mm: [f64; 2],
}

impl Default for Usual {
    fn default() -> Self {
        Self {
            bottom_layers: [0.0, 100.0],
            copies: [1.0, 1000.0],
            exposure_s: [0.1, 600.0],
            height_mm: [0.1, 1000.0],
            layer_mm: [0.001, 1.0],
            nozzle_mm: NOZZLES_MM,
            overcure_mm: Quantity::Overcure.range(),
            penetration_mm: [0.01, 2.0],
            retained: Quantity::RetainedDose.range(),
            step_mm: [0.001, 1.0],
            wall_mm: [LEAST_WALL_MM, 50.0],
        }
    }
}

/// A metric.
#[derive(Debug, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct MetricFacts {
    /// Its name, as in options.
    pub name: Metric,
    /// Default tolerance on resin printers, in the metric's unit. For volume, a job may need more.
    pub tolerance: f64,
    /// Usual tolerances, from and to, in the same unit.
    pub tolerances: [f64; 2],
    /// Greatest density of the profile; absent if it depends on the model.
    pub greatest_density: Option<f32>,
}

/// Sizes of supports for each strength.
#[derive(Debug, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[expect(missing_docs, reason = "the fields are the strengths")]
pub struct StrengthProfiles {
    #[cfg_attr(target_arch = "wasm32", tsify(type = "Required<SupportProfile>"))]
    pub light: SupportProfile,
    #[cfg_attr(target_arch = "wasm32", tsify(type = "Required<SupportProfile>"))]
    pub medium: SupportProfile,
    #[cfg_attr(target_arch = "wasm32", tsify(type = "Required<SupportProfile>"))]
    pub heavy: SupportProfile,
}

/// A print format.
#[derive(Debug, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct FormatFacts {
    /// Its name, as in options.
    pub name: Format,
    /// Limits of layers, if it is for a slicer of filament printers.
    pub layer_rule: Option<LayerRule>,
}

impl Default for Facts {
    /// The facts of this version.
    fn default() -> Self {
        let format = |name| FormatFacts {
            name,
            layer_rule: FilamentSlicer::of(name).map(FilamentSlicer::rule),
        };
        let metric = |name: Metric| MetricFacts {
            name,
            tolerance: name.default_tolerance(),
            tolerances: name.tolerances(),
            greatest_density: name.greatest_density(),
        };
        let least = SupportProfile::LEAST.iter();
        let least = least.map(|&(option, _, least)| {
            let name = option.rsplit('.').next().unwrap_or(option);
            (name, least)
        });
        Self {
            defaults: Options::default().settled(),
            arranging: Arranging::default(),
            limits: Limits::default(),
            metrics: Metric::ALL.map(metric),
            formats: Format::all().map(format).collect(),
            nozzle_mm: USUAL_NOZZLE_MM,
            usual: Usual::default(),
            supports: StrengthProfiles {
                light: SupportStrength::Light.profile(),
                medium: SupportStrength::Medium.profile(),
                heavy: SupportStrength::Heavy.profile(),
            },
            support_least: least.collect(),
            support_most_mm: MOST_SUPPORT_MM,
            raft_gap_mm: LEAST_GAP_MM,
            drain_mm: AutoDrain::default().diameter_mm,
            bridges: Calibration::BRIDGES,
            bridges_mm: Calibration::BRIDGES_MM,
            ray_options: RAY_OPTIONS,
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Map, Value, json};

    use super::RAY_OPTIONS;
    use crate::job::Options;

    /// Another value of every option.
    fn changes() -> Map<String, Value> {
        let changes = json!({
            "rotation": [0.0, 0.6, 0.0, 0.8],
            "height_mm": 20.0,
            "unit": "inch",
            "hollow": { "wall_mm": 2.5 },
            "supports": { "strength": "heavy" },
            "printer": "mars-4-ultra",
            "pixels": [1000, 900],
            "pitch_mm": 0.07,
            "pitch_y_mm": 0.06,
            "mirror": true,
            "allow_floating": true,
            "format": "goo",
            "rays": 512,
            "antialias": 4,
            "min_feature_mm": 0.3,
            "layer_min_mm": 0.04,
            "layer_max_mm": 0.12,
            "first_layer_mm": 0.06,
            "support_layer_mm": 0.14,
            "nozzle_mm": 0.6,
            "thicknesses_mm": [0.05, 0.1],
            "max_thicknesses": 3,
            "max_change_mm": 0.01,
            "tolerance": 0.05,
            "max_layers": 300,
            "max_time_s": 3000.0,
            "bin_mm": 0.001,
            "step_mm": 0.01,
            "ranges": [{ "from_mm": 1.0, "to_mm": 2.0, "layer_min_mm": 0.05, "layer_max_mm": 0.1 }],
            "planes_mm": [3.0],
            "snap": "off",
            "flat_area_mm2": 3.0,
            "metric": "deviation",
            "source": "sampled",
            "saliency": true,
            "weight_min": 0.5,
            "planner": { "kind": "greedy" },
            "minimize": "time",
            "resin": { "exposure_s": 4.0 },
            "backend": "cpu",
            "gpu_method": "peel",
        });
        serde_json::from_value(changes).unwrap()
    }

    #[test]
    fn rays_depend_on_the_options_that_are_said_and_on_no_others() {
        // On a plate of pixels, around a model, and for a slicer of filament printers.
        let bases = [
            json!({}),
            json!({ "pixels": [800, 600], "pitch_mm": 0.05 }),
            json!({ "format": "prusa-3mf" }),
        ];
        for (name, value) in changes() {
            let moves = bases.iter().any(|base| {
                let mut options = base.clone();
                let before: Options = serde_json::from_value(options.clone()).unwrap();
                options[&name] = value.clone();
                let after: Options = serde_json::from_value(options).unwrap();
                assert_ne!(before, after, "{name}");
                match (before.resolve(), after.resolve()) {
                    (Ok(before), Ok(after)) => before.sampling != after.sampling,
                    _ => false,
                }
            });
            assert_eq!(moves, RAY_OPTIONS.contains(&&*name), "{name}");
        }
    }

    #[test]
    fn every_option_is_changed_above() {
        let Value::Object(defaults) = json!(Options::default()) else {
            panic!("options are an object");
        };
        let changes = changes();
        for name in defaults.keys().map(String::as_str).chain(RAY_OPTIONS) {
            assert!(changes.contains_key(name), "{name}");
        }
    }
}
