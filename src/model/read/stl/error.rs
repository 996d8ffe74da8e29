//! Errors of reading an STL.

use serde::Serialize;

/// Word or number that the grammar of ASCII STL expects at some place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum StlExpected {
    /// The beginning of a solid.
    Solid,
    /// A facet, or the end of the solid.
    FacetOrEndsolid,
    /// The word before a normal.
    Normal,
    /// A component of a normal.
    NormalNumber,
    /// The words before the corners.
    OuterLoop,
    /// The word before a corner.
    Vertex,
    /// A coordinate of a corner.
    Coordinate,
    /// The word after the corners.
    Endloop,
    /// The end of a facet.
    Endfacet,
}

impl std::fmt::Display for StlExpected {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Solid => "`solid`",
            Self::FacetOrEndsolid => "`facet` or `endsolid`",
            Self::Normal => "`normal`",
            Self::NormalNumber => "a number of the normal",
            Self::OuterLoop => "`outer loop`",
            Self::Vertex => "`vertex`",
            Self::Coordinate => "a coordinate",
            Self::Endloop => "`endloop`",
            Self::Endfacet => "`endfacet`",
        })
    }
}

/// Error of reading bytes as an STL.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum StlError {
    /// A binary STL that ends before all facets that its header announces.
    #[error(
        "the STL is cut short: its header announces {declared_facets} facets, which need \
         {expected_bytes} bytes, but the file ends at byte {found_bytes}; copy or export it again"
    )]
    #[serde(rename = "stl-truncated")]
    Truncated {
        /// Facet count in the header.
        declared_facets: u64,
        /// Length that this count needs.
        expected_bytes: u64,
        /// Length of the file.
        found_bytes: u64,
    },
    /// A binary STL with more facets than its header announces.
    #[error(
        "the facet count is wrong: the header at byte 80 announces {declared_facets} facets, \
         but {found_facets} follow; export the model again"
    )]
    #[serde(rename = "stl-wrong-facet-count")]
    WrongFacetCount {
        /// Facet count in the header.
        declared_facets: u64,
        /// Whole facets in the file.
        found_facets: u64,
    },
    /// A coordinate of a binary STL is NaN or infinite.
    #[error(
        "the coordinate at byte {byte} (facet {facet}) is not a finite number; export the model again"
    )]
    #[serde(rename = "stl-not-finite")]
    NotFiniteBinary {
        /// Offset of the coordinate in the file.
        byte: u64,
        /// Facet it belongs to, from 0.
        facet: u64,
    },
    /// A coordinate of an ASCII STL is NaN or infinite.
    #[error("line {line}: `{text}` is not a finite number; export the model again")]
    #[serde(rename = "stl-not-finite")]
    NotFiniteText {
        /// Line in the file, from 1.
        line: u64,
        /// The offending word.
        text: String,
    },
    /// A word of an ASCII STL that the grammar does not expect there.
    #[error("line {line}: expected {expected}, found `{found}`; export the model again")]
    #[serde(rename = "stl-syntax")]
    Syntax {
        /// Line in the file, from 1.
        line: u64,
        /// Expected by the grammar at this place.
        expected: StlExpected,
        /// The word found instead.
        found: String,
    },
    /// An ASCII STL that ends inside a solid.
    #[error("the STL is cut short: it ends at line {line}, where {expected} should follow")]
    #[serde(rename = "stl-truncated")]
    EndOfText {
        /// Last line of the file, from 1.
        line: u64,
        /// Expected by the grammar at the end.
        expected: StlExpected,
    },
    /// A well-formed STL without facets.
    #[error("the STL holds no facets; export the model again")]
    #[serde(rename = "stl-no-facets")]
    NoFacets,
}
