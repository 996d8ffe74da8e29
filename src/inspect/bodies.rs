//! Bodies and islands: what hangs together when it is lit.

use super::collect::{Collector, Frame};
use super::finding::{Code, Finding};
use super::forest::{End, Forest, Joining, Tree};
use super::layer::Layer;
use super::limits::Limits;

/// The bodies of the layers so far.
pub(super) struct Bodies<'a> {
    frame: &'a Frame<'a>,
    limits: &'a Limits,
    forest: Forest,
    /// The largest body on the plate that has ended; the others are separate from it.
    main: Option<Finding>,
    /// Number of bodies, loose ones included.
    pub count: usize,
}

impl<'a> Bodies<'a> {
    pub fn new(frame: &'a Frame<'a>, limits: &'a Limits) -> Self {
        Self {
            frame,
            limits,
            forest: Forest::new(Joining::Ends),
            main: None,
            count: 0,
        }
    }

    pub fn advance(&mut self, layer: &Layer, collector: &mut Collector<'_>) {
        for (tree, end) in self.forest.rise(layer, self.frame) {
            self.end(&tree, end, layer.number, collector);
        }
    }

    pub fn finish(mut self, collector: &mut Collector<'_>) -> usize {
        for (tree, end) in self.forest.finish() {
            self.end(&tree, end, self.frame.layers(), collector);
        }
        self.count
    }

    fn end(&mut self, tree: &Tree, end: End, layer: usize, collector: &mut Collector<'_>) {
        let finding = |code| self.frame.finding(code, tree);
        if end == End::Joined {
            let island = finding(Code::Island);
            if island.area_mm2 >= self.limits.island_mm2 {
                collector.add(Finding {
                    at_mm: self.frame.middle_mm(&tree.begin, tree.first),
                    joins_layer: Some(layer),
                    limit: self.limits.island_mm2,
                    ..island
                });
            }
            return;
        }
        self.count += 1;
        if tree.is_fixed {
            let mut other = finding(Code::SeparateBody);
            match &mut self.main {
                None => {
                    self.main = Some(other);
                    return;
                }
                Some(main) if main.volume_mm3 < other.volume_mm3 => {
                    std::mem::swap(main, &mut other);
                }
                Some(_) => {}
            }
            collector.add(other);
            return;
        }
        let is_speck =
            tree.largest.pixels < u64::from(self.limits.speck_px) || tree.first == tree.last;
        let code = if is_speck {
            Code::Speck
        } else {
            Code::LooseBody
        };
        collector.add(Finding {
            at_mm: self.frame.middle_mm(&tree.begin, tree.first),
            limit: f64::from(self.limits.speck_px),
            ..finding(code)
        });
    }
}
