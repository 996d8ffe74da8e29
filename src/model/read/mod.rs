//! Model files, one file a format.

pub mod kind;
pub mod stl;
