//! Meshes for other programs.

use std::path::Path;

use cusp_slicer::archive::layer_profile;
use cusp_slicer::job::Slicer;
use cusp_slicer::progress::silent;
use stl_io::{Normal, Triangle, Vertex};

use crate::files::{Failure, Output, in_file};

/// Writes the mesh of the last plan with its voids and supports, as the name of the file says: STL or 3MF.
pub fn export(slicer: &Slicer, file: &Path) -> Result<(), Failure> {
    let Some(mesh) = slicer.prepared() else {
        return Err(in_file(file, &"there is no plan").into());
    };
    let output = Output::new(file, None, "model")?;
    let extension = file.extension().unwrap_or_default().to_ascii_lowercase();
    match extension.to_str() {
        Some("stl") => {
            let facets = mesh.printed_facets().into_iter();
            let corners = |facet: [u32; 3]| facet.map(|it| mesh.vertices[it as usize].to_array());
            write_stl(facets.map(corners), &output)
        }
        Some("3mf") => {
            let written = layer_profile::write_printed(mesh, Vec::new(), &mut silent);
            output.write_bytes(&written.map_err(|error| output.failed(&error))?)
        }
        _ => Err(in_file(file, &"a mesh is written as .stl or .3mf; name it so").into()),
    }
}

/// Writes facets as a binary STL.
pub fn write_stl(
    facets: impl ExactSizeIterator<Item = [[f32; 3]; 3]>,
    output: &Output<'_>,
) -> Result<(), Failure> {
    let facets = facets.map(|corners| Triangle {
        // Readers compute the normal from the corners.
        normal: Normal::new([0.0; 3]),
        vertices: corners.map(Vertex::new),
    });
    let mut bytes = Vec::new();
    stl_io::write_stl(&mut bytes, facets).map_err(|error| output.failed(&error))?;
    output.write_bytes(&bytes)
}
