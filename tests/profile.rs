//! The sampled cusp height profile of solids against their closed forms.

#![cfg(not(target_arch = "wasm32"))]

mod common;

use common::{assert_near, sample, solids};
use cusp_slicer::grid::Bins;
use cusp_slicer::profile::{Profile, cusp};

fn profile_of(triangles: &solids::Triangles, bin_mm: f64) -> Profile {
    let (mesh, ldi) = sample(triangles, 500);
    let bins = Bins::of_height(mesh.bounds().size().z, bin_mm).unwrap();
    cusp::sampled(&mesh, &ldi, bins)
}

#[test]
fn upright_walls_have_no_density_and_flats_have_all() {
    for triangles in [solids::cube(10.0), solids::cylinder(8.0, 10.0, 32)] {
        let profile = profile_of(&triangles, 0.1);
        assert_eq!(profile.density.len(), 100);
        assert_eq!((profile.density[0], profile.density[99]), (1.0, 1.0));
        assert!(profile.density[1..99].iter().all(|&density| density == 0.0));
    }
}

#[test]
fn caps_over_holes_have_no_part_in_the_profile() {
    let mut triangles = solids::cube(10.0);
    triangles.drain(0..2); // the bottom
    let profile = profile_of(&triangles, 0.1);
    assert_eq!((profile.density[0], profile.density[99]), (0.0, 1.0));
}

#[test]
fn a_cone_has_the_density_of_its_slope_everywhere() {
    let profile = profile_of(&solids::cone(6.0, 8.0, 64), 0.1);
    assert_eq!(profile.density[0], 1.0);
    for &density in &profile.density[1..] {
        assert_near(f64::from(density), 0.6, 1e-3);
    }
}

#[test]
fn a_sphere_has_the_density_of_its_height() {
    let profile = profile_of(&solids::sphere(10.0, 7), 0.2);
    for (bin, &density) in profile.density.iter().enumerate() {
        // The largest |n_z| in a bin is at its end away from the middle.
        let ends = [bin as f64, bin as f64 + 1.0].map(|end| (end * 0.2 - 10.0).abs() / 10.0);
        assert_near(f64::from(density), ends[0].max(ends[1]), 0.012);
    }
}

#[test]
fn errors_of_layers_are_sums_of_densities() {
    let bins = Bins::of_height(0.5, 0.1).unwrap();
    let errors = Profile {
        bins,
        density: vec![0.2, 0.4, 0.0, 1.0, 0.3],
    }
    .error_sum();
    let error_mm = |lower, upper| errors.to_mm(errors.steps_between(lower, upper));
    assert_near(error_mm(0, 5), 0.19, 1e-9);
    assert_near(error_mm(1, 4), 0.14, 1e-9);
    assert_near(error_mm(2, 3), 0.0, 0.0);
    // Nothing lies above the last bin.
    assert_near(error_mm(4, 9), 0.03, 1e-9);
    assert_eq!(errors.to_steps(errors.to_mm(1234)), 1234);
}
