//! The arguments of commands.

use std::fs;
use std::path::{Path, PathBuf};

use clap::error::ErrorKind;
use clap::{Args, CommandFactory, ValueEnum};
use cusp_slicer::filament::USUAL_NOZZLE_MM;
use cusp_slicer::format::Format;
use cusp_slicer::job::{BIN_MM, Backend, GpuMethod, LAYERS_MM, Minimize, Options, Planner, Snap};
use cusp_slicer::orientation::shard::Shard;
use cusp_slicer::orientation::{Cost, MAX_DIRECTIONS, Quality, SearchOptions};
use cusp_slicer::plan::HeightRange;
use cusp_slicer::printer::PrinterChoice;
use cusp_slicer::profile::{Metric, Source};
use cusp_slicer::resin::Resin;

use crate::Cli;
use crate::files::{Failure, WeightsFile, in_file};
use crate::values::{
    antialias, fraction, height_range, length, not_negative, pitch, pixels, positive, rotation,
    shard, uniform_layer,
};

/// A model, and how to slice it.
#[derive(Args)]
pub struct Slicing {
    /// STL file, binary or ASCII
    pub model: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub choices: Choices,
}

/// The printer and the resin.
#[derive(Args)]
pub struct Target {
    /// Printer, which sets pixels, pitch, mirroring and format: a name of `cusp printers`, or a JSON file that describes it
    #[arg(long, value_name = "NAME|FILE.json", help_heading = "Printer")]
    pub printer: Option<String>,
    #[arg(long, value_name = "WxH", value_parser = pixels, help = pixels_help(), requires = "pitch", help_heading = "Printer")]
    pixels: Option<[u32; 2]>,
    /// Pixel size, or pixel sizes in x and y: 0.019 or 0.019x0.024
    #[arg(long, value_name = "MM", value_parser = pitch, help_heading = "Printer")]
    pitch: Option<[f64; 2]>,
    /// Anti-alias edges: average each pixel over this many rays, at as many heights within its layer
    #[arg(long, value_name = "LEVEL", default_value_t = Options::default().antialias, value_parser = antialias, help_heading = "Printer")]
    aa: u32,
    /// Mirror the masks left to right
    #[arg(long, value_name = "BOOL", help_heading = "Printer")]
    mirror: Option<bool>,
    /// Format of the print file [default: the printer's, or png]
    #[arg(long, value_enum, help_heading = "Printer")]
    format: Option<Format>,
    #[arg(long, value_name = "MM", value_parser = length, help = nozzle_help(), help_heading = "Printer")]
    nozzle: Option<f64>,
    /// Resin, as a JSON file: exposures, bottom layers, lift
    #[arg(long, value_name = "FILE", help_heading = "Printer")]
    resin: Option<PathBuf>,
}

impl Target {
    /// The options that it sets; all others have their defaults.
    pub fn options(&self) -> Result<Options, Failure> {
        Ok(Options {
            printer: self.printer.as_deref().map(printer_choice).transpose()?,
            pixels: self.pixels,
            pitch_mm: self.pitch.map(|pitch| pitch[0]),
            pitch_y_mm: self.pitch.map(|pitch| pitch[1]),
            antialias: self.aa,
            mirror: self.mirror,
            format: self.format,
            nozzle_mm: self.nozzle,
            resin: read_resin(self.resin.as_deref())?,
            ..Options::default()
        })
    }
}

/// The resin of a file, or the default.
pub fn read_resin(path: Option<&Path>) -> Result<Resin, Failure> {
    let Some(path) = path else {
        return Ok(Resin::default());
    };
    let text = fs::read_to_string(path).map_err(|error| in_file(path, &error))?;
    Ok(serde_json::from_str(&text).map_err(|error| in_file(path, &error))?)
}

