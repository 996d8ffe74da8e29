//! Time of profiles and plans: `cargo xtask bench plan`.
//!
//! Prints tables in Markdown. Times are the minimum of several runs, on one core.

#[path = "../tests/common/solids.rs"]
#[expect(dead_code, reason = "the tests use the other solids")]
mod solids;

use std::hint::black_box;
use std::time::Instant;

use cusp_slicer::grid::Bins;
use cusp_slicer::model::{Mesh, Pose};
use cusp_slicer::plan::optimal::{self, Objective};
use cusp_slicer::plan::snap_cost::SnapPlanes;
use cusp_slicer::plan::thicknesses::{self, DEFAULT_STEPS};
use cusp_slicer::plan::tradeoff;
use cusp_slicer::plan::{Limits, Plan, gradual, greedy, least_sum};
use cusp_slicer::profile::deviation::DeviationError;
use cusp_slicer::profile::facet_bins::FacetBins;
use cusp_slicer::profile::{LayerErrors, Metric, Profile, Shape, normal_cones, section, steepest};
use cusp_slicer::progress::silent;
use cusp_slicer::resin::Resin;
use glam::Vec3;

/// The time budget of one figure; its first run may exceed it.
const BUDGET_S: f64 = 0.5;

/// The minimum time of several runs in milliseconds, and the last result.
fn time<T>(mut work: impl FnMut() -> T) -> (f64, T) {
    let all = Instant::now();
    let mut least = f64::INFINITY;
    loop {
        let clock = Instant::now();
        let result = black_box(work());
        least = least.min(clock.elapsed().as_secs_f64());
        if all.elapsed().as_secs_f64() > BUDGET_S {
            return (least * 1e3, result);
        }
    }
}

/// Procedure 1 as printed in the paper, including the sum in line 5. Returns the number of layers.
fn procedure_1(density: &[f32], tolerance: f32, least: usize, greatest: usize) -> Option<u32> {
    let count = density.len();
    let mut k = vec![u32::MAX; count + 1];
    k[0] = 0;
    for i in 1..=count {
        for l in i.saturating_sub(greatest)..=i.saturating_sub(least) {
            if i - l >= least && density[l..i].iter().sum::<f32>() <= tolerance && k[l] != u32::MAX
            {
                k[i] = k[i].min(k[l] + 1);
            }
        }
    }
    Some(k[count]).filter(|&layers| layers != u32::MAX)
}

/// Procedure 1 with prefix sums, the usual implementation.
fn procedure_1_with_sums(
    density: &[f32],
    tolerance: f64,
    least: usize,
    greatest: usize,
) -> Option<u32> {
    let mut sums = vec![0.0];
    for &value in density {
        sums.push(sums[sums.len() - 1] + f64::from(value));
    }
    let count = density.len();
    let mut k = vec![u32::MAX; count + 1];
    k[0] = 0;
    for i in 1..=count {
        for l in i.saturating_sub(greatest)..=i.saturating_sub(least) {
            if i - l >= least && sums[i] - sums[l] <= tolerance && k[l] != u32::MAX {
                k[i] = k[i].min(k[l] + 1);
            }
        }
    }
    Some(k[count]).filter(|&layers| layers != u32::MAX)
}

/// A row of spheres, which have all slopes.
fn balls(levels: u32, count: usize) -> Mesh {
    let ball = solids::sphere(10.0, levels);
    let place = |i: usize| Vec3::new(0.0, 3.0, 20.0) * i as f32;
    let triangles: Vec<_> = (0..count)
        .flat_map(|i| solids::moved(&ball, place(i)))
        .collect();
    Mesh::from_triangles(&triangles)
        .unwrap()
        .on_plate(&Pose::of_height(60.0))
        .unwrap()
}

fn main() {
    planners();
    profiles();
}

fn planners() {
    println!(
        "Planners, N = 23,771 bins of 1 µm, layers of 50 to 150 µm, cusp height within 65 µm\n"
    );
    let bins = Bins {
        count: 23_771,
        size_mm: 0.001,
    };
    let mesh = balls(6, 3).on_plate(&Pose::of_height(23.771)).unwrap();
    let shape = Shape {
        bins,
        steepest: steepest::exact(&FacetBins::of(&mesh, bins), &[]),
        cones: cone_maxima(&mesh, bins),
        areas_mm2: section::exact(&mesh, &[], bins),
    };
    let profile: Profile = shape.profile(Metric::Cusp);
    let errors = shape.errors(Metric::Cusp);
    let volumes = shape.errors(Metric::Volume);
    let deviations = shape.errors(Metric::Deviation);
    let resin = Resin::default();
    let limits = Limits {
        layer_min_mm: 0.05,
        layer_max_mm: 0.15,
        tolerance: 0.065,
        ..Limits::default()
    };
    let wide = Limits {
        tolerance: 1.0,
        ..limits.clone()
    };
    let best = |errors: &LayerErrors, limits: &Limits, objective| {
        optimal::plan(errors, limits, SnapPlanes::NONE, objective)
            .as_ref()
            .map_or(0, Plan::layers)
    };
    let (literal_ms, literal) = time(|| procedure_1(&profile.density, 65.0, 50, 150));
    let (sums_ms, with_sums) = time(|| procedure_1_with_sums(&profile.density, 65.0, 50, 150));
    let (linear_ms, linear) = time(|| best(&errors, &limits, Objective::Layers));
    assert_eq!(with_sums.map(|layers| layers as usize), Some(linear));
    println!("| planner | ms | layers | speed-up over Procedure 1 |");
    println!("|---|---:|---:|---:|");
    let row = |name: &str, ms: f64, layers: usize| {
        println!("| {name} | {ms:.3} | {layers} | {:.0} |", literal_ms / ms);
    };
    row(
        "Procedure 1, literally",
        literal_ms,
        literal.unwrap_or(0) as usize,
    );
    row(
        "Procedure 1 with prefix sums",
        sums_ms,
        with_sums.unwrap_or(0) as usize,
    );
    row("optimal, fewest layers", linear_ms, linear);
    let (ms, layers) = time(|| best(&errors, &limits, Objective::Time(&resin)));
    row("optimal, shortest time", ms, layers);
    let near = Limits {
        tolerance: 0.0325,
        ..limits.clone()
    };
    let (ms, layers) = time(|| best(&deviations, &near, Objective::Layers));
    row("optimal, deviation", ms, layers);
    let (ms, layers) = time(|| best(&volumes, &wide, Objective::Layers));
    row("optimal, volume deviation", ms, layers);
    let (ms, plan) = time(|| greedy::plan(&errors, &limits, &[], greedy::Sight::Profile));
    row("greedy on the profile", ms, plan.unwrap().layers());
    let (ms, curve) = time(|| {
        tradeoff::curve(
            &errors,
            &limits,
            SnapPlanes::NONE,
            Objective::Layers,
            &resin,
            100,
        )
        .unwrap()
    });
    beyond(&errors, &volumes, &limits, &wide, row);
    println!("\nTrade-off curve of {} plans: {ms:.1} ms\n", curve.len());
}

