//! The build of a 3MF: the facets of its items, with components inside components, each placed by its transforms.

use std::rc::Rc;

use glam::{DAffine3, DVec3};
use rustc_hash::FxHashMap;

use super::ThreeMfError;
use super::model::{self, Model, Object, Reference};
use super::package::Package;
use super::settings::Settings;
use crate::model::read::{Part, PartKind, PlateChoice, Triangles};

/// Levels of components.
const MOST_LEVELS: usize = 64;

/// Times that a file may repeat each of its facets and components on average, and how many it may repeat however few it has, so that a
/// small file cannot fill the memory.
const MOST_REPEATS: usize = 256;
const MOST_REPEATED: usize = 1 << 20;

/// The facets of a build, in millimetres.
pub struct Build<'a> {
    package: &'a Package<'a>,
    /// The parts that have been read, by name.
    models: FxHashMap<String, Rc<Model>>,
    /// Facets and components in these parts.
    stored: usize,
    /// Facets and components that were placed.
    placed: usize,
    settings: &'a Settings,
    /// True if surfaces are placed, too.
    surfaces: bool,
    pub triangles: Triangles,
    /// The facets of parts that are subtracted.
    pub negative: Triangles,
    /// Objects that are not printed.
    pub skipped: usize,
    /// Parts that are no solids, each once.
    pub parts: Vec<Part>,
}

impl<'a> Build<'a> {
    /// Builds the items of the model that a package starts with: all, or those on a plate.
    pub fn of(
        package: &'a Package<'a>,
        start: &str,
        settings: &'a Settings,
        plate: Option<PlateChoice>,
        surfaces: bool,
    ) -> Result<(Self, Rc<Model>), ThreeMfError> {
        let mut build = Self {
            package,
            models: FxHashMap::default(),
            stored: 0,
            placed: 0,
            settings,
            surfaces,
            triangles: Triangles::new(),
            negative: Triangles::new(),
            skipped: 0,
            parts: Vec::new(),
        };
        let root = build.model(start)?;
        let unit = DAffine3::from_scale(DVec3::splat(root.unit.mm()));
        let chosen = plate.and_then(|it| settings.plates.get(it.plate_number as usize - 1));
        let mut instances = FxHashMap::default();
        for item in &root.items {
            let next: &mut u32 = instances.entry(item.object).or_default();
            let instance = (item.object, *next);
            *next += 1;
            if chosen.is_none_or(|plate| plate.contains(&instance)) {
                build.place(&root, item, unit, 0, None)?;
            }
        }
        Ok((build, root))
    }

    /// Reads a part, unless it has been read.
    fn model(&mut self, part: &str) -> Result<Rc<Model>, ThreeMfError> {
        let Some(name) = self.package.find(part) else {
            let part = crate::model::read::text::named(part.as_bytes());
            return Err(ThreeMfError::NoPart { part });
        };
        if let Some(model) = self.models.get(name) {
            return Ok(Rc::clone(model));
        }
        let model = Rc::new(model::read(self.package.open(name)?)?);
        for object in model.objects.values() {
            self.stored += object.facets.len() + object.components.len();
        }
        self.models.insert(name.to_owned(), Rc::clone(&model));
        Ok(model)
    }

    /// Places the object of a reference. `to_mm` leads from the model's coordinates to millimetres on the plate.
    fn place(
        &mut self,
        from: &Rc<Model>,
        reference: &Reference,
        to_mm: DAffine3,
        level: usize,
        part: Option<&Part>,
    ) -> Result<(), ThreeMfError> {
        if !reference.is_printable {
            self.skipped += 1;
            return Ok(());
        }
        let model = match &reference.part {
            Some(part) => self.model(part)?,
            None => Rc::clone(from),
        };
        let id = reference.object;
        let Some(object) = model.objects.get(&id) else {
            return Err(ThreeMfError::NoObject {
                part: from.part.clone(),
                line: reference.line,
                object: id,
            });
        };
        if !(object.is_solid || self.surfaces && object.is_surface) {
            self.skipped += 1;
            return Ok(());
        }
        if level == MOST_LEVELS {
            return Err(ThreeMfError::Nested {
                part: from.part.clone(),
                line: reference.line,
                object: id,
                most_levels: MOST_LEVELS,
            });
        }
        if let Some(feature) = object.feature {
            return Err(ThreeMfError::Feature {
                part: model.part.clone(),
                object: id,
                feature,
            });
        }
        self.placed += 1 + object.facets.len();
        let most_facets = MOST_REPEATED + MOST_REPEATS * self.stored;
        if self.placed > most_facets {
            return Err(ThreeMfError::TooMany { most_facets });
        }
        let mut to_mm = to_mm * reference.transform;
        if model.unit != from.unit {
            to_mm *= DAffine3::from_scale(DVec3::splat(model.unit.mm() / from.unit.mm()));
        }
        if !self.add(id, object, to_mm, part) {
            return Err(ThreeMfError::Overflow {
                part: model.part.clone(),
                object: id,
            });
        }
        let mut components = object.components.iter();
        let settings = self.settings;
        components.try_for_each(|component| {
            let own = settings.component(id, component.object);
            self.place(&model, component, to_mm, level + 1, own.or(part))
        })
    }

    /// Adds the facets of an object, of which all or some may be a part that is no solid. A transform that mirrors turns them over, so that they face outward again. `false` if a
    /// coordinate is not finite.
    fn add(&mut self, id: u32, object: &Object, to_mm: DAffine3, part: Option<&Part>) -> bool {
        let vertices = object.vertices.iter();
        let vertices = vertices.map(|vertex| to_mm.transform_point3(vertex.as_dvec3()).as_vec3());
        let vertices: Vec<_> = vertices.collect();
        let mirrors = to_mm.matrix3.determinant() < 0.0;
        let facets = object.facets.iter().map(|&[a, b, c]| {
            let corners = if mirrors { [a, c, b] } else { [a, b, c] };
            corners.map(|corner| vertices[corner as usize])
        });
        if part.is_none() && !self.settings.has_ranges(id) {
            self.triangles.extend(facets);
        } else {
            for (index, corners) in facets.enumerate() {
                let own = self.settings.facet(id, index as u32);
                match own.or(part) {
                    None => self.triangles.push(corners),
                    Some(part) => {
                        if !self.parts.contains(part) {
                            self.parts.push(part.clone());
                        }
                        if part.kind == PartKind::Negative {
                            self.negative.push(corners);
                        }
                    }
                }
            }
        }
        vertices.iter().all(|vertex| vertex.is_finite())
    }
}
