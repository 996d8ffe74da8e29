//! The slicer in the browser. Errors are those of [`cusp_slicer::job::Error`].

use std::io::{self, BufWriter, Write};
use std::ops::ControlFlow;

use cusp_slicer::archive::{self, ArchiveError, Canvas};
use cusp_slicer::calibration::Calibration;
use cusp_slicer::cure::fit;
use cusp_slicer::facts::Facts;
use cusp_slicer::format::Format;
use cusp_slicer::inspect::Limits;
use cusp_slicer::job::{self, Error, JobOptions, LoadedModel, Options, OptionsError, Stage};
use cusp_slicer::mask::LayerRuns;
use cusp_slicer::model::read::{self, HEAD_BYTES, ReadOptions};
use cusp_slicer::model::{FacetClass, weights};
use cusp_slicer::orientation::packed::{pack, unpack};
use cusp_slicer::orientation::{Search, SearchOptions, Task, TaskResult};
use cusp_slicer::plan::PlanError;
use cusp_slicer::price::{PriceItem, Prices};
use cusp_slicer::printer::PRINTERS;
use cusp_slicer::profile::{Metric, Source};
use cusp_slicer::project::{Project, ProjectPart};
use cusp_slicer::resin::Resin;
use js_sys::{Function, Uint8Array};
use serde::de::DeserializeOwned;
use tsify::{Ts, Tsify};
use wasm_bindgen::JsCast;
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use crate::given;
use crate::js::{thrown, to_js};

/// The type of all errors thrown here: the code and the typed details of an [`Error`], and one sentence that says what
/// to do.
///
/// The types of all errors are generated. An error that holds another is serialised as that one, which `tsify` does not see;
/// `Flat` corrects for it.
#[wasm_bindgen(typescript_custom_section)]
const CUSP_ERROR: &str = r"
type Flat<E> = E extends { detail: infer Held extends { code: string } } ? Flat<Held> : E;
export type CoreError = Flat<NestedError>;
export type CuspError = CoreError & { message: string };
";

fn throw(error: impl Into<Error>) -> JsValue {
    thrown(&error.into())
}

/// Reads what JavaScript gives: options, limits or prices.
fn given<T: DeserializeOwned + Tsify>(value: &Ts<T>) -> Result<T, JsValue>
where
    T::JsType: JsCast,
{
    given::read(&value.js_value()).map_err(|system| throw(OptionsError::Unreadable { system }))
}

/// Calls a JavaScript function with the stage, the fraction of the stage that is done, and the fraction of the whole task.
/// It never cancels: a page terminates the worker instead.
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

/// Models that are printed together, or one alone. Models are counted from 0 in their order, and so are plates. A change of options
/// repeats only what depends on it.
#[wasm_bindgen]
#[derive(Default)]
pub struct Job {
    job: job::Job,
    preview_density: Vec<f32>,
}

/// The format of a model by the first bytes and the length of its file, before it is read.
///
/// # Errors
/// Throws a `CuspError` that names the kind of file.
#[wasm_bindgen(unchecked_return_type = "ModelFormat")]
pub fn identify(head: &[u8], length: f64) -> Result<JsValue, JsValue> {
    let format = read::identify(head, length as u64).map_err(throw)?;
    Ok(to_js(&format))
}

/// The part of a project as JSON; undefined if the file is no project.
///
/// # Errors
/// Throws a `CuspError` if it is damaged.
#[wasm_bindgen]
pub fn project_part(file: &[u8]) -> Result<Option<String>, JsValue> {
    let part = Project::part_of(file).map_err(throw)?;
    Ok(part.map(|part| String::from_utf8_lossy(&part).into_owned()))
}

/// The files of a project: that of each model and that of its weights, in turn; the latter is empty if it has none.
///
/// # Errors
/// Throws a `CuspError` if the project is damaged.
#[wasm_bindgen]
pub fn project_files(file: &[u8]) -> Result<Vec<Uint8Array>, JsValue> {
    let files = Project::files_of(file).map_err(throw)?;
    let files = files.iter().flat_map(|(file, weights)| [file, weights]);
    Ok(files.map(|bytes| Uint8Array::from(&**bytes)).collect())
}

