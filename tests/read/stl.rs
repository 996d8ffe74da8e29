//! Reading STL: valid files of every kind, and an error with its position for every invalid one.

use crate::common::{binary_stl, solids};
use cusp_slicer::model::read::stl::{StlError, StlExpected};
use cusp_slicer::model::read::{HEAD_BYTES, ModelFormat, ReadError, identify, read as any};
use glam::Vec3;

const ASCII: &str = "solid part one
  facet normal 0 0 1
    outer loop
      vertex 0 0 1.5
      vertex 1e1 0 1
      vertex 0 -10.25 1
    endloop
  endfacet
endsolid part one
";

/// Reads an STL; panics if the file is taken for something else.
fn read(bytes: &[u8]) -> Result<Vec<[Vec3; 3]>, StlError> {
    let contents = any(bytes).map_err(|error| match error {
        ReadError::Stl(error) => error,
        other => panic!("{other}"),
    })?;
    assert_eq!((contents.unit, contents.skipped_objects), (None, 0));
    Ok(contents.triangles)
}

#[test]
fn binary_files_give_the_corners_that_another_library_wrote() {
    let triangles = solids::sphere(3.0, 2);
    assert_eq!(read(&binary_stl(&triangles)).unwrap(), triangles);
}

#[test]
fn a_binary_header_may_begin_with_solid() {
    let triangles = solids::cube(2.0);
    let mut bytes = binary_stl(&triangles);
    bytes[..12].copy_from_slice(b"solid part  ");
    bytes[12..80].fill(b' ');
    assert_eq!(read(&bytes).unwrap(), triangles);
}

#[test]
fn ascii_agrees_with_another_reader() {
    let ours = read(ASCII.as_bytes()).unwrap();
    let theirs = stl_io::create_stl_reader(&mut std::io::Cursor::new(ASCII))
        .unwrap()
        .map(|triangle| {
            triangle
                .unwrap()
                .vertices
                .map(|v| glam::Vec3::from_array(v.into()))
        })
        .collect::<Vec<_>>();
    assert_eq!(ours, theirs);
}

#[test]
fn ascii_may_vary_in_case_line_ends_normals_and_hold_several_solids() {
    let text = ASCII
        .to_uppercase()
        .replace("0 0 1\n", "NaN NaN NaN\n")
        .replace('\n', "\r\n");
    let twice = format!("\u{feff}{text}\r\n{ASCII}");
    assert_eq!(read(twice.as_bytes()).unwrap().len(), 2);
}

#[test]
fn any_line_end_ends_a_line() {
    let expected = read(ASCII.as_bytes()).unwrap();
    for end in ["\n", "\r", "\r\n", "\n\n", "\r\r"] {
        let text = ASCII.replace('\n', end);
        assert_eq!(read(text.as_bytes()).unwrap(), expected, "{end:?}");
    }
    for end in ["\n", "\r", "\r\n"] {
        let with = |from: &str, to: &str| {
            let text = ASCII.replacen(from, to, 1).replace('\n', end);
            read(text.as_bytes()).unwrap_err()
        };
        assert_eq!(
            with("1e1", "wide"),
            StlError::Syntax {
                line: 5,
                expected: StlExpected::Coordinate,
                found: "wide".into()
            },
            "{end:?}"
        );
    }
}

#[test]
fn what_writers_get_wrong_is_read_all_the_same() {
    let expected = read(ASCII.as_bytes()).unwrap();
    for (right, wrong) in [
        ("endsolid", "end solid"),
        ("endloop", "end loop"),
        ("endfacet", "end facet"),
        ("endfacet", "endfacet 1 of 12"),
        ("endsolid part one\n", ""),
        (
            "endsolid part one\n",
            "endsolid part one\nmade by hand,\nnot by a program\n",
        ),
    ] {
        let text = ASCII.replace(right, wrong);
        assert_ne!(text, ASCII, "{wrong:?}");
        assert_eq!(read(text.as_bytes()).unwrap(), expected, "{wrong:?}");
        let two = [&expected[..], &expected[..]].concat();
        assert_eq!(read(text.repeat(2).as_bytes()).unwrap(), two, "{wrong:?}");
    }
}

#[test]
fn a_whole_file_may_stand_on_one_line() {
    let expected = read(ASCII.as_bytes()).unwrap();
    let line = ASCII.replace('\n', " ");
    for name in ["part one", "", "facet of a part", "\tpart"] {
        let line = line.replace("part one", name);
        assert_eq!(read(line.as_bytes()).unwrap(), expected, "{name:?}");
        let twice = [&expected[..], &expected[..]].concat();
        assert_eq!(read(line.repeat(2).as_bytes()).unwrap(), twice, "{name:?}");
    }
    assert_eq!(
        read(line.replacen("1e1", "wide", 1).as_bytes()),
        Err(StlError::Syntax {
            line: 1,
            expected: StlExpected::Coordinate,
            found: "wide".into()
        })
    );
    assert_eq!(read(b"solid x endsolid x"), Err(StlError::NoFacets));
}

