//! Failures of commands, for people and for programs.

use std::fmt::Display;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use cusp_slicer::progress::Cancelled;
use serde::Serialize;
use serde_json::Value;

use crate::terminal::{print_json, say};
use crate::visible::{visible, visible_detail};

/// The exit code of a command that was interrupted.
const INTERRUPTED: u8 = 130;

/// Failure of a command.
pub struct Failure {
    pub exit_code: u8,
    /// The message for the user; `None` if it has already been shown.
    pub message: Option<String>,
    /// The same for programs.
    pub problem: Option<Box<Problem>>,
}

/// A failure, for programs.
#[derive(Debug, Clone, Serialize, schemars::JsonSchema)]
pub struct Problem {
    /// The code of the library's error; `file` if a file cannot be read or written, `usage` if the command line is wrong.
    pub code: String,
    /// One sentence that says what to do.
    pub message: String,
    /// The typed details that the code has, if any.
    #[serde(skip_serializing_if = "Value::is_null")]
    pub detail: Value,
    /// The file that it is about, as the command line names it; absent if the message names one, and where the line has its model.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
}

impl Problem {
    /// A typed failure that concerns no file.
    fn of(error: &(impl Display + Serialize)) -> Self {
        let mut typed = serde_json::to_value(error).unwrap_or_default();
        let mut detail = typed["detail"].take();
        visible_detail(&mut detail);
        Self {
            code: typed["code"].as_str().unwrap_or_default().to_owned(),
            message: visible(&error.to_string()).into_owned(),
            detail,
            file: None,
        }
    }
}

/// The JSON of a command that fails.
#[derive(Serialize, schemars::JsonSchema)]
pub struct Failed {
    /// The problem.
    pub error: Problem,
}

impl From<String> for Failure {
    fn from(message: String) -> Self {
        Self {
            exit_code: 1,
            problem: Some(Box::new(Problem {
                code: "file".to_owned(),
                message: visible(&message).into_owned(),
                detail: Value::Null,
                file: None,
            })),
            message: Some(message),
        }
    }
}

impl Failure {
    /// A failure of the library that concerns a file. An interrupt does not name the file.
    pub fn in_file(path: &Path, error: &cusp_slicer::Error) -> Self {
        if error.code() == "cancelled" {
            Self::interrupted()
        } else {
            Self::of(path, error)
        }
    }

    /// A typed failure that concerns a file.
    pub fn of(path: &Path, error: &(impl Display + Serialize)) -> Self {
        Self {
            exit_code: 1,
            message: Some(in_file(path, error)),
            problem: Some(Box::new(Problem {
                file: Some(visible(&path.to_string_lossy()).into_owned()),
                ..Problem::of(error)
            })),
        }
    }

    /// The same with another message.
    pub fn renamed(mut self, rename: impl Fn(&str) -> String) -> Self {
        self.message = self.message.as_deref().map(&rename);
        if let Some(problem) = &mut self.problem {
            problem.message = rename(&problem.message);
        }
        self
    }

    pub fn interrupted() -> Self {
        Self {
            exit_code: INTERRUPTED,
            message: Some(Cancelled.to_string()),
            problem: None,
        }
    }

    /// A failure of the library that concerns no file, or several.
    pub fn without_file(error: &cusp_slicer::Error) -> Self {
        Self {
            exit_code: 1,
            message: Some(error.to_string()),
            problem: Some(Box::new(Problem::of(error))),
        }
    }

    pub fn is_interrupt(&self) -> bool {
        self.exit_code == INTERRUPTED
    }

    /// The failure as JSON; `None` if it has already been shown, and for an interrupt, which the exit code shows.
    pub fn told(self) -> Option<Failed> {
        Some(Failed {
            error: *self.problem?,
        })
    }

    /// Bad input that has already been reported.
    pub const TOLD: Self = Self {
        exit_code: 1,
        message: None,
        problem: None,
    };
}

/// A message about a file.
pub fn in_file(path: &Path, error: &dyn Display) -> String {
    if is_standard(path) {
        return format!("standard input: {error}");
    }
    format!("{}: {error}", path.display())
}

/// Returns true if this stands for standard input or output.
pub fn is_standard(path: &Path) -> bool {
    path == Path::new("-")
}

/// True if a program reads the output.
pub static IS_JSON: AtomicBool = AtomicBool::new(false);

/// Says why a command failed, once, and returns its exit code.
pub fn tell(failure: Failure) -> u8 {
    // Held until all is written: what ends the program meanwhile waits for it.
    static IS_TOLD: Mutex<bool> = Mutex::new(false);
    let exit_code = failure.exit_code;
    let mut is_told = IS_TOLD.lock().unwrap_or_else(PoisonError::into_inner);
    if *is_told {
        return exit_code;
    }
    *is_told = true;
    if let Some(message) = &failure.message {
        say(message);
    }
    if IS_JSON.load(Ordering::Relaxed)
        && let Some(failed) = failure.told()
    {
        // It has been said on stderr.
        let _ = print_json(&failed);
    }
    exit_code
}
