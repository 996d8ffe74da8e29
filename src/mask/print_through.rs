//! Errors of surfaces that face down after cure below layers, and what compensation cannot mend.

use std::ops::Range;

use serde::Serialize;

use super::entries::{Column, CuredRange, Entries, LitRanges, Raise};
use super::samples::SublayerOf;
use super::window::Place;
use super::{Masks, Samples, Side, of_rays};
use crate::cure::{Cure, Light, LitRange};
use crate::grid::Grid;
use crate::ldi::{Hit, RayRows};
use crate::model::FacetClasses;
use crate::parallel;
use crate::plan::Plan;
use crate::progress::{Cancelled, Progress};
use crate::warning::Warning;

/// Heights of cured surfaces that face down, above those of the model: negative where they are too low.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct BottomErrors {
    /// Largest distance.
    pub largest_mm: f64,
    /// Mean distance.
    pub mean_mm: f64,
}

/// Print-through of a plan: errors of surfaces that face down, outside the first layer and supports.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct PrintThroughReport {
    /// Without compensation.
    pub before: BottomErrors,
    /// With masks that make up for it.
    pub after: BottomErrors,
    /// The largest of `after` where penetration differs by 20 %, overcure by 0.02 mm, and half or all of earlier doses counts.
    pub within: BottomErrors,
    /// Area of roofs so thin that their last layer alone cures too deep.
    pub thin_roofs_mm2: f64,
    /// The most by which such a roof is too low.
    pub thin_roofs_mm: f64,
    /// Area of gaps that light through their roof closes.
    pub closed_gaps_mm2: f64,
    /// Ranges of heights in which surfaces stay out of tolerance after compensation, half of the layer where the metric is no distance.
    pub off_mm: Vec<[f64; 2]>,
    /// The first thin roof and the first closed gap, from the middle of their models and above the plate.
    #[serde(skip)]
    pub(crate) thin_at_mm: [f64; 3],
    #[serde(skip)]
    pub(crate) closed_at_mm: [f64; 3],
}

/// The least area of roofs and gaps that is worth a warning. Edges of wedges make up for less than this in most models.
const LEAST_MM2: f64 = 4.0;

/// The least area of a layer out of tolerance that is reported. Most models have a few rays at edges.
const LEAST_OFF_MM2: f64 = 0.5;

/// Rows of a band, in whose order errors are summed.
const BAND_ROWS: usize = 64;

/// The most cures that the same masks are examined under.
const MOST_CURES: usize = 4;

/// Sums over rays.
#[derive(Clone, Default)]
struct Tally {
    rays: u64,
    before: [f64; 2],
    after: [f64; 2],
    others: [[f64; 2]; MOST_CURES],
    thin: u64,
    thin_mm: f64,
    closed: u64,
    /// Rays out of tolerance, by the layer that the surface is in.
    off: Vec<u64>,
    /// The first ray of each, and a height.
    thin_at: Option<(usize, f64)>,
    closed_at: Option<(usize, f64)>,
}

fn note([largest_mm, sum_mm]: &mut [f64; 2], error_mm: f64) {
    *largest_mm = largest_mm.max(error_mm.abs());
    *sum_mm += error_mm.abs();
}

impl Tally {
    fn join(&mut self, other: &Self) {
        let pairs = [
            (&mut self.before, other.before),
            (&mut self.after, other.after),
        ];
        let pairs = pairs
            .into_iter()
            .chain(self.others.iter_mut().zip(other.others));
        for ([largest_mm, sum_mm], [its_mm, its_sum_mm]) in pairs {
            *largest_mm = largest_mm.max(its_mm);
            *sum_mm += its_sum_mm;
        }
        for (sum, rays) in self.off.iter_mut().zip(&other.off) {
            *sum += rays;
        }
        self.rays += other.rays;
        self.thin += other.thin;
        self.thin_mm = self.thin_mm.max(other.thin_mm);
        self.closed += other.closed;
        self.thin_at = self.thin_at.or(other.thin_at);
        self.closed_at = self.closed_at.or(other.closed_at);
    }
}

