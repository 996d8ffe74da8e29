//! Connected components over layers, followed from the plate upward.
//!
//! A tree is a connected set of components of the layers so far. Each layer's components join the trees that they
//! meet below, or begin new ones. The same sweep finds bodies and islands among lit components, cups and traps among dark
//! ones, and joins findings of consecutive layers.

use super::collect::Frame;
use super::components::{NONE, Patch};
use super::layer::Layer;
use crate::argsort::sort_by_number;
use crate::union_find::{find, unite};

/// Reason for which a tree ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    /// A component joins it with an older tree.
    Joined,
    /// The layer has no component of it.
    Closed,
    /// There are no more layers.
    Top,
}

/// Fate of the younger of two trees that a component joins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Joining {
    /// It ends, and its volume counts as the older one's.
    Ends,
    /// Both are one from the beginning, unless the older one is the outside.
    Unites,
}

/// A tree, measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Tree {
    /// Its place among all trees, in the order in which they begin.
    pub number: u32,
    /// The first layer.
    pub first: usize,
    /// The last layer so far.
    pub last: usize,
    /// Pixels times bins of height.
    pub volume: u64,
    /// The first layer's pixels that are the tree's.
    pub begin: Patch,
    /// The pixels of the layer that has most of them.
    pub largest: Patch,
    /// The layer with these pixels.
    pub largest_layer: usize,
    /// The box around all layers.
    pub around: Patch,
    /// True if it stands on the plate, or is the outside.
    pub is_fixed: bool,
    /// The pixels of the last layer.
    here: Patch,
}

impl Tree {
    fn new(number: u32, layer: usize, patch: &Patch, is_fixed: bool) -> Self {
        Self {
            number,
            first: layer,
            last: layer,
            volume: 0,
            begin: *patch,
            largest: *patch,
            largest_layer: layer,
            around: *patch,
            is_fixed,
            here: *patch,
        }
    }

    /// Takes the volume of another tree, and its extent as well if they unite.
    fn absorb(&mut self, other: &Self, joining: Joining) {
        self.volume += other.volume;
        self.around.extend(&other.around);
        if joining == Joining::Unites {
            self.first = self.first.min(other.first);
            if other.largest.pixels > self.largest.pixels {
                (self.largest, self.largest_layer) = (other.largest, other.largest_layer);
            }
        }
    }
}

/// The components of a layer.
pub(super) struct Step<'a> {
    pub layer: usize,
    /// Thickness of the layer in bins.
    pub bins: u64,
    pub patches: &'a [Patch],
    /// Pairs of a component of the layer below and one of this layer.
    pub contacts: &'a [[u32; 2]],
    /// Components of this layer that are fixed, in ascending order.
    pub fixed: &'a [u32],
    /// Components of the layer below that this layer joins with the outside.
    pub fixed_below: &'a [u32],
}

/// All trees.
#[derive(Debug)]
pub(super) struct Forest {
    joining: Joining,
    has_outside: bool,
    parent: Vec<u32>,
    trees: Vec<Tree>,
    /// Trees with components in the last layer.
    open: Vec<u32>,
    /// The tree of each component of the last layer.
    of_component: Vec<u32>,
}

impl Forest {
    /// The tree of the outside, in a forest that has one.
    pub const OUTSIDE: u32 = 0;

    /// A forest in which trees that join end, or are one.
    pub fn new(joining: Joining) -> Self {
        Self {
            joining,
            has_outside: false,
            parent: Vec::new(),
            trees: Vec::new(),
            open: Vec::new(),
            of_component: Vec::new(),
        }
    }

    /// A forest whose fixed components belong to the outside.
    pub fn with_outside(joining: Joining, anywhere: &Patch) -> Self {
        Self {
            has_outside: true,
            parent: vec![Self::OUTSIDE],
            trees: vec![Tree::new(Self::OUTSIDE, 0, anywhere, true)],
            ..Self::new(joining)
        }
    }

