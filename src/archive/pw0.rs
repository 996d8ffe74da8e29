//! pw0, Anycubic's images: runs of four-bit greys.

use super::raster::for_each_run;
use crate::mask::Run;

/// The longest run of black or white, and of a grey.
const LONGEST: [u64; 2] = [4095, 15];

/// The runs of a mask of `area` pixels.
pub(super) fn encode(runs: impl Iterator<Item = Run>, area: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    for_each_run(
        runs,
        area,
        |grey| grey >> 4,
        |grey, mut count| {
            let is_grey = (1..15).contains(&grey);
            while count > 0 {
                let part = count.min(LONGEST[usize::from(is_grey)]);
                count -= part;
                if is_grey {
                    bytes.push(grey << 4 | part as u8);
                } else {
                    bytes.extend((u16::from(grey) << 12 | part as u16).to_be_bytes());
                }
            }
        },
    );
    bytes
}
