//! Draws the model as seen from above, for the previews that printers show.

use super::png::{self, Depth};
use super::runs::RunWriter;
use crate::grid::Grid;
use crate::ldi::{Hit, RayImage, Rays, printed_ranges};
use crate::model::Mesh;
use crate::progress::silent;

/// The model seen from above, as the brightness of each pixel: lit from the left and behind, and brighter higher up.
#[derive(Debug, Clone, PartialEq)]
pub struct PreviewScene {
    width: usize,
    height: usize,
    /// Sides of a pixel in x and y, in any unit.
    side: [f64; 2],
    /// Row by row from the largest y; 0 outside the model.
    brightness: Vec<u8>,
}

/// The PNG filter that stores each pixel as its difference from the one to the left.
const LEFT: u8 = 1;

/// A model in the picture.
#[derive(Debug, Clone)]
pub struct PlacedMesh<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// Rays that cover it.
    pub rays: Grid,
    /// For each copy, column and row of the first ray among those of the whole plate.
    pub first_rays: Vec<[i64; 2]>,
}

impl PlacedMesh<'_> {
    /// For each copy, its first column and row, and those after the last.
    fn ends(&self) -> impl Iterator<Item = [[i64; 2]; 2]> {
        let size = [self.rays.width, self.rays.height].map(i64::from);
        let firsts = self.first_rays.iter();
        firsts.map(move |&first| [first, [0, 1].map(|axis| first[axis] + size[axis])])
    }

    /// The brightness where a ray with these hits meets it; 0 if it does not.
    fn brightness(&self, hits: &[Hit], top_mm: f64) -> u8 {
        // A drain hole begins outside the model, where its own facets are no surface.
        let mut highest = None;
        printed_ranges(hits, self.mesh.classes, |_, z_out| highest = Some(z_out));
        let top = hits.iter().rev().find(|hit| Some(hit.z_mm) == highest);
        let Some(top) = top else { return 0 };
        let [a, b, c] = self.mesh.corners(top.facet() as usize);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let light = normal.dot(glam::DVec3::new(-0.4, 0.4, 0.82)).max(0.0);
        let height = f64::from(top.z_mm) / top_mm;
        (60.0 + 195.0 * light * (0.6 + 0.4 * height)).min(255.0) as u8
    }
}

impl PreviewScene {
    /// Looks down at models, of which there must be at least one, along the fewest rays for a picture with this longer side in pixels. The
    /// rays of all models are equally far apart.
    pub fn new(models: &[PlacedMesh<'_>], longest: u32) -> Self {
        let all = models.iter().flat_map(PlacedMesh::ends);
        let all = all.reduce(|[first, last], [start, end]| {
            [
                [0, 1].map(|axis| first[axis].min(start[axis])),
                [0, 1].map(|axis| last[axis].max(end[axis])),
            ]
        });
        let [first, last] = all.unwrap_or_default();
        let [width, height] = [0, 1].map(|axis| (last[axis] - first[axis]) as u32);
        let step = width.max(height).div_ceil(longest).max(1);
        let [columns, rows] = [width, height].map(|side| side.div_ceil(step) as usize);
        let tops_mm = models.iter().map(|it| it.mesh.bounds().max.z);
        let top_mm = tops_mm.fold(f64::MIN_POSITIVE, f64::max);
        let mut brightness = vec![0u8; columns * rows];
        for model in models {
            let rays = model.rays.coarsened(step);
            let look = |values: &mut Vec<u8>, rays: Rays<'_>| {
                values.extend(rays.each().map(|hits| model.brightness(hits, top_mm)));
            };
            let image = RayImage::Scanned {
                mesh: model.mesh,
                grid: rays,
            };
            let parts = image.fold(Vec::new, look, &mut silent);
            let values = parts.unwrap_or_default().concat();
            for first_ray in &model.first_rays {
                let [x, y] =
                    [0, 1].map(|axis| (first_ray[axis] - first[axis]) as usize / step as usize);
                let picture = brightness.chunks_mut(columns).skip(y);
                for (row, values) in picture.zip(values.chunks(rays.width as usize)) {
                    for (pixel, &value) in row[x..].iter_mut().zip(values) {
                        *pixel = value.max(*pixel);
                    }
                }
            }
        }
        let grid = &models[0].rays;
        Self {
            width: columns,
            height: rows,
            side: [1.0, grid.pitch_y_mm / grid.pitch_mm],
            brightness,
        }
    }

    /// A picture from the brightness of each pixel, row by row from the top, and the sides of a pixel in any unit.
    pub(crate) fn from_picture(
        [width, height]: [u32; 2],
        side: [f64; 2],
        brightness: Vec<u8>,
    ) -> Self {
        Self {
            width: width as usize,
            height: height as usize,
            side,
            brightness,
        }
    }

    /// A picture of this many columns and rows, with the model centred and scaled to fit: a grey for each pixel.
    pub fn greys(&self, [width, height]: [u32; 2]) -> Vec<u8> {
        let scale = (self.width as f64 * self.side[0] / f64::from(width))
            .max(self.height as f64 * self.side[1] / f64::from(height));
        let source = |place: u32, pixels: u32, source_pixels: usize, side: f64| {
            let from_middle = f64::from(place) + 0.5 - f64::from(pixels) * 0.5;
            let position = from_middle * scale / side + source_pixels as f64 * 0.5;
            (0.0..source_pixels as f64)
                .contains(&position)
                .then_some(position as usize)
        };
        let columns: Vec<_> = (0..width)
            .map(|column| source(column, width, self.width, self.side[0]))
            .collect();
        let mut greys = Vec::with_capacity(width as usize * height as usize);
        for row in 0..height {
            let row = source(row, height, self.height, self.side[1]);
            greys.extend(columns.iter().map(|&column| {
                row.zip(column).map_or(0, |(row, column)| {
                    self.brightness[row * self.width + column]
                })
            }));
        }
        greys
    }

    /// The same as a greyscale PNG.
    pub fn png(&self, size: [u32; 2]) -> Vec<u8> {
        let mut stream = RunWriter::default();
        for row in self.greys(size).chunks(size[0] as usize) {
            stream.run(LEFT, 1);
            let mut last = 0;
            for &grey in row {
                stream.run(grey.wrapping_sub(last), 1);
                last = grey;
            }
        }
        png::wrap(size, Depth::Grey, &stream.finish())
    }
}

/// A grey as five bits of red, six of green and five of blue.
pub(super) fn rgb565(grey: u8) -> u16 {
    let grey = u16::from(grey);
    grey >> 3 << 11 | grey >> 2 << 5 | grey >> 3
}
