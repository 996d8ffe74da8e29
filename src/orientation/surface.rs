//! The surface of a model, prepared for measuring many directions: what does not depend on the direction is computed once.

use glam::{DVec3, Vec3};

use super::basins::{Along, Basins, Found};
use super::directions::{about_z, lattice, unit, upright};
use super::extents::Points;
use super::supports::Estimate;
use super::{Exclusion, Metrics};
use crate::argsort::argsort;
use crate::grid::Bins;
use crate::model::{Bounds, Mesh, rotation_matrix};
use crate::plan::Plan;
use crate::prepare::SupportProfile;
use crate::profile::facet_bins::FacetBins;
use crate::profile::normal_cones::Cone;
use crate::profile::roughness;

/// Maximum number of flats whose normals are added to the directions.
const FLATS: usize = 16;

/// Minimum area of such a flat, as a fraction of the surface.
const FLAT_PART: f64 = 0.02;

/// Cosine of the angle within which facets belong to one flat, 0.26°.
const SAME_FLAT: f64 = 1.0 - 1e-5;

/// Cosine of the angle within which a flat is perpendicular to an axis: only the rounding of single precision is allowed.
const AXIS: f64 = 1.0 - 1e-12;

/// Number of flats that are distinguished, from the largest facet down.
const TOLD_APART: usize = 64;

/// −`n_z` above which a facet needs support: it faces down at less than 45° from level.
const OVERHANG: f32 = std::f32::consts::FRAC_1_SQRT_2;

/// Sums that are made side by side, as each sum of a single chain would wait for the one before.
const LANES: usize = 4;

/// Facets that are examined together.
const BLOCK: usize = 16 * LANES;

/// Bytes per facet that a search takes on one thread: in the mesh, the surface, and the current placement.
const FACET_BYTES: usize = 148;

/// Bytes per vertex that a search takes on one thread.
const VERTEX_BYTES: usize = 165;

/// Peak memory of an orientation search on one thread, in bytes. tests/memory.rs measures it.
pub(crate) fn search_bytes(mesh: &Mesh) -> usize {
    FACET_BYTES * mesh.surface_facets + VERTEX_BYTES * mesh.vertices.len()
}

/// The surface of a model, at the scale at which it is printed.
#[derive(Debug)]
pub(crate) struct Surface {
    /// For each facet, its index in the mesh. Neighbouring facets are close together, so that their data is in the cache.
    order: Vec<usize>,
    /// The vertices of the surface.
    vertices: Points,
    /// Unit normals of facets, one list per axis.
    normals: [Vec<f32>; 3],
    areas_mm2: Vec<f32>,
    total_mm2: f64,
    /// Has the facets, by the numbers of `vertices_mm`.
    basins: Basins,
}

/// A model in one orientation.
#[derive(Debug)]
pub(crate) struct Placement {
    /// A quaternion x, y, z, w.
    pub rotation: [f64; 4],
    /// The direction that points up from the plate, in the frame of the file.
    up: DVec3,
    /// `n_z` of the unit normal of each facet.
    n_z: Vec<f32>,
    pub size_mm: [f64; 3],
    /// Height of each vertex above the plate, as in a mesh in this pose.
    heights_mm: Vec<f32>,
}

impl Surface {
    /// The surface of `mesh`, scaled by `scale`.
    pub fn new(mesh: &Mesh, scale: f64) -> Self {
        let order = neighbours_together(mesh);
        let mut number_of = vec![u32::MAX; mesh.vertices.len()];
        let mut vertices_mm: [Vec<f64>; 3] = Default::default();
        let caps = mesh.surface_facets..mesh.classes.model_end() as usize;
        let facets: Vec<[u32; 3]> = order
            .iter()
            .copied()
            .chain(caps)
            .map(|facet| {
                mesh.facets[facet].map(|vertex| {
                    let number = &mut number_of[vertex as usize];
                    if *number == u32::MAX {
                        *number = vertices_mm[0].len() as u32;
                        let vertex = mesh.vertices[vertex as usize].as_dvec3() * scale;
                        for (list, coordinate) in vertices_mm.iter_mut().zip(vertex.to_array()) {
                            list.push(coordinate);
                        }
                    }
                    *number
                })
            })
            .collect();
        let [x, y, z] = &vertices_mm;
        let vertices = x.iter().zip(y).zip(z);
        let vertices = vertices.map(|((&x, &y), &z)| DVec3::new(x, y, z)).collect();
        let basins = Basins::new(vertices, facets);
        let mut normals: [Vec<f32>; 3] = Default::default();
        let mut areas_mm2 = Vec::with_capacity(order.len());
        for &facet in &order {
            let [a, b, c] = mesh.corners(facet);
            let normal = (b - a).cross(c - a);
            let length = normal.length();
            areas_mm2.push((length * scale * scale / 2.0) as f32);
            // A facet so small that its normal underflows counts as vertical, as in a mesh.
            let normal = if length > 0.0 {
                normal / length
            } else {
                DVec3::X
            };
            for (list, coordinate) in normals.iter_mut().zip(normal.to_array()) {
                list.push(coordinate as f32);
            }
        }
        Self {
            order,
            vertices: Points::new(vertices_mm),
            normals,
            total_mm2: areas_mm2.iter().copied().map(f64::from).sum(),
            areas_mm2,
            basins,
        }
    }

