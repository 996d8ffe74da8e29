//! Time of reading a model of a million facets, as STL, OBJ and 3MF, and of making its mesh: `cargo xtask bench read
//! [FILE …]`.
//!
//! With `--write FOLDER` it writes the three files instead, for other programs and for the browser.

#[path = "../tests/common/solids.rs"]
#[expect(dead_code, reason = "the tests use the solids; here only one")]
mod solids;

use std::fmt::Write as _;
use std::io::{Cursor, Write as _};
use std::path::Path;
use std::time::Instant;

use cusp_slicer::model::Mesh;
use cusp_slicer::model::read::read;
use glam::Vec3;
use zip::write::SimpleFileOptions;

const ROUNDS: usize = 5;

/// A torus of 2 · 1024 · 512 facets.
fn torus() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    const AROUND: u32 = 1024;
    const ACROSS: u32 = 512;
    let at = |i: u32, of: u32| std::f64::consts::TAU * f64::from(i) / f64::from(of);
    let mut vertices = Vec::new();
    let mut facets = Vec::new();
    for i in 0..AROUND {
        for j in 0..ACROSS {
            let (a, b) = (at(i, AROUND), at(j, ACROSS));
            let radius = 30.0 + 10.0 * b.cos();
            let z = 10.0 * b.sin();
            vertices.push(glam::DVec3::new(radius * a.cos(), radius * a.sin(), z).as_vec3());
            let place = |i: u32, j: u32| (i % AROUND) * ACROSS + j % ACROSS;
            let [p, q, r, s] = [
                place(i, j),
                place(i + 1, j),
                place(i + 1, j + 1),
                place(i, j + 1),
            ];
            facets.extend([[p, q, r], [p, r, s]]);
        }
    }
    (vertices, facets)
}

fn obj(vertices: &[Vec3], facets: &[[u32; 3]]) -> Vec<u8> {
    let mut text = String::new();
    for Vec3 { x, y, z } in vertices {
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    for facet in facets {
        let [a, b, c] = facet.map(|corner| corner + 1);
        let _ = writeln!(text, "f {a} {b} {c}");
    }
    text.into_bytes()
}

fn threemf(vertices: &[Vec3], facets: &[[u32; 3]]) -> Vec<u8> {
    let mut text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" \
        xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n<resources>\n<object id=\"1\">\n<mesh>\n<vertices>\n"
        .to_owned();
    for Vec3 { x, y, z } in vertices {
        let _ = writeln!(text, "<vertex x=\"{x}\" y=\"{y}\" z=\"{z}\"/>");
    }
    text += "</vertices>\n<triangles>\n";
    for [a, b, c] in facets {
        let _ = writeln!(text, "<triangle v1=\"{a}\" v2=\"{b}\" v3=\"{c}\"/>");
    }
    text += "</triangles>\n</mesh>\n</object>\n</resources>\n<build>\n<item objectid=\"1\"/>\n</build>\n</model>\n";
    let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default();
    zip.start_file("3D/3dmodel.model", options).expect("a zip");
    zip.write_all(text.as_bytes()).expect("a zip");
    zip.finish().expect("a zip").into_inner()
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn measure(name: &str, bytes: &[u8]) {
    let (mut reading, mut all) = (Vec::new(), Vec::new());
    let mut facets = 0;
    for _ in 0..ROUNDS {
        let clock = Instant::now();
        let contents = read(bytes).expect("a model");
        reading.push(clock.elapsed().as_secs_f64());
        facets = Mesh::from_triangles(&contents.triangles)
            .expect("a mesh")
            .surface_facets;
        all.push(clock.elapsed().as_secs_f64());
    }
    println!(
        "| {name} | {facets} | {:.1} MB | {:.2} s | {:.2} s |",
        bytes.len() as f64 / 1e6,
        median(reading),
        median(all)
    );
}

fn main() {
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|it| it != "--bench")
        .collect();
    let (vertices, facets) = torus();
    let triangles: Vec<_> = facets
        .iter()
        .map(|it| it.map(|corner| vertices[corner as usize]))
        .collect();
    let files = [
        ("torus.stl", solids::binary_stl(&triangles)),
        ("torus.obj", obj(&vertices, &facets)),
        ("torus.3mf", threemf(&vertices, &facets)),
    ];
    if let [write, folder] = &*arguments
        && write == "--write"
    {
        for (name, bytes) in files {
            std::fs::write(Path::new(folder).join(name), bytes).expect("a file");
        }
        return;
    }
    println!("| model | facets | size | read | with the mesh |\n|---|---:|---:|---:|---:|");
    for (name, bytes) in files {
        measure(name, &bytes);
    }
    for path in arguments {
        measure(&path, &std::fs::read(&path).expect("a file"));
    }
}
