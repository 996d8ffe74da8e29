//! A job of a single copy of a model, by the options of that model alone: what most tests are about.

#![allow(
    dead_code,
    reason = "each program uses a different part of this module"
)]

use std::io::Write;
use std::ops::{Deref, DerefMut};

use cusp_slicer::inspect::{Finding, Limits, Printability};
use cusp_slicer::job::{
    Comparison, Error, Job, JobOptions, LayerGroups, LoadedModel, Options, Report, StageProgress,
    Tradeoff,
};
use cusp_slicer::ldi::gpu::Gpu;
use cusp_slicer::model::read::ReadOptions;
use cusp_slicer::model::{FacetClass, FileFacts, Mesh};
use cusp_slicer::plan::Plan;
use cusp_slicer::prepare::Shell;
use cusp_slicer::profile::{Metric, Profile, Source};
use glam::Vec3;

/// A job of a single copy of a model.
#[derive(Debug)]
pub struct Slicer {
    job: Job,
    report: Option<Report>,
}

impl Deref for Slicer {
    type Target = LoadedModel;

    fn deref(&self) -> &LoadedModel {
        self.job.model(0).unwrap()
    }
}

impl DerefMut for Slicer {
    fn deref_mut(&mut self) -> &mut LoadedModel {
        self.job.model_mut(0).unwrap()
    }
}

impl Slicer {
    pub fn load(bytes: &[u8]) -> Result<Self, Error> {
        LoadedModel::read(bytes).map(Self::of)
    }

    pub fn load_with(bytes: &[u8], options: &ReadOptions) -> Result<Self, Error> {
        LoadedModel::read_with(bytes, options).map(Self::of)
    }

    pub fn of_triangles(triangles: &[[Vec3; 3]], facts: FileFacts) -> Result<Self, Error> {
        LoadedModel::of_triangles(triangles, facts).map(Self::of)
    }

    fn with(job: Job) -> Self {
        Self { job, report: None }
    }

    pub fn of(model: LoadedModel) -> Self {
        Self::with(Job::new(vec![model]))
    }

    #[must_use]
    pub fn with_gpu(self, gpu: Gpu) -> Self {
        Self::with(self.job.with_gpu(gpu))
    }

    #[cfg(not(target_arch = "wasm32"))]
    #[must_use]
    pub fn with_memory(self, bytes: u64) -> Self {
        Self::with(self.job.with_memory(bytes))
    }

    #[cfg(not(target_arch = "wasm32"))]
    #[must_use]
    pub fn with_cpu_time(self, seconds: f64) -> Self {
        Self::with(self.job.with_cpu_time(seconds))
    }

    pub async fn open_gpu(&mut self) {
        self.job.open_gpu().await;
    }

    pub fn prepared(&self) -> Option<&Mesh> {
        self.job.prepared_mesh(0).ok()?
    }

    pub fn positions_of(&self, class: FacetClass) -> Vec<f32> {
        self.job.positions_of(0, class).unwrap_or_default()
    }

    pub fn plugs(&self) -> Option<Shell> {
        self.job.plugs(0).ok()?
    }

    pub fn plug_positions(&self) -> Vec<f32> {
        self.job.plug_positions(0).unwrap_or_default()
    }

    pub async fn plan(
        &mut self,
        options: &Options,
        progress: &mut StageProgress<'_>,
    ) -> Result<&Report, Error> {
        let options = JobOptions::of(options.clone());
        let mut report = self.job.plan(&options, progress).await?;
        Ok(self.report.insert(report.plates.remove(0)))
    }

    pub async fn tradeoff(
        &mut self,
        options: &Options,
        points: usize,
        progress: &mut StageProgress<'_>,
    ) -> Result<Tradeoff, Error> {
        let options = JobOptions::of(options.clone());
        self.job.tradeoff(0, &options, points, progress).await
    }

    pub async fn compare(
        &mut self,
        options: &Options,
        progress: &mut StageProgress<'_>,
    ) -> Result<Comparison, Error> {
        let options = JobOptions::of(options.clone());
        self.job.compare(0, &options, progress).await
    }

    #[cfg(not(target_arch = "wasm32"))]
    pub async fn front(
        &mut self,
        options: &Options,
        points: usize,
        progress: &mut StageProgress<'_>,
    ) -> Result<Vec<cusp_slicer::job::FrontPoint>, Error> {
        let options = JobOptions::of(options.clone());
        self.job.front(0, &options, points, progress).await
    }

    pub fn profile(&self, metric: Metric, source: Source) -> Result<Profile, Error> {
        self.job.profile(0, metric, source)
    }

    pub fn planned(&self) -> Result<(&Mesh, &Plan), Error> {
        let (meshes, plan) = self.job.planned(0)?;
        Ok((meshes[0], plan))
    }

    pub fn mask(&mut self, layer: usize) -> Result<Vec<u8>, Error> {
        self.job.mask(0, layer)
    }

    pub fn floating(&mut self, progress: &mut StageProgress<'_>) -> Result<Vec<Finding>, Error> {
        self.job.floating(0, progress)
    }

    pub fn inspect(
        &mut self,
        limits: &Limits,
        progress: &mut StageProgress<'_>,
    ) -> Result<Printability, Error> {
        let mut found = self.job.inspect(0, limits, progress)?;
        Ok(found.models.remove(0).found)
    }

    pub fn layer_groups(&mut self) -> Result<Option<LayerGroups>, Error> {
        self.job.layer_groups(0)
    }

    pub fn write_archive<W: Write>(
        &mut self,
        writer: W,
        progress: &mut StageProgress<'_>,
    ) -> Result<(W, &Report), Error> {
        self.job.write_archive(0, writer, progress)
    }

    pub fn write_archive_of<W: Write>(
        &mut self,
        encoded: Option<&dyn Fn(usize) -> Vec<u8>>,
        writer: W,
        progress: &mut StageProgress<'_>,
    ) -> Result<(W, &Report), Error> {
        self.job.write_archive_of(0, encoded, writer, progress)
    }

    pub fn into_model(mut self) -> LoadedModel {
        self.job.remove(0).unwrap()
    }
}
