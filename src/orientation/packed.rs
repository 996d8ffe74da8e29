//! Candidates as numbers. Workers of a browser exchange them thousands of times, and objects take it ten times as long.

use super::{Candidate, Exclusion, Metrics};

/// Numbers per candidate: its direction, rotation and size, its energy, why it is excluded, and its metrics, in the
/// order of their fields. Absent values are NaN; a candidate whose direction is not measured is all NaN.
pub const NUMBERS: usize = 3 + 4 + 3 + 1 + 1 + METRICS;

/// Numbers of metrics.
const METRICS: usize = 9;

/// Exclusions by number, from 1; 0 is for none. The page has the same list: `www/src/api/candidates.ts`.
const EXCLUSIONS: [Exclusion; 6] = [
    Exclusion::TooLarge,
    Exclusion::TooHigh,
    Exclusion::NoPlan,
    Exclusion::Overhang,
    Exclusion::Islands,
    Exclusion::Cups,
];

/// Candidates as numbers, [`NUMBERS`] each.
pub fn pack<'a>(candidates: impl ExactSizeIterator<Item = Option<&'a Candidate>>) -> Vec<f64> {
    let mut numbers = vec![f64::NAN; NUMBERS * candidates.len()];
    let (places, _) = numbers.as_chunks_mut::<NUMBERS>();
    for (place, candidate) in places.iter_mut().zip(candidates) {
        let Some(candidate) = candidate else { continue };
        place[..3].copy_from_slice(&candidate.direction);
        place[3..7].copy_from_slice(&candidate.rotation);
        place[7..10].copy_from_slice(&candidate.size_mm);
        place[10] = candidate.energy.unwrap_or(f64::NAN);
        let number = |it| EXCLUSIONS.iter().position(|&other| other == it);
        place[11] = candidate
            .excluded
            .and_then(number)
            .map_or(0.0, |place| place as f64 + 1.0);
        if let Some(metrics) = &candidate.metrics {
            place[12..].copy_from_slice(&[
                metrics.layers as f64,
                metrics.print_time_s,
                metrics.max_error,
                metrics.roughness_mm,
                metrics.overhang_mm2,
                metrics.islands as f64,
                metrics.cups_mm2,
                metrics.support_ml,
                metrics.contact_mm2,
            ]);
        }
    }
    numbers
}

/// Candidates from their numbers. An incomplete candidate is left out.
pub fn unpack(numbers: &[f64]) -> Vec<Candidate> {
    let (places, _) = numbers.as_chunks::<NUMBERS>();
    let candidates = places.iter().map(|place| {
        let [
            d0,
            d1,
            d2,
            r0,
            r1,
            r2,
            r3,
            s0,
            s1,
            s2,
            energy,
            excluded,
            metrics @ ..,
        ] = *place;
        let [
            layers,
            print_time_s,
            max_error,
            roughness_mm,
            overhang_mm2,
            islands,
            cups_mm2,
            support_ml,
            contact_mm2,
        ]: [f64; METRICS] = metrics;
        Candidate {
            direction: [d0, d1, d2],
            rotation: [r0, r1, r2, r3],
            size_mm: [s0, s1, s2],
            excluded: EXCLUSIONS.get((excluded as usize).wrapping_sub(1)).copied(),
            metrics: (!layers.is_nan()).then_some(Metrics {
                layers: layers as usize,
                print_time_s,
                max_error,
                roughness_mm,
                overhang_mm2,
                islands: islands as usize,
                cups_mm2,
                support_ml,
                contact_mm2,
            }),
            energy: (!energy.is_nan()).then_some(energy),
        }
    });
    candidates.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn candidates_come_out_as_they_went_in() {
        let metrics = Metrics {
            layers: 12,
            print_time_s: 1.5,
            max_error: 0.25,
            roughness_mm: 0.01,
            overhang_mm2: 7.0,
            islands: 3,
            cups_mm2: 8.0,
            support_ml: 0.5,
            contact_mm2: 2.5,
        };
        let candidate = |excluded: Option<Exclusion>, has_metrics: bool| Candidate {
            direction: [0.0, 0.6, 0.8],
            rotation: [0.5, 0.5, 0.5, 0.5],
            size_mm: [1.0, 2.0, 3.0],
            excluded,
            metrics: has_metrics.then_some(metrics),
            energy: excluded.is_none().then_some(0.75),
        };
        let exclusions = EXCLUSIONS.into_iter().map(Some).chain([None]);
        let candidates: Vec<Candidate> = exclusions
            .map(|it| candidate(it, it.is_none_or(|it| !it.is_impossible())))
            .collect();
        let numbers = pack(candidates.iter().map(Some));
        assert_eq!(numbers.len(), NUMBERS * candidates.len());
        assert_eq!(unpack(&numbers), candidates);
        assert!(pack([None].into_iter()).iter().all(|it| it.is_nan()));
        assert_eq!(unpack(&numbers[1..]).len(), candidates.len() - 1);
    }
}
