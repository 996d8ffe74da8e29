//! The lattice on which contours lie, and its numbers as decimals.

use std::io::{self, Write};

use glam::DVec2;

use crate::model::Bounds;

/// Decimals of a millimetre of the finest lattice.
const DECIMALS: i32 = 4;

/// Coordinates are below this in magnitude, which is what `i_overlay` requires.
const LIMIT: f64 = (1i64 << 30) as f64 - 2.0;

/// The points that contours may have: multiples of a tenth of a micrometre, or, for models of more than 100 m, of the power of ten with which
/// coordinates fit.
///
/// A point is a pair of whole steps. Files show them as decimals without rounding, so what holds for the integers holds for files.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lattice {
    /// A step is 10 to the power of minus this, in millimetres.
    decimals: i32,
    steps_per_mm: f64,
}

impl Lattice {
    /// The lattice for a mesh with these bounds.
    pub fn of(bounds: &Bounds) -> Self {
        let corners = [bounds.min.truncate().abs(), bounds.max.truncate().abs()];
        let farthest_mm = corners[0].max(corners[1]).max_element();
        let (mut decimals, mut steps_per_mm) = (DECIMALS, 1e4);
        while farthest_mm * steps_per_mm > LIMIT {
            decimals -= 1;
            steps_per_mm /= 10.0;
        }
        Self {
            decimals,
            steps_per_mm,
        }
    }

    /// The length of a step in millimetres.
    pub fn step_mm(self) -> f64 {
        1.0 / self.steps_per_mm
    }

    /// A length in steps.
    pub fn to_steps(self, length_mm: f64) -> f64 {
        length_mm * self.steps_per_mm
    }

    /// The nearest lattice point.
    pub fn nearest(self, point_mm: DVec2) -> [i32; 2] {
        let steps = (point_mm * self.steps_per_mm + 0.5).floor();
        [steps.x as i32, steps.y as i32]
    }

    /// A lattice point in millimetres.
    pub fn to_mm(self, [x, y]: [i32; 2]) -> DVec2 {
        DVec2::new(f64::from(x), f64::from(y)) / self.steps_per_mm
    }

    /// Writes a coordinate in millimetres, exactly, without zeros at its end.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write(self, writer: &mut impl Write, steps: i32) -> io::Result<()> {
        if self.decimals <= 0 || steps == 0 {
            write!(writer, "{steps}")?;
            let zeros = if steps == 0 { 0 } else { -self.decimals };
            return (0..zeros).try_for_each(|_| writer.write_all(b"0"));
        }
        let unit = 10u32.pow(self.decimals as u32);
        let (mut fraction, whole) = (steps.unsigned_abs() % unit, steps.unsigned_abs() / unit);
        let sign = if steps < 0 { "-" } else { "" };
        if fraction == 0 {
            return write!(writer, "{sign}{whole}");
        }
        let mut width = self.decimals as usize;
        while fraction.is_multiple_of(10) {
            (fraction, width) = (fraction / 10, width - 1);
        }
        write!(writer, "{sign}{whole}.{fraction:0width$}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn text(lattice: Lattice, steps: i32) -> String {
        let mut bytes = Vec::new();
        lattice.write(&mut bytes, steps).unwrap();
        String::from_utf8(bytes).unwrap()
    }

    #[test]
    fn numbers_are_written_exactly_on_every_lattice() {
        for farthest_mm in [1.0, 1e6, 1e9, 1e20, 3e38] {
            let lattice = Lattice::of(&Bounds {
                min: DVec3::splat(-farthest_mm),
                max: DVec3::ONE,
            });
            for steps in [
                0,
                1,
                -1,
                10,
                -305,
                9_999,
                10_000,
                123_456,
                -100_100,
                1 << 29,
            ] {
                let shown: f64 = text(lattice, steps).parse().unwrap();
                let expected = lattice.to_mm([steps, 0]).x;
                assert!(
                    (shown - expected).abs() <= expected.abs() * 1e-14,
                    "{shown}"
                );
            }
            let [x, y] = lattice.nearest(DVec2::new(-farthest_mm, farthest_mm));
            assert_eq!(x, -y);
            assert!(y < 1 << 30);
        }
        let fine = Lattice::of(&Bounds {
            min: DVec3::ZERO,
            max: DVec3::ONE,
        });
        assert_eq!(text(fine, -305), "-0.0305");
        assert_eq!(text(fine, 120_500), "12.05");
    }
}
