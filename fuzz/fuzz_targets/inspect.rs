//! No boxes, layers and limits make the checks of printability panic.

#![no_main]

use cusp_slicer::grid::{Bins, Grid};
use cusp_slicer::inspect::{Held, Limits, inspect};
use cusp_slicer::ldi::cpu;
use cusp_slicer::mask::{Masks, Samples, Side};
use cusp_slicer::model::{Mesh, Pose};
use cusp_slicer::plan::Plan;
use cusp_slicer::progress::silent;
use libfuzzer_sys::fuzz_target;

const BIN_MM: f64 = 0.02;

/// The two triangles of each side, by corners whose bits say which end of x, y and z they are at.
const SIDES: [[usize; 4]; 6] = [
    [0, 2, 3, 1],
    [4, 5, 7, 6],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 4, 6, 2],
    [1, 3, 7, 5],
];

fuzz_target!(|bytes: &[u8]| {
    let Some((&[wall, gap, floor, overhang, bridge, escape, hole], boxes)) =
        bytes.split_first_chunk()
    else {
        return;
    };
    let mut triangles = Vec::new();
    for ends in boxes.chunks_exact(6).take(40) {
        let corner = |corner: usize| {
            let at = |axis: usize| f32::from(ends[axis + 3 * (corner >> axis & 1)] % 32);
            glam::Vec3::new(at(0) * 0.1, at(1) * 0.1, at(2) * 0.02)
        };
        for [a, b, c, d] in SIDES.map(|side| side.map(corner)) {
            triangles.extend([[a, b, c], [a, c, d]]);
        }
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
        escape_mm: f64::from(escape) * 0.01,
        hole_mm: f64::from(hole) * 0.01,
        ..Limits::default()
    };
    let masks = Masks::new(&ldi, &plan, &grid, Samples::ONE, Side::Above);
    let _ = inspect(&masks, &plan, &limits, &Held::default(), &mut silent);
});
