//! The solid model that a hollow one was made of: would it hold a piece?

use glam::DVec2;

use crate::ldi::{Ldi, model_ranges};
use crate::plan::Plan;

/// Layers of a ray in which the model is solid.
#[derive(Clone, Copy)]
struct Stretch {
    ray: usize,
    /// Index of a hit of the ray, another one for each of its stretches.
    hit: usize,
    first: usize,
    /// The layer above the last.
    end: usize,
}

/// Returns true if the model without voids and supports stands on the plate below a point of a layer: if a way leads from there
/// through it, level or downward.
///
/// Cost: linear in the hits of what hangs together below the point.
pub(crate) fn stands_when_solid(ldi: &Ldi, plan: &Plan, at_mm: [f64; 3], layer: usize) -> bool {
    let grid = &ldi.grid;
    let [width, height] = [grid.width, grid.height].map(|side| side as usize);
    let at = grid.to_pixels(DVec2::new(at_mm[0], at_mm[1])).floor();
    let is_inside = |at: f64, side: usize| (0.0..side as f64).contains(&at);
    if !is_inside(at.x, width) || !is_inside(at.y, height) {
        return false;
    }
    let heights_mm = plan.middle_mm();
    let stretches_of = |ray: usize| {
        let mut stretches: Vec<Stretch> = Vec::new();
        model_ranges(ldi.ray(ray), ldi.classes, |z_in, z_out| {
            let [first, end] = [z_in, z_out]
                .map(|z_mm| heights_mm.partition_point(|&middle| middle < f64::from(z_mm)));
            match stretches.last_mut() {
                Some(last) if first <= last.end => last.end = end.max(last.end),
                _ if first < end => stretches.push(Stretch {
                    ray,
                    hit: ldi.offsets[ray] as usize + stretches.len(),
                    first,
                    end,
                }),
                _ => {}
            }
        });
        stretches
    };
    let ray = at.y as usize * width + at.x as usize;
    let start = stretches_of(ray)
        .into_iter()
        .find(|it| (it.first..it.end).contains(&layer));
    // One more than the highest layer of each stretch to which a way leads, by its hit.
    let mut levels = vec![0; ldi.hits.len()];
    let mut next: Vec<(Stretch, usize)> = start.map(|start| (start, layer)).into_iter().collect();
    while let Some((from, level)) = next.pop() {
        if from.first == 0 {
            return true;
        }
        let (column, row) = (from.ray % width, from.ray / width);
        let beside = [
            (column > 0).then(|| from.ray - 1),
            (column + 1 < width).then_some(from.ray + 1),
            (row > 0).then(|| from.ray - width),
            (row + 1 < height).then_some(from.ray + width),
        ];
        for to in beside.into_iter().flatten().flat_map(stretches_of) {
            if to.first > level || to.end <= from.first {
                continue;
            }
            let level = level.min(to.end - 1);
            if levels[to.hit] <= level {
                levels[to.hit] = level + 1;
                next.push((to, level));
            }
        }
    }
    false
}
