//! Closed solids made by code. Only basic arithmetic and square roots, so that every machine makes
//! the same coordinates. And what puts them in a file.

use glam::{DVec2, DVec3, Vec3};

pub type Triangles = Vec<[Vec3; 3]>;

/// A binary STL, written by another library.
pub fn binary_stl(triangles: &[[Vec3; 3]]) -> Vec<u8> {
    let triangles: Vec<_> = triangles
        .iter()
        .map(|corners| stl_io::Triangle {
            normal: stl_io::Normal::new([0.0; 3]),
            vertices: corners.map(|corner| stl_io::Vertex::new(corner.to_array())),
        })
        .collect();
    let mut bytes = Vec::new();
    stl_io::write_stl(&mut bytes, triangles.iter()).unwrap();
    bytes
}

/// An axis-aligned box from the origin.
pub fn cuboid(size: Vec3) -> Triangles {
    let corner =
        |i: usize| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2 & 1) as f32) * size;
    [
        [0, 2, 3, 1], // bottom
        [4, 5, 7, 6], // top
        [0, 1, 5, 4], // front
        [2, 6, 7, 3], // back
        [0, 4, 6, 2], // left
        [1, 3, 7, 5], // right
    ]
    .iter()
    .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
    .map(|corners| corners.map(corner))
    .collect()
}

pub fn cube(side: f32) -> Triangles {
    cuboid(Vec3::splat(side))
}

