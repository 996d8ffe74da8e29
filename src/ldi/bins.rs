//! Facets by the part of the grid that they reach into.

/// The facets of each bin, in compressed rows.
pub(super) struct Bins {
    starts: Vec<usize>,
    facets: Vec<u32>,
}

impl Bins {
    /// Puts each of `facets` into those of `count` bins that `bins_of` names. A bin keeps the order of `facets`.
    pub fn new<R: Iterator<Item = usize>>(
        count: usize,
        facets: impl Iterator<Item = u32> + Clone,
        bins_of: impl Fn(u32) -> R,
    ) -> Self {
        // Counts are stored one slot ahead: filling then advances each start to where it belongs.
        let mut starts = vec![0; count + 2];
        for bin in facets.clone().flat_map(&bins_of) {
            starts[bin + 2] += 1;
        }
        for bin in 2..starts.len() {
            starts[bin] += starts[bin - 1];
        }
        let mut filed = vec![0; starts[count + 1]];
        for facet in facets {
            for bin in bins_of(facet) {
                filed[starts[bin + 1]] = facet;
                starts[bin + 1] += 1;
            }
        }
        Self {
            starts,
            facets: filed,
        }
    }

    /// The places of a bin's facets in [`Bins::all`].
    pub fn range(&self, bin: usize) -> std::ops::Range<usize> {
        self.starts[bin]..self.starts[bin + 1]
    }

    /// The facets of all bins, one bin after the other.
    pub fn all(&self) -> &[u32] {
        &self.facets
    }
}
