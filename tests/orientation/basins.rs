//! Islands and cups of directions: in closed form, and against the checks of printability on masks.

use crate::common::Slicer;
use cusp_slicer::inspect::{Code, Limits};
use cusp_slicer::job::Options;
use cusp_slicer::orientation::{Exclusion, Metrics, Quality, Search, SearchOptions};
use glam::{DVec3, Quat, Vec3};

use super::{few, measure, metrics, options, solids, turned};
use crate::common::{assert_near, load, quiet};

/// A square vessel on z = 0, open at the top.
fn vessel(side: f32, height: f32, wall: f32) -> solids::Triangles {
    let ring = |inset: f32, z: f32| {
        let (low, high) = (inset, side - inset);
        [(low, low), (high, low), (high, high), (low, high)].map(|(x, y)| Vec3::new(x, y, z))
    };
    let rings = [
        ring(0.0, 0.0),
        ring(0.0, height),
        ring(wall, height),
        ring(wall, wall),
    ];
    let mut triangles = vec![];
    for pair in rings.windows(2) {
        for i in 0..4 {
            let j = (i + 1) % 4;
            triangles.push([pair[0][i], pair[0][j], pair[1][j]]);
            triangles.push([pair[0][i], pair[1][j], pair[1][i]]);
        }
    }
    let [a, b, c, d] = rings[0];
    triangles.extend([[a, c, b], [a, d, c]]);
    let [a, b, c, d] = rings[3];
    triangles.extend([[a, b, c], [a, c, d]]);
    triangles
}

fn found(triangles: &solids::Triangles, up: DVec3) -> (usize, f64) {
    let Metrics {
        islands, cups_mm2, ..
    } = metrics(&mut load(triangles), &options(), up);
    (islands, cups_mm2)
}

#[test]
fn a_vessel_is_a_cup_either_way_up_but_not_on_its_side() {
    let vessel = vessel(12.0, 9.0, 1.5);
    let inside = 81.0;
    // Upside down the plate is its bottom.
    for up in [DVec3::Z, -DVec3::Z] {
        let (islands, cups_mm2) = found(&vessel, up);
        assert_eq!(islands, 0);
        assert_near(cups_mm2, inside, 1e-3);
    }
    for up in [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y] {
        assert_eq!(found(&vessel, up), (0, 0.0));
    }
    // Tilted a little, it still holds something; far over, it spills.
    let tilted = |degrees: f64| {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        found(&vessel, DVec3::new(sine, 0.0, cosine))
    };
    let (_, little) = tilted(20.0);
    assert!((40.0..200.0).contains(&little), "{little}");
    assert_eq!(tilted(92.0).1, 0.0);
}

#[test]
fn a_cup_with_a_hole_in_its_bottom_is_none() {
    // A tube that leans: it stands on an edge, and its contents run out below.
    let mut tube = vessel(12.0, 9.0, 1.5);
    tube.truncate(tube.len() - 4);
    let ring = |inset: f32| {
        let (low, high) = (inset, 12.0 - inset);
        [(low, low), (high, low), (high, high), (low, high)].map(|(x, y)| Vec3::new(x, y, 0.0))
    };
    let (outer, inner) = (ring(0.0), ring(1.5));
    for corner in tube.iter_mut().flatten() {
        if corner.z == 1.5 {
            corner.z = 0.0;
        }
    }
    for i in 0..4 {
        let j = (i + 1) % 4;
        tube.push([outer[i], inner[j], outer[j]]);
        tube.push([outer[i], inner[i], inner[j]]);
    }
    let leaning = DVec3::new(0.4, 0.2, 0.9).normalize();
    assert_eq!(found(&tube, leaning), (0, 0.0));
    // Upright, the plate closes it.
    assert_near(found(&tube, DVec3::Z).1, 81.0, 1e-3);
}

#[test]
fn what_lies_within_another_body_is_no_island() {
    let ball = solids::sphere(5.0, 3);
    let pair = |apart: f32| {
        let mut both = ball.clone();
        both.extend(solids::moved(&ball, Vec3::Z * apart));
        both
    };
    // Apart, the upper one hangs in the air; overlapping, it grows out of the lower one.
    assert_eq!(found(&pair(12.0), DVec3::Z).0, 1);
    assert_eq!(found(&pair(7.0), DVec3::Z).0, 0);
    // Side by side, both stand on the plate.
    assert_eq!(found(&pair(12.0), DVec3::X).0, 0);
    // Shells: each ball in a hollow is loose, and a closed hollow is no cup.
    let (_, shells, _) = solids::torture()
        .into_iter()
        .find(|it| it.0 == "nested shells")
        .unwrap();
    for up in [DVec3::Z, DVec3::new(0.6, 0.0, -0.8)] {
        assert_eq!(found(&shells, up), (1, 0.0));
    }
}

