//! The only place that knows about threads: rayon natively, a plain loop in wasm. Results do not
//! depend on the number of threads.

use crate::progress::{Cancelled, Progress, report};

/// Number of items between two calls of the progress callback.
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

/// The results of two functions, of which the first runs on another thread where there are threads.
pub(crate) fn beside<A: Send, B>(
    aside: impl FnOnce() -> A + Send,
    here: impl FnOnce() -> B,
) -> (A, B) {
    #[cfg(not(target_arch = "wasm32"))]
    {
        let mut result = None;
        let here = rayon::in_place_scope(|scope| {
            scope.spawn(|_| result = Some(aside()));
            here()
        });
        (result.expect("a scope waits for its threads"), here)
    }
    #[cfg(target_arch = "wasm32")]
    (aside(), here())
}

/// Number of items processed at a time.
#[cfg(not(target_arch = "wasm32"))]
pub(crate) fn threads() -> usize {
    rayon::current_num_threads()
}

/// Number of items processed at a time.
#[cfg(target_arch = "wasm32")]
pub(crate) fn threads() -> usize {
    1
}

/// Makes glibc's allocator keep freed memory for the next item of work; with other allocators it does nothing.
///
/// glibc returns a large block to the system when it is freed, and the next allocation starts from zeroed pages again.
/// The threshold grows with the largest block freed so far, up to 32 MiB; so allocating and freeing one large block is
/// enough. If each item uses a few megabytes for a millisecond, this halves the time.
#[cfg(not(target_arch = "wasm32"))]
pub(crate) fn keep_memory() {
    drop(std::hint::black_box(Vec::<u8>::with_capacity(31 << 20)));
}

/// Applies `work` to every item in groups, passes the results to `collect` in order, and reports progress
/// from `from` to `to` after each group.
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
