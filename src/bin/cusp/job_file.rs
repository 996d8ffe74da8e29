//! Job files: models, options and places of plates. Projects are job files with their models inside.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use cusp_slicer::arrange::Arranging;
use cusp_slicer::job::{JobOptions, LoadedModel, ModelOptions, Options, Placement};
use cusp_slicer::model::read::ReadOptions;
use cusp_slicer::plan::HeightRange;
use cusp_slicer::prepare::{Hollowing, Supporting};
use cusp_slicer::project::{Project, ProjectModel, ProjectPart};
use serde::{Deserialize, Serialize};

use crate::failure::{Failure, in_file, is_standard};
use crate::files::{Reading, WeightsFile, read_json};

/// A job file: models, options and places. Paths are relative to the file.
#[derive(Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JobFile {
    /// The models.
    pub models: Vec<JobModel>,
    /// Options of all models: the names that reports have under `options`.
    #[serde(default)]
    pub options: Options,
    /// Options for arranging the copies.
    #[serde(default)]
    pub arranging: Arranging,
    /// Place of each copy. If empty, copies are arranged.
    #[serde(default)]
    pub placements: Vec<Placement>,
}

/// A model of a job file.
#[derive(Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "independent choices, each of which may be made or not"
)]
pub struct JobModel {
    /// The file.
    pub file: PathBuf,
    /// Number of copies.
    #[serde(default = "one")]
    pub copies: usize,
    /// Rotation from the pose in the file: a quaternion x, y, z, w.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation: Option<[f64; 4]>,
    /// Height to which the model is scaled.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height_mm: Option<f64>,
    /// Hollowing of this model.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hollow: Option<Hollowing>,
    /// Supports of this model.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub supports: Option<Supporting>,
    /// Maximum error of a layer on this model.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Height ranges of this model with a layer thickness of their own.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ranges: Vec<HeightRange>,
    /// A file of weights of its facets.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weights: Option<PathBuf>,
    /// The plate of a project that has several, from 1; the first if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plate: Option<u32>,
    /// True if objects that a 3MF calls surfaces are read, too.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub surfaces: bool,
    /// True if every hole is closed by a curved cap.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub curved_caps: bool,
    /// True if bodies that look like supports are parts of the model.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub supports_as_model: bool,
    /// True if the model is mirrored in the plane x = 0 of its file.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub mirrored: bool,
    /// The contents of the file and its weights, if the job file is a project.
    #[serde(skip)]
    inside: Option<Arc<(Vec<u8>, Vec<f32>)>>,
}

fn one() -> usize {
    1
}

impl JobModel {
    pub fn new(file: PathBuf, own: &ModelOptions, reading: &ReadOptions) -> Self {
        Self {
            file,
            copies: own.copies,
            rotation: own.rotation,
            height_mm: own.height_mm,
            hollow: own.hollow.clone(),
            supports: own.supports.clone(),
            tolerance: own.tolerance,
            ranges: own.ranges.clone(),
            weights: None,
            plate: reading.plate_number,
            surfaces: reading.surfaces,
            curved_caps: reading.curved_caps,
            supports_as_model: reading.supports_as_model,
            mirrored: reading.mirrored,
            inside: None,
        }
    }

    /// The same model with options of its own.
    pub fn with_own(&self, own: &ModelOptions) -> Self {
        Self {
            weights: self.weights.clone(),
            inside: self.inside.clone(),
            ..Self::new(self.file.clone(), own, &self.reading())
        }
    }

    /// Makes its paths valid from the folder of a job file.
    pub fn relate_to(&mut self, job_file: &Path) {
        self.file = path_from(job_file, &self.file);
        self.weights = self.weights.take().map(|path| path_from(job_file, &path));
    }

    /// Choices for reading it.
    pub fn reading(&self) -> ReadOptions {
        ReadOptions {
            plate_number: self.plate,
            surfaces: self.surfaces,
            curved_caps: self.curved_caps,
            supports_as_model: self.supports_as_model,
            mirrored: self.mirrored,
        }
    }

    /// The path of the file, which is relative to this folder; of a model of a project its name.
    pub fn path(&self, folder: Option<&Path>) -> PathBuf {
        within(folder.filter(|_| self.inside.is_none()), &self.file)
    }

    /// The same model with the paths that are relative to this folder.
    fn at(&self, folder: Option<&Path>) -> Self {
        Self {
            file: self.path(folder),
            weights: self.weights.as_deref().map(|path| within(folder, path)),
            ..self.clone()
        }
    }

    /// The file, whose path is relative to this folder.
    pub fn bytes(&self, folder: Option<&Path>) -> Result<Vec<u8>, Failure> {
        let path = self.path(folder);
        match self.inside.as_deref() {
            Some((file, _)) => Ok(file.clone()),
            None => Ok(fs::read(&path).map_err(|error| in_file(&path, &error))?),
        }
    }

    /// Reads it with its weights.
    fn load(&self, folder: Option<&Path>) -> Result<LoadedModel, Failure> {
        let path = self.path(folder);
        let options = self.reading();
        let Some((file, weights)) = self.inside.as_deref() else {
            let weights = self.weights.as_deref();
            let weights = weights.map(|path| WeightsFile::read(&within(folder, path)));
            let weights = weights.transpose()?;
            return Reading { weights, options }.load(&path);
        };
        let painted = (!weights.is_empty()).then(|| weights.clone());
        let loaded = LoadedModel::read_with(file, &options).and_then(|mut loaded| {
            loaded.set_weights(painted)?;
            Ok(loaded)
        });
        loaded.map_err(|error| Failure::in_file(&path, &error))
    }

