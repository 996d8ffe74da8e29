//! What will fail on a plate.

use std::sync::Arc;

use serde::Serialize;

use super::stages::stage::{Stage, StageProgress};
use super::{Error, Job};
use crate::arrange::TURN_DEG;
use crate::inspect::{self, Limits, Printability, Verdict};
use crate::ldi::LdiError;

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
    /// What was found on it, as if it stood alone.
    #[serde(flatten)]
    pub found: Printability,
}

impl Job {
    /// What will fail on each model of a plate, by these limits: each is checked as if it stood alone, in the layers of the plate.
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
        let (masks, _) = current.seen()?;
        let count = planned.models.len() as f64;
        let all = planned.models.iter().zip(&masks.stamps).enumerate();
        let found = all.map(|(place, (model, stamp))| {
            let mut within = |fraction| progress(Stage::Inspect, (place as f64 + fraction) / count);
            let held = model.sampled().held(limits);
            let found = inspect::inspect(&stamp.masks, &planned.plan, limits, &held, &mut within);
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
