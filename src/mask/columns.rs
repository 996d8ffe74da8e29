//! Pixels that are lit, or dark between lit ones, for few layers.

use super::{Band, Change, Masks, Samples, Span};
use crate::parallel;

/// Marks a pixel that is lit.
const LIT: u32 = 1 << 31;

/// Ends of the shortest spans of layers, lit or dark, that do not count as short.
pub(crate) struct Until {
    /// For each layer, the first one at which a pixel that is lit from there on may become dark.
    pub lit: Vec<u32>,
    /// The same for a pixel that is dark between lit ones.
    pub dark: Vec<u32>,
}

impl Masks {
    /// The pixels that are lit, and those that are dark between lit ones along z, but not as long as `until`: as two lists of
    /// masks of their own. A pixel is lit if at least half of its samples are.
    ///
    /// Cost: linear in changes and in the pixels of the window. Memory: five bytes per pixel of each band that is worked on.
    pub(crate) fn short_columns(&self, until: &Until) -> [Self; 2] {
        let bands = parallel::map(self.bands.iter().collect(), |band| {
            let changes = short_in(band, self.samples, self.layers, until);
            changes.map(|changes| Band::new(band.area.clone(), self.layers, Samples::ONE, &changes))
        });
        let mut lit = self.blank();
        let mut dark = self.blank();
        for [of_lit, of_dark] in bands {
            lit.bands.push(of_lit);
            dark.bands.push(of_dark);
        }
        [lit, dark]
    }

    /// Masks of the same pixels and layers, without bands.
    fn blank(&self) -> Self {
        Self {
            grid: self.grid,
            samples: Samples::ONE,
            window: self.window,
            layers: self.layers,
            bands: Vec::new(),
        }
    }

    /// Returns true if no pixel is lit in any layer.
    pub(crate) fn is_black(&self) -> bool {
        self.bands.iter().all(|band| band.spans.is_empty())
    }
}

/// The changes of pixels that are lit, and of those that are dark, for short.
fn short_in(band: &Band, samples: Samples, layers: usize, until: &Until) -> [Vec<Change>; 2] {
    let half = samples.total().div_ceil(2) as u8;
    let pixels = band.area.len();
    let mut samples_lit = vec![0u8; pixels];
    // The layer, from 1, at which each pixel took its present state, and that state; 0 if it was never lit.
    let mut since = vec![0u32; pixels];
    let mut found = [Vec::new(), Vec::new()];
    let mut add = |place: usize, from: u32, to: u32, is_lit: bool| {
        let span = Span::of(place as u32);
        let changes = &mut found[usize::from(!is_lit)];
        changes.push(Change::new(from, span, 1));
        changes.push(Change::new(to, span, -1));
    };
    for layer in 0..layers {
        let changes = band.of_layer(layer);
        for index in changes.clone() {
            for pixel in band.spans[index].range() {
                let lit = &mut samples_lit[pixel as usize];
                match band.by.get(index) {
                    Some(&by) => *lit = lit.wrapping_add_signed(by),
                    None => *lit ^= 1,
                }
            }
        }
        let layer = layer as u32;
        for pixel in band.spans[changes].iter().flat_map(|span| span.range()) {
            let place = pixel as usize;
            let is_lit = samples_lit[place] >= half;
            let before = since[place];
            let was_lit = before & LIT != 0;
            if is_lit == was_lit {
                continue;
            }
            since[place] = (layer + 1) | if is_lit { LIT } else { 0 };
            let Some(from) = (before & !LIT).checked_sub(1) else {
                continue;
            };
            let enough = if was_lit { &until.lit } else { &until.dark };
            if layer < enough[from as usize] {
                add(place, from, layer, was_lit);
            }
        }
    }
    for (place, &since) in since.iter().enumerate() {
        if since & LIT != 0 {
            let from = (since & !LIT) - 1;
            if (layers as u32) < until.lit[from as usize] {
                add(place, from, layers as u32, true);
            }
        }
    }
    found
}
