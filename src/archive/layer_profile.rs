//! Files for slicers of filament printers: a 3MF with the model in its pose, and the thicknesses of its layers as a layer height
//! profile.
//!
//! Such a slicer prints the first layer as thick as its settings say. From there on it looks the thickness of each layer up in the
//! profile, a little above the layer's bottom, and stops where the middle of a layer would be above the model. A profile with
//! two points for each layer, at its bottom and at its top, therefore gives exactly the layers of the plan.

use std::io::{self, BufWriter, Write};

use flate2::Compression;
use flate2::write::DeflateEncoder;
use rawzip::{CompressionMethod, DataDescriptorOutput, ZipArchiveWriter};

use super::ArchiveError;
use super::zip::MODIFIED;
use crate::crc::Crc32;
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

const CONTENT_TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
 <Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
 <Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
 <Default Extension="txt" ContentType="text/plain"/>
</Types>
"#;

const RELATIONSHIPS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
 <Relationship Target="/3D/3dmodel.model" Id="rel-1" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
"#;

const MODEL_HEAD: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
"#;

/// Name under which a slicer looks for the profile.
fn profile_name(slicer: FilamentSlicer) -> &'static str {
    match slicer {
        FilamentSlicer::Prusa => "Metadata/Slic3r_PE_layer_heights_profile.txt",
        FilamentSlicer::Orca => "Metadata/layer_heights_profile.txt",
    }
}

/// Application that the file names as its author. Bambu Studio and `OrcaSlicer` take only the mesh from files of other
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
    writer: W,
    progress: &mut Progress<'_>,
) -> Result<W, ArchiveError> {
    report(progress, 0.0)?;
    model.check()?;
    let mesh = model.mesh;
    let facets = &mesh.facets[..mesh.classes.model_end() as usize];
    let bounds = mesh.bounds();
    let mut zip = begin(writer, |file| {
        write_mesh(mesh, facets, &bounds, application(slicer), file, progress)
    })?;
    add(&mut zip, profile_name(slicer), |file| {
        writeln!(file, "object_id=1|{}", model.profile())?;
        Ok(())
    })?;
    zip.finish().map_err(ArchiveError::write)
}

/// Writes all that is printed of a mesh as a 3MF: the model, its voids as bodies inside out, and its supports.
///
/// # Errors
/// [`ArchiveError::Write`], [`ArchiveError::Cancelled`].
pub fn write_printed<W: Write>(
    mesh: &Mesh,
    writer: W,
    progress: &mut Progress<'_>,
) -> Result<W, ArchiveError> {
    let (facets, bounds) = (mesh.printed_facets(), mesh.printed_bounds());
    let zip = begin(writer, |file| {
        write_mesh(mesh, &facets, &bounds, "Cusp", file, progress)
    })?;
    zip.finish().map_err(ArchiveError::write)
}

/// The zip with what every 3MF has, and the model that `write_model` writes.
fn begin<W: Write>(
    writer: W,
    write_model: impl FnOnce(&mut dyn Write) -> Result<(), ArchiveError>,
) -> Result<ZipArchiveWriter<W>, ArchiveError> {
    let mut zip = ZipArchiveWriter::new(writer);
    add(&mut zip, "[Content_Types].xml", |file| {
        Ok(file.write_all(CONTENT_TYPES.as_bytes())?)
    })?;
    add(&mut zip, "_rels/.rels", |file| {
        Ok(file.write_all(RELATIONSHIPS.as_bytes())?)
    })?;
    add(&mut zip, "3D/3dmodel.model", write_model)?;
    Ok(zip)
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

/// Writes the mesh as XML. Coordinates are the shortest decimals that give the same number in single precision. The object is moved to
/// where its x and y are not negative, which readers may expect.
fn write_mesh(
    mesh: &Mesh,
    facets: &[[u32; 3]],
    bounds: &Bounds,
    application: &str,
    file: &mut dyn Write,
    progress: &mut Progress<'_>,
) -> Result<(), ArchiveError> {
    let total = (mesh.vertices.len() + facets.len()) as f64;
    file.write_all(MODEL_HEAD.as_bytes())?;
    writeln!(
        file,
        " <metadata name=\"Application\">{application}</metadata>\n <resources>\n  <object id=\"1\" type=\"model\">\n   <mesh>\n    \
         <vertices>"
    )?;
    for (chunk, vertices) in mesh.vertices.chunks(CHUNK).enumerate() {
        report(progress, (chunk * CHUNK) as f64 / total)?;
        for vertex in vertices {
            // Adding 0 makes -0 plain.
            let [x, y, z] = vertex.to_array().map(|it| it + 0.0);
            writeln!(file, "<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>")?;
        }
    }
    file.write_all(b"    </vertices>\n    <triangles>\n")?;
    for (chunk, facets) in facets.chunks(CHUNK).enumerate() {
        report(
            progress,
            (mesh.vertices.len() + chunk * CHUNK) as f64 / total,
        )?;
        for [a, b, c] in facets {
            writeln!(file, "<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>")?;
        }
    }
    let [x, y] = [bounds.min.x, bounds.min.y].map(|it| super::tidy(-it) + 0.0);
    writeln!(
        file,
        "    </triangles>\n   </mesh>\n  </object>\n </resources>\n <build>\n  \
         <item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 {x} {y} 0\"/>\n </build>\n</model>"
    )?;
    Ok(())
}

/// Text of coordinates shrinks hardly more at higher levels, which take several times as long.
const LEVEL: u32 = 3;

/// Adds a file to the zip, deflated while `write` writes it.
fn add<W: Write>(
    zip: &mut ZipArchiveWriter<W>,
    name: &str,
    write: impl FnOnce(&mut dyn Write) -> Result<(), ArchiveError>,
) -> Result<(), ArchiveError> {
    let builder = zip
        .new_file(name)
        .compression_method(CompressionMethod::DEFLATE)
        .last_modified(MODIFIED);
    let (mut entry, _) = builder.start().map_err(ArchiveError::write)?;
    let deflater = DeflateEncoder::new(&mut entry, Compression::new(LEVEL));
    let sum = summed(deflater, write)?;
    entry.finish(sum).map_err(ArchiveError::write)?;
    Ok(())
}

/// Writes all of a file, and sums it up.
fn summed<W: Write>(
    deflater: DeflateEncoder<W>,
    write: impl FnOnce(&mut dyn Write) -> Result<(), ArchiveError>,
) -> Result<DataDescriptorOutput, ArchiveError> {
    let mut file = BufWriter::new(Summed::new(deflater));
    write(&mut file)?;
    let file = file
        .into_inner()
        .map_err(|error| ArchiveError::write(error.error()))?;
    file.inner.finish()?;
    Ok(DataDescriptorOutput::new(file.crc.checksum(), file.length))
}

/// A writer that sums up what passes. Rawzip's has the table of checksums with it: see [`crate::crc`].
struct Summed<W> {
    inner: W,
    crc: Crc32,
    length: u64,
}

impl<W> Summed<W> {
    fn new(inner: W) -> Self {
        let (crc, length) = (Crc32::default(), 0);
        Self { inner, crc, length }
    }
}

impl<W: Write> Write for Summed<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.inner.write(bytes)?;
        self.crc.update(&bytes[..count]);
        self.length += count as u64;
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}
