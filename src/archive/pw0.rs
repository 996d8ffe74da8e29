//! pw0, Anycubic's images: runs of four-bit greys.

use super::raster::for_each_run;
use crate::mask::Run;

/// The runs of a mask of `area` pixels.
pub(super) fn encode(runs: impl Iterator<Item = Run>, area: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    let is_grey = |level: u8| (1..15).contains(&level);
    for_each_run(
        runs,
        area,
        |grey| grey >> 4,
        |level| if is_grey(level) { 0xf } else { 0xfff },
        |level, count| {
            if is_grey(level) {
                bytes.push(level << 4 | count as u8);
            } else {
                bytes.extend((u16::from(level) << 12 | count as u16).to_be_bytes());
            }
        },
    );
    bytes
}
