//! Says what copies of models cost.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use cusp_slicer::price::{Price, PriceItem, Prices};
use serde::Serialize;

use crate::budget::Budget;
use crate::failure::{Failure, in_file};
use crate::files::read_json;
use crate::job::Printing;
use crate::progress::Bar;
use crate::terminal::{print, print_json};
use crate::watch::stop_on_interrupt;

/// Models, and the prices of a shop.
#[derive(Args)]
pub struct Pricing {
    #[command(flatten)]
    pub printing: Printing,
    /// Prices of a shop, as a JSON file
    #[arg(long, value_name = "FILE.json")]
    prices: PathBuf,
    /// The finish, by its name in the prices
    #[arg(long, value_name = "NAME")]
    finish: Option<String>,
    #[command(flatten)]
    budget: Budget,
}

/// JSON that `price` prints.
#[derive(Serialize, schemars::JsonSchema)]
pub struct Priced {
    /// Price of all copies.
    #[serde(flatten)]
    price: Price,
    /// The priced items: the copies of each model on each plate.
    items: Vec<PriceItem>,
    /// Number of plates.
    plates: usize,
    /// Print time of all plates, one after the other.
    print_time_s: f64,
    /// Volume of resin in all copies.
    resin_ml: f64,
}

/// The prices of a file, and the finish that is ordered.
pub struct Order<'a> {
    path: &'a Path,
    prices: Prices,
    finish: Option<&'a str>,
}

impl<'a> Order<'a> {
    /// Reads prices, by which this finish can then be ordered.
    pub fn read(path: &'a Path, finish: Option<&'a str>) -> Result<Self, Failure> {
        let prices: Prices = read_json(path)?;
        prices.check().map_err(|error| in_file(path, &error))?;
        let found = finish.map(|name| prices.finish(name)).transpose();
        found.map_err(|error| in_file(path, &error))?;
        Ok(Self {
            path,
            prices,
            finish,
        })
    }

    pub fn price(&self, items: &[PriceItem]) -> Result<Price, Failure> {
        let price = self.prices.price(items, self.finish);
        price.map_err(|error| Failure::in_file(self.path, &error.into()))
    }
}

pub fn price(pricing: &Pricing) -> Result<(), Failure> {
    pricing.budget.keep();
    let printing = &pricing.printing;
    printing.check("price");
    let order = Order::read(&pricing.prices, pricing.finish.as_deref())?;
    let mut job = printing.read("price", &pricing.budget)?;
    stop_on_interrupt();
    let bar = Bar::new();
    let report = job.plan(&mut |stage, fraction| bar.report(stage, fraction))?;
    drop(bar);
    job.warn(&report);
    let items = report.price_items();
    let priced = Priced {
        price: order.price(&items)?,
        items,
        plates: report.plates.len(),
        print_time_s: report.print_time_s,
        resin_ml: report.resin_ml,
    };
    if printing.json {
        return Ok(print_json(&priced)?);
    }
    Ok(print(&describe(&priced))?)
}

fn describe(priced: &Priced) -> String {
    let Priced { price, plates, .. } = priced;
    let amounts = price.lines.iter().map(|line| line.amount);
    let amounts: Vec<String> = amounts
        .chain([price.total])
        .map(|it| price.written(it))
        .collect();
    let width = amounts.iter().map(String::len).max().unwrap_or(0);
    let mut text = String::new();
    for (line, amount) in price.lines.iter().zip(&amounts) {
        let _ = writeln!(text, "{:<9} {amount:>width$}", line.kind.name());
    }
    let plural = |count: usize, one: &str, many: &str| {
        format!("{count} {}", if count == 1 { one } else { many })
    };
    let _ = write!(
        text,
        "total     {:>width$} {} for {} on {}",
        price.written(price.total),
        price.currency,
        plural(price.copies, "copy", "copies"),
        plural(*plates, "plate", "plates"),
    );
    text
}
