//! Kinds of files, recognised by their content.

use cusp_slicer::model::read::kind::FileKind;
use cusp_slicer::model::read::{ReadError, read as any};

#[test]
fn files_of_other_kinds_are_named_by_their_first_bytes() {
    let xml = b"\xef\xbb\xbf<?xml version=\"1.0\"?>\n<amf unit=\"millimeter\">";
    let cases: [(&[u8], FileKind); 15] = [
        (b"PK\x03\x04\x14\0part.amf", FileKind::Amf),
        (b"PK\x03\x04\x14\0part.stl", FileKind::Zip),
        (b"\x1f\x8b\x08\0part.stl", FileKind::Gzip),
        (b"glTF\x02\0\0\0", FileKind::Gltf),
        (b"<!DOCTYPE html><title>Log in", FileKind::Html),
        (b"\n  <html lang=en>", FileKind::Html),
        (b"<amf>", FileKind::Amf),
        (xml, FileKind::Amf),
        (b"ISO-10303-21;\nHEADER;", FileKind::Step),
        (b"ply\nformat ascii 1.0\n", FileKind::Ply),
        (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", FileKind::Png),
        (b"\xff\xd8\xff\xe0\0\x10JFIF", FileKind::Jpeg),
        (b"%PDF-1.7\n", FileKind::Pdf),
        (b"  0\r\nSECTION\r\n  2\r\nHEADER\r\n", FileKind::Dxf),
        (b"999\nby hand\n0\nSECTION\n2\nENTITIES\n", FileKind::Dxf),
    ];
    for (head, kind) in cases {
        for length in [head.len(), 2000] {
            let mut file = head.to_vec();
            file.resize(length, b' ');
            let error = any(&file).unwrap_err();
            assert_eq!(error, ReadError::OtherKind { kind }, "{head:?}");
            let message = error.to_string();
            assert!(message.contains(kind.name()), "{message}");
        }
    }
    let picture = any(b"\xff\xd8\xff\xe0").unwrap_err().to_string();
    assert_eq!(
        picture,
        "this is a picture (JPEG); Cusp opens STL, 3MF, OBJ and print files"
    );
    // Keywords alone do not make it another kind.
    for text in ["vase", "v", "# nothing", "plywood", "solids"] {
        assert_eq!(FileKind::of(text.as_bytes()), None, "{text}");
    }
}
