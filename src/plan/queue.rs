//! The planes that a layer may begin at, for errors that never shrink as a layer grows: what replaces the inner loop of Procedure 1.
//!
//! The lowest plane within tolerance only moves up. A plane is obsolete once a higher one has neither a higher cost nor, at equal cost, a
//! larger error. The candidates that remain increase upward in cost, then in error.
//!
//! Among the candidates of the least cost, the error below the candidate increases upward and that of the layer on top decreases. The
//! best candidate is where the two cross, and that place also only moves up.

/// Candidates that no layer can begin at any more, before they leave the queue.
const PASSED: usize = 512;

/// A plane that may be the best one below some later plane.
#[derive(Clone, Copy)]
pub(super) struct Candidate<Cost, Mark> {
    pub plane: u32,
    /// Cost of the layers below. A layer on top adds the same cost to all candidates of the least cost.
    pub cost: Cost,
    /// The smallest maximum error of the layers below, in steps.
    pub worst: u64,
    /// Data from which errors of layers on top are computed.
    pub mark: Mark,
}

/// The candidates, from the lowest up.
pub(super) struct Queue<Cost, Mark> {
    candidates: Vec<Candidate<Cost, Mark>>,
    /// The lowest one that a layer can begin at.
    front: usize,
    /// The best one of the least cost, or the one before it.
    best: usize,
}

impl<Cost: Copy + Ord, Mark: Copy> Queue<Cost, Mark> {
    pub fn new() -> Self {
        Self {
            candidates: Vec::new(),
            front: 0,
            best: 0,
        }
    }

    pub fn clear(&mut self) {
        self.candidates.clear();
        (self.front, self.best) = (0, 0);
    }

    /// Adds a candidate above all others.
    #[inline]
    pub fn push(&mut self, candidate: Candidate<Cost, Mark>) {
        // So that the queue stays in the cache.
        if self.front >= PASSED {
            self.candidates.drain(..self.front);
            self.best -= self.front;
            self.front = 0;
        }
        while self.candidates.len() > self.front
            && self
                .candidates
                .last()
                .is_some_and(|last| (last.cost, last.worst) >= (candidate.cost, candidate.worst))
        {
            self.candidates.pop();
        }
        if self.best >= self.candidates.len() {
            self.best = self.candidates.len().saturating_sub(1).max(self.front);
        }
        self.candidates.push(candidate);
    }

    /// The best candidate below a plane, as its cost, its plane, and the smallest maximum error with the layer on top. The plane is above
    /// those of all calls before. `is_passed` returns true if the layer from a candidate is too thick or beyond
    /// tolerance; `error_from` returns its error in steps.
    #[inline]
    pub fn best(
        &mut self,
        is_passed: impl Fn(&Candidate<Cost, Mark>) -> bool,
        error_from: impl Fn(&Candidate<Cost, Mark>) -> u64,
    ) -> Option<(Cost, u32, u64)> {
        while self.candidates.get(self.front).is_some_and(&is_passed) {
            self.front += 1;
        }
        self.best = self.best.max(self.front);
        let cost = self.candidates.get(self.front)?.cost;
        let is_better =
            |next: &Candidate<Cost, Mark>| next.cost == cost && next.worst <= error_from(next);
        while self.candidates.get(self.best + 1).is_some_and(is_better) {
            self.best += 1;
        }
        let worst_over = |below: &Candidate<Cost, Mark>| below.worst.max(error_from(below));
        let best = &self.candidates[self.best];
        let (mut plane, mut worst) = (best.plane, worst_over(best));
        if let Some(next) = self.candidates.get(self.best + 1)
            && next.cost == cost
            && worst_over(next) < worst
        {
            (plane, worst) = (next.plane, worst_over(next));
        }
        Some((cost, plane, worst))
    }
}
