//! Areas of layers: the area that is peeled off the film, the force that this takes, and the area that holds the print on the plate.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use serde::Serialize;

use super::collect::{Collector, Frame};
use super::components::{Components, Patch};
use super::finding::{Code, Finding};
use super::limits::{Limits, Severity};
use super::rows::Span;
use crate::grid::Grid;
use crate::prepare::peel_n;

/// Lit areas of the layers, and the forces that peel them off the film.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Peel {
    /// The area of each layer in mm².
    pub area_mm2: Vec<f64>,
    /// The pull of the film at each layer in newtons, without the suction of cups.
    pub pull_n: Vec<f64>,
    /// The layer with the largest area, from 0.
    pub largest_layer: usize,
    /// The layer that has most more area than the one below, from 0: 0 if none has more.
    pub jump_layer: usize,
    /// Increase of its area over the layer below, in mm².
    pub jump_mm2: f64,
    /// The area on the plate as a fraction of the largest.
    pub contact: f64,
}

/// The areas of the layers so far.
pub(super) struct Peeling<'a> {
    frame: &'a Frame<'a>,
    limits: &'a Limits,
    layers: Vec<Patch>,
    pull_n: Vec<f64>,
    film_kpa: f64,
}

impl<'a> Peeling<'a> {
    pub fn new(frame: &'a Frame<'a>, limits: &'a Limits, film_kpa: f64) -> Self {
        Self {
            pull_n: Vec::with_capacity(frame.layers()),
            film_kpa,
            frame,
            limits,
            layers: Vec::with_capacity(frame.layers()),
        }
    }

    /// Takes the parts of the next layer, and the pull of a film of 1 kPa at it, in newtons.
    pub fn advance(&mut self, patches: &[Patch], pull: f64) {
        self.pull_n.push(pull * self.film_kpa);
        let mut layer = patches.first().copied().unwrap_or(Patch::NOWHERE);
        for patch in patches.iter().skip(1) {
            layer.add(patch);
        }
        self.layers.push(layer);
    }

    pub fn finish(self, collector: &mut Collector<'_>) -> Peel {
        let Self {
            frame,
            limits,
            layers,
            pull_n,
            ..
        } = self;
        let mut largest = 0;
        let (mut jump_layer, mut jump) = (0, 0);
        for (layer, patch) in layers.iter().enumerate() {
            if patch.pixels > layers[largest].pixels {
                largest = layer;
            }
            let below = layer.checked_sub(1).map_or(patch, |below| &layers[below]);
            if patch.pixels.saturating_sub(below.pixels) > jump {
                (jump_layer, jump) = (layer, patch.pixels - below.pixels);
            }
        }
        let peel = Peel {
            area_mm2: layers.iter().map(|it| frame.area_mm2(it.pixels)).collect(),
            pull_n,
            largest_layer: largest,
            jump_layer,
            jump_mm2: frame.area_mm2(jump),
            contact: layers[0].pixels as f64 / layers[largest].pixels.max(1) as f64,
        };
        let mut add = |code, layer: usize, area_mm2, limit| {
            collector.add(Finding {
                code,
                severity: Severity::Review,
                at_mm: frame.middle_mm(&layers[layer], layer),
                bounds_mm: frame.bounds_mm(&layers[layer], [layer; 2]),
                layers: [layer; 2],
                area_mm2,
                volume_mm3: area_mm2 * frame.thickness_mm(layer),
                joins_layer: None,
                limit,
            });
        };
        if let Some(limit) = limits
            .peel_mm2
            .filter(|limit| peel.area_mm2[largest] > *limit)
        {
            add(Code::PeelArea, largest, peel.area_mm2[largest], limit);
        }
        if let Some(limit) = limits.peel_jump_mm2.filter(|limit| peel.jump_mm2 > *limit) {
            add(Code::PeelJump, jump_layer, peel.jump_mm2, limit);
        }
        if let Some(limit) = limits.contact.filter(|limit| peel.contact < *limit) {
            add(Code::SmallContact, 0, peel.area_mm2[0], limit);
        }
        peel
    }
}

/// Pull of a film of 1 kPa at the lit pixels of a layer, in newtons: the sum over its parts. Perimeters are by Cauchy and Crofton's formula
/// for the directions of a pixel's sides and corners.
pub(super) fn pull(lit: &Components, grid: &Grid) -> f64 {
    let [width_mm, depth_mm] = [grid.pitch_mm, grid.pitch_y_mm];
    let diagonal_mm = (width_mm * width_mm + depth_mm * depth_mm).sqrt();
    let pixel_mm2 = width_mm * depth_mm;
    let turn = arctangent(depth_mm / width_mm);
    // Half the distance between parallel lines times the angle that a direction stands for. Each line leaves a part as often as it enters.
    let along_row = depth_mm * turn;
    let across = [
        pixel_mm2 / diagonal_mm * FRAC_PI_4,
        width_mm * (FRAC_PI_2 - turn),
        pixel_mm2 / diagonal_mm * FRAC_PI_4,
    ];
    let mut perimeters_mm = vec![0.0; lit.patches.len()];
    for row in 0..lit.rows.len() {
        let below: &[Span] = if row + 1 < lit.rows.len() {
            lit.rows.row(row + 1)
        } else {
            &[]
        };
        let mut first = [0; 3];
        for (span, part) in lit.of_row(row) {
            let mut perimeter_mm = along_row;
            for ((step, share_mm), first) in (-1..=1).zip(across).zip(&mut first) {
                let dark = span.pixels() - overlap(span, below, step, first);
                perimeter_mm += share_mm * dark as f64;
            }
            perimeters_mm[part as usize] += perimeter_mm;
        }
    }
    let parts = lit.patches.iter().zip(perimeters_mm);
    parts
        .map(|(part, perimeter_mm)| peel_n(part.pixels as f64 * pixel_mm2, perimeter_mm, 1.0))
        .sum()
}

/// Pixels of a span with a lit one in the row below, `step` columns on. `first` is the first span there that may reach so far, and moves on.
fn overlap(span: Span, below: &[Span], step: i32, first: &mut usize) -> u64 {
    let (start, end) = (span.start + step, span.end + step);
    let mut pixels = 0;
    while let Some(other) = below.get(*first) {
        pixels += (other.end.min(end) - other.start.max(start)).max(0) as u64;
        if other.end >= end {
            break;
        }
        *first += 1;
    }
    pixels
}

/// Arctangent of a positive number, by its series around 1: the same on every machine.
fn arctangent(number: f64) -> f64 {
    let from_one = (number - 1.0) / (number + 1.0);
    let square = from_one * from_one;
    let terms = (0..40).rev();
    let series = terms.fold(0.0, |sum, i| 1.0 / f64::from(2 * i + 1) - square * sum);
    FRAC_PI_4 + from_one * series
}

#[cfg(test)]
mod tests {
    use super::arctangent;

    #[test]
    fn arctangents_are_those_of_the_library() {
        for number in [0.2_f64, 0.5, 0.79, 1.0, 1.26, 4.0] {
            let difference = (arctangent(number) - number.atan()).abs();
            assert!(difference < 1e-12, "{number}");
        }
    }
}
