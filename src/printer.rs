//! Printers as data.

use serde::Serialize;

use crate::archive::Format;

/// A resin printer: its screen, its volume and the file that it takes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Printer {
    /// What users call it, for `--printer`.
    pub name: &'static str,
    /// What its maker calls it.
    pub model: &'static str,
    /// Columns and rows of the masks.
    pub pixels: [u32; 2],
    /// Sides of a pixel in x and y.
    pub pitch_um: [f64; 2],
    /// What it can print, in x, y and z.
    pub volume_mm: [f64; 3],
    /// Whether masks are mirrored left to right, because the screen is seen from above and lights from below.
    pub is_mirrored: bool,
    /// Least and greatest layer thickness.
    pub layer_mm: [f64; 2],
    /// What heights are multiples of.
    pub step_mm: f64,
    /// The file that it takes, or from which other programs make that.
    pub format: Format,
}

/// What presets whose makers name no limits allow.
const ANY_LAYER_MM: [f64; 2] = [0.01, 0.2];
/// The step of common z drives.
const USUAL_STEP_MM: f64 = 0.002;

const fn chitubox(
    name: &'static str,
    model: &'static str,
    pixels: [u32; 2],
    pitch_um: [f64; 2],
    volume_mm: [f64; 3],
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
    }
}

/// All printers that are known by name.
pub const PRINTERS: &[Printer] = &[
    chitubox(
        "mars-4-ultra",
        "Elegoo Mars 4 Ultra",
        [8520, 4320],
        [18.0, 18.0],
        [153.36, 77.76, 165.0],
    ),
    chitubox(
        "saturn-3-ultra",
        "Elegoo Saturn 3 Ultra",
        [11520, 5120],
        [19.0, 24.0],
        [218.88, 122.88, 260.0],
    ),
    chitubox(
        "saturn-4-ultra-16k",
        "Elegoo Saturn 4 Ultra 16K",
        [15120, 6230],
        [14.0, 19.0],
        [211.68, 118.37, 220.0],
    ),
    chitubox(
        "photon-mono-m5s",
        "Anycubic Photon Mono M5s",
        [11520, 5120],
        [19.0, 24.0],
        [218.88, 122.88, 200.0],
    ),
    chitubox(
        "photon-mono-m7-pro",
        "Anycubic Photon Mono M7 Pro",
        [13312, 5120],
        [16.8, 24.8],
        [223.642, 126.976, 230.0],
    ),
    chitubox(
        "sonic-mini-8k-s",
        "Phrozen Sonic Mini 8K S",
        [7536, 3240],
        [22.0, 22.0],
        [165.792, 71.28, 170.0],
    ),
    Printer {
        format: Format::Sl1,
        ..chitubox(
            "sl1s",
            "Prusa SL1S SPEED",
            [1620, 2560],
            [50.0, 50.0],
            [81.0, 128.0, 150.0],
        )
    },
    chitubox(
        "athena-12k",
        "Concepts3D Athena 12K",
        [11520, 5120],
        [19.0, 24.0],
        [218.88, 122.88, 245.0],
    ),
    Printer {
        is_mirrored: false,
        ..chitubox(
            "shuffle",
            "Phrozen Shuffle",
            [1440, 2560],
            [47.0, 47.0],
            [67.68, 120.32, 200.0],
        )
    },
];

/// The printer of a name.
pub fn named(name: &str) -> Option<&'static Printer> {
    PRINTERS.iter().find(|printer| printer.name == name)
}
