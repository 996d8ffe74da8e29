//! Encodes masks as PNG, at a cost proportional to the runs of equal pixels.

use super::runs::RunWriter;
use crate::mask::Run;

/// Bit depth of stored pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Depth {
    /// One bit per pixel.
    Bit,
    /// One byte per pixel, 255 if it is lit, as most printers' formats require.
    Grey,
    /// One byte per pixel, and three neighbours form one pixel of the image: red, green and blue. Rows are filled up with
    /// dark pixels.
    Thirds,
}

/// A mask as a greyscale PNG. The bytes depend on the mask alone.
///
/// Rows have no filter. Filters make more runs, not fewer; without one, the dark pixels around a model form one run that
/// continues from row to row.
pub fn encode(runs: impl Iterator<Item = Run>, pixels: [u32; 2], depth: Depth) -> Vec<u8> {
    let mut image = Image::new(pixels, depth);
    for run in runs {
        let (row, column) = (run.first / pixels[0], run.first % pixels[0]);
        match depth {
            Depth::Bit => image.light_bits(row, column..column + run.pixels),
            Depth::Grey | Depth::Thirds => image.light(row, column, run),
        }
    }
    wrap(pixels, depth, &image.finish())
}

/// The stream of an image. A byte before each row names its filter: 0 is none, so it looks like a dark byte.
struct Image {
    stream: RunWriter,
    /// Bytes of a row, with that of the filter.
    row_bytes: u64,
    bytes: u64,
    /// Bytes written so far.
    written: u64,
    /// The byte at `written`, if a run of bits ends within it.
    open: u8,
}

impl Image {
    fn new([width, height]: [u32; 2], depth: Depth) -> Self {
        let row_bytes = 1 + match depth {
            Depth::Bit => width.div_ceil(8),
            Depth::Grey => width,
            Depth::Thirds => width.next_multiple_of(3),
        };
        Self {
            stream: RunWriter::default(),
            row_bytes: u64::from(row_bytes),
            bytes: u64::from(row_bytes) * u64::from(height),
            written: 0,
            open: 0,
        }
    }

    /// Writes dark bytes up to a place in the stream.
    #[inline]
    fn darken_to(&mut self, place: u64) {
        if self.open > 0 && place > self.written {
            self.stream.run(self.open, 1);
            self.open = 0;
            self.written += 1;
        }
        self.stream.run(0, place - self.written);
        self.written = place;
    }

    fn light(&mut self, row: u32, column: u32, run: Run) {
        self.darken_to(u64::from(row) * self.row_bytes + 1 + u64::from(column));
        self.stream.run(run.grey, u64::from(run.pixels));
        self.written += u64::from(run.pixels);
    }

    fn light_bits(&mut self, row: u32, columns: std::ops::Range<u32>) {
        let first_byte = u64::from(row) * self.row_bytes + 1 + u64::from(columns.start / 8);
        self.darken_to(first_byte);
        // The bits from a column on, and those before it, in the byte of the column.
        let from = |column: u32| 0xffu8 >> (column % 8);
        let bytes = columns.end / 8 - columns.start / 8;
        if bytes == 0 {
            self.open |= from(columns.start) & !from(columns.end);
            return;
        }
        self.stream.run(self.open | from(columns.start), 1);
        self.stream.run(0xff, u64::from(bytes - 1));
        self.written += u64::from(bytes);
        self.open = !from(columns.end);
    }

    fn finish(mut self) -> Vec<u8> {
        self.darken_to(self.bytes);
        self.stream.finish()
    }
}

/// Wraps the zlib stream of an image of `width` × `height` pixels in a PNG file.
pub(super) fn wrap([width, height]: [u32; 2], depth: Depth, stream: &[u8]) -> Vec<u8> {
    const GREYSCALE: u8 = 0;
    const RGB: u8 = 2;
    let (width, bits, colour) = match depth {
        Depth::Bit => (width, 1, GREYSCALE),
        Depth::Grey => (width, 8, GREYSCALE),
        Depth::Thirds => (width.div_ceil(3), 8, RGB),
    };
    let mut header = [0; 13];
    header[..4].copy_from_slice(&width.to_be_bytes());
    header[4..8].copy_from_slice(&height.to_be_bytes());
    // Deflate, the standard filters, no interlacing.
    header[8..].copy_from_slice(&[bits, colour, 0, 0, 0]);
    // A pixel of three is three times as wide as high.
    let shape = [0, 0, 0, 1, 0, 0, 0, 3, 0];
    let shape = (depth == Depth::Thirds).then_some((b"pHYs", &shape[..]));
    let mut bytes = Vec::with_capacity(stream.len() + 96);
    bytes.extend(b"\x89PNG\r\n\x1a\n");
    let rest = [(b"IDAT", stream), (b"IEND", &[])];
    let chunks = std::iter::once((b"IHDR", &header[..]))
        .chain(shape)
        .chain(rest);
    for (kind, data) in chunks {
        bytes.extend((data.len() as u32).to_be_bytes());
        let first = bytes.len();
        bytes.extend(kind);
        bytes.extend(data);
        let crc = crate::crc::crc32(&bytes[first..]);
        bytes.extend(crc.to_be_bytes());
    }
    bytes
}
