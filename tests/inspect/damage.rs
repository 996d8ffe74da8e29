//! Damaged files: cut at every length, and with bytes changed. Every one is an error, has warnings, or reads as before;
//! none makes a reader panic.

use cusp_slicer::archive::read::{PrintFile, inspect};
use cusp_slicer::progress::silent;

use super::ctb::ctb;
use super::goo::goo;
use super::photon_workshop::photon_workshop;
use super::zips::{anycubic, nanodlp};

/// One file of each format. The last byte of each is needed.
fn files() -> Vec<Vec<u8>> {
    let chunks = [&[0x02, 0x43, 100, 0x87, 0xBF, 2][..], &[0xD0, 1]].concat();
    let mut files = vec![
        goo(&[(0.05, chunks.clone()), (0.15, chunks)]),
        nanodlp(),
        anycubic(),
    ];
    for version in [2, 3, 4, 5] {
        let layer = vec![0x00, 0x01, 0xC0, 3, 0xFF, 10];
        files.push(ctb(
            version,
            version - 2,
            &[(0.05, layer.clone()), (0.15, layer)],
        ));
    }
    for version in 515..=518 {
        let layer = vec![0x00, 3, 0x52, 0xE1, 0xF0, 9];
        files.push(photon_workshop(
            version,
            &[(0.05, layer.clone()), (0.1, layer)],
        ));
    }
    files
}

/// Reads whatever can be read, and returns true if something was wrong.
fn is_bad(bytes: &[u8]) -> bool {
    let Ok(file) = PrintFile::open(bytes) else {
        return true;
    };
    let flips = file.metadata().flips();
    for layer in 0..file.layers().len().min(8) {
        // Only the smallest of the remaining masks: a changed size may be large.
        if file.metadata().mask_pixels() < 1 << 20 {
            let _ = file.mask(layer, flips);
        }
    }
    let found = inspect(&file, &mut silent).unwrap();
    let _ = serde_json::to_string(&found).unwrap();
    for warning in &found.warnings {
        assert!(!warning.to_string().is_empty());
    }
    !found.warnings.is_empty()
}

#[test]
fn whole_files_have_no_warnings_but_for_their_black_layers() {
    for (place, file) in files().iter().enumerate() {
        // The two zips have a black layer each.
        assert_eq!(is_bad(file), [1, 2].contains(&place), "{place}");
    }
}

#[test]
fn every_cut_is_noticed() {
    for file in files() {
        // Of previews every part is like the others.
        let dull = 1000..file.len().saturating_sub(1000);
        for length in (0..file.len()).filter(|length| !dull.contains(length) || length % 997 == 0) {
            assert!(is_bad(&file[..length]), "{length} of {}", file.len());
        }
    }
}

#[test]
fn no_change_of_bytes_makes_a_reader_panic() {
    let mut random = fastrand::Rng::with_seed(7);
    for file in files() {
        // Of a GOO file most bytes are a preview.
        let dull = 200..file.len().saturating_sub(700).max(200);
        for _ in 0..3000 {
            let mut changed = file.clone();
            for _ in 0..random.usize(1..=4) {
                let place = random.usize(..file.len());
                let place = if dull.contains(&place) && file.len() > 100_000 {
                    random.usize(dull.end..file.len())
                } else {
                    place
                };
                let bytes = [0, 1, 0x7F, 0x80, 0xFF, random.u8(..)];
                changed[place] = bytes[random.usize(..bytes.len())];
            }
            is_bad(&changed);
        }
    }
}
