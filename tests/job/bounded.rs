//! Jobs within a bound of memory: hits that are not kept are found again, and all results are the same.

use crate::common::Slicer;
use cusp_slicer::Error;
use cusp_slicer::compensation::Compensation;
use cusp_slicer::format::Format;
use cusp_slicer::grid::{Bins, Grid};
use cusp_slicer::job::{Backend, Job, JobOptions, ModelOptions, Options, Planner, Report, Work};
use cusp_slicer::ldi::visibility::visibility;
use cusp_slicer::ldi::{MeshRays, RayImage, Survey, cpu};
use cusp_slicer::prepare::{Hollowing, SupportStrength, Supporting};
use cusp_slicer::profile::Metric;
use cusp_slicer::profile::facet_bins::FacetBins;
use cusp_slicer::profile::{section, steepest};
use cusp_slicer::progress::silent;
use cusp_slicer::resin::{PrintThrough, Resin};
use glam::Vec3;

use super::plan;
use crate::common::{least_memory_bytes, load, on_plate, quiet, solids};

/// Fine enough for several slabs within the least memory.
fn options() -> Options {
    Options {
        pixels: Some([1200, 900]),
        pitch_mm: Some(0.03),
        backend: Backend::Cpu,
        ..Options::default()
    }
}

/// The plan's report without its times, and its print file.
fn sliced(slicer: &mut Slicer, options: &Options) -> (serde_json::Value, Vec<u8>) {
    plan(slicer, options).unwrap();
    let (file, report) = slicer.write_archive(Vec::new(), &mut quiet).unwrap();
    (without_times(report), file)
}

fn without_times(report: &Report) -> serde_json::Value {
    let mut report = serde_json::to_value(report).unwrap();
    report.as_object_mut().unwrap().remove("timings_ms");
    report
}

#[track_caller]
fn assert_same_within_least_memory(triangles: &solids::Triangles, options: &Options) {
    let kept = sliced(&mut load(triangles), options);
    let least = least_memory_bytes(triangles, options);
    let mut slicer = load(triangles).with_memory(least);
    let anew = sliced(&mut slicer, options);
    assert_eq!(kept.0, anew.0);
    assert!(kept.1 == anew.1, "the files differ");
    // It did not keep the hits.
    let mask = slicer.mask(0);
    assert!(
        matches!(mask, Err(Error::MemoryBound { needed_bytes, allowed_bytes })
            if allowed_bytes == least && needed_bytes > least),
        "{mask:?}"
    );
}

/// Balls that overlap, one that is hollow, and one inside out: many hits a ray, and windings of all kinds.
fn crowd() -> solids::Triangles {
    let ball = solids::sphere(7.0, 5);
    let mut all = solids::moved(&ball, Vec3::new(9.0, 8.0, 7.0));
    all.extend(solids::moved(&ball, Vec3::new(15.0, 11.0, 9.0)));
    let small = solids::sphere(4.0, 4);
    all.extend(solids::moved(
        &solids::inverted(&small),
        Vec3::new(9.0, 8.0, 7.0),
    ));
    all.extend(solids::moved(&small, Vec3::new(24.0, 12.0, 14.0)));
    all
}

#[test]
fn a_crowd_is_the_same_with_and_without_its_hits() {
    assert_same_within_least_memory(&crowd(), &options());
    // With more than the least memory, it keeps them.
    let mut slicer = load(&crowd()).with_memory(1 << 40);
    assert!(sliced(&mut slicer, &options()) == sliced(&mut load(&crowd()), &options()));
    slicer.mask(0).unwrap();
}

