//! The printed solid: pixels of masks, each as high as its layer.

use glam::{DVec2, DVec3};

use super::SimulationError;
use crate::archive::read::{Flips, Mask, PrintFile, changes_up_to};
use crate::parallel;
use crate::progress::Progress;

/// A stack of masks, seen from above, at its place relative to the model. It is held in memory as runs.
#[derive(Debug, Clone)]
pub(super) struct Printed {
    /// Columns and rows.
    pub pixels: [u32; 2],
    /// Sides of a pixel in x and y, in millimetres.
    pub pitch: DVec2,
    /// The corner of pixel (0, 0) with the smallest x and the largest y, in millimetres.
    pub corner: DVec2,
    /// Heights of layer boundaries, from 0 upward, in millimetres.
    pub z_mm: Vec<f64>,
    /// The mask of each layer.
    pub masks: Vec<Mask>,
    /// The layer at equal steps of height, to begin the search for one.
    steps: Vec<u32>,
}

/// The nearest point of the printed surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Nearest {
    /// Square of the distance to it, in mm².
    pub squared: f64,
    /// The nearest point.
    pub point: DVec3,
}

impl Printed {
    /// Decodes all masks of a print file, centred on x = y = 0.
    pub fn read(
        file: &PrintFile<'_>,
        flips: Flips,
        progress: &mut Progress<'_>,
        share: [f64; 2],
    ) -> Result<Self, SimulationError> {
        let z_mm = boundaries(file)?;
        let (metadata, layers) = (file.metadata(), file.layers().len());
        let mut masks = Vec::with_capacity(layers);
        parallel::map_in_groups(
            0..layers,
            |layer| file.mask(layer, flips),
            |mask| {
                masks.push(mask?);
                Ok::<_, SimulationError>(())
            },
            progress,
            share,
        )?;
        if masks.iter().all(|mask| mask.rows().is_empty()) {
            return Err(SimulationError::AllBlack);
        }
        let [width, height] = metadata.pixels_from_above();
        let pitch = DVec2::from(metadata.pixel_mm_from_above());
        Ok(Self {
            pixels: [width, height],
            pitch,
            corner: DVec2::new(-f64::from(width), f64::from(height)) * pitch * 0.5,
            steps: steps_of(&z_mm),
            z_mm,
            masks,
        })
    }

    /// The same place with other layers, between these heights.
    pub fn with_layers(self, z_mm: Vec<f64>, masks: Vec<Mask>) -> Self {
        Self {
            steps: steps_of(&z_mm),
            z_mm,
            masks,
            ..self
        }
    }

    /// The middle of the lit pixels' bounding box.
    pub fn lit_centre(&self) -> DVec2 {
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for mask in &self.masks {
            for row in mask.rows() {
                if let [first, .., last] = mask.row(row) {
                    let [top, bottom] = [row, row + 1];
                    for point in [
                        self.at(i32::from(*first), top),
                        self.at(i32::from(*last), bottom),
                    ] {
                        low = low.min(point);
                        high = high.max(point);
                    }
                }
            }
        }
        (low + high) * 0.5
    }

    /// The corner of a pixel with the smallest x and the largest y, in millimetres.
    pub fn at(&self, column: i32, row: i32) -> DVec2 {
        self.corner + DVec2::new(f64::from(column), -f64::from(row)) * self.pitch
    }

    /// Number of layers.
    pub fn layers(&self) -> usize {
        self.masks.len()
    }

    /// The layer at a height; the first or last one for heights below or above all.
    pub fn layer_of(&self, z_mm: f64) -> usize {
        let last = self.layers() - 1;
        let step = z_mm / self.z_mm[last + 1] * self.steps.len() as f64;
        let mut layer = self.steps[(step as usize).min(self.steps.len() - 1)] as usize;
        while layer > 0 && self.z_mm[layer] > z_mm {
            layer -= 1;
        }
        while layer < last && self.z_mm[layer + 1] <= z_mm {
            layer += 1;
        }
        layer
    }

    /// The nearest point of the printed surface, walls and shelves alike. The surface bounds the solid, so from inside this is
    /// the nearest point that is not printed, and from outside the nearest one that is. `hint` is any point of the surface; the
    /// nearer it is, the faster the search.
    pub fn nearest(&self, point: DVec3, hint: Option<DVec3>) -> Nearest {
        let home = self.layer_of(point.z);
        let pixel = (point.truncate() - self.corner) / self.pitch * DVec2::new(1.0, -1.0);
        let is_within = (self.z_mm[0]..self.z_mm[self.layers()]).contains(&point.z);
        let cell = pixel.floor();
        let is_inside = is_within && self.masks[home].is_lit(cell.x as i32, cell.y as i32);
        let mut search = Search {
            printed: self,
            pixel,
            is_inside,
            found: Nearest {
                squared: hint.map_or(f64::INFINITY, |hint| hint.distance_squared(point)),
                point: hint.unwrap_or(point),
            },
            z: point.z,
        };
        // Outward from the point's own layer; the air above and below the stack is a layer too.
        search.layer(home as isize);
        let (mut below, mut above) = (home as isize, home as isize);
        loop {
            below -= 1;
            above += 1;
            let goes_on = [search.layer(below), search.layer(above)];
            if goes_on == [false; 2] {
                return search.found;
            }
        }
    }
}

