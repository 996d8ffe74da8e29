//! SVG and CLI files, read back by readers that share no code with the writers.

use cusp_slicer::contour::cli::Cli;
use cusp_slicer::contour::svg::Svg;
use cusp_slicer::contour::{Contours, Heading, Lattice, LayerHeights, Polygon, Ring};
use cusp_slicer::grid::Bins;
use cusp_slicer::model::Mesh;
use cusp_slicer::plan::Plan;
use glam::Vec3;

use super::contours_of;
use crate::common::on_plate;
use crate::common::solids::{self, Triangles};

/// Two bodies with a cavity, and part of another in it.
fn solid() -> Triangles {
    let mut solid = solids::sphere(6.0, 4);
    solid.extend(solids::inverted(&solids::sphere(4.0, 4)));
    solid.extend(solids::sphere(2.5, 3));
    solid.extend(solids::moved(
        &solids::cone(2.0, 9.0, 10),
        Vec3::new(9.123, 0.0, -6.0),
    ));
    solid
}

/// A plan of layers that are not equal, and their contours.
fn layers(mesh: &Mesh) -> Vec<Contours> {
    let plan = Plan {
        bins: Bins::of_height(mesh.bounds().size().z, 0.002).unwrap(),
        boundaries: vec![0, 51, 1_000, 3_001, 5_000, 5_999],
        snap_planes: Vec::new(),
        exempt_layers: 0,
    };
    let heights = LayerHeights::of(&plan);
    let sections: Vec<f64> = heights.iter().map(|layer| layer.section_mm).collect();
    let mut layers = contours_of(mesh, &sections, 0.005);
    for (contours, heights) in layers.iter_mut().zip(heights) {
        contours.heights = heights;
    }
    layers
}

fn heading(mesh: &Mesh, layers: usize) -> Heading<'static> {
    Heading {
        title: "A & B, <C>/$",
        lattice: Lattice::of(&mesh.bounds()),
        bounds: mesh.bounds(),
        layers,
    }
}

/// A decimal in millimetres as whole steps of 0.1 µm. It must have no more than four decimals.
fn steps(decimal: &str) -> i32 {
    let (whole, fraction) = decimal.split_once('.').unwrap_or((decimal, ""));
    let digits = format!("{}{fraction:0<4}", whole.trim_start_matches('-'));
    assert!(fraction.len() <= 4, "{decimal}");
    let steps: i32 = digits.parse().unwrap();
    if decimal.starts_with('-') {
        -steps
    } else {
        steps
    }
}

/// The value of an attribute of an element.
fn attribute<'a>(element: &'a str, name: &str) -> &'a str {
    let (_, rest) = element.split_once(&format!(" {name}=\"")).unwrap();
    rest.split_once('"').unwrap().0
}

#[test]
fn an_svg_has_every_layer_with_its_heights_and_points() {
    let mesh = on_plate(&solid());
    let layers = layers(&mesh);
    let mut svg = Svg::begin(Vec::new(), heading(&mesh, layers.len())).unwrap();
    for contours in &layers {
        svg.write(contours).unwrap();
    }
    let text = String::from_utf8(svg.end().unwrap()).unwrap();
    assert!(text.contains("<title>A &amp; B, &lt;C&gt;/$</title>"));
    let head = &text[..text.find("<title>").unwrap()];
    let width: f64 = attribute(head, "width")
        .trim_end_matches("mm")
        .parse()
        .unwrap();
    assert!((width - mesh.bounds().size().x).abs() < 1e-6);
    let view: Vec<f64> = attribute(head, "viewBox")
        .split(' ')
        .map(|number| number.parse().unwrap())
        .collect();
    assert!((view[1] + mesh.bounds().max.y).abs() < 1e-6 && view[2] == width);

    let groups: Vec<&str> = text.split("<g ").skip(1).collect();
    assert_eq!(groups.len(), layers.len());
    for (number, (group, contours)) in groups.iter().zip(&layers).enumerate() {
        let element = format!(" {}", &group[..group.find('>').unwrap()]);
        assert_eq!(attribute(&element, "id"), format!("layer{number}"));
        let height = |name| attribute(&element, name).parse::<f64>().unwrap();
        assert!((height("slic3r:z") - contours.heights.section_mm).abs() < 1e-9);
        assert!((height("data-bottom-mm") - contours.heights.bottom_mm).abs() < 1e-9);
        assert!((height("data-top-mm") - contours.heights.top_mm).abs() < 1e-9);
        assert!(
            attribute(&element, "slic3r:z").len() < 8,
            "digits that are rounding"
        );
        let polygons = group.split("<path ").skip(1).map(|path| {
            let path = format!(" {path}");
            let mut rings = attribute(&path, "d").split('M').skip(1).map(|ring| {
                let points = ring.trim().strip_suffix(" Z").unwrap().split(' ');
                let point = |point: &str| {
                    let (x, y) = point.split_once(',').unwrap();
                    [steps(x), steps(y)]
                };
                Ring {
                    points: points.map(point).collect(),
                }
            });
            Polygon {
                outer: rings.next().unwrap(),
                holes: rings.collect(),
            }
        });
        assert_eq!(polygons.collect::<Vec<_>>(), contours.polygons);
    }
    assert!(text.ends_with("</g>\n</svg>\n"));
}

