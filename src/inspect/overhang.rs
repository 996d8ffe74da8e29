//! Overhangs: surfaces that are too flat to support themselves and reach out too far.
//!
//! A pixel is supported if the layer below has a supported pixel within the width that the least self-supporting slope
//! spans in this layer. All of the first layer is supported. So is an island, as whatever will support it does so
//! there. An overhang is where unsupported pixels are farther than a limit from all supported pixels of their layer, along
//! lit pixels and never through air.
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
use super::surfaces::{CELL_MM, Surfaces};
use crate::grid::Grid;

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

/// Reach of supported pixels, straight and along lit pixels.
struct Reach {
    straight: Disc,
    /// A step along lit pixels. Gaps narrower than a step count as closed: resin closes them as well.
    step: Disc,
    /// Number of steps, and of those that surely stay within the straight reach.
    count: usize,
    sure: usize,
}

/// Ratio of a step's longest way to its shortest: what steps of pixels in rows and columns lack in other directions.
const LONGER: f64 = 1.12;

impl Reach {
    fn new(reach_mm: f64, grid: &Grid) -> Self {
        let step_mm = CELL_MM.max(2.0 * grid.pitch_mm.max(grid.pitch_y_mm));
        Self {
            straight: Disc::new(reach_mm, grid),
            step: Disc::new(LONGER * step_mm, grid),
            count: (reach_mm / step_mm).ceil() as usize,
            sure: (reach_mm / (LONGER * step_mm)) as usize,
        }
    }

    /// The unsupported pixels of a layer that are out of reach of the supported ones.
    ///
    /// Cost: for each step linear in the spans of the rows with pixels that are still to be reached.
    fn beyond(&self, unsupported: &Rows, supported: &Rows, lit: &Rows, rest: &mut Rest) -> Rows {
        let mut left = rest.beyond_all(unsupported, supported, 0, &self.step);
        // Pixels that steps reach may be farther than the straight reach only after this.
        let mut doubtful = (self.sure == 0).then(|| unsupported.clone());
        for step in 1..self.count {
            if step == self.sure {
                doubtful = Some(left.clone());
            }
            let Some([first, last]) = left.bounds() else {
                break;
            };
            let around = first - self.step.rows()..last + self.step.rows() + 1;
            let reached = lit.without_at(&left, 0, around);
            let next = rest.beyond_all(&left, &reached, 0, &self.step);
            if next == left {
                break;
            }
            left = next;
        }
        let Some(doubtful) = doubtful else {
            return left;
        };
        let far = rest.beyond_all(&doubtful, supported, 0, &self.straight);
        let within = doubtful.without(&left).without(&far);
        doubtful.without(&within)
    }
}

/// The overhangs of the layers so far.
pub(super) struct Overhangs {
    reach: Reach,
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
            reach: Reach::new(limits.overhang_mm, frame.grid),
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
                .reach
                .beyond(&unsupported, &self.supported, lit, &mut self.rest);
            let rest = self.bridges.not_held(&found, &unsupported, &self.supported);
            if rest != found {
                let held = found.without(&rest);
                unsupported = unsupported.without(&held);
                self.supported = lit.without(&unsupported);
                found = self
                    .reach
                    .beyond(&unsupported, &self.supported, lit, &mut self.rest);
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
