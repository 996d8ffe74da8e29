//! A triangle mesh in millimetres, and the defects found while it was built.

use std::sync::Arc;

use glam::{DVec2, DVec3, Vec3};
use rustc_hash::{FxHashMap, FxHashSet};
use serde::Serialize;

use super::bodies;
use super::class::{FacetClass, FacetClasses};
use super::curved_cap::Bent;
use super::edges::{Neighbours, edges};
use super::facing::facing;
use super::holes;
use super::own_supports;
use super::pose::{Pose, rotation_matrix};
use super::weld::weld;

/// Error of making a printable mesh from triangles.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum MeshError {
    /// Every facet is degenerate.
    #[error("none of the {facets} facets has an area; export the model again")]
    #[serde(rename = "mesh-no-area")]
    NoArea {
        /// Facets in the input.
        facets: usize,
    },
    /// The mesh lies in a horizontal plane.
    #[error(
        "the model has no height: all its facets lie in one horizontal plane; turn it, or export it again"
    )]
    #[serde(rename = "mesh-zero-height")]
    ZeroHeight,
    /// The requested height is not a positive number.
    #[error("the height must be greater than 0, not {height_mm} mm")]
    #[serde(rename = "bad-height")]
    BadHeight {
        /// The requested height.
        height_mm: f64,
    },
    /// The rotation is not a quaternion of a finite length greater than 0.
    #[error("the rotation must be a quaternion x, y, z, w whose length is not zero")]
    #[serde(rename = "bad-rotation")]
    BadRotation,
    /// The model measures more than a kilometre, with which sums of areas and volumes would overflow.
    #[error(
        "the model is too large: at this height it measures more than a kilometre; choose another unit or height"
    )]
    #[serde(rename = "mesh-overflow")]
    Overflow,
}

/// The axis-aligned box around a mesh, in millimetres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Bounds {
    /// Smallest x, y and z.
    pub min: DVec3,
    /// Largest x, y and z.
    pub max: DVec3,
}

impl Bounds {
    /// Extent along x, y and z, in millimetres.
    pub fn size(&self) -> DVec3 {
        self.max - self.min
    }
}

/// Facets over shared vertices. Corners are counter-clockwise as seen from outside.
///
/// All facets together are always closed: every edge is used equally often in both directions.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    /// Distinct positions in millimetres.
    pub vertices: Vec<Vec3>,
    /// Three vertex indices per facet, sorted by class. Within the surface, `surface_facets` facets with an area come
    /// first, then slivers without area that join them.
    pub facets: Vec<[u32; 3]>,
    /// Number of facets of the surface, all with an area that is more than rounding.
    pub surface_facets: usize,
    /// Classes of the facets.
    pub classes: FacetClasses,
    /// For each facet of the surface, slivers included, the facets across its edges; caps do not count.
    pub neighbours: Arc<Neighbours>,
    /// Facets of the input that had no area, or no more than rounding.
    pub degenerate_facets: usize,
    /// Edges of the input that were not used equally often in both directions; 0 for a closed,
    /// consistently oriented mesh.
    pub open_edges: usize,
    /// Number of holes, that is, loops of open edges, that were closed.
    pub holes: usize,
    /// True if the input was inside out as a whole, so that all facets were turned over.
    pub was_inside_out: bool,
    /// Facets of the surface that were turned over, unless all were.
    pub turned_facets: usize,
    /// Number of bodies: facets that hang together by their corners.
    pub bodies: usize,
    /// Edges whose adjacent facets cannot all face the same way, as on a Möbius strip, or where three facets meet.
    pub contradictory_edges: usize,
    /// The first of the vertices that are centroids of fans, if there are any.
    centroids_from: u32,
    /// The vertices, from one to another, that are the tips of supports in the file. No facet has them.
    tips: [u32; 2],
    /// Distance of the largest body from the lowest point, as the file has them.
    pub(super) largest_above: f64,
}

/// The most that a model may measure in x, y or z.
const MAX_SIDE_MM: f64 = 1e6;

