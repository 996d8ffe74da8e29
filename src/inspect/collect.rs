//! Findings as they are collected: in millimetres, with their severity, and no more than a list can show.

use std::cmp::Reverse;

use glam::DVec2;

use super::components::Patch;
use super::finding::{Code, Finding};
use super::forest::Tree;
use super::limits::{Limits, Severity};
use super::rows::Area;
use crate::argsort::sort_by_number;
use crate::grid::Grid;
use crate::plan::Plan;

/// Number of findings of a kind that are listed: the largest ones.
pub(super) const LISTED: usize = 100;

/// Turns pixels and layers into millimetres.
pub(super) struct Frame<'a> {
    pub grid: &'a Grid,
    pub area: Area,
    /// Boundaries of the layers in bins.
    pub boundaries: &'a [u32],
    /// Heights of these boundaries.
    pub z_mm: Vec<f64>,
    bin_mm: f64,
}

impl<'a> Frame<'a> {
    pub fn new(grid: &'a Grid, area: Area, plan: &'a Plan) -> Self {
        Self {
            grid,
            area,
            boundaries: &plan.boundaries,
            z_mm: plan.z_mm(),
            bin_mm: plan.bins.size_mm,
        }
    }

    pub fn layers(&self) -> usize {
        self.boundaries.len() - 1
    }

    /// Thickness of a layer in bins.
    pub fn bins(&self, layer: usize) -> u64 {
        u64::from(self.boundaries[layer + 1] - self.boundaries[layer])
    }

    pub fn thickness_mm(&self, layer: usize) -> f64 {
        self.bins(layer) as f64 * self.bin_mm
    }

    /// From the bottom of a layer to a boundary.
    pub fn height_mm(&self, layer: usize, boundary: usize) -> f64 {
        let bins = self.boundaries[boundary].saturating_sub(self.boundaries[layer]);
        f64::from(bins) * self.bin_mm
    }

    pub fn area_mm2(&self, pixels: u64) -> f64 {
        pixels as f64 * self.grid.pixel_mm2()
    }

    /// The volume of a number of pixels times bins.
    pub fn volume_mm3(&self, volume: u64) -> f64 {
        volume as f64 * self.grid.pixel_mm2() * self.bin_mm
    }

    /// Column and row of a point, counted in the area.
    pub fn pixel(&self, x_mm: f64, y_mm: f64) -> [i32; 2] {
        let pixel = self.grid.to_pixels(DVec2::new(x_mm, y_mm)).floor();
        let Area {
            first_column,
            first_row,
            ..
        } = self.area;
        [pixel.x as i32 - first_column, pixel.y as i32 - first_row]
    }

    /// x at twice a column's left edge, counted in the area.
    fn x_mm(&self, twice: i32) -> f64 {
        let columns = f64::from(self.area.first_column) + f64::from(twice) / 2.0;
        self.grid.corner_mm.x + columns * self.grid.pitch_mm
    }

    /// y at twice a row's upper edge, counted in the area.
    fn y_mm(&self, twice: i32) -> f64 {
        let rows = f64::from(self.area.first_row) + f64::from(twice) / 2.0;
        self.grid.corner_mm.y - rows * self.grid.pitch_y_mm
    }

    /// The middle of a patch in a layer: a place on it.
    pub fn middle_mm(&self, patch: &Patch, layer: usize) -> [f64; 3] {
        let (row, twice_column) = patch.middle();
        let z_mm = f64::midpoint(self.z_mm[layer], self.z_mm[layer + 1]);
        [self.x_mm(twice_column + 1), self.y_mm(2 * row + 1), z_mm]
    }

    pub fn bounds_mm(&self, patch: &Patch, layers: [usize; 2]) -> [[f64; 3]; 2] {
        let [left, right] = patch.columns;
        let [top, bottom] = patch.rows;
        let low = [
            self.x_mm(2 * left),
            self.y_mm(2 * bottom + 2),
            self.z_mm[layers[0]],
        ];
        let high = [
            self.x_mm(2 * right + 2),
            self.y_mm(2 * top),
            self.z_mm[layers[1] + 1],
        ];
        [low, high]
    }

    /// A finding with the extent of a tree.
    pub fn finding(&self, code: Code, tree: &Tree) -> Finding {
        let layers = [tree.first, tree.last];
        Finding {
            code,
            severity: Severity::Review,
            at_mm: self.middle_mm(&tree.largest, tree.largest_layer),
            bounds_mm: self.bounds_mm(&tree.around, layers),
            layers,
            area_mm2: self.area_mm2(tree.largest.pixels),
            volume_mm3: self.volume_mm3(tree.volume),
            joins_layer: None,
            limit: 0.0,
        }
    }
}

/// The findings so far.
pub(super) struct Collector<'a> {
    limits: &'a Limits,
    kinds: Vec<Kind>,
}

/// The findings of a kind.
#[derive(Clone, Default)]
struct Kind {
    found: usize,
    largest: Vec<Finding>,
}

impl<'a> Collector<'a> {
    pub fn new(limits: &'a Limits) -> Self {
        Self {
            limits,
            kinds: vec![Kind::default(); Code::ALL.len()],
        }
    }

    /// Adds a finding, unless its kind is ignored.
    pub fn add(&mut self, finding: Finding) {
        if !self.limits.looks_for(finding.code) {
            return;
        }
        let severity = self.limits.severity_of(&finding);
        let kind = &mut self.kinds[finding.code as usize];
        kind.found += 1;
        kind.largest.push(Finding {
            severity,
            ..finding
        });
        if kind.largest.len() >= 2 * LISTED {
            kind.shorten();
        }
    }

    /// The findings by kind, from the most severe and the largest down, and how many of each kind there are.
    pub fn finish(mut self) -> (Vec<Finding>, Vec<(Code, usize)>) {
        let mut findings = Vec::new();
        let mut counts = Vec::new();
        for (kind, code) in self.kinds.iter_mut().zip(Code::ALL) {
            if kind.found > 0 {
                kind.shorten();
                findings.append(&mut kind.largest);
                counts.push((code, kind.found));
            }
        }
        (findings, counts)
    }
}

impl Kind {
    fn shorten(&mut self) {
        sort_by_number(&mut self.largest, |finding| -finding.weight());
        self.largest
            .sort_by_key(|finding| Reverse(finding.severity));
        self.largest.truncate(LISTED);
    }
}