/// Measures the masks that make up for a cure, under that cure and under others. The areas are those of one copy of the model. `None` if
/// the masks make up for a constant distance. Without a tolerance, half of the layer is out of tolerance.
///
/// Cost: linear in hits.
///
/// # Errors
/// [`Cancelled`].
pub(crate) fn print_through(
    image: &RayRows<'_>,
    plan: &Plan,
    samples: Samples,
    raise: &Raise,
    others: &[Cure],
    tolerance_mm: Option<f64>,
    progress: &mut Progress<'_>,
) -> Result<Option<PrintThroughReport>, Cancelled> {
    let Raise::Cured { cure, .. } = raise else {
        return Ok(None);
    };
    let sublayer_of = SublayerOf::new(plan, samples.sublayers);
    let entries = Entries {
        sublayer_of: &sublayer_of,
        parts: samples.sublayers,
        raise,
    };
    let (width, height) = (image.grid.width as usize, image.grid.height as usize);
    let bands = (0..height).step_by(BAND_ROWS);
    let bands = bands.map(|row| row..(row + BAND_ROWS).min(height));
    let empty = Tally {
        off: vec![0; plan.layers()],
        ..Tally::default()
    };
    let mut all = empty.clone();
    parallel::map_in_groups(
        bands,
        |rows: Range<usize>| {
            let mut tally = empty.clone();
            let mut ranges = Column::new();
            let held = image.of(rows.start as u32..rows.end as u32);
            for (ray, hits) in held.rays().each().enumerate() {
                let ray = rows.start * width + ray;
                let mut lights = Lights::default();
                let mut pass = |range: &CuredRange| {
                    lights.pass(ray, range, cure, others, tolerance_mm, &mut tally);
                };
                each_range(&entries, cure, hits, image.classes, &mut ranges, &mut pass);
            }
            tally
        },
        |tally| {
            all.join(&tally);
            Ok::<_, Cancelled>(())
        },
        progress,
        [0.0, 1.0],
    )?;
    let errors = |[largest_mm, sum_mm]: [f64; 2], rays: u64| BottomErrors {
        largest_mm,
        mean_mm: sum_mm / rays.max(1) as f64,
    };
    let mended = all.rays - all.thin;
    let after = errors(all.after, mended);
    let at_mm = |at: Option<(usize, f64)>| {
        let (ray, z_mm) = at.unwrap_or_default();
        let middle = image
            .grid
            .centre_mm((ray % width) as u32, (ray / width) as u32);
        // Hundredths are enough to find a place.
        [middle.x, middle.y, z_mm].map(|mm| (mm * 100.0).round() / 100.0)
    };
    let area_mm2 = |rays: u64| rays as f64 * image.grid.pixel_mm2();
    let within = all
        .others
        .iter()
        .take(others.len())
        .map(|&it| errors(it, mended));
    Ok(Some(PrintThroughReport {
        before: errors(all.before, all.rays),
        after,
        within: within.fold(after, BottomErrors::largest),
        thin_roofs_mm2: area_mm2(all.thin),
        thin_roofs_mm: all.thin_mm,
        off_mm: joined_mm(
            all.off
                .iter()
                .zip(plan.z_mm().windows(2))
                .filter(|&(&rays, _)| area_mm2(rays) >= LEAST_OFF_MM2)
                .map(|(_, ends)| [ends[0], ends[1]]),
        ),
        closed_gaps_mm2: area_mm2(all.closed),
        thin_at_mm: at_mm(all.thin_at),
        closed_at_mm: at_mm(all.closed_at),
    }))
}