impl Mesh {
    /// Welds equal corners, separates facets without area, closes holes, and turns over whatever is inside out: the
    /// mesh as a whole, or bodies that are no cavities.
    ///
    /// Corners are welded if their coordinates are equal numbers (-0 equals 0). A hole is closed by a fan
    /// around the centroid of its loop.
    ///
    /// # Errors
    /// [`MeshError::NoArea`] if no facet has an area.
    pub fn from_triangles(triangles: &[[Vec3; 3]]) -> Result<Self, MeshError> {
        Self::with_caps(triangles, false)
    }

    /// The same, with all holes closed where the generalised winding number is one half if `all_curved`, and not only wide bent ones.
    ///
    /// # Errors
    /// As [`Self::from_triangles`].
    pub fn with_caps(triangles: &[[Vec3; 3]], all_curved: bool) -> Result<Self, MeshError> {
        let (mut vertices, welded) = weld(triangles);
        let rounding = rounding(&vertices);
        let (mut facets, flat): (Vec<_>, Vec<_>) = welded
            .into_iter()
            .partition(|corners| has_area(corners.map(|v| vertices[v as usize]), rounding));
        let surface_facets = facets.len();
        if surface_facets == 0 {
            return Err(MeshError::NoArea {
                facets: triangles.len(),
            });
        }
        keep_joining_slivers(&mut facets, flat, vertices.len());
        let first_cap = facets.len();
        let mut found = edges(vertices.len(), &facets);
        // Empty while none is turned over.
        let mut turned = Vec::new();
        let mut contradictory_edges = found.odd;
        let near = NEAR_ROUNDINGS * rounding;
        if let Some(facing) = facing(&vertices, &facets, &found, near) {
            contradictory_edges += facing.contradictions;
            turned = facing.turned;
            turn(&mut facets, &turned);
            found = edges(vertices.len(), &facets);
        }
        let loops = holes::loops(&found.open);
        let side = sides(&vertices).max_element();
        let mut flat = Vec::new();
        for hole in &loops {
            match Bent::of(hole, &vertices) {
                Some(bent) if all_curved || bent.is_wide(side) => {
                    bent.cap(hole, &mut vertices, &mut facets);
                }
                _ => flat.push(hole),
            }
        }
        let centroids_from = vertices.len() as u32;
        for hole in flat {
            holes::cap(hole, &mut vertices, &mut facets);
        }
        let mut mesh = Self {
            vertices,
            classes: FacetClasses::of_model(first_cap, facets.len()),
            facets,
            neighbours: Arc::new(found.neighbours),
            surface_facets,
            degenerate_facets: triangles.len() - surface_facets,
            open_edges: found.open.len(),
            holes: loops.len(),
            was_inside_out: false,
            turned_facets: 0,
            bodies: 0,
            contradictory_edges,
            centroids_from,
            tips: [0; 2],
            largest_above: 0.0,
        };
        let mut turn_over = |mesh: &mut Self, wrong: &[bool]| {
            turn(&mut mesh.facets, wrong);
            mesh.neighbours = Arc::new(mesh.neighbours.turned(wrong));
            turned.resize(first_cap, false);
            for (turned, wrong) in turned.iter_mut().zip(wrong) {
                *turned ^= wrong;
            }
        };
        if mesh.volume_mm3() < 0.0 {
            let all = vec![true; mesh.facets.len()];
            turn_over(&mut mesh, &all);
        }
        let found = bodies::find(&mesh);
        (mesh.bodies, mesh.largest_above) = (found.count, found.largest_above);
        if let Some(wrong) = found.wrong {
            turn_over(&mut mesh, &wrong);
        }
        let surface = turned.iter().take(surface_facets);
        let turned = surface.filter(|&&it| it).count();
        mesh.was_inside_out = turned == surface_facets;
        mesh.turned_facets = if mesh.was_inside_out { 0 } else { turned };
        Ok(mesh)
    }

