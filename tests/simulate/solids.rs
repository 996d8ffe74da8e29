//! Solids whose distances from their prints have closed forms.

use cusp_slicer::model::Pose;
use cusp_slicer::simulation::Knowledge;
use glam::Vec3;

use super::{measured, slice, sliced_and_measured, uniform, with_manifest};
use crate::common::assert_near;
use crate::common::solids::{cone, cube, cuboid, inverted, moved, sphere};

#[test]
fn a_cube_of_whole_layers_is_printed_to_half_a_pixel() {
    for pitch_mm in [0.05, 0.043] {
        let found = sliced_and_measured(&cube(5.0), &uniform(0.1, pitch_mm));
        assert_eq!(found.layers, 50);
        assert_near(found.half_pixel_diagonal_mm, pitch_mm / 2f64.sqrt(), 1e-12);
        let most = found.half_pixel_diagonal_mm + 1e-6;
        assert!(found.print_to_model.max_mm <= most, "{pitch_mm}");
        assert!(found.model_to_print.max_mm <= most, "{pitch_mm}");
    }
}

#[test]
fn a_top_layer_that_is_too_high_shows_on_its_shelf_alone() {
    let file = slice(&cube(5.0), &uniform(0.1, 0.05));
    let file = with_manifest(&file, |manifest| {
        let layers = manifest["layer_files"].as_array_mut().unwrap();
        layers.last_mut().unwrap()["z_mm"] = 5.1.into();
    });
    let found = measured(&cube(5.0), &file, &Knowledge::default());
    let (print, model) = (&found.print_to_model, &found.model_to_print);
    assert_near(print.max_mm, 0.1, 1e-6);
    assert_near(print.at_mm[2], 5.1, 1e-9);
    assert_near(model.max_mm, 0.1, 1e-6);
    assert_near(model.at_mm[2], 5.0, 1e-6);
    let below = |layer: &cusp_slicer::simulation::LayerDeviation| layer.max_mm.unwrap() < 1e-6;
    assert!(print.layers[..49].iter().all(below));
    assert!(model.layers[..49].iter().all(below));
    // The shelf is 25 mm², the walls of the layer 20 · 0.2 mm², of which half rises above the model.
    let walls = (0.25 * 0.0 + 0.5 * 0.0 + 0.25 * 0.1) * 4.0;
    let mean = (25.0 * 0.1 + walls) / (25.0 + 4.0);
    assert_near(print.layers[49].mean_mm.unwrap(), mean, 0.004);
}

#[test]
fn a_cone_is_half_a_layer_off_times_the_sine_of_its_slope() {
    for (height, sine) in [(2.0, 0.5f64.sqrt()), (4.0, 0.2f64.sqrt())] {
        for layer_mm in [0.05, 0.1] {
            let found = sliced_and_measured(&cone(2.0, height, 32), &uniform(layer_mm, 0.01));
            let expected = layer_mm / 2.0 * sine;
            let slack = found.half_pixel_diagonal_mm;
            assert_near(found.print_to_model.max_mm, expected, slack);
        }
    }
}

#[test]
fn a_ball_is_half_a_layer_off_at_its_poles() {
    let found = sliced_and_measured(&sphere(2.0, 6), &uniform(0.1, 0.01));
    let slack = found.half_pixel_diagonal_mm;
    assert_near(found.print_to_model.max_mm, 0.05, slack);
    // Near a pole, where the ball is between a wall of radius 0.444 mm and the shelf 0.05 mm below, as far from both.
    assert_near(found.model_to_print.max_mm, 0.041, slack);
    // Between pole and equator, walls are off by up to half a layer times the sine; on average by half of that.
    let belt = found.print_to_model.layers.iter();
    let belt = belt.filter(|layer| (layer.z_mm - 2.0).abs() < 1.0);
    for layer in belt {
        let up = (layer.z_mm - 0.05 - 2.0).abs() / 2.0 + 0.025;
        // The ball curves by 0.05² / 2r within half a layer, and its facets are as far from round.
        let most = 0.05 * up + slack + 0.001;
        assert!(layer.max_mm.unwrap() <= most, "{layer:?}");
        assert!(layer.mean_mm.unwrap() <= layer.max_mm.unwrap());
    }
}

