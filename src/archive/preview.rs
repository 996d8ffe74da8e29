//! Draws the model as seen from above, for the previews that printers show.

use super::png::{self, Depth};
use super::runs::RunWriter;
use crate::ldi::Ldi;
use crate::model::Mesh;

/// The model seen from above, as the brightness of each pixel: lit from the left and behind, and brighter higher up.
#[derive(Debug, Clone, PartialEq)]
pub struct Look {
    width: usize,
    height: usize,
    /// Row by row from the largest y; 0 outside the model.
    brightness: Vec<u8>,
}

/// The PNG filter that stores each pixel as its difference from the one to the left.
const LEFT: u8 = 1;
/// Maximum pixels of the longer side: more than any preview has.
const LONGEST: u32 = 1024;

impl Look {
    /// Looks down along the rays of `ldi`, which was sampled from `mesh`.
    pub fn new(mesh: &Mesh, ldi: &Ldi) -> Self {
        let grid = &ldi.grid;
        let step = grid.width.max(grid.height).div_ceil(LONGEST).max(1);
        let (columns, rows) = (grid.width.div_ceil(step), grid.height.div_ceil(step));
        let top_mm = mesh.bounds().max.z.max(f64::MIN_POSITIVE);
        let brightness = (0..rows * columns)
            .map(|pixel| {
                let (row, column) = (pixel / columns * step, pixel % columns * step);
                let hits = ldi.ray((row * grid.width + column) as usize);
                let Some(top) = hits.last() else { return 0 };
                let [a, b, c] = mesh.corners(top.facet() as usize);
                let normal = (b - a).cross(c - a).normalize_or_zero();
                let light = normal.dot(glam::DVec3::new(-0.4, 0.4, 0.82)).max(0.0);
                let height = f64::from(top.z_mm) / top_mm;
                (60.0 + 195.0 * light * (0.6 + 0.4 * height)).min(255.0) as u8
            })
            .collect();
        Self {
            width: columns as usize,
            height: rows as usize,
            brightness,
        }
    }

    /// A greyscale PNG of this size, with the model centred and scaled to fit.
    pub fn png(&self, width: u32, height: u32) -> Vec<u8> {
        let scale =
            (self.width as f64 / f64::from(width)).max(self.height as f64 / f64::from(height));
        let source = |place: u32, side: u32, source_side: usize| {
            let from_middle = f64::from(place) + 0.5 - f64::from(side) * 0.5;
            let position = from_middle * scale + source_side as f64 * 0.5;
            (0.0..source_side as f64)
                .contains(&position)
                .then_some(position as usize)
        };
        let mut stream = RunWriter::default();
        for row in 0..height {
            stream.run(LEFT, 1);
            let mut last = 0;
            for column in 0..width {
                let place = source(row, height, self.height).zip(source(column, width, self.width));
                let pixel = place.map_or(0, |(row, column)| {
                    self.brightness[row * self.width + column]
                });
                stream.run(pixel.wrapping_sub(last), 1);
                last = pixel;
            }
        }
        png::wrap([width, height], Depth::Grey, &stream.finish())
    }
}