/// The options of every command that plans.
#[derive(Args)]
pub struct Choices {
    /// Rotate the model by a quaternion
    #[arg(long, value_name = "X,Y,Z,W", value_parser = rotation, allow_hyphen_values = true, help_heading = "Model")]
    rotation: Option<[f64; 4]>,
    /// Scale the model uniformly to this height
    #[arg(long, value_name = "MM", value_parser = length, help_heading = "Model")]
    height: Option<f64>,
    #[command(flatten)]
    pub target: Target,
    /// Weight facets by saliency: how much they stand out
    #[arg(long, help_heading = "Weights")]
    saliency: bool,
    /// Weight facets by this file; with --saliency, by the product of both
    #[arg(long, value_name = "FILE", help_heading = "Weights")]
    weights: Option<PathBuf>,
    /// Smallest weight of a facet: a facet of weight w may exceed the tolerance by a factor of 1/w
    #[arg(
        long,
        value_name = "WEIGHT",
        default_value_t = Options::default().weight_min,
        help_heading = "Weights"
    )]
    weight_min: f64,
    #[arg(long, value_name = "MM", value_parser = length, help = limit_help("Minimum", LAYERS_MM[0]), help_heading = "Layers")]
    layer_min: Option<f64>,
    #[arg(long, value_name = "MM", value_parser = length, help = limit_help("Maximum", LAYERS_MM[1]), help_heading = "Layers")]
    layer_max: Option<f64>,
    /// Thickness of the first layer, whatever its error: the tolerance holds above it [default for filament printers: half the
    /// width of the nozzle]
    #[arg(long, value_name = "MM", value_parser = length, help_heading = "Layers")]
    first_layer: Option<f64>,
    /// The only layer thicknesses, in place of a range: each needs an exposure of its own
    #[arg(long, value_name = "MM,MM,...", value_delimiter = ',', value_parser = length, conflicts_with_all = ["layer_min", "layer_max", "max_thicknesses", "max_change"], help_heading = "Layers")]
    thicknesses: Vec<f64>,
    /// Choose at most this many distinct layer thicknesses: the best ones for the model
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), conflicts_with = "max_change", help_heading = "Layers")]
    max_thicknesses: Option<u32>,
    /// Change the layer thickness by at most this from one layer to the next
    #[arg(long, value_name = "MM", value_parser = not_negative, help_heading = "Layers")]
    max_change: Option<f64>,
    #[arg(long, value_name = "ERROR", value_parser = not_negative, help = tolerance_help(), help_heading = "Layers")]
    tolerance: Option<f64>,
    /// Find the smallest tolerance that needs at most this many layers
    #[arg(
        long,
        value_name = "K",
        conflicts_with = "tolerance",
        help_heading = "Layers"
    )]
    max_layers: Option<usize>,
    /// Find the smallest tolerance that prints in at most this many seconds
    #[arg(long, value_name = "S", value_parser = positive, conflicts_with_all = ["tolerance", "max_layers"], help_heading = "Layers")]
    max_time: Option<f64>,
    /// What the error measures
    #[arg(long, value_enum, default_value_t = Options::default().metric, help_heading = "Layers")]
    metric: Metric,
    /// Where errors are measured
    #[arg(long, value_enum, default_value_t = Options::default().source, help_heading = "Layers")]
    source: Source,
    /// How layers are chosen
    #[arg(long, value_enum, default_value = "optimal", help_heading = "Layers")]
    planner: PlannerArg,
    /// What the optimal planner minimizes
    #[arg(long, value_enum, default_value_t = Options::default().minimize, help_heading = "Layers")]
    minimize: Minimize,
    /// Layer thickness, for --planner uniform only: a length, `finest` or `coarsest`
    #[arg(
        long,
        value_name = "MM",
        value_parser = uniform_layer,
        required_if_eq("planner", "uniform"),
        help_heading = "Layers"
    )]
    layer: Option<Planner>,
    /// Limit layers between heights Z0 and Z1 to MIN to MAX mm; repeatable
    #[arg(long = "range", value_name = "Z0:Z1=MIN:MAX", value_parser = height_range, help_heading = "Layers")]
    ranges: Vec<HeightRange>,
    /// Put a plane at this height; repeatable
    #[arg(long = "plane", value_name = "MM", value_parser = length, help_heading = "Layers")]
    planes: Vec<f64>,
    /// Round heights to multiples of this: the printer's motor step
    #[arg(long, value_name = "MM", value_parser = length, help_heading = "Layers")]
    step: Option<f64>,
    /// Whether to put planes at flats and sharp changes
    #[arg(long, value_enum, default_value_t = Options::default().snap, help_heading = "Layers")]
    snap: Snap,
    #[arg(long, value_name = "MM", value_parser = length, help = bin_help(), help_heading = "Layers")]
    bin: Option<f64>,
    /// Where to sample the model
    #[arg(long, value_enum, default_value_t = Options::default().backend, help_heading = "Machine")]
    backend: Backend,
    /// How a GPU samples it
    #[arg(long, value_enum, default_value_t = Options::default().gpu_method, help_heading = "Machine")]
    gpu_method: GpuMethod,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum PlannerArg {
    /// The fewest layers within tolerance, or the shortest time
    Optimal,
    /// Layer by layer, as thick as the profile allows
    Greedy,
    /// Layer by layer, as thick as the surface at the plane suggests
    Local,
    /// Layers of one thickness, set by --layer
    Uniform,
}

