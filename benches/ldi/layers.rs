//! The layers of a model, seen along the rays: what each pass of depth peeling finds, from below and from above.

use cusp_slicer::grid::Grid;
use cusp_slicer::ldi::{Hit, cpu};
use cusp_slicer::model::Mesh;
use cusp_slicer::progress::silent;
use glam::DVec3;

use crate::png_file;

/// Columns of the picture, one a pass.
const PASSES: usize = 4;
/// Rays along the longer side of a panel.
const RAYS: u32 = 220;
/// Pixels around each panel.
const MARGIN: usize = 6;
/// Colour of rays without facets left.
const PAPER: [u8; 3] = [255; 3];

/// A PNG of two rows: the nearest facets of each pass seen from below, and the farthest ones seen from above.
pub fn picture(mesh: &Mesh) -> Vec<u8> {
    let grid = Grid::around(&mesh.bounds(), RAYS).expect("a grid");
    let ldi = cpu::sample(mesh, &grid, &mut silent).expect("hits");
    let [width, height] = [grid.width, grid.height].map(|side| side as usize);
    let [panel_width, panel_height] = [width + MARGIN, height + MARGIN];
    let row_pixels = panel_width * PASSES + MARGIN;
    let mut pixels = vec![PAPER; row_pixels * (2 * panel_height + MARGIN)];
    for ray in 0..ldi.rays() {
        let hits = ldi.ray(ray);
        for pass in 0..PASSES.min(hits.len().div_ceil(2)) {
            // From above after from below: the facet in the middle of an odd ray is both.
            let seen = [hits[pass], hits[hits.len() - 1 - pass]];
            for (row, hit) in seen.into_iter().enumerate() {
                let x = MARGIN + pass * panel_width + ray % width;
                let y = MARGIN + row * panel_height + ray / width;
                pixels[y * row_pixels + x] = colour(mesh, hit, row == 0);
            }
        }
    }
    png_file::encoded(row_pixels, &pixels)
}

/// Bright where the surface faces the viewer; from blue at the plate to yellow at the top.
fn colour(mesh: &Mesh, hit: Hit, is_below: bool) -> [u8; 3] {
    let corners = mesh.facets[hit.facet() as usize].map(|it| mesh.vertices[it as usize].as_dvec3());
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let viewer = if is_below { -1.0 } else { 1.0 };
    let light = normal.dot(DVec3::new(-0.45, 0.35, 0.82 * viewer)).abs();
    let height = f64::from(hit.z_mm) / mesh.bounds().max.z;
    let low = DVec3::new(0.25, 0.45, 0.75);
    let high = DVec3::new(0.99, 0.85, 0.45);
    let shade = low.lerp(high, height) * (0.35 + 0.65 * light);
    shade.to_array().map(|part| (255.0 * part.min(1.0)) as u8)
}
