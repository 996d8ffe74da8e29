//! Masks that no model gives: runs of every length at which chunks change, on the largest screens, written without slicing.

use cusp_slicer::archive::{self, Layer, MaskSource, PlacedMesh, PreviewScene, PrintJob, Screen};
use cusp_slicer::format::Format;
use cusp_slicer::mask::{LayerRuns, Run, RunReader, RunSource};
use cusp_slicer::progress::silent;
use cusp_slicer::resin::Resin;

use crate::common::{Runs, assert_same, sample, solids};
use crate::readers::READERS;

/// Masks that are known.
struct Planted {
    masks: Vec<Runs>,
    width: u32,
}

/// The next layer.
struct Reader<'a>(&'a Planted, usize);

impl RunSource for Planted {
    fn reader(&self) -> Box<dyn RunReader + '_> {
        Box::new(Reader(self, 0))
    }
}

impl RunReader for Reader<'_> {
    fn next(&mut self, layers: usize) -> LayerRuns {
        let Self(planted, next) = self;
        let masks = &planted.masks[*next..*next + layers];
        *next += layers;
        LayerRuns::new(masks.iter().map(|mask| cut(mask, planted.width)))
    }
}

/// The lit runs of a mask, cut at the ends of rows.
fn cut(mask: &Runs, width: u32) -> Vec<Run> {
    let mut runs = Vec::new();
    let mut place = 0;
    for &(grey, pixels) in &mask.0 {
        let end = place + pixels as u32;
        while grey > 0 && place < end {
            let row_end = (place / width + 1) * width;
            runs.push(Run {
                first: place,
                pixels: row_end.min(end) - place,
                grey,
            });
            place = row_end.min(end);
        }
        place = end;
    }
    runs
}

/// Writes these masks, and compares what both crates read.
fn check(pixels: [u32; 2], masks: Vec<Runs>) {
    let (mesh, ldi) = sample(&solids::cube(1.0), 10);
    let placed = PlacedMesh {
        mesh: &mesh,
        rays: ldi.grid,
        first_rays: vec![[0; 2]],
    };
    let layers: Vec<Layer> = (1..=masks.len())
        .map(|layer| Layer {
            z_mm: 0.05 * layer as f64,
            thickness_mm: 0.05,
            exposure_s: 3.0,
        })
        .collect();
    let source = Planted {
        masks,
        width: pixels[0],
    };
    let job = PrintJob {
        screen: Screen {
            pixels,
            pitch_mm: [0.014, 0.019],
            is_mirrored: false,
            antialias: 8,
        },
        layers: &layers,
        masks: MaskSource::Runs(&source),
        height_mm: 1.0,
        resin: &Resin::default(),
        transition_layers: 0,
        resin_ml: 1.0,
        printer: None,
        best_uniform: &|| None,
        look: &|longest| PreviewScene::new(std::slice::from_ref(&placed), longest),
        manifest: &|| unreachable!("the format has none"),
    };
    let bytes = archive::write(Format::Goo, &job, Vec::new(), &mut silent).unwrap();
    for (reader, read) in READERS {
        let print = read(&bytes);
        assert_eq!(print.head.pixels.map(u32::from), pixels);
        assert_eq!(print.layers.len(), source.masks.len());
        for (index, (read, expected)) in print.layers.iter().zip(&source.masks).enumerate() {
            assert_same(&read.1, expected, &format!("{reader}, layer {index}"));
        }
    }
}

/// Appends black pixels up to the area.
fn filled(runs: impl IntoIterator<Item = (u8, u64)>, area: u64) -> Runs {
    let mut runs: Runs = runs.into_iter().collect();
    runs.add(0, area - runs.area());
    runs
}

#[test]
fn a_screen_of_16k_is_read_whole_or_pixel_by_pixel() {
    let [width, height] = [16_384, 12_288];
    let area = width * height;
    let masks = vec![
        filled([(255, area)], area),
        filled([], area),
        filled([(1, area)], area),
        filled([(255, 1)], area),
        filled([(0, area - 1), (254, 1)], area),
        filled([(0, width - 1), (255, 1)], area),
        filled([(0, width - 1), (255, 2)], area),
        filled([(255, width), (127, width), (255, width)], area),
        // Half the screen, from the middle of a row to the middle of another.
        filled([(0, area / 4 - 7), (255, area / 2 + 19)], area),
        // Every other pixel of a row.
        filled([(255, 1), (0, 1)].repeat(8192), area),
    ];
    check([16_384, 12_288], masks);
}

#[test]
fn runs_are_read_on_either_side_of_every_length_at_which_chunks_change() {
    let [width, height] = [8192, 8192];
    let area = width * height;
    let ends: [u64; 3] = [1 << 4, 1 << 12, 1 << 20];
    let lengths: Vec<u64> = ends
        .iter()
        .flat_map(|end| [end - 1, *end, end + 1])
        .chain([1, 2, 255, 256, 65_535, 65_536])
        .collect();
    let mut masks = Vec::new();
    for (lit, between) in [(255, 0), (0, 255), (255, 254), (1, 2), (128, 0)] {
        let runs = lengths
            .iter()
            .flat_map(|&length| [(between, 1), (lit, length)]);
        masks.push(filled(runs, area));
        let runs = lengths.iter().map(|&length| (lit, length));
        let runs = runs.flat_map(|run| [run, (between, run.1)]);
        masks.push(filled(runs, area));
    }
    check([8192, 8192], masks);
}

#[test]
fn a_run_longer_than_a_chunk_can_be_is_read() {
    // As many pixels as a mask can have, one more than the longest chunk.
    let area = cusp_slicer::grid::MAX_PIXELS;
    assert_eq!(area, 1 << 28);
    let masks = vec![
        filled([(255, area)], area),
        filled([(77, area)], area),
        filled([(255, 1)], area),
        filled([], area),
    ];
    check([16_384, 16_384], masks);
}