/// Writes a project: options and names, and the files as [`project_files`] returns them.
///
/// # Errors
/// Throws a `CuspError`.
#[wasm_bindgen]
#[expect(
    clippy::needless_pass_by_value,
    reason = "values from JavaScript come by value"
)]
pub fn write_project(part: Ts<ProjectPart>, files: Vec<Uint8Array>) -> Result<Vec<u8>, JsValue> {
    let files: Vec<_> = files.iter().map(Uint8Array::to_vec).collect();
    let (files, _) = files.as_chunks::<2>();
    let project = Project {
        part: given(&part)?,
        files: files.iter().map(|[file, _]| file.clone()).collect(),
        weights: files.iter().map(|[_, weights]| weights.clone()).collect(),
    };
    project.to_bytes().map_err(throw)
}

/// Number of bytes that [`identify`] needs.
#[wasm_bindgen]
pub fn head_bytes() -> usize {
    HEAD_BYTES
}

/// The printers known by name.
#[wasm_bindgen(unchecked_return_type = "Printer[]")]
pub fn printers() -> JsValue {
    to_js(&*PRINTERS)
}

/// Defaults, bounds and formats. The build writes them to `facts.json`.
#[wasm_bindgen(unchecked_return_type = "Facts")]
pub fn facts() -> JsValue {
    to_js(&Facts::default())
}

/// A search for the best orientation. It hands out directions to measure, and measures nothing itself. Several jobs with
/// the same model and options may run its tasks.
#[wasm_bindgen]
pub struct OrientationSearch {
    search: Search,
}

#[wasm_bindgen]
impl OrientationSearch {
    /// A search whose candidates are already measured, as numbers: see [`packed`](cusp_slicer::orientation::packed). It rates them again and
    /// refines the best.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "values from JavaScript come by value"
    )]
    pub fn of_measured(
        search: Ts<SearchOptions>,
        candidates: &[f64],
    ) -> Result<OrientationSearch, JsValue> {
        let options = given(&search)?;
        let search = Search::of_measured(options, unpack(candidates));
        search.map(|search| Self { search }).map_err(throw)
    }

    /// The directions to measure first, three numbers each.
    pub fn directions(&self) -> Vec<f64> {
        self.search.directions().as_flattened().to_vec()
    }

    /// Number of directions that are measured.
    pub fn measured(&self) -> usize {
        self.search.measured()
    }

    /// Hands out up to `most` tasks. There are none while the next ones depend on outstanding results, and at the end.
    #[wasm_bindgen(unchecked_return_type = "Task[]")]
    pub fn next_tasks(&mut self, most: usize) -> JsValue {
        to_js(&self.search.next_tasks(most))
    }

    /// Accepts the candidates of a task, one per direction, as [`Job::evaluate`] returns them. Tasks may be accepted in any order.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    pub fn accept(&mut self, task: usize, candidates: &[f64]) -> Result<(), JsValue> {
        let result = TaskResult {
            number: task,
            candidates: unpack(candidates),
        };
        self.search.accept(result).map_err(throw)
    }

    /// Progress, 0 to 1.
    pub fn progress(&self) -> f64 {
        self.search.progress()
    }

    /// The candidate of each direction, as numbers. Energies are relative to the candidates measured so far.
    pub fn rated(&self) -> Vec<f64> {
        pack(self.search.rated().iter().map(Option::as_ref))
    }

    /// Up to three candidates, best first and at least 20° apart, as numbers. Undefined until all tasks are done.
    pub fn best(&self) -> Option<Vec<f64>> {
        let best = self.search.best()?;
        Some(pack(best.iter().map(Some)))
    }
}

