//! Searches in shards: each machine measures some of the directions, and their parts are merged.

use serde::{Deserialize, Serialize};

use super::Candidate;
use crate::model::ModelFile;

/// A shard of a search: every `count`th direction, from the `number`th on. All shards therefore cover the whole sphere and
/// take about equally long.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    /// From 1 to `count`.
    pub number: usize,
    /// Number of shards.
    pub count: usize,
}

impl Shard {
    /// Indices of its directions among `total`, in ascending order.
    pub fn places(self, total: usize) -> impl Iterator<Item = usize> {
        (self.number.saturating_sub(1)..total).step_by(self.count.max(1))
    }
}

/// The measurements of one shard for one model. The options `O` are the caller's.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Part<O> {
    /// The version of the library that measured it.
    pub version: String,
    /// The file that the model was read from.
    pub model: ModelFile,
    /// The options, except those that only rate candidates.
    pub options: O,
    /// CRC-32 of the user's weights of facets, if any.
    pub weights_crc32: Option<u32>,
    /// The shard that was measured.
    pub shard: Shard,
    /// Number of directions of all shards.
    pub directions: usize,
    /// Index of each candidate's direction.
    pub places: Vec<usize>,
    /// The candidates, in the order of `places`.
    pub candidates: Vec<Candidate>,
}

/// Error of merging parts.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize)]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum MergeError {
    /// No part is for this model with these weights.
    #[error("none of the parts belongs to this model with these weights")]
    #[serde(rename = "merge-none")]
    None,
    /// A part was measured by another version of the library.
    #[error("shard {shard} was measured by version {theirs}, and this is {ours}; measure it again")]
    #[serde(rename = "merge-version")]
    OtherVersion {
        /// Shard of the part.
        shard: Shard,
        /// The version that measured it.
        theirs: String,
        /// The version of this library.
        ours: String,
    },
    /// A part was measured with other options.
    #[error(
        "shard {shard} was measured with other options; give the same ones here and for all shards"
    )]
    #[serde(rename = "merge-options")]
    OtherOptions {
        /// Shard of the part.
        shard: Shard,
    },
    /// A direction is in two parts.
    #[error(
        "direction {place} was measured twice, in shards {first} and {second}; leave one of them out"
    )]
    #[serde(rename = "merge-duplicate")]
    Duplicate {
        /// Index of the direction, from 0.
        place: usize,
        /// Shard of one of the parts.
        first: Shard,
        /// Shard of the other part.
        second: Shard,
    },
    /// The indices and the candidates of a part do not match.
    #[error(
        "shard {shard} is damaged: its places and its candidates do not belong together; measure it again"
    )]
    #[serde(rename = "merge-damaged")]
    Damaged {
        /// Shard of the part.
        shard: Shard,
    },
    /// Some directions are in no part.
    #[error(
        "{missing} of {total} directions are missing, the first is {first}; is a shard missing?"
    )]
    #[serde(rename = "merge-gap")]
    Gap {
        /// Number of missing directions.
        missing: usize,
        /// Number of all directions.
        total: usize,
        /// Index of the first missing direction, from 0.
        first: usize,
    },
}

impl std::fmt::Display for Shard {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "{}/{}", self.number, self.count)
    }
}

/// Merges the parts of a search into one candidate per direction. Each direction must be in exactly one part, measured by
/// the version and with the options of `whole`, whose own indices and candidates are not used. Parts for other models or
/// weights are ignored.
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
