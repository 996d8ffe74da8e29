//! Errors of arranging models.

use serde::Serialize;

/// Error of arranging models, or of models in given places.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum ArrangeError {
    /// There is nothing to arrange.
    #[error("there is no model on the plate; add one")]
    #[serde(rename = "plate-empty")]
    Empty,
    /// There are more copies than can be planned.
    #[error(
        "{copies} copies are too many for a job, which has {most_copies} at most; make several jobs of them"
    )]
    #[serde(rename = "too-many-copies")]
    TooManyCopies {
        /// Copies of all models.
        copies: usize,
        /// Most copies of a job.
        most_copies: usize,
    },
    /// A model has other copies than places.
    #[error(
        "model {model_number} is to be printed {copies} times, and has {places} places; correct one of them, or arrange the plate"
    )]
    #[serde(rename = "plate-other-copies")]
    OtherCopies {
        /// The model, counted from 1.
        model_number: usize,
        /// Copies asked for.
        copies: usize,
        /// Places given.
        places: usize,
    },
    /// There is nothing on a plate, but on one after it.
    #[error("plate {plate_number} is empty, but a later plate is not; number plates without gaps")]
    #[serde(rename = "plate-gap")]
    EmptyPlate {
        /// The plate, counted from 1.
        plate_number: usize,
    },
    /// Neither a printer nor pixels and their pitch are given, so the plate has no size.
    #[error("the size of the plate is not known; choose a printer, or give pixels and pitch")]
    #[serde(rename = "plate-without-size")]
    NoSize,
    /// The spacing is negative or too large.
    #[error("the spacing must be 0 to 100 mm, not {spacing_mm} mm")]
    #[serde(rename = "bad-spacing")]
    BadSpacing {
        /// The spacing asked for.
        spacing_mm: f64,
    },
    /// The turn is no multiple of 15° that divides 360°.
    #[error("models turn in steps of 0, 15, 30, 45, 60, 90, 120 or 180°, not {turn_deg}°")]
    #[serde(rename = "bad-turn")]
    BadTurn {
        /// The step asked for.
        turn_deg: u32,
    },
    /// A model is wider or deeper than the plate, however it is turned.
    #[error(
        "model {model_number} is {:.3} × {:.3} mm, and the plate {:.3} × {:.3} mm; scale it, or choose another orientation or printer",
        size_mm[0], size_mm[1], plate_mm[0], plate_mm[1]
    )]
    #[serde(rename = "plate-too-small")]
    TooLarge {
        /// The model, counted from 1.
        model_number: usize,
        /// Its extent in x and y.
        size_mm: [f64; 2],
        /// Sides of the plate.
        plate_mm: [f64; 2],
    },
    /// A copy extends beyond the plate.
    #[error(
        "copy {copy_number} of model {model_number} extends beyond plate {plate_number}; move it, or arrange the plate"
    )]
    #[serde(rename = "plate-outside")]
    Outside {
        /// The model, counted from 1.
        model_number: usize,
        /// The copy of that model, counted from 1.
        copy_number: usize,
        /// The plate, counted from 1.
        plate_number: usize,
    },
    /// Two copies overlap.
    #[error(
        "copy {} of model {} and copy {} of model {} overlap on plate {plate_number}; move one, or arrange the plate",
        copy_numbers[0], model_numbers[0], copy_numbers[1], model_numbers[1]
    )]
    #[serde(rename = "plate-collision")]
    Collision {
        /// The models, counted from 1.
        model_numbers: [usize; 2],
        /// The copy of each, counted from 1.
        copy_numbers: [usize; 2],
        /// The plate, counted from 1.
        plate_number: usize,
    },
    /// A place names a model that there is not.
    #[error("there is no model {model_number}; the plate has {models}")]
    #[serde(rename = "plate-no-model")]
    NoModel {
        /// The model, counted from 1.
        model_number: usize,
        /// Number of models.
        models: usize,
    },
    /// There is no such plate.
    #[error("there is no plate {plate_number}; there are {plates}")]
    #[serde(rename = "no-such-plate")]
    NoPlate {
        /// The plate, counted from 1.
        plate_number: usize,
        /// Number of plates.
        plates: usize,
    },
}
