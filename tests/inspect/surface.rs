//! The surface that a view shows of a print file.

use std::collections::HashMap;

use crate::common::Slicer;
use cusp_slicer::archive::read::{Layer, Mask, PrintFile, inspect, inspect_masks, surface};
use cusp_slicer::job::{Backend, Options};
use cusp_slicer::progress::silent;

use crate::common::{binary_stl, quiet, solids};

/// Three corners of a facet.
type Corners = [[f32; 3]; 3];

fn facets(positions: &[f32]) -> Vec<Corners> {
    let (facets, rest) = positions.as_chunks::<9>();
    assert!(rest.is_empty());
    let corner =
        |facet: &[f32; 9], place: usize| std::array::from_fn(|axis| facet[3 * place + axis]);
    let corners = facets.iter();
    corners
        .map(|facet| std::array::from_fn(|place| corner(facet, place)))
        .collect()
}

/// The volume that facets enclose.
fn volume(facets: &[Corners]) -> f64 {
    let six = facets.iter().map(|facet| {
        let [a, b, c] = facet.map(|corner| glam::DVec3::from(corner.map(f64::from)));
        a.dot(b.cross(c))
    });
    six.sum::<f64>() / 6.0
}

/// Returns true if each edge has a partner the other way round.
fn is_closed(facets: &[Corners]) -> bool {
    let mut edges: HashMap<[[u32; 3]; 2], i32> = HashMap::new();
    for facet in facets {
        let corners = facet.map(|corner| corner.map(f32::to_bits));
        for (from, to) in [(0, 1), (1, 2), (2, 0)] {
            *edges.entry([corners[from], corners[to]]).or_default() += 1;
            *edges.entry([corners[to], corners[from]]).or_default() -= 1;
        }
    }
    edges.values().all(|&count| count == 0)
}

fn layer(z_mm: f64, thickness_mm: f64) -> Layer {
    Layer {
        z_mm,
        thickness_mm,
        ..Layer::default()
    }
}

/// A disk in a square of pixels.
fn disk(pixels: u32, radius: f64) -> Mask {
    let middle = f64::from(pixels) / 2.0;
    let rows: Vec<Vec<u16>> = (0..pixels)
        .map(|row| {
            let y = f64::from(row) + 0.5 - middle;
            let half = (radius * radius - y * y).max(0.0).sqrt();
            let ends = [middle - half, middle + half].map(|column| column.round() as u16);
            if ends[0] < ends[1] {
                ends.to_vec()
            } else {
                Vec::new()
            }
        })
        .collect();
    Mask::of_rows(rows.iter().map(Vec::as_slice))
}

#[test]
fn a_cylinder_is_closed_upright_and_as_large_as_it_prints() {
    // Fewer pixels than cells, as many, and more; layers thicker and thinner than a cell.
    for (pixels, pixel_mm, layers) in [
        (60, [0.5, 0.5], 20),
        (200, [0.1, 0.15], 300),
        (900, [0.03, 0.03], 40),
    ] {
        let radius = f64::from(pixels) / 2.0 - 3.0;
        let mask = disk(pixels, radius);
        let thickness_mm = 12.0 / f64::from(layers);
        let tops = (1..=layers).map(|layer| f64::from(layer) * thickness_mm);
        let printed: Vec<Layer> = tops.map(|z_mm| layer(z_mm, thickness_mm)).collect();
        let masks = vec![mask; printed.len()];
        let facets = facets(&surface(&printed, &masks, [pixels; 2], pixel_mm));
        assert!(is_closed(&facets));
        let expected = std::f64::consts::PI * radius * radius * pixel_mm[0] * pixel_mm[1] * 12.0;
        let ratio = volume(&facets) / expected;
        assert!((0.98..1.04).contains(&ratio), "{pixels}: {ratio}");
        let ends = |axis: usize| {
            let places = facets.iter().flatten().map(|corner| corner[axis]);
            let low = places.clone().fold(f32::INFINITY, f32::min);
            [low, places.fold(f32::NEG_INFINITY, f32::max)].map(f64::from)
        };
        let cell_mm = (radius * 2.0 * pixel_mm[1]).max(12.0) / 160.0;
        for (axis, side_mm) in pixel_mm.into_iter().enumerate() {
            let half = radius * side_mm;
            let [low, high] = ends(axis);
            assert!((low + half).abs() < cell_mm + side_mm, "{low} {half}");
            assert!((high - half).abs() < cell_mm + side_mm, "{high} {half}");
        }
        let [low, high] = ends(2);
        assert!(
            low.abs() < cell_mm && (high - 12.0).abs() < cell_mm,
            "{low} {high}"
        );
    }
}

#[test]
fn a_lone_pixel_and_a_thin_wall_have_a_surface_and_nothing_has_none() {
    let of = |mask: Mask, z_mm: f64, pixels: [u32; 2]| {
        surface(&[layer(z_mm, z_mm)], &[mask], pixels, [0.05; 2])
    };
    let one = Mask::of_rows([&[][..], &[2, 3]].into_iter());
    let lone = facets(&of(one, 0.05, [5, 4]));
    assert!(is_closed(&lone));
    assert!(volume(&lone) > 0.0);
    // Half a cell wide, and as high as one.
    let wall = Mask::of_rows([&[0, 320][..]].into_iter());
    let wall = facets(&of(wall, 0.1, [320, 3]));
    assert!(is_closed(&wall) && !wall.is_empty());
    assert!(of(Mask::default(), 0.05, [5, 4]).is_empty());
    assert!(surface(&[], &[], [5, 4], [0.05; 2]).is_empty());
}

#[test]
fn masks_of_an_inspection_are_those_of_the_layers() {
    let options = Options {
        pixels: Some([300, 200]),
        pitch_mm: Some(0.01),
        pitch_y_mm: Some(0.02),
        mirror: Some(true),
        backend: Backend::Cpu,
        ..Options::default()
    };
    for (name, triangles) in [
        ("ball", solids::sphere(1.0, 5)),
        ("cone", solids::cone(1.0, 2.0, 6)),
    ] {
        let mut slicer = Slicer::load(&binary_stl(&triangles)).unwrap();
        pollster::block_on(slicer.plan(&options, &mut quiet)).unwrap();
        let (bytes, _) = slicer.write_archive(Vec::new(), &mut quiet).unwrap();
        let file = PrintFile::open(&*bytes).unwrap();
        let metadata = file.metadata();
        let mut masks = Vec::new();
        let inspection = inspect_masks(&file, &mut |mask| masks.push(mask), &mut silent).unwrap();
        assert_eq!(inspection, inspect(&file, &mut silent).unwrap(), "{name}");
        let layers = 0..file.layers().len();
        let expected = layers.map(|layer| file.mask(layer, metadata.flips()).unwrap());
        assert!(masks.iter().cloned().eq(expected), "{name}");
        let facets = facets(&surface(
            file.layers(),
            &masks,
            metadata.pixels,
            metadata.pixel_mm,
        ));
        assert!(is_closed(&facets), "{name}");
        let ratio = volume(&facets) / inspection.lit_volume_ml / 1e3;
        assert!((0.97..1.08).contains(&ratio), "{name}: {ratio}");
    }
}
