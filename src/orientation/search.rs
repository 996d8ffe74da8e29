//! The search as a state machine: it hands out tasks, accepts their results in any order, and returns the result at the end.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};
#[cfg(target_arch = "wasm32")]
use tsify::Tsify;

use super::energy::{best, minima, rate};
use super::refine::Refinement;
use super::shard::Shard;
use super::{Candidate, SearchError, SearchOptions, Terms};

/// Directions per task of the first pass: few enough for all workers to finish together, and enough to be worth a message.
const CHUNK: usize = 8;

/// Approximate share of the time that refinements take.
const REFINEMENT: f64 = 0.2;

/// Directions to measure, on any thread, worker or machine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(Tsify))]
pub struct Task {
    /// Identifies the task. Its result has the same number.
    pub number: usize,
    /// Unit vectors that point up from the plate, in the frame of the file.
    pub directions: Vec<[f64; 3]>,
}

/// The result of a task.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TaskResult {
    /// Number of the task.
    pub number: usize,
    /// One candidate per direction of the task, in the same order.
    pub candidates: Vec<Candidate>,
}

/// The result of a search.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SearchResult {
    /// See [`Search::best`].
    pub best: Vec<Candidate>,
    /// Reference values of energies.
    pub scale: Terms,
    /// The rated candidates of the first pass, one per direction.
    pub candidates: Vec<Candidate>,
}

/// Purpose of a task.
#[derive(Debug, Clone)]
enum Purpose {
    /// Measures the directions with these indices, in the first pass.
    Measure(Vec<usize>),
    /// Measures the next ring of the refinement with this index.
    Refine(usize),
}

/// A search for the best orientations. It measures nothing itself: threads, workers or machines run its tasks, in any number
/// and order, and the result is the same to the last bit.
///
/// The first pass measures all directions. Refinements then measure rings around the local minima of the energy (eq. 25);
/// each ring depends on the one before.
///
/// ```
/// # use cusp_slicer::orientation::{Candidate, Search, SearchOptions, Task, TaskResult};
/// fn run(mut search: Search, evaluate: impl Fn(Task) -> TaskResult) -> Option<Vec<Candidate>> {
///     while !search.is_done() {
///         for task in search.next_tasks(16) {
///             search.accept(evaluate(task)).ok()?;
///         }
///     }
///     Some(search.result()?.best)
/// }
/// ```
#[derive(Debug, Clone)]
pub struct Search {
    options: SearchOptions,
    directions: Vec<[f64; 3]>,
    /// The candidate of each direction, once measured; rated once all are.
    found: Vec<Option<Candidate>>,
    /// Number of directions measured so far, and number to measure.
    measured: [usize; 2],
    /// True if minima are refined. In a shard they are not, because it has only some of the directions.
    refines: bool,
    /// Tasks that are waiting to be handed out.
    waiting: VecDeque<Purpose>,
    /// Tasks that were handed out, by number. `None` once accepted or put back.
    out: Vec<Option<Purpose>>,
    /// Number of outstanding tasks.
    open: usize,
    /// Known once all directions are measured.
    rated: Option<Rated>,
}

/// Results of rating the candidates of the first pass.
#[derive(Debug, Clone)]
struct Rated {
    scale: Terms,
    refinements: Vec<Refinement>,
}

impl Search {
    /// A search over these directions.
    ///
    /// # Errors
    /// [`SearchError::Directions`], [`SearchError::Alpha`].
    pub fn new(options: SearchOptions, directions: Vec<[f64; 3]>) -> Result<Self, SearchError> {
        let whole = Shard {
            number: 1,
            count: 1,
        };
        Self::of(options, directions, whole, true)
    }

    /// A search that only measures the directions of a shard. It refines nothing, so its result has no best candidates.
    ///
    /// # Errors
    /// Those of [`Self::new`].
    pub fn of_shard(
        options: SearchOptions,
        directions: Vec<[f64; 3]>,
        shard: Shard,
    ) -> Result<Self, SearchError> {
        Self::of(options, directions, shard, false)
    }

