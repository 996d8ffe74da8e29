//! Other plans of a plate: of other planners side by side, and of other tolerances.

use super::plan::layering_of;
use super::stages::parts::{Layering, Thicknesses};
use super::stages::planned::PlannedModel;
use super::stages::planning::Planning;
use super::stages::stage::{Stage, StageProgress, report};
use super::{Comparison, Error, Job, JobOptions, Planner, PlannerReport, Timings, Tradeoff};
use crate::arrange::ArrangeError;
use crate::progress::Progress;

impl Job {
    /// Compares the plans of five planners for a plate, from the coarsest to the finest (table 3), and that of a thickness rule if the
    /// options have one. The last plan is kept.
    ///
    /// # Errors
    /// Any [`Error`] of sampling and planning.
    pub async fn compare(
        &mut self,
        plate: usize,
        options: &JobOptions,
        progress: &mut StageProgress<'_>,
    ) -> Result<Comparison, Error> {
        let (models, layering) = self.measured_plate(plate, options, progress).await?;
        report(progress, Stage::Plan, 0.0)?;
        let parts: Vec<_> = models.iter().map(PlannedModel::part).collect();
        let heights_mm = parts.iter().map(|part| part.height_mm);
        let height_mm = heights_mm.fold(0.0, f64::max);
        let planning = Planning::new(parts, &layering);
        let rows = planning.compare(&mut |fraction| progress(Stage::Plan, fraction))?;
        report(progress, Stage::Plan, 1.0)?;
        let facets = models.iter().map(|it| it.sampled().mesh().surface_facets);
        Ok(Comparison {
            facets: facets.sum(),
            height_mm,
            metric: layering.metric,
            unit: layering.metric.unit().to_owned(),
            rows,
        })
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

    /// The models of a plate measured for these options, with its layering, to be planned in other ways than by [`Self::plan`]. The
    /// last plan is kept.
    pub(super) async fn measured_plate(
        &mut self,
        plate: usize,
        options: &JobOptions,
        progress: &mut StageProgress<'_>,
    ) -> Result<(Vec<PlannedModel>, Layering), Error> {
        let mut timings = Timings::default();
        let is_alone = self.is_alone(options);
        let layout = self.layout(options, is_alone, &mut timings, progress)?;
        let mut plates = layout.plates();
        let count = plates.len();
        let on_plate = plates.nth(plate).ok_or(ArrangeError::NoPlate {
            plate_number: plate + 1,
            plates: count,
        })?;
        self.measure(options, &layout, &mut timings, progress)
            .await?;
        let (models, _) = self.standing(options, &layout, on_plate);
        let layering = layering_of(options, &layout, &models);
        Ok((models, layering))
    }
}

impl Planning<'_> {
    fn compare(&self, progress: &mut Progress<'_>) -> Result<Vec<PlannerReport>, Error> {
        let all = [
            Planner::Coarsest,
            Planner::Optimal,
            Planner::Greedy,
            Planner::Local,
            Planner::Finest,
        ];
        let rows = all.into_iter().map(|planner| self.row(planner));
        let mut rows = rows.collect::<Result<Vec<_>, _>>()?;
        let rule = match self.layering.thicknesses {
            Thicknesses::Any => return Ok(rows),
            Thicknesses::Of(_) => "thicknesses",
            Thicknesses::AtMost(_) => "few",
            Thicknesses::Gradual(_) => "gradual",
        };
        rows.insert(2, self.row_of(rule, &self.plan(progress)?));
        Ok(rows)
    }
}