#[wasm_bindgen]
impl Job {
    /// A job without models.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Job {
        Self::default()
    }

    /// Reads an STL, a 3MF or an OBJ, and adds it after the other models.
    ///
    /// # Errors
    /// Throws a `CuspError` if the bytes are not a usable model.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "values from JavaScript come by value"
    )]
    pub fn add(&mut self, file: &[u8], options: Ts<ReadOptions>) -> Result<(), JsValue> {
        let options = given(&options)?;
        let model = LoadedModel::read_with(file, &options).map_err(throw)?;
        self.job.add(model);
        Ok(())
    }

    /// Number of models.
    pub fn models(&self) -> usize {
        self.job.models().len()
    }

    /// Removes a model. The indices of those after it become one less.
    ///
    /// # Errors
    /// Throws a `CuspError` if there is no such model.
    pub fn remove(&mut self, model: usize) -> Result<(), JsValue> {
        self.job.remove(model).map(|_| ()).map_err(throw)
    }

    /// Vertex positions of the surface facets of a model, nine numbers per facet, in millimetres, in the file's frame.
    ///
    /// # Errors
    /// Throws a `CuspError` if there is no such model.
    pub fn positions(&self, model: usize) -> Result<Vec<f32>, JsValue> {
        Ok(self.job.model(model).map_err(throw)?.positions())
    }

    /// Vertex positions of a model's supports in the last plan, nine numbers per facet, in millimetres from the plate, for a copy
    /// that is not turned; none without supports.
    ///
    /// # Errors
    /// Throws a `CuspError` if there is no such model.
    pub fn supports(&self, model: usize) -> Result<Vec<f32>, JsValue> {
        let supports = self.job.positions_of(model, FacetClass::Support);
        supports.map_err(throw)
    }

    /// Vertex positions of the walls of a model's void in the last plan, likewise; none of a solid model.
    ///
    /// # Errors
    /// Throws a `CuspError` if there is no such model.
    pub fn voids(&self, model: usize) -> Result<Vec<f32>, JsValue> {
        let voids = self.job.positions_of(model, FacetClass::Void);
        voids.map_err(throw)
    }

    /// Vertex positions of a plug for each drain hole of a model in the last plan, likewise, in a row on the plate; none without
    /// holes.
    ///
    /// # Errors
    /// Throws a `CuspError` if there is no such model.
    pub fn plugs(&self, model: usize) -> Result<Vec<f32>, JsValue> {
        self.job.plug_positions(model).map_err(throw)
    }

    /// The saliency of each facet of a model, 0 to 1: how much it stands out.
    ///
    /// # Errors
    /// Throws a `CuspError` if there is no such model.
    pub fn saliency(
        &mut self,
        model: usize,
        #[wasm_bindgen(
            unchecked_param_type = "(stage: Stage, fraction: number, done: number) => void"
        )]
        progress: &Function,
    ) -> Result<Vec<f32>, JsValue> {
        let model = self.job.model_mut(model).map_err(throw)?;
        let saliency = model.saliency(&mut progress_to(progress));
        Ok(saliency.map_err(throw)?.to_vec())
    }

    /// Sets a weight from 0 to 1 for each facet of a model, or removes all weights. Later plans and previews use them.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    pub fn set_weights(&mut self, model: usize, weights: Option<Vec<f32>>) -> Result<(), JsValue> {
        let model = self.job.model_mut(model).map_err(throw)?;
        model.set_weights(weights).map_err(throw)
    }

    /// Writes weights as a file for a model.
    ///
    /// # Errors
    /// Throws a `CuspError` unless there is a weight from 0 to 1 for every facet.
    pub fn weights_file(&self, model: usize, weights: &[f32]) -> Result<Vec<u8>, JsValue> {
        let corners = self.positions(model)?;
        weights::check(weights, corners.len() / 9).map_err(throw)?;
        Ok(weights::to_bytes(weights, &corners))
    }

    /// The weights in a file, which must be for this model.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    pub fn read_weights(&self, model: usize, file: &[u8]) -> Result<Vec<f32>, JsValue> {
        weights::from_bytes(file, &self.positions(model)?).map_err(throw)
    }

    /// Plans a model in its pose from the facets alone, in a few milliseconds: fast enough to follow a rotation live. The
    /// last plan is kept.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "values from JavaScript come by value"
    )]
    #[wasm_bindgen(unchecked_return_type = "Preview")]
    pub fn preview(&mut self, model: usize, options: Ts<Options>) -> Result<JsValue, JsValue> {
        let options = given(&options)?;
        let model = self.job.model(model).map_err(throw)?;
        let (preview, profile) = model.preview(&options).map_err(throw)?;
        self.preview_density = profile.density;
        Ok(to_js(&preview))
    }

    /// A search over directions spread evenly, the axes, and the normals of a model's largest flats.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "values from JavaScript come by value"
    )]
    pub fn search(
        &mut self,
        model: usize,
        options: Ts<Options>,
        search: Ts<SearchOptions>,
    ) -> Result<OrientationSearch, JsValue> {
        let options = given(&options)?;
        let search = given(&search)?;
        let model = self.job.model_mut(model).map_err(throw)?;
        let search = model.search(&options, &search);
        search
            .map(|search| OrientationSearch { search })
            .map_err(throw)
    }

    /// Measures the directions of a task, three numbers each, and returns their candidates as numbers.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "values from JavaScript come by value"
    )]
    pub fn evaluate(
        &mut self,
        model: usize,
        options: Ts<Options>,
        directions: &[f64],
    ) -> Result<Vec<f64>, JsValue> {
        let options = given(&options)?;
        let (directions, _) = directions.as_chunks::<3>();
        let task = Task {
            number: 0,
            directions: directions.to_vec(),
        };
        let model = self.job.model_mut(model).map_err(throw)?;
        let result = model.evaluate(&options, task).map_err(throw)?;
        Ok(pack(result.candidates.iter().map(Some)))
    }

    /// The profile of the last preview, in the same form as [`Self::profile`].
    pub fn preview_profile(&self) -> Vec<f32> {
        self.preview_density.clone()
    }

    /// Describes a model in the frame of its file.
    ///
    /// # Errors
    /// Throws a `CuspError` if there is no such model.
    #[wasm_bindgen(unchecked_return_type = "MeshInfo")]
    pub fn info(&self, model: usize) -> Result<JsValue, JsValue> {
        Ok(to_js(&self.job.model(model).map_err(throw)?.info()))
    }

    /// Places of copies when they are arranged.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "values from JavaScript come by value"
    )]
    #[wasm_bindgen(unchecked_return_type = "Placement[]")]
    pub fn arrange(&mut self, options: Ts<JobOptions>) -> Result<JsValue, JsValue> {
        let options = given(&options)?;
        Ok(to_js(&self.job.arrange(&options).map_err(throw)?))
    }

    /// Faults of the placements of the options: copies that extend beyond their plate, and copies that overlap.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "values from JavaScript come by value"
    )]
    #[wasm_bindgen(unchecked_return_type = "ArrangeError[]")]
    pub fn problems(&mut self, options: Ts<JobOptions>) -> Result<JsValue, JsValue> {
        let options = given(&options)?;
        let problems = self.job.problems(&options);
        Ok(to_js(&problems.map_err(throw)?))
    }

    /// Plans the layers of all plates.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    #[wasm_bindgen(unchecked_return_type = "JobReport")]
    pub async fn plan(
        &mut self,
        options: Ts<JobOptions>,
        #[wasm_bindgen(
            unchecked_param_type = "(stage: Stage, fraction: number, done: number) => void"
        )]
        progress: Function,
    ) -> Result<JsValue, JsValue> {
        let options = given(&options)?;
        let report = self.job.plan(&options, &mut progress_to(&progress)).await;
        Ok(to_js(&report.map_err(throw)?))
    }

    /// The best plans of a plate for `points` tolerances, from the smallest that a plan keeps to the largest that makes a difference.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    #[wasm_bindgen(unchecked_return_type = "Tradeoff")]
    pub async fn tradeoff(
        &mut self,
        plate: usize,
        options: Ts<JobOptions>,
        points: usize,
        #[wasm_bindgen(
            unchecked_param_type = "(stage: Stage, fraction: number, done: number) => void"
        )]
        progress: Function,
    ) -> Result<JsValue, JsValue> {
        let options = given(&options)?;
        let mut progress = progress_to(&progress);
        let curve = self.job.tradeoff(plate, &options, points, &mut progress);
        Ok(to_js(&curve.await.map_err(throw)?))
    }

    /// Compares the plans of five planners for a plate, from the coarsest to the finest.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    #[wasm_bindgen(unchecked_return_type = "Comparison")]
    pub async fn compare(
        &mut self,
        plate: usize,
        options: Ts<JobOptions>,
        #[wasm_bindgen(
            unchecked_param_type = "(stage: Stage, fraction: number, done: number) => void"
        )]
        progress: Function,
    ) -> Result<JsValue, JsValue> {
        let options = given(&options)?;
        let mut progress = progress_to(&progress);
        let comparison = self.job.compare(plate, &options, &mut progress);
        Ok(to_js(&comparison.await.map_err(throw)?))
    }

    /// The profile of a metric in the bins of a plate of the last plan, from the plate upward, in each the largest of its models: error
    /// density, or areas in mm² for the volume deviation.
    ///
    /// # Errors
    /// Throws a `CuspError` if there is no plan or no such plate.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "values from JavaScript come by value"
    )]
    pub fn profile(
        &self,
        plate: usize,
        metric: Ts<Metric>,
        source: Ts<Source>,
    ) -> Result<Vec<f32>, JsValue> {
        let metric = given(&metric)?;
        let source = given(&source)?;
        let profile = self.job.profile(plate, metric, source);
        Ok(profile.map_err(throw)?.density)
    }

    /// The mask of a layer of a plate, from 0: one bit per pixel, most significant first, rows from the largest y downward and padded
    /// to whole bytes. 1 is lit.
    ///
    /// # Errors
    /// Throws a `CuspError` if there is no plan, no such plate or no such layer.
    pub fn mask(&mut self, plate: usize, layer: usize) -> Result<Vec<u8>, JsValue> {
        self.job.mask(plate, layer).map_err(throw)
    }

    /// Findings on a plate of the last plan, by these limits.
    ///
    /// # Errors
    /// Throws a `CuspError` if there is no plan or no such plate, or if a limit is out of bounds.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "values from JavaScript come by value"
    )]
    #[wasm_bindgen(unchecked_return_type = "PlatePrintability")]
    pub fn inspect(
        &mut self,
        plate: usize,
        limits: Ts<Limits>,
        #[wasm_bindgen(
            unchecked_param_type = "(stage: Stage, fraction: number, done: number) => void"
        )]
        progress: &Function,
    ) -> Result<JsValue, JsValue> {
        let limits = given(&limits)?;
        let found = self.job.inspect(plate, &limits, &mut progress_to(progress));
        Ok(to_js(&found.map_err(throw)?))
    }

    /// The masks of a plate's print file in groups, for other workers to encode; nothing if the file has none, or if sending them takes
    /// as long as encoding them.
    ///
    /// # Errors
    /// Throws a `CuspError` if there is no plan or no such plate.
    pub fn layer_groups(&mut self, plate: usize) -> Result<Option<LayerGroups>, JsValue> {
        let groups = self.job.layer_groups(plate).map_err(throw)?;
        Ok(groups.map(|groups| LayerGroups { groups }))
    }

    /// Writes the print file of a plate in the format of its options, by calling `take` with one chunk after another. `encoded`, if
    /// given, fetches each group of [`Self::layer_groups`], counted from 0, as [`encode_group`] encodes it.
    ///
    /// # Errors
    /// Throws a `CuspError`, or what `take` throws.
    pub fn archive(
        &mut self,
        plate: usize,
        #[wasm_bindgen(unchecked_param_type = "((group: number) => Uint8Array) | null")]
        encoded: Option<Function>,
        #[wasm_bindgen(unchecked_param_type = "(chunk: Uint8Array) => void")] take: &Function,
        #[wasm_bindgen(
            unchecked_param_type = "(stage: Stage, fraction: number, done: number) => void"
        )]
        progress: &Function,
    ) -> Result<(), JsValue> {
        let group_of = encoded.map(|encoded| {
            move |group: usize| {
                let bytes = encoded.call1(&JsValue::NULL, &JsValue::from(group as u32));
                // A function that throws gives no layers, which is an error of the writer.
                bytes.map_or_else(|_| Vec::new(), |bytes| Uint8Array::from(bytes).to_vec())
            }
        });
        let group_of = group_of.as_ref().map(|it| it as &dyn Fn(usize) -> Vec<u8>);
        let mut writer = Chunks::to(take);
        let written = self
            .job
            .write_archive_of(plate, group_of, &mut writer, &mut progress_to(progress))
            .map(|_| ());
        Chunks::end(writer, written)
    }
}

