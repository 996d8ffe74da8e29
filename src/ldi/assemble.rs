//! What both backends share: compressed rows from counts, and the order of hits within a ray.

use super::{Hit, LdiError};

/// Turns `offsets`, which holds the number of hits of ray i at i + 1 and 0 at 0, into offsets.
///
/// # Errors
/// [`LdiError::OutOfMemory`] if there are more hits than an offset can count.
pub(super) fn accumulate(offsets: &mut [u32]) -> Result<(), LdiError> {
    let mut total = 0u64;
    for offset in offsets.iter_mut() {
        total += u64::from(*offset);
        *offset = total as u32;
    }
    if total > u64::from(u32::MAX) {
        return Err(out_of_memory(total));
    }
    Ok(())
}

/// Room for `count` values, or an error instead of an abort.
///
/// # Errors
/// [`LdiError::OutOfMemory`].
pub(super) fn zeroed<T: bytemuck::Zeroable + Clone>(count: usize) -> Result<Vec<T>, LdiError> {
    let mut values = Vec::new();
    values
        .try_reserve_exact(count)
        .map_err(|_| out_of_memory(count as u64))?;
    values.resize(count, T::zeroed());
    Ok(values)
}

fn out_of_memory(hits: u64) -> LdiError {
    LdiError::OutOfMemory {
        hits,
        needed_bytes: hits * size_of::<Hit>() as u64,
    }
}

/// Puts the hits of consecutive rays in order; `offsets` are relative to `base`.
pub(super) fn sort_rays(offsets: &[u32], base: u32, hits: &mut [Hit]) {
    for ray in offsets.windows(2) {
        let ray = &mut hits[(ray[0] - base) as usize..(ray[1] - base) as usize];
        match ray {
            [] | [_] => {}
            [low, high] => {
                if low.key() > high.key() {
                    std::mem::swap(low, high);
                }
            }
            _ => ray.sort_unstable_by_key(|hit| hit.key()),
        }
    }
}
