//! No boxes, layers and limits make the checks of printability panic.

use cusp_slicer::grid::{Bins, Grid};
use cusp_slicer::inspect::{Held, Limits, inspect as look};
use cusp_slicer::ldi::cpu;
use cusp_slicer::mask::{Masks, Samples, Side};
use cusp_slicer::model::{Mesh, Pose};
use cusp_slicer::plan::Plan;
use cusp_slicer::progress::silent;
use glam::Vec3;

use super::alone;
use super::input::cuboid;

const BIN_MM: f64 = 0.02;

/// Bytes of limits, then six of each box.
pub fn inspect(bytes: &[u8]) {
    alone(|| inspect_boxes(bytes));
}

fn inspect_boxes(bytes: &[u8]) {
    let Some((&[wall, gap, floor, overhang, bridge, drain, hole], boxes)) =
        bytes.split_first_chunk()
    else {
        return;
    };
    let mut triangles = Vec::new();
    for ends in boxes.chunks_exact(6).take(40) {
        let at = |place: usize| f32::from(ends[place] % 32);
        let corner = |end: usize| Vec3::new(at(end) * 0.1, at(end + 1) * 0.1, at(end + 2) * 0.02);
        triangles.extend(cuboid([corner(0), corner(3)]));
    }
    let mesh = Mesh::from_triangles(&triangles);
    let Some(mesh) = mesh.ok().and_then(|it| it.on_plate(&Pose::default()).ok()) else {
        return;
    };
    let bounds = mesh.bounds();
    let (Ok(grid), Ok(bins)) = (
        Grid::of_pitch(&bounds, 0.1),
        Bins::of_height(bounds.size().z, BIN_MM),
    ) else {
        return;
    };
    let Ok(ldi) = cpu::sample(&mesh, &grid, &mut silent) else {
        return;
    };
    let mut boundaries = vec![0];
    for byte in bytes.iter().cycle() {
        let top = boundaries.last().copied().unwrap_or(0);
        if top as usize >= bins.count {
            break;
        }
        boundaries.push(top + 1 + u32::from(byte % 4));
    }
    let plan = Plan {
        bins,
        boundaries,
        snap_planes: Vec::new(),
        exempt_layers: 0,
    };
    let limits = Limits {
        wall_mm: f64::from(wall) * 0.01,
        gap_mm: f64::from(gap) * 0.01,
        floor_mm: f64::from(floor) * 0.01,
        overhang_mm: f64::from(overhang) * 0.01,
        bridge_mm: f64::from(bridge) * 0.02,
        drain_mm: f64::from(drain) * 0.01,
        hole_mm: f64::from(hole) * 0.01,
        ..Limits::default()
    };
    let masks = Masks::new(&ldi, &plan, &grid, Samples::ONE, Side::Above);
    let _ = look(&masks, None, &plan, &limits, &Held::default(), &mut silent);
}
