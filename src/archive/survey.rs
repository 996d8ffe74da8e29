//! The lit areas of a mask, for formats that state them.

use crate::mask::Run;

/// A box of pixels: first column and row, and those after the last.
pub type Bounds = [u32; 4];

/// The box around two boxes.
pub fn joined(a: Bounds, b: Bounds) -> Bounds {
    std::array::from_fn(|side| match side {
        0 | 1 => a[side].min(b[side]),
        _ => a[side].max(b[side]),
    })
}

/// The box of a run on a screen of this width.
pub fn bounds_of(run: Run, width: u32) -> Bounds {
    let (row, column) = (run.first / width, run.first % width);
    [column, row, column + run.pixels, row + 1]
}

/// Box and areas of a mask's lit pixels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Survey {
    /// The box of the lit pixels; `None` for a black mask.
    pub bounds: Option<Bounds>,
    /// Number of pixels of each area. Pixels that share a side belong to the same area.
    pub areas: Vec<u64>,
}

impl Survey {
    /// Surveys runs that are sorted row by row.
    ///
    /// Cost: nearly linear in runs.
    pub fn of(runs: impl Iterator<Item = Run>, [width, _]: [u32; 2]) -> Self {
        let runs: Vec<Run> = runs.collect();
        let mut areas = Areas::new(&runs);
        let bounds = runs.iter().map(|&run| bounds_of(run, width));
        let bounds = bounds.reduce(joined);
        // The first run that may touch the next one from the row above.
        let mut above = 0;
        for (index, run) in runs.iter().enumerate() {
            if let Some(before) = index.checked_sub(1)
                && runs[before].first + runs[before].pixels == run.first
                && !run.first.is_multiple_of(width)
            {
                areas.join(before, index);
            }
            let Some(first_above) = run.first.checked_sub(width) else {
                continue;
            };
            while runs[above].first + runs[above].pixels <= first_above {
                above += 1;
            }
            let touching = runs[above..index]
                .iter()
                .take_while(|other| other.first < first_above + run.pixels);
            for other in above..above + touching.count() {
                areas.join(other, index);
            }
        }
        Self {
            bounds,
            areas: areas.sizes(&runs),
        }
    }
}

/// Runs joined into areas.
struct Areas {
    /// A run of the same area that comes no later; itself for the first one.
    parents: Vec<usize>,
}

impl Areas {
    fn new(runs: &[Run]) -> Self {
        Self {
            parents: (0..runs.len()).collect(),
        }
    }

    #[inline]
    fn first(&mut self, mut run: usize) -> usize {
        while self.parents[run] != run {
            self.parents[run] = self.parents[self.parents[run]];
            run = self.parents[run];
        }
        run
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.first(a), self.first(b));
        self.parents[a.max(b)] = a.min(b);
    }

    /// The pixels of each area, by its first run.
    fn sizes(mut self, runs: &[Run]) -> Vec<u64> {
        let mut sizes = vec![0; runs.len()];
        for (index, run) in runs.iter().enumerate() {
            sizes[self.first(index)] += u64::from(run.pixels);
        }
        sizes.retain(|&size| size > 0);
        sizes
    }
}
