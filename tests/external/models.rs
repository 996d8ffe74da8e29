//! Models that other programs write, and what others say of them: lib3mf, trimesh and PrusaSlicer.

use std::collections::HashMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common::Slicer;
use cusp_slicer::job::MeshInfo;
use cusp_slicer::model::ModelUnit;
use cusp_slicer::warning::Warning;
use libtest_mimic::{Failed, Trial};
use serde_json::Value;
use tempfile::TempDir;

use crate::common::{binary_stl, solids};
use crate::{Need, python, succeeds, trial};

const WRITER: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/tests/interop/python/models.py"
);
const PRUSA_SLICER: &str = "prusa-slicer";

pub fn trials() -> Vec<Trial> {
    const WRITERS: Need = Need::Python("lib3mf, trimesh");
    vec![
        trial(
            "models::models_of_lib3mf_and_trimesh_are_read_as_they_were_written",
            &[WRITERS],
            models_are_read_as_they_were_written,
        ),
        trial(
            "models::prusa_slicer_sees_the_same_bounds_and_volume",
            &[WRITERS, crate::PRUSA_SLICER],
            prusa_slicer_sees_the_same,
        ),
        trial(
            "models::what_prusa_slicer_writes_is_what_it_read",
            &[crate::PRUSA_SLICER],
            what_prusa_slicer_writes_is_what_it_read,
        ),
    ]
}

/// Has models written to a folder, and returns their descriptions.
fn write_models(folder: &Path) -> Result<Vec<Value>, Failed> {
    let output = succeeds(Command::new(python()).arg(WRITER).arg(folder))?;
    Ok(serde_json::from_slice(&output.stdout)?)
}

fn info(path: &Path) -> Result<MeshInfo, Failed> {
    Ok(Slicer::load(&fs::read(path)?)?.info())
}

fn numbers(value: &Value) -> Vec<f64> {
    let items = value.as_array().into_iter().flatten();
    items.filter_map(Value::as_f64).collect()
}

/// Fails unless two numbers differ by at most `tolerance`.
fn near(what: &str, found: f64, expected: f64, tolerance: f64) -> Result<(), Failed> {
    if (found - expected).abs() <= tolerance {
        return Ok(());
    }
    Err(format!("{what}: {found}, not {expected}").into())
}

/// lib3mf writes six decimals, of transforms too, so that transformed vertices may be off by a few millionths of the
/// model's size.
fn models_are_read_as_they_were_written() -> Result<(), Failed> {
    let folder = TempDir::new()?;
    let written = write_models(folder.path())?;
    if written.len() < 10 {
        return Err("too few models".into());
    }
    for model in written {
        let name = model["name"].as_str().ok_or("no name")?;
        let found = info(&folder.path().join(name))?;
        let unit = found.unit.map(ModelUnit::name);
        if unit != model["unit"].as_str() {
            return Err(format!("{name}: {unit:?}").into());
        }
        if found.facets as u64 != model["facets"] {
            return Err(format!("{name}: {} facets", found.facets).into());
        }
        let skipped = found.warnings.iter().find_map(|it| match it {
            Warning::SkippedObjects { objects } => Some(*objects as u64),
            _ => None,
        });
        if skipped.unwrap_or(0) != model["skipped"] {
            return Err(format!("{name}: {skipped:?} skipped").into());
        }
        let size = found.size_mm.iter().copied().fold(0.0, f64::max);
        let bounds = [found.bounds_mm.min, found.bounds_mm.max];
        for (found, expected) in bounds
            .iter()
            .zip(model["bounds"].as_array().ok_or("no bounds")?)
        {
            for (found, expected) in found.iter().zip(numbers(expected)) {
                near(name, *found, expected, 4e-6 * size)?;
            }
        }
        let volume = model["volume"].as_f64().ok_or("no volume")?;
        near(name, found.volume_mm3, volume, 4e-6 * volume)?;
    }
    Ok(())
}

/// Output of `prusa-slicer --info` for a file.
fn prusa_info(path: &Path) -> Result<HashMap<String, f64>, Failed> {
    let output = Command::new(PRUSA_SLICER)
        .arg("--info")
        .arg(path)
        .output()?;
    let text = String::from_utf8(output.stdout)?;
    let lines = text.lines().filter_map(|line| line.split_once(" = "));
    let numbers =
        lines.filter_map(|(name, value)| Some((name.to_owned(), value.trim().parse().ok()?)));
    Ok(numbers.collect())
}

/// `is_placed` is false where it puts the model elsewhere when it reads it.
fn assert_same_as_prusa(path: &Path, is_placed: bool) -> Result<(), Failed> {
    let (ours, theirs) = (info(path)?, prusa_info(path)?);
    let name = path.display().to_string();
    let of = |key: &str| theirs.get(key).copied().ok_or(format!("{name}: no {key}"));
    for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
        let size = of(&format!("size_{letter}"))?;
        near(&name, ours.size_mm[axis], size, 2e-6 * size.max(1.0))?;
        let least = of(&format!("min_{letter}"))?;
        if is_placed {
            near(&name, ours.bounds_mm.min[axis], least, 2e-6 * size.max(1.0))?;
        }
    }
    let volume = of("volume")?;
    near(&name, ours.volume_mm3, volume, 1e-5 * volume.max(1.0))?;
    near(&name, ours.facets as f64, of("number_of_facets")?, 0.0)
}

/// It refuses supports as items, and the names that trimesh gives to objects.
fn prusa_slicer_sees_the_same() -> Result<(), Failed> {
    let folder = TempDir::new()?;
    write_models(folder.path())?;
    for name in [
        "millimeter.3mf",
        "centimeter.3mf",
        "inch.3mf",
        "foot.3mf",
        "trimesh.obj",
        "ball.stl",
    ] {
        assert_same_as_prusa(&folder.path().join(name), true)?;
    }
    Ok(())
}

fn what_prusa_slicer_writes_is_what_it_read() -> Result<(), Failed> {
    let folder = TempDir::new()?;
    for (name, triangles) in [
        ("ball", solids::sphere(6.0, 5)),
        ("cone", solids::cone(3.0, 9.0, 40)),
    ] {
        let model = folder.path().join(format!("{name}.stl"));
        fs::write(&model, binary_stl(&triangles))?;
        for format in ["3mf", "obj"] {
            let written = folder.path().join(format!("{name}.{format}"));
            let export = format!("--export-{format}");
            let mut command = Command::new(PRUSA_SLICER);
            succeeds(command.arg(export).arg("-o").arg(&written).arg(&model))?;
            assert_same_as_prusa(&written, false)?;
            let (ours, theirs) = (info(&model)?, info(&written)?);
            near(
                name,
                theirs.volume_mm3,
                ours.volume_mm3,
                1e-5 * ours.volume_mm3,
            )?;
            near(name, theirs.facets as f64, ours.facets as f64, 0.0)?;
        }
    }
    Ok(())
}