/// Ranges of heights in ascending order, those that touch as one.
fn joined_mm(ranges_mm: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let mut joined: Vec<[f64; 2]> = Vec::new();
    for [low_mm, high_mm] in ranges_mm {
        match joined.last_mut() {
            Some(last) if low_mm <= last[1] => last[1] = last[1].max(high_mm),
            _ => joined.push([low_mm, high_mm]),
        }
    }
    joined
}

impl BottomErrors {
    pub(crate) fn largest(self, other: Self) -> Self {
        Self {
            largest_mm: self.largest_mm.max(other.largest_mm),
            mean_mm: self.mean_mm.max(other.mean_mm),
        }
    }
}

impl PrintThroughReport {
    /// The same for several copies.
    pub(crate) fn of_copies(self, copies: usize) -> Self {
        Self {
            thin_roofs_mm2: self.thin_roofs_mm2 * copies as f64,
            closed_gaps_mm2: self.closed_gaps_mm2 * copies as f64,
            ..self
        }
    }

    /// The report of two models: areas add up, and the larger errors count.
    pub(crate) fn and(self, other: &Self) -> Self {
        let mut off_mm = [&self.off_mm[..], &other.off_mm].concat();
        off_mm.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Self {
            off_mm: joined_mm(off_mm.into_iter()),
            before: self.before.largest(other.before),
            after: self.after.largest(other.after),
            within: self.within.largest(other.within),
            thin_roofs_mm2: self.thin_roofs_mm2 + other.thin_roofs_mm2,
            thin_roofs_mm: self.thin_roofs_mm.max(other.thin_roofs_mm),
            closed_gaps_mm2: self.closed_gaps_mm2 + other.closed_gaps_mm2,
            thin_at_mm: if self.thin_roofs_mm2 > 0.0 {
                self.thin_at_mm
            } else {
                other.thin_at_mm
            },
            closed_at_mm: if self.closed_gaps_mm2 > 0.0 {
                self.closed_at_mm
            } else {
                other.closed_at_mm
            },
        }
    }

    /// The warnings about what compensation cannot mend.
    pub(crate) fn warnings(&self) -> Vec<Warning> {
        let mut warnings = Vec::new();
        if self.thin_roofs_mm2 >= LEAST_MM2 {
            warnings.push(Warning::ThinRoofs {
                area_mm2: self.thin_roofs_mm2,
                deep_mm: self.thin_roofs_mm,
                at_mm: self.thin_at_mm,
            });
        }
        if self.closed_gaps_mm2 >= LEAST_MM2 {
            warnings.push(Warning::ClosedGaps {
                area_mm2: self.closed_gaps_mm2,
                at_mm: self.closed_at_mm,
            });
        }
        warnings
    }
}

/// Kinds of places that compensation cannot mend.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Unmended {
    /// The layer of a thin roof.
    Roof,
    /// The dark layers of a gap that closes.
    Gap,
}

/// These places along rays.
struct UnmendedRanges<'a> {
    kind: Unmended,
    entries: &'a Entries<'a>,
    cure: &'a Cure,
}

impl LitRanges for UnmendedRanges<'_> {
    fn of_ray(
        &self,
        hits: &[Hit],
        classes: FacetClasses,
        column: &mut Column,
        mut emit: impl FnMut(u32, u32),
    ) {
        let (cure, parts) = (self.cure, self.entries.parts);
        let mut light = None;
        let mut pass = |range: &CuredRange| {
            let first = range.lit.first;
            if first >= range.lit.end {
                return;
            }
            let bottom_mm = cure.bottom_mm(range.lit, light);
            let layers = match (self.kind, range.below) {
                (Unmended::Roof, _) if range.is_thin(cure, bottom_mm) => first..first + 1,
                // A gap within one layer is in the one below the roof's.
                (Unmended::Gap, Some(below)) if range.closes_gap(cure, bottom_mm) => {
                    below.min(first - 1)..first
                }
                _ => 0..0,
            };
            emit(layers.start as u32 * parts, layers.end as u32 * parts);
            if let Some(end) = range.below {
                light = cure.light_below(range.lit, light, end);
            }
        };
        each_range(self.entries, cure, hits, classes, column, &mut pass);
    }
}

