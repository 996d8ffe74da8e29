//! What will fail on a plate.

use std::sync::Arc;

use serde::Serialize;

use super::super::stage::{Stage, StageProgress};
use super::Plate;
use crate::Error;
use crate::inspect::{self, Limits, Printability};
use crate::ldi::LdiError;

/// What will fail on a model of a plate. Copies are all alike.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct ModelPrintability {
    /// The model, by its index in the job. One that also stands turned about z is there once for each turn.
    pub model: usize,
    /// What was found on it, as if it stood alone.
    #[serde(flatten)]
    pub found: Printability,
}

impl Plate {
    /// What will fail on each model of a plate, by these limits: each is checked as if it stood alone, in the layers of the plate.
    ///
    /// # Errors
    /// [`Error::NoPlan`], [`Error::Arrange`]; [`Error::Ldi`] if `progress` cancels.
    pub fn inspect(
        &mut self,
        plate: usize,
        limits: &Limits,
        progress: &mut StageProgress<'_>,
    ) -> Result<Vec<ModelPrintability>, Error> {
        let current = self.current(plate)?;
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
                found: found.map_err(LdiError::from)?,
            })
        });
        found.collect()
    }
}
