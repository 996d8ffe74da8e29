//! The exposures that a print file's head says for all layers.

/// Exposures that differ by no more are one, in seconds: files round them to a millisecond, and the rest is for single precision.
pub const SAME_S: f64 = 1.001e-3;

/// Exposures of all layers by four numbers: bottom layers, a fade in equal steps, and the usual exposure above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Schedule {
    /// Number of bottom layers.
    pub bottom_layers: usize,
    /// Exposure of a bottom layer, in seconds.
    pub bottom_s: f64,
    /// Number of layers above them whose exposure is between that and the usual one.
    pub transition_layers: usize,
    /// Exposure of the other layers, in seconds.
    pub usual_s: f64,
}

impl Schedule {
    /// Exposure of a layer, of which the first is 0, in seconds.
    pub fn exposure_s(&self, layer: usize) -> f64 {
        match layer.checked_sub(self.bottom_layers) {
            None => self.bottom_s,
            Some(above) if above < self.transition_layers => {
                let part = (above + 1) as f64 / (self.transition_layers + 1) as f64;
                self.bottom_s + (self.usual_s - self.bottom_s) * part
            }
            Some(_) => self.usual_s,
        }
    }

    /// Returns true if layers have these exposures, to the millisecond.
    pub fn fits(&self, exposures_s: impl IntoIterator<Item = f64>) -> bool {
        let mut layers = exposures_s.into_iter().enumerate();
        layers.all(|(layer, stated_s)| (stated_s - self.exposure_s(layer)).abs() <= SAME_S)
    }
}
