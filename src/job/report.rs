//! The data that leaves the library: reports on plans and meshes, with units in the names of fields.

use serde::Serialize;
use serde_json::value::to_raw_value;
#[cfg(target_arch = "wasm32")]
use tsify::Tsify;

use super::stages::parts::{Filament, Output};
use super::stages::planned::Planned;
use super::stages::prepared::{Hollowed, Supported};
use super::{Minimize, ModelOptions, Options, Placement};
use crate::archive::Manifest;
use crate::filament::FilamentReport;
use crate::format::Format;
use crate::ldi::Solid;
use crate::mask::{PrintThroughReport, black_layers};
use crate::model::{Mesh, ModelFile, ModelUnit};
use crate::orientation;
use crate::plan::tradeoff::TradeoffPoint;
use crate::price::PriceItem;
use crate::printer::{PRINTERS, Printer, Refusal, VariableLayers, are_equal, check_thicknesses};
use crate::profile::{Metric, Source};
use crate::resin::Resin;
use crate::warning::{UnitReading, Warning};

/// Smallest and largest coordinates.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(Tsify))]
pub struct BoundsReport {
    /// Smallest x, y and z in millimetres.
    pub min: [f64; 3],
    /// Largest x, y and z in millimetres.
    pub max: [f64; 3],
}

/// A mesh in the frame of its file.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(Tsify), tsify(missing_as_null))]
pub struct MeshInfo {
    /// The unit that the file states, from which lengths were converted; without one they are the file's own numbers.
    pub unit: Option<ModelUnit>,
    /// Number of facets with an area.
    pub facets: usize,
    /// Number of facets of the file without an area.
    pub degenerate_facets: usize,
    /// Number of distinct vertices, including the centroids of caps over holes.
    pub vertices: usize,
    /// The bounding box of the model.
    pub bounds_mm: BoundsReport,
    /// Extent in x, y and z.
    pub size_mm: [f64; 3],
    /// Enclosed volume, with holes closed.
    pub volume_mm3: f64,
    /// True if the mesh is closed and consistently oriented.
    pub closed: bool,
    /// Number of edges that are open or inconsistently oriented.
    pub open_edges: usize,
    /// Number of holes that were closed by caps.
    pub holes: usize,
    /// Number of facets that were turned over, as they faced another way than their neighbours or their body.
    pub turned_facets: usize,
    /// Peak memory of an orientation search on one thread, in bytes.
    pub search_bytes: usize,
    /// Warnings.
    pub warnings: Vec<Warning>,
}

impl MeshInfo {
    /// Describes a mesh.
    pub fn of(mesh: &Mesh) -> Self {
        let bounds = mesh.bounds();
        Self {
            unit: None,
            facets: mesh.surface_facets,
            degenerate_facets: mesh.degenerate_facets,
            vertices: mesh.vertices.len(),
            bounds_mm: BoundsReport {
                min: bounds.min.to_array(),
                max: bounds.max.to_array(),
            },
            size_mm: bounds.size().to_array(),
            volume_mm3: mesh.volume_mm3(),
            closed: mesh.is_closed(),
            open_edges: mesh.open_edges,
            holes: mesh.holes,
            turned_facets: mesh.turned_facets,
            search_bytes: orientation::search_bytes(mesh),
            warnings: mesh_warnings(mesh),
        }
    }
}

/// The warnings about a mesh.
pub fn mesh_warnings(mesh: &Mesh) -> Vec<Warning> {
    let mut warnings = Vec::new();
    if mesh.degenerate_facets > 0 {
        warnings.push(Warning::DegenerateFacets {
            facets: mesh.degenerate_facets,
        });
    }
    if mesh.was_inside_out {
        warnings.push(Warning::InsideOut);
    }
    if mesh.turned_facets > 0 {
        warnings.push(Warning::TurnedFacets {
            facets: mesh.turned_facets,
        });
    }
    if mesh.contradictory_edges > 0 {
        warnings.push(Warning::Unorientable {
            edges: mesh.contradictory_edges,
        });
    }
    if !mesh.is_closed() {
        warnings.push(Warning::OpenMesh {
            open_edges: mesh.open_edges,
            holes: mesh.holes,
        });
    }
    warnings
}

