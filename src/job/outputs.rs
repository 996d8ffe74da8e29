//! Outputs of the plan of a plate: profiles, masks, findings and print files.

use std::io::Write;
use std::sync::Arc;

use glam::DVec2;
use serde::Serialize;

use super::loaded::{positions, positions_of};
use super::plates::{LayerGroups, Plate};
use super::stages::prepared::Prepared;
use super::stages::stage::{Stage, StageProgress};
use super::{Error, Job, Report};
use crate::arrange::{self, ArrangeError, TURN_DEG};
use crate::inspect::{self, Finding, Limits, Printability, Verdict};
use crate::ldi::LdiError;
use crate::model::{FacetClass, Mesh};
use crate::plan::Plan;
use crate::prepare::{Shell, plugs};
use crate::profile::{Metric, Profile, Source};

/// Printability of a plate.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct PlatePrintability {
    /// The largest severity of all findings.
    pub verdict: Verdict,
    /// The findings on each model.
    pub models: Vec<ModelPrintability>,
}

/// Printability of a model on a plate. Copies that stand alike are all alike.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct ModelPrintability {
    /// The model, by its index in the job. One that also stands turned about z is there once for each turn.
    pub model: usize,
    /// Turn about z of the copies that it is about. Findings are at places of the turned model, as if it stood in the middle.
    pub turn_deg: u32,
    /// Findings on it, as if it stood alone.
    #[serde(flatten)]
    pub found: Printability,
}

impl Job {
    pub(super) fn plate_mut(&mut self, plate: usize) -> Result<&mut Plate, Error> {
        self.plate(plate)?;
        Ok(&mut self.plates[plate])
    }

    fn plate(&self, plate: usize) -> Result<&Plate, Error> {
        let plates = self.plates.len();
        if plates == 0 {
            return Err(Error::NoPlan);
        }
        let found = self.plates.get(plate);
        Ok(found.ok_or(ArrangeError::NoPlate {
            plate_number: plate + 1,
            plates,
        })?)
    }

    /// A model of the last plan before turns: on the plate, with its voids and supports.
    fn prepared(&self, model: usize) -> Result<Option<&Prepared>, Error> {
        self.check_model(model)?;
        let mut upright = self.plates.iter().flat_map(|plate| &plate.upright);
        Ok(upright
            .find(|(of, _)| *of == model)
            .map(|(_, prepared)| &**prepared))
    }

    /// The mesh of a model that the last plan was made for: on the plate, with its voids and supports. `None` without a plan.
    ///
    /// # Errors
    /// [`Error::Arrange`] if there is no such model.
    pub fn prepared_mesh(&self, model: usize) -> Result<Option<&Mesh>, Error> {
        Ok(self.prepared(model)?.map(|prepared| &prepared.mesh))
    }

    /// Vertex positions of a model's facets of a class in the last plan, nine numbers per facet, in millimetres from the plate: for a
    /// copy that is not turned, around x = y = 0. None without a plan.
    ///
    /// # Errors
    /// [`Error::Arrange`] if there is no such model.
    pub fn positions_of(&self, model: usize, class: FacetClass) -> Result<Vec<f32>, Error> {
        let mesh = self.prepared_mesh(model)?;
        Ok(mesh.map_or_else(Vec::new, |mesh| positions_of(mesh, class)))
    }

    /// A plug for each drain hole of a model in the last plan, if it has any.
    ///
    /// # Errors
    /// [`Error::Arrange`] if there is no such model.
    pub fn plugs(&self, model: usize) -> Result<Option<Shell>, Error> {
        let hollowed = self
            .prepared(model)?
            .and_then(|prepared| prepared.hollowed.as_ref());
        let drains = hollowed.map(|hollowed| &hollowed.drains);
        Ok(drains
            .filter(|drains| !drains.is_empty())
            .map(|drains| plugs(drains)))
    }

    /// Vertex positions of [`Self::plugs`], as those of [`Self::positions_of`]; none without holes.
    ///
    /// # Errors
    /// [`Error::Arrange`] if there is no such model.
    pub fn plug_positions(&self, model: usize) -> Result<Vec<f32>, Error> {
        let plugs = self.plugs(model)?.unwrap_or_default();
        Ok(positions(&plugs.vertices, &plugs.facets))
    }

    /// The layers of a plate, and its models as they are printed, each as if it stood alone.
    ///
    /// # Errors
    /// [`Error::NoPlan`], [`Error::Arrange`].
    pub fn planned(&self, plate: usize) -> Result<(Vec<&Mesh>, &Plan), Error> {
        let found = self.plate(plate)?;
        let models = found.planned.models.iter();
        let meshes = models.map(|model| model.sampled().mesh());
        Ok((meshes.collect(), &found.planned.plan))
    }

    /// The places in millimetres of the copies of each model of [`Job::planned`]: of its origin, from the middle of the plate.
    ///
    /// # Errors
    /// [`Error::NoPlan`], [`Error::Arrange`].
    pub fn places_mm(&self, plate: usize) -> Result<Vec<Vec<DVec2>>, Error> {
        let found = self.plate(plate)?;
        let mask_screen = found.screen();
        let screen = arrange::Screen::new(mask_screen.pixels, mask_screen.pitch_mm);
        let place_mm = |&offset: &[i32; 2]| DVec2::from(screen.offset_mm(offset));
        let offsets = found.offsets.iter();
        Ok(offsets
            .map(|it| it.iter().map(place_mm).collect())
            .collect())
    }

