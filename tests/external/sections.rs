//! Sections of layers, against those of trimesh, which does its own reading, cutting and joining.

use std::fs;
use std::process::Command;

use cusp_slicer::contour::{Copies, Lattice, LayerHeights, Polygon, Ring, cut};
use cusp_slicer::progress::{Cancelled, silent};
use glam::Vec3;
use libtest_mimic::{Failed, Trial};

use crate::common::solids::{self, Triangles};
use crate::common::{assert_near, binary_stl, on_plate};
use crate::{Need, python, succeeds, trial};

/// Prints area and length of all outlines of the section at each height.
const SECTIONS: &str = r"
import sys
import trimesh
mesh = trimesh.load(sys.argv[1])
for z in map(float, sys.argv[2:]):
    section = mesh.section(plane_origin=[0, 0, z], plane_normal=[0, 0, 1])
    if section is None:
        print(0.0, 0.0)
        continue
    flat, _ = section.to_2D()
    print(float(flat.area), float(flat.length))
";

pub fn trials() -> Vec<Trial> {
    let needs = &[Need::Python("trimesh, shapely, networkx, scipy, rtree")];
    let name = "sections::sections_are_those_of_trimesh";
    vec![trial(name, needs, sections_are_those_of_trimesh)]
}

/// Solids whose bodies neither touch nor overlap: trimesh makes no union.
fn cases() -> Vec<(&'static str, Triangles)> {
    let mut hollow = solids::sphere(6.0, 5);
    hollow.extend(solids::inverted(&solids::sphere(4.0, 4)));
    hollow.extend(solids::moved(
        &solids::sphere(2.0, 3),
        Vec3::new(1.0, 0.0, 0.0),
    ));
    hollow.extend(solids::moved(
        &solids::cone(3.0, 9.0, 10),
        Vec3::new(9.5, 0.0, -6.0),
    ));
    vec![
        ("ball", solids::sphere(10.0, 6)),
        ("hollow ball, a ball in it and a cone", hollow),
        ("cylinder", solids::cylinder(8.0, 12.0, 32)),
        ("gyroid", solids::gyroid(2, 24)),
    ]
}

fn sections_are_those_of_trimesh() -> Result<(), Failed> {
    for (name, triangles) in cases() {
        let mesh = on_plate(&triangles);
        let posed: Triangles = mesh
            .facets
            .iter()
            .map(|corners| corners.map(|vertex| mesh.vertices[vertex as usize]))
            .collect();
        let folder = tempfile::TempDir::new()?;
        let path = folder.path().join("model.stl");
        fs::write(&path, binary_stl(&posed))?;
        let height_mm = mesh.bounds().size().z;
        // Through no vertex of the solids, where trimesh has another rule.
        let sections = (0..40).map(|i| height_mm * (f64::from(i) + 0.4321) / 40.0);
        let layers: Vec<_> = sections
            .map(|section_mm| LayerHeights {
                bottom_mm: section_mm,
                top_mm: section_mm,
                section_mm,
            })
            .collect();
        let heights = layers.iter().map(|layer| layer.section_mm.to_string());
        let mut command = Command::new(python());
        let output = succeeds(command.args(["-c", SECTIONS]).arg(&path).args(heights))?;
        let theirs = String::from_utf8(output.stdout)?;
        let mut theirs = theirs.lines();
        let step_mm = Lattice::of(&mesh.bounds()).step_mm();
        cut(
            &[Copies::one(&mesh)],
            &layers,
            0.0,
            &mut silent,
            |contours| {
                let rings = || contours.polygons.iter().flat_map(Polygon::rings);
                let area = rings().map(Ring::area).sum::<f64>() * step_mm * step_mm;
                let length = rings().map(Ring::length).sum::<f64>() * step_mm;
                let line = theirs.next().unwrap_or_default();
                let numbers: Vec<f64> = line.split(' ').flat_map(str::parse).collect();
                let z = contours.heights.section_mm;
                assert!(length > 0.0, "{name}: nothing at {z}");
                // Points are rounded to the lattice.
                let points: usize = rings().map(|ring| ring.points.len()).sum();
                let [their_area, their_length] = numbers[..] else {
                    panic!("{name} at {z}: {line}")
                };
                assert_near(area, their_area, length * step_mm);
                assert_near(length, their_length, points as f64 * 2.0 * step_mm);
                Ok::<_, Cancelled>(())
            },
        )?;
    }
    Ok(())
}
