//! 3MF files that are refused: an error with its part and line for every one.

use cusp_slicer::model::read::read;
use cusp_slicer::model::read::threemf::{ThreeMfError, ThreeMfFeature, XmlFault};

use super::package::{START, Zipping, model, object, package, zipped};
use super::threemf::{error, error_of, read_model};
use crate::common::solids;

#[test]
fn errors_name_the_part_and_the_line() {
    let cube = object(1, &solids::cube(1.0));
    let item = "<item objectid=\"1\"/>\n";
    let part = || START.to_owned();
    // Two lines before the resources, and the first vertex is in line 8.
    let text = model("", &cube, item);
    let line = |of: &str| 1 + text.split(of).next().unwrap().matches('\n').count() as u64;
    let vertex = line("<vertex ");
    let bad = |attribute: &str, found: &str, line| ThreeMfError::BadAttribute {
        part: part(),
        line,
        attribute: attribute.to_owned(),
        found: found.to_owned(),
    };
    let xml = |line, fault| ThreeMfError::Xml {
        part: part(),
        line,
        fault,
    };
    let first = text.lines().nth(vertex as usize - 1).unwrap().to_owned();
    let triangle = line("<triangle ");
    let last = text.lines().count() as u64;
    let cases = [
        (
            &*first,
            "<vertex x=\"1,5\" y=\"0\" z=\"0\"/>",
            bad("x", "1,5", vertex),
        ),
        (
            &*first,
            "<vertex x=\"1\" y=\"nan\" z=\"0\"/>",
            bad("y", "nan", vertex),
        ),
        (
            &*first,
            "<vertex x=\"1\" y=\"1e99\" z=\"0\"/>",
            bad("y", "1e99", vertex),
        ),
        (&*first, "<vertex x=\"1\" y=\"0\"/>", bad("z", "", vertex)),
        (
            &*first,
            "<vertex x=1 y=\"0\"/>",
            xml(vertex, XmlFault::Attribute),
        ),
        (
            &*first,
            "<vertex x=\"1 y=\"0\"",
            xml(last, XmlFault::CutShort),
        ),
        ("v1=\"0\"", "v1=\"-1\"", bad("v1", "-1", triangle)),
        ("v3=\"2\"", "", bad("v3", "", triangle)),
        (
            "</vertices>",
            "</vertexes>",
            xml(line("</vertices>"), XmlFault::WrongEndTag),
        ),
        ("objectid=\"1\"", "", bad("objectid", "", line("<item"))),
        (
            "objectid=\"1\"",
            "objectid=\"1\" transform=\"1 0 0\"",
            bad("transform", "", line("<item")),
        ),
        ("<model ", "<model unit=\"mile\" ", bad("unit", "mile", 2)),
        (
            "<model ",
            "<!DOCTYPE x [<!ENTITY a \"b\">]><model ",
            xml(2, XmlFault::Doctype),
        ),
        ("</model>", "", xml(last, XmlFault::CutShort)),
    ];
    for (from, to, expected) in cases {
        let changed = text.replacen(from, to, 1);
        let found = error_of(read(&package(&changed, &[])));
        let is_line_of_end = matches!(
            &found,
            ThreeMfError::Xml {
                fault: XmlFault::CutShort,
                ..
            }
        );
        if is_line_of_end {
            assert!(
                matches!(
                    expected,
                    ThreeMfError::Xml {
                        fault: XmlFault::CutShort,
                        ..
                    }
                ),
                "{to}"
            );
        } else {
            assert_eq!(found, expected, "{to}");
        }
    }
}

