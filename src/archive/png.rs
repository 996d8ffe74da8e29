//! A mask as a PNG, at a cost of the pixels where it changes.

use super::ArchiveError;
use super::runs::RunWriter;
use crate::mask::{MaskCursor, Masks, row_bytes};

/// How pixels are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Depth {
    /// One bit a pixel.
    Bit,
    /// A byte a pixel, 255 for a lit one: what most printers' own formats ask for.
    Grey,
}

/// Filter of a row that is written as it is. Dark rows and the dark pixels around a model make one run together with it.
const NONE: u8 = 0;
/// Filter of a row that is written as the difference from the one above.
const UP: u8 = 2;
/// About how many runs the filter of a row costs that is not [`NONE`].
const FILTER_COST: usize = 2;

/// The mask at a cursor as a greyscale PNG. The bytes depend on the mask alone.
///
/// # Errors
/// [`ArchiveError::Write`] if there is no memory.
pub fn encode(masks: &Masks, mask: &MaskCursor, depth: Depth) -> Result<Vec<u8>, ArchiveError> {
    let window = masks.window;
    // Bytes that a byte of the mask becomes.
    let scale = match depth {
        Depth::Bit => 1,
        Depth::Grey => 8,
    };
    let row_length = match depth {
        Depth::Bit => row_bytes(&masks.grid) as u64,
        Depth::Grey => u64::from(masks.grid.width),
    };
    let left = (window.first_byte * scale) as u64;
    let dark_row = 1 + row_length;
    let mut stream = RunWriter::default();
    stream.run(0, dark_row * window.first_row as u64);
    let dark = vec![0; window.row_bytes];
    let mut above = dark.as_slice();
    let mut buffer = Vec::with_capacity(window.row_bytes);
    for row in mask.bits().chunks(window.row_bytes) {
        // Pixels of the last byte beyond the mask do not exist.
        let inside = ((window.row_bytes * scale) as u64).min(row_length - left);
        let right = row_length - left - inside;
        let mut pixels = Pixels {
            stream: &mut stream,
            depth,
            room: inside,
        };
        if row == above && row != dark {
            pixels.stream.run(UP, 1);
            pixels.stream.run(0, row_length);
        } else if is_simpler_as_it_is(row, above) {
            pixels.stream.run(NONE, 1);
            pixels.stream.run(0, left);
            pixels.write(row);
            pixels.stream.run(0, right);
        } else {
            pixels.stream.run(UP, 1);
            pixels.stream.run(0, left);
            pixels.write_difference(row, above, &mut buffer);
            pixels.stream.run(0, right);
        }
        above = row;
    }
    let rows_below = masks.grid.height as usize - window.first_row - window.rows;
    stream.run(0, dark_row * rows_below as u64);
    let size = [masks.grid.width, masks.grid.height];
    wrap(size, depth, &stream.finish())
}

/// Whether a row has fewer runs than its difference from the one above.
fn is_simpler_as_it_is(row: &[u8], above: &[u8]) -> bool {
    differences(row, &row[1..]) <= 2 * differences(row, above) + FILTER_COST
}

/// How many bytes differ between the beginnings of two rows.
fn differences(row: &[u8], other: &[u8]) -> usize {
    // Counted in bytes, many at a time, as long as they cannot overflow.
    const BLOCK: usize = 128;
    let blocks = row.chunks(BLOCK).zip(other.chunks(BLOCK));
    blocks
        .map(|(row, other)| {
            let differing = row.iter().zip(other).map(|(a, b)| u8::from(a != b));
            usize::from(differing.sum::<u8>())
        })
        .sum()
}

/// The bytes of a row of pixels.
struct Pixels<'a> {
    stream: &'a mut RunWriter,
    depth: Depth,
    /// Bytes that the row still has room for.
    room: u64,
}

impl Pixels<'_> {
    /// Writes the row as it is.
    fn write(&mut self, row: &[u8]) {
        for_each_run(row, |byte, count, _| match self.depth {
            Depth::Bit => self.stream.run(byte, count as u64),
            Depth::Grey if byte == 0 || byte == 255 => self.grey(byte, 8 * count as u64),
            Depth::Grey => {
                for _ in 0..count {
                    for bit in (0..8).rev() {
                        self.grey(brightness(byte, bit), 1);
                    }
                }
            }
        });
    }

    /// Writes the row less the one above.
    fn write_difference(&mut self, row: &[u8], above: &[u8], buffer: &mut Vec<u8>) {
        buffer.clear();
        if self.depth == Depth::Bit {
            buffer.extend(row.iter().zip(above).map(|(a, b)| a.wrapping_sub(*b)));
            for_each_run(buffer, |byte, count, _| self.stream.run(byte, count as u64));
            return;
        }
        buffer.extend(row.iter().zip(above).map(|(a, b)| a ^ b));
        for_each_run(buffer, |changed, count, first| {
            if changed == 0 {
                return self.grey(0, 8 * count as u64);
            }
            for place in first..first + count {
                for bit in (0..8).rev() {
                    let [now, before] = [row, above].map(|row| brightness(row[place], bit));
                    self.grey(now.wrapping_sub(before), 1);
                }
            }
        });
    }

    fn grey(&mut self, value: u8, count: u64) {
        let count = count.min(self.room);
        self.room -= count;
        self.stream.run(value, count);
    }
}

/// The grey of a pixel, by its bit.
fn brightness(bits: u8, bit: u32) -> u8 {
    if bits >> bit & 1 == 1 { 255 } else { 0 }
}

/// Calls `emit` with every run of equal bytes: the byte, how many there are, and where the first is.
fn for_each_run(bytes: &[u8], mut emit: impl FnMut(u8, usize, usize)) {
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
        emit(byte, count, first);
        first += count;
    }
}

/// The chunks around a zlib stream of so many columns and rows.
pub(super) fn wrap(
    [width, height]: [u32; 2],
    depth: Depth,
    stream: &[u8],
) -> Result<Vec<u8>, ArchiveError> {
    let mut bytes = Vec::with_capacity(stream.len() + 64);
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(match depth {
        Depth::Bit => png::BitDepth::One,
        Depth::Grey => png::BitDepth::Eight,
    });
    let mut writer = encoder.write_header().map_err(ArchiveError::write)?;
    let data = png::chunk::IDAT;
    writer
        .write_chunk(data, stream)
        .map_err(ArchiveError::write)?;
    writer.finish().map_err(ArchiveError::write)?;
    Ok(bytes)
}
