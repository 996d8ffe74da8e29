//! The print with cure below its layers: doses of all lit layers above a point add up.
//!
//! Doses are summed layer by layer, so no code is shared with the recurrences that masks and plans are made with. A grey pixel gets light in
//! proportion to its brightness.

use std::collections::BTreeMap;

use super::printed::Printed;
use crate::archive::read::Mask;
use crate::parallel;
use crate::resin::{PrintThrough, Resin};

/// Heights of cured bottoms are rounded to multiples of this.
const STEP_MM: f64 = 0.005;

/// Depth, in penetration depths, at which light counts as none.
const FAR: f64 = 30.0;

/// Columns of a row that become lit or dark, by heights in steps.
type Changes = BTreeMap<u64, Vec<u16>>;

/// Grey pixels of a layer, by their brightness.
pub(super) type Greys = Vec<(u8, Mask)>;

/// The print by the exposures of its layers, each as deep as it cures.
pub(super) fn cured(
    printed: Printed,
    greys: &[Greys],
    exposures_s: &[f64],
    resin: &Resin,
    print_through: &PrintThrough,
) -> Printed {
    let doses = Doses {
        planes_mm: &printed.z_mm,
        exposures_s,
        resin,
        print_through,
    };
    let rows: Vec<usize> = (0..printed.pixels[1] as usize).collect();
    let changes = parallel::map(rows, |row| of_row(&printed, greys, row as i32, &doses));
    let mut heights: Vec<u64> = changes.iter().flat_map(|it| it.keys().copied()).collect();
    heights.sort_unstable();
    heights.dedup();
    let mut lit: Vec<Vec<u16>> = vec![Vec::new(); changes.len()];
    let mut masks = Vec::with_capacity(heights.len());
    for height in &heights {
        for (lit, changes) in lit.iter_mut().zip(&changes) {
            for &column in changes.get(height).into_iter().flatten() {
                for side in [column, column + 1] {
                    match lit.binary_search(&side) {
                        Ok(place) => drop(lit.remove(place)),
                        Err(place) => lit.insert(place, side),
                    }
                }
            }
        }
        masks.push(Mask::of_rows(lit.iter().map(Vec::as_slice)));
    }
    // Nothing is lit above the last height.
    masks.pop();
    let z_mm = heights.iter().map(|&height| height as f64 * STEP_MM);
    printed.with_layers(z_mm.collect(), masks)
}

/// Doses of a print's layers.
struct Doses<'a> {
    planes_mm: &'a [f64],
    exposures_s: &'a [f64],
    resin: &'a Resin,
    print_through: &'a PrintThrough,
}

impl Doses<'_> {
    /// Dose of a layer at a height below its top, in critical doses.
    fn of(&self, layer: usize, z_mm: f64) -> f64 {
        let resin = self.resin;
        let reference_mm = resin.layer_mm + self.print_through.overcure_mm;
        let depth_mm = self.planes_mm[layer + 1] - z_mm;
        let part = self.exposures_s[layer] / resin.exposure_s(resin.layer_mm);
        part * ((reference_mm - depth_mm) / resin.penetration_mm).exp()
    }

    /// The same where the layer is grey.
    fn of_grey(&self, grey: u8, layer: usize, z_mm: f64) -> f64 {
        f64::from(grey) / f64::from(u8::MAX) * self.of(layer, z_mm)
    }

    /// The cured bottom of the lowest of a column's lit ranges, given with those above it, all from the highest down, and with the
    /// brightness of its grey layers.
    fn bottom_mm(&self, ranges: &[[usize; 2]], greys: &BTreeMap<usize, u8>) -> f64 {
        let Some(&[lowest, _]) = ranges.last() else {
            return 0.0;
        };
        let z_mm = self.planes_mm[lowest];
        if lowest == 0 {
            return z_mm;
        }
        let of = |layer| {
            let grey = greys.get(&layer).copied().unwrap_or(u8::MAX);
            self.of_grey(grey, layer, z_mm)
        };
        let own = of(lowest);
        let far_mm = z_mm + FAR * self.resin.penetration_mm;
        let layers = ranges.iter().rev().flat_map(|&[from, to]| from..to);
        let others = layers
            .skip(1)
            .take_while(|&layer| self.planes_mm[layer] < far_mm);
        let earlier: f64 = others.map(of).sum();
        let dose = own + self.print_through.retained * earlier;
        z_mm - self.resin.penetration_mm * dose.ln()
    }
}

