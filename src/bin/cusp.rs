//! The command line: the only file with a file system, arguments and a terminal.

use std::io::{BufWriter, IsTerminal, Write as _};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand, ValueEnum};
use cusp_slicer::pipeline::{self, Options, Slicer, Stage};
use cusp_slicer::profile::Metric;
use cusp_slicer::report::{MeshInfo, Report, Warning};
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;

/// Adaptive slicer for resin printers: the fewest layers that keep the error within a tolerance.
///
/// Lengths are in millimetres; z is up. Exit codes: 0 done, 1 bad input or no feasible plan, 2 usage.
#[derive(Parser)]
#[command(name = "cusp", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Slice a model into a zip of layer masks (PNG) with a manifest
    #[command(allow_negative_numbers = true)]
    Slice {
        #[command(flatten)]
        slicing: Slicing,
        /// Where to write the zip
        #[arg(short, long, value_name = "OUT.zip")]
        output: PathBuf,
    },
    /// Plan the layers of a model without writing masks
    #[command(allow_negative_numbers = true)]
    Plan {
        #[command(flatten)]
        slicing: Slicing,
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
    /// Scale the model evenly to this height
    #[arg(long, value_name = "MM", value_parser = length, help_heading = "Model")]
    height: Option<f64>,
    /// Columns and rows of the masks, with the model in their middle [default: the model's bounding
    /// box at 2048 pixels along its longer side]
    #[arg(long, value_name = "WxH", value_parser = pixels, requires = "pitch", help_heading = "Masks")]
    pixels: Option<[u32; 2]>,
    /// Side of a pixel
    #[arg(long, value_name = "MM", value_parser = length, help_heading = "Masks")]
    pitch: Option<f64>,
    /// Least layer thickness
    #[arg(long, value_name = "MM", default_value = "0.05", value_parser = length, help_heading = "Layers")]
    layer_min: f64,
    /// Greatest layer thickness
    #[arg(long, value_name = "MM", default_value = "0.15", value_parser = length, help_heading = "Layers")]
    layer_max: f64,
    /// Greatest error of a layer
    #[arg(long, value_name = "MM", default_value = "0.065", value_parser = length, help_heading = "Layers")]
    tolerance: f64,
    /// Height of a bin of the profile, to which layers are rounded
    #[arg(long, value_name = "MM", default_value = "0.002", value_parser = length, help_heading = "Layers")]
    bin: f64,
    /// What the error measures
    #[arg(long, value_enum, default_value = "cusp", help_heading = "Layers")]
    metric: MetricArg,
    /// How layers are chosen
    #[arg(long, value_enum, default_value = "optimal", help_heading = "Layers")]
    planner: PlannerArg,
    /// Layer thickness of the uniform planner
    #[arg(
        long,
        value_name = "MM",
        value_parser = length,
        required_if_eq("planner", "uniform"),
        help_heading = "Layers"
    )]
    layer: Option<f64>,
    /// Where surfaces are sampled
    #[arg(long, value_enum, default_value = "auto", help_heading = "Machine")]
    backend: BackendArg,
}

#[derive(Clone, Copy, ValueEnum)]
enum MetricArg {
    /// Cusp height in millimetres
    Cusp,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum PlannerArg {
    /// The fewest layers within tolerance
    Optimal,
    /// Layers of one thickness, given by --layer
    Uniform,
}

#[derive(Clone, Copy, ValueEnum)]
enum BackendArg {
    /// The GPU, unless there is none or it is emulated
    Auto,
    /// The GPU
    Gpu,
    /// The CPU
    Cpu,
}

impl Slicing {
    fn options(&self) -> Options {
        Options {
            height_mm: self.height,
            pixels: self.pixels,
            pitch_mm: self.pitch,
            layer_min_mm: self.layer_min,
            layer_max_mm: self.layer_max,
            tolerance_mm: self.tolerance,
            bin_mm: self.bin,
            metric: match self.metric {
                MetricArg::Cusp => Metric::Cusp,
            },
            planner: match (self.planner, self.layer) {
                (PlannerArg::Uniform, Some(layer_mm)) => pipeline::Planner::Uniform { layer_mm },
                _ => pipeline::Planner::Optimal,
            },
            backend: match self.backend {
                BackendArg::Auto => pipeline::Backend::Auto,
                BackendArg::Gpu => pipeline::Backend::Gpu,
                BackendArg::Cpu => pipeline::Backend::Cpu,
            },
            ..Options::default()
        }
    }
}

/// Parses a positive length.
fn length(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        _ => Err("a positive number of millimetres is needed".to_owned()),
    }
}

/// Parses `WxH`.
fn pixels(text: &str) -> Result<[u32; 2], String> {
    text.split_once(['x', 'X', '×'])
        .and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]))
        .filter(|size: &[u32; 2]| !size.contains(&0))
        .ok_or_else(|| "columns and rows are needed, such as 3840x2400".to_owned())
}

