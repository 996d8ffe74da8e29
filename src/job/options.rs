//! Options of slicing, as users specify them.

use serde::{Deserialize, Serialize};

use crate::arrange::{ArrangeError, Arranging};
use crate::filament::{FilamentSlicer, USUAL_NOZZLE_MM};
use crate::format::Format;
use crate::model::{ModelUnit, Pose};
use crate::plan::HeightRange;
use crate::prepare::{Hollowing, Supporting};
use crate::printer::PrinterChoice;
use crate::profile::{Metric, Source};
use crate::resin::Resin;

/// Processor that samples the LDI.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Backend {
    /// The CPU; or a hardware GPU for a million facets or more, if there are four for each ray.
    #[default]
    Auto,
    /// A GPU, even if emulated in software; fails if there is none.
    Gpu,
    /// The CPU.
    Cpu,
}

/// Method by which a GPU finds the hits of rays. Both methods find the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum GpuMethod {
    /// Filling if the device can do it.
    #[default]
    Auto,
    /// Two passes over the mesh, whatever the depth.
    Fill,
    /// Depth peeling, one pass for every two surfaces along the deepest ray. Draws without storage buffers.
    Peel,
}

/// Planner: the rule by which layers are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
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
        /// Layer thickness in millimetres.
        layer_mm: f64,
    },
    /// Uniform layers of the minimum thickness.
    Finest,
    /// Uniform layers of the maximum thickness.
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

    /// Returns true if thicknesses follow the surface.
    pub(super) fn is_adaptive(self) -> bool {
        matches!(self, Self::Optimal | Self::Greedy | Self::Local)
    }
}

/// Quantity that the optimal planner minimizes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Minimize {
    /// The number of layers.
    #[default]
    Layers,
    /// The print time: exposures, and the fixed time of each layer.
    Time,
}

/// Use of planes at flats and sharp changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Snap {
    /// Wherever the adjacent layers fill their heights and stay within tolerance.
    #[default]
    Auto,
    /// Never: the planner alone chooses the planes.
    Off,
}

/// Minimum and maximum layer thickness on resin printers if none are given, in millimetres.
pub const LAYERS_MM: [f64; 2] = [0.05, 0.15];