#[test]
fn references_to_nothing_are_named() {
    let cube = object(1, &solids::cube(1.0));
    let item = "<item objectid=\"1\"/>\n";
    let text = model("", &cube, item);
    let line = |of: &str| 1 + text.split(of).next().unwrap().matches('\n').count() as u64;
    let part = START.to_owned();
    assert_eq!(
        error(&cube, "\n<item objectid=\"9\"/>"),
        ThreeMfError::NoObject {
            part: part.clone(),
            line: line("<item") + 1,
            object: 9
        }
    );
    let beyond = cube.replacen("v2=\"1\"", "v2=\"36\"", 1);
    assert_eq!(
        error(&beyond, item),
        ThreeMfError::NoVertex {
            part,
            line: line("</object>"),
            vertex: 36,
            vertices: 36
        }
    );
    let not_xml = error_of(read(&package("\0\u{1}\u{2}", &[])));
    let fault = XmlFault::NotXml;
    let part = START.to_owned();
    assert_eq!(
        not_xml,
        ThreeMfError::Xml {
            part,
            line: 1,
            fault
        }
    );
}

#[test]
fn what_is_not_made_of_facets_is_named() {
    let cube = solids::cube(1.0);
    let item = "<item objectid=\"1\"/>";
    let feature = |feature| ThreeMfError::Feature {
        part: START.to_owned(),
        object: 1,
        feature,
    };
    let inside = |text: &str| object(1, &cube).replace("</mesh>", &format!("{text}</mesh>"));
    let beside = |text: &str| object(1, &cube).replace("<mesh>", &format!("{text}<mesh>"));
    let ns =
        |name: &str| format!("xmlns:x=\"http://schemas.3mf.io/3dmanufacturing/{name}/2020/01\"");
    let beams = inside(&format!(
        "<x:beamlattice {}><x:beams/></x:beamlattice>",
        ns("beamlattice")
    ));
    assert_eq!(error(&beams, item), feature(ThreeMfFeature::BeamLattice));
    let displaced = beside(&format!("<x:displacementmesh {}/>", ns("displacement")));
    assert_eq!(
        error(&displaced, item),
        feature(ThreeMfFeature::Displacement)
    );
    let cut = beside(&format!("<x:booleanshape {}/>", ns("booleanoperations")));
    assert_eq!(error(&cut, item), feature(ThreeMfFeature::Booleans));
    let level = beside(&format!("<x:levelset {}/>", ns("volumetric")));
    assert_eq!(error(&level, item), feature(ThreeMfFeature::Volumetric));
    let sliced = object(1, &cube).replace(
        "<object",
        &format!("<object {} x:meshresolution=\"lowres\"", ns("slice")),
    );
    assert_eq!(error(&sliced, item), feature(ThreeMfFeature::Slices));
    // It does not matter where it is not printed.
    let unused = beams.replace("id=\"1\"", "id=\"2\"") + &object(1, &cube);
    assert_eq!(read_model("", &unused, item).unwrap().triangles, cube);
    let required = |name: &str| {
        let attributes = format!("requiredextensions=\"p x\" {}", ns(name));
        read_model(&attributes, &object(1, &cube), item)
    };
    assert_eq!(required("material").unwrap().triangles, cube);
    let part = START.to_owned();
    assert_eq!(
        error_of(required("securecontent")),
        ThreeMfError::Encrypted { part: part.clone() }
    );
    let extension = "http://schemas.3mf.io/3dmanufacturing/holograms/2020/01".to_owned();
    assert_eq!(
        error_of(required("holograms")),
        ThreeMfError::Extension { part, extension }
    );
}

