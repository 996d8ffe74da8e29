//! The layers of measured models: the third stage.

use std::sync::Arc;

use super::measured::{Measured, Part};
use super::memory::Bound;
use super::parts::Layering;
use super::planning::{Findings, Planning};
use super::sampled::Sampled;
use crate::cure::Cure;
use crate::inspect::{self, Finding};
use crate::job::Error;
use crate::ldi::LdiError;
use crate::mask::{
    CompensatedSlabs, Compensations, Masks, PrintThroughReport, Raise, RunSource, Side, SlabMasks,
    Window, erased_mm2, print_through,
};
use crate::plan::Plan;
use crate::plan::uniform::UniformLayers;
use crate::progress::{Cancelled, Progress};
use crate::warning::Warning;

/// The most plans until planes at flats that face down stay.
const ROUNDS: usize = 4;

/// A model of a plan, as it was measured.
#[derive(Debug, Clone)]
pub struct PlannedModel {
    pub measured: Arc<Measured>,
    /// The model, by its index in the job.
    pub model: usize,
    /// Turns of 15° about z on its plate.
    pub turns: u32,
    /// Its own tolerance, in place of the plan's.
    pub tolerance: Option<f64>,
    /// Number of copies.
    pub copies: usize,
}

impl PlannedModel {
    /// The model as if it stood alone.
    pub fn part_alone(&self) -> Part<'_> {
        Part::alone(self.measured.of.height_mm, &self.measured.shapes)
    }

    pub fn part(&self) -> Part<'_> {
        Part {
            height_mm: self.measured.of.height_mm,
            shapes: &self.measured.shapes,
            model: self.model,
            tolerance: self.tolerance,
        }
    }

    pub fn sampled(&self) -> &Sampled {
        &self.measured.of
    }
}

/// A plan with its inputs. Immutable and shared, so its masks always come from its own rays.
#[derive(Debug)]
pub struct Planned {
    /// The models; there is at least one.
    pub models: Vec<PlannedModel>,
    /// The options with which it was planned.
    pub layering: Layering,
    pub plan: Plan,
    pub findings: Findings,
    /// Compensations in the masks, if there are any.
    compensations: Option<Compensations>,
    /// Errors of surfaces that face down, if the resin states its print-through.
    pub print_through: Option<PrintThroughReport>,
}

