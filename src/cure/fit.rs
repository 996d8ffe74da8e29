//! Values of a resin from measured bridges: how thick they print beyond their layers.

use serde::{Deserialize, Serialize};

use crate::resin::{PrintThrough, Resin, exp, ln};

/// A bridge of equal layers over nothing, as it was measured.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct Bridge {
    /// Thickness of each layer.
    pub layer_mm: f64,
    /// Number of layers.
    pub layers: u32,
    /// Measured thickness of the bridge.
    pub measured_mm: f64,
}

/// Values of a resin that fit measured bridges best.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct CureFit {
    /// Penetration depth.
    pub penetration_mm: f64,
    /// Overcure, and the part of earlier doses that counts.
    pub print_through: PrintThrough,
    /// Root mean square of the differences between measured and fitted thicknesses.
    pub residual_mm: f64,
    /// Interval of the penetration depth: values outside fit worse than 95 % of measurements would.
    pub penetration_within_mm: [f64; 2],
    /// The same of the overcure.
    pub overcure_within_mm: [f64; 2],
    /// The same of the part of earlier doses.
    pub retained_within: [f64; 2],
}

/// The fewest bridges that three values can be fitted to, with something left for the residual.
pub const FEWEST_BRIDGES: usize = 4;

/// Bounds of the penetration depth: those of published resins, doubled and halved.
const PENETRATION_MM: [f64; 2] = [0.03, 0.6];

/// Steps of each axis of the grid that is searched, and the times that it is searched more finely around the best point.
const STEPS: usize = 60;
const ROUNDS: usize = 7;

/// Fits penetration depth, overcure and retained dose by least squares to bridges that were printed with a resin's exposures. `None` if there
/// are fewer than [`FEWEST_BRIDGES`], or all have the same number of layers.
pub fn fit(bridges: &[Bridge], resin: &Resin) -> Option<CureFit> {
    let is_varied = bridges
        .windows(2)
        .any(|pair| pair[0].layers != pair[1].layers);
    if bridges.len() < FEWEST_BRIDGES || !is_varied {
        return None;
    }
    let mut within = [PENETRATION_MM, [0.0, 1.0]];
    let mut best = Trial::of(bridges, resin, PENETRATION_MM[0], 1.0);
    for _ in 0..ROUNDS {
        for trial in grid(within).map(|[depth, part]| Trial::of(bridges, resin, depth, part)) {
            if trial.squares < best.squares {
                best = trial;
            }
        }
        let around = |[low, high]: [f64; 2], middle: f64, [least, most]: [f64; 2]| {
            let reach = (high - low) * 0.15;
            [(middle - reach).max(least), (middle + reach).min(most)]
        };
        within = [
            around(within[0], best.penetration_mm, PENETRATION_MM),
            around(within[1], best.retained, [0.0, 1.0]),
        ];
    }
    // Sums of squares up to this belong to the interval: the 95 % point of F for one value is about 4 with many measurements, and more
    // with few.
    let freedom = (bridges.len() - 3) as f64;
    let most = best.squares.max(1e-12) * (1.0 + (4.0 + 12.0 / freedom) / freedom);
    let all = grid([PENETRATION_MM, [0.0, 1.0]]).chain(grid(within));
    let all = all.map(|[depth, part]| Trial::of(bridges, resin, depth, part));
    let mut ends = [best.values(), best.values()];
    for trial in all.filter(|trial| trial.squares <= most) {
        for (axis, value) in trial.values().into_iter().enumerate() {
            ends[0][axis] = ends[0][axis].min(value);
            ends[1][axis] = ends[1][axis].max(value);
        }
    }
    let of_axis = |axis: usize| [ends[0][axis], ends[1][axis]];
    Some(CureFit {
        penetration_mm: best.penetration_mm,
        print_through: PrintThrough {
            overcure_mm: best.overcure_mm,
            retained: best.retained,
        },
        residual_mm: (best.squares / bridges.len() as f64).sqrt(),
        penetration_within_mm: of_axis(0),
        overcure_within_mm: of_axis(1),
        retained_within: of_axis(2),
    })
}

/// Points of a grid of two axes.
fn grid([depths, parts]: [[f64; 2]; 2]) -> impl Iterator<Item = [f64; 2]> {
    let at = |[low, high]: [f64; 2], step: usize| low + (high - low) * step as f64 / STEPS as f64;
    let steps = (0..=STEPS).flat_map(|depth| (0..=STEPS).map(move |part| [depth, part]));
    steps.map(move |[depth, part]| [at(depths, depth), at(parts, part)])
}

/// Values, and how well they fit.
#[derive(Clone, Copy)]
struct Trial {
    penetration_mm: f64,
    overcure_mm: f64,
    retained: f64,
    squares: f64,
}

impl Trial {
    /// The overcure that fits best with the other two.
    fn of(bridges: &[Bridge], resin: &Resin, penetration_mm: f64, retained: f64) -> Self {
        let reference_s = resin.exposure_s(resin.layer_mm);
        // Measured thickness beyond layers and doses: the overcure alone, if all is right.
        let rests_mm = bridges.iter().map(|bridge| {
            let fade = exp(-bridge.layer_mm / penetration_mm);
            let all = exp(-bridge.layer_mm * f64::from(bridge.layers) / penetration_mm);
            let sum = (1.0 - all) / (1.0 - fade);
            let exposure_s = resin.exposure_s(bridge.layer_mm).max(1e-3);
            let doses = ln(exposure_s / reference_s) + ln(1.0 + retained * (sum - 1.0));
            let own_mm = resin.layer_mm - bridge.layer_mm + penetration_mm * doses;
            bridge.measured_mm - bridge.layer_mm * f64::from(bridge.layers) - own_mm
        });
        let rests_mm: Vec<f64> = rests_mm.collect();
        let mean_mm = rests_mm.iter().sum::<f64>() / rests_mm.len() as f64;
        let overcure_mm = mean_mm.clamp(0.0, 1.0);
        let squares = rests_mm
            .iter()
            .map(|it| (it - overcure_mm) * (it - overcure_mm));
        Self {
            penetration_mm,
            overcure_mm,
            retained,
            squares: squares.sum(),
        }
    }

    fn values(&self) -> [f64; 3] {
        [self.penetration_mm, self.overcure_mm, self.retained]
    }
}
