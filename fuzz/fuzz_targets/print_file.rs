//! No bytes make the readers of print files panic, or hold much more memory than the file justifies.

#![no_main]

use cusp_slicer::archive::read::{PrintFile, inspect_masks, surface};
use cusp_slicer::progress::silent;
use libfuzzer_sys::fuzz_target;

/// Larger files only take longer.
const MOST_PIXELS: u64 = 1 << 24;

fuzz_target!(|bytes: &[u8]| {
    let Ok(file) = PrintFile::open(bytes) else {
        return;
    };
    let about = file.about();
    if about
        .mask_pixels()
        .saturating_mul(file.layers().len() as u64)
        > MOST_PIXELS
    {
        return;
    }
    let mut masks = Vec::new();
    let inspection = inspect_masks(&file, &mut |mask| masks.push(mask), &mut silent);
    let inspection = inspection.expect("nobody cancels");
    for warning in &inspection.warnings {
        let _ = warning.to_string();
    }
    surface(
        file.layers(),
        &masks,
        about.pixels_from_above(),
        about.pixel_mm_from_above(),
    );
    for place in 0..file.previews() {
        file.preview(place);
    }
});