/// A sphere around the origin: an octahedron whose edges are halved `levels` times.
pub fn sphere(radius: f64, levels: u32) -> Triangles {
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    let mut faces = vec![
        [x, y, z],
        [y, -x, z],
        [-x, -y, z],
        [-y, x, z],
        [y, x, -z],
        [-x, y, -z],
        [-y, -x, -z],
        [x, -y, -z],
    ];
    for _ in 0..levels {
        faces = faces
            .iter()
            .flat_map(|&[a, b, c]| {
                let middle = |p: DVec3, q: DVec3| {
                    let sum = p + q;
                    sum / sum.dot(sum).sqrt()
                };
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    faces
        .iter()
        .map(|face| face.map(|corner| (corner * radius).as_vec3()))
        .collect()
}

/// Points on the unit circle, counter-clockwise, at multiples of 1/`count` of a quarter of each
/// quadrant's rational parameter.
pub fn circle(quarter: u32) -> Vec<DVec2> {
    let first: Vec<DVec2> = (0..quarter)
        .map(|i| {
            let t = f64::from(i) / f64::from(quarter);
            DVec2::new(1.0 - t * t, 2.0 * t) / (1.0 + t * t)
        })
        .collect();
    let mut points = first;
    for turn in 1..4 {
        let start = points.len() - quarter as usize;
        let turned: Vec<DVec2> = points[start..]
            .iter()
            .map(|point| DVec2::new(-point.y, point.x))
            .collect();
        assert_eq!(points.len(), (turn * quarter) as usize);
        points.extend(turned);
    }
    points
}

/// Area of the polygon that `circle` makes.
pub fn circle_area(quarter: u32) -> f64 {
    let points = circle(quarter);
    let next = points.iter().cycle().skip(1);
    points
        .iter()
        .zip(next)
        .map(|(p, q)| 0.5 * p.perp_dot(*q))
        .sum()
}

fn rim(radius: f64, quarter: u32) -> Vec<DVec2> {
    circle(quarter)
        .into_iter()
        .map(|point| point * radius)
        .collect()
}

/// An upright cylinder.
pub fn cylinder(radius: f64, height: f64, quarter: u32) -> Triangles {
    let rim = rim(radius, quarter);
    let at = |point: DVec2, z: f64| point.extend(z).as_vec3();
    let mut triangles = Vec::new();
    for (&p, &q) in rim.iter().zip(rim.iter().cycle().skip(1)) {
        triangles.push([at(DVec2::ZERO, 0.0), at(q, 0.0), at(p, 0.0)]);
        triangles.push([at(DVec2::ZERO, height), at(p, height), at(q, height)]);
        triangles.push([at(p, 0.0), at(q, 0.0), at(q, height)]);
        triangles.push([at(p, 0.0), at(q, height), at(p, height)]);
    }
    triangles
}

/// An upright cone on its base.
pub fn cone(radius: f64, height: f64, quarter: u32) -> Triangles {
    let rim = rim(radius, quarter);
    let at = |point: DVec2, z: f64| point.extend(z).as_vec3();
    let mut triangles = Vec::new();
    for (&p, &q) in rim.iter().zip(rim.iter().cycle().skip(1)) {
        triangles.push([at(DVec2::ZERO, 0.0), at(q, 0.0), at(p, 0.0)]);
        triangles.push([at(p, 0.0), at(q, 0.0), at(DVec2::ZERO, height)]);
    }
    triangles
}

/// A square ring standing upright: rays through its middle have four hits.
pub fn frame() -> Triangles {
    let mut triangles = moved(&cuboid(Vec3::new(10.0, 4.0, 2.0)), Vec3::ZERO);
    triangles.extend(moved(
        &cuboid(Vec3::new(10.0, 4.0, 2.0)),
        Vec3::new(0.0, 0.0, 8.0),
    ));
    triangles.extend(moved(
        &cuboid(Vec3::new(2.0, 4.0, 6.0)),
        Vec3::new(0.0, 0.0, 2.0),
    ));
    triangles.extend(moved(
        &cuboid(Vec3::new(2.0, 4.0, 6.0)),
        Vec3::new(8.0, 0.0, 2.0),
    ));
    triangles
}

/// Everything shifted.
pub fn moved(triangles: &[[Vec3; 3]], by: Vec3) -> Triangles {
    triangles
        .iter()
        .map(|corners| corners.map(|corner| corner + by))
        .collect()
}

/// Everything inside out.
pub fn inverted(triangles: &[[Vec3; 3]]) -> Triangles {
    triangles.iter().map(|&[a, b, c]| [a, c, b]).collect()
}

/// Mirrored at x = 0, orientation kept.
pub fn mirrored(triangles: &[[Vec3; 3]]) -> Triangles {
    let flip = |corner: Vec3| Vec3::new(-corner.x, corner.y, corner.z);
    triangles
        .iter()
        .map(|&[a, b, c]| [flip(a), flip(c), flip(b)])
        .collect()
}

/// Turned by a quarter about z.
pub fn turned(triangles: &[[Vec3; 3]]) -> Triangles {
    let turn = |corner: Vec3| Vec3::new(-corner.y, corner.x, corner.z);
    triangles.iter().map(|corners| corners.map(turn)).collect()
}

/// The same facets in another order.
pub fn shuffled(triangles: &[[Vec3; 3]]) -> Triangles {
    let mut shuffled = triangles.to_vec();
    fastrand::Rng::with_seed(7).shuffle(&mut shuffled);
    shuffled
}

/// Every solid by name.
pub fn all() -> Vec<(&'static str, Triangles)> {
    vec![
        ("cube", cube(10.0)),
        ("sphere", sphere(10.0, 5)),
        ("cylinder", cylinder(8.0, 12.0, 32)),
        ("cone", cone(9.0, 14.0, 32)),
        ("frame", frame()),
        ("inverted sphere", inverted(&sphere(6.0, 4))),
        ("overlapping spheres", {
            let mut triangles = sphere(6.0, 4);
            triangles.extend(moved(&sphere(5.0, 4), Vec3::new(4.0, 1.0, 2.0)));
            triangles
        }),
        ("stacked cubes", {
            let mut triangles = cube(5.0);
            triangles.extend(moved(&cube(5.0), Vec3::new(0.0, 0.0, 5.0)));
            triangles
        }),
        ("doubled sphere", {
            let mut triangles = sphere(6.0, 4);
            triangles.extend(sphere(6.0, 4));
            triangles
        }),
    ]
}

/// What sampling finds hard, by name, with the rays along the longer side that make it so.
pub fn torture() -> Vec<(&'static str, Triangles, u32)> {
    let stack = |count: usize| {
        let slab = cuboid(Vec3::new(8.0, 8.0, 0.1));
        let at = |i: usize| Vec3::new(0.0, 0.0, 0.2 * i as f32);
        (0..count).flat_map(|i| moved(&slab, at(i))).collect()
    };
    vec![
        ("a hundred surfaces on a ray", stack(50), 40),
        ("gyroid", gyroid(3, 36), 97),
        (
            "knife edge",
            prism(&[(0.0, 0.0), (9.0, 1e-4), (9.0, 2e-4)], 7.0),
            300,
        ),
        (
            "needle standing up",
            prism(&[(0.0, 0.0), (1e-3, 0.0), (0.0, 1e-3)], 50.0),
            3,
        ),
        ("walls that lean by a hair", leaning(1e-6), 100),
        ("facets smaller than a pixel", sphere(5.0, 6), 23),
        (
            "one facet over all pixels",
            prism(&[(0.0, 0.0), (40.0, 0.0), (0.0, 40.0)], 1.0),
            1400,
        ),
        (
            "nested shells",
            {
                let mut triangles = sphere(9.0, 4);
                triangles.extend(inverted(&sphere(7.0, 4)));
                triangles.extend(sphere(5.0, 4));
                triangles.extend(inverted(&sphere(3.0, 4)));
                triangles
            },
            120,
        ),
        (
            "coincident cubes",
            {
                let mut triangles = cube(5.0);
                triangles.extend(cube(5.0));
                triangles.extend(moved(&cube(5.0), Vec3::new(5.0, 0.0, 0.0)));
                triangles.extend(moved(&cube(5.0), Vec3::new(0.0, 5.0, 5.0)));
                triangles
            },
            64,
        ),
    ]
}

/// A triangle of (x, y) in counter-clockwise order, pulled up.
fn prism(base: &[(f32, f32); 3], height: f32) -> Triangles {
    let [a, b, c] = base.map(|(x, y)| Vec3::new(x, y, 0.0));
    let up = Vec3::Z * height;
    let mut triangles = vec![[a, c, b], [a + up, b + up, c + up]];
    for (p, q) in [(a, b), (b, c), (c, a)] {
        triangles.extend([[p, q, q + up], [p, q + up, p + up]]);
    }
    triangles
}

/// A cube whose top is shifted by `lean` of its side.
fn leaning(lean: f32) -> Triangles {
    cube(10.0)
        .iter()
        .map(|corners| corners.map(|c| Vec3::new(c.x + c.z * lean, c.y, c.z)))
        .collect()
}

/// A thick gyroid of `cells` periods a side inside a box, by marching tetrahedra on `steps` cubes a
/// side. The coordinates depend on the machine's sine: for comparisons within one run.
pub fn gyroid(cells: u32, steps: usize) -> Triangles {
    let scale = std::f64::consts::TAU * f64::from(cells) / steps as f64;
    let value = |p: [usize; 3]| {
        let [x, y, z] = p.map(|i| i as f64 * scale);
        let wall = (x.sin() * y.cos() + y.sin() * z.cos() + z.sin() * x.cos()).abs() - 0.4;
        let is_border = p.iter().any(|&i| i == 0 || i == steps);
        if is_border { wall.max(0.5) } else { wall }
    };
    // A corner of the surface on the edge between a point inside and one outside.
    let crossing = |inside: [usize; 3], outside: [usize; 3]| {
        let (p, q) = if inside < outside {
            (inside, outside)
        } else {
            (outside, inside)
        };
        let (f, g) = (value(p), value(q));
        let [p, q] = [p, q].map(|p| DVec3::from_array(p.map(|i| i as f64)));
        (p + (q - p) * (f / (f - g))).as_vec3()
    };
    // The six tetrahedra of a cube around its diagonal, each a path along the three axes.
    let paths = [
        [0, 1, 2],
        [0, 2, 1],
        [1, 0, 2],
        [1, 2, 0],
        [2, 0, 1],
        [2, 1, 0],
    ];
    let mut triangles = Vec::new();
    for index in 0..steps * steps * steps {
        let base = [index % steps, index / steps % steps, index / steps / steps];
        for path in paths {
            let mut corners = [base; 4];
            for (step, axis) in path.into_iter().enumerate() {
                for corner in &mut corners[step + 1..] {
                    corner[axis] += 1;
                }
            }
            let (inside, outside): (Vec<_>, Vec<_>) =
                corners.into_iter().partition(|&corner| value(corner) < 0.0);
            let edges: Vec<Vec3> = inside
                .iter()
                .flat_map(|&p| outside.iter().map(move |&q| (p, q)))
                .map(|(p, q)| crossing(p, q))
                .collect();
            let faces: &[[usize; 3]] = match (inside.len(), outside.len()) {
                (1, 3) | (3, 1) => &[[0, 1, 2]],
                (2, 2) => &[[0, 1, 3], [0, 3, 2]],
                _ => &[],
            };
            let middle = |points: &[[usize; 3]]| {
                let sum: DVec3 = points
                    .iter()
                    .map(|p| DVec3::from_array(p.map(|i| i as f64)))
                    .sum();
                sum / points.len().max(1) as f64
            };
            let outward = middle(&outside) - middle(&inside);
            for face in faces {
                let [a, b, c] = face.map(|i| edges[i]);
                let normal = (b - a).cross(c - a).as_dvec3();
                triangles.push(if normal.dot(outward) < 0.0 {
                    [a, c, b]
                } else {
                    [a, b, c]
                });
            }
        }
    }
    triangles
}
