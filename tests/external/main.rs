//! Tests that need a GPU or a program of others. Where it is absent, its tests are reported as ignored, which the standard harness
//! cannot do.

#[path = "../common/mod.rs"]
mod common;
mod filament;
mod gpu;
mod models;
mod openings;
#[path = "../common/peer.rs"]
mod peer;
mod print_files;
mod printability;
mod sections;

use std::env;
use std::process::{Command, Output};
use std::sync::LazyLock;

use cusp_slicer::ldi::LdiError;
use cusp_slicer::ldi::gpu::{Adapters, Gpu};
use libtest_mimic::{Arguments, Completion, Failed, Trial};

/// Names a Python with the packages of tests/interop/python/requirements.txt. `cargo xtask test` sets it.
const PYTHON_VARIABLE: &str = "CUSP_PEERS_PYTHON";

/// Something that a test needs and a machine may lack.
#[derive(Clone, Copy)]
enum Need {
    Gpu,
    /// A program, with an argument that shows if it is installed.
    Program(&'static str, &'static str),
    /// A Python with these modules.
    Python(&'static str),
}

const PRUSA_SLICER: Need = Need::Program("prusa-slicer", "--help");

impl Need {
    /// The absent program, module or GPU, as the reason of an ignored test; none if it is there.
    fn absent(self) -> Option<String> {
        match self {
            Self::Gpu => NO_GPU.clone(),
            Self::Program(name, argument) => {
                let found = Command::new(name).arg(argument).output();
                found.is_err().then(|| format!("no {name} on PATH"))
            }
            Self::Python(modules) => {
                let import = format!("import {modules}");
                let found = Command::new(python()).args(["-c", &import]).output();
                let is_found = found.is_ok_and(|found| found.status.success());
                let absent = || format!("no Python with {modules}: {PYTHON_VARIABLE} names one");
                (!is_found).then(absent)
            }
        }
    }
}

/// The reason for the lack of a GPU; none if there is one.
static NO_GPU: LazyLock<Option<String>> =
    LazyLock::new(|| match pollster::block_on(Gpu::open(Adapters::Any)) {
        Err(LdiError::NoGpu { system }) => Some(system),
        _ => None,
    });

fn python() -> String {
    env::var(PYTHON_VARIABLE).unwrap_or_else(|_| "python3".to_owned())
}

/// A test, ignored if something that it needs is absent.
fn trial(
    name: impl Into<String>,
    needs: &'static [Need],
    test: impl FnOnce() -> Result<(), Failed> + Send + 'static,
) -> Trial {
    Trial::ignorable_test(name, move || {
        if let Some(absent) = needs.iter().find_map(|need| need.absent()) {
            return Ok(Completion::ignored_with(absent));
        }
        test().map(|()| Completion::Completed)
    })
}

/// The output of a command, or an error with all that it says.
fn succeeds(command: &mut Command) -> Result<Output, Failed> {
    let output = command.output()?;
    if output.status.success() {
        return Ok(output);
    }
    let said = [output.stdout, output.stderr].concat();
    Err(format!("{command:?}: {}", String::from_utf8_lossy(&said)).into())
}

fn main() {
    // The longest tests first: at the end they would run alone.
    let suites = [
        printability::trials(),
        sections::trials(),
        print_files::trials(),
        filament::trials(),
        models::trials(),
        openings::trials(),
        gpu::trials(),
    ];
    let trials = suites.into_iter().flatten().collect();
    let conclusion = libtest_mimic::run(&Arguments::from_args(), trials);
    gpu::close();
    conclusion.exit();
}
