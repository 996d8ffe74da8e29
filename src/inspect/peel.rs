//! Areas of layers: the area that is peeled off the film, and the area that holds the print on the plate.

use serde::Serialize;

use super::collect::{Collector, Frame};
use super::components::Patch;
use super::finding::{Code, Finding};
use super::limits::{Limits, Severity};

/// Lit areas of the layers. The force that peels a layer off the film grows with its area.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Peel {
    /// The area of each layer in mm².
    pub area_mm2: Vec<f64>,
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
}

impl<'a> Peeling<'a> {
    pub fn new(frame: &'a Frame<'a>, limits: &'a Limits) -> Self {
        Self {
            frame,
            limits,
            layers: Vec::with_capacity(frame.layers()),
        }
    }

    pub fn advance(&mut self, patches: &[Patch]) {
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
