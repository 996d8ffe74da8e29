//! Hollowing against closed forms and naive distances.

#[path = "../common/mod.rs"]
mod common;
mod hollow;
