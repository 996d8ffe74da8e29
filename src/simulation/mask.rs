//! Masks as runs of lit pixels.

use std::io::Cursor;

use png::{BitDepth, ColorType, Decoder, DecodingError, Transformations};

use super::SimulationError;

/// How a stored mask becomes one seen from above, with x to the right and row 0 at the largest y.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Flips {
    /// Whether columns are stored from right to left.
    pub mirror_x: bool,
    /// Whether rows are stored from the smallest y to the largest.
    pub mirror_y: bool,
    /// Whether, mirroring undone, columns are along y and rows along x.
    pub exchange: bool,
}

/// The lit pixels of a layer: for each row the columns at which the light changes, an even number of them in ascending
/// order. A row that starts lit begins with 0; one that ends lit ends with the number of columns.
///
/// Grey pixels are lit from half of full brightness on. Memory is proportional to the number of runs.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Mask {
    /// The first row with a lit pixel.
    first_row: u32,
    /// Where each row begins in `columns`, from `first_row` to the last row with a lit pixel, and the end of that row.
    starts: Vec<u32>,
    columns: Vec<u16>,
}

impl Mask {
    /// Decodes a PNG of this many columns and rows, as stored.
    pub fn read(
        png: &[u8],
        pixels: [u32; 2],
        flips: Flips,
        name: &str,
    ) -> Result<Self, SimulationError> {
        let rows = read_rows(png, pixels).map_err(|error| match error {
            RowsError::Size([width, height]) => SimulationError::MaskSize {
                name: name.to_owned(),
                width,
                height,
                columns: pixels[0],
                rows: pixels[1],
            },
            RowsError::Png(error) => SimulationError::BadFile {
                name: name.to_owned(),
                system: error.to_string(),
            },
        })?;
        Ok(rows.seen_from_above(pixels, flips))
    }

    /// A mask of these rows, the first of them row 0.
    pub fn of_rows<'a>(rows: impl Iterator<Item = &'a [u16]>) -> Self {
        let mut mask = Self::default();
        for (row, columns) in rows.enumerate() {
            mask.push(row as u32, columns);
        }
        mask
    }

    /// Adds a row below those before it.
    fn push(&mut self, row: u32, columns: &[u16]) {
        if columns.is_empty() {
            return;
        }
        if self.starts.is_empty() {
            self.first_row = row;
            self.starts.push(0);
        }
        // Rows without light between the last row and this one.
        let rows = (row - self.first_row) as usize;
        self.starts.resize(rows + 1, self.columns.len() as u32);
        self.columns.extend_from_slice(columns);
        self.starts.push(self.columns.len() as u32);
    }

    /// The rows from the first to the last with a lit pixel; empty if there is none.
    pub fn rows(&self) -> std::ops::Range<i32> {
        let first = self.first_row as i32;
        first..first + self.starts.len().saturating_sub(1) as i32
    }

    /// The columns at which a row changes between dark and lit. Rows outside the mask are dark.
    pub fn row(&self, row: i32) -> &[u16] {
        let place = row.wrapping_sub(self.first_row as i32) as usize;
        match (
            self.starts.get(place),
            self.starts.get(place.wrapping_add(1)),
        ) {
            (Some(&start), Some(&end)) => &self.columns[start as usize..end as usize],
            _ => &[],
        }
    }

    /// Whether a pixel is lit. Pixels outside the mask are dark.
    pub fn is_lit(&self, column: i32, row: i32) -> bool {
        changes_up_to(self.row(row), column) & 1 == 1
    }

    fn seen_from_above(self, [width, height]: [u32; 2], flips: Flips) -> Self {
        if flips == Flips::default() {
            return self;
        }
        let rows: Vec<Vec<u16>> = (0..height as i32)
            .map(|row| {
                let stored = if flips.mirror_y {
                    height as i32 - 1 - row
                } else {
                    row
                };
                let columns = self.row(stored).iter().copied();
                if flips.mirror_x {
                    columns.rev().map(|column| width as u16 - column).collect()
                } else {
                    columns.collect()
                }
            })
            .collect();
        if flips.exchange {
            Self::of_rows(exchanged(&rows, width).iter().map(Vec::as_slice))
        } else {
            Self::of_rows(rows.iter().map(Vec::as_slice))
        }
    }
}

