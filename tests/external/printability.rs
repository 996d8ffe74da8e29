//! Printability, against the components and distance transforms of `scipy.ndimage`.

use std::collections::BTreeMap;
use std::fs;
use std::process::Command;

use cusp_slicer::grid::{Bins, Grid};
use cusp_slicer::inspect::{Code, Held, Limits, Printability, Severities, Severity, inspect};
use cusp_slicer::ldi::cpu;
use cusp_slicer::mask::{Masks, Samples, Side};
use cusp_slicer::plan::Plan;
use cusp_slicer::progress::silent;
use libtest_mimic::{Failed, Trial};
use serde_json::json;

use crate::common::on_plate;
use crate::common::solids::{self, Triangles};
use crate::{Need, python, succeeds, trial};

const SCRIPT: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/tests/interop/python/printability.py"
);

/// Pixels of the longer side of a solid.
const PIXELS: f64 = 60.0;

/// Dark pixels on each side: more than any limit.
const PAD: usize = 24;

/// For each kind, the first and the last layer of each finding, and its pixels times bins. A part that begins above the
/// first layer, with nothing below, is a kind of its own: there other programs' islands are those of the checks.
type Found = BTreeMap<String, Vec<[u64; 3]>>;

pub fn trials() -> Vec<Trial> {
    let name = "printability::checks_are_those_of_scipy";
    let needs = &[Need::Python("scipy.ndimage")];
    vec![trial(name, needs, checks_are_those_of_scipy)]
}

/// Layers of two to six bins of a hundredth of the height.
fn plan_of(height_mm: f64, seed: u64) -> Plan {
    let mut rng = fastrand::Rng::with_seed(seed);
    let mut boundaries = vec![0u32];
    while boundaries[boundaries.len() - 1] < 100 {
        boundaries.push((boundaries[boundaries.len() - 1] + rng.u32(2..=6)).min(100));
    }
    Plan {
        bins: Bins::of_height(height_mm, height_mm / 100.0).expect("some bins"),
        boundaries,
        snap_planes: Vec::new(),
        exempt_layers: 0,
    }
}

/// One byte for each pixel of each layer.
fn pixels_of(masks: &Masks) -> Vec<u8> {
    let (width, height) = (masks.grid.width as usize, masks.grid.height as usize);
    let mut cursor = masks.cursor();
    let mut pixels = Vec::new();
    for layer in 0..masks.layers() {
        cursor.seek(masks, layer);
        let bits = cursor.whole(masks);
        let is_lit = |at: usize| {
            let byte = bits[at / width * width.div_ceil(8) + at % width / 8];
            byte >> (7 - at % width % 8) & 1
        };
        pixels.extend((0..width * height).map(is_lit));
    }
    pixels
}

fn by_scipy(masks: &Masks, plan: &Plan, limits: &Limits) -> Result<Found, Failed> {
    let folder = tempfile::TempDir::new()?;
    let [job, lit] = ["job.json", "lit.raw"].map(|name| folder.path().join(name));
    let bins: Vec<u32> = plan.boundaries.windows(2).map(|it| it[1] - it[0]).collect();
    let metadata = json!({
        "shape": [masks.layers(), masks.grid.height as usize, masks.grid.width as usize],
        "bins": bins,
        "bin_mm": plan.bins.size_mm,
        "pitch_mm": masks.grid.pitch_mm,
        "pitch_y_mm": masks.grid.pitch_y_mm,
        "pad": PAD,
        "limits": limits,
    });
    fs::write(&job, metadata.to_string())?;
    fs::write(&lit, pixels_of(masks))?;
    let mut command = Command::new(python());
    let output = succeeds(command.arg(SCRIPT).args([job, lit]))?;
    Ok(serde_json::from_slice(&output.stdout)?)
}

/// The script's name for findings of a code: specks are loose bodies too.
fn kind(code: Code) -> &'static str {
    match code {
        Code::LooseBody | Code::Speck => "loose",
        _ => code.name(),
    }
}