/// Heights of layer boundaries, from 0 upward.
fn boundaries(file: &PrintFile<'_>) -> Result<Vec<f64>, SimulationError> {
    let tops = file.layers().iter().map(|layer| layer.z_mm);
    let z_mm: Vec<f64> = std::iter::once(0.0).chain(tops).collect();
    for (layer, pair) in z_mm.windows(2).enumerate() {
        if !pair.is_sorted_by(|below, above| below < above && above.is_finite()) {
            return Err(SimulationError::ZOrder {
                layer: layer + 1,
                z_mm: pair[1],
            });
        }
    }
    Ok(z_mm)
}

/// The layer at each of equal steps of height, two for each layer.
fn steps_of(z_mm: &[f64]) -> Vec<u32> {
    let count = 2 * (z_mm.len() - 1);
    let top = z_mm[z_mm.len() - 1];
    let layer_at = |step: usize| {
        let z = top * step as f64 / count as f64;
        z_mm.partition_point(|&plane| plane <= z) as u32 - 1
    };
    (0..count).map(layer_at).collect()
}

/// A search for the nearest pixel, printed or not, that differs from the point.
struct Search<'a> {
    printed: &'a Printed,
    /// The point in columns and rows.
    pixel: DVec2,
    z: f64,
    is_inside: bool,
    found: Nearest,
}

impl Search<'_> {
    /// Searches a layer. Returns true if layers beyond it may be nearer than the nearest point so far.
    fn layer(&mut self, layer: isize) -> bool {
        let layers = self.printed.layers() as isize;
        if layer < -1 || layer > layers {
            return false;
        }
        let planes = &self.printed.z_mm;
        let floor = if layer < 0 {
            f64::NEG_INFINITY
        } else {
            planes[layer as usize]
        };
        let top = if layer < layers {
            planes[(layer + 1) as usize]
        } else {
            f64::INFINITY
        };
        let z = self.z.clamp(floor, top);
        let up = (z - self.z) * (z - self.z);
        if up >= self.found.squared {
            return false;
        }
        if (0..layers).contains(&layer) {
            self.mask(&self.printed.masks[layer as usize], z, up);
        } else if self.is_inside {
            self.offer(up, self.pixel, z);
        }
        true
    }

    fn mask(&mut self, mask: &Mask, z: f64, up: f64) {
        let rows = mask.rows();
        let home = self.pixel.y.floor() as i32;
        if self.is_inside {
            // Dark rows around the lit ones end the search.
            let (mut low, mut high) = (home, home + 1);
            while self.row(mask, low, z, up) {
                low -= 1;
            }
            while self.row(mask, high, z, up) {
                high += 1;
            }
        } else if !rows.is_empty() {
            // Only rows with lit pixels count.
            let start = home.clamp(rows.start, rows.end - 1);
            let (mut low, mut high) = (start, start + 1);
            while low >= rows.start && self.row(mask, low, z, up) {
                low -= 1;
            }
            while high < rows.end && self.row(mask, high, z, up) {
                high += 1;
            }
        }
    }

    /// Searches a row of a mask. Returns true if rows beyond it may be nearer than the nearest point so far.
    fn row(&mut self, mask: &Mask, row: i32, z: f64, up: f64) -> bool {
        let y = self.pixel.y.clamp(f64::from(row), f64::from(row + 1));
        let across = (y - self.pixel.y) * self.printed.pitch.y;
        let least = up + across * across;
        if least >= self.found.squared {
            return false;
        }
        let changes = mask.row(row);
        let passed = changes_up_to(changes, self.pixel.x.floor() as i32);
        if (passed & 1 == 1) != self.is_inside {
            self.offer(least, DVec2::new(self.pixel.x, y), z);
            return true;
        }
        let left = passed.checked_sub(1).map(|place| changes[place]);
        for change in [left, changes.get(passed).copied()].into_iter().flatten() {
            let x = f64::from(change);
            let along = (x - self.pixel.x) * self.printed.pitch.x;
            self.offer(least + along * along, DVec2::new(x, y), z);
        }
        true
    }

    fn offer(&mut self, squared: f64, pixel: DVec2, z: f64) {
        if squared < self.found.squared {
            let at = pixel * self.printed.pitch * DVec2::new(1.0, -1.0) + self.printed.corner;
            self.found = Nearest {
                squared,
                point: at.extend(z),
            };
        }
    }
}
