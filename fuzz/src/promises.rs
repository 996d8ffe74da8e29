//! Promises of the layers of every plan.

use super::slicer::Slicer;
use cusp_slicer::job::{Options, Planner, Report, Timings};
use cusp_slicer::model::{FileFacts, Mesh, ModelFile, Pose};
use cusp_slicer::plan::{HeightRange, Plan};
use cusp_slicer::profile::{Metric, Source};
use glam::Vec3;

use super::further::{self, Further};
use super::quiet;

/// Lengths this close, as a fraction of a bin, are equal.
const SLACK_BINS: f64 = 2e-3;
/// The greatest side of a model.
const MOST_MM: f64 = 6.0;
/// The least longest side of a model with supports, whose feet have a size of their own: pixels that are a part of the model would be many.
const LEAST_SUPPORTED_MM: f64 = 0.5;
/// Room for the rounding of an error.
const ROOM: f64 = 1e-6;

/// Facts of a model without a file.
pub const FACTS: FileFacts = FileFacts {
    file: ModelFile {
        bytes: 0,
        crc32: 0,
        plate: None,
        surfaces: false,
        curved_caps: false,
        supports_as_model: false,
        mirrored: false,
    },
    unit: None,
    skipped_objects: 0,
    parts: Vec::new(),
};

/// Prints the options if a promise is broken.
struct Shown<'a>(&'a Options, Further);

impl Drop for Shown<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            eprintln!("{:?} of {:?}", self.1, self.0);
        }
    }
}

/// Plans, and checks the promises of the plan.
pub fn check(model: &[[Vec3; 3]], options: &Options, further: Further) {
    let _shown = Shown(options, further);
    let Ok(mut slicer) = Slicer::of_triangles(model, FACTS) else {
        return;
    };
    if takes_long(model, options) {
        return;
    }
    let planned = planned(&mut slicer, options);
    if let Ok((report, plan)) = &planned {
        check_layers(report, plan, options);
        check_errors(&slicer, report, plan, options);
    }
    further::check(further, model, options, slicer, planned);
}

/// Returns true if the model is large on the plate, as a low one may be scaled to any size by its height, or far
/// smaller than its supports. Its rays and pixels only take longer.
fn takes_long(model: &[[Vec3; 3]], options: &Options) -> bool {
    let pose = Pose {
        rotation: options.rotation,
        height_mm: options.height_mm,
        unit: options.unit,
    };
    let posed = Mesh::from_triangles(model).and_then(|mesh| mesh.on_plate(&pose));
    posed.is_ok_and(|mesh| {
        let longest_mm = mesh.bounds().size().max_element();
        longest_mm > MOST_MM || (options.supports.is_some() && longest_mm < LEAST_SUPPORTED_MM)
    })
}

/// The report without times and the plan, or the error's sentence.
pub type Planned = Result<(Report, Plan), String>;

/// Plans.
pub fn planned(slicer: &mut Slicer, options: &Options) -> Planned {
    let report = pollster::block_on(slicer.plan(options, &mut quiet));
    let mut report = report.cloned().map_err(|error| error.to_string())?;
    report.timings_ms = Timings::default();
    let (_, plan) = slicer.planned().expect("there is a plan");
    let plan = plan.clone();
    Ok((report, plan))
}

/// Returns true if the planner chooses every layer within the limits.
fn keeps_limits(options: &Options) -> bool {
    matches!(
        options.planner,
        Planner::Optimal | Planner::Greedy | Planner::Local
    )
}

