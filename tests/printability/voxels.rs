//! The checks of printability by brute force: every layer's whole past is flooded again, and every distance is measured.

use std::collections::BTreeMap;

use cusp_slicer::grid::Grid;
use cusp_slicer::inspect::{Code, Limits};
use cusp_slicer::mask::Masks;
use cusp_slicer::plan::Plan;

/// A finding in whole numbers: its code, first and last layer, pixels times bins, the pixels of its largest layer, and the layer
/// that joins it.
pub type Found = (Code, [usize; 2], u64, u64, Option<usize>);

type Plane = Vec<bool>;

/// Dark pixels on each side: more than any limit.
const PAD: usize = 8;

/// Pixels of all layers, true if lit.
pub struct Voxels {
    grid: Grid,
    width: usize,
    height: usize,
    layers: Vec<Plane>,
    bins: Vec<u64>,
    bin_mm: f64,
}

/// Labels of voxels, layer by layer; 0 is none.
type Labels = Vec<Vec<usize>>;

impl Voxels {
    pub fn new(masks: &Masks, plan: &Plan) -> Self {
        let grid = masks.grid;
        let (width, height) = (grid.width as usize, grid.height as usize);
        let mut cursor = masks.cursor();
        let (wide, high) = (width + 2 * PAD, height + 2 * PAD);
        let layers = (0..masks.layers()).map(|layer| {
            cursor.seek(masks, layer);
            let bits = cursor.whole(masks);
            let row_bytes = width.div_ceil(8);
            let mut plane = vec![false; wide * high];
            for at in 0..width * height {
                let (x, y) = (at % width, at / width);
                let is_lit = bits[y * row_bytes + x / 8] << (x % 8) & 0x80 != 0;
                plane[(y + PAD) * wide + x + PAD] = is_lit;
            }
            plane
        });
        Self {
            layers: layers.collect(),
            bins: plan
                .boundaries
                .windows(2)
                .map(|it| u64::from(it[1] - it[0]))
                .collect(),
            bin_mm: plan.bins.size_mm,
            grid,
            width: wide,
            height: high,
        }
    }

    pub fn layers(&self) -> usize {
        self.layers.len()
    }

    fn beside(&self, at: usize) -> impl Iterator<Item = usize> {
        let (x, y) = (at % self.width, at / self.width);
        let left = (x > 0).then(|| at - 1);
        let right = (x + 1 < self.width).then(|| at + 1);
        let above = (y > 0).then(|| at - self.width);
        let below = (y + 1 < self.height).then(|| at + self.width);
        [left, right, above, below].into_iter().flatten()
    }

    /// The components of voxels, six-connected.
    fn flood(&self, planes: &[Plane]) -> Labels {
        let mut labels: Labels = planes.iter().map(|plane| vec![0; plane.len()]).collect();
        let mut count = 0;
        for layer in 0..planes.len() {
            for at in 0..planes[layer].len() {
                if !planes[layer][at] || labels[layer][at] != 0 {
                    continue;
                }
                count += 1;
                labels[layer][at] = count;
                let mut waiting = vec![(layer, at)];
                while let Some((layer, at)) = waiting.pop() {
                    let above = (layer + 1 < planes.len()).then(|| (layer + 1, at));
                    let below = (layer > 0).then(|| (layer - 1, at));
                    let beside = self.beside(at).map(|at| (layer, at));
                    for (layer, at) in beside.chain(above).chain(below) {
                        if planes[layer][at] && labels[layer][at] == 0 {
                            labels[layer][at] = count;
                            waiting.push((layer, at));
                        }
                    }
                }
            }
        }
        labels
    }

    /// Pixels times bins of each label.
    fn volumes(&self, labels: &Labels) -> BTreeMap<usize, u64> {
        let mut volumes = BTreeMap::new();
        for (plane, &bins) in labels.iter().zip(&self.bins) {
            for &label in plane.iter().filter(|&&label| label != 0) {
                *volumes.entry(label).or_insert(0) += bins;
            }
        }
        volumes
    }

