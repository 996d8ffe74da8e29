//! Heights, exposures, moves and rests of a conversion. Values that differ by noise alone count as one.

use super::{ConvertError, LayerRead, Loss, SAME_MM};
use crate::archive::read::Metadata;
use crate::archive::{Layer, SAME_S, Schedule};
use crate::format::{Format, FormatThicknesses};
use crate::resin::Resin;

/// No printer lifts as slowly as this, in millimetres per minute.
const SLOWEST_MM_MIN: f64 = 1.0;
/// A longer fade is none: formats count its layers in 16 bits.
const LONGEST_FADE: usize = u16::MAX as usize;

/// The layers of a file without the noise of their heights.
///
/// If all are of one thickness, or all but the first, each ends at the height that this thickness gives it. Other layers
/// stay as they are.
pub(super) fn without_noise(metadata: &Metadata, layers: &[LayerRead]) -> Vec<LayerRead> {
    let mut layers = layers.to_vec();
    for first in 0..=1 {
        let bottom_mm = layers[..first].last().map_or(0.0, |layer| layer.z_mm);
        let Some(thickness_mm) = one_thickness(metadata, &layers[first..], bottom_mm) else {
            continue;
        };
        for (below, layer) in layers[first..].iter_mut().enumerate() {
            // Products, not sums: errors do not add up.
            layer.z_mm = to_nanometres(bottom_mm + (below + 1) as f64 * thickness_mm);
            layer.thickness_mm = thickness_mm;
        }
        break;
    }
    layers
}

/// The thickness of layers that stand on `bottom_mm`, if they have only one: the nominal one where it agrees, or else the mean.
fn one_thickness(metadata: &Metadata, layers: &[LayerRead], bottom_mm: f64) -> Option<f64> {
    let height_mm = layers.last()?.z_mm - bottom_mm;
    let count = layers.len() as f64;
    let mean_mm = height_mm / count;
    // A nominal thickness that counts for all layers is taken if it is within noise. Elsewhere it might be rounded: then it is
    // off by the same in every layer, whereas the noise of n thicknesses adds up to √n times that of one.
    let room_mm = match metadata.uses_layer_values {
        Some(false) => SAME_MM,
        _ => SAME_MM / count.sqrt(),
    };
    let nominal_mm = metadata
        .layer_mm
        .filter(|nominal_mm| (nominal_mm - mean_mm).abs() <= room_mm);
    let thickness_mm = nominal_mm.unwrap_or(to_nanometres(mean_mm));

    let thicknesses = layers.iter().map(|layer| layer.thickness_mm);
    let least_mm = thicknesses.clone().fold(f64::INFINITY, f64::min);
    let greatest_mm = thicknesses.fold(f64::NEG_INFINITY, f64::max);
    let is_one = greatest_mm - least_mm <= SAME_MM
        || layers.iter().enumerate().all(|(below, layer)| {
            let z_mm = bottom_mm + (below + 1) as f64 * thickness_mm;
            (layer.z_mm - z_mm).abs() <= SAME_MM
        });
    is_one.then_some(thickness_mm)
}

fn to_nanometres(length_mm: f64) -> f64 {
    (length_mm * 1e6).round() / 1e6
}

/// Exposures of the new file.
pub(super) struct Exposures {
    /// The resin.
    pub resin: Resin,
    /// Exposure of each layer in seconds.
    pub exposure_s: Vec<f64>,
    /// Number of layers of the fade.
    pub transition_layers: usize,
}

