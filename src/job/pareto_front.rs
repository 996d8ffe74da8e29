//! The Pareto front of plans, from both ends: the least sum of volume deviations, and the smallest maximum error.

use super::stages::planned::PlannedModel;
use super::stages::planning::Planning;
use super::stages::stage::{Stage, StageProgress, report};
use super::{Error, FrontPoint, Job, JobOptions, SumAndMaximum};
use crate::plan::optimal::{self, Objective};
use crate::plan::snap_cost::SnapPlanes;
use crate::plan::tradeoff::{self, Goal};
use crate::plan::{Limits, Plan, PlanError, least_sum};
use crate::profile::{LayerErrors, Metric, Source};
use crate::quantity::Quantity;

impl Job {
    /// Plans of a plate with the least sum of volume deviations, paired with those of the smallest maximum error, for
    /// about `points` numbers of layers from the fewest to the most. The tolerance is ignored. The last plan is kept.
    ///
    /// # Errors
    /// Any [`Error`] of sampling and planning.
    pub async fn front(
        &mut self,
        plate: usize,
        options: &JobOptions,
        points: usize,
        progress: &mut StageProgress<'_>,
    ) -> Result<Vec<FrontPoint>, Error> {
        let mut by_volume = options.clone();
        by_volume.options.metric = Metric::Volume;
        // Areas that are measured for volumes stay when the metric of the options is measured.
        self.measured_plate(plate, &by_volume, progress).await?;
        let (models, layering) = self.measured_plate(plate, options, progress).await?;
        let parts = models.iter().map(PlannedModel::part).collect();
        Planning::new(parts, &layering).front(points, progress)
    }
}

impl Planning<'_> {
    fn front(
        &self,
        points: usize,
        progress: &mut StageProgress<'_>,
    ) -> Result<Vec<FrontPoint>, Error> {
        let volumes = self.unweighted(Metric::Volume, Source::Exact);
        let without_tolerance = self.layering.limits(Quantity::Tolerance.range()[1]);
        report(progress, Stage::Plan, 0.0)?;
        let plans = least_sum::plans(&volumes, &without_tolerance, usize::MAX)?;
        let last = plans.len() - 1;
        let steps = points.clamp(2, plans.len().max(2)) - 1;
        let mut chosen: Vec<usize> = (0..=steps).map(|step| step * last / steps).collect();
        chosen.dedup();
        let mut front = Vec::with_capacity(chosen.len());
        for (place, &plan) in chosen.iter().enumerate() {
            report(progress, Stage::Plan, place as f64 / chosen.len() as f64)?;
            let least_sum = &plans[plan].plan;
            let errors_of = |plan: &Plan| SumAndMaximum {
                volume_mm3: sum(&volumes, plan),
                max_error: self.max_error(plan),
            };
            let layers = least_sum.layers();
            front.push(FrontPoint {
                layers,
                least_sum: errors_of(least_sum),
                least_maximum: errors_of(&self.least_maximum(&without_tolerance, layers)?),
            });
        }
        Ok(front)
    }

    /// The plan of the smallest maximum error with at most this number of layers.
    fn least_maximum(&self, limits: &Limits, layers: usize) -> Result<Plan, PlanError> {
        let goal = Goal::Layers(layers);
        let resin = &self.layering.resin;
        let tolerance = tradeoff::tolerance_for(self.errors(), limits, resin, goal)?;
        let limits = Limits {
            tolerance,
            ..limits.clone()
        };
        let objective = Objective::Layers;
        optimal::plan(self.errors(), &limits, SnapPlanes::NONE, objective)
    }
}

/// The sum of the errors of all layers that the tolerance covers.
fn sum(errors: &LayerErrors, plan: &Plan) -> f64 {
    let layers = plan.covered().windows(2);
    let steps = layers.map(|layer| errors.steps_between(layer[0], layer[1]));
    errors.to_value(steps.sum())
}
