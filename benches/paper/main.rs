//! Tables 1, 2 and 3 and figure 5 of the paper, reproduced: `cargo xtask bench paper [MODEL.stl …]`.
//!
//! Writes docs/paper.md and docs/paper-metrics.svg. Models named on the command line come first, 60 mm high; the others
//! are generated. A direct slicer of our own stands in for the paper's.

mod direct;
mod figure;
mod models;
#[path = "../../tests/common/solids.rs"]
#[expect(
    dead_code,
    reason = "the tests use the solids; here only their type and their file"
)]
mod solids;

use std::fmt::Write as _;
use std::hint::black_box;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use cusp_slicer::grid::Bins;
use cusp_slicer::job::{Backend, Options, Slicer, Stage};
use cusp_slicer::model::read;
use cusp_slicer::model::{Mesh, Pose};
use cusp_slicer::plan::Limits;
use cusp_slicer::plan::optimal::{self, Objective};
use cusp_slicer::plan::preferred::SnapPlanes;
use cusp_slicer::profile::facet_bins::FacetBins;
use cusp_slicer::profile::{Metric, Shape, Source, steepest};

use direct::DirectSlicer;

/// The height to which generated models are scaled.
const HEIGHT_MM: f64 = 40.0;

struct Model {
    name: String,
    height_mm: f64,
    facets: usize,
    /// The binary STL.
    bytes: Vec<u8>,
}

fn quiet(_: Stage, _: f64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

fn seconds<T>(work: impl FnOnce() -> T) -> f64 {
    let clock = Instant::now();
    black_box(work());
    clock.elapsed().as_secs_f64()
}

fn models() -> Vec<Model> {
    let arguments = std::env::args().skip(1);
    let named = arguments
        .filter(|argument| !argument.starts_with('-'))
        .map(|path| {
            let bytes = std::fs::read(&path).expect("a model to read");
            let facets = read::read(&bytes).expect("an STL").len();
            let name = Path::new(&path).file_stem().unwrap_or_default();
            Model {
                name: name.to_string_lossy().into_owned(),
                height_mm: 60.0,
                facets,
                bytes,
            }
        });
    let made = models::all().into_iter().map(|(name, triangles)| Model {
        name,
        height_mm: HEIGHT_MM,
        facets: triangles.len(),
        bytes: solids::binary_stl(&triangles),
    });
    named.chain(made).collect()
}

fn options(model: &Model) -> Options {
    Options {
        height_mm: Some(model.height_mm),
        backend: Backend::Cpu,
        ..Options::default()
    }
}

fn main() {
    let models = models();
    let mut text = String::from(
        "# The paper's tables, reproduced\n\n\
         The paper is Mao, Kwok, Chen and Wang, \"Adaptive slicing based on efficient profile analysis\", *Computer-Aided \
         Design* 107 (2019).\n\n\
         Written by `cargo xtask bench paper`, on the CPU: cusp height, layers of 50 to 150 µm, ε = 65 µm, b = 2 µm, \
         2048 rays. The scanned model is 60 mm high; the others are generated, 40 mm high.\n\n",
    );
    table_1(&models, &mut text);
    table_2(&models, &mut text);
    table_3(&models, &mut text);
    figure_5(&models, &mut text);
    println!("{text}");
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    std::fs::write(docs.join("paper.md"), text).expect("docs/paper.md");
}

fn model<'a>(models: &'a [Model], name: &str) -> &'a Model {
    models
        .iter()
        .find(|model| model.name == name)
        .expect("a model of this name")
}

fn table_1(models: &[Model], text: &mut String) {
    let hand = model(models, "hand");
    let mut slicer = Slicer::load(&hand.bytes).expect("the hand");
    let _ = writeln!(
        text,
        "## Table 1: bin size, for the hand\n\n| b (µm) | intervals | planning (ms) | layers |\n|---:|---:|---:|---:|"
    );
    for bin_um in [50, 25, 10, 5, 2, 1] {
        let options = Options {
            bin_mm: Some(f64::from(bin_um) / 1000.0),
            ..options(hand)
        };
        let report = pollster::block_on(slicer.plan(&options, &mut quiet)).cloned();
        let _ = match report {
            Ok(report) => writeln!(
                text,
                "| {bin_um} | {} | {:.2} | {} |",
                report.bins, report.timings_ms.plan, report.layers
            ),
            Err(error) => writeln!(text, "| {bin_um} | – | – | ∞ ({}) |", error.code()),
        };
    }
}

