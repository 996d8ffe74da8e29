//! Pixels and bins to millimetres and back: the only place that converts units.

use glam::DVec2;
use serde::Serialize;

use crate::model::Bounds;
use crate::quantity::{Quantity, QuantityError};

/// Maximum side of a mask in pixels.
pub const MAX_SIDE: u32 = 1 << 15;
/// Maximum number of pixels of a mask.
pub const MAX_PIXELS: u64 = 1 << 28;
/// Maximum number of bins of a profile.
const MAX_BINS: f64 = 2_000_000.0;

/// Lengths that differ by less than this fraction of a bin count as equal, so that 0.05 mm is 25 bins of
/// 0.002 mm although neither is a binary fraction.
const BIN_SLACK: f64 = 1e-3;
/// Relative error of heights, which come from single precision.
const HEIGHT_SLACK: f64 = 1.0 / (1 << 23) as f64;
/// Absolute error, in bins, of a quotient of lengths.
const ROUNDING_SLACK: f64 = 1e-9;

/// 2⁵²: from here on double precision has integers only, and the next 2³² have the same high bits.
const INTEGERS: f64 = (1u64 << 52) as f64;

/// Error of laying out pixels or bins.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum GridError {
    /// No pixels, or more than masks can have.
    #[error(
        "a mask of {width} × {height} pixels is not possible: there can be 1 to {max_side} a side, and {max_pixels} in all"
    )]
    #[serde(rename = "grid-bad-size")]
    BadSize {
        /// Pixels in x.
        width: u64,
        /// Pixels in y.
        height: u64,
        /// Maximum number in x and y.
        max_side: u32,
        /// Maximum number in all.
        max_pixels: u64,
    },
    /// More rays than there can be, several to a pixel.
    #[error(
        "anti-aliasing asks for {width} × {height} rays, and there can be {max_side} a side, and {max_pixels} in all; choose \
         a lower level"
    )]
    #[serde(rename = "grid-too-fine")]
    TooFine {
        /// Rays in x.
        width: u32,
        /// Rays in y.
        height: u32,
        /// Maximum number in x and y.
        max_side: u32,
        /// Maximum number in all.
        max_pixels: u64,
    },
    /// The model is wider or deeper than the grid.
    #[error(
        "the model is {model_mm_x:.3} × {model_mm_y:.3} mm, but the grid covers only \
         {grid_mm_x:.3} × {grid_mm_y:.3} mm; a scale of {fitting_scale:.4} fits"
    )]
    #[serde(rename = "model-too-large")]
    ModelTooLarge {
        /// Extent of the model in x, in millimetres.
        model_mm_x: f64,
        /// Extent of the model in y, in millimetres.
        model_mm_y: f64,
        /// Extent of the grid in x, in millimetres.
        grid_mm_x: f64,
        /// Extent of the grid in y, in millimetres.
        grid_mm_y: f64,
        /// Factor by which the model can be scaled to fit.
        fitting_scale: f64,
    },
    /// The model is higher than the printer's volume.
    #[error(
        "the model is {model_mm_z:.3} mm high, but the printer only prints {printer_mm_z} mm; a scale of \
         {fitting_scale:.4} fits"
    )]
    #[serde(rename = "model-too-high")]
    ModelTooHigh {
        /// Height of the model.
        model_mm_z: f64,
        /// Height that the printer prints.
        printer_mm_z: f64,
        /// Factor by which the model can be scaled to fit.
        fitting_scale: f64,
    },
    /// The model is too high for its bins.
    #[error("bins of {bin_mm} mm are too many for a height of {height_mm} mm; choose a larger bin")]
    #[serde(rename = "too-many-bins")]
    TooManyBins {
        /// Height of the model.
        height_mm: f64,
        /// Height of a bin.
        bin_mm: f64,
    },
    /// A length is out of bounds.
    #[error(transparent)]
    #[serde(untagged)]
    Quantity(#[from] QuantityError),
}

fn bad_size(width: u64, height: u64) -> GridError {
    GridError::BadSize {
        width,
        height,
        max_side: MAX_SIDE,
        max_pixels: MAX_PIXELS,
    }
}

