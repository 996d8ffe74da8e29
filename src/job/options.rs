//! What to slice and how, as users say it.

use serde::{Deserialize, Serialize};

use crate::format::Format;
use crate::plan::HeightRange;
use crate::profile::{Metric, Source};
use crate::resin::Resin;

/// Where the LDI is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Backend {
    /// The GPU, unless there is none or it is emulated in software.
    #[default]
    Auto,
    /// The GPU, or an error.
    Gpu,
    /// The CPU.
    Cpu,
}

/// How layers are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase", tag = "kind")]
pub enum Planner {
    /// The fewest layers within tolerance, or the shortest time.
    #[default]
    Optimal,
    /// Layer by layer, as thick as the profile allows; may exceed the tolerance.
    Greedy,
    /// Layer by layer, as thick as the surface at the plane suggests; may exceed the tolerance.
    Local,
    /// Layers of one thickness, whatever their error.
    Uniform {
        /// That thickness in millimetres.
        layer_mm: f64,
    },
    /// Uniform layers of the least thickness.
    Finest,
    /// Uniform layers of the greatest thickness.
    Coarsest,
}

impl Planner {
    /// The name of the planner, as in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Optimal => "optimal",
            Self::Greedy => "greedy",
            Self::Local => "local",
            Self::Uniform { .. } => "uniform",
            Self::Finest => "finest",
            Self::Coarsest => "coarsest",
        }
    }
}

/// What the optimal plan has least of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Minimize {
    /// Layers.
    #[default]
    Layers,
    /// Time: exposures and what comes with each layer.
    Time,
}

/// Whether planes go where flats and sharp changes are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Snap {
    /// Wherever layers add up and stay within tolerance beside them.
    #[default]
    Auto,
    /// Only where that is best.
    Off,
}

/// What to slice and how. All lengths are in millimetres.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(default, deny_unknown_fields)]
pub struct Options {
    /// Turn the model from how it stands in its file: a quaternion x, y, z, w of any length but 0.
    pub rotation: Option<[f64; 4]>,
    /// Scale the model evenly to this height; its own height if absent.
    pub height_mm: Option<f64>,
    /// A printer known by name: see [`crate::printer::PRINTERS`]. It gives all that is absent below.
    pub printer: Option<String>,
    /// Columns and rows of the masks, with the model in the middle; needs `pitch_mm`.
    pub pixels: Option<[u32; 2]>,
    /// Side of a pixel in x; alone, with as many pixels as cover the model.
    pub pitch_mm: Option<f64>,
    /// Side of a pixel in y; that in x if absent.
    pub pitch_y_mm: Option<f64>,
    /// Whether print files have their masks mirrored left to right, as printers want them whose screen lights from below.
    pub mirror: Option<bool>,
    /// The print file.
    pub format: Option<Format>,
    /// Pixels along the model's longer horizontal side where neither is given.
    pub rays: u32,
    /// Rays of a pixel, and parts of a layer, that its grey is averaged over: 1, 2, 4 or 8. With 1 pixels are lit or dark.
    pub antialias: u32,
    /// Least layer thickness.
    pub layer_min_mm: f64,
    /// Greatest layer thickness.
    pub layer_max_mm: f64,
    /// Greatest error of a layer in the metric's unit: mm, mm, a fraction or mm³. If absent 0.065 mm of cusp height,
    /// 0.1 mm of roughness, 0.1 of the area, or 1 mm³ and as much more as the model needs.
    pub tolerance: Option<f64>,
    /// Find the least tolerance that needs at most so many layers.
    pub max_layers: Option<usize>,
    /// Find the least tolerance that takes at most so many seconds.
    pub max_time_s: Option<f64>,
    /// Height of a bin of the profile; if absent 2 µm, or what the step or a thickness needs.
    pub bin_mm: Option<f64>,
    /// What every height is a multiple of: the printer's motor step, or a bin if absent and no printer is named.
    pub step_mm: Option<f64>,
    /// Height ranges with a layer thickness of their own.
    pub ranges: Vec<HeightRange>,
    /// Heights at which there must be a plane.
    pub planes_mm: Vec<f64>,
    /// Whether planes go where flats and sharp changes are.
    pub snap: Snap,
    /// Area in mm² from which on a flat is worth a plane.
    pub flat_area_mm2: f64,
    /// What the error measures.
    pub metric: Metric,
    /// What errors are measured on.
    pub source: Source,
    /// Whether facets count by how much they stand out: see [`crate::model::saliency`].
    pub saliency: bool,
    /// What facets count for at least, 0 to 1, where some count for less than others. The error of a facet may be as many
    /// times the tolerance as its weight goes into 1.
    pub weight_min: f64,
    /// How layers are chosen.
    pub planner: Planner,
    /// What the optimal plan has least of.
    pub minimize: Minimize,
    /// How layers are exposed and how long that takes.
    pub resin: Resin,
    /// Where the LDI is sampled.
    pub backend: Backend,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            rotation: None,
            height_mm: None,
            printer: None,
            pixels: None,
            pitch_mm: None,
            pitch_y_mm: None,
            mirror: None,
            format: None,
            rays: 2048,
            antialias: 1,
            layer_min_mm: 0.05,
            layer_max_mm: 0.15,
            tolerance: None,
            max_layers: None,
            max_time_s: None,
            bin_mm: None,
            step_mm: None,
            ranges: Vec::new(),
            planes_mm: Vec::new(),
            snap: Snap::Auto,
            flat_area_mm2: 1.0,
            metric: Metric::Cusp,
            source: Source::Exact,
            saliency: false,
            weight_min: 0.25,
            planner: Planner::Optimal,
            minimize: Minimize::Layers,
            resin: Resin::default(),
            backend: Backend::Auto,
        }
    }
}

impl Options {
    /// The same wherever rays are cast, which decides nothing.
    pub(crate) fn without_backend(&self) -> Self {
        Self {
            backend: Backend::default(),
            ..self.clone()
        }
    }
}