fn table_2(models: &[Model], text: &mut String) {
    let _ = writeln!(
        text,
        "\n## Table 2: seconds from the mesh to a plan\n\n\
         *Plan* measures the facets and plans; *all* also samples the layered depth image, from which the masks follow at \
         almost no cost. The other columns intersect the mesh with every plane, by a sweep over the facets at that height: \
         *coarsest* and *finest* are uniform at 150 and 50 µm, *local* is greedy by the surface at the plane, and *ultra* \
         is uniform at 12.5 µm, from which a plan like ours could be made. All columns except *all* are single-threaded.\n\n\
         | model | facets | layers | plan | all | coarsest | local | finest | ultra | ultra / plan |\n|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|"
    );
    for model in models {
        let mut slicer = Slicer::load(&model.bytes).expect("a model");
        let mut layers = 0;
        let ours = seconds(|| {
            layers = pollster::block_on(slicer.plan(&options(model), &mut quiet))
                .expect("a plan")
                .layers;
        });
        let mesh = Mesh::from_triangles(&read::read(&model.bytes).expect("an STL"))
            .and_then(|mesh| mesh.on_plate(&Pose::of_height(model.height_mm)))
            .expect("a mesh");
        let plan = seconds(|| {
            let bins = Bins::of_height(model.height_mm, 0.002).expect("bins");
            let shape = Shape {
                bins,
                steepest: steepest::exact(&FacetBins::of(&mesh, bins), &[]),
                cones: Vec::new(),
                areas_mm2: Vec::new(),
            };
            let limits = Limits {
                layer_min_mm: 0.05,
                layer_max_mm: 0.15,
                tolerance: 0.065,
                ..Limits::default()
            };
            optimal::plan(
                &shape.errors(Metric::Cusp),
                &limits,
                SnapPlanes::NONE,
                Objective::Layers,
            )
        });
        let height = model.height_mm as f32;
        let slice = |layer| seconds(|| DirectSlicer::new(&mesh).uniform(height, layer));
        let local = seconds(|| DirectSlicer::new(&mesh).local(height, [0.05, 0.15], 0.065));
        let (coarsest, finest, ultra) = (slice(0.15), slice(0.05), slice(0.0125));
        let _ = writeln!(
            text,
            "| {} | {} | {layers} | {plan:.4} | {ours:.2} | {coarsest:.2} | {local:.2} | {finest:.2} | {ultra:.2} | {:.0} |",
            model.name,
            model.facets,
            ultra / plan
        );
    }
}

fn table_3(models: &[Model], text: &mut String) {
    let _ = writeln!(
        text,
        "\n## Table 3: layers, and the largest error in mm, measured on every facet\n\n\
         *Greedy* is the paper's \\[3\\], which sees only the surface at the plane. Errors above the tolerance are bold. The \
         first four columns are layers, the last four errors.\n\n\
         | model | height | facets | coarsest | ours | greedy | finest | coarsest | ours | greedy | finest |\n\
         |---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|"
    );
    for model in models {
        let mut slicer = Slicer::load(&model.bytes).expect("a model");
        let comparison =
            pollster::block_on(slicer.compare(&options(model), &mut quiet)).expect("a comparison");
        let row = |planner: &str| {
            comparison
                .rows
                .iter()
                .find(|row| row.planner == planner)
                .expect("a row")
        };
        let rows = ["coarsest", "optimal", "local", "finest"].map(row);
        let layers = rows.map(|row| row.layers.to_string()).join(" | ");
        let errors = rows.map(|row| {
            if row.max_error > 0.065 + 1e-6 {
                format!("**{:.3}**", row.max_error)
            } else {
                format!("{:.3}", row.max_error)
            }
        });
        let _ = writeln!(
            text,
            "| {} | {} | {} | {layers} | {} |",
            model.name,
            model.height_mm,
            model.facets,
            errors.join(" | ")
        );
    }
}

fn figure_5(models: &[Model], text: &mut String) {
    let shell = model(models, "shell");
    let mut slicer = Slicer::load(&shell.bytes).expect("the shell");
    let panels: Vec<figure::Panel> = [
        Metric::Cusp,
        Metric::Roughness,
        Metric::Area,
        Metric::Volume,
    ]
    .into_iter()
    .map(|metric| {
        let options = Options {
            metric,
            ..options(shell)
        };
        let report = pollster::block_on(slicer.plan(&options, &mut quiet)).expect("a plan");
        let (tolerance, z_mm) = (report.tolerance, report.z_mm.clone());
        let profile = slicer.profile(metric, Source::Exact).expect("a profile");
        figure::Panel {
            metric,
            tolerance,
            density: profile.density,
            z_mm,
        }
    })
    .collect();
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    std::fs::write(
        docs.join("paper-metrics.svg"),
        figure::draw("shell", &panels),
    )
    .expect("the figure");
    let _ = writeln!(
        text,
        "\n## Figure 5: the four metrics of the shell\n\n\
         Profiles are on the left, plans on the right. Red layers are 50 µm thick, blue ones 150 µm.\n\n![Profiles and plans](paper-metrics.svg)"
    );
}
