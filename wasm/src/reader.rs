//! Print files in the browser. The page fetches this module when somebody opens one.

use std::ops::ControlFlow;

use cusp_slicer::archive::read::{Inspection, Mask, Preview, PrintFile, inspect_masks, surface};
use js_sys::{Function, Reflect, Uint8ClampedArray};
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use crate::js::{thrown, to_js};

/// The type of all errors thrown here.
#[wasm_bindgen(typescript_custom_section)]
const ERROR: &str = "export type ReaderError = PrintFileError & { message: string };";

/// Lit changes that are kept in memory, as pairs of bytes: 128 MiB. A file with more has no surface.
const MOST_CHANGES: usize = 64 << 20;

/// A print file that is open.
#[wasm_bindgen]
pub struct PrintReader {
    file: PrintFile<'static>,
    /// The masks from the plate upward, seen from above; empty before the inspection, and if they are too large.
    masks: Vec<Mask>,
}

#[wasm_bindgen]
impl PrintReader {
    /// Reads the settings of a print file, whatever its format.
    ///
    /// # Errors
    /// Throws a `ReaderError`.
    #[wasm_bindgen(constructor)]
    pub fn new(bytes: Vec<u8>) -> Result<Self, JsValue> {
        Ok(Self {
            file: PrintFile::open(bytes).map_err(|error| thrown(&error))?,
            masks: Vec::new(),
        })
    }

    /// Decodes all layers. Calls back with the fraction that is done; it never cancels: a page terminates the worker instead.
    #[wasm_bindgen(unchecked_return_type = "Inspection")]
    pub fn inspect(&mut self, progress: &Function) -> JsValue {
        let mut masks = Vec::new();
        let mut changes = 0;
        let mut take = |mask: Mask| {
            changes += mask.changes();
            if changes <= MOST_CHANGES {
                masks.push(mask);
            } else {
                masks.clear();
            }
        };
        let mut report = |fraction: f64| {
            // A failing callback must not fail the inspection.
            let _ = progress.call1(&JsValue::NULL, &fraction.into());
            ControlFlow::Continue(())
        };
        let inspection = inspect_masks(&self.file, &mut take, &mut report);
        if changes <= MOST_CHANGES {
            self.masks = masks;
        }
        inspection.map_or(JsValue::NULL, |inspection: Inspection| to_js(&inspection))
    }

    /// Columns and rows of the masks, seen from above.
    pub fn pixels(&self) -> Vec<u32> {
        self.file.metadata().pixels_from_above().to_vec()
    }

    /// Sides of their pixels in x and y, in millimetres.
    pub fn pixel_mm(&self) -> Vec<f64> {
        self.file.metadata().pixel_mm_from_above().to_vec()
    }

    /// The mask of a layer, seen from above: one bit per pixel, rows from the top, most significant bit first, ⌈width / 8⌉
    /// bytes per row. Grey pixels are lit from half of full brightness on.
    ///
    /// # Errors
    /// Throws a `ReaderError` if the layer is damaged.
    pub fn mask(&self, layer: usize) -> Result<Vec<u8>, JsValue> {
        let [width, height] = self.file.metadata().pixels_from_above();
        if let Some(mask) = self.masks.get(layer) {
            return Ok(mask.bits(width, height));
        }
        let mask = self.file.mask(layer, self.file.metadata().flips());
        mask.map(|mask| mask.bits(width, height))
            .map_err(|error| thrown(&error))
    }

    /// The surface of the printed solid, coarse enough to display: nine numbers per facet, in millimetres. Needs an
    /// inspection.
    pub fn surface(&self) -> Vec<f32> {
        let metadata = self.file.metadata();
        surface(
            self.file.layers(),
            &self.masks,
            metadata.pixels_from_above(),
            metadata.pixel_mm_from_above(),
        )
    }

    /// A preview as `{ width, height, rgba }`; null if it is damaged.
    #[wasm_bindgen(
        unchecked_return_type = "{ width: number; height: number; rgba: Uint8ClampedArray<ArrayBuffer> } | null"
    )]
    pub fn preview(&self, place: usize) -> JsValue {
        let Some(Preview { width, height, rgb }) = self.file.preview(place) else {
            return JsValue::NULL;
        };
        let (pixels, _) = rgb.as_chunks::<3>();
        let rgba: Vec<u8> = pixels
            .iter()
            .flat_map(|&[red, green, blue]| [red, green, blue, 255])
            .collect();
        let picture = js_sys::Object::new();
        let pairs: [(&str, JsValue); 3] = [
            ("width", width.into()),
            ("height", height.into()),
            ("rgba", Uint8ClampedArray::from(&*rgba).into()),
        ];
        for (key, value) in pairs {
            // Never fails on a plain object.
            let _ = Reflect::set(&picture, &key.into(), &value);
        }
        picture.into()
    }
}