    /// Islands, loose and separate bodies, and specks.
    pub fn bodies(&self, limits: &Limits) -> Vec<Found> {
        // Components that begin, in the order of age: layer, more pixels first, then place.
        let mut births: Vec<(usize, i64, usize)> = Vec::new();
        for (layer, plane) in self.layers.iter().enumerate() {
            let labels = &self.flood(std::slice::from_ref(plane))[0];
            let most = labels.iter().max().copied().unwrap_or(0);
            for label in 1..=most {
                let of_label = || (0..labels.len()).filter(|&at| labels[at] == label);
                if layer == 0 || !of_label().any(|at| self.layers[layer - 1][at]) {
                    births.push((
                        layer,
                        -(of_label().count() as i64),
                        of_label().next().unwrap(),
                    ));
                }
            }
        }
        births.sort_unstable();
        let mut found = Vec::new();
        let mut main: Option<Found> = None;
        let mut alive = vec![true; births.len()];
        let mut largest = vec![0u64; births.len()];
        let mut last = vec![0; births.len()];
        let mut volume = vec![0u64; births.len()];
        for layer in 0..=self.layers() {
            let top = layer == self.layers();
            let labels = self.flood(&self.layers[..(layer + 1).min(self.layers())]);
            let volumes = self.volumes(&labels);
            let mut eldest: BTreeMap<usize, usize> = BTreeMap::new();
            for (age, &(first, _, at)) in births.iter().enumerate() {
                if first > layer || !alive[age] {
                    continue;
                }
                let elder = *eldest.entry(labels[first][at]).or_insert(age);
                if elder != age {
                    alive[age] = false;
                    if first > 0 {
                        let layers = [first, last[age]];
                        found.push((Code::Island, layers, volume[age], largest[age], Some(layer)));
                    }
                }
            }
            for (&label, &age) in &eldest {
                if top {
                    let layers = [births[age].0, last[age]];
                    let is_speck =
                        largest[age] < u64::from(limits.speck_px) || layers[0] == layers[1];
                    let code = match births[age].0 {
                        0 => Code::SeparateBody,
                        _ if is_speck => Code::Speck,
                        _ => Code::LooseBody,
                    };
                    let body = (code, layers, volumes[&label], largest[age], None);
                    match main {
                        _ if code != Code::SeparateBody => found.push(body),
                        Some(other) if other.2 >= body.2 => found.push(body),
                        _ => found.extend(main.replace(body)),
                    }
                    continue;
                }
                let here = labels[layer].iter().filter(|&&it| it == label).count() as u64;
                largest[age] = largest[age].max(here);
                volume[age] = volumes[&label];
                if here > 0 {
                    last[age] = layer;
                }
            }
        }
        found
    }

    /// Cups and traps.
    pub fn hollows(&self) -> Vec<Found> {
        let mut found = Vec::new();
        // The hollows up to the last layer: a voxel of each, and its measures.
        let mut before: Vec<((usize, usize), Found)> = Vec::new();
        for layer in 0..=self.layers() {
            let planes = &self.layers[..(layer + 1).min(self.layers())];
            let mut dark: Vec<Plane> = planes
                .iter()
                .map(|plane| plane.iter().map(|lit| !lit).collect())
                .collect();
            if layer == self.layers() {
                dark.push(vec![true; self.width * self.height]);
            }
            let labels = self.flood(&dark);
            // The outside goes around the grid.
            let is_open = self.leads_out(&labels, &[]);
            let mut now: BTreeMap<usize, ((usize, usize), Found)> = BTreeMap::new();
            let volumes = self.volumes(&labels);
            for (place, old) in before.drain(..) {
                let label = labels[place.0][place.1];
                let (_, layers, volume, area, _) = old;
                if is_open[label] {
                    found.push((Code::Cup, layers, volume, area, None));
                } else if !labels[layer].contains(&label) {
                    found.push((Code::Trap, layers, volume, area, None));
                } else {
                    let entry = now.entry(label).or_insert((place, old));
                    entry.1.1[0] = entry.1.1[0].min(layers[0]);
                    entry.1.3 = entry.1.3.max(area);
                }
            }
            for (at, &label) in labels[layer].iter().enumerate() {
                if label != 0 && !is_open[label] {
                    let area = labels[layer].iter().filter(|&&it| it == label).count() as u64;
                    let fresh = (Code::Cup, [layer; 2], 0, area, None);
                    let entry = now.entry(label).or_insert(((layer, at), fresh));
                    entry.1.3 = entry.1.3.max(area);
                    entry.1.2 = volumes[&label];
                    entry.1.1[1] = layer;
                }
            }
            before = now.into_values().collect();
        }
        found
    }

