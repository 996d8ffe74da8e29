//! Overlaps of bodies: tests whether a point of one lies within the others.

use glam::DVec3;

use crate::model::{FacetLists, bodies, passes_above};

/// Facets per cell that the cells are made for.
const PER_CELL: usize = 4;

/// The facets of several bodies by their place in x and y.
#[derive(Debug)]
pub(super) struct Overlaps {
    /// The body of each facet, by one of its vertices.
    body_of: Vec<u32>,
    /// For each vertex that stands for a body, true if the body is a cavity.
    is_cavity: Vec<bool>,
    lattice: Lattice,
    /// The facets that reach into each cell.
    cells: FacetLists,
}

impl Overlaps {
    /// `None` if there is only one body.
    pub fn new(vertices: &[DVec3], facets: &[[u32; 3]]) -> Option<Self> {
        let body_of = bodies(vertices.len(), facets);
        if body_of.windows(2).all(|pair| pair[0] == pair[1]) {
            return None;
        }
        let mut sixfold_mm3 = vec![0.0; vertices.len()];
        for (corners, &body) in facets.iter().zip(&body_of) {
            let body = body as usize;
            let [a, b, c] = corners.map(|it| vertices[it as usize] - vertices[body]);
            sixfold_mm3[body] += a.dot(b.cross(c));
        }
        let (mut low, mut high) = (vertices[0], vertices[0]);
        for &vertex in vertices {
            (low, high) = (low.min(vertex), high.max(vertex));
        }
        let count = ((facets.len() / PER_CELL) as f64).sqrt() as usize + 1;
        let cell_mm = [0, 1].map(|axis| ((high - low)[axis] / count as f64).max(f64::MIN_POSITIVE));
        let lattice = Lattice {
            low,
            cell_mm,
            count,
        };
        let cells_of = |facet: u32| {
            let [a, b, c] = facets[facet as usize].map(|it| vertices[it as usize]);
            let [left, top] = lattice.place(a.min(b).min(c));
            let [right, bottom] = lattice.place(a.max(b).max(c));
            (top..=bottom)
                .flat_map(move |row| (left..=right).map(move |column| row * count + column))
        };
        let cells = FacetLists::new(count * count, 0..facets.len() as u32, cells_of);
        Some(Self {
            body_of,
            is_cavity: sixfold_mm3.iter().map(|&volume| volume < 0.0).collect(),
            lattice,
            cells,
        })
    }

    /// Returns true if a point of a facet lies within the solid that the other bodies are.
    pub fn hide(&self, vertices: &[DVec3], facets: &[[u32; 3]], facet: u32, point: DVec3) -> bool {
        let body = self.body_of[facet as usize];
        let [column, row] = self.lattice.place(point);
        let near = self.cells.of(row * self.lattice.count + column);
        let around: i32 = near
            .iter()
            .filter(|&&facet| self.body_of[facet as usize] != body)
            .map(|&facet| facets[facet as usize].map(|it| vertices[it as usize]))
            .map(|corners| passes_above(corners, point))
            .sum();
        let own = if self.is_cavity[body as usize] { -1 } else { 1 };
        around != 0 && around + own != 0
    }
}

/// Cells over the model as seen along z.
#[derive(Debug)]
struct Lattice {
    low: DVec3,
    cell_mm: [f64; 2],
    /// Cells along each axis.
    count: usize,
}

impl Lattice {
    /// The column and the row of a point.
    fn place(&self, point: DVec3) -> [usize; 2] {
        [0, 1].map(|axis| {
            let cell = (point - self.low)[axis] / self.cell_mm[axis];
            (cell as usize).min(self.count - 1)
        })
    }
}
