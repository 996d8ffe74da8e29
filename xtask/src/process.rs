//! Other programs, with their output shown, captured, or both.

use std::{
    env,
    ffi::OsStr,
    io::{self, BufRead, BufReader, Write},
    path::Path,
    process::{Command, ExitStatus, Stdio},
};

use anyhow::{Context, Result, bail};

use crate::project::Project;

/// A command without standard input: nothing here asks questions, and a tool that
/// does must fail rather than wait.
pub fn command(program: impl AsRef<OsStr>) -> Command {
    let mut command = Command::new(program);
    command.stdin(Stdio::null());
    command
}

/// The cargo that started xtask, in the project's root, with the same target folder.
pub fn cargo(project: &Project) -> Command {
    let mut command = command(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command
        .current_dir(&project.root)
        .env("CARGO_TARGET_DIR", &project.target);
    command
}

/// A program of rustup's nightly toolchain.
pub fn nightly(program: impl AsRef<OsStr>) -> Command {
    let mut rustup = command("rustup");
    // The variables that rustup's cargo sets for xtask would mislead the other toolchain.
    for name in ["CARGO", "RUSTC", "RUSTDOC", "RUSTUP_TOOLCHAIN"] {
        rustup.env_remove(name);
    }
    rustup.args(["run", "nightly"]).arg(program);
    rustup
}

/// Runs to completion with all output on standard error: standard output is for
/// xtask's own result.
pub fn run(command: &mut Command) -> Result<()> {
    show(command.stdout(io::stderr()))
}

/// Runs to completion with the output where the program writes it.
pub fn show(command: &mut Command) -> Result<()> {
    announce(command);
    let status = command.status().with_context(|| not_started(command))?;
    if !status.success() {
        bail!("{} failed ({status})", describe(command));
    }
    Ok(())
}

/// Runs to completion and returns standard output, trimmed; shows nothing.
pub fn output(command: &mut Command) -> Result<String> {
    let output = command.output().with_context(|| not_started(command))?;
    if !output.status.success() {
        let words = String::from_utf8_lossy(&output.stderr);
        bail!("{} failed: {}", describe(command), words.trim());
    }
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// Runs to completion with the output shown, and returns a copy: standard output
/// and standard error in one stream, in the order they were written.
pub fn tee(command: &mut Command) -> Result<(ExitStatus, String)> {
    announce(command);
    let (reader, writer) = io::pipe()?;
    let mut child = command
        .stdout(writer.try_clone()?)
        .stderr(writer)
        .spawn()
        .with_context(|| not_started(command))?;
    // The command holds the pipe's write ends: while they are open in this
    // process, the reader never sees the end.
    command.stdout(Stdio::null()).stderr(Stdio::null());

    let mut text = String::new();
    let mut line = Vec::new();
    let mut reader = BufReader::new(reader);
    while reader.read_until(b'\n', &mut line)? > 0 {
        let mut out = io::stdout().lock();
        out.write_all(&line)?;
        out.flush()?;
        text.push_str(&String::from_utf8_lossy(&line));
        line.clear();
    }
    Ok((child.wait()?, text))
}

/// Prints the command to standard error, as one would type it.
fn announce(command: &Command) {
    eprintln!("$ {}", describe(command));
}

fn not_started(command: &Command) -> String {
    format!("cannot start {}", describe(command))
}

/// The program's bare name and its arguments.
fn describe(command: &Command) -> String {
    let program = Path::new(command.get_program());
    let mut words = program.file_name().unwrap_or_default().to_os_string();
    for argument in command.get_args() {
        words.push(" ");
        words.push(argument);
    }
    words.to_string_lossy().into_owned()
}