/// Units that a file may be in that states none, the likeliest first.
const LIKELY_UNITS: [ModelUnit; 4] = [
    ModelUnit::Inch,
    ModelUnit::Centimeter,
    ModelUnit::Meter,
    ModelUnit::Micron,
];

/// The warning about a model that is under a millimetre, or wider than the widest plate that is known, if its coordinates are in
/// millimetres.
pub(super) fn odd_size(mesh: &Mesh) -> Option<Warning> {
    let side = mesh.bounds().size().max_element();
    let plates = PRINTERS.iter().flat_map(|printer| printer.volume_mm);
    let usual_mm = 1.0..=plates.fold(1.0, f64::max);
    if usual_mm.contains(&side) {
        return None;
    }
    let rounded = |mm: f64| (mm * 1e3).round() / 1e3;
    let readings = LIKELY_UNITS.map(|unit| UnitReading {
        unit,
        size_mm: rounded(side * unit.mm()),
    });
    let readings = readings.into_iter();
    Some(Warning::OddSize {
        size_mm: rounded(side),
        readings: readings
            .filter(|it| usual_mm.contains(&it.size_mm))
            .collect(),
    })
}

/// The schema version of reports. It increases when a name or a meaning changes, not when something is added.
pub const SCHEMA: u32 = 3;

/// Keys of a report that depend on the machine, not on the plan.
pub const OF_THE_MACHINE: [&str; 4] = ["timings_ms", "backend", "adapter", "gpu_method"];

/// The pixels of the masks.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(Tsify))]
pub struct MaskReport {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Side of a pixel in x.
    pub pitch_mm: f64,
    /// Side of a pixel in y.
    pub pitch_y_mm: f64,
    /// Level of anti-aliasing; 1 means none.
    pub antialias: u32,
    /// True if print files have the masks mirrored left to right.
    pub is_mirrored: bool,
}

/// The format of a print file.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(Tsify))]
pub struct PrintFileReport {
    /// The requested format, or the printer's.
    pub format: Format,
    /// File extension, without a dot: the one that the printer expects if it reads the format, otherwise the format's own.
    pub extension: String,
    /// Its media type.
    pub media_type: String,
    /// True if a printer is named and reads the format without a converter.
    pub is_read_by_printer: bool,
    /// Settings that must match in the slicer, if the format is for filament printers.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub filament: Option<FilamentReport>,
}

impl PrintFileReport {
    /// Describes a file of `format` for a printer.
    pub fn new(format: Format, printer: Option<&Printer>) -> Self {
        let reader = printer.filter(|printer| printer.reads_format && printer.format == format);
        let own = reader.and_then(|printer| printer.reads.first().cloned());
        Self {
            format,
            extension: own.unwrap_or_else(|| format.extension().to_owned()),
            media_type: format.media_type().to_owned(),
            is_read_by_printer: reader.is_some(),
            filament: None,
        }
    }

    fn of(output: &Output) -> Self {
        let filament = output.filament.map(|it| {
            let Filament {
                slicer,
                nozzle_mm,
                first_layer_mm,
            } = it;
            FilamentReport::new(slicer, nozzle_mm, first_layer_mm)
        });
        Self {
            filament,
            ..Self::new(output.format, output.printer.as_deref())
        }
    }
}

impl Options {
    /// Describes the print files that a plan with these options gives, whatever the model.
    ///
    /// # Errors
    /// [`Error::Options`], [`Error::Plan`].
    ///
    /// [`Error::Options`]: super::Error::Options
    /// [`Error::Plan`]: super::Error::Plan
    pub fn print_file(&self) -> Result<PrintFileReport, super::Error> {
        let Output {
            format, printer, ..
        } = self.resolve()?.output;
        Ok(PrintFileReport::new(format, printer.as_deref()))
    }
}