#[test]
fn a_cli_file_has_every_layer_with_its_thickness_and_points() {
    let mesh = on_plate(&solid());
    let layers = layers(&mesh);
    let mut cli = Cli::begin(Vec::new(), heading(&mesh, layers.len())).unwrap();
    for contours in &layers {
        cli.write(contours).unwrap();
    }
    let text = String::from_utf8(cli.end().unwrap()).unwrap();
    let (head, geometry) = text.split_once("$$HEADEREND\n$$GEOMETRYSTART\n").unwrap();
    let head: Vec<&str> = head.lines().collect();
    assert_eq!(
        head[..5],
        [
            "$$HEADERSTART",
            "$$ASCII",
            "$$UNITS/1",
            "$$VERSION/200",
            "$$LABEL/1,A & B_ <C>__"
        ]
    );
    assert_eq!(head[6], format!("$$LAYERS/{}", layers.len() + 1));
    let box_mm: Vec<f64> = head[5]
        .strip_prefix("$$DIMENSION/")
        .unwrap()
        .split(',')
        .map(|number| number.parse().unwrap())
        .collect();
    let expected = [mesh.bounds().min.to_array(), mesh.bounds().max.to_array()].concat();
    assert!(
        box_mm
            .iter()
            .zip(&expected)
            .all(|(a, b)| (a - b).abs() < 1e-6)
    );

    let mut planes: Vec<f64> = Vec::new();
    let mut rings: Vec<Vec<(bool, Ring)>> = Vec::new();
    let geometry = geometry.strip_suffix("$$GEOMETRYEND\n").unwrap();
    for line in geometry.lines() {
        if let Some(z) = line.strip_prefix("$$LAYER/") {
            planes.push(z.parse().unwrap());
            rings.push(Vec::new());
            continue;
        }
        let fields: Vec<&str> = line
            .strip_prefix("$$POLYLINE/")
            .unwrap()
            .split(',')
            .collect();
        assert_eq!(fields[0], "1");
        let coordinates: Vec<i32> = fields[3..].iter().map(|field| steps(field)).collect();
        let mut points: Vec<[i32; 2]> = coordinates
            .chunks_exact(2)
            .map(|point| [point[0], point[1]])
            .collect();
        assert_eq!(
            (points.len().to_string().as_str(), coordinates.len() % 2),
            (fields[2], 0)
        );
        assert_eq!(points.pop(), Some(points[0]), "not closed");
        rings
            .last_mut()
            .unwrap()
            .push((fields[1] == "1", Ring { points }));
    }
    // The layer at the plate has no contours, and gives the first one its thickness.
    assert!(rings[0].is_empty());
    let expected: Vec<f64> = std::iter::once(0.0)
        .chain(layers.iter().map(|layer| layer.heights.top_mm))
        .collect();
    assert_eq!(planes, expected);
    for (rings, contours) in rings[1..].iter().zip(&layers) {
        let expected: Vec<_> = contours
            .polygons
            .iter()
            .flat_map(|polygon| {
                polygon
                    .rings()
                    .enumerate()
                    .map(|(number, ring)| (number == 0, ring.clone()))
            })
            .collect();
        assert_eq!(*rings, expected);
        assert!(
            rings
                .iter()
                .all(|(is_outer, ring)| *is_outer == (ring.area() > 0.0))
        );
    }
}

#[test]
fn contours_do_not_depend_on_the_order_of_facets() {
    let expected = layers(&on_plate(&solid()));
    assert_eq!(layers(&on_plate(&solids::shuffled(&solid()))), expected);
}
