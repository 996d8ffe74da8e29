//! The lit areas of a mask, for formats that state them.

use crate::mask::Run;

/// Box and areas of a mask's lit pixels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Survey {
    /// First column and row with a lit pixel, and the columns and rows after the last. `None` for a black mask.
    pub bounds: Option<[u32; 4]>,
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
        let mut bounds: Option<[u32; 4]> = None;
        // The first run that may touch the next one from the row above.
        let mut above = 0;
        for (index, run) in runs.iter().enumerate() {
            let (row, column) = (run.first / width, run.first % width);
            let end = column + run.pixels;
            let [left, top, right, _] = bounds.unwrap_or([column, row, end, row]);
            bounds = Some([left.min(column), top, right.max(end), row + 1]);
            if let Some(before) = index.checked_sub(1)
                && runs[before].first + runs[before].pixels == run.first
                && column > 0
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
