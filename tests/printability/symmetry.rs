//! The same findings however a solid is written down, wherever it stands, and on any number of threads.

use cusp_slicer::inspect::{Held, Limits, Printability, inspect};
use cusp_slicer::mask::Samples;
use cusp_slicer::plan::Plan;
use cusp_slicer::progress::silent;

use super::{masks_with, plan_of, strict};
use crate::common::on_plate;
use crate::common::solids::{self, Triangles, random_boxes};

const PITCH_MM: f64 = 0.1;

fn plan(triangles: &Triangles) -> Plan {
    let bins = (on_plate(triangles).bounds().size().z / 0.02).ceil() as u32;
    let layers = bins.div_ceil(3);
    plan_of(0.02, (0..=layers).map(|layer| layer * 3).collect())
}

fn check(triangles: &Triangles, margin: [u32; 2]) -> Printability {
    let plan = plan(triangles);
    let masks = masks_with(triangles, [PITCH_MM; 2], &plan, Samples::ONE, margin);
    let limits = Limits {
        overhang_mm: 0.2,
        bridge_mm: 1.0,
        ..strict()
    };
    inspect(&masks, None, &plan, &limits, &Held::default(), &mut silent).unwrap()
}

/// Measures that do not depend on places: code, layers, area and volume, sorted.
fn measures(found: &Printability) -> Vec<String> {
    let findings = found.findings.iter();
    let mut all: Vec<String> = findings
        .map(|it| {
            let (code, layers, joins) = (it.code, it.layers, it.joins_layer);
            format!(
                "{code:?} {layers:?} {joins:?} {:.6} {:.6}",
                it.area_mm2, it.volume_mm3
            )
        })
        .collect();
    all.sort();
    all.push(format!("{:?} {}", found.verdict, found.bodies));
    all
}

fn cases() -> Vec<(String, Triangles)> {
    let random = (1000..1040).map(|seed| {
        let rng = &mut fastrand::Rng::with_seed(seed);
        (format!("seed {seed}"), random_boxes(rng, [PITCH_MM; 2]))
    });
    let small = solids::all().into_iter();
    let small = small.map(|(name, triangles)| {
        let smaller = |corners: &[glam::Vec3; 3]| corners.map(|corner| corner * 0.25);
        (name.to_owned(), triangles.iter().map(smaller).collect())
    });
    random.chain(small).collect()
}

#[test]
fn findings_are_the_same_in_any_order_of_facets() {
    for (name, triangles) in cases() {
        let shuffled = check(&solids::shuffled(&triangles), [4, 4]);
        assert_eq!(check(&triangles, [4, 4]), shuffled, "{name}");
    }
}

#[test]
fn findings_are_the_same_anywhere_on_the_screen() {
    for (name, triangles) in cases() {
        let (near, far) = (check(&triangles, [4, 4]), check(&triangles, [30, 18]));
        assert_eq!(measures(&near), measures(&far), "{name}");
        for (a, b) in near.findings.iter().zip(&far.findings) {
            for (a, b) in a.at_mm.iter().zip(b.at_mm) {
                assert!((a - b).abs() < 1e-9, "{name}");
            }
        }
    }
}

#[test]
fn a_mirrored_solid_has_the_same_findings() {
    for (name, triangles) in cases() {
        let mirrored = check(&solids::mirrored(&triangles), [4, 4]);
        assert_eq!(
            measures(&check(&triangles, [4, 4])),
            measures(&mirrored),
            "{name}"
        );
    }
}

#[test]
fn one_thread_finds_what_eight_find() {
    let pool = |threads| {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap()
    };
    let (one, eight) = (pool(1), pool(8));
    for (name, triangles) in cases() {
        let found = |pool: &rayon::ThreadPool| pool.install(|| check(&triangles, [4, 4]));
        assert_eq!(found(&one), found(&eight), "{name}");
    }
}

#[test]
fn a_check_can_be_cancelled() {
    let triangles = solids::cube(3.0);
    let plan = plan(&triangles);
    let masks = masks_with(&triangles, [PITCH_MM; 2], &plan, Samples::ONE, [4, 4]);
    let mut calls = 0;
    let mut stop = |_| {
        calls += 1;
        if calls == 3 {
            std::ops::ControlFlow::Break(())
        } else {
            std::ops::ControlFlow::Continue(())
        }
    };
    let found = inspect(&masks, None, &plan, &strict(), &Held::default(), &mut stop);
    assert!(found.is_err());
    assert_eq!(calls, 3);
}
