//! Contours of layers: sections as polygons, and their files.

mod files;
mod forms;
mod masks;
mod oracle;
mod simplify;
mod union;

use crate::common::{on_plate, solids::Triangles};
use cusp_slicer::contour::{Contours, Copies, Lattice, LayerHeights, Polygon, Ring, cut};
use cusp_slicer::model::Mesh;
use cusp_slicer::progress::{Cancelled, silent};

/// The contours of a mesh at these heights.
fn contours_of(mesh: &Mesh, sections_mm: &[f64], simplify_mm: f64) -> Vec<Contours> {
    let layers: Vec<_> = sections_mm
        .iter()
        .map(|&section_mm| LayerHeights {
            bottom_mm: section_mm - 0.01,
            top_mm: section_mm + 0.01,
            section_mm,
        })
        .collect();
    let mut found = Vec::new();
    let cut = cut(
        &[Copies::one(mesh)],
        &layers,
        simplify_mm,
        &mut silent,
        |contours| {
            oracle::assert_valid(&contours.polygons);
            found.push(contours);
            Ok::<_, Cancelled>(())
        },
    );
    cut.unwrap();
    assert_eq!(found.len(), sections_mm.len());
    found
}

/// The section of a solid at a height, all of its points kept, in millimetres: area, perimeter and polygons.
fn section(triangles: &Triangles, section_mm: f64) -> (f64, f64, Vec<Polygon>) {
    let mesh = on_plate(triangles);
    let found = contours_of(&mesh, &[section_mm], 0.0).remove(0).polygons;
    let step_mm = Lattice::of(&mesh.bounds()).step_mm();
    let rings = || found.iter().flat_map(Polygon::rings);
    let area: f64 = rings().map(Ring::area).sum();
    let length: f64 = rings().map(Ring::length).sum();
    (area * step_mm * step_mm, length * step_mm, found)
}
