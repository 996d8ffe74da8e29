//! `cargo xtask bench filament MODEL=HEIGHT...`: layers for a filament printer compared with the adaptive layers of
//! PrusaSlicer, for which its command line has no switch. Its planner is written again here from its description in
//! docs/filament.md.
//!
//! Prints a table: for each model and quality, layers and largest cusp of that planner, the layers that Cusp needs for that cusp, and
//! the least cusp of as many layers. All have a first layer of 0.2 mm, whose cusp does not count, and layers of 0.07 to 0.3 mm.

#[path = "../tests/common/slicer.rs"]
mod slicer;

use std::fs;
use std::path::Path;

use cusp_slicer::format::Format;
use cusp_slicer::job::{Backend, Options, Report};
use cusp_slicer::model::Pose;
use cusp_slicer::profile::{Metric, Profile, Source};
use slicer::Slicer;

const LEAST_MM: f64 = 0.07;
const MOST_MM: f64 = 0.3;
const FIRST_MM: f64 = 0.2;
/// The layer height that the slicer is set to, which is its quality of 0.5.
const NOMINAL_MM: f64 = 0.2;

/// A facet as the adaptive planner sees it.
struct Facet {
    from_mm: f64,
    to_mm: f64,
    /// Sine and cosine of the angle between the normal and z, as absolute values.
    sine: f64,
    cosine: f64,
}

fn facets(slicer: &Slicer, pose: &Pose) -> Vec<Facet> {
    let positions = slicer.positions_on_plate(pose).expect("a pose");
    let mut facets: Vec<Facet> = positions
        .as_chunks::<9>()
        .0
        .iter()
        .map(|corners| {
            let [a, b, c] = [0, 3, 6].map(|corner| {
                glam::DVec3::from([0, 1, 2].map(|axis| f64::from(corners[corner + axis])))
            });
            let normal = (b - a).cross(c - a).normalize_or_zero();
            Facet {
                from_mm: a.z.min(b.z).min(c.z),
                to_mm: a.z.max(b.z).max(c.z),
                sine: normal.truncate().length(),
                cosine: normal.z.abs(),
            }
        })
        .collect();
    facets.sort_by(|a, b| a.from_mm.total_cmp(&b.from_mm));
    facets
}

/// The thickness at which the triangle of a step on this facet is as large as a deviation of `deviation_mm` allows.
fn thickness_on(facet: &Facet, deviation_mm: f64) -> f64 {
    let most_mm = deviation_mm / 0.184;
    if facet.cosine > 1e-5 {
        most_mm.min(1.44 * deviation_mm * (facet.sine / facet.cosine).sqrt())
    } else {
        most_mm
    }
}

/// The tops of the adaptive layers: greedily from the plate up, each as thick as the facets allow that it meets.
fn adaptive(facets: &[Facet], height_mm: f64, quality: f64) -> Vec<f64> {
    const TOUCHING_MM: f64 = 1e-4;
    let between = |from_mm: f64, to_mm: f64, part: f64| from_mm + (to_mm - from_mm) * part;
    let deviation_mm = if quality < 0.5 {
        between(LEAST_MM, NOMINAL_MM, 2.0 * quality)
    } else {
        between(NOMINAL_MM, MOST_MM, 2.0 * quality - 1.0)
    };
    let mut tops = vec![FIRST_MM];
    let mut below_mm = FIRST_MM;
    loop {
        let mut thickness_mm = MOST_MM;
        let crossing = facets.iter().take_while(|facet| facet.from_mm < below_mm);
        for facet in crossing.filter(|facet| facet.to_mm >= below_mm + TOUCHING_MM) {
            thickness_mm = thickness_mm.min(thickness_on(facet, deviation_mm));
        }
        thickness_mm = thickness_mm.max(LEAST_MM);
        let begins = facets.partition_point(|facet| facet.from_mm < below_mm);
        for facet in &facets[begins..] {
            let above_mm = facet.from_mm - below_mm;
            if above_mm >= thickness_mm {
                break;
            }
            if facet.to_mm < below_mm + TOUCHING_MM {
                continue;
            }
            // A facet that asks for thinner layers ends the layer at its own bottom, or makes it as thin as itself.
            let reduced_mm = thickness_on(facet, deviation_mm);
            thickness_mm = thickness_mm.min(reduced_mm.max(above_mm));
        }
        thickness_mm = thickness_mm.max(LEAST_MM);
        if below_mm + thickness_mm / 2.0 >= height_mm {
            return tops;
        }
        below_mm += thickness_mm;
        tops.push(below_mm);
    }
}

/// The largest cusp of the layers above the first.
fn largest_cusp(profile: &Profile, tops: &[f64]) -> f64 {
    let bin_mm = profile.bins.size_mm;
    let mut sums = vec![0.0];
    for &density in &profile.density {
        sums.push(sums[sums.len() - 1] + f64::from(density) * bin_mm);
    }
    let below = |z_mm: f64| {
        let place = (z_mm / bin_mm).clamp(0.0, (sums.len() - 1) as f64);
        let whole = (place as usize).min(sums.len() - 2);
        sums[whole] + (sums[whole + 1] - sums[whole]) * (place - whole as f64)
    };
    let cusps = tops.windows(2).map(|pair| below(pair[1]) - below(pair[0]));
    cusps.fold(0.0, f64::max)
}

fn plan(slicer: &mut Slicer, options: &Options) -> Report {
    let mut quiet = |_, _| std::ops::ControlFlow::Continue(());
    let planned = pollster::block_on(slicer.plan(options, &mut quiet));
    planned.expect("a plan").clone()
}

fn main() {
    let models = std::env::args().skip(1).filter(|it| !it.starts_with("--"));
    println!(
        "| model, height | its quality | its layers | its largest cusp | Cusp's layers at that cusp | fewer | Cusp's least cusp with as \
         many | smaller |\n|---|---:|---:|---:|---:|---:|---:|---:|"
    );
    for model in models {
        let (path, height) = model.split_once('=').expect("MODEL=HEIGHT");
        let height_mm: f64 = height.parse().expect("a height in mm");
        let mut slicer = Slicer::load(&fs::read(path).expect("a file")).expect("a model");
        let options = Options {
            format: Some(Format::Prusa3mf),
            height_mm: Some(height_mm),
            backend: Backend::Cpu,
            ..Options::default()
        };
        let pose = Pose::of_height(height_mm);
        let facets = facets(&slicer, &pose);
        plan(&mut slicer, &options);
        let profile = slicer.profile(Metric::Cusp, Source::Exact).expect("a plan");
        for quality in [0.25, 0.5, 0.75] {
            let tops = adaptive(&facets, height_mm, quality);
            let cusp_mm = largest_cusp(&profile, &tops);
            let at_that = Options {
                tolerance: Some(cusp_mm),
                ..options.clone()
            };
            let at_that = plan(&mut slicer, &at_that);
            let with_as_many = Options {
                max_layers: Some(tops.len()),
                ..options.clone()
            };
            let with_as_many = plan(&mut slicer, &with_as_many);
            let name = Path::new(path).file_stem().unwrap_or_default();
            let less = |ours: f64, theirs: f64| 100.0 * (1.0 - ours / theirs);
            println!(
                "| {}, {height} mm | {quality} | {} | {cusp_mm:.3} | {} | {:.0} % | {:.3} | {:.0} % |",
                name.to_string_lossy(),
                tops.len(),
                at_that.layers,
                less(at_that.layers as f64, tops.len() as f64),
                with_as_many.max_error,
                less(with_as_many.max_error, cusp_mm)
            );
        }
    }
}