/// The masks of a plan, read group by group.
#[wasm_bindgen]
pub struct LayerGroups {
    groups: job::LayerGroups,
}

#[wasm_bindgen]
impl LayerGroups {
    /// Number of groups that are left.
    pub fn left(&self) -> usize {
        self.groups.left()
    }

    /// The format of the print file, which [`encode_group`] asks for.
    #[wasm_bindgen(unchecked_return_type = "Format")]
    pub fn format(&self) -> JsValue {
        to_js(&self.groups.format)
    }

    /// The canvas for [`encode_group`]: columns, rows and the level of anti-aliasing.
    pub fn canvas(&self) -> Vec<u32> {
        let Canvas { pixels, antialias } = self.groups.canvas;
        vec![pixels[0], pixels[1], antialias]
    }

    /// Reports progress, when the groups read so far are encoded.
    pub fn report(
        &self,
        #[wasm_bindgen(
            unchecked_param_type = "(stage: Stage, fraction: number, done: number) => void"
        )]
        progress: &Function,
    ) {
        let _ = progress_to(progress)(Stage::Masks, self.groups.progress());
    }

    /// The runs of the next group; none after the last one.
    pub fn next_runs(&mut self) -> Option<Vec<u32>> {
        self.groups.next().map(|runs| runs.to_words())
    }
}

