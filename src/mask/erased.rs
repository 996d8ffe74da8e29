//! Parts of masks that compensation erases.
//!
//! Erosion takes a rim away, and moving downward surfaces up takes away everything that is thinner than that
//! distance; the print grows back over it from the part that stays lit. A part that lies farther from all lit pixels of
//! its layer is lost. Such parts are found as masks are compensated, row by row, without a mask.

use std::ops::Range;

use super::compensated::{Compensated, Part, ROWS_AT_ONCE, Rows};
use super::entries::{Column, Raise};
use super::samples::SublayerOf;
use super::step::{Disc, Step, Stretch, without};
use super::{Compensations, Samples};
use crate::ldi::RayRows;
use crate::parallel;
use crate::plan::Plan;
use crate::progress::{Cancelled, Progress};

/// Distance from the remaining lit area at which a part is lost, as a multiple of the distance taken away in x and y:
/// the tip of a corner of 60° is that far from the rest of it.
const REACH_XY: f64 = 2.0;

/// The same along z: the edge of a wedge that rises by 19°, below which surfaces need supports.
const REACH_Z: f64 = 3.0;

/// Less than this in a layer is left out, as less than a resin printer holds: the smallest island of checks, too.
const LEAST_MM2: f64 = 0.01;

/// Rows of a band.
const BAND_ROWS: usize = 128;

/// The area of each layer that compensation erases, in square millimetres, up to the last layer of which it erases any; with several
/// heights in a layer, the largest of theirs.
///
/// Cost: nothing without erosion; otherwise that of masks, up to the last layer that is eroded.
///
/// # Errors
/// [`Cancelled`].
pub(crate) fn erased_mm2(
    image: &RayRows<'_>,
    plan: &Plan,
    samples: Samples,
    compensations: &Compensations,
    progress: &mut Progress<'_>,
) -> Result<Vec<f64>, Cancelled> {
    let sublayer_of = SublayerOf::new(plan, samples.sublayers);
    let compensated = Compensated {
        image,
        sublayer_of: &sublayer_of,
        compensations,
        parts: samples.sublayers,
        rays: image.grid,
        offset: [0, 0],
    };
    let steps = compensated.steps();
    let height = image.grid.height as usize;
    let rows = (0..height).step_by(BAND_ROWS);
    let rows: Vec<Range<usize>> = rows.map(|row| row..(row + BAND_ROWS).min(height)).collect();
    let last = if takes_all_of_a_stretch(&compensated, &rows) {
        Some(steps.len() - 1)
    } else {
        steps.iter().rposition(Step::takes)
    };
    let Some(last) = last else {
        return Ok(Vec::new());
    };
    let layers = last + 1;
    let mut sums = vec![0; layers * samples.sublayers as usize];
    parallel::map_in_groups(
        rows.into_iter(),
        |rows| erased(&compensated, &steps[..layers], rows),
        |counts| {
            for (sum, count) in sums.iter_mut().zip(counts) {
                *sum += count;
            }
            Ok::<_, Cancelled>(())
        },
        progress,
        [0.0, 1.0],
    )?;
    let ray_mm2 = image.grid.pixel_mm2();
    let of_layers = sums.chunks(samples.sublayers as usize);
    let mut areas_mm2: Vec<f64> = of_layers
        .map(|counts| counts.iter().copied().max().unwrap_or(0))
        .map(|rays: u64| rays as f64 * ray_mm2)
        .map(|area_mm2| if area_mm2 < LEAST_MM2 { 0.0 } else { area_mm2 })
        .collect();
    let end = areas_mm2.iter().rposition(|&area_mm2| area_mm2 > 0.0);
    areas_mm2.truncate(end.map_or(0, |layer| layer + 1));
    Ok(areas_mm2)
}

