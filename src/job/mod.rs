//! A job: options are resolved once, then the stages run in order. The result of each is an immutable value.

mod alternatives;
mod error;
mod loaded;
mod options;
mod orient;
mod outputs;
#[cfg(not(target_arch = "wasm32"))]
mod pareto_front;
mod places;
mod plan;
mod plates;
mod report;
mod resolve;
mod shapes;
mod shares;
mod stages;
mod verify;

use std::sync::Arc;

use plates::Plate;
use stages::measured::Shape;
use stages::memory::Memory;
use stages::prepared::Prepared;
use stages::sampled::Sampler;

use crate::arrange::ArrangeError;
use crate::ldi::gpu::Gpu;

pub use error::{Error, OptionsError, Work};
pub use loaded::LoadedModel;
pub use options::*;
#[cfg(not(target_arch = "wasm32"))]
pub use orient::OrientationPart;
pub use orient::OrientationReport;
pub use outputs::{ModelPrintability, PlatePrintability};
pub use plates::LayerGroups;
pub use report::*;
pub use resolve::BIN_MM;
pub(crate) use resolve::find_printer;
pub(crate) use stages::parts::Output;
pub use stages::prepared::{Hollowed, Supported};
pub use stages::stage::{Stage, StageProgress};
pub use verify::*;

/// Models that are printed together, or one alone. A change of options repeats only the stages that depend on it.
#[derive(Debug, Default)]
pub struct Job {
    models: Vec<LoadedModel>,
    sampler: Sampler,
    /// Limits of memory and time, if any.
    memory: Option<Memory>,
    /// The models with their voids and supports, before turns, in the order of models.
    prepared: Vec<Arc<Prepared>>,
    shapes: Vec<Shape>,
    plates: Vec<Plate>,
}

impl Job {
    /// A job of these models.
    pub fn new(models: Vec<LoadedModel>) -> Self {
        Self {
            models,
            ..Self::default()
        }
    }

    /// Samples on `gpu` from now on, unless the options ask for the CPU.
    #[must_use]
    pub fn with_gpu(mut self, gpu: Gpu) -> Self {
        self.sampler.set_gpu(gpu);
        self
    }

    /// Limits memory to about this many bytes from now on: hits and masks that do not fit are found again when they are
    /// needed, and print files are the same. Models share the bytes equally. See [`Error::MemoryBound`] for jobs that
    /// cannot be kept within them.
    #[cfg(not(target_arch = "wasm32"))]
    #[must_use]
    pub fn with_memory(mut self, bytes: u64) -> Self {
        self.memory = Some(Memory::of(bytes));
        self
    }

    /// Plans no plate from now on that is certain to take more processor time than this, in seconds: see [`Error::TimeBound`]. Callers
    /// that must keep to it also cancel by progress.
    #[cfg(not(target_arch = "wasm32"))]
    #[must_use]
    pub fn with_cpu_time(mut self, seconds: f64) -> Self {
        self.sampler.set_cpu_time(seconds);
        for model in &mut self.models {
            model.cpu_time_s = Some(seconds);
        }
        self
    }

    /// Searches in advance for the GPU that the next plan on [`Backend::Gpu`] would search for. Drivers may
    /// write to stderr during a search, and here a caller can silence them. The plan reports the result.
    pub async fn open_gpu(&mut self) {
        self.sampler.open_gpu().await;
    }

    /// The models, in the order of their indices.
    pub fn models(&self) -> &[LoadedModel] {
        &self.models
    }

    /// A model by its index.
    ///
    /// # Errors
    /// [`Error::Arrange`] if there is no such model.
    pub fn model(&self, model: usize) -> Result<&LoadedModel, Error> {
        self.check_model(model)?;
        Ok(&self.models[model])
    }

    /// The same, to set its weights or to search for its orientation.
    ///
    /// # Errors
    /// [`Error::Arrange`] if there is no such model.
    pub fn model_mut(&mut self, model: usize) -> Result<&mut LoadedModel, Error> {
        self.check_model(model)?;
        Ok(&mut self.models[model])
    }

    /// Adds a model and returns its index.
    #[cfg_attr(
        target_arch = "wasm32",
        expect(unused_mut, reason = "time is bounded elsewhere")
    )]
    pub fn add(&mut self, mut model: LoadedModel) -> usize {
        #[cfg(not(target_arch = "wasm32"))]
        {
            model.cpu_time_s = self.sampler.cpu_time_s();
        }
        self.models.push(model);
        self.models.len() - 1
    }

    /// Removes a model. Those after it move up.
    ///
    /// # Errors
    /// [`Error::Arrange`].
    pub fn remove(&mut self, model: usize) -> Result<LoadedModel, Error> {
        self.check_model(model)?;
        self.plates.clear();
        if model < self.prepared.len() {
            self.prepared.remove(model);
        }
        self.shapes.retain(|shape| shape.model != model);
        for shape in &mut self.shapes {
            shape.model -= usize::from(shape.model > model);
        }
        Ok(self.models.remove(model))
    }

    fn check_model(&self, model: usize) -> Result<(), ArrangeError> {
        let models = self.models.len();
        if model < models {
            Ok(())
        } else {
            Err(ArrangeError::NoModel {
                model_number: model + 1,
                models,
            })
        }
    }
}
