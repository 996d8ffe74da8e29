//! A plate of a submitted plan, to be planned again.

use serde::Deserialize;

use super::stages::stage::StageProgress;
use super::{Error, Job, JobOptions, ModelOptions, Options, Placement, Report};
use crate::arrange::Arranging;
use crate::model::ModelFile;

/// What a submitted plan says of its plate. Unlike a report it says how copies stand, and nothing that follows from it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct ClaimedPlate {
    pub(super) options: Options,
    plate: usize,
    plate_count: usize,
    models: Vec<ClaimedModel>,
    placements: Vec<Placement>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
struct ClaimedModel {
    model: usize,
    file: ModelFile,
    options: ModelOptions,
}

impl ClaimedPlate {
    /// The files of its models, and their indices in the job.
    pub(super) fn files(&self) -> impl Iterator<Item = (&ModelFile, usize)> {
        self.models.iter().map(|model| (&model.file, model.model))
    }

    /// The job that has only this plate.
    fn job(&self) -> JobOptions {
        let count = self.models.iter().map(|model| model.model + 1).max();
        let absent = ModelOptions {
            copies: 0,
            ..ModelOptions::default()
        };
        let mut models = vec![absent; count.unwrap_or(0)];
        for model in &self.models {
            let placed = self.placements.iter();
            models[model.model] = ModelOptions {
                copies: placed.filter(|it| it.model == model.model).count(),
                ..model.options.clone()
            };
        }
        JobOptions {
            options: self.options.clone(),
            models,
            arranging: Arranging::default(),
            placements: self
                .placements
                .iter()
                .map(|place| Placement { plate: 0, ..*place })
                .collect(),
        }
    }
}

impl Job {
    /// Plans a submitted plate again, as the only one, and numbers it as it was.
    ///
    /// # Errors
    /// Those of [`Job::plan`].
    pub(super) async fn plan_claimed(
        &mut self,
        claimed: &ClaimedPlate,
        progress: &mut StageProgress<'_>,
    ) -> Result<&Report, Error> {
        self.plan(&claimed.job(), progress).await?;
        let report = &mut self.plate_mut(0)?.report;
        (report.plate, report.plate_count) = (claimed.plate, claimed.plate_count);
        for place in &mut report.placements {
            place.plate = claimed.plate;
        }
        Ok(report)
    }
}
