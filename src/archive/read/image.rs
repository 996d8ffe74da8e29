//! PNGs: masks row by row, previews as a whole.

use std::io::{Cursor, Write};

use png::{BitDepth, ColorType, Decoder, DecodingError, Encoder, Transformations};

use super::mask::HALF;
use super::{LayerFault, Preview, Sink};

/// Deflate makes at most this many bytes of one.
const DEFLATE_RATIO: u64 = 1032;

/// A row of a mask as decoded.
#[derive(Clone, Copy)]
pub(super) enum Row<'a> {
    /// One bit a pixel, the first in the highest bit; bits after the last pixel are undefined.
    Bits(&'a [u8]),
    /// Samples of 8 bits, this many a pixel. An alpha channel, the last of two or four, is no colour.
    Samples(&'a [u8], usize),
}

impl<'a> Row<'a> {
    fn of(bytes: &'a [u8], samples: usize, is_bits: bool) -> Self {
        if is_bits {
            Self::Bits(bytes)
        } else {
            Self::Samples(bytes, samples)
        }
    }
}

/// Requirements on a mask.
#[derive(Clone, Copy)]
pub(super) struct Expected<'a> {
    /// Columns and rows of the image.
    pub pixels: [u32; 2],
    /// Name in the zip.
    pub name: &'a str,
}

impl Expected<'_> {
    fn bad(self, error: impl std::fmt::Display) -> LayerFault {
        LayerFault::BadMask {
            name: self.name.to_owned(),
            system: error.to_string(),
        }
    }
}

