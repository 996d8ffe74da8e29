//! Progress on a terminal.

use std::borrow::Cow;
use std::io::{self, IsTerminal};
use std::ops::ControlFlow;

use cusp_slicer::job::Stage;
use indicatif::{ProgressBar, ProgressFinish, ProgressStyle};

use crate::watch::{is_stopped, note_progress};

/// A progress bar on a terminal, hidden elsewhere. Clears its line when dropped.
pub struct Bar {
    bar: ProgressBar,
}

impl Bar {
    pub fn new() -> Self {
        const STEPS: u64 = 1000;
        if !io::stderr().is_terminal() {
            return Self {
                bar: ProgressBar::hidden(),
            };
        }
        let style = ProgressStyle::with_template("{msg:8} {wide_bar} {percent:>3} %")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        Self {
            bar: ProgressBar::new(STEPS)
                .with_style(style)
                .with_finish(ProgressFinish::AndClear),
        }
    }

    pub fn report(&self, stage: Stage, fraction: f64) -> ControlFlow<()> {
        self.show(stage.name(), stage.done(fraction))
    }

    /// Prints without the bar in between.
    pub fn suspend<T>(&self, print: impl FnOnce() -> T) -> T {
        self.bar.suspend(print)
    }

    /// Shows the current step, and the fraction of the whole task that is done.
    pub fn show(&self, name: impl Into<Cow<'static, str>>, done: f64) -> ControlFlow<()> {
        self.bar.set_message(name);
        let steps = self.bar.length().unwrap_or_default() as f64;
        self.bar.set_position((done * steps) as u64);
        note_progress(done);
        if is_stopped() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}
