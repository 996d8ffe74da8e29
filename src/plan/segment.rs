//! Mandatory planes, and the segments between them, which planners fill one by one (section 3.3).

use std::ops::RangeInclusive;

use super::{Limits, PlanError};
use crate::argsort::{argsort, sort_by_number};
use crate::grid::Bins;

/// A height range between two mandatory planes, to be filled with layers.
///
/// Heights in it are in units of `unit` bins: plane p of the segment is at boundary `lower + p · unit`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Segment {
    /// The plane below, as a boundary of bins.
    pub lower: u32,
    /// Height in units.
    pub units: u32,
    /// Bins per unit.
    pub unit: u32,
    /// Minimum and maximum layer thickness in units.
    pub thickness: RangeInclusive<u32>,
}

impl Segment {
    /// The boundary of bins at plane `p`, from 0 to [`Self::units`].
    pub fn boundary(&self, p: u32) -> u32 {
        self.lower + p * self.unit
    }

    /// The plane above, as a boundary of bins.
    pub fn upper(&self) -> u32 {
        self.boundary(self.units)
    }

    /// The plane nearest to a boundary of bins, if that is between the planes below and above.
    pub(super) fn plane_within(&self, boundary: u32) -> Option<u32> {
        let above = (boundary + self.unit / 2).checked_sub(self.lower)?;
        let plane = above / self.unit;
        (plane > 0 && plane < self.units).then_some(plane)
    }

    /// The planes of the highest segment at which layers of few thicknesses may end, of which `least` is the least: the nearest to the
    /// model's top first, the lower of two equally near. None is farther from it than half of `least`, or half the minimum thickness
    /// of the segment if that is more.
    pub(super) fn ends(&self, bins: Bins, least: u32) -> Vec<u32> {
        let top = bins.count as u64;
        let height = top - top.min(u64::from(self.lower));
        let unit = u64::from(self.unit);
        let reach = unit * u64::from(least.clamp(*self.thickness.start(), *self.thickness.end()));
        let lowest = height.saturating_sub(reach / 2).div_ceil(unit).max(1);
        let highest = (height + reach / 2) / unit;
        let mut ends: Vec<u64> = (lowest..=highest)
            // The middle of the last layer, where its mask is sampled, lies below the model's top.
            .filter(|end| 2 * (end * unit) < 2 * height + reach)
            .collect();
        sort_by_number(&mut ends, |end| (end * unit).abs_diff(height) as f64);
        ends.into_iter().map(|end| end as u32).collect()
    }

    /// Returns true if layers within the thickness range can add up to `units`.
    pub fn can_fill(&self, units: u32) -> bool {
        let fewest = units.div_ceil(*self.thickness.end());
        u64::from(fewest) * u64::from(*self.thickness.start()) <= u64::from(units)
    }
}

/// The boundaries of a plan below its segments: the plate, and the top of the first layer if that is fixed.
pub(super) fn boundaries_below(segments: &[Segment]) -> Vec<u32> {
    let lowest = segments.first().map_or(0, |segment| segment.lower);
    let mut boundaries = vec![0, lowest];
    boundaries.dedup();
    boundaries
}

/// The segments of a plan, and the snap planes between them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Segments {
    /// Segments from the plate, or from the top of a fixed first layer, upward.
    pub segments: Vec<Segment>,
    /// The snap planes that are kept, as boundaries of bins in ascending order.
    pub snap_planes: Vec<u32>,
}

impl Segments {
    /// Lays out the segments of a model of `bins`.
    ///
    /// Mandatory planes are the plate, the top of a fixed first layer, the ends of height ranges and
    /// [`Limits::planes_mm`]. Snap planes are added in their order, unless layers could no longer fill the segments on
    /// either side; planners that choose their own pass none.
    ///
    /// The top moves to the nearest height that layers add up to, the lower one of two equally near. It moves by less
    /// than half the minimum thickness. Snap planes do not affect it.
    ///
    /// # Errors
    /// [`PlanError`] if the limits are contradictory, or if no layers fit between two mandatory planes.
    pub fn new(bins: Bins, limits: &Limits, snap_planes: &[u32]) -> Result<Self, PlanError> {
        let layout = Layout::new(bins, limits)?;
        let mut planes = layout.demanded_planes(limits)?;
        let top = layout.top(planes[planes.len() - 1])?;
        // The mandatory planes alone may leave a gap that no layers fill.
        for segment in &layout.segments(&planes, top) {
            if !segment.can_fill(segment.units) {
                return Err(layout.do_not_fit(segment));
            }
        }
        let mut kept = Vec::new();
        for &snap_plane in snap_planes {
            let plane = layout.round(snap_plane);
            let Err(place) = planes.binary_search(&plane) else {
                continue;
            };
            if plane >= top || place == 0 {
                continue;
            }
            // Only the two segments adjacent to the new plane change.
            let above = planes.get(place).copied().unwrap_or(top);
            let beside = layout.segments(&[planes[place - 1], plane], above);
            if beside.iter().all(|segment| segment.can_fill(segment.units)) {
                planes.insert(place, plane);
                kept.push(plane);
            }
        }
        kept.sort_unstable();
        Ok(Self {
            segments: layout.segments(&planes, top),
            snap_planes: kept,
        })
    }
}

/// The limits in bins and units.
struct Layout {
    bins: Bins,
    unit: u32,
    /// Top of the first layer, if it is fixed; 0 otherwise.
    first_layer: u32,
    /// Layer thickness in units, outside the height ranges.
    thickness: RangeInclusive<u32>,
    /// Height ranges in ascending order: first and last boundary, and layer thickness in units.
    ranges: Vec<(u32, u32, RangeInclusive<u32>)>,
}

