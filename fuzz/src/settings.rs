//! No text makes the readers of settings and plans panic, and the values that they read are written so that they read
//! the same.

use std::fmt::Debug;
use std::sync::LazyLock;

use super::slicer::Slicer;
use cusp_slicer::inspect::Limits;
use cusp_slicer::job::{Backend, Claim, JobOptions, Options, Report};
use cusp_slicer::model::{FileFacts, ModelFile};
use cusp_slicer::price::{PriceItem, Prices};
use cusp_slicer::printer::Printer;
use cusp_slicer::resin::Resin;
use glam::Vec3;
use serde::Serialize;
use serde::de::DeserializeOwned;

use super::input::cuboid;
use super::{alone, quiet};

/// Options, a job, a resin, a printer, limits or prices: whichever the text can be.
pub fn settings(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    if let Some(options) = read_twice::<Options>(text) {
        // It resolves them.
        let _ = options.print_file().map_err(|error| error.to_string());
    }
    read_twice::<JobOptions>(text);
    if let Some(resin) = read_twice::<Resin>(text)
        && resin.check().is_ok()
    {
        let time_s = resin.print_time_s(&[0.05, 0.15, 1e-6, 1e3]);
        assert!(time_s.is_finite() && time_s >= 0.0, "{time_s} s");
    }
    if let Some(printer) = read_twice::<Printer>(text) {
        let _ = printer.check();
    }
    if let Some(limits) = read_twice::<Limits>(text) {
        let _ = limits.check().map_err(|error| error.to_string());
    }
    if let Some(prices) = read_twice::<Prices>(text) {
        let item = PriceItem {
            copies: 3,
            resin_ml: 12.5,
            support_ml: Some(1.5),
            print_time_s: 4321.0,
        };
        match prices.price(&[item], None) {
            Ok(price) => drop(price.written(price.total)),
            Err(error) => drop(error.to_string()),
        }
    }
}

/// Reads a value, and again after writing it.
fn read_twice<T: DeserializeOwned + Serialize + PartialEq + Debug>(text: &str) -> Option<T> {
    let value: T = serde_json::from_str(text).ok()?;
    let written = serde_json::to_string(&value).expect("what was read can be written");
    let again: T = serde_json::from_str(&written).expect("what was written can be read");
    assert_eq!(again, value, "{written}");
    Some(value)
}

/// A plan as its maker has it.
static MADE: LazyLock<Report> = LazyLock::new(|| {
    let cube = cuboid([Vec3::ZERO, Vec3::ONE]);
    let facts = FileFacts {
        file: MODEL,
        unit: None,
        skipped_objects: 0,
        parts: Vec::new(),
    };
    let options = Options {
        rays: 8,
        backend: Backend::Cpu,
        tolerance: Some(0.3),
        layer_min_mm: Some(0.2),
        layer_max_mm: Some(0.5),
        bin_mm: Some(0.1),
        ..Options::default()
    };
    let mut slicer = Slicer::of_triangles(&cube, facts).expect("a cube is a mesh");
    let report = pollster::block_on(slicer.plan(&options, &mut quiet));
    report.expect("a cube has a plan").clone()
});

/// The file that plans are said to be of.
const MODEL: ModelFile = ModelFile {
    bytes: 684,
    crc32: 1,
    plate: None,
    surfaces: false,
    curved_caps: false,
    supports_as_model: false,
    mirrored: false,
};

/// The report of that plan, as the seed of [`plan`].
pub fn made_plan() -> String {
    serde_json::to_string(&*MADE).expect("a report can be written")
}

/// A plan that somebody submits.
pub fn plan(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    alone(|| {
        for models in [&[&MODEL][..], &[&MODEL, &MODEL]] {
            match Claim::read(text, models) {
                Ok(claims) => {
                    for claim in claims {
                        let _ = claim.options().print_file();
                        let _ = claim.check(&MADE).map_err(|error| error.to_string());
                    }
                }
                Err(error) => drop(error.to_string()),
            }
        }
    });
}
