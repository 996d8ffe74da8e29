//! A search in parts, for more than one machine: each measures some of the directions, and the parts are put together again.

use serde::{Deserialize, Serialize};

use super::Candidate;
use crate::model::ModelFile;

/// Which part of a search one machine measures: of all directions in their order each `count`th, from the `number`th on. So
/// all parts are spread over the whole sphere and take about as long.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    /// From 1 to `count`.
    pub number: usize,
    /// How many parts there are.
    pub count: usize,
}

impl Shard {
    /// The places of its directions among `total`, upward.
    pub fn places(self, total: usize) -> impl Iterator<Item = usize> {
        (self.number.saturating_sub(1)..total).step_by(self.count.max(1))
    }
}

/// What was measured of one model, with the caller's own type of options.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Part<O> {
    /// The version of the library that measured it.
    pub version: String,
    /// The file that the model was read from.
    pub model: ModelFile,
    /// What was asked for, except what rates directions.
    pub options: O,
    /// CRC-32 of the weights that the user gave to facets, if any.
    pub weights_crc32: Option<u32>,
    /// Which part it is.
    pub shard: Shard,
    /// How many directions there are in all.
    pub directions: usize,
    /// The place of each candidate among them.
    pub places: Vec<usize>,
    /// What was measured there.
    pub candidates: Vec<Candidate>,
}

/// Why parts do not make a whole.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize)]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum MergeError {
    /// No part is of this model, with these weights.
    #[error("no part is of this model with these weights")]
    #[serde(rename = "merge-none")]
    None,
    /// A part was measured by another version of the library.
    #[error("shard {shard} was measured by version {theirs}, and this is {ours}; measure it again")]
    #[serde(rename = "merge-version")]
    OtherVersion {
        /// Which part.
        shard: Shard,
        /// Its version.
        theirs: String,
        /// This version.
        ours: String,
    },
    /// A part was measured with other options.
    #[error(
        "shard {shard} was measured with other options; give the same ones here and for all shards"
    )]
    #[serde(rename = "merge-options")]
    OtherOptions {
        /// Which part.
        shard: Shard,
    },
    /// A direction is in two parts.
    #[error(
        "direction {place} was measured twice, in shards {first} and {second}; leave one of them out"
    )]
    #[serde(rename = "merge-duplicate")]
    Duplicate {
        /// The direction's place, from 0.
        place: usize,
        /// A part that it is in.
        first: Shard,
        /// Another one.
        second: Shard,
    },
    /// A part does not hold what it says.
    #[error(
        "shard {shard} is damaged: its places and its candidates do not belong together; measure it again"
    )]
    #[serde(rename = "merge-damaged")]
    Damaged {
        /// Which part.
        shard: Shard,
    },
    /// Directions are in no part.
    #[error(
        "{missing} of {total} directions are missing, the first is {first}; is a shard missing?"
    )]
    #[serde(rename = "merge-gap")]
    Gap {
        /// How many.
        missing: usize,
        /// How many there should be.
        total: usize,
        /// The place of the first one, from 0.
        first: usize,
    },
}

impl std::fmt::Display for Shard {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "{}/{}", self.number, self.count)
    }
}

/// Puts the parts of a search together: all directions that `whole` names, each measured once and as `whole` says, whose own
/// places and candidates do not matter. Parts of other models, or with other weights, are left aside.
///
/// # Errors
/// [`MergeError`].
pub fn merge<O: PartialEq>(
    parts: &[Part<O>],
    whole: &Part<O>,
    directions: &[[f64; 3]],
) -> Result<Vec<Candidate>, MergeError> {
    let mut found: Vec<Option<(Shard, &Candidate)>> = vec![None; directions.len()];
    let is_ours =
        |part: &&Part<O>| part.model == whole.model && part.weights_crc32 == whole.weights_crc32;
    let mut ours = parts.iter().filter(is_ours).peekable();
    if ours.peek().is_none() {
        return Err(MergeError::None);
    }
    for part in ours {
        let shard = part.shard;
        if part.version != whole.version {
            return Err(MergeError::OtherVersion {
                shard,
                theirs: part.version.clone(),
                ours: whole.version.clone(),
            });
        }
        if part.options != whole.options || part.directions != directions.len() {
            return Err(MergeError::OtherOptions { shard });
        }
        if part.places.len() != part.candidates.len() {
            return Err(MergeError::Damaged { shard });
        }
        for (&place, candidate) in part.places.iter().zip(&part.candidates) {
            if directions.get(place) != Some(&candidate.direction) {
                return Err(MergeError::Damaged { shard });
            }
            if let Some((first, _)) = found[place].replace((part.shard, candidate)) {
                return Err(MergeError::Duplicate {
                    place,
                    first,
                    second: shard,
                });
            }
        }
    }
    if let Some(first) = found.iter().position(Option::is_none) {
        return Err(MergeError::Gap {
            missing: found.iter().filter(|found| found.is_none()).count(),
            total: directions.len(),
            first,
        });
    }
    Ok(found
        .into_iter()
        .flatten()
        .map(|(_, candidate)| candidate.clone())
        .collect())
}
