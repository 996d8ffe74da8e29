//! Model files. Each format has a source file of its own, and is recognised by content, never by the file's name.

mod error;
mod format;
pub mod kind;
pub mod obj;
pub mod stl;
mod text;
pub mod threemf;

use glam::Vec3;

use super::ModelUnit;

pub use error::ReadError;
pub use format::ModelFormat;
use kind::FileKind;

/// Number of bytes at the beginning of a file that are enough to tell its kind.
pub const HEAD_BYTES: usize = 1 << 16;

/// The corners of triangles, in file order.
pub type Triangles = Vec<[Vec3; 3]>;

/// What a file holds of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Contents {
    /// Its triangles, in millimetres if the file has a unit.
    pub triangles: Triangles,
    /// The unit that the file states, from which the triangles were converted.
    pub unit: Option<ModelUnit>,
    /// Objects that are not printed: supports of other programs, surfaces, and what a user turned off.
    pub skipped_objects: usize,
}

impl Contents {
    /// Those of a file that states no unit.
    fn without_unit(triangles: Triangles) -> Self {
        Self {
            triangles,
            unit: None,
            skipped_objects: 0,
        }
    }
}

/// Reads a model.
///
/// # Errors
/// [`ReadError`], with the byte offset, or the line and the part, where reading failed.
pub fn read(bytes: &[u8]) -> Result<Contents, ReadError> {
    match identify(head_of(bytes), bytes.len() as u64)? {
        ModelFormat::Stl => Ok(Contents::without_unit(stl::read(bytes)?)),
        ModelFormat::ThreeMf => threemf::read(bytes),
        ModelFormat::Obj => Ok(obj::read(bytes)?),
    }
}

fn head_of(bytes: &[u8]) -> &[u8] {
    &bytes[..bytes.len().min(HEAD_BYTES)]
}

/// The format of a file by its first [`HEAD_BYTES`] and its length, so that files that cannot be models are rejected before
/// they are read. Of a zip only the whole tells.
///
/// # Errors
/// [`ReadError`], which names what the file is instead.
pub fn identify(head: &[u8], length: u64) -> Result<ModelFormat, ReadError> {
    if length == 0 {
        return Err(ReadError::Empty);
    }
    if let Some(format) = ModelFormat::of(head, length) {
        return Ok(format);
    }
    if let Some(kind) = FileKind::of(head) {
        return Err(ReadError::OtherKind { kind });
    }
    // A binary STL has no signature: an unknown file may be one of the wrong length.
    let damage = stl::wrong_length(head, length);
    Err(damage.map_or(ReadError::UnknownKind, ReadError::Stl))
}
