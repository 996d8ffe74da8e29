//! Metadata of a print file, in one form for all formats.

use std::sync::Arc;

use serde::Serialize;

use super::Format;
use super::mask::Flips;
use crate::printer::{PRINTERS, Printer};

/// Metadata of a print as a whole. Values that the file does not state are absent.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify), tsify(missing_as_null))]
pub struct Metadata {
    /// The format.
    pub format: Format,
    /// The version of the format.
    pub version: Option<String>,
    /// The program that wrote the file.
    pub software: Option<String>,
    /// The printer.
    pub printer: Option<String>,
    /// The resin.
    pub resin: Option<String>,
    /// Columns and rows of the masks as stored.
    pub pixels: [u32; 2],
    /// Sides of a pixel of the masks as stored, in millimetres.
    pub pixel_mm: [f64; 2],
    /// Extent of the printer in x, y and z, in millimetres.
    pub plate_mm: [Option<f64>; 3],
    /// True if columns are stored from right to left.
    pub is_mirrored_x: Option<bool>,
    /// True if rows are stored from the smallest y to the largest.
    pub is_mirrored_y: Option<bool>,
    /// True if, mirroring undone, columns are along y and rows along x.
    pub is_turned: bool,
    /// Nominal layer thickness, in millimetres.
    pub layer_mm: Option<f64>,
    /// Exposure of a layer, in seconds, where layers do not say it themselves.
    pub exposure_s: Option<f64>,
    /// Exposure of a bottom layer, in seconds, likewise.
    pub bottom_exposure_s: Option<f64>,
    /// Number of bottom layers.
    pub bottom_layers: Option<u32>,
    /// Number of layers above them, over which the exposure falls to the usual one.
    pub transition_layers: Option<u32>,
    /// Time of the print, in seconds.
    pub print_time_s: Option<f64>,
    /// Volume of the resin, in millilitres.
    pub volume_ml: Option<f64>,
    /// Weight of the resin, in grams.
    pub weight_g: Option<f64>,
    /// True if heights and exposures of single layers count. Where the file says no, a printer takes the nominal values for
    /// all layers.
    pub uses_layer_values: Option<bool>,
}

impl Metadata {
    /// A file that says nothing but the size of its masks.
    pub(super) fn new(format: Format, pixels: [u32; 2], pixel_mm: [f64; 2]) -> Self {
        Self {
            format,
            version: None,
            software: None,
            printer: None,
            resin: None,
            pixels,
            pixel_mm,
            plate_mm: [None; 3],
            is_mirrored_x: None,
            is_mirrored_y: None,
            is_turned: false,
            layer_mm: None,
            exposure_s: None,
            bottom_exposure_s: None,
            bottom_layers: None,
            transition_layers: None,
            print_time_s: None,
            volume_ml: None,
            weight_g: None,
            uses_layer_values: None,
        }
    }

    /// The printer that the file names, if it is known and has such a screen.
    pub fn known_printer(&self) -> Option<Arc<Printer>> {
        let name = self.printer.as_ref()?;
        let is_it = |printer: &&Arc<Printer>| {
            let names = [&*printer.name, &*printer.model, printer.machine()];
            names.contains(&name.as_str()) && printer.pixels == self.pixels
        };
        PRINTERS.iter().find(is_it).cloned()
    }

    /// Returns true if columns are stored from right to left, by the file or by its printer, if either says.
    pub fn is_mirrored(&self) -> Option<bool> {
        let by_printer = || self.known_printer().map(|printer| printer.is_mirrored);
        self.is_mirrored_x.or_else(by_printer)
    }

    /// Transformation from stored masks to masks seen from above. Masks are taken to be unmirrored if neither the file
    /// nor its printer says.
    pub fn flips(&self) -> Flips {
        Flips {
            mirror_x: self.is_mirrored().unwrap_or(false),
            mirror_y: self.is_mirrored_y.unwrap_or(false),
            exchange: self.is_turned,
        }
    }

    /// Columns and rows of the masks, seen from above.
    pub fn pixels_from_above(&self) -> [u32; 2] {
        self.across(self.pixels)
    }

    /// Sides of a pixel of the masks seen from above, in millimetres.
    pub fn pixel_mm_from_above(&self) -> [f64; 2] {
        self.across(self.pixel_mm)
    }

    fn across<T>(&self, [x, y]: [T; 2]) -> [T; 2] {
        if self.is_turned { [y, x] } else { [x, y] }
    }

    /// Number of pixels of a mask.
    pub fn mask_pixels(&self) -> u64 {
        u64::from(self.pixels[0]) * u64::from(self.pixels[1])
    }
}

/// Values that a print file states for a layer, whether or not they count ([`Metadata::uses_layer_values`]). Values that
/// it does not state are absent.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify), tsify(missing_as_null))]
pub struct Layer {
    /// Top of the layer, in millimetres above the plate.
    pub z_mm: f64,
    /// Its thickness, in millimetres, to the nanometre.
    pub thickness_mm: f64,
    /// Its exposure, in seconds.
    pub exposure_s: Option<f64>,
    /// Rest before the exposure, in seconds.
    pub wait_before_exposure_s: Option<f64>,
    /// Rest before the lift, in seconds.
    pub wait_before_lift_s: Option<f64>,
    /// Rest after the lift, in seconds.
    pub wait_after_lift_s: Option<f64>,
    /// Height by which the model is lifted, all stages together, in millimetres.
    pub lift_mm: Option<f64>,
    /// Speed of the first stage of the lift, in millimetres per minute.
    pub lift_mm_min: Option<f64>,
    /// Speed of the first stage of the return, in millimetres per minute.
    pub retract_mm_min: Option<f64>,
    /// Number of lit pixels, as the file states it.
    pub stated_lit_pixels: Option<u64>,
}

/// Layers from their tops, which say thicknesses.
pub(super) fn with_thicknesses(mut layers: Vec<Layer>) -> Vec<Layer> {
    let mut below_mm = 0.0;
    for layer in &mut layers {
        layer.thickness_mm = to_nanometres(layer.z_mm - below_mm);
        below_mm = layer.z_mm;
    }
    layers
}

/// Layers from their thicknesses, which say tops.
pub(super) fn with_tops(mut layers: Vec<Layer>) -> Vec<Layer> {
    let mut z_mm = 0.0;
    for layer in &mut layers {
        z_mm = to_nanometres(z_mm + layer.thickness_mm);
        layer.z_mm = z_mm;
    }
    layers
}

fn to_nanometres(length_mm: f64) -> f64 {
    (length_mm * 1e6).round() / 1e6
}

/// A picture for the printer's screen.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Preview {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green and blue of each pixel, row by row from the top.
    pub rgb: Vec<u8>,
}