impl Layout {
    fn new(bins: Bins, limits: &Limits) -> Result<Self, PlanError> {
        let unit = limits.unit(bins)?;
        let thickness = limits.thickness(bins, limits.layer_min_mm, limits.layer_max_mm)?;
        let mut layout = Self {
            bins,
            unit,
            first_layer: limits.first_layer(bins)?,
            thickness,
            ranges: Vec::new(),
        };
        for place in argsort(limits.ranges.iter().map(|range| range.from_mm)) {
            let range = &limits.ranges[place];
            let (from_mm, to_mm) = (range.from_mm, range.to_mm);
            let is_ordered = from_mm >= 0.0 && to_mm > from_mm;
            let ends = [from_mm, to_mm].map(|z_mm| layout.plane_at(z_mm));
            let is_free = layout.ranges.last().is_none_or(|below| below.1 <= ends[0]);
            if !is_ordered || !is_free || ends[0] == ends[1] {
                return Err(PlanError::BadRange { from_mm, to_mm });
            }
            let thickness = limits.thickness(bins, range.layer_min_mm, range.layer_max_mm)?;
            layout.ranges.push((ends[0], ends[1], thickness));
        }
        Ok(layout)
    }

    /// The nearest boundary that is a whole number of units above the plate.
    fn round(&self, boundary: u32) -> u32 {
        (boundary + self.unit / 2) / self.unit * self.unit
    }

    fn plane_at(&self, z_mm: f64) -> u32 {
        // Clamped far above any model, to avoid overflow.
        let units = z_mm / self.bins.size_mm / f64::from(self.unit) + 0.5;
        units.clamp(0.0, f64::from(u32::MAX / 2 / self.unit)) as u32 * self.unit
    }

    /// The mandatory planes below the top, in ascending order: the plate or the top of a fixed first layer, the ends of ranges,
    /// and the planes that the limits name.
    fn demanded_planes(&self, limits: &Limits) -> Result<Vec<u32>, PlanError> {
        let top = self.bins.count as u32;
        let lowest = self.first_layer;
        if lowest >= top {
            return Err(PlanError::LayerTooThick {
                layer_mm: self.bins.boundary_mm(lowest),
                height_mm: self.bins.boundary_mm(top),
            });
        }
        let mut planes = vec![lowest];
        for &(from, to, _) in &self.ranges {
            planes.extend([from, to]);
        }
        planes.retain(|plane| (lowest..top).contains(plane));
        for &z_mm in &limits.planes_mm {
            let plane = self.plane_at(z_mm);
            // A NaN casts to plane 0.
            if z_mm <= 0.0 || plane == 0 || plane > top {
                let height_mm = self.bins.boundary_mm(top);
                return Err(PlanError::BadPlane { z_mm, height_mm });
            }
            if plane < lowest {
                return Err(self.do_not_fit(&Segment {
                    lower: 0,
                    units: plane / self.unit,
                    unit: self.unit,
                    thickness: lowest / self.unit..=lowest / self.unit,
                }));
            }
            if plane < top {
                planes.push(plane);
            }
        }
        planes.sort_unstable();
        planes.dedup();
        Ok(planes)
    }

    fn thickness_above(&self, plane: u32) -> RangeInclusive<u32> {
        let begun = self.ranges.partition_point(|range| range.0 <= plane);
        let range = self.ranges[..begun].last();
        let range = range.filter(|range| plane < range.1);
        range.map_or(&self.thickness, |range| &range.2).clone()
    }

    /// The top of a plan whose highest mandatory plane is `below`.
    fn top(&self, below: u32) -> Result<u32, PlanError> {
        let thickness = self.thickness_above(below);
        let (least, greatest) = (u64::from(*thickness.start()), u64::from(*thickness.end()));
        let unit = f64::from(self.unit);
        let rest = f64::from(self.bins.count as u32 - below) / unit;
        let exact = rest.ceil();
        // The usual case: without a motor step the top is a whole number of units above, and layers add up to it.
        let layers = (exact / greatest as f64).ceil();
        if rest == exact && layers * least as f64 <= exact {
            return Ok(below + exact as u32 * self.unit);
        }
        let best = [layers - 1.0, layers, layers + 1.0]
            .into_iter()
            .filter(|&layers| layers >= 1.0)
            .map(|layers| {
                let units = (rest - 1e-9)
                    .round()
                    .clamp(layers * least as f64, layers * greatest as f64);
                ((units - rest).abs(), units)
            })
            .min_by(|a, b| a.0.total_cmp(&b.0));
        match best {
            Some((moved, units)) if moved * 2.0 < least as f64 => {
                Ok(below + units as u32 * self.unit)
            }
            _ => Err(self.do_not_fit(&Segment {
                lower: below,
                units: exact as u32,
                unit: self.unit,
                thickness,
            })),
        }
    }

    fn segments(&self, planes: &[u32], top: u32) -> Vec<Segment> {
        let uppers = planes.iter().skip(1).copied().chain([top]);
        planes
            .iter()
            .zip(uppers)
            .map(|(&lower, upper)| Segment {
                lower,
                units: (upper - lower) / self.unit,
                unit: self.unit,
                thickness: self.thickness_above(lower),
            })
            .collect()
    }

    fn do_not_fit(&self, segment: &Segment) -> PlanError {
        let (least, greatest) = (segment.thickness.start(), segment.thickness.end());
        let mm = |units: u32| self.bins.boundary_mm(units.saturating_mul(self.unit));
        PlanError::LayersDoNotFit {
            from_mm: self.bins.boundary_mm(segment.lower),
            to_mm: self
                .bins
                .boundary_mm(segment.upper().min(self.bins.count as u32)),
            layer_min_mm: mm(*least),
            layer_max_mm: mm(*greatest),
        }
    }
}
