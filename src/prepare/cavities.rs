//! Cavities that a model has before it is hollowed: hollows that no way leads out of.
//!
//! They are found in the columns: gaps between the height ranges of a column are connected to adjacent gaps, and a
//! group of gaps that is not connected to the outside is a cavity. A passage that is narrower than a column may be
//! missed.

use glam::Vec3;

use super::columns::Columns;
use crate::union_find::{find, unite};

/// A cavity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cavity {
    pub volume_mm3: f64,
    /// The middle of its highest gap, in columns, rows and millimetres.
    at: [f32; 3],
    gap_mm: f32,
}

/// The cavities of a solid.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cavities {
    pub all: Vec<Cavity>,
    /// For each range of the solid, the cavity below it.
    below: Vec<u32>,
}

/// No cavity: the gap is outside.
const NONE: u32 = u32::MAX;

impl Cavities {
    /// Finds them.
    ///
    /// Cost: nothing if no column has a gap; otherwise linear in ranges and columns.
    pub fn of(model: &Columns) -> Self {
        let columns = model.width * model.height;
        let mut found = Self {
            all: Vec::new(),
            below: Vec::new(),
        };
        if (0..columns).all(|column| model.ranges(column).len() < 2) {
            return found;
        }
        // A gap is known by the range above it, and the outside by a number of its own.
        let outside = model.count() as u32;
        let mut parent: Vec<u32> = (0..=outside).collect();
        for column in 0..columns {
            let (row, in_row) = (column / model.width, column % model.width);
            let before = [(in_row > 0, 1), (row > 0, model.width)];
            for (_, back) in before.into_iter().filter(|it| it.0) {
                for_each_meeting(model, [column - back, column], outside, |a, b| {
                    unite(&mut parent, a, b);
                });
            }
        }
        let mut place_of = vec![NONE; parent.len()];
        let beyond = find(&mut parent, outside);
        found.below = vec![NONE; model.count()];
        let pixel_mm2 = f64::from(model.pitch_mm) * f64::from(model.pitch_mm);
        for column in 0..columns {
            let first = model.first(column);
            for (pair, range) in model.ranges(column).windows(2).zip(first + 1..) {
                let root = find(&mut parent, range as u32);
                if root == beyond {
                    continue;
                }
                let gap_mm = pair[1][0] - pair[0][1];
                let middle_mm = pair[0][1] + gap_mm / 2.0;
                let place = &mut place_of[root as usize];
                if *place == NONE {
                    *place = found.all.len() as u32;
                    found.all.push(Cavity {
                        volume_mm3: 0.0,
                        at: [0.0; 3],
                        gap_mm: 0.0,
                    });
                }
                found.below[range] = *place;
                let cavity = &mut found.all[*place as usize];
                cavity.volume_mm3 += f64::from(gap_mm) * pixel_mm2;
                if gap_mm > cavity.gap_mm {
                    let (row, in_row) = (column / model.width, column % model.width);
                    cavity.gap_mm = gap_mm;
                    cavity.at = [in_row as f32, row as f32, middle_mm];
                }
            }
        }
        found
    }

    /// The solid with some cavities filled.
    pub fn filled(&self, model: &Columns, is_filled: &[bool]) -> Columns {
        if self.all.is_empty() {
            return model.clone();
        }
        model.with_ranges(|column, ranges| {
            let first = model.first(column);
            for (place, &[from_mm, to_mm]) in model.ranges(column).iter().enumerate() {
                match ranges.last_mut() {
                    Some(last) if place > 0 && self.is_one_of(first + place, is_filled) => {
                        last[1] = to_mm;
                    }
                    _ => ranges.push([from_mm, to_mm]),
                }
            }
        })
    }

    /// Some cavities, as a solid.
    pub fn as_solid(&self, model: &Columns, counts: &[bool]) -> Columns {
        model.with_ranges(|column, ranges| {
            let first = model.first(column);
            for (pair, range) in model.ranges(column).windows(2).zip(first + 1..) {
                if self.is_one_of(range, counts) {
                    ranges.push([pair[0][1], pair[1][0]]);
                }
            }
        })
    }

    /// For each cavity, true if it has a point in common with a solid of the same columns.
    pub fn that_meet(&self, model: &Columns, other: &Columns) -> Vec<bool> {
        let mut meets = vec![false; self.all.len()];
        for column in 0..model.width * model.height {
            let first = model.first(column);
            for (pair, range) in model.ranges(column).windows(2).zip(first + 1..) {
                let cavity = self.below[range];
                if cavity == NONE || meets[cavity as usize] {
                    continue;
                }
                let (low_mm, high_mm) = (pair[0][1], pair[1][0]);
                meets[cavity as usize] = other
                    .ranges(column)
                    .iter()
                    .any(|range| range[0] < high_mm && low_mm < range[1]);
            }
        }
        meets
    }

    fn is_one_of(&self, range: usize, those: &[bool]) -> bool {
        let cavity = self.below[range];
        cavity != NONE && those[cavity as usize]
    }
}

impl Cavity {
    /// A point in it, given where the first column is.
    pub fn at_mm(&self, corner_mm: Vec3, pitch_mm: f32) -> Vec3 {
        let [column, row, z_mm] = self.at;
        Vec3::new(
            corner_mm.x + column * pitch_mm,
            corner_mm.y - row * pitch_mm,
            z_mm,
        )
    }
}

/// Calls `emit` with each pair of gaps of two columns that have a height in common.
fn for_each_meeting(
    model: &Columns,
    columns: [usize; 2],
    outside: u32,
    mut emit: impl FnMut(u32, u32),
) {
    let ranges = columns.map(|column| model.ranges(column));
    let gap = |side: usize, place: usize| {
        let of = ranges[side];
        let low_mm = place
            .checked_sub(1)
            .map_or(f32::NEG_INFINITY, |it| of[it][1]);
        let high_mm = of.get(place).map_or(f32::INFINITY, |it| it[0]);
        let is_outside = place == 0 || place == of.len();
        let name = if is_outside {
            outside
        } else {
            (model.first(columns[side]) + place) as u32
        };
        ([low_mm, high_mm], name)
    };
    if ranges.iter().all(|of| of.len() < 2) {
        return;
    }
    let mut at = [0, 0];
    while at[0] <= ranges[0].len() && at[1] <= ranges[1].len() {
        let (a, of_a) = gap(0, at[0]);
        let (b, of_b) = gap(1, at[1]);
        if a[0] < b[1] && b[0] < a[1] {
            emit(of_a, of_b);
        }
        at[usize::from(b[1] < a[1])] += 1;
    }
}
