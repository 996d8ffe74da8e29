//! Reading 3MF: what is built, where, and how large; and an error with its part and line for every invalid file.

use cusp_slicer::model::read::kind::FileKind;
use cusp_slicer::model::read::threemf::{ThreeMfError, ThreeMfFeature, XmlFault};
use cusp_slicer::model::read::{Contents, ReadError, read};
use cusp_slicer::model::{Mesh, ModelUnit};
use glam::Vec3;

use crate::common::{assert_near, solids};
use crate::package::{START, Zipping, mesh, model, object, of, package, relationships, zipped};

fn read_model(attributes: &str, resources: &str, build: &str) -> Result<Contents, ReadError> {
    read(&package(&model(attributes, resources, build), &[]))
}

/// The error of a model part.
#[track_caller]
fn error(resources: &str, build: &str) -> ThreeMfError {
    error_of(read_model("", resources, build))
}

#[track_caller]
fn error_of(found: Result<Contents, ReadError>) -> ThreeMfError {
    match found {
        Err(ReadError::ThreeMf(error)) => error,
        other => panic!("{other:?}"),
    }
}

fn moved(triangles: &[[Vec3; 3]], place: impl Fn(Vec3) -> Vec3) -> Vec<[Vec3; 3]> {
    let corners = triangles.iter();
    corners.map(|corners| corners.map(&place)).collect()
}

#[test]
fn an_object_has_the_triangles_that_were_written() {
    let triangles = solids::sphere(3.0, 3);
    let contents = read(&of(&triangles)).unwrap();
    assert_eq!(contents.triangles, triangles);
    assert_eq!(contents.unit, Some(ModelUnit::Millimeter));
    assert_eq!(contents.skipped_objects, 0);
}

#[test]
fn every_way_to_pack_a_part_gives_the_same() {
    let triangles = solids::sphere(3.0, 4);
    let text = model("", &object(7, &triangles), "<item objectid=\"7\"/>");
    let relationships = relationships("3D/3dmodel.model");
    let files = [("_rels/.rels", &*relationships), (START, &*text)];
    for zipping in [
        Zipping::Deflated,
        Zipping::Stored,
        Zipping::Zip64,
        Zipping::Streamed,
    ] {
        assert_eq!(read(&zipped(&files, zipping)).unwrap().triangles, triangles);
    }
}

#[test]
fn coordinates_are_converted_from_every_unit() {
    let cube = solids::cube(2.0);
    for (unit, mm) in [
        ("micron", 0.001),
        ("millimeter", 1.0),
        ("centimeter", 10.0),
        ("inch", 25.4),
        ("foot", 304.8),
        ("meter", 1000.0),
    ] {
        let attributes = format!("unit=\"{unit}\"");
        let contents =
            read_model(&attributes, &object(1, &cube), "<item objectid=\"1\"/>").unwrap();
        assert_eq!(contents.unit.unwrap().name(), unit);
        let expected = moved(&cube, |corner| (corner.as_dvec3() * mm).as_vec3());
        assert_eq!(contents.triangles, expected, "{unit}");
    }
    // Without the attribute it is millimetres.
    let contents = read_model("", &object(1, &cube), "<item objectid=\"1\"/>").unwrap();
    assert_eq!(contents.unit, Some(ModelUnit::Millimeter));
}

#[test]
fn transforms_are_applied_from_the_inside_out() {
    let cube = solids::cube(1.0);
    // Turned by a quarter about z, then moved.
    let resources = object(1, &cube)
        + "<object id=\"2\"><components><component objectid=\"1\" transform=\"0 1 0 -1 0 0 0 0 1 10 0 0\"/></components></object>"
        + "<object id=\"3\"><components><component objectid=\"2\" transform=\"2 0 0 0 2 0 0 0 2 0 0 5\"/>\n\
           <component objectid=\"1\"/></components></object>";
    let build =
        "<item objectid=\"3\" transform=\"1 0 0 0 1 0 0 0 1 100 0 0\"/><item objectid=\"1\"/>";
    let contents = read_model("", &resources, build).unwrap();
    let inner = |corner: Vec3| Vec3::new(10.0 - corner.y, corner.x, corner.z);
    let outer = |corner: Vec3| 2.0 * inner(corner) + Vec3::new(100.0, 0.0, 5.0);
    let mut expected = moved(&cube, outer);
    expected.extend(moved(&cube, |corner| corner + Vec3::new(100.0, 0.0, 0.0)));
    expected.extend(&cube);
    assert_eq!(contents.triangles, expected);
}

