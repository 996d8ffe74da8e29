//! The price of an order by a shop's own prices. `docs/price.md` defines the formula.

mod currency;
mod prices;

use serde::{Deserialize, Serialize};

pub use prices::{Finish, PriceError, Prices, QuantityBreak};

/// Copies that are ordered, and what each of them needs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(deny_unknown_fields)]
pub struct PriceItem {
    /// Number of copies.
    pub copies: usize,
    /// Volume of resin in a copy with its supports.
    pub resin_ml: f64,
    /// Part of it that is in the supports; absent if the plan has none, which are then estimated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub support_ml: Option<f64>,
    /// Print time of a copy; of one that shares a plate, its share.
    pub print_time_s: f64,
}

/// Item of a price.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "kebab-case")]
pub enum PriceKind {
    /// The order itself.
    Setup,
    /// Time on the machine.
    Machine,
    /// Resin in the copies and their planned supports.
    Resin,
    /// Resin in supports that are not planned: an estimate.
    Supports,
    /// The finish.
    Finish,
    /// The discount for many copies: negative.
    Discount,
    /// The supplement up to the least price of an order.
    Minimum,
}

impl PriceKind {
    /// All kinds, in the order of their lines.
    pub const ALL: [Self; 7] = [
        Self::Setup,
        Self::Machine,
        Self::Resin,
        Self::Supports,
        Self::Finish,
        Self::Discount,
        Self::Minimum,
    ];

    /// The name, as in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Setup => "setup",
            Self::Machine => "machine",
            Self::Resin => "resin",
            Self::Supports => "supports",
            Self::Finish => "finish",
            Self::Discount => "discount",
            Self::Minimum => "minimum",
        }
    }
}

/// A part of a price.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct PriceLine {
    /// Its item.
    pub kind: PriceKind,
    /// Whole minor units of the currency.
    pub amount: i64,
}

/// The price of an order.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify), tsify(missing_as_null))]
pub struct Price {
    /// The currency, by its code of ISO 4217.
    pub currency: String,
    /// Decimal digits of its minor unit: amounts are to be divided by 10 to this power.
    pub digits: u32,
    /// Number of copies.
    pub copies: usize,
    /// The finish, if one is ordered.
    pub finish: Option<String>,
    /// The parts of the price, without those of 0.
    pub lines: Vec<PriceLine>,
    /// The sum of all lines, in whole minor units.
    pub total: i64,
}

/// The largest amount of a line, and the largest rate, in minor units: sums of lines are far from the largest integer of
/// every language.
const MOST: f64 = 1e12;

/// The most copies of an order.
const MOST_COPIES: f64 = 1e9;

impl Prices {
    /// The price of an order. Each line is rounded once, to the nearest whole minor unit, and halves up.
    ///
    /// # Errors
    /// [`PriceError`].
    pub fn price(&self, items: &[PriceItem], finish: Option<&str>) -> Result<Price, PriceError> {
        self.check()?;
        let [mut copies, mut resin_ml, mut time_s] = [0.0; 3];
        // Resin without supports, and of copies whose plan has none.
        let [mut model_ml, mut unsupported_ml] = [0.0; 2];
        for item in items {
            let each = item.copies as f64;
            prices::within("resin_ml", item.resin_ml, 0.0, MOST)?;
            prices::within("print_time_s", item.print_time_s, 0.0, MOST)?;
            if let Some(support_ml) = item.support_ml {
                prices::within("support_ml", support_ml, 0.0, item.resin_ml)?;
                model_ml += each * (item.resin_ml - support_ml);
            } else {
                model_ml += each * item.resin_ml;
                unsupported_ml += each * item.resin_ml;
            }
            copies += each;
            resin_ml += each * item.resin_ml;
            time_s += each * item.print_time_s;
        }
        prices::within("copies", copies, 1.0, MOST_COPIES)?;
        let count = copies as usize;
        let finished = finish.map(|name| self.finish(name)).transpose()?;
        let setup = whole(PriceKind::Setup, self.setup)?;
        let machine = whole(PriceKind::Machine, self.machine_per_h * time_s / 3600.0)?;
        let resin = whole(PriceKind::Resin, self.resin_per_ml * resin_ml)?;
        let supports = whole(
            PriceKind::Supports,
            self.resin_per_ml * self.supports * unsupported_ml,
        )?;
        let finished = finished.map_or(0.0, |it| it.per_copy * copies + it.per_ml * model_ml);
        let finished = whole(PriceKind::Finish, finished)?;
        let discounted = machine + resin + supports + finished;
        let discount = -whole(
            PriceKind::Discount,
            self.discount(count) * discounted as f64,
        )?;
        let sum = setup + discounted + discount;
        let minimum = (whole(PriceKind::Minimum, self.minimum)? - sum).max(0);
        let amounts = [setup, machine, resin, supports, finished, discount, minimum];
        let lines = PriceKind::ALL.into_iter().zip(amounts);
        let lines = lines.filter(|(_, amount)| *amount != 0);
        Ok(Price {
            currency: self.currency.clone(),
            digits: currency::digits(&self.currency),
            copies: count,
            finish: finish.map(str::to_owned),
            lines: lines
                .map(|(kind, amount)| PriceLine { kind, amount })
                .collect(),
            total: sum + minimum,
        })
    }

    /// A finish by its name.
    ///
    /// # Errors
    /// [`PriceError::NoFinish`].
    pub fn finish(&self, name: &str) -> Result<&Finish, PriceError> {
        let found = self.finishes.iter().find(|finish| finish.name == name);
        found.ok_or_else(|| PriceError::NoFinish {
            finish: name.to_owned(),
            known: self.finishes.iter().map(|it| it.name.clone()).collect(),
        })
    }

    /// The discount for this number of copies: that of the last break that it reaches.
    fn discount(&self, copies: usize) -> f64 {
        let breaks = self.quantity_breaks.iter().rev();
        let mut reached = breaks.filter(|it| it.copies <= copies);
        reached.next().map_or(0.0, |it| it.discount)
    }
}

impl Price {
    /// An amount in the currency's own unit, with all digits of the minor unit: 1240 cents are `12.40`.
    pub fn written(&self, amount: i64) -> String {
        let digits = self.digits as usize;
        let sign = if amount < 0 { "-" } else { "" };
        let minor = format!("{:0>1$}", amount.unsigned_abs(), digits + 1);
        let (units, parts) = minor.split_at(minor.len() - digits);
        let point = if digits == 0 { "" } else { "." };
        format!("{sign}{units}{point}{parts}")
    }
}

/// Rounds a line to whole minor units.
fn whole(kind: PriceKind, amount: f64) -> Result<i64, PriceError> {
    prices::within(kind.name(), amount, 0.0, MOST)?;
    Ok((amount + 0.5).floor() as i64)
}
