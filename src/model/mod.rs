//! The model: read from a file, welded to a closed mesh, posed on the plate, weighted by facet.

mod bodies;
mod class;
pub(crate) mod crossing;
mod curved_cap;
mod edges;
mod facet_lists;
mod facing;
mod file;
mod holes;
mod mesh;
mod own_supports;
mod pose;
pub mod read;
pub mod saliency;
mod unit;
pub mod weights;
mod weld;

pub(crate) use bodies::{bodies, passes_above, windings_at};
pub use class::{FacetClass, FacetClasses, Winding};
pub use edges::{Across, Neighbours};
pub(crate) use facet_lists::FacetLists;
pub use file::{FileFacts, ModelFile};
pub use mesh::{Bounds, Mesh, MeshError};
pub(crate) use pose::rotation_matrix;
pub use pose::{Pose, TURNS};
pub use unit::ModelUnit;
pub(crate) use weld::weld;