/// Encodes a group of layers, which needs no model.
///
/// # Errors
/// Throws a `CuspError` if these are no runs of this build.
#[expect(
    clippy::needless_pass_by_value,
    reason = "values from JavaScript come by value"
)]
#[wasm_bindgen]
pub fn encode_group(format: Ts<Format>, canvas: &[u32], runs: &[u32]) -> Result<Vec<u8>, JsValue> {
    let format = given(&format)?;
    let given = (canvas, LayerRuns::of_words(runs));
    let (&[columns, rows, antialias], Some(runs)) = given else {
        return Err(throw(ArchiveError::from(io::Error::other(
            "the runs of layers were cut",
        ))));
    };
    let canvas = Canvas {
        pixels: [columns, rows],
        antialias,
    };
    archive::encode_group(format, canvas, &runs).map_err(throw)
}

/// Writes the print of two towers that shows if a printer prints layers of several thicknesses, by calling `take` with
/// one chunk after another, and returns its report. Of the options, printer, screen, format and resin count.
///
/// # Errors
/// Throws a `CuspError`, or what `take` throws.
#[wasm_bindgen(unchecked_return_type = "Report")]
pub async fn calibrate_layers(
    options: Ts<Options>,
    #[wasm_bindgen(unchecked_param_type = "(chunk: Uint8Array) => void")] take: Function,
    #[wasm_bindgen(
        unchecked_param_type = "(stage: Stage, fraction: number, done: number) => void"
    )]
    progress: Function,
) -> Result<JsValue, JsValue> {
    let calibration = Calibration::layers(&given(&options)?).map_err(throw)?;
    calibrate(&calibration, &take, &progress).await
}