/// Layers ascend from the plate to the model's height, within their limits, with a boundary at each mandatory plane.
fn check_layers(report: &Report, plan: &Plan, options: &Options) {
    let boundaries = &plan.boundaries;
    assert_eq!(boundaries[0], 0);
    assert!(boundaries.is_sorted_by(|below, above| below < above));
    assert_eq!(report.layers, plan.layers());
    assert_eq!(report.exposure_s.len(), plan.layers());
    assert_eq!(report.z_mm, plan.z_mm());
    let top_mm = report.z_mm[report.layers];
    let sum_mm: f64 = report.thickness_mm.iter().sum();
    assert!((sum_mm - top_mm).abs() < 1e-6, "{sum_mm} of {top_mm} mm");
    assert!(plan.snap_planes.iter().all(|it| boundaries.contains(it)));

    let bin_mm = plan.bins.size_mm;
    let uniform = &report.thickness_mm[plan.exempt_layers..];
    let moved_mm = (top_mm - report.height_mm).abs();
    if !keeps_limits(options) {
        let thickness_mm = uniform[0];
        assert!(uniform.iter().all(|it| (it - thickness_mm).abs() < 1e-9));
        let is_low = report.layers == 1;
        assert!(
            is_low || moved_mm <= 0.5 * thickness_mm + bin_mm,
            "{moved_mm} mm"
        );
        return;
    }
    let unit_mm = options.step_mm.unwrap_or(bin_mm);
    let settled = options.settled();
    let all = HeightRange {
        from_mm: 0.0,
        to_mm: f64::INFINITY,
        layer_min_mm: settled.layer_min_mm.unwrap_or(0.0),
        layer_max_mm: settled.layer_max_mm.unwrap_or(f64::INFINITY),
    };
    let list = &options.thicknesses_mm;
    let slack_mm = SLACK_BINS * unit_mm;
    let mut greatest_min_mm = 0.0f64;
    for (layer, &thickness_mm) in report.thickness_mm.iter().enumerate() {
        if layer < plan.exempt_layers {
            continue;
        }
        let middle_mm = 0.5 * (report.z_mm[layer] + report.z_mm[layer + 1]);
        let near = |z_mm: f64| (z_mm / unit_mm + 0.5).floor() * unit_mm;
        let range = options
            .ranges
            .iter()
            .find(|range| (near(range.from_mm)..near(range.to_mm)).contains(&middle_mm));
        if range.is_some() || list.is_empty() {
            let range = range.unwrap_or(&all);
            assert!(
                thickness_mm >= range.layer_min_mm - slack_mm
                    && thickness_mm <= range.layer_max_mm + slack_mm,
                "layer {layer} of {thickness_mm} mm is beyond {range:?}"
            );
            greatest_min_mm = greatest_min_mm.max(range.layer_min_mm);
        }
        if !list.is_empty() {
            let is_it = |it: &&f64| (*it - thickness_mm).abs() <= slack_mm;
            let listed = list.iter().find(is_it);
            assert!(listed.is_some(), "layer {layer} of {thickness_mm} mm");
        }
        // Few thicknesses rarely add up, so the top then moves by half of the least of them.
        if !list.is_empty() || options.max_thicknesses.is_some() {
            greatest_min_mm = greatest_min_mm.max(thickness_mm);
        }
    }
    assert!(
        moved_mm <= 0.5 * greatest_min_mm + unit_mm + bin_mm,
        "{top_mm} of {} mm",
        report.height_mm
    );
    check_rules(plan, options);
    check_planes(report, plan, options, unit_mm);
}

/// The rules of the optimal planner.
fn check_rules(plan: &Plan, options: &Options) {
    let thicknesses: Vec<u32> = plan
        .covered()
        .windows(2)
        .map(|layer| layer[1] - layer[0])
        .collect();
    if let Some(most) = options.max_thicknesses {
        let mut distinct = thicknesses.clone();
        distinct.sort_unstable();
        distinct.dedup();
        assert!(distinct.len() <= most, "{distinct:?} bins");
    }
    if let Some(change_mm) = options.max_change_mm {
        let changes = thicknesses.windows(2).map(|two| two[0].abs_diff(two[1]));
        let most = change_mm / plan.bins.size_mm;
        for change in changes {
            assert!(f64::from(change) <= most + SLACK_BINS, "{change} bins");
        }
    }
}

/// Each mandatory plane below the top is a boundary.
fn check_planes(report: &Report, plan: &Plan, options: &Options, unit_mm: f64) {
    let unit = (unit_mm / plan.bins.size_mm).round() as u32;
    let lowest = plan.boundaries[plan.exempt_layers];
    if let Some(first_mm) = options.first_layer_mm {
        assert!((report.z_mm[1] - first_mm).abs() <= SLACK_BINS * unit_mm);
    }
    let ends = options.ranges.iter();
    let ends = ends.flat_map(|range| [range.from_mm, range.to_mm]);
    for plane_mm in options.planes_mm.iter().copied().chain(ends) {
        let plane = (plane_mm / plan.bins.size_mm / f64::from(unit) + 0.5) as u32 * unit;
        if plane > lowest && (plane as usize) < plan.bins.count {
            assert!(
                plan.boundaries.contains(&plane),
                "no plane at {plane_mm} mm"
            );
        }
    }
}

/// The optimal planner keeps the tolerance on every layer that it covers.
fn check_errors(slicer: &Slicer, report: &Report, plan: &Plan, options: &Options) {
    if options.planner != Planner::Optimal {
        return;
    }
    let kept = match options.source {
        Source::Exact => report.max_error,
        Source::Sampled => report.sampled_error.unwrap(),
    };
    let most = report.tolerance * (1.0 + ROOM) + ROOM;
    assert!(kept <= most, "{kept} of {}", report.tolerance);
    if !matches!(options.metric, Metric::Cusp | Metric::Roughness) {
        return;
    }
    // Summed naively (eq. 1).
    let profile = slicer.profile(options.metric, options.source);
    let profile = profile.expect("what was planned was measured");
    for layer in plan.covered().windows(2) {
        let end = (layer[1] as usize).min(plan.bins.count);
        let densities = &profile.density[(layer[0] as usize).min(end)..end];
        let sum: f64 = densities.iter().copied().map(f64::from).sum();
        let error = sum * plan.bins.size_mm;
        assert!(error <= most + ROOM, "{error} of {}", report.tolerance);
    }
}
