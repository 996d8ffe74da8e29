//! The facets of a surface by bins: which bins each one meets, and how steep it is.

use crate::grid::Bins;
use crate::model::Mesh;

/// A facet is horizontal if `n_z²` of its unit normal is at least this, that is, within 0.06°.
const HORIZONTAL: f32 = 1.0 - 1e-6;

/// The facets of a surface along z, in the mesh's order. Caps and slivers, which only close the surface, are left out.
#[derive(Debug, Clone)]
pub struct FacetBins {
    /// The bins that `spans` indexes.
    pub bins: Bins,
    /// The first and the last bin that each facet meets.
    pub spans: Vec<[u32; 2]>,
    /// `n_z²` of the unit normal of each facet: 1 if the facet is horizontal, 0 if it is vertical.
    pub n_z_squared: Vec<f32>,
    /// The horizontal facets.
    pub flats: Vec<Flat>,
}

/// A horizontal facet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flat {
    /// Index of the facet.
    pub facet: u32,
    /// The nearest boundary of bins.
    pub boundary: u32,
    /// Its area in mm².
    pub area_mm2: f64,
    /// True if its normal points down.
    pub faces_down: bool,
}

impl FacetBins {
    /// The facet bins of a mesh that stands on the plate.
    pub fn of(mesh: &Mesh, bins: Bins) -> Self {
        let heights_mm: Vec<f32> = mesh.vertices.iter().map(|vertex| vertex.z).collect();
        let facets = &mesh.facets[..mesh.surface_facets];
        Self::new(
            bins,
            facets,
            &heights_mm,
            |facet| mesh.n_z_squared(facet),
            |facet| mesh.projected_mm2(facet),
            |facet| mesh.faces_down(facet),
        )
    }

    /// The facet bins of any facets, given the heights of vertices, a function for the `n_z²` of a facet, and two for the
    /// area in mm² of a horizontal facet, and whether it faces down.
    pub(crate) fn new(
        bins: Bins,
        facets: &[[u32; 3]],
        heights_mm: &[f32],
        n_z_squared: impl Fn(usize) -> f32,
        area_mm2: impl Fn(usize) -> f64,
        faces_down: impl Fn(usize) -> bool,
    ) -> Self {
        let heights = heights_mm.iter();
        let bin_of: Vec<u32> = heights
            .map(|&z_mm| bins.of(f64::from(z_mm)) as u32)
            .collect();
        let span = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|vertex| bin_of[vertex as usize]);
            [a.min(b).min(c), a.max(b).max(c)]
        };
        let n_z_squared: Vec<f32> = (0..facets.len()).map(n_z_squared).collect();
        let flats = horizontal(&n_z_squared)
            .map(|facet| {
                let corners = facets[facet].map(|vertex| f64::from(heights_mm[vertex as usize]));
                let [a, b, c] = corners;
                Flat {
                    facet: facet as u32,
                    boundary: bins.nearest_boundary((a + b + c) / 3.0),
                    area_mm2: area_mm2(facet),
                    faces_down: faces_down(facet),
                }
            })
            .collect();
        Self {
            bins,
            spans: facets.iter().map(span).collect(),
            n_z_squared,
            flats,
        }
    }

    /// The horizontal facets that are not hidden. An empty `hidden` hides none.
    pub fn flats_but(&self, hidden: &[bool]) -> Vec<Flat> {
        let is_seen = |flat: &&Flat| hidden.get(flat.facet as usize) != Some(&true);
        self.flats.iter().filter(is_seen).copied().collect()
    }
}

/// Indices of horizontal facets. Most models have few, so whole blocks without any are skipped.
fn horizontal(n_z_squared: &[f32]) -> impl Iterator<Item = usize> {
    const BLOCK: usize = 64;
    let is_horizontal = |square: &&f32| **square >= HORIZONTAL;
    let blocks = n_z_squared.chunks(BLOCK).enumerate();
    blocks
        .filter(move |(_, block)| block.iter().filter(is_horizontal).count() > 0)
        .flat_map(|(place, block)| {
            let facets = block.iter().zip(place * BLOCK..);
            facets.filter(|(square, _)| **square >= HORIZONTAL)
        })
        .map(|(_, facet)| facet)
}