    /// The profile of a metric on a plate: in each bin the largest of its models.
    ///
    /// # Errors
    /// [`Error::NoPlan`], also for a metric of areas or for the sampled source if no plan has measured them;
    /// [`Error::Arrange`].
    pub fn profile(&self, plate: usize, metric: Metric, source: Source) -> Result<Profile, Error> {
        let planned = &self.plate(plate)?.planned;
        let mut largest = Profile {
            bins: planned.plan.bins,
            density: vec![0.0; planned.plan.bins.count],
        };
        for model in &planned.models {
            let shapes = &model.measured.shapes;
            let has_source = source == Source::Exact || shapes.sampled.is_some();
            if !has_source || metric.needs_areas() && !shapes.has_areas() {
                return Err(Error::NoPlan);
            }
            let density = shapes.profile(metric, source).density;
            for (most, density) in largest.density.iter_mut().zip(density) {
                *most = most.max(density);
            }
        }
        Ok(largest)
    }

    /// The mask of a layer of a plate: see [`MaskCursor::whole`](crate::mask::MaskCursor::whole).
    ///
    /// # Errors
    /// [`Error::NoPlan`], [`Error::NoLayer`], [`Error::Arrange`].
    pub fn mask(&mut self, plate: usize, layer: usize) -> Result<Vec<u8>, Error> {
        let plate = self.plate_mut(plate)?;
        let layers = plate.planned.plan.layers();
        if layer >= layers {
            return Err(Error::NoLayer { layer, layers });
        }
        let (masks, cursors) = plate.seen()?;
        Ok(masks.whole(cursors, layer))
    }

    /// Gives the layers of a plate exposures of their own, in seconds.
    pub(crate) fn expose(&mut self, plate: usize, exposure_s: Vec<f64>) -> Result<(), Error> {
        let report = &mut self.plate_mut(plate)?.report;
        report.print_time_s = report.resin.time_s(&exposure_s);
        report.exposure_s = exposure_s;
        Ok(())
    }

    /// The masks of a plate's print file in groups, for others to encode; `None` if the file has no masks, if they have to be
    /// read slab by slab, or if sending them takes as long as encoding them.
    ///
    /// # Errors
    /// [`Error::NoPlan`], [`Error::Arrange`].
    pub fn layer_groups(&mut self, plate: usize) -> Result<Option<LayerGroups>, Error> {
        self.plate_mut(plate)?.layer_groups()
    }

    /// Writes the print file of a plate in the format of its options. Returns the writer, and the report with the time that this
    /// took.
    ///
    /// # Errors
    /// [`Error::NoPlan`], [`Error::Archive`], [`Error::Arrange`].
    pub fn write_archive<W: Write>(
        &mut self,
        plate: usize,
        writer: W,
        progress: &mut StageProgress<'_>,
    ) -> Result<(W, &Report), Error> {
        self.write_archive_of(plate, None, writer, progress)
    }

    /// [`Self::write_archive`] of layers that others have encoded, if that is how they are given: `encoded` fetches a group of
    /// [`Self::layer_groups`], counted from 0, as [`archive::encode_group`](crate::archive::encode_group) encodes it.
    ///
    /// # Errors
    /// Those of [`Self::write_archive`].
    pub fn write_archive_of<W: Write>(
        &mut self,
        plate: usize,
        encoded: Option<&dyn Fn(usize) -> Vec<u8>>,
        writer: W,
        progress: &mut StageProgress<'_>,
    ) -> Result<(W, &Report), Error> {
        self.plate_mut(plate)?.write_file(encoded, writer, progress)
    }

    /// Pieces that would float in the vat, from the largest down: they begin with nothing below them. Of models without supports, those
    /// count that the solid model would hold.
    ///
    /// # Errors
    /// [`Error::NoPlan`]; [`Error::Ldi`] if `progress` cancels.
    pub fn floating(
        &mut self,
        plate: usize,
        progress: &mut StageProgress<'_>,
    ) -> Result<Vec<Finding>, Error> {
        let mut within = |fraction| progress(Stage::Inspect, fraction);
        self.plate_mut(plate)?.floating(&mut within)
    }

    /// Findings on each model of a plate, by these limits: each is checked as if it stood alone, in the layers of the plate.
    ///
    /// # Errors
    /// [`Error::NoPlan`], [`Error::Limits`], [`Error::Arrange`]; [`Error::Ldi`] if `progress` cancels.
    pub fn inspect(
        &mut self,
        plate: usize,
        limits: &Limits,
        progress: &mut StageProgress<'_>,
    ) -> Result<PlatePrintability, Error> {
        limits.check()?;
        let current = self.plate_mut(plate)?;
        let planned = Arc::clone(&current.planned);
        let film_kpa = current.output.printer.as_ref().and_then(|it| it.film_kpa);
        let (masks, _) = current.seen()?;
        let count = planned.models.len() as f64;
        let all = planned.models.iter().zip(&masks.stamps).enumerate();
        let found = all.map(|(place, (model, stamp))| {
            let mut within = |fraction| progress(Stage::Inspect, (place as f64 + fraction) / count);
            // The options of supports may state another film than the printer.
            let mut held = model.sampled().held(limits);
            held.film_kpa = held.film_kpa.or(film_kpa);
            let unmended = planned.unmended(place);
            let found = inspect::inspect(
                &stamp.masks,
                unmended.as_ref(),
                &planned.plan,
                limits,
                &held,
                &mut within,
            );
            Ok(ModelPrintability {
                model: model.model,
                turn_deg: model.turns * TURN_DEG,
                found: found.map_err(LdiError::from)?,
            })
        });
        let models = found.collect::<Result<Vec<_>, Error>>()?;
        let verdicts = models.iter().map(|model| model.found.verdict);
        Ok(PlatePrintability {
            verdict: verdicts.max().unwrap_or(Verdict::Ok),
            models,
        })
    }
}
