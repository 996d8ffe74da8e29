//! Known printers, as data.

use serde::Serialize;

use crate::format::Format;

/// A resin printer: its screen, its build volume and the file that it takes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Printer {
    /// Its name in options, as in `--printer NAME`.
    pub name: &'static str,
    /// Make and model.
    pub model: &'static str,
    /// Columns and rows of the masks.
    pub pixels: [u32; 2],
    /// Sides of a pixel in x and y, in micrometres.
    pub pitch_um: [f64; 2],
    /// Build volume in x, y and z, in millimetres.
    pub volume_mm: [f64; 3],
    /// Whether masks are mirrored left to right, because the screen lights the resin from below.
    pub is_mirrored: bool,
    /// Minimum and maximum layer thickness in millimetres.
    pub layer_mm: [f64; 2],
    /// Motor step in millimetres: every height is a multiple of it.
    pub step_mm: f64,
    /// The print format to write for it: one that it reads, or one that other programs convert to one that it reads.
    pub format: Format,
    /// Whether it reads `format` without a converter.
    pub reads_format: bool,
    /// Extensions of the files that it reads, the most common first.
    pub reads: &'static [&'static str],
}

/// Layer thicknesses of printers whose makers state no limits.
const ANY_LAYER_MM: [f64; 2] = [0.01, 0.2];
/// The motor step of common z drives.
const USUAL_STEP_MM: f64 = 0.002;

/// A printer whose own format other programs write from a `ChiTuBox` zip.
const fn converted(
    name: &'static str,
    model: &'static str,
    pixels: [u32; 2],
    pitch_um: [f64; 2],
    volume_mm: [f64; 3],
    reads: &'static [&'static str],
) -> Printer {
    Printer {
        name,
        model,
        pixels,
        pitch_um,
        volume_mm,
        is_mirrored: true,
        layer_mm: ANY_LAYER_MM,
        step_mm: USUAL_STEP_MM,
        format: Format::Chitubox,
        reads_format: false,
        reads,
    }
}

/// All printers known by name.
pub const PRINTERS: &[Printer] = &[
    converted(
        "mars-4-ultra",
        "Elegoo Mars 4 Ultra",
        [8520, 4320],
        [18.0, 18.0],
        [153.36, 77.76, 165.0],
        &["goo"],
    ),
    converted(
        "saturn-3-ultra",
        "Elegoo Saturn 3 Ultra",
        [11520, 5120],
        [19.0, 24.0],
        [218.88, 122.88, 260.0],
        &["goo"],
    ),
    converted(
        "saturn-4-ultra-16k",
        "Elegoo Saturn 4 Ultra 16K",
        [15120, 6230],
        [14.0, 19.0],
        [211.68, 118.37, 220.0],
        &["ctb", "goo"],
    ),
    converted(
        "photon-mono-m5s",
        "Anycubic Photon Mono M5s",
        [11520, 5120],
        [19.0, 24.0],
        [218.88, 122.88, 200.0],
        &["pm5s"],
    ),
    converted(
        "photon-mono-m7-pro",
        "Anycubic Photon Mono M7 Pro",
        [13312, 5120],
        [16.8, 24.8],
        [223.642, 126.976, 230.0],
        &["pwsz"],
    ),
    converted(
        "sonic-mini-8k-s",
        "Phrozen Sonic Mini 8K S",
        [7536, 3240],
        [22.0, 22.0],
        [165.792, 71.28, 170.0],
        &["prz"],
    ),
    Printer {
        format: Format::Sl1,
        reads_format: true,
        ..converted(
            "sl1s",
            "Prusa SL1S SPEED",
            [1620, 2560],
            [50.0, 50.0],
            [81.0, 128.0, 150.0],
            &["sl1s"],
        )
    },
    converted(
        "athena-12k",
        "Concepts3D Athena 12K",
        [11520, 5120],
        [19.0, 24.0],
        [218.88, 122.88, 245.0],
        &["nanodlp"],
    ),
    Printer {
        is_mirrored: false,
        reads_format: true,
        ..converted(
            "shuffle",
            "Phrozen Shuffle",
            [1440, 2560],
            [47.0, 47.0],
            [67.68, 120.32, 200.0],
            &["zip"],
        )
    },
];

/// The printer with this name.
pub fn named(name: &str) -> Option<&'static Printer> {
    PRINTERS.iter().find(|printer| printer.name == name)
}
