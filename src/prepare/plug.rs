//! Plugs: pins that close drain holes once the resin is out.

use glam::DVec3;

use super::drain::{BEYOND, DOUBLINGS, Drain};
use super::round::circle;
use super::shell::Shell;

/// Play in diameter between a plug's inner end and its hole; the other end fills the hole.
const PLAY_MM: f64 = 0.2;

/// The shortest plug that can be held, in diameters of its hole.
const SHORTEST: f64 = 0.5;

/// Room between plugs.
const APART_MM: f64 = 2.0;

/// A plug for each drain hole, as long as the wall there is thick: upright on the plate in a row along x, in the order of the holes, the end
/// that goes in at the top. The row is centred on x = y = 0.
pub fn plugs(drains: &[Drain]) -> Shell {
    let widths_mm = drains.iter().map(|drain| drain.diameter_mm + APART_MM);
    let mut left_mm = -widths_mm.sum::<f64>() / 2.0;
    let mut shell = Shell::default();
    for drain in drains {
        let width_mm = drain.diameter_mm + APART_MM;
        let middle_mm = left_mm + width_mm / 2.0;
        left_mm += width_mm;
        let into_void_mm = BEYOND * drain.diameter_mm;
        let wall_mm = drain.depth_mm.unwrap_or_default() - into_void_mm;
        let ends_mm = [0.0, wall_mm.max(SHORTEST * drain.diameter_mm)];
        let radii_mm = [drain.diameter_mm, drain.diameter_mm - PLAY_MM].map(|it| it / 2.0);
        let ring = |end: usize| {
            let middle = DVec3::new(middle_mm, 0.0, ends_mm[end]);
            let rim = circle(DOUBLINGS).into_iter();
            rim.map(|[x, y]| middle + DVec3::new(x, y, 0.0) * radii_mm[end])
                .collect()
        };
        shell.drum(ring(0), ring(1));
    }
    shell
}