    /// Goes on to the next layer. Returns the trees that end below it.
    ///
    /// Cost: nearly linear in components and contacts.
    pub fn advance(&mut self, step: &Step<'_>) -> Vec<(Tree, End)> {
        let has_outside = self.has_outside;
        let mut node = vec![NONE; step.patches.len()];
        for &[under, over] in step.contacts {
            let tree = find(&mut self.parent, self.of_component[under as usize]);
            let known = &mut node[over as usize];
            *known = if *known == NONE {
                tree
            } else {
                unite(&mut self.parent, *known, tree)
            };
        }
        for &component in step.fixed_below {
            if has_outside {
                unite(
                    &mut self.parent,
                    Self::OUTSIDE,
                    self.of_component[component as usize],
                );
            }
        }
        for &component in step.fixed {
            let known = &mut node[component as usize];
            if has_outside {
                *known = if *known == NONE {
                    Self::OUTSIDE
                } else {
                    unite(&mut self.parent, Self::OUTSIDE, *known)
                };
            }
        }
        let components = 0..step.patches.len() as u32;
        let mut new: Vec<u32> = components.filter(|&it| node[it as usize] == NONE).collect();
        // The larger of two that begin together is the older one.
        sort_by_number(&mut new, |&it| -(step.patches[it as usize].pixels as f64));
        let mut ended = self.settle();
        for component in new {
            let tree = self.trees.len() as u32;
            let is_fixed = !has_outside && step.fixed.binary_search(&component).is_ok();
            let patch = &step.patches[component as usize];
            self.trees
                .push(Tree::new(tree, step.layer, patch, is_fixed));
            self.parent.push(tree);
            node[component as usize] = tree;
        }
        let before = std::mem::take(&mut self.open);
        self.measure(step, &mut node);
        for tree in before {
            let is_root = self.parent[tree as usize] == tree;
            if is_root && self.trees[tree as usize].last < step.layer {
                ended.push((self.trees[tree as usize], End::Closed));
            }
        }
        self.of_component = node;
        ended
    }

    /// Goes on to the lit components of the next layer, of which those of the first stand on the plate. Returns the trees that end below it.
    pub fn rise(&mut self, layer: &Layer, frame: &Frame<'_>) -> Vec<(Tree, End)> {
        let patches = &layer.alone.lit.patches;
        let on_plate: Vec<u32> = (0..patches.len() as u32).collect();
        self.advance(&Step {
            layer: layer.number,
            bins: frame.bins(layer.number),
            patches,
            contacts: &layer.contacts,
            fixed: if layer.number == 0 { &on_plate } else { &[] },
            fixed_below: &[],
        })
    }

    /// Ends trees that have just joined older ones, or makes them one.
    fn settle(&mut self) -> Vec<(Tree, End)> {
        let mut ended = Vec::new();
        for place in 0..self.open.len() {
            let tree = self.open[place];
            let root = find(&mut self.parent, tree);
            if root == tree {
                continue;
            }
            let other = self.trees[tree as usize];
            let winner = &mut self.trees[root as usize];
            if !other.is_fixed && (winner.is_fixed || self.joining == Joining::Ends) {
                ended.push((other, End::Joined));
            }
            winner.absorb(&other, self.joining);
        }
        ended
    }

    /// Adds a layer's components to their trees.
    fn measure(&mut self, step: &Step<'_>, node: &mut [u32]) {
        for (node, patch) in node.iter_mut().zip(step.patches) {
            *node = find(&mut self.parent, *node);
            let tree = &mut self.trees[*node as usize];
            if tree.last < step.layer || tree.volume == 0 {
                tree.here = *patch;
                self.open.push(*node);
            } else {
                tree.here.add(patch);
            }
            tree.last = step.layer;
            tree.volume += patch.pixels * step.bins;
            tree.around.extend(patch);
        }
        for &open in &self.open {
            let tree = &mut self.trees[open as usize];
            if tree.here.pixels > tree.largest.pixels {
                (tree.largest, tree.largest_layer) = (tree.here, step.layer);
            }
        }
    }

    /// Number of trees so far.
    pub fn trees(&self) -> usize {
        self.trees.len()
    }

    /// The tree of each component of the last layer.
    pub fn of_components(&self) -> &[u32] {
        &self.of_component
    }

    /// The tree that another is part of by now.
    pub fn root(&self, mut tree: u32) -> &Tree {
        while self.parent[tree as usize] != tree {
            tree = self.parent[tree as usize];
        }
        &self.trees[tree as usize]
    }

    /// The trees that reach the last layer.
    pub fn finish(&self) -> Vec<(Tree, End)> {
        let open = self.open.iter().map(|&tree| &self.trees[tree as usize]);
        open.map(|tree| (*tree, End::Top)).collect()
    }
}