/// The resin of the new file, and the exposure of each layer.
pub(super) fn exposures(
    metadata: &Metadata,
    layers: &[LayerRead],
    resin: Option<&Resin>,
) -> Result<Exposures, ConvertError> {
    if let Some(resin) = resin {
        let thickness_mm: Vec<f64> = layers.iter().map(|layer| layer.thickness_mm).collect();
        return Ok(Exposures {
            resin: resin.clone(),
            exposure_s: resin.exposures_s(&thickness_mm),
            transition_layers: 0,
        });
    }
    let nominal = nominal(metadata);
    let exposure_s = stated_s(metadata, layers, nominal.as_ref())?;
    let schedule = nominal
        .filter(|nominal| nominal.fits(exposure_s.iter().copied()))
        .or_else(|| found(metadata, &exposure_s));
    // Without a schedule, layers that are exposed like the first one are bottom layers, if the file does not count them.
    let bottom_layers = schedule.map(|schedule| schedule.bottom_layers);
    let bottom_layers = bottom_layers
        .or(metadata.bottom_layers.map(|layers| layers as usize))
        .unwrap_or_else(|| like_first(&exposure_s));
    let transition_layers = schedule.map_or(0, |schedule| schedule.transition_layers);
    let exposure_s: Vec<f64> = match schedule {
        Some(schedule) => (0..layers.len())
            .map(|layer| schedule.exposure_s(layer))
            .collect(),
        None => exposure_s,
    };
    let usual = &layers[layers.len() / 2];
    let usual_s = schedule.map_or(exposure_s[layers.len() / 2], |schedule| schedule.usual_s);
    // A printer that always has bottom layers does not expose them longer than the file does.
    let bottom_exposure_s = match schedule {
        Some(schedule) if bottom_layers + transition_layers > 0 => schedule.bottom_s,
        _ => exposure_s[0],
    };
    let default = Resin::default();
    // Files for vats that tilt name a lift that takes forever.
    let moves = moves(usual).filter(|[_, lift_mm_min, _]| *lift_mm_min >= SLOWEST_MM_MIN);
    let [lift_mm, lift_mm_min, return_mm_min] =
        moves.unwrap_or([default.lift_mm, default.lift_mm_min, default.return_mm_min]);
    let resin = Resin {
        name: metadata.resin.clone().unwrap_or(default.name),
        layer_mm: usual.thickness_mm,
        exposure_s: usual_s,
        bottom_layers,
        bottom_exposure_s,
        wait_s: rests_s(usual).map_or(default.wait_s, |rests_s| rests_s.iter().sum()),
        lift_mm,
        lift_mm_min,
        return_mm_min,
        density_g_ml: density(metadata).unwrap_or(default.density_g_ml),
        ..default
    };
    Ok(Exposures {
        resin,
        exposure_s,
        transition_layers,
    })
}

/// Returns true if exposures are one, to the millisecond.
fn is_same(one_s: f64, other_s: f64) -> bool {
    (one_s - other_s).abs() <= SAME_S
}

fn positive(value: Option<f64>) -> Option<f64> {
    value.filter(|value| *value > 0.0)
}

/// The exposures that the head of a file states for all layers. Without an exposure of bottom layers, there are none.
fn nominal(metadata: &Metadata) -> Option<Schedule> {
    let usual_s = positive(metadata.exposure_s)?;
    let transition_layers = metadata.transition_layers.unwrap_or(0) as usize;
    let bottom_s = positive(metadata.bottom_exposure_s);
    Some(Schedule {
        bottom_layers: metadata.bottom_layers.unwrap_or(0) as usize,
        bottom_s: bottom_s.unwrap_or(usual_s),
        transition_layers: if bottom_s.is_some() && transition_layers <= LONGEST_FADE {
            transition_layers
        } else {
            0
        },
        usual_s,
    })
}

/// The exposure of each layer by the file, in seconds.
fn stated_s(
    metadata: &Metadata,
    layers: &[LayerRead],
    nominal: Option<&Schedule>,
) -> Result<Vec<f64>, ConvertError> {
    // CTB's printers take the exposures of layers whatever the file says of their values.
    let is_ignored = metadata.uses_layer_values == Some(false) && metadata.format != Format::Ctb;
    let exposure_of = |(place, layer): (usize, &LayerRead)| {
        let stated_s = positive(layer.exposure_s);
        let nominal_s = nominal.map(|nominal| nominal.exposure_s(place));
        let exposure_s = if is_ignored {
            nominal_s.or(stated_s)
        } else {
            stated_s.or(nominal_s)
        };
        exposure_s.ok_or(ConvertError::NoExposure)
    };
    layers.iter().enumerate().map(exposure_of).collect()
}

