//! A zip of one-bit PNG masks with a manifest: the default download.
//!
//! `layers/00000.png` upward from the plate, white where the resin is cured, row 0 at the largest y;
//! `manifest.json` is the report with an entry for every layer, but for what differs from machine to machine: times, and
//! where rays were cast. So the same plan gives the same bytes everywhere.

use serde_json::json;

use super::png::Depth;
use super::{ArchiveError, Container, File, Job, LayerEntry};
use crate::report::{OF_THE_MACHINE, Report};
use crate::warning::Warning;

pub(super) struct Plain;

impl Container for Plain {
    fn depth(&self) -> Depth {
        Depth::Bit
    }

    fn mask_name(&self, layer: usize) -> String {
        format!("layers/{layer:05}.png")
    }

    fn files(&self, job: &Job<'_>, layers: &[LayerEntry]) -> Result<Vec<File>, ArchiveError> {
        let report = Report {
            warnings: of_the_plan(&job.report.warnings),
            ..job.report.clone()
        };
        let mut manifest = serde_json::to_value(report).map_err(ArchiveError::write)?;
        if let Some(manifest) = manifest.as_object_mut() {
            for key in OF_THE_MACHINE {
                manifest.remove(key);
            }
            manifest.insert("layer_files".to_owned(), json!(layers));
        }
        let json = serde_json::to_vec(&manifest).map_err(ArchiveError::write)?;
        Ok(vec![("manifest.json".to_owned(), json)])
    }
}

/// The warnings that every machine has.
fn of_the_plan(warnings: &[Warning]) -> Vec<Warning> {
    let of_the_plan = |warning: &&Warning| !warning.is_of_the_machine();
    warnings.iter().filter(of_the_plan).cloned().collect()
}
