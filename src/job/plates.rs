//! A plate with its plan: its masks and its print file.

use std::io::Write;
use std::ops::ControlFlow;
use std::sync::Arc;

use web_time::Instant;

use super::stages::parts::Output;
use super::stages::planned::{Planned, PlannedModel};
use super::stages::prepared::Prepared;
use super::stages::stage::{Stage, StageProgress, ms_since};
use super::{Error, Report};
use crate::archive::layer_profile::{self, LayeredModel};
use crate::archive::{
    self, Canvas, GROUP, Layer, MaskSource, PlacedMesh, PreviewScene, PrintJob, Screen,
};
use crate::argsort::sort_by_number;
use crate::format::Format;
use crate::inspect::{self, Finding};
use crate::ldi::LdiError;
use crate::mask::{
    LayerRuns, MaskCursor, PlateMasks, PlateReadPlace, PlateRuns, RunSource, Side, Stamp, Window,
};
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
    /// True if it is known that no piece of it floats.
    pub is_held: bool,
}

impl Plate {
    /// Returns true if the hits of all models are kept, and with them their masks.
    fn are_all_held(&self) -> bool {
        let mut models = self.planned.models.iter();
        models.all(|model| model.sampled().bound().is_none())
    }

    /// Pieces that would float in the vat, from the largest down: of supported models all, of hollow ones those that the solid model
    /// would hold.
    ///
    /// # Errors
    /// [`Error::Ldi`] if `progress` cancels.
    pub fn floating(&mut self, progress: &mut Progress<'_>) -> Result<Vec<Finding>, Error> {
        let planned = Arc::clone(&self.planned);
        let are_held = self.are_all_held();
        let is_prepared = |model: &&PlannedModel| {
            let prepared = &model.sampled().prepared;
            prepared.supports.is_some() || prepared.hollowed.is_some()
        };
        let prepared = planned.models.iter().filter(is_prepared).count();
        if prepared == 0 {
            return Ok(Vec::new());
        }
        let masks = if are_held {
            Some(Arc::clone(&self.seen()?.0))
        } else {
            None
        };
        let mut found = Vec::new();
        let mut done = 0.0;
        for (place, model) in planned.models.iter().enumerate() {
            if !is_prepared(&model) {
                continue;
            }
            let mut within = |fraction| progress((done + fraction) / prepared as f64);
            let sampled = model.sampled();
            let slabs;
            let grid = &sampled.grid;
            let (runs, window): (&dyn RunSource, _) = if let Some(masks) = &masks {
                let masks = &masks.stamps[place].masks;
                (masks, masks.window)
            } else {
                slabs = planned.runs(place, Side::Above)?;
                (&*slabs, Window::whole(grid))
            };
            let floating = inspect::floating(runs, &window, grid, &planned.plan, &mut within);
            let mut floating = floating.map_err(LdiError::from)?;
            if !sampled.is_supported() && !floating.is_empty() {
                planned.retain_held(place, &mut floating, &mut within)?;
            }
            found.extend(floating);
            done += 1.0;
        }
        sort_by_number(&mut found, |it| -it.volume_mm3);
        Ok(found)
    }

    /// Refuses a print file in which pieces would float, unless the options allow it.
    fn check_floating(&mut self, progress: &mut StageProgress<'_>) -> Result<(), Error> {
        if self.output.allow_floating || self.is_held {
            return Ok(());
        }
        let found = self.floating(&mut |fraction| progress(Stage::Inspect, fraction))?;
        let Some(largest) = found.first() else {
            self.is_held = true;
            return Ok(());
        };
        Err(Error::FloatingPieces {
            pieces: found.len(),
            volume_mm3: largest.volume_mm3,
            layer_number: largest.layers[0] + 1,
            at_mm: largest.at_mm,
        })
    }

    /// The screen that shows its masks.
    pub fn screen(&self) -> Screen {
        let first = &self.planned.first().of;
        Screen {
            pixels: [first.grid.width, first.grid.height],
            pitch_mm: [first.grid.pitch_mm, first.grid.pitch_y_mm],
            is_mirrored: self.output.is_mirrored,
            antialias: first.sampling.samples.sublayers,
        }
    }

    /// The masks of its print file in groups; `None` if the file has no masks, if they have to be read slab by slab, or if sending them
    /// takes as long as encoding them.
    pub fn layer_groups(&mut self) -> Result<Option<LayerGroups>, Error> {
        // Masks of a mirroring printer are not kept: they would be made a second time when the file is written.
        if !self.output.format.is_zip() || !self.are_all_held() {
            return Ok(None);
        }
        self.check_floating(&mut |_, _| ControlFlow::Continue(()))?;
        let masks = self.shown()?;
        Ok(Some(LayerGroups {
            place: PlateReadPlace::new(&masks),
            masks,
            layers: self.report.layers,
            left: self.report.layers,
            format: self.output.format,
            canvas: self.screen().canvas(),
        }))
    }

