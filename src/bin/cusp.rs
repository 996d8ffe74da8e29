//! The command line: the only file with a file system, arguments and a terminal.

use std::fmt::Write as _;
use std::fs;
use std::io::{self, BufWriter, IsTerminal, Write as _};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::error::ErrorKind;
use clap::{Args, CommandFactory, Parser, Subcommand, ValueEnum};
use cusp_slicer::archive::Format;
use cusp_slicer::exposure::Resin;
use cusp_slicer::mask::LEVELS;
use cusp_slicer::options::{Backend, Minimize, Options, Planner, Snap};
use cusp_slicer::pipeline::{Slicer, Stage, StageProgress};
use cusp_slicer::plan::HeightRange;
use cusp_slicer::printer::PRINTERS;
use cusp_slicer::profile::{Metric, Source};
use cusp_slicer::report::{MeshInfo, Report, Warning};
use cusp_slicer::verify::Claim;
use cusp_slicer::weights;
use indicatif::{ProgressBar, ProgressFinish, ProgressStyle};
use serde::Serialize;
use tempfile::NamedTempFile;

/// Set once by Ctrl-C; stages look at it whenever they report progress.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Adaptive slicer for resin printers: the fewest layers that keep the error within a tolerance.
///
/// Lengths are in millimetres; z is up. Exit codes: 0 done, 1 bad input or no feasible plan, 2 usage,
/// 130 interrupted.
#[derive(Parser)]
#[command(name = "cusp", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Slice a model into a print file: masks with a manifest, or what a printer takes
    #[command(allow_negative_numbers = true)]
    Slice {
        #[command(flatten)]
        slicing: Slicing,
        /// Where to write the print file; one that is there is replaced once the new one is whole
        #[arg(short, long, value_name = "FILE")]
        output: PathBuf,
    },
    /// Plan the layers of a model without writing masks
    #[command(allow_negative_numbers = true)]
    Plan {
        #[command(flatten)]
        slicing: Slicing,
    },
    /// Show how layers, time and error depend on each other
    #[command(allow_negative_numbers = true)]
    Tradeoff {
        #[command(flatten)]
        slicing: Slicing,
        /// Plans on the curve
        #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u32).range(2..=1000))]
        points: u32,
    },
    /// Compare planners: coarsest, optimal, greedy and finest
    #[command(allow_negative_numbers = true)]
    Compare {
        #[command(flatten)]
        slicing: Slicing,
    },
    /// Make a plan anew that somebody sent, and say whether it is the same and keeps its tolerance
    Verify {
        /// The plan as `cusp plan --json` or the page gives it, or the manifest of a zip of masks
        plan: PathBuf,
        /// STL file that it was made from
        model: PathBuf,
        /// Make this print file anew as well, and compare every byte
        #[arg(long, value_name = "FILE")]
        print: Option<PathBuf>,
        /// The weights of facets that the plan was made with
        #[arg(long, value_name = "FILE")]
        weights: Option<PathBuf>,
        /// Print one JSON object
        #[arg(long)]
        json: bool,
    },
    /// Find how much each facet stands out, and write that as weights
    Saliency {
        /// STL file, binary or ASCII
        model: PathBuf,
        /// Where to write the weights
        #[arg(short, long, value_name = "FILE")]
        output: PathBuf,
    },
    /// List the printers that are known by name
    Printers {
        /// Print one JSON array
        #[arg(long)]
        json: bool,
    },
    /// Describe a model: size, facets, volume, faults
    Info {
        /// STL file, binary or ASCII
        model: PathBuf,
        /// Print one JSON object
        #[arg(long)]
        json: bool,
    },
}