    fn of(
        options: SearchOptions,
        directions: Vec<[f64; 3]>,
        shard: Shard,
        refines: bool,
    ) -> Result<Self, SearchError> {
        options.check()?;
        let places: Vec<usize> = shard.places(directions.len()).collect();
        // Each chunk covers the whole sphere, so that partial results do too.
        let chunks = places.len().div_ceil(CHUNK);
        let chunk = |first| places.iter().copied().skip(first).step_by(chunks).collect();
        let mut search = Self {
            options,
            found: vec![None; directions.len()],
            measured: [0, places.len()],
            refines,
            waiting: (0..chunks).map(chunk).map(Purpose::Measure).collect(),
            out: Vec::new(),
            open: 0,
            rated: None,
            directions,
        };
        search.rate_if_measured();
        Ok(search)
    }

    /// A search whose directions are already measured, in shards or by a search with other options. It rates these
    /// candidates and refines the minima.
    ///
    /// # Errors
    /// Those of [`Self::new`], and [`SearchError::Candidate`].
    pub fn of_measured(
        options: SearchOptions,
        candidates: Vec<Candidate>,
    ) -> Result<Self, SearchError> {
        if let Some(place) = candidates.iter().position(|it| !is_measured(it)) {
            return Err(SearchError::Candidate { place });
        }
        let directions = candidates.iter().map(|it| it.direction).collect();
        let mut search = Self::new(options, directions)?;
        search.waiting.clear();
        search.measured[0] = candidates.len();
        search.found = candidates.into_iter().map(Some).collect();
        search.rate_if_measured();
        Ok(search)
    }

    /// The options of the search.
    pub fn options(&self) -> &SearchOptions {
        &self.options
    }

    /// The directions of the first pass.
    pub fn directions(&self) -> &[[f64; 3]] {
        &self.directions
    }

    /// Number of directions that are measured.
    pub fn measured(&self) -> usize {
        self.measured[0]
    }

    /// Hands out up to `most` tasks. There are none while the next ones depend on outstanding results, and at the end: see
    /// [`Self::is_done`].
    pub fn next_tasks(&mut self, most: usize) -> Vec<Task> {
        let mut tasks = Vec::new();
        while tasks.len() < most
            && let Some(purpose) = self.waiting.pop_front()
        {
            tasks.push(Task {
                number: self.out.len(),
                directions: self.directions_of(&purpose),
            });
            self.out.push(Some(purpose));
            self.open += 1;
        }
        tasks
    }

    /// Accepts the result of an outstanding task. After an error the task is still outstanding.
    ///
    /// # Errors
    /// [`SearchError::Task`], [`SearchError::Candidate`].
    pub fn accept(&mut self, result: TaskResult) -> Result<(), SearchError> {
        let TaskResult { number, candidates } = result;
        let out = self.out.get(number).and_then(Option::as_ref);
        let directions = self.directions_of(out.ok_or(SearchError::Task { task: number })?);
        let is_good = |place: usize| {
            let candidate = candidates.get(place);
            candidate.is_some_and(|it| it.direction == directions[place] && is_measured(it))
        };
        let count = directions.len().max(candidates.len());
        let bad = (0..count).find(|&place| place >= directions.len() || !is_good(place));
        if let Some(place) = bad {
            return Err(SearchError::Candidate { place });
        }
        match self.take(number)? {
            Purpose::Measure(places) => {
                self.measured[0] += places.len();
                for (place, candidate) in places.into_iter().zip(candidates) {
                    self.found[place] = Some(candidate);
                }
                self.rate_if_measured();
            }
            Purpose::Refine(place) => {
                if let Some(rated) = &mut self.rated {
                    let refinement = &mut rated.refinements[place];
                    refinement.accept(candidates, &self.options, &rated.scale);
                    if !refinement.is_done() {
                        self.waiting.push_back(Purpose::Refine(place));
                    }
                }
            }
        }
        Ok(())
    }

