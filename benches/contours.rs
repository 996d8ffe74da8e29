//! Contours of scans: `cargo xtask bench contours MODEL.stl …`.
//!
//! For each model, 60 mm high, and for a ball of 131,072 facets, 10 mm high, in 800 layers: points of all contours, and the times of
//! cutting all layers without a file, into an SVG and into a CLI file, with the default tolerance and without one.

use cusp_slicer::contour::cli::Cli;
use cusp_slicer::contour::svg::Svg;
use cusp_slicer::contour::{Contours, Copies, Heading, Lattice, LayerHeights, Polygon, cut};
use cusp_slicer::model::Mesh;
use cusp_slicer::progress::{Cancelled, silent};

#[path = "common/mod.rs"]
#[expect(dead_code, reason = "other benches use the rest")]
mod common;
#[path = "../tests/common/solids.rs"]
#[expect(dead_code, reason = "the tests use the other solids")]
mod solids;

use common::{balls, named, time};

const LAYERS: usize = 800;

fn main() {
    let ball = balls(1, 1, 7);
    println!(
        "| model | facets | simplified | points | cut (ms) | cut and written as SVG (ms) | SVG (MB) | as CLI (ms) | CLI (MB) |\n\
         |---|---:|---:|---:|---:|---:|---:|---:|---:|"
    );
    for (name, mesh) in named().chain([("ball".to_owned(), ball)]) {
        for simplify_mm in [0.0, 0.005] {
            row(&name, &mesh, simplify_mm);
        }
    }
}

fn row(name: &str, mesh: &Mesh, simplify_mm: f64) {
    let height_mm = mesh.bounds().size().z;
    let plane = |layer: usize| height_mm * layer as f64 / LAYERS as f64;
    let layers: Vec<LayerHeights> = (0..LAYERS)
        .map(|layer| LayerHeights {
            bottom_mm: plane(layer),
            top_mm: plane(layer + 1),
            section_mm: height_mm * (layer as f64 + 0.5) / LAYERS as f64,
        })
        .collect();
    let heading = Heading {
        title: name,
        lattice: Lattice::of(&mesh.bounds()),
        bounds: mesh.bounds(),
        layers: LAYERS,
    };
    let run = |collect: &mut dyn FnMut(&Contours)| {
        cut(
            &[Copies::one(mesh)],
            &layers,
            simplify_mm,
            &mut silent,
            |contours| {
                collect(&contours);
                Ok::<_, Cancelled>(())
            },
        )
        .expect("contours");
    };
    let (cut_s, points) = time(|| {
        let mut points = 0;
        run(&mut |contours| {
            let rings = contours.polygons.iter().flat_map(Polygon::rings);
            points += rings.map(|ring| ring.points.len()).sum::<usize>();
        });
        points
    });
    let (svg_s, svg_bytes) = time(|| {
        let mut svg = Svg::begin(Vec::new(), heading.clone()).expect("an SVG");
        run(&mut |contours| svg.write(contours).expect("a layer"));
        svg.end().expect("an SVG").len()
    });
    let (cli_s, cli_bytes) = time(|| {
        let mut cli = Cli::begin(Vec::new(), heading.clone()).expect("a CLI file");
        run(&mut |contours| cli.write(contours).expect("a layer"));
        cli.end().expect("a CLI file").len()
    });
    let ms = |seconds: f64| format!("{:.0}", seconds * 1000.0);
    println!(
        "| {name} | {} | {simplify_mm} mm | {points} | {} | {} | {:.1} | {} | {:.1} |",
        mesh.surface_facets,
        ms(cut_s),
        ms(svg_s),
        svg_bytes as f64 / 1e6,
        ms(cli_s),
        cli_bytes as f64 / 1e6,
    );
}