#[derive(Args)]
struct Slicing {
    /// STL file, binary or ASCII
    model: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Turn the model by a quaternion
    #[arg(long, value_name = "X,Y,Z,W", value_parser = rotation, allow_hyphen_values = true, help_heading = "Model")]
    rotation: Option<[f64; 4]>,
    /// Scale the model evenly to this height
    #[arg(long, value_name = "MM", value_parser = length, help_heading = "Model")]
    height: Option<f64>,
    /// A printer by name, which gives pixels, pitch, mirroring and format: see `cusp printers`
    #[arg(long, value_name = "NAME", help_heading = "Printer")]
    printer: Option<String>,
    /// Columns and rows of the masks, with the model in their middle [default: the model's bounding
    /// box at 2048 pixels along its longer side]
    #[arg(long, value_name = "WxH", value_parser = pixels, requires = "pitch", help_heading = "Printer")]
    pixels: Option<[u32; 2]>,
    /// Side of a pixel, or its sides in x and y: 0.019 or 0.019x0.024
    #[arg(long, value_name = "MM", value_parser = pitch, help_heading = "Printer")]
    pitch: Option<[f64; 2]>,
    /// Smooth edges by grey: average each pixel over so many rays, and as many parts of its layer
    #[arg(long, value_name = "LEVEL", default_value = "1", value_parser = antialias, help_heading = "Printer")]
    aa: u32,
    /// Mirror the masks of print files left to right
    #[arg(long, value_name = "YES", help_heading = "Printer")]
    mirror: Option<bool>,
    /// The print file [default: what the printer takes, or png]
    #[arg(long, value_enum, help_heading = "Printer")]
    format: Option<Format>,
    /// Resin as a JSON file: exposures, bottom layers, lift
    #[arg(long, value_name = "FILE", help_heading = "Printer")]
    resin: Option<PathBuf>,
    /// Facets count by how much they stand out
    #[arg(long, help_heading = "Weights")]
    saliency: bool,
    /// Facets count by this file of weights; with --saliency by the product
    #[arg(long, value_name = "FILE", help_heading = "Weights")]
    weights: Option<PathBuf>,
    /// What facets count for at least: the error of one may be as many times the tolerance as this goes into 1
    #[arg(
        long,
        value_name = "WEIGHT",
        default_value_t = 0.25,
        help_heading = "Weights"
    )]
    weight_min: f64,
    /// Least layer thickness
    #[arg(long, value_name = "MM", default_value = "0.05", value_parser = length, help_heading = "Layers")]
    layer_min: f64,
    /// Greatest layer thickness
    #[arg(long, value_name = "MM", default_value = "0.15", value_parser = length, help_heading = "Layers")]
    layer_max: f64,
    /// Greatest error of a layer, in the metric's unit [default: 0.065 mm of cusp height, 0.1 mm of roughness, 0.1 of the
    /// area, 1 mm³ of volume and as much more as the model needs]
    #[arg(long, value_name = "ERROR", value_parser = positive, help_heading = "Layers")]
    tolerance: Option<f64>,
    /// Find the least tolerance that needs at most so many layers
    #[arg(
        long,
        value_name = "K",
        conflicts_with = "tolerance",
        help_heading = "Layers"
    )]
    max_layers: Option<usize>,
    /// Find the least tolerance that takes at most so many seconds
    #[arg(long, value_name = "S", value_parser = positive, conflicts_with_all = ["tolerance", "max_layers"], help_heading = "Layers")]
    max_time: Option<f64>,
    /// What the error measures
    #[arg(long, value_enum, default_value = "cusp", help_heading = "Layers")]
    metric: Metric,
    /// What errors are measured on
    #[arg(long, value_enum, default_value = "exact", help_heading = "Layers")]
    source: Source,
    /// How layers are chosen
    #[arg(long, value_enum, default_value = "optimal", help_heading = "Layers")]
    planner: PlannerArg,
    /// What the optimal plan has least of
    #[arg(long, value_enum, default_value = "layers", help_heading = "Layers")]
    minimize: Minimize,
    /// Layer thickness of the uniform planner, and of no other: a length, `finest` or `coarsest`
    #[arg(
        long,
        value_name = "MM",
        value_parser = uniform_layer,
        required_if_eq("planner", "uniform"),
        help_heading = "Layers"
    )]
    layer: Option<Planner>,
    /// Layers from Z0 to Z1 of MIN to MAX mm; may be given again for other heights
    #[arg(long = "range", value_name = "Z0:Z1=MIN:MAX", value_parser = height_range, help_heading = "Layers")]
    ranges: Vec<HeightRange>,
    /// Put a plane at this height; may be given again
    #[arg(long = "plane", value_name = "MM", value_parser = length, help_heading = "Layers")]
    planes: Vec<f64>,
    /// What heights are multiples of: the printer's motor step
    #[arg(long, value_name = "MM", value_parser = length, help_heading = "Layers")]
    step: Option<f64>,
    /// Whether planes go where flats and sharp changes are
    #[arg(long, value_enum, default_value = "auto", help_heading = "Layers")]
    snap: Snap,
    /// Height of a bin of the profile, to which layers are rounded
    #[arg(long, value_name = "MM", default_value = "0.002", value_parser = length, help_heading = "Layers")]
    bin: f64,
    /// Where surfaces are sampled
    #[arg(long, value_enum, default_value = "auto", help_heading = "Machine")]
    backend: Backend,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum PlannerArg {
    /// The fewest layers within tolerance, or the shortest time
    Optimal,
    /// Layer by layer, as thick as the profile allows
    Greedy,
    /// Layer by layer, as thick as the surface at the plane suggests
    Local,
    /// Layers of one thickness, given by --layer
    Uniform,
}

