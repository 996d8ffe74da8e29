//! What a 3MF builds: the facets of its items, with components inside components, each where its transforms put it.

use std::rc::Rc;

use glam::{DAffine3, DVec3};
use rustc_hash::FxHashMap;

use super::ThreeMfError;
use super::model::{self, Model, Object, Reference};
use super::package::Package;
use crate::model::read::Triangles;

/// Levels of components.
const MOST_LEVELS: usize = 64;

/// Facets and components that a file may come to, besides those that are in it, so that a small file cannot repeat its
/// objects for ever.
const MOST_REPEATED: usize = 1 << 24;

/// The facets of a build, in millimetres.
pub struct Build<'a> {
    package: &'a Package<'a>,
    /// The parts that have been read, by name.
    models: FxHashMap<String, Rc<Model>>,
    /// Facets and components in these parts.
    stored: usize,
    /// Facets and components that were placed.
    placed: usize,
    pub triangles: Triangles,
    /// Objects that are not printed.
    pub skipped: usize,
}

impl<'a> Build<'a> {
    /// Builds all items of the model that a package starts with.
    pub fn of(package: &'a Package<'a>, start: &str) -> Result<(Self, Rc<Model>), ThreeMfError> {
        let mut build = Self {
            package,
            models: FxHashMap::default(),
            stored: 0,
            placed: 0,
            triangles: Triangles::new(),
            skipped: 0,
        };
        let root = build.model(start)?;
        let unit = DAffine3::from_scale(DVec3::splat(root.unit.mm()));
        for item in &root.items {
            build.place(&root, item, unit, 0)?;
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

    /// Places what a model refers to. `to_mm` leads from the model's coordinates to millimetres on the plate.
    fn place(
        &mut self,
        from: &Rc<Model>,
        reference: &Reference,
        to_mm: DAffine3,
        level: usize,
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
        if !object.is_solid {
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
        let most_facets = MOST_REPEATED + self.stored;
        if self.placed > most_facets {
            return Err(ThreeMfError::TooMany { most_facets });
        }
        let mut to_mm = to_mm * reference.transform;
        if model.unit != from.unit {
            to_mm *= DAffine3::from_scale(DVec3::splat(model.unit.mm() / from.unit.mm()));
        }
        if !self.add(object, to_mm) {
            return Err(ThreeMfError::Overflow {
                part: model.part.clone(),
                object: id,
            });
        }
        let mut components = object.components.iter();
        components.try_for_each(|component| self.place(&model, component, to_mm, level + 1))
    }

    /// Adds the facets of an object. A transform that mirrors turns them over, so that they face outward again. `false` if a
    /// coordinate is not finite.
    fn add(&mut self, object: &Object, to_mm: DAffine3) -> bool {
        let vertices = object.vertices.iter();
        let vertices = vertices.map(|vertex| to_mm.transform_point3(vertex.as_dvec3()).as_vec3());
        let vertices: Vec<_> = vertices.collect();
        let mirrors = to_mm.matrix3.determinant() < 0.0;
        let facets = object.facets.iter().map(|&[a, b, c]| {
            let corners = if mirrors { [a, c, b] } else { [a, b, c] };
            corners.map(|corner| vertices[corner as usize])
        });
        self.triangles.extend(facets);
        vertices.iter().all(|vertex| vertex.is_finite())
    }
}
