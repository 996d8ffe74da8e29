//! The one place that knows whether work is spread over threads: rayon natively, a plain loop in
//! wasm. Results never depend on it.

use crate::progress::{Cancelled, Progress, report};

/// Items worked on between two calls of the progress callback.
const GROUP: usize = 16;

/// Applies `work` to every item and returns the results in the items' order.
#[cfg(not(target_arch = "wasm32"))]
pub(crate) fn map<T: Send, R: Send>(items: Vec<T>, work: impl Fn(T) -> R + Sync + Send) -> Vec<R> {
    use rayon::iter::{IntoParallelIterator, ParallelIterator};
    items.into_par_iter().map(work).collect()
}

/// Applies `work` to every item and returns the results in the items' order.
#[cfg(target_arch = "wasm32")]
pub(crate) fn map<T: Send, R: Send>(items: Vec<T>, work: impl Fn(T) -> R + Sync + Send) -> Vec<R> {
    items.into_iter().map(work).collect()
}

/// Has the system's allocator keep what is freed for the next piece of work. glibc gives it back, and clears it when it is
/// wanted again, until it has seen a large block come and go; up to 32 MiB it takes that for what to expect. Where every item takes
/// a few megabytes for a millisecond that is half of the time. Elsewhere this does nothing.
#[cfg(not(target_arch = "wasm32"))]
pub(crate) fn keep_memory() {
    drop(std::hint::black_box(Vec::<u8>::with_capacity(31 << 20)));
}

/// Applies `work` to every item in groups, hands the results to `collect` in order, and after each
/// group reports a progress that grows from `from` to `to`.
pub(crate) fn map_in_groups<T: Send, R: Send, E: From<Cancelled>>(
    items: impl ExactSizeIterator<Item = T>,
    work: impl Fn(T) -> R + Sync + Send,
    mut collect: impl FnMut(R) -> Result<(), E>,
    progress: &mut Progress<'_>,
    [from, to]: [f64; 2],
) -> Result<(), E> {
    let total = items.len().max(1) as f64;
    let mut items = items.fuse();
    let mut done = 0;
    loop {
        let group: Vec<T> = items.by_ref().take(GROUP).collect();
        if group.is_empty() {
            return Ok(());
        }
        done += group.len();
        for result in map(group, &work) {
            collect(result)?;
        }
        report(progress, from + (to - from) * done as f64 / total)?;
    }
}
