//! Values and errors as JavaScript has them.

use std::fmt::Display;

use js_sys::{JSON, Reflect};
use serde::Serialize;
use wasm_bindgen::prelude::JsValue;

/// Converts a value by way of JSON. The manifest needs a JSON writer anyway; a second writer for JavaScript objects would
/// make the module larger.
pub fn to_js(value: &impl Serialize) -> JsValue {
    // Fails only on maps whose keys are not strings, and no value here has one.
    let json = serde_json::to_string(value).unwrap_or_default();
    JSON::parse(&json).unwrap_or(JsValue::NULL)
}

/// The value that is thrown for an error: its code and details, and one sentence that says what to do.
pub fn thrown(error: &(impl Serialize + Display)) -> JsValue {
    let thrown = to_js(error);
    // Fails only on values that are not objects.
    let _ = Reflect::set(&thrown, &"message".into(), &error.to_string().into());
    thrown
}
