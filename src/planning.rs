//! From the shape of a model to a plan and its figures: which errors a planner sees, at which tolerance, with which
//! wishes.

use std::borrow::Borrow;

use crate::grid::Bins;
use crate::job::{Aim, Layering};
use crate::ldi::Ldi;
use crate::ldi::visibility::{Visibility, visibility};
use crate::mesh::Mesh;
use crate::options::Planner;
use crate::plan::optimal::Objective;
use crate::plan::tradeoff::{self, Goal, TradeoffPoint};
use crate::plan::{Limits, Plan, PlanError, greedy, optimal, uniform};
use crate::profile::relief::{Flat, Relief};
use crate::profile::weighted::Weighted;
use crate::profile::wishes::wishes;
use crate::profile::{LayerErrors, Metric, Profile, Shape, Source, section, steepest};
use crate::report::{PlannerReport, UniformReport};
use crate::warning::Warning;

/// The shape of a model from both sources.
#[derive(Debug)]
pub(crate) struct Shapes {
    pub exact: Shape,
    pub sampled: Shape,
    /// Horizontal facets that are not hidden.
    flats: Vec<Flat>,
    /// Facets wholly inside the solid.
    hidden: Vec<bool>,
    /// Whether bodies overlap in a way that only rays can sort out.
    overlaps: bool,
    weighing: Option<Weighing>,
}

/// The shapes under weights.
#[derive(Debug)]
struct Weighing {
    metric: Metric,
    weights: Vec<f32>,
    exact: Weighted,
    sampled: Weighted,
}

impl Shapes {
    pub fn new(mesh: &Mesh, ldi: &Ldi, bins: Bins) -> Self {
        let Visibility { hidden, overlaps } = visibility(mesh, ldi);
        let relief = Relief::of(mesh, bins);
        let shape = |steepest| Shape {
            bins,
            steepest,
            areas_mm2: Vec::new(),
        };
        Self {
            exact: shape(steepest::exact(&relief, &hidden)),
            sampled: shape(steepest::sampled(&relief, ldi, &hidden)),
            flats: relief.flats_but(&hidden),
            hidden,
            overlaps,
            weighing: None,
        }
    }

    /// The shape of facets alone, where there are no rays: it stands for both sources, and no facet is known to be hidden.
    /// `areas_mm2` may be empty if the metric is not made of them.
    pub fn of_relief(relief: &Relief, areas_mm2: Vec<f64>) -> Self {
        let exact = Shape {
            bins: relief.bins,
            steepest: steepest::exact(relief, &[]),
            areas_mm2,
        };
        Self {
            sampled: exact.clone(),
            exact,
            flats: relief.flats.clone(),
            hidden: Vec::new(),
            overlaps: false,
            weighing: None,
        }
    }

    /// Weighs the facets of the surface for a metric, or all alike; returns whether anything was measured for it, on the
    /// relief that the shapes are of. Without an LDI what is exact stands for both sources.
    pub fn weigh<R: Borrow<Relief>>(
        &mut self,
        relief: impl FnOnce() -> R,
        ldi: Option<&Ldi>,
        metric: Metric,
        weights: Option<Vec<f32>>,
    ) -> bool {
        let Some(weights) = weights else {
            self.weighing = None;
            return false;
        };
        let kept = self.weighing.as_ref();
        if kept.is_some_and(|kept| kept.metric == metric && kept.weights == weights) {
            return false;
        }
        let relief = relief();
        let measure = |ldi| Weighted::new(relief.borrow(), ldi, &self.hidden, metric, &weights);
        let exact = measure(None);
        let sampled = ldi.map_or_else(|| exact.clone(), |ldi| measure(Some(ldi)));
        self.weighing = Some(Weighing {
            metric,
            weights,
            exact,
            sampled,
        });
        true
    }

    /// The profile of a metric, weighted if facets were weighed for it.
    pub fn profile(&self, metric: Metric, source: Source) -> Profile {
        let shape = self.of(source);
        match self.weighted(metric, source) {
            Some(weighted) => weighted.profile(shape),
            None => shape.profile(metric),
        }
    }

    /// The errors of layers, weighted if facets were weighed for the metric.
    pub fn errors(&self, metric: Metric, source: Source) -> LayerErrors {
        let shape = self.of(source);
        match self.weighted(metric, source) {
            Some(weighted) => weighted.errors(shape),
            None => shape.errors(metric),
        }
    }

