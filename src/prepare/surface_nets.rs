//! The surface where a field on a lattice is zero, as a closed mesh: naive surface nets.
//!
//! Each cell of eight nodes that the surface passes has a vertex, the mean of the points where the surface crosses the cell's edges.
//! Each edge that it crosses has a quadrilateral between the vertices of the four cells around it (Gibson, "Constrained elastic surface
//! nets", 1998; here without relaxation).
//!
//! The lattice is visited slice by slice, and two slices are in memory: all of it would take gigabytes for a plate of a 12K screen.

use glam::Vec3;

use super::shell::Shell;

/// No vertex.
const NONE: u32 = u32::MAX;

/// Positions of the nodes of a lattice.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lattice {
    /// Nodes of a row, along x.
    pub width: usize,
    /// Rows, along y from the largest down.
    pub height: usize,
    /// From one node to the next.
    pub spacing_mm: f32,
    /// Node (0, 0) of the lowest slice.
    pub origin_mm: Vec3,
}

impl Lattice {
    /// A point, given in nodes.
    fn point_mm(&self, nodes: Vec3) -> Vec3 {
        self.origin_mm + Vec3::new(nodes.x, -nodes.y, nodes.z) * self.spacing_mm
    }

    /// A node of a slice.
    pub fn node_mm(&self, column: usize, row: usize, slice: usize) -> Vec3 {
        self.point_mm(Vec3::new(column as f32, row as f32, slice as f32))
    }
}

/// Makes the surface slice by slice, from the lowest up. All nodes at the lattice's border must be outside: not positive.
pub(super) struct Nets {
    lattice: Lattice,
    /// Number of slices so far.
    slices: usize,
    below: Vec<f32>,
    /// The vertices of the cells between the last two slices, and of those below.
    vertex_of: [Vec<u32>; 2],
    shell: Shell,
}

impl Nets {
    pub fn new(lattice: Lattice) -> Self {
        let nodes = lattice.width * lattice.height;
        Self {
            lattice,
            slices: 0,
            below: vec![-1.0; nodes],
            vertex_of: [vec![NONE; nodes], vec![NONE; nodes]],
            shell: Shell::default(),
        }
    }

    /// Adds the next slice: the field at its nodes, row by row.
    pub fn add(&mut self, slice: Vec<f32>) {
        if self.slices > 0 {
            self.add_cells(&slice);
        }
        if self.slices > 1 {
            self.add_level();
        }
        self.below = slice;
        self.slices += 1;
    }

    pub fn finish(self) -> Shell {
        self.shell
    }

    /// The vertices of the cells between the slice before and this one, and the quadrilaterals around the edges between the two.
    fn add_cells(&mut self, above: &[f32]) {
        let Lattice { width, height, .. } = self.lattice;
        self.vertex_of.swap(0, 1);
        self.vertex_of[0].fill(NONE);
        for row in 0..height - 1 {
            for column in 0..width - 1 {
                let node = row * width + column;
                let corners = [
                    self.below[node],
                    self.below[node + 1],
                    self.below[node + width],
                    self.below[node + width + 1],
                    above[node],
                    above[node + 1],
                    above[node + width],
                    above[node + width + 1],
                ];
                let inside = corners.iter().filter(|&&field| field > 0.0).count();
                if inside == 0 || inside == 8 {
                    continue;
                }
                let first = Vec3::new(column as f32, row as f32, self.slices as f32 - 1.0);
                self.vertex_of[0][node] = self.shell.vertices.len() as u32;
                let vertex = self.lattice.point_mm(first + mean_crossing(&corners));
                self.shell.vertices.push(vertex);
            }
        }
        for row in 1..height {
            for column in 1..width {
                let node = row * width + column;
                // Rows go along -y.
                let cells = [node - 1, node, node - width, node - width - 1];
                let corners = cells.map(|cell| self.vertex_of[0][cell]);
                self.add_quad(self.below[node], above[node], corners);
            }
        }
    }

