//! Contours, filled pixel by pixel, against masks.

use cusp_slicer::contour::{Lattice, LayerHeights};
use cusp_slicer::grid::{Bins, Grid};
use cusp_slicer::ldi::cpu;
use cusp_slicer::mask::{Masks, Samples, Side};
use cusp_slicer::plan::Plan;
use cusp_slicer::progress::silent;

use super::contours_of;
use super::oracle::{distance, segments};
use crate::common::solids::{self, Triangles};
use crate::common::{on_plate, shifted_grid};

/// Greatest distance of an outline from that of the masks, in pixels: snapping moves vertices by half a step of 1/256
/// pixel along each axis.
const SNAPPING: f64 = std::f64::consts::SQRT_2 / 512.0;

/// For each column of a row of pixels, true if its centre is inside, by the crossings of outlines to its left; and the crossings.
fn fill(segments: &[[[f64; 2]; 2]], centres: impl Iterator<Item = f64>, y: f64) -> Vec<bool> {
    let mut crossings: Vec<f64> = segments
        .iter()
        .filter(|[a, b]| (a[1] > y) != (b[1] > y))
        .map(|[a, b]| a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]))
        .collect();
    crossings.sort_by(f64::total_cmp);
    centres
        .map(|x| crossings.partition_point(|&crossing| crossing < x) % 2 == 1)
        .collect()
}

/// Compares all layers, and returns how many pixels are lit and how many differ.
fn compare(name: &str, triangles: &Triangles, rays: u32, simplify_mm: f64) -> (usize, usize) {
    let mesh = on_plate(triangles);
    // Off the symmetries of the solids.
    let grid: Grid = shifted_grid(&mesh, rays, [0.31, 0.17]);
    let ldi = cpu::sample(&mesh, &grid, &mut silent).unwrap();
    let bins = Bins::of_height(mesh.bounds().size().z, 0.002).unwrap();
    let count = bins.count as u32;
    let layers = 23.min(count);
    let plan = Plan {
        bins,
        boundaries: (0..=layers).map(|layer| layer * count / layers).collect(),
        snap_planes: Vec::new(),
        exempt_layers: 0,
    };
    let masks = Masks::new(&ldi, &plan, &grid, Samples::ONE, Side::Above);
    let mut cursor = masks.cursor();
    let lattice = Lattice::of(&mesh.bounds());
    let sections: Vec<f64> = LayerHeights::of(&plan)
        .iter()
        .map(|layer| layer.section_mm)
        .collect();
    let near_mm = SNAPPING * grid.pitch_mm + 2.0 * lattice.step_mm() + simplify_mm;
    let row_bytes = (grid.width as usize).div_ceil(8);
    let (mut lit, mut differing) = (0, 0);
    for (layer, contours) in contours_of(&mesh, &sections, simplify_mm)
        .iter()
        .enumerate()
    {
        cursor.seek(&masks, layer);
        let mask = cursor.whole(&masks);
        let outline = segments(&contours.polygons);
        let in_mm: Vec<_> = outline
            .iter()
            .map(|ends| ends.map(|end| lattice.to_mm(end).to_array()))
            .collect();
        for row in 0..grid.height {
            let y = grid.centre_mm(0, row).y;
            let centres = (0..grid.width).map(|column| grid.centre_mm(column, row).x);
            for (column, is_in) in fill(&in_mm, centres, y).into_iter().enumerate() {
                let byte = mask[row as usize * row_bytes + column / 8];
                let is_lit = byte >> (7 - column % 8) & 1 == 1;
                lit += usize::from(is_lit);
                if is_lit == is_in {
                    continue;
                }
                differing += 1;
                let steps = grid.centre_mm(column as u32, row) / lattice.step_mm();
                let distances = outline
                    .iter()
                    .map(|&segment| distance(steps.to_array(), segment));
                let nearest_mm = distances.fold(f64::INFINITY, f64::min) * lattice.step_mm();
                assert!(
                    nearest_mm <= near_mm,
                    "{name}, layer {layer}, row {row}, column {column}: {nearest_mm} mm from an outline, over {near_mm}"
                );
            }
        }
    }
    (lit, differing)
}

#[test]
fn filled_contours_are_the_masks() {
    for (name, triangles) in solids::all() {
        let (lit, differing) = compare(name, &triangles, 150, 0.0);
        assert!(lit > 1000, "{name}: {lit}");
        assert!(differing * 1000 <= lit, "{name}: {differing} of {lit}");
    }
}

#[test]
fn filled_contours_are_the_masks_of_hard_solids() {
    for (name, triangles, rays) in solids::torture() {
        compare(name, &triangles, rays, 0.0);
    }
}

#[test]
fn simplified_contours_are_the_masks_but_for_the_tolerance() {
    let (_, differing) = compare("ball", &solids::sphere(10.0, 5), 150, 0.1);
    assert!(differing > 0, "the tolerance makes no difference");
    compare("gyroid", &solids::gyroid(2, 24), 150, 0.05);
}
