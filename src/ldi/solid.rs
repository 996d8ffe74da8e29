//! The solid that an LDI encloses: its volume, and the heights at which any ray is inside it.

/// The solid as sampled by rays.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// Volume in mm³: the total length of rays inside, times the area of a pixel.
    pub volume_mm3: f64,
    /// Heights in millimetres at which at least one ray is inside. Each range runs from an entry (included) to an exit
    /// (excluded). Ranges are in ascending order and do not touch.
    pub heights_mm: Vec<(f32, f32)>,
}

impl Solid {
    /// Several solids side by side, each a number of times.
    pub fn of_copies<'a>(solids: impl Iterator<Item = (&'a Self, usize)>) -> Self {
        let mut volume_mm3 = 0.0;
        let mut heights = Heights::default();
        for (solid, copies) in solids {
            volume_mm3 += solid.volume_mm3 * copies as f64;
            for &(z_in, z_out) in &solid.heights_mm {
                heights.add(z_in, z_out);
            }
        }
        Self {
            volume_mm3,
            heights_mm: heights.into_ranges(),
        }
    }
}

/// A union of height ranges. Heights are not negative, so their bits ascend with them: browsers compare and choose integers faster.
#[derive(Default)]
pub(super) struct Heights {
    /// Each range as bits, the lower end in the upper half.
    keys: Vec<u64>,
    /// The bits of both ends of the ranges that grew last, at most [`Self::RECENT`]: most rays pass through the same parts of the solid
    /// as the ray before.
    recent: Vec<(u32, u32)>,
    /// Number of keys at which they are merged.
    limit: usize,
}

impl Heights {
    /// The lowest limit: few keys to sort, and enough to make sorting worthwhile.
    const LIMIT: usize = 1 << 10;

    /// Number of ranges that each new one is compared with: few solids have more parts along a ray.
    const RECENT: usize = 4;

    #[inline]
    pub fn add(&mut self, z_in: f32, z_out: f32) {
        let (z_in, z_out) = (z_in.to_bits(), z_out.to_bits());
        for (from, to) in &mut self.recent {
            if z_in <= *to && *from <= z_out {
                // Seldom, as most ranges lie within.
                if z_in < *from || *to < z_out {
                    *from = z_in.min(*from);
                    *to = z_out.max(*to);
                }
                return;
            }
        }
        self.add_apart((z_in, z_out));
    }

    #[cold]
    fn add_apart(&mut self, range: (u32, u32)) {
        if self.recent.len() == Self::RECENT {
            let first = self.recent.remove(0);
            self.keep(first);
        }
        self.recent.push(range);
    }

    fn keep(&mut self, (from, to): (u32, u32)) {
        self.keys.push(u64::from(from) << 32 | u64::from(to));
        if self.keys.len() >= self.limit.max(Self::LIMIT) {
            self.merge();
            self.limit = 2 * self.keys.len();
        }
    }

    /// Merges ranges that overlap or touch.
    fn merge(&mut self) {
        let ends = |key: u64| ((key >> 32) as u32, key as u32);
        self.keys.sort_unstable();
        self.keys.dedup_by(|next, kept| {
            let ((from, to), (first, last)) = (ends(*next), ends(*kept));
            let joins = from <= last;
            if joins {
                *kept = u64::from(first) << 32 | u64::from(last.max(to));
            }
            joins
        });
    }

    /// The ranges in ascending order. No two touch.
    pub fn into_ranges(mut self) -> Vec<(f32, f32)> {
        for range in std::mem::take(&mut self.recent) {
            self.keep(range);
        }
        self.merge();
        let ends = |key: u64| {
            (
                f32::from_bits((key >> 32) as u32),
                f32::from_bits(key as u32),
            )
        };
        self.keys.into_iter().map(ends).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Heights;

    fn union(ranges: &[(f32, f32)]) -> Vec<(f32, f32)> {
        let mut heights = Heights::default();
        for &(from, to) in ranges {
            heights.add(from, to);
        }
        heights.into_ranges()
    }

    #[test]
    fn ranges_that_overlap_or_touch_become_one() {
        let mut ranges = vec![
            (4.0, 5.0),
            (0.0, 1.0),
            (2.0, 3.0),
            (2.5, 2.75),
            (3.0, 3.5),
            (0.5, 2.25),
        ];
        assert_eq!(union(&ranges), [(0.0, 3.5), (4.0, 5.0)]);
        ranges.push((0.0, 9.0));
        assert_eq!(union(&ranges), [(0.0, 9.0)]);
        assert_eq!(union(&[]), []);
    }

    #[test]
    fn many_ranges_in_any_order_are_merged() {
        // Ranges that start at even numbers, in a scrambled order: none touch until those between them are added.
        let at = |i: u32| (i * 7919 % 10_000) as f32;
        let odd: Vec<_> = (0..10_000)
            .map(|i| (2.0 * at(i), 2.0 * at(i) + 1.0))
            .collect();
        assert_eq!(union(&odd).len(), 10_000);
        let all = odd
            .iter()
            .flat_map(|&(from, to)| [(from, to), (from + 1.0, to + 1.0)]);
        assert_eq!(union(&all.collect::<Vec<_>>()), [(0.0, 20_000.0)]);
    }
}