/// The number of changes of a row at or before a column: odd if its pixel is lit.
pub(super) fn changes_up_to(row: &[u16], column: i32) -> usize {
    if row.len() <= 8 {
        row.iter()
            .take_while(|&&change| i32::from(change) <= column)
            .count()
    } else {
        row.partition_point(|&change| i32::from(change) <= column)
    }
}

/// Rows whose columns are along y and whose rows are along x, largest first, as columns along x: new row r is the old
/// column `width` - 1 - r, read from the last row to the first.
fn exchanged(rows: &[Vec<u16>], width: u32) -> Vec<Vec<u16>> {
    let mut turned = vec![Vec::new(); width as usize];
    let mut before: &[u16] = &[];
    for (column, row) in rows
        .iter()
        .rev()
        .map(Vec::as_slice)
        .chain([&[][..]])
        .enumerate()
    {
        let changed = combine(before, row, |before, after| before != after);
        for (from, to) in changed {
            for old in from..to {
                turned[(width - 1 - u32::from(old)) as usize].push(column as u16);
            }
        }
        before = row;
    }
    turned
}

/// The runs of columns in which `is` holds of two rows. It must not hold of two dark pixels.
pub(super) fn combine<'a>(
    a: &'a [u16],
    b: &'a [u16],
    is: impl Fn(bool, bool) -> bool + 'a,
) -> impl Iterator<Item = (u16, u16)> + 'a {
    let (mut i, mut j, mut start) = (0, 0, None);
    std::iter::from_fn(move || {
        loop {
            let column = match (a.get(i), b.get(j)) {
                (None, None) => return None,
                (Some(&x), None) => x,
                (None, Some(&y)) => y,
                (Some(&x), Some(&y)) => x.min(y),
            };
            i += usize::from(a.get(i) == Some(&column));
            j += usize::from(b.get(j) == Some(&column));
            match (start, is(i & 1 == 1, j & 1 == 1)) {
                (None, true) => start = Some(column),
                (Some(from), false) => {
                    start = None;
                    return Some((from, column));
                }
                _ => {}
            }
        }
    })
}

enum RowsError {
    Size([u32; 2]),
    Png(DecodingError),
}

impl From<DecodingError> for RowsError {
    fn from(error: DecodingError) -> Self {
        Self::Png(error)
    }
}

fn read_rows(png: &[u8], pixels: [u32; 2]) -> Result<Mask, RowsError> {
    let mut decoder = Decoder::new(Cursor::new(png));
    let info = decoder.read_header_info()?;
    if [info.width, info.height] != pixels {
        return Err(RowsError::Size([info.width, info.height]));
    }
    let is_bits = (info.color_type, info.bit_depth) == (ColorType::Grayscale, BitDepth::One);
    let is_interlaced = info.interlaced;
    if !is_bits {
        decoder.set_transformations(Transformations::normalize_to_color8());
    }
    let mut reader = decoder.read_info()?;
    let (width, samples) = (pixels[0] as usize, reader.output_color_type().0.samples());
    let mut mask = Mask::default();
    let mut columns = Vec::new();
    let mut scan = |row: u32, bytes: &[u8]| {
        columns.clear();
        if is_bits {
            scan_bits(bytes, width, &mut columns);
        } else {
            scan_samples(bytes, samples, width, &mut columns);
        }
        mask.push(row, &columns);
    };
    if is_interlaced {
        // Rows arrive in several passes.
        let mut frame = vec![0; reader.output_buffer_size().unwrap_or_default()];
        let line = reader.next_frame(&mut frame)?.line_size;
        for (row, bytes) in frame.chunks(line).enumerate() {
            scan(row as u32, bytes);
        }
    } else {
        let mut row = 0;
        while let Some(bytes) = reader.next_row()? {
            scan(row, bytes.data());
            row += 1;
        }
    }
    Ok(mask)
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

/// Finds the changes of a row of 8-bit samples. A pixel is lit if one of its colours is half as bright as can be.
fn scan_samples(bytes: &[u8], samples: usize, width: usize, columns: &mut Vec<u16>) {
    const HALF: u8 = 128;
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
        // An alpha channel, the last of two or four, is no colour.
        let colours = if samples == 2 { 1 } else { 3 };
        for (column, pixel) in bytes.chunks_exact(samples).take(width).enumerate() {
            change(column, pixel[..colours].iter().any(|&byte| byte >= HALF));
        }
    }
    if columns.len() % 2 == 1 {
        columns.push(width as u16);
    }
}
