//! Several models in one job, in the browser.

use cusp_slicer::arrange::Arranging;
use cusp_slicer::inspect::Limits;
use cusp_slicer::job::{self, Placement, PlateOptions};
use cusp_slicer::profile::{Metric, Source};
use js_sys::Function;
use tsify::Ts;
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

use super::{Chunks, Slicer, given, progress_to, throw};
use crate::js::to_js;

/// How copies are arranged if nothing else is asked for.
#[wasm_bindgen(unchecked_return_type = "Required<Arranging>")]
pub fn default_arranging() -> JsValue {
    to_js(&Arranging::default())
}

/// Models that are printed together. A change of options repeats only what depends on it.
#[wasm_bindgen]
#[derive(Default)]
pub struct Plate {
    plate: job::Plate,
}

#[wasm_bindgen]
impl Plate {
    /// A plate without models.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Plate {
        Self::default()
    }

    /// Adds a model. Its index is the number of models before.
    pub fn add(&mut self, model: Slicer) {
        self.plate.add(model.slicer);
    }

    /// Removes a model. The indices of those after it become one less.
    ///
    /// # Errors
    /// Throws a `CuspError` if there is no such model.
    pub fn remove(&mut self, model: usize) -> Result<(), JsValue> {
        self.plate.remove(model).map(|_| ()).map_err(throw)
    }

    /// Vertex positions of a model, as those of a slicer.
    ///
    /// # Errors
    /// Throws a `CuspError` if there is no such model.
    pub fn positions(&self, model: usize) -> Result<Vec<f32>, JsValue> {
        Ok(self.plate.model(model).map_err(throw)?.positions())
    }

    /// Vertex positions of a model's supports in the last plan, for the copy that is not turned.
    ///
    /// # Errors
    /// Throws a `CuspError` if there is no such model.
    pub fn supports(&self, model: usize) -> Result<Vec<f32>, JsValue> {
        self.plate.supports(model).map_err(throw)
    }

    /// Sets a weight from 0 to 1 for each facet of a model, or removes all weights.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    pub fn set_weights(&mut self, model: usize, weights: Option<Vec<f32>>) -> Result<(), JsValue> {
        let model = self.plate.model_mut(model).map_err(throw)?;
        model.set_weights(weights).map_err(throw)
    }

    /// Where copies stand when they are arranged.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "values from JavaScript come by value"
    )]
    #[wasm_bindgen(unchecked_return_type = "Placement[]")]
    pub fn arrange(&mut self, options: Ts<PlateOptions>) -> Result<JsValue, JsValue> {
        let options = given(&options)?;
        Ok(to_js(&self.plate.arrange(&options).map_err(throw)?))
    }

    /// What is wrong with the placements of the options: copies that extend beyond their plate, and copies that overlap.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "values from JavaScript come by value"
    )]
    #[wasm_bindgen(unchecked_return_type = "ArrangeError[]")]
    pub fn problems(&mut self, options: Ts<PlateOptions>) -> Result<JsValue, JsValue> {
        let options = given(&options)?;
        let placements: &[Placement] = &options.placements;
        let problems = self.plate.problems(&options, placements);
        Ok(to_js(&problems.map_err(throw)?))
    }

    /// Plans the layers of all plates.
    ///
    /// # Errors
    /// Throws a `CuspError`.
    #[wasm_bindgen(unchecked_return_type = "PlatesReport")]
    pub async fn plan(
        &mut self,
        options: Ts<PlateOptions>,
        #[wasm_bindgen(
            unchecked_param_type = "(stage: Stage, fraction: number, done: number) => void"
        )]
        progress: Function,
    ) -> Result<JsValue, JsValue> {
        let options = given(&options)?;
        let report = self.plate.plan(&options, &mut progress_to(&progress)).await;
        Ok(to_js(&report.map_err(throw)?))
    }

    /// The profile of a metric on a plate, from 0: in each bin the largest of its models.
    ///
    /// # Errors
    /// Throws a `CuspError` if there is no plan.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "values from JavaScript come by value"
    )]
    pub fn profile(
        &mut self,
        plate: usize,
        metric: Ts<Metric>,
        source: Ts<Source>,
    ) -> Result<Vec<f32>, JsValue> {
        let metric = given(&metric)?;
        let source = given(&source)?;
        let profile = self.plate.profile(plate, metric, source);
        Ok(profile.map_err(throw)?.density)
    }

    /// The mask of a layer of a plate, both from 0, as that of a slicer.
    ///
    /// # Errors
    /// Throws a `CuspError` if there is no plan, no such plate or no such layer.
    pub fn mask(&mut self, plate: usize, layer: usize) -> Result<Vec<u8>, JsValue> {
        self.plate.mask(plate, layer).map_err(throw)
    }

    /// The best plans of a plate, from 0, for `points` tolerances.
    ///
    /// # Errors
    /// Throws a `CuspError` if there is no plan or no such plate.
    #[wasm_bindgen(unchecked_return_type = "Tradeoff")]
    pub fn tradeoff(&mut self, plate: usize, points: usize) -> Result<JsValue, JsValue> {
        let found = self.plate.tradeoff(plate, points);
        Ok(to_js(&found.map_err(throw)?))
    }

    /// The printability of a plate, from 0, by these limits.
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
        let found = self
            .plate
            .inspect(plate, &limits, &mut progress_to(progress));
        Ok(to_js(&found.map_err(throw)?))
    }

    /// Writes the print file of a plate, from 0, by calling `take` with one chunk after another.
    ///
    /// # Errors
    /// Throws a `CuspError`, or what `take` throws.
    pub fn archive(
        &mut self,
        plate: usize,
        #[wasm_bindgen(unchecked_param_type = "(chunk: Uint8Array) => void")] take: &Function,
        #[wasm_bindgen(
            unchecked_param_type = "(stage: Stage, fraction: number, done: number) => void"
        )]
        progress: &Function,
    ) -> Result<(), JsValue> {
        let mut writer = Chunks::to(take);
        let written = self
            .plate
            .write_archive(plate, &mut writer, &mut progress_to(progress))
            .map(|_| ());
        Chunks::end(writer, written)
    }
}