    /// The mesh less the bodies of these triangles, which become voids.
    ///
    /// # Errors
    /// [`MeshError::NoArea`] if there are triangles, and none has an area.
    pub fn without(mut self, negative: &[[Vec3; 3]]) -> Result<Self, MeshError> {
        if !negative.is_empty() {
            let bodies = Self::from_triangles(negative)?;
            self.add(&bodies.vertices, &bodies.facets, FacetClass::Void);
        }
        Ok(self)
    }

    /// The mesh of `triangles` with its supports in a class of their own, if some of its bodies are supports.
    ///
    /// # Errors
    /// As [`Self::from_triangles`].
    pub fn with_own_supports(
        self,
        triangles: &[[Vec3; 3]],
        all_curved: bool,
    ) -> Result<Self, MeshError> {
        let Some(found) = own_supports::find(&self) else {
            return Ok(self);
        };
        let key = |corner: Vec3| (corner + Vec3::ZERO).to_array().map(f32::to_bits);
        let theirs = self.facets.iter().zip(&found.is_support);
        let theirs = theirs.filter(|it| *it.1).flat_map(|it| *it.0);
        let theirs: FxHashSet<_> = theirs.map(|it| key(self.vertices[it as usize])).collect();
        let (supports, model): (Vec<_>, Vec<_>) = triangles
            .iter()
            .copied()
            .partition(|corners| theirs.contains(&key(corners[0])));
        let mut supports = Self::from_triangles(&supports)?;
        for vertex in &mut supports.vertices {
            vertex.z = vertex.z.max(found.feet);
        }
        let mut mesh = Self::with_caps(&model, all_curved)?;
        mesh.add(&supports.vertices, &supports.facets, FacetClass::Support);
        let first = mesh.vertices.len() as u32;
        mesh.vertices
            .extend(found.tips.iter().map(|tip| tip.as_vec3()));
        mesh.tips = [first, mesh.vertices.len() as u32];
        Ok(mesh)
    }

    /// Places where supports of the file hold the model; none without such supports.
    pub fn own_tips(&self) -> &[Vec3] {
        let [from, to] = self.tips;
        &self.vertices[from as usize..to as usize]
    }

    /// The mesh without supports.
    #[must_use]
    pub fn bare(&self) -> Self {
        self.up_to(FacetClass::Void)
    }

    /// The mesh without supports and voids.
    #[must_use]
    pub fn solid(&self) -> Self {
        self.up_to(FacetClass::Cap)
    }

    /// The mesh without the facets of later classes.
    fn up_to(&self, class: FacetClass) -> Self {
        let classes = self.classes.up_to(class);
        Self {
            vertices: self.vertices.clone(),
            facets: self.facets[..classes.end(class)].to_vec(),
            classes,
            neighbours: Arc::clone(&self.neighbours),
            tips: [0; 2],
            ..*self
        }
    }

    /// Distance by which supports reach below the surface; 0 without supports.
    pub fn raised_mm(&self) -> f64 {
        let supports = self.of_class(FacetClass::Support);
        if supports.is_empty() {
            return 0.0;
        }
        let place = |vertex: usize| self.vertices[vertex].as_dvec3();
        let below_mm = self.bounds().min.z - Self::bounds_of(supports, place).min.z;
        // Without the noise of single precision.
        (below_mm.max(0.0) * 1e6).round() / 1e6
    }

