//! Layer plans: the heights of the planes between layers (section 3.3).
//!
//! A planner sees limits and the errors of layers, and nothing else of the model.

mod breadth_first;
pub mod gradual;
pub mod greedy;
pub mod least_sum;
mod limits;
pub(crate) mod minimum_time;
pub mod optimal;
mod queue;
pub mod segment;
pub mod snap_cost;
mod thickness_subset;
pub mod thicknesses;
pub mod tradeoff;
pub mod uniform;

use serde::Serialize;

pub use limits::{HeightRange, Limits};

use crate::grid::Bins;
use crate::profile::LayerErrors;
use crate::quantity::{Quantity, QuantityError};
use crate::resin::Resin;
use segment::{Segment, boundaries_below};

/// Error of planning.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify), tsify(missing_as_null))]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum PlanError {
    /// The least layer thickness is more than the greatest, as where only one of them is given and the other has its default.
    #[error(
        "the least layer thickness of {layer_min_mm} mm is more than the greatest of {layer_max_mm} mm; lower one or raise the other"
    )]
    #[serde(rename = "layer-range-upside-down")]
    UpsideDownRange {
        /// Least layer thickness.
        layer_min_mm: f64,
        /// Greatest layer thickness.
        layer_max_mm: f64,
    },
    /// The layer range holds no whole number of steps.
    #[error(
        "no whole number of steps of {step_mm} mm lies between the layer thicknesses \
         {layer_min_mm} and {layer_max_mm} mm; widen the range or choose a smaller step"
    )]
    #[serde(rename = "layer-range-empty")]
    EmptyRange {
        /// Least layer thickness.
        layer_min_mm: f64,
        /// Greatest layer thickness.
        layer_max_mm: f64,
        /// Step of heights: a bin, or the motor step.
        step_mm: f64,
    },
    /// A length that is no whole number of bins.
    #[error(
        "{} of {length_mm} mm is no whole number of bins of {bin_mm} mm; choose a bin that divides it",
        quantity.noun()
    )]
    #[serde(rename = "not-whole-bins")]
    NotWholeBins {
        /// The length.
        quantity: Quantity,
        /// The length asked for.
        length_mm: f64,
        /// Bin size.
        bin_mm: f64,
    },
    /// A thickness that is no whole number of motor steps.
    #[error(
        "{} of {length_mm} mm is no whole number of steps of {step_mm} mm; choose a multiple of {step_mm} mm",
        quantity.noun()
    )]
    #[serde(rename = "not-whole-steps")]
    NotWholeSteps {
        /// The thickness.
        quantity: Quantity,
        /// The thickness asked for.
        length_mm: f64,
        /// The motor step.
        step_mm: f64,
    },
    /// A height range that is empty or upside down, or overlaps another.
    #[error(
        "the height range from {from_mm} to {to_mm} mm is empty or overlaps another; give ranges from bottom to top, without overlaps"
    )]
    #[serde(rename = "bad-range")]
    BadRange {
        /// Its lower end.
        from_mm: f64,
        /// Its upper end.
        to_mm: f64,
    },
    /// A plane that does not lie within the model.
    #[error("there can be no plane at {z_mm} mm in a model that is {height_mm} mm high")]
    #[serde(rename = "bad-plane")]
    BadPlane {
        /// Its height.
        z_mm: f64,
        /// Height of the model.
        height_mm: f64,
    },
    /// A uniform layer whose middle, where its mask is sampled, lies above the model.
    #[error("layers of {layer_mm} mm are too thick for a model that is {height_mm} mm high")]
    #[serde(rename = "layer-too-thick")]
    LayerTooThick {
        /// Layer thickness asked for.
        layer_mm: f64,
        /// Height of the model.
        height_mm: f64,
    },
    /// The paper's infeasible case: K\[N\] = ∞.
    #[error("{}", infeasible_message(self))]
    #[serde(rename = "infeasible")]
    Infeasible {
        /// The highest plane that layers within tolerance can reach.
        from_mm: f64,
        /// The top of the layer of least thickness above it, which exceeds the tolerance.
        to_mm: f64,
        /// The model, counted from 1, if the tolerance is its own.
        model_number: Option<usize>,
        /// The tolerance asked for, in the metric's unit.
        tolerance: f64,
        /// The least layer thickness there.
        layer_min_mm: f64,
        /// The least tolerance for which there is a plan, rounded up to six digits.
        least_tolerance: Option<f64>,
        /// The largest least thickness for which there is one; absent if even the thinnest would not do.
        largest_layer_min_mm: Option<f64>,
    },
    /// Layers of the range do not add up to the height between two planes.
    #[error(
        "layers of {layer_min_mm} to {layer_max_mm} mm do not add up to the height from {from_mm} to \
         {to_mm} mm; widen the range of thicknesses or move the planes"
    )]
    #[serde(rename = "layers-do-not-fit")]
    LayersDoNotFit {
        /// The plane below.
        from_mm: f64,
        /// The plane above.
        to_mm: f64,
        /// The least layer thickness there.
        layer_min_mm: f64,
        /// The greatest layer thickness there.
        layer_max_mm: f64,
    },
    /// Layers of the given thicknesses do not reach a plane within tolerance.
    #[error("{}", thicknesses_message(self))]
    #[serde(rename = "thicknesses-do-not-fit")]
    ThicknessesDoNotFit {
        /// The highest plane below that they reach.
        from_mm: f64,
        /// The plane that they do not reach.
        to_mm: f64,
        /// The model, counted from 1, if the tolerance is its own.
        model_number: Option<usize>,
        /// The tolerance asked for, in the metric's unit.
        tolerance: f64,
        /// The thicknesses, argsort.
        thicknesses_mm: Vec<f64>,
        /// The least tolerance for which there is a plan, rounded up to six digits; absent if none is enough.
        least_tolerance: Option<f64>,
    },
    /// Every plan within tolerance has more thicknesses.
    #[error(
        "no plan within the tolerance has at most {thicknesses} layer thicknesses; allow {enough}, or raise the tolerance"
    )]
    #[serde(rename = "too-few-thicknesses")]
    TooFewThicknesses {
        /// The greatest number allowed.
        thicknesses: usize,
        /// A number for which there is a plan.
        enough: usize,
    },
    /// Every plan within tolerance changes its layer thickness more abruptly.
    #[error(
        "no plan within the tolerance changes the layer thickness by at most {change_mm} mm from layer to layer; allow \
         changes of {least_change_mm} mm, or raise the tolerance"
    )]
    #[serde(rename = "not-gradual")]
    NotGradual {
        /// The greatest change allowed.
        change_mm: f64,
        /// The least for which there is a plan.
        least_change_mm: f64,
    },
    /// No tolerance gives a plan with so few layers.
    #[error("no plan has at most {layers} layers; it takes at least {least_layers}")]
    #[serde(rename = "out-of-reach")]
    LayersOutOfReach {
        /// The layers asked for.
        layers: usize,
        /// The fewest layers that are possible.
        least_layers: usize,
    },
    /// No tolerance gives a plan with so short a print.
    #[error("no plan prints in at most {time_s} s; it takes at least {least_time_s} s")]
    #[serde(rename = "out-of-reach")]
    TimeOutOfReach {
        /// The time asked for, in seconds.
        time_s: f64,
        /// Print time of the fastest plan, rounded up to whole seconds.
        least_time_s: f64,
    },
    /// A limit, or a number of the resin, is out of bounds.
    #[error(transparent)]
    #[serde(untagged)]
    Quantity(#[from] QuantityError),
}

