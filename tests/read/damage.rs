//! Damaged models: cut at every length, and with bytes changed. None makes a reader panic.

use cusp_slicer::model::Mesh;
use cusp_slicer::model::read::{ReadError, read};

use super::obj::obj;
use super::package::{START, Zipping, model, object, relationships, zipped};
use crate::common::{binary_stl, solids};

fn files() -> Vec<Vec<u8>> {
    let cube = solids::cube(3.0);
    let resources = object(1, &cube)
        + "<object id=\"2\"><components><component objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 9 0 0\"/>\
           <component p:path=\"/3D/b.model\" objectid=\"1\"/></components></object>";
    let text = model(
        "unit=\"inch\"",
        &resources,
        "<item objectid=\"2\"/><item objectid=\"1\"/>",
    );
    let relationships = relationships("/3D/3dmodel.model");
    let other = model("", &object(1, &cube), "");
    let parts = [
        ("_rels/.rels", &*relationships),
        (START, &*text),
        ("3D/b.model", &*other),
    ];
    let quads = obj(&cube) + "f 1 2 3 4 5\nf -1//1 -2/3 -3/4/5 \\\n-9\n";
    vec![
        binary_stl(&cube),
        quads.into_bytes(),
        zipped(&parts, Zipping::Deflated),
        zipped(&parts, Zipping::Streamed),
        zipped(&parts, Zipping::Zip64),
        zipped(&parts, Zipping::Stored),
    ]
}

/// Reads a file; an error must have a sentence.
fn look(bytes: &[u8]) -> Result<(), ReadError> {
    match read(bytes) {
        Ok(contents) => {
            assert!(
                contents
                    .triangles
                    .iter()
                    .flatten()
                    .all(|corner| corner.is_finite())
            );
            let _ = Mesh::from_triangles(&contents.triangles);
            Ok(())
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            Err(error)
        }
    }
}

#[test]
fn whole_files_are_read() {
    for file in files() {
        look(&file).unwrap();
    }
}

#[test]
fn every_cut_of_a_zip_or_a_binary_file_is_noticed() {
    for (place, file) in files().iter().enumerate() {
        for length in 0..file.len() {
            let found = look(&file[..length]);
            // A cut between lines of an OBJ cannot be noticed.
            assert!(found.is_err() || place == 1, "{length} of {}", file.len());
        }
    }
}

#[test]
fn no_change_of_bytes_makes_a_reader_panic() {
    let mut random = fastrand::Rng::with_seed(7);
    for file in files() {
        for _ in 0..3000 {
            let mut changed = file.clone();
            for _ in 0..random.usize(1..=4) {
                let place = random.usize(..file.len());
                let bytes = [
                    0,
                    1,
                    b'0',
                    b'9',
                    b'-',
                    b'/',
                    b'<',
                    b'"',
                    0x7F,
                    0xFF,
                    random.u8(..),
                ];
                changed[place] = bytes[random.usize(..bytes.len())];
            }
            let _ = look(&changed);
        }
    }
}

/// The text is changed before it is packed, so that the zip's checksum does not notice.
#[test]
fn no_change_of_a_part_makes_the_reader_panic() {
    let mut random = fastrand::Rng::with_seed(8);
    let cube = solids::cube(3.0);
    let resources = object(1, &cube)
        + "<object id=\"2\"><components><component objectid=\"1\"/></components></object>";
    let text = model("unit=\"inch\"", &resources, "<item objectid=\"2\"/>");
    for _ in 0..5000 {
        let mut changed = text.clone().into_bytes();
        for _ in 0..random.usize(1..=4) {
            let place = random.usize(..changed.len());
            let bytes = *b"<>/\"'&;= 0-ex\n!?:";
            match random.u8(..3) {
                0 => drop(changed.remove(place)),
                1 => changed.insert(place, bytes[random.usize(..bytes.len())]),
                _ => changed[place] = bytes[random.usize(..bytes.len())],
            }
        }
        let changed = String::from_utf8(changed).unwrap();
        let _ = look(&zipped(&[(START, &changed)], Zipping::Stored));
    }
}