/// Uniform layers within the same range of thicknesses, for comparison. A saving is fair against `fewest` or `quickest`: of every
/// thickness that the motor can make, the best that keeps the tolerance, the top of the model included.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(Tsify), tsify(missing_as_null))]
pub struct UniformReport {
    /// Layers of the minimum thickness.
    pub finest: PlannerReport,
    /// Layers of the maximum thickness.
    pub coarsest: PlannerReport,
    /// The fewest uniform layers within tolerance; absent if no thickness keeps it.
    pub fewest: Option<BestUniform>,
    /// The quickest uniform layers within tolerance; absent if no thickness keeps it.
    pub quickest: Option<BestUniform>,
    /// True if an adaptive plan saves less than 3 % against the best of these, in layers or in time, whichever the
    /// options minimize.
    pub is_enough: bool,
}

impl UniformReport {
    /// The best uniform layers within tolerance, in layers or in time, whichever the options minimize.
    pub fn best(&self, minimize: Minimize) -> Option<&BestUniform> {
        match minimize {
            Minimize::Layers => self.fewest.as_ref(),
            Minimize::Time => self.quickest.as_ref(),
        }
    }
}

/// The best uniform layers within tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(Tsify))]
pub struct BestUniform {
    /// Thickness of each in millimetres.
    pub layer_mm: f64,
    /// Number of layers.
    pub layers: usize,
    /// The largest error of a layer, in the metric's unit, from the source that plans are made from.
    pub max_error: f64,
    /// Print time.
    pub print_time_s: f64,
}

/// The result of a planner.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(Tsify))]
pub struct PlannerReport {
    /// Name of the planner.
    pub planner: String,
    /// Number of layers.
    pub layers: usize,
    /// The largest exact error of a layer, in the metric's unit.
    pub max_error: f64,
    /// Print time.
    pub print_time_s: f64,
}

/// Planners side by side, as in table 3.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(Tsify))]
pub struct Comparison {
    /// Number of facets of the model.
    pub facets: usize,
    /// Height of the model.
    pub height_mm: f64,
    /// The metric of the errors.
    pub metric: Metric,
    /// The unit of the errors.
    pub unit: String,
    /// One row per planner, from the coarsest to the finest. A thickness rule has a row of its own in addition to the
    /// optimal planner.
    pub rows: Vec<PlannerReport>,
}

/// Two plans with as many layers: the one with the least sum of volume deviations (Alexa, Hildebrand and Lefebvre, Optimal Discrete
/// Slicing, 2017), and the one with the smallest maximum error.
#[cfg(not(target_arch = "wasm32"))]
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct FrontPoint {
    /// Number of layers of both.
    pub layers: usize,
    /// The plan with the least sum.
    pub least_sum: SumAndMaximum,
    /// The plan with the smallest maximum error.
    pub least_maximum: SumAndMaximum,
}

/// The two errors of a plan that [`FrontPoint`] compares.
#[cfg(not(target_arch = "wasm32"))]
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct SumAndMaximum {
    /// The sum of the volume deviations of all layers (eq. 20), without weights.
    pub volume_mm3: f64,
    /// The largest error of a layer, in the unit of the comparison's metric.
    pub max_error: f64,
}

/// The trade-off curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(Tsify))]
pub struct Tradeoff {
    /// Its points, from the smallest tolerance to the largest.
    pub points: Vec<TradeoffPoint>,
}

/// Wall-clock times of the stages, in milliseconds; 0 for a stage whose result was reused.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(Tsify))]
pub struct Timings {
    /// Reading the STL, building the mesh and placing it.
    pub load: f64,
    /// Sampling the layered depth image.
    pub ldi: f64,
    /// Making the profile.
    pub profile: f64,
    /// Planning.
    pub plan: f64,
    /// Making and writing the masks.
    pub masks: f64,
    /// The sum of these.
    pub total: f64,
}

impl Timings {
    /// Updates `total`.
    pub fn sum_up(&mut self) {
        self.total = self.load + self.ldi + self.profile + self.plan + self.masks;
    }
}

