//! Several models with the same settings, side by side.
//!
//! All models share rayon's pool: work that one of them does on a single thread, such as reading and planning, fills the time that the
//! others leave.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{self, Sender};
use std::sync::{Condvar, Mutex, PoisonError};
use std::thread;

use cusp_slicer::job::{JobReport, MeshInfo, Stage};
use cusp_slicer::warning::Warning;
use serde::Serialize;

use crate::failure::{Failure, Problem, in_file, is_standard};
use crate::progress::Bar;
use crate::terminal::{print, print_json, say};
use crate::usage::wrong_usage;
use crate::visible::visible;
use crate::watch::{is_stopped, stop_on_interrupt};

/// Bytes of models that may be in work at a time. A larger model is in work alone.
const BYTES_IN_WORK: u64 = 64 << 20;

/// Result for a model of a batch.
pub trait Told: Serialize + Send {
    /// A line for people, without the model's name.
    fn line(&self) -> String;
    /// Warnings about a model that was processed.
    fn warnings(&self) -> Vec<Warning>;
}

/// JSON that a batch prints for a model: one line.
#[derive(Serialize, schemars::JsonSchema)]
pub struct BatchLine<T> {
    /// Path of the model, as it was given.
    model: String,
    /// Path of its print file, if one was written.
    #[serde(skip_serializing_if = "Option::is_none")]
    output: Option<String>,
    /// Its result.
    #[serde(flatten)]
    outcome: Outcome<T>,
}

/// Result of a model of a batch.
#[derive(Serialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
enum Outcome<T> {
    /// The report that the command prints for a single model.
    Report(T),
    /// The problem that prevented it.
    Error(Problem),
}

/// Models that are worked on with the same settings.
pub struct Batch<'a> {
    pub models: &'a [PathBuf],
    /// The print file of each, if any are written.
    pub outputs: Vec<PathBuf>,
    pub is_json: bool,
    /// Greatest number of models in work at a time.
    pub workers: usize,
}

/// Progress callback of a model's work.
pub type Progress<'a> = dyn FnMut(Stage, f64) -> ControlFlow<()> + 'a;

impl Batch<'_> {
    /// Number of models in work at a time.
    pub fn at_a_time(&self) -> usize {
        self.workers.clamp(1, self.models.len().max(1))
    }

    /// Works on every model. Prints a line as each ends, and in the end repeats what failed.
    pub fn run<T: Told>(
        &self,
        work: impl Fn(usize, &mut Progress<'_>) -> Result<T, Failure> + Sync,
    ) -> Result<(), Failure> {
        stop_on_interrupt();
        let bar = Bar::new();
        let shared = Shared {
            next: AtomicUsize::new(0),
            in_work: Room::default(),
            tally: Mutex::default(),
            of: self.models.len(),
            bar: &bar,
        };
        let (sender, results) = mpsc::channel();
        let mut failed = Vec::new();
        thread::scope(|scope| {
            for _ in 0..self.at_a_time() {
                let (sender, shared, work) = (sender.clone(), &shared, &work);
                scope.spawn(move || self.work_off(shared, work, &sender));
            }
            // The loop ends with the last worker.
            drop(sender);
            for (place, result) in results {
                match result {
                    Err(failure) if failure.exit_code == 130 => {}
                    result => bar.suspend(|| self.tell(place, result, &mut failed))?,
                }
            }
            Ok::<(), Failure>(())
        })?;
        drop(bar);
        if is_stopped() {
            return Err(Failure::interrupted());
        }
        self.repeat(failed)
    }

    /// Works on models until none is left, or somebody interrupts.
    fn work_off<T: Told>(
        &self,
        shared: &Shared<'_>,
        work: &(impl Fn(usize, &mut Progress<'_>) -> Result<T, Failure> + Sync),
        sender: &Sender<(usize, Result<T, Failure>)>,
    ) {
        loop {
            let place = shared.next.fetch_add(1, Ordering::Relaxed);
            let Some(model) = self.models.get(place) else {
                return;
            };
            let bytes = std::fs::metadata(model).map_or(0, |file| file.len());
            let _room = shared.in_work.take(bytes);
            if is_stopped() {
                return;
            }
            let mut done = 0.0;
            let result = work(place, &mut |stage, fraction| {
                let before = std::mem::replace(&mut done, stage.done(fraction));
                shared.advance(done - before, 0)
            });
            let _ = shared.advance(1.0 - done, 1);
            if sender.send((place, result)).is_err() {
                return;
            }
        }
    }

    /// Prints what became of a model.
    fn tell<T: Told>(
        &self,
        place: usize,
        result: Result<T, Failure>,
        failed: &mut Vec<(usize, String)>,
    ) -> Result<(), Failure> {
        let model = self.models[place].display();
        let output = self.outputs.get(place);
        let outcome = match result {
            Ok(told) => {
                for warning in told.warnings() {
                    say(&format!("warning: {model}: {warning}"));
                }
                if !self.is_json {
                    let output = output.map_or(String::new(), |it| format!("{}: ", it.display()));
                    let line = format!("{model}: {output}{}", told.line());
                    return Ok(print(&visible(&line))?);
                }
                Outcome::Report(told)
            }
            Err(failure) => {
                let message = failure.message.unwrap_or_default();
                say(&message);
                failed.push((place, message));
                match failure.problem {
                    // The line has the model.
                    Some(problem) if self.is_json => Outcome::Error(Problem {
                        file: None,
                        ..*problem
                    }),
                    _ => return Ok(()),
                }
            }
        };
        let line = BatchLine {
            model: model.to_string(),
            output: match &outcome {
                Outcome::Report(_) => output.map(|it| it.display().to_string()),
                Outcome::Error(_) => None,
            },
            outcome,
        };
        Ok(print_json(&line)?)
    }

    /// Repeats what failed, in the order of the models, since it may be far above by now.
    fn repeat(&self, mut failed: Vec<(usize, String)>) -> Result<(), Failure> {
        if failed.is_empty() {
            return Ok(());
        }
        failed.sort_unstable();
        if self.models.len() > 1 {
            let (count, all) = (failed.len(), self.models.len());
            say(&format!("{count} of {all} models failed:"));
            for (_, message) in failed {
                say(&message);
            }
        }
        Err(Failure::TOLD)
    }
}

/// State shared by the workers.
struct Shared<'a> {
    /// The next model to take.
    next: AtomicUsize,
    in_work: Room,
    /// Models that are done, and the parts of all that are.
    tally: Mutex<(usize, f64)>,
    of: usize,
    bar: &'a Bar,
}

impl Shared<'_> {
    /// Moves the bar on by a part of a model, and by whole ones that ended.
    fn advance(&self, part: f64, ended: usize) -> ControlFlow<()> {
        let mut tally = self.tally.lock().unwrap_or_else(PoisonError::into_inner);
        tally.0 += ended;
        tally.1 += part;
        let name = format!("{}/{}", tally.0, self.of);
        self.bar.show(name, tally.1 / self.of as f64)
    }
}

