//! Planners side by side.

use super::parts::Thicknesses;
use super::planning::Planning;
use super::stage::{Stage, StageProgress, report};
use super::{Comparison, Error, Options, Planner, PlannerReport, Slicer, Timings};
use crate::progress::Progress;

impl Slicer {
    /// Compares the plans of five planners, from the coarsest to the finest (table 3), and that of a thickness rule if the options
    /// have one. The last plan is kept.
    ///
    /// # Errors
    /// Any [`Error`] of sampling and planning.
    pub async fn compare(
        &mut self,
        options: &Options,
        progress: &mut StageProgress<'_>,
    ) -> Result<Comparison, Error> {
        let job = self.job(options)?;
        let mut timings = Timings::default();
        let measured = self.measure(&job, &mut timings, progress).await?;
        report(progress, Stage::Plan, 0.0)?;
        let planning = Planning::of(&measured, &job.layering);
        let rows = planning.compare(&mut |fraction| progress(Stage::Plan, fraction))?;
        report(progress, Stage::Plan, 1.0)?;
        let metric = job.layering.metric;
        Ok(Comparison {
            facets: measured.of.mesh().surface_facets,
            height_mm: measured.of.height_mm,
            metric,
            unit: metric.unit().to_owned(),
            rows,
        })
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