fn check_size(width: u64, height: u64) -> Result<(), GridError> {
    let side = 1..=u64::from(MAX_SIDE);
    if !side.contains(&width) || !side.contains(&height) || width * height > MAX_PIXELS {
        return Err(bad_size(width, height));
    }
    Ok(())
}

/// The pixels of a mask on the plate, or the rays of an LDI, one through each pixel centre.
///
/// Row 0 has the largest y, as in an image; x grows with the column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Side of a pixel in x, in millimetres.
    pub pitch_mm: f64,
    /// Side of a pixel in y, in millimetres.
    pub pitch_y_mm: f64,
    /// The corner of pixel (0, 0) with the smallest x and the largest y, in millimetres.
    pub corner_mm: DVec2,
}

impl Grid {
    /// A grid of square pixels that just covers the model, with `rays` pixels along its longer horizontal side.
    ///
    /// # Errors
    /// [`GridError::BadSize`].
    pub fn around(bounds: &Bounds, rays: u32) -> Result<Self, GridError> {
        let size = bounds.size();
        if rays == 0 {
            return Err(bad_size(0, 0));
        }
        Self::of_pitch(bounds, size.x.max(size.y) / f64::from(rays))
    }

    /// A grid of square pixels of this pitch that just covers the model.
    ///
    /// # Errors
    /// [`GridError::BadSize`], [`GridError::Quantity`].
    pub fn of_pitch(bounds: &Bounds, pitch_mm: f64) -> Result<Self, GridError> {
        Quantity::Pitch.check(pitch_mm)?;
        let size = bounds.size();
        let pixels = |length_mm: f64| (length_mm / pitch_mm - BIN_SLACK).ceil().max(1.0) as u64;
        let pitch_mm = DVec2::splat(pitch_mm);
        Self::centred(bounds, pixels(size.x), pixels(size.y), pitch_mm)
    }

    /// A grid with these numbers of pixels and this pitch in x and y, centred on the model's bounding box.
    ///
    /// # Errors
    /// [`GridError::BadSize`], [`GridError::Quantity`], [`GridError::ModelTooLarge`].
    pub fn plate(bounds: &Bounds, pixels: [u32; 2], pitch_mm: [f64; 2]) -> Result<Self, GridError> {
        for side_mm in pitch_mm {
            Quantity::Pitch.check(side_mm)?;
        }
        let pitch_mm = DVec2::from_array(pitch_mm);
        let model = bounds.size();
        let covered = DVec2::new(f64::from(pixels[0]), f64::from(pixels[1])) * pitch_mm;
        let slack = pitch_mm * BIN_SLACK;
        if model.x > covered.x + slack.x || model.y > covered.y + slack.y {
            return Err(GridError::ModelTooLarge {
                model_mm_x: model.x,
                model_mm_y: model.y,
                grid_mm_x: covered.x,
                grid_mm_y: covered.y,
                // Rounded down to four decimals, as the message shows it.
                fitting_scale: ((covered.x / model.x).min(covered.y / model.y) * 1e4).floor() / 1e4,
            });
        }
        Self::centred(bounds, u64::from(pixels[0]), u64::from(pixels[1]), pitch_mm)
    }

    fn centred(
        bounds: &Bounds,
        width: u64,
        height: u64,
        pitch_mm: DVec2,
    ) -> Result<Self, GridError> {
        check_size(width, height)?;
        let middle = (bounds.min + bounds.max) * 0.5;
        Ok(Self {
            width: width as u32,
            height: height as u32,
            pitch_mm: pitch_mm.x,
            pitch_y_mm: pitch_mm.y,
            corner_mm: DVec2::new(
                middle.x - width as f64 * 0.5 * pitch_mm.x,
                middle.y + height as f64 * 0.5 * pitch_mm.y,
            ),
        })
    }

    /// Area of a pixel in mm².
    pub fn pixel_mm2(&self) -> f64 {
        self.pitch_mm * self.pitch_y_mm
    }

    /// Sides of a pixel.
    fn pitch(&self) -> DVec2 {
        DVec2::new(self.pitch_mm, self.pitch_y_mm)
    }

