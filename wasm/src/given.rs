//! Options, limits and prices from JavaScript.

use cusp_slicer::misnamed::with_nearest;
use js_sys::{Array, ArrayBuffer, Object};
use serde::de::value::StringDeserializer;
use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, Error as _, Expected, IntoDeserializer,
    MapAccess, SeqAccess, Unexpected, Visitor,
};
use serde::forward_to_deserialize_any;
use serde_json::{Error, Number};
use wasm_bindgen::JsCast;
use wasm_bindgen::prelude::JsValue;

/// Reads a value of JavaScript. A field that is undefined counts as absent, as it does in JSON; one that is unknown is refused with the
/// nearest known name, as on the command line.
pub fn read<T: DeserializeOwned>(value: &JsValue) -> Result<T, String> {
    let value = Given { value, depth: 0 };
    if let Some(fault) = value.fault() {
        return Err(fault.to_owned());
    }
    T::deserialize(value).map_err(|error| with_nearest(&error.to_string()).into_owned())
}

/// Objects inside each other; options have four.
const MOST_DEPTH: usize = 16;
/// Whole numbers up to here are exact.
const MOST_WHOLE: f64 = 9_007_199_254_740_992.0;

/// A value of JavaScript inside others. It takes no list for a struct, as JSON's values do: that made the module 5 % larger.
#[derive(Clone, Copy)]
struct Given<'a> {
    value: &'a JsValue,
    depth: usize,
}

impl Given<'_> {
    fn is_absent(self) -> bool {
        self.value.is_null() || self.value.is_undefined()
    }

    fn is_list(self) -> bool {
        Array::is_array(self.value) || ArrayBuffer::is_view(self.value)
    }

    fn inside(self, entries: Array) -> Rest {
        Rest {
            entries,
            next: 0,
            value: JsValue::UNDEFINED,
            depth: self.depth + 1,
        }
    }

    fn fields(self) -> Option<Rest> {
        let object = self.value.dyn_ref::<Object>();
        let object = object.filter(|_| !self.value.is_function() && !self.is_list())?;
        Some(self.inside(Object::entries(object)))
    }

    /// The fault that it has whatever is expected.
    fn fault(self) -> Option<&'static str> {
        if self.depth > MOST_DEPTH {
            Some("objects lie inside each other more than 16 deep")
        } else if self.value.is_function() || self.value.is_symbol() {
            Some("a function or a symbol is no value")
        } else {
            let number = self.value.as_f64();
            number
                .filter(|number| !number.is_finite())
                .map(|_| "a number is not finite")
        }
    }

    fn number(self) -> Option<Number> {
        let number = self.value.as_f64()?;
        if number.fract() != 0.0 || number.abs() > MOST_WHOLE {
            Number::from_f64(number)
        } else {
            Some(Number::from(number as i64))
        }
    }

    /// The error for this value in place of the expected one.
    fn refuse(self, expected: &dyn Expected) -> Error {
        let text = self.value.as_string();
        let unexpected = match (&text, self.value.as_f64(), self.value.as_bool()) {
            (Some(text), ..) => Unexpected::Str(text),
            (_, Some(number), _) => Unexpected::Float(number),
            (.., Some(is_true)) => Unexpected::Bool(is_true),
            _ if self.is_absent() => Unexpected::Unit,
            _ if self.is_list() => Unexpected::Seq,
            _ => Unexpected::Map,
        };
        Error::invalid_type(unexpected, expected)
    }
}

impl<'de> Deserializer<'de> for Given<'_> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        if let Some(text) = self.value.as_string() {
            visitor.visit_string(text)
        } else if let Some(is_true) = self.value.as_bool() {
            visitor.visit_bool(is_true)
        } else if self.is_absent() {
            visitor.visit_unit()
        } else if self.is_list() {
            self.deserialize_seq(visitor)
        } else if let Some(fields) = self.fields() {
            visitor.visit_map(fields)
        } else {
            self.deserialize_f64(visitor)
        }
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.number() {
            Some(number) => number.deserialize_any(visitor),
            None => Err(self.refuse(&visitor)),
        }
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.value.as_string() {
            Some(text) => visitor.visit_string(text),
            None => Err(self.refuse(&visitor)),
        }
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.value.as_bool() {
            Some(is_true) => visitor.visit_bool(is_true),
            None => Err(self.refuse(&visitor)),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        if self.is_absent() {
            visitor.visit_none()
        } else {
            visitor.visit_some(self)
        }
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        if !self.is_list() {
            return Err(self.refuse(&visitor));
        }
        let mut items = self.inside(Array::from(self.value));
        let read = visitor.visit_seq(&mut items)?;
        // A pair has no third number.
        let count = items.entries.length();
        if items.next < count {
            return Err(Error::invalid_length(
                count as usize,
                &"fewer elements in array",
            ));
        }
        Ok(read)
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_seq(visitor)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        match self.fields() {
            Some(fields) => visitor.visit_map(fields),
            None => Err(self.refuse(&visitor)),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        // Choices are names; those with numbers are objects that name their kind.
        match self.value.as_string() {
            Some(name) => visitor.visit_enum(IntoDeserializer::<Error>::into_deserializer(name)),
            None => Err(self.refuse(&visitor)),
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Error> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_i64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_f64(visitor)
    }

    fn deserialize_u32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_f64(visitor)
    }

    fn deserialize_u64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_f64(visitor)
    }

    forward_to_deserialize_any! {
        i8 i16 i32 i128 u8 u16 u128 f32 char str bytes byte_buf unit unit_struct tuple_struct map identifier ignored_any
    }
}

/// The elements of a list, or the fields of an object as pairs.
struct Rest {
    entries: Array,
    next: u32,
    /// The current element, or the value of the current field.
    value: JsValue,
    depth: usize,
}

impl Rest {
    fn given(&self) -> Given<'_> {
        let depth = self.depth;
        Given {
            value: &self.value,
            depth,
        }
    }

    fn next_entry(&mut self) -> Option<JsValue> {
        if self.next >= self.entries.length() {
            return None;
        }
        self.next += 1;
        Some(self.entries.get(self.next - 1))
    }

    /// Moves on to the next element, if there is one.
    fn advance(&mut self) -> Result<bool, Error> {
        let Some(value) = self.next_entry() else {
            return Ok(false);
        };
        self.value = value;
        match self.given().fault() {
            Some(fault) => Err(Error::custom(fault)),
            None => Ok(true),
        }
    }

    /// Moves on to the next field that is not undefined, and returns its name.
    fn advance_field(&mut self) -> Result<Option<String>, Error> {
        while let Some(entry) = self.next_entry() {
            let entry = Array::from(&entry);
            self.value = entry.get(1);
            if self.value.is_undefined() {
                continue;
            }
            let name = entry.get(0).as_string().unwrap_or_default();
            return match self.given().fault() {
                Some(fault) => Err(Error::custom(format_args!("{name}: {fault}"))),
                None => Ok(Some(name)),
            };
        }
        Ok(None)
    }
}

impl<'de> SeqAccess<'de> for &mut Rest {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, Error> {
        if self.advance()? {
            seed.deserialize(self.given()).map(Some)
        } else {
            Ok(None)
        }
    }
}

impl<'de> MapAccess<'de> for Rest {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, Error> {
        let Some(name) = self.advance_field()? else {
            return Ok(None);
        };
        let name: StringDeserializer<Error> = name.into_deserializer();
        seed.deserialize(name).map(Some)
    }

    fn next_value_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<T::Value, Error> {
        seed.deserialize(self.given())
    }
}