/// The planners beyond the paper, each as a row.
fn beyond(
    errors: &LayerErrors,
    volumes: &LayerErrors,
    limits: &Limits,
    wide: &Limits,
    row: impl Fn(&str, f64, usize),
) {
    let given = [0.05, 0.1, 0.15];
    let (ms, plan) = time(|| thicknesses::of(errors, limits, &given));
    row(
        "given thicknesses of 50, 100 and 150 µm",
        ms,
        plan.map_or(0, |plan| plan.layers()),
    );
    for count in 1..=4 {
        let (ms, found) =
            time(|| thicknesses::at_most(errors, limits, count, DEFAULT_STEPS, &mut silent));
        let layers = found
            .ok()
            .and_then(Result::ok)
            .map_or(0, |found| found.plan.layers());
        row(&format!("at most {count} thicknesses"), ms, layers);
    }
    let (ms, plan) = time(|| gradual::plan(errors, limits, 0.01));
    row(
        "gradual, changes within 10 µm",
        ms,
        plan.map_or(0, |plan| plan.layers()),
    );
    let (ms, plans) = time(|| least_sum::plans(volumes, wide, 500));
    let fewest = plans
        .ok()
        .and_then(|plans| Some(plans.first()?.plan.layers()));
    row(
        "least sum of volume deviations, up to 500 layers",
        ms,
        fewest.unwrap_or(0),
    );
}

/// The largest `n_z²` over the normal cones in each bin.
fn cone_maxima(mesh: &Mesh, bins: Bins) -> Vec<f32> {
    let steepest = steepest::exact(&FacetBins::of(mesh, bins), &[]);
    normal_cones::maxima(&steepest, &normal_cones::cones(mesh, bins), |_| true)
}

fn profiles() {
    println!("Exact profile and plan of a model of 60 mm, 30,000 bins of 2 µm\n");
    println!(
        "| facets | steepest ms | areas ms | cusp profile + plan ms | layers | cones ms | deviation profile + plan ms | layers |"
    );
    println!("|---:|---:|---:|---:|---:|---:|---:|---:|");
    let limits = Limits {
        layer_min_mm: 0.05,
        layer_max_mm: 0.15,
        tolerance: 0.065,
        ..Limits::default()
    };
    for (levels, count) in [(5, 1), (6, 1), (6, 3), (7, 3), (8, 2)] {
        let mesh = balls(levels, count);
        let bins = Bins::of_height(60.0, 0.002).unwrap();
        let (steepest_ms, _) = time(|| steepest::exact(&FacetBins::of(&mesh, bins), &[]));
        let (areas_ms, _) = time(|| section::exact(&mesh, &[], bins));
        let (all_ms, plan) = time(|| {
            let shape = Shape {
                bins,
                steepest: steepest::exact(&FacetBins::of(&mesh, bins), &[]),
                cones: Vec::new(),
                areas_mm2: Vec::new(),
            };
            optimal::plan(
                &shape.errors(Metric::Cusp),
                &limits,
                SnapPlanes::NONE,
                Objective::Layers,
            )
            .unwrap()
        });
        let (cones_ms, _) = time(|| normal_cones::cones(&mesh, bins));
        let near = Limits {
            tolerance: 0.0325,
            ..limits.clone()
        };
        let (deviation_ms, nearest) = time(|| {
            let errors = DeviationError::new(&cone_maxima(&mesh, bins), bins);
            let errors = LayerErrors::Deviation(errors);
            optimal::plan(&errors, &near, SnapPlanes::NONE, Objective::Layers).unwrap()
        });
        println!(
            "| {} | {steepest_ms:.2} | {areas_ms:.2} | {all_ms:.2} | {} | {cones_ms:.2} | {deviation_ms:.2} | {} |",
            mesh.facets.len(),
            plan.layers(),
            nearest.layers()
        );
    }
}