    fn weighted(&self, metric: Metric, source: Source) -> Option<&Weighted> {
        let weighing = self.weighing.as_ref();
        let weighing = weighing.filter(|weighing| weighing.metric == metric)?;
        Some(match source {
            Source::Exact => &weighing.exact,
            Source::Sampled => &weighing.sampled,
        })
    }

    /// Measures the areas of sections as well, unless that was done; returns whether it was not.
    pub fn add_areas(&mut self, mesh: &Mesh, ldi: &Ldi) -> bool {
        if !self.sampled.areas_mm2.is_empty() {
            return false;
        }
        let bins = self.exact.bins;
        self.sampled.areas_mm2 = section::sampled(ldi, bins);
        self.exact.areas_mm2 = if self.overlaps {
            self.sampled.areas_mm2.clone()
        } else {
            section::exact(mesh, &self.hidden, bins)
        };
        true
    }

    pub fn of(&self, source: Source) -> &Shape {
        match source {
            Source::Exact => &self.exact,
            Source::Sampled => &self.sampled,
        }
    }
}

/// All that planners need to know about a model.
pub(crate) struct Planning<'a> {
    shapes: &'a Shapes,
    layering: &'a Layering,
    height_mm: f64,
    /// Errors under the metric, of the source that plans are made from.
    errors: LayerErrors,
    /// The same of the exact shape, for reports.
    exact: LayerErrors,
    wishes: Vec<u32>,
    /// The tolerance that the options give or ask to find, or why there is none.
    tolerance: Result<f64, PlanError>,
}

/// A plan's figures.
pub(crate) struct PlanReport {
    pub snapped_mm: Vec<f64>,
    pub tolerance: f64,
    pub max_error: f64,
    pub sampled_error: f64,
    pub max_error_mm: f64,
    pub print_time_s: f64,
    pub uniform: UniformReport,
    pub warnings: Vec<Warning>,
}

impl<'a> Planning<'a> {
    pub fn new(height_mm: f64, shapes: &'a Shapes, layering: &'a Layering) -> Self {
        let exact = shapes.errors(layering.metric, Source::Exact);
        let errors = match layering.source {
            Source::Exact => exact.clone(),
            Source::Sampled => shapes.errors(layering.metric, Source::Sampled),
        };
        let wishes = match layering.snap_mm2 {
            None => Vec::new(),
            Some(area_mm2) => {
                let cusp = shapes.of(layering.source).profile(Metric::Cusp);
                wishes(&shapes.flats, &cusp.density, cusp.bins, area_mm2)
            }
        };
        Self {
            shapes,
            height_mm,
            tolerance: tolerance(&errors, &wishes, layering),
            layering,
            errors,
            exact,
            wishes,
        }
    }

    fn limits(&self) -> Result<Limits, PlanError> {
        Ok(self.layering.limits(self.tolerance.clone()?))
    }

    /// The largest error of a plan on the mesh itself, in the metric's unit.
    pub fn max_error(&self, plan: &Plan) -> f64 {
        plan.max_error(&self.exact)
    }

    pub fn plan(&self) -> Result<Plan, PlanError> {
        self.plan_by(self.layering.planner)
    }

    fn plan_by(&self, planner: Planner) -> Result<Plan, PlanError> {
        let (errors, wishes) = (&self.errors, &self.wishes);
        let bins = errors.bins();
        let greedily = |sight| greedy::plan(errors, &self.limits()?, wishes, sight);
        match planner {
            Planner::Optimal => {
                // The time is what a longest time is about.
                let objective = match self.layering.aim {
                    Aim::Time(_) => Objective::Time(&self.layering.resin),
                    _ => self.layering.objective(),
                };
                optimal::plan(errors, &self.limits()?, wishes, objective)
            }
            Planner::Greedy => greedily(greedy::Sight::Profile),
            Planner::Local => greedily(greedy::Sight::Plane),
            Planner::Uniform { layer_mm } => uniform::plan(bins, self.height_mm, layer_mm),
            Planner::Finest | Planner::Coarsest => {
                let limits = self.layering.limits(0.0);
                let thickness = limits.thickness(bins, limits.layer_min_mm, limits.layer_max_mm)?;
                let units = match planner {
                    Planner::Finest => *thickness.start(),
                    _ => *thickness.end(),
                };
                let layer_mm = bins.boundary_mm(units * limits.unit(bins)?);
                match uniform::plan(bins, self.height_mm, layer_mm) {
                    // A model lower than half a layer is one layer here, as it is for the optimal planner.
                    Err(PlanError::LayerTooThick { .. }) => Ok(Plan {
                        bins,
                        boundaries: vec![0, bins.count as u32],
                        wishes: Vec::new(),
                    }),
                    plan => plan,
                }
            }
        }
    }

