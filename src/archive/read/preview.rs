//! Previews as they are stored.

use std::ops::Range;

use super::Preview;
use super::bytes::{Fields, Order};
use super::image;

/// Longer sides are no picture for a printer's screen.
const MOST_SIDE: u32 = 4096;
/// Bytes that a picture may unpack to.
pub(super) const MOST_BYTES: u64 = 16 << 20;

/// A preview that is not decoded yet.
#[derive(Debug, Clone)]
pub(super) enum Picture {
    /// A PNG in a zip.
    Png(String),
    /// Two bytes a pixel, five bits red, six green and five blue.
    Words {
        pixels: [u32; 2],
        order: Order,
        place: Range<u64>,
    },
    /// Chitubox's runs of two bytes a pixel: five bits red, five green, one for runs and five blue.
    Ctb { pixels: [u32; 2], place: Range<u64> },
}

fn is_small([width, height]: [u32; 2]) -> bool {
    let side = 1..=MOST_SIDE;
    side.contains(&width) && side.contains(&height)
}

/// Decodes a PNG.
pub(super) fn of_png(png: &[u8]) -> Option<Preview> {
    image::rgb(png, is_small)
}

/// Decodes words in `bytes`, the whole file.
pub(super) fn of_words(
    bytes: &[u8],
    pixels: [u32; 2],
    order: Order,
    place: &Range<u64>,
) -> Option<Preview> {
    if !is_small(pixels) {
        return None;
    }
    let fields = Fields { bytes, order };
    let words = fields
        .slice(place.start, place.end.checked_sub(place.start)?)
        .ok()?;
    let words = words.chunks_exact(2).map(|word| match order {
        Order::Big => u16::from_be_bytes([word[0], word[1]]),
        Order::Little => u16::from_le_bytes([word[0], word[1]]),
    });
    let rgb = words.flat_map(|word| [five(word >> 11), six(word >> 5), five(word)]);
    complete(pixels, rgb.collect())
}

/// Decodes Chitubox's runs in `bytes`, the whole file.
pub(super) fn of_ctb(bytes: &[u8], pixels: [u32; 2], place: &Range<u64>) -> Option<Preview> {
    const IS_RUN: u16 = 1 << 5;
    if !is_small(pixels) {
        return None;
    }
    let order = Order::Little;
    let fields = Fields { bytes, order };
    let data = fields
        .slice(place.start, place.end.checked_sub(place.start)?)
        .ok()?;
    let mut words = data
        .chunks_exact(2)
        .map(|word| u16::from_le_bytes([word[0], word[1]]));
    let expected = 3 * pixels[0] as usize * pixels[1] as usize;
    let mut rgb = Vec::new();
    while let Some(word) = words.next() {
        let count = if word & IS_RUN == 0 {
            1
        } else {
            usize::from(words.next()? & 0xFFF) + 1
        };
        let pixel = [five(word >> 11), five(word >> 6), five(word)];
        let fits = count.min((expected - rgb.len()) / 3);
        rgb.extend(std::iter::repeat_n(pixel, fits).flatten());
        if fits < count {
            return None;
        }
    }
    complete(pixels, rgb)
}

fn complete([width, height]: [u32; 2], rgb: Vec<u8>) -> Option<Preview> {
    let is_complete = rgb.len() == 3 * width as usize * height as usize;
    is_complete.then_some(Preview { width, height, rgb })
}

/// The lowest five bits as a colour of eight.
fn five(bits: u16) -> u8 {
    let bits = (bits & 31) as u8;
    bits << 3 | bits >> 2
}

/// The lowest six bits as a colour of eight.
fn six(bits: u16) -> u8 {
    let bits = (bits & 63) as u8;
    bits << 2 | bits >> 4
}