    /// Rearranges one value per facet of the mesh into the order of facets here.
    pub fn arranged(&self, values: &[f32]) -> Vec<f32> {
        let order = self.order.iter();
        order.map(|&facet| values[facet]).collect()
    }

    /// Renumbers the facets of cones of the mesh to those here.
    pub fn renumber(&self, cones: &mut [Cone]) {
        let mut place_of = vec![0; self.order.len()];
        for (place, &facet) in self.order.iter().enumerate() {
            place_of[facet] = place as u32;
        }
        for cone in cones {
            cone.facet = place_of[cone.facet as usize];
        }
    }

    /// `count` directions spread evenly, followed by the axes of the file, along which models are usually designed, and the
    /// normals of the largest flats, each in both senses.
    pub fn directions(&self, count: usize) -> Vec<[f64; 3]> {
        let mut directions = lattice(count);
        for axis in DVec3::AXES.into_iter().chain(self.flats()) {
            directions.extend([axis, -axis]);
        }
        directions.into_iter().map(|it| it.to_array()).collect()
    }

    fn normal(&self, facet: usize) -> DVec3 {
        let [x, y, z] = &self.normals;
        unit(Vec3::new(x[facet], y[facet], z[facet]).as_dvec3())
    }

    /// Normals of the largest flats that are not perpendicular to an axis, largest first. Parallel flats count as one.
    fn flats(&self) -> Vec<DVec3> {
        let mut flats: Vec<(DVec3, f64)> = Vec::new();
        for facet in argsort(self.areas_mm2.iter().map(|&area_mm2| f64::from(-area_mm2))) {
            let (normal, area_mm2) = (self.normal(facet), f64::from(self.areas_mm2[facet]));
            let is_same = |(flat, _): &(DVec3, f64)| flat.dot(normal).abs() >= SAME_FLAT;
            match flats.iter().position(is_same) {
                Some(same) => flats[same].1 += area_mm2,
                None if flats.len() < TOLD_APART => flats.push((normal, area_mm2)),
                None => {}
            }
        }
        let is_axis = |normal: DVec3| normal.abs().max_element() >= AXIS;
        flats.retain(|&(normal, area_mm2)| {
            area_mm2 >= FLAT_PART * self.total_mm2 && !is_axis(normal)
        });
        let largest = argsort(flats.iter().map(|(_, area_mm2)| -area_mm2)).into_iter();
        largest.take(FLATS).map(|flat| flats[flat].0).collect()
    }

    /// Places the model on the plate with `direction` up, at the first rotation about z at which its bounding box `fits`. If
    /// it fits at none, also returns why.
    pub fn place(
        &self,
        direction: [f64; 3],
        fits: impl Fn(&Bounds) -> Result<(), Exclusion>,
    ) -> (Placement, Option<Exclusion>) {
        let upright = upright(DVec3::from_array(direction));
        let mut first = None;
        for turn in about_z() {
            let rotation = (turn * upright).to_array();
            let (placement, bounds) = self.turned(rotation);
            match fits(&bounds) {
                Ok(()) => return (placement, None),
                Err(Exclusion::TooLarge) => {
                    first.get_or_insert(placement);
                }
                Err(other) => return (placement, Some(other)),
            }
        }
        let placement = first.unwrap_or_else(|| self.turned(upright.to_array()).0);
        (placement, Some(Exclusion::TooLarge))
    }