/// Writes the print of the bridges that measure a resin's print-through, as [`calibrate_layers`] writes towers.
///
/// # Errors
/// Throws a `CuspError`, or what `take` throws.
#[wasm_bindgen(unchecked_return_type = "Report")]
pub async fn calibrate_cure(
    options: Ts<Options>,
    #[wasm_bindgen(unchecked_param_type = "(chunk: Uint8Array) => void")] take: Function,
    #[wasm_bindgen(
        unchecked_param_type = "(stage: Stage, fraction: number, done: number) => void"
    )]
    progress: Function,
) -> Result<JsValue, JsValue> {
    let bridges = Calibration::cure(&given(&options)?, Calibration::BRIDGES_MM).map_err(throw)?;
    calibrate(&bridges, &take, &progress).await
}

async fn calibrate(
    calibration: &Calibration,
    take: &Function,
    progress: &Function,
) -> Result<JsValue, JsValue> {
    let mut writer = Chunks::to(take);
    let mut progress = progress_to(progress);
    let written = calibration.write(&mut writer, &mut progress).await;
    let mut report = JsValue::NULL;
    let written = written.map(|(_, written)| report = to_js(&written));
    Chunks::end(writer, written)?;
    Ok(report)
}

/// Print-through of a resin by the measured thicknesses of these bridges in millimetres, thickness by thickness; NaN for those that were
/// not measured. `undefined` if there are too few.
///
/// # Errors
/// Throws a `CuspError`.
#[expect(
    clippy::needless_pass_by_value,
    reason = "values from JavaScript come by value"
)]
#[wasm_bindgen(unchecked_return_type = "CureFit | undefined")]
pub fn fit_cure(measured_mm: &[f64], resin: Ts<Resin>) -> Result<JsValue, JsValue> {
    let resin: Resin = given(&resin)?;
    resin
        .check()
        .map_err(|error| throw(PlanError::from(error)))?;
    let found = fit(&Calibration::measured_bridges(measured_mm), &resin);
    Ok(found.map_or(JsValue::UNDEFINED, |found| to_js(&found)))
}