    /// Moves the sides of supports outward, along the plate.
    pub fn widen_supports(&mut self, by_mm: f64) {
        if by_mm == 0.0 {
            return;
        }
        let supports = self.of_class(FacetClass::Support);
        let normals = supports.iter().map(|corners| {
            let [a, b, c] = corners.map(|vertex| self.vertices[vertex as usize].as_dvec3());
            (corners, (b - a).cross(c - a))
        });
        // The way outward of each vertex, and how much farther it moves than its sides, as corners do.
        let mut moves: FxHashMap<u32, (DVec2, f64)> = FxHashMap::default();
        for (corners, normal) in normals.clone() {
            for &vertex in corners {
                moves.entry(vertex).or_insert((DVec2::ZERO, 1.0)).0 += normal.truncate();
            }
        }
        for (corners, normal) in normals {
            let side = normal.truncate();
            if 2.0 * side.length() <= normal.length() {
                continue;
            }
            for vertex in corners {
                if let Some((outward, farther)) = moves.get_mut(vertex) {
                    let along = side.normalize_or_zero().dot(outward.normalize_or_zero());
                    *farther = farther.max(1.0 / along.max(0.5));
                }
            }
        }
        for (vertex, (outward, farther)) in moves {
            let by = outward.normalize_or_zero() * (by_mm * farther);
            let at = &mut self.vertices[vertex as usize];
            *at = (at.as_dvec3() + by.extend(0.0)).as_vec3();
        }
    }

    /// The corners of a facet in double precision.
    #[inline]
    pub fn corners(&self, facet: usize) -> [DVec3; 3] {
        self.facets[facet].map(|vertex| self.vertices[vertex as usize].as_dvec3())
    }

    /// A copy with the facets of another mesh, caps included, added to a class of this one. They count in masks, but not in
    /// profiles, bounds and volume.
    #[must_use]
    pub fn with(&self, other: &Self, class: FacetClass) -> Self {
        let mut joined = self.clone();
        joined.add(&other.vertices, &other.facets, class);
        joined
    }

    /// Adds a closed surface to a class. Its facets count in masks, but not in profiles, bounds and volume.
    pub fn add(&mut self, vertices: &[Vec3], facets: &[[u32; 3]], class: FacetClass) {
        let first_vertex = self.vertices.len() as u32;
        self.vertices.extend(vertices);
        let added = facets.iter();
        let added = added.map(|corners| corners.map(|vertex| vertex + first_vertex));
        let end = self.classes.end(class);
        self.facets.splice(end..end, added);
        self.classes = self.classes.grown(class, facets.len());
    }

    /// Moves the mesh up, but nothing below the plate.
    pub fn lift(&mut self, by_mm: f64) {
        for vertex in &mut self.vertices {
            vertex.z = ((f64::from(vertex.z) + by_mm) as f32).max(0.0);
        }
    }

    /// The bounding box of the surface.
    pub fn bounds(&self) -> Bounds {
        let surface = &self.facets[..self.surface_facets];
        Self::bounds_of(surface, |vertex| self.vertices[vertex].as_dvec3())
    }

    /// The facets of a class.
    pub fn of_class(&self, class: FacetClass) -> &[[u32; 3]] {
        let from = match class {
            FacetClass::Surface => 0,
            FacetClass::Cap => self.classes.surface_end(),
            FacetClass::Void => self.classes.end(FacetClass::Cap),
            FacetClass::Support => self.classes.end(FacetClass::Void),
        };
        &self.facets[from..self.classes.end(class)]
    }

    /// All facets, those of voids inside out, so that readers subtract them.
    pub fn printed_facets(&self) -> Vec<[u32; 3]> {
        let voids = self.classes.model_end() as usize..self.classes.end(FacetClass::Void);
        let facets = self.facets.iter().enumerate();
        let turned = |[a, b, c]: [u32; 3]| [a, c, b];
        let printed = facets.map(|(facet, &corners)| {
            if voids.contains(&facet) {
                turned(corners)
            } else {
                corners
            }
        });
        printed.collect()
    }

    /// The bounding box of all that is printed: the surface and its supports.
    pub fn printed_bounds(&self) -> Bounds {
        let place = |vertex: usize| self.vertices[vertex].as_dvec3();
        let model = self.bounds();
        let supports = Self::bounds_of(self.of_class(FacetClass::Support), place);
        Bounds {
            min: model.min.min(supports.min),
            max: model.max.max(supports.max),
        }
    }

    /// The bounding box of facets, with vertices at the positions that `place` gives.
    fn bounds_of(facets: &[[u32; 3]], place: impl Fn(usize) -> DVec3) -> Bounds {
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for &vertex in facets.iter().flatten() {
            min = min.min(place(vertex as usize));
            max = max.max(place(vertex as usize));
        }
        Bounds { min, max }
    }