impl Slicing {
    /// Ends the program where options of this `command` contradict each other in a way that clap's
    /// attributes cannot say.
    fn check(&self, command: &str) {
        if self.layer.is_some() && self.planner != PlannerArg::Uniform {
            let message = "--layer is for --planner uniform only; elsewhere --layer-min and \
                           --layer-max bound the layers";
            let mut cli = Cli::command();
            cli.build();
            let command = cli.find_subcommand_mut(command);
            command
                .expect("the command that was parsed")
                .error(ErrorKind::ArgumentConflict, message)
                .exit();
        }
    }

    fn options(&self) -> Result<Options, Failure> {
        let resin = match &self.resin {
            None => Resin::default(),
            Some(path) => {
                let text = fs::read_to_string(path).map_err(|error| in_file(path, &error))?;
                serde_json::from_str(&text).map_err(|error| in_file(path, &error))?
            }
        };
        Ok(Options {
            rotation: self.rotation,
            height_mm: self.height,
            printer: self.printer.clone(),
            pixels: self.pixels,
            pitch_mm: self.pitch.map(|pitch| pitch[0]),
            pitch_y_mm: self.pitch.map(|pitch| pitch[1]),
            antialias: self.aa,
            mirror: self.mirror,
            format: self.format,
            layer_min_mm: self.layer_min,
            layer_max_mm: self.layer_max,
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
            resin,
            backend: self.backend,
            ..Options::default()
        })
    }
}

/// Parses a positive length.
fn length(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        _ => Err("a positive number of millimetres is needed".to_owned()),
    }
}

/// Parses `P` or `PxQ`.
fn pitch(text: &str) -> Result<[f64; 2], String> {
    match text.split_once(['x', 'X', '×']) {
        Some((x, y)) => Ok([length(x)?, length(y)?]),
        None => Ok([length(text)?; 2]),
    }
}

/// Parses `X,Y,Z,W`.
fn rotation(text: &str) -> Result<[f64; 4], String> {
    let parts = text.split(',').map(|part| part.trim().parse::<f64>());
    let parts: Result<Vec<f64>, _> = parts.collect();
    let parts = parts.ok().and_then(|parts| parts.try_into().ok());
    parts.ok_or_else(|| "a quaternion has four numbers: X,Y,Z,W".to_owned())
}

/// Parses a level of anti-aliasing.
fn antialias(text: &str) -> Result<u32, String> {
    let level = text.parse().ok().filter(|level| LEVELS.contains(level));
    level.ok_or_else(|| format!("there are levels {LEVELS:?}"))
}

/// Parses a positive number.
fn positive(text: &str) -> Result<f64, String> {
    length(text).map_err(|_| "a positive number is needed".to_owned())
}

/// Parses a thickness of uniform layers.
fn uniform_layer(text: &str) -> Result<Planner, String> {
    match text {
        "finest" => Ok(Planner::Finest),
        "coarsest" => Ok(Planner::Coarsest),
        _ => Ok(Planner::Uniform {
            layer_mm: length(text)
                .map_err(|reason| format!("{reason}, or `finest` or `coarsest`"))?,
        }),
    }
}

/// Parses `Z0:Z1=MIN:MAX`.
fn height_range(text: &str) -> Result<HeightRange, String> {
    let pair = |text: &str| {
        let (first, second) = text.split_once(':')?;
        Some((first.trim().parse().ok()?, second.trim().parse().ok()?))
    };
    text.split_once('=')
        .and_then(|(heights, layers)| {
            let ((from_mm, to_mm), (layer_min_mm, layer_max_mm)) = (pair(heights)?, pair(layers)?);
            Some(HeightRange {
                from_mm,
                to_mm,
                layer_min_mm,
                layer_max_mm,
            })
        })
        .ok_or_else(|| "heights and thicknesses in mm are needed, such as 0:5=0.1:0.1".to_owned())
}

