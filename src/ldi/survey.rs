//! Facts about the sampled model from one pass over all rays.

use super::assemble::sort_ray;
use super::cpu::{RayRow, RowPart};
use super::overlaps::{Part, is_plain};
use super::solid::Heights;
use super::visibility::is_in_turn;
use super::{Hit, LdiError, Overlaps, RayImage, Rays, Solid, printed_ranges, ranges};
use crate::model::{FacetClass, FacetClasses};
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
    classes: FacetClasses,
    /// Columns of the grid.
    width: u32,
    keeps: bool,
    hits: u64,
    printed_mm: f64,
    heights: Heights,
    support_mm: f64,
    through_holes: usize,
    is_in_turn: bool,
    /// The rays that overlap; absent if they are not kept, and before the first row.
    overlaps: Option<Result<Part, LdiError>>,
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
        let none = || Sums::new(image, keeps);
        let parts = image.read(|rows| rows.fold_rows(none, Sums::add, Sums::add_row, progress))?;
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
    fn new(image: RayImage<'_>, keeps: bool) -> Self {
        Self {
            classes: image.classes(),
            width: image.grid().width,
            keeps,
            hits: 0,
            printed_mm: 0.0,
            heights: Heights::default(),
            support_mm: 0.0,
            through_holes: 0,
            is_in_turn: true,
            overlaps: None,
        }
    }

    fn add(&mut self, rays: Rays<'_>) {
        for (ray, hits) in rays.each().enumerate() {
            if !hits.is_empty() {
                let (row, column) = (ray as u32 / self.width, ray as u32 % self.width);
                self.add_ray([rays.first_row + row, column], hits);
            }
        }
    }

    fn add_row(&mut self, found: &mut RayRow) {
        let row = found.row;
        found.each(|column, part| match part {
            RowPart::Ray(hits) => self.add_ray([row, column], hits),
            RowPart::Pairs(pairs) => {
                // No early exit, so that the loop is vectorised.
                let rise = |[enters, leaves]: &[Hit; 2]| enters.z_mm < leaves.z_mm;
                let are_plain = pairs.iter().fold(true, |all, pair| all & rise(pair));
                if are_plain && self.classes.is_model_alone() {
                    return self.add_bodies(pairs);
                }
                for (column, pair) in (column..).zip(pairs) {
                    sort_ray(pair);
                    self.add_ray([row, column], pair);
                }
            }
        });
    }

    /// Adds rays side by side, each of which enters a body of the model and leaves it.
    fn add_bodies(&mut self, rays: &[[Hit; 2]]) {
        self.hits += 2 * rays.len() as u64;
        let Some(&[first, _]) = rays.first() else {
            return;
        };
        // In registers: each sum waits for the one before.
        let mut printed_mm = self.printed_mm;
        let [mut low, mut high] = [first.z_mm; 2];
        let [mut last_in, mut last_out] = [low, high];
        let mut is_connected = true;
        for [enters, leaves] in rays {
            let (z_in, z_out) = (enters.z_mm, leaves.z_mm);
            printed_mm += f64::from(z_out) - f64::from(z_in);
            is_connected &= z_in <= last_out;
            is_connected &= last_in <= z_out;
            (last_in, last_out) = (z_in, z_out);
            low = if z_in < low { z_in } else { low };
            high = if z_out > high { z_out } else { high };
        }
        self.printed_mm = printed_mm;
        if is_connected {
            self.heights.add(low, high);
        } else {
            for [enters, leaves] in rays {
                self.heights.add(enters.z_mm, leaves.z_mm);
            }
        }
        if self.classes.has_caps() {
            let through_caps = rays.iter().filter(|ray| self.meets_cap(*ray));
            self.through_holes += through_caps.count();
        }
    }

    /// Adds a ray that has hits, given its row and column.
    fn add_ray(&mut self, place: [u32; 2], hits: &[Hit]) {
        let classes = self.classes;
        let is_alone = classes.is_model_alone();
        self.hits += hits.len() as u64;
        if classes.has_caps() && self.meets_cap(hits) {
            self.through_holes += 1;
        }
        let mut add_range = |z_in: f32, z_out: f32| {
            self.printed_mm += f64::from(z_out) - f64::from(z_in);
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
        if !is_alone {
            ranges::support_ranges(hits, classes, |from_mm, to_mm| {
                self.support_mm += f64::from(to_mm) - f64::from(from_mm);
            });
        }
        if !is_plain {
            self.add_overlap(place, hits);
        }
    }

    #[inline]
    fn meets_cap(&self, hits: &[Hit]) -> bool {
        let is_cap = |hit: &Hit| self.classes.of(hit.facet()) == FacetClass::Cap;
        hits.iter().fold(false, |any, hit| any | is_cap(hit))
    }

    #[cold]
    fn add_overlap(&mut self, [row, column]: [u32; 2], hits: &[Hit]) {
        // Once is enough.
        self.is_in_turn = self.is_in_turn && is_in_turn(hits, self.classes.model_end());
        if !self.keeps {
            return;
        }
        let part = self
            .overlaps
            .get_or_insert_with(|| Ok(Part::new(row, self.width)));
        if let Ok(part) = part
            && let Err(error) = part.add(row, column, hits)
        {
            self.overlaps = Some(Err(error));
        }
    }
}
