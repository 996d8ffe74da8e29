//! Time of hollowing: `cargo xtask bench hollow [MODEL.stl …]`.
//!
//! Prints a table in Markdown: a ball and each model named, 60 mm high, with walls of 1, 2 and 4 mm and cavities of at least 2 mm. Times
//! are the minimum of several runs. Memory is the peak without that of the model.

#[path = "common/mod.rs"]
#[expect(dead_code, reason = "other benches use the rest")]
mod common;
#[path = "../tests/common/solids.rs"]
#[expect(dead_code, reason = "the tests use the other solids")]
mod solids;

use common::{named, on_plate, time};
use cusp_slicer::model::{Mesh, Pose};
use cusp_slicer::prepare::{AutoDrain, Hollowing, Infill, hollow};
use cusp_slicer::progress::silent;
use peak_alloc::PeakAlloc;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

fn row(name: &str, mesh: &Mesh, hollowing: &Hollowing) {
    let work = || hollow(mesh, hollowing, None, &mut silent).expect("no failure");
    let before = ALLOCATOR.current_usage();
    ALLOCATOR.reset_peak_usage();
    drop(work());
    let bytes = ALLOCATOR.peak_usage() - before;
    let (seconds, void) = time(work);
    let (ml, facets, resolution_mm) = void.map_or((0.0, 0, 0.0), |void| {
        let ml = void.shell.volume_mm3() / 1e3;
        (ml, void.shell.facets.len(), void.resolution_mm)
    });
    println!(
        "| {name} | {} | {} | {:.0} | {:.2} of {:.2} | {facets} | {resolution_mm:.3} | {:.0} |",
        hollowing.wall_mm,
        if hollowing.infill.is_some() {
            "lattice"
        } else {
            "none"
        },
        seconds * 1e3,
        ml,
        mesh.volume_mm3() / 1e3,
        bytes as f64 / 1e6,
    );
}

fn main() {
    println!(
        "| model | wall, mm | infill | time, ms | void, ml | its facets | resolution, mm | memory, MB |"
    );
    println!("|---|---:|---|---:|---:|---:|---:|---:|");
    let ball = on_plate(&solids::sphere(30.0, 7), &Pose::default());
    for (name, mesh) in std::iter::once(("ball".to_owned(), ball)).chain(named()) {
        for wall_mm in [1.0, 2.0, 4.0] {
            let hollowing = Hollowing {
                wall_mm,
                ..Hollowing::default()
            };
            row(&name, &mesh, &hollowing);
            let auto_drain = Some(AutoDrain::default());
            let drained = Hollowing {
                auto_drain,
                ..hollowing.clone()
            };
            row(&format!("{name}, drained"), &mesh, &drained);
            if wall_mm == 2.0 {
                let infill = Infill {
                    spacing_mm: 8.0,
                    strut_mm: 1.0,
                };
                row(
                    &name,
                    &mesh,
                    &Hollowing {
                        infill: Some(infill),
                        ..hollowing
                    },
                );
            }
        }
    }
}
