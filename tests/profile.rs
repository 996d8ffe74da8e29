//! Profiles of solids, sampled and exact, against closed forms and naive oracles.

use crate::common::{assert_near, on_plate, oracle, sample, seen_along, solids};
use cusp_slicer::grid::{Bins, Grid};
use cusp_slicer::ldi::visibility::Visibility;
use cusp_slicer::ldi::{Ldi, RayImage, cpu};
use cusp_slicer::model::Mesh;
use cusp_slicer::profile::facet_bins::{FacetBins, Flat};
use cusp_slicer::profile::snap_planes::{Surface, snap_planes};
use cusp_slicer::profile::{Metric, Profile, Shape, area, roughness, section, steepest};
use cusp_slicer::progress::silent;
use glam::Vec3;

/// The surface of a model that is printed once.
fn surface<'a>(flats: &'a [Flat], steepest: &'a [f32]) -> Surface<'a> {
    Surface { flats, steepest }
}

fn bins_of(mesh: &Mesh, bin_mm: f64) -> Bins {
    Bins::of_height(mesh.bounds().size().z, bin_mm).unwrap()
}

/// The exact and the sampled shape.
fn shapes(triangles: &solids::Triangles, bin_mm: f64) -> [Shape; 2] {
    let (mesh, ldi) = sample(triangles, 500);
    let bins = bins_of(&mesh, bin_mm);
    let seen = seen_along(&mesh, &ldi);
    let image = RayImage::Kept(&ldi);
    [
        Shape {
            bins,
            steepest: steepest::exact(&FacetBins::of(&mesh, bins), &seen.hidden),
            cones: Vec::new(),
            areas_mm2: section::exact(&mesh, &seen.hidden, bins),
        },
        Shape {
            bins,
            steepest: maxima(&FacetBins::of(&mesh, bins), &ldi, &seen.hidden),
            cones: Vec::new(),
            areas_mm2: section::sampled(image, bins, &mut silent).unwrap(),
        },
    ]
}

fn densities(triangles: &solids::Triangles, bin_mm: f64, metric: Metric) -> [Vec<f32>; 2] {
    shapes(triangles, bin_mm).map(|shape| shape.profile(metric).density)
}

fn seen(mesh: &Mesh, rays: u32) -> Visibility {
    let grid = Grid::around(&mesh.bounds(), rays).unwrap();
    seen_along(mesh, &cpu::sample(mesh, &grid, &mut silent).unwrap())
}

/// The largest `n_z²` of each bin, along the rays.
fn maxima(facet_bins: &FacetBins, ldi: &Ldi, hidden: &[bool]) -> Vec<f32> {
    steepest::sampled(facet_bins, RayImage::Kept(ldi), hidden, &mut silent).unwrap()
}

#[test]
fn upright_walls_have_no_cusps_and_flats_have_all() {
    for triangles in [solids::cube(10.0), solids::cylinder(8.0, 10.0, 32)] {
        for density in densities(&triangles, 0.1, Metric::Cusp) {
            assert_eq!(density.len(), 100);
            assert_eq!((density[0], density[99]), (1.0, 1.0));
            assert!(density[1..99].iter().all(|&density| density == 0.0));
        }
    }
}

#[test]
fn upright_walls_are_as_rough_as_layers_are_thick_and_flats_are_capped() {
    let [exact, sampled] = densities(&solids::cylinder(8.0, 10.0, 32), 0.1, Metric::Roughness);
    assert_eq!((exact[0], exact[99]), (roughness::CAP, roughness::CAP));
    assert!(exact[1..99].iter().all(|&density| density == 1.0));
    // Rays never meet vertical walls.
    assert!(sampled[1..99].iter().all(|&density| density == 0.0));
}

#[test]
fn caps_over_holes_have_no_part_in_cusps() {
    let mut triangles = solids::cube(10.0);
    triangles.drain(0..2); // the bottom
    for density in densities(&triangles, 0.1, Metric::Cusp) {
        assert_eq!((density[0], density[99]), (0.0, 1.0));
    }
}

#[test]
fn a_cone_has_the_densities_of_its_slope_everywhere() {
    let cone = solids::cone(6.0, 8.0, 64);
    for (metric, expected) in [(Metric::Cusp, 0.6), (Metric::Roughness, 1.25)] {
        for density in densities(&cone, 0.1, metric) {
            for &density in &density[1..] {
                assert_near(f64::from(density), expected, 2e-3);
            }
        }
    }
    // A is proportional to the square of s, the distance from the tip, so |A'| / A is 2 / s.
    let [exact, _] = densities(&cone, 0.01, Metric::Area);
    for bin in (0..780).step_by(39) {
        let below_tip = 8.0 - (bin as f64 + 1.0) * 0.01;
        let expected = (2.0 / below_tip).min(f64::from(area::CAP));
        assert_near(f64::from(exact[bin]), expected, 0.01 * expected);
    }
    assert_eq!(exact[799], area::CAP);
}

