//! The whole path over any options and models: every input gives an error or a plan that keeps its promises
//! (`promises.rs`).

use cusp_slicer::compensation::Compensation;
use cusp_slicer::format::Format;
use cusp_slicer::job::{Backend, Minimize, Options, Planner, Snap};
use cusp_slicer::plan::HeightRange;
use cusp_slicer::prepare::{Hollowing, Supporting};
use cusp_slicer::profile::{Metric, Source};
use cusp_slicer::resin::Resin;

use super::further::FURTHER;
use super::input::{Input, triangles};
use super::{alone, promises};

/// A model, options, and the further promise to check.
pub fn pipeline(bytes: &[u8]) {
    let mut input = Input(bytes);
    let further = input.below(FURTHER.len() as u8);
    let model = triangles(&mut input);
    let options = options(&mut input);
    alone(|| promises::check(&model, &options, FURTHER[usize::from(further)]));
}

/// Options, as [`pipeline`] reads them. Lengths are few bins, since more only take longer.
pub fn options(input: &mut Input<'_>) -> Options {
    let bin_mm = input.of(&[0.02, 0.01, 0.0125, 0.025, 0.05]);
    let steps = input.below(6);
    let step_mm = (steps > 0).then(|| f64::from(steps) * bin_mm);
    let unit_mm = step_mm.unwrap_or(bin_mm);
    let length = |input: &mut Input<'_>, most: u8| {
        let beside = if input.once_in(8) { 0.3 } else { 0.0 };
        (1.0 + input.number(most) + beside) * unit_mm
    };
    let layer_min_mm = length(input, 8);
    let layer_max_mm = layer_min_mm + length(input, 16);
    let mut options = Options {
        bin_mm: Some(bin_mm),
        step_mm,
        layer_min_mm: Some(layer_min_mm),
        layer_max_mm: Some(layer_max_mm),
        first_layer_mm: input.once_in(4).then(|| length(input, 12)),
        backend: Backend::Cpu,
        metric: input.of(&Metric::ALL),
        ..Options::default()
    };
    match input.below(8) {
        0 => options.max_layers = Some(usize::from(input.byte())),
        1 => options.max_time_s = Some(10.0 * input.number(255)),
        2 => {}
        _ => options.tolerance = Some(input.of(&[0.05, 0.0, 0.01, 0.02, 0.1, 0.2, 1.0])),
    }
    for _ in 0..input.below(3) {
        options.planes_mm.push(length(input, 200));
    }
    for _ in 0..input.below(3) {
        let from_mm = length(input, 100) - unit_mm;
        let layer_min_mm = length(input, 6);
        options.ranges.push(HeightRange {
            from_mm,
            to_mm: from_mm + length(input, 60),
            layer_min_mm,
            layer_max_mm: layer_min_mm + length(input, 12),
        });
    }
    match input.below(12) {
        1 => {
            let count = 1 + input.below(4);
            options.thicknesses_mm = (0..count).map(|_| length(input, 16)).collect();
        }
        2 => options.max_thicknesses = Some(usize::from(1 + input.below(4))),
        3 => options.max_change_mm = Some(length(input, 8)),
        4 => options.planner = Planner::Greedy,
        5 => options.planner = Planner::Local,
        6 => {
            let layer_mm = length(input, 16);
            options.planner = Planner::Uniform { layer_mm };
        }
        7 => options.planner = Planner::Finest,
        8 => options.planner = Planner::Coarsest,
        9 => options.minimize = Minimize::Time,
        _ => {}
    }
    rest(input, &mut options);
    options
}

/// Sets the options that are not about layers.
fn rest(input: &mut Input<'_>, options: &mut Options) {
    if input.once_in(4) {
        options.snap = Snap::Off;
    }
    options.flat_area_mm2 = input.of(&[1.0, 0.0, 0.01, 4.0]);
    if input.once_in(4) {
        options.source = Source::Sampled;
    }
    options.saliency = input.once_in(8);
    options.weight_min = input.of(&[0.25, 0.0, 0.5, 1.0]);
    if input.once_in(4) {
        options.rotation = Some([(); 4].map(|()| input.number(16) - 8.0));
    }
    if input.once_in(6) {
        options.height_mm = Some((1.0 + input.number(32)) / 16.0);
    }
    let pitch_mm = (2.0 + input.number(8)) / 32.0;
    match input.below(4) {
        1 => options.pitch_mm = Some(pitch_mm),
        2 => {
            options.pitch_mm = Some(pitch_mm);
            options.pitch_y_mm = Some((2.0 + input.number(8)) / 32.0);
            options.pixels = Some([(); 2].map(|()| 16 + u32::from(input.below(32))));
        }
        _ => options.rays = 4 + u32::from(input.below(37)),
    }
    options.antialias = input.of(&[1, 1, 1, 2, 4, 8]);
    options.mirror = input.of(&[None, Some(false), Some(true)]);
    options.format = Some(input.of(&Format::MASKS));
    options.resin = Resin {
        layer_mm: input.of(&[0.05, 0.1]),
        bottom_layers: usize::from(input.below(8)),
        ..Resin::default()
    };
    if input.once_in(8) {
        options.resin.compensation = Compensation {
            xy_mm: input.of(&[0.05, -0.05, 0.2]),
            bottom_xy_mm: input.of(&[None, Some(0.1)]),
            faded_layers: usize::from(input.below(4)),
            z_mm: input.of(&[0.0, 0.05, 0.2]),
        };
    }
    if input.once_in(32) {
        options.hollow = Some(Hollowing {
            wall_mm: 0.4,
            cavity_mm: 0.4,
            ..Hollowing::default()
        });
    }
    if input.once_in(32) {
        options.supports = Some(Supporting::default());
    }
}
