//! Several models in one job, as users specify them.

use serde::{Deserialize, Serialize};

use super::Options;
use crate::arrange::{ArrangeError, Arranging};
use crate::plan::HeightRange;
use crate::prepare::{Hollowing, Supporting};

/// How a model of a plate differs from the options of the job, and how often it is printed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(default, deny_unknown_fields)]
pub struct ModelOptions {
    /// Number of copies.
    pub copies: usize,
    /// Rotation from the pose in the file: a quaternion x, y, z, w of any length except 0. That of the options if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotation: Option<[f64; 4]>,
    /// Height to which the model is scaled uniformly. That of the options if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height_mm: Option<f64>,
    /// How this model is hollowed. As the options say if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hollow: Option<Hollowing>,
    /// How this model is supported. As the options say if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub supports: Option<Supporting>,
    /// Maximum error of a layer on this model, in the metric's unit. That of the options if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Height ranges of this model with a layer thickness of their own, besides those of the options. Where ranges of several
    /// models meet, layers are within all of them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub ranges: Vec<HeightRange>,
}

impl Default for ModelOptions {
    fn default() -> Self {
        Self {
            copies: 1,
            rotation: None,
            height_mm: None,
            hollow: None,
            supports: None,
            tolerance: None,
            ranges: Vec::new(),
        }
    }
}

/// Where a copy of a model stands.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(deny_unknown_fields)]
pub struct Placement {
    /// The model, by its index.
    pub model: usize,
    /// The plate, from 0.
    #[serde(default)]
    pub plate: usize,
    /// Position of the middle of the box around the turned model from the middle of the plate, to the right; the nearest whole pixel
    /// counts.
    pub x_mm: f64,
    /// The same to the back.
    pub y_mm: f64,
    /// Turn about z after the rotation, counter-clockwise as seen from above: a multiple of 15.
    #[serde(default)]
    pub turn_deg: u32,
}

impl Placement {
    /// A single copy in the middle of its plate.
    pub const MIDDLE: Self = Self {
        model: 0,
        plate: 0,
        x_mm: 0.0,
        y_mm: 0.0,
        turn_deg: 0,
    };
}

/// Models × copies in one job. All share the options.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(default, deny_unknown_fields)]
pub struct JobOptions {
    /// What holds for all models; printer, layers and resin among it.
    pub options: Options,
    /// The models, in the order in which they were loaded.
    pub models: Vec<ModelOptions>,
    /// How to arrange the copies.
    pub arranging: Arranging,
    /// Where each copy stands. If empty, copies are arranged.
    pub placements: Vec<Placement>,
}

/// Copies in all, of all models.
const MOST_COPIES: usize = 10_000;

impl JobOptions {
    /// One copy of one model.
    pub fn of(options: Options) -> Self {
        Self {
            options,
            ..Self::default()
        }
    }

    /// Checks that there are not too many copies, and that places are those of the copies that are asked for, plate by plate.
    pub(super) fn check(&self) -> Result<(), ArrangeError> {
        let of_models = self.models.iter().map(|model| model.copies);
        let copies = of_models
            .fold(0, usize::saturating_add)
            .max(self.placements.len());
        if copies > MOST_COPIES {
            let most_copies = MOST_COPIES;
            return Err(ArrangeError::TooManyCopies {
                copies,
                most_copies,
            });
        }
        if self.placements.is_empty() {
            return Ok(());
        }
        for (model, own) in self.models.iter().enumerate() {
            let places = self
                .placements
                .iter()
                .filter(|it| it.model == model)
                .count();
            if places != own.copies {
                return Err(ArrangeError::OtherCopies {
                    model_number: model + 1,
                    copies: own.copies,
                    places,
                });
            }
        }
        let mut plates: Vec<usize> = self.placements.iter().map(|it| it.plate).collect();
        plates.sort_unstable();
        plates.dedup();
        match (0..).zip(plates).find(|(number, plate)| number != plate) {
            Some((number, _)) => Err(ArrangeError::EmptyPlate {
                plate_number: number + 1,
            }),
            None => Ok(()),
        }
    }

    /// The options of a model by its index. If it is the only one, they say all that its own say.
    pub(super) fn of_model(&self, model: usize) -> ModelOptions {
        self.models.get(model).cloned().unwrap_or_default()
    }

    /// The options of the only model, alone on its plate.
    pub(super) fn alone(&self) -> Options {
        let own = self.of_model(0);
        let mut options = self.options.clone();
        options.rotation = own.rotation.or(options.rotation);
        options.height_mm = own.height_mm.or(options.height_mm);
        options.hollow = own.hollow.or(options.hollow);
        options.supports = own.supports.or(options.supports);
        options.tolerance = own.tolerance.or(options.tolerance);
        options.ranges.extend(own.ranges);
        options
    }
}
