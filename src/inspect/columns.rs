//! Floors and gaps that are too thin along z.
//!
//! A lit pixel is thin if its column is lit for less than the limit, and no pixel of its layer within the limit has a
//! column that is lit longer: a thin column next to a thick part is the edge of it. The same holds for the dark between
//! lit pixels.

use super::collect::Frame;
use super::finding::Code;
use super::limits::Limits;
use super::rows::{Disc, ROUNDING, Rest, Rows};
use crate::mask::{Masks, Until};

/// The masks of short columns: lit ones, and dark ones. Masks of an ignored kind are empty.
pub(super) fn short(masks: &Masks, frame: &Frame<'_>, limits: &Limits) -> [Masks; 2] {
    let wanted = |code, limit_mm| {
        let is_wanted = limits.looks_for(code);
        until(frame, if is_wanted { limit_mm } else { 0.0 })
    };
    masks.short_columns(&Until {
        lit: wanted(Code::ThinFloor, limits.floor_mm),
        dark: wanted(Code::LowGap, limits.low_gap_mm),
    })
}

/// For each layer, the first boundary that is so far above its bottom.
fn until(frame: &Frame<'_>, limit_mm: f64) -> Vec<u32> {
    let layers = frame.layers();
    let mut top = 0;
    let first = |layer: usize| {
        while top <= layers && frame.height_mm(layer, top) * (1.0 + ROUNDING) < limit_mm {
            top += 1;
        }
        if top <= layers { top as u32 } else { u32::MAX }
    };
    (0..layers).map(first).collect()
}

/// The pixels of short columns in a layer that are not near longer ones, given all pixels of either kind.
pub(super) fn thin(short: &Rows, all: &Rows, limit: &Disc) -> Rows {
    let margin = (all.len() - short.len()) / 2;
    let reach = limit.rows();
    let near = short
        .bounds()
        .map(|[first, last]| first - reach..last + reach + 1);
    let near = near.map_or(0..0, |near| near.start + margin..near.end + margin);
    let longer = all.without_at(short, margin, near);
    Rest::default().beyond_all(short, &longer, margin, limit)
}
