//! The masks of a plan in groups of layers, for other workers to encode.

use std::sync::Arc;

use crate::archive::{Canvas, GROUP};
use crate::format::Format;
use crate::mask::{LayerRuns, PlateMasks, PlateReadPlace};

/// The share of the stage of masks that encoding takes, before the file is written.
pub(super) const ENCODED_SHARE: f64 = 0.9;

/// The masks of a plan, read group by group. Whatever becomes of the plan meanwhile, they stay.
pub struct LayerGroups {
    masks: Arc<PlateMasks>,
    place: PlateReadPlace,
    layers: usize,
    /// Layers that are not yet read.
    left: usize,
    /// The format of the plan's print file.
    pub format: Format,
    /// What its masks are drawn on.
    pub canvas: Canvas,
}

impl LayerGroups {
    pub(super) fn new(
        masks: Arc<PlateMasks>,
        layers: usize,
        format: Format,
        canvas: Canvas,
    ) -> Self {
        Self {
            place: PlateReadPlace::new(&masks),
            masks,
            layers,
            left: layers,
            format,
            canvas,
        }
    }

    /// Number of groups that are left.
    pub fn left(&self) -> usize {
        self.left.div_ceil(GROUP)
    }

    /// Progress of the stage of masks, 0 to 1, when the groups read so far are encoded.
    pub fn progress(&self) -> f64 {
        ENCODED_SHARE * (self.layers - self.left) as f64 / self.layers as f64
    }
}

impl Iterator for LayerGroups {
    type Item = LayerRuns;

    /// The runs of the next group; `None` after the last one.
    fn next(&mut self) -> Option<LayerRuns> {
        let layers = GROUP.min(self.left);
        self.left -= layers;
        (layers > 0).then(|| self.place.next(&self.masks, layers))
    }
}
