//! Heights that deserve a plane (section 3.3): flats, so that they print at their true height, and sharp changes of the
//! profile.

use super::cusp::density_of;
use super::facet_bins::Flat;
use super::steepest::NO_SURFACE;
use crate::argsort::{argsort, sort_by_number};
use crate::grid::Bins;

/// A change is sharp if the cusp height densities of neighbouring bins differ by more than this.
pub const SHARP: f32 = 0.5;

/// The features of a model's surface that decide on snap planes.
#[derive(Debug, Clone, Copy)]
pub struct Surface<'a> {
    /// Its horizontal facets.
    pub flats: &'a [Flat],
    /// The largest `n_z²` of each bin; bins without surface have no density, so nothing changes there.
    pub steepest: &'a [f32],
}

/// Boundaries of bins that deserve a plane, the most important first: heights at which horizontal facets of a model have a total area of
/// at least `flat_area_mm2`, by area; then changes of a model's cusp height density by more than [`SHARP`], by size. Of several
/// models the largest area and the largest change count, so that neither copies nor other models make a plane.
pub fn snap_planes(surfaces: &[Surface<'_>], bins: Bins, flat_area_mm2: f64) -> Vec<u32> {
    raised_planes(surfaces, bins, flat_area_mm2, None)
}

/// The same where flats that face down have their planes where `raised` puts them: there light cures down to them. Their sharp changes have
/// none.
pub fn raised_planes(
    surfaces: &[Surface<'_>],
    bins: Bins,
    flat_area_mm2: f64,
    raised: Option<&dyn Fn(u32) -> u32>,
) -> Vec<u32> {
    let mut flats: Vec<(u32, f64)> = Vec::new();
    let mut sharp: Vec<(u32, f64)> = Vec::new();
    for surface in surfaces {
        let mut moved: Vec<u32> = Vec::new();
        let levels = match raised {
            None => levels(surface.flats, bins),
            Some(raised) => {
                let mut flats = surface.flats.to_vec();
                for flat in flats.iter_mut().filter(|flat| flat.faces_down) {
                    let boundary = raised(flat.boundary);
                    if boundary != flat.boundary {
                        moved.push(flat.boundary);
                        flat.boundary = boundary;
                    }
                }
                levels(&flats, bins)
            }
        };
        flats.extend(
            levels
                .into_iter()
                .filter(|&(_, area_mm2)| area_mm2 >= flat_area_mm2),
        );
        let changes = sharp_changes(surface.steepest, bins).into_iter();
        sharp.extend(changes.filter(|&(boundary, _)| {
            // A change lies at the flat, or a bin beside it.
            !(boundary.saturating_sub(1)..=boundary + 1).any(|it| moved.contains(&it))
        }));
    }
    if surfaces.len() > 1 {
        (flats, sharp) = (largest(&flats), largest(&sharp));
    }
    [largest_first(&flats), largest_first(&sharp)].concat()
}

/// The largest worth of each boundary, in ascending order of boundaries.
fn largest(boundaries: &[(u32, f64)]) -> Vec<(u32, f64)> {
    let order = argsort(boundaries.iter().map(|&(_, worth)| -worth));
    let mut largest: Vec<(u32, f64)> = order.into_iter().map(|place| boundaries[place]).collect();
    sort_by_number(&mut largest, |&(boundary, _)| f64::from(boundary));
    largest.dedup_by_key(|&mut (boundary, _)| boundary);
    largest
}

/// The boundaries at which the density of a model changes sharply, in ascending order, and by how much.
fn sharp_changes(steepest: &[f32], bins: Bins) -> Vec<(u32, f64)> {
    let changes = steepest.windows(2).zip(1u32..);
    let mut sharp: Vec<(u32, f64)> = changes
        // Spares the roots of most: sharp ones are at least 0.25 apart, rounding aside.
        .filter(|(pair, _)| (pair[1] - pair[0]).abs() > SHARP * SHARP / 2.0)
        .filter(|(pair, _)| !pair.contains(&NO_SURFACE))
        .map(|(pair, boundary)| (boundary, density_of(pair[1]) - density_of(pair[0])))
        .filter(|&(_, change)| change.abs() > SHARP)
        // A surface that begins at a boundary also lies in the bin below it.
        .map(|(boundary, change)| (boundary + u32::from(change > 0.0), f64::from(change.abs())))
        .filter(|&(boundary, _)| (boundary as usize) < bins.count)
        .collect();
    // A flat is both a rise and a fall.
    sharp.dedup_by_key(|&mut (boundary, _)| boundary);
    sharp
}

/// Boundaries in descending order of their worth, of equals the lowest first. They come in ascending order.
fn largest_first(boundaries: &[(u32, f64)]) -> Vec<u32> {
    let order = argsort(boundaries.iter().map(|&(_, worth)| -worth));
    order.into_iter().map(|place| boundaries[place].0).collect()
}

/// The boundaries nearest to horizontal facets, in ascending order, and the total area of those facets in mm².
fn levels(flats: &[Flat], bins: Bins) -> Vec<(u32, f64)> {
    let order = argsort(flats.iter().map(|flat| f64::from(flat.boundary)));
    let flats: Vec<Flat> = order.into_iter().map(|place| flats[place]).collect();
    flats
        .chunk_by(|a, b| a.boundary == b.boundary)
        .map(|level| {
            let area_mm2 = level.iter().map(|flat| flat.area_mm2).sum();
            (level[0].boundary, area_mm2)
        })
        .filter(|&(boundary, _)| boundary > 0 && (boundary as usize) < bins.count)
        .collect()
}