impl PlanError {
    /// The least tolerance that would do, if the error is that there is no plan within a tolerance.
    pub(crate) fn least_tolerance(&self) -> Option<f64> {
        match self {
            Self::Infeasible {
                least_tolerance, ..
            }
            | Self::ThicknessesDoNotFit {
                least_tolerance, ..
            } => *least_tolerance,
            _ => None,
        }
    }

    /// The same error with another tolerance, that of a model if it has its own.
    pub(crate) fn of_model(&self, number: Option<usize>, own: f64, least: f64) -> Self {
        let mut error = self.clone();
        if let Self::Infeasible {
            model_number,
            tolerance,
            least_tolerance,
            ..
        }
        | Self::ThicknessesDoNotFit {
            model_number,
            tolerance,
            least_tolerance,
            ..
        } = &mut error
        {
            (*model_number, *tolerance, *least_tolerance) = (number, own, Some(least));
        }
        error
    }
}

/// The owner of the tolerance, as a noun and after an error.
fn owner(model_number: Option<usize>) -> [String; 2] {
    match model_number {
        None => ["the tolerance".to_owned(), String::new()],
        Some(number) => [
            format!("the tolerance of model {number}"),
            format!(" on model {number}"),
        ],
    }
}

fn infeasible_message(error: &PlanError) -> String {
    let PlanError::Infeasible {
        from_mm,
        to_mm,
        model_number,
        tolerance,
        layer_min_mm,
        least_tolerance,
        largest_layer_min_mm,
    } = error
    else {
        return String::new();
    };
    let [whose, on_model] = owner(*model_number);
    let ways = [
        least_tolerance.map(|tolerance| format!("raise {whose} to {tolerance}")),
        largest_layer_min_mm
            .map(|layer_mm| format!("lower the minimum thickness to {layer_mm} mm")),
    ];
    let ways: Vec<String> = ways.into_iter().flatten().collect();
    let ways = if ways.is_empty() {
        "change the planes or ranges".to_owned()
    } else {
        ways.join(" or ")
    };
    format!(
        "no plan keeps every layer's error{on_model} within {tolerance}: from z = {from_mm} to {to_mm} mm even a layer of \
         {layer_min_mm} mm exceeds it; {ways}"
    )
}

