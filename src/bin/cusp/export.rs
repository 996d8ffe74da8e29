//! Meshes for other programs.

use std::path::Path;

use cusp_slicer::archive::layer_profile;
use cusp_slicer::job::Job;
use cusp_slicer::progress::silent;
use glam::Vec3;
use stl_io::{Normal, Triangle, Vertex};

use crate::failure::{Failure, in_file};
use crate::files::Output;

/// Writes the mesh of the last plan with its voids and supports, as 3MF if the file is named so, or else as STL.
pub fn export(job: &Job, file: &Path) -> Result<(), Failure> {
    let Ok(Some(mesh)) = job.prepared_mesh(0) else {
        return Err(in_file(file, &"there is no plan").into());
    };
    let output = Output::new(file, None, "model")?;
    if file
        .extension()
        .is_some_and(|it| it.eq_ignore_ascii_case("3mf"))
    {
        let written = layer_profile::write_printed(mesh, Vec::new(), &mut silent);
        return output.write_bytes(&written.map_err(|error| output.failed(&error))?);
    }
    let facets = mesh.printed_facets().into_iter();
    write_stl(facets.map(corners(&mesh.vertices)), &output)
}

/// Writes a plug for each drain hole of the last plan.
pub fn export_plugs(job: &Job, file: &Path) -> Result<(), Failure> {
    let Ok(Some(plugs)) = job.plugs(0) else {
        return Err(in_file(
            file,
            &"there are no drain holes to plug; make some by --drain",
        )
        .into());
    };
    let facets = plugs.facets.iter().copied();
    write_stl(
        facets.map(corners(&plugs.vertices)),
        &Output::new(file, None, "model")?,
    )
}

fn corners(vertices: &[Vec3]) -> impl Fn([u32; 3]) -> [[f32; 3]; 3] {
    |facet| facet.map(|it| vertices[it as usize].to_array())
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
