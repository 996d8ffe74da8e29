//! Weights of facets, from 0 to 1 (section 4.2), read from and written to a small file.
//!
//! The file is bound to its mesh. It holds the eight bytes `CUSPWT01`, the number of facets and the CRC-32 of their corners
//! as single-precision numbers (32 bits each), then one single-precision weight per facet, all little-endian. The facets are
//! those with an area, in the order of the STL.

use serde::Serialize;

/// The first bytes of a file of weights, which include the version of the format.
const MAGIC: &[u8; 8] = b"CUSPWT01";
const HEAD_BYTES: usize = 16;

/// Error of reading or using weights.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum WeightsError {
    /// The bytes are not a file of weights.
    #[error("this is no file of weights: it does not begin with CUSPWT01, or is cut short")]
    #[serde(rename = "weights-not-weights")]
    NotWeights,
    /// The weights were made for another mesh.
    #[error(
        "these weights are for another mesh, of {weights_facets} facets; this one has {mesh_facets}; paint it again, or open \
         the model that they were made for"
    )]
    #[serde(rename = "weights-other-mesh")]
    OtherMesh {
        /// Facets that the weights are for.
        weights_facets: usize,
        /// Facets of the mesh.
        mesh_facets: usize,
    },
    /// A weight is not a number from 0 to 1.
    #[error("the weight of facet {facet} is {weight}, and weights are 0 to 1")]
    #[serde(rename = "weights-out-of-range")]
    OutOfRange {
        /// The first such facet, from 0.
        facet: usize,
        /// Its weight.
        weight: f32,
    },
}

/// Checks that there is a weight from 0 to 1 for every facet.
///
/// # Errors
/// [`WeightsError::OtherMesh`], [`WeightsError::OutOfRange`].
pub fn check(weights: &[f32], facets: usize) -> Result<(), WeightsError> {
    if weights.len() != facets {
        return Err(WeightsError::OtherMesh {
            weights_facets: weights.len(),
            mesh_facets: facets,
        });
    }
    let bad = weights
        .iter()
        .position(|weight| !(0.0..=1.0).contains(weight));
    match bad {
        Some(facet) => Err(WeightsError::OutOfRange {
            facet,
            weight: weights[facet],
        }),
        None => Ok(()),
    }
}

/// The file of these weights, for the mesh with these corners, nine numbers per facet.
pub fn to_bytes(weights: &[f32], corners: &[f32]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(HEAD_BYTES + 4 * weights.len());
    bytes.extend(MAGIC);
    bytes.extend((weights.len() as u32).to_le_bytes());
    bytes.extend(crc_of(corners).to_le_bytes());
    bytes.extend(weights.iter().flat_map(|weight| weight.to_le_bytes()));
    bytes
}

/// The weights in a file, which must be for the mesh with these corners.
///
/// # Errors
/// [`WeightsError`].
pub fn from_bytes(bytes: &[u8], corners: &[f32]) -> Result<Vec<f32>, WeightsError> {
    let (head, body) = bytes
        .split_at_checked(HEAD_BYTES)
        .ok_or(WeightsError::NotWeights)?;
    let number =
        |at: usize| u32::from_le_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]);
    let facets = number(8) as usize;
    if head[..8] != MAGIC[..] || body.len() != 4 * facets {
        return Err(WeightsError::NotWeights);
    }
    let mesh_facets = corners.len() / 9;
    if facets != mesh_facets || number(12) != crc_of(corners) {
        return Err(WeightsError::OtherMesh {
            weights_facets: facets,
            mesh_facets,
        });
    }
    let weights: Vec<f32> = body
        .chunks_exact(4)
        .map(|bytes| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
        .collect();
    check(&weights, facets)?;
    Ok(weights)
}

/// The CRC-32 of numbers as little-endian bytes.
pub(crate) fn crc_of(numbers: &[f32]) -> u32 {
    let bytes: Vec<u8> = numbers
        .iter()
        .flat_map(|number| number.to_le_bytes())
        .collect();
    crate::crc::crc32(&bytes)
}
