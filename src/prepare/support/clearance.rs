//! Distances of points from the model, and routes by which a support reaches the plate, or else the model, without
//! coming near it.
//!
//! Distances are known on a lattice of nodes, and between nodes by interpolation. Ways go from node to node, straight down or down at 45° along
//! an axis; sweeping the lattice once from the plate up finds the shortest one from every node.

use std::cmp::Ordering;

use glam::{DVec3, Vec3};

use crate::ldi::LdiError;
use crate::parallel;
use crate::prepare::columns::{Columns, MARGIN, To};
use crate::prepare::surface_nets::Lattice;
use crate::progress::{Progress, report};

/// Columns from one node to the next.
pub(super) const STRIDE: usize = 2;

/// Length of a step straight down, and of one at 45°.
const DOWN: u16 = 10;
const SLANTED: u16 = 14;

/// No way.
const NONE: u16 = u16::MAX;

/// Cost of a pillar that stands on the model, where it leaves a mark, as a length of pillar. A branch to another pillar
/// is preferred if it is shorter.
const ON_MODEL_MM: f32 = 30.0;

/// Least clearance of a point above a floor, as a fraction of its height, for a pillar to stand on that floor. Steep
/// floors fail this.
const FLAT: f32 = 0.7;

/// Steps from a node: its neighbours in the slice below.
const STEPS: [([isize; 2], u16); 5] = [
    ([0, 0], DOWN),
    ([1, 0], SLANTED),
    ([-1, 0], SLANTED),
    ([0, 1], SLANTED),
    ([0, -1], SLANTED),
];

/// Distances from the model, and ways around it.
pub(super) struct Clearance {
    columns: Columns,
    lattice: Lattice,
    slices: usize,
    /// The distance of each node in parts of `most_mm`, 255 if it is that or more. Nodes within the model have 0.
    parts: Vec<u8>,
    most_mm: f32,
    /// The lengths of the ways from each node.
    ways: Vec<u16>,
    need_mm: f32,
}

/// End of a route.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum End {
    Plate,
    /// On the model.
    Model,
}

impl Clearance {
    /// Distances up to `most_mm` from a solid above the plate, up to a height.
    pub fn new(
        columns: Columns,
        corner_mm: Vec3,
        top_mm: f32,
        most_mm: f32,
        progress: &mut Progress<'_>,
    ) -> Result<Self, LdiError> {
        let margin_mm = MARGIN as f32 * columns.pitch_mm;
        let spacing_mm = STRIDE as f32 * columns.pitch_mm;
        let lattice = Lattice {
            width: columns.width.div_ceil(STRIDE),
            height: columns.height.div_ceil(STRIDE),
            spacing_mm,
            origin_mm: corner_mm + Vec3::new(-margin_mm, margin_mm, 0.0),
        };
        let slices = ((top_mm - corner_mm.z) / spacing_mm) as usize + 2;
        let mut parts = Vec::with_capacity(slices * lattice.width * lattice.height);
        let group = 8 * parallel::threads();
        for from in (0..slices).step_by(group) {
            report(progress, from as f64 / slices as f64)?;
            let these = from..(from + group).min(slices);
            let heights_mm: Vec<f32> = these.map(|it| lattice.node_mm(0, 0, it).z).collect();
            for slice in columns.distances_mm(To::Solid, &heights_mm, most_mm, STRIDE) {
                let slice = slice.into_iter();
                // Rounded down.
                parts.extend(slice.map(|mm| (mm / most_mm * 255.0).min(255.0) as u8));
            }
        }
        Ok(Self {
            columns,
            lattice,
            slices,
            parts,
            most_mm,
            ways: Vec::new(),
            need_mm: 0.0,
        })
    }

    /// Bytes of each node.
    pub const NODE_BYTES: f64 = 3.0;

    /// Finds the ways for pillars that need this distance from the model to their middle.
    pub fn find_ways(&mut self, need_mm: f32) {
        self.need_mm = need_mm;
        let area = self.lattice.width * self.lattice.height;
        let mut ways = vec![NONE; area * self.slices];
        let on_model = (ON_MODEL_MM / self.lattice.spacing_mm) as u16 * DOWN;
        let (width, height) = (self.lattice.width as isize, self.lattice.height as isize);
        for slice in 0..self.slices {
            let (below, here) = ways.split_at_mut(slice * area);
            let below = &below[slice.saturating_sub(1) * area..];
            for row in 0..height {
                for column in 0..width {
                    let node = (row * width + column) as usize;
                    if self.node_mm(slice * area + node) < need_mm {
                        continue;
                    }
                    here[node] = if slice == 0 {
                        0
                    } else {
                        let lengths = STEPS.iter().filter_map(|&([dx, dy], length)| {
                            let (x, y) = (column + dx, row + dy);
                            let is_within = (0..width).contains(&x) && (0..height).contains(&y);
                            let way = is_within.then(|| below[(y * width + x) as usize])?;
                            (way != NONE).then(|| way.saturating_add(length).min(NONE - 1))
                        });
                        lengths.min().unwrap_or_else(|| {
                            let floor = self.floor_below([column as usize, row as usize], slice);
                            floor.map_or(NONE, |_| on_model)
                        })
                    };
                }
            }
        }
        self.ways = ways;
    }

