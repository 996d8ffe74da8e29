//! Jobs of the core whose cost is counted, for `cargo xtask counts`.
//!
//! Without a name it runs all of them on one thread and prints, as JSON, how often each allocates and how many bytes, and how long print
//! files are. With the name of a job it does that job alone, within [`counted`], where valgrind counts instructions.
//!
//! Models use basic arithmetic only, so they are the same on every machine.

#[path = "../tests/common/slicer.rs"]
mod slicer;
#[path = "../tests/common/solids.rs"]
#[expect(dead_code, reason = "the tests use the other solids")]
mod solids;

use std::alloc::System;
use std::hint::black_box;
use std::io::sink;
use std::ops::ControlFlow;

use cusp_slicer::format::Format;
use cusp_slicer::grid::Grid;
use cusp_slicer::inspect::Limits;
use cusp_slicer::job::{Backend, LoadedModel, Options, Planner, Stage};
use cusp_slicer::ldi::cpu;
use cusp_slicer::model::{Mesh, Pose};
use cusp_slicer::orientation::SearchOptions;
use cusp_slicer::prepare::{AutoDrain, Hollowing, Supporting, hollow, support};
use cusp_slicer::progress::silent;
use glam::Vec3;
use serde_json::{Map, Value, json};
use slicer::Slicer;
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// The counted part of a job; its inputs have been made before.
type Work = Box<dyn FnOnce()>;

/// A job: its name, and a function that makes its inputs.
type Job = (&'static str, fn() -> Work);

const JOBS: [Job; 9] = [
    ("read", read),
    ("sample", sample),
    ("plan", plan),
    ("png", || print_file(Format::Png)),
    ("goo", || print_file(Format::Goo)),
    ("orient", orient),
    ("check", check),
    ("hollow", hollowing),
    ("support", supporting),
];

/// A table of 40 × 40 mm on four legs with a ball on it: slopes of every kind, flats, overhangs, and bodies that overlap.
fn table(levels: u32) -> solids::Triangles {
    let mut all = solids::moved(
        &solids::cuboid(Vec3::new(40.0, 40.0, 4.0)),
        Vec3::new(-20.0, -20.0, 16.0),
    );
    for (x, y) in [(-15.0, -15.0), (15.0, -15.0), (-15.0, 15.0), (15.0, 15.0)] {
        let leg = solids::cylinder(3.0, 17.0, 16);
        all.extend(solids::moved(&leg, Vec3::new(x, y, 0.0)));
    }
    let ball = solids::sphere(11.0, levels);
    all.extend(solids::moved(&ball, Vec3::new(0.0, 0.0, 30.0)));
    all
}

fn mesh(levels: u32) -> Mesh {
    let mesh = Mesh::from_triangles(&table(levels)).expect("a mesh");
    mesh.on_plate(&Pose::default())
        .expect("a mesh on the plate")
}

fn options() -> Options {
    Options {
        rays: 512,
        backend: Backend::Cpu,
        ..Options::default()
    }
}

fn quiet(_: Stage, _: f64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// The table, planned.
fn planned(options: &Options) -> Slicer {
    let mut slicer = Slicer::load(&solids::binary_stl(&table(5))).expect("a model");
    pollster::block_on(slicer.plan(options, &mut quiet)).expect("a plan");
    slicer
}

fn read() -> Work {
    let stl = solids::binary_stl(&table(7));
    Box::new(move || {
        drop(black_box(LoadedModel::read(&stl).expect("a model")));
    })
}

fn sample() -> Work {
    let mesh = mesh(6);
    let grid = Grid::around(&mesh.bounds(), 2048).expect("a grid");
    Box::new(move || {
        drop(black_box(
            cpu::sample(&mesh, &grid, &mut silent).expect("an LDI"),
        ));
    })
}

/// The profile and the plan: the rays exist, and finer bins need both again.
fn plan() -> Work {
    let mut slicer = planned(&options());
    let finer = Options {
        bin_mm: Some(0.001),
        ..options()
    };
    Box::new(move || {
        let report = pollster::block_on(slicer.plan(&finer, &mut quiet)).expect("a plan");
        black_box(report);
    })
}

fn print_file(format: Format) -> Work {
    let mut slicer = planned(&Options {
        rays: 1024,
        format: Some(format),
        ..options()
    });
    Box::new(move || {
        let (_, report) = slicer
            .write_archive(sink(), &mut quiet)
            .expect("a print file");
        black_box(report);
    })
}

fn orient() -> Work {
    let mut slicer = Slicer::load(&solids::binary_stl(&table(4))).expect("a model");
    let search = SearchOptions {
        directions: 50,
        ..SearchOptions::default()
    };
    Box::new(move || {
        let found = slicer.orient(&options(), &search, &mut quiet);
        drop(black_box(found.expect("directions")));
    })
}

/// The masks are there when the checks begin.
fn check() -> Work {
    let mut slicer = planned(&options());
    slicer.mask(0).expect("a mask");
    Box::new(move || {
        let found = slicer.inspect(&Limits::default(), &mut quiet);
        drop(black_box(found.expect("findings")));
    })
}

fn hollowing() -> Work {
    let mesh = mesh(4);
    let drained = Hollowing {
        wall_mm: 2.0,
        auto_drain: Some(AutoDrain::default()),
        ..Hollowing::default()
    };
    Box::new(move || {
        let void = hollow(&mesh, &drained, None, &mut silent);
        drop(black_box(void.expect("no failure")));
    })
}

fn supporting() -> Work {
    let mesh = mesh(5);
    Box::new(move || {
        let supports = support(&mesh, &Supporting::default(), None, 0.0, &mut silent);
        drop(black_box(supports.expect("no failure")));
    })
}

/// The function that valgrind counts, by its name.
#[inline(never)]
fn counted(work: Work) {
    work();
}

/// Does a job, and returns its allocations. Memory that grows counts as allocated by its growth.
fn allocations(ready: fn() -> Work) -> Value {
    let work = ready();
    let region = Region::new(ALLOCATOR);
    counted(work);
    let change = region.change();
    json!({
        "allocations": change.allocations + change.reallocations,
        "allocated_bytes": change.bytes_allocated as u64,
    })
}

/// Sizes of the table's print files in bytes, by format. Layers are uniform, which every format takes.
fn file_bytes() -> Map<String, Value> {
    let bytes = |format| {
        let mut slicer = planned(&Options {
            planner: Planner::Uniform { layer_mm: 0.1 },
            format: Some(format),
            ..options()
        });
        let written = slicer.write_archive(Vec::new(), &mut quiet);
        written.expect("a print file").0.len()
    };
    let sizes = Format::all().map(|format| (format.name().to_owned(), json!(bytes(format))));
    sizes.collect()
}

fn main() {
    // Work is then done on the thread that asks for it, in the same order on every machine.
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .use_current_thread()
        .build_global()
        .expect("no other threads yet");
    let name = std::env::args()
        .skip(1)
        .find(|argument| !argument.starts_with('-'));
    if let Some(name) = name {
        let job = JOBS.iter().find(|(job, _)| *job == name);
        counted(job.expect("the name of a job").1());
        return;
    }
    let jobs: Map<String, Value> = JOBS
        .into_iter()
        .map(|(name, ready)| (name.to_owned(), allocations(ready)))
        .collect();
    println!("{:#}", json!({ "jobs": jobs, "files": file_bytes() }));
}