    /// Puts back an outstanding task, for example after losing its worker. It is handed out again under another number.
    ///
    /// # Errors
    /// [`SearchError::Task`].
    pub fn put_back(&mut self, task: usize) -> Result<(), SearchError> {
        let lost = self.take(task)?;
        self.waiting.push_front(lost);
        Ok(())
    }

    /// Removes an outstanding task, and returns its purpose.
    fn take(&mut self, task: usize) -> Result<Purpose, SearchError> {
        let taken = self.out.get_mut(task).and_then(Option::take);
        let taken = taken.ok_or(SearchError::Task { task })?;
        self.open -= 1;
        Ok(taken)
    }

    /// Progress, 0 to 1. It never decreases.
    pub fn progress(&self) -> f64 {
        let [measured, total] = self.measured;
        let measured = measured as f64 / total.max(1) as f64;
        match &self.rated {
            None if self.refines => measured * (1.0 - REFINEMENT),
            None => measured,
            Some(Rated { refinements, .. }) => {
                let left = refinements.iter().map(|it| 1.0 - it.progress());
                1.0 - REFINEMENT * (left.sum::<f64>() / refinements.len().max(1) as f64)
            }
        }
    }

    /// Returns true if no task is waiting or outstanding.
    pub fn is_done(&self) -> bool {
        self.waiting.is_empty() && self.open == 0
    }

    /// The candidate of each direction, `None` until it is measured. Energies are relative to the candidates measured so
    /// far.
    pub fn rated(&self) -> Vec<Option<Candidate>> {
        let mut found = self.found.clone();
        if self.rated.is_none() {
            rate(found.iter_mut().flatten(), &self.options);
        }
        found
    }

    /// Up to three candidates, best first and at least 20° apart. `None` until all tasks are done.
    pub fn best(&self) -> Option<Vec<Candidate>> {
        let rated = self.rated.as_ref().filter(|_| self.is_done())?;
        let refined: Vec<Candidate> = rated.refinements.iter().map(|it| it.best.clone()).collect();
        Some(best(&refined))
    }

    /// The result. `None` until all tasks are done.
    pub fn result(&self) -> Option<SearchResult> {
        Some(SearchResult {
            best: self.best()?,
            scale: self.rated.as_ref()?.scale,
            candidates: self.found.iter().flatten().cloned().collect(),
        })
    }

    fn directions_of(&self, purpose: &Purpose) -> Vec<[f64; 3]> {
        match purpose {
            Purpose::Measure(places) => places.iter().map(|&it| self.directions[it]).collect(),
            Purpose::Refine(place) => {
                let refinement = self.rated.as_ref().map(|it| &it.refinements[*place]);
                refinement.map(Refinement::ring).unwrap_or_default()
            }
        }
    }

    /// Once every direction is measured, rates the candidates and starts the refinements.
    fn rate_if_measured(&mut self) {
        let [measured, total] = self.measured;
        if measured < total {
            return;
        }
        let scale = rate(self.found.iter_mut().flatten(), &self.options);
        let mut refinements = Vec::new();
        if self.refines {
            let candidates: Vec<Candidate> = self.found.iter().flatten().cloned().collect();
            for place in minima(&candidates, &self.options) {
                refinements.push(Refinement::new(candidates[place].clone(), &self.options));
            }
        }
        let unfinished = |place: &usize| !refinements[*place].is_done();
        let places = (0..refinements.len()).filter(unfinished);
        self.waiting = places.map(Purpose::Refine).collect();
        self.rated = Some(Rated { scale, refinements });
    }
}

/// Returns true if a measurement can return this candidate, or a search that rated it: without metrics, it has a reason why it cannot be
/// printed; with metrics, it can.
fn is_measured(candidate: &Candidate) -> bool {
    let can_be_printed = candidate.excluded.is_none_or(|it| !it.is_impossible());
    can_be_printed == candidate.metrics.is_some()
}
