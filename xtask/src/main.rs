//! The project's own commands: `cargo xtask help` lists them.
//!
//! Each command makes sure of what it needs before it starts (compiler target,
//! wasm tools, browser, npm packages), so that a fresh clone on a machine with
//! only Rust and Node is enough, and a second run spends no time on it.

mod browser;
mod debian;
mod lint;
mod modules;
mod node;
mod process;
mod project;
mod python;
mod report;
mod runner_output;
mod serve;
mod suite;
mod toolchain;
mod tools;
mod wasm;
mod wasm_std;

use std::process::ExitCode;

use anyhow::Result;
use clap::{Parser, Subcommand};

use crate::project::Project;

#[derive(Parser)]
#[command(
    name = "cargo xtask",
    bin_name = "cargo xtask",
    about = "Build, try and test Cusp. `cargo xtask start` is all that a first look needs."
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Build everything and serve the page on this machine
    Start {
        /// Port to serve on [default: 8080, or the next free one]
        #[arg(long)]
        port: Option<u16>,
    },
    /// Build the wasm package (www/pkg) and the page (www/dist)
    Build,
    /// Build the npm package (www/dist-package), and weigh it
    Package,
    /// Run every test: native, GPU, wasm in a browser, page, end to end, cluster
    Test {
        /// Run these steps only
        #[arg(value_name = "STEP")]
        steps: Vec<suite::Step>,
    },
    /// Check formatting, lints (native and wasm), documentation, and that modules form no circle
    Lint,
    /// Build the wasm module and hold its gzipped size against the budget
    Size,
    /// Take the documentation's pictures with a real browser
    Screenshots,
    /// Run the benchmarks, or the one named
    Bench {
        /// A file of benches/ without its extension
        name: Option<String>,
        /// Handed on to the benchmark: its head says what it takes
        #[arg(requires = "name", trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
}

fn main() -> ExitCode {
    // With no argument clap prints the help to stderr and exits with 2; asking
    // what there is to do is no error here.
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

/// Runs one command; `false` when it did its work and the answer is no.
fn run(command: Command) -> Result<bool> {
    let project = Project::here()?;
    match command {
        Command::Start { port } => {
            build(&project)?;
            serve::serve(&project, port)?;
        }
        Command::Build => build(&project)?,
        Command::Package => {
            wasm::build(&project)?;
            process::run(node::npm(&project)?.args(["run", "package"]))?;
        }
        Command::Test { steps } => return suite::run(&project, &steps),
        Command::Lint => return Ok(lint::run(&project)),
        Command::Size => {
            wasm::build(&project)?;
            return wasm::check_size(&project);
        }
        Command::Screenshots => {
            build(&project)?;
            let chromium = browser::chromium()?;
            let mut npm = node::npm(&project)?;
            process::run(npm.args(["run", "screenshots"]).env("CHROMIUM", chromium))?;
        }
        Command::Bench { name, arguments } => {
            let mut cargo = process::cargo(&project);
            cargo.arg("bench");
            match name {
                Some(name) => cargo.args(["--bench", &name, "--"]).args(arguments),
                None => cargo.arg("--benches"),
            };
            process::show(&mut cargo)?;
        }
    }
    Ok(true)
}

fn build(project: &Project) -> Result<()> {
    wasm::build(project)?;
    node::build_page(project)
}