impl Choices {
    /// Exits with a usage error if options of `command` contradict each other in a way that clap's
    /// attributes cannot express.
    pub fn check(&self, command: &str) {
        if self.layer.is_some() && self.planner != PlannerArg::Uniform {
            let message = "--layer is for --planner uniform only; other planners take --layer-min \
                           and --layer-max";
            let mut cli = Cli::command();
            cli.build();
            let command = cli.find_subcommand_mut(command);
            command
                .expect("the command that was parsed")
                .error(ErrorKind::ArgumentConflict, message)
                .exit();
        }
    }

    /// Reads the file of weights, if one is given.
    pub fn read_weights(&self) -> Result<Option<WeightsFile<'_>>, Failure> {
        let path = self.weights.as_deref();
        path.map(WeightsFile::read).transpose()
    }

    pub fn options(&self) -> Result<Options, Failure> {
        Ok(Options {
            rotation: self.rotation,
            height_mm: self.height,
            layer_min_mm: self.layer_min,
            layer_max_mm: self.layer_max,
            first_layer_mm: self.first_layer,
            thicknesses_mm: self.thicknesses.clone(),
            max_thicknesses: self.max_thicknesses.map(|count| count as usize),
            max_change_mm: self.max_change,
            tolerance: self.tolerance,
            max_layers: self.max_layers,
            max_time_s: self.max_time,
            bin_mm: self.bin,
            step_mm: self.step,
            ranges: self.ranges.clone(),
            planes_mm: self.planes.clone(),
            snap: self.snap,
            metric: self.metric,
            source: self.source,
            saliency: self.saliency,
            weight_min: self.weight_min,
            planner: match (self.planner, self.layer) {
                (PlannerArg::Optimal, _) => Planner::Optimal,
                (PlannerArg::Greedy, _) => Planner::Greedy,
                (PlannerArg::Local, _) => Planner::Local,
                (PlannerArg::Uniform, layer) => layer.unwrap_or(Planner::Finest),
            },
            minimize: self.minimize,
            backend: self.backend,
            gpu_method: self.gpu_method,
            ..self.target.options()?
        })
    }
}

/// A known printer, or that of a JSON file.
pub fn printer_choice(printer: &str) -> Result<PrinterChoice, Failure> {
    let path = Path::new(printer);
    if path.extension().is_none_or(|extension| extension != "json") {
        return Ok(PrinterChoice::Named(printer.to_owned()));
    }
    let text = fs::read_to_string(path).map_err(|error| in_file(path, &error))?;
    let printer = serde_json::from_str(&text).map_err(|error| in_file(path, &error))?;
    Ok(PrinterChoice::Own(printer))
}

