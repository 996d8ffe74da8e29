//! Findings that consist of pixels: those that hang together within and over layers are one.

use super::collect::{Collector, Frame};
use super::components::Components;
use super::finding::{Code, Finding};
use super::forest::{End, Forest, Joining, Step, Tree};
use super::rows::{ROUNDING, Rows};

/// The regions of one kind in the layers so far.
pub(super) struct Regions {
    code: Code,
    limit: f64,
    /// Regions of fewer pixels in every layer are left out.
    least_px: u64,
    /// Regions that are not as high are left out.
    least_height_mm: f64,
    forest: Forest,
    last: Components,
}

impl Regions {
    pub fn new(code: Code, limit: f64, least_px: u32, least_height_mm: f64) -> Self {
        Self {
            code,
            limit,
            least_px: u64::from(least_px),
            least_height_mm,
            forest: Forest::new(Joining::Unites),
            last: Components::default(),
        }
    }

    /// Adds the pixels of the next layer.
    pub fn advance(
        &mut self,
        layer: usize,
        rows: Rows,
        frame: &Frame<'_>,
        collector: &mut Collector<'_>,
    ) {
        if rows.is_blank() && self.last.rows.is_blank() {
            return;
        }
        let here = Components::new(rows);
        let step = Step {
            layer,
            bins: frame.bins(layer),
            patches: &here.patches,
            contacts: &here.contacts(&self.last),
            fixed: &[],
            fixed_below: &[],
        };
        for (tree, end) in self.forest.advance(&step) {
            self.add(&tree, end, frame, collector);
        }
        self.last = here;
    }

    pub fn finish(self, frame: &Frame<'_>, collector: &mut Collector<'_>) {
        for (tree, end) in self.forest.finish() {
            self.add(&tree, end, frame, collector);
        }
    }

    fn add(&self, tree: &Tree, end: End, frame: &Frame<'_>, collector: &mut Collector<'_>) {
        if end == End::Joined || tree.largest.pixels < self.least_px {
            return;
        }
        let height_mm = frame.z_mm[tree.last + 1] - frame.z_mm[tree.first];
        if height_mm * (1.0 + ROUNDING) < self.least_height_mm {
            return;
        }
        collector.add(Finding {
            limit: self.limit,
            ..frame.finding(self.code, tree)
        });
    }
}
