//! The bytes of a print file, and fields at offsets of it. Nothing is read beyond the end.

use std::sync::Arc;

use super::PrintFileError;

/// The bytes of a print file: borrowed, or shared by all who read them. They are held once.
#[derive(Debug, Clone)]
pub struct Bytes<'a>(Held<'a>);

#[derive(Debug, Clone)]
enum Held<'a> {
    Borrowed(&'a [u8]),
    Shared(Arc<Vec<u8>>),
}

impl AsRef<[u8]> for Bytes<'_> {
    fn as_ref(&self) -> &[u8] {
        match &self.0 {
            Held::Borrowed(bytes) => bytes,
            Held::Shared(bytes) => bytes,
        }
    }
}

impl<'a> From<&'a [u8]> for Bytes<'a> {
    fn from(bytes: &'a [u8]) -> Self {
        Self(Held::Borrowed(bytes))
    }
}

impl From<Vec<u8>> for Bytes<'static> {
    fn from(bytes: Vec<u8>) -> Self {
        Self(Held::Shared(Arc::new(bytes)))
    }
}

/// Byte order of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Order {
    /// The lowest.
    Little,
    /// The highest.
    Big,
}

/// Fields of a file, by their offset.
#[derive(Clone, Copy)]
pub(super) struct Fields<'a> {
    pub bytes: &'a [u8],
    pub order: Order,
}

impl<'a> Fields<'a> {
    pub fn len(self) -> u64 {
        self.bytes.len() as u64
    }

    /// Fails if the file ends before.
    pub fn slice(self, at: u64, length: u64) -> Result<&'a [u8], PrintFileError> {
        let end = at.checked_add(length);
        let found = end.filter(|&end| end <= self.len());
        let found = found.map(|end| &self.bytes[at as usize..end as usize]);
        found.ok_or(PrintFileError::Truncated {
            needed_bytes: end.unwrap_or(u64::MAX),
            found_bytes: self.len(),
        })
    }

    fn array<const N: usize>(self, at: u64) -> Result<[u8; N], PrintFileError> {
        let mut array = [0; N];
        array.copy_from_slice(self.slice(at, N as u64)?);
        // As if the lowest byte came first.
        if self.order == Order::Big {
            array.reverse();
        }
        Ok(array)
    }

    pub fn u8(self, at: u64) -> Result<u8, PrintFileError> {
        Ok(u8::from_le_bytes(self.array(at)?))
    }

    pub fn u16(self, at: u64) -> Result<u16, PrintFileError> {
        Ok(u16::from_le_bytes(self.array(at)?))
    }

    pub fn u32(self, at: u64) -> Result<u32, PrintFileError> {
        Ok(u32::from_le_bytes(self.array(at)?))
    }

    /// The shortest decimal that has this single-precision value: 0.05, not 0.05000000074505806.
    pub fn f32(self, at: u64) -> Result<f64, PrintFileError> {
        let single = f32::from_le_bytes(self.array(at)?);
        let shortest = single.to_string().parse();
        Ok(shortest.unwrap_or_else(|_| f64::from(single)))
    }

    /// A number that is stated only if it is finite.
    pub fn finite(self, at: u64) -> Result<Option<f64>, PrintFileError> {
        Ok(Some(self.f32(at)?).filter(|value| value.is_finite()))
    }

    /// Text up to a zero or to the end of the field.
    pub fn text(self, at: u64, length: u64) -> Result<Option<String>, PrintFileError> {
        let field = self.slice(at, length.min(LONGEST_NAME as u64))?;
        let text = field.split(|&byte| byte == 0).next().unwrap_or_default();
        Ok(clean(&String::from_utf8_lossy(text)))
    }
}

/// More characters of a name are not kept.
const LONGEST_NAME: usize = 256;

/// A name as it may be shown: without control characters, which terminals obey, and not empty.
pub(super) fn clean(text: &str) -> Option<String> {
    let letters = text.chars().filter(|letter| !letter.is_control());
    let text: String = letters.take(LONGEST_NAME).collect();
    let text = text.trim();
    (!text.is_empty()).then(|| text.to_owned())
}
