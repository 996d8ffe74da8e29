//! Kinds of files that cannot be read but are often opened as models. They are recognised by their first bytes, so that errors
//! can name them.

use serde::Serialize;

/// A kind of file that cannot be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum FileKind {
    /// AMF, as XML or in a zip.
    Amf,
    /// PLY, also called Stanford.
    Ply,
    /// STEP: exact surfaces, for CAD programs.
    Step,
    /// glTF in its binary form.
    Gltf,
    /// Another zip.
    Zip,
    /// A file compressed by gzip.
    Gzip,
    /// A web page.
    Html,
    /// A PNG picture.
    Png,
    /// A JPEG picture.
    Jpeg,
    /// A PDF document.
    Pdf,
    /// DXF: a drawing.
    Dxf,
}

impl FileKind {
    /// Its usual name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Amf => "AMF",
            Self::Ply => "PLY",
            Self::Step => "STEP",
            Self::Gltf => "glTF",
            Self::Zip => "zip",
            Self::Gzip => "gzip",
            Self::Html => "HTML",
            Self::Png => "PNG",
            Self::Jpeg => "JPEG",
            Self::Pdf => "PDF",
            Self::Dxf => "DXF",
        }
    }

    /// The sentence that names the file and says what to do instead.
    pub(crate) fn sentence(self) -> String {
        let name = self.name();
        let noun = match self {
            Self::Png | Self::Jpeg => "picture",
            Self::Pdf => "document",
            Self::Dxf => "drawing",
            _ => {
                let advice = self.advice();
                return format!("this is a {name} file, which Cusp does not read; {advice}");
            }
        };
        format!("this is a {noun} ({name}); Cusp opens STL, 3MF, OBJ and print files")
    }

    fn advice(self) -> &'static str {
        match self {
            Self::Zip | Self::Gzip => "unpack it, and open the model inside",
            Self::Html => {
                "download the model itself; the address may need a login, or lead to a page about the model"
            }
            _ => "export the model as STL, 3MF or OBJ",
        }
    }

    /// The kind of a file that begins with these bytes. `None` for models and for unknown kinds.
    pub fn of(head: &[u8]) -> Option<Self> {
        if head.starts_with(b"PK\x03\x04") {
            return Self::of_zip(head);
        }
        if head.starts_with(b"\x1f\x8b") {
            return Some(Self::Gzip);
        }
        if head.starts_with(b"glTF") {
            return Some(Self::Gltf);
        }
        if head.starts_with(b"\x89PNG\r\n\x1a\n") {
            return Some(Self::Png);
        }
        if head.starts_with(b"\xff\xd8\xff") {
            return Some(Self::Jpeg);
        }
        if head.starts_with(b"%PDF-") {
            return Some(Self::Pdf);
        }
        let text = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
        let text = text.trim_ascii_start();
        if head.starts_with(b"AutoCAD Binary DXF") || is_dxf(text) {
            return Some(Self::Dxf);
        }
        let starts_with = |word: &[u8]| {
            text.get(..word.len())
                .is_some_and(|start| start.eq_ignore_ascii_case(word))
        };
        if starts_with(b"<!doctype html") || starts_with(b"<html") {
            return Some(Self::Html);
        }
        if starts_with(b"<amf") || (starts_with(b"<?xml") && contains(text, b"<amf")) {
            return Some(Self::Amf);
        }
        if starts_with(b"ISO-10303-21;") {
            return Some(Self::Step);
        }
        if starts_with(b"ply\n") || starts_with(b"ply\r") {
            return Some(Self::Ply);
        }
        None
    }

    /// The kind of a zip, by the file names in it, which zips do not compress. `None` for a 3MF.
    pub(crate) fn of_zip(head: &[u8]) -> Option<Self> {
        if contains(head, b".amf") {
            Some(Self::Amf)
        } else if contains(head, b"[Content_Types].xml") || contains(head, b"3D/") {
            None
        } else {
            Some(Self::Zip)
        }
    }
}

/// Returns true if a text begins as a DXF does, perhaps after comments: group 0, then SECTION.
fn is_dxf(text: &[u8]) -> bool {
    let mut lines = text.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
    let mut code = lines.next();
    while code == Some(b"999") {
        lines.next();
        code = lines.next();
    }
    code == Some(b"0") && lines.next() == Some(b"SECTION")
}

fn contains(text: &[u8], part: &[u8]) -> bool {
    text.windows(part.len()).any(|window| window == part)
}
