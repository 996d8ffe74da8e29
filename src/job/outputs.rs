//! Outputs of the plan of a plate: profiles, masks, findings and print files.

use std::io::Write;
use std::sync::Arc;

use glam::DVec2;
use web_time::Instant;

use super::groups::{ENCODED_SHARE, LayerGroups};
use super::loaded::{positions, positions_of};
use super::stages::parts::Output;
use super::stages::planned::{Planned, PlannedModel};
use super::stages::planning::Planning;
use super::stages::prepared::Prepared;
use super::stages::stage::{Stage, StageProgress, ms_since, report};
use super::{Error, Job, JobOptions, Report, Tradeoff};
use crate::archive::layer_profile::{self, LayeredModel};
use crate::archive::{self, Layer, Look, MaskSource, PrintJob, Screen, Standing};
use crate::arrange::{self, ArrangeError};
use crate::mask::{MaskCursor, PlateMasks, PlateRuns, Side, Stamp};
use crate::model::{FacetClass, Mesh};
use crate::plan::Plan;
use crate::prepare::{Shell, plugs};
use crate::profile::{Metric, Profile, Source};
use crate::progress::Progress;

/// A plate with its plan and its report.
#[derive(Debug)]
pub(super) struct Plate {
    pub planned: Arc<Planned>,
    /// For each model of the plan, where its copies stand as seen from above.
    pub offsets: Vec<Vec<[i32; 2]>>,
    /// Each model before turns: on the plate, with its voids and supports.
    pub upright: Vec<(usize, Arc<Prepared>)>,
    pub output: Output,
    pub report: Report,
    /// The masks seen from above, kept for later calls, and cursors at the last layer that was read.
    pub seen: Option<(Arc<PlateMasks>, Vec<MaskCursor>)>,
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
        let mask_screen = screen_of(&found.planned, &found.output);
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
    /// [`Error::NoPlan`], also for a metric of areas if no plan has measured them; [`Error::Arrange`].
    pub fn profile(&self, plate: usize, metric: Metric, source: Source) -> Result<Profile, Error> {
        let planned = &self.plate(plate)?.planned;
        let mut largest = Profile {
            bins: planned.plan.bins,
            density: vec![0.0; planned.plan.bins.count],
        };
        for model in &planned.models {
            let shapes = &model.measured.shapes;
            if metric.needs_areas() && !shapes.has_areas() {
                return Err(Error::NoPlan);
            }
            let density = shapes.profile(metric, source).density;
            for (most, density) in largest.density.iter_mut().zip(density) {
                *most = most.max(density);
            }
        }
        Ok(largest)
    }

    /// The mask of a layer of a plate: see [`MaskCursor::whole`].
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

    /// The best plans of a plate for `points` tolerances, from the smallest that a plan keeps to the largest that makes a difference.
    /// Models with a tolerance of their own are held to it in proportion. The last plan is kept.
    ///
    /// # Errors
    /// Those of [`Self::plan`].
    pub async fn tradeoff(
        &mut self,
        plate: usize,
        options: &JobOptions,
        points: usize,
        progress: &mut StageProgress<'_>,
    ) -> Result<Tradeoff, Error> {
        let (models, layering) = self.measured_plate(plate, options, progress).await?;
        report(progress, Stage::Plan, 0.0)?;
        let parts = models.iter().map(PlannedModel::part).collect();
        let points = Planning::new(parts, &layering).tradeoff(points)?;
        report(progress, Stage::Plan, 1.0)?;
        Ok(Tradeoff { points })
    }

    /// Gives the layers of a plate exposures of their own, in seconds.
    pub(super) fn expose(&mut self, plate: usize, exposure_s: Vec<f64>) -> Result<(), Error> {
        let report = &mut self.plate_mut(plate)?.report;
        report.print_time_s = report.resin.time_s(&exposure_s);
        report.exposure_s = exposure_s;
        Ok(())
    }

    /// The masks of a plate's print file in groups, for others to encode; `None` if the file has no masks, or they have to be
    /// read slab by slab.
    ///
    /// # Errors
    /// [`Error::NoPlan`], [`Error::Arrange`].
    pub fn layer_groups(&mut self, plate: usize) -> Result<Option<LayerGroups>, Error> {
        let plate = self.plate_mut(plate)?;
        if plate.output.filament.is_some() || !plate.are_all_held() {
            return Ok(None);
        }
        let canvas = screen_of(&plate.planned, &plate.output).canvas();
        let layers = plate.report.layers;
        let format = plate.output.format;
        Ok(Some(LayerGroups::new(
            plate.shown()?,
            layers,
            format,
            canvas,
        )))
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
        let clock = Instant::now();
        let plate = self.plate_mut(plate)?;
        let encoded_share = encoded.map_or(0.0, |_| ENCODED_SHARE);
        let mut within = |fraction| {
            let fraction = encoded_share + (1.0 - encoded_share) * fraction;
            progress(Stage::Masks, fraction)
        };
        let writer = match encoded {
            Some(encoded) => plate.write(MaskSource::Encoded(encoded), writer, &mut within),
            None if plate.output.filament.is_some() => {
                plate.write_layer_profile(writer, &mut within)
            }
            None if plate.are_all_held() => {
                let masks = plate.shown()?;
                plate.write(MaskSource::Runs(&masks.runs()), writer, &mut within)
            }
            None => plate.write_by_slabs(writer, &mut within),
        }?;
        let report = &mut plate.report;
        report.timings_ms.masks = ms_since(clock);
        report.timings_ms.sum_up();
        Ok((writer, report))
    }
}

impl Plate {
    /// Returns true if the hits of all models are kept, and with them their masks.
    fn are_all_held(&self) -> bool {
        let mut models = self.planned.models.iter();
        models.all(|model| model.sampled().bound().is_none())
    }

