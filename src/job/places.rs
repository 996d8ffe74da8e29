//! Places of the copies on plates.

use std::sync::Arc;

use super::stages::parts::{Raster, Resolved, Sampling};
use super::stages::planned::PlannedModel;
use super::stages::prepared::Prepared;
use super::{Error, Job, JobOptions, ModelOptions, Options, Placement, Timings};
use crate::argsort::sort_by_number;
use crate::arrange::{
    ArrangeError, Item, Outline, Place, PlacedOutline, Screen, TURN_DEG, arrange, problems,
    shadow_mm2,
};
use crate::model::{Mesh, Pose, TURNS};
use crate::parallel;

/// Places of copies, before anything is sampled.
pub(super) struct Layout {
    pub resolved: Resolved,
    /// The options that the report repeats.
    pub shared: Options,
    /// A single copy of a single model, in the middle.
    pub is_alone: bool,
    /// Absent for a model alone, which needs none.
    pub screen: Option<Screen>,
    /// Ascending by plate.
    pub places: Vec<Place>,
}

impl Layout {
    /// Options of a model of its own. A model alone has all options to itself.
    pub fn own(&self, options: &JobOptions, model: usize) -> ModelOptions {
        if self.is_alone {
            return ModelOptions::default();
        }
        options.of_model(model)
    }

    /// The places of copies, plate by plate.
    pub fn plates(&self) -> impl ExactSizeIterator<Item = &[Place]> {
        let plates: Vec<_> = self.places.chunk_by(|a, b| a.plate == b.plate).collect();
        plates.into_iter()
    }
}

/// Size of a model, before turns about z.
#[derive(Debug, Clone)]
pub(super) struct Extent {
    /// In x, y and z.
    pub size_mm: [f64; 3],
    /// Its shadow on the plate, in cells.
    pub shadow: Outline,
}

/// A model in its pose before turns.
pub(super) struct Posed<'a> {
    mesh: &'a Mesh,
    pose: Pose,
    /// With its supports, if it has some.
    prepared: Option<&'a Arc<Prepared>>,
}

impl Posed<'_> {
    /// Hands what stands on the plate after turns to `see`.
    fn seen<T>(&self, turns: u32, see: impl Fn(&Mesh) -> T) -> Result<T, Error> {
        Ok(match self.prepared {
            Some(prepared) => see(&prepared.turned(turns)?.mesh),
            None => see(&self.mesh.on_plate(&self.pose.turned(turns))?),
        })
    }

    /// The true area of its shadow.
    pub fn shadow_mm2(&self) -> Result<f64, Error> {
        self.seen(0, shadow_mm2)
    }

    /// Its extent in x, y and z, which one of its turns knows if it is none.
    pub fn size_mm(&self, turned: &[PlannedModel]) -> Result<[f64; 3], Error> {
        let size_of = |mesh: &Mesh| self.sized(mesh);
        match turned.iter().find(|it| it.turns == 0) {
            Some(upright) => Ok(size_of(upright.sampled().mesh())),
            None => self.seen(0, size_of),
        }
    }

    fn sized(&self, mesh: &Mesh) -> [f64; 3] {
        let size = mesh.bounds().size();
        [size.x, size.y, self.pose.height_mm.unwrap_or(size.z)]
    }

    fn outline(&self, turns: u32, screen: &Screen) -> Result<Outline, Error> {
        self.seen(turns, |mesh| Outline::of(mesh, screen))
    }

    fn extent(&self, screen: &Screen) -> Result<Extent, Error> {
        self.seen(0, |mesh| Extent {
            size_mm: self.sized(mesh),
            shadow: Outline::of(mesh, screen),
        })
    }
}

impl Job {
    /// Arranges copies: on the fewest plates, then the lowest. Returns their places.
    ///
    /// # Errors
    /// [`Error::Arrange`], [`Error::Options`], [`Error::Mesh`].
    pub fn arrange(&mut self, options: &JobOptions) -> Result<Vec<Placement>, Error> {
        options.check()?;
        let resolved = options.options.resolve()?;
        let screen = screen_of(&resolved.sampling)?;
        self.prepare_silently(options, &resolved)?;
        let extents = self.extents(options, &resolved, &screen)?;
        let places = self.arranged(options, &resolved, &screen, &extents)?;
        Ok(places
            .iter()
            .map(|place| placement(Some(&screen), place))
            .collect())
    }

    pub(super) fn arranged(
        &self,
        options: &JobOptions,
        resolved: &Resolved,
        screen: &Screen,
        extents: &[Extent],
    ) -> Result<Vec<Place>, Error> {
        if self.models.is_empty() {
            return Err(ArrangeError::Empty.into());
        }
        let outline_of = |(model, extent): (usize, &Extent)| {
            let posed = self.posed(options, resolved, model);
            let shadow = extent.shadow.clone();
            move |turns| match turns {
                0 => Ok(shadow.clone()),
                _ => posed.outline(turns, screen),
            }
        };
        let outlines: Vec<_> = extents.iter().enumerate().map(outline_of).collect();
        let items = outlines.iter().zip(extents).enumerate();
        let items: Vec<_> = items
            .map(|(model, (outline, extent))| Item {
                copies: options.of_model(model).copies,
                height_mm: extent.size_mm[2],
                outline,
            })
            .collect();
        if items.iter().all(|item| item.copies == 0) {
            return Err(ArrangeError::Empty.into());
        }
        arrange(screen, &options.arranging, &items)
    }

