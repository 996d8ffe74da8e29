//! The zip of masks, read back with independent libraries.

use std::io::{Cursor, Read, Seek, SeekFrom, Write};

use crate::common::Slicer;
use crate::common::{binary_stl, quiet, solids};
use cusp_slicer::format::Format;
use cusp_slicer::job::{Backend, Options, Planner};
use cusp_slicer::warning::Warning;
use serde_json::Value;

use super::file;

fn slice(triangles: &solids::Triangles, options: &Options) -> (Slicer, Vec<u8>, Value) {
    let mut slicer = Slicer::load(&binary_stl(triangles)).unwrap();
    pollster::block_on(slicer.plan(options, &mut quiet)).unwrap();
    let (writer, report) = slicer
        .write_archive(Cursor::new(Vec::new()), &mut quiet)
        .unwrap();
    // Through text, as the manifest is written.
    let report = serde_json::from_str(&serde_json::to_string(report).unwrap()).unwrap();
    (slicer, writer.into_inner(), report)
}

fn options() -> Options {
    Options {
        rays: 203,
        backend: Backend::Cpu,
        ..Options::default()
    }
}

#[test]
fn the_zip_holds_every_mask_as_a_one_bit_png() {
    let (mut slicer, bytes, report) = slice(&solids::sphere(3.0, 4), &options());
    let mut zip = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
    let manifest: Value = serde_json::from_slice(&file(&mut zip, "manifest.json")).unwrap();
    let layers = report["layers"].as_u64().unwrap() as usize;
    assert_eq!(zip.len(), layers + 1);
    for layer in 0..layers {
        let entry = &manifest["layer_files"][layer];
        assert_eq!(entry["file"], format!("layers/{layer:05}.png"));
        assert_eq!(entry["z_mm"], report["z_mm"][layer + 1]);
        assert_eq!(entry["thickness_mm"], report["thickness_mm"][layer]);
        let png = file(&mut zip, entry["file"].as_str().unwrap());
        let mut reader = png::Decoder::new(Cursor::new(png)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        assert_eq!((info.width, info.height), (203, 203));
        assert_eq!(
            (info.color_type, info.bit_depth),
            (png::ColorType::Grayscale, png::BitDepth::One)
        );
        assert_eq!(pixels, slicer.mask(layer).unwrap());
        let lit: u32 = pixels.iter().map(|byte| byte.count_ones()).sum();
        assert_eq!(entry["lit_pixels"], lit);
    }
}

#[test]
fn the_manifest_repeats_the_report() {
    let (_, bytes, mut report) = slice(&solids::cone(2.0, 3.0, 16), &options());
    let mut zip = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
    let mut manifest: Value = serde_json::from_slice(&file(&mut zip, "manifest.json")).unwrap();
    // Without the parts that differ between machines.
    for key in ["timings_ms", "backend", "adapter", "gpu_method"] {
        assert!(manifest.get(key).is_none(), "{key}");
        report.as_object_mut().unwrap().remove(key);
    }
    assert_eq!(manifest["resin"]["exposure_s"], 3.0);
    manifest.as_object_mut().unwrap().remove("layer_files");
    assert_eq!(manifest, report);
}

#[test]
fn the_same_plan_gives_the_same_bytes_on_one_thread_and_on_many() {
    for format in [Format::Png, Format::Chitubox, Format::Uvj] {
        let options = Options {
            format: Some(format),
            ..options()
        };
        let bytes = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| slice(&solids::frame(), &options).1)
        };
        assert!(bytes(1) == bytes(4), "{format:?}");
    }
}

#[test]
fn a_change_of_tolerance_keeps_the_ldi_and_changes_the_plan() {
    let (mut slicer, _, first) = slice(&solids::sphere(3.0, 4), &options());
    let finer = Options {
        tolerance: Some(0.055),
        ..options()
    };
    let report = pollster::block_on(slicer.plan(&finer, &mut quiet)).unwrap();
    assert!(report.layers > first["layers"].as_u64().unwrap() as usize);
    assert_eq!(report.timings_ms.ldi, 0.0);
    let uniform = Options {
        planner: Planner::Uniform { layer_mm: 0.1 },
        ..options()
    };
    let report = pollster::block_on(slicer.plan(&uniform, &mut quiet)).unwrap();
    assert_eq!((report.layers, report.planner.as_str()), (60, "uniform"));
    assert!(matches!(
        report.all_warnings()[0],
        Warning::ToleranceExceeded { .. }
    ));
}

#[test]
fn after_an_infeasible_request_the_model_can_still_be_planned() {
    let mut slicer = Slicer::load(&binary_stl(&solids::sphere(3.0, 4))).unwrap();
    let impossible = Options {
        tolerance: Some(0.01),
        ..options()
    };
    let error = pollster::block_on(slicer.plan(&impossible, &mut quiet)).unwrap_err();
    assert_eq!(error.code(), "infeasible");
    assert_eq!(
        serde_json::to_value(&error).unwrap()["detail"]["from_mm"],
        0.0
    );
    assert_eq!(slicer.mask(0).unwrap_err().code(), "no-plan");
    assert!(pollster::block_on(slicer.plan(&options(), &mut quiet)).is_ok());
}

#[test]
fn an_open_model_slices_with_a_warning() {
    let mut open = solids::sphere(3.0, 4);
    open.truncate(open.len() - 40);
    let (_, _, report) = slice(&open, &options());
    let codes: Vec<_> = report["models"][0]["warnings"]
        .as_array()
        .unwrap()
        .iter()
        .map(|warning| &warning["code"])
        .collect();
    assert_eq!(codes, ["open-mesh", "unclosed-rays"]);
}

/// Offsets beyond 4 GiB, written by the calls that write print files, in a sparse file.
#[test]
fn zips_beyond_four_gibibytes_are_read_by_another_library() {
    const OFFSET: u64 = 5 << 30;
    let mut file = tempfile::tempfile().unwrap();
    file.seek(SeekFrom::Start(OFFSET)).unwrap();
    let mut zip = rawzip::ZipArchiveWriter::builder()
        .with_offset(OFFSET)
        .build(&mut file);
    for name in ["a.png", "b.png"] {
        let (mut entry, _) = zip.new_file(name).start().unwrap();
        entry.write_all(name.as_bytes()).unwrap();
        let crc = rawzip::crc32(name.as_bytes());
        let sum = rawzip::DataDescriptorOutput::new(crc, name.len() as u64);
        entry.finish(sum).unwrap();
    }
    zip.finish().unwrap();
    let mut zip = zip::ZipArchive::new(file).unwrap();
    assert_eq!(zip.len(), 2);
    for name in ["a.png", "b.png"] {
        let mut text = String::new();
        let mut entry = zip.by_name(name).unwrap();
        assert!(entry.header_start() >= OFFSET);
        entry.read_to_string(&mut text).unwrap();
        assert_eq!(text, name);
    }
}

#[test]
fn more_files_than_a_plain_zip_counts_are_all_there() {
    let options = Options {
        rays: 3,
        bin_mm: Some(0.001),
        planner: Planner::Uniform { layer_mm: 0.001 },
        ..options()
    };
    let tower = solids::cuboid(glam::Vec3::new(3.0, 3.0, 66.0));
    let (_, bytes, report) = slice(&tower, &options);
    let zip = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
    assert_eq!((zip.len(), &report["layers"]), (66_001, &66_000.into()));
}
