//! Directions on the unit sphere: evenly spread, around one another, and turned upright. By basic arithmetic and square
//! roots alone, so that they are the same on every machine.

use std::f64::consts::PI;

use glam::{DQuat, DVec3};

/// Cosine and sine of the golden angle, (3 − √5) · π.
const GOLDEN: [f64; 2] = [-0.737_368_878_078_319_9, 0.675_490_294_261_523_8];

/// Cosine and sine of half of 15°.
const HALF_STEP: [f64; 2] = [0.991_444_861_373_810_4, 0.130_526_192_220_051_6];

/// Directions spread evenly over the sphere, from the one nearest +z to the one nearest −z: a Fibonacci lattice.
pub fn lattice(count: usize) -> Vec<DVec3> {
    let [cosine, sine] = GOLDEN;
    let (mut x, mut y) = (1.0f64, 0.0f64);
    (0..count)
        .map(|i| {
            let z = 1.0 - (2 * i + 1) as f64 / count as f64;
            let radius = (1.0 - z * z).sqrt();
            let direction = DVec3::new(x * radius, y * radius, z);
            (x, y) = (x * cosine - y * sine, x * sine + y * cosine);
            let length = (x * x + y * y).sqrt();
            (x, y) = (x / length, y / length);
            direction
        })
        .collect()
}

/// The usual distance between neighbours of so many directions, in radians: each has an equal part of the sphere.
pub fn spacing(count: usize) -> f64 {
    (4.0 * PI / count.max(1) as f64).sqrt()
}

/// Six directions around one, at a distance in radians.
pub fn around(direction: DVec3, distance: f64) -> [DVec3; 6] {
    let [x, y, z] = direction.to_array().map(f64::abs);
    let axis = if x <= y && x <= z {
        DVec3::X
    } else if y <= z {
        DVec3::Y
    } else {
        DVec3::Z
    };
    let across = direction.cross(axis);
    let u = across / across.length() * distance;
    let v = direction.cross(u);
    let (half, height) = (0.5, 0.75f64.sqrt());
    [
        u,
        u * half + v * height,
        v * height - u * half,
        -u,
        -(u * half + v * height),
        u * half - v * height,
    ]
    .map(|step| unit(direction + step))
}

/// The direction of a vector that is not 0.
pub fn unit(vector: DVec3) -> DVec3 {
    vector / vector.length()
}

/// The rotation that turns a direction to +z by the shortest way.
pub fn upright(direction: DVec3) -> DQuat {
    // Opposite to +z every way is as short.
    if direction.z <= -1.0 + 1e-12 {
        return DQuat::from_xyzw(1.0, 0.0, 0.0, 0.0);
    }
    let turn = DQuat::from_xyzw(direction.y, -direction.x, 0.0, 1.0 + direction.z);
    turn / turn.length()
}

/// Rotations about z by 0 to 165° in steps of 15°, first those by right angles.
pub fn about_z() -> impl Iterator<Item = DQuat> {
    let [cosine, sine] = HALF_STEP;
    let mut turn = DQuat::IDENTITY;
    let steps: Vec<DQuat> = (0..12)
        .map(|_| {
            let now = turn;
            let (c, s) = (turn.w, turn.z);
            turn = DQuat::from_xyzw(0.0, 0.0, s * cosine + c * sine, c * cosine - s * sine);
            now
        })
        .collect();
    let by_right_angles = [0, 6].into_iter();
    by_right_angles
        .chain((1..12).filter(|&step| step != 6))
        .map(move |step| steps[step])
}
