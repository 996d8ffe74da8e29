//! The LDI on the CPU: closed forms, a naive intersector, symmetries, and rays that do not close.

use std::ops::ControlFlow;

use crate::common::{assert_near, on_plate, oracle, sample, seen_along, solids};
use cusp_slicer::grid::{Bins, Grid};
use cusp_slicer::ldi::{Hit, Ldi, LdiError, RayImage, Survey, cpu, model_ranges, printed_ranges};
use cusp_slicer::model::{FacetClass, FacetClasses, Mesh};
use cusp_slicer::profile::facet_bins::FacetBins;
use cusp_slicer::profile::section;
use cusp_slicer::progress::{Cancelled, silent};
use glam::Vec3;

fn ranges(hits: &[Hit]) -> Vec<(f32, f32)> {
    let mut ranges = Vec::new();
    let classes = FacetClasses::of_model(u32::MAX as usize, u32::MAX as usize);
    printed_ranges(hits, classes, |z_in, z_out| ranges.push((z_in, z_out)));
    ranges
}

/// Number of rays that do not leave the solid as often as they enter it.
fn unclosed_rays(ldi: &Ldi) -> usize {
    let winding = |ray| ldi.ray(ray).iter().map(|hit| hit.winding()).sum::<i32>();
    (0..ldi.rays()).filter(|&ray| winding(ray) != 0).count()
}

#[test]
fn a_cube_has_one_entry_and_one_exit_on_every_ray() {
    let (_, ldi) = sample(&solids::cube(10.0), 64);
    assert_eq!(ldi.hits.len(), 2 * 64 * 64);
    for ray in 0..ldi.rays() {
        let [entry, exit] = ldi.ray(ray) else {
            panic!("ray {ray}: {:?}", ldi.ray(ray))
        };
        assert!(!entry.is_exit() && exit.is_exit());
        assert_eq!((entry.z_mm, exit.z_mm), (0.0, 10.0));
    }
}

#[test]
fn round_solids_have_as_many_hits_as_their_areas() {
    let area = solids::circle_area(32);
    for (triangles, area_mm2) in [
        (solids::cylinder(8.0, 12.0, 32), area * 64.0),
        (solids::cone(9.0, 14.0, 32), area * 81.0),
        (solids::sphere(10.0, 6), std::f64::consts::PI * 100.0),
    ] {
        let (_, ldi) = sample(&triangles, 1000);
        let expected = 2.0 * area_mm2 / ldi.grid.pitch_mm.powi(2);
        assert_near(ldi.hits.len() as f64, expected, 2e-3 * expected);
        assert_eq!(unclosed_rays(&ldi), 0);
    }
}

#[test]
fn every_solid_agrees_with_a_naive_intersector() {
    // A vertex moves by at most 1/512 pixel in x and in y.
    const NEAR: f64 = 0.005;
    for (name, triangles) in solids::all() {
        let (mesh, ldi) = sample(&triangles, 48);
        let steepest = 40.0;
        let mut compared = 0;
        for ray in 0..ldi.rays() {
            let (column, row) = (ray as u32 % ldi.grid.width, ray as u32 / ldi.grid.width);
            let naive = oracle::cast(&mesh, &ldi.grid, column, row, NEAR);
            if naive.is_near_edge {
                continue;
            }
            compared += 1;
            let mut expected: Vec<u32> = naive.hits.iter().map(|hit| hit.0).collect();
            let mut found: Vec<u32> = ldi.ray(ray).iter().map(|hit| hit.facet()).collect();
            for (hit, (_, z)) in ldi.ray(ray).iter().zip(&naive.hits) {
                assert_near(f64::from(hit.z_mm), *z, NEAR * ldi.grid.pitch_mm * steepest);
            }
            expected.sort_unstable();
            found.sort_unstable();
            assert_eq!(found, expected, "{name}, column {column}, row {row}");
        }
        assert!(
            compared * 3 > ldi.rays(),
            "{name}: only {compared} rays were compared"
        );
    }
}

