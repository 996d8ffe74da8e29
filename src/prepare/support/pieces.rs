//! Pieces of the print below a plane that rises, and the regions in which the plane cuts them.

use std::collections::BTreeMap;

use glam::DVec2;

use super::rays::Rays;
use crate::argsort::argsort;
use crate::union_find;
use crate::ways::AROUND;

/// No stretch.
const NONE: u32 = u32::MAX;

/// Region in which the plane cuts a piece.
#[derive(Default, Clone, Copy)]
pub(super) struct Region {
    rays: i64,
    /// Pairs of a ray of the region and a dark one beside it: across sides, and across corners.
    edges: [i64; 2],
    sum: DVec2,
}

impl Region {
    pub fn area_mm2(&self, pitch_mm: f64) -> f64 {
        self.rays as f64 * pitch_mm * pitch_mm
    }

    /// The perimeter, by Cauchy and Crofton's formula for four directions.
    pub fn perimeter_mm(&self, pitch_mm: f64) -> f64 {
        let [sides, corners] = self.edges.map(|edges| edges as f64);
        let edges = sides + corners * std::f64::consts::FRAC_1_SQRT_2;
        edges * pitch_mm * std::f64::consts::FRAC_PI_8
    }

    pub fn middle(&self) -> DVec2 {
        self.sum / self.rays as f64
    }

    /// Adds a region that this one encloses.
    pub fn fill(&mut self, enclosed: &Self) {
        self.rays += enclosed.rays;
        for (edges, its) in self.edges.iter_mut().zip(enclosed.edges) {
            *edges -= its;
        }
        self.sum += enclosed.sum;
    }

    fn join(&mut self, other: &Self) {
        self.rays += other.rays;
        for (edges, its) in self.edges.iter_mut().zip(other.edges) {
            *edges += its;
        }
        self.sum += other.sum;
    }
}

/// Pieces of the print below a plane. Each move of the plane costs what begins and ends between its two heights.
pub(super) struct Pieces<'a> {
    rays: &'a Rays<'a>,
    parent: Vec<u32>,
    /// By the roots of their pieces.
    regions: BTreeMap<u32, Region>,
    /// The stretch of each ray that the plane cuts.
    cut: Vec<u32>,
    /// Stretches in the order in which they begin and end, and the number of those that have.
    orders: [Vec<usize>; 2],
    passed: [usize; 2],
}

impl<'a> Pieces<'a> {
    /// The plane is below all.
    pub fn new(rays: &'a Rays<'a>) -> Self {
        Self {
            parent: (0..rays.stretches.len() as u32).collect(),
            regions: BTreeMap::new(),
            cut: vec![NONE; rays.ldi.rays()],
            orders: [
                rays.ascending(),
                argsort(rays.stretches.iter().map(|it| f64::from(it.to_mm))),
            ],
            passed: [0; 2],
            rays,
        }
    }

    /// Moves the plane up to a height.
    pub fn rise(&mut self, z_mm: f64) {
        let rays = self.rays;
        while let Some(&here) = self.orders[0].get(self.passed[0]) {
            let it = &rays.stretches[here];
            if f64::from(it.from_mm) >= z_mm {
                break;
            }
            self.passed[0] += 1;
            for there in AROUND.iter().flat_map(|&step| rays.near(it.ray, step)) {
                let begins = rays.stretches[there].from_mm <= it.from_mm;
                if begins && rays.overlap(here, there) {
                    self.unite(here, there);
                }
            }
            if f64::from(it.to_mm) > z_mm {
                self.set_cut(here, true);
            }
        }
        while let Some(&here) = self.orders[1].get(self.passed[1]) {
            let it = &rays.stretches[here];
            if f64::from(it.to_mm) > z_mm {
                break;
            }
            self.passed[1] += 1;
            if self.cut[it.ray] == here as u32 {
                self.set_cut(here, false);
            }
        }
    }

    fn unite(&mut self, a: usize, b: usize) {
        let roots = [a, b].map(|it| self.root(it));
        if roots[0] == roots[1] {
            return;
        }
        let parts = roots.map(|it| self.regions.remove(&it));
        let root = union_find::unite(&mut self.parent, roots[0], roots[1]);
        for part in parts.iter().flatten() {
            self.regions.entry(root).or_default().join(part);
        }
    }

    /// Adds a stretch to the region of its piece, or takes it away.
    fn set_cut(&mut self, here: usize, is_cut: bool) {
        let rays = self.rays;
        let ray = rays.stretches[here].ray;
        let sign = if is_cut { 1 } else { -1 };
        let root = self.root(here);
        let mut own = Region {
            rays: sign,
            edges: [0; 2],
            sum: rays.at(here).truncate() * sign as f64,
        };
        self.cut[ray] = if is_cut { here as u32 } else { NONE };
        for (place, &step) in AROUND.iter().enumerate() {
            let kind = usize::from(place >= 4);
            let beside = rays.beside(ray, step).map_or(NONE, |it| self.cut[it]);
            if beside == NONE {
                own.edges[kind] += sign;
            } else {
                let other = self.root(beside as usize);
                self.regions.entry(other).or_default().edges[kind] -= sign;
            }
        }
        let region = self.regions.entry(root).or_default();
        region.join(&own);
        if region.rays == 0 {
            self.regions.remove(&root);
        }
    }

    /// The root of the piece of a stretch.
    pub fn root(&mut self, stretch: usize) -> u32 {
        union_find::find(&mut self.parent, stretch as u32)
    }

    /// The root of the piece that the plane cuts along a ray.
    fn root_along(&mut self, ray: usize) -> Option<u32> {
        let stretch = self.cut[ray];
        (stretch != NONE).then(|| self.root(stretch as usize))
    }

    /// The regions of other pieces, around the print, that a piece encloses in the plane and that are not connected to the first ray
    /// below it: each with the root of the piece here.
    pub fn enclosed(&mut self, others: &mut Self) -> Vec<(u32, Region)> {
        let outside = others.root_along(0);
        let mut closed = others.regions.clone();
        closed.retain(|&root, _| Some(root) != outside);
        let mut found = Vec::new();
        for ray in 0..self.cut.len() {
            if closed.is_empty() {
                break;
            }
            let beside = self.rays.beside(ray, [1, 0]);
            let here = beside.and_then(|it| self.root_along(it));
            if let (Some(here), Some(other)) = (here, others.root_along(ray)) {
                found.extend(closed.remove(&other).map(|region| (here, region)));
            }
        }
        found
    }

    /// The regions in which the plane cuts, with the roots of their pieces.
    pub fn regions(&self) -> Vec<(u32, Region)> {
        self.regions
            .iter()
            .map(|(&root, &region)| (root, region))
            .collect()
    }
}
