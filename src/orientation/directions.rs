//! Directions on the unit sphere: a lattice, rings around a direction, and rotations that turn one upright. Only basic
//! arithmetic and square roots are used, so the results are the same on every machine.

use std::f64::consts::PI;

use glam::{DQuat, DVec3};

/// Cosine and sine of the golden angle, (3 − √5) · π.
const GOLDEN: [f64; 2] = [-0.737_368_878_078_319_9, 0.675_490_294_261_523_8];

/// Cosine and sine of 7.5°, half the step of [`about_z`].
const HALF_STEP: [f64; 2] = [0.991_444_861_373_810_4, 0.130_526_192_220_051_6];

/// A Fibonacci lattice: `count` directions spread evenly over the sphere, in descending order of z.
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

/// Typical distance, in radians, between neighbours among `count` directions that share the sphere equally.
pub fn spacing(count: usize) -> f64 {
    (4.0 * PI / count.max(1) as f64).sqrt()
}

/// Six directions in a ring around `direction`, at about `distance` radians.
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

/// The unit vector along `vector`, which must not be 0.
pub fn unit(vector: DVec3) -> DVec3 {
    vector / vector.length()
}

/// The shortest rotation that turns `direction` to +z.
pub fn upright(direction: DVec3) -> DQuat {
    // From −z all half-turns are equally short; this is the one about x.
    if direction.z <= -1.0 + 1e-12 {
        return DQuat::from_xyzw(1.0, 0.0, 0.0, 0.0);
    }
    let turn = DQuat::from_xyzw(direction.y, -direction.x, 0.0, 1.0 + direction.z);
    turn / turn.length()
}

/// Rotations about z by 0° to 165° in steps of 15°; 0° and 90° come first.
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
