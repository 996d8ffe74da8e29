//! Models other than STL in the browser: a module of its own, which the slicer fetches when somebody opens a 3MF or an OBJ.
//!
//! Errors are thrown as `{ code, message, detail }`.

#![cfg(target_arch = "wasm32")]

use cusp_slicer::js::{thrown, to_js};
use cusp_slicer::model::FileFacts;
use cusp_slicer::model::read::{self, Triangles};
use js_sys::Float32Array;
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

/// What every function here throws. An error that holds another is serialised as that one, which `tsify` does not see.
#[wasm_bindgen(typescript_custom_section)]
const ERROR: &str = r"
type FlatRead<E> = E extends { detail: infer Held extends { code: string } } ? Held : E;
export type ModelError = FlatRead<ReadError>;
";

/// A model that has been read.
#[wasm_bindgen]
pub struct ModelRead {
    triangles: Triangles,
    facts: FileFacts,
}

#[wasm_bindgen]
impl ModelRead {
    /// Reads a model.
    ///
    /// # Errors
    /// Throws a `ModelError` with a `message`.
    #[wasm_bindgen(constructor)]
    pub fn new(file: &[u8]) -> Result<Self, JsValue> {
        let contents = read::read(file).map_err(|error| thrown(&error))?;
        Ok(Self {
            facts: FileFacts::new(file, &contents),
            triangles: contents.triangles,
        })
    }

    /// The corners of its triangles, nine numbers each, in millimetres if the file has a unit.
    pub fn coordinates(&self) -> Float32Array {
        Float32Array::from(bytemuck::cast_slice::<_, f32>(&self.triangles))
    }

    /// What else the file tells.
    #[wasm_bindgen(unchecked_return_type = "FileFacts")]
    pub fn facts(&self) -> JsValue {
        to_js(&self.facts)
    }
}
