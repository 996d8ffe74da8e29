//! The same results natively and in the browser: each test runs in both, against the same recorded
//! fingerprints.

use crate::common::Slicer;
#[cfg(target_arch = "wasm32")]
use crate::common::shifted_grid;
use crate::common::{binary_stl, fingerprint, on_plate, quiet, solids};
use cusp_slicer::calibration::Calibration;
use cusp_slicer::compensation::Compensation;
use cusp_slicer::format::Format;
use cusp_slicer::grid::Grid;
use cusp_slicer::inspect::Limits;
#[cfg(target_arch = "wasm32")]
use cusp_slicer::job::Stage;
use cusp_slicer::job::{Backend, Minimize, Options, Planner};
use cusp_slicer::ldi::cpu;
#[cfg(target_arch = "wasm32")]
use cusp_slicer::ldi::{
    LdiError,
    gpu::{self, Gpu, Method},
};
use cusp_slicer::model::{Mesh, Pose};
use cusp_slicer::orientation::{Quality, SearchOptions};
use cusp_slicer::prepare::{AutoDrain, Drain, Hollowing, Infill, Supporting, hollow, support};
use cusp_slicer::profile::{Metric, Source};
use cusp_slicer::progress::silent;
use cusp_slicer::resin::PrintThrough;
#[cfg(target_arch = "wasm32")]
use cusp_slicer::warning::Warning;
use wasm_bindgen_test::wasm_bindgen_test;

fn options() -> Options {
    Options {
        rays: 257,
        height_mm: Some(7.3),
        backend: Backend::Cpu,
        ..Options::default()
    }
}

/// Two overlapping bodies with flats, slopes and an inverted copy.
fn model() -> solids::Triangles {
    let mut triangles = solids::sphere(3.0, 5);
    triangles.extend(solids::moved(
        &solids::cone(2.0, 5.0, 16),
        glam::Vec3::new(1.0, 0.5, 0.25),
    ));
    triangles.extend(solids::inverted(&solids::cube(1.7)));
    triangles
}

#[wasm_bindgen_test(unsupported = test)]
fn the_void_and_its_holes_are_the_recorded_ones() {
    let hollowing = Hollowing {
        pillars: false,
        wall_mm: 0.7,
        cavity_mm: 0.8,
        infill: Some(Infill {
            spacing_mm: 2.5,
            strut_mm: 0.5,
        }),
        drains: vec![Drain {
            at_mm: [3.0, 0.2, 3.0],
            direction: [-1.0, 0.1, 0.3],
            diameter_mm: 0.9,
            depth_mm: None,
        }],
        auto_drain: Some(AutoDrain {
            diameter_mm: 0.8,
            ..AutoDrain::default()
        }),
    };
    let void = hollow(
        &on_plate(&solids::sphere(3.0, 5)),
        &hollowing,
        None,
        &mut silent,
    );
    let void = void.unwrap().unwrap();
    assert!(void.astray.is_empty() && void.drains.len() > 1);
    let shells = std::iter::once(&void.shell).chain(void.drains.iter().map(|drain| &drain.1));
    let numbers: Vec<u8> = shells
        .flat_map(|shell| {
            let vertices = bytemuck::cast_slice(&shell.vertices).to_vec();
            [vertices, bytemuck::cast_slice(&shell.facets).to_vec()].concat()
        })
        .collect();
    assert_eq!(fingerprint(&numbers), 0x1213_4c04_36ef_d439);
}

#[wasm_bindgen_test(unsupported = test)]
fn the_supports_are_the_recorded_ones() {
    let mesh = Mesh::from_triangles(&model()).unwrap();
    let mesh = mesh.on_plate(&Pose::of_height(24.0)).unwrap();
    let supports = support(&mesh, &Supporting::default(), None, 0.0, &mut silent).unwrap();
    assert!(supports.points.len() > 9);
    let vertices = bytemuck::cast_slice(&supports.shell.vertices).to_vec();
    let facets = bytemuck::cast_slice(&supports.shell.facets).to_vec();
    assert_eq!(
        fingerprint(&[vertices, facets].concat()),
        0x6232_e0a4_a0c6_fbb3
    );
}