/// The plan of a model in a pose, made without sampling: fast enough to follow a rotation live.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(Tsify))]
pub struct Preview {
    /// Number of layers.
    pub layers: usize,
    /// Extent of the model in x, y and z.
    pub size_mm: [f64; 3],
    /// Distance by which supports lift it above the plate.
    pub lift_mm: f64,
    /// Heights of layer boundaries, from 0 upward: one more than there are layers.
    pub z_mm: Vec<f64>,
    /// Thickness of each layer.
    pub thickness_mm: Vec<f64>,
    /// Metric of the error.
    pub metric: Metric,
    /// The largest error of a layer, in the metric's unit.
    pub max_error: f64,
    /// Print time.
    pub print_time_s: f64,
    /// Height of a bin of the profile.
    pub bin_mm: f64,
    /// Minimum and maximum layer thickness of a plan, in whole motor steps if there is one.
    pub layer_range_mm: [f64; 2],
}

/// The plan of a plate and how it was made: what `--json` prints for each plate, and the page shows.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(Tsify), tsify(missing_as_null))]
pub struct Report {
    /// The schema version of this object: [`SCHEMA`].
    pub schema: u32,
    /// The options of the job. With these and those of its models, the same files give the same plan again.
    pub options: Options,
    /// The plate, from 0.
    pub plate: usize,
    /// Number of plates of the job.
    pub plate_count: usize,
    /// The models on this plate.
    pub models: Vec<ModelReport>,
    /// Place of each copy. A single copy without a place stands in the middle.
    pub placements: Vec<Placement>,
    /// Number of layers.
    pub layers: usize,
    /// Height of the model.
    pub height_mm: f64,
    /// Heights of layer boundaries, from 0 upward: one more than there are layers.
    pub z_mm: Vec<f64>,
    /// Thickness of each layer.
    pub thickness_mm: Vec<f64>,
    /// Exposure of each layer.
    pub exposure_s: Vec<f64>,
    /// Time between the exposures of two layers.
    pub overhead_s: f64,
    /// The resin, which determines both.
    pub resin: Resin,
    /// Volume of resin in all copies.
    pub resin_ml: f64,
    /// The printer, if one was named.
    pub printer: Option<String>,
    /// Heights of the planes at flats and sharp changes.
    pub snapped_mm: Vec<f64>,
    /// Errors of surfaces that face down after cure below layers, if the resin states its print-through and memory is not bounded.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub print_through: Option<PrintThroughReport>,
    /// Metric of the error.
    pub metric: Metric,
    /// The unit of tolerance and errors: `mm`, `mm³`, or empty for a fraction.
    pub unit: String,
    /// The source of the errors that the plan was made with.
    pub source: Source,
    /// The planner that ran.
    pub planner: String,
    /// The requested or found tolerance, in the metric's unit.
    pub tolerance: f64,
    /// The largest error of a layer under the exact profile, in the metric's unit; weighted if facets have weights.
    pub max_error: f64,
    /// The same without weights and without the cap of the area deviation.
    pub true_error: f64,
    /// The largest error of a layer under the sampled profile, in the metric's unit; null for a plan that was not made from it.
    pub sampled_error: Option<f64>,
    /// The largest cusp height of a layer under the exact profile, whatever the metric.
    pub max_error_mm: f64,
    /// The largest distance from the print to the model, whatever the metric: see `deviation`.
    pub max_deviation_mm: f64,
    /// Print time.
    pub print_time_s: f64,
    /// Processor that sampled the LDI, `cpu` or `gpu`.
    pub backend: String,
    /// The GPU, if one was used.
    pub adapter: Option<String>,
    /// Method by which that GPU sampled, `fill` or `peel`.
    pub gpu_method: Option<String>,
    /// Number of bins of the profile.
    pub bins: usize,
    /// Height of a bin.
    pub bin_mm: f64,
    /// Minimum and maximum layer thickness of a plan, in whole motor steps if there is one.
    pub layer_range_mm: [f64; 2],
    /// Uniform layers for comparison.
    pub uniform: UniformReport,
    /// The pixels of the masks.
    pub mask: MaskReport,
    /// The format in which the plan is exported.
    pub print_file: PrintFileReport,
    /// Warnings about the plate. Those about a model are with the model.
    pub warnings: Vec<Warning>,
    /// Times of the stages.
    pub timings_ms: Timings,
}

impl Report {
    /// The warnings about the models, then those about the plate.
    pub fn all_warnings(&self) -> Vec<Warning> {
        let of_models = self.models.iter().flat_map(|model| &model.warnings);
        of_models.chain(&self.warnings).cloned().collect()
    }

