//! The command line: the only part that uses a file system, arguments and a terminal.

mod arguments;
mod batch;
mod budget;
mod calibrate;
mod check;
mod config;
mod contours;
mod convert;
mod export;
mod failure;
mod files;
mod inspect;
mod job;
mod job_file;
mod models;
mod orient;
mod packaging;
mod plate;
mod price;
mod progress;
mod schemas;
mod simulate;
mod slice;
mod study;
mod terminal;
mod unfinished;
mod usage;
mod values;
mod verify;
mod visible;
mod watch;

use std::env;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::atomic::Ordering;

use clap::{CommandFactory as _, Parser, Subcommand};

use arguments::{ReadChoices, Slicing};
use calibrate::Calibrating;
use check::Checking;
use contours::Contouring;
use convert::Converting;
use failure::{IS_JSON, tell};
use inspect::Inspecting;
use job::Printing;
use orient::Orienting;
use plate::Plating;
use price::Pricing;
use simulate::Simulating;
use usage::{COMMAND_LINE, exit};
use verify::Verifying;

/// Adaptive slicer for resin printers: the fewest layers that keep the error within a tolerance.
///
/// Lengths are in millimetres; z is up. Exit codes: 0 done, 1 bad input or no feasible plan, 2 usage, 130 interrupted.
#[derive(Parser)]
#[command(name = "cusp", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Slice models into print files: masks with a manifest, or a printer's format
    #[command(allow_negative_numbers = true)]
    Slice {
        #[command(flatten)]
        slicing: Slicing,
        /// Print file to write; an existing file is replaced only once the new one is complete. In a folder each model
        /// has a print file of its own name; - is standard output
        #[arg(short, long, value_name = "FILE|FOLDER/")]
        output: PathBuf,
    },
    /// Plan the layers of models without writing masks
    #[command(allow_negative_numbers = true)]
    Plan {
        #[command(flatten)]
        slicing: Slicing,
    },
    /// Write the exact section of each layer as polygons, for tool paths of other processes
    #[command(allow_negative_numbers = true)]
    Contours(Contouring),
    /// Arrange models on plates, and write a job file or a project that other commands take
    #[command(allow_negative_numbers = true)]
    Plate(Plating),
    /// Show how layers, time and error depend on each other
    #[command(allow_negative_numbers = true)]
    Tradeoff {
        #[command(flatten)]
        printing: Printing,
        /// Number of plans on the curve
        #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u32).range(2..=1000))]
        points: u32,
    },
    /// Compare planners: coarsest, optimal, greedy, local and finest
    #[command(allow_negative_numbers = true)]
    Compare {
        #[command(flatten)]
        printing: Printing,
    },
    /// Find what will fail when a model is printed: islands, overhangs, cups, traps, thin walls and gaps
    ///
    /// Exit codes: 0 nothing to reject, 1 something to reject or bad input, 2 usage, 130 interrupted.
    #[command(allow_negative_numbers = true)]
    Check(Checking),
    /// Find the best orientations of a model: few layers, and little error, roughness or overhang
    #[command(allow_negative_numbers = true)]
    Orient(Orienting),
    /// Say what copies of models cost, by the prices of a shop
    ///
    /// Copies are arranged on plates, and share the time that a plate takes.
    #[command(allow_negative_numbers = true)]
    Price(Pricing),
    /// Recompute a plan, and check that it matches and keeps its tolerance; --limits also checks that it can be printed,
    /// --prices adds its price
    Verify(Verifying),
    /// Measure the distances between the solid that a print file prints and the model, both ways
    Simulate(Simulating),
    /// Write a calibration print, or put its measurements into a resin file
    #[command(subcommand)]
    Calibrate(Calibrating),
    /// Show the contents of a print file from any program, and check that it is whole
    Inspect(Inspecting),
    /// Make a print file from another: the same layers and pixels, in another format or for another printer
    Convert(Converting),
    /// Write the saliency of each facet as a file of weights
    Saliency {
        /// Model: 3MF, OBJ or STL; - is standard input
        model: PathBuf,
        /// File of weights to write; - is standard output
        #[arg(short, long, value_name = "FILE")]
        output: PathBuf,
        /// Print one JSON object
        #[arg(long)]
        json: bool,
    },
    /// List the printers known by name
    Printers {
        /// Print one JSON array
        #[arg(long)]
        json: bool,
    },
    /// Describe models: size, facets, volume, defects
    Info {
        /// Models: 3MF, OBJ or STL; - is standard input
        #[arg(required = true, value_name = "MODEL")]
        models: Vec<PathBuf>,
        #[command(flatten)]
        reading: ReadChoices,
        /// Print one JSON object; for several models one per model, each on its own line
        #[arg(long)]
        json: bool,
    },
    /// Print the JSON Schema of a command's report, or of a file that it reads
    Schema {
        /// Name of the report or of the file
        #[arg(value_parser = schemas::schema_name(), required_unless_present = "output")]
        name: Option<String>,
        /// Folder for all of them, as plan.schema.json and so on
        #[arg(short, long, value_name = "FOLDER", conflicts_with = "name")]
        output: Option<PathBuf>,
    },
    /// Print the completions for a shell
    Completions {
        /// The shell
        #[arg(value_enum)]
        shell: clap_complete::Shell,
    },
    /// Print the manual page, or write those of all commands to a folder
    Man {
        /// Folder for cusp.1, cusp-slice.1 and the others
        #[arg(short, long, value_name = "FOLDER")]
        output: Option<PathBuf>,
    },
}

fn main() -> ExitCode {
    // Also where the rest cannot be parsed.
    IS_JSON.store(env::args_os().any(|it| it == "--json"), Ordering::Relaxed);
    COMMAND_LINE.get_or_init(|| Cli::command);
    let command = Cli::try_parse()
        .unwrap_or_else(|error| exit(&error))
        .command;
    let result = match command {
        Command::Slice { slicing, output } => slice::slice(&slicing, &output),
        Command::Plan { slicing } => slice::plan(&slicing),
        Command::Plate(plating) => plate::plate(&plating),
        Command::Contours(contouring) => contours::contours(&contouring),
        Command::Tradeoff { printing, points } => study::tradeoff(&printing, points as usize),
        Command::Check(checking) => check::check(&checking),
        Command::Orient(orienting) => orient::orient(&orienting),
        Command::Compare { printing } => study::compare(&printing),
        Command::Price(pricing) => price::price(&pricing),
        Command::Verify(verifying) => verify::verify(&verifying),
        Command::Simulate(simulating) => simulate::simulate(&simulating),
        Command::Calibrate(calibrating) => calibrate::calibrate(&calibrating),
        Command::Inspect(inspecting) => inspect::inspect(&inspecting),
        Command::Convert(converting) => convert::convert(&converting),
        Command::Saliency {
            model,
            output,
            json,
        } => models::saliency(&model, &output, json),
        Command::Printers { json } => models::printers(json),
        Command::Info {
            models,
            reading,
            json,
        } => models::info(&models, &reading.options(), json),
        Command::Schema { name, output } => schemas::schema(name.as_deref(), output.as_deref()),
        Command::Completions { shell } => packaging::completions(Cli::command(), shell),
        Command::Man { output } => packaging::man(Cli::command(), output.as_deref()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => ExitCode::from(tell(watch::reason(failure))),
    }
}