#[test]
fn so_it_is_anti_aliased_mirrored_and_in_every_format() {
    let formats = [
        (Format::Png, 4, true),
        (Format::Goo, 8, false),
        (Format::Chitubox, 1, true),
        (Format::PhotonWorkshop, 2, false),
        (Format::Sl1, 1, false),
    ];
    for (format, antialias, mirror) in formats {
        let planner = Planner::Uniform { layer_mm: 0.05 };
        let options = Options {
            format: Some(format),
            antialias,
            mirror: Some(mirror),
            planner,
            ..options()
        };
        assert_same_within_least_memory(&crowd(), &options);
    }
}

#[test]
fn compensated_masks_and_their_reports_are_the_same() {
    let cures = Some(PrintThrough {
        overcure_mm: 0.02,
        retained: 1.0,
    });
    let compensations = [
        (
            Compensation {
                xy_mm: 0.05,
                z_mm: 0.2,
                ..Compensation::default()
            },
            None,
            1,
        ),
        (
            Compensation {
                xy_mm: -0.1,
                ..Compensation::default()
            },
            None,
            2,
        ),
        (Compensation::default(), cures, 1),
        (
            Compensation {
                xy_mm: 0.04,
                ..Compensation::default()
            },
            cures,
            4,
        ),
    ];
    for (compensation, print_through, antialias) in compensations {
        let options = Options {
            antialias,
            resin: Resin {
                compensation,
                print_through,
                ..Resin::default()
            },
            ..options()
        };
        assert_same_within_least_memory(&crowd(), &options);
    }
}

#[test]
fn voids_and_supports_are_found_anew_as_well() {
    let options = Options {
        hollow: Some(Hollowing {
            wall_mm: 1.5,
            ..Hollowing::default()
        }),
        supports: Some(Supporting {
            strength: SupportStrength::Light,
            ..Supporting::default()
        }),
        ..options()
    };
    let ball = solids::moved(&solids::sphere(12.0, 5), Vec3::splat(12.0));
    assert_same_within_least_memory(&ball, &options);
}

#[test]
fn pieces_that_float_are_found_anew() {
    // Nothing holds the ball.
    let options = Options {
        supports: Some(Supporting {
            points: Some(Vec::new()),
            ..Supporting::default()
        }),
        ..options()
    };
    let ball = solids::moved(&solids::sphere(12.0, 5), Vec3::splat(12.0));
    let refused = |mut slicer: Slicer| {
        plan(&mut slicer, &options).unwrap();
        let error = slicer.write_archive(Vec::new(), &mut quiet).unwrap_err();
        assert_eq!(error.code(), "floating-pieces");
        serde_json::to_value(error).unwrap()
    };
    let least = least_memory_bytes(&ball, &options);
    assert_eq!(
        refused(load(&ball)),
        refused(load(&ball).with_memory(least))
    );
}

#[test]
fn metrics_of_areas_and_weights_are_measured_anew() {
    for metric in [Metric::Area, Metric::Volume, Metric::Deviation] {
        let options = Options {
            metric,
            saliency: true,
            ..options()
        };
        assert_same_within_least_memory(&crowd(), &options);
    }
}

#[test]
fn a_plate_of_models_and_copies_is_the_same() {
    let models = [crowd(), solids::cube(6.0)];
    let plate = || Job::new(models.iter().map(|it| load(it).into_model()).collect());
    let job = JobOptions {
        options: Options {
            pixels: Some([2400, 1200]),
            ..options()
        },
        models: [2, 3]
            .map(|copies| ModelOptions {
                copies,
                ..ModelOptions::default()
            })
            .to_vec(),
        ..JobOptions::default()
    };
    let sliced = |mut plate: Job| {
        pollster::block_on(plate.plan(&job, &mut quiet)).unwrap();
        let (file, report) = plate.write_archive(0, Vec::new(), &mut quiet).unwrap();
        (without_times(report), file, plate.mask(0, 0))
    };
    let kept = sliced(plate());
    kept.2.unwrap();
    let little = plate().with_memory(1);
    let error = pollster::block_on({ little }.plan(&job, &mut quiet)).unwrap_err();
    let Error::MemoryBound { needed_bytes, .. } = error else {
        panic!("{error}");
    };
    let anew = sliced(plate().with_memory(needed_bytes));
    assert_eq!(kept.0, anew.0);
    assert!(kept.1 == anew.1, "the files differ");
    assert!(matches!(anew.2, Err(Error::MemoryBound { .. })));
}

