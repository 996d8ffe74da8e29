//! Watches over a command while it works: interrupts, and the processor time and memory that it takes.
//!
//! Stages stop by themselves when they next report progress. A stage that does not report in time is ended here, with
//! its temporary files.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, LazyLock, Mutex, OnceLock, PoisonError};
use std::thread;
use std::time::Duration;
#[cfg(not(unix))]
use std::time::Instant;

use cusp_slicer::Error;
use cusp_slicer::job::Work;

use crate::failure::{Failure, tell};

/// Set by an interrupt; stages ask whenever they report progress.
static INTERRUPTED: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);
/// The bound that the command has exceeded, if any.
static EXCEEDED: OnceLock<Error> = OnceLock::new();
/// The fraction of the work that is done, as bits of a double.
static DONE: AtomicU64 = AtomicU64::new(0);
/// Temporary files that will replace others.
static TEMPORARY: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Interval between checks.
const PERIOD: Duration = Duration::from_millis(20);
/// Longest time that a stage may take until it reports progress, and the command until it has tidied up after that.
const GRACE: Duration = Duration::from_millis(70);

/// From here on, an interrupt sets a flag instead of killing the process, so that temporary files are removed.
pub fn stop_on_interrupt() {
    static ONCE: OnceLock<()> = OnceLock::new();
    ONCE.get_or_init(|| {
        handle_signals();
        thread::spawn(|| {
            loop {
                thread::sleep(PERIOD);
                if is_stopped() {
                    thread::sleep(GRACE);
                    end();
                }
            }
        });
    });
}

/// Interrupts, requests to end and hang-ups, but for those that are ignored, as a hang-up is under `nohup` and an interrupt is for
/// commands that a shell runs in the background: these stay ignored.
#[cfg(target_os = "linux")]
fn handle_signals() {
    use signal_hook::consts::{SIGABRT, SIGHUP, SIGINT, SIGTERM};
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status
        .lines()
        .find_map(|line| line.strip_prefix("SigIgn:"))
        .and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
        .unwrap_or(0);
    // Memory that cannot be had ends the process with a message. It fails like any other command then.
    let _ = signal_hook::flag::register_conditional_shutdown(SIGABRT, 1, Arc::new(true.into()));
    for signal in [SIGHUP, SIGINT, SIGTERM] {
        if ignored >> (signal - 1) & 1 == 0 {
            // Without a handler it ends the process, as it always did.
            let _ = signal_hook::flag::register(signal, Arc::clone(&INTERRUPTED));
        }
    }
}

/// Elsewhere the ignored signals are not known: if any is ignored, none is handled.
#[cfg(not(target_os = "linux"))]
fn handle_signals() {
    let _ = ctrlc::try_set_handler(|| INTERRUPTED.store(true, Ordering::Relaxed));
}

/// From here on, what exceeds these bounds stops the command.
pub fn keep_within(cpu_time_s: Option<f64>, memory_bytes: Option<u64>) {
    if cpu_time_s.is_none() && memory_bytes.is_none() {
        return;
    }
    stop_on_interrupt();
    thread::spawn(move || {
        while EXCEEDED.get().is_none() {
            thread::sleep(PERIOD);
            if let Some(error) = exceeded(cpu_time_s, memory_bytes) {
                let _ = EXCEEDED.set(error);
            }
        }
    });
}

fn exceeded(cpu_time_s: Option<f64>, memory_bytes: Option<u64>) -> Option<Error> {
    let done = f64::from_bits(DONE.load(Ordering::Relaxed));
    if let Some(allowed_s) = cpu_time_s {
        let taken_s = taken_cpu_s();
        if taken_s > allowed_s {
            // It needs at least the time that it has taken.
            let needed_s = if done > 0.0 { taken_s / done } else { taken_s };
            return Some(Error::TimeBound {
                work: Work::All,
                needed_s: needed_s.ceil(),
                allowed_s,
            });
        }
    }
    if let Some(allowed_bytes) = memory_bytes {
        let [_, needed_bytes] = memory_taken_bytes();
        // The library's estimate is not exact.
        if needed_bytes > allowed_bytes + allowed_bytes / 8 + (64 << 20) {
            return Some(Error::MemoryBound {
                needed_bytes,
                allowed_bytes,
            });
        }
    }
    None
}

/// Processor time of all threads, in seconds.
#[cfg(unix)]
fn taken_cpu_s() -> f64 {
    let taken = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    taken.tv_sec as f64 + taken.tv_nsec as f64 / 1e9
}

/// Elsewhere the time since the command began to work.
#[cfg(not(unix))]
fn taken_cpu_s() -> f64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed().as_secs_f64()
}

/// Addresses that are taken and memory that is in use, if the system reports them; otherwise 0.
pub fn memory_taken_bytes() -> [u64; 2] {
    let text = fs::read_to_string("/proc/self/statm").unwrap_or_default();
    let mut pages = text.split(' ').map(|pages| pages.parse().unwrap_or(0));
    [(); 2].map(|()| pages.next().unwrap_or(0) * page_bytes())
}

#[cfg(unix)]
fn page_bytes() -> u64 {
    rustix::param::page_size() as u64
}

#[cfg(not(unix))]
fn page_bytes() -> u64 {
    0
}

/// Notes the fraction of the work that is done.
pub fn note_progress(done: f64) {
    DONE.store(done.to_bits(), Ordering::Relaxed);
}

/// Returns true if work should stop.
pub fn is_stopped() -> bool {
    INTERRUPTED.load(Ordering::Relaxed) || EXCEEDED.get().is_some()
}

/// The failure of a command that was stopped: of the bound that it exceeded, if any, in place of its own.
pub fn reason(failure: Failure) -> Failure {
    match EXCEEDED.get() {
        Some(error) if failure.is_interrupt() => Failure::without_file(error),
        _ => failure,
    }
}

/// Removes a temporary file should the command be ended.
pub fn note_temporary(path: &Path) {
    let mut files = TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner);
    files.push(path.to_owned());
}

/// Ends the process with its temporary files.
fn end() -> ! {
    let files = TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner);
    for file in files.iter() {
        // Most are gone by now, or in their places.
        let _ = fs::remove_file(file);
    }
    std::process::exit(i32::from(tell(reason(Failure::interrupted()))))
}
