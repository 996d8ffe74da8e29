//! Facets listed by where they are: in a band or a tile of the grid, in a cell, at a vertex.

/// Lists of facets, in compressed rows.
#[derive(Debug)]
pub(crate) struct FacetLists {
    starts: Vec<usize>,
    facets: Vec<u32>,
}

impl FacetLists {
    /// Puts each of `facets` into those of `count` lists that `lists_of` names. A list keeps the order of `facets`.
    pub fn new<R: Iterator<Item = usize>>(
        count: usize,
        facets: impl Iterator<Item = u32> + Clone,
        lists_of: impl Fn(u32) -> R,
    ) -> Self {
        // Counts are stored one slot ahead: filling then advances each start to where it belongs.
        let mut starts = vec![0; count + 2];
        for list in facets.clone().flat_map(&lists_of) {
            starts[list + 2] += 1;
        }
        for list in 2..starts.len() {
            starts[list] += starts[list - 1];
        }
        let mut filed = vec![0; starts[count + 1]];
        for facet in facets {
            for list in lists_of(facet) {
                filed[starts[list + 1]] = facet;
                starts[list + 1] += 1;
            }
        }
        Self {
            starts,
            facets: filed,
        }
    }

    /// The places of the facets of a list among those of all lists.
    pub fn range(&self, list: usize) -> std::ops::Range<usize> {
        self.starts[list]..self.starts[list + 1]
    }

    /// The facets of a list.
    #[inline]
    pub fn of(&self, list: usize) -> &[u32] {
        &self.facets[self.range(list)]
    }

    /// The facets of all lists, one list after the other, as a GPU takes them.
    pub fn all(&self) -> &[u32] {
        &self.facets
    }
}
