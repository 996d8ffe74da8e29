//! Bounds of a command's memory and processor time.

#[cfg(target_os = "linux")]
use std::sync::OnceLock;

use bytesize::ByteSize;
use clap::Args;
use cusp_slicer::job::Job;

use crate::values::positive;
use crate::watch::keep_within;
#[cfg(target_os = "linux")]
use crate::watch::memory_taken_bytes;

/// Bounds of a command.
#[derive(Debug, Clone, Copy, Default, Args)]
pub struct Budget {
    /// Take at most about this much memory, such as 1GB or 512MiB; hits that do not fit are found again in each pass, and
    /// files stay the same
    #[arg(long, value_name = "SIZE")]
    max_memory: Option<ByteSize>,
    /// Take this much processor time at most, in seconds of all cores together
    #[arg(long, value_name = "S", value_parser = positive)]
    max_cpu_time: Option<f64>,
}

impl Budget {
    /// Bounds of memory, and of time in seconds.
    pub fn of(max_memory: ByteSize, max_cpu_time: f64) -> Self {
        Self {
            max_memory: Some(max_memory),
            max_cpu_time: Some(max_cpu_time),
        }
    }

    /// The bound on the command line, or the system's if that is less.
    fn memory_bytes(&self) -> Option<u64> {
        let asked = self.max_memory.map(|ByteSize(bytes)| bytes);
        asked.into_iter().chain(address_bytes()).min()
    }

    /// From here on, what exceeds it stops the command.
    pub fn keep(&self) {
        keep_within(self.max_cpu_time, self.memory_bytes());
    }

    /// A job with its share, of which `workers` take some at a time.
    pub fn bound(&self, mut job: Job, workers: usize) -> Job {
        if let Some(bytes) = self.memory_bytes() {
            job = job.with_memory(bytes / workers as u64);
        }
        if let Some(seconds) = self.max_cpu_time {
            job = job.with_cpu_time(seconds);
        }
        job
    }
}

/// Addresses that each thread's allocator reserves.
#[cfg(target_os = "linux")]
const ARENA_BYTES: u64 = 64 << 20;

/// The bytes that a limit on addresses (`ulimit -v`) leaves to allocate, if there is one: what exceeds it cannot be reported.
#[cfg(target_os = "linux")]
fn address_bytes() -> Option<u64> {
    static LEFT: OnceLock<Option<u64>> = OnceLock::new();
    *LEFT.get_or_init(|| {
        let limit = rustix::process::getrlimit(rustix::process::Resource::As);
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let [taken_bytes, _] = memory_taken_bytes();
        let arenas_bytes = ARENA_BYTES * (threads as u64 + 1);
        let left = |bytes: u64| bytes.saturating_sub(taken_bytes + arenas_bytes);
        limit.current.map(left)
    })
}

#[cfg(not(target_os = "linux"))]
fn address_bytes() -> Option<u64> {
    None
}