/// The help of `--tolerance`, with the library's defaults.
fn tolerance_help() -> String {
    let defaults = Metric::value_variants().iter().map(|metric| {
        let (tolerance, unit, name) = (metric.default_tolerance(), metric.unit(), metric.name());
        let space = if unit.is_empty() { "" } else { " " };
        format!("{tolerance}{space}{unit} for {name}")
    });
    let defaults = defaults.collect::<Vec<_>>().join(", ");
    format!(
        "Largest error of a layer, in the metric's unit. A model that needs more by volume has the smallest tolerance that it \
         allows [default: {defaults}]"
    )
}

fn pixels_help() -> String {
    let rays = Options::default().rays;
    format!(
        "Columns and rows of the masks, with the model at the centre [default: the model's bounding box at {rays} pixels \
         along its longer side]"
    )
}

/// The help of `--layer-min` and `--layer-max`.
fn limit_help(which: &str, usual_mm: f64) -> String {
    format!(
        "{which} layer thickness [default: {usual_mm}; for filament printers, what the nozzle prints]"
    )
}

fn nozzle_help() -> String {
    let formats = Format::FILAMENT.map(Format::name).join(" and ");
    format!(
        "Width of a filament printer's nozzle, for the formats {formats}: it sets the limits of layers [default: {USUAL_NOZZLE_MM}]"
    )
}

fn bin_help() -> String {
    format!(
        "Height of a bin of the profile [default: {BIN_MM}, or what the step or a thickness needs]"
    )
}

/// The options of the orientation search.
#[derive(Args)]
pub struct Orienting {
    /// STL files, binary or ASCII
    #[arg(required = true, value_name = "MODEL")]
    pub models: Vec<PathBuf>,
    /// Print one JSON object per model, each on its own line
    #[arg(long)]
    pub json: bool,
    /// Directions to evaluate, spread evenly; the axes and the normals of large flats are added
    #[arg(long, value_name = "N", default_value_t = SearchOptions::default().directions as u32, value_parser = clap::value_parser!(u32).range(1..=MAX_DIRECTIONS as i64), help_heading = "Search")]
    directions: u32,
    /// Weight of the cost against the quality, 0 to 1
    #[arg(long, value_name = "A", default_value_t = SearchOptions::default().alpha, value_parser = fraction, help_heading = "Search")]
    alpha: f64,
    /// What counts as cost
    #[arg(long, value_enum, default_value_t = SearchOptions::default().cost, help_heading = "Search")]
    cost: Cost,
    /// What counts as quality; less is better
    #[arg(long, value_enum, default_value_t = SearchOptions::default().quality, help_heading = "Search")]
    quality: Quality,
    /// Write the model in the Kth best orientation to -o; for a single model
    #[arg(long, value_name = "K", requires = "output", conflicts_with = "shard", value_parser = clap::value_parser!(u32).range(1..=3), help_heading = "Search")]
    pub apply: Option<u32>,
    /// Where to write the oriented model
    #[arg(
        short,
        long,
        value_name = "FILE",
        requires = "apply",
        help_heading = "Search"
    )]
    pub output: Option<PathBuf>,
    /// Measure only shard I of N, and print a part for --merge
    #[arg(long, value_name = "I/N", value_parser = shard, help_heading = "Several machines")]
    pub shard: Option<Shard>,
    /// Measure nothing: merge these parts, made with the same models and options
    #[arg(long, value_name = "PART", num_args = 1.., conflicts_with = "shard", help_heading = "Several machines")]
    pub merge: Vec<PathBuf>,
    #[command(flatten)]
    pub choices: Choices,
}

impl Orienting {
    pub fn search(&self) -> SearchOptions {
        SearchOptions {
            directions: self.directions as usize,
            alpha: self.alpha,
            cost: self.cost,
            quality: self.quality,
        }
    }
}
