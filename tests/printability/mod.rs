//! Findings of the checks on solids in closed form, against brute force on voxels, and under symmetries.

mod drains;
mod forms;
mod naive;
mod symmetry;
mod voxels;

use crate::common::{on_plate, solids};
use cusp_slicer::grid::{Bins, Grid};
use cusp_slicer::inspect::{
    Code, Finding, Held, Limits, Printability, Severities, Severity, inspect,
};
use cusp_slicer::ldi::cpu;
use cusp_slicer::mask::{Masks, Samples, Side};
use cusp_slicer::plan::Plan;
use cusp_slicer::progress::silent;
use glam::Vec3;

/// Limits that look for everything, however small.
fn strict() -> Limits {
    Limits {
        island_mm2: 0.0,
        cup_mm2: 0.0,
        trap_ml: 0.0,
        speck_px: 1,
        // Roofs and ceilings of small boxes are bridges.
        bridge_mm: 21.0,
        severity: Severities {
            separate_body: Severity::Review,
            ..Severities::default()
        },
        ..Limits::default()
    }
}

/// A plan of these boundaries.
fn plan_of(bin_mm: f64, boundaries: Vec<u32>) -> Plan {
    let top = boundaries.last().copied().unwrap_or(0);
    Plan {
        bins: Bins::of_height(f64::from(top) * bin_mm, bin_mm).unwrap(),
        boundaries,
        snap_planes: Vec::new(),
        exempt_layers: 0,
    }
}

/// Layers of 0.05 mm for this height.
fn layers_of(height_mm: f64) -> Plan {
    let layers = (height_mm / 0.05).round() as u32;
    plan_of(0.01, (0..=layers).map(|layer| layer * 5).collect())
}

/// The masks of a solid on the plate, with a margin of some pixels.
fn masks_of(
    triangles: &solids::Triangles,
    pitch_mm: [f64; 2],
    plan: &Plan,
    samples: Samples,
) -> Masks {
    masks_with(triangles, pitch_mm, plan, samples, [4, 4])
}

/// The masks of a solid on the plate, with these columns and rows more than it covers.
fn masks_with(
    triangles: &solids::Triangles,
    pitch_mm: [f64; 2],
    plan: &Plan,
    samples: Samples,
    margin: [u32; 2],
) -> Masks {
    let mesh = on_plate(triangles);
    let size = mesh.bounds().size();
    let pixels = |size_mm: f64, pitch_mm: f64| (size_mm / pitch_mm - 1e-3).ceil() as u32;
    let pixels = [
        pixels(size.x, pitch_mm[0]) + margin[0],
        pixels(size.y, pitch_mm[1]) + margin[1],
    ];
    let grid = Grid::plate(&mesh.bounds(), pixels, pitch_mm).unwrap();
    let rays = grid.refined(samples.rays()).around_model(&mesh.bounds());
    let ldi = cpu::sample(&mesh, &rays, &mut silent).unwrap();
    Masks::new(&ldi, plan, &grid, samples, Side::Above)
}

/// Findings on a solid in layers of 0.05 mm, on pixels of 0.05 mm.
fn check(triangles: &solids::Triangles, limits: &Limits) -> Printability {
    let plan = layers_of(on_plate(triangles).bounds().size().z);
    let masks = masks_of(triangles, [0.05; 2], &plan, Samples::ONE);
    inspect(&masks, None, &plan, limits, &Held::default(), &mut silent).unwrap()
}

/// A box from one corner to the other.
fn block(low: [f32; 3], high: [f32; 3]) -> solids::Triangles {
    let (low, high) = (Vec3::from(low), Vec3::from(high));
    solids::moved(&solids::cuboid(high - low), low)
}

/// The findings of a kind.
fn of_code(found: &Printability, code: Code) -> Vec<&Finding> {
    let findings = found.findings.iter();
    findings.filter(|finding| finding.code == code).collect()
}