    /// Writes its print file, from groups of layers that others have encoded, if that is how they are given.
    pub fn write_file<W: Write>(
        &mut self,
        encoded: Option<&dyn Fn(usize) -> Vec<u8>>,
        writer: W,
        progress: &mut StageProgress<'_>,
    ) -> Result<(W, &Report), Error> {
        self.check_floating(progress)?;
        let clock = Instant::now();
        let encoded_share = encoded.map_or(0.0, |_| ENCODED_SHARE);
        let mut within = |fraction| {
            let fraction = encoded_share + (1.0 - encoded_share) * fraction;
            progress(Stage::Masks, fraction)
        };
        let writer = match encoded {
            Some(encoded) => self.write(MaskSource::Encoded(encoded), writer, &mut within),
            None if self.output.filament.is_some() => self.write_layer_profile(writer, &mut within),
            None if self.are_all_held() => {
                let masks = self.shown()?;
                self.write(MaskSource::Runs(&masks.runs()), writer, &mut within)
            }
            None => self.write_by_slabs(writer, &mut within),
        }?;
        let report = &mut self.report;
        report.timings_ms.masks = ms_since(clock);
        report.timings_ms.sum_up();
        Ok((writer, report))
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

    /// Writes the print file with these masks.
    fn write<W: Write>(
        &self,
        masks: MaskSource<'_>,
        writer: W,
        progress: &mut Progress<'_>,
    ) -> Result<W, Error> {
        let Self {
            planned,
            output,
            report,
            ..
        } = self;
        let layers: Vec<Layer> = (0..report.layers)
            .map(|layer| Layer {
                z_mm: report.z_mm[layer + 1],
                thickness_mm: report.thickness_mm[layer],
                exposure_s: report.exposure_s[layer],
            })
            .collect();
        let job = PrintJob {
            screen: self.screen(),
            layers: &layers,
            masks,
            height_mm: report.height_mm,
            resin: &planned.layering.resin,
            transition_layers: 0,
            resin_ml: report.resin_ml,
            printer: output.printer.as_deref(),
            best_uniform: &|| planned.best_uniform(),
            look: &|longest| preview_scene(planned, &self.offsets, longest),
            manifest: &|| report.manifest(),
        };
        Ok(archive::write(output.format, &job, writer, progress)?)
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

/// The plate seen from above, as a picture of this longer side.
fn preview_scene(planned: &Planned, offsets: &[Vec<[i32; 2]>], longest: u32) -> PreviewScene {
    let models = planned.models.iter().zip(offsets).map(|(model, offsets)| {
        let sampled = model.sampled();
        let rays = sampled.sampling.samples.rays();
        let first = sampled.grid.refined(rays).offset_of(&sampled.rays);
        let first_rays = offsets.iter().map(|offset| {
            [0, 1].map(|axis| {
                i64::from(first[axis]) + i64::from(offset[axis]) * i64::from(rays[axis])
            })
        });
        PlacedMesh {
            mesh: sampled.mesh(),
            rays: sampled.rays,
            first_rays: first_rays.collect(),
        }
    });
    PreviewScene::new(&models.collect::<Vec<_>>(), longest)
}

/// The share of the stage of masks that encoding takes, before the file is written.
pub(super) const ENCODED_SHARE: f64 = 0.9;

/// The masks of a plan, read group by group. Whatever becomes of the plan meanwhile, they stay.
pub struct LayerGroups {
    masks: Arc<PlateMasks>,
    place: PlateReadPlace,
    layers: usize,
    /// Layers that are not yet read.
    left: usize,
    /// The format of the plan's print file.
    pub format: Format,
    /// The canvas of its masks.
    pub canvas: Canvas,
}

impl LayerGroups {
    /// Number of groups that are left.
    pub fn left(&self) -> usize {
        self.left.div_ceil(GROUP)
    }

    /// Progress of the stage of masks, 0 to 1, when the groups read so far are encoded.
    pub fn progress(&self) -> f64 {
        ENCODED_SHARE * (self.layers - self.left) as f64 / self.layers as f64
    }
}

impl Iterator for LayerGroups {
    type Item = LayerRuns;

    /// The runs of the next group; `None` after the last one.
    fn next(&mut self) -> Option<LayerRuns> {
        let layers = GROUP.min(self.left);
        self.left -= layers;
        (layers > 0).then(|| self.place.next(&self.masks, layers))
    }
}
