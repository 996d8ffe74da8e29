//! Masks of Anycubic, `pw0Img`: four bits of grey, in binary files and in zips.

use super::LayerFault;
use super::runs::{Coverage, Reader};

/// Length of the checksum after the data of very old files.
const OLD_CHECKSUM: usize = 2;

/// Decodes a layer's data.
pub fn decode(data: &[u8], coverage: &mut Coverage<'_>) -> Result<(), LayerFault> {
    let mut reader = Reader::new(data);
    while let Some(first) = reader.next() {
        if coverage.is_full() && reader.left() + 1 == OLD_CHECKSUM {
            break;
        }
        let (grey, low) = (first >> 4, u32::from(first & 15));
        let count = match grey {
            0 | 15 => low << 8 | reader.number(1)?,
            _ => low,
        };
        coverage.run(grey * 17, count)?;
    }
    coverage.finish()
}