    /// Volume enclosed by the model in mm³, by the divergence theorem, with holes closed and without voids and supports.
    /// Overlaps of bodies count once per body.
    pub fn volume_mm3(&self) -> f64 {
        let centre = (self.bounds().min + self.bounds().max) * 0.5;
        let sixfold: f64 = (0..self.classes.model_end() as usize)
            .map(|facet| {
                let [a, b, c] = self.corners(facet).map(|corner| corner - centre);
                sixfold_volume([a, b, c])
            })
            .sum();
        sixfold / 6.0
    }

    /// Returns true if the input was closed and consistently oriented.
    pub fn is_closed(&self) -> bool {
        self.open_edges == 0
    }

    /// `n_z²` of a facet's unit normal: 1 for a horizontal facet, 0 for a vertical one or one without area.
    pub fn n_z_squared(&self, facet: usize) -> f32 {
        let [a, b, c] = self.corners(facet);
        let normal = (b - a).cross(c - a);
        let vertical = normal.z * normal.z;
        let all = normal.x * normal.x + normal.y * normal.y + vertical;
        if all > 0.0 {
            (vertical / all) as f32
        } else {
            0.0
        }
    }

    /// The area of a facet seen from above, in mm².
    pub fn projected_mm2(&self, facet: usize) -> f64 {
        let [a, b, c] = self.corners(facet);
        (b - a).cross(c - a).z.abs() * 0.5
    }

    /// Returns true if the outward normal of a facet points down.
    pub fn faces_down(&self, facet: usize) -> bool {
        let [a, b, c] = self.corners(facet);
        (b - a).cross(c - a).z < 0.0
    }

    /// A copy that stands on the plate in this pose, with its lowest point at z = 0, centred on x = y = 0.
    ///
    /// # Errors
    /// [`MeshError::ZeroHeight`], [`MeshError::BadHeight`], [`MeshError::BadRotation`], [`MeshError::Overflow`].
    pub fn on_plate(&self, pose: &Pose) -> Result<Self, MeshError> {
        let turned: Vec<DVec3> = match pose.rotation {
            None => self
                .vertices
                .iter()
                .map(|vertex| vertex.as_dvec3())
                .collect(),
            Some(rotation) => {
                let rotation = rotation_matrix(rotation)?;
                let turn = |vertex: &Vec3| rotation * vertex.as_dvec3();
                self.vertices.iter().map(turn).collect()
            }
        };
        let surface = &self.facets[..self.surface_facets];
        let bounds = Self::bounds_of(surface, |vertex| turned[vertex]);
        let size = bounds.size();
        if size.z <= 0.0 {
            return Err(MeshError::ZeroHeight);
        }
        let scale = match pose.height_mm {
            Some(height_mm) if height_mm.is_finite() && height_mm > 0.0 => height_mm / size.z,
            Some(height_mm) => return Err(MeshError::BadHeight { height_mm }),
            None => pose.unit_mm(),
        };
        let middle = (bounds.min + bounds.max) * 0.5;
        let foot = DVec3::new(middle.x, middle.y, bounds.min.z);
        // Not a number if anything before it overflows.
        if !(size * scale).cmple(DVec3::splat(MAX_SIDE_MM)).all() {
            return Err(MeshError::Overflow);
        }
        let placed = turned.into_iter().map(|vertex| (vertex - foot) * scale);
        let mut placed: Vec<DVec3> = placed.collect();
        self.place_centroids(&mut placed);
        // Voids may reach below the plate, where nothing is printed. Supports are added later.
        if !self.of_class(FacetClass::Void).is_empty()
            && self.of_class(FacetClass::Support).is_empty()
        {
            for vertex in &mut placed {
                vertex.z = vertex.z.max(0.0);
            }
        }
        Ok(Self {
            vertices: placed.iter().map(|vertex| vertex.as_vec3()).collect(),
            facets: self.facets.clone(),
            neighbours: Arc::clone(&self.neighbours),
            ..*self
        })
    }
}

