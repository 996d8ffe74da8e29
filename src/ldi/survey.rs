//! Facts about the sampled model from one pass over all rays.

use super::solid::Heights;
use super::visibility::is_in_turn;
use super::{Hit, RayImage, Rays, Solid, printed_ranges, ranges};
use crate::model::FacetClass;
use crate::progress::{Cancelled, Progress};

/// Facts about the sampled model from one pass over all rays.
#[derive(Debug, Clone, PartialEq)]
pub struct Survey {
    /// Number of hits.
    pub hits: u64,
    /// The printed solid.
    pub solid: Solid,
    /// Volume of supports outside the model, in mm³.
    pub support_mm3: f64,
    /// Number of rays that pass through a hole of the mesh. Without the caps these rays would not close.
    pub rays_through_holes: usize,
    /// True if every ray enters and leaves one body of the model after another, so that no facet is hidden.
    pub is_in_turn: bool,
}

/// The sums over the rays of a part.
#[derive(Default)]
struct Sums {
    hits: u64,
    printed_mm: f64,
    heights: Heights,
    support_mm: f64,
    through_holes: usize,
    overlaps: bool,
}

impl Survey {
    /// Surveys the rays in one pass. Sums are made by rows, so an LDI and its mesh give the same.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn of(image: RayImage<'_>, progress: &mut Progress<'_>) -> Result<Self, Cancelled> {
        let parts = image.fold(Sums::default, Sums::add, progress)?;
        let mut all = Sums::default();
        for part in parts {
            all.hits += part.hits;
            all.printed_mm += part.printed_mm;
            all.support_mm += part.support_mm;
            all.through_holes += part.through_holes;
            all.overlaps |= part.overlaps;
            for (z_in, z_out) in part.heights.into_ranges() {
                all.heights.add(z_in, z_out);
            }
        }
        let pixel_mm2 = image.grid().pixel_mm2();
        Ok(Self {
            hits: all.hits,
            solid: Solid {
                volume_mm3: all.printed_mm * pixel_mm2,
                heights_mm: all.heights.into_ranges(),
            },
            support_mm3: all.support_mm * pixel_mm2,
            rays_through_holes: all.through_holes,
            is_in_turn: !all.overlaps,
        })
    }
}

impl Sums {
    fn add(&mut self, rays: Rays<'_>) {
        let classes = rays.classes;
        let model_end = classes.model_end();
        let (has_caps, is_alone) = (classes.has_caps(), classes.is_model_alone());
        let is_cap = |hit: &Hit| classes.of(hit.facet()) == FacetClass::Cap;
        self.hits += rays.hits.len() as u64;
        for hits in rays.each() {
            printed_ranges(hits, classes, |z_in, z_out| {
                self.printed_mm += f64::from(z_out) - f64::from(z_in);
                self.heights.add(z_in, z_out);
            });
            // Once is enough.
            self.overlaps = self.overlaps || !is_in_turn(hits, model_end);
            if has_caps && hits.iter().any(is_cap) {
                self.through_holes += 1;
            }
            if !is_alone {
                ranges::support_ranges(hits, classes, |from_mm, to_mm| {
                    self.support_mm += f64::from(to_mm) - f64::from(from_mm);
                });
            }
        }
    }
}
