//! Facts about the sampled model from one pass over all rays.

use super::overlaps::{Part, is_plain};
use super::solid::Heights;
use super::visibility::is_in_turn;
use super::{Hit, LdiError, Overlaps, RayImage, Rays, Solid, printed_ranges, ranges};
use crate::model::FacetClass;
use crate::progress::Progress;

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
struct Sums {
    hits: u64,
    printed_mm: f64,
    heights: Heights,
    support_mm: f64,
    through_holes: usize,
    is_in_turn: bool,
    /// The rays that overlap; absent if they are not kept, and before the first row.
    overlaps: Option<Result<Part, LdiError>>,
    keeps: bool,
}

impl Survey {
    /// Surveys the rays in one pass. Sums are made by rows, so an LDI and its mesh give the same.
    ///
    /// # Errors
    /// [`LdiError::Cancelled`].
    pub fn of(image: RayImage<'_>, progress: &mut Progress<'_>) -> Result<Self, LdiError> {
        Ok(Self::keeping(image, false, progress)?.0)
    }

    /// The same, and the rays along which bodies overlap.
    ///
    /// # Errors
    /// [`LdiError::Cancelled`], [`LdiError::OutOfMemory`].
    pub fn with_overlaps(
        image: RayImage<'_>,
        progress: &mut Progress<'_>,
    ) -> Result<(Self, Overlaps), LdiError> {
        Self::keeping(image, true, progress)
    }

    /// Surveys the rays, and keeps those that overlap if `keeps` is set.
    fn keeping(
        image: RayImage<'_>,
        keeps: bool,
        progress: &mut Progress<'_>,
    ) -> Result<(Self, Overlaps), LdiError> {
        let none = || Sums::new(keeps);
        let parts = image.fold(none, Sums::add, progress)?;
        let mut overlaps = Vec::new();
        let mut all = none();
        for part in parts {
            all.hits += part.hits;
            all.printed_mm += part.printed_mm;
            all.support_mm += part.support_mm;
            all.through_holes += part.through_holes;
            all.is_in_turn &= part.is_in_turn;
            for (z_in, z_out) in part.heights.into_ranges() {
                all.heights.add(z_in, z_out);
            }
            overlaps.extend(part.overlaps.transpose()?);
        }
        let pixel_mm2 = image.grid().pixel_mm2();
        let survey = Self {
            hits: all.hits,
            solid: Solid {
                volume_mm3: all.printed_mm * pixel_mm2,
                heights_mm: all.heights.into_ranges(),
            },
            support_mm3: all.support_mm * pixel_mm2,
            rays_through_holes: all.through_holes,
            is_in_turn: all.is_in_turn,
        };
        Ok((survey, Overlaps::new(overlaps)))
    }
}

impl Sums {
    fn new(keeps: bool) -> Self {
        Self {
            hits: 0,
            printed_mm: 0.0,
            heights: Heights::default(),
            support_mm: 0.0,
            through_holes: 0,
            is_in_turn: true,
            overlaps: None,
            keeps,
        }
    }

    fn add(&mut self, rays: Rays<'_>) {
        let classes = rays.classes;
        let is_alone = classes.is_model_alone();
        let is_cap = |hit: &Hit| classes.of(hit.facet()) == FacetClass::Cap;
        // In most rows there are none, and a loop that only looks for any is vectorised.
        let meet_caps = || rays.hits.iter().fold(false, |any, hit| any | is_cap(hit));
        let has_caps = classes.has_caps() && meet_caps();
        self.hits += rays.hits.len() as u64;
        // In a register: each sum waits for the one before.
        let mut printed_mm = self.printed_mm;
        for (ray, hits) in rays.each().enumerate() {
            if hits.is_empty() {
                continue;
            }
            let mut add_range = |z_in: f32, z_out: f32| {
                printed_mm += f64::from(z_out) - f64::from(z_in);
                self.heights.add(z_in, z_out);
            };
            let is_plain = is_plain(hits, classes);
            if is_plain && is_alone {
                let (bodies, _) = hits.as_chunks::<2>();
                for [enters, leaves] in bodies {
                    add_range(enters.z_mm, leaves.z_mm);
                }
            } else {
                printed_ranges(hits, classes, add_range);
            }
            if has_caps && hits.iter().any(is_cap) {
                self.through_holes += 1;
            }
            if !is_alone {
                ranges::support_ranges(hits, classes, |from_mm, to_mm| {
                    self.support_mm += f64::from(to_mm) - f64::from(from_mm);
                });
            }
            if !is_plain {
                self.add_overlap(&rays, ray, hits);
            }
        }
        self.printed_mm = printed_mm;
    }

    #[cold]
    fn add_overlap(&mut self, rays: &Rays<'_>, ray: usize, hits: &[Hit]) {
        let model_end = rays.classes.model_end();
        // Once is enough.
        self.is_in_turn = self.is_in_turn && is_in_turn(hits, model_end);
        if !self.keeps {
            return;
        }
        let width = rays.width as usize;
        let (row, column) = (rays.first_row + (ray / width) as u32, (ray % width) as u32);
        let part = self
            .overlaps
            .get_or_insert_with(|| Ok(Part::new(row, rays.width)));
        if let Ok(part) = part
            && let Err(error) = part.add(row, column, hits)
        {
            self.overlaps = Some(Err(error));
        }
    }
}
