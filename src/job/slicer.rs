//! A job of a single copy of a single model, by the model's own options.

use std::io::Write;
use std::ops::{Deref, DerefMut};

use glam::Vec3;

#[cfg(not(target_arch = "wasm32"))]
use super::FrontPoint;
use super::groups::LayerGroups;
use super::stage::StageProgress;
use super::{Comparison, Error, Job, JobOptions, LoadedModel, Options, Report, Tradeoff};
use crate::inspect::{Limits, Printability};
use crate::ldi::gpu::Gpu;
use crate::model::read::ReadOptions;
use crate::model::{FacetClass, FileFacts, Mesh};
use crate::plan::Plan;
use crate::prepare::Shell;
use crate::profile::{Metric, Profile, Source};

/// A job of a single copy of a single model.
#[derive(Debug)]
pub struct Slicer(Job);

impl Deref for Slicer {
    type Target = LoadedModel;

    fn deref(&self) -> &LoadedModel {
        &self.0.models[0]
    }
}

impl DerefMut for Slicer {
    fn deref_mut(&mut self) -> &mut LoadedModel {
        &mut self.0.models[0]
    }
}

impl Slicer {
    /// Reads a model: see [`LoadedModel::read`].
    ///
    /// # Errors
    /// [`Error::Read`], [`Error::Mesh`].
    pub fn load(bytes: &[u8]) -> Result<Self, Error> {
        LoadedModel::read(bytes).map(Self::of)
    }

    /// Reads a model with choices.
    ///
    /// # Errors
    /// [`Error::Read`], [`Error::Mesh`].
    pub fn load_with(bytes: &[u8], options: &ReadOptions) -> Result<Self, Error> {
        LoadedModel::read_with(bytes, options).map(Self::of)
    }

    /// A model that was read elsewhere.
    ///
    /// # Errors
    /// [`Error::Mesh`].
    pub fn of_triangles(triangles: &[[Vec3; 3]], facts: FileFacts) -> Result<Self, Error> {
        LoadedModel::of_triangles(triangles, facts).map(Self::of)
    }

    /// A job of this model.
    pub fn of(model: LoadedModel) -> Self {
        Self(Job::new(vec![model]))
    }

    /// See [`Job::with_gpu`].
    #[must_use]
    pub fn with_gpu(self, gpu: Gpu) -> Self {
        Self(self.0.with_gpu(gpu))
    }

    /// See [`Job::with_memory`].
    #[cfg(not(target_arch = "wasm32"))]
    #[must_use]
    pub fn with_memory(self, bytes: u64) -> Self {
        Self(self.0.with_memory(bytes))
    }

    /// See [`Job::with_cpu_time`].
    #[cfg(not(target_arch = "wasm32"))]
    #[must_use]
    pub fn with_cpu_time(self, seconds: f64) -> Self {
        Self(self.0.with_cpu_time(seconds))
    }

    /// See [`Job::open_gpu`].
    pub async fn open_gpu(&mut self) {
        self.0.open_gpu().await;
    }

    /// See [`Job::prepared_mesh`].
    pub fn prepared(&self) -> Option<&Mesh> {
        self.0.prepared_mesh(0).ok()?
    }

    /// See [`Job::positions_of`].
    pub fn positions_of(&self, class: FacetClass) -> Vec<f32> {
        self.0.positions_of(0, class).unwrap_or_default()
    }

    /// See [`Job::plugs`].
    pub fn plugs(&self) -> Option<Shell> {
        self.0.plugs(0).ok()?
    }

    /// See [`Job::plug_positions`].
    pub fn plug_positions(&self) -> Vec<f32> {
        self.0.plug_positions(0).unwrap_or_default()
    }

    /// Plans the layers: see [`Job::plan`].
    ///
    /// # Errors
    /// Those of [`Job::plan`].
    pub async fn plan(
        &mut self,
        options: &Options,
        progress: &mut StageProgress<'_>,
    ) -> Result<&Report, Error> {
        let options = JobOptions::of(options.clone());
        self.0.plan(&options, progress).await?;
        Ok(&self.0.plates[0].report)
    }

    /// See [`Job::tradeoff`].
    ///
    /// # Errors
    /// Those of [`Job::tradeoff`].
    pub async fn tradeoff(
        &mut self,
        options: &Options,
        points: usize,
        progress: &mut StageProgress<'_>,
    ) -> Result<Tradeoff, Error> {
        let options = JobOptions::of(options.clone());
        self.0.tradeoff(0, &options, points, progress).await
    }

    /// See [`Job::compare`].
    ///
    /// # Errors
    /// Those of [`Job::compare`].
    pub async fn compare(
        &mut self,
        options: &Options,
        progress: &mut StageProgress<'_>,
    ) -> Result<Comparison, Error> {
        let options = JobOptions::of(options.clone());
        self.0.compare(0, &options, progress).await
    }

    /// See [`Job::front`].
    ///
    /// # Errors
    /// Those of [`Job::front`].
    #[cfg(not(target_arch = "wasm32"))]
    pub async fn front(
        &mut self,
        options: &Options,
        points: usize,
        progress: &mut StageProgress<'_>,
    ) -> Result<Vec<FrontPoint>, Error> {
        let options = JobOptions::of(options.clone());
        self.0.front(0, &options, points, progress).await
    }

    /// See [`Job::profile`].
    ///
    /// # Errors
    /// Those of [`Job::profile`].
    pub fn profile(&self, metric: Metric, source: Source) -> Result<Profile, Error> {
        self.0.profile(0, metric, source)
    }

    /// See [`Job::planned`].
    ///
    /// # Errors
    /// Those of [`Job::planned`].
    pub fn planned(&self) -> Result<(&Mesh, &Plan), Error> {
        let (meshes, plan) = self.0.planned(0)?;
        Ok((meshes[0], plan))
    }

    /// See [`Job::mask`].
    ///
    /// # Errors
    /// Those of [`Job::mask`].
    pub fn mask(&mut self, layer: usize) -> Result<Vec<u8>, Error> {
        self.0.mask(0, layer)
    }

    /// See [`Job::inspect`].
    ///
    /// # Errors
    /// Those of [`Job::inspect`].
    pub fn inspect(
        &mut self,
        limits: &Limits,
        progress: &mut StageProgress<'_>,
    ) -> Result<Printability, Error> {
        let mut found = self.0.inspect(0, limits, progress)?;
        Ok(found.models.remove(0).found)
    }

    /// See [`Job::layer_groups`].
    ///
    /// # Errors
    /// Those of [`Job::layer_groups`].
    pub fn layer_groups(&mut self) -> Result<Option<LayerGroups>, Error> {
        self.0.layer_groups(0)
    }

    /// See [`Job::write_archive`].
    ///
    /// # Errors
    /// Those of [`Job::write_archive`].
    pub fn write_archive<W: Write>(
        &mut self,
        writer: W,
        progress: &mut StageProgress<'_>,
    ) -> Result<(W, &Report), Error> {
        self.0.write_archive(0, writer, progress)
    }

    /// See [`Job::write_archive_of`].
    ///
    /// # Errors
    /// Those of [`Job::write_archive_of`].
    pub fn write_archive_of<W: Write>(
        &mut self,
        encoded: Option<&dyn Fn(usize) -> Vec<u8>>,
        writer: W,
        progress: &mut StageProgress<'_>,
    ) -> Result<(W, &Report), Error> {
        self.0.write_archive_of(0, encoded, writer, progress)
    }

    /// The model alone, without its plan.
    pub fn into_model(mut self) -> LoadedModel {
        self.0.models.remove(0)
    }
}