#[test]
fn a_sphere_has_the_density_of_its_height() {
    for density in densities(&solids::sphere(10.0, 7), 0.2, Metric::Cusp) {
        for (bin, &density) in density.iter().enumerate() {
            // The largest |n_z| in a bin is at the end farther from the middle of the sphere.
            let ends = [bin as f64, bin as f64 + 1.0].map(|end| (end * 0.2 - 10.0).abs() / 10.0);
            assert_near(f64::from(density), ends[0].max(ends[1]), 0.012);
        }
    }
}

#[test]
fn a_symmetric_solid_has_a_symmetric_profile() {
    // A number of bins such that no vertex of the sphere lies on a boundary.
    let [exact, _] = shapes(&solids::sphere(10.0, 6), 20.0 / 777.0);
    for metric in [Metric::Cusp, Metric::Roughness, Metric::Volume] {
        let density = exact.profile(metric).density;
        let most = density.iter().copied().fold(0.0, f32::max);
        for (upward, downward) in density.iter().zip(density.iter().rev()) {
            assert_near(
                f64::from(*upward),
                f64::from(*downward),
                2e-5 * f64::from(most),
            );
        }
    }
}

#[test]
fn the_exact_profile_is_that_of_a_loop_over_facets_and_bins() {
    for (name, triangles) in solids::all() {
        let mesh = on_plate(&triangles);
        let bins = bins_of(&mesh, mesh.bounds().size().z / 173.0);
        let expected = oracle::steepest(&mesh, bins, |_| true);
        let found = steepest::exact(&FacetBins::of(&mesh, bins), &[]);
        for (bin, (&found, &expected)) in found.iter().zip(&expected).enumerate() {
            let found = f64::from(found);
            let found = if found < 0.0 { found } else { found.sqrt() };
            assert!(
                (found - expected).abs() < 1e-6,
                "{name}, bin {bin}: {found} {expected}"
            );
        }
    }
}

#[test]
fn the_sampled_profile_is_never_above_the_exact_one() {
    let mut lower = 0;
    for (name, triangles) in solids::all() {
        let [exact, sampled] = shapes(&triangles, 0.03);
        let bins = exact.bins.count;
        for bin in 0..bins {
            assert!(
                sampled.steepest[bin] <= exact.steepest[bin],
                "{name}, bin {bin}"
            );
            lower += usize::from(sampled.steepest[bin] + 0.02 < exact.steepest[bin]);
        }
    }
    assert!(lower > 20, "rays miss something: {lower}");
}

#[test]
fn exact_areas_are_those_of_every_section() {
    for (name, triangles) in solids::all() {
        let mesh = on_plate(&triangles);
        // One bin, and a number of bins that is not a power of two.
        for count in [1.0, 357.0] {
            let bins = bins_of(&mesh, mesh.bounds().size().z / count);
            let areas_mm2 = section::exact(&mesh, &[], bins);
            let most = areas_mm2.iter().copied().fold(0.0, f64::max);
            for (bin, &found) in areas_mm2.iter().enumerate() {
                // Near a horizontal facet, rounding may decide whether the whole area counts.
                let expected = oracle::section_mm2(&mesh, bins.middle_mm(bin));
                assert!(
                    (found - expected).abs() < 1e-9 * most,
                    "{name}, bin {bin}: {found} {expected}"
                );
            }
        }
    }
}

#[test]
fn areas_have_their_closed_forms() {
    let [exact, sampled] = shapes(&solids::cone(6.0, 8.0, 64), 0.02).map(|shape| shape.areas_mm2);
    let cylinder = shapes(&solids::cylinder(8.0, 10.0, 32), 0.02).map(|shape| shape.areas_mm2);
    for bin in 0..400 {
        let radius = 6.0 * (1.0 - (bin as f64 + 0.5) * 0.02 / 8.0);
        let expected = solids::circle_area(64) * radius * radius;
        assert_near(exact[bin], expected, 1e-5);
        assert_near(sampled[bin], expected, 0.15);
        assert_near(cylinder[0][bin], solids::circle_area(32) * 64.0, 1e-4);
        assert_near(cylinder[1][bin], solids::circle_area(32) * 64.0, 0.3);
    }
}

