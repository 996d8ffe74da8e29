//! Options, limits and prices from JavaScript.

use cusp_slicer::misnamed::with_nearest;
use js_sys::{Array, ArrayBuffer, Object};
use serde::de::DeserializeOwned;
use serde_json::{Map, Number, Value};
use wasm_bindgen::JsCast;
use wasm_bindgen::prelude::JsValue;

/// Reads a value of JavaScript. A field that is undefined counts as absent, as it does in JSON; one that is unknown is refused with the
/// nearest known name, as on the command line.
pub fn read<T: DeserializeOwned>(value: &JsValue) -> Result<T, String> {
    let value = json(value, 0)?;
    T::deserialize(value).map_err(|error| with_nearest(&error.to_string()).into_owned())
}

/// Objects inside each other; options have four.
const MOST_DEPTH: usize = 16;
/// Whole numbers up to here are exact.
const MOST_WHOLE: f64 = 9_007_199_254_740_992.0;

/// A value of JavaScript as JSON, without a detour through text, which would round numbers.
fn json(value: &JsValue, depth: usize) -> Result<Value, String> {
    if depth > MOST_DEPTH {
        return Err("objects lie inside each other more than 16 deep".to_owned());
    }
    if let Some(number) = value.as_f64() {
        let is_whole = number.fract() == 0.0 && number.abs() <= MOST_WHOLE;
        let whole = is_whole.then(|| Number::from(number as i64));
        let number = whole.or_else(|| Number::from_f64(number));
        return number
            .map(Value::Number)
            .ok_or_else(|| "a number is not finite".to_owned());
    }
    if let Some(text) = value.as_string() {
        return Ok(Value::String(text));
    }
    if let Some(is_true) = value.as_bool() {
        return Ok(Value::Bool(is_true));
    }
    if value.is_null() || value.is_undefined() {
        return Ok(Value::Null);
    }
    if Array::is_array(value) || ArrayBuffer::is_view(value) {
        let items = Array::from(value);
        let items = items.iter().map(|item| json(&item, depth + 1));
        return Ok(Value::Array(items.collect::<Result<_, _>>()?));
    }
    let Some(object) = value.dyn_ref::<Object>().filter(|_| !value.is_function()) else {
        return Err("a function or a symbol is no value".to_owned());
    };
    let mut fields = Map::new();
    for entry in Object::entries(object) {
        let entry = Array::from(&entry);
        let (key, field) = (entry.get(0), entry.get(1));
        if field.is_undefined() {
            continue;
        }
        let key = key.as_string().unwrap_or_default();
        let field = json(&field, depth + 1).map_err(|error| format!("{key}: {error}"))?;
        fields.insert(key, field);
    }
    Ok(Value::Object(fields))
}
