//! Model files. Each format has a source file of its own, and is recognised by content, never by the file's name.

mod error;
pub mod kind;
pub mod obj;
pub mod stl;
mod text;
pub mod threemf;

use glam::Vec3;

use super::ModelUnit;

pub use error::ReadError;
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

/// A format of model files.
struct Format {
    /// Whether a file with these first bytes and this length has the format.
    is: fn(head: &[u8], length: u64) -> bool,
    /// Reads a file of the format.
    read: fn(bytes: &[u8]) -> Result<Contents, ReadError>,
}

/// The first that fits counts: a binary STL may begin with anything.
const FORMATS: [Format; 3] = [
    Format {
        is: stl::is_stl,
        read: |bytes| Ok(Contents::without_unit(stl::read(bytes)?)),
    },
    Format {
        is: |head, _| threemf::is_zip(head),
        read: threemf::read,
    },
    Format {
        is: |head, _| obj::is_obj(head),
        read: |bytes| Ok(obj::read(bytes)?),
    },
];

/// Reads a model.
///
/// # Errors
/// [`ReadError`], with the byte offset, or the line and the part, where reading failed.
pub fn read(bytes: &[u8]) -> Result<Contents, ReadError> {
    (format_of(head_of(bytes), bytes.len() as u64)?.read)(bytes)
}

fn head_of(bytes: &[u8]) -> &[u8] {
    &bytes[..bytes.len().min(HEAD_BYTES)]
}

/// Checks by the first [`HEAD_BYTES`] of a file and its length that it can be a model, so that other files are rejected
/// before they are read. Of a zip only the whole tells.
///
/// # Errors
/// [`ReadError`], which names what the file is instead.
pub fn identify(head: &[u8], length: u64) -> Result<(), ReadError> {
    format_of(head, length).map(|_| ())
}

fn format_of(head: &[u8], length: u64) -> Result<&'static Format, ReadError> {
    if length == 0 {
        return Err(ReadError::Empty);
    }
    let mut formats = FORMATS.iter();
    if let Some(format) = formats.find(|format| (format.is)(head, length)) {
        return Ok(format);
    }
    if let Some(kind) = FileKind::of(head) {
        return Err(ReadError::OtherKind { kind });
    }
    // A binary STL has no signature: an unknown file may be one of the wrong length.
    let damage = stl::wrong_length(head, length);
    Err(damage.map_or(ReadError::UnknownKind, ReadError::Stl))
}
