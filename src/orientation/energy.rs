//! Energies of candidates (eq. 25), their local minima, and the best distinct candidates.
//!
//! ε of eq. 25 is the largest error of a layer, as in table 3. Plans keep it near the tolerance, so other terms separate directions
//! better: one can take its place, or a ranking weighs all.

use glam::DVec3;

use super::directions::spacing;
use super::{Candidate, Cost, Exclusion, Metrics, Quality, SearchOptions, Terms};
use crate::argsort::argsort;

/// Maximum number of refinements.
const MINIMA: usize = 5;

/// Directions up to this many spacings apart are neighbours: the adjacent ones all around, but not those beyond them.
const NEIGHBOURS: f64 = 1.5;

/// Maximum number of best candidates.
const BEST: usize = 3;

/// Cosine of the minimum angle between distinct directions, 20°.
const DISTINCT: f64 = 0.939_692_620_785_908_4;

impl Terms {
    /// The terms of a candidate that can be printed.
    fn of(metrics: &Metrics, height: f64) -> Self {
        Self {
            layers: metrics.layers as f64,
            time: metrics.print_time_s,
            error: metrics.max_error,
            roughness: metrics.roughness_mm,
            overhang: metrics.overhang_mm2,
            islands: metrics.islands as f64,
            cups: metrics.cups_mm2,
            supports: metrics.support_ml,
            contacts: metrics.contact_mm2,
            height,
        }
    }
}

impl SearchOptions {
    /// Weights of the terms, which add up to 1: those of the ranking, or α and 1 − α.
    fn weights(&self) -> Terms {
        if let Some(ranking) = self.ranking {
            let weights = ranking.to_array();
            let sum: f64 = weights.iter().sum();
            return Terms::from_array(weights.map(|it| if sum > 0.0 { it / sum } else { 0.0 }));
        }
        let mut weights = Terms::default();
        let cost = match self.cost {
            Cost::Layers => &mut weights.layers,
            Cost::Time => &mut weights.time,
        };
        *cost = self.alpha;
        let quality = match self.quality {
            Quality::Error => &mut weights.error,
            Quality::Roughness => &mut weights.roughness,
            Quality::Overhang => &mut weights.overhang,
            Quality::Islands => &mut weights.islands,
            Quality::Cups => &mut weights.cups,
            Quality::Supports => &mut weights.supports,
            Quality::Contacts => &mut weights.contacts,
        };
        *quality = 1.0 - self.alpha;
        weights
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
    pub(crate) fn rate(&self, candidate: &mut Candidate, scale: &Terms) {
        candidate.energy = None;
        let Some(metrics) = &candidate.metrics else {
            return;
        };
        candidate.excluded = self.exclusion(metrics);
        if candidate.excluded.is_none() {
            let terms = Terms::of(metrics, candidate.size_mm[2]).to_array();
            let weighted = terms
                .iter()
                .zip(scale.to_array())
                .zip(self.weights().to_array());
            let part = |value: f64, most: f64| if most > 0.0 { value / most } else { 0.0 };
            let energy = weighted.fold(0.0, |sum, ((&value, most), weight)| {
                sum + weight * part(value, most)
            });
            candidate.energy = Some(energy);
        }
    }
}

/// Sets the energies of candidates relative to the largest terms among them, and returns these terms.
pub(super) fn rate<'a>(
    candidates: impl IntoIterator<Item = &'a mut Candidate>,
    search: &SearchOptions,
) -> Terms {
    let mut candidates: Vec<&mut Candidate> = candidates.into_iter().collect();
    let mut scale = [0.0; Terms::NAMES.len()];
    for candidate in &candidates {
        let Some(metrics) = &candidate.metrics else {
            continue;
        };
        let terms = Terms::of(metrics, candidate.size_mm[2]).to_array();
        for (most, value) in scale.iter_mut().zip(terms) {
            *most = f64::max(*most, value);
        }
    }
    let scale = Terms::from_array(scale);
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
