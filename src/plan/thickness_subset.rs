//! The best set of few layer thicknesses, by branch and bound.
//!
//! A node of the search is an ascending list of intervals of thicknesses, one for each member of the set. With every
//! thickness of every interval allowed, the fewest layers are a lower bound for all of the node's sets. The widest
//! interval is halved until each holds one thickness. The node of the least bound is always the next, so that bound
//! holds for all sets not tried, and the search is over when the best set known needs no more layers. Planes from which
//! even all thicknesses together would need too many layers are left out.
//!
//! Bounds count layers alone, in 32-bit integers and a block of planes at a time, which compilers turn into vector instructions: no
//! layer is thinner than a block, so the planes of one do not depend on each other.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::optimal::{layers_above, tops};
use super::segment::Segment;
use crate::grid::Bins;
use crate::profile::{LayerErrors, Reach};
use crate::progress::{Cancelled, Progress, report};

/// Number of times that a search reports its progress, if it takes all its steps.
const REPORTS: u64 = 250;

/// In place of a number of layers where there is no plan. Two of them can be added.
const NO_PLAN: i32 = 1 << 29;

/// An interval of places in the list of thicknesses, both ends included, for each member of a set.
type Node = Vec<(usize, usize)>;

/// A model as the search sees it.
pub(super) struct Search {
    bins: Bins,
    /// All thicknesses that layers may have in any segment, in units, argsort.
    thicknesses: Vec<u32>,
    parts: Vec<Part>,
    steps: u64,
    /// Layers up to each plane.
    layers: Vec<i32>,
}

/// A segment.
struct Part {
    /// The segment, with planes up to the highest at which a plan may end.
    segment: Segment,
    is_last: bool,
    /// For each thickness and plane, 1 if the layer of that thickness below the plane is within tolerance, and [`NO_PLAN`] if not.
    costs: Vec<Vec<i32>>,
    /// The fewest layers from each plane to an end, with all thicknesses.
    above: Vec<i32>,
}

impl Search {
    pub(super) fn new(errors: &LayerErrors, segments: &[Segment], tolerance: u64) -> Self {
        let bins = errors.bins();
        let mut thicknesses: Vec<u32> = segments
            .iter()
            .flat_map(|segment| {
                let tallest = segment
                    .units
                    .saturating_add(segment.units)
                    .saturating_add(1);
                *segment.thickness.start()..=tallest.min(*segment.thickness.end())
            })
            .collect();
        thicknesses.sort_unstable();
        thicknesses.dedup();
        let last = segments.len() - 1;
        let parts = segments.iter().enumerate().map(|(index, segment)| {
            Part::measure(errors, segment, index == last, &thicknesses, tolerance)
        });
        Self {
            bins,
            parts: parts.collect(),
            thicknesses,
            steps: 0,
            layers: Vec::new(),
        }
    }

