//! Places of the copies on plates.

use super::shapes::Upright;
use super::stages::parts::{Raster, Resolved, Sampling};
use super::{Error, Job, JobOptions, ModelOptions, Options, Placement, Timings};
use crate::argsort::sort_by_number;
use crate::arrange::{
    ArrangeError, Item, Place, PlacedOutline, Screen, TURN_DEG, arrange, problems,
};
use crate::model::{Pose, TURNS};
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
        let places = self.arranged(options, &resolved, &screen)?;
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
    ) -> Result<Vec<Place>, Error> {
        if self.models.is_empty() {
            return Err(ArrangeError::Empty.into());
        }
        let outline_of = |model| {
            let upright = self.upright(options, resolved, model);
            move |turns| upright.outline(turns, screen)
        };
        let outlines: Vec<_> = (0..self.models.len()).map(outline_of).collect();
        let items = outlines.iter().enumerate();
        let items: Vec<_> = items
            .map(|(model, outline)| Item {
                copies: options.of_model(model).copies,
                height_mm: self.size_mm(options, resolved, model)[2],
                outline,
            })
            .collect();
        if items.iter().all(|item| item.copies == 0) {
            return Err(ArrangeError::Empty.into());
        }
        arrange(screen, &options.arranging, &items)
    }

    /// The extent of a prepared model in x, y and z, before turns.
    pub(super) fn size_mm(
        &self,
        options: &JobOptions,
        resolved: &Resolved,
        model: usize,
    ) -> [f64; 3] {
        let size = self.prepared[model].surface.size();
        let asked_mm = self.pose_of(options, resolved, model).height_mm;
        [size.x, size.y, asked_mm.unwrap_or(size.z)]
    }

    fn prepare_silently(&mut self, options: &JobOptions, resolved: &Resolved) -> Result<(), Error> {
        let mut silent = |_, _| std::ops::ControlFlow::Continue(());
        self.prepare(
            options,
            resolved,
            options.may_turn(),
            &mut Timings::default(),
            &mut silent,
        )
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
        let standing = kinds
            .iter()
            .map(|&(model, turns)| (self.upright(options, resolved, model), turns));
        let outlines = parallel::map(
            standing.collect(),
            |(upright, turns): (Upright<'_>, u32)| upright.outline(turns, &pixels),
        );
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
