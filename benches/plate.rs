//! Time and fill of plates of several models: `cargo xtask bench plate [MODEL.stl …]`.
//!
//! Prints tables in Markdown: copies of one model against one, forty different models, and shadows against boxes for the models
//! named. Times are the minimum of several runs.

#[path = "common/mod.rs"]
#[expect(dead_code, reason = "other benches use the rest")]
mod common;
#[path = "../tests/common/solids.rs"]
#[expect(dead_code, reason = "the tests use the other solids")]
mod solids;

use common::{named, time};
use cusp_slicer::arrange::Arranging;
use cusp_slicer::job::{Job, JobOptions, LoadedModel, ModelOptions, Options, Placement};
use cusp_slicer::model::Mesh;
use cusp_slicer::printer::PrinterChoice;
use glam::Vec3;

/// A plate of 219 × 123 mm in pixels of 19 × 24 µm.
const PRINTER: &str = "saturn-3-ultra";

fn job(models: Vec<ModelOptions>) -> JobOptions {
    JobOptions {
        options: Options {
            printer: Some(PrinterChoice::Named(PRINTER.to_owned())),
            ..Options::default()
        },
        models,
        ..JobOptions::default()
    }
}

fn quiet(_: cusp_slicer::job::Stage, _: f64) -> std::ops::ControlFlow<()> {
    std::ops::ControlFlow::Continue(())
}

fn load(triangles: &solids::Triangles) -> LoadedModel {
    LoadedModel::read(&solids::binary_stl(triangles)).expect("a model")
}

/// Seconds to the plan and to the masks, from models that are read, and to another plan within another tolerance.
fn seconds(models: &[solids::Triangles], options: &JobOptions) -> [f64; 3] {
    let read = || Job::new(models.iter().map(load).collect());
    let mut read_s = time(|| drop(read())).0;
    let (plan_s, ()) = time(|| {
        let mut plate = read();
        pollster::block_on(plate.plan(options, &mut quiet)).expect("a plan");
    });
    let (mask_s, ()) = time(|| {
        let mut plate = read();
        pollster::block_on(plate.plan(options, &mut quiet)).expect("a plan");
        plate.mask(0, 0).expect("a mask");
    });
    read_s = read_s.min(plan_s);
    let mut planned = read();
    pollster::block_on(planned.plan(options, &mut quiet)).expect("a plan");
    let mut tolerance = 0.06;
    let (again_s, ()) = time(|| {
        // Each plan differs from the last, which would be kept.
        tolerance += 1e-5;
        let mut other = options.clone();
        other.options.tolerance = Some(tolerance);
        pollster::block_on(planned.plan(&other, &mut quiet)).expect("another plan");
    });
    [plan_s - read_s, mask_s - read_s, again_s]
}

fn copies(count: usize, height_mm: f64) -> ModelOptions {
    ModelOptions {
        copies: count,
        height_mm: Some(height_mm),
        ..ModelOptions::default()
    }
}

fn main() {
    println!(
        "| copies of a ball of 9 mm, 80,000 facets | to the plan, s | to the masks, s | to another plan, s |"
    );
    println!("|---|---:|---:|---:|");
    let ball = vec![solids::sphere(5.0, 7)];
    let mut first = None;
    for count in [1, 10, 100] {
        let [plan_s, masks_s, again_s] = seconds(&ball, &job(vec![copies(count, 9.0)]));
        let [one_plan_s, one_masks_s] = *first.get_or_insert([plan_s, masks_s]);
        let (plans, masks) = (plan_s / one_plan_s, masks_s / one_masks_s);
        println!(
            "| {count} | {plan_s:.3} ({plans:.2} ×) | {masks_s:.3} ({masks:.2} ×) | {again_s:.3} |"
        );
    }

    let kinds = [
        solids::sphere(5.0, 6),
        solids::gyroid(2, 24),
        solids::cone(4.0, 8.0, 400),
        solids::crossing_roofs(),
    ];
    let models: Vec<_> = (0..40)
        .map(|model: usize| kinds[model % 4].clone())
        .collect();
    let facets: usize = models.iter().map(Vec::len).sum();
    let heights = (0..40).map(|model: u32| copies(1, 6.0 + 0.25 * f64::from(model)));
    let options = job(heights.collect());
    let [plan_s, masks_s, again_s] = seconds(&models, &options);
    println!(
        "\n40 models of {facets} facets in all: {plan_s:.2} s to the plan, {masks_s:.2} s to the masks, {again_s:.3} s to another plan"
    );

    println!("\n| 60 mm high | plates of 50 by shadows | by boxes | arranged in, s |");
    println!("|---|---:|---:|---:|");
    let l_shape = {
        let mut l_shape = solids::cuboid(Vec3::new(40.0, 8.0, 10.0));
        l_shape.extend(solids::cuboid(Vec3::new(8.0, 40.0, 10.0)));
        l_shape
    };
    let arm = [("an L of 40 mm".to_owned(), l_shape)];
    for (name, triangles) in arm
        .into_iter()
        .chain(named().map(|(name, mesh)| (name, of(&mesh))))
    {
        let options = JobOptions {
            arranging: Arranging::default(),
            ..job(vec![ModelOptions {
                copies: 50,
                ..ModelOptions::default()
            }])
        };
        let mut plate = Job::new(vec![load(&triangles)]);
        let (seconds, places) = time(|| plate.arrange(&options));
        let plates = |places: &[Placement]| places.last().map_or(0, |place| place.plate + 1);
        let boxed = Job::new(vec![load(&box_of(&triangles))]).arrange(&options);
        match (places, boxed) {
            (Ok(places), Ok(boxed)) => {
                println!(
                    "| {name} | {} | {} | {seconds:.2} |",
                    plates(&places),
                    plates(&boxed)
                );
            }
            (Err(error), _) | (_, Err(error)) => println!("| {name} | {error} | | |"),
        }
    }
}

fn of(mesh: &Mesh) -> solids::Triangles {
    let facets = mesh.facets[..mesh.surface_facets].iter();
    facets
        .map(|corners| corners.map(|vertex| mesh.vertices[vertex as usize]))
        .collect()
}

/// The box around a model.
fn box_of(triangles: &solids::Triangles) -> solids::Triangles {
    let corners = || triangles.iter().flatten().copied();
    let least = corners().reduce(Vec3::min).unwrap_or_default();
    let most = corners().reduce(Vec3::max).unwrap_or_default();
    solids::cuboid(most - least)
}
