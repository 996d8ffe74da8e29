//! How long supports take, and what they weigh: `cargo xtask bench support [MODEL.stl …]`.
//!
//! Prints a table in Markdown: a ball and each model named, 60 mm high, with supports of each strength. Times are the minimum of several
//! runs. Volumes count what overlaps once for each body.

#[path = "common/mod.rs"]
#[expect(dead_code, reason = "other benches use the rest")]
mod common;
#[path = "../tests/common/solids.rs"]
#[expect(dead_code, reason = "the tests use the other solids")]
mod solids;

use common::{named, on_plate, time};
use cusp_slicer::model::Pose;
use cusp_slicer::prepare::{SupportStrength, Supporting, support};
use cusp_slicer::progress::silent;
use peak_alloc::PeakAlloc;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

fn main() {
    println!(
        "| model | facets | strength | time, ms | contacts | unreached | on the model | volume, ml | facets | memory, MB |"
    );
    println!("|---|---:|---|---:|---:|---:|---:|---:|---:|---:|");
    let ball = on_plate(&solids::sphere(30.0, 7), &Pose::default());
    for (name, mesh) in std::iter::once(("ball".to_owned(), ball)).chain(named()) {
        for strength in [
            SupportStrength::Light,
            SupportStrength::Medium,
            SupportStrength::Heavy,
        ] {
            let supporting = Supporting {
                strength,
                ..Supporting::default()
            };
            let work = || support(&mesh, &supporting, &mut silent).expect("no failure");
            let before = ALLOCATOR.current_usage();
            ALLOCATOR.reset_peak_usage();
            drop(work());
            let bytes = ALLOCATOR.peak_usage() - before;
            let (seconds, supports) = time(work);
            println!(
                "| {name} | {} | {strength:?} | {:.0} | {} | {} | {} | {:.2} | {} | {:.0} |",
                mesh.surface_facets,
                seconds * 1e3,
                supports.points.len(),
                supports.unreached.len(),
                supports.on_model,
                supports.shell.volume_mm3() / 1e3,
                supports.shell.facets.len(),
                bytes as f64 / 1e6,
            );
        }
    }
}
