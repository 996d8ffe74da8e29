//! Layer masks: which pixels are lit (section 3.4).
//!
//! From one layer to the next, a pixel changes only if its ray meets the surface between the two
//! sampling heights. All masks together are therefore a list of changes, sorted by layer and at most as
//! long as the list of hits. No mask is computed from scratch, and only one is in memory at a time.

mod columns;
mod compensated;
mod entries;
mod erased;
mod facets;
mod plate;
mod print_through;
mod runs;
mod samples;
mod slabs;
mod step;
mod window;

use std::ops::Range;

pub(crate) use columns::Until;
pub use compensated::Compensations;
pub use entries::Raise;
pub(crate) use erased::erased_mm2;
pub use plate::{PlateMasks, PlateReadPlace, PlateRuns, Stamp};
pub(crate) use print_through::print_through;
pub use print_through::{BottomErrors, PrintThroughReport};
pub use runs::{LayerRuns, ReadPlace, Run, RunReader, RunSource};
pub use samples::{LEVELS, Samples};
pub use slabs::{CompensatedSlabs, SlabMasks};
pub use window::{Side, Window};

use crate::grid::Grid;
use crate::ldi::{Ldi, RayImage, RayRows, Solid};
use crate::parallel;
use crate::plan::Plan;
use compensated::{Compensated, ROWS_AT_ONCE};
use entries::{Column, Entries, LitRanges};
use samples::SublayerOf;
use window::Place;

/// The masks of all layers of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Masks {
    /// The pixels.
    pub grid: Grid,
    /// Sampling pattern over which the light of a pixel is averaged.
    pub samples: Samples,
    /// The part of the mask that the model covers. All pixels outside it are dark in every layer.
    pub window: Window,
    layers: usize,
    /// Changes by bands of rows, from the top row down.
    bands: Vec<Band>,
}

/// The changes between layers in a band of rows.
#[derive(Debug, Clone, PartialEq)]
struct Band {
    /// The pixels of the window that the band covers: whole rows.
    area: Range<u32>,
    /// The changes of layer k are those from `starts[k]` to `starts[k + 1]`.
    starts: Vec<u32>,
    /// Pixels that differ from the layer below, sorted by layer. A pixel may be in several spans of a layer: with a single
    /// sample it flips with each, and otherwise their changes add up.
    spans: Vec<Span>,
    /// The change of each pixel of a span in lit samples. Empty if pixels have a single sample, which can only flip.
    by: Vec<i8>,
}

impl Masks {
    /// The masks of `plan` on `grid`. The rays of `ldi` are those of [`Grid::refined`], or a part of them.
    ///
    /// A sample is lit where the middle of its part of the layer lies inside the solid, from an entry (included) to an
    /// exit (excluded).
    ///
    /// Cost: linear in rays and hits. Memory: with one sample per pixel, 4 bytes per change and at most one change per
    /// hit; with several, 5 bytes per change and at most two changes per hit.
    pub fn new(ldi: &Ldi, plan: &Plan, grid: &Grid, samples: Samples, side: Side) -> Self {
        let sublayer_of = SublayerOf::new(plan, samples.sublayers);
        RayImage::Kept(ldi).read(|image| {
            let place = Place::new(&image.grid, grid, samples, side);
            Self::of_bands(plan.layers(), grid, samples, &place, |rows, changes| {
                of_rays(image, samples, &place, &sublayer_of, rows, |change| {
                    change.join(changes);
                });
            })
        })
    }

    /// The masks of a plan that make up for prints larger than they.
    ///
    /// Cost: linear in the lit stretches of the rows of all layers, times the rows that the compensation spans.
    pub fn compensated(
        image: RayImage<'_>,
        plan: &Plan,
        grid: &Grid,
        samples: Samples,
        side: Side,
        compensations: &Compensations,
    ) -> Self {
        image.read(|image| {
            let layers = 0..plan.layers();
            Self::compensated_layers(image, plan, layers, grid, samples, side, compensations)
        })
    }

