//! No bytes make the readers of models panic.

#![no_main]

use cusp_slicer::model::Mesh;
use cusp_slicer::model::read::read;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Ok(contents) = read(bytes) {
        let _ = Mesh::from_triangles(&contents.triangles);
    }
});
