//! Promises of plans beyond their layers: each takes a second run, so an input checks one.

use std::sync::LazyLock;

use super::slicer::Slicer;
use cusp_slicer::archive::read::PrintFile;
use cusp_slicer::inspect::Limits;
use cusp_slicer::job::{Claim, Error, Minimize, Options, Planner, Report, VerifyError};
use cusp_slicer::plan::HeightRange;
use cusp_slicer::profile::Metric;
use glam::Vec3;
use rayon::ThreadPool;

use super::promises::{FACTS, Planned, planned};
use super::{quiet, threads};

/// Some formats have heights in whole micrometres.
const HALF_MICROMETRE_MM: f64 = 0.000_501;

/// A promise beyond those of the plan itself.
#[derive(Debug, Clone, Copy)]
pub enum Further {
    /// A print file read back has the layers and the masks.
    PrintFile,
    /// The number of threads changes nothing.
    Threads,
    /// Nor does a translation by whole millimetres.
    Translation,
    /// A model twice as large has the same layers, twice as thick, if all lengths are doubled.
    Scale,
    /// Any plan can be inspected.
    Inspection,
    /// A plan that is submitted is accepted.
    Claim,
    /// Any options have a preview and a trade-off, or an error.
    Preview,
}

/// All of them.
pub const FURTHER: [Further; 7] = [
    Further::PrintFile,
    Further::Threads,
    Further::Translation,
    Further::Scale,
    Further::Inspection,
    Further::Claim,
    Further::Preview,
];

/// Checks one of them, of a model whose plan with these options is the slicer's last.
pub fn check(
    further: Further,
    model: &[[Vec3; 3]],
    options: &Options,
    mut slicer: Slicer,
    planned: Planned,
) {
    match (further, planned) {
        (Further::Threads, planned) => check_threads(model, options, slicer, &planned),
        (Further::Translation, planned) => check_translation(model, options, &slicer, &planned),
        (Further::Scale, planned) => check_scale(model, options, &planned),
        (Further::Preview, _) => {
            let _ = slicer.preview(options);
            let _ = pollster::block_on(slicer.tradeoff(options, 3, &mut quiet));
        }
        (Further::PrintFile, Ok((report, _))) => check_print_file(&mut slicer, &report, options),
        (Further::Claim, Ok((report, _))) => check_claim(&report),
        (Further::Inspection, Ok(_)) => {
            let found = slicer.inspect(&Limits::default(), &mut quiet);
            found.expect("a plan can be inspected");
        }
        (Further::PrintFile | Further::Claim | Further::Inspection, Err(_)) => {}
    }
}

fn check_threads(model: &[[Vec3; 3]], options: &Options, mut alone: Slicer, expected: &Planned) {
    static THREE: LazyLock<ThreadPool> = LazyLock::new(|| threads(3));
    let (found, shared) = THREE.install(|| {
        let slicer = Slicer::of_triangles(model, FACTS);
        let mut slicer = slicer.expect("it is a mesh on one thread");
        let found = planned(&mut slicer, options);
        (found, written(&mut slicer))
    });
    assert_eq!(&found, expected);
    assert!(shared == written(&mut alone), "other print files");
}

/// The print file of the last plan.
fn written(slicer: &mut Slicer) -> Result<Vec<u8>, String> {
    let written = slicer.write_archive(Vec::new(), &mut quiet);
    written
        .map(|(file, _)| file)
        .map_err(|error| error.to_string())
}

fn check_translation(model: &[[Vec3; 3]], options: &Options, slicer: &Slicer, expected: &Planned) {
    // Caps are fans around centroids, which are rounded; and rotations round every coordinate.
    let is_exact = slicer.info().holes == 0
        && options.rotation.is_none()
        && options.height_mm.is_none()
        && !options.saliency;
    if !is_exact {
        return;
    }
    let by = Vec3::new(3.0, -5.0, 7.0);
    let moved: Vec<_> = model
        .iter()
        .map(|corners| corners.map(|corner| corner + by))
        .collect();
    let slicer = Slicer::of_triangles(&moved, FACTS);
    let mut slicer = slicer.expect("it is a mesh where it was");
    assert_eq!(&planned(&mut slicer, options), expected);
}

