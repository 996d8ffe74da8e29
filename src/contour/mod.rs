//! The exact section of every layer of a plan, as polygons: for tool paths of other processes.
//!
//! [`cut`] cuts the mesh at the middle of each layer, where masks are sampled as well, joins the segments to loops (`section.rs`), unites all
//! bodies (`union.rs`) and leaves out points within a tolerance (`simplify.rs`). Polygons never cross themselves or each other; outer rings
//! are counter-clockwise, holes clockwise. [`svg`] and [`cli`] write them.
//!
//! Points lie on a [`Lattice`] of a tenth of a micrometre, and everything after the section is decided by integers.

pub mod cli;
mod lattice;
mod report;
mod section;
mod simplify;
pub mod svg;
mod union;

use glam::DVec2;

use crate::model::{Bounds, Mesh};
use crate::parallel;
use crate::plan::Plan;
use crate::progress::{Cancelled, Progress};
pub use lattice::Lattice;
pub use report::{ContoursReport, SectionReport};
use section::{Crossings, Loops};

/// A closed outline on the [`Lattice`]. The last point is joined to the first.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Ring {
    /// Three points or more, x and y in steps.
    pub points: Vec<[i32; 2]>,
}

impl Ring {
    /// The area in square steps: positive for an outer ring, negative for a hole.
    pub fn area(&self) -> f64 {
        simplify::twice_area(&self.points) as f64 / 2.0
    }

    /// The length in steps.
    pub fn length(&self) -> f64 {
        let next = self.points.iter().cycle().skip(1);
        let lengths = self.points.iter().zip(next).map(|(a, b)| {
            let [x, y] = [0, 1].map(|axis| f64::from(b[axis]) - f64::from(a[axis]));
            (x * x + y * y).sqrt()
        });
        lengths.sum()
    }
}

/// A part of a section: an outer ring and the holes in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Polygon {
    /// Counter-clockwise.
    pub outer: Ring,
    /// Clockwise, inside the outer ring and outside each other.
    pub holes: Vec<Ring>,
}

impl Polygon {
    /// A copy at an offset in steps.
    fn moved(&self, [right, back]: [i32; 2]) -> Self {
        let moved = |ring: &Ring| Ring {
            points: ring
                .points
                .iter()
                .map(|[x, y]| [x + right, y + back])
                .collect(),
        };
        Self {
            outer: moved(&self.outer),
            holes: self.holes.iter().map(moved).collect(),
        }
    }

    /// The outer ring, then the holes.
    pub fn rings(&self) -> impl Iterator<Item = &Ring> {
        std::iter::once(&self.outer).chain(&self.holes)
    }
}

/// Heights of a layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LayerHeights {
    /// Its bottom.
    pub bottom_mm: f64,
    /// Its top.
    pub top_mm: f64,
    /// Height of the section: the middle of the layer.
    pub section_mm: f64,
}

impl LayerHeights {
    /// The layers of a plan.
    pub fn of(plan: &Plan) -> Vec<Self> {
        let z_mm = plan.z_mm();
        let layers = z_mm.windows(2).zip(plan.middle_mm());
        layers
            .map(|(planes, section_mm)| Self {
                bottom_mm: planes[0],
                top_mm: planes[1],
                section_mm,
            })
            .collect()
    }
}

/// The section of a layer.
#[derive(Debug, Clone, PartialEq)]
pub struct Contours {
    /// Heights of the layer.
    pub heights: LayerHeights,
    /// The printed area. No two polygons have more than single points in common.
    pub polygons: Vec<Polygon>,
}

/// Copies of a mesh on a plate. They overlap neither each other nor those of other meshes.
#[derive(Debug, Clone)]
pub struct Copies<'a> {
    /// The mesh, on the plate at z = 0.
    pub mesh: &'a Mesh,
    /// The place of its origin, for each copy.
    pub places_mm: Vec<DVec2>,
}

impl<'a> Copies<'a> {
    /// A mesh where it is.
    pub fn one(mesh: &'a Mesh) -> Self {
        Self {
            mesh,
            places_mm: vec![DVec2::ZERO],
        }
    }

    /// The box around all of them, supports left out.
    pub fn bounds(all: &[Self]) -> Bounds {
        let boxes = all.iter().flat_map(|copies| {
            let Bounds { min, max } = copies.mesh.bounds();
            let places_mm = copies.places_mm.iter();
            places_mm.map(move |place| [min + place.extend(0.0), max + place.extend(0.0)])
        });
        let [min, max] = boxes
            .reduce(|[min, max], [low, high]| [min.min(low), max.max(high)])
            .unwrap_or_default();
        Bounds { min, max }
    }
}

/// A length in millimetres as files and reports show it: to the picometre, as planes of layers are.
fn shown(length_mm: f64) -> f64 {
    (length_mm * 1e9).round() / 1e9
}

/// Header of a file of contours.
#[derive(Debug, Clone)]
pub struct Heading<'a> {
    /// Title of the file: the name of the model, for example.
    pub title: &'a str,
    /// The lattice of all points.
    pub lattice: Lattice,
    /// The box around all that is cut, supports left out.
    pub bounds: Bounds,
    /// Number of layers.
    pub layers: usize,
}

/// Cuts meshes at every layer, in ascending order, and passes the contours to `collect` from the plate upward. A mesh is cut once for all
/// of its copies, which are moved to the nearest lattice points.
///
/// No point of the contours is farther than `simplify_mm` from the outline of the exact section, and none of that outline is farther than that
/// from the contours, apart from rounding to the lattice; 0 keeps every point.
///
/// Cost: linear in facets, plus, in each layer, the facets that cross it, times their logarithm. Memory: 4 bytes per facet and layer that
/// it crosses.
///
/// # Errors
/// Those of `collect`, and [`Cancelled`] if `progress` cancels.
pub fn cut<E: From<Cancelled>>(
    all: &[Copies<'_>],
    layers: &[LayerHeights],
    simplify_mm: f64,
    progress: &mut Progress<'_>,
    collect: impl FnMut(Contours) -> Result<(), E>,
) -> Result<(), E> {
    let lattice = Lattice::of(&Copies::bounds(all));
    let sections_mm: Vec<f64> = layers.iter().map(|layer| layer.section_mm).collect();
    let meshes = all.iter();
    let crossings: Vec<Crossings> = meshes
        .map(|copies| Crossings::new(copies.mesh, &sections_mm))
        .collect();
    let tolerance = lattice.to_steps(simplify_mm);
    let work = |layer: usize| {
        let heights = layers[layer];
        let mut polygons = Vec::new();
        for (Copies { mesh, places_mm }, crossings) in all.iter().zip(&crossings) {
            let loops = Loops::of(mesh, crossings.of(layer), heights.section_mm, lattice);
            let of_one = simplify::simplify(union::union(&loops), tolerance);
            for &place_mm in places_mm {
                let offset = lattice.nearest(place_mm);
                polygons.extend(of_one.iter().map(|polygon| polygon.moved(offset)));
            }
        }
        Contours { heights, polygons }
    };
    parallel::map_in_groups(0..layers.len(), work, collect, progress, [0.0, 1.0])
}
