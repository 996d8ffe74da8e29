//! Against brute force on voxels.

use cusp_slicer::inspect::{Code, Held, Limits, Printability, Severity, inspect};
use cusp_slicer::mask::{Masks, Samples};
use cusp_slicer::plan::Plan;
use cusp_slicer::progress::silent;

use super::voxels::{Found, Voxels};
use super::{masks_of, plan_of, strict};
use crate::common::{on_plate, solids};

/// The findings in whole numbers.
fn in_whole_numbers(found: &Printability, masks: &Masks, plan: &Plan) -> Vec<Found> {
    let has_area = |code| {
        [
            Code::Island,
            Code::LooseBody,
            Code::SeparateBody,
            Code::Speck,
            Code::Cup,
            Code::Trap,
        ]
        .contains(&code)
    };
    let pixel_mm2 = masks.grid.pixel_mm2();
    let mut all: Vec<Found> = found
        .findings
        .iter()
        .map(|finding| {
            let volume = (finding.volume_mm3 / pixel_mm2 / plan.bins.size_mm).round() as u64;
            let area = (finding.area_mm2 / pixel_mm2).round() as u64;
            let area = if has_area(finding.code) { area } else { 0 };
            (
                finding.code,
                finding.layers,
                volume,
                area,
                finding.joins_layer,
            )
        })
        .collect();
    all.sort();
    all
}

fn by_brute_force(masks: &Masks, plan: &Plan, limits: &Limits) -> Vec<Found> {
    let voxels = Voxels::new(masks, plan);
    let mut all = voxels.bodies(limits);
    all.extend(voxels.hollows());
    all.extend(voxels.overhangs(limits));
    all.extend(voxels.thin_walls(limits));
    all.extend(voxels.narrow_gaps(limits));
    all.extend(voxels.narrow_drains(limits));
    all.extend(voxels.small_holes(limits));
    all.extend(voxels.thin_floors(limits));
    all.extend(voxels.low_gaps(limits));
    all.sort();
    all
}

#[track_caller]
fn compare(name: &str, masks: &Masks, plan: &Plan, limits: &Limits) -> usize {
    let found = inspect(masks, None, plan, limits, &Held::default(), &mut silent).unwrap();
    let mut listed = in_whole_numbers(&found, masks, plan);
    let mut expected = by_brute_force(masks, plan, limits);
    for count in &found.counts {
        let of_code = expected.iter().filter(|it| it.0 == count.code).count();
        assert_eq!(count.found, of_code, "{name}: {:?}", count.code);
        if count.found > 100 {
            listed.retain(|it| it.0 != count.code);
            expected.retain(|it| it.0 != count.code);
        }
    }
    assert_eq!(listed, expected, "{name}");
    expected.len()
}

/// Layers of one to four bins.
fn random_plan(rng: &mut fastrand::Rng, height_mm: f64) -> Plan {
    let mut boundaries = vec![0];
    while f64::from(*boundaries.last().unwrap()) * 0.02 < height_mm {
        boundaries.push(boundaries.last().unwrap() + rng.u32(1..=4));
    }
    plan_of(0.02, boundaries)
}

/// The masks of a random solid in a random plan, on pixels that need not be square.
fn random_masks(
    rng: &mut fastrand::Rng,
    solid: fn(&mut fastrand::Rng, [f64; 2]) -> solids::Triangles,
) -> (Masks, Plan) {
    let pitch_mm = [[0.1; 2], [0.1, 0.07], [0.05, 0.08]][rng.usize(0..3)];
    let triangles = solid(rng, pitch_mm);
    let plan = random_plan(rng, on_plate(&triangles).bounds().size().z);
    let masks = masks_of(&triangles, pitch_mm, &plan, Samples::ONE);
    (masks, plan)
}

#[test]
pub fn random_boxes_have_the_findings_of_brute_force() {
    let mut all = 0;
    for seed in 0..300 {
        let rng = &mut fastrand::Rng::with_seed(seed);
        let (masks, plan) = random_masks(rng, solids::random_boxes);
        let length = |rng: &mut fastrand::Rng| f64::from(rng.u32(0..12)) * 0.05;
        let limits = Limits {
            wall_mm: length(rng),
            floor_mm: length(rng) / 2.0,
            gap_mm: length(rng),
            drain_mm: length(rng),
            hole_mm: length(rng),
            low_gap_mm: length(rng) / 2.0,
            overhang_mm: length(rng) / 2.0,
            bridge_mm: length(rng) * 2.0,
            self_supporting_slope: [0.2, 0.344, 1.0][rng.usize(0..3)],
            speck_px: rng.u32(0..6),
            ..strict()
        };
        all += compare(&format!("seed {seed}"), &masks, &plan, &limits);
    }
    assert!(all > 2000, "{all} findings in all");
}