/// Options of slicing. All lengths are in millimetres.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(default, deny_unknown_fields)]
pub struct Options {
    /// Rotation from the pose in the file: a quaternion x, y, z, w of any length except 0.
    pub rotation: Option<[f64; 4]>,
    /// Height to which the model is scaled uniformly; not scaled if absent.
    pub height_mm: Option<f64>,
    /// The unit of the coordinates in a file that states none, as STL and OBJ; millimetres if absent. A file that states its
    /// unit ignores it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<ModelUnit>,
    /// Hollowing of the model; solid if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hollow: Option<Hollowing>,
    /// Supports of the model, which also lift it above the plate; none if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub supports: Option<Supporting>,
    /// Name of a known printer, see [`crate::printer::PRINTERS`], or the description of another. It provides pixels, pitch,
    /// mirroring, format and step where these are absent.
    pub printer: Option<PrinterChoice>,
    /// Columns and rows of the masks, with the model at the centre; needs `pitch_mm`, unless a printer provides it.
    pub pixels: Option<[u32; 2]>,
    /// Side of a pixel in x. Without `pixels` and a printer, the masks have as many pixels as cover the model.
    pub pitch_mm: Option<f64>,
    /// Side of a pixel in y; `pitch_mm` if absent.
    pub pitch_y_mm: Option<f64>,
    /// True if print files have their masks mirrored left to right, for printers whose screen lights the resin from below.
    pub mirror: Option<bool>,
    /// True if print files of supported or hollow models are written although pieces would float in the vat.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub allow_floating: bool,
    /// Format of the print file.
    pub format: Option<Format>,
    /// Pixels along the model's longer horizontal side, where neither pixels nor a pitch are known.
    pub rays: u32,
    /// Anti-aliasing level, 1, 2, 4 or 8: the number of rays per pixel, and of heights per layer, over which grey is
    /// averaged. At 1, pixels are either lit or dark.
    pub antialias: u32,
    /// The least width that compensation in x and y leaves, measured along rows and columns of pixels;
    /// narrower features are not changed. None if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min_feature_mm: Option<f64>,
    /// Minimum layer thickness. If absent, 0.05 mm, or the nozzle's limit for filament printers.
    pub layer_min_mm: Option<f64>,
    /// Maximum layer thickness. If absent, 0.15 mm, or the nozzle's limit for filament printers.
    pub layer_max_mm: Option<f64>,
    /// Thickness of the first layer, whatever its error and the range of thicknesses. The tolerance holds above it. If absent,
    /// it is chosen like the others, or, for filament printers, half the width of the nozzle.
    pub first_layer_mm: Option<f64>,
    /// Maximum thickness of layers below all models, where only supports and rafts are. If absent, as elsewhere.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub support_layer_mm: Option<f64>,
    /// Width of the nozzle of a filament printer, for formats that these have; 0.4 mm if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nozzle_mm: Option<f64>,
    /// The only layer thicknesses of the optimal planner, in place of a range; any in the range if empty.
    pub thicknesses_mm: Vec<f64>,
    /// The optimal planner chooses at most this many distinct layer thicknesses.
    pub max_thicknesses: Option<usize>,
    /// The optimal planner changes the layer thickness by at most this from one layer to the next.
    pub max_change_mm: Option<f64>,
    /// Maximum error of a layer, in the metric's unit: mm, mm, a fraction or mm³. If absent, 0.065 mm of cusp height, 0.1 mm
    /// of roughness, 0.1 of the area, or 1 mm³ of volume; if no plan keeps that volume, the smallest tolerance that a plan
    /// keeps. For filament printers, larger in proportion to the least thickness that the nozzle prints.
    pub tolerance: Option<f64>,
    /// Find the smallest tolerance that needs at most this many layers.
    pub max_layers: Option<usize>,
    /// Find the smallest tolerance that prints in at most this many seconds.
    pub max_time_s: Option<f64>,
    /// Height of a bin of the profile. If absent, 2 µm, or less if the step or a thickness needs it.
    pub bin_mm: Option<f64>,
    /// Motor step: every height is a multiple of it. If absent, the printer's, or one bin if there is no printer.
    pub step_mm: Option<f64>,
    /// Height ranges with a layer thickness of their own.
    pub ranges: Vec<HeightRange>,
    /// Heights at which there must be a plane.
    pub planes_mm: Vec<f64>,
    /// Use of planes at flats and sharp changes.
    pub snap: Snap,
    /// Minimum area, in mm², of a flat that gets a plane.
    pub flat_area_mm2: f64,
    /// Metric of the error.
    pub metric: Metric,
    /// Source of the surface on which errors are measured.
    pub source: Source,
    /// True if facets are weighted by saliency: see [`crate::model::saliency`].
    pub saliency: bool,
    /// Smallest weight of a facet, 0 to 1, if facets are weighted. A facet of weight w may exceed the tolerance by a factor
    /// of 1/w.
    pub weight_min: f64,
    /// Planner: the rule by which layers are chosen.
    pub planner: Planner,
    /// Quantity that the optimal planner minimizes.
    pub minimize: Minimize,
    /// The resin: exposures, and the time between them.
    pub resin: Resin,
    /// Processor that samples the LDI.
    pub backend: Backend,
    /// Method by which a GPU samples it.
    pub gpu_method: GpuMethod,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            rotation: None,
            height_mm: None,
            unit: None,
            hollow: None,
            supports: None,
            printer: None,
            pixels: None,
            pitch_mm: None,
            pitch_y_mm: None,
            mirror: None,
            allow_floating: false,
            format: None,
            rays: 2048,
            antialias: 1,
            min_feature_mm: None,
            layer_min_mm: None,
            layer_max_mm: None,
            first_layer_mm: None,
            support_layer_mm: None,
            nozzle_mm: None,
            thicknesses_mm: Vec::new(),
            max_thicknesses: None,
            max_change_mm: None,
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
            gpu_method: GpuMethod::Auto,
        }
    }
}

