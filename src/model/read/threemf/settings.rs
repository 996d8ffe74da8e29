//! Slicers' own files in a 3MF: the parts that are subtracted, the parts that only guide the slicer, and the parts of each plate. OrcaSlicer and Bambu Studio name components, PrusaSlicer ranges of facets.

use std::ops::RangeInclusive;

use rustc_hash::FxHashMap;

use super::package::Package;
use super::xml::{Attributes, Tag, Tags, unescaped};
use super::{ThreeMfError, XmlFault};
use crate::model::read::text::named;
use crate::model::read::{Part, PartKind};

/// The file of OrcaSlicer and Bambu Studio.
const ORCA: &str = "Metadata/model_settings.config";
/// The file of PrusaSlicer.
const PRUSA: &str = "Metadata/Slic3r_PE_model.config";

/// The attributes that matter.
const ATTRIBUTES: [&[u8]; 6] = [b"id", b"subtype", b"firstid", b"lastid", b"key", b"value"];

/// Parts that are no solids, and plates.
#[derive(Default)]
pub struct Settings {
    /// Parts by object and component.
    components: FxHashMap<(u32, u32), Part>,
    /// Parts by object and facets, in order.
    ranges: FxHashMap<u32, Vec<(RangeInclusive<u32>, Part)>>,
    /// The instances on each plate: object, and its instance counted from 0.
    pub plates: Vec<Vec<(u32, u32)>>,
}

impl Settings {
    /// Reads the settings of a package.
    pub fn of(package: &Package<'_>) -> Result<Self, ThreeMfError> {
        let mut reader = Reader::default();
        for part in [ORCA, PRUSA] {
            let Some(part) = package.find(part) else {
                continue;
            };
            let mut tags = Tags::of(package.open(part)?)?;
            while let Some(tag) = tags.next()? {
                if let Err(fault) = reader.take(tag) {
                    return Err(tags.fault(fault));
                }
            }
        }
        // A plate without anything on it is nothing to choose.
        reader.settings.plates.retain(|plate| !plate.is_empty());
        Ok(reader.settings)
    }

    /// The part that a component is, if it is no solid.
    pub fn component(&self, object: u32, component: u32) -> Option<&Part> {
        self.components.get(&(object, component))
    }

    /// The part that a facet belongs to, if that is no solid.
    pub fn facet(&self, object: u32, facet: u32) -> Option<&Part> {
        let mut ranges = self.ranges.get(&object)?.iter();
        ranges.find_map(|(range, part)| range.contains(&facet).then_some(part))
    }

    /// Returns true if any facets of an object are no solid.
    pub fn has_ranges(&self, object: u32) -> bool {
        self.ranges.contains_key(&object)
    }
}

#[derive(Default)]
struct Reader {
    settings: Settings,
    object: Option<u32>,
    /// The component or the facets that are being described.
    place: Option<Place>,
    kind: Option<PartKind>,
    name: String,
    /// Object and instance on a plate.
    instance: [Option<u32>; 2],
}

enum Place {
    Component(u32),
    Facets(RangeInclusive<u32>),
}

impl Reader {
    fn take(&mut self, tag: Tag<'_>) -> Result<(), XmlFault> {
        match tag {
            Tag::Start {
                name,
                attributes,
                is_empty,
            } => {
                self.start(name, attributes)?;
                if is_empty {
                    self.end(name);
                }
            }
            Tag::End { name } => self.end(name),
        }
        Ok(())
    }

    fn start(&mut self, name: &[u8], attributes: Attributes<'_>) -> Result<(), XmlFault> {
        let mut given: [Option<&[u8]>; 6] = [None; 6];
        for attribute in attributes {
            let (name, value) = attribute?;
            if let Some(place) = ATTRIBUTES.iter().position(|it| *it == name) {
                given[place] = Some(value);
            }
        }
        let [id, subtype, first, last, key, value] = given;
        let number = |value: Option<&[u8]>| str::from_utf8(value?).ok()?.trim().parse().ok();
        match name {
            b"object" => self.object = number(id),
            b"part" => {
                self.begin(number(id).map(Place::Component));
                self.kind = subtype.and_then(kind);
            }
            b"volume" => {
                let range = number(first).zip(number(last));
                self.begin(range.map(|(first, last)| Place::Facets(first..=last)));
            }
            b"plate" => self.settings.plates.push(Vec::new()),
            b"model_instance" => self.instance = [None; 2],
            b"metadata" => match (key.unwrap_or_default(), value.unwrap_or_default()) {
                (b"name", value) if self.place.is_some() => self.name = named(&unescaped(value)),
                (b"volume_type", value) if self.place.is_some() => self.kind = kind(value),
                // Written by PrusaSlicer before it had volume types.
                (b"modifier", b"1") if self.kind.is_none() => self.kind = Some(PartKind::Modifier),
                (b"object_id", value) => self.instance[0] = number(Some(value)),
                (b"instance_id", value) => self.instance[1] = number(Some(value)),
                _ => (),
            },
            _ => (),
        }
        Ok(())
    }

    fn begin(&mut self, place: Option<Place>) {
        self.place = place;
        self.kind = None;
        self.name.clear();
    }

    fn end(&mut self, name: &[u8]) {
        match name {
            b"part" | b"volume" => {
                let place = self.place.take();
                let (Some(object), Some(place), Some(kind)) = (self.object, place, self.kind)
                else {
                    return;
                };
                let mut name = std::mem::take(&mut self.name);
                if name.is_empty() {
                    name = match &place {
                        Place::Component(id) => id.to_string(),
                        Place::Facets(range) => range.start().to_string(),
                    };
                }
                let part = Part { name, kind };
                match place {
                    Place::Component(id) => {
                        self.settings.components.insert((object, id), part);
                    }
                    Place::Facets(range) => {
                        let ranges = self.settings.ranges.entry(object).or_default();
                        ranges.push((range, part));
                    }
                }
            }
            b"object" => self.object = None,
            b"model_instance" => {
                if let ([Some(object), Some(instance)], Some(plate)) =
                    (self.instance, self.settings.plates.last_mut())
                {
                    plate.push((object, instance));
                }
            }
            _ => (),
        }
    }
}

/// The kind of a part by its name in either program; `None` for a solid.
fn kind(name: &[u8]) -> Option<PartKind> {
    match name {
        b"negative_part" | b"NegativeVolume" => Some(PartKind::Negative),
        b"modifier_part" | b"ParameterModifier" => Some(PartKind::Modifier),
        b"support_blocker" | b"SupportBlocker" => Some(PartKind::SupportBlocker),
        b"support_enforcer" | b"SupportEnforcer" => Some(PartKind::SupportEnforcer),
        _ => None,
    }
}
