//! 3MF files made by code.

use std::fmt::Write as _;
use std::io::{Cursor, Write as _};

use glam::Vec3;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

pub const CORE: &str = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
pub const PRODUCTION: &str = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";
pub const START: &str = "3D/3dmodel.model";

/// The relationships that lead to a model.
pub fn relationships(target: &str) -> String {
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Id="rel0" Type="http://schemas.openxmlformats.org/package/2006/relationships/metadata/thumbnail" Target="/Metadata/thumbnail.png"/>
<Relationship Target="{target}" Id="rel1" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>"#
    )
}

/// A model part.
pub fn model(attributes: &str, resources: &str, build: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model {attributes} xmlns=\"{CORE}\" xmlns:p=\"{PRODUCTION}\">\n\
         <metadata name=\"Title\">A &lt;test&gt;</metadata>\n<resources>\n{resources}</resources>\n<build>\n{build}</build>\n</model>\n"
    )
}

/// An object of these triangles, each with vertices of its own.
pub fn object(id: u32, triangles: &[[Vec3; 3]]) -> String {
    let mut text = format!("<object id=\"{id}\" type=\"model\">\n{}", mesh(triangles));
    text.push_str("</object>\n");
    text
}

pub fn mesh(triangles: &[[Vec3; 3]]) -> String {
    let mut text = "<mesh>\n<vertices>\n".to_owned();
    for Vec3 { x, y, z } in triangles.iter().flatten() {
        let _ = writeln!(text, "<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>");
    }
    text.push_str("</vertices>\n<triangles>\n");
    for at in (0..3 * triangles.len()).step_by(3) {
        let _ = writeln!(
            text,
            "<triangle v1=\"{at}\" v2=\"{}\" v3=\"{}\"/>",
            at + 1,
            at + 2
        );
    }
    text.push_str("</triangles>\n</mesh>\n");
    text
}

/// Way in which a zip is written.
#[derive(Clone, Copy, PartialEq)]
pub enum Zipping {
    Deflated,
    Stored,
    /// With the sizes in 64 bits.
    Zip64,
    /// With the sizes behind the data.
    Streamed,
}

/// A zip of these files.
pub fn zipped(files: &[(&str, &str)], zipping: Zipping) -> Vec<u8> {
    let method = match zipping {
        Zipping::Stored => CompressionMethod::Stored,
        _ => CompressionMethod::Deflated,
    };
    let options = SimpleFileOptions::default()
        .compression_method(method)
        .large_file(zipping == Zipping::Zip64);
    if zipping == Zipping::Streamed {
        let mut bytes = Vec::new();
        let mut zip = ZipWriter::new_stream(&mut bytes);
        for (name, text) in files {
            zip.start_file(*name, options).unwrap();
            zip.write_all(text.as_bytes()).unwrap();
        }
        zip.finish().unwrap();
        return bytes;
    }
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, text) in files {
        zip.start_file(*name, options).unwrap();
        zip.write_all(text.as_bytes()).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

/// A 3MF of one model part and others.
pub fn package(start: &str, others: &[(&str, &str)]) -> Vec<u8> {
    let relationships = relationships("/3D/3dmodel.model");
    let mut files = vec![
        ("[Content_Types].xml", "<Types/>"),
        ("_rels/.rels", &*relationships),
        (START, start),
    ];
    files.extend(others);
    zipped(&files, Zipping::Deflated)
}

/// A 3MF of one object in millimetres.
pub fn of(triangles: &[[Vec3; 3]]) -> Vec<u8> {
    let item = "<item objectid=\"1\"/>\n";
    package(
        &model("unit=\"millimeter\"", &object(1, triangles), item),
        &[],
    )
}
