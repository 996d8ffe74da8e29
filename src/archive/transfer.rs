//! Encoded layers as bytes, from the worker that encoded them to the one that writes the file. Both are of the same build, so this is
//! no format that others read.

use super::survey::{Bounds, Survey};
use super::{ArchiveError, EncodedLayer};

/// Layers as bytes: of each its numbers, then its data.
pub fn to_bytes(layers: &[EncodedLayer]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(layers.iter().map(|it| it.data.len() + 64).sum());
    for layer in layers {
        let mut numbers = vec![layer.data.len() as u64, layer.lit_pixels];
        push(
            &mut numbers,
            layer.inflated.map(|(crc, length)| [crc.into(), length]),
        );
        push(&mut numbers, layer.bounds.map(|it| it.map(u64::from)));
        let survey = layer.survey.as_ref();
        push(&mut numbers, survey.map(|it| [it.areas.len() as u64]));
        if let Some(survey) = survey {
            push(&mut numbers, survey.bounds.map(|it| it.map(u64::from)));
            numbers.extend(&survey.areas);
        }
        bytes.extend(numbers.into_iter().flat_map(u64::to_le_bytes));
        bytes.extend(&layer.data);
    }
    bytes
}

/// Adds whether there are numbers, and these.
fn push<const N: usize>(numbers: &mut Vec<u64>, some: Option<[u64; N]>) {
    numbers.push(u64::from(some.is_some()));
    numbers.extend(some.into_iter().flatten());
}

/// The layers of [`to_bytes`].
///
/// # Errors
/// [`ArchiveError::Write`] if the bytes do not hold `count` layers: the worker that encoded them was of another build.
pub fn from_bytes(bytes: &[u8], count: usize) -> Result<Vec<EncodedLayer>, ArchiveError> {
    let mut rest = Rest(bytes);
    let layers: Result<Vec<_>, Cut> = (0..count).map(|_| rest.layer()).collect();
    let layers = layers.ok().filter(|_| rest.0.is_empty());
    layers.ok_or_else(|| ArchiveError::write("encoded layers were cut"))
}

/// There are fewer bytes than the numbers before say.
struct Cut;

/// The bytes yet to be read.
struct Rest<'a>(&'a [u8]);

impl Rest<'_> {
    fn layer(&mut self) -> Result<EncodedLayer, Cut> {
        let [bytes, lit_pixels] = self.numbers()?;
        let inflated = self.some()?.map(|[crc, length]| (crc as u32, length));
        let bounds = self.bounds()?;
        let survey = match self.some()? {
            None => None,
            Some([areas]) => Some(Survey {
                bounds: self.bounds()?,
                areas: (0..areas)
                    .map(|_| self.numbers().map(|[area]| area))
                    .collect::<Result<_, _>>()?,
            }),
        };
        let (data, rest) = self.0.split_at_checked(bytes as usize).ok_or(Cut)?;
        self.0 = rest;
        Ok(EncodedLayer {
            data: data.to_vec(),
            inflated,
            lit_pixels,
            survey,
            bounds,
        })
    }

    fn bounds(&mut self) -> Result<Option<Bounds>, Cut> {
        Ok(self
            .some()?
            .map(|sides: [u64; 4]| sides.map(|it| it as u32)))
    }

    fn some<const N: usize>(&mut self) -> Result<Option<[u64; N]>, Cut> {
        let [is_some] = self.numbers()?;
        if is_some == 0 {
            return Ok(None);
        }
        self.numbers().map(Some)
    }

    fn numbers<const N: usize>(&mut self) -> Result<[u64; N], Cut> {
        let mut numbers = [0; N];
        for number in &mut numbers {
            let (bytes, rest) = self.0.split_first_chunk().ok_or(Cut)?;
            *number = u64::from_le_bytes(*bytes);
            self.0 = rest;
        }
        Ok(numbers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_come_back_and_cut_ones_do_not() {
        let layer = |data: &[u8]| EncodedLayer {
            data: data.to_vec(),
            inflated: Some((7, 1 << 40)),
            lit_pixels: 3,
            survey: Some(Survey {
                bounds: Some([1, 2, 3, 4]),
                areas: vec![5, 6],
            }),
            bounds: None,
        };
        let black = EncodedLayer {
            inflated: None,
            survey: None,
            bounds: Some([0; 4]),
            lit_pixels: 0,
            ..layer(b"")
        };
        let layers = [layer(b"abc"), black, layer(b"d")];
        let bytes = to_bytes(&layers);
        assert_eq!(from_bytes(&bytes, 3).unwrap(), layers);
        assert!(from_bytes(&bytes, 2).is_err());
        assert!(from_bytes(&bytes, 4).is_err());
        for end in 0..bytes.len() {
            assert!(from_bytes(&bytes[..end], 3).is_err(), "{end}");
        }
    }
}
