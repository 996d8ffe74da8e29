//! Reading 3MF: the facets of its build, their places and their sizes.

use std::fmt::Write as _;

use crate::common::Slicer;
use cusp_slicer::job::Options;
use cusp_slicer::model::read::kind::FileKind;
use cusp_slicer::model::read::threemf::ThreeMfError;
use cusp_slicer::model::read::{Contents, PartKind, ReadError, ReadOptions, read, read_with};
use cusp_slicer::model::{Mesh, ModelUnit};
use cusp_slicer::warning::Warning;
use glam::Vec3;

use super::package::{START, Zipping, mesh, model, object, of, package, relationships, zipped};
use crate::common::{assert_near, quiet, solids};

pub fn read_model(attributes: &str, resources: &str, build: &str) -> Result<Contents, ReadError> {
    read(&package(&model(attributes, resources, build), &[]))
}

/// The error of a model part.
#[track_caller]
pub fn error(resources: &str, build: &str) -> ThreeMfError {
    error_of(read_model("", resources, build))
}

#[track_caller]
pub fn error_of(found: Result<Contents, ReadError>) -> ThreeMfError {
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
fn drafts_of_the_format_and_relative_targets_are_read() {
    let triangles = solids::sphere(3.0, 2);
    let text = model("", &object(7, &triangles), "<item objectid=\"7\"/>");
    let draft = text.replace("3dmanufacturing/core/2015/02", "3dmanufacturing/2013/01");
    assert_ne!(draft, text);
    for (text, target) in [
        (&draft, "3D/3dmodel.model"),
        (&text, "./3D/3dmodel.model"),
        (&text, "/3D/../3D/./3dmodel.model"),
    ] {
        let relationships = relationships(target);
        let files = [("_rels/.rels", &*relationships), (START, &**text)];
        let contents = read(&zipped(&files, Zipping::Deflated)).unwrap();
        assert_eq!(contents.triangles, triangles, "{target}");
    }
}

/// A project of OrcaSlicer: a block, with a hole, a region and two supports that are only hints, and a second block on another plate.
fn project() -> Vec<u8> {
    let block = solids::cuboid(Vec3::new(20.0, 20.0, 10.0));
    let hole = solids::moved(
        &solids::cuboid(Vec3::new(4.0, 5.0, 30.0)),
        Vec3::new(8.0, 8.0, -10.0),
    );
    let hint = solids::moved(&solids::cube(6.0), Vec3::new(0.0, 0.0, 12.0));
    let mut resources = String::new();
    for (id, triangles) in [(1, &block), (2, &hole), (3, &hint), (4, &hint), (5, &hint)] {
        resources += &object(id, triangles);
    }
    resources += "<object id=\"6\"><components>";
    for id in 1..=5 {
        let _ = write!(resources, "<component objectid=\"{id}\"/>");
    }
    resources += "</components></object>";
    let build = "<item objectid=\"6\"/><item objectid=\"1\"/><item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 50 0 0\"/>";
    let text = model("", &resources, build);
    let part = |id: u32, subtype: &str, name: &str| {
        format!(
            "<part id=\"{id}\" subtype=\"{subtype}\"><metadata key=\"name\" value=\"{name}\"/></part>"
        )
    };
    let instance = |object: u32, instance: u32| {
        format!(
            "<model_instance><metadata key=\"object_id\" value=\"{object}\"/><metadata key=\"instance_id\" value=\"{instance}\"/></model_instance>"
        )
    };
    let settings = format!(
        "<?xml version=\"1.0\"?>\n<config><object id=\"6\"><metadata key=\"name\" value=\"all\"/>{}{}{}{}{}</object>\
         <plate><metadata key=\"plater_id\" value=\"1\"/>{}</plate><plate>{}{}</plate><plate/></config>",
        part(1, "normal_part", "block"),
        part(2, "negative_part", "bolt &amp; nut"),
        part(3, "modifier_part", "dense"),
        part(4, "support_blocker", "none here"),
        part(5, "support_enforcer", ""),
        instance(6, 0),
        instance(1, 0),
        instance(1, 1),
    );
    let relationships = relationships(START);
    let files = [
        ("_rels/.rels", &*relationships),
        (START, &*text),
        ("Metadata/model_settings.config", &*settings),
    ];
    zipped(&files, Zipping::Deflated)
}

#[test]
fn parts_that_slicers_do_not_print_are_subtracted_or_left_out_by_name() {
    let bytes = project();
    let contents = read(&bytes).unwrap();
    assert_eq!(
        (contents.triangles.len(), contents.negative.len()),
        (12, 12)
    );
    let parts = contents.parts.iter();
    let parts: Vec<_> = parts.map(|part| (&*part.name, part.kind)).collect();
    assert_eq!(
        parts,
        [
            ("bolt & nut", PartKind::Negative),
            ("dense", PartKind::Modifier),
            ("none here", PartKind::SupportBlocker),
            ("5", PartKind::SupportEnforcer),
        ]
    );
    // The negative part reaches beyond the block, also below the plate.
    let mut slicer = Slicer::load(&bytes).unwrap();
    let options = Options {
        rays: 200,
        ..Options::default()
    };
    let report = pollster::block_on(slicer.plan(&options, &mut quiet)).unwrap();
    assert_near(report.resin_ml, (400.0 - 20.0) * 10.0 / 1e3, 0.01);
    assert_eq!(report.height_mm, 10.0);
    let warnings = report.all_warnings();
    let said: Vec<String> = warnings.iter().take(3).map(Warning::to_string).collect();
    assert_eq!(
        said,
        [
            "plate 1 of 2 is read",
            "the part “bolt & nut” is subtracted",
            "the modifier “dense” is left out",
        ]
    );
}

#[test]
fn ranges_of_facets_are_parts_as_prusaslicer_writes_them() {
    let mut triangles = solids::cuboid(Vec3::new(20.0, 20.0, 10.0));
    triangles.extend(solids::moved(&solids::cube(4.0), Vec3::splat(8.0)));
    triangles.extend(solids::moved(&solids::cube(4.0), Vec3::splat(30.0)));
    let text = model("", &object(1, &triangles), "<item objectid=\"1\"/>");
    let volume = |first: u32, kind: &str| {
        format!(
            "<volume firstid=\"{first}\" lastid=\"{}\"><metadata type=\"volume\" key=\"volume_type\" value=\"{kind}\"/></volume>",
            first + 11
        )
    };
    let settings = format!(
        "<?xml version=\"1.0\"?><config><object id=\"1\">{}{}{}</object></config>",
        volume(0, "ModelPart"),
        volume(12, "NegativeVolume"),
        volume(24, "ParameterModifier")
    );
    let relationships = relationships(START);
    let files = [
        ("_rels/.rels", &*relationships),
        (START, &*text),
        ("Metadata/Slic3r_PE_model.config", &*settings),
    ];
    let contents = read(&zipped(&files, Zipping::Deflated)).unwrap();
    assert_eq!(contents.triangles, triangles[..12]);
    assert_eq!(contents.negative, triangles[12..24]);
    let kinds = contents.parts.iter().map(|part| part.kind);
    assert!(kinds.eq([PartKind::Negative, PartKind::Modifier]));
}

fn read_plate(bytes: &[u8], plate_number: u32) -> Result<Contents, ReadError> {
    let options = ReadOptions {
        plate_number: Some(plate_number),
        ..ReadOptions::default()
    };
    read_with(bytes, &options)
}

#[test]
fn a_plate_of_a_project_is_chosen_by_its_number() {
    let bytes = project();
    let first = read_plate(&bytes, 1).unwrap();
    assert_eq!(first.triangles, read(&bytes).unwrap().triangles);
    let second = read_plate(&bytes, 2).unwrap();
    assert_eq!((second.triangles.len(), second.parts.len()), (24, 0));
    let choice = second.plate.unwrap();
    assert_eq!((choice.plate_number, choice.plates), (2, 2));
    // The third has nothing on it.
    for (bytes, plates) in [(&bytes, 2), (&of(&solids::cube(2.0)), 1)] {
        let error = read_plate(bytes, 3).unwrap_err();
        let plate_number = 3;
        assert_eq!(
            error,
            ReadError::NoPlate {
                plate_number,
                plates
            }
        );
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
        let _ = write!(build, "<item objectid=\"{id}\"/>");
    }
    build += "<item objectid=\"1\" printable=\"0\"/>";
    let contents = read_model("", &resources, &build).unwrap();
    assert_eq!(contents.triangles, [cube.clone(), cube].concat());
    assert_eq!(contents.skipped_objects, 4);
    let options = ReadOptions {
        surfaces: true,
        ..ReadOptions::default()
    };
    let bytes = package(&model("", &resources, &build), &[]);
    let contents = read_with(&bytes, &options).unwrap();
    assert_eq!(contents.triangles.len(), 3 * 12);
    assert_eq!(contents.skipped_objects, 3);
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
