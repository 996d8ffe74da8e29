//! Print files as other programs read them, and masks as another slicer makes them.

use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::Slicer;
use cusp_slicer::format::Format;
use cusp_slicer::job::{Backend, Options, Planner, Report};
use cusp_slicer::prepare::{AutoDrain, Hollowing, Supporting};
use libtest_mimic::{Failed, Trial};
use tempfile::TempDir;

use crate::common::{binary_stl, quiet, solids};
use crate::{Need, PRUSA_SLICER, peer, succeeds, trial};

/// Decodes every mask of a print file with zlib alone and counts its lit pixels: one line per mask, in the zip's order.
const DECODE: &str = r"
import struct, sys, zipfile, zlib
with zipfile.ZipFile(sys.argv[1]) as archive:
    assert archive.testzip() is None
    for name in archive.namelist():
        if not name.endswith('.png') or 'preview' in name or 'thumbnail' in name:
            continue
        png = archive.read(name)
        width, height, depth, colour = struct.unpack('>IIBB', png[16:26])
        assert colour == 0
        at, data = 8, b''
        while at < len(png):
            length, kind = struct.unpack('>I4s', png[at:at + 8])
            body = png[at + 8:at + 8 + length]
            assert zlib.crc32(kind + body) == struct.unpack('>I', png[at + 8 + length:at + 12 + length])[0]
            data += body if kind == b'IDAT' else b''
            at += 12 + length
        row = 1 + (width * depth + 7) // 8
        rows = zlib.decompress(data)
        assert len(rows) == row * height and not any(rows[::row])
        if depth == 1:
            print(bin(int.from_bytes(rows, 'big')).count('1'))
        else:
            print(len(rows) - rows.count(0))
";

/// Without packages of others, so that any does.
const PYTHON: Need = Need::Program("python3", "--version");

pub fn trials() -> Vec<Trial> {
    vec![
        trial(
            "print_files::python_reads_every_mask",
            &[PYTHON],
            python_reads_every_mask,
        ),
        trial(
            "print_files::python_reads_more_files_than_zip_counts",
            &[PYTHON],
            python_reads_70_000_layers,
        ),
        trial(
            "print_files::pngcheck_finds_nothing",
            &[Need::Program("pngcheck", "-h")],
            pngcheck_finds_nothing,
        ),
        trial(
            "print_files::unzip_finds_nothing",
            &[Need::Program("unzip", "-v")],
            unzip_finds_nothing,
        ),
        trial(
            "print_files::masks_are_those_of_prusa_slicer",
            &[PRUSA_SLICER],
            masks_are_those_of_prusa_slicer,
        ),
        trial(
            "print_files::hollow_models_take_the_resin_of_prusa_slicers",
            &[PRUSA_SLICER],
            hollow_models_take_the_resin_of_prusa_slicers,
        ),
    ]
}

/// Slices into a file in a folder.
fn slice(
    folder: &Path,
    triangles: &solids::Triangles,
    options: &Options,
) -> Result<(PathBuf, Report), Failed> {
    let path = folder.join("print.zip");
    let mut slicer = Slicer::load(&binary_stl(triangles))?;
    pollster::block_on(slicer.plan(options, &mut quiet))?;
    let writer = BufWriter::new(File::create(&path)?);
    let (writer, report) = slicer.write_archive(writer, &mut quiet)?;
    let report = report.clone();
    writer.into_inner().map_err(|error| error.to_string())?;
    Ok((path, report))
}

/// Slices a solid with many contours, and a hollow one on supports, into every format, with and without grey, and passes each file to `look`.
fn print_files(
    mut look: impl FnMut(&Path, &Path, &Report) -> Result<(), Failed>,
) -> Result<(), Failed> {
    let solid = Options {
        rays: 301,
        planner: Planner::Uniform { layer_mm: 0.1 },
        backend: Backend::Cpu,
        ..Options::default()
    };
    let held = Options {
        hollow: Some(Hollowing {
            auto_drain: Some(AutoDrain::default()),
            ..Hollowing::default()
        }),
        supports: Some(Supporting::default()),
        ..solid.clone()
    };
    let cases = [
        (solids::gyroid(2, 24), solid),
        (solids::sphere(8.0, 5), held),
    ];
    for format in [Format::Png, Format::Chitubox, Format::Uvj, Format::Sl1] {
        for antialias in [1, 4] {
            for (triangles, options) in &cases {
                let options = Options {
                    format: Some(format),
                    antialias,
                    ..options.clone()
                };
                let folder = TempDir::new()?;
                let (path, report) = slice(folder.path(), triangles, &options)?;
                look(&path, folder.path(), &report)?;
            }
        }
    }
    Ok(())
}

