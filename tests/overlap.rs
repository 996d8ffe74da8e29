//! Profiles of bodies that overlap: a facet counts where it is visible.

use crate::common::{load, on_plate, oracle, quiet, solids};
use cusp_slicer::job::{Backend, Options, Report};
use cusp_slicer::profile::{Metric, Source};
use glam::{DVec3, Vec3};

/// A pillar of 24 × 16 × 40 mm, with a slat across it that rises by 30° from end to end.
fn pillar_with_slat() -> solids::Triangles {
    let mut both = solids::moved(
        &solids::cuboid(Vec3::new(24.0, 16.0, 40.0)),
        Vec3::new(-12.0, -8.0, 0.0),
    );
    both.extend(slat([40.0, 6.0, 2.0], 20.0));
    both
}

/// A cuboid of this size, turned by 30° about y, with its middle on the z axis.
fn slat(size: [f32; 3], z_mm: f32) -> solids::Triangles {
    let size = Vec3::from(size);
    let (cos, sin) = (0.75_f32.sqrt(), 0.5);
    let place = |corner: Vec3| {
        let Vec3 { x, y, z } = corner - size / 2.0;
        Vec3::new(cos * x - sin * z, y, sin * x + cos * z + z_mm)
    };
    let slat = solids::cuboid(size);
    slat.iter().map(|corners| corners.map(place)).collect()
}

fn options(metric: Metric) -> Options {
    Options {
        rays: 400,
        metric,
        bin_mm: Some(0.01),
        backend: Backend::Cpu,
        ..Options::default()
    }
}

/// The report of the exact source, and the densities from both.
fn planned(triangles: &solids::Triangles, options: &Options) -> (Report, [Vec<f32>; 2]) {
    let mut slicer = load(triangles);
    let [exact, sampled] = [Source::Exact, Source::Sampled].map(|source| {
        let options = Options {
            source,
            ..options.clone()
        };
        let report = pollster::block_on(slicer.plan(&options, &mut quiet)).cloned();
        let density = slicer.profile(options.metric, source).unwrap().density;
        (report.unwrap(), density)
    });
    (exact.0, [exact.1, sampled.1])
}

#[test]
fn where_a_slope_is_inside_another_body_only_walls_count() {
    // Top and bottom of the slat pass the walls of the pillar, at x = ±12, about 6.93 mm below and above its middle.
    let rise = 12.0 / 3.0_f64.sqrt();
    let half = 1.0 / 0.75_f64.sqrt();
    let inside_mm = (20.0 - rise + half + 0.05)..(20.0 + rise - half - 0.05);
    for metric in [Metric::Cusp, Metric::Deviation] {
        let (report, densities) = planned(&pillar_with_slat(), &options(metric));
        for density in densities {
            for (bin, &density) in density.iter().enumerate() {
                let z_mm = (bin as f64 + 0.5) * 0.01;
                if inside_mm.contains(&z_mm) {
                    assert_eq!(density, 0.0, "{metric:?} at {z_mm}");
                }
            }
        }
        // Outside the slope has its density.
        let [exact, _] = planned(&pillar_with_slat(), &options(metric)).1;
        for z_mm in [12.5, 27.5] {
            let density = exact[(z_mm / 0.01) as usize];
            assert!((density - 0.75_f32.sqrt()).abs() < 1e-4, "{density}");
        }
        // There layers have the greatest thickness: the plan is that of the visible slopes alone.
        let within = report.z_mm.windows(2).zip(&report.thickness_mm);
        let within =
            within.filter(|(z_mm, _)| inside_mm.contains(&z_mm[0]) && inside_mm.contains(&z_mm[1]));
        let (mut count, mut thin) = (0, 0);
        for (_, &thickness_mm) in within {
            count += 1;
            thin += usize::from(thickness_mm < 0.13);
        }
        assert!(count > 60 && thin < 4, "{thin} of {count}");
    }
}

#[test]
fn every_visible_point_of_a_facet_counts() {
    let ball =
        |radius: f64, at: [f32; 3]| solids::moved(&solids::sphere(radius, 4), Vec3::from(at));
    let both = |mut one: solids::Triangles, other: solids::Triangles| {
        one.extend(other);
        one
    };
    let models = [
        ("slat", pillar_with_slat()),
        ("roofs", solids::crossing_roofs()),
        (
            "balls",
            both(ball(5.0, [0.0; 3]), ball(4.0, [3.0, 1.0, 2.0])),
        ),
        (
            "slats",
            both(
                both(slat([20.0, 6.0, 5.0], 3.0), slat([9.0, 9.0, 9.0], 5.0)),
                solids::mirrored(&slat([20.0, 4.0, 4.0], 4.0)),
            ),
        ),
        // A ball that a hole lets rays into, on a slat.
        ("open", {
            let mut ball = ball(5.0, [0.0, 0.0, 2.0]);
            ball.retain(|corners| corners.iter().any(|corner| corner.x < 3.5));
            both(ball, slat([20.0, 4.0, 4.0], 2.0))
        }),
    ];
    let mut random = fastrand::Rng::with_seed(10);
    for (name, triangles) in models {
        let (report, [density, _]) = planned(&triangles, &options(Metric::Cusp));
        let mesh = on_plate(&triangles);
        let all = || (0..mesh.facets.len()).map(|facet| mesh.corners(facet));
        let bin_mm = report.bin_mm;
        let [mut hidden, mut fewer] = [0; 2];
        for _ in 0..3000 {
            let facet = random.usize(..mesh.surface_facets);
            let [a, b, c] = mesh.corners(facet);
            let (mut u, mut v) = (random.f64(), random.f64());
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let point = a + (b - a) * u + (c - a) * v;
            let normal = (b - a).cross(c - a).normalize();
            let winding = |point: DVec3| oracle::winding(all(), point).round();
            let found = density[((point.z / bin_mm) as usize).min(density.len() - 1)];
            if winding(point + normal * 1e-4) == 0.0 || winding(point - normal * 1e-4) == 0.0 {
                let steepness = normal.z.abs() as f32;
                assert!(
                    found >= steepness - 1e-5,
                    "{name}: {found} at {point}, facet {facet} of {steepness}"
                );
            } else {
                hidden += 1;
                fewer += usize::from(found < normal.z.abs() as f32 - 1e-5);
            }
        }
        assert!(hidden > 20, "{name}: {hidden}");
        // Somewhere only hidden parts are as steep.
        assert!(name != "slat" || fewer > 20, "{name}: {fewer} of {hidden}");
    }
}
