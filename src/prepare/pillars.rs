//! Pillars that hold the ceilings of a void where they are wider than a bridge, each with a head that widens by 45°.

use glam::Vec3;

use super::surface_nets::Lattice;
use crate::ways::{self, AROUND};

/// Distance from a wall up to which a ceiling holds by itself.
const FROM_WALL_MM: f32 = 1.0;

/// Distance from the rim of a head up to which it holds a ceiling: half of the longest bridge.
const FROM_HEAD_MM: f32 = BRIDGE_MM / 2.0;

/// The longest bridge that holds by itself.
pub(super) const BRIDGE_MM: f32 = 5.0;

/// Overhang of a head beyond its pillar.
const HEAD_MM: f32 = 2.0;

/// Least diameter of a pillar.
const DIAMETER_MM: f32 = 1.0;

/// Ratio of a pillar's height to its diameter up to which it stands by itself while it grows.
const SLENDER: f32 = 20.0;

/// A pillar from the floor of a void to its ceiling.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pillar {
    /// Its top, at the ceiling.
    pub top_mm: Vec3,
    /// Height of the floor on which it stands.
    pub bottom_mm: f32,
    /// Its radius, without its head.
    pub radius_mm: f32,
    /// Overhang of its head, and the head's height.
    pub head_mm: f32,
}

impl Pillar {
    fn new(top_mm: Vec3, bottom_mm: f32) -> Self {
        let height_mm = top_mm.z - bottom_mm;
        Self {
            top_mm,
            bottom_mm,
            radius_mm: DIAMETER_MM.max(height_mm / SLENDER) / 2.0,
            head_mm: HEAD_MM.min(height_mm / 2.0),
        }
    }

    /// Distance from the top's middle up to which it holds the ceiling.
    pub fn reach_mm(&self) -> f32 {
        self.radius_mm + self.head_mm + FROM_HEAD_MM
    }

    /// Takes the pillar out of the void in a slice.
    pub(super) fn leave_standing(&self, lattice: &Lattice, slice: usize, field: &mut [f32]) {
        let z_mm = lattice.node_mm(0, 0, slice).z;
        let slack_mm = 2.0 * lattice.spacing_mm;
        if !(self.bottom_mm - slack_mm..=self.top_mm.z + slack_mm).contains(&z_mm) {
            return;
        }
        let radius_mm = self.radius_mm + (self.head_mm - (self.top_mm.z - z_mm)).max(0.0);
        let middle = (self.top_mm - lattice.origin_mm) / lattice.spacing_mm;
        let reach = radius_mm / lattice.spacing_mm + 2.0;
        let around = |at: f32, count: usize| {
            (at - reach).max(0.0) as usize..((at + reach).max(0.0) as usize + 1).min(count)
        };
        for row in around(-middle.y, lattice.height) {
            for column in around(middle.x, lattice.width) {
                let away = (lattice.node_mm(column, row, slice) - self.top_mm).truncate();
                let field = &mut field[row * lattice.width + column];
                *field = field.min(away.length() - radius_mm);
            }
        }
    }
}

/// Largest ratio of a way by steps to the eight nodes around to a straight one.
const EIGHT_WAYS: f32 = 1.083;

/// Ceilings of a void, slice by slice from the lowest up.
pub(super) struct Ceilings {
    lattice: Lattice,
    slices: usize,
    /// Nodes of the last slice that are not void, with their distances from what holds them: walls, and heads of pillars.
    solid: Vec<bool>,
    held: [Vec<f32>; 2],
    /// Slice of the floor below each node of the void.
    floor: Vec<u32>,
    pub pillars: Vec<Pillar>,
}

impl Ceilings {
    pub fn new(lattice: Lattice) -> Self {
        let nodes = lattice.width * lattice.height;
        Self {
            lattice,
            slices: 0,
            solid: vec![true; nodes],
            held: [vec![0.0; nodes], vec![f32::INFINITY; nodes]],
            floor: vec![0; nodes],
            pillars: Vec::new(),
        }
    }

    /// Adds the next slice: nodes are in the void where the field is positive. No pillar stands where `is_blocked` from its floor to its
    /// ceiling.
    pub fn add(&mut self, field: &[f32], is_blocked: &dyn Fn(&Pillar) -> bool) {
        let solid: Vec<bool> = field.iter().map(|&depth| depth <= 0.0).collect();
        let nodes = 0..solid.len();
        let new: Vec<usize> = nodes.filter(|&it| solid[it] && !self.solid[it]).collect();
        for (node, &is_solid) in solid.iter().enumerate() {
            if !is_solid && self.solid[node] {
                self.floor[node] = self.slices as u32;
                for held in &mut self.held {
                    held[node] = f32::INFINITY;
                }
            }
        }
        if !new.is_empty() {
            self.hold(&new, &solid, is_blocked);
        }
        self.solid = solid;
        self.slices += 1;
    }