/// Compares the facets that the rays of `chosen` meet with the naive intersector. Returns the number of rays compared.
fn compare_facets(
    name: &str,
    mesh: &Mesh,
    ldi: &Ldi,
    chosen: impl Iterator<Item = usize>,
) -> usize {
    let mut compared = 0;
    for ray in chosen {
        let (column, row) = (ray as u32 % ldi.grid.width, ray as u32 / ldi.grid.width);
        let naive = oracle::cast(mesh, &ldi.grid, column, row, 0.005);
        if naive.is_near_edge {
            continue;
        }
        compared += 1;
        let mut expected: Vec<u32> = naive.hits.iter().map(|hit| hit.0).collect();
        let mut found: Vec<u32> = ldi.ray(ray).iter().map(|hit| hit.facet()).collect();
        expected.sort_unstable();
        found.sort_unstable();
        assert_eq!(found, expected, "{name}, column {column}, row {row}");
    }
    compared
}

#[test]
fn torture_agrees_with_a_naive_intersector_and_closes() {
    for (name, triangles, rays) in solids::torture() {
        let (mesh, ldi) = sample(&triangles, rays);
        assert!(mesh.is_closed(), "{name}");
        assert_eq!(unclosed_rays(&ldi), 0, "{name}");
        let step = (ldi.rays() / 600).max(1);
        compare_facets(name, &mesh, &ldi, (0..ldi.rays()).step_by(step));
        if name == "a hundred surfaces on a ray" {
            assert_eq!(ldi.ray(820).len(), 100);
            assert_eq!(ranges(ldi.ray(820)).len(), 50);
        }
    }
}

#[test]
fn two_million_facets_agree_with_a_naive_intersector() {
    let (mesh, ldi) = sample(&solids::sphere(10.0, 9), 400);
    assert_eq!(mesh.facets.len(), 2_097_152);
    assert_eq!(unclosed_rays(&ldi), 0);
    let mut random = fastrand::Rng::with_seed(31);
    let chosen: Vec<usize> = (0..40).map(|_| random.usize(0..ldi.rays())).collect();
    assert!(compare_facets("ball", &mesh, &ldi, chosen.into_iter()) > 10);
}

#[test]
fn hits_are_ordered_and_balanced_on_every_ray() {
    for (name, triangles) in solids::all() {
        let (_, ldi) = sample(&triangles, 200);
        assert_eq!(unclosed_rays(&ldi), 0, "{name}");
        for ray in 0..ldi.rays() {
            let hits = ldi.ray(ray);
            assert!(
                hits.windows(2).all(|pair| {
                    (pair[0].z_mm, pair[0].facet()) < (pair[1].z_mm, pair[1].facet())
                }),
                "{name}, ray {ray}: {hits:?}"
            );
        }
    }
}

#[test]
fn a_centre_on_a_shared_edge_or_corner_belongs_to_one_facet() {
    // Corners are at -4 and 4 and pixel centres at whole millimetres, so the square's sides and diagonals
    // run through centres. The top-left rule keeps two of the four sides.
    let mesh = on_plate(&solids::cube(8.0));
    let grid = Grid::plate(&mesh.bounds(), [9, 9], [1.0; 2]).unwrap();
    let ldi = cpu::sample(&mesh, &grid, &mut silent).unwrap();
    for row in 0..9 {
        for column in 0..9 {
            let expected = if row < 8 && column < 8 { 2 } else { 0 };
            assert_eq!(
                ldi.ray(row * 9 + column).len(),
                expected,
                "column {column}, row {row}"
            );
        }
    }
}

