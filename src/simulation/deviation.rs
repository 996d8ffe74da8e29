//! Distances from one surface to the other: the greatest and the mean, in all and by layer.

use glam::DVec3;
use serde::Serialize;

/// Distances from the points of one surface to the nearest points of the other.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct Deviation {
    /// The greatest distance, in millimetres.
    pub max_mm: f64,
    /// The point that is that far from the other surface: x, y and z, with the model on the plate and centred on x = y
    /// = 0.
    pub at_mm: [f64; 3],
    /// The mean over the surface, by area, in millimetres.
    pub mean_mm: f64,
    /// The same by layer, from the plate upward.
    pub layers: Vec<LayerDeviation>,
}

/// The distances of points of one layer. Values are absent if the layer has no points for them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct LayerDeviation {
    /// Top of the layer, in millimetres above the plate.
    pub z_mm: f64,
    /// The greatest distance, in millimetres.
    pub max_mm: Option<f64>,
    /// The mean by area, in millimetres.
    pub mean_mm: Option<f64>,
}

/// Distances of a layer so far.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tally {
    /// Square of the greatest distance; negative if there is none yet.
    pub squared: f64,
    /// The point at that distance.
    pub at: DVec3,
    /// Sum of the distances of samples, each times its area.
    sum: f64,
    /// Sum of those areas.
    area: f64,
}

impl Default for Tally {
    fn default() -> Self {
        Self {
            squared: -1.0,
            at: DVec3::ZERO,
            sum: 0.0,
            area: 0.0,
        }
    }
}

impl Tally {
    /// Counts a point for the maximum.
    pub fn raise(&mut self, squared: f64, at: DVec3) {
        if squared > self.squared {
            (self.squared, self.at) = (squared, at);
        }
    }

    /// Counts a point for the mean, as a sample of this area.
    pub fn average(&mut self, squared: f64, area: f64) {
        self.sum += squared.sqrt() * area;
        self.area += area;
    }

    /// The maximum alone.
    pub fn without_mean(&self) -> Self {
        Self {
            squared: self.squared,
            at: self.at,
            ..Self::default()
        }
    }

    /// Adds what another tally of the same layer has found. Of equal maxima the first stays.
    pub fn merge(&mut self, other: &Self) {
        self.raise(other.squared, other.at);
        self.sum += other.sum;
        self.area += other.area;
    }
}

impl Deviation {
    /// The tallies of all layers, whose boundaries are at `z_mm`.
    pub(super) fn of(tallies: &[Tally], z_mm: &[f64]) -> Self {
        let mut all = Tally::default();
        for tally in tallies {
            all.merge(tally);
        }
        let max_mm = |tally: &Tally| (tally.squared >= 0.0).then(|| tally.squared.sqrt());
        let mean_mm = |tally: &Tally| (tally.area > 0.0).then(|| tally.sum / tally.area);
        Self {
            max_mm: max_mm(&all).unwrap_or(0.0),
            at_mm: all.at.to_array(),
            mean_mm: mean_mm(&all).unwrap_or(0.0),
            layers: tallies
                .iter()
                .zip(&z_mm[1..])
                .map(|(tally, &z_mm)| LayerDeviation {
                    z_mm,
                    max_mm: max_mm(tally),
                    mean_mm: mean_mm(tally),
                })
                .collect(),
        }
    }
}