fn check_scale(model: &[[Vec3; 3]], options: &Options, expected: &Planned) {
    // Exposures, areas and supports do not scale, and tolerances that are found are rounded to what people type.
    let scales = matches!(options.metric, Metric::Cusp | Metric::Roughness)
        && options.tolerance.is_some()
        && options.minimize == Minimize::Layers
        && options.hollow.is_none()
        && options.supports.is_none()
        && !options.saliency;
    let Ok((_, expected)) = expected else {
        return;
    };
    if !scales {
        return;
    }
    let twice: Vec<_> = model
        .iter()
        .map(|corners| corners.map(|corner| corner * 2.0))
        .collect();
    let slicer = Slicer::of_triangles(&twice, FACTS);
    let mut slicer = slicer.expect("it is a mesh at half the size");
    let found = planned(&mut slicer, &doubled(options));
    let (_, found) = found.expect("it has a plan at half the size");
    assert_eq!(found.boundaries, expected.boundaries);
    assert_eq!(found.snap_planes, expected.snap_planes);
}

/// The same options with all lengths doubled.
fn doubled(options: &Options) -> Options {
    let twice = |length_mm: Option<f64>| length_mm.map(|it| 2.0 * it);
    let all = |lengths_mm: &[f64]| lengths_mm.iter().map(|it| 2.0 * it).collect();
    Options {
        height_mm: twice(options.height_mm),
        pitch_mm: twice(options.pitch_mm),
        pitch_y_mm: twice(options.pitch_y_mm),
        layer_min_mm: twice(options.layer_min_mm),
        layer_max_mm: twice(options.layer_max_mm),
        first_layer_mm: twice(options.first_layer_mm),
        thicknesses_mm: all(&options.thicknesses_mm),
        max_change_mm: twice(options.max_change_mm),
        tolerance: twice(options.tolerance),
        bin_mm: twice(options.bin_mm),
        step_mm: twice(options.step_mm),
        ranges: options
            .ranges
            .iter()
            .map(|range| HeightRange {
                from_mm: 2.0 * range.from_mm,
                to_mm: 2.0 * range.to_mm,
                layer_min_mm: 2.0 * range.layer_min_mm,
                layer_max_mm: 2.0 * range.layer_max_mm,
            })
            .collect(),
        planes_mm: all(&options.planes_mm),
        flat_area_mm2: 4.0 * options.flat_area_mm2,
        planner: match options.planner {
            Planner::Uniform { layer_mm } => Planner::Uniform {
                layer_mm: 2.0 * layer_mm,
            },
            planner => planner,
        },
        ..options.clone()
    }
}

fn check_print_file(slicer: &mut Slicer, report: &Report, options: &Options) {
    let bytes = match slicer.write_archive(Vec::new(), &mut quiet) {
        Ok((bytes, _)) => bytes,
        // Formats with one thickness, and models between the samples.
        Err(Error::Archive(_)) => return,
        Err(error) => panic!("{error}"),
    };
    let file = PrintFile::open(&*bytes).expect("what is written can be read");
    let metadata = file.metadata();
    assert_eq!(metadata.format, report.print_file.format);
    assert_eq!(metadata.pixels, [report.mask.width, report.mask.height]);
    assert_eq!(file.layers().len(), report.layers);
    let may_be_mirrored = metadata.is_mirrored_x.is_none() && report.mask.is_mirrored;
    for (layer, found) in file.layers().iter().enumerate() {
        let z_mm = report.z_mm[layer + 1];
        assert!(
            (found.z_mm - z_mm).abs() < HALF_MICROMETRE_MM,
            "{} of {z_mm} mm",
            found.z_mm
        );
        let mask = file
            .mask(layer, metadata.flips())
            .expect("masks can be decoded");
        let is_compensated = !options.resin.compensation.is_none();
        if options.antialias > 1 || may_be_mirrored || is_compensated {
            continue;
        }
        let expected = slicer.mask(layer).expect("there is this layer");
        let [width, height] = metadata.pixels;
        assert!(
            mask.bits(width, height) == expected,
            "layer {layer} differs"
        );
    }
}

fn check_claim(report: &Report) {
    let text = serde_json::to_string(report).expect("a report can be written");
    let claims = Claim::read(&text, &[&report.models[0].file]).expect("a plan can be read");
    let claim = &claims[0];
    assert_eq!(claim.options(), &report.options);
    match claim.check(report) {
        Ok(()) | Err(VerifyError::ToleranceExceeded { .. }) => {}
        Err(error) => panic!("{error}"),
    }
}