    /// The masks of some layers of [`Self::compensated`].
    fn compensated_layers(
        image: &RayRows<'_>,
        plan: &Plan,
        layers: Range<usize>,
        grid: &Grid,
        samples: Samples,
        side: Side,
        compensations: &Compensations,
    ) -> Self {
        let sublayer_of = SublayerOf::new(plan, samples.sublayers);
        let keep = |changes: &mut Vec<Change>, mut change: Change| {
            if layers.contains(&change.layer()) {
                change.lower(layers.start);
                change.join(changes);
            }
        };
        if compensations.xy_mm.iter().all(|&mm| mm == 0.0) {
            let entries = Entries {
                sublayer_of: &sublayer_of,
                parts: samples.sublayers,
                raise: &compensations.raise,
            };
            let place = Place::new(&image.grid, grid, samples, side);
            return Self::of_bands(layers.len(), grid, samples, &place, |rows, changes| {
                of_rays(image, samples, &place, &entries, rows, |change| {
                    keep(changes, change);
                });
            });
        }
        let all_rays = grid.refined(samples.rays());
        let rays = compensated::extended(compensations, &all_rays, &image.grid);
        let offset = rays.offset_of(&image.grid);
        let place = Place::new(&rays, grid, samples, side);
        let compensated = Compensated {
            image,
            sublayer_of: &sublayer_of,
            compensations,
            parts: samples.sublayers,
            rays,
            offset,
        };
        Self::of_bands(layers.len(), grid, samples, &place, |rows, changes| {
            let first = place.area(&rows).start;
            let pixel_of = |row: usize, column: usize| place.pixel(row, column) - first;
            compensated.changes(rows, pixel_of, |change| keep(changes, change));
        })
    }

    /// The masks of the changes that `find` adds for rows of rays.
    fn of_bands(
        layers: usize,
        grid: &Grid,
        samples: Samples,
        place: &Place,
        find: impl Fn(Range<usize>, &mut Vec<Change>) + Sync + Send,
    ) -> Self {
        let bands = parallel::map(place.bands(), |rows| {
            let area = place.area(&rows);
            let mut changes = Vec::new();
            find(rows, &mut changes);
            Band::new(area, layers, samples, &changes)
        });
        Self {
            grid: *grid,
            samples,
            window: place.window,
            layers,
            bands,
        }
    }

    /// Bytes that masks take per hit: where a pixel changes, and by how many samples. With several samples a hit may change two
    /// layers.
    pub(crate) fn bytes_per_hit(samples: Samples) -> u64 {
        if samples == Samples::ONE { 4 } else { 10 }
    }

    /// Number of layers.
    pub fn layers(&self) -> usize {
        self.layers
    }

    /// A cursor at the first layer.
    pub fn cursor(&self) -> MaskCursor {
        let Window {
            row_bytes, rows, ..
        } = self.window;
        let light = if self.samples == Samples::ONE {
            Light::Bits(vec![0; row_bytes * rows])
        } else {
            Light::Samples(vec![0; self.window.row_pixels() * rows])
        };
        let mut cursor = MaskCursor {
            light,
            lit_pixels: 0,
            layer: 0,
        };
        cursor.change(self, 0, 1);
        cursor
    }
}

/// Calls `emit` for the changes of rows of rays, given the lit ranges of each ray.
fn of_rays(
    image: &RayRows<'_>,
    samples: Samples,
    place: &Place,
    ranges: &impl LitRanges,
    rows: Range<usize>,
    mut emit: impl FnMut(Change),
) {
    let width = image.grid.width as usize;
    let first_pixel = place.area(&rows).start;
    let mut column_ranges = Column::new();
    for first in rows.clone().step_by(ROWS_AT_ONCE as usize) {
        let end = (first + ROWS_AT_ONCE as usize).min(rows.end);
        let held = image.of(first as u32..end as u32);
        let rays = held.rays();
        for row in first..end {
            for (column, &in_row) in place.columns.iter().enumerate() {
                let pixel = place.rows[row] + in_row - first_pixel;
                let hits = rays.ray((row - first) * width + column);
                ranges.of_ray(hits, image.classes, &mut column_ranges, |on, off| {
                    if on >= off {
                        return;
                    }
                    for (sublayer, sign) in [(on, 1), (off, -1)] {
                        let span = Span::of(pixel);
                        each_change(sublayer, samples.sublayers, sign, span, &mut emit);
                    }
                });
            }
        }
    }
}

/// Indices of the layers of `plan`, from 0, whose masks are black: no ray is inside the solid at any of the layer's
/// sampling heights ([`Solid::heights_mm`]).
///
/// Cost: linear in layers and height ranges. No mask is computed.
pub fn black_layers(solid: &Solid, plan: &Plan, samples: Samples) -> Vec<usize> {
    let sublayer_of = SublayerOf::new(plan, samples.sublayers);
    let parts = samples.sublayers;
    let mut black = Vec::new();
    let mut next = 0;
    for &(z_in, z_out) in &solid.heights_mm {
        let on = sublayer_of.first_above(z_in);
        let off = sublayer_of.first_above(z_out);
        if on < off {
            black.extend(next..on / parts);
            next = next.max(off.div_ceil(parts));
        }
    }
    black.extend(next..plan.layers() as u32);
    black.into_iter().map(|layer| layer as usize).collect()
}

