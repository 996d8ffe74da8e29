//! Planes that a plan prefers, and the cost of omitting one.

use super::segment::Segment;
use crate::argsort::argsort;

/// Heights that deserve a plane.
#[derive(Debug, Clone, Copy)]
pub struct SnapPlanes<'a> {
    /// Boundaries of bins, the most important first.
    pub planes: &'a [u32],
    /// Cost of omitting one.
    pub price: Price,
}

/// Cost of omitting a snap plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Price {
    /// The cost of a layer, or the time of the thinnest one. If both cost the same, the plane is kept.
    Layer,
    /// Nothing: snap planes only choose among plans of the least cost.
    Nothing,
}

impl SnapPlanes<'_> {
    /// No snap planes.
    pub const NONE: Self = Self {
        planes: &[],
        price: Price::Nothing,
    };

    /// In the order in which segments meet them.
    pub(super) fn by_height(&self) -> ByHeight {
        let order = argsort(self.planes.iter().map(|&plane| f64::from(plane))).into_iter();
        ByHeight {
            planes: order.map(|rank| (self.planes[rank], rank as u64)).collect(),
            price: self.price,
        }
    }
}

/// Snap planes by height.
#[derive(Debug)]
pub(super) struct ByHeight {
    /// Boundaries of bins, each with how many are more important, in ascending order.
    planes: Vec<(u32, u64)>,
    price: Price,
}

impl ByHeight {
    /// The planes of a segment nearest to those within it, in ascending order, each with how many snap planes are more important.
    pub fn within(&self, segment: &Segment) -> impl Iterator<Item = (u32, u64)> {
        let (lower, upper) = (segment.lower, segment.upper() + segment.unit);
        let from = self
            .planes
            .partition_point(|(plane, _)| plane + segment.unit < lower);
        let near = self.planes[from..].iter();
        let near = near.take_while(move |&&(plane, _)| plane <= upper);
        near.filter_map(|&(plane, rank)| Some((segment.plane_within(plane)?, rank)))
    }
}

/// The snap planes within a segment.
#[derive(Debug, Clone, Default)]
pub struct SnapCosts {
    /// For each plane of the segment, the price and the weight of all snap planes from it upward; empty if there are none.
    from: Vec<[u64; 2]>,
}

impl SnapCosts {
    /// The snap planes within `segment`, each at this price. Of plans of the same cost the one that does without fewer is better; of
    /// those with as many, the one that keeps the more important.
    pub(super) fn within(segment: &Segment, snap_planes: &ByHeight, layer_price: u64) -> Self {
        let price = match snap_planes.price {
            Price::Layer => layer_price,
            Price::Nothing => 0,
        };
        let count = snap_planes.planes.len() as u64;
        let mut from = Vec::new();
        for (plane, rank) in snap_planes.within(segment) {
            if from.is_empty() {
                from = vec![[0; 2]; segment.units as usize + 1];
            }
            let slot: &mut [u64; 2] = &mut from[plane as usize];
            // Several may be rounded to the same step: the most important counts.
            *slot = [price, slot[1].max(count * count + count - rank)];
        }
        for plane in (1..from.len()).rev() {
            let above = from[plane];
            let below = &mut from[plane - 1];
            *below = [below[0] + above[0], below[1] + above[1]];
        }
        Self { from }
    }

    /// Returns true if there are none.
    pub(super) fn is_empty(&self) -> bool {
        self.from.is_empty()
    }

    /// Price and weight of the snap planes from `plane` upward.
    fn from(&self, plane: u32) -> [u64; 2] {
        self.from.get(plane as usize).copied().unwrap_or_default()
    }

    /// Price and weight of the snap planes above `plane`.
    pub(super) fn above(&self, plane: u32) -> [u64; 2] {
        self.from(plane + 1)
    }

    /// Price and weight of the snap planes that a layer passes over.
    pub(super) fn within_layer(&self, lower: u32, upper: u32) -> [u64; 2] {
        let (all, beyond) = (self.above(lower), self.from(upper));
        [all[0] - beyond[0], all[1] - beyond[1]]
    }

    /// Price and weight less those of the snap planes from `plane` upward.
    pub(super) fn below(&self, [price, weight]: [u64; 2], plane: u32) -> [u64; 2] {
        let beyond = self.from(plane);
        [price - beyond[0], weight - beyond[1]]
    }
}
