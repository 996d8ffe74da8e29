//! Model files. Each format has a source file of its own, and is recognised by content, never by the file's name.

mod error;
mod format;
pub mod kind;
pub mod obj;
pub mod stl;
mod text;
pub mod threemf;

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::ModelUnit;

pub use error::ReadError;
pub use format::ModelFormat;
use kind::FileKind;

/// Number of bytes at the beginning of a file that determine its kind.
pub const HEAD_BYTES: usize = 1 << 16;

/// The corners of triangles, in file order.
pub type Triangles = Vec<[Vec3; 3]>;

/// Contents of a model file.
#[derive(Debug, Clone, PartialEq)]
pub struct Contents {
    /// Its triangles, in millimetres if the file has a unit.
    pub triangles: Triangles,
    /// The triangles of bodies that are subtracted from it.
    pub negative: Triangles,
    /// The unit that the file states, from which the triangles were converted.
    pub unit: Option<ModelUnit>,
    /// Objects that are not printed: supports of other programs, surfaces unless they were asked for, and objects that
    /// a user turned off.
    pub skipped_objects: usize,
    /// Parts that slicers do not print as solids, each once.
    pub parts: Vec<Part>,
    /// The plate that was read, if the file has several.
    pub plate: Option<PlateChoice>,
}

/// A part of a project that is no solid.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Part {
    /// Its name in the project.
    pub name: String,
    /// Its kind.
    pub kind: PartKind,
}

/// The kind of a part that is no solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "kebab-case")]
pub enum PartKind {
    /// Subtracted from the solids.
    Negative,
    /// A region with settings of its own.
    Modifier,
    /// A region without supports.
    SupportBlocker,
    /// A region that is to be supported.
    SupportEnforcer,
}

/// A plate of a project that has several.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct PlateChoice {
    /// The plate, from 1.
    pub plate_number: u32,
    /// Number of plates.
    pub plates: u32,
}

/// Choices that a file leaves to its reader.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(default, deny_unknown_fields)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "independent choices, each of which may be made or not"
)]
pub struct ReadOptions {
    /// Plate of a 3MF project that has several, from 1; the first if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plate_number: Option<u32>,
    /// Reads objects that a 3MF calls surfaces as models. Without it they are not printed.
    pub surfaces: bool,
    /// Closes every hole where the generalised winding number is one half, and not only wide ones that are bent.
    pub curved_caps: bool,
    /// Reads bodies that look like supports as parts of the model. Without it they are kept as supports: printed, and left out of
    /// profiles and compensation.
    pub supports_as_model: bool,
    /// Mirrors the model in the plane x = 0 of the file.
    pub mirrored: bool,
}

impl Contents {
    /// Contents of a file that states no unit.
    fn without_unit(triangles: Triangles) -> Self {
        Self {
            triangles,
            negative: Triangles::new(),
            unit: None,
            skipped_objects: 0,
            parts: Vec::new(),
            plate: None,
        }
    }
}

/// Reads a model.
///
/// # Errors
/// [`ReadError`], with the byte offset, or the line and the part, where reading failed.
pub fn read(bytes: &[u8]) -> Result<Contents, ReadError> {
    read_with(bytes, &ReadOptions::default())
}

/// The same with choices. Files without plates have one.
///
/// # Errors
/// [`ReadError`]; [`ReadError::NoPlate`] if there is no such plate.
pub fn read_with(bytes: &[u8], options: &ReadOptions) -> Result<Contents, ReadError> {
    let mut contents = match identify(head_of(bytes), bytes.len() as u64)? {
        ModelFormat::Stl => Contents::without_unit(stl::read(bytes)?),
        ModelFormat::ThreeMf => threemf::read(bytes, options)?,
        ModelFormat::Obj => obj::read(bytes)?,
    };
    if options.mirrored {
        mirror(&mut contents.triangles);
        mirror(&mut contents.negative);
    }
    let plates = contents.plate.map_or(1, |plate| plate.plates);
    match options.plate_number {
        Some(plate_number) if !(1..=plates).contains(&plate_number) => Err(ReadError::NoPlate {
            plate_number,
            plates,
        }),
        _ => Ok(contents),
    }
}

/// Mirrors triangles in the plane x = 0. Their order stays, and their normals point outwards again.
fn mirror(triangles: &mut Triangles) {
    for triangle in triangles {
        for corner in triangle.iter_mut() {
            corner.x = -corner.x;
        }
        triangle.swap(1, 2);
    }
}

fn head_of(bytes: &[u8]) -> &[u8] {
    &bytes[..bytes.len().min(HEAD_BYTES)]
}

/// The format of a file by its first [`HEAD_BYTES`] and its length, so that files that cannot be models are rejected before
/// they are read. A zip is identified by the whole file only.
///
/// # Errors
/// [`ReadError`], which names the kind of file.
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