    fn turned(&self, rotation: [f64; 4]) -> (Placement, Bounds) {
        // No quaternion of this module is 0, so there is always a matrix.
        let matrix = rotation_matrix(rotation).unwrap_or_default();
        let [x, y, z] = [0, 1, 2].map(|axis| self.vertices.extent_along(matrix.row(axis)));
        let min = DVec3::new(x[0], y[0], z[0]);
        let max = DVec3::new(x[1], y[1], z[1]);
        let heights = self.vertices.along(matrix.row(2), 0..self.vertices.count());
        let heights_mm = heights.map(|z| (z - min.z) as f32).collect();
        let size = max - min;
        let round = |length_mm: f64| (length_mm * 1e6).round() / 1e6;
        let placement = Placement {
            rotation,
            up: matrix.row(2),
            n_z: self.n_z(matrix.row(2).as_vec3()),
            size_mm: [
                round(size.x),
                round(size.y),
                round(f64::from(size.z as f32)),
            ],
            heights_mm,
        };
        (placement, Bounds { min, max })
    }

    /// `n_z` of the unit normals of facets.
    fn n_z(&self, up: Vec3) -> Vec<f32> {
        let [x, y, z] = &self.normals;
        x.iter()
            .zip(y)
            .zip(z)
            .map(|((x, y), z)| x * up.x + y * up.y + z * up.z)
            .collect()
    }

    /// The facet bins of the surface in a placement.
    pub fn facet_bins(&self, placement: &Placement, bins: Bins) -> FacetBins {
        let square = |facet: usize| {
            let square = placement.n_z[facet] * placement.n_z[facet];
            // Rounding may exceed 1 slightly.
            if square > 1.0 { 1.0 } else { square }
        };
        let area = |facet: usize| f64::from(self.areas_mm2[facet]);
        let facets = &self.basins.facets()[..self.order.len()];
        let faces_down = |facet: usize| placement.n_z[facet] < 0.0;
        FacetBins::new(
            bins,
            facets,
            &placement.heights_mm,
            square,
            area,
            faces_down,
        )
    }

    /// The metrics of a plan in a placement, with supports of this profile. Weights are in the order of facets here.
    pub fn metrics(
        &self,
        placement: &Placement,
        facet_bins: &FacetBins,
        weights: Option<&[f32]>,
        profile: &SupportProfile,
        plan: &Plan,
        [max_error, print_time_s]: [f64; 2],
    ) -> Metrics {
        // For each bin, the thickness in bins of the layer that it belongs to, as running sums. The top of a plan may be
        // slightly below or above that of the model.
        let mut sums = Vec::with_capacity(facet_bins.bins.count + 1);
        let mut sum = 0.0;
        for pair in plan.boundaries.windows(2) {
            let thickness = f64::from(pair[1] - pair[0]);
            sums.extend((0..pair[1] - pair[0]).map(|bin| sum + f64::from(bin) * thickness));
            sum += thickness * thickness;
        }
        sums.resize(facet_bins.bins.count + 1, sum);
        let plate = plan.boundaries[1];
        let bin_mm = facet_bins.bins.size_mm;
        // Heights at which masks are sampled.
        let middles_mm: Vec<f32> = plan
            .boundaries
            .windows(2)
            .map(|pair| f64::midpoint(f64::from(pair[0]), f64::from(pair[1])))
            .map(|bins| (bins * bin_mm) as f32)
            .collect();
        let low = facet_bins.bins.of(f64::from(middles_mm[0])) as u32;
        // The facets that reach down to the first of them.
        let mut lowest = Vec::new();
        let (mut overhang_mm2, mut roughness) = (0.0, [0.0; LANES]);
        let mut supports = Estimate::new(profile);
        let facing_down = supports.least_n_z().max(-OVERHANG);
        // Block by block, as most have no facet that faces down or reaches that low, and the work on all facets is a
        // short loop of its own.
        let blocks = facet_bins
            .spans
            .chunks(BLOCK)
            .zip(facet_bins.n_z_squared.chunks(BLOCK));
        let blocks = blocks
            .zip(placement.n_z.chunks(BLOCK))
            .zip(self.areas_mm2.chunks(BLOCK));
        for (block, (((spans, squares), n_z), areas_mm2)) in blocks.enumerate() {
            add_roughness(&mut roughness, &sums, spans, squares, areas_mm2);
            let first_facet = block * BLOCK;
            for &place in which(n_z, |&n_z| n_z < facing_down).iter() {
                let place = usize::from(place);
                let (n_z, area_mm2) = (n_z[place], f64::from(areas_mm2[place]));
                let [first, last] = spans[place];
                let is_above_plate = last >= plate;
                if n_z < -OVERHANG && is_above_plate {
                    overhang_mm2 += area_mm2;
                }
                if supports.counts(n_z, is_above_plate) {
                    let middle_mm = f64::from((first + last) as i32 + 1) / 2.0 * bin_mm;
                    let weight =
                        weights.map_or(1.0, |weights| f64::from(weights[first_facet + place]));
                    supports.add(f64::from(n_z), area_mm2, middle_mm, weight);
                }
            }
            for &place in which(spans, |[first, _]| *first <= low).iter() {
                lowest.push((first_facet + usize::from(place)) as u32);
            }
        }
        lowest.extend(facet_bins.spans.len() as u32..self.basins.facets().len() as u32);
        let along = Along {
            up: placement.up,
            height_mm: placement.size_mm[2] as f32,
            heights_mm: &placement.heights_mm,
            middles_mm: &middles_mm,
        };
        let Found { islands, cups_mm2 } = self.basins.find(&along, &lowest);
        let [support_ml, contact_mm2] = supports.of_islands(islands);
        Metrics {
            layers: plan.layers(),
            print_time_s,
            max_error,
            roughness_mm: total(roughness) / self.total_mm2 * facet_bins.bins.size_mm,
            overhang_mm2,
            islands,
            cups_mm2,
            support_ml,
            contact_mm2,
        }
    }
}

