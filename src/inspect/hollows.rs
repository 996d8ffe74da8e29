//! Cups and traps: dark places that the outside does not reach.
//!
//! The part hangs from the plate, and the film is below its newest layer. A dark place that no dark passage through the layers
//! so far joins with the outside, and that is open in the newest layer, sucks at the film: a cup. Once a layer covers the last
//! opening, the resin in it stays: a trap. Dark pixels of the first layer lie on the plate, which closes them.

use super::collect::{Collector, Frame};
use super::components::{Components, Extent, Patch};
use super::finding::{Code, Finding};
use super::forest::{End, Forest, Joining, Step, Tree};
use super::limits::Limits;
use super::rows::Rows;

/// The dark places between lit pixels of a layer, and which of them are open sideways.
#[derive(Default)]
pub(super) struct Gaps {
    pub components: Components,
    /// For each component, true if it meets the outside in its own layer.
    pub is_open: Vec<bool>,
}

impl Gaps {
    /// The dark places of a layer.
    pub fn between(lit: &Rows) -> Self {
        Self::new(lit.gaps(), &|row| lit.extent(row))
    }

    /// Dark pixels outside the extents of the layer's rows are outside, and not among those given.
    pub fn new(dark: Rows, extent: Extent<'_>) -> Self {
        let components = Components::new(dark);
        let mut is_open = vec![false; components.patches.len()];
        if !is_open.is_empty() {
            components.open_to(extent, -1, &mut is_open);
            components.open_to(extent, 1, &mut is_open);
        }
        Self {
            components,
            is_open,
        }
    }
}

/// Links of the gaps of a layer with those of the layer below, and gaps that are open to the outside.
#[derive(Default)]
pub(super) struct GapLinks {
    pub contacts: Vec<[u32; 2]>,
    /// Components of the layer that are open to the outside, in it or in the layer below.
    pub open: Vec<u32>,
    /// Components of the layer below that are open to the outside in the layer.
    pub open_below: Vec<u32>,
}

impl GapLinks {
    /// `below` is absent for the first layer.
    pub fn new(here: &Gaps, extent: Extent<'_>, below: Option<(&Gaps, Extent<'_>)>) -> Self {
        let mut is_open = here.is_open.clone();
        let mut is_open_below = Vec::new();
        let mut contacts = Vec::new();
        if let Some((gaps, extent_below)) = below {
            contacts = here.components.contacts(&gaps.components);
            here.components.open_to(extent_below, 0, &mut is_open);
            is_open_below = vec![false; gaps.is_open.len()];
            gaps.components.open_to(extent, 0, &mut is_open_below);
        }
        let those = |is_open: &[bool]| {
            let all = is_open.iter().zip(0..);
            all.filter(|it| *it.0).map(|it| it.1).collect()
        };
        Self {
            contacts,
            open: those(&is_open),
            open_below: those(&is_open_below),
        }
    }
}

/// The hollows of the layers so far.
pub(super) struct Hollows<'a> {
    frame: &'a Frame<'a>,
    limits: &'a Limits,
    forest: Forest,
}

impl<'a> Hollows<'a> {
    pub fn new(frame: &'a Frame<'a>, limits: &'a Limits) -> Self {
        Self {
            frame,
            limits,
            forest: Forest::with_outside(Joining::Unites, &Patch::NOWHERE),
        }
    }

    pub fn advance(
        &mut self,
        layer: usize,
        gaps: &Gaps,
        links: &GapLinks,
        collector: &mut Collector<'_>,
    ) {
        let step = Step {
            layer,
            bins: self.frame.bins(layer),
            patches: &gaps.components.patches,
            contacts: &links.contacts,
            fixed: &links.open,
            fixed_below: &links.open_below,
        };
        for (tree, end) in self.forest.advance(&step) {
            self.add(&tree, end, collector);
        }
    }

    /// The hollow, or the outside, that a gap of the last layer belongs to.
    pub fn tree(&self, gap: u32) -> u32 {
        self.forest.of_components()[gap as usize]
    }

    /// Returns true if a hollow is closed by now.
    pub fn is_trap(&self, tree: u32) -> bool {
        let tree = self.forest.root(tree);
        !tree.is_fixed && tree.last + 1 < self.frame.layers()
    }

    pub fn finish(self, collector: &mut Collector<'_>) {
        for (tree, end) in self.forest.finish() {
            self.add(&tree, end, collector);
        }
    }

    fn add(&self, tree: &Tree, end: End, collector: &mut Collector<'_>) {
        let (frame, limits) = (self.frame, self.limits);
        if tree.is_fixed {
            return;
        }
        let is_trap = end == End::Closed;
        let code = if is_trap { Code::Trap } else { Code::Cup };
        let finding = frame.finding(code, tree);
        let (size, limit) = if is_trap {
            (finding.volume_mm3 / 1e3, limits.trap_ml)
        } else {
            (finding.area_mm2, limits.cup_mm2)
        };
        if size >= limit {
            collector.add(Finding { limit, ..finding });
        }
    }
}
