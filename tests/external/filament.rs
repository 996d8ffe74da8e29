//! Plans for filament printers as programs of others see them.

use std::fs::{self, File};
use std::path::Path;
use std::process::Command;

use crate::common::Slicer;
use cusp_slicer::format::Format;
use cusp_slicer::job::{Backend, Options, Report};
use cusp_slicer::profile::Metric;
use libtest_mimic::{Failed, Trial};
use tempfile::TempDir;

use crate::common::{binary_stl, quiet, solids};
use crate::{Need, PRUSA_SLICER, python, succeeds, trial};

/// Prints vertices, triangles and whether the mesh is closed, for each object of a 3MF.
const LIB3MF: &str = r"
import sys, lib3mf
wrapper = lib3mf.get_wrapper() if hasattr(lib3mf, 'get_wrapper') else lib3mf.Wrapper()
model = wrapper.CreateModel()
reader = model.QueryReader('3mf')
reader.SetStrictModeActive(True)
reader.ReadFromFile(sys.argv[1])
assert reader.GetWarningCount() == 0
items = model.GetBuildItems()
assert items.MoveNext() and not items.MoveNext()
meshes = model.GetMeshObjects()
while meshes.MoveNext():
    mesh = meshes.GetCurrentMeshObject()
    print(mesh.GetVertexCount(), mesh.GetTriangleCount(), mesh.IsManifoldAndOriented())
";

pub fn trials() -> Vec<Trial> {
    vec![
        trial(
            "filament::prusa_slicer_prints_every_layer_of_the_plan",
            &[PRUSA_SLICER],
            prusa_slicer_prints_every_layer_of_the_plan,
        ),
        trial(
            "filament::lib3mf_opens_every_file",
            &[Need::Python("lib3mf")],
            lib3mf_opens_every_file,
        ),
    ]
}

/// Five models, each of which has other layers. All end in a top that is wide enough for a thread: `prusa-slicer`
/// leaves out thinner parts of a tip.
fn models() -> Vec<(&'static str, solids::Triangles, Options)> {
    let options = |height_mm: f64| Options {
        format: Some(Format::Prusa3mf),
        height_mm: Some(height_mm),
        rays: 512,
        backend: Backend::Cpu,
        ..Options::default()
    };
    vec![
        ("ball", solids::sphere(10.0, 6), options(20.0)),
        (
            "hill",
            solids::profiled(
                &[
                    [0.0, 0.0],
                    [20.0, 0.0],
                    [16.0, 5.0],
                    [13.0, 12.0],
                    [7.0, 12.0],
                    [2.0, 9.0],
                ],
                15.0,
            ),
            Options {
                metric: Metric::FilamentRoundness,
                ..options(15.003)
            },
        ),
        ("gyroid", solids::gyroid(2, 24), options(18.0)),
        (
            "frame",
            solids::frame(),
            Options {
                max_change_mm: Some(0.02),
                tolerance: Some(0.2),
                ..options(12.34)
            },
        ),
        (
            "cylinder",
            solids::cylinder(6.0, 10.0, 30),
            Options {
                nozzle_mm: Some(0.6),
                ..options(11.111_111)
            },
        ),
    ]
}

fn slice(path: &Path, triangles: &solids::Triangles, options: &Options) -> Result<Report, Failed> {
    let mut slicer = Slicer::load(&binary_stl(triangles))?;
    pollster::block_on(slicer.plan(options, &mut quiet))?;
    let (_, report) = slicer.write_archive(File::create(path)?, &mut quiet)?;
    Ok(report.clone())
}

/// The height of each layer in the G-code that `prusa-slicer` makes of a file, in thousandths of a millimetre.
fn heights_in_gcode(path: &Path, nozzle_mm: f64, first_layer_mm: f64) -> Result<Vec<i64>, Failed> {
    let gcode = path.with_extension("gcode");
    let mut command = Command::new("prusa-slicer");
    command
        .args(["--gcode-comments", "--layer-height", "0.15"])
        .args(["--nozzle-diameter", &nozzle_mm.to_string()])
        .args(["--first-layer-height", &first_layer_mm.to_string()])
        .args(["--brim-width", "2", "-g", "-o"]);
    succeeds(command.arg(&gcode).arg(path))?;
    let heights = fs::read_to_string(&gcode)?;
    let heights = heights.lines().filter_map(|line| line.strip_prefix(";Z:"));
    let heights = heights.map(|z_mm| z_mm.parse::<f64>().map(|z_mm| (z_mm * 1e3).round() as i64));
    Ok(heights.collect::<Result<_, _>>()?)
}

fn prusa_slicer_prints_every_layer_of_the_plan() -> Result<(), Failed> {
    for (name, triangles, options) in models() {
        let folder = TempDir::new()?;
        let path = folder.path().join("model.3mf");
        let report = slice(&path, &triangles, &options)?;
        let Some(filament) = &report.print_file.filament else {
            return Err("no filament".into());
        };
        let planned: Vec<i64> = report.z_mm[1..]
            .iter()
            .map(|z_mm| (z_mm * 1e3).round() as i64)
            .collect();
        let printed = heights_in_gcode(&path, filament.nozzle_mm, filament.first_layer_mm)?;
        if printed != planned {
            let first = printed.iter().zip(&planned).position(|(a, b)| a != b);
            return Err(format!(
                "{name}: {} layers planned, {} printed, the first that differs is {first:?}",
                planned.len(),
                printed.len()
            )
            .into());
        }
        // With another first layer, all others are elsewhere.
        let wrong = heights_in_gcode(&path, filament.nozzle_mm, filament.first_layer_mm + 0.05)?;
        if wrong.iter().any(|z| planned.contains(z)) && wrong == planned {
            return Err(format!("{name}: a wrong first layer changes nothing").into());
        }
    }
    Ok(())
}

fn lib3mf_opens_every_file() -> Result<(), Failed> {
    for (name, triangles, options) in models() {
        for format in Format::FILAMENT {
            let folder = TempDir::new()?;
            let path = folder.path().join("model.3mf");
            let options = Options {
                format: Some(format),
                ..options.clone()
            };
            let report = slice(&path, &triangles, &options)?;
            let output = Command::new(python())
                .args(["-c", LIB3MF])
                .arg(&path)
                .output()?;
            let said = String::from_utf8_lossy(&output.stdout).into_owned();
            let words: Vec<&str> = said.split_whitespace().collect();
            let [_, triangles, is_closed] = words[..] else {
                let error = String::from_utf8_lossy(&output.stderr);
                return Err(format!("{name}: {said} {error}").into());
            };
            // The bodies of the frame touch along edges.
            let is_right = is_closed == "True" || name == "frame";
            if triangles.parse::<usize>()? < report.models[0].facets || !is_right {
                return Err(format!("{name}: {said}").into());
            }
        }
    }
    Ok(())
}