fn main() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Slice { slicing, output } => slice(&slicing, &output),
        Command::Plan { slicing } => plan(&slicing),
        Command::Info { model, json } => info(&model, json),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("cusp: {message}");
            ExitCode::from(1)
        }
    }
}

fn load(model: &Path) -> Result<Slicer, String> {
    let bytes = std::fs::read(model).map_err(|error| in_file(model, &error))?;
    Slicer::load(&bytes).map_err(|error| in_file(model, &error))
}

fn in_file(path: &Path, error: &dyn std::fmt::Display) -> String {
    format!("{}: {error}", path.display())
}

fn info(model: &Path, json: bool) -> Result<(), String> {
    let info = load(model)?.info();
    if json {
        print_json(&info)
    } else {
        print(&describe_mesh(&info))
    }
}

fn plan(slicing: &Slicing) -> Result<(), String> {
    let mut slicer = load(&slicing.model)?;
    let mut bar = Bar::new();
    let report = make_plan(&mut slicer, slicing, &mut bar)?;
    bar.finish();
    show(slicing, report)
}

fn slice(slicing: &Slicing, output: &Path) -> Result<(), String> {
    let mut slicer = load(&slicing.model)?;
    let mut bar = Bar::new();
    make_plan(&mut slicer, slicing, &mut bar)?;
    // Written beside its place and then renamed: a file of that name is always whole.
    let folder = match output.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let file = tempfile::NamedTempFile::new_in(folder).map_err(|error| in_file(output, &error))?;
    let (writer, report) = slicer
        .write_png_zip(BufWriter::new(file), &mut |stage, fraction| {
            bar.report(stage, fraction)
        })
        .map_err(|error| in_file(output, &error))?;
    let file = writer
        .into_inner()
        .map_err(|error| in_file(output, &error))?;
    set_usual_permissions(file.as_file());
    file.persist(output)
        .map_err(|error| in_file(output, &error.error))?;
    bar.finish();
    show(slicing, report)
}

/// Temporary files are private; a print file is not.
#[cfg(unix)]
fn set_usual_permissions(file: &std::fs::File) {
    use std::os::unix::fs::PermissionsExt;
    // Failing leaves a file that only its owner can read: no reason to lose it.
    let _ = file.set_permissions(std::fs::Permissions::from_mode(0o644));
}

#[cfg(not(unix))]
fn set_usual_permissions(_file: &std::fs::File) {}

fn make_plan<'a>(
    slicer: &'a mut Slicer,
    slicing: &Slicing,
    bar: &mut Bar,
) -> Result<&'a Report, String> {
    let options = slicing.options();
    let mut progress = |stage, fraction| bar.report(stage, fraction);
    pollster::block_on(slicer.plan(&options, &mut progress))
        .map_err(|error| in_file(&slicing.model, &error))
}

fn show(slicing: &Slicing, report: &Report) -> Result<(), String> {
    for Warning { message, .. } in &report.warnings {
        eprintln!("cusp: warning: {message}");
    }
    if slicing.json {
        print_json(report)
    } else {
        print(&describe_plan(report))
    }
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
    format!(
        "layers    {} of {thinnest:.3} to {thickest:.3} mm, {:.3} mm in all\n\
         uniform   {} at the least thickness (error {:.4} mm), {} at the greatest ({:.4} mm)\n\
         error     {:.4} mm, tolerance {} mm\n\
         masks     {} × {} pixels of {:.4} mm\n\
         sampled   {} hits on {}, {:.0} ms in all",
        report.layers,
        report.height_mm,
        report.uniform.finest_layers,
        report.uniform.finest_error_mm,
        report.uniform.coarsest_layers,
        report.uniform.coarsest_error_mm,
        report.max_error_mm,
        report.tolerance_mm,
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
    match writeln!(std::io::stdout(), "{text}") {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(error.to_string()),
        _ => Ok(()),
    }
}

/// A progress bar on a terminal, nothing elsewhere.
struct Bar {
    bar: ProgressBar,
}

impl Bar {
    fn new() -> Self {
        const STEPS: u64 = 1000;
        if !std::io::stderr().is_terminal() {
            return Self {
                bar: ProgressBar::hidden(),
            };
        }
        let style = ProgressStyle::with_template("{msg:8} {wide_bar} {percent:>3} %")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        Self {
            bar: ProgressBar::new(STEPS).with_style(style),
        }
    }

    fn report(&self, stage: Stage, fraction: f64) -> ControlFlow<()> {
        self.bar.set_message(stage.name());
        let steps = self.bar.length().unwrap_or_default() as f64;
        self.bar.set_position((fraction * steps) as u64);
        ControlFlow::Continue(())
    }

    fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
