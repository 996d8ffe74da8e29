//! Shared by both backends: offsets from counts, hits from facets, and the order of hits within a ray.

use super::projection::{ProjectedFacet, Projection};
use super::{CHUNK_RAYS, Hit, LdiError};
use crate::grid::Grid;
use crate::parallel::map_in_groups;
use crate::progress::Progress;

/// Turns counts into offsets in place: on entry `offsets[i + 1]` is the number of hits of ray i, and
/// `offsets[0]` is 0.
///
/// # Errors
/// [`LdiError::OutOfMemory`] if there are more hits than an offset can count.
pub(super) fn accumulate(offsets: &mut [u32]) -> Result<(), LdiError> {
    let mut total = 0u64;
    for offset in offsets.iter_mut() {
        total += u64::from(*offset);
        *offset = total as u32;
    }
    if total > u64::from(u32::MAX) {
        return Err(out_of_memory(total));
    }
    Ok(())
}

/// Allocates `count` zeroed values, and returns an error where `Vec` would abort.
///
/// # Errors
/// [`LdiError::OutOfMemory`].
pub(super) fn zeroed<T: bytemuck::Zeroable>(count: usize) -> Result<Vec<T>, LdiError> {
    // The system's zero pages: the threads that fill them are the first to touch them.
    bytemuck::allocation::try_zeroed_vec(count).map_err(|()| out_of_memory(count as u64))
}

pub(super) fn out_of_memory(hits: u64) -> LdiError {
    LdiError::OutOfMemory {
        hits,
        needed_bytes: hits * size_of::<Hit>() as u64,
    }
}

/// Cuts `hits` into chunks of `chunk_rays` whole rays. Each chunk is the offsets of its rays, one more than
/// there are rays, and their hits.
pub(super) fn by_rays<'a>(
    offsets: &'a [u32],
    hits: &'a mut [Hit],
    chunk_rays: usize,
) -> Vec<(&'a [u32], &'a mut [Hit])> {
    let rays = offsets.len() - 1;
    let mut chunks = Vec::with_capacity(rays.div_ceil(chunk_rays));
    let mut rest = hits;
    for first in (0..rays).step_by(chunk_rays) {
        let offsets = &offsets[first..=(first + chunk_rays).min(rays)];
        let (chunk, others) = rest.split_at_mut((offsets[offsets.len() - 1] - offsets[0]) as usize);
        chunks.push((offsets, chunk));
        rest = others;
    }
    chunks
}

/// Computes the hits of all rays with `facets`, and sorts them within each ray. The facets are in compressed
/// rows, in any order within a ray.
///
/// # Errors
/// [`LdiError::OutOfMemory`], [`LdiError::Cancelled`].
pub(super) fn hits_of_facets(
    projection: &Projection<'_>,
    grid: &Grid,
    offsets: &[u32],
    facets: &[u32],
    progress: &mut Progress<'_>,
    range: [f64; 2],
) -> Result<Vec<Hit>, LdiError> {
    let mut hits: Vec<Hit> = zeroed(facets.len())?;
    map_in_groups(
        by_rays(offsets, &mut hits, CHUNK_RAYS)
            .into_iter()
            .enumerate(),
        |(chunk, (offsets, hits))| {
            let mut recent = RecentFacets::new(projection);
            let base = offsets[0];
            for (index, ray) in offsets.windows(2).enumerate() {
                let ray_index = (chunk * CHUNK_RAYS + index) as u32;
                let (column, row) = (ray_index % grid.width, ray_index / grid.width);
                let places = (ray[0] - base) as usize..(ray[1] - base) as usize;
                let facets = &facets[ray[0] as usize..ray[1] as usize];
                for (hit, &index) in hits[places].iter_mut().zip(facets) {
                    if let Some(facet) = recent.get(index) {
                        *hit = Hit::new(facet.heights(row).at(column), index, facet.faces_up);
                    }
                }
            }
            sort_rays(offsets, hits);
        },
        |()| Ok::<_, LdiError>(()),
        progress,
        range,
    )?;
    Ok(hits)
}

/// A direct-mapped cache of projected facets: neighbouring rays usually meet the same ones.
struct RecentFacets<'a> {
    projection: &'a Projection<'a>,
    slots: Vec<(u32, Option<ProjectedFacet>)>,
}

impl<'a> RecentFacets<'a> {
    const SLOTS: usize = 256;

    fn new(projection: &'a Projection<'a>) -> Self {
        Self {
            projection,
            slots: vec![(u32::MAX, None); Self::SLOTS],
        }
    }

    fn get(&mut self, facet: u32) -> Option<&ProjectedFacet> {
        let slot = &mut self.slots[facet as usize % Self::SLOTS];
        if slot.0 != facet {
            *slot = (facet, self.projection.facet(facet as usize));
        }
        slot.1.as_ref()
    }
}

/// Sorts the hits of each of some consecutive rays. `hits` begins with the hit at `offsets[0]`.
pub(super) fn sort_rays(offsets: &[u32], hits: &mut [Hit]) {
    let base = offsets[0];
    for ray in offsets.windows(2) {
        sort_ray(&mut hits[(ray[0] - base) as usize..(ray[1] - base) as usize]);
    }
}

/// Sorts the hits of a ray. Most rays have two or four.
#[inline]
pub(super) fn sort_ray(ray: &mut [Hit]) {
    match ray {
        [] | [_] => {}
        [a, b] => sort_two(a, b),
        [a, b, c, d] => {
            sort_two(a, b);
            sort_two(c, d);
            sort_two(a, c);
            sort_two(b, d);
            sort_two(b, c);
        }
        _ => ray.sort_unstable_by_key(|hit| hit.key()),
    }
}

/// Sorts two hits without a branch, which no processor could predict.
#[inline]
fn sort_two(low: &mut Hit, high: &mut Hit) {
    let keys = [low.key(), high.key()];
    *low = Hit::of_key(keys[0].min(keys[1]));
    *high = Hit::of_key(keys[0].max(keys[1]));
}
