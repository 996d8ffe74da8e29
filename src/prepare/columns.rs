//! A solid as height ranges over a lattice of columns, and distances to it slice by slice.
//!
//! A column is a vertical line through the centre of a square of `pitch_mm`. Along columns heights are exact; from one column to the
//! next the solid is known to a column. So the distance to it, or to the outside, is found at most a pitch too long,
//! and half a pitch on average.
//!
//! Distances to the facets would not do: facets inside overlapping bodies are no surface, and the columns know the union.

use crate::ldi::{Ldi, model_ranges};
use crate::parallel;

/// Columns without any range on each side of a solid, so that all that is beyond them is outside.
pub(super) const MARGIN: usize = 1;

/// A distance that is longer than any that matters. Its square is finite in single precision.
const FAR_MM: f32 = 1e9;

/// Height ranges of each column, argsort and apart, row by row.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Columns {
    /// Columns of a row.
    pub width: usize,
    /// Rows, along y from the largest down.
    pub height: usize,
    pub pitch_mm: f32,
    /// The ranges of column i are those from `starts[i]` to `starts[i + 1]`.
    starts: Vec<u32>,
    ranges_mm: Vec<[f32; 2]>,
}

/// Target of distances.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum To {
    /// The solid.
    Solid,
    /// All that is not in the solid.
    Outside,
}

impl Columns {
    /// The model along the rays of an LDI with square pixels, without voids and supports.
    pub fn of_model(ldi: &Ldi) -> Self {
        let (width, height) = (ldi.grid.width as usize, ldi.grid.height as usize);
        let mut columns = Self {
            width: width + 2 * MARGIN,
            height: height + 2 * MARGIN,
            pitch_mm: ldi.grid.pitch_mm as f32,
            starts: vec![0],
            ranges_mm: Vec::new(),
        };
        for row in 0..columns.height {
            for column in 0..columns.width {
                let is_within = (MARGIN..MARGIN + height).contains(&row)
                    && (MARGIN..MARGIN + width).contains(&column);
                if is_within {
                    let ray = ldi.ray((row - MARGIN) * width + column - MARGIN);
                    let first = columns.ranges_mm.len();
                    model_ranges(ray, ldi.classes, |z_in, z_out| {
                        // Bodies that touch are one.
                        match columns.ranges_mm[first..].last_mut() {
                            Some(last) if z_in <= last[1] => last[1] = z_out,
                            _ => columns.ranges_mm.push([z_in, z_out]),
                        }
                    });
                }
                columns.starts.push(columns.ranges_mm.len() as u32);
            }
        }
        columns
    }

    /// The ranges of a column.
    pub fn ranges(&self, column: usize) -> &[[f32; 2]] {
        &self.ranges_mm[self.first(column)..self.first(column + 1)]
    }

    /// The place of a column's first range among all.
    pub fn first(&self, column: usize) -> usize {
        self.starts[column] as usize
    }

    /// Number of ranges of all columns.
    pub fn count(&self) -> usize {
        self.ranges_mm.len()
    }

    /// Columns of the same lattice with the ranges that `add` gives each: ascending and apart.
    pub fn with_ranges(&self, add: impl Fn(usize, &mut Vec<[f32; 2]>)) -> Self {
        let mut columns = Self {
            starts: vec![0],
            ranges_mm: Vec::new(),
            ..*self
        };
        let mut of_column = Vec::new();
        for column in 0..self.width * self.height {
            add(column, &mut of_column);
            columns.ranges_mm.append(&mut of_column);
            columns.starts.push(columns.ranges_mm.len() as u32);
        }
        columns
    }

    /// Columns of the same lattice with other ranges: the heights at which each column enters or leaves a solid, in ascending order for each
    /// column, whatever the order of columns.
    pub fn of_changes(&self, changes: &[(u32, f32)]) -> Self {
        let count = self.width * self.height;
        let mut starts = vec![0; count + 1];
        for &(column, _) in changes {
            starts[column as usize + 1] += 1;
        }
        for column in 0..count {
            starts[column + 1] += starts[column];
        }
        let mut next = starts.clone();
        let mut heights_mm = vec![0.0; changes.len()];
        for &(column, z_mm) in changes {
            let place = &mut next[column as usize];
            heights_mm[*place as usize] = z_mm;
            *place += 1;
        }
        // Each range that is entered is also left, so heights come in pairs.
        let (ranges_mm, _) = heights_mm.as_chunks::<2>();
        Self {
            starts: starts.into_iter().map(|start| start / 2).collect(),
            ranges_mm: ranges_mm.to_vec(),
            ..*self
        }
    }

    /// The lowest and the highest point of the solid; none of an empty one.
    pub fn extent_mm(&self) -> Option<[f32; 2]> {
        self.ranges_mm
            .iter()
            .copied()
            .reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }

