//! The project's own commands: `cargo xtask help` lists them.
//!
//! Each command first ensures its requirements (compiler target, wasm tools,
//! browser, npm packages), so that a fresh clone on a machine with only Rust and
//! Node is enough, and a second run spends no time on it.

mod against;
mod bench;
mod browser;
mod counts;
mod debian;
mod fuzz;
mod lint;
mod modules;
mod node;
mod package;
mod process;
mod project;
mod python;
mod serve;
mod suite;
mod tally;
mod wasm;

use std::process::ExitCode;

use anyhow::Result;
use clap::{Parser, Subcommand};

use crate::project::Project;

#[derive(Parser)]
#[command(
    name = "cargo xtask",
    bin_name = "cargo xtask",
    about = "Build, try and test Cusp. For a first look, run `cargo xtask start`."
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Build everything and serve the page on this computer
    Start {
        /// Port to serve on [default: 8080, or the next free one]
        #[arg(long)]
        port: Option<u16>,
    },
    /// Build the wasm package (www/pkg) and the page (www/dist)
    Build,
    /// Build the npm package (www/dist-package) and the crate, and check what would be published: contents, sizes, links, documentation
    Package,
    /// Run every test: native, counts, interop, GPU, wasm in a browser, page, end to end, other engines
    Test {
        /// Run only these steps
        #[arg(value_name = "STEP")]
        steps: Vec<suite::Step>,
    },
    /// Check formatting, lints (native, wasm and TypeScript), dependencies, documentation and module cycles
    Lint {
        /// Run only the checks of these names
        #[arg(value_name = "CHECK")]
        checks: Vec<String>,
    },
    /// Build the wasm modules and check their gzipped sizes against the budgets
    Size,
    /// Count instructions, allocations and bytes of print files, and compare them with benches/counts.json
    Counts,
    /// Feed random input to the readers and the whole path for this many minutes (nightly compiler)
    Fuzz {
        /// Minutes for all targets together
        minutes: f64,
        /// Run only these targets
        #[arg(value_name = "TARGET")]
        targets: Vec<String>,
    },
    /// Take the documentation's screenshots in a browser
    Screenshots,
    /// Run all benchmarks, or one; `gpu` also makes a folder that runs on other machines, and
    /// `all --against REV` compares the command line with that of another revision
    Bench {
        /// A benchmark: a file or folder of benches/, without extension; or `all`
        name: Option<String>,
        /// Arguments of the benchmark: its source says which it takes
        #[arg(requires = "name", trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
}

fn main() -> ExitCode {
    // Without arguments clap prints the help to stderr and exits with 2. Asking
    // for the list of tasks is not an error here.
    if std::env::args_os().len() < 2 {
        use clap::CommandFactory;
        let _ = Arguments::command().print_help();
        return ExitCode::SUCCESS;
    }
    match run(Arguments::parse().command) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

/// Runs one command. Returns `false` if it ran and found a failure.
fn run(command: Command) -> Result<bool> {
    let project = Project::here()?;
    match command {
        Command::Start { port } => {
            serve::build(&project)?;
            serve::serve(&project, port)?;
        }
        Command::Build => serve::build(&project)?,
        Command::Package => return Ok(package::run(&project)),
        Command::Test { steps } => return suite::run(&project, &steps),
        Command::Lint { checks } => return lint::run(&project, &checks),
        Command::Size => {
            wasm::build(&project)?;
            return wasm::check_size(&project);
        }
        Command::Counts => return suite::run(&project, &[suite::Step::Counts]),
        Command::Fuzz { minutes, targets } => return fuzz::run(&project, minutes, &targets),
        Command::Screenshots => {
            serve::build(&project)?;
            let chromium = browser::chromium()?;
            let mut npm = node::npm(&project)?;
            process::run(npm.args(["run", "screenshots"]).env("CHROMIUM", chromium))?;
        }
        Command::Bench { name, arguments } => {
            bench::run(&project, name.as_deref(), &arguments)?;
        }
    }
    Ok(true)
}