    fn distance_mm(&self, a: usize, b: usize) -> f64 {
        let x = (a % self.width).abs_diff(b % self.width) as f64 * self.grid.pitch_mm;
        let y = (a / self.width).abs_diff(b / self.width) as f64 * self.grid.pitch_y_mm;
        (x * x + y * y).sqrt()
    }

    /// The pixels that are farther than `limit_mm` from all of the others.
    fn beyond(&self, pixels: &[bool], others: &[bool], limit_mm: f64) -> Plane {
        let limit_mm = limit_mm * (1.0 + 1e-9);
        let columns = (limit_mm / self.grid.pitch_mm) as usize + 1;
        let rows = (limit_mm / self.grid.pitch_y_mm) as usize + 1;
        let near = |at: usize| {
            let (x, y) = (at % self.width, at / self.width);
            let ys = y.saturating_sub(rows)..(y + rows + 1).min(self.height);
            let xs = x.saturating_sub(columns)..(x + columns + 1).min(self.width);
            ys.into_iter().any(|y| {
                xs.clone().any(|x| {
                    let it = y * self.width + x;
                    others[it] && self.distance_mm(at, it) <= limit_mm
                })
            })
        };
        let is_beyond = |at: usize| pixels[at] && !near(at);
        (0..pixels.len()).map(is_beyond).collect()
    }

    /// The unsupported pixels of a layer out of reach of its supported ones, straight or along lit pixels.
    fn out_of_reach(&self, unsupported: &Plane, supported: &Plane, reach_mm: f64) -> Plane {
        let far = self.beyond(unsupported, supported, reach_mm);
        let mut left = unsupported.clone();
        let step_mm = f64::max(0.1, 2.0 * self.pitch_mm());
        for _ in 0..(reach_mm / step_mm).ceil() as usize {
            let is_reached = |at: usize| supported[at] || (unsupported[at] && !left[at]);
            let reached: Plane = (0..left.len()).map(is_reached).collect();
            left = self.beyond(&left, &reached, 1.12 * step_mm);
        }
        (0..far.len()).map(|at| far[at] || left[at]).collect()
    }

    /// Regions of these pixels.
    fn regions(&self, code: Code, planes: &[Plane], least_px: u32, least_mm: f64) -> Vec<Found> {
        let mut found = Vec::new();
        let labels = self.flood(planes);
        for (label, volume) in self.volumes(&labels) {
            let here = |plane: &Vec<usize>| plane.iter().filter(|&&it| it == label).count() as u64;
            let pixels: Vec<u64> = labels.iter().map(here).collect();
            let first = pixels.iter().position(|&it| it > 0).unwrap();
            let last = pixels.iter().rposition(|&it| it > 0).unwrap();
            let bins: u64 = self.bins[first..=last].iter().sum();
            let largest = *pixels.iter().max().unwrap();
            let is_high = bins as f64 * self.bin_mm >= least_mm * (1.0 - 1e-9);
            if largest >= u64::from(least_px) && is_high {
                found.push((code, [first, last], volume, 0, None));
            }
        }
        found
    }

    fn is_near_middle(&self, at: usize) -> bool {
        let (x, y) = (at % self.width, at / self.width);
        (PAD..self.width - PAD).contains(&x) && (PAD..self.height - PAD).contains(&y)
    }

    fn pitch_mm(&self) -> f64 {
        self.grid.pitch_mm.max(self.grid.pitch_y_mm)
    }

    pub fn overhangs(&self, limits: &Limits) -> Vec<Found> {
        let mut supported = self.layers[0].clone();
        let mut planes = vec![vec![false; supported.len()]];
        for layer in 1..self.layers() {
            let lit = &self.layers[layer];
            let labels = &self.flood(std::slice::from_ref(lit))[0];
            let mut touches = vec![false; labels.iter().max().unwrap() + 1];
            for at in 0..lit.len() {
                touches[labels[at]] |= self.layers[layer - 1][at];
            }
            let run_mm = self.bins[layer] as f64 * self.bin_mm / limits.self_supporting_slope;
            let width_mm = (run_mm + self.pitch_mm() / 2.0).max(self.pitch_mm());
            let asking: Plane = (0..lit.len())
                .map(|at| lit[at] && touches[labels[at]])
                .collect();
            let unsupported = self.beyond(&asking, &supported, width_mm);
            supported = (0..lit.len())
                .map(|at| lit[at] && !unsupported[at])
                .collect();
            let found = self.out_of_reach(&unsupported, &supported, limits.overhang_mm);
            let bridge = |at| self.is_bridged(at, &unsupported, &supported, limits.bridge_mm);
            let held: Plane = (0..lit.len()).map(|at| found[at] && bridge(at)).collect();
            for at in 0..lit.len() {
                supported[at] |= held[at];
            }
            let rest: Plane = (0..lit.len())
                .map(|at| unsupported[at] && !held[at])
                .collect();
            planes.push(self.out_of_reach(&rest, &supported, limits.overhang_mm));
        }
        self.regions(Code::Overhang, &planes, limits.speck_px, 0.0)
    }