#[test]
fn facets_in_another_order_give_the_same_heights() {
    let heights = |ldi: &Ldi| {
        ldi.hits
            .iter()
            .map(|hit| (hit.z_mm, hit.is_exit()))
            .collect::<Vec<_>>()
    };
    for (name, triangles) in solids::all() {
        if name == "doubled sphere" || name == "stacked cubes" || name == "frame" {
            // Coincident facets are ordered by index, which shuffling changes.
            continue;
        }
        let (_, ldi) = sample(&triangles, 100);
        let (_, shuffled) = sample(&solids::shuffled(&triangles), 100);
        assert_eq!(ldi.offsets, shuffled.offsets, "{name}");
        assert_eq!(heights(&ldi), heights(&shuffled), "{name}");
    }
}

/// A solid without symmetry and with corners off any lattice: two tilted tetrahedra that overlap.
fn crooked() -> solids::Triangles {
    let tetrahedron = |[a, b, c, d]: [[f32; 3]; 4]| {
        let [a, b, c, d] = [a, b, c, d].map(Vec3::from);
        [[a, c, b], [a, b, d], [b, c, d], [c, a, d]]
    };
    [
        tetrahedron([
            [0.137, 0.291, 0.083],
            [9.713, 1.377, 1.919],
            [2.617, 6.841, 0.757],
            [3.331, 2.173, 8.273],
        ]),
        tetrahedron([
            [1.171, 2.939, 0.613],
            [6.367, 0.571, 2.459],
            [4.793, 5.231, 3.187],
            [7.879, 3.637, 6.029],
        ]),
    ]
    .concat()
}

/// Asserts that ray (column, row) of `one` has the hits of ray `place(column, row)` of `other`.
#[track_caller]
fn assert_same_rays(one: &Ldi, other: &Ldi, place: impl Fn(u32, u32) -> (u32, u32)) {
    assert_eq!(one.hits.len(), other.hits.len());
    for row in 0..one.grid.height {
        for column in 0..one.grid.width {
            let (to_column, to_row) = place(column, row);
            let hits = one.ray((row * one.grid.width + column) as usize);
            let others = other.ray((to_row * other.grid.width + to_column) as usize);
            assert_eq!(hits.len(), others.len(), "column {column}, row {row}");
            for (hit, other) in hits.iter().zip(others) {
                assert_eq!(hit.is_exit(), other.is_exit(), "column {column}, row {row}");
                assert_near(f64::from(hit.z_mm), f64::from(other.z_mm), 1e-5);
            }
        }
    }
}

#[test]
fn a_mirrored_or_turned_solid_has_mirrored_or_turned_hits() {
    let (_, ldi) = sample(&crooked(), 131);
    let (width, height) = (ldi.grid.width, ldi.grid.height);
    assert!(width > height && ldi.hits.len() > 10_000);

    let (_, mirrored) = sample(&solids::mirrored(&crooked()), 131);
    assert_same_rays(&ldi, &mirrored, |column, row| (width - 1 - column, row));

    // A rotation counter-clockwise from above: +x becomes +y, which is up in an image, and +y becomes -x.
    let (_, turned) = sample(&solids::turned(&crooked()), 131);
    assert_eq!((turned.grid.width, turned.grid.height), (height, width));
    assert_same_rays(&ldi, &turned, |column, row| (row, width - 1 - column));
}

#[test]
fn a_grid_shifted_by_whole_pixels_has_shifted_hits() {
    let (mesh, ldi) = sample(&crooked(), 131);
    let grid = Grid {
        width: ldi.grid.width + 7,
        height: ldi.grid.height + 4,
        corner_mm: ldi.grid.corner_mm + glam::DVec2::new(-5.0, 3.0) * ldi.grid.pitch_mm,
        ..ldi.grid
    };
    let shifted = cpu::sample(&mesh, &grid, &mut silent).unwrap();
    assert_same_rays(&ldi, &shifted, |column, row| (column + 5, row + 3));
}