    /// The floor that a pillar can stand on below a node, if it is near and flat.
    fn floor_below(&self, [column, row]: [usize; 2], slice: usize) -> Option<f32> {
        let at = self.lattice.node_mm(column, row, slice);
        let floor_mm = self
            .columns
            .floor_mm(row * STRIDE * self.columns.width + column * STRIDE, at.z)?;
        let height_mm = at.z - floor_mm;
        let area = self.lattice.width * self.lattice.height;
        let distance_mm = self.node_mm(slice * area + row * self.lattice.width + column);
        let is_near = height_mm <= (self.need_mm + self.lattice.spacing_mm) / FLAT;
        (is_near && distance_mm >= FLAT * height_mm.min(self.most_mm)).then_some(floor_mm)
    }

    fn node_mm(&self, node: usize) -> f32 {
        f32::from(self.parts[node]) * (self.most_mm / 255.0)
    }

    /// The lowest and the highest of the floors below a point, along the four columns around it; that of the plate has no height.
    pub fn floors_mm(&self, at: DVec3) -> [Option<f32>; 2] {
        let nodes = self.nodes(at) * STRIDE as f32;
        let (width, height) = (self.columns.width, self.columns.height);
        let around = |place: f32, count: usize| {
            let place = (place.max(0.0) as usize).min(count - 2);
            [place, place + 1]
        };
        let [rows, columns] = [around(nodes.y, height), around(nodes.x, width)];
        let floors = rows.into_iter().flat_map(|row| {
            let floor = |column| self.columns.floor_mm(row * width + column, at.z as f32);
            columns.map(floor)
        });
        // None, the plate, is below all others.
        let floors: Vec<Option<f32>> = floors.collect();
        let is_below = |a: Option<f32>, b: Option<f32>| a.partial_cmp(&b) == Some(Ordering::Less);
        let [lowest, highest] = [false, true].map(|wants_highest| {
            let floors = floors.iter().copied();
            floors.reduce(|a, b| {
                if is_below(a, b) == wants_highest {
                    b
                } else {
                    a
                }
            })
        });
        [lowest.flatten(), highest.flatten()]
    }

    /// A point in nodes: columns, rows and slices.
    fn nodes(&self, at: DVec3) -> Vec3 {
        let from = (at.as_vec3() - self.lattice.origin_mm) / self.lattice.spacing_mm;
        Vec3::new(from.x, -from.y, from.z)
    }

    /// The distance of a point from the model, at most the largest that is known, found by interpolation.
    pub fn distance_mm(&self, at: DVec3) -> f32 {
        let (width, height) = (self.lattice.width, self.lattice.height);
        let cell = |place: f32, count: usize| {
            let place = place.clamp(0.0, (count - 1) as f32);
            let first = (place as usize).min(count.saturating_sub(2));
            (first, (first + 1).min(count - 1), place - first as f32)
        };
        let nodes = self.nodes(at);
        let (x, next_x, part_x) = cell(nodes.x, width);
        let (y, next_y, part_y) = cell(nodes.y, height);
        let (z, next_z, part_z) = cell(nodes.z, self.slices);
        let node = |x: usize, y: usize, z: usize| self.node_mm((z * height + y) * width + x);
        let mix = |a: f32, b: f32, part: f32| a + (b - a) * part;
        let row = |y: usize, z: usize| mix(node(x, y, z), node(next_x, y, z), part_x);
        let slice = |z: usize| mix(row(y, z), row(next_y, z), part_y);
        mix(slice(z), slice(next_z), part_z)
    }

    /// Returns true if a point is where supports may be.
    pub fn is_within(&self, at: DVec3) -> bool {
        let nodes = self.nodes(at);
        let last = [self.lattice.width, self.lattice.height].map(|count| (count - 1) as f32);
        (0.0..=last[0]).contains(&nodes.x) && (0.0..=last[1]).contains(&nodes.y)
    }