/// Size of these chunks in bytes.
const CHUNK_BYTES: usize = 1 << 18;

/// A writer that calls a JavaScript function.
struct Chunks<'a> {
    take: &'a Function,
    /// The value that this function threw.
    thrown: Option<JsValue>,
}

impl<'a> Chunks<'a> {
    /// A writer that calls `take` with large chunks.
    fn to(take: &'a Function) -> BufWriter<Self> {
        BufWriter::with_capacity(CHUNK_BYTES, Self { take, thrown: None })
    }

    /// Writes the rest, and throws any error.
    fn end(mut writer: BufWriter<Self>, written: Result<(), Error>) -> Result<(), JsValue> {
        let flushed = writer.flush();
        let (chunks, _) = writer.into_parts();
        if let Some(thrown) = chunks.thrown {
            return Err(thrown);
        }
        written.map_err(throw)?;
        flushed.map_err(|error| throw(ArchiveError::from(error)))
    }
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

/// The price of an order by the prices of a shop. For each item, `items` has the number of copies, and the millilitres
/// of resin, those of them in supports, and the seconds of one copy. NaN stands for supports that are not planned.
///
/// # Errors
/// Throws a `CuspError`.
#[expect(
    clippy::needless_pass_by_value,
    reason = "values from JavaScript come by value"
)]
#[wasm_bindgen(unchecked_return_type = "Price")]
pub fn price(
    prices: Ts<Prices>,
    items: &[f64],
    finish: Option<String>,
) -> Result<JsValue, JsValue> {
    let (items, _) = items.as_chunks::<4>();
    let items = items
        .iter()
        .map(|&[copies, resin_ml, support_ml, print_time_s]| PriceItem {
            // An invalid number of copies becomes 0, which no order may have.
            copies: copies as usize,
            resin_ml,
            support_ml: Some(support_ml).filter(|it| !it.is_nan()),
            print_time_s,
        });
    let items: Vec<PriceItem> = items.collect();
    let prices = given(&prices)?;
    let price = prices.price(&items, finish.as_deref());
    Ok(to_js(&price.map_err(throw)?))
}