    fn row(&self, planner: Planner) -> Result<PlannerReport, PlanError> {
        let plan = self.plan_by(planner)?;
        Ok(PlannerReport {
            planner: planner.name().to_owned(),
            layers: plan.layers(),
            max_error: self.max_error(&plan),
            print_time_s: plan.print_time_s(&self.layering.resin),
        })
    }

    pub fn report(&self, plan: &Plan) -> Result<PlanReport, PlanError> {
        let layering = self.layering;
        let (finest, coarsest) = match layering.planner {
            // They may be planned with no valid range; they then stand for both ends.
            Planner::Uniform { .. } if layering.limits(1.0).check(plan.bins).is_err() => {
                (layering.planner, layering.planner)
            }
            _ => (Planner::Finest, Planner::Coarsest),
        };
        let bins = plan.bins;
        let is_adaptive = matches!(
            layering.planner,
            Planner::Optimal | Planner::Greedy | Planner::Local
        );
        let tolerance = match self.tolerance.clone() {
            Ok(tolerance) => tolerance,
            Err(error) if is_adaptive => return Err(error),
            Err(_) => layering.metric.default_tolerance(),
        };
        let max_error = self.max_error(plan);
        let mut warnings = Vec::new();
        let planned_steps = plan.max_error_steps(&self.errors);
        if planned_steps > self.errors.to_steps(tolerance) {
            let planned = self.errors.to_value(planned_steps);
            warnings.push(Warning::ToleranceExceeded {
                planner: layering.planner.name().to_owned(),
                metric: layering.metric,
                tolerance,
                max_error: planned,
            });
        } else if plan.max_error_steps(&self.exact) > self.exact.to_steps(tolerance) {
            warnings.push(Warning::ToleranceExceededOnMesh {
                metric: layering.metric,
                tolerance,
                max_error,
            });
        }
        if self.shapes.overlaps && layering.metric.needs_areas() {
            warnings.push(Warning::SampledSections);
        }
        let top_mm = bins.boundary_mm(plan.boundaries[plan.layers()]);
        if (top_mm - self.height_mm).abs() > bins.size_mm && is_adaptive {
            warnings.push(Warning::TopMoved {
                top_mm,
                height_mm: self.height_mm,
            });
        }
        let cusp = self.shapes.exact.errors(Metric::Cusp);
        Ok(PlanReport {
            snapped_mm: plan
                .wishes
                .iter()
                .map(|&wish| bins.boundary_mm(wish))
                .collect(),
            tolerance,
            max_error,
            sampled_error: plan.max_error(&self.shapes.errors(layering.metric, Source::Sampled)),
            max_error_mm: plan.max_error(&cusp),
            print_time_s: plan.print_time_s(&layering.resin),
            uniform: UniformReport {
                finest: self.row(finest)?,
                coarsest: self.row(coarsest)?,
            },
            warnings,
        })
    }

    pub fn tradeoff(&self, points: usize) -> Result<Vec<TradeoffPoint>, PlanError> {
        tradeoff::curve(
            &self.errors,
            &self.layering.limits(0.0),
            &self.wishes,
            self.layering.objective(),
            &self.layering.resin,
            points,
        )
    }

    pub fn compare(&self) -> Result<Vec<PlannerReport>, PlanError> {
        [
            Planner::Coarsest,
            Planner::Optimal,
            Planner::Greedy,
            Planner::Local,
            Planner::Finest,
        ]
        .into_iter()
        .map(|planner| self.row(planner))
        .collect()
    }
}

/// The tolerance that is asked for, or is to be found.
fn tolerance(errors: &LayerErrors, wishes: &[u32], layering: &Layering) -> Result<f64, PlanError> {
    let goal = match layering.aim {
        Aim::Tolerance(tolerance) => return Ok(tolerance),
        Aim::AtLeast(usual) => {
            let limits = layering.limits(usual);
            let steps = errors.to_steps(usual);
            if optimal::within(errors, &limits, &[], Objective::Layers, steps)?.is_ok() {
                return Ok(usual);
            }
            let least = tradeoff::least_tolerance(errors, &limits, Objective::Layers);
            return Ok(least.unwrap_or(usual));
        }
        Aim::Layers(layers) => Goal::Layers(layers),
        Aim::Time(time_s) => Goal::Time(time_s),
    };
    let limits = layering.limits(0.0);
    tradeoff::tolerance_for(errors, &limits, wishes, &layering.resin, goal)
}