/// The findings in whole numbers.
fn in_whole_numbers(found: &Printability, masks: &Masks, plan: &Plan) -> Found {
    let kinds = [
        "loose",
        "trap",
        "narrow-drain",
        "thin-wall",
        "narrow-gap",
        "overhang",
        "begins",
    ];
    let mut all: Found = kinds.map(|kind| (kind.to_owned(), Vec::new())).into();
    let voxel_mm3 = masks.grid.pixel_mm2() * plan.bins.size_mm;
    for finding in &found.findings {
        if let Some(listed) = all.get_mut(kind(finding.code)) {
            let [first, last] = finding.layers.map(|layer| layer as u64);
            listed.push([first, last, (finding.volume_mm3 / voxel_mm3).round() as u64]);
        }
        if let Code::Island | Code::LooseBody | Code::Speck = finding.code
            && finding.layers[0] > 0
            && let Some(begins) = all.get_mut("begins")
        {
            let first = finding.layers[0] as u64;
            begins.push([first, first, 0]);
        }
    }
    for listed in all.values_mut() {
        listed.sort_unstable();
    }
    all
}

fn compare(name: &str, triangles: &Triangles) -> Result<usize, Failed> {
    let mesh = on_plate(triangles);
    let size = mesh.bounds().size();
    let pitch_mm = size.x.max(size.y).max(size.z / 4.0) / PIXELS;
    let plan = plan_of(size.z, 11);
    let bin_mm = plan.bins.size_mm;
    let limits = Limits {
        wall_mm: 9.0 * pitch_mm,
        gap_mm: 7.0 * pitch_mm,
        drain_mm: 6.0 * pitch_mm,
        overhang_mm: 4.0 * pitch_mm,
        bridge_mm: 20.0 * pitch_mm,
        floor_mm: 9.0 * bin_mm,
        cup_mm2: 0.0,
        trap_ml: 0.0,
        speck_px: 2,
        severity: Severities {
            separate_body: Severity::Review,
            ..Severities::default()
        },
        ..Limits::default()
    };
    limits.check()?;
    let pixels = [size.x, size.y].map(|size_mm| (size_mm / pitch_mm).ceil() as u32 + 4);
    let grid = Grid::plate(&mesh.bounds(), pixels, [pitch_mm; 2])?;
    let ldi = cpu::sample(&mesh, &grid.around_model(&mesh.bounds()), &mut silent)?;
    let masks = Masks::new(&ldi, &plan, &grid, Samples::ONE, Side::Above);
    let found = inspect(&masks, None, &plan, &limits, &Held::default(), &mut silent)?;
    let mut theirs = by_scipy(&masks, &plan, &limits)?;
    let bodies = theirs.remove("bodies").unwrap_or_default();
    assert_eq!(found.bodies, bodies.len(), "{name}: bodies");
    let mut ours = in_whole_numbers(&found, &masks, &plan);
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for count in &found.counts {
        *counts.entry(kind(count.code)).or_default() += count.found;
    }
    // Only the hundred largest of a code are listed.
    for kind in found.counts.iter().filter(|count| count.found > 100) {
        let kind = self::kind(kind.code);
        if let Some(theirs) = theirs.remove(kind) {
            assert_eq!(counts[kind], theirs.len(), "{name}: {kind}");
            ours.remove(kind);
        }
        if ["island", "loose"].contains(&kind) {
            ours.remove("begins");
            theirs.remove("begins");
        }
    }
    assert_eq!(ours, theirs, "{name}");
    Ok(ours.values().map(Vec::len).sum())
}

fn checks_are_those_of_scipy() -> Result<(), Failed> {
    let torture = solids::torture().into_iter();
    let torture = torture.map(|(name, triangles, _)| (name, triangles));
    let mut findings = 0;
    for (name, triangles) in solids::all().into_iter().chain(torture) {
        findings += compare(name, &triangles)?;
    }
    for seed in 0..10 {
        let boxes = solids::random_boxes(&mut fastrand::Rng::with_seed(seed), [0.1; 2]);
        findings += compare(&format!("boxes {seed}"), &boxes)?;
    }
    assert!(findings > 60, "{findings} findings in all");
    Ok(())
}
