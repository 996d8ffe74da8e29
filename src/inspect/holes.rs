//! Holes that are too small: dark places that are enclosed in their layer, and smaller than a limit whichever way they are measured.

use super::collect::Frame;
use super::components::Patch;
use super::finding::Code;
use super::hollows::Gaps;
use super::limits::Limits;
use super::rows::{ROUNDING, Rows};

/// The pixels of a layer's small holes.
pub(super) fn small(gaps: &Gaps, frame: &Frame<'_>, limits: &Limits) -> Rows {
    if !limits.looks_for(Code::SmallHole) {
        return Rows::default();
    }
    let grid = frame.grid;
    // A hole may be a pixel smaller in masks than it is.
    let is_short = |[first, last]: [i32; 2], pitch_mm: f64| {
        f64::from(last - first + 2) * pitch_mm < limits.hole_mm * (1.0 - ROUNDING)
    };
    let is_small = |patch: &Patch| {
        is_short(patch.columns, grid.pitch_mm) && is_short(patch.rows, grid.pitch_y_mm)
    };
    let patches = gaps.components.patches.iter().zip(&gaps.is_open);
    let is_small: Vec<bool> = patches
        .map(|(patch, is_open)| !is_open && is_small(patch))
        .collect();
    let mut small = Rows::default();
    if !is_small.contains(&true) {
        return small;
    }
    for row in 0..gaps.components.rows.len() {
        for (span, component) in gaps.components.of_row(row) {
            if is_small[component as usize] {
                small.push(span);
            }
        }
        small.end_row();
    }
    small
}
