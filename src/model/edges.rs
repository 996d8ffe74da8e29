//! The edges of a mesh: which facets lie on both sides of each, and which edges are left open.

/// An edge that facets leave open, in the direction in which a cap must use it.
pub(super) type OpenEdge = (u32, u32);

/// Neighbour of a facet across an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Across {
    /// No other facet.
    Nothing,
    /// One facet.
    Facet(u32),
    /// Several facets.
    Several,
}

/// For each facet, its neighbours across its edges; edge i runs from corner i to the next.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Neighbours(Vec<[u32; 3]>);

const NOTHING: u32 = u32::MAX;
const SEVERAL: u32 = u32::MAX - 1;

impl Neighbours {
    /// Returns the neighbour across edge `edge` of a facet.
    pub fn across(&self, facet: usize, edge: usize) -> Across {
        match self.0[facet][edge] {
            NOTHING => Across::Nothing,
            SEVERAL => Across::Several,
            other => Across::Facet(other),
        }
    }

    /// The neighbours in the same mesh with the second and third corners of some facets swapped.
    pub(super) fn turned(&self, turned: &[bool]) -> Self {
        let across = self.0.iter().zip(turned);
        Self(
            across
                .map(|(&[a, b, c], &turned)| if turned { [c, b, a] } else { [a, b, c] })
                .collect(),
        )
    }
}

/// The edges of a mesh.
pub(super) struct Edges {
    pub neighbours: Neighbours,
    /// Every edge that is used more often in one direction than in the other, repeated by the difference, in order of its lower vertex.
    pub open: Vec<OpenEdge>,
    /// True if the two facets at an edge use it in opposite directions wherever there are two.
    pub is_even: bool,
    /// Edges at which three, five or more facets meet.
    pub odd: usize,
}

/// The facets on both sides of each edge, and the edges that are left open.
///
/// A counting sort puts edges into buckets by their lower vertex: linear, and without hashing.
pub(super) fn edges(vertex_count: usize, facets: &[[u32; 3]]) -> Edges {
    let edges = || {
        facets
            .iter()
            .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
            .zip(0u64..)
            .filter(|((start, end), _)| start != end)
    };
    // Counts are stored one slot ahead: filling then advances each start to where it belongs.
    let mut starts = vec![0usize; vertex_count + 2];
    for ((start, end), _) in edges() {
        starts[start.min(end) as usize + 2] += 1;
    }
    for vertex in 2..starts.len() {
        starts[vertex] += starts[vertex - 1];
    }
    // The higher vertex, whether the edge goes up to it, and the place of the edge, three a facet, in one number.
    let mut uses = vec![0u64; starts[vertex_count + 1]];
    for ((start, end), place) in edges() {
        let slot = &mut starts[start.min(end) as usize + 1];
        uses[*slot] = u64::from(start.max(end)) << 32 | place << 1 | u64::from(start < end);
        *slot += 1;
    }
    let mut across = vec![[NOTHING; 3]; facets.len()];
    let mut open = Vec::new();
    let mut is_even = true;
    let mut odd = 0;
    for low in 0..vertex_count {
        let bucket = &mut uses[starts[low]..starts[low + 1]];
        bucket.sort_unstable();
        for edge in bucket.chunk_by(|left, right| left >> 32 == right >> 32) {
            let place_of = |one: u64| (one as u32 >> 1) as usize;
            if let &[one, other] = edge {
                is_even &= (one ^ other) & 1 == 1;
                let (one, other) = (place_of(one), place_of(other));
                across[one / 3][one % 3] = (other / 3) as u32;
                across[other / 3][other % 3] = (one / 3) as u32;
            } else if edge.len() > 2 {
                odd += edge.len() % 2;
                for &one in edge {
                    across[place_of(one) / 3][place_of(one) % 3] = SEVERAL;
                }
            }
            let upward = edge.iter().filter(|&one| one & 1 == 1).count();
            let downward = edge.len() - upward;
            let (low, high) = (low as u32, (edge[0] >> 32) as u32);
            let missing = if upward > downward {
                (high, low)
            } else {
                (low, high)
            };
            open.extend(std::iter::repeat_n(missing, upward.abs_diff(downward)));
        }
    }
    Edges {
        neighbours: Neighbours(across),
        open,
        is_even,
        odd,
    }
}
