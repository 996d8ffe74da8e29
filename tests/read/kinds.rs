//! What files are is told by their content.

use cusp_slicer::model::read::kind::FileKind;
use cusp_slicer::model::read::{ReadError, read as any};

#[test]
fn files_of_other_kinds_are_named_by_their_first_bytes() {
    let xml = b"\xef\xbb\xbf<?xml version=\"1.0\"?>\n<amf unit=\"millimeter\">";
    let cases: [(&[u8], FileKind); 10] = [
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
    // Keywords alone do not make it another kind.
    for text in ["vase", "v", "# nothing", "plywood", "solids"] {
        assert_eq!(FileKind::of(text.as_bytes()), None, "{text}");
    }
}