#[test]
fn a_plate_that_no_mask_shows_is_as_far_off_as_the_rest_is() {
    let block = cuboid(Vec3::new(4.0, 4.0, 2.0));
    // The middles of layers are at 0.95 and 1.05 mm.
    let plate = moved(
        &cuboid(Vec3::new(2.0, 4.0, 0.03)),
        Vec3::new(6.0, 0.0, 0.985),
    );
    let both = [block, plate].concat();
    let found = sliced_and_measured(&both, &uniform(0.1, 0.05));
    assert!(found.print_to_model.max_mm <= found.half_pixel_diagonal_mm + 1e-6);
    assert_near(
        found.model_to_print.max_mm,
        4.0,
        found.half_pixel_diagonal_mm,
    );
    let [x, _, z] = found.model_to_print.at_mm;
    assert_near(x, 4.0, 1e-5);
    assert_near(z, 1.0, 0.016);
}

#[test]
fn what_overlapping_bodies_hide_is_left_out() {
    let block = cube(4.0);
    for (other, hidden) in [
        // Half of it sticks out: the end inside is hidden, and the sides are cut.
        (
            moved(&cuboid(Vec3::new(4.0, 2.0, 2.0)), Vec3::new(2.0, 1.0, 1.0)),
            2,
        ),
        // All of it is inside.
        (moved(&cube(2.0), Vec3::splat(1.0)), 12),
        // It stands on the block, face to face.
        (moved(&cube(2.0), Vec3::new(1.0, 1.0, 4.0)), 0),
    ] {
        let both = [block.clone(), other].concat();
        let found = sliced_and_measured(&both, &uniform(0.1, 0.05));
        let most = found.half_pixel_diagonal_mm + 1e-5;
        assert!(
            found.hidden_facets >= hidden,
            "{hidden}: {}",
            found.hidden_facets
        );
        assert!(found.print_to_model.max_mm <= most, "{hidden}");
        assert!(found.model_to_print.max_mm <= most, "{hidden}");
    }
}

#[test]
fn a_print_that_stops_inside_an_overlap_is_not_near_what_is_hidden() {
    // The inner cube's top is at the last layer of a print that lacks the rest.
    let both = [cube(4.0), moved(&cube(2.0), Vec3::splat(1.0))].concat();
    let file = slice(&both, &uniform(0.1, 0.05));
    let file = with_manifest(&file, |manifest| {
        manifest["layer_files"].as_array_mut().unwrap().truncate(30);
    });
    let found = measured(&both, &file, &Knowledge::default());
    assert_eq!(found.layers, 30);
    assert_near(found.print_to_model.max_mm, 1.0, 1e-5);
    assert_near(found.model_to_print.max_mm, 1.0, 1e-5);
}

#[test]
fn a_cavity_is_surface_and_counts() {
    let hollow = [cube(4.0), inverted(&moved(&cube(2.0), Vec3::splat(1.0)))].concat();
    let found = sliced_and_measured(&hollow, &uniform(0.1, 0.05));
    assert_eq!(found.hidden_facets, 0);
    assert!(found.model_to_print.max_mm <= found.half_pixel_diagonal_mm + 1e-5);
    // The print of the full cube lacks the cavity.
    let full = slice(&cube(4.0), &uniform(0.1, 0.05));
    let found = measured(&hollow, &full, &Knowledge::default());
    assert!(found.print_to_model.max_mm <= found.half_pixel_diagonal_mm + 1e-5);
    assert_near(found.model_to_print.max_mm, 1.0, found.precision_mm + 1e-5);
}

#[test]
fn the_pose_is_the_manifests_or_the_callers() {
    let model = cuboid(Vec3::new(3.0, 2.0, 1.0));
    let pose = Pose {
        rotation: Some([0.0, 0.6, 0.0, 0.8]),
        height_mm: Some(5.0),
        unit: None,
    };
    let options = cusp_slicer::Options {
        rotation: pose.rotation,
        height_mm: pose.height_mm,
        ..uniform(0.1, 0.02)
    };
    let file = slice(&model, &options);
    let found = measured(&model, &file, &Knowledge::default());
    assert_near(found.model_mm[2], 5.0, 1e-5);
    assert!(found.print_to_model.max_mm <= 0.05 + found.half_pixel_diagonal_mm);
    let bare = with_manifest(&file, |manifest| {
        manifest["options"] = serde_json::json!({});
    });
    let knowledge = Knowledge {
        pose: Some(pose),
        ..Knowledge::default()
    };
    assert_eq!(measured(&model, &bare, &knowledge), found);
    let astray = measured(&model, &bare, &Knowledge::default());
    assert!(astray.print_to_model.max_mm > 1.0);
}