/// Parses `WxH`.
fn pixels(text: &str) -> Result<[u32; 2], String> {
    text.split_once(['x', 'X', '×'])
        .and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]))
        .filter(|size: &[u32; 2]| !size.contains(&0))
        .ok_or_else(|| "columns and rows are needed, such as 3840x2400".to_owned())
}

/// Why a command stops.
struct Failure {
    exit_code: u8,
    message: String,
}

impl From<String> for Failure {
    fn from(message: String) -> Self {
        Self {
            exit_code: 1,
            message,
        }
    }
}

impl Failure {
    /// A failure of the library about a file; being interrupted is about none.
    fn in_file(path: &Path, error: &cusp_slicer::Error) -> Self {
        if error.code() == "cancelled" {
            Self {
                exit_code: 130,
                message: error.to_string(),
            }
        } else {
            in_file(path, error).into()
        }
    }
}

fn main() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Slice { slicing, output } => slice(&slicing, &output),
        Command::Plan { slicing } => plan(&slicing),
        Command::Tradeoff { slicing, points } => tradeoff(&slicing, points as usize),
        Command::Compare { slicing } => compare(&slicing),
        Command::Verify {
            plan,
            model,
            print,
            weights,
            json,
        } => verify(&plan, &model, print.as_deref(), weights.as_deref(), json),
        Command::Saliency { model, output } => saliency(&model, &output),
        Command::Printers { json } => printers(json),
        Command::Info { model, json } => info(&model, json),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            say(&failure.message);
            ExitCode::from(failure.exit_code)
        }
    }
}

/// Tells the user something on stderr; that nobody listens there is no reason to stop.
fn say(message: &str) {
    let _ = writeln!(io::stderr(), "cusp: {message}");
}

fn load(model: &Path) -> Result<Slicer, Failure> {
    let bytes = fs::read(model).map_err(|error| in_file(model, &error))?;
    Slicer::load(&bytes).map_err(|error| Failure::in_file(model, &error))
}

fn in_file(path: &Path, error: &dyn std::fmt::Display) -> String {
    format!("{}: {error}", path.display())
}

fn printers(json: bool) -> Result<(), Failure> {
    if json {
        return Ok(print_json(&PRINTERS)?);
    }
    let mut text = format!(
        "{:<20} {:<28} {:>12}  {:<13} {:<20} format",
        "name", "printer", "pixels", "pitch (µm)", "volume (mm)"
    );
    for printer in PRINTERS {
        let by = |sides: &[f64]| {
            sides
                .iter()
                .map(f64::to_string)
                .collect::<Vec<_>>()
                .join(" × ")
        };
        let format = printer.format.to_possible_value();
        let _ = write!(
            text,
            "\n{:<20} {:<28} {:>12}  {:<13} {:<20} {}",
            printer.name,
            printer.model,
            format!("{} × {}", printer.pixels[0], printer.pixels[1]),
            by(&printer.pitch_um),
            by(&printer.volume_mm),
            format.as_ref().map_or("", |format| format.get_name())
        );
    }
    Ok(print(&text)?)
}

fn info(model: &Path, json: bool) -> Result<(), Failure> {
    let info = load(model)?.info();
    if json {
        print_json(&info)?;
    } else {
        print(&describe_mesh(&info))?;
    }
    Ok(())
}

fn plan(slicing: &Slicing) -> Result<(), Failure> {
    slicing.check("plan");
    let mut slicer = load_weighted(slicing)?;
    stop_on_interrupt();
    let bar = Bar::new();
    let report = make_plan(&mut slicer, slicing, &bar)?;
    drop(bar);
    show(slicing, report)
}

