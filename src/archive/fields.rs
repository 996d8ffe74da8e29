//! Writes the fields of binary print files.

use crate::printer::Printer;

/// Byte order of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ByteOrder {
    Big,
    Little,
}

impl ByteOrder {
    /// The order of GOO files for a printer.
    pub fn of_goo(printer: Option<&Printer>) -> Self {
        if printer.is_some_and(|printer| printer.is_little_endian) {
            Self::Little
        } else {
            Self::Big
        }
    }
}

/// Appends fields to bytes. Heads have a hundred fields and are written once, so that calls matter less than room.
pub(super) struct Fields<'a> {
    bytes: &'a mut Vec<u8>,
    order: ByteOrder,
}

impl<'a> Fields<'a> {
    pub fn new(bytes: &'a mut Vec<u8>, order: ByteOrder) -> Self {
        Self { bytes, order }
    }

    #[inline(never)]
    pub fn bytes(&mut self, bytes: &[u8]) {
        self.bytes.extend(bytes);
    }

    #[inline]
    fn number<const N: usize>(&mut self, mut big_endian: [u8; N]) {
        if self.order == ByteOrder::Little {
            big_endian.reverse();
        }
        self.bytes(&big_endian);
    }

    #[inline(never)]
    pub fn bool(&mut self, value: bool) {
        self.bytes(&[u8::from(value)]);
    }

    #[inline(never)]
    pub fn u16(&mut self, value: u16) {
        self.number(value.to_be_bytes());
    }

    #[inline(never)]
    pub fn u32(&mut self, value: u32) {
        self.number(value.to_be_bytes());
    }

    /// Writes a number in single precision.
    #[inline(never)]
    pub fn f32(&mut self, value: f64) {
        self.number((value as f32).to_be_bytes());
    }

    /// Writes text, cut at a character's end to leave a zero, in a field of `length` bytes.
    #[inline(never)]
    pub fn text(&mut self, text: &str, length: usize) {
        let mut end = text.len().min(length - 1);
        while !text.is_char_boundary(end) {
            end -= 1;
        }
        self.bytes(&text.as_bytes()[..end]);
        self.zeros(length - end);
    }

    #[inline(never)]
    pub fn zeros(&mut self, count: usize) {
        self.bytes.resize(self.bytes.len() + count, 0);
    }
}
