//! Masks as printers' own formats store them: runs of equal light, row after row without a gap.

use crate::mask::Run;

/// Calls `emit(level, pixels)` for every run of a screen of `area` pixels, dark ones included. Neighbours of one level are one
/// run, also across the ends of rows.
///
/// `level` converts a brightness of 8 bits to the format's levels, and 0 to 0. `longest` is the longest run of a level
/// that the format can store; longer ones come in parts.
pub(super) fn for_each_run(
    runs: impl Iterator<Item = Run>,
    area: u64,
    level: impl Fn(u8) -> u8,
    longest: impl Fn(u8) -> u32,
    mut emit: impl FnMut(u8, u32),
) {
    let mut emit = |level: u8, mut count: u64| {
        let longest = longest(level);
        while count > 0 {
            let part = count.min(u64::from(longest));
            emit(level, part as u32);
            count -= part;
        }
    };
    let (mut last, mut count, mut end) = (0, 0, 0);
    let mut add = |level: u8, pixels: u64| {
        if pixels == 0 {
            return;
        }
        if level != last {
            emit(last, count);
            (last, count) = (level, 0);
        }
        count += pixels;
    };
    // Internal iteration turns nested iterators into nested loops.
    runs.for_each(|run| {
        let first = u64::from(run.first);
        add(0, first - end);
        add(level(run.grey), u64::from(run.pixels));
        end = first + u64::from(run.pixels);
    });
    add(0, area - end);
    emit(last, count);
}
