//! Job files: models, options and places of plates.

use std::path::{Path, PathBuf};

use cusp_slicer::arrange::Arranging;
use cusp_slicer::job::{LoadedModel, ModelOptions, Options, Placement};
use cusp_slicer::model::read::ReadOptions;
use cusp_slicer::plan::HeightRange;
use cusp_slicer::prepare::{Hollowing, Supporting};
use serde::{Deserialize, Serialize};

use crate::failure::{Failure, is_standard};
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
#[derive(Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
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
}

fn one() -> usize {
    1
}

impl JobModel {
    pub fn new(file: PathBuf, copies: usize, reading: &ReadOptions) -> Self {
        Self {
            file,
            plate: reading.plate_number,
            surfaces: reading.surfaces,
            curved_caps: reading.curved_caps,
            supports_as_model: reading.supports_as_model,
            ..Self::of(&ModelOptions {
                copies,
                ..ModelOptions::default()
            })
        }
    }

    /// A model without a file.
    pub fn of(own: &ModelOptions) -> Self {
        Self {
            file: PathBuf::new(),
            copies: own.copies,
            rotation: own.rotation,
            height_mm: own.height_mm,
            hollow: own.hollow.clone(),
            supports: own.supports.clone(),
            tolerance: own.tolerance,
            ranges: own.ranges.clone(),
            weights: None,
            plate: None,
            surfaces: false,
            curved_caps: false,
            supports_as_model: false,
        }
    }

    /// Choices for reading it.
    pub fn reading(&self) -> ReadOptions {
        ReadOptions {
            plate_number: self.plate,
            surfaces: self.surfaces,
            curved_caps: self.curved_caps,
            supports_as_model: self.supports_as_model,
        }
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
    /// The job file, if the only argument is one: JSON, by its name.
    pub fn of(models: &[PathBuf]) -> Result<Option<Self>, Failure> {
        let [path] = models else {
            return Ok(None);
        };
        let is_json = path
            .extension()
            .is_some_and(|end| end.eq_ignore_ascii_case("json"));
        if is_standard(path) || !is_json {
            return Ok(None);
        }
        read_json(path).map(Some)
    }

    /// Reads all models, whose paths are relative to this folder.
    pub fn read_models(&self, folder: Option<&Path>) -> Result<LoadedModels, Failure> {
        let mut read = LoadedModels::default();
        for model in &self.models {
            let path = within(folder, &model.file);
            let weights = model.weights.as_deref();
            let weights = weights.map(|path| within(folder, path));
            let reading = Reading {
                weights: weights.as_deref().map(WeightsFile::read).transpose()?,
                options: model.reading(),
            };
            read.models.push(reading.load(&path)?);
            read.weights.push(weights);
            read.paths.push(path);
        }
        Ok(read)
    }
}

/// A path of a job file, which is relative to the folder of the file.
pub fn within(folder: Option<&Path>, path: &Path) -> PathBuf {
    folder.map_or_else(|| path.to_owned(), |folder| folder.join(path))
}

/// The models of a job file.
#[derive(Default)]
pub struct LoadedModels {
    pub models: Vec<LoadedModel>,
    pub paths: Vec<PathBuf>,
    /// The file of weights of each, if it has one.
    pub weights: Vec<Option<PathBuf>>,
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

/// A path that is valid from the folder of a job file, too.
pub fn path_from(job_file: Option<&Path>, path: &Path) -> PathBuf {
    let folder = job_file.and_then(Path::parent);
    let is_here = folder.is_none_or(|folder| folder.as_os_str().is_empty());
    if is_here || path.is_absolute() {
        path.to_owned()
    } else {
        path.canonicalize().unwrap_or_else(|_| path.to_owned())
    }
}