impl Options {
    /// Fills in the limits of layers that apply if none are given. The plan is the same.
    #[must_use]
    pub fn settled(&self) -> Self {
        let (nozzle_mm, first_layer_mm, [layer_min_mm, layer_max_mm]) = match self.filament() {
            None => (self.nozzle_mm, None, LAYERS_MM),
            Some(filament) => {
                let nozzle_mm = self.nozzle_mm.unwrap_or(USUAL_NOZZLE_MM);
                let layers = filament.layers(nozzle_mm);
                let range_mm = [layers.least_mm, layers.most_mm];
                (Some(nozzle_mm), Some(layers.first_mm), range_mm)
            }
        };
        Self {
            nozzle_mm,
            first_layer_mm: self.first_layer_mm.or(first_layer_mm),
            layer_min_mm: self.layer_min_mm.or(Some(layer_min_mm)),
            layer_max_mm: self.layer_max_mm.or(Some(layer_max_mm)),
            ..self.clone()
        }
    }

    /// The tolerance if none is given, in the metric's unit. Those of metrics are chosen for layers from 0.05 mm up, so they grow with
    /// the least thickness that a nozzle prints: models that have a plan on a resin printer then have one through a nozzle.
    pub fn default_tolerance(&self) -> f64 {
        let usual = self.metric.default_tolerance();
        let Some(filament) = self.filament() else {
            return usual;
        };
        let layers = filament.layers(self.nozzle_mm.unwrap_or(USUAL_NOZZLE_MM));
        (usual * layers.least_mm / LAYERS_MM[0] * 1e6).round() / 1e6
    }

    /// The slicer of filament printers that the format is for, if it is for one.
    pub(crate) fn filament(&self) -> Option<FilamentSlicer> {
        self.format.and_then(FilamentSlicer::of)
    }

    /// Options for a report: settled, and with the default backend and method, since neither affects a plan.
    pub(crate) fn as_reported(&self) -> Self {
        Self {
            backend: Backend::default(),
            gpu_method: GpuMethod::default(),
            ..self.settled()
        }
    }
}

/// Options of one model that differ from those of the job, and its number of copies.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(default, deny_unknown_fields)]
pub struct ModelOptions {
    /// Number of copies.
    pub copies: usize,
    /// Rotation from the pose in the file: a quaternion x, y, z, w of any length except 0. That of the options if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotation: Option<[f64; 4]>,
    /// Height to which the model is scaled uniformly. That of the options if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height_mm: Option<f64>,
    /// Hollowing of this model. That of the options if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hollow: Option<Hollowing>,
    /// Supports of this model. Those of the options if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub supports: Option<Supporting>,
    /// Maximum error of a layer on this model, in the metric's unit. That of the options if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Height ranges of this model with a layer thickness of their own, besides those of the options. Where ranges of several
    /// models meet, layers are within all of them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub ranges: Vec<HeightRange>,
}

impl Default for ModelOptions {
    fn default() -> Self {
        Self {
            copies: 1,
            rotation: None,
            height_mm: None,
            hollow: None,
            supports: None,
            tolerance: None,
            ranges: Vec::new(),
        }
    }
}

/// Place of a copy of a model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(deny_unknown_fields)]
pub struct Placement {
    /// The model, by its index.
    pub model: usize,
    /// The plate, from 0.
    #[serde(default)]
    pub plate: usize,
    /// Position of the middle of the box around the turned model from the middle of the plate, to the right; the nearest whole pixel
    /// counts.
    pub x_mm: f64,
    /// The same to the back.
    pub y_mm: f64,
    /// Turn about z after the rotation, counter-clockwise as seen from above: a multiple of 15.
    #[serde(default)]
    pub turn_deg: u32,
}