    /// The masks seen from above, and cursors.
    pub(super) fn seen(&mut self) -> Result<&mut (Arc<PlateMasks>, Vec<MaskCursor>), Error> {
        let seen = if let Some(seen) = self.seen.take() {
            seen
        } else {
            let masks = self.masks(Side::Above)?;
            let cursors = masks.stamps.iter().map(|stamp| stamp.masks.cursor());
            let cursors = cursors.collect();
            (Arc::new(masks), cursors)
        };
        Ok(self.seen.insert(seen))
    }

    /// The masks as the printer shows them.
    fn shown(&mut self) -> Result<Arc<PlateMasks>, Error> {
        Ok(match self.output.side() {
            Side::Below => Arc::new(self.masks(Side::Below)?),
            Side::Above => Arc::clone(&self.seen()?.0),
        })
    }

    fn masks(&self, side: Side) -> Result<PlateMasks, Error> {
        let stamps = self.offsets.iter().enumerate().map(|(model, offsets)| {
            Ok::<_, Error>(Stamp {
                masks: self.planned.masks(model, side)?,
                offsets: seen_from(side, offsets),
            })
        });
        Ok(PlateMasks {
            grid: self.planned.first().of.grid,
            stamps: stamps.collect::<Result<_, _>>()?,
        })
    }

    fn write<W: Write>(
        &self,
        masks: MaskSource<'_>,
        writer: W,
        progress: &mut Progress<'_>,
    ) -> Result<W, Error> {
        let Self {
            planned,
            offsets,
            output,
            report,
            ..
        } = self;
        let look = || look_of(planned, offsets);
        write_print(planned, output, report, masks, &look, writer, progress)
    }

    /// The same of masks that are read slab by slab, as they do not fit into memory.
    fn write_by_slabs<W: Write>(&self, writer: W, progress: &mut Progress<'_>) -> Result<W, Error> {
        let side = self.output.side();
        let models = 0..self.planned.models.len();
        let apart = models.map(|model| self.planned.runs(model, side));
        let apart = apart.collect::<Result<Vec<_>, _>>()?;
        let runs = PlateRuns {
            grid: self.planned.first().of.grid,
            stamps: apart
                .iter()
                .zip(&self.offsets)
                .map(|(runs, offsets)| (&**runs, seen_from(side, offsets)))
                .collect(),
        };
        self.write(MaskSource::Runs(&runs), writer, progress)
    }

    /// The file for a slicer of filament printers, which places and turns models itself: of one copy of one model.
    fn write_layer_profile<W: Write>(
        &self,
        writer: W,
        progress: &mut Progress<'_>,
    ) -> Result<W, Error> {
        let filament = self.output.filament;
        let filament = filament.ok_or(Error::NoPlan)?;
        let model = LayeredModel {
            mesh: self.planned.first().of.mesh(),
            z_mm: &self.report.z_mm,
            first_layer_mm: filament.first_layer_mm,
        };
        Ok(layer_profile::write(
            filament.slicer,
            &model,
            writer,
            progress,
        )?)
    }
}

/// The places of copies as they are seen from a side.
fn seen_from(side: Side, offsets: &[[i32; 2]]) -> Vec<[i32; 2]> {
    let offsets = offsets.iter();
    match side {
        Side::Above => offsets.copied().collect(),
        Side::Below => offsets.map(|&[right, down]| [-right, down]).collect(),
    }
}

/// The plate seen from above.
fn look_of(planned: &Planned, offsets: &[Vec<[i32; 2]>]) -> Look {
    let mut copies = Vec::new();
    for (model, offsets) in planned.models.iter().zip(offsets) {
        let sampled = model.sampled();
        let rays = sampled.sampling.samples.rays();
        let first = sampled.grid.refined(rays).offset_of(&sampled.rays);
        copies.extend(offsets.iter().map(|offset| Standing {
            mesh: sampled.mesh(),
            image: sampled.image(),
            first_ray: [0, 1].map(|axis| {
                i64::from(first[axis]) + i64::from(offset[axis]) * i64::from(rays[axis])
            }),
        }));
    }
    Look::of_copies(&copies)
}

/// Writes the print file of a plan that is exported as `output`, with these masks.
///
/// # Errors
/// [`Error::Archive`].
fn write_print<W: Write>(
    planned: &Planned,
    output: &Output,
    report: &Report,
    masks: MaskSource<'_>,
    look: &dyn Fn() -> Look,
    writer: W,
    progress: &mut Progress<'_>,
) -> Result<W, Error> {
    let layers: Vec<Layer> = (0..report.layers)
        .map(|layer| Layer {
            z_mm: report.z_mm[layer + 1],
            thickness_mm: report.thickness_mm[layer],
            exposure_s: report.exposure_s[layer],
        })
        .collect();
    let job = PrintJob {
        screen: screen_of(planned, output),
        layers: &layers,
        masks,
        height_mm: report.height_mm,
        resin: &planned.layering.resin,
        transition_layers: 0,
        resin_ml: report.resin_ml,
        printer: output.printer.as_deref(),
        best_uniform: &|| planned.best_uniform(),
        look,
        manifest: &|| report.manifest(),
    };
    Ok(archive::write(output.format, &job, writer, progress)?)
}

/// The screen that shows the masks of a plan.
fn screen_of(planned: &Planned, output: &Output) -> Screen {
    let grid = &planned.first().of.grid;
    Screen {
        pixels: [grid.width, grid.height],
        pitch_mm: [grid.pitch_mm, grid.pitch_y_mm],
        is_mirrored: output.is_mirrored,
        antialias: planned.first().of.sampling.samples.sublayers,
    }
}