#[test]
fn names_may_be_words_of_the_grammar() {
    for name in ["solid", "my solid part", "facet", "outer loop"] {
        let text = ASCII.replace("part one", name).repeat(2);
        assert_eq!(read(text.as_bytes()).unwrap().len(), 2, "{name}");
    }
}

#[test]
fn bad_binary_files_are_told_apart() {
    let good = binary_stl(&solids::cube(2.0));
    assert_eq!(any(&[]), Err(ReadError::Empty));
    assert_eq!(any(&good[..40]), Err(ReadError::UnknownKind));
    assert_eq!(
        read(&good[..good.len() - 20]),
        Err(StlError::Truncated {
            declared_facets: 12,
            expected_bytes: 684,
            found_bytes: 664
        })
    );
    let mut fewer = good.clone();
    fewer[80] = 11;
    assert_eq!(
        read(&fewer),
        Err(StlError::WrongFacetCount {
            declared_facets: 11,
            found_facets: 12
        })
    );
    let mut none = good[..84].to_vec();
    none[80] = 0;
    assert_eq!(read(&none), Err(StlError::NoFacets));
}

#[test]
fn numbers_that_are_not_finite_are_named_by_byte() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut bytes = binary_stl(&solids::cube(2.0));
        let byte = 84 + 50 * 7 + 12 + 4 * 5;
        bytes[byte..byte + 4].copy_from_slice(&bad.to_le_bytes());
        assert_eq!(
            read(&bytes),
            Err(StlError::NotFiniteBinary {
                byte: byte as u64,
                facet: 7
            })
        );
    }
}

#[test]
fn bad_text_is_named_by_line() {
    let with = |from: &str, to: &str| read(ASCII.replacen(from, to, 1).as_bytes());
    assert_eq!(
        with("1e1", "wide"),
        Err(StlError::Syntax {
            line: 5,
            expected: StlExpected::Coordinate,
            found: "wide".into()
        })
    );
    assert_eq!(
        with("1e1", "inf"),
        Err(StlError::NotFiniteText {
            line: 5,
            text: "inf".into()
        })
    );
    assert_eq!(
        with("endloop", "endfacet"),
        Err(StlError::Syntax {
            line: 7,
            expected: StlExpected::Endloop,
            found: "endfacet".into()
        })
    );
    let cut = &ASCII[..ASCII.find("endloop").unwrap()];
    assert_eq!(
        read(cut.as_bytes()),
        Err(StlError::EndOfText {
            line: 7,
            expected: StlExpected::Endloop
        })
    );
    assert_eq!(
        read(b"solid empty\nendsolid empty\n"),
        Err(StlError::NoFacets)
    );
}

#[test]
fn words_of_a_file_are_quoted_short_and_harmless() {
    let long = "1".repeat(500);
    let cases = [
        (
            "\u{1b}[31m\u{202e}\u{7}it's",
            r"\u{1b}[31m\u{202e}\u{7}it's".to_owned(),
        ),
        ("é\u{1}é", r"é\u{1}é".to_owned()),
        (&*"é".repeat(100), "é".repeat(40)),
    ];
    for (word, expected) in cases {
        match read(ASCII.replacen("1e1", word, 1).as_bytes()) {
            Err(StlError::Syntax { line: 5, found, .. }) => assert_eq!(found, expected),
            other => panic!("{other:?}"),
        }
    }
    assert_eq!(
        read(ASCII.replacen("1e1", &long, 1).as_bytes()),
        Err(StlError::NotFiniteText {
            line: 5,
            text: "1".repeat(40)
        })
    );
}

#[test]
fn text_in_utf_16_is_no_stl() {
    for to_bytes in [u16::to_le_bytes, u16::to_be_bytes] {
        let text = format!("\u{feff}{ASCII}");
        let bytes: Vec<u8> = text.encode_utf16().flat_map(to_bytes).collect();
        assert_eq!(any(&bytes), Err(ReadError::UnknownKind));
    }
}

#[test]
fn other_text_is_no_stl() {
    let text = "A letter about solids.\n".repeat(20);
    assert_eq!(any(text.as_bytes()), Err(ReadError::UnknownKind));
}

#[test]
fn a_binary_file_whose_length_is_right_is_an_stl_whatever_its_header_says() {
    let triangles = solids::cube(2.0);
    for header in [b"PK\x03\x04", b"ply\n", b"v 1 "] {
        let mut bytes = binary_stl(&triangles);
        bytes[..4].copy_from_slice(header);
        assert_eq!(read(&bytes).unwrap(), triangles);
    }
}

#[test]
fn the_head_of_a_file_is_enough_to_refuse_it() {
    let bytes = binary_stl(&solids::sphere(3.0, 6));
    let head = &bytes[..HEAD_BYTES];
    assert_eq!(identify(head, bytes.len() as u64), Ok(ModelFormat::Stl));
    assert_eq!(identify(ASCII.as_bytes(), 1 << 40), Ok(ModelFormat::Stl));
    let cut = identify(head, bytes.len() as u64 - 51);
    assert!(
        matches!(cut, Err(ReadError::Stl(StlError::Truncated { .. }))),
        "{cut:?}"
    );
}