    /// The extent of each model and of its shadow.
    pub(super) fn extents(
        &self,
        options: &JobOptions,
        resolved: &Resolved,
        screen: &Screen,
    ) -> Result<Vec<Extent>, Error> {
        let posed = (0..self.models.len()).map(|model| self.posed(options, resolved, model));
        parallel::map(posed.collect(), |posed: Posed<'_>| posed.extent(screen))
            .into_iter()
            .collect()
    }

    fn prepare_silently(&mut self, options: &JobOptions, resolved: &Resolved) -> Result<(), Error> {
        let mut silent = |_, _| std::ops::ControlFlow::Continue(());
        self.prepare(options, resolved, &mut Timings::default(), &mut silent)
    }

    pub(super) fn posed(
        &self,
        options: &JobOptions,
        resolved: &Resolved,
        model: usize,
    ) -> Posed<'_> {
        Posed {
            mesh: &self.models[model].mesh,
            pose: self.pose_of(options, resolved, model),
            prepared: self.prepared.get(model).and_then(Option::as_ref),
        }
    }

    /// The sampling of a model, after turns.
    pub(super) fn sampling_of(
        &self,
        options: &JobOptions,
        resolved: &Resolved,
        model: usize,
        turns: u32,
    ) -> Sampling {
        let own = options.of_model(model);
        let shared = resolved.sampling.clone();
        let supports = own.supports.or(shared.supports);
        let is_supported = supports.is_some() || !self.models[model].mesh.own_tips().is_empty();
        Sampling {
            pose: self.pose_of(options, resolved, model).turned(turns),
            hollow: own.hollow.or(shared.hollow),
            wider_mm: resolved.layering.support_wider_mm(is_supported),
            supports,
            ..shared
        }
    }

    /// The pose of a model before turns.
    pub(super) fn pose_of(&self, options: &JobOptions, resolved: &Resolved, model: usize) -> Pose {
        let pose = options.of_model(model).pose_over(resolved.sampling.pose);
        Pose {
            unit: pose
                .unit
                .filter(|_| self.models[model].facts.unit.is_none()),
            ..pose
        }
    }

    /// Problems with the placements of these options: copies that extend beyond their plate, and copies that overlap.
    ///
    /// # Errors
    /// [`Error::Arrange`], [`Error::Options`], [`Error::Mesh`].
    pub fn problems(&mut self, options: &JobOptions) -> Result<Vec<ArrangeError>, Error> {
        options.check_count()?;
        let resolved = options.options.resolve()?;
        let screen = screen_of(&resolved.sampling)?;
        self.prepare_silently(options, &resolved)?;
        let places = self.places(&screen, &options.placements)?;
        self.problems_of(options, &resolved, &screen, &places)
    }

    pub(super) fn places(
        &self,
        screen: &Screen,
        placements: &[Placement],
    ) -> Result<Vec<Place>, ArrangeError> {
        let mut placed = vec![0; self.models.len()];
        let places = placements.iter().map(|placement| {
            self.check_model(placement.model)?;
            let copy = placed[placement.model];
            placed[placement.model] += 1;
            if placement.turn_deg % TURN_DEG != 0 {
                return Err(ArrangeError::BadTurn {
                    turn_deg: placement.turn_deg,
                });
            }
            Ok(Place {
                item: placement.model,
                copy,
                turns: placement.turn_deg / TURN_DEG % TURNS,
                offset: screen.offset(placement.x_mm, placement.y_mm),
                plate: placement.plate,
            })
        });
        let mut places = places.collect::<Result<Vec<_>, _>>()?;
        sort_by_number(&mut places, |place| place.item as f64);
        sort_by_number(&mut places, |place| place.plate as f64);
        Ok(places)
    }

    pub(super) fn problems_of(
        &self,
        options: &JobOptions,
        resolved: &Resolved,
        screen: &Screen,
        places: &[Place],
    ) -> Result<Vec<ArrangeError>, Error> {
        let pixels = screen.by_pixels();
        let kinds = kinds(places);
        let turned = kinds
            .iter()
            .map(|&(model, turns)| (self.posed(options, resolved, model), turns));
        let outlines = parallel::map(turned.collect(), |(posed, turns): (Posed<'_>, u32)| {
            posed.outline(turns, &pixels)
        });
        let outlines = outlines.into_iter().collect::<Result<Vec<_>, _>>()?;
        let mut found = Vec::new();
        for on_plate in places.chunk_by(|a, b| a.plate == b.plate) {
            let standing = on_plate.iter().filter_map(|place| {
                let kind = kinds.binary_search(&(place.item, place.turns)).ok()?;
                Some(PlacedOutline {
                    item: place.item,
                    copy: place.copy,
                    outline: &outlines[kind],
                    offset: place.offset,
                })
            });
            let standing: Vec<_> = standing.collect();
            found.extend(problems(&pixels, on_plate[0].plate, &standing));
        }
        Ok(found)
    }
}

/// The screen that the plate has.
pub(super) fn screen_of(sampling: &Sampling) -> Result<Screen, ArrangeError> {
    match sampling.raster {
        Raster::Plate { pixels, pitch_mm } => Ok(Screen::new(pixels, pitch_mm)),
        _ => Err(ArrangeError::NoSize),
    }
}

/// Without a screen, a place is in the middle.
pub(super) fn placement(screen: Option<&Screen>, place: &Place) -> Placement {
    let offset_mm = screen.map(|screen| screen.offset_mm(place.offset));
    let [x_mm, y_mm] = offset_mm.unwrap_or_default();
    Placement {
        model: place.item,
        plate: place.plate,
        x_mm,
        y_mm,
        turn_deg: place.turns * TURN_DEG,
    }
}

/// The models and turns in which copies stand, in ascending order.
pub(super) fn kinds(places: &[Place]) -> Vec<(usize, u32)> {
    let kinds = places.iter().map(|place| (place.item, place.turns));
    let mut kinds: Vec<_> = kinds.collect();
    kinds.sort_unstable();
    kinds.dedup();
    kinds
}
