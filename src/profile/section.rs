//! Areas of horizontal sections at the middle of each bin, sampled (eq. 13) or in closed form. The area and volume
//! deviations are computed from them.

use glam::{DVec2, DVec3};

use crate::grid::Bins;
use crate::ldi::{RayImage, Rays, model_ranges};
use crate::model::Mesh;
use crate::progress::{Cancelled, Progress};

/// The area of the section at the middle of each bin in mm²: the number of rays inside, times the area of a pixel
/// (eq. 13).
///
/// Cost: linear in rays, hits and bins.
///
/// # Errors
/// [`Cancelled`].
pub fn sampled(
    image: RayImage<'_>,
    bins: Bins,
    progress: &mut Progress<'_>,
) -> Result<Vec<f64>, Cancelled> {
    // Rays that enter minus rays that leave, between the middle of the bin below and that of this bin.
    let none = || vec![0i64; bins.count + 1];
    let add = |gains: &mut Vec<i64>, rays: Rays<'_>| {
        for hits in rays.each() {
            model_ranges(hits, rays.classes, |z_in, z_out| {
                gains[bins.middles_below(f64::from(z_in))] += 1;
                gains[bins.middles_below(f64::from(z_out))] -= 1;
            });
        }
    };
    let parts = image.fold(none, add, progress)?;
    let pixel_mm2 = image.grid().pixel_mm2();
    let mut lit = 0;
    let areas = (0..bins.count).map(|bin| {
        lit += parts.iter().map(|gains| gains[bin]).sum::<i64>();
        lit as f64 * pixel_mm2
    });
    Ok(areas.collect())
}

/// The area of the section at the middle of each bin in mm², from the facets: each adds a quadratic function of height
/// between its corners (Green's theorem).
///
/// Hidden facets are left out; an empty `hidden` hides none. Where bodies overlap without hiding whole facets, the
/// overlap counts once per body.
///
/// Cost: linear in facets times the logarithm of bins, and in bins.
pub fn exact(mesh: &Mesh, hidden: &[bool], bins: Bins) -> Vec<f64> {
    let mut sums = QuadraticSums::new(bins.count);
    for facet in 0..mesh.classes.model_end() as usize {
        if hidden.get(facet) == Some(&true) {
            continue;
        }
        let [a, b, c] = mesh.corners(facet);
        // The direction along the section in which the solid lies to the left of the facet.
        let normal = (b - a).cross(c - a);
        let [low, middle, high] = upward([a, b, c]);
        let first = bins.middles_below(low.z);
        let end = bins.middles_below(high.z);
        if first == end {
            continue;
        }
        let bend = bins.middles_below(middle.z);
        let long = Edge::new(low, high);
        let side = middle.truncate() - long.at(middle.z);
        let left = DVec2::new(-normal.y, normal.x);
        let sign = if side.dot(left) >= 0.0 { 0.5 } else { -0.5 };
        for (from, to, range) in [(low, middle, first..bend), (middle, high, bend..end)] {
            if range.is_empty() {
                continue;
            }
            let short = Edge::new(from, to);
            sums.add(range, |bin| {
                let z = bins.middle_mm(bin);
                let (p, q) = (long.at(z), short.at(z));
                let (dp, dq) = (long.slope * bins.size_mm, short.slope * bins.size_mm);
                [
                    sign * p.perp_dot(q),
                    sign * (p.perp_dot(dq) + dp.perp_dot(q)),
                    sign * dp.perp_dot(dq),
                ]
            });
        }
    }
    let mut areas = sums.into_values();
    for area in &mut areas {
        // Rounding may leave an empty section slightly negative.
        if *area < 0.0 {
            *area = 0.0;
        }
    }
    areas
}

/// Corners from the lowest up; of equal ones the first comes first.
fn upward([mut low, mut middle, mut high]: [DVec3; 3]) -> [DVec3; 3] {
    if middle.z < low.z {
        std::mem::swap(&mut low, &mut middle);
    }
    if high.z < middle.z {
        std::mem::swap(&mut middle, &mut high);
        if middle.z < low.z {
            std::mem::swap(&mut low, &mut middle);
        }
    }
    [low, middle, high]
}

/// An edge of a facet: its x and y as a function of height.
struct Edge {
    from: glam::DVec3,
    slope: DVec2,
}

impl Edge {
    fn new(from: glam::DVec3, to: glam::DVec3) -> Self {
        let rise = to.z - from.z;
        let run = to.truncate() - from.truncate();
        let slope = if rise > 0.0 { run / rise } else { DVec2::ZERO };
        Self { from, slope }
    }

    fn at(&self, z: f64) -> DVec2 {
        self.from.truncate() + self.slope * (z - self.from.z)
    }
}

/// Sums of quadratics over ranges of indices.
///
/// A range is cut into blocks of 2^k indices, at most two of each size. Each block keeps its sum as a quadratic of the
/// distance from its first index; in the end every block pushes its sum down to its halves. Nothing is ever subtracted,
/// so sums are as exact as their terms.
struct QuadraticSums {
    count: usize,
    /// Blocks as a binary tree: block 1 is the whole, blocks 2i and 2i + 1 are the halves of block i.
    blocks: Vec<[f64; 3]>,
}

impl QuadraticSums {
    fn new(count: usize) -> Self {
        Self {
            count,
            blocks: vec![[0.0; 3]; 2 * count.next_power_of_two()],
        }
    }

    /// Adds a quadratic to a range. `quadratic` gives its three coefficients relative to the first index of a block:
    /// value, linear and quadratic term per index.
    fn add(&mut self, range: std::ops::Range<usize>, quadratic: impl Fn(usize) -> [f64; 3]) {
        let leaves = self.blocks.len() / 2;
        let (mut low, mut high) = (range.start + leaves, range.end + leaves);
        let mut size = 1;
        while low < high {
            for block in [
                (low & 1 == 1).then_some(low),
                (high & 1 == 1).then(|| high - 1),
            ]
            .into_iter()
            .flatten()
            {
                let terms = quadratic(block * size - leaves);
                for (sum, term) in self.blocks[block].iter_mut().zip(terms) {
                    *sum += term;
                }
            }
            low = low.div_ceil(2);
            high /= 2;
            size *= 2;
        }
    }

    fn into_values(mut self) -> Vec<f64> {
        let leaves = self.blocks.len() / 2;
        let mut half = leaves / 2;
        for block in 1..leaves {
            if block.is_power_of_two() && block > 1 {
                half /= 2;
            }
            let [value, slope, curve] = self.blocks[block];
            let step = half as f64;
            let moved = [
                value + step * (slope + step * curve),
                slope + 2.0 * step * curve,
                curve,
            ];
            for (child, terms) in [(2 * block, [value, slope, curve]), (2 * block + 1, moved)] {
                for (sum, term) in self.blocks[child].iter_mut().zip(terms) {
                    *sum += term;
                }
            }
        }
        self.blocks[leaves..leaves + self.count]
            .iter()
            .map(|block| block[0])
            .collect()
    }
}