    /// Checks that a ray through each pixel is within the limits.
    ///
    /// # Errors
    /// [`GridError::TooFine`].
    pub fn check_rays(&self) -> Result<(), GridError> {
        let (width, height) = (self.width, self.height);
        if width.max(height) > MAX_SIDE || self.pixels() as u64 > MAX_PIXELS {
            return Err(GridError::TooFine {
                width,
                height,
                max_side: MAX_SIDE,
                max_pixels: MAX_PIXELS,
            });
        }
        Ok(())
    }

    /// A grid of larger pixels over the same place, each as wide and deep as `times` of these. The last ones may go beyond it.
    #[must_use]
    pub fn coarsened(&self, times: u32) -> Self {
        Self {
            width: self.width.div_ceil(times),
            height: self.height.div_ceil(times),
            pitch_mm: self.pitch_mm * f64::from(times),
            pitch_y_mm: self.pitch_y_mm * f64::from(times),
            ..*self
        }
    }

    /// The part of the grid that covers the model, with a margin of a pixel for rounding. No ray outside it meets the
    /// model.
    #[must_use]
    pub fn around_model(&self, bounds: &Bounds) -> Self {
        let first = self.to_pixels(DVec2::new(bounds.min.x, bounds.max.y));
        let last = self.to_pixels(DVec2::new(bounds.max.x, bounds.min.y));
        let within = |first: f64, last: f64, side: u32| {
            let first = (first - 1.0).floor().clamp(0.0, f64::from(side - 1));
            let last = (last + 1.0).ceil().clamp(first + 1.0, f64::from(side));
            (first, (last - first) as u32)
        };
        let (column, width) = within(first.x, last.x, self.width);
        let (row, height) = within(first.y, last.y, self.height);
        Self {
            width,
            height,
            corner_mm: self.corner_mm + DVec2::new(column, -row) * self.pitch(),
            ..*self
        }
    }

    /// The grid with as many columns and rows more on each side as cover a box.
    ///
    /// # Errors
    /// [`GridError::BadSize`].
    pub fn containing(&self, bounds: &Bounds) -> Result<Self, GridError> {
        let first = self.to_pixels(DVec2::new(bounds.min.x, bounds.max.y));
        let last = self.to_pixels(DVec2::new(bounds.max.x, bounds.min.y));
        let more = |pixels: f64| pixels.ceil().max(0.0);
        let (left, above) = (more(-first.x), more(-first.y));
        let width = left + f64::from(self.width) + more(last.x - f64::from(self.width));
        let height = above + f64::from(self.height) + more(last.y - f64::from(self.height));
        check_size(width as u64, height as u64)?;
        Ok(Self {
            width: width as u32,
            height: height as u32,
            corner_mm: self.corner_mm + DVec2::new(-left, above) * self.pitch(),
            ..*self
        })
    }

    /// Column and row of the first pixel of `part`, a result of [`Self::around_model`].
    pub fn offset_of(&self, part: &Self) -> [u32; 2] {
        let offset = self.to_pixels(part.corner_mm).round();
        [offset.x as u32, offset.y as u32]
    }

    /// `part`, a result of [`Self::around_model`], extended by these columns and rows on each side, within the grid.
    #[must_use]
    pub fn extended(&self, part: &Self, [columns, rows]: [u32; 2]) -> Self {
        let [column, row] = self.offset_of(part);
        let (left, above) = (column.min(columns), row.min(rows));
        let right = (self.width - column - part.width).min(columns);
        let below = (self.height - row - part.height).min(rows);
        Self {
            width: left + part.width + right,
            height: above + part.height + below,
            corner_mm: part.corner_mm
                - DVec2::new(f64::from(left), -f64::from(above)) * self.pitch(),
            ..*part
        }
    }

    /// The grid with each pixel divided into `columns` × `rows` smaller ones.
    #[must_use]
    pub fn refined(&self, [columns, rows]: [u32; 2]) -> Self {
        Self {
            width: self.width * columns,
            height: self.height * rows,
            pitch_mm: self.pitch_mm / f64::from(columns),
            pitch_y_mm: self.pitch_y_mm / f64::from(rows),
            corner_mm: self.corner_mm,
        }
    }

    /// Number of pixels or rays.
    pub fn pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// A point in pixels, columns to the right and rows downward from the corner, given x and y in millimetres.
    pub fn to_pixels(&self, point_mm: DVec2) -> DVec2 {
        DVec2::new(
            (point_mm.x - self.corner_mm.x) / self.pitch_mm,
            (self.corner_mm.y - point_mm.y) / self.pitch_y_mm,
        )
    }

