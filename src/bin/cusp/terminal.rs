//! Terminal output.

use std::fmt::Display;
use std::io::{self, IsTerminal, Write as _};
use std::sync::atomic::{AtomicBool, Ordering};

use cusp_slicer::job::Job;
use serde::Serialize;

use crate::visible::{visible, visible_lines};

/// True if standard output carries a file, so that nothing else may go there.
static STDOUT_IS_TAKEN: AtomicBool = AtomicBool::new(false);

/// From here on, standard output carries a file: text for people goes to stderr.
pub fn take_stdout() {
    STDOUT_IS_TAKEN.store(true, Ordering::Relaxed);
}

/// Returns true if standard output is a terminal.
pub fn is_on_terminal() -> bool {
    io::stdout().is_terminal()
}

/// Writes a message of one line to stderr; a closed stderr is no reason to stop.
pub fn say(message: &str) {
    let _ = writeln!(io::stderr(), "cusp: {}", visible(message));
}

/// Prints warnings to stderr.
pub fn warn(warnings: &[impl Display]) {
    for warning in warnings {
        say(&format!("warning: {warning}"));
    }
}

pub fn to_json(value: &impl Serialize) -> Result<String, String> {
    serde_json::to_string(value).map_err(|error| error.to_string())
}

/// Prints a line of JSON. Who reads it must have all of it: a closed pipe is an error here.
pub fn print_json(value: &impl Serialize) -> Result<(), String> {
    print_json_line(&to_json(value)?)
}

/// Prints a line of JSON from [`to_json`], likewise.
pub fn print_json_line(json: &str) -> Result<(), String> {
    write_line(json).map_err(|error| format!("standard output: {error}"))
}

/// Prints lines for people. A reader that has closed the pipe, such as `head`, is not an error.
pub fn print(text: &str) -> Result<(), String> {
    match write_line(&visible_lines(text)) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error.to_string()),
        _ => Ok(()),
    }
}

fn write_line(text: &str) -> io::Result<()> {
    if STDOUT_IS_TAKEN.load(Ordering::Relaxed) {
        let _ = writeln!(io::stderr(), "{text}");
        return Ok(());
    }
    writeln!(io::stdout(), "{text}")
}

/// A duration for people: seconds below a minute, else hours and minutes.
pub fn duration(seconds: f64) -> String {
    let minutes = (seconds / 60.0).round() as u64;
    if minutes == 0 {
        format!("{seconds:.0} s")
    } else {
        format!("{} h {:02} min", minutes / 60, minutes % 60)
    }
}

/// Searches for the GPU that the next plan uses, and silences drivers meanwhile. Mesa, for example, complains about a missing
/// display although nothing is displayed. The plan reports the result.
pub fn open_gpu(job: &mut Job) {
    #[cfg(unix)]
    let _silence = Silence::begin();
    pollster::block_on(job.open_gpu());
}

/// While it lives, nothing reaches stderr. Drivers write to the file descriptor itself, so the descriptor is redirected and
/// restored.
#[cfg(unix)]
struct Silence {
    stderr: std::os::fd::OwnedFd,
}

#[cfg(unix)]
impl Silence {
    fn begin() -> io::Result<Self> {
        use std::os::fd::AsFd as _;
        let stderr = io::stderr().as_fd().try_clone_to_owned()?;
        let nowhere = std::fs::File::options().write(true).open("/dev/null")?;
        rustix::stdio::dup2_stderr(nowhere)?;
        Ok(Self { stderr })
    }
}

#[cfg(unix)]
impl Drop for Silence {
    fn drop(&mut self) {
        let _ = rustix::stdio::dup2_stderr(&self.stderr);
    }
}