impl Planned {
    /// Plans the layers.
    ///
    /// # Errors
    /// [`Error::Plan`]; [`Error::Ldi`] if `progress` cancels.
    pub fn new(
        models: Vec<PlannedModel>,
        layering: &Layering,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Error> {
        let parts = models.iter().map(PlannedModel::part).collect();
        let mut planning = Planning::new(parts, layering);
        let compensates =
            !layering.compensation.is_none() || layering.resin.print_through.is_some();
        let share = if compensates { 0.5 } else { 1.0 };
        let mut plan = planning.plan(&mut |fraction| progress(share * fraction))?;
        // Planes move with the doses of the plan, and the plan with the planes.
        for _ in 0..ROUNDS {
            let cure = Cure::of_plan(&plan, &layering.resin);
            if !cure.is_some_and(|cure| planning.raise(&cure)) {
                break;
            }
            plan = planning.plan(&mut |_| progress(share))?;
        }
        let mut planned = Self {
            findings: planning.findings(&plan)?,
            models,
            compensations: compensations(&plan, layering),
            layering: layering.clone(),
            plan,
            print_through: None,
        };
        let mut within = |fraction| progress(share + (1.0 - share) * fraction);
        let erased = planned.erased(&mut within).map_err(LdiError::from)?;
        planned.findings.warnings.extend(erased);
        let measured = planned.measure_print_through(progress);
        planned.print_through = measured.map_err(LdiError::from)?;
        let warnings = planned
            .print_through
            .iter()
            .flat_map(PrintThroughReport::warnings);
        planned.findings.warnings.extend(warnings);
        Ok(planned)
    }

    /// Errors of surfaces that face down, over all models and copies.
    fn measure_print_through(
        &self,
        progress: &mut Progress<'_>,
    ) -> Result<Option<PrintThroughReport>, Cancelled> {
        let Some(Compensations { raise, .. }) = &self.compensations else {
            return Ok(None);
        };
        let others = Cure::within(&self.plan, &self.layering.resin);
        let is_distance = self.layering.metric.is_distance();
        let tolerance_mm = is_distance.then_some(self.findings.tolerance);
        let mut all: Option<PrintThroughReport> = None;
        for model in &self.models {
            let samples = model.sampled().sampling.samples;
            let mut within = |_| progress(1.0);
            let its = model.sampled().image().read(|image| {
                let plan = &self.plan;
                print_through(
                    image,
                    plan,
                    samples,
                    raise,
                    &others,
                    tolerance_mm,
                    &mut within,
                )
            })?;
            let Some(its) = its else {
                return Ok(None);
            };
            let its = its.of_copies(model.copies);
            all = Some(match all {
                Some(all) => all.and(&its),
                None => its,
            });
        }
        Ok(all)
    }

    /// The warning about what compensation erases.
    fn erased(&self, progress: &mut Progress<'_>) -> Result<Option<Warning>, Cancelled> {
        let Some(compensations) = &self.compensations else {
            return Ok(None);
        };
        let mut of_layers_mm2 = vec![0.0; self.plan.layers()];
        let share = 1.0 / self.models.len() as f64;
        for (place, model) in self.models.iter().enumerate() {
            let samples = model.sampled().sampling.samples;
            let image = model.sampled().image();
            let mut within = |fraction| progress(share * (place as f64 + fraction));
            let areas_mm2 = image
                .read(|image| erased_mm2(image, &self.plan, samples, compensations, &mut within))?;
            for (sum_mm2, area_mm2) in of_layers_mm2.iter_mut().zip(areas_mm2) {
                *sum_mm2 += area_mm2 * model.copies as f64;
            }
        }
        let lowest = of_layers_mm2.iter().position(|&area_mm2| area_mm2 > 0.0);
        Ok(lowest.map(|lowest| Warning::ErasedParts {
            layers: of_layers_mm2.iter().filter(|&&mm2| mm2 > 0.0).count(),
            from_mm: self.plan.z_mm()[lowest],
            area_mm2: of_layers_mm2.iter().copied().fold(0.0, f64::max),
        }))
    }

    /// Returns true if this is the plan of these models with this layering.
    pub fn is_of(&self, models: &[PlannedModel], layering: &Layering) -> bool {
        let is_same = |(a, b): (&PlannedModel, &PlannedModel)| {
            Arc::ptr_eq(&a.measured, &b.measured)
                && a.model == b.model
                && a.tolerance == b.tolerance
                && a.copies == b.copies
        };
        self.layering == *layering
            && self.models.len() == models.len()
            && self.models.iter().zip(models).all(is_same)
    }

    /// The first model, or the only one.
    pub fn first(&self) -> &Arc<Measured> {
        &self.models[0].measured
    }

    /// The best uniform layers within tolerance, in layers or in time, whichever the options minimize.
    pub fn best_uniform(&self) -> Option<UniformLayers> {
        let best = self.findings.uniform.best(self.layering.minimize)?;
        Some(UniformLayers {
            layer_mm: best.layer_mm,
            layers: best.layers,
        })
    }

    /// The masks of a model by its index, as if it stood alone, seen from one side.
    ///
    /// # Errors
    /// [`Error::MemoryBound`] if there is no LDI.
    pub fn masks(&self, model: usize, side: Side) -> Result<Masks, Error> {
        let sampled = self.models[model].sampled();
        let Sampled {
            grid,
            rays,
            sampling,
            ..
        } = sampled;
        let (plan, samples, overlaps) = (&self.plan, sampling.samples, sampled.overlaps()?);
        Ok(match &self.compensations {
            None => {
                let grids = [rays, grid];
                Masks::of_facets(sampled.mesh(), grids, overlaps, plan, samples, side)
            }
            Some(compensations) => {
                let image = sampled.image();
                Masks::compensated(image, plan, grid, samples, side, compensations)
            }
        })
    }

    /// The same to be read once, slab by slab if there is no LDI.
    ///
    /// # Errors
    /// As [`Self::masks`].
    pub fn runs(&self, model: usize, side: Side) -> Result<Box<dyn RunSource + '_>, Error> {
        let sampled = self.models[model].sampled();
        let Sampled {
            grid,
            rays,
            sampling,
            ..
        } = sampled;
        Ok(match sampled.bound() {
            Some(Bound { slab_bytes, .. }) => {
                let (mesh, samples) = (sampled.mesh(), sampling.samples);
                let plan = &self.plan;
                let masks = SlabMasks::new(mesh, *rays, plan, grid, samples, side, slab_bytes);
                match &self.compensations {
                    None => Box::new(masks),
                    Some(compensations) => Box::new(CompensatedSlabs {
                        masks,
                        image: sampled.image(),
                        side,
                        compensations,
                    }),
                }
            }
            None => Box::new(self.masks(model, side)?),
        })
    }