/// Loads the model and asks something of it that makes no plan, with a progress bar.
fn study<T>(
    slicing: &Slicing,
    ask: impl AsyncFnOnce(&mut Slicer, &mut StageProgress<'_>) -> Result<T, cusp_slicer::Error>,
) -> Result<T, Failure> {
    let mut slicer = load_weighted(slicing)?;
    stop_on_interrupt();
    let bar = Bar::new();
    let mut progress = |stage, fraction| bar.report(stage, fraction);
    pollster::block_on(ask(&mut slicer, &mut progress))
        .map_err(|error| Failure::in_file(&slicing.model, &error))
}

fn tradeoff(slicing: &Slicing, points: usize) -> Result<(), Failure> {
    slicing.check("tradeoff");
    let options = slicing.options()?;
    let curve = study(slicing, async |slicer, progress| {
        slicer.tradeoff(&options, points, progress).await
    })?;
    if slicing.json {
        return Ok(print_json(&curve)?);
    }
    let mut text = format!(
        "tolerance     layers  largest error  time\n{:>9}",
        options.metric.unit()
    );
    for point in &curve.points {
        let _ = write!(
            text,
            "\n{:<12.5} {:>7}  {:<13.5}  {}",
            point.tolerance,
            point.layers,
            point.max_error,
            duration(point.print_time_s)
        );
    }
    Ok(print(&text)?)
}

fn compare(slicing: &Slicing) -> Result<(), Failure> {
    slicing.check("compare");
    let options = slicing.options()?;
    let comparison = study(slicing, async |slicer, progress| {
        slicer.compare(&options, progress).await
    })?;
    if slicing.json {
        return Ok(print_json(&comparison)?);
    }
    let mut text = format!(
        "{} facets, {} mm high\nplanner    layers  largest error  time",
        comparison.facets, comparison.height_mm
    );
    for row in &comparison.rows {
        let _ = write!(
            text,
            "\n{:<9} {:>7}  {:<13}  {}",
            row.planner,
            row.layers,
            comparison.metric.words(row.max_error),
            duration(row.print_time_s)
        );
    }
    Ok(print(&text)?)
}

/// A time as people say it.
fn duration(seconds: f64) -> String {
    let minutes = (seconds / 60.0).round() as u64;
    if minutes == 0 {
        format!("{seconds:.0} s")
    } else {
        format!("{} h {:02} min", minutes / 60, minutes % 60)
    }
}

/// Has facets count by a file of weights, if there is one.
fn paint(slicer: &mut Slicer, weights: Option<&Path>) -> Result<(), Failure> {
    let Some(path) = weights else { return Ok(()) };
    let bytes = fs::read(path).map_err(|error| in_file(path, &error))?;
    let weights =
        weights::from_bytes(&bytes, &slicer.positions()).map_err(|error| in_file(path, &error))?;
    slicer
        .paint(Some(weights))
        .map_err(|error| Failure::in_file(path, &error))
}

/// Loads a model, and the weights of its facets if there are any.
fn load_weighted(slicing: &Slicing) -> Result<Slicer, Failure> {
    let mut slicer = load(&slicing.model)?;
    paint(&mut slicer, slicing.weights.as_deref())?;
    Ok(slicer)
}

fn saliency(model: &Path, output: &Path) -> Result<(), Failure> {
    let place = place_for(output, model).map_err(|reason| in_file(output, &reason))?;
    let mut slicer = load(model)?;
    stop_on_interrupt();
    let mut file = file_beside(&place).map_err(|error| in_file(output, &error))?;
    let bar = Bar::new();
    let mut progress = |stage, fraction| bar.report(stage, fraction);
    let saliency = slicer
        .saliency(&mut progress)
        .map_err(|error| Failure::in_file(model, &error))?
        .to_vec();
    drop(bar);
    let bytes = weights::to_bytes(&saliency, &slicer.positions());
    file.write_all(&bytes)
        .map_err(|error| in_file(output, &error))?;
    file.persist(&place)
        .map_err(|error| in_file(output, &error.error))?;
    Ok(())
}

/// Says that a plan, and a print file, are right.
#[derive(Serialize)]
struct Verified {
    layers: usize,
    max_error: f64,
    tolerance: f64,
    print_time_s: f64,
    resin_ml: f64,
    print_is_same: bool,
}

fn verify(
    plan: &Path,
    model: &Path,
    print_file: Option<&Path>,
    weights: Option<&Path>,
    json: bool,
) -> Result<(), Failure> {
    let text = fs::read_to_string(plan).map_err(|error| in_file(plan, &error))?;
    let mut slicer = load(model)?;
    paint(&mut slicer, weights)?;
    let claim = Claim::read(&text, slicer.stl()).map_err(|error| in_file(plan, &error))?;
    stop_on_interrupt();
    let bar = Bar::new();
    let mut progress = |stage, fraction| bar.report(stage, fraction);
    let made = pollster::block_on(slicer.plan(claim.options(), &mut progress))
        .map_err(|error| Failure::in_file(model, &error))?;
    claim.check(made).map_err(|error| in_file(plan, &error))?;
    let verified = Verified {
        layers: made.layers,
        max_error: made.max_error,
        tolerance: made.tolerance,
        print_time_s: made.print_time_s,
        resin_ml: made.resin_ml,
        print_is_same: print_file.is_some(),
    };
    let words = made.metric.words(made.max_error);
    if let Some(path) = print_file {
        let sent = fs::read(path).map_err(|error| in_file(path, &error))?;
        let (bytes, _) = slicer
            .write_archive(Vec::with_capacity(sent.len()), &mut progress)
            .map_err(|error| Failure::in_file(model, &error))?;
        if sent != bytes {
            let reason = "it is not the print file that this plan gives";
            return Err(in_file(path, &reason).into());
        }
    }
    drop(bar);
    if json {
        return Ok(print_json(&verified)?);
    }
    Ok(print(&format!(
        "the plan is right: {} layers, largest error {words} within its tolerance{}",
        verified.layers,
        if verified.print_is_same {
            "; the print file is the one that it gives"
        } else {
            ""
        }
    ))?)
}

fn slice(slicing: &Slicing, output: &Path) -> Result<(), Failure> {
    slicing.check("slice");
    let place = place_for(output, &slicing.model).map_err(|reason| in_file(output, &reason))?;
    let mut slicer = load_weighted(slicing)?;
    stop_on_interrupt();
    // Made before the work, so that a folder which cannot be written to is met at once.
    let file = file_beside(&place).map_err(|error| in_file(output, &error))?;
    let bar = Bar::new();
    make_plan(&mut slicer, slicing, &bar)?;
    let (writer, report) = slicer
        .write_archive(BufWriter::new(file), &mut |stage, fraction| {
            bar.report(stage, fraction)
        })
        .map_err(|error| Failure::in_file(output, &error))?;
    let file = writer
        .into_inner()
        .map_err(|error| in_file(output, &error))?;
    file.persist(&place)
        .map_err(|error| in_file(output, &error.error))?;
    drop(bar);
    show(slicing, report)
}

/// The file to write for `output`: itself, or what it links to, so that links stay links.
///
/// Fails with a sentence where no zip can be, which is cheaper to learn before the work.
fn place_for(output: &Path, model: &Path) -> Result<PathBuf, String> {
    match fs::metadata(output) {
        Ok(found) if found.is_dir() => Err("is a folder; name a file in it".to_owned()),
        Ok(found) if !found.is_file() => {
            Err("is a device or a pipe; a zip can only be written to a file".to_owned())
        }
        Ok(_) => {
            let place = output.canonicalize().map_err(|error| error.to_string())?;
            if model.canonicalize().is_ok_and(|model| model == place) {
                return Err("is the model itself; name another file".to_owned());
            }
            Ok(place)
        }
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error.to_string()),
        Err(_) if output.is_symlink() => {
            Err("is a link to a file that does not exist; name that file instead".to_owned())
        }
        Err(_) => {
            let names_folder = output.to_string_lossy().ends_with(std::path::is_separator);
            let folder = if names_folder { output } else { parent(output) };
            if folder.is_dir() {
                Ok(output.to_owned())
            } else {
                Err(format!(
                    "there is no folder {}; make it first",
                    folder.display()
                ))
            }
        }
    }
}

