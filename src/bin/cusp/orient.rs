//! The search for the best direction, whole or in parts.

use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::Path;

use cusp_slicer::direction::shard::Part;
use cusp_slicer::direction::{Candidate, Exclusion, Orientation};
use cusp_slicer::mesh::Pose;
use cusp_slicer::options::Options;
use cusp_slicer::pipeline::Slicer;
use stl_io::{Normal, Triangle, Vertex};

use crate::arguments::Orienting;
use crate::files::{Failure, file_beside, in_file, keep, load_weighted, place_for};
use crate::terminal::{Bar, duration, print, print_json, stop_on_interrupt};

pub fn orient(orienting: &Orienting) -> Result<(), Failure> {
    orienting.choices.check("orient");
    let options = orienting.choices.options()?;
    if orienting.models.len() > 1 && orienting.apply.is_some() {
        return Err("--apply is for one model".to_owned().into());
    }
    let parts = read_parts(orienting)?;
    let target = orienting.output.as_deref().map(|output| {
        let place = place_for(output, &orienting.models[0]);
        place
            .map(|place| (output, place))
            .map_err(|reason| in_file(output, &reason))
    });
    let target = target.transpose()?;
    stop_on_interrupt();
    for model in &orienting.models {
        let mut slicer = load_weighted(model, &orienting.choices)?;
        let bar = Bar::new();
        let mut progress = |stage, fraction| bar.report(stage, fraction);
        let search = orienting.search();
        if let Some(shard) = orienting.shard {
            let part = slicer.measure_shard(&options, &search, shard, &mut progress);
            let part = part.map_err(|error| Failure::in_file(model, &error))?;
            drop(bar);
            print_json(&part)?;
            continue;
        }
        let found = if orienting.merge.is_empty() {
            slicer.orient(&options, &search, &mut progress)
        } else {
            let candidates = slicer
                .merge_shards(&options, &search, &parts)
                .map_err(|error| in_file(model, &error))?;
            slicer.choose(&options, &search, candidates, &mut progress)
        };
        let found = found.map_err(|error| Failure::in_file(model, &error))?;
        drop(bar);
        if let (Some(number), Some((output, place))) = (orienting.apply, &target) {
            let candidate = found.best.get(number as usize - 1).ok_or_else(|| {
                let reason = format!("there are only {} best directions", found.best.len());
                in_file(model, &reason)
            })?;
            apply(&slicer, &options, candidate, output, place)?;
        }
        if orienting.json {
            print_json(&found)?;
        } else {
            print(&describe(model, &options, &found))?;
        }
    }
    Ok(())
}

/// The parts to merge: files of one JSON object a line.
fn read_parts(orienting: &Orienting) -> Result<Vec<Part>, Failure> {
    let mut parts = Vec::new();
    for path in &orienting.merge {
        let text = fs::read_to_string(path).map_err(|error| in_file(path, &error))?;
        for line in text.lines() {
            parts.push(serde_json::from_str(line).map_err(|error| in_file(path, &error))?);
        }
    }
    Ok(parts)
}

/// Writes the model as it stands in a direction, on the plate, as a binary STL.
fn apply(
    slicer: &Slicer,
    options: &Options,
    candidate: &Candidate,
    output: &Path,
    place: &Path,
) -> Result<(), Failure> {
    let pose = Pose {
        rotation: Some(candidate.rotation),
        height_mm: options.height_mm.map(|_| candidate.size_mm[2]),
    };
    let corners = slicer.positions_on_plate(&pose);
    let corners = corners.map_err(|error| Failure::in_file(output, &error))?;
    let (facets, _) = corners.as_chunks::<9>();
    let facets = facets
        .iter()
        .map(|&[ax, ay, az, bx, by, bz, cx, cy, cz]| Triangle {
            // Programs work it out from the corners.
            normal: Normal::new([0.0; 3]),
            vertices: [[ax, ay, az], [bx, by, bz], [cx, cy, cz]].map(Vertex::new),
        });
    let mut file = file_beside(place).map_err(|error| in_file(output, &error))?;
    let mut bytes = Vec::new();
    stl_io::write_stl(&mut bytes, facets).map_err(|error| in_file(output, &error))?;
    file.write_all(&bytes)
        .map_err(|error| in_file(output, &error))?;
    keep(file, place, output)
}

fn describe(model: &Path, options: &Options, found: &Orientation) -> String {
    let excluded = |why| {
        let candidates = found.candidates.iter();
        candidates.filter(|it| it.excluded == Some(why)).count()
    };
    let mut text = format!("{}: {} directions", model.display(), found.candidates.len());
    for (why, words) in [
        (Exclusion::TooLarge, "too large for the plate"),
        (Exclusion::TooHigh, "too high for the printer"),
        (Exclusion::NoPlan, "without a plan within tolerance"),
    ] {
        let count = excluded(why);
        if count > 0 {
            let _ = write!(text, ", {count} {words}");
        }
    }
    if found.best.is_empty() {
        text.push_str(
            "\nthere is no direction to print it in; choose another printer or wider limits",
        );
        return text;
    }
    text.push_str(
        "\n     energy  layers  time         largest error  roughness   overhang     size",
    );
    let rows = found.best.iter().enumerate();
    let rows = rows.map(|(place, candidate)| ((place + 1).to_string(), candidate));
    for (name, candidate) in rows.chain([("now".to_owned(), &found.now)]) {
        let [x, y, z] = candidate.size_mm;
        let Some(figures) = &candidate.figures else {
            let _ = write!(
                text,
                "\n{name:<4} does not fit: {x:.1} × {y:.1} × {z:.1} mm"
            );
            continue;
        };
        let _ = write!(
            text,
            "\n{name:<4} {:.4}  {:>6}  {:<11}  {:<13}  {:<10}  {:<11}  {x:.1} × {y:.1} × {z:.1} mm",
            candidate.energy.unwrap_or_default(),
            figures.layers,
            duration(figures.print_time_s),
            options.metric.words(figures.max_error),
            format!("{:.4} mm", figures.roughness_mm),
            format!("{:.1} mm²", figures.overhang_mm2),
        );
    }
    let [x, y, z, w] = found.best[0].rotation;
    let _ = write!(text, "\nas in the first: --rotation={x},{y},{z},{w}");
    text
}