#[wasm_bindgen_test(unsupported = test)]
fn the_ldi_is_the_recorded_one() {
    let mesh = on_plate(&model());
    let grid = Grid::around(&mesh.bounds(), 257).unwrap();
    let ldi = cpu::sample(&mesh, &grid, &mut silent).unwrap();
    let hits = fingerprint(bytemuck::cast_slice(&ldi.hits));
    let offsets = fingerprint(bytemuck::cast_slice(&ldi.offsets));
    assert_eq!(
        [hits, offsets],
        [0xf91a_24f3_ddd3_8515, 0x245c_617d_6fc3_e4e1]
    );
}

#[wasm_bindgen_test(unsupported = test)]
fn the_directions_are_the_recorded_ones() {
    let options = Options {
        bin_mm: Some(0.01),
        ..options()
    };
    let search = SearchOptions {
        directions: 40,
        quality: Quality::Overhang,
        ..SearchOptions::default()
    };
    let mut slicer = Slicer::load(&binary_stl(&model())).unwrap();
    let found = slicer.orient(&options, &search, &mut quiet).unwrap();
    let all = found
        .candidates
        .iter()
        .chain(&found.best)
        .chain([&found.now]);
    let numbers: Vec<u8> = all
        .flat_map(|candidate| {
            let metrics = candidate.metrics.iter().flat_map(|metrics| {
                [
                    metrics.layers as f64,
                    metrics.print_time_s,
                    metrics.max_error,
                    metrics.roughness_mm,
                    metrics.overhang_mm2,
                    metrics.islands as f64,
                    metrics.cups_mm2,
                    metrics.support_ml,
                    metrics.contact_mm2,
                ]
            });
            let place = candidate.direction.into_iter().chain(candidate.rotation);
            let place = place.chain(candidate.size_mm).chain(candidate.energy);
            place
                .chain(metrics)
                .flat_map(f64::to_le_bytes)
                .collect::<Vec<_>>()
        })
        .collect();
    assert_eq!(
        (found.best.len(), fingerprint(&numbers)),
        (3, 0xbe68_6f93_0cdf_5d3d)
    );
}

/// A print file for a printer of each format, anti-aliased, with compensated masks; and one calibration print.
async fn check_print_files() {
    let mut slicer = Slicer::load(&binary_stl(&model())).unwrap();
    let mut fingerprints = Vec::new();
    for printer in [
        "saturn-3-ultra",
        "jupiter-2",
        "photon-mono-x",
        "photon-mono-m5",
        "photon-mono-m5s",
        "photon-mono-m7",
        "ld-002h",
        "athena-8k",
    ] {
        let mut options = Options {
            printer: Some(printer.into()),
            planner: Planner::Uniform { layer_mm: 0.2 },
            height_mm: Some(5.0),
            antialias: 4,
            ..options()
        };
        options.resin.compensation = Compensation {
            xy_mm: 0.04,
            bottom_xy_mm: Some(0.1),
            faded_layers: 3,
            z_mm: 0.1,
        };
        slicer.plan(&options, &mut quiet).await.unwrap();
        let (bytes, _) = slicer.write_archive(Vec::new(), &mut quiet).unwrap();
        fingerprints.extend(fingerprint(&bytes).to_le_bytes());
    }
    let options = Options {
        printer: Some("saturn-4".into()),
        ..options()
    };
    let calibration = Calibration::layers(&options).unwrap();
    let (bytes, _) = calibration.write(Vec::new(), &mut quiet).await.unwrap();
    fingerprints.extend(fingerprint(&bytes).to_le_bytes());
    assert_eq!(fingerprint(&fingerprints), 0x9e76_0a75_06bc_e053);
}

#[cfg(not(target_arch = "wasm32"))]
#[test]
fn print_files_are_the_recorded_ones() {
    pollster::block_on(check_print_files());
}

#[cfg(target_arch = "wasm32")]
#[wasm_bindgen_test]
async fn print_files_are_the_recorded_ones() {
    check_print_files().await;
}

