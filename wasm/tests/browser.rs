//! The suite of `tests/web.rs` in a browser.

#![cfg(target_arch = "wasm32")]

#[path = "../../tests/common/mod.rs"]
mod common;
#[path = "../../tests/web.rs"]
mod web;

wasm_bindgen_test::wasm_bindgen_test_configure!(run_in_dedicated_worker);
