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
    /// The outer ring, then the holes.
    pub fn rings(&self) -> impl Iterator<Item = &Ring> {
        std::iter::once(&self.outer).chain(&self.holes)
    }
}

/// Where a layer is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LayerHeights {
    /// Its bottom.
    pub bottom_mm: f64,
    /// Its top.
    pub top_mm: f64,
    /// Where the model is cut: its middle.
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
    /// Where the layer is.
    pub heights: LayerHeights,
    /// What is printed. No two polygons have more than single points in common.
    pub polygons: Vec<Polygon>,
}

/// A length in millimetres as files and reports show it: to the picometre, as planes of layers are.
fn shown(length_mm: f64) -> f64 {
    (length_mm * 1e9).round() / 1e9
}

/// What a file of contours says before its layers.
#[derive(Debug, Clone)]
pub struct Heading<'a> {
    /// What the file is about: the name of the model, for example.
    pub title: &'a str,
    /// The lattice of all points.
    pub lattice: Lattice,
    /// The box around the model.
    pub bounds: Bounds,
    /// Number of layers.
    pub layers: usize,
}

/// Cuts a mesh, as it stands on the plate, at every layer, in ascending order, and passes the contours to `collect` from the plate upward.
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
    mesh: &Mesh,
    layers: &[LayerHeights],
    simplify_mm: f64,
    progress: &mut Progress<'_>,
    collect: impl FnMut(Contours) -> Result<(), E>,
) -> Result<(), E> {
    let lattice = Lattice::of(&mesh.bounds());
    let sections_mm: Vec<f64> = layers.iter().map(|layer| layer.section_mm).collect();
    let crossings = Crossings::new(mesh, &sections_mm);
    let tolerance = lattice.to_steps(simplify_mm);
    let work = |layer: usize| {
        let heights = layers[layer];
        let loops = Loops::of(mesh, crossings.of(layer), heights.section_mm, lattice);
        let polygons = simplify::simplify(union::union(&loops), tolerance);
        Contours { heights, polygons }
    };
    parallel::map_in_groups(0..layers.len(), work, collect, progress, [0.0, 1.0])
}
