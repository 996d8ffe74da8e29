//! The search as a state machine: it hands out tasks, accepts their results in any order, and has the result in the end.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};
#[cfg(target_arch = "wasm32")]
use tsify::Tsify;

use super::energy::{best, minima, rate};
use super::refine::Refinement;
use super::shard::Shard;
use super::{Candidate, Scale, SearchError, SearchOptions};

/// Directions of a task of the first look: few, so that all workers end together, and enough to be worth a message.
const CHUNK: usize = 8;

/// The part of the time that refinements take, about.
const REFINEMENT: f64 = 0.2;

/// Directions to measure, for whoever is free.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(Tsify))]
pub struct Task {
    /// What its result is known by.
    pub number: usize,
    /// Unit vectors that point up from the plate, in the frame of the file.
    pub directions: Vec<[f64; 3]>,
}

/// What was measured for a task.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TaskResult {
    /// The task's number.
    pub number: usize,
    /// One for each of its directions, in their order.
    pub candidates: Vec<Candidate>,
}

/// What a search finds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SearchResult {
    /// See [`Search::best`].
    pub best: Vec<Candidate>,
    /// What energies are relative to.
    pub scale: Scale,
    /// All directions of the first look, rated.
    pub candidates: Vec<Candidate>,
}

/// What a task is for.
#[derive(Debug, Clone)]
enum Purpose {
    /// The first look, at directions in these places.
    Measure(Vec<usize>),
    /// The next ring of a refinement, by its place.
    Refine(usize),
}

/// A search for the best directions. It measures nothing itself: tasks may go to threads, workers or machines, in any number
/// and order, and the result is the same to the last bit.
///
/// First all directions are measured, then rings around the local minima of the energy (eq. 25), each of which depends on the
/// one before.
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
    /// One for each direction, once it is measured; rated once all are.
    found: Vec<Option<Candidate>>,
    /// How many are found, and how many are to be.
    measured: [usize; 2],
    /// Whether minima are refined: not in a shard, which knows only its own directions.
    refines: bool,
    /// Tasks that nobody has.
    waiting: VecDeque<Purpose>,
    /// Tasks that were handed out, by their numbers; `None` where nobody has them any more.
    out: Vec<Option<Purpose>>,
    /// How many somebody has.
    open: usize,
    /// Known once all directions are measured.
    rated: Option<Rated>,
}

/// What follows from all candidates of the first look.
#[derive(Debug, Clone)]
struct Rated {
    scale: Scale,
    refinements: Vec<Refinement>,
}

impl Search {
    /// A search along directions.
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

    /// A search that only measures the directions of a shard: it refines nothing, and its result has no best.
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
        // Each chunk lies all over the sphere, so that it fills everywhere at once.
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

    /// A search whose directions have been measured before, in shards or by a search with other options: these are rated, and
    /// the minima refined.
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

    /// What is searched for.
    pub fn options(&self) -> &SearchOptions {
        &self.options
    }

    /// The directions of the first look.
    pub fn directions(&self) -> &[[f64; 3]] {
        &self.directions
    }

    /// How many of them are measured.
    pub fn measured(&self) -> usize {
        self.measured[0]
    }

    /// Up to `most` tasks that nobody has. There are none while the next ones depend on results that are still out, and at the
    /// end: see [`Self::is_done`].
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

    /// Takes the result of a task that is out. After an error the task is still out.
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

    /// Has a task that is out handed out again, under another number: whoever had it is lost.
    ///
    /// # Errors
    /// [`SearchError::Task`].
    pub fn put_back(&mut self, task: usize) -> Result<(), SearchError> {
        let lost = self.take(task)?;
        self.waiting.push_front(lost);
        Ok(())
    }

    /// Takes a task from whoever has it.
    fn take(&mut self, task: usize) -> Result<Purpose, SearchError> {
        let taken = self.out.get_mut(task).and_then(Option::take);
        let taken = taken.ok_or(SearchError::Task { task })?;
        self.open -= 1;
        Ok(taken)
    }

    /// How much is done, 0 to 1. It never falls.
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

    /// Whether no task is left, in here or out there.
    pub fn is_done(&self) -> bool {
        self.waiting.is_empty() && self.open == 0
    }

    /// One for each direction, as soon as it is measured. Energies are relative to what has been measured so far.
    pub fn rated(&self) -> Vec<Option<Candidate>> {
        let mut found = self.found.clone();
        if self.rated.is_none() {
            rate(found.iter_mut().flatten(), &self.options);
        }
        found
    }

    /// The best direction and up to two others that are good in another way, the best first; `None` before all is done.
    pub fn best(&self) -> Option<Vec<Candidate>> {
        let rated = self.rated.as_ref().filter(|_| self.is_done())?;
        let refined: Vec<Candidate> = rated.refinements.iter().map(|it| it.best.clone()).collect();
        Some(best(&refined))
    }

    /// What was found; `None` before all is done.
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

    /// Rates the candidates, and starts the refinements, once every direction is measured.
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

/// Whether a measurement gives such a candidate: with metrics, or with a reason why there are none.
fn is_measured(candidate: &Candidate) -> bool {
    candidate.excluded.is_none() == candidate.metrics.is_some()
}
