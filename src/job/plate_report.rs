//! What a plate of several models needs of time and resin, and each copy's fair share.

use serde::Serialize;

use super::{ModelOptions, Placement};
use crate::model::ModelFile;
use crate::plan::Plan;
use crate::resin::Resin;
use crate::warning::Warning;

/// The models of a plate.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct PlateReport {
    /// The plate, from 0.
    pub plate: usize,
    /// Number of plates of the job.
    pub plates: usize,
    /// The models on this plate.
    pub models: Vec<PlateModelReport>,
    /// Where each copy stands.
    pub placements: Vec<Placement>,
    /// Least distance between copies that was asked for, in millimetres.
    pub spacing_mm: f64,
}

/// A model on a plate.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct PlateModelReport {
    /// The model, by its index in the job.
    pub model: usize,
    /// Its file.
    pub file: ModelFile,
    /// How it differs from the options of the job.
    pub options: ModelOptions,
    /// CRC-32 of the user's weights of its facets, if any.
    pub weights_crc32: Option<u32>,
    /// Copies on this plate.
    pub copies: usize,
    /// Extent of the model in x, y and z, before turns about z.
    pub size_mm: [f64; 3],
    /// Layers that reach it.
    pub layers: usize,
    /// Volume of resin in a copy.
    pub resin_ml: f64,
    /// A copy's share of the print time. The time of each layer is divided among the copies that it reaches, in proportion to their
    /// shadows on the plate.
    pub print_time_s: f64,
    /// The largest exact error of a layer on this model, in the metric's unit.
    pub max_error: f64,
    /// The largest distance from the print to this model.
    pub max_deviation_mm: f64,
    /// Warnings about this model.
    pub warnings: Vec<Warning>,
}

/// A model as it shares the cost of layers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sharer {
    pub height_mm: f64,
    pub shadow_mm2: f64,
    pub copies: usize,
}

/// Number of layers that reach a height.
pub(super) fn layers_reaching(plan: &Plan, height_mm: f64) -> usize {
    let bottoms_mm = plan.z_mm();
    let reached = bottoms_mm[..plan.layers()].partition_point(|&z_mm| z_mm < height_mm);
    reached.max(1)
}

/// Each copy's share of the print time in seconds.
pub(super) fn time_shares_s(plan: &Plan, resin: &Resin, sharers: &[Sharer]) -> Vec<f64> {
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

/// What the plates of a job need in all.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct PlatesReport {
    /// The schema version of this object: [`super::SCHEMA`].
    pub schema: u32,
    /// Print time of all plates, one after the other.
    pub print_time_s: f64,
    /// Volume of resin in all copies.
    pub resin_ml: f64,
    /// The report of each plate.
    pub plates: Vec<super::Report>,
}