#[test]
fn what_lies_wholly_inside_has_no_part() {
    let outer = solids::cube(10.0);
    let ball = solids::moved(&solids::sphere(2.0, 4), Vec3::splat(5.0));
    let mut both = outer.clone();
    both.extend(ball);
    let mesh = on_plate(&both);
    let found = seen(&mesh, 400);
    assert!(!found.overlaps);
    let ball = outer.len()..mesh.surface_facets;
    assert!(!found.hidden[..ball.start].contains(&true));
    // Rays meet the facets at the poles, but not all at the equator: those count as hidden like their body.
    assert!(!found.hidden[ball].contains(&false));

    let bins = bins_of(&mesh, 0.1);
    let areas_mm2 = section::exact(&mesh, &found.hidden, bins);
    assert!(areas_mm2.iter().all(|area| (area - 100.0).abs() < 1e-9));
    let density = steepest::exact(&FacetBins::of(&mesh, bins), &found.hidden);
    assert_eq!(
        density,
        steepest::exact(&FacetBins::of(&on_plate(&outer), bins), &[])
    );
}

#[test]
fn where_bodies_touch_there_is_no_surface() {
    let mut stacked = solids::cube(10.0);
    stacked.extend(solids::moved(
        &solids::cube(10.0),
        Vec3::new(0.0, 0.0, 10.0),
    ));
    for shuffled in [stacked.clone(), solids::shuffled(&stacked)] {
        let [exact, _] = shapes(&shuffled, 0.1);
        let density = exact.profile(Metric::Cusp).density;
        assert!(density[1..199].iter().all(|&density| density == 0.0));
        assert!(
            exact
                .areas_mm2
                .iter()
                .all(|area| (area - 100.0).abs() < 1e-9)
        );
    }
}

#[test]
fn bodies_that_cross_are_left_to_the_rays() {
    let mut crossing = solids::cube(10.0);
    crossing.extend(solids::moved(&solids::cube(10.0), Vec3::splat(4.0)));
    let found = seen(&on_plate(&crossing), 100);
    assert!(found.overlaps);
    assert!(!seen(&on_plate(&solids::cube(3.0)), 20).overlaps);
}

#[test]
fn flats_come_before_sharp_changes_and_larger_before_smaller() {
    // Steps of two sizes, and a cone on top.
    let step = |side: f32, z: f32| solids::moved(&solids::cube(side), Vec3::new(0.0, 0.0, z));
    let mut stairs = step(10.0, 0.0);
    stairs.extend(step(6.0, 6.0));
    stairs.extend(step(3.0, 11.0));
    let mesh = on_plate(&stairs);
    let bins = bins_of(&mesh, 0.1);
    let hidden = seen(&mesh, 300).hidden;
    let facet_bins = FacetBins::of(&mesh, bins);
    let steepest = steepest::exact(&facet_bins, &hidden);
    let flats = facet_bins.flats_but(&hidden);
    let found = snap_planes(&[surface(&flats, &steepest)], bins, 1.0);
    assert_eq!(found[..2], [100, 120]);
    // At each flat the density changes sharply, and where the walls begin; at the top there is a plane anyway.
    let mut sharp = found[2..].to_vec();
    sharp.sort_unstable();
    assert_eq!(sharp, [1, 100, 120], "{found:?}");
    let large = snap_planes(&[surface(&flats, &[])], bins, 50.0);
    assert_eq!(large, [100]);
}

#[test]
fn flats_of_a_model_count_whatever_stands_beside_it() {
    let of = |side: f32, height: f32| {
        let mesh = on_plate(&solids::cuboid(Vec3::new(side, side, height)));
        FacetBins::of(&mesh, bins_of(&mesh, 0.1)).flats
    };
    // Tops of 4 mm² at 3 mm, and of 25 mm² at 5 mm, under something 9 mm high.
    let (small, large) = (of(2.0, 3.0), of(5.0, 5.0));
    let bins = Bins {
        count: 90,
        size_mm: 0.1,
    };
    let surfaces = [surface(&small, &[]), surface(&large, &[])];
    assert_eq!(snap_planes(&surfaces, bins, 1.0), [50, 30]);
    assert_eq!(snap_planes(&surfaces, bins, 5.0), [50]);
    // Seven of them are seven flats, each too small.
    assert!(snap_planes(&[surfaces[0]; 7], bins, 5.0).is_empty());
    assert_eq!(snap_planes(&[surfaces[0]; 7], bins, 4.0), [30]);
}

#[test]
fn a_sharp_change_is_where_the_surface_turns() {
    // Up to 2 mm a wall, up to 4 mm a slope of 27°, then a wall again.
    let outline = [
        [0.0, 0.0],
        [4.0, 0.0],
        [4.0, 2.0],
        [8.0, 4.0],
        [8.0, 6.0],
        [0.0, 6.0],
    ];
    let mesh = on_plate(&solids::profiled(&outline, 5.0));
    let bins = bins_of(&mesh, 0.1);
    let steepest = steepest::exact(&FacetBins::of(&mesh, bins), &[]);
    let mut found = snap_planes(&[surface(&[], &steepest)], bins, 1.0);
    found.sort_unstable();
    assert_eq!(found, [1, 20, 40]);
}

