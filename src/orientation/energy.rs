//! Energies of directions (eq. 25), their local minima, finer searches around these, and the best that differ.

use glam::DVec3;

use super::directions::{around, spacing};
use super::order::ascending;
use super::{Candidate, Cost, Metrics, Quality, Rating, Scale, SearchOptions};
use crate::parallel;

/// Finer searches at most.
const MINIMA: usize = 5;

/// Distance in spacings up to which directions are neighbours: the next ones all around, and not those behind them.
const NEIGHBOURS: f64 = 1.5;

/// A finer search ends when its steps are smaller than this, in radians: 0.2°.
const FINEST: f64 = 0.0035;

/// Measurements of a finer search at most.
const MEASUREMENTS: usize = 60;

/// How many directions are shown as the best.
const BEST: usize = 3;

/// The cosine of the angle from which on directions are different choices: 20°.
const DISTINCT: f64 = 0.939_692_620_785_908_4;

impl SearchOptions {
    fn terms(&self, metrics: &Metrics) -> [f64; 2] {
        let cost = match self.cost {
            Cost::Layers => metrics.layers as f64,
            Cost::Time => metrics.print_time_s,
        };
        let quality = match self.quality {
            Quality::Error => metrics.max_error,
            Quality::Roughness => metrics.roughness_mm,
            Quality::Overhang => metrics.overhang_mm2,
        };
        [cost, quality]
    }

    /// The energy of a candidate, relative to what all have at most (eq. 25).
    pub(crate) fn energy(&self, candidate: &Candidate, scale: &Scale) -> Option<f64> {
        let [cost, quality] = self.terms(candidate.metrics.as_ref()?);
        let part = |value: f64, most: f64| if most > 0.0 { value / most } else { 0.0 };
        Some(
            self.alpha * part(cost, scale.cost) + (1.0 - self.alpha) * part(quality, scale.quality),
        )
    }
}

/// The energies of candidates, relative to those that are there: of all directions of a search, or of those that have been
/// measured so far.
pub fn rate(candidates: &[Candidate], search: &SearchOptions) -> Rating {
    let mut scale = Scale {
        cost: 0.0,
        quality: 0.0,
    };
    for metrics in candidates.iter().filter_map(|it| it.metrics.as_ref()) {
        let [cost, quality] = search.terms(metrics);
        scale.cost = scale.cost.max(cost);
        scale.quality = scale.quality.max(quality);
    }
    let energies: Vec<Option<f64>> = candidates
        .iter()
        .map(|candidate| search.energy(candidate, &scale))
        .collect();
    Rating {
        minima: minima(candidates, &energies, search),
        energies,
        scale,
    }
}

/// Candidates with no better neighbour, the best first; of equal neighbours the first one stands for all.
fn minima(
    candidates: &[Candidate],
    energies: &[Option<f64>],
    search: &SearchOptions,
) -> Vec<usize> {
    let reach = NEIGHBOURS * spacing(search.directions);
    // Neighbours are near in z: they are looked for among those only.
    let z_of = |index: usize| candidates[index].direction[2];
    let mut order = ascending((0..candidates.len()).map(z_of));
    order.retain(|&index| energies[index].is_some());
    let place = |index: usize| DVec3::from_array(candidates[index].direction);
    let is_minimum = |&(position, &index): &(usize, &usize)| {
        let key = (energies[index], index);
        let is_near = |other: &&usize| (z_of(**other) - z_of(index)).abs() <= reach;
        let below = order[..position].iter().rev().take_while(is_near);
        let above = order[position + 1..].iter().take_while(is_near);
        below.chain(above).all(|&other| {
            (place(other) - place(index)).length_squared() > reach * reach
                || key < (energies[other], other)
        })
    };
    let mut minima: Vec<usize> = order
        .iter()
        .enumerate()
        .filter(is_minimum)
        .map(|(_, &index)| index)
        .collect();
    minima.sort_unstable();
    let energy = |&index: &usize| energies[index].unwrap_or(f64::INFINITY);
    let best = ascending(minima.iter().map(energy)).into_iter();
    best.take(MINIMA).map(|place| minima[place]).collect()
}

/// Searches around a candidate in ever smaller steps, from half the spacing of the first look down, and returns the best that
/// it meets, rated. `measure` gives the candidate of a direction.
pub fn refine(
    candidate: &Candidate,
    search: &SearchOptions,
    scale: &Scale,
    measure: impl Fn([f64; 3]) -> Candidate + Sync,
) -> Candidate {
    let energy = |candidate: &Candidate| search.energy(candidate, scale);
    let mut best = candidate.clone();
    best.energy = energy(&best);
    let mut step = spacing(search.directions) / 2.0;
    let mut measured = 0;
    while step >= FINEST && measured < MEASUREMENTS {
        let mut better = None;
        let ring = around(DVec3::from_array(best.direction), step);
        for mut found in parallel::map(ring.map(|it| it.to_array()).to_vec(), &measure) {
            found.energy = energy(&found);
            measured += 1;
            let least = better.as_ref().unwrap_or(&best).energy;
            if found
                .energy
                .is_some_and(|energy| least.is_none_or(|least| energy < least))
            {
                better = Some(found);
            }
        }
        match better {
            Some(better) => best = better,
            None => step /= 2.0,
        }
    }
    best
}

/// The best of the candidates that finer searches found, and the best of those that are at least 20° away from it and from each
/// other: three at most.
pub fn best(refined: &[Candidate]) -> Vec<Candidate> {
    let energies = refined
        .iter()
        .map(|candidate| candidate.energy.unwrap_or(f64::INFINITY));
    let mut best: Vec<Candidate> = Vec::with_capacity(BEST);
    for place in ascending(energies) {
        let candidate = &refined[place];
        let direction = DVec3::from_array(candidate.direction);
        let is_new =
            |other: &Candidate| direction.dot(DVec3::from_array(other.direction)) < DISTINCT;
        if best.len() < BEST && candidate.energy.is_some() && best.iter().all(is_new) {
            best.push(candidate.clone());
        }
    }
    best
}
