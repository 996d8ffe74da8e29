//! Inputs of planners from the models of a plan: errors, tolerance and snap planes; and findings about a plan.

use std::borrow::Cow;

use super::measured::Part;
use super::parts::{Layering, Target, Thicknesses};
use super::tolerances::{Sharing, errors_of, largest, sharing, tolerance};
use crate::argsort::argsort;
use crate::cure::Cure;
use crate::grid::Bins;
use crate::job::{BestUniform, Error, Minimize, Planner, PlannerReport, UniformReport};
use crate::ldi::LdiError;
use crate::plan::optimal::Objective;
use crate::plan::snap_cost::{Price, SnapPlanes};
use crate::plan::tradeoff::{self, TradeoffPoint};
use crate::plan::uniform::layers_above;
use crate::plan::{Limits, Plan, PlanError, gradual, greedy, optimal, thicknesses, uniform};
use crate::profile::largest::Strictness;
use crate::profile::shapes::Shapes;
use crate::profile::snap_planes::{Surface, raised_planes};
use crate::profile::{LayerErrors, Metric, Source, area};
use crate::progress::{Progress, silent};
use crate::warning::Warning;

/// Steps between thicknesses of uniform layers that people choose, where the motor has none of its own.
const UNIFORM_STEP_MM: f64 = 0.001;

/// The fraction that an adaptive plan must save to be worth more than uniform layers.
const WORTHWHILE: f64 = 0.03;

/// Everything that planners need to know about the models of a plan.
pub struct Planning<'a> {
    /// The models; there is at least one.
    pub(in crate::job) parts: Vec<Part<'a>>,
    pub(in crate::job) layering: &'a Layering,
    height_mm: f64,
    /// Errors of layers under the metric, from the exact shape.
    exact: LayerErrors,
    /// The same from rays, if plans are made from them.
    sampled: Option<LayerErrors>,
    snap_planes: Vec<u32>,
    /// The tolerance that the options give or ask to find, or the error if none can be found.
    tolerance: Result<f64, PlanError>,
}

/// Findings about a plan besides its layers.
#[derive(Debug)]
pub struct Findings {
    pub snapped_mm: Vec<f64>,
    pub tolerance: f64,
    pub max_error: f64,
    pub sampled_error: Option<f64>,
    pub true_error: f64,
    pub max_error_mm: f64,
    pub max_deviation_mm: f64,
    pub print_time_s: f64,
    pub uniform: UniformReport,
    pub warnings: Vec<Warning>,
}

impl<'a> Planning<'a> {
    /// For the shapes of a model of this height.
    pub fn alone(height_mm: f64, shapes: &'a Shapes, layering: &'a Layering) -> Self {
        Self::new(vec![Part::alone(height_mm, shapes)], layering)
    }

    /// For several models, all in bins of the same size. The error of a layer is the largest over the models that reach it.
    pub fn new(parts: Vec<Part<'a>>, layering: &'a Layering) -> Self {
        let of = |source| errors_of(&parts, layering, layering.metric, source);
        let exact = of(Source::Exact);
        let sampled = match layering.source {
            Source::Exact => None,
            Source::Sampled => Some(of(Source::Sampled)),
        };
        let errors = sampled.as_ref().unwrap_or(&exact);
        let snap_planes = snap_planes_of(&parts, layering, errors.bins(), None);
        let heights_mm = parts.iter().map(|part| part.height_mm);
        Self {
            height_mm: heights_mm.fold(0.0, f64::max),
            parts,
            tolerance: tolerance(errors, layering),
            layering,
            exact,
            sampled,
            snap_planes,
        }
    }

    /// Moves snap planes at flats that face down to where their layers cure down to the flats, by the doses of a plan. Returns false if none
    /// moves.
    pub fn raise(&mut self, cure: &Cure) -> bool {
        let bins = self.errors().bins();
        let raised = |boundary: u32| match boundary {
            0 => 0,
            _ => bins.nearest_boundary(cure.plane_mm(bins.boundary_mm(boundary))),
        };
        let planes = snap_planes_of(&self.parts, self.layering, bins, Some(&raised));
        let before = std::mem::replace(&mut self.snap_planes, planes);
        before != self.snap_planes
    }

    /// Errors of layers under the metric, from the source that plans are made from.
    pub(in crate::job) fn errors(&self) -> &LayerErrors {
        self.sampled.as_ref().unwrap_or(&self.exact)
    }

    /// The errors of layers under another metric, without weights and without tolerances of models' own.
    pub(in crate::job) fn unweighted(&self, metric: Metric, source: Source) -> LayerErrors {
        largest(self.parts.iter().map(|part| {
            let errors = part.shapes.of(source).errors(metric);
            (errors, Strictness::NONE)
        }))
    }

