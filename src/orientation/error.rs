//! Errors of an orientation search.

use serde::Serialize;

/// Error of starting a search, or of a rejected input.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum SearchError {
    /// No directions, or too many.
    #[error("a search looks along 1 to {most} directions, not {directions}")]
    #[serde(rename = "bad-directions")]
    Directions {
        /// Requested number.
        directions: usize,
        /// Maximum number.
        most: usize,
    },
    /// The weight of the cost, α, is not from 0 to 1.
    #[error("alpha must be from 0 to 1, not {alpha}")]
    #[serde(rename = "bad-alpha")]
    Alpha {
        /// Requested weight.
        alpha: f64,
    },
    /// A limit is negative or no number.
    #[error("{limit} is {value}, but must be 0 or more")]
    #[serde(rename = "bad-search-limit")]
    Limit {
        /// The field.
        limit: &'static str,
        /// Its value.
        value: f64,
    },
    /// A result for a task that is not outstanding: never handed out, put back, or already accepted.
    #[error("task {task} is not pending: submit each task's result exactly once")]
    #[serde(rename = "search-task")]
    Task {
        /// Number of the task.
        task: usize,
    },
    /// A candidate for the wrong direction, or one that no measurement can return.
    #[error("candidate {place} is not one that was measured for its direction")]
    #[serde(rename = "search-candidate")]
    Candidate {
        /// Its index among the given candidates, from 0.
        place: usize,
    },
}