#[test]
fn overlaps_are_a_union_and_inside_out_is_inside() {
    let hit = |z: f32, is_exit| Hit::new(z, 0, is_exit);
    let (entry, exit) = (|z| hit(z, false), |z| hit(z, true));
    assert_eq!(
        ranges(&[entry(1.0), exit(2.0), entry(3.0), exit(4.0)]),
        [(1.0, 2.0), (3.0, 4.0)]
    );
    assert_eq!(
        ranges(&[entry(1.0), entry(2.0), exit(3.0), exit(4.0)]),
        [(1.0, 4.0)]
    );
    assert_eq!(
        ranges(&[entry(1.0), exit(2.0), entry(2.0), exit(4.0)]),
        [(1.0, 2.0), (2.0, 4.0)]
    );
    assert_eq!(ranges(&[exit(1.0), entry(4.0)]), [(1.0, 4.0)]);
    assert_eq!(ranges(&[entry(1.0), exit(1.0)]), []);
}

#[test]
fn a_cavity_is_what_its_facets_say() {
    let hit = |z: f32, is_exit| Hit::new(z, 0, is_exit);
    let hits = [
        hit(1.0, false),
        hit(2.0, true),
        hit(3.0, false),
        hit(4.0, true),
    ];
    assert_eq!(ranges(&hits), [(1.0, 2.0), (3.0, 4.0)]);
    let mut triangles = solids::cube(10.0);
    let cavity = solids::moved(&solids::sphere(3.0, 4), Vec3::splat(5.0));
    triangles.extend(solids::inverted(&cavity));
    let (_, ldi) = sample(&triangles, 41);
    let middle = ranges(ldi.ray(20 * 41 + 20));
    assert_eq!(middle.len(), 2);
    assert_near(f64::from(middle[1].0 - middle[0].1), 6.0, 0.02);
}

fn survey(ldi: &Ldi) -> Survey {
    Survey::of(RayImage::Kept(ldi), &mut silent).unwrap()
}

#[test]
fn an_open_solid_counts_the_rays_through_its_holes() {
    let mut triangles = solids::cube(10.0);
    triangles.drain(0..2); // the bottom
    let (_, ldi) = sample(&triangles, 32);
    assert_eq!(survey(&ldi).rays_through_holes, 32 * 32);
    assert_eq!(ranges(ldi.ray(100)), [(0.0, 10.0)]);
    let (_, ldi) = sample(&solids::cube(10.0), 32);
    assert_eq!(survey(&ldi).rays_through_holes, 0);
}

#[test]
fn every_ray_closes_whatever_is_missing_or_flipped() {
    let mut random = fastrand::Rng::with_seed(23);
    for _ in 0..20 {
        let mut triangles = solids::sphere(5.0, 3);
        let part = random.f32() * 0.6;
        triangles.retain(|_| random.f32() > part);
        for corners in &mut triangles {
            if random.f32() < part {
                corners.swap(0, 2);
            }
        }
        assert_eq!(unclosed_rays(&sample(&triangles, 150).1), 0);
    }
}

/// Asserts that the rays of a mesh, as they are found row by row, tell the same as its LDI, whose rays are sorted.
#[track_caller]
fn assert_same_surveys(mesh: &Mesh, rays: u32) {
    let grid = Grid::around(&mesh.bounds(), rays).unwrap();
    let ldi = cpu::sample(mesh, &grid, &mut silent).unwrap();
    let told = |image| Survey::with_overlaps(image, &mut silent).unwrap();
    assert_eq!(
        told(RayImage::Scanned { mesh, grid }),
        told(RayImage::Kept(&ldi))
    );
}

#[test]
fn found_rows_tell_the_same_as_an_ldi() {
    for (_, triangles) in solids::all() {
        assert_same_surveys(&on_plate(&triangles), 100);
    }
    for (_, triangles, rays) in solids::torture() {
        assert_same_surveys(&on_plate(&triangles), rays);
    }
    let mut random = fastrand::Rng::with_seed(29);
    for part in [0.02, 0.2, 0.5] {
        let mut triangles = solids::sphere(5.0, 4);
        triangles.retain(|_| random.f32() > part);
        assert_same_surveys(&on_plate(&triangles), 150);
    }
}

