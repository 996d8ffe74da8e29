//! A model part: its objects, and the items of its build.

use glam::{DAffine3, Vec3};
use rustc_hash::FxHashMap;

use super::namespaces::{Namespace, Namespaces, split};
use super::package::Part;
use super::values::{Fault, bad, facet, number, transform, vertex};
use super::xml::{Attributes, Tag, Tags, unescaped};
use super::{ThreeMfError, ThreeMfFeature, XmlFault};
use crate::model::ModelUnit;
use crate::model::read::text::named;

/// Elements inside each other; a model has six.
const MOST_DEPTH: usize = 64;

/// Contents of a model part.
pub struct Model {
    /// Name of the part.
    pub part: String,
    pub unit: ModelUnit,
    pub objects: FxHashMap<u32, Object>,
    /// Items of the build.
    pub items: Vec<Reference>,
}

/// An object that can be built, or be a component of others.
#[derive(Default)]
pub struct Object {
    /// True if it is printed as a solid: a model or a solid support.
    pub is_solid: bool,
    /// True if it is a surface, which need not enclose anything.
    pub is_surface: bool,
    pub vertices: Vec<Vec3>,
    pub facets: Vec<[u32; 3]>,
    pub components: Vec<Reference>,
    /// Geometry other than facets, if it has any.
    pub feature: Option<ThreeMfFeature>,
}

/// An object put somewhere.
pub struct Reference {
    pub object: u32,
    /// The part that has it, if it is another.
    pub part: Option<String>,
    pub transform: DAffine3,
    /// True if it is to be printed.
    pub is_printable: bool,
    /// Line of the reference.
    pub line: u64,
}

/// The elements that matter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Element {
    Model,
    Resources,
    Object,
    Mesh,
    Vertices,
    Vertex,
    Triangles,
    Triangle,
    Components,
    Component,
    Build,
    Item,
    Other,
}

impl Element {
    /// The element of this name in another.
    fn within(parent: Option<Self>, name: &[u8]) -> Self {
        match (parent, name) {
            (None, b"model") => Self::Model,
            (Some(Self::Model), b"resources") => Self::Resources,
            (Some(Self::Model), b"build") => Self::Build,
            (Some(Self::Resources), b"object") => Self::Object,
            (Some(Self::Object), b"mesh") => Self::Mesh,
            (Some(Self::Object), b"components") => Self::Components,
            (Some(Self::Mesh), b"vertices") => Self::Vertices,
            (Some(Self::Mesh), b"triangles") => Self::Triangles,
            (Some(Self::Vertices), b"vertex") => Self::Vertex,
            (Some(Self::Triangles), b"triangle") => Self::Triangle,
            (Some(Self::Components), b"component") => Self::Component,
            (Some(Self::Build), b"item") => Self::Item,
            _ => Self::Other,
        }
    }
}

/// Reads a model part.
pub fn read(part: Part<'_>) -> Result<Model, ThreeMfError> {
    let mut tags = Tags::of(part)?;
    let mut reader = Reader::new(tags.part());
    while let Some(tag) = tags.next()? {
        if let Err(fault) = reader.take(tag) {
            return Err(fault.at(&tags));
        }
        if let Some(reference) = reader.unnumbered() {
            reference.line = tags.line();
        }
    }
    if !reader.open.is_empty() || !reader.has_model {
        return Err(tags.fault(XmlFault::CutShort));
    }
    Ok(reader.model)
}

/// Makes a model of tags.
struct Reader {
    model: Model,
    namespaces: Namespaces,
    /// The open elements, and the lengths of `names` before them.
    open: Vec<(Element, usize)>,
    /// The names of the open elements.
    names: Vec<u8>,
    has_model: bool,
    /// The object that is being read, and its id.
    object: Object,
    id: u32,
}

impl Reader {
    fn new(part: &str) -> Self {
        Self {
            model: Model {
                part: part.to_owned(),
                unit: ModelUnit::Millimeter,
                objects: FxHashMap::default(),
                items: Vec::new(),
            },
            namespaces: Namespaces::default(),
            open: Vec::new(),
            names: Vec::new(),
            has_model: false,
            object: Object::default(),
            id: 0,
        }
    }

    fn take(&mut self, tag: Tag<'_>) -> Result<(), Fault> {
        match tag {
            Tag::Start {
                name,
                attributes,
                is_empty,
            } => {
                let element = self.start(name, attributes)?;
                if is_empty {
                    return self.end(element);
                }
                if self.open.len() >= MOST_DEPTH {
                    return Err(XmlFault::Deep.into());
                }
                self.open.push((element, self.names.len()));
                self.names.extend(name);
                Ok(())
            }
            Tag::End { name } => {
                let (element, before) = self.open.pop().ok_or(XmlFault::WrongEndTag)?;
                if self.names[before..] != *name {
                    return Err(XmlFault::WrongEndTag.into());
                }
                self.names.truncate(before);
                self.end(element)
            }
        }
    }

    /// The last reference, if its line is not known yet.
    fn unnumbered(&mut self) -> Option<&mut Reference> {
        let references = match self.open.last() {
            Some((Element::Components | Element::Component, _)) => &mut self.object.components,
            Some((Element::Build | Element::Item, _)) => &mut self.model.items,
            _ => return None,
        };
        references.last_mut().filter(|last| last.line == 0)
    }