    /// The snap planes of the optimal planner. Where layers or time are given, they must not cost any.
    fn snap_planes(&self) -> SnapPlanes<'_> {
        SnapPlanes {
            planes: &self.snap_planes,
            price: match self.layering.target {
                Target::Tolerance(_) | Target::AtLeast(_) => Price::Layer,
                Target::Layers(_) | Target::Time(_) => Price::Nothing,
            },
        }
    }

    fn limits(&self) -> Result<Limits, PlanError> {
        Ok(self.layering.limits(self.tolerance.clone()?))
    }

    /// The largest error of a plan on the mesh itself, in the metric's unit.
    pub fn max_error(&self, plan: &Plan) -> f64 {
        plan.max_error(&self.exact)
    }

    /// The largest distance from the print to the models. A fixed first layer counts.
    pub fn max_deviation_mm(&self, plan: &Plan) -> f64 {
        let all_layers = Plan {
            exempt_layers: 0,
            ..plan.clone()
        };
        all_layers.max_error(&self.unweighted(Metric::Deviation, Source::Exact))
    }

    /// The plan that the options ask for.
    ///
    /// # Errors
    /// [`Error::Plan`]; [`Error::Ldi`] if `progress` cancels.
    pub fn plan(&self, progress: &mut Progress<'_>) -> Result<Plan, Error> {
        self.plan_as_asked(progress).map_err(|error| match error {
            Error::Plan(error) => self.in_own_figures(error).into(),
            error => error,
        })
    }

    /// An error of a plan in which models have tolerances of their own, with the tolerance that prevents the plan, and
    /// the least that allows it. If several do, each alone would have to be larger, and the next plan names the next
    /// one.
    fn in_own_figures(&self, error: PlanError) -> PlanError {
        let Target::Tolerance(of) = self.layering.target else {
            return error;
        };
        if self.parts.iter().all(|part| part.tolerance.is_none()) {
            return error;
        }
        let advice_on = |errors: &LayerErrors, sharing: &Sharing| {
            let planning = Planning {
                parts: Vec::new(),
                layering: self.layering,
                height_mm: self.height_mm,
                exact: errors.clone(),
                sampled: None,
                snap_planes: Vec::new(),
                tolerance: Ok(sharing.tolerance),
            };
            let Err(Error::Plan(own)) = planning.plan_as_asked(&mut silent) else {
                return None;
            };
            let least = own.least_tolerance()?;
            // Beyond every tolerance: another model prevents the plan as well.
            let is_possible = errors.to_steps(least) < u64::MAX / 2;
            is_possible.then(|| error.of_model(sharing.model_number, sharing.tolerance, least))
        };
        let sharing = sharing(&self.parts, self.layering, of);
        let both = sharing.iter().find_map(|it| advice_on(&it.errors, it));
        let alone = || {
            sharing
                .iter()
                .find_map(|it| advice_on(&it.errors_alone, it))
        };
        both.or_else(alone).unwrap_or(error)
    }

    fn plan_as_asked(&self, progress: &mut Progress<'_>) -> Result<Plan, Error> {
        let errors = self.errors();
        let limits = || self.limits();
        Ok(match &self.layering.thicknesses {
            Thicknesses::Any => self.plan_freely()?,
            Thicknesses::Of(thicknesses_mm) => thicknesses::of(errors, &limits()?, thicknesses_mm)?,
            Thicknesses::AtMost(count) => {
                let steps = thicknesses::DEFAULT_STEPS;
                let found = thicknesses::at_most(errors, &limits()?, *count, steps, progress);
                found.map_err(LdiError::from)??.plan
            }
            Thicknesses::Gradual(change_mm) => gradual::plan(errors, &limits()?, *change_mm)?,
        })
    }

    /// The plan of the options' planner if layers may have any thickness within the limits. It never takes long.
    ///
    /// # Errors
    /// [`PlanError`].
    pub fn plan_freely(&self) -> Result<Plan, PlanError> {
        self.plan_by(self.layering.planner)
    }

    fn plan_by(&self, planner: Planner) -> Result<Plan, PlanError> {
        let (errors, snap_planes) = (self.errors(), &self.snap_planes);
        let bins = errors.bins();
        let greedily = |sight| greedy::plan(errors, &self.limits()?, snap_planes, sight);
        match planner {
            Planner::Optimal => {
                // A target of time minimizes time, whatever the options minimize.
                let objective = match self.layering.target {
                    Target::Time(_) => Objective::Time(&self.layering.resin),
                    _ => self.layering.objective(),
                };
                optimal::plan(errors, &self.limits()?, self.snap_planes(), objective)
            }
            Planner::Greedy => greedily(greedy::Sight::Profile),
            Planner::Local => greedily(greedy::Sight::Plane),
            Planner::Uniform { layer_mm } => self.uniform(layer_mm),
            Planner::Finest | Planner::Coarsest => {
                let limits = self.layering.limits(0.0);
                let thickness = limits.thickness(bins, limits.layer_min_mm, limits.layer_max_mm)?;
                let units = match planner {
                    Planner::Finest => *thickness.start(),
                    _ => *thickness.end(),
                };
                let layer_mm = bins.boundary_mm(units * limits.unit(bins)?);
                match self.uniform(layer_mm) {
                    // A model less than half a layer high is one layer, as with the optimal planner.
                    Err(PlanError::LayerTooThick { .. }) => Ok(Plan {
                        bins,
                        boundaries: vec![0, bins.count as u32],
                        snap_planes: Vec::new(),
                        exempt_layers: 0,
                    }),
                    plan => plan,
                }
            }
        }
    }

    fn uniform(&self, layer_mm: f64) -> Result<Plan, PlanError> {
        let bins = self.errors().bins();
        let first_layer = self.layering.limits(0.0).first_layer(bins)?;
        uniform::plan(bins, self.height_mm, layer_mm, first_layer)
    }

    /// The fewest and the quickest uniform layers within a tolerance, of every thickness within the limits that the
    /// motor can make; without a motor step, of every micrometre. The top counts: the rest above the last layer must be
    /// within the tolerance as well, and if errors are distances, the top must be no farther from the model's.
    fn uniform_within(&self, tolerance: f64) -> Result<[Option<BestUniform>; 2], PlanError> {
        let resin = &self.layering.resin;
        let limits = self.layering.limits(tolerance);
        let parts = match limits.step_mm {
            Some(_) => 1,
            None => (self.errors().bins().size_mm / UNIFORM_STEP_MM + 0.5).max(1.0) as usize,
        };
        let errors = &*match parts {
            1 => Cow::Borrowed(self.errors()),
            _ => Cow::Owned(self.errors().split(parts)),
        };
        let bins = errors.bins();
        let first_layer = limits.first_layer(bins)?;
        let unit = limits.unit(bins)?;
        let range = limits.thickness(bins, limits.layer_min_mm, limits.layer_max_mm)?;
        let first_mm = (first_layer > 0).then(|| bins.boundary_mm(first_layer));
        // Thickness, number of layers and print time.
        let candidates = range.filter_map(|units| {
            let thickness = units * unit;
            let above = layers_above(bins, self.height_mm, f64::from(thickness), first_layer)?;
            let layer_mm = bins.boundary_mm(thickness);
            let layers = above as usize + usize::from(first_layer > 0);
            Some((
                layer_mm,
                layers,
                resin.uniform_time_s(layers, layer_mm, first_mm),
            ))
        });
        let candidates: Vec<_> = candidates.collect();
        let steps = errors.to_steps(tolerance);
        let holds = |plan: &Plan| {
            let top = plan.boundaries[plan.layers()];
            let is_top_near = !self.layering.metric.is_distance()
                || (bins.boundary_mm(top) - self.height_mm).abs() <= tolerance;
            let end = bins.count as u32;
            let mut layers = plan.covered().windows(2);
            is_top_near
                && (top >= end || errors.steps_between(top, end) <= steps)
                && layers.all(|layer| errors.steps_between(layer[0], layer[1]) <= steps)
        };
        // The thinnest of as many layers comes first.
        let best_by = |cost: fn(&(f64, usize, f64)) -> f64| {
            let order = argsort(candidates.iter().map(cost)).into_iter();
            let mut plans = order.filter_map(|place| {
                let (layer_mm, _, print_time_s) = candidates[place];
                let plan = uniform::plan(bins, self.height_mm, layer_mm, first_layer).ok()?;
                Some((layer_mm, plan, print_time_s))
            });
            let (layer_mm, plan, print_time_s) = plans.find(|(_, plan, _)| holds(plan))?;
            Some(BestUniform {
                layer_mm,
                layers: plan.layers(),
                max_error: plan.max_error(errors),
                print_time_s,
            })
        };
        let fewest = best_by(|&(_, layers, _)| layers as f64);
        Ok([fewest, best_by(|&(_, _, print_time_s)| print_time_s)])
    }

    fn uniform_report(
        &self,
        [finest, coarsest]: [Planner; 2],
        plan: &Plan,
        tolerance: f64,
    ) -> Result<UniformReport, PlanError> {
        let Layering {
            minimize,
            planner,
            resin,
            ..
        } = self.layering;
        // Uniform layers may be planned without a valid range of thicknesses.
        let [fewest, quickest] = self.uniform_within(tolerance).unwrap_or_default();
        let mut report = UniformReport {
            finest: self.row(finest)?,
            coarsest: self.row(coarsest)?,
            fewest,
            quickest,
            is_enough: false,
        };
        report.is_enough = planner.is_adaptive()
            && report.best(*minimize).is_some_and(|best| {
                let (own, uniform) = match minimize {
                    Minimize::Layers => (plan.layers() as f64, best.layers as f64),
                    Minimize::Time => (plan.print_time_s(resin), best.print_time_s),
                };
                own > uniform * (1.0 - WORTHWHILE)
            });
        Ok(report)
    }

    pub(in crate::job) fn row(&self, planner: Planner) -> Result<PlannerReport, PlanError> {
        Ok(self.row_of(planner.name(), &self.plan_by(planner)?))
    }

    pub(in crate::job) fn row_of(&self, planner: &str, plan: &Plan) -> PlannerReport {
        PlannerReport {
            planner: planner.to_owned(),
            layers: plan.layers(),
            max_error: self.max_error(plan),
            print_time_s: plan.print_time_s(&self.layering.resin),
        }
    }

    pub(in crate::job) fn findings(&self, plan: &Plan) -> Result<Findings, PlanError> {
        let layering = self.layering;
        let (finest, coarsest) = match layering.planner {
            // Uniform layers may be planned without a valid range of thicknesses. They then stand for both ends.
            Planner::Uniform { .. } if layering.limits(1.0).check(plan.bins).is_err() => {
                (layering.planner, layering.planner)
            }
            _ => (Planner::Finest, Planner::Coarsest),
        };
        let bins = plan.bins;
        let is_adaptive = layering.planner.is_adaptive();
        let tolerance = match self.tolerance.clone() {
            Ok(tolerance) => tolerance,
            Err(error) if is_adaptive => return Err(error),
            Err(_) => layering.metric.default_tolerance(),
        };
        let max_error = self.max_error(plan);
        let mut warnings = Vec::new();
        let planned_steps = plan.max_error_steps(self.errors());
        if planned_steps > self.errors().to_steps(tolerance) {
            let planned = self.errors().to_value(planned_steps);
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
        let overlaps = self.parts.iter().any(|part| part.shapes.overlaps);
        if overlaps && layering.metric.needs_areas() {
            warnings.push(Warning::SampledSections);
        }
        let top_mm = bins.boundary_mm(plan.boundaries[plan.layers()]);
        if (top_mm - self.height_mm).abs() > bins.size_mm && is_adaptive {
            warnings.push(Warning::TopMoved {
                top_mm,
                height_mm: self.height_mm,
            });
        }
        let exact = |metric| self.unweighted(metric, Source::Exact);
        let unweighted = |metric| plan.max_error(&exact(metric));
        let true_error = match layering.metric {
            Metric::Area => {
                let changes = self
                    .parts
                    .iter()
                    .map(|part| area::largest_change(&part.shapes.exact.areas_mm2, plan.covered()));
                changes.fold(0.0, f64::max)
            }
            metric => unweighted(metric),
        };
        // This holds for every point of the print, so for a fixed first layer as well.
        let max_deviation_mm = self.max_deviation_mm(plan);
        Ok(Findings {
            snapped_mm: plan
                .snap_planes
                .iter()
                .map(|&snap_plane| bins.boundary_mm(snap_plane))
                .collect(),
            tolerance,
            max_error,
            sampled_error: self.sampled.as_ref().map(|errors| plan.max_error(errors)),
            true_error,
            max_error_mm: unweighted(Metric::Cusp),
            max_deviation_mm,
            print_time_s: plan.print_time_s(&layering.resin),
            uniform: self.uniform_report([finest, coarsest], plan, tolerance)?,
            warnings,
        })
    }

    pub fn tradeoff(&self, points: usize) -> Result<Vec<TradeoffPoint>, PlanError> {
        tradeoff::curve(
            self.errors(),
            &self.layering.limits(0.0),
            self.snap_planes(),
            self.layering.objective(),
            &self.layering.resin,
            points,
        )
    }
}

/// The snap planes of models, those at flats that face down where `raised` puts them.
fn snap_planes_of(
    parts: &[Part<'_>],
    layering: &Layering,
    bins: Bins,
    raised: Option<&dyn Fn(u32) -> u32>,
) -> Vec<u32> {
    let Some(area_mm2) = layering.snap_mm2 else {
        return Vec::new();
    };
    let surfaces = parts.iter().map(|part| Surface {
        flats: &part.shapes.flats,
        // Rays miss upright walls, and with them where a slope begins.
        steepest: &part.shapes.of(Source::Exact).steepest,
    });
    let surfaces: Vec<Surface<'_>> = surfaces.collect();
    raised_planes(&surfaces, bins, area_mm2, raised)
}
