//! A surface as metrics see it along z: which bins its facets meet and how steep they are.

use crate::grid::Bins;
use crate::model::Mesh;

/// A facet is horizontal if `n_z²` of its normal is at least this: within 0.06°.
const HORIZONTAL: f32 = 1.0 - 1e-6;

/// The facets of a surface along z, in their order. What only closes a surface has no part in it.
#[derive(Debug, Clone)]
pub struct FacetBins {
    /// The height ranges that `spans` speaks of.
    pub bins: Bins,
    /// The first and the last bin that each facet meets.
    pub spans: Vec<[u32; 2]>,
    /// `n_z²` of the unit normal of each facet: 1 where it is horizontal.
    pub n_z_squared: Vec<f32>,
    /// Those that are horizontal.
    pub flats: Vec<Flat>,
}

/// A horizontal facet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flat {
    /// Its number.
    pub facet: u32,
    /// The boundary of bins that is nearest to it.
    pub boundary: u32,
    /// Its area in mm².
    pub area_mm2: f64,
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
            |facet| {
                let [a, b, c] = mesh.corners(facet);
                (b - a).cross(c - a).z.abs() * 0.5
            },
        )
    }

    /// The facet bins of facets over vertices of these heights, with the `n_z²` of each, and for horizontal ones the area in mm².
    pub(crate) fn new(
        bins: Bins,
        facets: &[[u32; 3]],
        heights_mm: &[f32],
        n_z_squared: impl Fn(usize) -> f32,
        area_mm2: impl Fn(usize) -> f64,
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

    /// The horizontal facets but those that `hidden` names; it may be empty.
    pub fn flats_but(&self, hidden: &[bool]) -> Vec<Flat> {
        let is_seen = |flat: &&Flat| hidden.get(flat.facet as usize) != Some(&true);
        self.flats.iter().filter(is_seen).copied().collect()
    }
}

/// Places of the squares of horizontal facets. Most models have few: blocks without any are passed over at once.
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
