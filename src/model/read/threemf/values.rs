//! The values of attributes, and their faults.

use glam::{DAffine3, DMat3, DVec3, Vec3};

use super::xml::{Attributes, Tags, unescaped};
use super::{ThreeMfError, XmlFault};
use crate::model::read::text::quoted;

/// A fault in a tag, before its place is known.
pub enum Fault {
    Xml(XmlFault),
    Attribute {
        attribute: &'static str,
        found: String,
    },
    NoVertex {
        vertex: u32,
        vertices: u64,
    },
    Encrypted,
    Extension(String),
}

impl From<XmlFault> for Fault {
    fn from(fault: XmlFault) -> Self {
        Self::Xml(fault)
    }
}

impl Fault {
    pub fn at(self, tags: &Tags<'_>) -> ThreeMfError {
        let (part, line) = (tags.part().to_owned(), tags.line());
        match self {
            Self::Xml(fault) => tags.fault(fault),
            Self::Attribute { attribute, found } => ThreeMfError::BadAttribute {
                part,
                line,
                attribute: attribute.to_owned(),
                found,
            },
            Self::NoVertex { vertex, vertices } => ThreeMfError::NoVertex {
                part,
                line,
                vertex,
                vertices,
            },
            Self::Encrypted => ThreeMfError::Encrypted { part },
            Self::Extension(extension) => ThreeMfError::Extension { part, extension },
        }
    }
}

/// The places of a facet's corners.
pub fn facet(attributes: Attributes<'_>) -> Result<[u32; 3], Fault> {
    const NAMES: [&str; 3] = ["v1", "v2", "v3"];
    let mut corners = [None; 3];
    for attribute in attributes {
        let (name, value) = attribute?;
        if let [b'v', digit @ b'1'..=b'3'] = *name {
            let place = usize::from(digit - b'1');
            corners[place] = Some(number(NAMES[place], value)?);
        }
    }
    all(corners, NAMES)
}

/// The coordinates of a vertex.
pub fn vertex(attributes: Attributes<'_>) -> Result<Vec3, Fault> {
    const NAMES: [&str; 3] = ["x", "y", "z"];
    let mut vertex = [None; 3];
    for attribute in attributes {
        let (name, value) = attribute?;
        if let [axis @ b'x'..=b'z'] = *name {
            let axis = usize::from(axis - b'x');
            let coordinate: f32 = number(NAMES[axis], value)?;
            if !coordinate.is_finite() {
                return Err(bad(NAMES[axis], value));
            }
            vertex[axis] = Some(coordinate);
        }
    }
    all(vertex, NAMES).map(Vec3::from_array)
}

/// Twelve numbers: four rows of three, by which a row is multiplied from the left.
pub fn transform(value: &[u8]) -> Result<DAffine3, Fault> {
    let mut rows = [0.0; 12];
    let words = value.split(u8::is_ascii_whitespace);
    let mut words = words.filter(|word| !word.is_empty());
    for place in &mut rows {
        let word = words.next().unwrap_or_default();
        *place = f64::from(number::<f32>("transform", word)?);
    }
    if words.next().is_some() || rows.iter().any(|number| !number.is_finite()) {
        return Err(bad("transform", value));
    }
    let row = |row: usize| DVec3::from_slice(&rows[3 * row..]);
    Ok(DAffine3 {
        matrix3: DMat3::from_cols(row(0), row(1), row(2)),
        translation: row(3),
    })
}

/// All values, or the error of the first that is missing.
fn all<T: Copy>(values: [Option<T>; 3], names: [&'static str; 3]) -> Result<[T; 3], Fault> {
    if let [Some(a), Some(b), Some(c)] = values {
        return Ok([a, b, c]);
    }
    let missing = values.iter().position(Option::is_none);
    Err(bad(names[missing.unwrap_or_default()], b""))
}

/// The number that is the value of an attribute.
pub fn number<T: std::str::FromStr>(attribute: &'static str, value: &[u8]) -> Result<T, Fault> {
    let text = unescaped(value);
    let number = str::from_utf8(text.trim_ascii()).ok();
    let number = number.and_then(|text| text.parse().ok());
    number.ok_or_else(|| bad(attribute, value))
}

/// The fault of an attribute with a bad value; `value` is empty if the attribute is missing.
pub fn bad(attribute: &'static str, value: &[u8]) -> Fault {
    Fault::Attribute {
        attribute,
        found: quoted(value),
    }
}