    /// The places of a model, by its index, that compensation for print-through cannot mend, if there are any.
    pub fn unmended(&self, model: usize) -> Option<[Masks; 2]> {
        let PrintThroughReport {
            thin_roofs_mm2,
            closed_gaps_mm2,
            ..
        } = self.print_through.as_ref()?;
        if *thin_roofs_mm2 == 0.0 && *closed_gaps_mm2 == 0.0 {
            return None;
        }
        let Compensations { raise, .. } = self.compensations.as_ref()?;
        let sampled = self.models[model].sampled();
        let (grid, samples) = (&sampled.grid, sampled.sampling.samples);
        sampled
            .image()
            .read(|image| Masks::unmended(image, &self.plan, grid, samples, raise))
    }

    /// Keeps the pieces of a hollow model, by its index, that the solid model would hold.
    ///
    /// # Errors
    /// [`LdiError::Cancelled`].
    pub fn retain_held(
        &self,
        model: usize,
        pieces: &mut Vec<Finding>,
        progress: &mut Progress<'_>,
    ) -> Result<(), LdiError> {
        let sampled = self.models[model].sampled();
        let Sampled {
            grid,
            rays,
            sampling,
            ..
        } = sampled;
        let (solid, plan) = (sampled.mesh().solid(), &self.plan);
        let (samples, side) = (sampling.samples, Side::Above);
        let mut retain = |masks: &dyn RunSource, window: &Window| {
            inspect::retain_held(pieces, masks, window, grid, plan, progress)
        };
        match sampled.bound() {
            None => {
                let grids = [rays, grid];
                let masks = Masks::of_mesh(&solid, grids, plan, samples, side)?;
                retain(&masks, &masks.window)?;
            }
            Some(Bound { slab_bytes, .. }) => {
                let masks = SlabMasks::new(&solid, *rays, plan, grid, samples, side, slab_bytes);
                retain(&masks, &Window::whole(grid))?;
            }
        }
        Ok(())
    }
}

/// Compensations in the masks of a plan, if there are any.
fn compensations(plan: &Plan, layering: &Layering) -> Option<Compensations> {
    let Layering {
        compensation,
        resin,
        ..
    } = layering;
    let cure = Cure::of_plan(plan, resin);
    if compensation.is_none() && cure.is_none() {
        return None;
    }
    Some(Compensations {
        xy_mm: compensation.of_layers_mm(plan.layers(), resin.bottom_layers),
        raise: cure.map_or(Raise::By(compensation.z_mm), |cure| Raise::Cured {
            cure,
            greys: layering.greys,
        }),
        least_mm: layering.min_feature_mm,
    })
}
