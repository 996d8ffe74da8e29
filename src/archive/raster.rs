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
    let dark_end = std::iter::once(None);
    for run in runs.map(Some).chain(dark_end) {
        let first = run.map_or(area, |run| u64::from(run.first));
        let pixels = run.map_or(0, |run| u64::from(run.pixels));
        for (grey, pixels) in [
            (0, first - end),
            (run.map_or(0, |run| level(run.grey)), pixels),
        ] {
            if pixels == 0 {
                continue;
            }
            if grey != last {
                emit(last, count);
                count = 0;
            }
            last = grey;
            count += pixels;
        }
        end = first + pixels;
    }
    emit(last, count);
}
