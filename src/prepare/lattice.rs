//! Struts along the four space diagonals of a cubic lattice.
//!
//! They rise by 35° from level, so they support themselves in every pose that turns the model about z.

use glam::Vec3;

use super::hollow::Infill;

/// The space diagonals, up to sign.
const DIAGONALS: [Vec3; 4] = [
    Vec3::new(1.0, 1.0, 1.0),
    Vec3::new(-1.0, 1.0, 1.0),
    Vec3::new(1.0, -1.0, 1.0),
    Vec3::new(1.0, 1.0, -1.0),
];

/// Struts through all nodes of a lattice, one of which is at the origin.
pub(super) struct Lattice {
    spacing_mm: f32,
    radius_mm: f32,
}

impl Lattice {
    pub fn new(infill: &Infill) -> Self {
        Self {
            spacing_mm: infill.spacing_mm as f32,
            radius_mm: infill.strut_mm as f32 / 2.0,
        }
    }

    /// The distance from the nearest strut; negative inside it.
    pub fn distance_mm(&self, at_mm: Vec3) -> f32 {
        // Within the cell around the nearest node, from -0.5 to 0.5.
        let at = at_mm / self.spacing_mm;
        let at = at - (at + 0.5).floor();
        let mut least = f32::INFINITY;
        for diagonal in DIAGONALS {
            // Lines through this node and its neighbours: a line that passes the cell passes one of these.
            for node in NODES {
                let from = at - node;
                let along = from.dot(diagonal) / 3.0;
                let away = from - diagonal * along;
                least = least.min(away.length_squared());
            }
        }
        least.sqrt() * self.spacing_mm - self.radius_mm
    }
}

/// The node of a cell, and those across its sides.
const NODES: [Vec3; 7] = [
    Vec3::ZERO,
    Vec3::X,
    Vec3::NEG_X,
    Vec3::Y,
    Vec3::NEG_Y,
    Vec3::Z,
    Vec3::NEG_Z,
];
