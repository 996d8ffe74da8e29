//! Pixels and bins: decimal lengths, which are not binary fractions, still give the counts that users expect.

use crate::common::{on_plate, solids};
use cusp_slicer::grid::{Bins, Grid, GridError};
use glam::Vec3;

#[test]
fn decimal_lengths_are_whole_bins() {
    for (bin_mm, length_mm, count) in [
        (0.002, 0.05, 25),
        (0.002, 0.15, 75),
        (0.001, 23.771, 23_771),
        (0.01, 0.07, 7),
    ] {
        let bins = Bins::of_height(60.0, bin_mm).unwrap();
        assert_eq!(bins.ceil(length_mm) as u32, count);
        assert_eq!(bins.floor(length_mm) as u32, count);
    }
    assert_eq!(Bins::of_height(60.0, 0.002).unwrap().count, 30_000);
    assert_eq!(Bins::of_height(60.001, 0.002).unwrap().count, 30_001);
}

#[test]
fn a_bin_is_open_below_and_closed_above() {
    let bins = Bins::of_height(1.0, 0.25).unwrap();
    let found = [0.0, 0.1, 0.25, 0.2501, 1.0, 1.2].map(|z_mm| bins.of(z_mm));
    assert_eq!(found, [0, 0, 0, 1, 3, 3]);
}

#[test]
fn heights_of_single_precision_stay_in_their_bins() {
    for bin_mm in [0.001, 0.002, 0.01] {
        for step in (1..30_000).step_by(7) {
            let z_mm = f64::from((f64::from(step) * 0.01) as f32);
            let bins = Bins::of_height(z_mm, bin_mm).unwrap();
            let expected = (f64::from(step) * 0.01 / bin_mm).round() as usize;
            assert_eq!(bins.count, expected, "{z_mm} mm in bins of {bin_mm} mm");
            let above = Bins {
                count: expected + 10,
                size_mm: bin_mm,
            };
            assert_eq!(above.of(z_mm), expected - 1);
        }
    }
}

#[test]
fn the_default_grid_fits_the_longer_side() {
    let bounds = on_plate(&solids::cuboid(Vec3::new(10.0, 4.99, 3.0))).bounds();
    let grid = Grid::around(&bounds, 100).unwrap();
    assert_eq!((grid.width, grid.height, grid.pitch_mm), (100, 50, 0.1));
}

#[test]
fn a_model_beyond_the_plate_is_refused_with_a_scale_that_fits() {
    let bounds = on_plate(&solids::cuboid(Vec3::new(10.0, 20.0, 3.0))).bounds();
    let Err(GridError::ModelTooLarge { fitting_scale, .. }) =
        Grid::plate(&bounds, [100, 160], [0.1; 2])
    else {
        panic!("a model that is too large was accepted");
    };
    assert_eq!(fitting_scale, 0.8);
    assert!(Grid::plate(&bounds, [100, 200], [0.1; 2]).is_ok());
}

#[test]
fn sizes_and_lengths_are_checked() {
    let bounds = on_plate(&solids::cube(1.0)).bounds();
    assert!(matches!(
        Grid::around(&bounds, 0),
        Err(GridError::BadSize { .. })
    ));
    assert!(matches!(
        Grid::around(&bounds, 40_000),
        Err(GridError::BadSize { .. })
    ));
    for pitch_mm in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            Grid::plate(&bounds, [10, 10], [pitch_mm; 2]),
            Err(GridError::Quantity(_))
        ));
    }
    assert!(matches!(
        Bins::of_height(1.0, 0.0),
        Err(GridError::Quantity(_))
    ));
    assert!(matches!(
        Bins::of_height(1e9, 1e-3),
        Err(GridError::TooManyBins { .. })
    ));
}
