//! The fuzz targets: each is a function of bytes that panics if a promise is broken. `fuzz_targets/` gives them to libFuzzer, and
//! tests/fuzz.rs, which includes this file, replays the seeds on any compiler.

pub mod further;
pub mod input;
pub mod inspect;
pub mod pipeline;
pub mod promises;
pub mod readers;
pub mod settings;
#[path = "../../tests/common/slicer.rs"]
#[allow(
    clippy::duplicate_mod,
    reason = "the tests have it, too, and include this file"
)]
pub mod slicer;

use std::ops::ControlFlow;
use std::sync::LazyLock;

use cusp_slicer::job::Stage;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// A target.
pub type Target = fn(&[u8]);

/// All targets by their names, which are those of the files in `fuzz_targets/` and of the folders in `seeds/`.
pub const TARGETS: [(&str, Target); 8] = [
    ("inspect", inspect::inspect),
    ("model", readers::model),
    ("packed", readers::packed),
    ("pipeline", pipeline::pipeline),
    ("plan", settings::plan),
    ("print_file", readers::print_file),
    ("settings", settings::settings),
    ("weights", readers::weights),
];

/// A progress callback that never cancels.
pub fn quiet(_stage: Stage, _fraction: f64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// So many threads.
pub fn threads(count: usize) -> ThreadPool {
    let pool = ThreadPoolBuilder::new().num_threads(count).build();
    pool.expect("the system has threads")
}

/// Works on one thread: for models of few facets, sharing takes longer than the work.
pub fn alone<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    static ONE: LazyLock<ThreadPool> = LazyLock::new(|| threads(1));
    match rayon::current_thread_index() {
        Some(_) => work(),
        None => ONE.install(work),
    }
}

/// Makes the calling thread the only one that works, so that handing work over takes no time. For a process with one target.
pub fn work_here() {
    let pool = ThreadPoolBuilder::new().num_threads(1).use_current_thread();
    pool.build_global().expect("nothing has run before");
}
