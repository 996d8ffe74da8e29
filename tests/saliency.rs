//! Saliency, against its definition and invariances; weights in profiles, plans and files.

use std::ops::ControlFlow;

use crate::common::Slicer;
use crate::common::{assert_near, binary_stl, quiet, solids};
use cusp_slicer::job::{Backend, Options, Report, Snap};
use cusp_slicer::model::Mesh;
use cusp_slicer::model::saliency::saliency;
use cusp_slicer::model::weights::{self, WeightsError};
use cusp_slicer::profile::{Metric, Source};
use cusp_slicer::progress::silent;
use glam::{DVec3, Quat, Vec3};

/// A ball with bumps and dents within 37° of the direction x.
fn bumpy_ball(levels: u32) -> solids::Triangles {
    let mut ball = solids::sphere(10.0, levels);
    for corner in ball.iter_mut().flatten() {
        let toward = corner.normalize().x;
        if toward > 0.8 {
            let [y, z] = [corner.y, corner.z];
            let fade = (toward - 0.8) / 0.2;
            *corner *= 1.0 + 0.04 * fade * (1.6 * y).sin() * (1.6 * z).sin();
        }
    }
    ball
}

fn facets(triangles: &solids::Triangles) -> Vec<f32> {
    let mesh = Mesh::from_triangles(triangles).unwrap();
    saliency(&mesh, &mut silent).unwrap()
}

fn mean(values: impl Iterator<Item = f32>) -> f32 {
    let values: Vec<f32> = values.collect();
    values.iter().sum::<f32>() / values.len() as f32
}

fn middle([a, b, c]: &[Vec3; 3]) -> Vec3 {
    (*a + *b + *c) / 3.0
}

#[test]
fn a_bumpy_ball_stands_out_at_its_bumps() {
    let ball = bumpy_ball(6);
    let found = facets(&ball);
    let side = |is_front: bool| {
        let facets = ball.iter().zip(&found);
        mean(
            facets
                .filter(|(facet, _)| (middle(facet).normalize().x > 0.85) == is_front)
                .map(|(_, &saliency)| saliency),
        )
    };
    let (front, back) = (side(true), side(false));
    assert!(front > 0.2, "{front}");
    assert!(front > 8.0 * back, "{front} at the bumps, {back} elsewhere");
    let most = found.iter().copied().fold(0.0, f32::max);
    assert_eq!(most, 1.0);
    assert!(found.iter().all(|value| (0.0..=1.0).contains(value)));
}

#[test]
fn size_and_pose_do_not_matter() {
    let ball = bumpy_ball(5);
    let expected = facets(&ball);
    let turn = Quat::from_xyzw(0.3, -0.5, 0.2, 0.8).normalize();
    for (name, change) in [
        (
            "scaled",
            &(|corner: Vec3| corner * 7.3) as &dyn Fn(Vec3) -> Vec3,
        ),
        ("turned", &|corner: Vec3| turn * corner),
        ("moved", &|corner: Vec3| corner + Vec3::new(13.0, -5.0, 2.0)),
    ] {
        let changed: solids::Triangles = ball.iter().map(|facet| facet.map(change)).collect();
        let found = facets(&changed);
        // Scales depend on the diagonal of the bounding box, which a rotation changes, though little for a ball.
        let off = expected.iter().zip(&found).map(|(a, b)| (a - b).abs());
        let off: Vec<f32> = off.collect();
        let worst = off.iter().copied().fold(0.0, f32::max);
        let usual = mean(off.into_iter());
        let (most, mean) = if name == "turned" {
            (0.15, 0.01)
        } else {
            (0.02, 5e-4)
        };
        assert!(
            worst < most && usual < mean,
            "{name}: {worst} at worst, {usual} in the mean"
        );
    }
}