    /// Finds what holds new nodes, and adds pillars for those that nothing holds.
    fn hold(&mut self, new: &[usize], solid: &[bool], is_blocked: &dyn Fn(&Pillar) -> bool) {
        let mut is_new = vec![false; solid.len()];
        for &node in new {
            is_new[node] = true;
        }
        // Slopes of 45° and steeper hold by what is below them.
        let inherited = self.held.each_ref().map(|held| {
            let of_node = |&node: &usize| {
                let around = AROUND.iter().filter_map(|&step| self.beside(node, step));
                let around = around.filter(|&it| self.solid[it]);
                (
                    around.map(|it| held[it]).fold(f32::INFINITY, f32::min),
                    node,
                )
            };
            new.iter().map(of_node).collect::<Vec<_>>()
        });
        for (which, from) in inherited.into_iter().enumerate() {
            self.spread(which, &from, &is_new);
        }
        let mut open: Vec<usize> = new.to_vec();
        loop {
            open.retain(|&node| !self.is_held(node, solid, &is_new));
            let Some(&first) = open.first() else {
                break;
            };
            let pillar = self.best(first, &open, is_blocked);
            if let Some(pillar) = pillar {
                self.stand(pillar, new, &is_new);
            }
            if pillar.is_none() || !self.is_held(first, solid, &is_new) {
                // Round a corner, or in the way of a drain hole.
                let own = self.pillar(first);
                if pillar.is_some() && !is_blocked(&own) {
                    self.stand(own, new, &is_new);
                }
                open.remove(0);
            }
        }
    }

    /// Adds a pillar, whose head holds the nodes above it.
    fn stand(&mut self, pillar: Pillar, new: &[usize], is_new: &[bool]) {
        let rim_mm = pillar.radius_mm + pillar.head_mm;
        let is_above = |&&node: &&usize| {
            let away = (self.node_mm(node) - pillar.top_mm).truncate();
            away.length() <= rim_mm
        };
        let above = new.iter().filter(is_above).map(|&node| (0.0, node));
        let above: Vec<(f32, usize)> = above.collect();
        self.spread(1, &above, is_new);
        self.pillars.push(pillar);
    }

    /// The pillar below a new node.
    fn pillar(&self, node: usize) -> Pillar {
        let bottom_mm = self.lattice.node_mm(0, 0, self.floor[node] as usize).z;
        Pillar::new(self.node_mm(node), bottom_mm)
    }

    /// The pillar near an open node that holds it and as many others as possible; of equals the first.
    fn best(
        &self,
        first: usize,
        open: &[usize],
        is_blocked: &dyn Fn(&Pillar) -> bool,
    ) -> Option<Pillar> {
        let at = self.node_mm(first);
        let farthest_mm = DIAMETER_MM + HEAD_MM + FROM_HEAD_MM;
        let near = open.iter().map(|&node| (self.node_mm(node), node));
        let near = near.filter(|it| it.0.distance(at) <= 2.0 * farthest_mm);
        let near: Vec<(Vec3, usize)> = near.collect();
        let mut best: Option<(usize, Pillar)> = None;
        for &(there, node) in &near {
            let pillar = self.pillar(node);
            let reach_mm = pillar.radius_mm + pillar.head_mm + FROM_HEAD_MM / EIGHT_WAYS;
            if there.distance(at) > reach_mm || is_blocked(&pillar) {
                continue;
            }
            let holds = near.iter().filter(|it| it.0.distance(there) <= reach_mm);
            let holds = holds.count();
            if best.is_none_or(|best| holds > best.0) {
                best = Some((holds, pillar));
            }
        }
        best.map(|it| it.1)
    }

    /// A node of the slice that is being added.
    fn node_mm(&self, node: usize) -> Vec3 {
        let width = self.lattice.width;
        self.lattice
            .node_mm(node % width, node / width, self.slices)
    }

    fn beside(&self, node: usize, step: [isize; 2]) -> Option<usize> {
        ways::beside(node, step, [self.lattice.width, self.lattice.height])
    }

    /// Spreads distances from nodes to the new ones that are connected to them.
    fn spread(&mut self, which: usize, from: &[(f32, usize)], is_new: &[bool]) {
        let Lattice {
            width,
            height,
            spacing_mm,
            ..
        } = self.lattice;
        let held = &mut self.held[which];
        ways::spread(held, f32::INFINITY, from, &mut |node, reach| {
            for step in AROUND {
                let there = ways::beside(node, step, [width, height]);
                if let Some(there) = there.filter(|&it| is_new[it]) {
                    reach(there, ways::length(step) * spacing_mm);
                }
            }
        });
    }

    /// Returns true if a new node is near a wall or a head, or on a bridge between two.
    fn is_held(&self, node: usize, solid: &[bool], is_new: &[bool]) -> bool {
        let [from_wall_mm, from_head_mm] = self.held.each_ref().map(|held| held[node]);
        if from_wall_mm <= FROM_WALL_MM || from_head_mm <= FROM_HEAD_MM {
            return true;
        }
        let most = BRIDGE_MM / self.lattice.spacing_mm;
        let steps_to_end = |step: [isize; 2]| {
            let mut there = node;
            for steps in 1..=most as usize {
                there = self.beside(there, step)?;
                let is_end = if is_new[there] {
                    self.held.iter().any(|held| held[there] <= 0.0)
                } else {
                    solid[there]
                };
                if is_end {
                    return Some(steps);
                }
                if !is_new[there] {
                    return None;
                }
            }
            None
        };
        AROUND.iter().any(|&[dx, dy]| {
            let ends = [[dx, dy], [-dx, -dy]].map(steps_to_end);
            let [Some(a), Some(b)] = ends else {
                return false;
            };
            (a + b - 1) as f32 * ways::length([dx, dy]) <= most
        })
    }
}