    pub fn own(&self) -> ModelOptions {
        ModelOptions {
            copies: self.copies,
            rotation: self.rotation,
            height_mm: self.height_mm,
            hollow: self.hollow.clone(),
            supports: self.supports.clone(),
            tolerance: self.tolerance,
            ranges: self.ranges.clone(),
        }
    }
}

impl JobFile {
    /// The job file, if the only argument is one: JSON by its name, or a project.
    pub fn of(models: &[PathBuf]) -> Result<Option<Self>, Failure> {
        let [path] = models else {
            return Ok(None);
        };
        if is_named_as_project(path) {
            // A file that cannot be read is reported as a model.
            let project = Project::read(&fs::read(path).unwrap_or_default());
            let project = project.map_err(|error| Failure::in_file(path, &error))?;
            return Ok(project.map(Self::from));
        }
        let is_json = path
            .extension()
            .is_some_and(|end| end.eq_ignore_ascii_case("json"));
        if is_standard(path) || !is_json {
            return Ok(None);
        }
        read_json(path).map(Some)
    }

    /// Returns true if the only argument is a job file. The models of a project are not read.
    pub fn is(models: &[PathBuf]) -> Result<bool, Failure> {
        let [path] = models else {
            return Ok(false);
        };
        if !is_named_as_project(path) {
            return Ok(Self::of(models)?.is_some());
        }
        let part = Project::part_of(&fs::read(path).unwrap_or_default());
        let part = part.map_err(|error| Failure::in_file(path, &error))?;
        Ok(part.is_some())
    }

    /// Reads all models, whose paths are relative to this folder.
    pub fn read_models(&self, folder: Option<&Path>) -> Result<LoadedModels, Failure> {
        let mut read = LoadedModels::default();
        for model in &self.models {
            read.models.push(model.load(folder)?);
            read.files.push(model.at(folder));
        }
        Ok(read)
    }

    /// Returns true if the models are inside, as those of a project.
    pub fn is_project(&self) -> bool {
        self.models.iter().any(|model| model.inside.is_some())
    }

    /// The project of this job, whose paths are relative to the working directory, and whose models are `loaded`.
    pub fn project(&self, loaded: &[LoadedModel]) -> Result<Project, Failure> {
        let named = self.models.iter().map(|model| ProjectModel {
            name: model
                .file
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned(),
            reading: model.reading(),
        });
        let mut project = Project {
            part: ProjectPart {
                job: JobOptions {
                    options: self.options.clone(),
                    models: self.models.iter().map(JobModel::own).collect(),
                    arranging: self.arranging,
                    placements: self.placements.clone(),
                },
                models: named.collect(),
                form: String::new(),
            },
            ..Project::default()
        };
        for (model, loaded) in self.models.iter().zip(loaded) {
            project.files.push(model.bytes(None)?);
            let weights = loaded.painted().unwrap_or_default().iter();
            let bytes = weights.flat_map(|weight| weight.to_le_bytes());
            project.weights.push(bytes.collect());
        }
        Ok(project)
    }
}

impl From<Project> for JobFile {
    fn from(project: Project) -> Self {
        let Project {
            part: ProjectPart { job, models, .. },
            files,
            weights,
        } = project;
        let floats = |bytes: Vec<u8>| {
            let (floats, _) = bytes.as_chunks::<4>();
            floats.iter().copied().map(f32::from_le_bytes).collect()
        };
        let inside = files.into_iter().zip(weights.into_iter().map(floats));
        let models = models.into_iter().zip(inside).enumerate();
        let models = models.map(|(place, (ProjectModel { name, reading }, inside))| {
            let own = job.models.get(place).cloned().unwrap_or_default();
            JobModel {
                inside: Some(Arc::new(inside)),
                ..JobModel::new(name.into(), &own, &reading)
            }
        });
        Self {
            models: models.collect(),
            options: job.options,
            arranging: job.arranging,
            placements: job.placements,
        }
    }
}

/// A path of a job file, which is relative to the folder of the file.
fn within(folder: Option<&Path>, path: &Path) -> PathBuf {
    folder.map_or_else(|| path.to_owned(), |folder| folder.join(path))
}

/// The models of a job file.
#[derive(Default)]
pub struct LoadedModels {
    pub models: Vec<LoadedModel>,
    /// The models as in the job file, with paths that do not depend on its folder.
    pub files: Vec<JobModel>,
}

/// A model and its number of copies: `part.stl:3`, unless there is a file of that name.
pub fn with_copies(model: &Path) -> (PathBuf, Option<usize>) {
    let text = model.to_string_lossy();
    let parts = text.rsplit_once(':').filter(|_| !model.exists());
    let copies = parts.and_then(|(file, copies)| Some((file, copies.parse().ok()?)));
    copies.map_or_else(
        || (model.to_owned(), None),
        |(file, copies)| (PathBuf::from(file), Some(copies)),
    )
}

/// Returns true if a path ends as that of a project.
pub fn is_named_as_project(path: &Path) -> bool {
    path.extension()
        .is_some_and(|end| end.eq_ignore_ascii_case("3mf"))
}

/// A path that is valid from the folder of a job file, too.
fn path_from(job_file: &Path, path: &Path) -> PathBuf {
    let folder = job_file.parent();
    let is_here = folder.is_none_or(|folder| folder.as_os_str().is_empty());
    if is_here || path.is_absolute() {
        path.to_owned()
    } else {
        path.canonicalize().unwrap_or_else(|_| path.to_owned())
    }
}
