//! Figures 1, 6 and 7 of the paper, reproduced on a generated head, and the cost of saliency: `cargo xtask bench weights`.
//!
//! Writes docs/weights.md and docs/weights.png.

#[path = "../paper/models.rs"]
#[expect(dead_code, reason = "one of the models is enough here")]
mod models;
mod picture;
#[path = "../common/png_file.rs"]
mod png_file;
#[path = "../../tests/common/slicer.rs"]
mod slicer;
#[path = "../../tests/common/solids.rs"]
#[expect(
    dead_code,
    reason = "the tests use the solids; here only their type and their file"
)]
mod solids;

use std::fmt::Write as _;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use cusp_slicer::job::{Backend, Options, Report, Stage};
use cusp_slicer::model::Mesh;
use cusp_slicer::model::saliency::saliency;
use cusp_slicer::progress::silent;
use glam::Vec3;
use picture::{Colour, Picture};
use slicer::Slicer;

const HEIGHT_MM: f64 = 40.0;
const ROUNDS: usize = 3;

fn quiet(_: Stage, _: f64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// From violet for 0 through green to yellow for 1, perceptually uniform.
fn heat(weight: f64) -> Colour {
    let steps = [
        [0.27, 0.0, 0.33],
        [0.23, 0.32, 0.55],
        [0.13, 0.57, 0.55],
        [0.37, 0.79, 0.38],
        [0.99, 0.91, 0.14],
    ];
    between(&steps, weight)
}

/// From red for the thinnest layers to blue for the thickest, as in the paper.
fn thickness(part: f64) -> Colour {
    let steps = [
        [0.78, 0.16, 0.21],
        [0.99, 0.73, 0.40],
        [0.69, 0.84, 0.89],
        [0.21, 0.38, 0.67],
    ];
    between(&steps, part)
}

fn between(steps: &[Colour], part: f64) -> Colour {
    let place = part.clamp(0.0, 1.0) * (steps.len() - 1) as f64;
    let first = (place as usize).min(steps.len() - 2);
    let part = place - first as f64;
    let [from, to] = [steps[first], steps[first + 1]];
    [0, 1, 2].map(|channel| from[channel] + (to[channel] - from[channel]) * part)
}

/// The weight a user might paint on a facet: the face, fading out around it.
fn paint(facet: &[Vec3; 3]) -> f32 {
    let middle = (facet[0] + facet[1] + facet[2]) / 3.0;
    let [x, z] = [middle.x / 0.52, (middle.z + 0.08) / 0.62];
    let off = (x * x + z * z).sqrt();
    if middle.y < 0.0 {
        (2.2 - 1.6 * off).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// Plans within the default tolerance, or with at most `max_layers`.
fn plan(slicer: &mut Slicer, saliency: bool, max_layers: Option<usize>) -> Report {
    let options = Options {
        height_mm: Some(HEIGHT_MM),
        backend: Backend::Cpu,
        rays: 1024,
        saliency,
        max_layers,
        weight_min: 0.1,
        ..Options::default()
    };
    pollster::block_on(slicer.plan(&options, &mut quiet))
        .expect("a plan")
        .clone()
}

fn main() {
    let facets = models::head(170);
    let mut slicer = Slicer::load(&solids::binary_stl(&facets)).expect("the head");
    let plain = plan(&mut slicer, false, None);
    let salient = slicer.saliency(&mut quiet).expect("saliency").to_vec();
    let painted: Vec<f32> = facets.iter().map(paint).collect();
    slicer.set_weights(Some(painted.clone())).expect("paint");
    let weighted = plan(&mut slicer, true, Some(plain.layers));

    let mesh = Mesh::from_triangles(&facets).expect("a mesh");
    let mut picture = Picture::new(5, mesh.bounds().size());
    picture.add(&facets, |facet, _| heat(f64::from(salient[facet])));
    picture.add(&facets, |facet, _| heat(f64::from(painted[facet])));
    picture.add(&facets, |facet, _| {
        heat(f64::from(salient[facet] * painted[facet]))
    });
    for report in [&plain, &weighted] {
        picture.add(&facets, |_, height| {
            let z_mm = height * HEIGHT_MM;
            let layer = report
                .z_mm
                .partition_point(|&z| z <= z_mm)
                .clamp(1, report.layers)
                - 1;
            thickness((report.thickness_mm[layer] - 0.05) / 0.1)
        });
    }
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    std::fs::write(docs.join("weights.png"), picture.png()).expect("docs/weights.png");

    let mut text = format!(
        "# Weighted models\n\n\
         Written by `cargo xtask bench weights`: a generated head of {} facets, {HEIGHT_MM} mm high, layers of 50 to 150 µm, \
         cusp height within 65 µm. The weighted plan may have as many layers as the plain plan, and has the smallest weighted error \
         that these allow; the minimum weight is 0.1. It needs {} of {} layers: only layers thinner than 50 µm would lower the \
         weighted error further.\n\n\
         ![Saliency, paint and their product as heat maps; plans without and with weights](weights.png)\n\n\
         From left to right: mesh saliency, painted weights and their product (figure 6; yellow is 1, violet 0); the layers of \
         the plain plan and of the weighted plan (figures 1 and 7; red is 50 µm, blue 150 µm).\n\n\
         | plan | layers | print time | largest weighted error | largest cusp height anywhere |\n\
         |---|---:|---:|---:|---:|\n",
        facets.len(),
        weighted.layers,
        plain.layers
    );
    for (name, report) in [("plain", &plain), ("weighted", &weighted)] {
        let _ = writeln!(
            text,
            "| {name} | {} | {:.0} min | {:.4} mm | {:.4} mm |",
            report.layers,
            report.print_time_s / 60.0,
            report.max_error,
            report.max_error_mm
        );
    }
    text.push_str("\n## What saliency costs\n\nOn one thread; minimum of three runs.\n\n| facets | s |\n|---:|---:|\n");
    let one = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .expect("a thread");
    for rings in [40, 80, 160, 320] {
        let mesh = Mesh::from_triangles(&models::head(rings)).expect("a mesh");
        let seconds = (0..ROUNDS).map(|_| {
            let clock = Instant::now();
            one.install(|| saliency(&mesh, &mut silent))
                .expect("saliency");
            clock.elapsed().as_secs_f64()
        });
        let least = seconds.fold(f64::INFINITY, f64::min);
        let _ = writeln!(text, "| {} | {least:.2} |", mesh.surface_facets);
    }
    println!("{text}");
    std::fs::write(docs.join("weights.md"), text).expect("docs/weights.md");
}
