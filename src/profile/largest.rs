//! The errors of layers that several models share: the largest over the models.

use super::{LayerErrors, LayersAbove, Reach};
use crate::grid::Bins;

/// For each layer, the largest error over several models. A model adds nothing to layers above it.
#[derive(Debug, Clone)]
pub struct LargestError {
    models: Vec<Share>,
    /// The model with the most bins.
    tallest: usize,
}

/// The errors of one model.
#[derive(Debug, Clone)]
struct Share {
    errors: LayerErrors,
    strictness: Strictness,
}

/// Ratio of the plan's tolerance to the model's own: the model's errors are multiplied by `of` / `own`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Strictness {
    /// The model's own tolerance in steps.
    own: u64,
    /// The tolerance of the plan in steps.
    of: u64,
}

impl Strictness {
    /// For a model without a tolerance of its own.
    pub const NONE: Self = Self { own: 1, of: 1 };

    /// For a model whose tolerance is `own` in a plan of the tolerance `of`, in the same steps.
    pub fn new(own: u64, of: u64) -> Self {
        if own == of {
            Self::NONE
        } else {
            Self { own, of }
        }
    }

    /// For a model whose errors count nothing up to `own` steps, and are beyond every tolerance above.
    pub fn within_or_not(own: u64) -> Self {
        Self { own, of: 0 }
    }

    /// An error as the plan counts it. It exceeds the tolerance of the plan if and only if the error exceeds the model's own.
    fn counted(self, steps: u64) -> u64 {
        match self {
            Self::NONE => steps,
            Self { own, .. } if own == 0 || self.of == 0 => {
                if steps <= own {
                    0
                } else {
                    u64::MAX
                }
            }
            Self { own, of } => {
                let counted = (u128::from(steps) * u128::from(of)).div_ceil(u128::from(own));
                u64::try_from(counted).unwrap_or(u64::MAX)
            }
        }
    }

    /// The largest error that the plan counts as `tolerance` or less.
    fn within(self, tolerance: u64) -> u64 {
        match self {
            Self { of: 0, own } if tolerance < u64::MAX => own,
            Self { of, own } if tolerance < u64::MAX => {
                let within = u128::from(tolerance) * u128::from(own) / u128::from(of);
                u64::try_from(within).unwrap_or(u64::MAX)
            }
            _ => u64::MAX,
        }
    }
}

impl LargestError {
    /// The largest of the errors of these models, in bins of one size. There must be at least one model.
    pub fn new(models: Vec<(LayerErrors, Strictness)>) -> Self {
        let heights = models.iter().map(|(errors, _)| errors.bins().count);
        let tallest = heights
            .enumerate()
            .max_by_key(|&(place, count)| (count, usize::MAX - place));
        Self {
            tallest: tallest.map_or(0, |(place, _)| place),
            models: models
                .into_iter()
                .map(|(errors, strictness)| Share { errors, strictness })
                .collect(),
        }
    }

    /// The same in finer bins: see [`LayerErrors::split`].
    pub(super) fn split(&self, parts: usize) -> Self {
        let models = self.models.iter().map(|Share { errors, strictness }| {
            let Strictness { own, of } = *strictness;
            let strictness = match *strictness {
                Strictness::NONE => Strictness::NONE,
                _ => Strictness {
                    own: own * parts as u64,
                    of: of * parts as u64,
                },
            };
            (errors.split(parts), strictness)
        });
        Self::new(models.collect())
    }

    pub(super) fn tallest(&self) -> &LayerErrors {
        &self.models[self.tallest].errors
    }

    pub(super) fn bins(&self) -> Bins {
        self.tallest().bins()
    }

    /// Returns true if all errors are sums, and so never shrink as a layer grows at either end.
    pub(super) fn is_monotone(&self) -> bool {
        self.models.iter().all(|model| model.errors.is_monotone())
    }

    pub(super) fn steps_between(&self, lower: u32, upper: u32) -> u64 {
        let errors = self.models.iter().map(|Share { errors, strictness }| {
            strictness.counted(errors.steps_between(lower, upper))
        });
        errors.max().unwrap_or(0)
    }

    pub(super) fn above(&self, lower: u32, tolerance: u64) -> LargestAbove<'_> {
        let models = self.models.iter();
        LargestAbove(
            models
                .map(|Share { errors, strictness }| {
                    let own = strictness.within(tolerance);
                    (errors.layers_above(lower, own), *strictness)
                })
                .collect(),
        )
    }
}

/// The layers of all models that begin at the same boundary.
#[derive(Debug)]
pub(super) struct LargestAbove<'a>(Vec<(LayersAbove<'a>, Strictness)>);

impl LargestAbove<'_> {
    /// The layer that ends at `upper`.
    pub fn up_to(&mut self, upper: u32) -> Reach {
        let mut largest = Reach::Within(0);
        for (layers, strictness) in &mut self.0 {
            match (layers.up_to(upper), &mut largest) {
                (Reach::BeyondFromHere, _) => return Reach::BeyondFromHere,
                (Reach::Beyond, _) => largest = Reach::Beyond,
                (Reach::Within(steps), Reach::Within(most)) => {
                    *most = (*most).max(strictness.counted(steps));
                }
                (Reach::Within(_), _) => {}
            }
        }
        largest
    }
}