#[test]
fn objects_that_contain_themselves_or_repeat_for_ever_are_refused() {
    let part = || START.to_owned();
    let component = |id| format!("<component objectid=\"{id}\"/>");
    let composed =
        |id: u32, of: &str| format!("<object id=\"{id}\"><components>{of}</components></object>");
    let circle = composed(1, &component(2)) + &composed(2, &component(1));
    assert!(matches!(
        error(&circle, "<item objectid=\"1\"/>"),
        ThreeMfError::Nested {
            most_levels: 64,
            ..
        }
    ));
    // Each object has twenty of the one before.
    let mut tower = object(1, &solids::cube(1.0));
    for id in 2..30 {
        tower += &composed(id, &component(id - 1).repeat(20));
    }
    assert!(matches!(
        error(&tower, "<item objectid=\"29\"/>"),
        ThreeMfError::TooMany { most_facets } if most_facets < 1_300_000
    ));
    // Empty ones cost time, if no memory.
    let empty = tower.replacen(
        &object(1, &solids::cube(1.0)),
        "<object id=\"1\"><mesh/></object>",
        1,
    );
    assert!(matches!(
        error(&empty, "<item objectid=\"29\"/>"),
        ThreeMfError::TooMany { .. }
    ));
    let far = error(
        &object(1, &solids::cube(1.0)),
        "<item objectid=\"1\" transform=\"3e38 0 0 0 1 0 0 0 1 3e38 0 0\"/>",
    );
    assert_eq!(
        far,
        ThreeMfError::Overflow {
            part: part(),
            object: 1
        }
    );
    let deep = "<a>".repeat(100) + &"</a>".repeat(100);
    assert!(matches!(
        error(&deep, ""),
        ThreeMfError::Xml {
            fault: XmlFault::Deep,
            ..
        }
    ));
}

#[test]
fn bombs_are_stopped() {
    let spaces = " ".repeat(100 << 20);
    let text = model("", &object(1, &solids::cube(1.0)), "<item objectid=\"1\"/>") + &spaces;
    let bytes = package(&text, &[]);
    assert!(bytes.len() < 1 << 20);
    // The same facet again and again would fill the memory once it is expanded.
    let facets = "<triangle v1=\"0\" v2=\"1\" v3=\"2\"/>".repeat(1 << 19);
    let many = object(1, &solids::cube(1.0)).replace("</triangles>", &(facets + "</triangles>"));
    let many = package(&model("", &many, "<item objectid=\"1\"/>"), &[]);
    assert!(many.len() < 1 << 16);
    for bytes in [bytes, many] {
        let found = error_of(read(&bytes));
        let most = 200 * bytes.len() as u64;
        assert!(
            matches!(found, ThreeMfError::TooLarge { most_bytes, .. } if most_bytes == most.max(8 << 20)),
            "{found:?}"
        );
    }
    let tag = model(&format!("{}=\"x\"", "a".repeat(2 << 20)), "", "");
    let found = error_of(read(&package(&tag, &[])));
    assert!(
        matches!(
            found,
            ThreeMfError::Xml {
                fault: XmlFault::LongTag,
                ..
            }
        ),
        "{found:?}"
    );
}

#[test]
fn damaged_parts_are_noticed() {
    let text = model(
        "",
        &object(1, &solids::sphere(2.0, 3)),
        "<item objectid=\"1\"/>",
    );
    let part = || START.to_owned();
    let bytes = zipped(&[(START, &text)], Zipping::Stored);
    let mut changed = bytes.clone();
    let place = bytes.windows(6).position(|it| it == b"vertex").unwrap();
    let digit = bytes[place..].iter().position(u8::is_ascii_digit).unwrap();
    changed[place + digit] ^= 1;
    assert_eq!(
        error_of(read(&changed)),
        ThreeMfError::DamagedPart { part: part() }
    );
    let cut = &bytes[..bytes.len() - 30];
    assert_eq!(error_of(read(cut)), ThreeMfError::NoDirectory);
    // The directory says that it is encrypted: bit 0 of its flags.
    let mut encrypted = bytes.clone();
    let directory = bytes
        .windows(4)
        .rposition(|it| it == b"PK\x01\x02")
        .unwrap();
    encrypted[directory + 8] |= 1;
    assert_eq!(
        error_of(read(&encrypted)),
        ThreeMfError::Packed {
            part: part(),
            method: 0
        }
    );
    encrypted[directory + 8] ^= 1;
    encrypted[directory + 10] = 14;
    assert_eq!(
        error_of(read(&encrypted)),
        ThreeMfError::Packed {
            part: part(),
            method: 14
        }
    );
}
