//! Erosion and dilation of the lit stretches of a row of rays.

use std::ops::Range;

use super::compensated::Rows;
use crate::grid::Grid;

/// A lit stretch of a row of rays.
pub(super) type Stretch = Range<i32>;

/// A radius this close to a whole number of pixels, as a fraction of it, counts as whole.
const ROUNDING: f64 = 1e-9;

/// The rays of a disc: for each row from its middle, the number of columns on each side.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Disc {
    half_widths: Vec<i32>,
}

impl Disc {
    pub fn new(radius_mm: f64, grid: &Grid) -> Self {
        let radius_mm = radius_mm.abs() * (1.0 + ROUNDING);
        let rows = (radius_mm / grid.pitch_y_mm) as i32;
        let half_widths = (0..=rows).map(|row| {
            let y_mm = f64::from(row) * grid.pitch_y_mm;
            let x_mm = (radius_mm * radius_mm - y_mm * y_mm).max(0.0).sqrt();
            (x_mm / grid.pitch_mm) as i32
        });
        Self {
            half_widths: half_widths.collect(),
        }
    }

    /// Rows on each side of its middle.
    pub fn rows(&self) -> i32 {
        self.half_widths.len() as i32 - 1
    }

    /// Columns on each side of its middle line, in the row at this distance from the middle.
    pub fn half_width(&self, rows: i32) -> i32 {
        self.half_widths[rows as usize]
    }

    /// Returns true if it is its middle alone, so that nothing changes.
    fn is_point(&self) -> bool {
        self.half_widths == [0]
    }
}

/// The erosion or dilation of a layer.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Step {
    /// Distance on each side, in millimetres; negative for dilation.
    mm: f64,
    disc: Disc,
    /// The least width that erosion leaves, in columns and in rows.
    least: Option<[i32; 2]>,
    /// Sides of a pixel.
    pitch_mm: [f64; 2],
}

impl Step {
    /// Erosion by `mm` on each side, and leaves a least width; 0 for none.
    pub fn new(mm: f64, least_mm: f64, grid: &Grid) -> Self {
        let pitch_mm = [grid.pitch_mm, grid.pitch_y_mm];
        let pixels = |pitch_mm: f64| (least_mm / pitch_mm * (1.0 - ROUNDING)).ceil() as i32;
        Self {
            mm,
            disc: Disc::new(mm, grid),
            least: (least_mm > 0.0).then(|| pitch_mm.map(pixels)),
            pitch_mm,
        }
    }

    /// Rows on each side that decide about a row.
    pub fn reach(&self) -> i32 {
        let [_, narrow] = self.narrow().unwrap_or_default();
        narrow.max(self.disc.rows())
    }

    /// The number of columns and of rows from which on erosion leaves the least width anyway, if that holds.
    fn narrow(&self) -> Option<[i32; 2]> {
        let [columns, rows] = self.least.filter(|_| self.takes())?;
        let [across, along] = [self.disc.half_width(0), self.disc.rows()];
        Some([columns + 2 * across, rows + 2 * along])
    }

    fn grows(&self) -> bool {
        self.mm < 0.0
    }

    /// Returns true if it takes anything away.
    pub fn takes(&self) -> bool {
        !self.grows() && !self.disc.is_point()
    }

    /// The width that it takes away on each side, in millimetres.
    pub fn taken_mm(&self) -> f64 {
        self.mm.max(0.0)
    }

    /// A row of the result.
    pub fn row(&self, source: &Rows, row: i32, width: i32) -> Vec<Stretch> {
        if self.grows() {
            return grown(source, &self.disc, row, width);
        }
        let eroded = eroded(source, &self.disc, row);
        match (self.least, self.narrow()) {
            (Some(least), Some(narrow)) => {
                let kept = self.kept(source, row, &eroded, least, narrow);
                union(&eroded, kept.into_iter())
            }
            _ => eroded,
        }
    }

    /// The rest of a row that stays lit where it is narrow: the middle of it, as wide as the least width, across the direction in which it is
    /// narrower; along the other nothing is taken away.
    fn kept(
        &self,
        source: &Rows,
        row: i32,
        eroded: &[Stretch],
        least: [i32; 2],
        narrow: [i32; 2],
    ) -> Vec<Stretch> {
        let mut kept: Vec<Stretch> = Vec::new();
        for stretch in source.row(row) {
            let taken = without(std::slice::from_ref(stretch), eroded, 0);
            for column in taken.into_iter().flatten() {
                let in_row = [column - stretch.start, stretch.end - 1 - column];
                let in_column = [-1, 1].map(|step| {
                    let lit = (1..narrow[1]).take_while(|rows| {
                        let row = source.row(row + step * rows);
                        let at = row.partition_point(|it| it.end <= column);
                        row.get(at).is_some_and(|it| it.start <= column)
                    });
                    lit.count() as i32
                });
                if !self.keeps([in_row, in_column], least, narrow) {
                    continue;
                }
                match kept.last_mut() {
                    Some(last) if last.end == column => last.end += 1,
                    _ => kept.push(column..column + 1),
                }
            }
        }
        kept
    }

