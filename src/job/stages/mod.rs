//! The stages of a job in order, each with an immutable result that holds its inputs: parts of the resolved options, a
//! prepared model, its rays, its shape along z, and its layers.

pub mod facet_shapes;
pub mod measured;
pub mod memory;
pub mod parts;
pub mod planned;
pub mod planning;
pub mod prepared;
pub mod sampled;
pub mod stage;
pub mod tolerances;
#[cfg(not(target_arch = "wasm32"))]
pub mod work;