/// Consecutive pixels of a band, in four bytes: the first in the upper 21 bits, their number less one in the lower eleven.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Span(u32);

impl Span {
    const LENGTH_BITS: u32 = 11;
    /// The most pixels of a span.
    const MOST: u32 = 1 << Self::LENGTH_BITS;
    /// The most pixels of a band.
    const BAND_PIXELS: u32 = 1 << (32 - Self::LENGTH_BITS);

    /// A single pixel, counted from the first of the band.
    fn of(pixel: u32) -> Self {
        Self(pixel << Self::LENGTH_BITS)
    }

    /// At most [`Self::MOST`] pixels from one on.
    fn from(first: u32, pixels: u32) -> Self {
        Self(first << Self::LENGTH_BITS | (pixels - 1))
    }

    fn first(self) -> u32 {
        self.0 >> Self::LENGTH_BITS
    }

    fn pixels(self) -> u32 {
        (self.0 & (Self::MOST - 1)) + 1
    }

    /// The pixels, counted from the first of the band.
    fn range(self) -> Range<u32> {
        let first = self.first();
        first..first + self.pixels()
    }

    /// The pixels of two spans side by side as one, if it can hold them.
    fn joined(self, other: Self) -> Option<Self> {
        let first = self.first().min(other.first());
        let pixels = self.pixels() + other.pixels();
        let touch = self.first() + self.pixels() == other.first()
            || other.first() + other.pixels() == self.first();
        (touch && pixels <= Self::MOST).then(|| Self::from(first, pixels))
    }
}

/// Pixels, and the number of samples of each that a layer lights more (or fewer) than the layer below.
///
/// Eight bytes, since writing and sorting changes is bound by memory: plans have fewer than two million layers.
struct Change {
    span: Span,
    /// The layer in the upper 24 bits, the number of samples in the lower eight.
    layer_and_by: u32,
}

/// Number of changes that the next one may go on from: of a ray that enters and leaves the solid once, with several samples.
const OPEN_CHANGES: usize = 4;

impl Change {
    fn new(layer: u32, span: Span, by: i8) -> Self {
        Self {
            span,
            layer_and_by: layer << 8 | u32::from(by.cast_unsigned()),
        }
    }

    fn layer(&self) -> usize {
        (self.layer_and_by >> 8) as usize
    }

    fn by(&self) -> i8 {
        self.layer_and_by as i8
    }

    /// Counts its layer from another one.
    fn lower(&mut self, first_layer: usize) {
        self.layer_and_by -= (first_layer as u32) << 8;
    }

    /// Adds it to changes, as part of one of the last if that goes on.
    #[inline]
    fn join(self, changes: &mut Vec<Self>) {
        for open in changes.iter_mut().rev().take(OPEN_CHANGES) {
            if open.layer_and_by == self.layer_and_by
                && let Some(joined) = open.span.joined(self.span)
            {
                open.span = joined;
                return;
            }
        }
        changes.push(self);
    }
}

/// Calls `emit` for each layer that changes if rays of pixels change at a sublayer: the layer of that sublayer, and the
/// one above unless the sublayer is its lowest.
fn each_change(sublayer: u32, parts: u32, sign: i8, span: Span, emit: &mut impl FnMut(Change)) {
    let (layer, below) = (sublayer / parts, sublayer % parts);
    let mut change = |layer, parts: u32| {
        let by = sign * parts as i8;
        emit(Change::new(layer, span, by));
    };
    change(layer, parts - below);
    if below > 0 {
        change(layer + 1, below);
    }
}