async fn check_plan_and_masks() {
    let mut slicer = Slicer::load(&binary_stl(&model())).unwrap();
    let report = slicer.plan(&options(), &mut quiet).await.unwrap().clone();
    let masks: Vec<u8> = (0..report.layers)
        .flat_map(|layer| slicer.mask(layer).unwrap())
        .collect();
    assert_eq!(
        (report.layers, fingerprint(&masks)),
        (66, 0xd9c8_1ed1_9083_cc9c)
    );
    let found = slicer.inspect(&Limits::default(), &mut quiet).unwrap();
    assert_ne!(found.findings, []);
    let found = serde_json::to_vec(&found).unwrap();
    assert_eq!(fingerprint(&found), 0xbfd6_f9d3_19f1_d9a4);
    let archive = |slicer: &mut Slicer| {
        let (bytes, _) = slicer.write_archive(Vec::new(), &mut quiet).unwrap();
        fingerprint(&bytes)
    };
    assert_eq!(archive(&mut slicer), 0xc587_dff6_8153_6dd2);
    let grey = Options {
        antialias: 4,
        printer: Some("sl1s".into()),
        format: Some(Format::Chitubox),
        ..options()
    };
    slicer.plan(&grey, &mut quiet).await.unwrap();
    assert_eq!(archive(&mut slicer), 0x5583_4511_6bf4_6186);
    // Cured bottoms by whole layers and by greys.
    let mut cured = Vec::new();
    for proportional_greys in [false, true] {
        let printer = serde_json::json!({
            "pixels": [400, 400], "pitch_um": [50, 50], "volume_mm": [20, 20, 100], "step_mm": 0.01,
            "proportional_greys": proportional_greys,
        });
        let mut options = Options {
            antialias: 4,
            printer: Some(serde_json::from_value(printer).unwrap()),
            ..options()
        };
        options.resin.print_through = Some(PrintThrough {
            overcure_mm: 0.03,
            retained: 0.8,
        });
        let report = slicer.plan(&options, &mut quiet).await.unwrap();
        let found = report.print_through.clone().unwrap();
        assert!(
            found.after.mean_mm < 0.2 * found.before.mean_mm,
            "{found:?}"
        );
        cured.extend(serde_json::to_vec(&found).unwrap());
        cured.extend(archive(&mut slicer).to_le_bytes());
    }
    assert_eq!(fingerprint(&cured), 0x6f20_0e33_fb45_963a);
    // Every metric, source and objective.
    let mut plans = Vec::new();
    let is_older = |metric: &Metric| *metric != Metric::FilamentRoundness;
    for metric in Metric::ALL.into_iter().filter(is_older) {
        for (source, minimize) in [
            (Source::Exact, Minimize::Layers),
            (Source::Exact, Minimize::Time),
            (Source::Sampled, Minimize::Layers),
        ] {
            let options = Options {
                metric,
                source,
                minimize,
                ..options()
            };
            let report = slicer.plan(&options, &mut quiet).await.unwrap();
            let numbers = report.z_mm.iter().chain(&report.sampled_error);
            let numbers = numbers.chain([&report.max_error, &report.print_time_s]);
            plans.extend(numbers.flat_map(|number| number.to_le_bytes()));
        }
    }
    let curve = slicer.tradeoff(&options(), 25, &mut quiet).await.unwrap();
    for point in &curve.points {
        plans.extend(point.tolerance.to_le_bytes());
        plans.extend(point.layers.to_le_bytes().iter().take(4));
    }
    assert_eq!(fingerprint(&plans), 0x8994_ba40_cb12_1eba);
    // A plan for filament printers, and its file.
    let filament = Options {
        metric: Metric::FilamentRoundness,
        format: Some(Format::Prusa3mf),
        ..options()
    };
    slicer.plan(&filament, &mut quiet).await.unwrap();
    assert_eq!(archive(&mut slicer), 0xedae_cf0c_4508_0127);
}