fn parent(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// A file beside `place`, to be renamed to it once whole. It has the permissions of the file that it
/// replaces, or those that the umask leaves a new one.
fn file_beside(place: &Path) -> io::Result<NamedTempFile> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let mut builder = tempfile::Builder::new();
        let old = fs::metadata(place).ok().map(|old| old.permissions());
        let usual = fs::Permissions::from_mode(0o666);
        builder.permissions(old.clone().unwrap_or(usual));
        let file = builder.tempfile_in(parent(place))?;
        if let Some(old) = old {
            // The umask may have taken some away.
            file.as_file().set_permissions(old)?;
        }
        Ok(file)
    }
    #[cfg(not(unix))]
    NamedTempFile::new_in(parent(place))
}

/// From here on Ctrl-C is noted rather than deadly, so that temporary files go away.
///
/// Where an interrupt or hang-up is ignored already, as under `nohup`, it stays so: hence `try`, and
/// hence failing does no harm.
fn stop_on_interrupt() {
    let _ = ctrlc::try_set_handler(|| INTERRUPTED.store(true, Ordering::Relaxed));
}

fn make_plan<'a>(
    slicer: &'a mut Slicer,
    slicing: &Slicing,
    bar: &Bar,
) -> Result<&'a Report, Failure> {
    let options = slicing.options()?;
    let mut progress = |stage, fraction| bar.report(stage, fraction);
    pollster::block_on(slicer.plan(&options, &mut progress))
        .map_err(|error| Failure::in_file(&slicing.model, &error))
}

