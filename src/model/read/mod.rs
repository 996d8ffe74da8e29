//! Model files. Each format has a source file of its own, and is recognised by content, never by the file's name.

mod error;
pub mod kind;
pub mod stl;

use glam::Vec3;

pub use error::ReadError;
use kind::FileKind;

/// Number of bytes at the beginning of a file that are enough to tell its kind.
pub const HEAD_BYTES: usize = 1 << 16;

/// The corners of triangles, in file order.
pub type Triangles = Vec<[Vec3; 3]>;

/// A format of model files.
struct Format {
    /// Whether a file with these first bytes and this length has the format.
    is: fn(head: &[u8], length: u64) -> bool,
    /// Reads a file of the format.
    read: fn(bytes: &[u8]) -> Result<Triangles, ReadError>,
}

const FORMATS: [Format; 1] = [Format {
    is: stl::is_stl,
    read: |bytes| Ok(stl::read(bytes)?),
}];

/// Reads the triangles of a model.
///
/// # Errors
/// [`ReadError`], with the byte offset or the line where reading failed.
pub fn read(bytes: &[u8]) -> Result<Triangles, ReadError> {
    let head = &bytes[..bytes.len().min(HEAD_BYTES)];
    (format_of(head, bytes.len() as u64)?.read)(bytes)
}

/// Checks by the first [`HEAD_BYTES`] of a file and its length that it can be a model, so that other files are rejected
/// before they are read.
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
