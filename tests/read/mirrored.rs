//! Models read mirrored: the masks are mirrored pixel by pixel, and nothing else changes.

use crate::common::{Slicer, binary_stl, quiet, solids};
use cusp_slicer::job::Options;
use cusp_slicer::model::read::ReadOptions;
use glam::Vec3;

/// Rows of pixels of a mask, whose rows are whole bytes.
fn rows(bits: &[u8], width: usize) -> Vec<Vec<bool>> {
    let row = |bytes: &[u8]| {
        let pixel = |x: usize| bytes[x / 8] & (0x80 >> (x % 8)) != 0;
        (0..width).map(pixel).collect()
    };
    bits.chunks(width.div_ceil(8)).map(row).collect()
}

#[test]
fn masks_of_a_mirrored_model_are_mirrored() {
    let mut hand = solids::cuboid(Vec3::new(8.0, 3.0, 2.0));
    hand.extend(solids::moved(
        &solids::sphere(1.5, 3),
        Vec3::new(3.0, 2.0, 2.5),
    ));
    let stl = binary_stl(&hand);
    let options = Options {
        rays: 120,
        ..Options::default()
    };
    let read = |mirrored: bool| {
        let reading = ReadOptions {
            mirrored,
            ..ReadOptions::default()
        };
        let mut slicer = Slicer::load_with(&stl, &reading).unwrap();
        let report = pollster::block_on(slicer.plan(&options, &mut quiet));
        let report = report.unwrap().clone();
        assert_eq!(report.models[0].file.mirrored, mirrored);
        let width = report.mask.width as usize;
        let masks = (0..report.layers).map(|layer| rows(&slicer.mask(layer).unwrap(), width));
        (report.z_mm, masks.collect::<Vec<_>>())
    };
    let (z_mm, plain) = read(false);
    let (mirrored_z_mm, mirrored) = read(true);
    assert_eq!(z_mm, mirrored_z_mm);
    assert_ne!(plain, mirrored);
    for (layer, (plain, mirrored)) in plain.iter().zip(&mirrored).enumerate() {
        for (row, theirs) in plain.iter().zip(mirrored) {
            let mut row = row.clone();
            row.reverse();
            assert_eq!(&row, theirs, "layer {layer}");
        }
    }
}
