//! Runs of equal pixels in raster order, passed from a layer's data to a sink.

use super::LayerFault;

/// Takes a run: its grey, and its number of pixels. Runs follow each other in raster order, rows without a gap.
pub type Sink<'a> = dyn FnMut(u8, u32) + 'a;

/// Passes runs on and holds them to the number of pixels of a mask.
pub(super) struct Coverage<'a> {
    expected: u64,
    left: u64,
    sink: &'a mut Sink<'a>,
}

impl<'a> Coverage<'a> {
    pub fn new(pixels: u64, sink: &'a mut Sink<'a>) -> Self {
        Self {
            expected: pixels,
            left: pixels,
            sink,
        }
    }

    /// Fails at the first run that does not fit.
    pub fn run(&mut self, grey: u8, count: u32) -> Result<(), LayerFault> {
        if u64::from(count) > self.left {
            return Err(LayerFault::TooManyPixels {
                expected: self.expected,
            });
        }
        self.left -= u64::from(count);
        if count > 0 {
            (self.sink)(grey, count);
        }
        Ok(())
    }

    pub fn is_full(&self) -> bool {
        self.left == 0
    }

    /// Fails if there are pixels without a run.
    pub fn finish(&self) -> Result<(), LayerFault> {
        if self.is_full() {
            return Ok(());
        }
        Err(LayerFault::TooFewPixels {
            pixels: self.expected - self.left,
            expected: self.expected,
        })
    }
}

/// Bytes one after the other, with the place of the next.
pub(super) struct Reader<'a> {
    data: &'a [u8],
    place: usize,
}

impl<'a> Reader<'a> {
    pub fn new(data: &'a [u8]) -> Self {
        Self { data, place: 0 }
    }

    pub fn next(&mut self) -> Option<u8> {
        let byte = self.data.get(self.place).copied();
        self.place += usize::from(byte.is_some());
        byte
    }

    /// Fails at the end: a run has begun.
    pub fn more(&mut self) -> Result<u8, LayerFault> {
        let byte = self.place as u64;
        self.next().ok_or(LayerFault::BadRun { byte })
    }

    /// A number of this many bytes, the highest first.
    pub fn number(&mut self, bytes: u32) -> Result<u32, LayerFault> {
        let mut number = 0;
        for _ in 0..bytes {
            number = number << 8 | u32::from(self.more()?);
        }
        Ok(number)
    }

    pub fn left(&self) -> usize {
        self.data.len() - self.place
    }

    /// The fault for a last byte that is not part of a run.
    pub fn fault(&self) -> LayerFault {
        LayerFault::BadRun {
            byte: (self.place as u64).saturating_sub(1),
        }
    }
}