    fn start(&mut self, name: &[u8], attributes: Attributes<'_>) -> Result<Element, Fault> {
        let parent = self.open.last().map(|&(element, _)| element);
        // Nearly all elements: they declare nothing.
        match (parent, split(name).1) {
            (Some(Element::Vertices), b"vertex") => {
                self.object.vertices.push(vertex(attributes)?);
                return Ok(Element::Vertex);
            }
            (Some(Element::Triangles), b"triangle") => {
                let facet = facet(attributes)?;
                self.object.facets.push(facet);
                return Ok(Element::Triangle);
            }
            _ => (),
        }
        self.namespaces
            .declare(self.open.len() + 1, attributes.clone())?;
        let (namespace, local) = self.namespaces.split(name);
        let element = if namespace == Namespace::Core {
            Element::within(parent, local)
        } else {
            self.extension(local);
            Element::Other
        };
        match element {
            Element::Model => self.model(attributes)?,
            Element::Object => self.object(attributes)?,
            Element::Component => {
                let component = self.reference(attributes)?;
                self.object.components.push(component);
            }
            Element::Item => {
                let item = self.reference(attributes)?;
                self.model.items.push(item);
            }
            _ => (),
        }
        Ok(element)
    }

    fn end(&mut self, element: Element) -> Result<(), Fault> {
        self.namespaces.leave(self.open.len());
        if element == Element::Object {
            let object = std::mem::take(&mut self.object);
            let vertices = object.vertices.len();
            // Facets may come before their vertices.
            let mut corners = object.facets.iter().flatten();
            if let Some(&vertex) = corners.find(|&&corner| corner as usize >= vertices) {
                let vertices = vertices as u64;
                return Err(Fault::NoVertex { vertex, vertices });
            }
            self.model.objects.insert(self.id, object);
        }
        Ok(())
    }

    fn model(&mut self, attributes: Attributes<'_>) -> Result<(), Fault> {
        self.has_model = true;
        for attribute in attributes {
            match attribute? {
                (b"unit", name) => {
                    let unit = ModelUnit::named(name.trim_ascii());
                    self.model.unit = unit.ok_or_else(|| bad("unit", name))?;
                }
                (b"requiredextensions", prefixes) => {
                    let prefixes = prefixes.split(u8::is_ascii_whitespace);
                    for prefix in prefixes.filter(|prefix| !prefix.is_empty()) {
                        self.require(prefix)?;
                    }
                }
                _ => (),
            }
        }
        Ok(())
    }

    /// Checks that a required extension can be read.
    fn require(&self, prefix: &[u8]) -> Result<(), Fault> {
        let (namespace, uri) = self.namespaces.of(prefix);
        match namespace {
            Namespace::SecureContent => Err(Fault::Encrypted),
            Namespace::Other => {
                let name = if uri.is_empty() { prefix } else { uri };
                Err(Fault::Extension(named(name)))
            }
            _ => Ok(()),
        }
    }

    fn object(&mut self, attributes: Attributes<'_>) -> Result<(), Fault> {
        self.object = Object {
            is_solid: true,
            ..Object::default()
        };
        let mut id = None;
        for attribute in attributes {
            let (name, value) = attribute?;
            match split(name) {
                (b"", b"id") => id = Some(number::<u32>("id", value)?),
                (b"", b"type") => {
                    self.object.is_solid = matches!(value, b"model" | b"solidsupport" | b"");
                    self.object.is_surface = value == b"surface";
                }
                (_, b"meshresolution") if value == b"lowres" => {
                    self.object.feature = Some(ThreeMfFeature::Slices);
                }
                _ => (),
            }
        }
        self.id = id.ok_or_else(|| bad("id", b""))?;
        Ok(())
    }

    /// Notes what an element of an extension makes the object of.
    fn extension(&mut self, name: &[u8]) {
        let feature = match name {
            b"beamlattice" => ThreeMfFeature::BeamLattice,
            b"displacementmesh" => ThreeMfFeature::Displacement,
            b"booleanshape" => ThreeMfFeature::Booleans,
            b"levelset" | b"volumedata" => ThreeMfFeature::Volumetric,
            _ => return,
        };
        self.object.feature = Some(feature);
    }

    fn reference(&self, attributes: Attributes<'_>) -> Result<Reference, Fault> {
        let mut object = None;
        let mut reference = Reference {
            object: 0,
            part: None,
            transform: DAffine3::IDENTITY,
            is_printable: true,
            line: 0,
        };
        for attribute in attributes {
            let (name, value) = attribute?;
            match split(name) {
                (b"", b"objectid") => object = Some(number::<u32>("objectid", value)?),
                (b"", b"transform") => reference.transform = transform(value)?,
                // Not in the specification, but what PrusaSlicer and its kin write.
                (_, b"printable") => reference.is_printable = value != b"0",
                (prefix, b"path") if self.namespaces.of(prefix).0 == Namespace::Production => {
                    let path = unescaped(value);
                    reference.part = Some(String::from_utf8_lossy(&path).into_owned());
                }
                _ => (),
            }
        }
        reference.object = object.ok_or_else(|| bad("objectid", b""))?;
        Ok(reference)
    }
}
