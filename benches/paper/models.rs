//! Generated models like the paper's: a shell like a hearing aid's, a goblet, a hand, a bumpy ball and a lens.

use glam::DVec3;

use crate::solids::Triangles;

/// A head with a face toward −y: brow, eyes, nose and mouth.
#[allow(dead_code, reason = "each bench uses only some of the models")]
pub fn head(rings: u32) -> Triangles {
    deformed(rings, |direction| {
        // A bump of `height` at (x, z) on the face, `wide` × `high` in size.
        let feature = |x: f64, z: f64, wide: f64, high: f64, height: f64| {
            let [dx, dz] = [(direction.x - x) / wide, (direction.z - z) / high];
            let square = dx * dx + dz * dz;
            if direction.y < 0.0 {
                height * (-square).exp()
            } else {
                0.0
            }
        };
        let features = [
            feature(0.0, 0.02, 0.09, 0.16, 0.16),
            feature(0.0, -0.13, 0.12, 0.06, 0.06),
            feature(-0.28, 0.17, 0.11, 0.06, -0.07),
            feature(0.28, 0.17, 0.11, 0.06, -0.07),
            feature(-0.28, 0.29, 0.16, 0.04, 0.035),
            feature(0.28, 0.29, 0.16, 0.04, 0.035),
            feature(0.0, -0.32, 0.22, 0.025, 0.035),
            feature(0.0, -0.39, 0.18, 0.02, -0.03),
            feature(0.0, -0.46, 0.18, 0.03, 0.03),
        ];
        direction * (1.0 + features.iter().sum::<f64>()) * DVec3::new(0.78, 0.9, 1.1)
    })
}

/// A model and its name.
pub type Named = (String, Triangles);

/// All models of the tables, with about as many facets as the paper's.
pub fn all() -> Vec<Named> {
    let named = |name: &str, triangles| (name.to_owned(), triangles);
    vec![
        named("shell", shell(130)),
        named("goblet", goblet(120)),
        named("hand", deformed(205, hand)),
        named("bumpy ball", deformed(140, bumps)),
        named("lens", deformed(120, |d| d * DVec3::new(1.0, 1.0, 0.3))),
    ]
}

/// A sphere of `rings` × `columns` pairs of facets.
#[allow(dead_code, reason = "each bench uses only some of the models")]
pub fn ball(radius: f64, rings: u32, columns: u32) -> Triangles {
    surface([rings, columns], |along, around| {
        direction(along, around) * radius
    })
}

/// A closed surface over a grid of rings and columns, between two poles: `at` takes both coordinates in 0 to 1, the first from
/// pole to pole.
fn surface([rings, columns]: [u32; 2], at: impl Fn(f64, f64) -> DVec3) -> Triangles {
    let point = |ring: u32, column: u32| {
        let along = f64::from(ring) / f64::from(rings);
        // A pole is one point, whatever the column.
        let column = if ring == 0 || ring == rings {
            0
        } else {
            column % columns
        };
        at(along, f64::from(column) / f64::from(columns)).as_vec3()
    };
    let mut triangles = Vec::new();
    for ring in 0..rings {
        for column in 0..columns {
            let [a, b] = [point(ring, column), point(ring, column + 1)];
            let [c, d] = [point(ring + 1, column), point(ring + 1, column + 1)];
            if ring > 0 {
                triangles.push([a, c, b]);
            }
            if ring + 1 < rings {
                triangles.push([b, c, d]);
            }
        }
    }
    triangles
}

/// The unit vector at two coordinates of a sphere, from the upper pole to the lower.
fn direction(along: f64, around: f64) -> DVec3 {
    let (polar, azimuth) = (along * std::f64::consts::PI, around * std::f64::consts::TAU);
    let ring = polar.sin();
    DVec3::new(ring * azimuth.cos(), ring * azimuth.sin(), polar.cos())
}

fn deformed(rings: u32, shape: impl Fn(DVec3) -> DVec3) -> Triangles {
    surface([rings, 2 * rings], |along, around| {
        shape(direction(along, around))
    })
}

/// A palm with five fingers: a sphere extended in five directions.
fn hand(direction: DVec3) -> DVec3 {
    let mut radius = 1.0;
    for finger in 0..5 {
        let angle = f64::from(finger) * 0.42 - 0.95;
        let tip = DVec3::new(angle.sin(), 0.15 * f64::from(finger % 2), angle.cos()).normalize();
        let length = if finger == 0 {
            0.7
        } else {
            1.1 + 0.1 * f64::from(finger % 3)
        };
        radius += length * (90.0 * (direction.dot(tip) - 1.0)).exp();
    }
    direction * radius * DVec3::new(1.0, 0.5, 1.2)
}

/// A sphere with many smooth bumps.
fn bumps(direction: DVec3) -> DVec3 {
    let wave = |scale: f64| {
        let [x, y, z] = (direction * scale).to_array();
        x.sin() * y.cos() + y.sin() * z.cos() + z.sin() * x.cos()
    };
    direction * (1.0 + 0.05 * wave(7.0) + 0.02 * wave(17.0))
}

/// A thin bent shell, open at its upper end: the outside, the rim and the inside.
fn shell(rings: u32) -> Triangles {
    let wall = 0.06;
    surface([rings, 2 * rings], |along, around| {
        // From the outer pole at the bottom up to the rim, and from there down to the inner pole.
        let (rise, inset) = if along < 0.5 {
            (along * 2.0, 0.0)
        } else {
            ((1.0 - along) * 2.0, wall)
        };
        let angle = around * std::f64::consts::TAU;
        let polar = rise * 2.3;
        let wobble = 1.0 + 0.12 * (3.0 * angle + 4.0 * rise).sin() + 0.25 * (5.0 * rise).sin();
        let ring = polar.sin() * (wobble - inset);
        let z = -polar.cos() * (1.3 - inset) + 0.1 * (2.0 * angle).sin() * rise;
        let bend = 0.5 * rise * rise;
        DVec3::new(ring * angle.cos() + bend, -ring * angle.sin(), z)
    })
}

/// A goblet: foot, stem and bowl, revolved about z.
fn goblet(rings: u32) -> Triangles {
    // Radius and height along the outline: from the foot's centre up the outside to the rim, and down the inside.
    let outline = [
        (0.0, 0.0),
        (1.6, 0.0),
        (1.65, 0.1),
        (0.5, 0.4),
        (0.25, 1.2),
        (0.3, 2.2),
        (1.0, 2.7),
        (1.6, 3.6),
        (1.7, 4.8),
        (1.6, 4.82),
        (1.5, 3.6),
        (0.9, 2.85),
        (0.0, 2.6),
    ];
    surface([rings, 2 * rings], |along, around| {
        let position = along * (outline.len() - 1) as f64;
        let piece = (position as usize).min(outline.len() - 2);
        // A smooth step rounds the corners.
        let part = position - piece as f64;
        let part = part * part * (3.0 - 2.0 * part) * 0.5 + part * 0.5;
        let (from, to) = (outline[piece], outline[piece + 1]);
        let radius = from.0 + (to.0 - from.0) * part;
        let angle = -around * std::f64::consts::TAU;
        DVec3::new(
            radius * angle.cos(),
            radius * angle.sin(),
            from.1 + (to.1 - from.1) * part,
        )
    })
}