/// Places in a block, in ascending order.
struct Places {
    places: [u8; BLOCK],
    count: usize,
}

impl Places {
    fn iter(&self) -> std::slice::Iter<'_, u8> {
        self.places[..self.count].iter()
    }
}

/// The places of a block at which something is so.
#[inline]
fn which<T>(block: &[T], is_so: impl Fn(&T) -> bool) -> Places {
    let mut found = Places {
        places: [0; BLOCK],
        count: 0,
    };
    // In most blocks there are none, and a loop that only looks for any is vectorised.
    if block.iter().fold(false, |any, it| any | is_so(it)) {
        for (place, it) in (0..).zip(block) {
            // No branch, which would be unpredictable.
            found.places[found.count % BLOCK] = place;
            found.count += usize::from(is_so(it));
        }
    }
    found
}

/// Adds the area of each facet of a block times its roughness, for layers whose thicknesses have these running sums.
fn add_roughness(
    lanes: &mut [f64; LANES],
    sums: &[f64],
    spans: &[[u32; 2]],
    squares: &[f32],
    areas_mm2: &[f32],
) {
    // Loops one after the other, so that the compiler can vectorise all but the first. Lanes beyond the last facet add
    // nothing.
    let mut thicknesses = [0.0; BLOCK];
    for (thickness, &[first, last]) in thicknesses.iter_mut().zip(spans) {
        *thickness = sums[last as usize + 1] - sums[first as usize];
    }
    for (thickness, &[first, last]) in thicknesses.iter_mut().zip(spans) {
        *thickness /= f64::from((last - first + 1) as i32);
    }
    for (thickness, &area_mm2) in thicknesses.iter_mut().zip(areas_mm2) {
        *thickness *= f64::from(area_mm2);
    }
    for (thickness, &square) in thicknesses.iter_mut().zip(squares) {
        *thickness *= f64::from(roughness::density_of(square));
    }
    let (groups, _) = thicknesses.as_chunks::<LANES>();
    for group in groups {
        for (lane, product) in lanes.iter_mut().zip(group) {
            *lane += product;
        }
    }
}

fn total([a, b, c, d]: [f64; LANES]) -> f64 {
    (a + b) + (c + d)
}

/// Indices of the surface facets of a mesh along a space-filling curve (Morton order).
fn neighbours_together(mesh: &Mesh) -> Vec<usize> {
    let bounds = mesh.bounds();
    let cells = 1023.0 / bounds.size().max_element();
    // Moves the ten bits of a number three places apart.
    let spread = |number: f64| {
        let number = number as u32;
        (0..10).fold(0, |all, bit| all | (number >> bit & 1) << (3 * bit))
    };
    let keys = (0..mesh.surface_facets).map(|facet| {
        let [a, b, c] = mesh.corners(facet);
        let cell = ((a + b + c) / 3.0 - bounds.min) * cells;
        f64::from(spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2)
    });
    argsort(keys)
}