impl Band {
    /// Sorts changes by layer with a counting sort.
    fn new(area: Range<u32>, layers: usize, samples: Samples, changes: &[Change]) -> Self {
        // Counts are stored one slot ahead: filling then advances each start to where it belongs.
        let mut starts = vec![0u32; layers + 2];
        for change in changes {
            // Changes above the last layer belong to no mask.
            if let Some(start) = starts.get_mut(change.layer() + 2) {
                *start += 1;
            }
        }
        for layer in 2..starts.len() {
            starts[layer] += starts[layer - 1];
        }
        let is_one = samples == Samples::ONE;
        let kept = starts[layers + 1] as usize;
        let mut spans = vec![Span(0); kept];
        let mut by = vec![0i8; if is_one { 0 } else { kept }];
        for change in changes.iter().filter(|change| change.layer() < layers) {
            let slot = &mut starts[change.layer() + 1];
            spans[*slot as usize] = change.span;
            if !is_one {
                by[*slot as usize] = change.by();
            }
            *slot += 1;
        }
        starts.truncate(layers + 1);
        Self {
            area,
            starts,
            spans,
            by,
        }
    }

    fn of_layer(&self, layer: usize) -> Range<usize> {
        self.starts[layer] as usize..self.starts[layer + 1] as usize
    }
}

/// Lit pixels of a mask's window, row by row.
#[derive(Debug, Clone, PartialEq)]
pub enum Light {
    /// One bit per pixel, most significant first; 1 is lit.
    Bits(Vec<u8>),
    /// One byte per pixel: the number of its lit samples.
    Samples(Vec<u8>),
}

/// The mask of one layer. It moves to any other layer, since changes apply in both directions.
#[derive(Debug, Clone)]
pub struct MaskCursor {
    light: Light,
    lit_pixels: u64,
    layer: usize,
}

impl MaskCursor {
    /// Moves to another layer. `masks` must be those that made this cursor.
    ///
    /// Cost: linear in the pixels that change on the way.
    pub fn seek(&mut self, masks: &Masks, layer: usize) {
        while self.layer < layer {
            self.layer += 1;
            self.change(masks, self.layer, 1);
        }
        while self.layer > layer {
            self.change(masks, self.layer, -1);
            self.layer -= 1;
        }
    }

    /// The window of the mask.
    pub fn light(&self) -> &Light {
        &self.light
    }

    /// The whole mask: one bit per pixel, most significant first, rows padded to whole bytes. 1 is lit; a pixel of
    /// several samples counts as lit if at least half of them are.
    pub fn whole(&self, masks: &Masks) -> Vec<u8> {
        let Masks { grid, window, .. } = masks;
        let row_bytes = row_bytes(grid);
        let mut whole = vec![0; row_bytes * grid.height as usize];
        let first = window.first_row * row_bytes + window.first_byte;
        let rows = whole[first..].chunks_mut(row_bytes);
        match &self.light {
            Light::Bits(bits) => {
                for (row, bits) in rows.zip(bits.chunks(window.row_bytes)) {
                    row[..bits.len()].copy_from_slice(bits);
                }
            }
            Light::Samples(samples) => {
                let half = masks.samples.total().div_ceil(2) as u8;
                for (row, samples) in rows.zip(samples.chunks(window.row_pixels())) {
                    for (byte, pixels) in row.iter_mut().zip(samples.chunks(8)) {
                        *byte = pixels
                            .iter()
                            .fold(0, |byte, &pixel| byte << 1 | u8::from(pixel >= half));
                    }
                }
            }
        }
        whole
    }

    /// Number of pixels with at least one lit sample.
    pub fn lit_pixels(&self) -> u64 {
        self.lit_pixels
    }

    fn change(&mut self, masks: &Masks, layer: usize, sign: i8) {
        for band in &masks.bands {
            let changes = band.of_layer(layer);
            let pixels = |span: Span| {
                let Range { start, end } = span.range();
                (band.area.start + start) as usize..(band.area.start + end) as usize
            };
            match &mut self.light {
                Light::Bits(bits) => {
                    for &span in &band.spans[changes] {
                        for pixel in pixels(span) {
                            let byte = &mut bits[pixel / 8];
                            let bit = 0x80 >> (pixel % 8);
                            *byte ^= bit;
                            if *byte & bit == 0 {
                                self.lit_pixels -= 1;
                            } else {
                                self.lit_pixels += 1;
                            }
                        }
                    }
                }
                Light::Samples(samples) => {
                    for (&span, &by) in band.spans[changes.clone()].iter().zip(&band.by[changes]) {
                        for lit in &mut samples[pixels(span)] {
                            self.lit_pixels -= u64::from(*lit > 0);
                            *lit = lit.wrapping_add_signed(sign * by);
                            self.lit_pixels += u64::from(*lit > 0);
                        }
                    }
                }
            }
        }
    }
}

/// Bytes per row of a one-bit mask.
pub fn row_bytes(grid: &Grid) -> usize {
    grid.width.div_ceil(8) as usize
}