    /// The best set of at most `count` thicknesses, argsort and in units, and a proven lower bound of the layers; `None` if none
    /// has a plan. It ends early after `most_steps`, but not before it has found a set.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub(super) fn run(
        mut self,
        count: usize,
        most_steps: u64,
        progress: &mut Progress<'_>,
    ) -> Result<Option<(Vec<u32>, usize)>, Cancelled> {
        if count == 0 || self.thicknesses.is_empty() {
            return Ok(None);
        }
        let (mut best, mut set) = self.descend(count);
        let mut least = NO_PLAN;
        let mut next_report = 0;
        // The least bound first; of equal ones the narrower node, which is nearer to a single set.
        let mut open = BinaryHeap::new();
        let root = vec![(0, self.thicknesses.len() - 1); count];
        let bound = self.bound(&root, best);
        open.push(Reverse((bound, width(&root), root)));
        while let Some(Reverse((bound, _, node))) = open.pop() {
            if self.steps >= next_report {
                report(progress, (self.steps as f64 / most_steps as f64).min(1.0))?;
                next_report = self.steps + most_steps / REPORTS;
            }
            let is_early = self.steps >= most_steps && best < NO_PLAN;
            if bound >= best || is_early {
                least = bound.min(best);
                break;
            }
            let Some(halves) = halves(&node) else {
                let places: Vec<usize> = node.iter().map(|interval| interval.0).collect();
                let found = self.evaluate(&places);
                if found < best {
                    (best, set) = (found, places);
                }
                continue;
            };
            for half in halves {
                let bound = self.bound(&half, best);
                if bound < best {
                    open.push(Reverse((bound, width(&half), half)));
                }
            }
        }
        if best >= NO_PLAN {
            return Ok(None);
        }
        let mut units: Vec<u32> = set.iter().map(|&place| self.thicknesses[place]).collect();
        units.sort_unstable();
        units.dedup();
        Ok(Some((units, least.min(best) as usize)))
    }

    /// A good set to begin with: one thickness after the other that helps most, then each exchanged for a better one while that
    /// helps.
    fn descend(&mut self, count: usize) -> (i32, Vec<usize>) {
        let mut set: Vec<usize> = Vec::new();
        let mut best = NO_PLAN;
        for member in 0..count.min(self.thicknesses.len()) {
            // Without a plan so far, the thinnest are the most likely to have one.
            set.push(if best < NO_PLAN { set[0] } else { member });
            self.exchange(&mut set, member, &mut best);
        }
        for _ in 0..4 {
            let before = best;
            for member in 0..set.len() {
                self.exchange(&mut set, member, &mut best);
            }
            if best == before {
                break;
            }
        }
        (best, set)
    }

    fn exchange(&mut self, set: &mut [usize], member: usize, best: &mut i32) {
        for place in 0..self.thicknesses.len() {
            let kept = std::mem::replace(&mut set[member], place);
            let node: Node = set.iter().map(|&place| (place, place)).collect();
            let found = match self.bound(&node, *best) {
                bound if bound < *best => self.evaluate(set),
                _ => NO_PLAN,
            };
            if found < *best {
                *best = found;
            } else {
                set[member] = kept;
            }
        }
    }

    /// A lower bound of the layers of all sets of a node; any number from `best` up if it is not below that.
    fn bound(&mut self, node: &[(usize, usize)], best: i32) -> i32 {
        let thinnest = node.iter().map(|interval| interval.1).min().unwrap_or(0);
        let allowed = union(node);
        self.fewest(&allowed, best, |this, part| {
            let ends = part.segment.ends(this.bins, this.thicknesses[thinnest]);
            let layers = ends.iter().filter_map(|&end| this.layers.get(end as usize));
            layers.copied().min().unwrap_or(NO_PLAN)
        })
    }

    /// The layers of the plan of a set.
    fn evaluate(&mut self, set: &[usize]) -> i32 {
        let node: Node = set.iter().map(|&place| (place, place)).collect();
        let thinnest = set.iter().copied().min().unwrap_or(0);
        self.fewest(&union(&node), i32::MAX, |this, part| {
            let ends = part.segment.ends(this.bins, this.thicknesses[thinnest]);
            let layers = ends.iter().filter_map(|&end| this.layers.get(end as usize));
            let mut reached = layers.copied().filter(|&layers| layers < NO_PLAN);
            reached.next().unwrap_or(NO_PLAN)
        })
    }

    /// The fewest layers of allowed thicknesses in all parts. `at_top` reads the number of the last part from [`Self::layers`].
    fn fewest(
        &mut self,
        allowed: &[usize],
        best: i32,
        at_top: impl Fn(&Self, &Part) -> i32,
    ) -> i32 {
        let parts = std::mem::take(&mut self.parts);
        // At first every part has its fewest layers with all thicknesses, then the parts that are filled have theirs.
        let mut total: i32 = parts.iter().fold(0, |sum, part| plus(sum, part.above[0]));
        for part in &parts {
            if total >= best || total >= NO_PLAN {
                break;
            }
            let others = total - part.above[0];
            part.fill(&self.thicknesses, allowed, best - others, &mut self.layers);
            self.steps += part.above.len() as u64 * allowed.len() as u64;
            let layers = if part.is_last {
                at_top(self, part)
            } else {
                self.layers[part.above.len() - 1]
            };
            total = plus(others, layers);
        }
        self.parts = parts;
        total
    }
}

/// A sum of layers, where no plan is.
fn plus(a: i32, b: i32) -> i32 {
    (a + b).min(NO_PLAN)
}

/// The places in any interval of a node, argsort.
fn union(node: &[(usize, usize)]) -> Vec<usize> {
    let mut places: Vec<usize> = node.iter().flat_map(|&(low, high)| low..=high).collect();
    places.sort_unstable();
    places.dedup();
    places
}