    /// Returns true if a line through a pixel leads over unsupported ones to a supported one on both sides.
    fn is_bridged(&self, at: usize, over: &Plane, to: &Plane, longest_mm: f64) -> bool {
        let (x, y) = ((at % self.width) as i32, (at / self.width) as i32);
        // From a pixel to the nearest that is not unsupported, in steps; none if that is not supported.
        let steps = |right: i32, down: i32| {
            (1..).find_map(|step| {
                let place = [x + right * step, y + down * step];
                let [x, y] = place.map(|it| usize::try_from(it).ok());
                let inside = |it: Option<usize>, size| it.filter(|&it| it < size);
                match (inside(x, self.width), inside(y, self.height)) {
                    (Some(x), Some(y)) if over[y * self.width + x] => None,
                    (Some(x), Some(y)) if to[y * self.width + x] => Some(Some(step)),
                    _ => Some(None),
                }
            })
        };
        let mut lines = (-2_i32..=2).flat_map(|right| (0..=2).map(move |down| (right, down)));
        lines.any(|(right, down)| {
            let is_line = matches!(
                [right.abs().min(down), right.abs().max(down)],
                [0 | 1, 1] | [1, 2]
            );
            if !is_line {
                return false;
            }
            let (one, other) = (steps(right, down), steps(-right, -down));
            let (Some(Some(one)), Some(Some(other))) = (one, other) else {
                return false;
            };
            let step_mm = (f64::from(right) * self.grid.pitch_mm)
                .hypot(f64::from(down) * self.grid.pitch_y_mm);
            f64::from(one + other - 1) * step_mm <= longest_mm * (1.0 + 1e-9)
        })
    }

    /// Thin walls of lit pixels, or thin gaps between them, in a margin of dark pixels that is wide enough.
    fn thin(&self, code: Code, limit_mm: f64, least_px: u32) -> Vec<Found> {
        let is_gap = code == Code::NarrowGap;
        let radius_mm = ((limit_mm - self.pitch_mm()) / 2.0).max(0.0);
        let planes: Vec<Plane> = self
            .layers
            .iter()
            .map(|lit| {
                let solid: Plane = lit.iter().map(|&lit| lit != is_gap).collect();
                let other: Plane = lit.iter().map(|&lit| lit == is_gap).collect();
                let centres = self.beyond(&solid, &other, radius_mm);
                let mut thin = self.beyond(&solid, &centres, limit_mm);
                // Pixels that no gap reaches.
                for (at, thin) in thin.iter_mut().enumerate() {
                    *thin &= self.is_near_middle(at);
                }
                thin
            })
            .collect();
        self.regions(code, &planes, least_px, limit_mm)
    }

    pub fn thin_walls(&self, limits: &Limits) -> Vec<Found> {
        self.thin(Code::ThinWall, limits.wall_mm, limits.speck_px)
    }

    pub fn narrow_gaps(&self, limits: &Limits) -> Vec<Found> {
        self.thin(Code::NarrowGap, limits.gap_mm, limits.speck_px)
    }

    fn dark(&self) -> Vec<Plane> {
        let dark_of = |plane: &Plane| plane.iter().map(|lit| !lit).collect();
        self.layers.iter().map(dark_of).collect()
    }

