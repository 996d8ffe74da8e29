//! Time and resin of a plate of several models, and each copy's fair share.

use super::places::Layout;
use super::stages::planned::{Planned, PlannedModel};
use super::stages::planning::Planning;
use super::stages::prepared::Supported;
use super::{Job, JobOptions, ModelOptions, ModelReport};
use crate::plan::Plan;
use crate::resin::Resin;

impl Job {
    /// The models of a plate, each with its share of the plan.
    pub(super) fn shares(
        &self,
        options: &JobOptions,
        layout: &Layout,
        planned: &Planned,
    ) -> Vec<ModelReport> {
        let by_model = || planned.models.chunk_by(|a, b| a.model == b.model);
        let is_shared = by_model().count() > 1;
        let mut models = Vec::new();
        let mut sharers = Vec::new();
        for turned in by_model() {
            let model = turned[0].model;
            let loaded = &self.models[model];
            let copies = turned.iter().map(|it| it.copies).sum();
            let sampled = turned[0].sampled();
            let prepared = &self.prepared[model];
            sharers.push(Sharer {
                height_mm: sampled.height_mm,
                shadow_mm2: if is_shared {
                    prepared.shadow_mm2()
                } else {
                    1.0
                },
                copies,
            });
            let has_own_tolerance = turned.iter().any(|it| it.tolerance.is_some());
            let [max_error, max_deviation_mm] = if is_shared || has_own_tolerance {
                let parts = turned.iter().map(PlannedModel::part_alone);
                let planning = Planning::new(parts.collect(), &planned.layering);
                let plan = &planned.plan;
                [planning.max_error(plan), planning.max_deviation_mm(plan)]
            } else {
                // Those of the plate are its own.
                let findings = &planned.findings;
                [findings.max_error, findings.max_deviation_mm]
            };
            let asked = options.of_model(model);
            let asked = asked.pose_over(layout.resolved.sampling.pose);
            let mut warnings = loaded.file_warnings(asked);
            for warning in &sampled.warnings {
                if !warnings.contains(warning) {
                    warnings.push(warning.clone());
                }
            }
            let supports = prepared.supports.as_ref();
            models.push(ModelReport {
                model,
                file: loaded.facts.file.clone(),
                options: ModelOptions {
                    copies,
                    ..layout.own(options, model)
                },
                weights_crc32: loaded.weights_crc32(),
                copies,
                size_mm: self.size_mm(options, &layout.resolved, model),
                facets: sampled.mesh().surface_facets,
                hits: turned
                    .iter()
                    .map(|it| it.sampled().survey.hits as usize)
                    .sum(),
                layers: layers_reaching(&planned.plan, sampled.height_mm),
                resin_ml: sampled.survey.solid.volume_mm3 / 1e3,
                print_time_s: 0.0,
                max_error,
                max_deviation_mm,
                hollowed: prepared.hollowed.clone(),
                supported: supports.map(|it| Supported::of(it, sampled.survey.support_mm3)),
                warnings,
            });
        }
        let shares_s = match &sharers[..] {
            [alone] => vec![planned.findings.print_time_s / alone.copies as f64],
            _ => time_shares_s(&planned.plan, &planned.layering.resin, &sharers),
        };
        for (model, share_s) in models.iter_mut().zip(shares_s) {
            model.print_time_s = share_s;
        }
        models
    }
}

/// A model as it shares the cost of layers.
#[derive(Debug, Clone, Copy)]
struct Sharer {
    height_mm: f64,
    shadow_mm2: f64,
    copies: usize,
}

/// Number of layers that reach a height.
fn layers_reaching(plan: &Plan, height_mm: f64) -> usize {
    let bottoms_mm = plan.z_mm();
    let reached = bottoms_mm[..plan.layers()].partition_point(|&z_mm| z_mm < height_mm);
    reached.max(1)
}

/// Each copy's share of the print time in seconds.
fn time_shares_s(plan: &Plan, resin: &Resin, sharers: &[Sharer]) -> Vec<f64> {
    let exposures_s = resin.exposures_s(&plan.thickness_mm());
    let reached: Vec<usize> = sharers
        .iter()
        .map(|sharer| layers_reaching(plan, sharer.height_mm))
        .collect();
    let mut shares_s = vec![0.0; sharers.len()];
    for (layer, exposure_s) in exposures_s.iter().enumerate() {
        let reaches = |place: usize| reached[place] > layer;
        let all_mm2: f64 = (0..sharers.len())
            .filter(|&place| reaches(place))
            .map(|place| sharers[place].shadow_mm2 * sharers[place].copies as f64)
            .sum();
        let time_s = resin.time_s(&[*exposure_s]);
        for (place, share_s) in shares_s.iter_mut().enumerate() {
            if reaches(place) && all_mm2 > 0.0 {
                *share_s += time_s * sharers[place].shadow_mm2 / all_mm2;
            }
        }
    }
    shares_s
}
