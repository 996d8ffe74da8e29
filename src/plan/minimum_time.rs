//! The shortest print by dynamic programming. The first layers of a print take the bottom exposure whatever their
//! thickness, so the cost of a layer depends on the number below it.

use super::optimal::{Stuck, Table, layers_above, tops};
use super::segment::{Segment, boundaries_below};
use super::snap_cost::{ByHeight, SnapCosts};
use crate::profile::{LayerErrors, Reach};
use crate::resin::Resin;

/// Number of bottom layers that are counted; any beyond them cost as much as layers above.
pub(crate) const MOST_BOTTOM_LAYERS: usize = 100;

/// Plans up to the planes of a segment, by the layers below.
struct Tables {
    /// Table j is of plans with j layers; the last is of those with as many as there are bottom layers, or more.
    by_layers: Vec<Table>,
    /// True if the top layer of a plan in the last table is the last bottom layer.
    is_last_bottom: Vec<bool>,
}

/// The boundaries of the shortest print within tolerance.
pub(super) fn quickest(
    errors: &LayerErrors,
    segments: &[Segment],
    snap_planes: &ByHeight,
    resin: &Resin,
    tolerance: u64,
) -> Result<Vec<u32>, Stuck> {
    let bottom = resin.bottom_layers.min(MOST_BOTTOM_LAYERS);
    let bottom_us = resin.bottom_layer_us();
    // The plans below the segment, by their layers: time, weight of missed snap planes, and maximum error.
    let mut starts = vec![None; bottom + 1];
    let mut boundaries = boundaries_below(segments);
    let below = boundaries.len() - 1;
    starts[below.min(bottom)] = Some([0; 3]);
    let mut filled: Vec<Tables> = Vec::with_capacity(segments.len());
    for (index, segment) in segments.iter().enumerate() {
        let unit_mm = f64::from(segment.unit) * errors.bins().size_mm;
        let times_us: Vec<u64> = (0..=*segment.thickness.end())
            .map(|units| resin.layer_us(f64::from(units) * unit_mm))
            .collect();
        // If there is a single start, all plans share the error below, which then need not be compared.
        if starts.iter().flatten().count() == 1 {
            for start in starts.iter_mut().flatten() {
                start[2] = 0;
            }
        }
        let mut tables = Tables::new(segment, &starts);
        let thinnest_us = times_us[*segment.thickness.start() as usize];
        let preferred = SnapCosts::within(segment, snap_planes, thinnest_us);
        tables.fill(errors, segment, &preferred, tolerance, bottom_us, &times_us);
        starts = tables.by_layers.iter().map(at_top).collect();
        let reached = tables.by_layers.iter().map(Table::highest_reached).max();
        filled.push(tables);
        if starts.iter().all(Option::is_none) {
            return Err(Stuck {
                segment: index,
                reached: reached.unwrap_or(0),
            });
        }
    }
    let ends = starts.iter().enumerate();
    let best = ends
        .filter_map(|(layers, end)| Some((end.as_ref()?, layers)))
        .min();
    let mut layers = best.map_or(0, |(_, layers)| layers);
    for (segment, tables) in segments.iter().zip(&filled).rev() {
        let mut plane = segment.units;
        while plane > 0 {
            boundaries.push(segment.boundary(plane));
            let is_bottom = layers < bottom || tables.is_last_bottom[plane as usize];
            plane = tables.by_layers[layers].below[plane as usize];
            layers -= usize::from(is_bottom);
        }
    }
    boundaries.sort_unstable();
    Ok(boundaries)
}

/// Time, weight and maximum error of the plan up to the top.
fn at_top(table: &Table) -> Option<[u64; 3]> {
    let top = table.cost.len() as u32 - 1;
    table.reaches_top().then(|| table.at(top))
}

impl Tables {
    fn new(segment: &Segment, starts: &[Option<[u64; 3]>]) -> Self {
        let mut by_layers = vec![Table::unreached(segment.units); starts.len()];
        for (table, start) in by_layers.iter_mut().zip(starts) {
            if let Some(start) = *start {
                table.improve(0, start, 0);
            }
        }
        Self {
            by_layers,
            is_last_bottom: vec![false; segment.units as usize + 1],
        }
    }

    fn fill(
        &mut self,
        errors: &LayerErrors,
        segment: &Segment,
        preferred: &SnapCosts,
        tolerance: u64,
        bottom_us: u64,
        times_us: &[u64],
    ) {
        let bottom = self.by_layers.len() - 1;
        for plane in 0..segment.units {
            for layers in 0..=bottom {
                let table = &self.by_layers[layers];
                let [time, missed, worst] = table.at(plane);
                if time == Table::NO_PLAN {
                    continue;
                }
                let is_bottom = layers < bottom;
                let above = &mut self.by_layers[layers + usize::from(is_bottom)];
                let mut layers_above = layers_above(errors, segment, plane, tolerance);
                for (thickness, top) in tops(segment, plane) {
                    let layer_us = if is_bottom {
                        bottom_us
                    } else {
                        times_us[thickness as usize]
                    };
                    let [price, weight] = preferred.within_layer(plane, top);
                    let found = [time + layer_us + price, missed + weight, worst];
                    if found >= above.at(top) {
                        continue;
                    }
                    let error = match layers_above.up_to(segment.boundary(top)) {
                        Reach::Within(error) => error,
                        Reach::Beyond => continue,
                        Reach::BeyondFromHere => break,
                    };
                    let found = [found[0], found[1], worst.max(error)];
                    // Each plane of the last table remembers which table its plan comes from.
                    if above.improve(top, found, plane) && layers + 1 >= bottom {
                        self.is_last_bottom[top as usize] = is_bottom;
                    }
                }
            }
        }
    }
}