    /// The centre of a pixel, x and y in millimetres.
    pub fn centre_mm(&self, column: u32, row: u32) -> DVec2 {
        self.corner_mm + DVec2::new(f64::from(column) + 0.5, -(f64::from(row) + 0.5)) * self.pitch()
    }
}

/// Equal height ranges from the plate to the top of a model (section 3.2).
///
/// Bin i, counted from 0 in code, is the half-open range (i·b, (i+1)·b]; boundary i is at i·b.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bins {
    /// Number of bins.
    pub count: usize,
    /// Height of a bin, b, in millimetres.
    pub size_mm: f64,
}

impl Bins {
    /// The bins of a model of `height_mm`. The last one may extend above it.
    ///
    /// # Errors
    /// [`GridError::Quantity`], [`GridError::TooManyBins`].
    pub fn of_height(height_mm: f64, bin_mm: f64) -> Result<Self, GridError> {
        Quantity::Bin.check(bin_mm)?;
        let bins = Self {
            count: 0,
            size_mm: bin_mm,
        };
        let count = bins.ceil(height_mm - height_slack(height_mm / bin_mm) * bin_mm);
        if count > MAX_BINS {
            return Err(GridError::TooManyBins { height_mm, bin_mm });
        }
        Ok(Self {
            count: count.max(1.0) as usize,
            size_mm: bin_mm,
        })
    }

    /// Finer bins: each of these divided into `parts`.
    pub(crate) fn split(self, parts: usize) -> Self {
        Self {
            count: self.count * parts,
            size_mm: self.size_mm / parts as f64,
        }
    }

    /// The bin, from 0, that contains the height `z_mm`. Heights below or above all bins belong to the first or last.
    #[inline]
    pub fn of(&self, z_mm: f64) -> usize {
        let bins = z_mm / self.size_mm;
        let position = bins - height_slack(bins);
        let most = self.count as f64;
        let position = if position < most { position } else { most };
        if cfg!(target_arch = "wasm32") {
            let above = position.ceil();
            let bin = if above > 1.0 { above - 1.0 } else { 0.0 };
            // Browsers turn one number at a time into an integer. Of one this large, the low bits are the integer.
            return (bin + INTEGERS).to_bits() as u32 as usize;
        }
        // Rounded up by hand: `ceil` is a library call on x86-64 without SSE 4.1. Numbers of 32 bits make vectors.
        let below = position as i32;
        let bin = below + i32::from(position > f64::from(below));
        (bin.max(1) - 1) as usize
    }

    /// The boundary nearest to height `z_mm`.
    pub fn nearest_boundary(&self, z_mm: f64) -> u32 {
        (z_mm / self.size_mm + 0.5) as u32
    }

    /// Number of bins whose middle lies below height `z_mm`.
    pub fn middles_below(&self, z_mm: f64) -> usize {
        let position = z_mm / self.size_mm - 0.5;
        let below = position as usize;
        (below + usize::from(position > below as f64)).min(self.count)
    }

    /// Height of the middle of a bin in millimetres.
    pub fn middle_mm(&self, bin: usize) -> f64 {
        (bin as f64 + 0.5) * self.size_mm
    }

    /// Height of a boundary in millimetres, rounded to the picometre, so that 51 bins of 0.002 mm are 0.102 mm and not
    /// 0.10200000000000001.
    pub fn boundary_mm(&self, boundary: u32) -> f64 {
        (f64::from(boundary) * self.size_mm * 1e9).round() / 1e9
    }

    /// The smallest number of bins that is at least as long as `length_mm`, ⌈length/b⌉.
    pub fn ceil(&self, length_mm: f64) -> f64 {
        (length_mm / self.size_mm - BIN_SLACK).ceil()
    }

    /// The largest number of bins that is at most as long as `length_mm`, ⌊length/b⌋.
    pub fn floor(&self, length_mm: f64) -> f64 {
        (length_mm / self.size_mm + BIN_SLACK).floor()
    }
}

/// The error, in bins, up to which a height of `bins` bins counts as exact.
fn height_slack(bins: f64) -> f64 {
    bins * HEIGHT_SLACK + ROUNDING_SLACK
}