#[test]
fn mirrored_objects_face_outward() {
    let ball = solids::sphere(2.0, 3);
    let volume = Mesh::from_triangles(&ball).unwrap().volume_mm3();
    // Two balls in one mesh: had one been inside out, the volumes would cancel.
    let build =
        "<item objectid=\"1\"/><item objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 -9 0 0\"/>";
    let contents = read_model("", &object(1, &ball), build).unwrap();
    let signed = |[a, b, c]: [Vec3; 3]| a.as_dvec3().dot(b.as_dvec3().cross(c.as_dvec3())) / 6.0;
    let (first, second) = contents.triangles.split_at(ball.len());
    for half in [first, second] {
        assert_near(
            half.iter().copied().map(signed).sum(),
            volume,
            1e-3 * volume,
        );
    }
    assert!(second.iter().flatten().all(|corner| corner.x <= -7.0));
}

#[test]
fn objects_in_other_parts_are_found_and_have_the_units_of_these() {
    let cube = solids::cube(1.0);
    let other = model("unit=\"inch\"", &object(5, &cube), "<item objectid=\"5\"/>");
    let resources = "<object id=\"1\"><components>\
        <component p:path=\"/3D/Objects/a%20part.model\" objectid=\"5\" transform=\"1 0 0 0 1 0 0 0 1 3 0 0\"/>\
        </components></object>";
    let build = "<item objectid=\"1\"/><item objectid=\"5\" p:path=\"/3d/objects/A part.model\"/>";
    let start = model(
        "unit=\"millimeter\" requiredextensions=\"p\"",
        resources,
        build,
    );
    let contents = read(&package(&start, &[("3D/Objects/a part.model", &other)])).unwrap();
    let inch = |corner: Vec3| (corner.as_dvec3() * 25.4).as_vec3();
    let mut expected = moved(&cube, |corner| inch(corner) + Vec3::new(3.0, 0.0, 0.0));
    expected.extend(moved(&cube, inch));
    for (found, expected) in contents
        .triangles
        .iter()
        .flatten()
        .zip(expected.iter().flatten())
    {
        assert!((*found - *expected).length() < 1e-5, "{found} {expected}");
    }
    assert_eq!(contents.triangles.len(), expected.len());
    assert_eq!(contents.unit, Some(ModelUnit::Millimeter));
}

#[test]
fn only_what_is_built_and_printed_counts() {
    let cube = solids::cube(1.0);
    let mut resources = object(1, &cube) + &object(2, &solids::sphere(1.0, 2));
    for (id, kind) in [
        (3, "support"),
        (4, "surface"),
        (5, "other"),
        (6, "solidsupport"),
    ] {
        resources += &object(id, &cube).replace("\"model\"", &format!("\"{kind}\""));
    }
    let mut build = String::new();
    for id in [1, 3, 4, 5, 6] {
        build += &format!("<item objectid=\"{id}\"/>");
    }
    build += "<item objectid=\"1\" printable=\"0\"/>";
    let contents = read_model("", &resources, &build).unwrap();
    assert_eq!(contents.triangles, [cube.clone(), cube].concat());
    assert_eq!(contents.skipped_objects, 4);
    let none = error(&resources, "<item objectid=\"3\"/>");
    assert_eq!(none, ThreeMfError::NoFacets { skipped: 1 });
}