impl Mesh {
    /// Moves the centroids of caps to the middle of their loops. Where the file has the model, single precision rounds them by more
    /// than at the plate, and a model that is moved in its file would have other caps.
    fn place_centroids(&self, vertices: &mut [DVec3]) {
        let from = self.centroids_from;
        let mut sums: FxHashMap<u32, (DVec3, f64)> = FxHashMap::default();
        for corners in self.of_class(FacetClass::Cap) {
            let Some(&centroid) = corners.iter().find(|&&corner| corner >= from) else {
                continue;
            };
            let (sum, count) = sums.entry(centroid).or_default();
            for &corner in corners.iter().filter(|&&corner| corner != centroid) {
                *sum += vertices[corner as usize];
                *count += 1.0;
            }
        }
        for (centroid, (sum, count)) in sums {
            vertices[centroid as usize] = sum / count;
        }
    }
}

/// Six times the volume between a facet and the origin, negative if the origin is on its outer side.
pub(super) fn sixfold_volume([a, b, c]: [DVec3; 3]) -> f64 {
    a.dot(b.cross(c))
}

/// Turns those facets over.
fn turn(facets: &mut [[u32; 3]], turned: &[bool]) {
    for (corners, _) in facets.iter_mut().zip(turned).filter(|(_, turned)| **turned) {
        corners.swap(1, 2);
    }
}

/// Adds those facets without area that lie between facets of the surface. They keep the surface closed
/// when vertices are snapped. The others are dropped.
fn keep_joining_slivers(facets: &mut Vec<[u32; 3]>, flat: Vec<[u32; 3]>, vertex_count: usize) {
    let mut is_on_surface = vec![false; vertex_count];
    for &vertex in facets.iter().flatten() {
        is_on_surface[vertex as usize] = true;
    }
    facets.extend(flat.into_iter().filter(|&[a, b, c]| {
        let is_sliver = a != b && b != c && c != a;
        is_sliver
            && [a, b, c]
                .iter()
                .all(|&vertex| is_on_surface[vertex as usize])
    }));
}

/// Roundings of a coordinate within which a vertex lies on an edge: text files have fewer digits than single precision.
const NEAR_ROUNDINGS: f64 = 16.0;

/// Roundings of a coordinate within which the height of a needle of a facet does not determine its slope: its normal
/// may be off by several degrees.
const NEEDLE_ROUNDINGS: f64 = 64.0;

/// Least ratio of length to height at which a facet counts as a needle.
const NEEDLE_ASPECT: f64 = 1000.0;

/// Largest distance along an axis by which rounding to single precision may have moved a vertex.
fn rounding(vertices: &[Vec3]) -> f64 {
    let most = vertices
        .iter()
        .fold(Vec3::ZERO, |most, it| most.max(it.abs()));
    f64::from(most.max_element()) * f64::from(f32::EPSILON) / 2.0
}

/// The extent of vertices along each axis.
fn sides(vertices: &[Vec3]) -> DVec3 {
    let (mut min, mut max) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for vertex in vertices {
        (min, max) = (min.min(*vertex), max.max(*vertex));
    }
    max.as_dvec3() - min.as_dvec3()
}

/// Returns true if a facet has an area and a slope. Where its height is a matter of rounding, its normal is as well.
fn has_area([a, b, c]: [Vec3; 3], rounding: f64) -> bool {
    let (a, b, c) = (a.as_dvec3(), b.as_dvec3(), c.as_dvec3());
    let twice_area = (b - a).cross(c - a).length();
    let edges = [b - a, c - b, a - c].map(DVec3::length);
    let longest = edges[0].max(edges[1]).max(edges[2]);
    let height = twice_area / longest;
    let is_needle = height < NEEDLE_ROUNDINGS * rounding && longest > NEEDLE_ASPECT * height;
    twice_area > 0.0 && !is_needle
}