/// The article's steps one by one, as printed: all pairs of vertices, and the library's exp.
fn naive(mesh: &Mesh) -> Vec<f64> {
    let points: Vec<DVec3> = mesh
        .vertices
        .iter()
        .map(|vertex| vertex.as_dvec3())
        .collect();
    let surface = &mesh.facets[..mesh.surface_facets];
    let cross = |[a, b, c]: [u32; 3]| {
        let [a, b, c] = [a, b, c].map(|vertex| points[vertex as usize]);
        (b - a).cross(c - a)
    };
    let around = |vertex: usize| {
        surface
            .iter()
            .filter(move |facet| facet.contains(&(vertex as u32)))
    };
    let count = points.len();
    let area: Vec<f64> = (0..count)
        .map(|vertex| {
            around(vertex)
                .map(|&facet| cross(facet).length() / 6.0)
                .sum()
        })
        .collect();
    let curvature: Vec<f64> = (0..count)
        .map(|vertex| {
            let normal: DVec3 = around(vertex).map(|&facet| cross(facet)).sum();
            let normal = normal.normalize();
            let (mut sum, mut weights) = (0.0, 0.0);
            for facet in around(vertex) {
                for &other in facet.iter().filter(|&&other| other as usize != vertex) {
                    let edge = points[vertex] - points[other as usize];
                    sum += cross(*facet).length() * 2.0 * normal.dot(edge) / edge.length_squared();
                    weights += cross(*facet).length();
                }
            }
            sum / weights
        })
        .collect();
    let unit = 0.003 * mesh.bounds().size().length();
    let average = |vertex: usize, sigma: f64| {
        let (mut sum, mut weights) = (0.0, 0.0);
        for other in 0..count {
            let square = points[vertex].distance_squared(points[other]);
            if square < 4.0 * sigma * sigma && area[other] > 0.0 {
                let weight = area[other] * (-square / (2.0 * sigma * sigma)).exp();
                sum += weight * curvature[other];
                weights += weight;
            }
        }
        sum / weights
    };
    let mut total = vec![0.0; count];
    for scale in 2..=6 {
        let sigma = f64::from(scale) * unit;
        let values: Vec<f64> = (0..count)
            .map(|vertex| (average(vertex, sigma) - average(vertex, 2.0 * sigma)).abs())
            .collect();
        let most = values.iter().copied().fold(0.0, f64::max);
        if most == 0.0 {
            continue;
        }
        let is_peak = |vertex: usize| {
            let corners = around(vertex).flatten();
            corners
                .filter(|&&other| other as usize != vertex)
                .all(|&other| values[vertex] > values[other as usize])
        };
        let peaks: Vec<f64> = (0..count)
            .filter(|&vertex| is_peak(vertex) && values[vertex] < most)
            .map(|vertex| values[vertex] / most)
            .collect();
        let mean = peaks.iter().sum::<f64>() / peaks.len().max(1) as f64;
        for (total, value) in total.iter_mut().zip(&values) {
            *total += value / most * (1.0 - mean).powi(2);
        }
    }
    let of_facets = surface
        .iter()
        .map(|facet| facet.iter().map(|&vertex| total[vertex as usize]).sum());
    let of_facets: Vec<f64> = of_facets.collect();
    let most = of_facets.iter().copied().fold(0.0, f64::max);
    of_facets.into_iter().map(|value| value / most).collect()
}

#[test]
fn saliency_is_what_the_article_says() {
    let mut holed = bumpy_ball(4);
    holed.truncate(holed.len() - 30);
    for (name, triangles) in [
        ("ball", bumpy_ball(4)),
        ("open ball", holed),
        ("gyroid", solids::gyroid(1, 16)),
    ] {
        let mesh = Mesh::from_triangles(&triangles).unwrap();
        let found = saliency(&mesh, &mut silent).unwrap();
        for (facet, (found, expected)) in found.iter().zip(naive(&mesh)).enumerate() {
            assert!(
                (f64::from(*found) - expected).abs() < 1.5e-2,
                "{name}, facet {facet}: {found}, not {expected}"
            );
        }
    }
}