#[test]
fn bins_that_no_ray_meets_are_no_sharp_changes() {
    // Near the equator rays are farther apart than bins.
    let ball = solids::sphere(10.0, 5);
    let (mesh, ldi) = sample(&ball, 100);
    let bins = bins_of(&mesh, 0.002);
    let facet_bins = FacetBins::of(&mesh, bins);
    let sampled = maxima(&facet_bins, &ldi, &[]);
    assert!(sampled.contains(&steepest::NO_SURFACE));
    assert_eq!(snap_planes(&[surface(&[], &sampled)], bins, 1.0), [0u32; 0]);
}

#[test]
fn errors_of_layers_are_sums_of_densities() {
    let bins = Bins::of_height(0.5, 0.1).unwrap();
    let shape = Shape {
        bins,
        steepest: [0.2f32, 0.4, 0.0, 1.0, 0.3]
            .map(|density| density * density)
            .to_vec(),
        cones: Vec::new(),
        areas_mm2: vec![5.0, 4.0, 4.0, 7.0, 1.0],
    };
    let errors = shape.errors(Metric::Cusp);
    let error = |lower, upper| errors.to_value(errors.steps_between(lower, upper));
    assert_near(error(0, 5), 0.19, 1e-7);
    assert_near(error(1, 4), 0.14, 1e-7);
    assert_near(error(2, 3), 0.0, 0.0);
    // Nothing is added above the last bin.
    assert_near(error(4, 9), 0.03, 1e-7);
    assert_eq!(errors.to_steps(errors.to_value(1234)), 1234);

    let errors = shape.errors(Metric::Volume);
    let error = |lower, upper| errors.to_value(errors.steps_between(lower, upper));
    assert_near(error(0, 3), 0.2, 1e-9);
    assert_near(error(1, 5), 0.6, 1e-9);
    // Above the model there is no section, so the whole layer is excess.
    assert_near(error(4, 6), 0.1, 1e-9);

    let area = shape.profile(Metric::Area);
    assert_eq!(area.density, [2.0, 0.0, area::CAP, area::CAP, area::CAP]);
    assert_eq!(
        Profile {
            bins,
            density: shape.areas_mm2.iter().map(|&it| it as f32).collect()
        },
        shape.profile(Metric::Volume)
    );
}

#[test]
fn a_facet_that_pokes_out_between_rays_is_seen() {
    // The inner cuboid reaches 0.03 mm beyond the wall of the outer, and no ray passes there.
    let outer = solids::cube(10.0);
    let mut both = outer.clone();
    both.extend(solids::moved(&solids::cube(4.0), Vec3::new(6.03, 3.0, 3.0)));
    let mesh = on_plate(&both);
    let found = seen(&mesh, 50);
    assert!(found.overlaps);
    let is_level = |facet: usize| mesh.n_z_squared(facet) == 1.0;
    let inner: Vec<usize> = (outer.len()..both.len())
        .filter(|&it| is_level(it))
        .collect();
    assert_eq!(inner.len(), 4);
    // Of the two facets of the top and of the bottom one lies wholly inside, unless the wall cuts both.
    for pair in inner.chunks(2) {
        assert!(
            pair.iter()
                .any(|&facet| !found.hidden.get(facet).copied().unwrap_or(false))
        );
    }
    // Away from walls that it crosses, a facet that rays show inside is hidden.
    let mut within = outer.clone();
    within.extend(solids::moved(&solids::cube(4.0), Vec3::splat(3.0)));
    assert!(
        seen(&on_plate(&within), 50).hidden[outer.len()..]
            .iter()
            .all(|&hidden| hidden)
    );
}

#[test]
fn a_body_on_a_larger_one_is_no_crossing() {
    let mut shoulder = solids::cuboid(Vec3::new(20.0, 20.0, 5.0));
    shoulder.extend(solids::moved(
        &solids::cuboid(Vec3::new(10.0, 10.0, 5.0)),
        Vec3::new(5.0, 5.0, 5.0),
    ));
    let mesh = on_plate(&shoulder);
    let found = seen(&mesh, 100);
    assert!(!found.overlaps);
    let bins = bins_of(&mesh, 0.1);
    let areas_mm2 = section::exact(&mesh, &found.hidden, bins);
    for (bin, area) in areas_mm2.iter().enumerate() {
        assert_near(*area, if bin < 50 { 400.0 } else { 100.0 }, 1e-9);
    }
}
