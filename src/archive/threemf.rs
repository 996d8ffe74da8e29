//! Common parts of the 3MF files written here: a zip with the types of its parts, a relationship to the model, and meshes as XML.

use std::io::{self, BufWriter, Write};

use flate2::Compression;
use flate2::write::DeflateEncoder;
use glam::Vec3;
use rawzip::{CompressionMethod, DataDescriptorOutput, ZipArchiveWriter};

use super::ArchiveError;
use super::zip::MODIFIED;
use crate::crc::Crc32;

const CONTENT_TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
 <Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
 <Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
"#;

const RELATIONSHIPS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
 <Relationship Target="/3D/3dmodel.model" Id="rel-1" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
"#;

/// Beginning of the model part, in millimetres.
pub(crate) const HEAD: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
"#;

/// Writes a part. No type of the writer, so that all writers share its code.
pub(crate) type WritePart<'a> = &'a mut dyn FnMut(&mut dyn Write) -> Result<(), ArchiveError>;

/// The zip with what every 3MF has, and the model that `write_model` writes. `types` are those of further parts: extension and content
/// type.
pub(crate) fn begin<'a>(
    writer: &'a mut dyn Write,
    types: &[(&str, &str)],
    write_model: WritePart<'_>,
) -> Result<ZipArchiveWriter<&'a mut dyn Write>, ArchiveError> {
    let mut zip = ZipArchiveWriter::new(writer);
    add(&mut zip, "[Content_Types].xml", &mut |file| {
        file.write_all(CONTENT_TYPES.as_bytes())?;
        for (extension, content) in types {
            writeln!(
                file,
                " <Default Extension=\"{extension}\" ContentType=\"{content}\"/>"
            )?;
        }
        Ok(file.write_all(b"</Types>\n")?)
    })?;
    add(&mut zip, "_rels/.rels", &mut |file| {
        Ok(file.write_all(RELATIONSHIPS.as_bytes())?)
    })?;
    add(&mut zip, "3D/3dmodel.model", write_model)?;
    Ok(zip)
}

/// Writes vertices. Coordinates are the shortest decimals that give the same number in single precision.
pub(crate) fn write_vertices(vertices: &[Vec3], file: &mut dyn Write) -> io::Result<()> {
    for vertex in vertices {
        // Adding 0 makes -0 plain.
        let [x, y, z] = vertex.to_array().map(|it| it + 0.0);
        writeln!(file, "<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>")?;
    }
    Ok(())
}

/// Writes facets by their vertices.
pub(crate) fn write_facets(facets: &[[u32; 3]], file: &mut dyn Write) -> io::Result<()> {
    for [a, b, c] in facets {
        writeln!(file, "<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>")?;
    }
    Ok(())
}

/// Text of coordinates shrinks hardly more at higher levels, which take several times as long.
const LEVEL: u32 = 3;

/// Adds a file to the zip, deflated while `write` writes it.
pub(crate) fn add(
    zip: &mut ZipArchiveWriter<&mut dyn Write>,
    name: &str,
    write: WritePart<'_>,
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
    write: WritePart<'_>,
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