    /// The quadrilaterals around the edges within the slice before, which has cells above and below by now.
    fn add_level(&mut self) {
        let width = self.lattice.width;
        let slice = std::mem::take(&mut self.below);
        for row in 0..self.lattice.height {
            for column in 0..width {
                let node = row * width + column;
                let [above, below] = [&self.vertex_of[0], &self.vertex_of[1]];
                if column + 1 < width && row > 0 {
                    let other = node - width;
                    let corners = [below[other], above[other], above[node], below[node]];
                    self.add_quad(slice[node], slice[node + 1], corners);
                }
                let [above, below] = [&self.vertex_of[0], &self.vertex_of[1]];
                if row + 1 < self.lattice.height && column > 0 {
                    let other = node - 1;
                    let corners = [below[node], above[node], above[other], below[other]];
                    self.add_quad(slice[node], slice[node + width], corners);
                }
            }
        }
        self.below = slice;
    }

    /// Adds a quadrilateral around an edge that the surface crosses, with its front where the field is not positive, given corners that are
    /// counter-clockwise as seen from the end of the edge if the field falls along it.
    fn add_quad(&mut self, from: f32, to: f32, corners: [u32; 4]) {
        let [a, b, c, d] = match (from > 0.0, to > 0.0) {
            (true, false) => corners,
            (false, true) => [corners[3], corners[2], corners[1], corners[0]],
            _ => return,
        };
        let at = |vertex: u32| self.shell.vertices[vertex as usize];
        // Along the shorter diagonal.
        if at(a).distance_squared(at(c)) <= at(b).distance_squared(at(d)) {
            self.shell.facets.extend([[a, b, c], [a, c, d]]);
        } else {
            self.shell.facets.extend([[a, b, d], [b, c, d]]);
        }
    }
}

/// The mean of the points where the field is zero on a cell's edges, in nodes from its first corner. Corners count along x, then down the
/// rows, then up.
fn mean_crossing(corners: &[f32; 8]) -> Vec3 {
    let (mut sum, mut count) = (Vec3::ZERO, 0.0);
    for corner in 0..8 {
        for axis in 0..3 {
            let other = corner | 1 << axis;
            let (from, to) = (corners[corner], corners[other]);
            if other == corner || (from > 0.0) == (to > 0.0) {
                continue;
            }
            let mut at = Vec3::new(
                (corner & 1) as f32,
                (corner >> 1 & 1) as f32,
                (corner >> 2) as f32,
            );
            at[axis] = from / (from - to);
            sum += at;
            count += 1.0;
        }
    }
    sum / count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_is_closed_and_has_its_volume() {
        let (radius, side) = (8.0f32, 24);
        let lattice = Lattice {
            width: side,
            height: side,
            spacing_mm: 1.0,
            origin_mm: Vec3::ZERO,
        };
        let centre = Vec3::new(11.3, -11.7, 11.5);
        let mut nets = Nets::new(lattice);
        for slice in 0..side {
            let nodes = (0..side * side).map(|node| {
                let at = lattice.node_mm(node % side, node / side, slice);
                radius - at.distance(centre)
            });
            nets.add(nodes.collect());
        }
        let shell = nets.finish();
        let ball = 4.0 / 3.0 * std::f64::consts::PI * f64::from(radius).powi(3);
        assert!(
            (shell.volume_mm3() / ball - 1.0).abs() < 0.02,
            "{}",
            shell.volume_mm3() / ball
        );
        let edge = |a: u32, b: u32| u64::from(a) << 32 | u64::from(b);
        let of_facet = |&[a, b, c]: &[u32; 3]| [edge(a, b), edge(b, c), edge(c, a)];
        let mut edges: Vec<u64> = shell.facets.iter().flat_map(of_facet).collect();
        edges.sort_unstable();
        for edge in &edges {
            let back = edge.rotate_right(32);
            assert!(edges.binary_search(&back).is_ok());
        }
        for vertex in &shell.vertices {
            assert!((vertex.distance(centre) - radius).abs() < 0.1);
        }
    }
}