fn show(slicing: &Slicing, report: &Report) -> Result<(), Failure> {
    for Warning { message, .. } in &report.warnings {
        say(&format!("warning: {message}"));
    }
    if slicing.json {
        print_json(report)?;
    } else {
        print(&describe_plan(report))?;
    }
    Ok(())
}

fn describe_mesh(info: &MeshInfo) -> String {
    let [x, y, z] = info.size_mm;
    let mut text = format!(
        "size     {x:.3} × {y:.3} × {z:.3} mm\nfacets   {}\nvertices {}\nvolume   {:.3} ml\nclosed   {}",
        info.facets,
        info.vertices,
        info.volume_mm3 / 1e3,
        if info.closed { "yes" } else { "no" },
    );
    for Warning { message, .. } in &info.warnings {
        text.push_str("\nwarning  ");
        text.push_str(message);
    }
    text
}

fn describe_plan(report: &Report) -> String {
    let (thinnest, thickest) = report
        .thickness_mm
        .iter()
        .fold((f64::INFINITY, 0f64), |(low, high), &t| {
            (low.min(t), high.max(t))
        });
    let words = |error| report.metric.words(error);
    let (finest, coarsest) = (&report.uniform.finest, &report.uniform.coarsest);
    format!(
        "layers    {} of {thinnest:.3} to {thickest:.3} mm, {:.3} mm in all\n\
         time      {}, {:.1} ml of resin\n\
         uniform   {} at the least thickness (error {}), {} at the greatest ({})\n\
         error     {} on the mesh, {} as sampled, tolerance {}\n\
         planes    {} at flats and sharp changes\n\
         masks     {} × {} pixels of {:.4} mm\n\
         sampled   {} hits on {}, {:.0} ms in all",
        report.layers,
        report.height_mm,
        duration(report.print_time_s),
        report.resin_ml,
        finest.layers,
        words(finest.max_error),
        coarsest.layers,
        words(coarsest.max_error),
        words(report.max_error),
        words(report.sampled_error),
        words(report.tolerance),
        report.snapped_mm.len(),
        report.mask.width,
        report.mask.height,
        report.mask.pitch_mm,
        report.hits,
        report.adapter.as_deref().unwrap_or("the CPU"),
        report.timings_ms.total,
    )
}

fn print_json(value: &impl Serialize) -> Result<(), String> {
    print(&serde_json::to_string(value).map_err(|error| error.to_string())?)
}

/// Prints a line; a reader that has gone away, such as `head`, is no error.
fn print(text: &str) -> Result<(), String> {
    match writeln!(io::stdout(), "{text}") {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error.to_string()),
        _ => Ok(()),
    }
}

/// A progress bar on a terminal, nothing elsewhere; it clears its line when dropped.
struct Bar {
    bar: ProgressBar,
}

impl Bar {
    fn new() -> Self {
        const STEPS: u64 = 1000;
        if !io::stderr().is_terminal() {
            return Self {
                bar: ProgressBar::hidden(),
            };
        }
        let style = ProgressStyle::with_template("{msg:8} {wide_bar} {percent:>3} %")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        Self {
            bar: ProgressBar::new(STEPS)
                .with_style(style)
                .with_finish(ProgressFinish::AndClear),
        }
    }

    fn report(&self, stage: Stage, fraction: f64) -> ControlFlow<()> {
        self.bar.set_message(stage.name());
        let steps = self.bar.length().unwrap_or_default() as f64;
        self.bar.set_position((fraction * steps) as u64);
        if INTERRUPTED.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}
