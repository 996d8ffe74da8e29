//! The checksum of zips, PNGs and model files.

use std::sync::LazyLock;

/// Bytes that are looked up at once.
const SLICE: usize = 16;

/// The CRC-32 of `bytes`, with the polynomial of zip and PNG.
pub fn crc32(bytes: &[u8]) -> u32 {
    let mut crc = Crc32::default();
    crc.update(bytes);
    crc.checksum()
}

/// The CRC-32 of bytes that come in parts.
///
/// The tables are computed when they are first used, in less time than 16 KB of them take to download: they do not compress.
#[derive(Debug, Clone, Copy, Default)]
pub struct Crc32 {
    checksum: u32,
}

impl Crc32 {
    /// Adds bytes behind those before.
    pub fn update(&mut self, bytes: &[u8]) {
        let tables = &*TABLES;
        let (slices, rest) = bytes.as_chunks::<SLICE>();
        let mut crc = !self.checksum;
        for slice in slices {
            let mut slice = *slice;
            for (byte, of_crc) in slice.iter_mut().zip(crc.to_le_bytes()) {
                *byte ^= of_crc;
            }
            let looked_up = slice.iter().zip(tables.iter().rev());
            crc = looked_up.fold(0, |sum, (&byte, table)| sum ^ table[usize::from(byte)]);
        }
        for &byte in rest {
            crc = crc >> 8 ^ tables[0][usize::from(crc as u8 ^ byte)];
        }
        self.checksum = !crc;
    }

    /// The checksum of all bytes so far.
    pub fn checksum(self) -> u32 {
        self.checksum
    }
}

/// Table n has the checksum of each byte with n zeros after it.
static TABLES: LazyLock<Box<[[u32; 256]; SLICE]>> = LazyLock::new(|| {
    let mut tables = Box::new([[0; 256]; SLICE]);
    for byte in 0..256 {
        let mut crc = byte as u32;
        for _ in 0..8 {
            let carry = if crc & 1 == 1 { 0xEDB8_8320 } else { 0 };
            crc = crc >> 1 ^ carry;
        }
        tables[0][byte] = crc;
    }
    for byte in 0..256 {
        let mut crc = tables[0][byte];
        for zeros in 1..SLICE {
            crc = crc >> 8 ^ tables[0][usize::from(crc as u8)];
            tables[zeros][byte] = crc;
        }
    }
    tables
});

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksums_are_those_of_rawzip_at_every_length() {
        let bytes: Vec<u8> = (0..300_u32).map(|i| ((i * i * 167) >> 3) as u8).collect();
        for end in 0..bytes.len() {
            let part = &bytes[end / 7..end];
            assert_eq!(crc32(part), rawzip::crc32(part), "{} bytes", part.len());
            let mut in_parts = Crc32::default();
            part.chunks(1 + end / 3)
                .for_each(|part| in_parts.update(part));
            assert_eq!(in_parts.checksum(), crc32(part));
        }
        assert_eq!(crc32(b"123456789"), 0xCBF4_3926);
    }
}
