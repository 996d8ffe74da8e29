//! The prices of a shop: its own numbers, of which none is built in.

use serde::{Deserialize, Serialize};

use super::MOST;

/// The prices of a shop. Amounts are in minor units of the currency, such as cents, and may be fractions: lines are rounded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(deny_unknown_fields)]
pub struct Prices {
    /// The currency: three capitals of ISO 4217.
    pub currency: String,
    /// Fixed price of an order.
    #[serde(default)]
    pub setup: f64,
    /// Price of an hour of print time.
    #[serde(default)]
    pub machine_per_h: f64,
    /// Price of a millilitre of resin.
    #[serde(default)]
    pub resin_per_ml: f64,
    /// Resin of supports, as a fraction of that in the model: an estimate for plans without supports.
    #[serde(default)]
    pub supports: f64,
    /// The finishes to choose from.
    #[serde(default)]
    pub finishes: Vec<Finish>,
    /// Discounts for many copies, in ascending order of copies.
    #[serde(default)]
    pub quantity_breaks: Vec<QuantityBreak>,
    /// The least that an order costs.
    #[serde(default)]
    pub minimum: f64,
}

/// A finish.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(deny_unknown_fields)]
pub struct Finish {
    /// Its name, by which it is ordered.
    pub name: String,
    /// Price of each copy.
    #[serde(default)]
    pub per_copy: f64,
    /// Price of each millilitre of resin in the model, without supports.
    #[serde(default)]
    pub per_ml: f64,
}

/// A discount from a number of copies on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(deny_unknown_fields)]
pub struct QuantityBreak {
    /// The least number of copies.
    pub copies: usize,
    /// Discount on machine, resin, supports and finish, as a fraction.
    pub discount: f64,
}

/// Error of pricing.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum PriceError {
    /// A number is out of bounds.
    #[error(
        "{field} is {value}, but must be from {least} to {most}; correct the prices or the order"
    )]
    #[serde(rename = "price-out-of-bounds")]
    OutOfBounds {
        /// The field, or the line of the price.
        field: &'static str,
        /// Its value.
        value: f64,
        /// The smallest possible value.
        least: f64,
        /// The largest possible value.
        most: f64,
    },
    /// Prices contradict themselves.
    #[error(
        "the prices have an invalid {field}; a currency is an ISO 4217 code of three capitals, quantity breaks ascend, and each \
         finish has a name of its own"
    )]
    #[serde(rename = "bad-prices")]
    BadPrices {
        /// The field: `currency`, `quantity_breaks` or `finishes`.
        field: &'static str,
    },
    /// No finish has this name.
    #[error("there is no finish {finish}; {}", known_finishes(known))]
    #[serde(rename = "no-finish")]
    NoFinish {
        /// The name.
        finish: String,
        /// The finishes that there are.
        known: Vec<String>,
    },
}

/// Checks that a number is within bounds.
pub(super) fn within(
    field: &'static str,
    value: f64,
    least: f64,
    most: f64,
) -> Result<(), PriceError> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err(PriceError::OutOfBounds {
        field,
        value,
        least,
        most,
    })
}

fn known_finishes(known: &[String]) -> String {
    if known.is_empty() {
        return "the prices name none".to_owned();
    }
    format!("known are {}", known.join(", "))
}

impl Prices {
    /// Checks all numbers and names.
    ///
    /// # Errors
    /// [`PriceError`].
    pub fn check(&self) -> Result<(), PriceError> {
        let letters = self.currency.as_bytes();
        if letters.len() != 3 || !letters.iter().all(u8::is_ascii_uppercase) {
            return Err(PriceError::BadPrices { field: "currency" });
        }
        within("setup", self.setup, 0.0, MOST)?;
        within("machine_per_h", self.machine_per_h, 0.0, MOST)?;
        within("resin_per_ml", self.resin_per_ml, 0.0, MOST)?;
        within("supports", self.supports, 0.0, 10.0)?;
        within("minimum", self.minimum, 0.0, MOST)?;
        for (place, finish) in self.finishes.iter().enumerate() {
            within("per_copy", finish.per_copy, 0.0, MOST)?;
            within("per_ml", finish.per_ml, 0.0, MOST)?;
            let mut before = self.finishes[..place].iter();
            if before.any(|other| other.name == finish.name) {
                return Err(PriceError::BadPrices { field: "finishes" });
            }
        }
        let mut last = 0;
        for it in &self.quantity_breaks {
            within("discount", it.discount, 0.0, 1.0)?;
            if it.copies <= last {
                return Err(PriceError::BadPrices {
                    field: "quantity_breaks",
                });
            }
            last = it.copies;
        }
        Ok(())
    }
}
