//! Encodes masks as PNG, at a cost proportional to the runs of equal pixels.

use super::runs::RunWriter;
use crate::mask::{Light, MaskCursor, Masks, row_bytes};

/// How pixels are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Depth {
    /// One bit per pixel.
    Bit,
    /// One byte per pixel, 255 if it is lit, as most printers' formats require.
    Grey,
}

/// The mask at a cursor as a greyscale PNG. The bytes depend on the mask alone.
///
/// Rows have no filter. Filters make more runs, not fewer; without one, the dark pixels around a model form one run that
/// continues from row to row.
pub fn encode(masks: &Masks, mask: &MaskCursor, depth: Depth) -> Vec<u8> {
    let Masks {
        grid,
        window,
        samples,
        ..
    } = masks;
    // Bytes per eight pixels.
    let scale = match depth {
        Depth::Bit => 1,
        Depth::Grey => 8,
    };
    let row_length = match depth {
        Depth::Bit => row_bytes(grid),
        Depth::Grey => grid.width as usize,
    };
    let left = window.first_byte * scale;
    // The last byte of the window may have pixels beyond the mask.
    let inside = (window.row_bytes * scale).min(row_length - left);
    let right = row_length - left - inside;

    let mut stream = RunWriter::default();
    // A byte before each row names its filter: 0 is none.
    stream.run(0, ((1 + row_length) * window.first_row) as u64);
    match mask.light() {
        Light::Bits(bits) => {
            for row in bits.chunks(window.row_bytes) {
                stream.run(0, 1 + left as u64);
                match depth {
                    Depth::Bit => for_each_run(row, |byte, count| stream.run(byte, count)),
                    Depth::Grey => write_grey(&mut stream, row, inside as u64),
                }
                stream.run(0, right as u64);
            }
        }
        Light::Samples(lit) => {
            let total = samples.total();
            let greys: Vec<u8> = (0..=total)
                .map(|lit| ((255 * lit + total / 2) / total) as u8)
                .collect();
            for row in lit.chunks(window.row_pixels()) {
                stream.run(0, 1 + left as u64);
                for_each_run(&row[..inside], |lit, count| {
                    stream.run(greys[usize::from(lit)], count);
                });
                stream.run(0, right as u64);
            }
        }
    }
    let rows_below = grid.height as usize - window.first_row - window.rows;
    stream.run(0, ((1 + row_length) * rows_below) as u64);
    wrap([grid.width, grid.height], depth, &stream.finish())
}

/// Writes a row of bits as one byte per pixel, `room` pixels at most.
fn write_grey(stream: &mut RunWriter, row: &[u8], mut room: u64) {
    let mut grey = |value: u8, count: u64| {
        let count = count.min(room);
        room -= count;
        stream.run(value, count);
    };
    for_each_run(row, |byte, count| match byte {
        0 | 255 => grey(byte, 8 * count),
        _ => {
            for _ in 0..count {
                for bit in (0..8).rev() {
                    grey(if byte >> bit & 1 == 1 { 255 } else { 0 }, 1);
                }
            }
        }
    });
}

/// Calls `emit(byte, count)` for every run of equal bytes.
fn for_each_run(bytes: &[u8], mut emit: impl FnMut(u8, u64)) {
    const WORD: usize = 8;
    let mut first = 0;
    while first < bytes.len() {
        let byte = bytes[first];
        let rest = &bytes[first..];
        let words = rest.chunks_exact(WORD);
        let same = words.take_while(|&word| word == [byte; WORD]);
        let mut count = WORD * same.count();
        count += rest[count..]
            .iter()
            .take_while(|&&other| other == byte)
            .count();
        emit(byte, count as u64);
        first += count;
    }
}

/// Wraps the zlib stream of an image of `width` × `height` pixels in a PNG file.
pub(super) fn wrap([width, height]: [u32; 2], depth: Depth, stream: &[u8]) -> Vec<u8> {
    const GREYSCALE: u8 = 0;
    let bits = match depth {
        Depth::Bit => 1,
        Depth::Grey => 8,
    };
    let mut header = [0; 13];
    header[..4].copy_from_slice(&width.to_be_bytes());
    header[4..8].copy_from_slice(&height.to_be_bytes());
    // Deflate, the standard filters, no interlacing.
    header[8..].copy_from_slice(&[bits, GREYSCALE, 0, 0, 0]);
    let mut bytes = Vec::with_capacity(stream.len() + 64);
    bytes.extend(b"\x89PNG\r\n\x1a\n");
    for (kind, data) in [(b"IHDR", &header[..]), (b"IDAT", stream), (b"IEND", &[])] {
        bytes.extend((data.len() as u32).to_be_bytes());
        let first = bytes.len();
        bytes.extend(kind);
        bytes.extend(data);
        let crc = rawzip::crc32(&bytes[first..]);
        bytes.extend(crc.to_be_bytes());
    }
    bytes
}