#[test]
fn any_mesh_has_a_saliency_and_any_moment_can_be_the_last() {
    for (name, triangles) in solids::all() {
        let found = facets(&triangles);
        assert!(
            found.iter().all(|value| (0.0..=1.0).contains(value)),
            "{name}"
        );
    }
    let mesh = Mesh::from_triangles(&bumpy_ball(6)).unwrap();
    let mut calls = 0;
    let mut stop = |_| {
        calls += 1;
        if calls == 3 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    assert!(saliency(&mesh, &mut stop).is_err());
}

fn options(metric: Metric) -> Options {
    Options {
        rays: 203,
        metric,
        // Snap planes depend on heights alone, and would hide the effect of weights.
        snap: Snap::Off,
        backend: Backend::Cpu,
        ..Options::default()
    }
}

fn plan(slicer: &mut Slicer, options: &Options) -> Report {
    pollster::block_on(slicer.plan(options, &mut quiet))
        .unwrap()
        .clone()
}

#[test]
fn weight_1_changes_nothing_and_weight_one_half_doubles_the_tolerance() {
    let model = binary_stl(&solids::sphere(4.0, 5));
    let mut slicer = Slicer::load(&model).unwrap();
    let facets = slicer.info().facets;
    for metric in Metric::ALL {
        for source in [Source::Exact, Source::Sampled] {
            let options = Options {
                source,
                ..options(metric)
            };
            slicer.set_weights(None).unwrap();
            let plain = plan(&mut slicer, &options);
            let profile = slicer.profile(metric, source).unwrap();
            let tight = options.tolerance.unwrap_or(plain.tolerance);
            let doubled = Options {
                tolerance: Some(2.0 * tight),
                ..options.clone()
            };
            let doubled = plan(&mut slicer, &doubled);

            slicer.set_weights(Some(vec![1.0; facets])).unwrap();
            let same = plan(&mut slicer, &options);
            assert_eq!(same.z_mm, plain.z_mm, "{metric:?}, {source:?}");
            assert_eq!(same.max_error, plain.max_error);
            assert_eq!(slicer.profile(metric, source).unwrap(), profile);

            slicer.set_weights(Some(vec![0.5; facets])).unwrap();
            let half = Options {
                tolerance: Some(tight),
                ..options.clone()
            };
            let half = plan(&mut slicer, &half);
            assert_eq!(half.layers, doubled.layers, "{metric:?}, {source:?}");
            assert!(source == Source::Sampled || half.max_error <= tight);
            if source == Source::Exact {
                let slack = 1e-3 * doubled.max_error;
                assert_near(2.0 * half.max_error, doubled.max_error, slack);
                // The reported cusp height is the true one, whatever the weights.
                assert_near(half.max_error_mm, doubled.max_error_mm, 2e-3);
            }
            let is_fewer = half.layers < plain.layers;
            assert!(is_fewer || metric != Metric::Cusp);
        }
    }
}

#[test]
fn the_plan_changes_where_weights_do_and_nowhere_else() {
    let triangles = solids::sphere(8.0, 6);
    let mut slicer = Slicer::load(&binary_stl(&triangles)).unwrap();
    let options = Options {
        // The parts below and above are planned independently, so layers below do not depend on those above.
        planes_mm: vec![10.5],
        ..options(Metric::Cusp)
    };
    let plain = plan(&mut slicer, &options);
    // Heights in the file are 8 mm less than on the plate.
    let paint = |facet: &[Vec3; 3]| if middle(facet).z > 3.0 { 0.4 } else { 1.0 };
    slicer
        .set_weights(Some(triangles.iter().map(paint).collect()))
        .unwrap();
    let painted = plan(&mut slicer, &options);
    assert!(painted.layers < plain.layers);
    let unchanged = |report: &Report| -> Vec<f64> {
        report.z_mm.iter().copied().filter(|&z| z <= 10.5).collect()
    };
    assert_eq!(unchanged(&painted), unchanged(&plain));
    // On a facet of weight 0.4 the error is at most 2.5 times the tolerance.
    assert!(painted.max_error_mm > 0.065 && painted.max_error_mm <= 0.065 / 0.4);
    assert!(painted.max_error <= 0.065);
    // A preview agrees, and the minimum weight bounds the loosening.
    assert_eq!(slicer.preview(&options).unwrap().0.z_mm, painted.z_mm);
    let bounded = Options {
        weight_min: 0.9,
        ..options.clone()
    };
    assert!(plan(&mut slicer, &bounded).layers > painted.layers);
    let all = Options {
        weight_min: 1.0,
        ..options
    };
    assert_eq!(plan(&mut slicer, &all).z_mm, plain.z_mm);
}

#[test]
fn weights_are_the_product_of_paint_and_saliency() {
    let triangles = bumpy_ball(5);
    let mut slicer = Slicer::load(&binary_stl(&triangles)).unwrap();
    let options = Options {
        saliency: true,
        weight_min: 0.1,
        ..options(Metric::Cusp)
    };
    let saliency = slicer.saliency(&mut quiet).unwrap().to_vec();
    let paint: Vec<f32> = (0..triangles.len())
        .map(|facet| (facet % 11) as f32 / 10.0)
        .collect();
    slicer.set_weights(Some(paint.clone())).unwrap();
    let found = slicer.weights(&options, &mut quiet).unwrap().unwrap();
    for (facet, weight) in found.into_iter().enumerate() {
        assert_eq!(weight, (saliency[facet] * paint[facet]).max(0.1));
    }
    // Fewer layers in total than without weights.
    slicer.set_weights(None).unwrap();
    let salient = plan(&mut slicer, &options);
    let plain = plan(&mut slicer, &self::options(Metric::Cusp));
    assert!(
        salient.layers < plain.layers,
        "{} and {}",
        salient.layers,
        plain.layers
    );
}

#[test]
fn weights_in_a_file_are_bound_to_their_mesh() {
    let triangles = solids::sphere(4.0, 4);
    let slicer = Slicer::load(&binary_stl(&triangles)).unwrap();
    let corners = slicer.positions();
    assert_eq!(corners.len(), 9 * triangles.len());
    assert_eq!(corners[..3], triangles[0][0].to_array());
    let mut random = fastrand::Rng::with_seed(3);
    let expected: Vec<f32> = triangles.iter().map(|_| random.f32()).collect();
    let bytes = weights::to_bytes(&expected, &corners);
    assert_eq!(bytes.len(), 16 + 4 * expected.len());
    assert_eq!(weights::from_bytes(&bytes, &corners), Ok(expected));

    let other = Slicer::load(&binary_stl(&solids::sphere(4.1, 4)))
        .unwrap()
        .positions();
    let error = weights::from_bytes(&bytes, &other).unwrap_err();
    assert!(matches!(error, WeightsError::OtherMesh { .. }), "{error}");
    let fewer = Slicer::load(&binary_stl(&solids::cube(1.0)))
        .unwrap()
        .positions();
    let error = weights::from_bytes(&bytes, &fewer).unwrap_err();
    assert_eq!(
        error,
        WeightsError::OtherMesh {
            weights_facets: triangles.len(),
            mesh_facets: 12
        }
    );
    for cut in [0, 7, 15, 16, bytes.len() - 1] {
        assert_eq!(
            weights::from_bytes(&bytes[..cut], &corners),
            Err(WeightsError::NotWeights)
        );
    }
    let mut bad = bytes;
    bad[16..20].copy_from_slice(&1.5f32.to_le_bytes());
    let error = weights::from_bytes(&bad, &corners).unwrap_err();
    assert_eq!(
        error,
        WeightsError::OutOfRange {
            facet: 0,
            weight: 1.5
        }
    );
    let mut slicer = slicer;
    assert_eq!(
        slicer.set_weights(Some(vec![1.0; 3])).unwrap_err().code(),
        "weights-other-mesh"
    );
}

/// Every corner of an octahedron is alike.
fn octahedron() -> solids::Triangles {
    let corner = |x: f32, y: f32, z: f32| Vec3::new(x, y, z) * 10.0;
    let mut triangles = Vec::new();
    for x in [1.0, -1.0] {
        for y in [1.0, -1.0] {
            for z in [1.0, -1.0] {
                let [a, b, c] = [
                    corner(x, 0.0, 0.0),
                    corner(0.0, y, 0.0),
                    corner(0.0, 0.0, z),
                ];
                triangles.push(if x * y * z > 0.0 {
                    [a, b, c]
                } else {
                    [a, c, b]
                });
            }
        }
    }
    triangles
}

#[test]
fn where_nothing_stands_out_all_matters_alike() {
    assert_eq!(facets(&octahedron()), [1.0; 8]);
    let mut slicer = Slicer::load(&binary_stl(&octahedron())).unwrap();
    let plain = plan(&mut slicer, &options(Metric::Cusp));
    let salient = Options {
        saliency: true,
        ..options(Metric::Cusp)
    };
    let salient = plan(&mut slicer, &salient);
    assert_eq!(salient.z_mm, plain.z_mm);
    assert_eq!(salient.true_error, salient.max_error);
}

#[test]
fn a_report_has_the_error_without_weights_beside_the_weighted() {
    let triangles = solids::cone(6.0, 8.0, 64);
    let mut slicer = Slicer::load(&binary_stl(&triangles)).unwrap();
    slicer
        .set_weights(Some(vec![0.25; triangles.len()]))
        .unwrap();
    let report = plan(&mut slicer, &options(Metric::Cusp));
    assert_near(report.true_error, 4.0 * report.max_error, 1e-5);
    assert_near(report.true_error, report.max_error_mm, 0.0);
}

#[test]
fn the_caps_of_holes_and_vertices_of_no_facet_are_no_peaks() {
    // A bumpy ball without its lowest facets: the centroid of the cap has no saliency of its own.
    let mut open = bumpy_ball(4);
    open.retain(|corners| middle(corners).z > -6.0);
    let mesh = Mesh::from_triangles(&open).unwrap();
    assert!(mesh.holes > 0 && !mesh.is_closed());
    // The same surface, with the centroids of the caps far away.
    let mut used = mesh.clone();
    let on_surface = mesh.facets[..mesh.surface_facets].iter().flatten();
    let on_surface: Vec<u32> = on_surface.copied().collect();
    for (vertex, place) in used.vertices.iter_mut().enumerate() {
        if !on_surface.contains(&(vertex as u32)) {
            *place = Vec3::splat(500.0);
        }
    }
    assert_eq!(
        saliency(&used, &mut silent).unwrap(),
        saliency(&mesh, &mut silent).unwrap()
    );
}