#[cfg(not(target_arch = "wasm32"))]
#[test]
fn the_plan_and_the_masks_are_the_recorded_ones() {
    pollster::block_on(check_plan_and_masks());
}

#[cfg(target_arch = "wasm32")]
#[wasm_bindgen_test]
async fn the_plan_and_the_masks_are_the_recorded_ones() {
    check_plan_and_masks().await;
}

/// The browser under test is started with WebGPU enabled, so a missing adapter is a failure.
#[cfg(target_arch = "wasm32")]
#[wasm_bindgen_test]
async fn gpu_equals_cpu_in_the_browser() {
    let gpu = Gpu::open(gpu::Adapters::Any).await.unwrap();
    let all = solids::all().into_iter();
    let all = all.map(|(name, triangles)| (name, triangles, 200));
    for (name, triangles, rays) in all.chain(solids::torture()) {
        let mesh = on_plate(&triangles);
        // Other shifts are tried natively, on two drivers.
        let grid = shifted_grid(&mesh, rays, [0.371, -0.618]);
        let expected = cpu::sample(&mesh, &grid, &mut silent).unwrap();
        for method in [Method::Fill, Method::Peel] {
            let found =
                gpu::sample(&mesh, &grid, &gpu, Default::default(), method, &mut silent).await;
            assert!(
                found.unwrap() == expected,
                "{name} differs by {method:?} on {}",
                gpu.name()
            );
        }
    }
}

/// A device of WebGPU's compatibility mode, which has no storage buffers for vertices, peels.
#[cfg(target_arch = "wasm32")]
#[wasm_bindgen_test]
async fn a_compatible_adapter_peels() {
    let request = js_sys::eval(
        "const request = GPU.prototype.requestAdapter;
         GPU.prototype.requestAdapter = function (options) {
             return request.call(this, { ...options, featureLevel: 'compatibility' });
         };
         request",
    )
    .unwrap();
    let gpu = Gpu::open(gpu::Adapters::Any).await.unwrap();
    let prototype = js_sys::eval("GPU.prototype").unwrap();
    js_sys::Reflect::set(&prototype, &"requestAdapter".into(), &request).unwrap();
    assert_eq!(gpu.method(), Method::Peel);
    // Deep ones are tried natively, on two drivers.
    for triangles in [model(), solids::stack(12)] {
        let mesh = on_plate(&triangles);
        let grid = Grid::around(&mesh.bounds(), 120).unwrap();
        let expected = cpu::sample(&mesh, &grid, &mut silent).unwrap();
        let method = gpu.method();
        let found = gpu::sample(&mesh, &grid, &gpu, Default::default(), method, &mut silent).await;
        assert!(found.unwrap() == expected);
    }
}

/// If a device is lost in the middle of a job, the CPU takes over; nothing hangs.
#[cfg(target_arch = "wasm32")]
#[wasm_bindgen_test]
async fn a_lost_device_hands_its_work_to_the_cpu() {
    let gpu = Gpu::open(gpu::Adapters::Any).await.unwrap();
    let device = gpu.device().clone();
    let mut lose_it = move |stage: Stage, _: f64| {
        if stage == Stage::Ldi {
            device.destroy();
        }
        std::ops::ControlFlow::Continue(())
    };
    let mut slicer = Slicer::load(&binary_stl(&model())).unwrap().with_gpu(gpu);
    let options = Options {
        backend: Backend::Auto,
        ..options()
    };
    let report = slicer.plan(&options, &mut lose_it).await.unwrap();
    let warnings = report.all_warnings();
    let has_failed = |it: &Warning| matches!(it, Warning::GpuFailed { .. });
    assert!(warnings.iter().any(has_failed), "{warnings:?}");
    assert_eq!(report.backend, "cpu");
}

/// `auto` does not use an emulated adapter.
#[cfg(target_arch = "wasm32")]
#[wasm_bindgen_test]
async fn an_emulated_adapter_is_no_hardware() {
    let found = Gpu::open(gpu::Adapters::Hardware).await;
    assert!(
        matches!(found, Err(LdiError::GpuEmulated { .. })),
        "{found:?}"
    );
}