fn thicknesses_message(error: &PlanError) -> String {
    let PlanError::ThicknessesDoNotFit {
        from_mm,
        to_mm,
        model_number,
        tolerance,
        thicknesses_mm,
        least_tolerance,
    } = error
    else {
        return String::new();
    };
    let all: Vec<String> = thicknesses_mm.iter().map(f64::to_string).collect();
    let [whose, on_model] = owner(*model_number);
    let way = match least_tolerance {
        Some(tolerance) => format!("raise {whose} to {tolerance} or add a thickness"),
        None => "add a thickness or move the planes".to_owned(),
    };
    format!(
        "layers of {} mm do not lead from z = {from_mm} to {to_mm} mm within the tolerance of {tolerance}{on_model}; {way}",
        all.join(", ")
    )
}

/// The layers of a print, from the plate upward.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The bins that boundaries count.
    pub bins: Bins,
    /// Boundaries of layers in bins: 0, then the top of each layer.
    pub boundaries: Vec<u32>,
    /// The boundaries that are snap planes, in ascending order.
    pub snap_planes: Vec<u32>,
    /// Number of layers from the plate upward that the tolerance does not cover, because their thickness is given: see
    /// [`Limits::first_layer_mm`].
    pub exempt_layers: usize,
}

impl Plan {
    /// The plan whose `boundaries` fill these segments.
    fn new(bins: Bins, segments: &[Segment], boundaries: Vec<u32>, snap_planes: Vec<u32>) -> Self {
        Self {
            bins,
            boundaries,
            snap_planes,
            exempt_layers: boundaries_below(segments).len() - 1,
        }
    }

    /// Number of layers, K.
    pub fn layers(&self) -> usize {
        self.boundaries.len() - 1
    }

    /// Height of each boundary in millimetres, one more than there are layers.
    pub fn z_mm(&self) -> Vec<f64> {
        self.boundaries
            .iter()
            .map(|&boundary| self.bins.boundary_mm(boundary))
            .collect()
    }

    /// Thickness of each layer in millimetres.
    pub fn thickness_mm(&self) -> Vec<f64> {
        self.boundaries
            .windows(2)
            .map(|layer| self.bins.boundary_mm(layer[1] - layer[0]))
            .collect()
    }

    /// Height of the middle of each layer in millimetres, where its mask is sampled.
    pub fn middle_mm(&self) -> Vec<f64> {
        self.middles_of_parts_mm(1)
    }

    /// Divides each layer into `parts` equal parts, and returns the heights of their middles in millimetres.
    pub fn middles_of_parts_mm(&self, parts: u32) -> Vec<f64> {
        let halves = 2 * u64::from(parts);
        let layers = self.boundaries.windows(2);
        layers
            .flat_map(|layer| {
                let [bottom, top] = [layer[0], layer[1]].map(u64::from);
                (0..u64::from(parts)).map(move |part| {
                    let bins = bottom * halves + (top - bottom) * (2 * part + 1);
                    bins as f64 / halves as f64 * self.bins.size_mm
                })
            })
            .collect()
    }

    /// The boundaries of the layers that the tolerance covers.
    pub fn covered(&self) -> &[u32] {
        &self.boundaries[self.exempt_layers..]
    }

    /// The largest error of the layers that the tolerance covers, in steps of `errors`.
    pub fn max_error_steps(&self, errors: &LayerErrors) -> u64 {
        let layers = self.covered().windows(2);
        let steps = layers.map(|layer| errors.steps_between(layer[0], layer[1]));
        steps.max().unwrap_or(0)
    }

    /// The largest error of the layers that the tolerance covers, in the metric's unit.
    pub fn max_error(&self, errors: &LayerErrors) -> f64 {
        errors.to_value(self.max_error_steps(errors))
    }

    /// Total time of all layers, in seconds.
    pub fn print_time_s(&self, resin: &Resin) -> f64 {
        resin.print_time_s(&self.thickness_mm())
    }
}
