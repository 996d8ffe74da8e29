//! Draws the model as seen from above, for the previews that printers show.

use super::png::{self, Depth};
use super::runs::RunWriter;
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
/// Maximum pixels of the longer side: more than any preview has.
const LONGEST: u32 = 1024;

/// A model in the picture, and where it stands.
#[derive(Debug, Clone, Copy)]
pub struct PlacedMesh<'a> {
    /// The mesh from which the rays were sampled.
    pub mesh: &'a Mesh,
    /// Its rays.
    pub image: RayImage<'a>,
    /// Column and row of its first ray among those of the whole plate.
    pub first_ray: [i64; 2],
}

impl PlacedMesh<'_> {
    /// Its first column and row, and those after the last.
    fn rays(&self) -> [[i64; 2]; 2] {
        let grid = self.image.grid();
        let size = [grid.width, grid.height].map(i64::from);
        let last = [0, 1].map(|axis| self.first_ray[axis] + size[axis]);
        [self.first_ray, last]
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

    /// The rows of a picture with this many columns that it covers: the place of the first pixel, and the brightness of each.
    fn seen_on(&self, raster: &Raster, columns: usize, top_mm: f64) -> Vec<(usize, Vec<u8>)> {
        let grid = self.image.grid();
        let [left, above] = self.first_ray;
        let look = |seen: &mut Vec<(usize, Vec<u8>)>, rays: Rays<'_>| {
            let end_row = rays.first_row + rays.count() as u32 / grid.width;
            for (row, y) in raster.along(1, above, rays.first_row..end_row) {
                let first = (row - rays.first_row) * grid.width;
                let mut along = raster.along(0, left, 0..grid.width).peekable();
                let Some(&(_, x)) = along.peek() else {
                    continue;
                };
                let values = along.map(|(column, _)| {
                    self.brightness(rays.ray((first + column) as usize), top_mm)
                });
                seen.push((y * columns + x, values.collect()));
            }
        };
        let seen = self.image.fold(Vec::new, look, &mut silent);
        seen.unwrap_or_default().into_iter().flatten().collect()
    }
}

/// The rays that are in the picture: every `step`th column and row of the plate.
struct Raster {
    /// The first column and row of the plate.
    first: [i64; 2],
    step: u32,
}

impl Raster {
    /// The rays of a copy along an axis that are in the picture, from the copy's first one: each with its place there.
    fn along(
        &self,
        axis: usize,
        first_ray: i64,
        rays: std::ops::Range<u32>,
    ) -> impl Iterator<Item = (u32, usize)> {
        let (offset, step) = ((first_ray - self.first[axis]) as u32, self.step);
        let start = (offset + rays.start).next_multiple_of(step);
        let places = (start..offset + rays.end).step_by(step as usize);
        places.map(move |ray| (ray - offset, (ray / step) as usize))
    }
}

impl PreviewScene {
    /// Looks down along the rays of a mesh.
    pub fn new(mesh: &Mesh, image: RayImage<'_>) -> Self {
        Self::of_copies(&[PlacedMesh {
            mesh,
            image,
            first_ray: [0; 2],
        }])
    }

    /// Looks down at several models, of which there must be at least one. Their rays are equally far apart.
    pub fn of_copies(copies: &[PlacedMesh<'_>]) -> Self {
        let grid = copies[0].image.grid();
        let all = copies.iter().map(PlacedMesh::rays);
        let all = all.reduce(|[first, last], [start, end]| {
            [
                [0, 1].map(|axis| first[axis].min(start[axis])),
                [0, 1].map(|axis| last[axis].max(end[axis])),
            ]
        });
        let [first, last] = all.unwrap_or_default();
        let [width, height] = [0, 1].map(|axis| (last[axis] - first[axis]) as u32);
        let step = width.max(height).div_ceil(LONGEST).max(1);
        let [columns, rows] = [width, height].map(|side| side.div_ceil(step) as usize);
        let raster = Raster { first, step };
        let tops_mm = copies.iter().map(|copy| copy.mesh.bounds().max.z);
        let top_mm = tops_mm.fold(f64::MIN_POSITIVE, f64::max);
        let mut brightness = vec![0u8; columns * rows];
        for copy in copies {
            for (place, values) in copy.seen_on(&raster, columns, top_mm) {
                for (pixel, value) in brightness[place..].iter_mut().zip(values) {
                    *pixel = value.max(*pixel);
                }
            }
        }
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
