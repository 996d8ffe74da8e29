//! A scene whose layers are known, sliced in memory, and masks as runs.

#![allow(
    dead_code,
    unused_imports,
    reason = "each suite uses a different part of this module"
)]

#[path = "../../../common/mod.rs"]
mod cusp;

use std::io::{Cursor, Read};

use cusp::Slicer;
pub use cusp::{binary_stl, quiet, sample, solids};
use cusp_slicer::Error;
use cusp_slicer::format::Format;
use cusp_slicer::job::{Backend, Options, Planner, Report, Snap};
use cusp_slicer::plan::HeightRange;
use cusp_slicer::prepare::{AutoDrain, Hollowing, Supporting};
use cusp_slicer::resin::Resin;
use glam::Vec3;

/// Pixels and their pitch in millimetres.
#[derive(Debug, Clone, Copy)]
pub struct Screen {
    pub pixels: [u32; 2],
    pub pitch_mm: [f64; 2],
}

impl Screen {
    /// The place of the pixel that is lit by the needle of [`scene`], which may be mirrored.
    pub fn needle(self, is_mirrored: bool) -> u64 {
        let [columns, rows] = self.pixels.map(u64::from);
        let column = columns / 2;
        let column = if is_mirrored {
            columns - 1 - column
        } else {
            column
        };
        rows / 2 * columns + column
    }

    pub fn area(self) -> u64 {
        self.pixels.map(u64::from).iter().product()
    }
}

/// Tops of the layers of [`several`].
pub const TOPS_MM: [f64; 9] = [0.05, 0.1, 0.15, 0.2, 0.27, 0.34, 0.46, 0.58, 0.7];
/// Their exposures: two bottom layers, then those of [`resin`].
pub const EXPOSURES_S: [f64; 9] = [25.0, 25.0, 2.0, 2.0, 2.75, 2.75, 4.5, 4.5, 4.5];
/// The layer of [`several`] in which nothing is lit.
pub const BLACK: usize = 6;

/// A cone next to a block, which distinguish left and right; above a gap, a needle thinner than a pixel, which a single
/// ray meets. 0.7 mm high.
pub fn scene(screen: Screen) -> solids::Triangles {
    let mut scene = solids::cone(0.8, 0.3, 12);
    let block = solids::cuboid(Vec3::new(0.25, 0.5, 0.34));
    scene.extend(solids::moved(&block, Vec3::new(0.5, -0.75, 0.0)));
    // The middle of the screen is the corner of a pixel if it has an even number of them.
    let [x_mm, y_mm] = [0, 1].map(|axis| {
        let is_even = screen.pixels[axis].is_multiple_of(2);
        if is_even {
            screen.pitch_mm[axis] / 2.0
        } else {
            0.0
        }
    });
    let [width_mm, depth_mm] = screen.pitch_mm.map(|pitch_mm| pitch_mm / 4.0);
    let needle = Vec3::new(width_mm as f32, depth_mm as f32, 0.24);
    let corner = Vec3::new(
        (x_mm - width_mm / 2.0) as f32,
        (-y_mm - depth_mm / 2.0) as f32,
        0.46,
    );
    scene.extend(solids::moved(&solids::cuboid(needle), corner));
    scene
}

pub fn resin() -> Resin {
    Resin {
        name: "clear".to_owned(),
        exposures: vec![[0.05, 2.0], [0.07, 2.75], [0.12, 4.5], [0.15, 5.5]],
        bottom_layers: 2,
        bottom_exposure_s: 25.0,
        wait_s: 2.0,
        lift_mm: 6.0,
        lift_mm_min: 60.0,
        return_mm_min: 180.0,
        ..Resin::default()
    }
}

fn options() -> Options {
    Options {
        backend: Backend::Cpu,
        snap: Snap::Off,
        // Heights decide, not the surface.
        tolerance: Some(10.0),
        resin: resin(),
        ..Options::default()
    }
}

/// A hollow ball with a drain hole, on supports.
pub fn held() -> (solids::Triangles, Options) {
    let hollow = Hollowing {
        wall_mm: 1.0,
        cavity_mm: 1.0,
        auto_drain: Some(AutoDrain {
            diameter_mm: 1.0,
            ..AutoDrain::default()
        }),
        ..Hollowing::default()
    };
    let options = Options {
        hollow: Some(hollow),
        supports: Some(Supporting::default()),
        pitch_mm: Some(0.1),
        ..options()
    };
    (solids::sphere(4.0, 5), options)
}

/// Four layers of 50 µm, two of 70 µm and three of 120 µm.
pub fn several() -> Options {
    let range = |from_mm, to_mm, layer_mm| HeightRange {
        from_mm,
        to_mm,
        layer_min_mm: layer_mm,
        layer_max_mm: layer_mm,
    };
    Options {
        ranges: vec![
            range(0.0, 0.2, 0.05),
            range(0.2, 0.34, 0.07),
            range(0.34, 0.7, 0.12),
        ],
        ..options()
    }
}