impl ModelOptions {
    /// The pose of the model before turns: its own, or else that of the job.
    pub fn pose_over(&self, shared: Pose) -> Pose {
        Pose {
            rotation: self.rotation.or(shared.rotation),
            height_mm: self.height_mm.or(shared.height_mm),
            ..shared
        }
    }
}

impl Placement {
    /// A single copy in the middle of its plate.
    pub const MIDDLE: Self = Self {
        model: 0,
        plate: 0,
        x_mm: 0.0,
        y_mm: 0.0,
        turn_deg: 0,
    };
}

/// Models × copies in one job. All share the options.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(default, deny_unknown_fields)]
pub struct JobOptions {
    /// Options of all models; printer, layers and resin among them.
    pub options: Options,
    /// The models, in the order in which they were loaded.
    pub models: Vec<ModelOptions>,
    /// Rules by which copies are arranged.
    pub arranging: Arranging,
    /// Place of each copy. If empty, copies are arranged.
    pub placements: Vec<Placement>,
}

/// Copies in all, of all models.
const MOST_COPIES: usize = 10_000;

impl JobOptions {
    /// One copy of one model.
    pub fn of(options: Options) -> Self {
        Self {
            options,
            ..Self::default()
        }
    }

    /// Returns true if copies on a plate may stand turned about z.
    pub(super) fn may_turn(&self) -> bool {
        self.arranging.turn_deg > 0 || !self.placements.is_empty()
    }

    /// Checks that there are not too many copies.
    pub(super) fn check_count(&self) -> Result<(), ArrangeError> {
        let of_models = self.models.iter().map(|model| model.copies);
        let copies = of_models
            .fold(0, usize::saturating_add)
            .max(self.placements.len());
        if copies > MOST_COPIES {
            let most_copies = MOST_COPIES;
            return Err(ArrangeError::TooManyCopies {
                copies,
                most_copies,
            });
        }
        Ok(())
    }

    /// Checks that there are not too many copies, and that places are those of the copies that are asked for, plate by plate.
    pub(super) fn check(&self) -> Result<(), ArrangeError> {
        self.check_count()?;
        if self.placements.is_empty() {
            return Ok(());
        }
        for (model, own) in self.models.iter().enumerate() {
            let places = self
                .placements
                .iter()
                .filter(|it| it.model == model)
                .count();
            if places != own.copies {
                return Err(ArrangeError::OtherCopies {
                    model_number: model + 1,
                    copies: own.copies,
                    places,
                });
            }
        }
        let mut plates: Vec<usize> = self.placements.iter().map(|it| it.plate).collect();
        plates.sort_unstable();
        plates.dedup();
        match (0..).zip(plates).find(|(number, plate)| number != plate) {
            Some((number, _)) => Err(ArrangeError::EmptyPlate {
                plate_number: number + 1,
            }),
            None => Ok(()),
        }
    }

    /// The options of a model by its index. If it is the only one, they say all that its own say.
    pub(crate) fn of_model(&self, model: usize) -> ModelOptions {
        self.models.get(model).cloned().unwrap_or_default()
    }

    /// The options of the only model, alone on its plate.
    pub(super) fn alone(&self) -> Options {
        let own = self.of_model(0);
        let mut options = self.options.clone();
        options.rotation = own.rotation.or(options.rotation);
        options.height_mm = own.height_mm.or(options.height_mm);
        options.hollow = own.hollow.or(options.hollow);
        options.supports = own.supports.or(options.supports);
        options.tolerance = own.tolerance.or(options.tolerance);
        options.ranges.extend(own.ranges);
        options
    }
}