#[test]
fn sampling_stops_when_asked() {
    let mesh = on_plate(&solids::sphere(10.0, 4));
    let grid = Grid::around(&mesh.bounds(), 500).unwrap();
    let mut calls = 0;
    let result = cpu::sample(&mesh, &grid, &mut |_| {
        calls += 1;
        if calls == 2 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    assert_eq!(result, Err(LdiError::Cancelled(Cancelled)));
    assert_eq!(calls, 2);
}

/// A cube of 10 mm with a void of 6 mm in its middle and a support of 2 mm through both. On the axis the support fills
/// the void, next to it the void is empty, and the model alone has neither.
#[test]
fn voids_are_left_out_of_the_model_and_supports_are_not() {
    let cube = |side_mm: f32, z_mm: f32| {
        let moved = solids::moved(&solids::cube(side_mm), Vec3::new(0.0, 0.0, z_mm));
        Mesh::from_triangles(&moved).unwrap()
    };
    let model = on_plate(&solids::cube(10.0));
    let middle = |mesh: Mesh| {
        let bounds = mesh.bounds();
        let shift = -(bounds.min + bounds.max).truncate() * 0.5;
        let mut mesh = mesh;
        for vertex in &mut mesh.vertices {
            *vertex += shift.extend(0.0).as_vec3();
        }
        mesh
    };
    let low = |mesh: &Mesh, z_mm: f64| (z_mm - mesh.bounds().min.z) as f32;
    let void = middle(cube(6.0, low(&cube(6.0, 0.0), 2.0)));
    let support = middle(cube(2.0, low(&cube(2.0, 0.0), 3.0)));
    let joined = model
        .with(&support, FacetClass::Support)
        .with(&void, FacetClass::Void);
    let classes = (0..joined.facets.len() as u32).map(|facet| joined.classes.of(facet));
    let counts = [
        FacetClass::Surface,
        FacetClass::Cap,
        FacetClass::Void,
        FacetClass::Support,
    ]
    .map(|class| classes.clone().filter(|&it| it == class).count());
    assert_eq!(counts, [12, 0, 12, 12]);
    assert_eq!(joined.bounds(), model.bounds());
    assert_near(joined.volume_mm3(), 1000.0, 1e-3);

    let grid = Grid::around(&joined.bounds(), 50).unwrap();
    let ldi = cpu::sample(&joined, &grid, &mut silent).unwrap();
    let look = |x: usize, printed: bool| {
        let (mut ranges, ray) = (Vec::new(), ldi.ray(25 * 50 + x));
        let emit = |z_in: f32, z_out: f32| ranges.push((z_in, z_out));
        if printed {
            printed_ranges(ray, ldi.classes, emit);
        } else {
            model_ranges(ray, ldi.classes, emit);
        }
        ranges
    };
    assert_eq!(look(25, true), [(0.0, 2.0), (3.0, 5.0), (8.0, 10.0)]);
    assert_eq!(look(35, true), [(0.0, 2.0), (8.0, 10.0)]);
    assert_eq!(look(45, true), [(0.0, 10.0)]);
    for x in [25, 35, 45] {
        assert_eq!(look(x, false), [(0.0, 10.0)]);
    }
    let alone = cpu::sample(&model, &grid, &mut silent).unwrap();
    let bins = Bins::of_height(10.0, 0.01).unwrap();
    let areas = |ldi: &Ldi| section::sampled(RayImage::Kept(ldi), bins, &mut silent);
    assert_eq!(areas(&ldi), areas(&alone));
    let facet_bins = |mesh: &Mesh| FacetBins::of(mesh, bins);
    assert_eq!(facet_bins(&joined).spans, facet_bins(&model).spans);
    assert_eq!(seen_along(&joined, &ldi), seen_along(&model, &alone));
    assert_same_surveys(&joined, 50);
    let printed_mm3 = survey(&ldi).solid.volume_mm3;
    assert_near(printed_mm3, 1000.0 - 216.0 + 8.0, 1e-6);
}