    pub fn small_holes(&self, limits: &Limits) -> Vec<Found> {
        let planes: Vec<Plane> = self
            .dark()
            .into_iter()
            .map(|dark| {
                let labels = &self.flood(&[dark])[0];
                let mut small = vec![false; labels.len()];
                for label in 1..=labels.iter().max().copied().unwrap_or(0) {
                    let hole = || (0..labels.len()).filter(|&at| labels[at] == label);
                    let is_open = hole().any(|at| self.beside(at).count() < 4);
                    let columns: Vec<usize> = hole().map(|at| at % self.width).collect();
                    let rows: Vec<usize> = hole().map(|at| at / self.width).collect();
                    let size_mm = |places: &[usize], pitch_mm: f64| {
                        let size = places.iter().max().unwrap() - places.iter().min().unwrap() + 1;
                        (size + 1) as f64 * pitch_mm
                    };
                    let most_mm = limits.hole_mm * (1.0 - 1e-9);
                    let is_small = size_mm(&columns, self.grid.pitch_mm) < most_mm
                        && size_mm(&rows, self.grid.pitch_y_mm) < most_mm;
                    if !is_open && is_small {
                        hole().for_each(|at| small[at] = true);
                    }
                }
                small
            })
            .collect();
        self.regions(Code::SmallHole, &planes, limits.speck_px, limits.hole_mm)
    }

    /// For each label, true if a way from it leads around the grid or through one of these layers.
    fn leads_out(&self, labels: &Labels, through: &[usize]) -> Vec<bool> {
        let mut is_out = vec![false; labels.iter().flatten().max().unwrap_or(&0) + 1];
        for (layer, plane) in labels.iter().enumerate() {
            for (at, &label) in plane.iter().enumerate() {
                is_out[label] |= through.contains(&layer) || self.beside(at).count() < 4;
            }
        }
        is_out
    }

    pub fn narrow_drains(&self, limits: &Limits) -> Vec<Found> {
        let radius_mm = (limits.drain_mm - self.pitch_mm()) / 2.0;
        if radius_mm < self.grid.pitch_mm.min(self.grid.pitch_y_mm) {
            return Vec::new();
        }
        let dark = self.dark();
        let last = self.layers() - 1;
        let hollows = self.flood(&dark);
        let drains = self.leads_out(&hollows, &[last]);
        let roomy: Vec<Plane> = dark
            .iter()
            .zip(&self.layers)
            .map(|(dark, lit)| self.beyond(dark, lit, radius_mm))
            .collect();
        let rooms = self.flood(&roomy);
        let is_out = self.leads_out(&rooms, &[0, last]);
        let mut found = Vec::new();
        for (room, volume) in self.volumes(&rooms) {
            let places = |layer: usize| rooms[layer].iter().position(|&it| it == room);
            let layers: Vec<usize> = (0..=last).filter(|&it| places(it).is_some()).collect();
            let (low, high) = (layers[0], layers[layers.len() - 1]);
            let hollow = hollows[low][places(low).unwrap()];
            if !is_out[room] && drains[hollow] {
                found.push((Code::NarrowDrain, [low, high], volume, 0, None));
            }
        }
        found
    }

    /// Thin floors, or low gaps.
    fn short(&self, code: Code, limit_mm: f64, least_px: u32) -> Vec<Found> {
        let is_gap = code == Code::LowGap;
        let is_solid = |layer: usize, at: usize| self.layers[layer][at] != is_gap;
        let mut short = vec![vec![false; self.width * self.height]; self.layers()];
        let pixels = self.width * self.height;
        for at in 0..pixels {
            let mut layer = 0;
            while layer < self.layers() {
                if !is_solid(layer, at) {
                    layer += 1;
                    continue;
                }
                let first = layer;
                while layer < self.layers() && is_solid(layer, at) {
                    layer += 1;
                }
                let bins: u64 = self.bins[first..layer].iter().sum();
                let is_between = first > 0 && layer < self.layers();
                let is_short = (bins as f64) * self.bin_mm * (1.0 + 1e-9) < limit_mm;
                if is_short && (!is_gap || is_between) {
                    for plane in &mut short[first..layer] {
                        plane[at] = true;
                    }
                }
            }
        }
        let planes: Vec<Plane> = short
            .iter()
            .enumerate()
            .map(|(layer, short)| {
                let longer: Plane = (0..short.len())
                    .map(|at| is_solid(layer, at) && !short[at])
                    .collect();
                self.beyond(short, &longer, limit_mm)
            })
            .collect();
        self.regions(code, &planes, least_px, 0.0)
    }

    pub fn thin_floors(&self, limits: &Limits) -> Vec<Found> {
        self.short(Code::ThinFloor, limits.floor_mm, limits.speck_px)
    }

    pub fn low_gaps(&self, limits: &Limits) -> Vec<Found> {
        self.short(Code::LowGap, limits.low_gap_mm, limits.speck_px)
    }
}