/// Bounds the bytes of models in work, and with them memory.
#[derive(Default)]
struct Room {
    taken: Mutex<u64>,
    left: Condvar,
}

impl Room {
    /// Waits until there is room for `bytes`, or nothing else is in work.
    fn take(&self, bytes: u64) -> Taken<'_> {
        let taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        let is_full = |taken: &mut u64| *taken > 0 && *taken + bytes > BYTES_IN_WORK;
        let mut taken = self
            .left
            .wait_while(taken, is_full)
            .unwrap_or_else(PoisonError::into_inner);
        *taken += bytes;
        Taken { room: self, bytes }
    }
}

struct Taken<'a> {
    room: &'a Room,
    bytes: u64,
}

impl Drop for Taken<'_> {
    fn drop(&mut self) {
        let mut taken = self
            .room
            .taken
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        *taken -= self.bytes;
        self.room.left.notify_all();
    }
}

/// Number of models to work on at a time: one per processor.
pub fn workers() -> usize {
    thread::available_parallelism().map_or(1, usize::from)
}

/// Exits with a usage error if standard input is to be several models.
pub fn check_inputs(command: &str, models: &[PathBuf]) {
    if models.iter().filter(|model| is_standard(model)).count() > 1 {
        wrong_usage(command, "standard input (-) is one model");
    }
}

/// The print file of each model in a folder, named as the model with another extension.
pub fn outputs_in(
    folder: &Path,
    models: &[PathBuf],
    extension: &str,
) -> Result<Vec<PathBuf>, Failure> {
    let mut outputs: Vec<PathBuf> = Vec::new();
    let mut known = std::collections::HashMap::new();
    for model in models {
        let name = model.file_stem().filter(|_| !is_standard(model));
        let Some(name) = name else {
            let reason = "this has no name for a print file in a folder; name a file by -o";
            return Err(in_file(model, &reason).into());
        };
        // The extension is added, not replaced: names may have dots.
        let mut name = name.to_owned();
        name.push(".");
        name.push(extension);
        // Some file systems ignore case.
        if let Some(other) = known.insert(name.to_string_lossy().to_lowercase(), model) {
            let (other, model) = (other.display(), model.display());
            let output = folder.join(&name);
            let output = output.display();
            let reason = format!(
                "{other} and {model} would both become {output}; rename one, or slice them into different folders"
            );
            return Err(reason.into());
        }
        outputs.push(folder.join(name));
    }
    Ok(outputs)
}

impl Told for JobReport {
    fn line(&self) -> String {
        let plate = &self.plates[0];
        format!(
            "{} layers, {:.3} mm, {}, {:.1} ml, error {}",
            plate.layers,
            plate.height_mm,
            crate::terminal::duration(plate.print_time_s),
            plate.resin_ml,
            plate.metric.format(plate.max_error)
        )
    }

    fn warnings(&self) -> Vec<Warning> {
        self.plates[0].all_warnings()
    }
}

impl Told for MeshInfo {
    fn line(&self) -> String {
        let [x, y, z] = self.size_mm;
        format!(
            "{x:.3} × {y:.3} × {z:.3} mm, {} facets, {:.3} ml, {}",
            self.facets,
            self.volume_mm3 / 1e3,
            if self.closed { "closed" } else { "open" }
        )
    }

    fn warnings(&self) -> Vec<Warning> {
        self.warnings.clone()
    }
}