/// Decodes a mask, and passes its rows on from the top.
pub(super) fn rows(
    png: &[u8],
    expected: Expected<'_>,
    mut each: impl FnMut(Row<'_>) -> Result<(), LayerFault>,
) -> Result<(), LayerFault> {
    let bad = |error: DecodingError| expected.bad(error);
    let mut decoder = Decoder::new(Cursor::new(png));
    let info = decoder.read_header_info().map_err(bad)?;
    if [info.width, info.height] != expected.pixels {
        return Err(LayerFault::MaskSize {
            name: expected.name.to_owned(),
            width: info.width,
            height: info.height,
            columns: expected.pixels[0],
            rows: expected.pixels[1],
        });
    }
    let is_bits = (info.color_type, info.bit_depth) == (ColorType::Grayscale, BitDepth::One);
    let is_interlaced = info.interlaced;
    if !is_bits {
        decoder.set_transformations(Transformations::normalize_to_color8());
    }
    let mut reader = decoder.read_info().map_err(bad)?;
    let samples = reader.output_color_type().0.samples();
    if is_interlaced {
        // Rows arrive in several passes, so the whole image is held.
        let pixels = u64::from(expected.pixels[0]) * u64::from(expected.pixels[1]);
        let size = reader.output_buffer_size();
        let size = size.filter(|_| is_plausible(pixels, png));
        let size = size.ok_or_else(|| expected.bad("it is too short for its pixels"))?;
        let mut frame = vec![0; size];
        let line = reader.next_frame(&mut frame).map_err(bad)?.line_size;
        return frame
            .chunks(line)
            .try_for_each(|bytes| each(Row::of(bytes, samples, is_bits)));
    }
    while let Some(bytes) = reader.next_row().map_err(bad)? {
        each(Row::of(bytes.data(), samples, is_bits))?;
    }
    Ok(())
}

/// Returns true if a PNG of this length can hold this many pixels, of at least one bit each.
fn is_plausible(pixels: u64, png: &[u8]) -> bool {
    pixels <= 8 * DEFLATE_RATIO * png.len() as u64
}

/// Passes the runs of equal pixels of a row on. The grey of a coloured pixel is its brightest colour.
pub(super) fn row_runs(
    row: Row<'_>,
    width: u32,
    each: &mut dyn FnMut(u8, u32) -> Result<(), LayerFault>,
) -> Result<(), LayerFault> {
    match row {
        Row::Bits(bytes) => {
            let mut changes = Vec::new();
            scan_bits(bytes, width as usize, &mut changes);
            let mut column = 0;
            for pair in changes.chunks_exact(2) {
                let (from, to) = (u32::from(pair[0]), u32::from(pair[1]));
                each(0, from - column)?;
                each(255, to - from)?;
                column = to;
            }
            each(0, width - column)
        }
        Row::Samples(bytes, 1) => {
            let mut rest = &bytes[..width as usize];
            while let Some(&grey) = rest.first() {
                let count = equal(rest, grey);
                each(grey, count as u32)?;
                rest = &rest[count..];
            }
            Ok(())
        }
        Row::Samples(bytes, samples) => {
            let colours = colours(samples);
            let pixels = bytes.chunks_exact(samples).take(width as usize);
            runs_of(pixels.map(|pixel| brightest(&pixel[..colours])), each)
        }
    }
}

/// Same as [`row_runs`], for a row in which each colour of a pixel is a pixel of the mask.
pub(super) fn subpixel_runs(
    row: Row<'_>,
    width: u32,
    each: &mut dyn FnMut(u8, u32) -> Result<(), LayerFault>,
) -> Result<(), LayerFault> {
    let width = width as usize;
    match row {
        Row::Bits(bytes) => {
            // Black and white has no colours: three pixels are alike.
            let bit = |column: usize| bytes[column / 8] >> (7 - column % 8) & 1;
            runs_of((0..width).map(|column| 255 * bit(column / 3)), each)
        }
        Row::Samples(bytes, samples) => {
            let last = colours(samples) - 1;
            let pixels = bytes.chunks_exact(samples);
            let colours =
                pixels.flat_map(|pixel| [0, 1, 2].map(|place: usize| pixel[place.min(last)]));
            runs_of(colours.take(width), each)
        }
    }
}

/// Number of leading bytes equal to `byte`, compared eight at a time.
fn equal(bytes: &[u8], byte: u8) -> usize {
    let words = bytes.chunks_exact(8);
    let words = words.take_while(|word| **word == [byte; 8]).count();
    let rest = bytes[8 * words..].iter();
    8 * words + rest.take_while(|&&other| other == byte).count()
}

/// Number of colours among the samples of a pixel.
fn colours(samples: usize) -> usize {
    if samples <= 2 { 1 } else { 3 }
}

fn brightest(colours: &[u8]) -> u8 {
    colours.iter().copied().max().unwrap_or(0)
}

fn runs_of(
    pixels: impl Iterator<Item = u8>,
    each: &mut dyn FnMut(u8, u32) -> Result<(), LayerFault>,
) -> Result<(), LayerFault> {
    let (mut grey, mut count) = (0, 0);
    for pixel in pixels {
        if pixel == grey {
            count += 1;
        } else {
            each(grey, count)?;
            (grey, count) = (pixel, 1);
        }
    }
    each(grey, count)
}

/// Adds the columns at which a row changes between dark and lit, an even number of them.
///
/// Grey pixels are lit from half of full brightness on; coloured ones if one of their colours is.
pub(super) fn scan(row: Row<'_>, width: u32, columns: &mut Vec<u16>) {
    match row {
        Row::Bits(bytes) => scan_bits(bytes, width as usize, columns),
        Row::Samples(bytes, samples) => scan_samples(bytes, samples, width as usize, columns),
    }
}

/// Finds the changes of a row of one bit a pixel, 64 pixels at a time.
fn scan_bits(bytes: &[u8], width: usize, columns: &mut Vec<u16>) {
    let mut last = 0u64;
    for (place, chunk) in bytes.chunks(8).enumerate() {
        let mut word = [0; 8];
        word[..chunk.len()].copy_from_slice(chunk);
        let mut bits = u64::from_be_bytes(word);
        // Bits after the last pixel are undefined.
        let rest = width.saturating_sub(64 * place);
        if rest < 64 {
            bits &= !(u64::MAX >> rest);
        }
        let mut changes = bits ^ (bits >> 1 | last << 63);
        last = bits & 1;
        while changes != 0 {
            let bit = changes.leading_zeros();
            columns.push((64 * place) as u16 + bit as u16);
            changes &= !(1 << 63 >> bit);
        }
    }
    if columns.len() % 2 == 1 {
        columns.push(width as u16);
    }
}

/// Finds the changes of a row of 8-bit samples.
fn scan_samples(bytes: &[u8], samples: usize, width: usize, columns: &mut Vec<u16>) {
    let mut is_lit = false;
    let mut change = |column: usize, lit: bool| {
        if lit != is_lit {
            is_lit = lit;
            columns.push(column as u16);
        }
    };
    if samples == 1 {
        const TOPS: u64 = 0x8080_8080_8080_8080;
        let mut before = 0;
        for (place, chunk) in bytes[..width].chunks(8).enumerate() {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            let tops = u64::from_be_bytes(word) & TOPS;
            if tops != before || (tops != 0 && tops != TOPS) {
                for (offset, &byte) in chunk.iter().enumerate() {
                    change(8 * place + offset, byte >= HALF);
                }
                before = if chunk[chunk.len() - 1] >= HALF {
                    TOPS
                } else {
                    0
                };
            }
        }
    } else {
        let colours = colours(samples);
        for (column, pixel) in bytes.chunks_exact(samples).take(width).enumerate() {
            change(column, pixel[..colours].iter().any(|&byte| byte >= HALF));
        }
    }
    if columns.len() % 2 == 1 {
        columns.push(width as u16);
    }
}

/// Decodes a picture of at most a size.
pub(super) fn rgb(png: &[u8], fits: impl Fn([u32; 2]) -> bool) -> Option<Preview> {
    let mut decoder = Decoder::new(Cursor::new(png));
    let info = decoder.read_header_info().ok()?;
    let (width, height) = (info.width, info.height);
    let pixels = u64::from(width) * u64::from(height);
    if !fits([width, height]) || !is_plausible(pixels, png) {
        return None;
    }
    decoder.set_transformations(Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().ok()?;
    let samples = reader.output_color_type().0.samples();
    let mut frame = vec![0; reader.output_buffer_size()?];
    reader.next_frame(&mut frame).ok()?;
    let last = colours(samples) - 1;
    let pixels = frame.chunks_exact(samples);
    let rgb = pixels.flat_map(|pixel| [0, 1, 2].map(|place: usize| pixel[place.min(last)]));
    Some(Preview {
        width,
        height,
        rgb: rgb.collect(),
    })
}

/// Writes a PNG of 8 bits of grey from the runs that `decode` passes on, in raster order and of at most as many pixels.
/// Pixels after the last run are black. Returns what `decode` returns.
pub(super) fn write_grey<R>(
    writer: impl Write,
    [width, height]: [u32; 2],
    decode: impl FnOnce(&mut Sink<'_>) -> R,
) -> std::io::Result<R> {
    let mut encoder = Encoder::new(writer, width, height);
    encoder.set_color(ColorType::Grayscale);
    encoder.set_depth(BitDepth::Eight);
    let mut png = encoder.write_header()?;
    let mut stream = png.stream_writer()?;
    let mut left = u64::from(width) * u64::from(height);
    let mut written = Ok(());
    let decoded = decode(&mut |grey, count| {
        left -= u64::from(count);
        if written.is_ok() {
            written = write_run(&mut stream, grey, count.into());
        }
    });
    written?;
    write_run(&mut stream, 0, left)?;
    stream.finish()?;
    Ok(decoded)
}

fn write_run(writer: &mut impl Write, grey: u8, mut count: u64) -> std::io::Result<()> {
    let bytes = [grey; 4096];
    while count > 0 {
        let step = count.min(bytes.len() as u64);
        writer.write_all(&bytes[..step as usize])?;
        count -= step;
    }
    Ok(())
}