    /// Returns true if all of a straight way is so far from the model.
    pub fn is_clear(&self, from: DVec3, to: DVec3, need_mm: f32) -> bool {
        let step_mm = f64::from(self.columns.pitch_mm);
        let steps = (from.distance(to) / step_mm) as usize + 1;
        (0..=steps).all(|step| {
            let at = from + (to - from) * (step as f64 / steps as f64);
            self.distance_mm(at) >= need_mm
        })
    }

    /// Length of the shortest way from a point, and the node at which it begins.
    pub fn way(&self, from: DVec3) -> Option<(f64, usize)> {
        let nodes = self.nodes(from);
        let spacing_mm = f64::from(self.lattice.spacing_mm);
        let area = self.lattice.width * self.lattice.height;
        let slice = (nodes.z - 1.0).max(0.0).min((self.slices - 1) as f32) as usize;
        let first = [nodes.x.max(0.0) as usize, nodes.y.max(0.0) as usize];
        let around = [[0, 0], [1, 0], [0, 1], [1, 1]];
        let around = around.map(|[x, y]| [first[0] + x, first[1] + y]);
        let ways = around.into_iter().filter_map(|[x, y]| {
            let is_within = x < self.lattice.width && y < self.lattice.height;
            let node = is_within.then_some(slice * area + y * self.lattice.width + x)?;
            let to = self.lattice.node_mm(x, y, slice).as_dvec3();
            let is_clear = self.ways[node] != NONE
                && is_steep(from, to)
                && self.is_clear(from, to, self.need_mm);
            is_clear.then(|| {
                let length = f64::from(self.ways[node]) / f64::from(DOWN);
                (length * spacing_mm + from.distance(to), node)
            })
        });
        ways.reduce(|best, way| if way.0 < best.0 { way } else { best })
    }

    /// The points of the way from a node, which is the first, with as few bends as there can be, and where it ends.
    pub fn points(&self, mut node: usize) -> (Vec<DVec3>, End) {
        let (width, height) = (self.lattice.width, self.lattice.height);
        let area = width * height;
        let place = |node: usize| [node % width, node % area / width, node / area];
        let at = |node: usize| {
            let [x, y, slice] = place(node);
            self.lattice.node_mm(x, y, slice).as_dvec3()
        };
        let mut points = vec![at(node)];
        let end = loop {
            let [x, y, slice] = place(node);
            if slice == 0 {
                break End::Plate;
            }
            let next = STEPS.iter().find_map(|&([dx, dy], length)| {
                let (x, y) = (x.checked_add_signed(dx)?, y.checked_add_signed(dy)?);
                let next =
                    (x < width && y < height).then(|| node - area + y * width + x - node % area)?;
                let is_next = self.ways[next] != NONE
                    && self.ways[next].saturating_add(length).min(NONE - 1) == self.ways[node];
                is_next.then_some(next)
            });
            let Some(next) = next else {
                if let Some(floor_mm) = self.floor_below([x, y], slice) {
                    points.push(DVec3::new(at(node).x, at(node).y, f64::from(floor_mm)));
                }
                break End::Model;
            };
            node = next;
            points.push(at(node));
        };
        (self.straightened(&points, end), end)
    }

    /// Leaves out points between which the way can be straight.
    fn straightened(&self, points: &[DVec3], end: End) -> Vec<DVec3> {
        // A foot on the model stands upright.
        let last = points.len()
            - if end == End::Model && points.len() > 1 {
                2
            } else {
                1
            };
        let mut kept = vec![points[0]];
        let mut here = 0;
        while here < last {
            let from = points[here];
            let reaches = |&next: &usize| {
                let to = points[next];
                is_steep(from, to) && self.is_clear(from, to, self.need_mm)
            };
            // If a point is reachable, nearly always all points before it are too.
            let mut next = here + 1;
            let mut step = 1;
            while step > 0 {
                let further = next + step;
                if further <= last && reaches(&further) {
                    next = further;
                    step *= 2;
                } else {
                    step /= 2;
                }
            }
            kept.push(points[next]);
            here = next;
        }
        kept.extend(&points[last + 1..]);
        kept
    }
}

/// Returns true if a way rises by at least as much as it runs, except for rounding.
pub(super) fn is_steep(from: DVec3, to: DVec3) -> bool {
    let (x, y, z) = (from.x - to.x, from.y - to.y, from.z - to.z);
    z > 0.0 && x * x + y * y <= z * z * 1.0001
}
