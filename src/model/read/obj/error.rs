//! Errors of reading an OBJ.

use serde::Serialize;

/// Error of reading a file as OBJ.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum ObjError {
    /// A coordinate of a vertex is missing or not a finite number.
    #[error(
        "line {line}: a vertex needs three finite numbers, but has `{found}`; export the model again"
    )]
    #[serde(rename = "obj-bad-vertex")]
    BadVertex {
        /// Line in the file, from 1.
        line: u64,
        /// The word found instead; empty at the end of the line.
        found: String,
    },
    /// A corner of a face is not the number of a vertex.
    #[error(
        "line {line}: `{found}` is not the number of a vertex: the file has {vertices}; export the model again"
    )]
    #[serde(rename = "obj-bad-corner")]
    BadCorner {
        /// Line in the file, from 1.
        line: u64,
        /// The corner.
        found: String,
        /// Number of vertices that it can refer to.
        vertices: u64,
    },
    /// A face with fewer than three corners.
    #[error(
        "line {line}: a face needs at least three corners, and has {corners}; export the model again"
    )]
    #[serde(rename = "obj-few-corners")]
    FewCorners {
        /// Line in the file, from 1.
        line: u64,
        /// Its corners.
        corners: u64,
    },
    /// A free-form surface, which has no facets.
    #[error(
        "line {line}: `{keyword}` is a free-form surface without facets; export the model as polygons"
    )]
    #[serde(rename = "obj-free-form")]
    FreeForm {
        /// Line in the file, from 1.
        line: u64,
        /// The keyword.
        keyword: String,
    },
    /// Faces that name the same corners time and again.
    #[error(
        "line {line}: the faces come to more than {most_facets} facets, too many for the size of the file; export the model again"
    )]
    #[serde(rename = "obj-too-many")]
    TooMany {
        /// Line in the file, from 1.
        line: u64,
        /// Most facets of a file of its size.
        most_facets: usize,
    },
    /// A well-formed OBJ without faces.
    #[error("the OBJ holds no faces; export the model again")]
    #[serde(rename = "obj-no-faces")]
    NoFaces,
}