/// [`Entries::each_cured`], compiled once for those that need not be as quick as masks.
fn each_range(
    entries: &Entries<'_>,
    cure: &Cure,
    hits: &[Hit],
    classes: FacetClasses,
    column: &mut Column,
    emit: &mut dyn FnMut(&CuredRange),
) {
    entries.each_cured(cure, hits, classes, column, emit);
}

impl Masks {
    /// The places that compensation for a cure cannot mend, as masks of their own: roofs so thin that their last layer alone cures too
    /// deep, and gaps that light through their roof closes. `None` if masks make up for a constant distance.
    ///
    /// Cost: twice linear in hits.
    pub(crate) fn unmended(
        image: &RayRows<'_>,
        plan: &Plan,
        grid: &Grid,
        samples: Samples,
        raise: &Raise,
    ) -> Option<[Self; 2]> {
        let Raise::Cured { cure, .. } = raise else {
            return None;
        };
        let sublayer_of = SublayerOf::new(plan, samples.sublayers);
        let entries = Entries {
            sublayer_of: &sublayer_of,
            parts: samples.sublayers,
            raise,
        };
        let place = Place::new(&image.grid, grid, samples, Side::Above);
        Some([Unmended::Roof, Unmended::Gap].map(|kind| {
            let ranges = UnmendedRanges {
                kind,
                entries: &entries,
                cure,
            };
            Self::of_bands(plan.layers(), grid, samples, &place, |rows, changes| {
                of_rays(image, samples, &place, &ranges, rows, |change| {
                    change.join(changes);
                });
            })
        }))
    }
}

/// Light on its way down a ray, under each cure.
#[derive(Default)]
struct Lights {
    before: Option<Light>,
    after: Option<Light>,
    others: [Option<Light>; MOST_CURES],
}

impl Lights {
    fn pass(
        &mut self,
        ray: usize,
        range: &CuredRange,
        cure: &Cure,
        others: &[Cure],
        tolerance_mm: Option<f64>,
        tally: &mut Tally,
    ) {
        let CuredRange { lit, z_mm, .. } = *range;
        let LitRange { first, end, .. } = lit;
        if first >= end {
            return;
        }
        let unraised = LitRange::white(range.unraised_layer, end);
        if range.is_raised {
            note(
                &mut tally.before,
                cure.bottom_mm(unraised, self.before) - z_mm,
            );
            let bottom_mm = cure.bottom_mm(lit, self.after);
            let error_mm = bottom_mm - z_mm;
            tally.rays += 1;
            let half_mm = 0.5 * cure.thickness_mm(first);
            if error_mm.abs() > tolerance_mm.unwrap_or(half_mm) {
                tally.off[range.unraised_layer] += 1;
            }
            if range.is_thin(cure, bottom_mm) {
                tally.thin += 1;
                tally.thin_at = tally.thin_at.or(Some((ray, z_mm)));
                tally.thin_mm = tally.thin_mm.max(-error_mm);
            } else {
                note(&mut tally.after, error_mm);
                for ((other, light), sums) in others.iter().zip(&self.others).zip(&mut tally.others)
                {
                    note(sums, other.bottom_mm(lit, *light) - z_mm);
                }
            }
            if range.closes_gap(cure, bottom_mm) {
                tally.closed += 1;
                tally.closed_at = tally.closed_at.or(Some((ray, bottom_mm)));
            }
        }
        let Some(end) = range.below else {
            return;
        };
        self.before = cure.light_below(unraised, self.before, end);
        self.after = cure.light_below(lit, self.after, end);
        for (other, light) in others.iter().zip(&mut self.others) {
            *light = other.light_below(lit, *light, end);
        }
    }
}