pub fn uniform() -> Options {
    Options {
        planner: Planner::Uniform { layer_mm: 0.05 },
        ..options()
    }
}

/// On a screen of one's own, not mirrored.
pub fn on_screen(screen: Screen, options: Options) -> Options {
    Options {
        pixels: Some(screen.pixels),
        pitch_mm: Some(screen.pitch_mm[0]),
        pitch_y_mm: Some(screen.pitch_mm[1]),
        ..options
    }
}

pub fn load(triangles: &[[Vec3; 3]]) -> Slicer {
    Slicer::load(&binary_stl(triangles)).unwrap()
}

/// The print file of these options.
pub fn print_file(slicer: &mut Slicer, options: &Options) -> Result<(Vec<u8>, Report), Error> {
    pollster::block_on(slicer.plan(options, &mut quiet))?;
    let (bytes, report) = slicer.write_archive(Vec::new(), &mut quiet)?;
    Ok((bytes, report.clone()))
}

/// The masks of the same job in the format `png`: see [`of_png`].
pub fn png_masks(slicer: &mut Slicer, options: &Options, columns: u64) -> Vec<Runs> {
    let options = Options {
        format: Some(Format::Png),
        ..options.clone()
    };
    let (bytes, report) = print_file(slicer, &options).unwrap();
    let mut zip = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
    let masks = (0..report.layers).map(|layer| {
        let mut png = Vec::new();
        let mut entry = zip.by_name(&format!("layers/{layer:05}.png")).unwrap();
        entry.read_to_end(&mut png).unwrap();
        of_png(&png, columns)
    });
    masks.collect()
}

/// The pixels of a mask, row after row without a gap: brightness and number. Neighbours of one brightness are one run.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Runs(pub Vec<(u8, u64)>);

impl Runs {
    pub fn add(&mut self, grey: u8, pixels: u64) {
        match self.0.last_mut() {
            Some((last, count)) if *last == grey => *count += pixels,
            _ if pixels > 0 => self.0.push((grey, pixels)),
            _ => {}
        }
    }

    /// Number of pixels.
    pub fn area(&self) -> u64 {
        self.0.iter().map(|(_, pixels)| pixels).sum()
    }

    /// Number of pixels that are not black.
    pub fn lit(&self) -> u64 {
        let lit = self.0.iter().filter(|(grey, _)| *grey > 0);
        lit.map(|(_, pixels)| pixels).sum()
    }
}

impl FromIterator<(u8, u64)> for Runs {
    fn from_iter<I: IntoIterator<Item = (u8, u64)>>(runs: I) -> Self {
        let mut all = Self::default();
        for (grey, pixels) in runs {
            all.add(grey, pixels);
        }
        all
    }
}

/// Fails at the first run that differs, without printing masks of thousands of runs.
#[track_caller]
pub fn assert_same(read: &Runs, expected: &Runs, which: &str) {
    let pairs = read.0.iter().zip(&expected.0);
    let first = pairs.take_while(|(a, b)| a == b).count();
    assert_eq!(
        (first, read.0.get(first), read.0.len()),
        (expected.0.len(), None, expected.0.len()),
        "{which}: expected {:?}",
        expected.0.get(first)
    );
}

/// Decodes a PNG of one bit or one byte per pixel, or with three pixels in the colours of one. Each row is filled up to a
/// multiple of `columns` by dark pixels.
pub fn of_png(png: &[u8], columns: u64) -> Runs {
    let mut reader = png::Decoder::new(Cursor::new(png)).read_info().unwrap();
    let info = reader.info();
    let width = u64::from(info.width) * info.color_type.samples() as u64;
    let depth = info.bit_depth;
    let filling = width.next_multiple_of(columns) - width;
    let mut runs = Runs::default();
    while let Some(row) = reader.next_row().unwrap() {
        let mut left = width;
        // The last byte of a row may have more bits than there are pixels.
        let mut add = |grey, pixels: u64| {
            let pixels = pixels.min(left);
            left -= pixels;
            runs.add(grey, pixels);
        };
        for_each_run(row.data(), &mut |byte, bytes| match (depth, byte) {
            (png::BitDepth::Eight, _) => add(byte, bytes),
            (png::BitDepth::One, 0 | 255) => add(byte, 8 * bytes),
            (png::BitDepth::One, _) => {
                for bit in (0..8).rev().cycle().take(8 * bytes as usize) {
                    add((byte >> bit & 1) * 255, 1);
                }
            }
            other => panic!("{other:?}"),
        });
        runs.add(0, filling);
    }
    runs
}

/// Calls `emit` for stretches of equal bytes. Halves are compared whole, which is fast even where this is not optimised.
fn for_each_run(bytes: &[u8], emit: &mut impl FnMut(u8, u64)) {
    let Some((&first, rest)) = bytes.split_first() else {
        return;
    };
    if bytes[..rest.len()] == *rest {
        emit(first, bytes.len() as u64);
    } else {
        let (left, right) = bytes.split_at(bytes.len() / 2);
        for_each_run(left, emit);
        for_each_run(right, emit);
    }
}