/// A ball with pits and bumps all over, of which no two are near each other.
fn knobbly() -> solids::Triangles {
    let towards: Vec<DVec3> = (0..14)
        .map(|number: u32| {
            let z = 1.0 - (f64::from(number) + 0.5) / 7.0;
            let turn = 2.399_963 * f64::from(number);
            DVec3::new(
                (1.0 - z * z).sqrt() * turn.cos(),
                (1.0 - z * z).sqrt() * turn.sin(),
                z,
            )
        })
        .collect();
    let mut ball = solids::sphere(1.0, 6);
    for corner in ball.iter_mut().flatten() {
        let at = corner.as_dvec3().normalize();
        let bumps = towards.iter().zip([1.0, -0.8].iter().cycle());
        let bumps: f64 = bumps
            .map(|(to, sign)| sign * (40.0 * (at.dot(*to) - 1.0)).exp())
            .sum();
        *corner = (at * (8.0 + 2.5 * bumps)).as_vec3();
    }
    ball
}

#[test]
fn islands_and_cups_are_those_of_the_checks() {
    let ball = knobbly();
    let limits = Limits::default();
    let options = Options {
        pitch_mm: Some(0.05),
        ..options()
    };
    let mut slicer = Slicer::load(&super::binary_stl(&ball)).unwrap();
    let directions: Vec<[f64; 3]> = slicer.directions(&options, 12).unwrap();
    let (mut all, mut differing) = ([0, 0], 0);
    for candidate in measure(&mut slicer, &options, &directions) {
        let metrics = candidate.metrics.unwrap();
        let turned = Options {
            rotation: Some(candidate.rotation),
            ..options.clone()
        };
        pollster::block_on(slicer.plan(&turned, &mut quiet)).unwrap();
        let checked = slicer.inspect(&limits, &mut quiet).unwrap();
        let of = |codes: &[Code]| {
            checked
                .findings
                .iter()
                .filter(|it| codes.contains(&it.code))
                .count()
        };
        let islands = of(&[Code::Island, Code::LooseBody, Code::Speck]);
        let cups_mm2: f64 = checked
            .findings
            .iter()
            .filter(|it| it.code == Code::Cup)
            .map(|it| it.area_mm2)
            .sum();
        assert!(metrics.islands.abs_diff(islands) <= 1);
        // A cup ends with the layer that lets it spill: it may lose, or gain, what that layer would have had.
        let off_mm2 = (metrics.cups_mm2 - cups_mm2).abs();
        assert!(off_mm2 <= 1.4 + 0.1 * cups_mm2, "{off_mm2} of {cups_mm2}");
        differing += metrics.islands.abs_diff(islands);
        all[0] += islands;
        all[1] += of(&[Code::Cup]);
    }
    assert!(
        differing <= 1 && all[0] >= 15 && all[1] >= 10,
        "{differing}, {all:?}"
    );
}

#[test]
fn limits_exclude_directions_and_can_be_lifted_again() {
    let model = turned(&vessel(12.0, 9.0, 1.5), Quat::from_rotation_x(0.3));
    let mut slicer = load(&model);
    let mut orient =
        |search: &SearchOptions| slicer.orient(&options(), search, &mut quiet).unwrap();
    let free = orient(&few(150));
    let dry = SearchOptions {
        most_cups_mm2: Some(0.0),
        ..few(150)
    };
    let found = orient(&dry);
    assert!(!found.best.is_empty());
    assert!(
        found
            .best
            .iter()
            .all(|it| it.metrics.unwrap().cups_mm2 == 0.0)
    );
    let excluded = |it: &&_| {
        let it: &cusp_slicer::orientation::Candidate = it;
        it.excluded == Some(Exclusion::Cups)
    };
    let count = found.candidates.iter().filter(excluded).count();
    let wet = free
        .candidates
        .iter()
        .filter(|it| it.metrics.unwrap().cups_mm2 > 0.0)
        .count();
    assert!(count > 0 && count == wet, "{count} of {wet}");
    // They keep their metrics, so that other limits need no new measurement.
    let again = Search::of_measured(few(150), found.candidates).unwrap();
    let again: Vec<_> = again.rated().into_iter().flatten().collect();
    assert_eq!(again, free.candidates);
    let nothing = orient(&SearchOptions {
        most_overhang_mm2: Some(0.0),
        most_cups_mm2: Some(0.0),
        most_islands: Some(0),
        quality: Quality::Islands,
        ..few(150)
    });
    assert!(
        nothing
            .best
            .iter()
            .all(|it| it.metrics.unwrap().overhang_mm2 == 0.0)
    );
}
