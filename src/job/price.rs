//! What a plan asks for in a price.

use super::{JobReport, Report};
use crate::price::PriceItem;

impl Report {
    /// What `copies` prints of this plate need: each copy has its share of the time.
    pub fn price_items(&self, copies: usize) -> Vec<PriceItem> {
        let models = self.models.iter().map(|model| PriceItem {
            copies: model.copies.saturating_mul(copies),
            resin_ml: model.resin_ml,
            print_time_s: model.print_time_s,
        });
        models.collect()
    }
}

impl JobReport {
    /// What all copies on all plates need.
    pub fn price_items(&self) -> Vec<PriceItem> {
        let plates = self.plates.iter();
        plates.flat_map(|plate| plate.price_items(1)).collect()
    }
}
