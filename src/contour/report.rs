//! Statistics of contours.

use serde::Serialize;

use super::{Contours, Lattice, Polygon, shown};

/// A plan's contours in figures.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct ContoursReport {
    /// Tolerance within which points were left out; 0 if none were.
    pub simplify_mm: f64,
    /// Coordinates are multiples of this.
    pub step_mm: f64,
    /// Number of layers.
    pub layers: usize,
    /// Number of polygons in all layers.
    pub polygons: usize,
    /// Number of holes in all polygons.
    pub holes: usize,
    /// Number of points of all outlines.
    pub points: usize,
    /// Volume of the layers: the area of each section times its layer's thickness.
    pub volume_mm3: f64,
    /// Each layer, from the plate upward.
    pub sections: Vec<SectionReport>,
}

/// The section of a layer in figures.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct SectionReport {
    /// Bottom of the layer.
    pub bottom_mm: f64,
    /// Top of the layer.
    pub top_mm: f64,
    /// Height of the section: the middle of the layer.
    pub section_mm: f64,
    /// Number of polygons.
    pub polygons: usize,
    /// Number of holes in all polygons.
    pub holes: usize,
    /// Number of points of all outlines.
    pub points: usize,
    /// Area without holes.
    pub area_mm2: f64,
    /// Length of all outlines, those of holes included.
    pub perimeter_mm: f64,
}

impl ContoursReport {
    /// A report of no layers yet.
    pub fn new(lattice: Lattice, simplify_mm: f64) -> Self {
        Self {
            simplify_mm,
            step_mm: lattice.step_mm(),
            layers: 0,
            polygons: 0,
            holes: 0,
            points: 0,
            volume_mm3: 0.0,
            sections: Vec::new(),
        }
    }

    /// Adds the next layer.
    pub fn add(&mut self, contours: &Contours) {
        let heights = contours.heights;
        let rings = || contours.polygons.iter().flat_map(Polygon::rings);
        let area: f64 = rings().map(super::Ring::area).sum();
        let section = SectionReport {
            bottom_mm: shown(heights.bottom_mm),
            top_mm: shown(heights.top_mm),
            section_mm: shown(heights.section_mm),
            polygons: contours.polygons.len(),
            holes: rings().count() - contours.polygons.len(),
            points: rings().map(|ring| ring.points.len()).sum(),
            area_mm2: area * self.step_mm * self.step_mm,
            perimeter_mm: rings().map(super::Ring::length).sum::<f64>() * self.step_mm,
        };
        self.layers += 1;
        self.polygons += section.polygons;
        self.holes += section.holes;
        self.points += section.points;
        self.volume_mm3 += section.area_mm2 * (heights.top_mm - heights.bottom_mm);
        self.sections.push(section);
    }
}