    /// The report without timings and backend, which depend on the machine: the same plan gives the same manifest
    /// everywhere.
    ///
    /// # Errors
    /// [`serde_json::Error`], which no report causes.
    pub(crate) fn manifest(&self) -> Result<Manifest, serde_json::Error> {
        let mut manifest: Manifest = serde_json::from_str(&serde_json::to_string(self)?)?;
        let lasting = |warnings: &[Warning]| -> Vec<Warning> {
            let warnings = warnings.iter();
            let warnings = warnings.filter(|warning| !warning.is_of_the_machine());
            warnings.cloned().collect()
        };
        let models = self.models.iter().map(|model| ModelReport {
            warnings: lasting(&model.warnings),
            ..model.clone()
        });
        let models = to_raw_value(&models.collect::<Vec<_>>())?;
        manifest.insert("models".to_owned(), models);
        let warnings = to_raw_value(&lasting(&self.warnings))?;
        manifest.insert("warnings".to_owned(), warnings);
        manifest.retain(|key, _| !OF_THE_MACHINE.contains(&&**key));
        Ok(manifest)
    }
}

/// The plate of a plan, besides its stages.
pub(super) struct Origin {
    pub options: Options,
    pub plate: usize,
    pub plate_count: usize,
    pub models: Vec<ModelReport>,
    pub placements: Vec<Placement>,
}

/// The report of a plan that is exported as `output`.
pub(super) fn report_of(
    planned: &Planned,
    output: &Output,
    origin: Origin,
    timings_ms: Timings,
) -> Report {
    let Planned {
        models,
        layering,
        plan,
        print_through,
        findings,
        ..
    } = planned;
    let sampled = &planned.first().of;
    let Origin {
        options,
        plate,
        plate_count,
        models: on_plate,
        placements,
    } = origin;
    let mut warnings = findings.warnings.clone();
    let solids = models
        .iter()
        .map(|model| (&model.sampled().survey.solid, model.copies));
    let solid = Solid::of_copies(solids);
    let black = black_layers(&solid, plan, sampled.sampling.samples);
    if let Some(&lowest) = black.first() {
        warnings.push(Warning::BlackLayers {
            layers: black.len(),
            from_mm: plan.z_mm()[lowest],
        });
    }
    let thickness_mm = plan.thickness_mm();
    warnings.extend(thickness_warning(planned, output, &thickness_mm));
    match output.filament {
        Some(Filament { slicer, .. }) if !slicer.is_tried() => {
            warnings.push(Warning::UntriedSlicer {
                slicers: slicer.names().to_vec(),
            });
        }
        Some(_) => {}
        None => warnings.extend(Warning::of_exposures(&layering.resin, &thickness_mm)),
    }
    Report {
        schema: SCHEMA,
        options,
        plate,
        plate_count,
        models: on_plate,
        placements,
        layers: plan.layers(),
        height_mm: models
            .iter()
            .map(|model| model.sampled().height_mm)
            .fold(0.0, f64::max),
        z_mm: plan.z_mm(),
        exposure_s: layering.resin.exposures_s(&thickness_mm),
        overhead_s: layering.resin.overhead_s(),
        resin: layering.resin.clone(),
        thickness_mm,
        resin_ml: solid.volume_mm3 / 1e3,
        printer: output.printer.as_ref().map(|printer| printer.name.clone()),
        snapped_mm: findings.snapped_mm.clone(),
        print_through: print_through.clone(),
        metric: layering.metric,
        unit: layering.metric.unit().to_owned(),
        source: layering.source,
        planner: layering.planner.name().to_owned(),
        tolerance: findings.tolerance,
        max_error: findings.max_error,
        sampled_error: findings.sampled_error,
        true_error: findings.true_error,
        max_error_mm: findings.max_error_mm,
        max_deviation_mm: findings.max_deviation_mm,
        print_time_s: findings.print_time_s,
        backend: sampled.gpu.as_ref().map_or("cpu", |_| "gpu").to_owned(),
        adapter: sampled.gpu.as_ref().map(|gpu| gpu.name.clone()),
        gpu_method: sampled.gpu.as_ref().map(|gpu| gpu.method.name().to_owned()),
        bins: plan.bins.count,
        bin_mm: plan.bins.size_mm,
        layer_range_mm: layering.layer_range_mm(plan.bins),
        uniform: findings.uniform.clone(),
        mask: MaskReport {
            width: sampled.grid.width,
            height: sampled.grid.height,
            pitch_mm: sampled.grid.pitch_mm,
            pitch_y_mm: sampled.grid.pitch_y_mm,
            antialias: sampled.sampling.samples.sublayers,
            is_mirrored: output.is_mirrored,
        },
        print_file: PrintFileReport::of(output),
        warnings,
        timings_ms,
    }
}