    /// Returns true if a ray stays lit, given how many are lit on either side of it in its row and in its column.
    fn keeps(&self, sides: [[i32; 2]; 2], least: [i32; 2], narrow: [i32; 2]) -> bool {
        let widths = sides.map(|[before, after]| before + 1 + after);
        let is_in_middle = |axis: usize| {
            let taken = (widths[axis] - least[axis]).max(0) / 2;
            sides[axis].iter().all(|&side| side >= taken)
        };
        let is_narrow = [0, 1].map(|axis| widths[axis] < narrow[axis]);
        let [x_mm, y_mm] = [0, 1].map(|axis| f64::from(widths[axis]) * self.pitch_mm[axis]);
        let across_x = is_narrow[0] && (!is_narrow[1] || x_mm <= y_mm);
        let across_y = is_narrow[1] && (!is_narrow[0] || y_mm <= x_mm);
        (across_x || across_y) && (!across_x || is_in_middle(0)) && (!across_y || is_in_middle(1))
    }
}

/// The rows of a disc around `row`, and the half width of each.
fn disc_rows(disc: &Disc, row: i32) -> impl Iterator<Item = (i32, i32)> {
    (-disc.rows()..=disc.rows())
        .map(move |step| (row + step, disc.half_widths[step.unsigned_abs() as usize]))
}

fn eroded(source: &Rows, disc: &Disc, row: i32) -> Vec<Stretch> {
    let mut result: Option<Vec<Stretch>> = None;
    for (row, half_width) in disc_rows(disc, row) {
        let shorter = source.row(row).iter().filter_map(|stretch| {
            let shorter = stretch.start + half_width..stretch.end - half_width;
            (!shorter.is_empty()).then_some(shorter)
        });
        let both = match &result {
            None => shorter.collect(),
            Some(before) => intersection(before, shorter),
        };
        if both.is_empty() {
            return both;
        }
        result = Some(both);
    }
    result.unwrap_or_default()
}

fn intersection(a: &[Stretch], b: impl Iterator<Item = Stretch>) -> Vec<Stretch> {
    let mut result = Vec::new();
    let mut first = 0;
    for stretch in b {
        while a.get(first).is_some_and(|it| it.end <= stretch.start) {
            first += 1;
        }
        for other in a[first..].iter().take_while(|it| it.start < stretch.end) {
            result.push(other.start.max(stretch.start)..other.end.min(stretch.end));
        }
    }
    result
}

fn grown(source: &Rows, disc: &Disc, row: i32, width: i32) -> Vec<Stretch> {
    let mut result = Vec::new();
    for (row, half_width) in disc_rows(disc, row) {
        let longer = source.row(row).iter().map(|stretch| {
            (stretch.start - half_width).max(0)..(stretch.end + half_width).min(width)
        });
        result = union(&result, longer);
    }
    result
}

/// The stretches less others, each of which is made longer on both sides.
pub(super) fn without(stretches: &[Stretch], others: &[Stretch], half_width: i32) -> Vec<Stretch> {
    let mut rest = Vec::with_capacity(stretches.len());
    let mut first = 0;
    for stretch in stretches {
        let mut start = stretch.start;
        while others
            .get(first)
            .is_some_and(|other| other.end + half_width <= start)
        {
            first += 1;
        }
        for other in &others[first..] {
            if other.start - half_width >= stretch.end {
                break;
            }
            if start < other.start - half_width {
                rest.push(start..other.start - half_width);
            }
            start = start.max(other.end + half_width);
        }
        if start < stretch.end {
            rest.push(start..stretch.end);
        }
    }
    rest
}

fn union(a: &[Stretch], b: impl Iterator<Item = Stretch>) -> Vec<Stretch> {
    let mut result: Vec<Stretch> = Vec::with_capacity(a.len() + 1);
    let mut add = |stretch: Stretch| match result.last_mut() {
        Some(last) if stretch.start <= last.end => last.end = last.end.max(stretch.end),
        _ => result.push(stretch),
    };
    let mut rest = a.iter().cloned().peekable();
    for stretch in b {
        while let Some(other) = rest.next_if(|other| other.start <= stretch.start) {
            add(other);
        }
        add(stretch);
    }
    rest.for_each(add);
    result
}
