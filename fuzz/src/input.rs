//! Bytes as decisions, and models of few facets that they decide on.

use glam::Vec3;

/// The side of the lattice on which models stand, in millimetres: a binary fraction, so that sums of coordinates and their doubles are exact.
const LATTICE_MM: f32 = 1.0 / 16.0;

/// The two triangles of each side of a box, by corners whose bits say which end of x, y and z they are at.
const SIDES: [[usize; 4]; 6] = [
    [0, 2, 3, 1],
    [4, 5, 7, 6],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 4, 6, 2],
    [1, 3, 7, 5],
];

/// The corners of triangles.
pub type Triangles = Vec<[Vec3; 3]>;

/// Bytes that are taken one after the other, and zeros after the last.
pub struct Input<'a>(pub &'a [u8]);

impl Input<'_> {
    /// The next byte.
    pub fn byte(&mut self) -> u8 {
        let Some((&first, rest)) = self.0.split_first() else {
            return 0;
        };
        self.0 = rest;
        first
    }

    /// A number below `end`.
    pub fn below(&mut self, end: u8) -> u8 {
        self.byte() % end
    }

    /// A number below `end`, for arithmetic.
    pub fn number(&mut self, end: u8) -> f64 {
        f64::from(self.below(end))
    }

    /// One of some values.
    pub fn of<T: Copy>(&mut self, values: &[T]) -> T {
        values[usize::from(self.byte()) % values.len()]
    }

    /// Returns true once in `times` times.
    pub fn once_in(&mut self, times: u8) -> bool {
        // Zeros, which follow the last byte, choose the usual value.
        self.below(times) == times - 1
    }

    fn point(&mut self) -> Vec3 {
        let mut at = |end| f32::from(self.below(end)) * LATTICE_MM;
        Vec3::new(at(48), at(48), at(32))
    }
}

/// The triangles of a box between two corners.
pub fn cuboid(ends: [Vec3; 2]) -> Triangles {
    let corner = |corner: usize| {
        let at = |axis: usize| ends[corner >> axis & 1][axis];
        Vec3::new(at(0), at(1), at(2))
    };
    let sides = SIDES.map(|side| side.map(corner));
    sides
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
        .collect()
}

/// Boxes, tetrahedra or a prism, up to 3 mm wide and 2 mm high. They may overlap, touch, be flat or inside out, and lack a facet.
pub fn triangles(input: &mut Input<'_>) -> Triangles {
    let mut triangles = match input.below(3) {
        0 => boxes(input),
        1 => tetrahedra(input),
        _ => prism(input),
    };
    if input.once_in(8) {
        let lacking = usize::from(input.byte()) % triangles.len();
        triangles.swap_remove(lacking);
    }
    triangles
}

fn boxes(input: &mut Input<'_>) -> Triangles {
    let count = 1 + input.below(4);
    (0..count)
        .flat_map(|_| {
            let lower = input.point();
            let size = input.point() * 0.5 + Vec3::splat(LATTICE_MM);
            cuboid([lower, lower + size])
        })
        .collect()
}

fn tetrahedra(input: &mut Input<'_>) -> Triangles {
    let count = 1 + input.below(6);
    (0..count)
        .flat_map(|_| {
            let [a, b, c, d] = std::array::from_fn(|_| input.point());
            [[a, c, b], [a, b, d], [b, c, d], [c, a, d]]
        })
        .collect()
}

/// An outline in x and z along y, which may cross itself.
fn prism(input: &mut Input<'_>) -> Triangles {
    let corners = 3 + input.below(6);
    let length = f32::from(1 + input.below(32)) * LATTICE_MM;
    let outline: Vec<[Vec3; 2]> = (0..corners)
        .map(|_| {
            let front = input.point() * Vec3::new(1.0, 0.0, 1.0);
            [front, front + Vec3::Y * length]
        })
        .collect();
    let mut triangles = Vec::new();
    for (place, &[front, back]) in outline.iter().enumerate() {
        let [next_front, next_back] = outline[(place + 1) % outline.len()];
        triangles.extend([[front, next_front, next_back], [front, next_back, back]]);
        if (1..outline.len() - 1).contains(&place) {
            let [first_front, first_back] = outline[0];
            triangles.extend([
                [first_front, next_front, front],
                [first_back, back, next_back],
            ]);
        }
    }
    triangles
}