/// The number of lit pixels of each mask of a print file, as Python decodes it.
fn lit_pixels(path: &Path) -> Result<Vec<u64>, Failed> {
    let output = succeeds(Command::new("python3").arg("-c").arg(DECODE).arg(path))?;
    let text = String::from_utf8(output.stdout)?;
    Ok(text.lines().map(str::parse).collect::<Result<_, _>>()?)
}

fn python_reads_every_mask() -> Result<(), Failed> {
    print_files(|path, _, report| {
        let found = lit_pixels(path)?;
        if found.len() != report.layers || found.contains(&0) {
            return Err(format!("{} layers, but {found:?}", report.layers).into());
        }
        let Ok(mut zip) = zip::ZipArchive::new(File::open(path)?) else {
            return Err("no zip".into());
        };
        // The manifest, if there is one, has the same numbers.
        let Ok(manifest) = zip.by_name("manifest.json") else {
            return Ok(());
        };
        let manifest: serde_json::Value = serde_json::from_reader(manifest)?;
        for (entry, lit) in manifest["layer_files"]
            .as_array()
            .into_iter()
            .flatten()
            .zip(found)
        {
            if entry["lit_pixels"] != lit {
                return Err(format!("{entry}, but {lit}").into());
            }
        }
        Ok(())
    })
}

/// With more than 65,535 files, the zip is a zip64.
fn python_reads_70_000_layers() -> Result<(), Failed> {
    let options = Options {
        rays: 3,
        bin_mm: Some(0.001),
        planner: Planner::Uniform { layer_mm: 0.001 },
        backend: Backend::Cpu,
        ..Options::default()
    };
    let folder = TempDir::new()?;
    let tower = solids::cuboid(glam::Vec3::new(3.0, 3.0, 70.0));
    let (path, report) = slice(folder.path(), &tower, &options)?;
    let found = lit_pixels(&path)?;
    if report.layers != 70_000 || found != vec![9; 70_000] {
        return Err(format!("{} layers, {} masks", report.layers, found.len()).into());
    }
    Ok(())
}

fn pngcheck_finds_nothing() -> Result<(), Failed> {
    print_files(|path, folder, report| {
        let Ok(mut zip) = zip::ZipArchive::new(File::open(path)?) else {
            return Err("no zip".into());
        };
        zip.extract(folder.join("files"))?;
        let pngs = pngs_of(&folder.join("files"))?;
        if pngs.len() < report.layers {
            return Err(format!("{} PNGs", pngs.len()).into());
        }
        succeeds(Command::new("pngcheck").arg("-q").args(pngs)).map(|_| ())
    })
}

fn pngs_of(folder: &Path) -> Result<Vec<PathBuf>, Failed> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            found.extend(pngs_of(&path)?);
        } else if path.extension().is_some_and(|extension| extension == "png") {
            found.push(path);
        }
    }
    Ok(found)
}

fn unzip_finds_nothing() -> Result<(), Failed> {
    print_files(|path, _, _| succeeds(Command::new("unzip").arg("-tq").arg(path)).map(|_| ()))
}