/// Changes of the pixels of a row from dark to lit and back, by their heights.
fn of_row(printed: &Printed, greys: &[Greys], row: i32, doses: &Doses<'_>) -> Changes {
    let mut columns: BTreeMap<u16, Vec<[usize; 2]>> = BTreeMap::new();
    let mut below: &[u16] = &[];
    for layer in 0..=printed.layers() {
        let here = printed
            .masks
            .get(layer)
            .map_or(&[][..], |mask| mask.row(row));
        if here == below {
            continue;
        }
        let is_lit =
            |changes: &[u16], column: u16| changes.partition_point(|&it| it <= column) % 2 == 1;
        let ends = here.iter().chain(below);
        let (first, last) = (ends.clone().min(), ends.max());
        for column in first.copied().unwrap_or(0)..last.copied().unwrap_or(0) {
            match (is_lit(below, column), is_lit(here, column)) {
                (false, true) => columns.entry(column).or_default().push([layer, layer]),
                (true, false) => {
                    let ranges = columns.get_mut(&column);
                    if let Some(range) = ranges.and_then(|it| it.last_mut()) {
                        range[1] = layer;
                    }
                }
                _ => {}
            }
        }
        below = here;
    }
    let greys = greys_of_row(greys, row);
    let none = BTreeMap::new();
    for (&column, greys) in &greys {
        columns.insert(column, grey_ranges(printed, column, row, greys, doses));
    }
    let mut changes = Changes::new();
    for (column, mut ranges) in columns {
        let greys = greys.get(&column).unwrap_or(&none);
        ranges.reverse();
        // The height down to which the column is solid so far.
        let mut solid: Option<u64> = None;
        for place in 0..ranges.len() {
            let top = steps(doses.planes_mm[ranges[place][1]]);
            let bottom = steps(doses.bottom_mm(&ranges[..=place], greys).max(0.0));
            match solid {
                // Light closes the gap.
                Some(low) if low <= top => {}
                Some(low) => {
                    changes.entry(low).or_default().push(column);
                    changes.entry(top).or_default().push(column);
                }
                None => changes.entry(top).or_default().push(column),
            }
            solid = Some(solid.map_or(
                bottom,
                |low| if low <= top { low.min(bottom) } else { bottom },
            ));
        }
        if let Some(low) = solid {
            changes.entry(low).or_default().push(column);
        }
    }
    changes
}

/// Lit ranges of a column with grey pixels: layers that cure at the film, and the one below each range if it is lit at all.
fn grey_ranges(
    printed: &Printed,
    column: u16,
    row: i32,
    greys: &BTreeMap<usize, u8>,
    doses: &Doses<'_>,
) -> Vec<[usize; 2]> {
    let is_lit = |layer: usize| match greys.get(&layer) {
        Some(&grey) => doses.of_grey(grey, layer, doses.planes_mm[layer + 1]) >= 1.0,
        None => printed.masks[layer].is_lit(i32::from(column), row),
    };
    let mut ranges: Vec<[usize; 2]> = Vec::new();
    for layer in 0..printed.layers() {
        if !is_lit(layer) {
            continue;
        }
        match ranges.last_mut() {
            Some(last) if last[1] == layer => last[1] += 1,
            last => {
                let above = last.map_or(0, |last| last[1]);
                let begins_below = layer > above && greys.contains_key(&(layer - 1));
                ranges.push([layer - usize::from(begins_below), layer + 1]);
            }
        }
    }
    ranges
}

/// The brightness of grey pixels in a row, by columns and layers.
fn greys_of_row(greys: &[Greys], row: i32) -> BTreeMap<u16, BTreeMap<usize, u8>> {
    let mut of_columns: BTreeMap<u16, BTreeMap<usize, u8>> = BTreeMap::new();
    for (layer, greys) in greys.iter().enumerate() {
        for (grey, mask) in greys {
            for run in mask.row(row).chunks_exact(2) {
                for column in run[0]..run[1] {
                    of_columns.entry(column).or_default().insert(layer, *grey);
                }
            }
        }
    }
    of_columns
}

fn steps(z_mm: f64) -> u64 {
    (z_mm / STEP_MM).round() as u64
}
