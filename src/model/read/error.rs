//! Errors of reading a file as a model.

use serde::Serialize;

use super::kind::FileKind;
use super::obj::ObjError;
use super::stl::StlError;
use super::threemf::ThreeMfError;

/// Error of reading a file as a model.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum ReadError {
    /// The file has no bytes.
    #[error("the file is empty; export the model again")]
    #[serde(rename = "file-empty")]
    Empty,
    /// A file of another known kind.
    #[error("{}", kind.sentence())]
    #[serde(rename = "other-file-kind")]
    OtherKind {
        /// The kind of the file.
        kind: FileKind,
    },
    /// A file of an unknown kind.
    #[error("this is not a model that Cusp can read; export it as STL, 3MF or OBJ")]
    #[serde(rename = "unknown-file-kind")]
    UnknownKind,
    /// The file has no such plate.
    #[error("there is no plate {plate_number}: the file has {plates}")]
    #[serde(rename = "no-plate")]
    NoPlate {
        /// The plate that was asked for, from 1.
        plate_number: u32,
        /// Number of plates.
        plates: u32,
    },
    /// An STL that is damaged.
    #[error(transparent)]
    #[serde(untagged)]
    Stl(#[from] StlError),
    /// A 3MF that is damaged, or has unsupported contents.
    #[error(transparent)]
    #[serde(untagged)]
    ThreeMf(#[from] ThreeMfError),
    /// An OBJ that is damaged, or has unsupported contents.
    #[error(transparent)]
    #[serde(untagged)]
    Obj(#[from] ObjError),
}