/// Returns true if nothing is left of any stretch along a ray where surfaces that face down move up.
fn takes_all_of_a_stretch(compensated: &Compensated<'_>, bands: &[Range<usize>]) -> bool {
    if raised_mm(compensated) == 0.0 {
        return false;
    }
    let (image, entries) = (compensated.image, compensated.entries());
    let found = parallel::map(bands.to_vec(), |rows| {
        let mut found = false;
        let mut ranges = Column::new();
        for first in rows.clone().step_by(ROWS_AT_ONCE as usize) {
            let end = (first + ROWS_AT_ONCE as usize).min(rows.end);
            for hits in image.of(first as u32..end as u32).rays().each() {
                entries.each(hits, image.classes, &mut ranges, |on, off, unraised| {
                    found |= unraised < off && off <= on;
                });
            }
        }
        found
    });
    found.contains(&true)
}

/// Distance by which all surfaces that face down move up. Where compensation follows the cure, a layer of each range stays lit.
fn raised_mm(compensated: &Compensated<'_>) -> f64 {
    match compensated.compensations.raise {
        Raise::By(distance_mm) => distance_mm,
        Raise::Cured { .. } => 0.0,
    }
}

/// The number of rays that are erased in a band of rows at each sublayer of some layers.
fn erased(compensated: &Compensated<'_>, steps: &[Step], rows: Range<usize>) -> Vec<u64> {
    let reaches: Vec<Disc> = steps
        .iter()
        .map(|step| reach_of(compensated, step))
        .collect();
    let halo = reaches.iter().map(Disc::rows).max().unwrap_or(0) as usize;
    let wide =
        rows.start.saturating_sub(halo)..(rows.end + halo).min(compensated.rays.height as usize);
    let around = compensated.around(&wide, steps);
    let mut source = Rows::new(compensated, around.clone(), Part::Raised);
    let mut whole = Rows::new(compensated, around, Part::Whole);
    let width = compensated.rays.width as i32;
    let mut lit: Vec<Vec<Stretch>> = vec![Vec::new(); wide.len()];
    let mut of_rows = vec![0; rows.len()];
    let mut last_step = None;
    let mut counts = Vec::new();
    for (layer, step) in steps.iter().enumerate() {
        let is_new_step = last_step != Some(step);
        last_step = Some(step);
        for part in 0..compensated.parts {
            let sublayer = layer as u32 * compensated.parts + part;
            let mut changed = source.advance(sublayer);
            let is_all_new = is_new_step && part == 0;
            for (lit, row) in lit.iter_mut().zip(wide.clone()) {
                if is_all_new || is_near(&changed, row, step.reach()) {
                    *lit = step.row(&source, row as i32, width);
                }
            }
            changed.extend(whole.advance(sublayer));
            let reach = &reaches[layer];
            let far = step.reach() + reach.rows();
            for (count, row) in of_rows.iter_mut().zip(rows.clone()) {
                if is_all_new || is_near(&changed, row, far) {
                    *count = far_from(&lit, wide.start, reach, row, whole.row(row as i32));
                }
            }
            counts.push(of_rows.iter().sum());
        }
    }
    counts
}

/// The disc that what stays lit is grown by.
fn reach_of(compensated: &Compensated<'_>, step: &Step) -> Disc {
    let reach_mm = REACH_XY * step.taken_mm() + REACH_Z * raised_mm(compensated);
    Disc::new(reach_mm, &compensated.rays)
}

/// Returns true if a row is within a reach of any of some.
fn is_near(changed: &[i32], row: usize, reach: i32) -> bool {
    changed.iter().any(|it| (it - row as i32).abs() <= reach)
}

/// The number of rays of a row that are out of reach of all that is lit, given the lit stretches of rows from `first` on.
fn far_from(
    lit: &[Vec<Stretch>],
    first: usize,
    reach: &Disc,
    row: usize,
    stretches: &[Stretch],
) -> u64 {
    let mut far = stretches.to_vec();
    for step in 0..=reach.rows() {
        let half_width = reach.half_width(step);
        for row in [row as i32 - step, row as i32 + step] {
            if far.is_empty() {
                return 0;
            }
            let place = usize::try_from(row - first as i32).ok();
            if let Some(lit) = place.and_then(|place| lit.get(place)) {
                far = without(&far, lit, half_width);
            }
        }
    }
    far.iter().map(|it| (it.end - it.start) as u64).sum()
}
