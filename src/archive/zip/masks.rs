//! A zip of one-bit PNG masks with a manifest: the default format.
//!
//! The masks are `layers/00000.png` and so on, from the plate upward: white where the resin is cured, row 0 at the largest
//! y. `manifest.json` is the job's manifest with an entry for each layer.

use serde_json::value::to_raw_value;

use super::{Container, File, LayerEntry};
use crate::archive::png::{self, Depth};
use crate::archive::{ArchiveError, Canvas, PrintJob};
use crate::mask::Run;

pub struct Masks;

impl Container for Masks {
    fn mask(&self, canvas: Canvas, runs: &mut dyn Iterator<Item = Run>) -> Vec<u8> {
        let depth = match canvas.antialias {
            1 => Depth::Bit,
            _ => Depth::Grey,
        };
        png::encode(runs, canvas.pixels, depth)
    }

    fn mask_name(&self, layer: usize) -> String {
        format!("layers/{layer:05}.png")
    }

    fn files(&self, job: &PrintJob<'_>, layers: &[LayerEntry]) -> Result<Vec<File>, ArchiveError> {
        let mut manifest = (job.manifest)().map_err(ArchiveError::write)?;
        let layers = to_raw_value(layers).map_err(ArchiveError::write)?;
        manifest.insert("layer_files".to_owned(), layers);
        let json = serde_json::to_vec(&manifest).map_err(ArchiveError::write)?;
        Ok(vec![("manifest.json".to_owned(), json)])
    }
}
