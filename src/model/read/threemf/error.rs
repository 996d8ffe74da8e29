//! Errors of reading a 3MF.

use serde::Serialize;

/// Fault in the XML of a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum XmlFault {
    /// It ends before its elements do.
    CutShort,
    /// It does not begin with a tag, as XML in UTF-8 does.
    NotXml,
    /// An end tag does not match its start tag.
    WrongEndTag,
    /// An attribute is not a name and a value in quotes.
    Attribute,
    /// A tag is longer than any in a model.
    LongTag,
    /// More elements lie inside each other than in any model.
    Deep,
    /// A document type, which 3MF forbids.
    Doctype,
}

impl XmlFault {
    fn in_words(self) -> &'static str {
        match self {
            Self::CutShort => "it ends before its elements do",
            Self::NotXml => "it is not XML in UTF-8",
            Self::WrongEndTag => "an end tag does not match its start tag",
            Self::Attribute => "an attribute is not a name and a value in quotes",
            Self::LongTag => "a tag is too long",
            Self::Deep => "too many elements lie inside each other",
            Self::Doctype => "it has a document type, which 3MF forbids",
        }
    }
}

/// Geometry other than facets that an extension of 3MF gives an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum ThreeMfFeature {
    /// Beams between vertices.
    BeamLattice,
    /// Slices, whose facets only illustrate them.
    Slices,
    /// Facets displaced by a texture.
    Displacement,
    /// Boolean operations on other objects.
    Booleans,
    /// A function of the place.
    Volumetric,
}

impl ThreeMfFeature {
    fn in_words(self) -> &'static str {
        match self {
            Self::BeamLattice => "a lattice of beams",
            Self::Slices => "slices",
            Self::Displacement => "displaced facets",
            Self::Booleans => "boolean operations",
            Self::Volumetric => "volumetric data",
        }
    }
}

/// Error of reading a file as 3MF. Parts are the files in its zip.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum ThreeMfError {
    /// The directory of the zip is missing or damaged.
    #[error(
        "the 3MF file is damaged or cut short: its directory is missing; copy or export it again"
    )]
    #[serde(rename = "threemf-no-directory")]
    NoDirectory,
    /// A part that another refers to is not there.
    #[error("the 3MF file has no part {part}; export the model again")]
    #[serde(rename = "threemf-no-part")]
    NoPart {
        /// Its name.
        part: String,
    },
    /// A part does not match its entry in the zip's directory.
    #[error("the part {part} of the 3MF file is damaged; copy or export it again")]
    #[serde(rename = "threemf-damaged-part")]
    DamagedPart {
        /// Its name.
        part: String,
    },
    /// A part is compressed or encrypted in a way that 3MF does not allow.
    #[error(
        "the part {part} of the 3MF file is encrypted or packed by method {method}; 3MF allows methods 0 and 8, unencrypted; export the model again"
    )]
    #[serde(rename = "threemf-packed")]
    Packed {
        /// Its name.
        part: String,
        /// Number of the zip's method.
        method: u16,
    },
    /// A part that grows beyond reason when it is inflated.
    #[error(
        "the part {part} of the 3MF file inflates to more than {most_bytes} bytes, too much for its size; export the model again"
    )]
    #[serde(rename = "threemf-too-large")]
    TooLarge {
        /// Its name.
        part: String,
        /// The most that it may inflate to.
        most_bytes: u64,
    },
    /// A part that is not XML.
    #[error("{part}, line {line}: {}; export the model again", fault.in_words())]
    #[serde(rename = "threemf-xml")]
    Xml {
        /// Name of the part.
        part: String,
        /// Line in the part, from 1.
        line: u64,
        /// The fault.
        fault: XmlFault,
    },
    /// An attribute is missing, or its value is invalid.
    #[error("{part}, line {line}: `{found}` is no value of {attribute}; export the model again")]
    #[serde(rename = "threemf-bad-attribute")]
    BadAttribute {
        /// Name of the part.
        part: String,
        /// Line in the part, from 1.
        line: u64,
        /// Name of the attribute.
        attribute: String,
        /// Its value; empty if it is missing.
        found: String,
    },
    /// A corner of a facet is not a vertex of its mesh.
    #[error(
        "{part}, line {line}: there is no vertex {vertex}: the mesh has {vertices}, from 0; export the model again"
    )]
    #[serde(rename = "threemf-no-vertex")]
    NoVertex {
        /// Name of the part.
        part: String,
        /// Line in the part, from 1.
        line: u64,
        /// Number of the vertex.
        vertex: u32,
        /// Vertices of the mesh.
        vertices: u64,
    },
    /// An object that is to be printed is not there.
    #[error("{part}, line {line}: there is no object {object}; export the model again")]
    #[serde(rename = "threemf-no-object")]
    NoObject {
        /// Name of the part that refers to it.
        part: String,
        /// Line in the part, from 1.
        line: u64,
        /// Id of the object.
        object: u32,
    },
    /// Objects consist of each other without end.
    #[error(
        "{part}, line {line}: object {object} is more than {most_levels} levels deep, or a part of itself; export the model again"
    )]
    #[serde(rename = "threemf-nested")]
    Nested {
        /// Name of the part.
        part: String,
        /// Line in the part, from 1.
        line: u64,
        /// Id of the object.
        object: u32,
        /// Most levels.
        most_levels: usize,
    },
    /// Objects that repeat others beyond reason.
    #[error(
        "the objects of the 3MF file repeat each other to more than {most_facets} facets; print fewer copies"
    )]
    #[serde(rename = "threemf-too-many")]
    TooMany {
        /// The most facets and components.
        most_facets: usize,
    },
    /// A coordinate is not a finite number once it is transformed.
    #[error("{part}: object {object} has coordinates too large to compute; export the model again")]
    #[serde(rename = "threemf-overflow")]
    Overflow {
        /// Name of the part.
        part: String,
        /// Id of the object.
        object: u32,
    },
    /// An object to be printed is not made of facets.
    #[error("{part}: object {object} is made of {}, which Cusp does not read; export the model as a mesh", feature.in_words())]
    #[serde(rename = "threemf-feature")]
    Feature {
        /// Name of the part.
        part: String,
        /// Id of the object.
        object: u32,
        /// Its geometry.
        feature: ThreeMfFeature,
    },
    /// The model is encrypted.
    #[error("{part}: the model is encrypted; export it without encryption")]
    #[serde(rename = "threemf-encrypted")]
    Encrypted {
        /// Name of the part.
        part: String,
    },
    /// The file says that an extension must be understood, and it is not known here.
    #[error(
        "{part}: the model requires the extension {extension}, which Cusp does not know; export it without"
    )]
    #[serde(rename = "threemf-extension")]
    Extension {
        /// Name of the part.
        part: String,
        /// Its namespace, or its prefix if that has none.
        extension: String,
    },
    /// The build has nothing that is printed.
    #[error(
        "the 3MF file has no facets to print: {skipped} of its objects are supports, surfaces or not to be printed; export the model again"
    )]
    #[serde(rename = "threemf-no-facets")]
    NoFacets {
        /// Objects that were left out.
        skipped: usize,
    },
}
