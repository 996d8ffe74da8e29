//! Filament roundness against closed forms and a loop over facets and bins.

use crate::common::Slicer;
use crate::common::{assert_near, binary_stl, on_plate, oracle, quiet, solids};
use cusp_slicer::grid::Bins;
use cusp_slicer::job::{Backend, Options, Planner, Snap};
use cusp_slicer::profile::{Metric, Source};

/// Measurement of Wasserfall, Hendrich and Zhang on vertical walls.
const WALL: f64 = 0.184;
const BIN_MM: f64 = 0.02;

fn options() -> Options {
    Options {
        metric: Metric::FilamentRoundness,
        rays: 200,
        snap: Snap::Off,
        bin_mm: Some(BIN_MM),
        backend: Backend::Cpu,
        ..Options::default()
    }
}

/// The densities of a plan's profile.
fn densities(triangles: &solids::Triangles, weight: Option<f32>, source: Source) -> Vec<f32> {
    let mut slicer = Slicer::load(&binary_stl(triangles)).unwrap();
    let facets = slicer.info().facets;
    slicer
        .set_weights(weight.map(|weight| vec![weight; facets]))
        .unwrap();
    let options = Options {
        planner: Planner::Uniform { layer_mm: 0.1 },
        source,
        ..options()
    };
    pollster::block_on(slicer.plan(&options, &mut quiet)).unwrap();
    slicer
        .profile(Metric::FilamentRoundness, source)
        .unwrap()
        .density
}

#[test]
fn a_wall_has_0_184_of_the_thickness_of_the_layer() {
    let cylinder = solids::cylinder(5.0, 6.0, 30);
    for source in [Source::Exact, Source::Sampled] {
        let found = densities(&cylinder, None, source);
        assert_eq!(found.len(), 300);
        // The flats are at both ends.
        assert_eq!((found[0], found[299]), (1.0, 1.0));
        assert!(found[1..299].iter().all(|&density| density == 0.184));
    }
    // A facet of a quarter of the weight may have four times the error.
    let found = densities(&cylinder, Some(0.25), Source::Exact);
    assert!(found[1..299].iter().all(|&density| density == 0.046));
}

#[test]
fn a_cone_has_its_slope_or_that_of_a_wall() {
    // |n_z| is r / √(r² + h²): 0.6, and 0.0995, which is less than that of a wall.
    for (radius, height, expected) in [(6.0, 8.0, 0.6), (1.0, 10.0, WALL)] {
        let found = densities(&solids::cone(radius, height, 60), None, Source::Exact);
        for &density in &found[1..] {
            assert_near(f64::from(density), expected, 2e-3);
        }
    }
}

#[test]
fn densities_are_those_of_a_loop_over_facets_and_bins() {
    for (name, triangles) in solids::all() {
        let found = densities(&triangles, None, Source::Exact);
        let mesh = on_plate(&triangles);
        let bins = Bins::of_height(mesh.bounds().size().z, BIN_MM).unwrap();
        assert_eq!(found.len(), bins.count, "{name}");
        // Facets that the solid hides are left out, and the loop does not know them.
        let has_hidden = ["overlapping spheres", "stacked cubes", "doubled sphere"].contains(&name);
        let expected = oracle::steepest(&mesh, bins, |_| true);
        for (found, expected) in found.iter().zip(&expected) {
            let (found, expected) = (f64::from(*found), expected.max(WALL));
            assert!(found <= expected + 1e-5, "{name}");
            assert!(has_hidden || found >= expected - 1e-5, "{name}");
        }
    }
}

/// The error of a layer is the larger of that of the cusp and 0.184 of its thickness, if the surface is the same all
/// the way through it.
#[test]
fn thick_layers_on_walls_are_limited_by_their_threads() {
    let mut slicer = Slicer::load(&binary_stl(&solids::cylinder(5.0, 12.0, 30))).unwrap();
    for (tolerance, thickest_mm) in [(0.0369, 0.2), (0.0295, 0.16), (0.0553, 0.3)] {
        let options = Options {
            layer_min_mm: Some(0.02),
            layer_max_mm: Some(0.4),
            tolerance: Some(tolerance),
            ..options()
        };
        let report = pollster::block_on(slicer.plan(&options, &mut quiet)).unwrap();
        let thickest = report.thickness_mm.iter().copied().fold(0.0, f64::max);
        assert_near(thickest, thickest_mm, 1e-9);
        let cusp = Options {
            metric: Metric::Cusp,
            ..options
        };
        let report = pollster::block_on(slicer.plan(&cusp, &mut quiet)).unwrap();
        let thickest = report.thickness_mm.iter().copied().fold(0.0, f64::max);
        assert_near(thickest, 0.4, 1e-9);
    }
}

#[test]
fn its_name_of_earlier_versions_is_read() {
    let options: Options = serde_json::from_str(r#"{ "metric": "thread" }"#).unwrap();
    assert_eq!(options.metric, Metric::FilamentRoundness);
    let written = serde_json::to_value(&options).unwrap();
    assert_eq!(written["metric"], "filament-roundness");
}
