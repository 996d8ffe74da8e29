//! What a plan asks for in a price.

use super::{JobReport, Report};
use crate::price::PriceItem;

impl Report {
    /// What `copies` of this plan need. Each takes the whole print time; copies that are printed together are priced by their
    /// plate's report, in which each has its share, and `copies` is how often the plate is printed.
    pub fn price_items(&self, copies: usize) -> Vec<PriceItem> {
        let Some(plate) = &self.plate else {
            return vec![PriceItem {
                copies,
                resin_ml: self.resin_ml,
                print_time_s: self.print_time_s,
            }];
        };
        let models = plate.models.iter().map(|model| PriceItem {
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