#[test]
fn what_takes_all_hits_says_how_much_that_is() {
    let least = least_memory_bytes(&crowd(), &options());
    let mut slicer = load(&crowd()).with_memory(least);
    plan(&mut slicer, &options()).unwrap();
    let limits = cusp_slicer::inspect::Limits::default();
    let error = slicer.inspect(&limits, &mut quiet).unwrap_err();
    assert_eq!(error.code(), "memory-bound");
}

#[test]
fn rays_found_anew_are_those_of_the_ldi() {
    for triangles in [crowd(), solids::torture()[0].1.clone()] {
        let mesh = on_plate(&triangles);
        let grid = Grid::around(&mesh.bounds(), 300).unwrap();
        let ldi = cpu::sample(&mesh, &grid, &mut silent).unwrap();
        let bins = Bins::of_height(mesh.bounds().size().z, 0.002).unwrap();
        let facet_bins = FacetBins::of(&mesh, bins);
        let told = |image: RayImage<'_>| {
            let (survey, overlaps) = Survey::with_overlaps(image, &mut silent).unwrap();
            assert_eq!(Survey::of(image, &mut silent).unwrap(), survey);
            let seen = |overlaps| {
                let rays = MeshRays {
                    mesh: &mesh,
                    image,
                    overlaps,
                };
                visibility(rays, &survey, &mut silent).unwrap()
            };
            assert_eq!(seen(None), seen(Some(&overlaps)));
            (
                seen(None),
                steepest::sampled(&facet_bins, image, &[], &mut silent).unwrap(),
                section::sampled(image, bins, &mut silent).unwrap(),
                (survey, overlaps),
            )
        };
        let scanned = RayImage::Scanned { mesh: &mesh, grid };
        assert_eq!(told(RayImage::Kept(&ldi)), told(scanned));
    }
}

/// The work that takes longer than a job may.
#[track_caller]
fn bound_by<T: std::fmt::Debug>(found: Result<T, Error>, allowed: f64) -> Work {
    match found {
        Err(Error::TimeBound {
            work,
            needed_s,
            allowed_s,
        }) => {
            assert_eq!(allowed_s, allowed);
            assert!(needed_s > allowed_s);
            work
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn what_takes_too_long_is_named_before_it_is_done() {
    let ball = solids::sphere(8.0, 4);
    let bounded = |seconds| load(&ball).with_cpu_time(seconds);
    let salient = Options {
        saliency: true,
        ..options()
    };
    let long = Options {
        metric: Metric::Volume,
        max_layers: Some(20),
        bin_mm: Some(0.0001),
        layer_max_mm: Some(8.0),
        ..options()
    };
    assert_eq!(
        bound_by(plan(&mut bounded(1e-4), &options()), 1e-4),
        Work::Hits
    );
    assert_eq!(
        bound_by(plan(&mut bounded(1e-4), &salient), 1e-4),
        Work::Saliency
    );
    assert_eq!(
        bound_by(plan(&mut bounded(60.0), &long), 60.0),
        Work::Layers
    );
    let plates = |options: Options| {
        let mut plate = Job::new(vec![load(&ball).into_model()]).with_cpu_time(1e-4);
        let options = JobOptions {
            options,
            ..JobOptions::default()
        };
        pollster::block_on(plate.plan(&options, &mut quiet)).map(|_| ())
    };
    assert_eq!(bound_by(plates(options()), 1e-4), Work::Hits);
    assert_eq!(bound_by(plates(salient), 1e-4), Work::Saliency);
    plan(&mut bounded(60.0), &options()).unwrap();
}
