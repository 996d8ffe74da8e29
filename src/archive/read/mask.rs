//! Masks as runs of lit pixels.

/// Grey pixels are lit from this brightness on, half of the full one.
pub(super) const HALF: u8 = 128;

/// Transformation from a stored mask to one seen from above, with x to the right and row 0 at the largest y.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Flips {
    /// True if columns are stored from right to left.
    pub mirror_x: bool,
    /// True if rows are stored from the smallest y to the largest.
    pub mirror_y: bool,
    /// True if, mirroring undone, columns are along y and rows along x.
    pub exchange: bool,
}

/// The lit pixels of a layer: for each row the columns at which the light changes, an even number of them in ascending
/// order. A row that starts lit begins with 0; one that ends lit ends with the number of columns.
///
/// Grey pixels are lit from half of full brightness on. Memory is proportional to the number of runs.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Mask {
    /// The first row with a lit pixel.
    first_row: u32,
    /// Start of each row in `columns`, from `first_row` to the last row with a lit pixel, and the end of that row.
    starts: Vec<u32>,
    columns: Vec<u16>,
}

impl Mask {
    /// A mask of these rows, the first of them row 0.
    pub fn of_rows<'a>(rows: impl Iterator<Item = &'a [u16]>) -> Self {
        let mut mask = Self::default();
        for (row, columns) in rows.enumerate() {
            mask.push(row as u32, columns);
        }
        mask
    }

    /// Adds a row below those before it.
    pub(super) fn push(&mut self, row: u32, columns: &[u16]) {
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

    /// Returns true if a pixel is lit. Pixels outside the mask are dark.
    pub fn is_lit(&self, column: i32, row: i32) -> bool {
        changes_up_to(self.row(row), column) & 1 == 1
    }

    /// Number of changes between dark and lit in all rows, which memory is proportional to.
    pub fn changes(&self) -> usize {
        self.columns.len()
    }

    /// One bit per pixel of a mask of this size, rows from the top, most significant bit first, ⌈width / 8⌉ bytes per row.
    pub fn bits(&self, width: u32, height: u32) -> Vec<u8> {
        let row_bytes = width.div_ceil(8) as usize;
        let mut bits = vec![0u8; row_bytes * height as usize];
        for (row, line) in bits.chunks_mut(row_bytes).enumerate() {
            for run in self.row(row as i32).chunks_exact(2) {
                let (first, end) = (usize::from(run[0]), usize::from(run[1]));
                let (head, tail) = (0xff >> (first % 8), !(0xff >> (end % 8)) as u8);
                if first / 8 == end / 8 {
                    line[first / 8] |= head & tail;
                    continue;
                }
                line[first / 8] |= head;
                line[first / 8 + 1..end / 8].fill(0xff);
                if tail != 0 {
                    line[end / 8] |= tail;
                }
            }
        }
        bits
    }

    pub(super) fn seen_from_above(self, [width, height]: [u32; 2], flips: Flips) -> Self {
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

/// Collects runs in raster order into a mask.
pub(super) struct Collector {
    width: u32,
    row: u32,
    column: u32,
    columns: Vec<u16>,
    mask: Mask,
}

impl Collector {
    /// A collector for rows of `width` pixels, of which there must not be more than 65,535.
    pub fn new(width: u32) -> Self {
        Self {
            width,
            row: 0,
            column: 0,
            columns: Vec::new(),
            mask: Mask::default(),
        }
    }

    pub fn run(&mut self, grey: u8, mut count: u32) {
        let is_lit = grey >= HALF;
        while count > 0 {
            if self.column == 0 && !is_lit {
                // Most of a mask is dark.
                self.row += count / self.width;
                count %= self.width;
            }
            let step = count.min(self.width - self.column);
            if is_lit {
                if self.columns.last() == Some(&(self.column as u16)) {
                    self.columns.pop();
                } else {
                    self.columns.push(self.column as u16);
                }
                self.columns.push((self.column + step) as u16);
            }
            self.column += step;
            count -= step;
            if self.column == self.width {
                self.end_row();
            }
        }
    }

    fn end_row(&mut self) {
        self.mask.push(self.row, &self.columns);
        self.columns.clear();
        self.row += 1;
        self.column = 0;
    }

    pub fn finish(mut self) -> Mask {
        self.end_row();
        self.mask
    }
}

/// The number of changes of a row at or before a column: odd if its pixel is lit.
pub fn changes_up_to(row: &[u16], column: i32) -> usize {
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
pub fn combine<'a>(
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
