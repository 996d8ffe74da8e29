//! Promises of reports, compared with the solid that the print file prints.

use crate::common::Slicer;
use cusp_slicer::format::Format;
use cusp_slicer::job::{Backend, Minimize, Options, Planner, Report, Snap};
use cusp_slicer::profile::Metric;
use cusp_slicer::simulation::{Knowledge, Simulation};
use glam::Vec3;

use super::measured;
use crate::common::solids::{self, Triangles};
use crate::common::{binary_stl, quiet};

fn options() -> Options {
    Options {
        pitch_mm: Some(0.02),
        format: Some(Format::Png),
        backend: Backend::Cpu,
        ..Options::default()
    }
}

/// The report of a print, and what its print file prints.
fn printed(triangles: &Triangles, options: &Options) -> (Report, Simulation) {
    let mut slicer = Slicer::load(&binary_stl(triangles)).unwrap();
    let report = pollster::block_on(slicer.plan(options, &mut quiet)).unwrap();
    let report = report.clone();
    let (bytes, _) = slicer.write_archive(Vec::new(), &mut quiet).unwrap();
    (report, measured(triangles, &bytes, &Knowledge::default()))
}

/// The solid at half its size: an eighth of the pixels of all layers, which are as large as before.
fn halved(triangles: &[[Vec3; 3]]) -> Triangles {
    let facets = triangles.iter();
    facets.map(|it| it.map(|corner| corner * 0.5)).collect()
}

/// Asserts that no point of the print is farther from the model than the report says, but for the pixels.
fn holds(name: &str, triangles: &Triangles, options: &Options) -> (Report, Simulation) {
    let (report, simulation) = printed(triangles, options);
    let bound_mm = report.max_deviation_mm + simulation.half_pixel_diagonal_mm;
    let found_mm = simulation.print_to_model.max_mm;
    assert!(
        found_mm <= bound_mm,
        "{name}: {found_mm} at {:?}, not within {bound_mm}",
        simulation.print_to_model.at_mm
    );
    (report, simulation)
}

#[test]
fn no_point_of_a_print_is_farther_from_the_model_than_its_tolerance() {
    for (name, triangles) in solids::all() {
        let options = Options {
            metric: Metric::Deviation,
            ..options()
        };
        let (report, simulation) = holds(name, &halved(&triangles), &options);
        assert!(report.max_deviation_mm <= 0.0325 + 1e-9, "{name}");
        // A model of one body without thin parts is as near to the print.
        if ["cube", "sphere", "cylinder", "cone", "inverted sphere"].contains(&name) {
            let bound_mm = 0.0325 + simulation.half_pixel_diagonal_mm;
            let found_mm = simulation.model_to_print.max_mm;
            assert!(found_mm <= bound_mm, "{name}: {found_mm}");
        }
    }
}

#[test]
fn reports_bound_the_distance_under_every_metric_and_planner() {
    let (ball, frame) = (solids::sphere(2.5, 5), halved(&solids::frame()));
    for metric in Metric::ALL {
        let options = Options {
            metric,
            snap: Snap::Off,
            minimize: Minimize::Time,
            ..options()
        };
        holds(metric.name(), &ball, &options);
    }
    for planner in [
        Planner::Greedy,
        Planner::Local,
        Planner::Finest,
        Planner::Coarsest,
        Planner::Uniform { layer_mm: 0.1 },
    ] {
        let options = Options {
            planner,
            ..options()
        };
        for (name, triangles) in [("ball", &ball), ("frame", &frame)] {
            holds(&format!("{name}, {}", planner.name()), triangles, &options);
        }
    }
}

#[test]
fn the_tolerance_holds_whatever_thicknesses_are_allowed() {
    let (ball, frame) = (solids::sphere(2.5, 5), halved(&solids::frame()));
    let rules: [fn(&mut Options); 4] = [
        |it| it.thicknesses_mm = vec![0.05, 0.08, 0.12],
        |it| it.max_thicknesses = Some(2),
        |it| it.max_change_mm = Some(0.004),
        |it| it.first_layer_mm = Some(0.2),
    ];
    for set in rules {
        let mut options = Options {
            metric: Metric::Deviation,
            ..options()
        };
        set(&mut options);
        for (name, triangles) in [("ball", &ball), ("frame", &frame)] {
            let (report, _) = holds(name, triangles, &options);
            assert!(report.max_error <= 0.0325 + 1e-9, "{name} {options:?}");
            // A first layer of 0.2 mm is farther from the ball than any other, and the report says so.
            let is_exempt = options.first_layer_mm.is_some() && name == "ball";
            let most_mm = report.max_deviation_mm;
            assert_eq!(most_mm > 0.0325 + 1e-9, is_exempt, "{name} {options:?}");
        }
    }
}

#[test]
fn the_tolerance_holds_along_the_creases_of_crossing_bodies() {
    // And two cones side by side.
    let mut cones = solids::cone(5.0, 10.0, 16);
    let other = solids::cone(5.0, 10.0, 13);
    cones.extend(solids::moved(&other, Vec3::new(6.0, 0.0, 0.0)));
    for (name, triangles) in [("roofs", solids::crossing_roofs()), ("cones", cones)] {
        let options = Options {
            metric: Metric::Deviation,
            ..options()
        };
        let (report, _) = holds(name, &triangles, &options);
        assert!(report.max_deviation_mm <= 0.0325 + 1e-9, "{name}");
    }
}

#[test]
fn the_report_of_a_cusp_height_says_how_far_its_print_is_from_the_model() {
    // Without planes at its flats, a print by cusp height is farther from the model than half its tolerance.
    let stairs = solids::profiled(
        &[
            [0.0, 0.0],
            [9.0, 0.0],
            [9.0, 2.03],
            [6.0, 2.03],
            [6.0, 4.07],
            [3.0, 4.07],
            [3.0, 6.11],
            [0.0, 6.11],
        ],
        5.0,
    );
    let options = Options {
        snap: Snap::Off,
        ..options()
    };
    let (report, simulation) = holds("stairs", &stairs, &options);
    assert!(report.max_error_mm <= 0.065);
    assert!(
        simulation.print_to_model.max_mm > 0.04,
        "{:?}",
        simulation.print_to_model.max_mm
    );
}
