//! The library in the browser: the only file with wasm-bindgen.
//!
//! Errors are thrown as `{ code, message, detail }`; see [`crate::job::Error`].

use std::io::{self, BufWriter, Write};
use std::ops::ControlFlow;

use js_sys::{Function, Reflect, Uint8Array};
use serde::Serialize;
use tsify::Ts;
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use crate::job::{self, Error, Options, OptionsError, Stage};
use crate::model::read::{self, HEAD_BYTES};
use crate::model::weights;
use crate::orientation::{Candidate, Search, SearchOptions, Task, TaskResult};
use crate::printer::PRINTERS;
use crate::profile::{Metric, Source};

/// What every function here throws: code and typed details of an [`Error`], and one sentence for people with what to do.
///
/// The types of all errors are generated. Those that hold another are serialised as that one, which `tsify` does not see.
#[wasm_bindgen(typescript_custom_section)]
const CUSP_ERROR: &str = r"
type Flat<E> = E extends { detail: infer Held extends { code: string } } ? Flat<Held> : E;
export type CoreError = Flat<NestedError>;
export type CuspError = CoreError & { message: string };
";

/// Hands a value over as JSON, whose writer the manifest needs anyway; a second one for JavaScript's objects would only make
/// the module larger.
fn to_js(value: &impl Serialize) -> JsValue {
    // Fails only on maps with keys that are no strings, which nothing here has.
    let json = serde_json::to_string(value).unwrap_or_default();
    js_sys::JSON::parse(&json).unwrap_or(JsValue::NULL)
}

fn throw(error: impl Into<Error>) -> JsValue {
    let error = error.into();
    let message = error.to_string();
    let thrown = to_js(&error);
    // Fails only on what is no object.
    let _ = Reflect::set(&thrown, &"message".into(), &message.into());
    thrown
}

/// Values that do not fit their type: options that are none, mostly.
fn throw_conversion(error: impl std::fmt::Display) -> JsValue {
    throw(OptionsError::Unreadable {
        system: error.to_string(),
    })
}

/// Calls a JavaScript function with the stage, the fraction of the stage that is done and that of the whole task. A page
/// cancels by ending the worker.
fn progress_to(callback: &Function) -> impl FnMut(Stage, f64) -> ControlFlow<()> {
    move |stage, fraction| {
        // A failing callback must not fail the job.
        let _ = callback.call3(
            &JsValue::NULL,
            &stage.name().into(),
            &fraction.into(),
            &stage.done(fraction).into(),
        );
        ControlFlow::Continue(())
    }
}

/// A loaded model; a change of options repeats only what depends on it.
#[wasm_bindgen]
pub struct Slicer {
    slicer: job::Slicer,
    preview_density: Vec<f32>,
}

/// Says whether a file can be a model, by its first bytes and its length, before it is read.
///
/// # Errors
/// Throws a `CuspError` that names what it is instead.
#[wasm_bindgen]
pub fn identify(head: &[u8], length: f64) -> Result<(), JsValue> {
    read::identify(head, length as u64).map_err(throw)
}

/// Bytes that [`identify`] wants.
#[wasm_bindgen]
pub fn head_bytes() -> usize {
    HEAD_BYTES
}

/// The printers that are known by name.
#[wasm_bindgen(unchecked_return_type = "Printer[]")]
pub fn printers() -> JsValue {
    to_js(&PRINTERS)
}

/// Options as they are where nothing is said.
#[wasm_bindgen(unchecked_return_type = "Required<Options>")]
pub fn defaults() -> JsValue {
    to_js(&Options::default())
}

/// A search for the best orientation: it says what to measure next, and measures nothing itself. Several slicers with the
/// same model and options may run its tasks.
#[wasm_bindgen]
pub struct OrientationSearch {
    search: Search,
}

#[wasm_bindgen]
impl OrientationSearch {
    /// A search of candidates that were measured before: they are rated again, and the best of them refined.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "values from JavaScript come by value"
    )]
    pub fn of_measured(
        search: Ts<SearchOptions>,
        candidates: Vec<Ts<Candidate>>,
    ) -> Result<OrientationSearch, JsValue> {
        let options = search.to_rust().map_err(throw_conversion)?;
        let search = Search::of_measured(options, to_rust(&candidates)?);
        search.map(|search| Self { search }).map_err(throw)
    }

    /// The directions to measure first, three numbers each.
    pub fn directions(&self) -> Vec<f64> {
        self.search.directions().as_flattened().to_vec()
    }

    /// How many of them are measured.
    pub fn measured(&self) -> usize {
        self.search.measured()
    }

    /// Up to `most` tasks that nobody has; none while the next ones depend on results that are still out.
    #[wasm_bindgen(unchecked_return_type = "Task[]")]
    pub fn next_tasks(&mut self, most: usize) -> JsValue {
        to_js(&self.search.next_tasks(most))
    }

    /// Takes the candidates of a task's directions. Tasks may come in any order.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "values from JavaScript come by value"
    )]
    pub fn accept(&mut self, task: usize, candidates: Vec<Ts<Candidate>>) -> Result<(), JsValue> {
        let result = TaskResult {
            number: task,
            candidates: to_rust(&candidates)?,
        };
        self.search.accept(result).map_err(throw)
    }

    /// How much is done, 0 to 1.
    pub fn progress(&self) -> f64 {
        self.search.progress()
    }

    /// One for each direction, null before it is measured. Energies are relative to what has been measured so far.
    #[wasm_bindgen(unchecked_return_type = "(Candidate | null)[]")]
    pub fn rated(&self) -> JsValue {
        to_js(&self.search.rated())
    }

    /// The best candidates that differ from each other, the best first: three at most. Null before all is done.
    #[wasm_bindgen(unchecked_return_type = "Candidate[] | null")]
    pub fn best(&self) -> JsValue {
        to_js(&self.search.best())
    }
}