    /// Returns true if a point is in the solid, by the column that it is nearest to, given in columns and rows.
    pub fn holds(&self, [column, row]: [f32; 2], z_mm: f32) -> bool {
        let (column, row) = (column + 0.5, row + 0.5);
        if !(column >= 0.0 && row >= 0.0) {
            return false;
        }
        let (column, row) = (column as usize, row as usize);
        if column >= self.width || row >= self.height {
            return false;
        }
        let column = row * self.width + column;
        let ranges = self.starts[column] as usize..self.starts[column + 1] as usize;
        self.ranges_mm[ranges]
            .iter()
            .any(|range| range[0] <= z_mm && z_mm < range[1])
    }

    /// The highest point of the solid that is below a height in a column.
    pub fn floor_mm(&self, column: usize, z_mm: f32) -> Option<f32> {
        let ranges = self.starts[column] as usize..self.starts[column + 1] as usize;
        let tops = self.ranges_mm[ranges].iter().map(|range| range[1]);
        tops.take_while(|&top_mm| top_mm <= z_mm).last()
    }

    /// The distances of the columns' points at some heights, each at every `stride`th column of every `stride`th row, beginning with the first.
    /// Those beyond `most_mm` may be anything larger.
    pub fn distances_mm(
        &self,
        to: To,
        heights_mm: &[f32],
        most_mm: f32,
        stride: usize,
    ) -> Vec<Vec<f32>> {
        parallel::map(heights_mm.to_vec(), |z_mm| {
            self.slice_mm(to, z_mm, most_mm, stride)
        })
    }

    fn slice_mm(&self, to: To, z_mm: f32, most_mm: f32, stride: usize) -> Vec<f32> {
        let (along, has_any) = self.along_z(to, z_mm);
        let reach = (most_mm / self.pitch_mm) as usize + 1;
        let squares: Vec<f32> = (0..=reach)
            .map(|step| {
                let away_mm = step as f32 * self.pitch_mm;
                away_mm * away_mm
            })
            .collect();
        // Beyond the columns all is outside.
        let beyond = match to {
            To::Solid => FAR_MM * FAR_MM,
            To::Outside => 0.0,
        };
        let width = self.width;
        let mut padded = vec![beyond; width + 2 * reach];
        let mut in_rows = vec![beyond; width * self.height];
        // A row that is outside as a whole stays so, and one that meets nothing is far from all.
        let rows = has_any.iter().enumerate();
        for (row, _) in rows.filter(|(_, has_any)| **has_any) {
            let of_row = row * width..(row + 1) * width;
            padded[reach..reach + width].copy_from_slice(&along[of_row.clone()]);
            let nearest = &mut in_rows[of_row];
            nearest.copy_from_slice(&padded[reach..reach + width]);
            for (step, &square) in squares.iter().enumerate().skip(1) {
                let (before, after) = (&padded[reach - step..], &padded[reach + step..]);
                for ((nearest, &before), &after) in nearest.iter_mut().zip(before).zip(after) {
                    *nearest = least(*nearest, least(before, after) + square);
                }
            }
        }
        let mut slice = Vec::with_capacity(width.div_ceil(stride) * self.height.div_ceil(stride));
        let mut nearest = vec![0.0; width];
        for row in (0..self.height).step_by(stride) {
            nearest.copy_from_slice(&in_rows[row * width..(row + 1) * width]);
            for (step, &square) in squares.iter().enumerate().skip(1) {
                for other in [row.checked_sub(step), Some(row + step)] {
                    let Some(other) = other.filter(|&it| it < self.height) else {
                        // Beyond the rows, where all is outside, or all is far.
                        for nearest in &mut nearest {
                            *nearest = least(*nearest, beyond + square);
                        }
                        continue;
                    };
                    let others = &in_rows[other * width..(other + 1) * width];
                    for (nearest, &other) in nearest.iter_mut().zip(others) {
                        *nearest = least(*nearest, other + square);
                    }
                }
            }
            slice.extend(nearest.iter().step_by(stride).map(|square| square.sqrt()));
        }
        slice
    }

    /// The squares of the distances within the columns, and the rows in which any differs from the space beyond the
    /// columns.
    fn along_z(&self, to: To, z_mm: f32) -> (Vec<f32>, Vec<bool>) {
        let mut squares = Vec::with_capacity(self.width * self.height);
        let mut has_any = vec![false; self.height];
        for (row, has_any) in has_any.iter_mut().enumerate() {
            for column in row * self.width..(row + 1) * self.width {
                let ranges = self.starts[column] as usize..self.starts[column + 1] as usize;
                let ranges = &self.ranges_mm[ranges];
                *has_any |= !ranges.is_empty();
                let distance_mm = match to {
                    To::Outside => ranges
                        .iter()
                        .find(|range| z_mm < range[1])
                        .map_or(0.0, |range| (z_mm - range[0]).min(range[1] - z_mm).max(0.0)),
                    To::Solid => ranges
                        .iter()
                        .map(|range| (range[0] - z_mm).max(z_mm - range[1]).max(0.0))
                        .fold(FAR_MM, f32::min),
                };
                squares.push(distance_mm * distance_mm);
            }
        }
        (squares, has_any)
    }
}

/// The smaller number. Unlike `f32::min` it does not handle NaN, and so compiles to one instruction for four numbers.
fn least(a: f32, b: f32) -> f32 {
    if b < a { b } else { a }
}