/// A box with cavities and narrow channels into them.
fn random_hollows(rng: &mut fastrand::Rng, pitch_mm: [f64; 2]) -> solids::Triangles {
    const SIZE: [usize; 3] = [24, 22, 20];
    let mut is_dark = vec![false; SIZE.iter().product()];
    let mut carve = |from: [usize; 3], to: [usize; 3]| {
        for (y, z) in (from[1]..to[1]).flat_map(|y| (from[2]..to[2]).map(move |z| (y, z))) {
            let row = (z * SIZE[1] + y) * SIZE[0];
            is_dark[row + from[0]..row + to[0]].fill(true);
        }
    };
    for _ in 0..rng.u32(1..=2) {
        let from = SIZE.map(|most| rng.usize(1..most / 2));
        let to = [0, 1, 2].map(|axis| rng.usize(from[axis] + 4..SIZE[axis]));
        carve(from, to);
        for _ in 0..rng.u32(1..=2) {
            let axis = rng.usize(0..3);
            let mut start = [0, 1, 2].map(|axis| rng.usize(from[axis]..to[axis]));
            let mut end = [0, 1, 2].map(|axis| SIZE[axis].min(start[axis] + rng.usize(1..=6)));
            if rng.bool() {
                start[axis] = 0;
            } else {
                end[axis] = SIZE[axis];
            }
            carve(start, end);
        }
    }
    let [x_mm, y_mm] = pitch_mm.map(|it| it as f32);
    let mut all = Vec::new();
    for (row, is_dark) in is_dark.chunks(SIZE[0]).enumerate() {
        let (y, z) = ((row % SIZE[1]) as f32, (row / SIZE[1]) as f32);
        let mut x = 0;
        for cells in is_dark.chunk_by(|one, next| one == next) {
            let end = x + cells.len();
            if !cells[0] {
                let low = [x as f32 * x_mm, y * y_mm, z * 0.06];
                let high = [end as f32 * x_mm, (y + 1.0) * y_mm, (z + 1.0) * 0.06];
                all.extend(super::block(low, high));
            }
            x = end;
        }
    }
    all
}

#[test]
pub fn random_hollows_have_the_findings_of_brute_force() {
    let mut drains = 0;
    for seed in 0..100 {
        let rng = &mut fastrand::Rng::with_seed(seed);
        let (masks, plan) = random_masks(rng, random_hollows);
        let pitch_mm = masks.grid.pitch_mm;
        let limits = Limits {
            drain_mm: f64::from(rng.u32(2..8)) * pitch_mm,
            hole_mm: f64::from(rng.u32(2..8)) * pitch_mm,
            ..strict()
        };
        compare(&format!("seed {seed}"), &masks, &plan, &limits);
        let found = inspect(&masks, None, &plan, &limits, &Held::default(), &mut silent).unwrap();
        drains += super::of_code(&found, Code::NarrowDrain).len();
    }
    assert!(drains > 25, "{drains} narrow drains in all");
}

#[test]
fn solids_have_the_findings_of_brute_force() {
    let torture = solids::torture().into_iter();
    let torture = torture.map(|(name, triangles, _)| (name, triangles));
    for (name, triangles) in solids::all().into_iter().chain(torture) {
        let mesh = on_plate(&triangles);
        let size = mesh.bounds().size();
        let pitch_mm = size.x.max(size.y).max(size.z / 4.0) / 30.0;
        let bin_mm = size.z / 100.0;
        let rng = &mut fastrand::Rng::with_seed(5);
        let mut boundaries = vec![0];
        while *boundaries.last().unwrap() < 100 {
            boundaries.push((boundaries.last().unwrap() + rng.u32(2..=6)).min(100));
        }
        let plan = plan_of(bin_mm, boundaries);
        let limits = Limits {
            wall_mm: 6.0 * pitch_mm,
            floor_mm: 9.0 * bin_mm,
            gap_mm: 5.0 * pitch_mm,
            drain_mm: 4.0 * pitch_mm,
            hole_mm: 6.0 * pitch_mm,
            low_gap_mm: 9.0 * bin_mm,
            overhang_mm: 3.0 * pitch_mm,
            bridge_mm: 20.0 * pitch_mm,
            ..strict()
        };
        for samples in [Samples::ONE, Samples::of_level(4).unwrap()] {
            let masks = masks_of(&triangles, [pitch_mm; 2], &plan, samples);
            compare(name, &masks, &plan, &limits);
        }
    }
}

#[test]
fn what_is_ignored_is_not_found() {
    let triangles = crate::common::solids::frame();
    let plan = super::layers_of(10.0);
    let masks = masks_of(&triangles, [0.1; 2], &plan, Samples::ONE);
    let mut limits = Limits {
        bridge_mm: 0.0,
        ..strict()
    };
    let has_overhang = |limits: &Limits| {
        let found = inspect(&masks, None, &plan, limits, &Held::default(), &mut silent).unwrap();
        found.findings.iter().any(|it| it.code == Code::Overhang)
    };
    assert!(has_overhang(&limits));
    limits.severity.overhang = Severity::Ignore;
    assert!(!has_overhang(&limits));
}
