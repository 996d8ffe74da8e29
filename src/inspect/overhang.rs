//! Overhangs: surfaces that are too flat to support themselves and reach out too far.
//!
//! A pixel is supported if the layer below has a supported pixel within the width that the least self-supporting slope
//! spans in this layer. All of the first layer is supported. So is an island, as whatever will support it does so
//! there. An overhang is where unsupported pixels are farther than a limit from all supported pixels of their layer.
//! Unsupported pixels that bridge the way from one supported pixel to another are supported by both, and those near the
//! contact of a support by it.

use super::bridges::Bridges;
use super::collect::{Collector, Frame};
use super::components::Components;
use super::finding::Code;
use super::held::Held;
use super::layer::Layer;
use super::limits::Limits;
use super::regions::Regions;
use super::rows::{Disc, Rest, Rows, Span};
use super::surfaces::Surfaces;

/// Width that the least self-supporting slope spans in a layer, in pixels.
pub(super) fn width(layer: usize, frame: &Frame<'_>, limits: &Limits) -> Disc {
    let pitch_mm = frame.grid.pitch_mm.max(frame.grid.pitch_y_mm);
    let run_mm = frame.thickness_mm(layer) / limits.self_supporting_slope;
    // Masks round to whole pixels: half a pixel makes up for it, and less than one is no slope at all.
    let width_mm = (run_mm + pitch_mm / 2.0).max(pitch_mm);
    Disc::new(width_mm, frame.grid)
}

/// The pixels of a layer that are too far from the layer below, if all of that is supported. Islands have none.
pub(super) fn unsupported(
    here: &Components,
    below: &Rows,
    contacts: &[[u32; 2]],
    width: &Disc,
) -> Rows {
    let touches = touching(here, contacts);
    let mut found = Rows::default();
    let mut rest = Rest::default();
    let mut spans = Vec::new();
    for row in 0..here.rows.len() {
        spans_of(here, row, &touches, &mut spans);
        found.push_row(rest.beyond(&spans, below, row, width));
    }
    found
}

/// For each component, true if it touches the layer below.
fn touching(here: &Components, contacts: &[[u32; 2]]) -> Vec<bool> {
    let mut touches = vec![false; here.patches.len()];
    for &[_, over] in contacts {
        touches[over as usize] = true;
    }
    touches
}

/// The spans of a row whose components touch the layer below.
fn spans_of(here: &Components, row: i32, touches: &[bool], spans: &mut Vec<Span>) {
    spans.clear();
    let of_row = here.of_row(row);
    spans.extend(of_row.filter(|it| touches[it.1 as usize]).map(|it| it.0));
}

/// The overhangs of the layers so far.
pub(super) struct Overhangs {
    reach: Disc,
    bridges: Bridges,
    /// The unsupported pixels of the last layer, if there are any.
    unsupported: Option<Rows>,
    /// The supported pixels of the last layer, if some are not.
    supported: Rows,
    regions: Regions,
    rest: Rest,
    surfaces: Surfaces,
}

impl Overhangs {
    pub fn new(frame: &Frame<'_>, limits: &Limits, held: &Held) -> Self {
        Self {
            surfaces: Surfaces::new(held, frame),
            reach: Disc::new(limits.overhang_mm, frame.grid),
            bridges: Bridges::new(limits.bridge_mm, frame.grid),
            unsupported: None,
            supported: Rows::default(),
            regions: Regions::new(Code::Overhang, limits.overhang_mm, limits.speck_px, 0.0),
            rest: Rest::default(),
        }
    }

    pub fn advance(&mut self, layer: &Layer, frame: &Frame<'_>, collector: &mut Collector<'_>) {
        let carried = self
            .unsupported
            .take()
            .map(|below| self.carried(layer, &below));
        let mut unsupported = carried.unwrap_or_else(|| layer.flat.clone());
        let mut found = Rows::default();
        let lit = &layer.alone.lit.rows;
        self.surfaces
            .take_from(&mut unsupported, lit, layer.number, frame);
        if !unsupported.is_blank() {
            self.supported = lit.without(&unsupported);
            found = self
                .rest
                .beyond_all(&unsupported, &self.supported, 0, &self.reach);
            let rest = self.bridges.not_held(&found, &unsupported, &self.supported);
            if rest != found {
                let held = found.without(&rest);
                unsupported = unsupported.without(&held);
                self.supported = lit.without(&unsupported);
                found = self.rest.beyond_all(&rest, &held, 0, &self.reach);
            }
            self.unsupported = Some(unsupported);
        }
        self.regions.advance(layer.number, found, frame, collector);
    }

    /// The unsupported pixels of a layer above one that has some: only rows near those can have more than `flat` has.
    fn carried(&mut self, layer: &Layer, below: &Rows) -> Rows {
        let Layer { flat, width, .. } = layer;
        let here = &layer.alone.lit;
        let touches = touching(here, &layer.contacts);
        let mut spans = Vec::new();
        let mut found = Rows::default();
        let mut next = -width.rows();
        // The last row so far of the layer below that has unsupported pixels.
        let mut near = i32::MIN / 2;
        for row in 0..here.rows.len() {
            while next <= row + width.rows() {
                if !below.row(next).is_empty() {
                    near = next;
                }
                next += 1;
            }
            if near < row - width.rows() {
                found.push_row(flat.row(row));
                continue;
            }
            spans_of(here, row, &touches, &mut spans);
            found.push_row(self.rest.beyond(&spans, &self.supported, row, width));
        }
        found
    }

    pub fn finish(self, frame: &Frame<'_>, collector: &mut Collector<'_>) {
        self.regions.finish(frame, collector);
    }
}