/// `prusa-slicer` hollows by a level set (OpenVDB): inward by the wall and a closing distance, and back by that.
fn hollow_models_take_the_resin_of_prusa_slicers() -> Result<(), Failed> {
    const PIXELS: u32 = 640;
    const SIDE_MM: f64 = 64.0;
    let cases = [
        ("ball", solids::sphere(15.0, 6)),
        ("cube", solids::cube(24.0)),
        ("cone", solids::cone(16.0, 30.0, 32)),
    ];
    for (name, triangles) in cases {
        let folder = TempDir::new()?;
        let path = |name| folder.path().join(name);
        let (model, theirs, settings) = (path("model.stl"), path("theirs.sl1"), path("hollow.ini"));
        fs::write(&model, binary_stl(&triangles))?;
        let lines = "hollowing_enable = 1\nhollowing_min_thickness = 2\nhollowing_quality = 1\nhollowing_closing_distance = 2";
        fs::write(&settings, lines)?;
        let mut command = peer::prusa_slicer(&model, &theirs, folder.path(), SIDE_MM, PIXELS);
        succeeds(command.arg("--load").arg(&settings))?;
        let area_mm2 = (SIDE_MM / f64::from(PIXELS)).powi(2);
        let lit = |mask: Vec<u8>| mask.iter().filter(|&&pixel| pixel > 127).count() as f64;
        let pixels: f64 = peer::sl1_masks(&theirs).into_iter().map(lit).sum();
        let theirs_ml = pixels * area_mm2 * 0.05 / 1e3;
        let options = Options {
            pixels: Some([PIXELS; 2]),
            pitch_mm: Some(SIDE_MM / f64::from(PIXELS)),
            hollow: Some(Hollowing {
                cavity_mm: 4.0,
                ..Hollowing::default()
            }),
            backend: Backend::Cpu,
            ..Options::default()
        };
        let mut slicer = Slicer::load(&binary_stl(&triangles))?;
        let ours_ml = pollster::block_on(slicer.plan(&options, &mut quiet))?.resin_ml;
        println!("{name}: {ours_ml:.3} ml, and {theirs_ml:.3} ml of prusa-slicer");
        if !(0.97..1.03).contains(&(ours_ml / theirs_ml)) {
            return Err(format!("{name}: {ours_ml} ml, and {theirs_ml} ml of prusa-slicer").into());
        }
    }
    Ok(())
}

/// `prusa-slicer` cuts the mesh at the middle of each layer and fills the contours. At most one lit pixel in a thousand may
/// differ, and only on a contour.
fn masks_are_those_of_prusa_slicer() -> Result<(), Failed> {
    const PIXELS: u32 = 2048;
    const SIDE_MM: f64 = 16.0;
    // Contours inside each other, and side by side.
    let mut hollow = solids::sphere(5.0, 6);
    hollow.extend(solids::inverted(&solids::sphere(3.7, 6)));
    let cone = solids::cone(2.0, 9.0, 30);
    hollow.extend(solids::moved(&cone, glam::Vec3::new(7.2, 1.0, -5.0)));
    let cases = [("ball", solids::sphere(6.0, 6)), ("hollow ball", hollow)];
    for (name, triangles) in cases {
        let folder = TempDir::new()?;
        let (model, theirs) = (
            folder.path().join("model.stl"),
            folder.path().join("theirs.sl1"),
        );
        fs::write(&model, binary_stl(&triangles))?;
        let options = Options {
            pixels: Some([PIXELS; 2]),
            pitch_mm: Some(SIDE_MM / f64::from(PIXELS)),
            format: Some(Format::Sl1),
            planner: Planner::Uniform { layer_mm: 0.05 },
            backend: Backend::Cpu,
            ..Options::default()
        };
        let (ours, report) = slice(folder.path(), &triangles, &options)?;
        succeeds(&mut peer::prusa_slicer(
            &model,
            &theirs,
            folder.path(),
            SIDE_MM,
            PIXELS,
        ))?;
        let (ours, theirs) = (peer::sl1_masks(&ours), peer::sl1_masks(&theirs));
        if ours.len() != report.layers || ours.len() != theirs.len() {
            return Err(format!("{name}: {} and {} masks", ours.len(), theirs.len()).into());
        }
        let side = PIXELS as usize;
        let (mut lit, mut differing) = (0u64, 0u64);
        for (layer, (own, their)) in ours.iter().zip(&theirs).enumerate() {
            lit += own.iter().filter(|&&pixel| pixel > 127).count() as u64;
            for place in 0..own.len() {
                if (own[place] > 127) == (their[place] > 127) {
                    continue;
                }
                differing += 1;
                let around = [place - 1, place + 1, place - side, place + side];
                let on_contour = |mask: &[u8]| {
                    let lit = |place: usize| mask[place] > 127;
                    around.into_iter().any(|other| lit(other) != lit(place))
                };
                if !on_contour(own) && !on_contour(their) {
                    let (row, column) = (place / side, place % side);
                    return Err(format!("{name}, layer {layer}: row {row}, column {column}").into());
                }
            }
        }
        if differing * 1000 > lit {
            return Err(format!("{name}: {differing} of {lit} lit pixels differ").into());
        }
    }
    Ok(())
}
