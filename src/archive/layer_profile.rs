//! Files for slicers of filament printers: a 3MF with the model in its pose, and the thicknesses of its layers as a layer height
//! profile.
//!
//! Such a slicer prints the first layer as thick as its settings say. From there on it looks the thickness of each layer up in the
//! profile, a little above the layer's bottom, and stops where the middle of a layer would be above the model. A profile with
//! two points for each layer, at its bottom and at its top, therefore gives exactly the layers of the plan.

use std::io::Write;

use super::ArchiveError;
use super::threemf::{HEAD, add, begin, write_facets, write_vertices};
use crate::filament::FilamentSlicer;
use crate::model::{Bounds, Mesh};
use crate::progress::{Progress, report};

/// A model with its layers.
#[derive(Debug, Clone, Copy)]
pub struct LayeredModel<'a> {
    /// The model on the plate.
    pub mesh: &'a Mesh,
    /// Heights of layer boundaries, from 0 upward: one more than there are layers.
    pub z_mm: &'a [f64],
    /// Thickness of the first layer as set in the slicer.
    pub first_layer_mm: f64,
}

/// Name under which a slicer looks for the profile.
fn profile_name(slicer: FilamentSlicer) -> &'static str {
    match slicer {
        FilamentSlicer::Prusa => "Metadata/Slic3r_PE_layer_heights_profile.txt",
        FilamentSlicer::Orca => "Metadata/layer_heights_profile.txt",
    }
}

/// Application that the file names as its author. Bambu Studio and OrcaSlicer take only the mesh from files of other
/// programs.
fn application(slicer: FilamentSlicer) -> &'static str {
    match slicer {
        FilamentSlicer::Prusa => "Cusp",
        FilamentSlicer::Orca => "BambuStudio-02.00.00.00",
    }
}

/// Writes the file sequentially, without seeking, and returns the writer. Caps over holes are part of the model, so that the slicer
/// does not close them in its own way.
///
/// The bytes depend on model and layers alone.
///
/// # Errors
/// [`ArchiveError::OtherFirstLayer`], [`ArchiveError::Write`], [`ArchiveError::Cancelled`].
pub fn write<W: Write>(
    slicer: FilamentSlicer,
    model: &LayeredModel<'_>,
    mut writer: W,
    progress: &mut Progress<'_>,
) -> Result<W, ArchiveError> {
    report(progress, 0.0)?;
    model.check()?;
    let mesh = model.mesh;
    let facets = &mesh.facets[..mesh.classes.model_end() as usize];
    let bounds = mesh.bounds();
    let mut zip = begin(&mut writer, &[("txt", "text/plain")], &mut |file| {
        write_mesh(mesh, facets, &bounds, application(slicer), file, progress)
    })?;
    add(&mut zip, profile_name(slicer), &mut |file| {
        writeln!(file, "object_id=1|{}", model.profile())?;
        Ok(())
    })?;
    zip.finish().map_err(ArchiveError::write)?;
    Ok(writer)
}

/// Writes all that is printed of a mesh as a 3MF: the model, its voids as bodies inside out, and its supports.
///
/// # Errors
/// [`ArchiveError::Write`], [`ArchiveError::Cancelled`].
pub fn write_printed<W: Write>(
    mesh: &Mesh,
    mut writer: W,
    progress: &mut Progress<'_>,
) -> Result<W, ArchiveError> {
    let (facets, bounds) = (mesh.printed_facets(), mesh.printed_bounds());
    let zip = begin(&mut writer, &[("txt", "text/plain")], &mut |file| {
        write_mesh(mesh, &facets, &bounds, "Cusp", file, progress)
    })?;
    zip.finish().map_err(ArchiveError::write)?;
    Ok(writer)
}

impl LayeredModel<'_> {
    fn check(&self) -> Result<(), ArchiveError> {
        let layer_mm = match self.z_mm {
            [bottom_mm, top_mm, ..] => top_mm - bottom_mm,
            _ => 0.0,
        };
        if millionths(layer_mm) == millionths(self.first_layer_mm) {
            return Ok(());
        }
        Err(ArchiveError::OtherFirstLayer {
            layer_mm: super::tidy(layer_mm),
            first_layer_mm: self.first_layer_mm,
        })
    }

    /// The profile: bottom and thickness, then top and thickness of each layer, with six decimals, separated by
    /// semicolons. The last top is the model's height, or the slicer drops the profile; the layer is still as thick as
    /// planned.
    fn profile(&self) -> String {
        let model_mm = self.mesh.bounds().size().z;
        let layers = self.z_mm.len().saturating_sub(1);
        let mut profile = String::with_capacity(40 * layers);
        for (layer, pair) in self.z_mm.windows(2).enumerate() {
            let [bottom, top] = [pair[0], pair[1]].map(millionths);
            // The difference of the rounded heights, so that rounding does not accumulate.
            let thickness = top - bottom;
            let is_last = layer + 1 == layers;
            // A reader refuses a profile of two points, which a single layer gives.
            let middle = (is_last && layer == 0).then(|| millionths(model_mm) / 2);
            let top = if is_last { millionths(model_mm) } else { top };
            for z in [Some(bottom), middle, Some(top)].into_iter().flatten() {
                if !profile.is_empty() {
                    profile.push(';');
                }
                profile.push_str(&decimal(z));
                profile.push(';');
                profile.push_str(&decimal(thickness));
            }
        }
        profile
    }
}

/// A length in whole millionths of a millimetre.
fn millionths(length_mm: f64) -> i64 {
    (length_mm * 1e6).round() as i64
}

/// Whole millionths with six decimals.
fn decimal(millionths: i64) -> String {
    format!("{}.{:06}", millionths / 1_000_000, millionths % 1_000_000)
}

/// Facets and vertices that are written between two reports of progress.
const CHUNK: usize = 1 << 14;

/// Writes the mesh as XML. The object is moved to where its x and y are not negative, which readers may expect.
fn write_mesh(
    mesh: &Mesh,
    facets: &[[u32; 3]],
    bounds: &Bounds,
    application: &str,
    file: &mut dyn Write,
    progress: &mut Progress<'_>,
) -> Result<(), ArchiveError> {
    let total = (mesh.vertices.len() + facets.len()) as f64;
    file.write_all(HEAD.as_bytes())?;
    writeln!(
        file,
        " <metadata name=\"Application\">{application}</metadata>\n <resources>\n  <object id=\"1\" type=\"model\">\n   <mesh>\n    \
         <vertices>"
    )?;
    for (chunk, vertices) in mesh.vertices.chunks(CHUNK).enumerate() {
        report(progress, (chunk * CHUNK) as f64 / total)?;
        write_vertices(vertices, file)?;
    }
    file.write_all(b"    </vertices>\n    <triangles>\n")?;
    for (chunk, facets) in facets.chunks(CHUNK).enumerate() {
        report(
            progress,
            (mesh.vertices.len() + chunk * CHUNK) as f64 / total,
        )?;
        write_facets(facets, file)?;
    }
    let [x, y] = [bounds.min.x, bounds.min.y].map(|it| super::tidy(-it) + 0.0);
    writeln!(
        file,
        "    </triangles>\n   </mesh>\n  </object>\n </resources>\n <build>\n  \
         <item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 {x} {y} 0\"/>\n </build>\n</model>"
    )?;
    Ok(())
}
