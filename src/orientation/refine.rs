//! Refinement of a local minimum: rings of directions, in ever smaller steps.

use glam::DVec3;

use super::directions::{around, spacing};
use super::{Candidate, SearchOptions, Terms};

/// A refinement ends when its step is smaller than this, in radians: 0.2°.
const FINEST: f64 = 0.0035;

/// Number of measurements after which a refinement ends.
const MEASUREMENTS: usize = 60;

/// A refinement in progress. The next ring lies around the best candidate so far.
#[derive(Debug, Clone)]
pub(super) struct Refinement {
    pub best: Candidate,
    step: f64,
    measured: usize,
}

impl Refinement {
    /// Starts at a rated candidate, with a step of half the spacing of the first pass.
    pub fn new(start: Candidate, options: &SearchOptions) -> Self {
        Self {
            best: start,
            step: spacing(options.directions) / 2.0,
            measured: 0,
        }
    }

    /// The directions to measure next.
    pub fn ring(&self) -> Vec<[f64; 3]> {
        let ring = around(DVec3::from_array(self.best.direction), self.step);
        ring.map(|it| it.to_array()).to_vec()
    }

    /// Moves to the best candidate of the ring, or halves the step if none is better.
    pub fn accept(&mut self, ring: Vec<Candidate>, options: &SearchOptions, scale: &Terms) {
        let mut better: Option<Candidate> = None;
        for mut found in ring {
            options.rate(&mut found, scale);
            self.measured += 1;
            let least = better.as_ref().unwrap_or(&self.best).energy;
            if found
                .energy
                .is_some_and(|energy| least.is_none_or(|least| energy < least))
            {
                better = Some(found);
            }
        }
        match better {
            Some(better) => self.best = better,
            None => self.step /= 2.0,
        }
    }

    pub fn is_done(&self) -> bool {
        self.step < FINEST || self.measured >= MEASUREMENTS
    }

    /// Progress, 0 to 1, relative to the maximum number of measurements.
    pub fn progress(&self) -> f64 {
        if self.is_done() {
            1.0
        } else {
            self.measured as f64 / MEASUREMENTS as f64
        }
    }
}