#[test]
fn xml_may_be_written_in_many_ways() {
    let cube = solids::cube(1.0);
    let plain = model("", &object(1, &cube), "<item objectid=\"1\"/>");
    let prefixed = plain
        .replace("xmlns=", "xmlns:m=")
        .replace("</", "</m:")
        .replace("<v", "<m:v")
        .replace("<t", "<m:t")
        .replace("<m", "<m:m")
        .replace("<m:m:", "<m:")
        .replace("<o", "<m:o")
        .replace("<r", "<m:r")
        .replace("<b", "<m:b")
        .replace("<i", "<m:i");
    assert!(
        prefixed.contains("<m:vertex ") && prefixed.contains("</m:model>"),
        "{prefixed}"
    );
    let commented = plain
        .replace(
            "<vertices>",
            "<!-- <vertex x=\"> --><![CDATA[<vertex/>]]><vertices\n>",
        )
        .replace("<item", "<!----><item\tx:note='a > b' xmlns:x='urn:x'");
    let foreign = plain.replace(
        "<mesh>",
        "<x:wrap xmlns:x=\"urn:x\" xmlns=\"urn:y\"><mesh><vertices><vertex/></vertices></mesh></x:wrap><mesh>",
    );
    let quoted = plain.replace('"', "'").replace("x='0'", "x=' &#x30; '");
    let packed = plain.replace('\n', "");
    let bom = format!("\u{feff}{plain}");
    for text in [
        &plain, &prefixed, &commented, &foreign, &quoted, &packed, &bom,
    ] {
        assert_eq!(read(&package(text, &[])).unwrap().triangles, cube, "{text}");
    }
}

#[test]
fn the_model_is_the_one_that_the_relationships_name() {
    let cube = solids::cube(1.0);
    let text = model("", &object(1, &cube), "<item objectid=\"1\"/>");
    let elsewhere = relationships("/Models/a&amp;b.model");
    let files = [
        ("_rels/.rels", &*elsewhere),
        ("Models/a&b.model", &text),
        (START, "<model/>"),
    ];
    assert_eq!(
        read(&zipped(&files, Zipping::Deflated)).unwrap().triangles,
        cube
    );
    // Without any, it is where it usually is.
    let alone = zipped(&[(START, &text)], Zipping::Deflated);
    assert_eq!(read(&alone).unwrap().triangles, cube);
    let missing = zipped(
        &[("_rels/.rels", &*elsewhere), (START, &text)],
        Zipping::Deflated,
    );
    let part = "/Models/a&b.model".to_owned();
    assert_eq!(error_of(read(&missing)), ThreeMfError::NoPart { part });
}

#[test]
fn other_zips_are_named() {
    for (name, kind) in [("model.amf", FileKind::Amf), ("model.stl", FileKind::Zip)] {
        let bytes = zipped(&[(name, &"solid ".repeat(50))], Zipping::Stored);
        assert_eq!(read(&bytes), Err(ReadError::OtherKind { kind }));
    }
}

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
    let part = part();
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
    assert_eq!(not_xml, xml(1, XmlFault::NotXml));
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
        ThreeMfError::TooMany { .. }
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
    let found = error_of(read(&bytes));
    assert!(
        matches!(
            found,
            ThreeMfError::TooLarge {
                most_bytes: 67_108_864,
                ..
            }
        ),
        "{found:?}"
    );
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
fn tags_and_comments_may_lie_across_what_is_read_at_a_time() {
    let cube = solids::cube(1.0);
    let text = model("", &object(1, &cube), "<item objectid=\"1\"/>");
    let before = text.find("<vertices>").unwrap();
    // The buffer has 65,536 bytes.
    for length in (65_400..65_600).chain([200_000]) {
        let filler = "-\n".repeat((length - before) / 2) + &"-".repeat(length % 2);
        for comment in [format!("<!-- {} -->", filler.replace('-', "=")), filler] {
            let text = text.replacen("<vertices>", &format!("{comment}<vertices>"), 1);
            assert_eq!(
                read(&package(&text, &[])).unwrap().triangles,
                cube,
                "{length}"
            );
            let broken = text.replacen("<triangle v1", "<triangle v9", 1);
            let line = 1 + broken.split("v9").next().unwrap().matches('\n').count() as u64;
            let found = error_of(read(&package(&broken, &[])));
            assert!(
                matches!(found, ThreeMfError::BadAttribute { line: it, .. } if it == line),
                "{length}: {found:?}"
            );
        }
    }
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

#[test]
fn a_mesh_may_have_its_triangles_first() {
    let cube = solids::cube(1.0);
    let text = mesh(&cube);
    let (start, rest) = text.split_at(text.find("<vertices>").unwrap());
    let (vertices, triangles) = rest.split_at(rest.find("<triangles>").unwrap());
    let (triangles, end) = triangles.split_at(triangles.find("</mesh>").unwrap());
    let swapped = format!("<object id=\"1\">{start}{triangles}{vertices}{end}</object>");
    assert_eq!(
        read_model("", &swapped, "<item objectid=\"1\"/>")
            .unwrap()
            .triangles,
        cube
    );
}