/// Bottom layers, a fade and one exposure above, if the exposures are no more than that.
fn found(metadata: &Metadata, exposure_s: &[f64]) -> Option<Schedule> {
    let (bottom_s, usual_s) = (*exposure_s.first()?, *exposure_s.last()?);
    let stated = metadata.bottom_layers.map(|layers| layers as usize);
    let counts = stated.into_iter().chain([like_first(exposure_s)]);
    let schedules = counts.filter_map(|bottom_layers| {
        let upper = exposure_s.get(bottom_layers..)?;
        let is_faded = |layer_s: &&f64| !is_same(**layer_s, usual_s);
        Some(Schedule {
            bottom_layers,
            bottom_s,
            transition_layers: upper.iter().take_while(is_faded).count(),
            usual_s,
        })
    });
    let mut fitting = schedules.filter(|schedule| {
        schedule.transition_layers <= LONGEST_FADE && schedule.fits(exposure_s.iter().copied())
    });
    fitting.next()
}

/// Number of layers that are exposed like the first one; 0 if all are.
fn like_first(exposure_s: &[f64]) -> usize {
    let is_like_first = |layer_s: &&f64| is_same(**layer_s, exposure_s[0]);
    match exposure_s.iter().take_while(is_like_first).count() {
        count if count < exposure_s.len() => count,
        _ => 0,
    }
}

/// Refuses several exposures for a format that has one above the bottom layers, except for a fade that it can state.
pub(super) fn check_exposures(
    format: Format,
    layers: &[Layer],
    bottom_layers: usize,
    transition_layers: usize,
) -> Result<(), ConvertError> {
    let faded = match format {
        Format::Sl1 => transition_layers,
        _ => 0,
    };
    let upper = layers.get(bottom_layers + faded..).unwrap_or_default();
    let is_one = upper
        .windows(2)
        .all(|pair| is_same(pair[0].exposure_s, pair[1].exposure_s));
    if is_one || format.thicknesses() == FormatThicknesses::Any {
        return Ok(());
    }
    Err(ConvertError::OneExposure { format })
}

/// The density that weight and volume say, if both are stated.
fn density(metadata: &Metadata) -> Option<f64> {
    let density = metadata.weight_g? / metadata.volume_ml?;
    (0.5..5.0).contains(&density).then_some(density)
}

/// Lift of a layer in millimetres, and speeds up and down in millimetres per minute, if all are stated.
fn moves(layer: &LayerRead) -> Option<[f64; 3]> {
    let moves = [layer.lift_mm?, layer.lift_mm_min?, layer.retract_mm_min?];
    moves.iter().all(|number| *number > 0.0).then_some(moves)
}

/// The rests of a layer before its exposure, before its lift and after it, in seconds, if any is stated.
fn rests_s(layer: &LayerRead) -> Option<[f64; 3]> {
    let rests_s = [
        layer.wait_before_exposure_s,
        layer.wait_before_lift_s,
        layer.wait_after_lift_s,
    ];
    let is_stated = rests_s.iter().any(Option::is_some);
    is_stated.then(|| rests_s.map(Option::unwrap_or_default))
}

/// The losses of one lift and one rest for all layers.
pub(super) fn lost_moves(layers: &[LayerRead], resin: &Resin) -> Vec<Loss> {
    let mut losses = Vec::new();
    let usual = &layers[layers.len() / 2];
    if layers.iter().any(|layer| moves(layer) != moves(usual)) {
        losses.push(Loss::Moves {
            layer: layers.len() / 2 + 1,
        });
    }
    let rests_s = layers.iter().filter_map(rests_s);
    if rests_s
        .into_iter()
        .any(|rests_s| rests_s != [resin.wait_s, 0.0, 0.0])
    {
        losses.push(Loss::Rests {
            wait_s: resin.wait_s,
        });
    }
    losses
}
