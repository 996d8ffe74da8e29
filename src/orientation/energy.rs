//! Energies of candidates (eq. 25), their local minima, and the best distinct candidates.
//!
//! ε of eq. 25 is the largest error of a layer, as in table 3. Plans keep it near the tolerance, so roughness and overhang separate
//! directions better and can take its place.

use glam::DVec3;

use super::directions::spacing;
use super::{Candidate, Cost, Exclusion, Metrics, Quality, Scale, SearchOptions};
use crate::argsort::argsort;

/// Maximum number of refinements.
const MINIMA: usize = 5;

/// Directions up to this many spacings apart are neighbours: the adjacent ones all around, but not those beyond them.
const NEIGHBOURS: f64 = 1.5;

/// Maximum number of best candidates.
const BEST: usize = 3;

/// Cosine of the minimum angle between distinct directions, 20°.
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
            Quality::Islands => metrics.islands as f64,
            Quality::Cups => metrics.cups_mm2,
            Quality::Supports => metrics.support_ml,
            Quality::Contacts => metrics.contact_mm2,
        };
        [cost, quality]
    }

    /// Returns the limit that an orientation exceeds, if any.
    fn exclusion(&self, metrics: &Metrics) -> Option<Exclusion> {
        let exceeds = |value: f64, most: Option<f64>| most.is_some_and(|most| value > most);
        if exceeds(metrics.overhang_mm2, self.most_overhang_mm2) {
            Some(Exclusion::Overhang)
        } else if self.most_islands.is_some_and(|most| metrics.islands > most) {
            Some(Exclusion::Islands)
        } else if exceeds(metrics.cups_mm2, self.most_cups_mm2) {
            Some(Exclusion::Cups)
        } else {
            None
        }
    }

    /// Excludes a candidate that exceeds a limit, and sets the energy of any other, relative to the largest terms of all
    /// candidates (eq. 25). Those that cannot be printed stay as they are.
    pub(crate) fn rate(&self, candidate: &mut Candidate, scale: &Scale) {
        candidate.energy = None;
        let Some(metrics) = &candidate.metrics else {
            return;
        };
        candidate.excluded = self.exclusion(metrics);
        if candidate.excluded.is_none() {
            let [cost, quality] = self.terms(metrics);
            let part = |value: f64, most: f64| if most > 0.0 { value / most } else { 0.0 };
            let quality = (1.0 - self.alpha) * part(quality, scale.quality);
            candidate.energy = Some(self.alpha * part(cost, scale.cost) + quality);
        }
    }
}

/// Sets the energies of candidates relative to the largest terms among them, and returns these terms.
pub(super) fn rate<'a>(
    candidates: impl IntoIterator<Item = &'a mut Candidate>,
    search: &SearchOptions,
) -> Scale {
    let mut candidates: Vec<&mut Candidate> = candidates.into_iter().collect();
    let mut scale = Scale {
        cost: 0.0,
        quality: 0.0,
    };
    for metrics in candidates.iter().filter_map(|it| it.metrics.as_ref()) {
        let [cost, quality] = search.terms(metrics);
        scale.cost = scale.cost.max(cost);
        scale.quality = scale.quality.max(quality);
    }
    for candidate in &mut candidates {
        search.rate(candidate, &scale);
    }
    scale
}

/// Indices of the local minima to refine, best first: rated candidates without a better neighbour, at most five. Among
/// neighbours of equal energy, only the first counts.
pub fn minima(candidates: &[Candidate], search: &SearchOptions) -> Vec<usize> {
    let reach = NEIGHBOURS * spacing(search.directions);
    // Neighbours are close in z, so only candidates in that range are compared.
    let z_of = |index: usize| candidates[index].direction[2];
    let mut order = argsort((0..candidates.len()).map(z_of));
    let energy_of = |index: usize| candidates[index].energy;
    order.retain(|&index| energy_of(index).is_some());
    let place = |index: usize| DVec3::from_array(candidates[index].direction);
    let is_minimum = |&(position, &index): &(usize, &usize)| {
        let key = (energy_of(index), index);
        let is_near = |other: &&usize| (z_of(**other) - z_of(index)).abs() <= reach;
        let below = order[..position].iter().rev().take_while(is_near);
        let above = order[position + 1..].iter().take_while(is_near);
        below.chain(above).all(|&other| {
            (place(other) - place(index)).length_squared() > reach * reach
                || key < (energy_of(other), other)
        })
    };
    let mut minima = vec![false; candidates.len()];
    for (_, &index) in order.iter().enumerate().filter(is_minimum) {
        minima[index] = true;
    }
    let minima: Vec<usize> = (0..minima.len()).filter(|&index| minima[index]).collect();
    let energy = |&index: &usize| energy_of(index).unwrap_or(f64::INFINITY);
    let best = argsort(minima.iter().map(energy)).into_iter();
    best.take(MINIMA).map(|place| minima[place]).collect()
}

/// The best refined candidates, best first and at least 20° apart: three at most.
pub(super) fn best(refined: &[Candidate]) -> Vec<Candidate> {
    let energies = refined
        .iter()
        .map(|candidate| candidate.energy.unwrap_or(f64::INFINITY));
    let mut best: Vec<Candidate> = Vec::with_capacity(BEST);
    for place in argsort(energies) {
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