fn to_rust(candidates: &[Ts<Candidate>]) -> Result<Vec<Candidate>, JsValue> {
    let candidates = candidates.iter().map(Ts::to_rust);
    candidates
        .collect::<Result<_, _>>()
        .map_err(throw_conversion)
}

#[wasm_bindgen]
impl Slicer {
    /// Reads an STL, binary or ASCII.
    ///
    /// # Errors
    /// Throws a `CuspError` if the bytes are no usable STL.
    #[wasm_bindgen(constructor)]
    pub fn new(stl: &[u8]) -> Result<Slicer, JsValue> {
        let slicer = job::Slicer::load(stl).map_err(throw)?;
        Ok(Self {
            slicer,
            preview_density: Vec::new(),
        })
    }

    /// Corners of the facets, nine numbers a facet, in millimetres as they stand in the file.
    pub fn positions(&self) -> Vec<f32> {
        self.slicer.positions()
    }

    /// How much each facet stands out, from 0 to 1.
    ///
    /// # Errors
    /// None that a valid model causes.
    pub fn saliency(
        &mut self,
        #[wasm_bindgen(
            unchecked_param_type = "(stage: Stage, fraction: number, done: number) => void"
        )]
        progress: &Function,
    ) -> Result<Vec<f32>, JsValue> {
        let saliency = self.slicer.saliency(&mut progress_to(progress));
        Ok(saliency.map_err(throw)?.to_vec())
    }

    /// Says how much each facet matters, from 0 to 1; all alike if that is absent. Later plans and previews follow it.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    pub fn set_weights(&mut self, weights: Option<Vec<f32>>) -> Result<(), JsValue> {
        self.slicer.set_weights(weights).map_err(throw)
    }

    /// A file of weights of this model.
    ///
    /// # Errors
    /// Throws a `CuspError` if there is not one from 0 to 1 for every facet.
    pub fn weights_file(&self, weights: &[f32]) -> Result<Vec<u8>, JsValue> {
        let corners = self.slicer.positions();
        weights::check(weights, corners.len() / 9).map_err(throw)?;
        Ok(weights::to_bytes(weights, &corners))
    }

    /// The weights in a file, which must be one of this model.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    pub fn read_weights(&self, file: &[u8]) -> Result<Vec<f32>, JsValue> {
        weights::from_bytes(file, &self.slicer.positions()).map_err(throw)
    }

    /// The plan of the model in a pose, from the facets alone, in a few milliseconds: for following live while it is
    /// turned. Leaves the last plan.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "values from JavaScript come by value"
    )]
    #[wasm_bindgen(unchecked_return_type = "Preview")]
    pub fn preview(&mut self, options: Ts<Options>) -> Result<JsValue, JsValue> {
        let options = options.to_rust().map_err(throw_conversion)?;
        let (preview, profile) = self.slicer.preview(&options).map_err(throw)?;
        self.preview_density = profile.density;
        Ok(to_js(&preview))
    }

    /// A search along directions spread evenly, the axes, and those of the model's largest flats.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "values from JavaScript come by value"
    )]
    pub fn search(
        &mut self,
        options: Ts<Options>,
        search: Ts<SearchOptions>,
    ) -> Result<OrientationSearch, JsValue> {
        let options = options.to_rust().map_err(throw_conversion)?;
        let search = search.to_rust().map_err(throw_conversion)?;
        let search = self.slicer.search(&options, &search);
        search
            .map(|search| OrientationSearch { search })
            .map_err(throw)
    }

    /// Measures the directions of a task, three numbers each, and returns their candidates.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "values from JavaScript come by value"
    )]
    #[wasm_bindgen(unchecked_return_type = "Candidate[]")]
    pub fn evaluate(
        &mut self,
        options: Ts<Options>,
        directions: &[f64],
    ) -> Result<JsValue, JsValue> {
        let options = options.to_rust().map_err(throw_conversion)?;
        let (directions, _) = directions.as_chunks::<3>();
        let task = Task {
            number: 0,
            directions: directions.to_vec(),
        };
        let result = self.slicer.evaluate(&options, task).map_err(throw)?;
        Ok(to_js(&result.candidates))
    }

    /// The profile of the last preview, as that of a plan.
    pub fn preview_profile(&self) -> Vec<f32> {
        self.preview_density.clone()
    }

    /// Describes the model as it stands in its file.
    #[wasm_bindgen(unchecked_return_type = "MeshInfo")]
    pub fn info(&self) -> JsValue {
        to_js(&self.slicer.info())
    }

    /// Plans the layers.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    #[wasm_bindgen(unchecked_return_type = "Report")]
    pub async fn plan(
        &mut self,
        options: Ts<Options>,
        #[wasm_bindgen(
            unchecked_param_type = "(stage: Stage, fraction: number, done: number) => void"
        )]
        progress: Function,
    ) -> Result<JsValue, JsValue> {
        let options = options.to_rust().map_err(throw_conversion)?;
        let report = self
            .slicer
            .plan(&options, &mut progress_to(&progress))
            .await;
        Ok(to_js(report.map_err(throw)?))
    }

    /// Best plans for `points` tolerances, from the tightest that can be held to the loosest that saves a layer.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    #[wasm_bindgen(unchecked_return_type = "Tradeoff")]
    pub async fn tradeoff(
        &mut self,
        options: Ts<Options>,
        points: usize,
        #[wasm_bindgen(
            unchecked_param_type = "(stage: Stage, fraction: number, done: number) => void"
        )]
        progress: Function,
    ) -> Result<JsValue, JsValue> {
        let options = options.to_rust().map_err(throw_conversion)?;
        let mut progress = progress_to(&progress);
        let curve = self.slicer.tradeoff(&options, points, &mut progress).await;
        Ok(to_js(&curve.map_err(throw)?))
    }

    /// The plans of all planners side by side.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    #[wasm_bindgen(unchecked_return_type = "Comparison")]
    pub async fn compare(
        &mut self,
        options: Ts<Options>,
        #[wasm_bindgen(
            unchecked_param_type = "(stage: Stage, fraction: number, done: number) => void"
        )]
        progress: Function,
    ) -> Result<JsValue, JsValue> {
        let options = options.to_rust().map_err(throw_conversion)?;
        let mut progress = progress_to(&progress);
        let comparison = self.slicer.compare(&options, &mut progress).await;
        Ok(to_js(&comparison.map_err(throw)?))
    }

    /// The profile of a metric at the last plan's bins, from the plate upward: error density, or areas in mm² for the
    /// volume deviation.
    ///
    /// # Errors
    /// Throws a `CuspError` if there is no plan.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "values from JavaScript come by value"
    )]
    pub fn profile(&self, metric: Ts<Metric>, source: Ts<Source>) -> Result<Vec<f32>, JsValue> {
        let metric = metric.to_rust().map_err(throw_conversion)?;
        let source = source.to_rust().map_err(throw_conversion)?;
        Ok(self.slicer.profile(metric, source).map_err(throw)?.density)
    }

    /// The mask of a layer, from 0: one bit a pixel, most significant first, rows from the largest y
    /// downward and padded to whole bytes; 1 is lit.
    ///
    /// # Errors
    /// Throws a `CuspError` if there is no plan or no such layer.
    pub fn mask(&mut self, layer: usize) -> Result<Vec<u8>, JsValue> {
        self.slicer.mask(layer).map_err(throw)
    }

    /// Writes the print file of the last plan, in the format that its options ask for: `take` is called with one chunk
    /// after another.
    ///
    /// # Errors
    /// Throws a `CuspError`, or what `take` throws.
    pub fn archive(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "(chunk: Uint8Array) => void")] take: &Function,
        #[wasm_bindgen(
            unchecked_param_type = "(stage: Stage, fraction: number, done: number) => void"
        )]
        progress: &Function,
    ) -> Result<(), JsValue> {
        let chunks = Chunks { take, thrown: None };
        let mut writer = BufWriter::with_capacity(CHUNK_BYTES, chunks);
        let written = self
            .slicer
            .write_archive(&mut writer, &mut progress_to(progress))
            .map(|_| ());
        let flushed = writer.flush();
        let (chunks, _) = writer.into_parts();
        if let Some(thrown) = chunks.thrown {
            return Err(thrown);
        }
        written.map_err(throw)?;
        flushed.map_err(|error| throw(crate::archive::ArchiveError::from(error)))
    }
}

/// Bytes that a print file is handed out by.
const CHUNK_BYTES: usize = 1 << 18;

/// A writer that calls a JavaScript function.
struct Chunks<'a> {
    take: &'a Function,
    /// What that function has thrown.
    thrown: Option<JsValue>,
}

impl Write for Chunks<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let chunk = Uint8Array::from(bytes);
        match self.take.call1(&JsValue::NULL, &chunk) {
            Ok(_) => Ok(bytes.len()),
            Err(thrown) => {
                self.thrown = Some(thrown);
                Err(io::ErrorKind::Other.into())
            }
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
