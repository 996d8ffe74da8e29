//! Why there is no search, or why a search refuses what it is given.

use serde::Serialize;

/// Why there is no search, or why a search refuses what it is given.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum SearchError {
    /// A search of no directions, or of too many.
    #[error("a search looks along 1 to {most} directions, not {directions}")]
    #[serde(rename = "bad-directions")]
    Directions {
        /// The number asked for.
        directions: usize,
        /// The greatest number.
        most: usize,
    },
    /// The weight of the cost is not from 0 to 1.
    #[error("alpha must be from 0 to 1, not {alpha}")]
    #[serde(rename = "bad-alpha")]
    Alpha {
        /// What was asked for.
        alpha: f64,
    },
    /// A result of a task that is not out: never handed out, put back, or accepted before.
    #[error("task {task} is not out: hand in each task's result once")]
    #[serde(rename = "search-task")]
    Task {
        /// The task's number.
        task: usize,
    },
    /// A candidate that is none of the direction it should be, or that no measurement gives.
    #[error("candidate {place} is not one that was measured for its direction")]
    #[serde(rename = "search-candidate")]
    Candidate {
        /// Its place among those given, from 0.
        place: usize,
    },
}