/// Total width of a node's intervals: thicknesses beyond the least of each.
fn width(node: &[(usize, usize)]) -> usize {
    node.iter().map(|&(low, high)| high - low).sum()
}

/// Halves the widest interval of a node: the sets whose member is in the lower half of it, and those where it is in the
/// upper; `None` if the node is a single set. Members ascend, so adjacent intervals shrink as well.
fn halves(node: &[(usize, usize)]) -> Option<[Node; 2]> {
    let width = |member: &usize| node[*member].1 - node[*member].0;
    let member = (0..node.len()).max_by_key(width)?;
    let (low, high) = node[member];
    if low == high {
        return None;
    }
    let middle = low + (high - low) / 2;
    let [mut lower, mut upper] = [node.to_vec(), node.to_vec()];
    for interval in &mut lower[..=member] {
        interval.1 = interval.1.min(middle);
    }
    for interval in &mut upper[member..] {
        interval.0 = interval.0.max(middle + 1);
    }
    Some([lower, upper])
}

impl Part {
    fn measure(
        errors: &LayerErrors,
        segment: &Segment,
        is_last: bool,
        thicknesses: &[u32],
        tolerance: u64,
    ) -> Self {
        let mut segment = segment.clone();
        let mut ends = vec![segment.units];
        if is_last {
            let thickest = thicknesses.last().copied().unwrap_or(1);
            ends = segment.ends(errors.bins(), thickest);
            segment.units = ends.iter().copied().max().unwrap_or(segment.units);
        }
        let planes = segment.units as usize + 1;
        let mut costs = vec![vec![NO_PLAN; planes]; thicknesses.len()];
        for plane in 0..segment.units {
            let mut layers = layers_above(errors, &segment, plane, tolerance);
            let first = thicknesses.partition_point(|t| t < segment.thickness.start());
            for (costs, (_, top)) in costs[first..].iter_mut().zip(tops(&segment, plane)) {
                match layers.up_to(segment.boundary(top)) {
                    Reach::Within(_) => costs[top as usize] = 1,
                    Reach::Beyond => {}
                    Reach::BeyondFromHere => break,
                }
            }
        }
        let mut above = vec![NO_PLAN; planes];
        for end in ends {
            above[end as usize] = 0;
        }
        for plane in (0..planes).rev() {
            for (costs, &thickness) in costs.iter().zip(thicknesses) {
                let top = plane + thickness as usize;
                if top < planes {
                    above[plane] = above[plane].min(plus(above[top], costs[top]));
                }
            }
        }
        Self {
            segment,
            is_last,
            costs,
            above,
        }
    }

    /// The fewest layers up to each plane with the allowed thicknesses; [`NO_PLAN`] where an end needs `best` or more.
    fn fill(&self, thicknesses: &[u32], allowed: &[usize], best: i32, layers: &mut Vec<i32>) {
        let planes = self.above.len();
        layers.clear();
        layers.resize(planes, NO_PLAN);
        layers[0] = 0;
        let (Some(&thinnest), Some(&thickest)) = (allowed.first(), allowed.last()) else {
            return;
        };
        let block = thicknesses[thinnest] as usize;
        let mut last_reached = 0;
        for start in (1..planes).step_by(block) {
            if start > last_reached + thicknesses[thickest] as usize {
                break;
            }
            let end = (start + block).min(planes);
            let (below, rest) = layers.split_at_mut(start);
            let filled = &mut rest[..end - start];
            for &place in allowed {
                let thickness = thicknesses[place] as usize;
                let first = start.max(thickness);
                if first >= end {
                    break;
                }
                let below = &below[first - thickness..end - thickness];
                let costs = &self.costs[place][first..end];
                let filled = &mut filled[first - start..];
                for ((layers, &below), &cost) in filled.iter_mut().zip(below).zip(costs) {
                    *layers = (*layers).min(below + cost);
                }
            }
            let mut is_reached = false;
            for (layers, &above) in filled.iter_mut().zip(&self.above[start..end]) {
                let is_useful = *layers + above < best.min(NO_PLAN);
                *layers = if is_useful { *layers } else { NO_PLAN };
                is_reached |= is_useful;
            }
            if is_reached {
                last_reached = end - 1;
            }
        }
    }
}