/// The warning about layers of several thicknesses on this printer, or in its file.
fn thickness_warning(planned: &Planned, output: &Output, thickness_mm: &[f64]) -> Option<Warning> {
    let printer = output.printer.as_deref();
    let taker = match check_thicknesses(output.format, printer, thickness_mm) {
        Err(Refusal::Printer(printer)) => printer.model.clone(),
        Err(Refusal::Format(format)) => format.name().to_owned(),
        Ok(()) => {
            let untried = printer.filter(|printer| {
                printer.format == output.format
                    && printer.variable_layers == VariableLayers::Untried
                    && !are_equal(thickness_mm)
            });
            return untried.map(|printer| Warning::UntriedThicknesses {
                model: printer.model.clone(),
            });
        }
    };
    Some(Warning::OneThickness {
        taker,
        best: planned.best_uniform(),
    })
}

/// A model on a plate.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify), tsify(missing_as_null))]
pub struct ModelReport {
    /// The model, by its index in the job.
    pub model: usize,
    /// Its file.
    pub file: ModelFile,
    /// Options that differ from those of the job, with its copies on this plate.
    pub options: ModelOptions,
    /// CRC-32 of the user's weights of its facets, if any.
    pub weights_crc32: Option<u32>,
    /// Copies on this plate.
    pub copies: usize,
    /// Extent of the model in x, y and z, before turns about z.
    pub size_mm: [f64; 3],
    /// Number of facets of its surface.
    pub facets: usize,
    /// Number of hits of rays with it, in all turns in which it stands.
    pub hits: usize,
    /// Layers that reach it.
    pub layers: usize,
    /// Volume of resin in a copy.
    pub resin_ml: f64,
    /// A copy's share of the print time. The time of each layer is divided among the copies that it reaches, in proportion to their
    /// shadows on the plate.
    pub print_time_s: f64,
    /// The largest exact error of a layer on this model, in the metric's unit.
    pub max_error: f64,
    /// The largest distance from the print to this model.
    pub max_deviation_mm: f64,
    /// The void that was left out of a copy, if it was hollowed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hollowed: Option<Hollowed>,
    /// Supports of a copy, if any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub supported: Option<Supported>,
    /// Warnings about this model.
    pub warnings: Vec<Warning>,
}

/// Plates of a job, with their time and resin in all.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct JobReport {
    /// The schema version of this object: [`crate::job::SCHEMA`].
    pub schema: u32,
    /// Print time of all plates, one after the other.
    pub print_time_s: f64,
    /// Volume of resin in all copies.
    pub resin_ml: f64,
    /// The report of each plate.
    pub plates: Vec<Report>,
}

impl Report {
    /// Items of a price for `copies` prints of this plate: each copy has its share of the time.
    pub fn price_items(&self, copies: usize) -> Vec<PriceItem> {
        let models = self.models.iter().map(|model| PriceItem {
            copies: model.copies.saturating_mul(copies),
            resin_ml: model.resin_ml,
            support_ml: model.supported.as_ref().map(|it| it.support_ml),
            print_time_s: model.print_time_s,
        });
        models.collect()
    }
}

impl JobReport {
    /// Items of a price for all copies on all plates.
    pub fn price_items(&self) -> Vec<PriceItem> {
        let plates = self.plates.iter();
        plates.flat_map(|plate| plate.price_items(1)).collect()
    }
}
