//! A direct slicer, like the one the paper compares with: it intersects the mesh with every plane and joins the segments into
//! contours.

use std::collections::HashMap;

use cusp_slicer::model::Mesh;
use glam::DVec2;

/// Facets sorted by their lowest corner, so that a plane visits only those it can cut.
pub struct DirectSlicer<'a> {
    mesh: &'a Mesh,
    /// Lowest and highest z of each facet with its index, argsort.
    facets: Vec<(f32, f32, u32)>,
    /// Extent in z of the tallest facet.
    tallest: f32,
}

/// The contours at a height, and the slope of the surface that they lie on.
pub struct Section {
    /// Closed contours.
    pub contours: Vec<Vec<DVec2>>,
    /// The largest |`n_z`| along them.
    pub steepest: f64,
}

impl<'a> DirectSlicer<'a> {
    pub fn new(mesh: &'a Mesh) -> Self {
        let mut facets: Vec<(f32, f32, u32)> = (0..mesh.surface_facets as u32)
            .map(|facet| {
                let z = mesh.facets[facet as usize].map(|vertex| mesh.vertices[vertex as usize].z);
                (z[0].min(z[1]).min(z[2]), z[0].max(z[1]).max(z[2]), facet)
            })
            .collect();
        facets.sort_by(|a, b| a.0.total_cmp(&b.0));
        let tallest = facets
            .iter()
            .map(|facet| facet.1 - facet.0)
            .fold(0.0, f32::max);
        Self {
            mesh,
            facets,
            tallest,
        }
    }

    /// Cuts the mesh at a height.
    pub fn cut(&self, z: f32) -> Section {
        let first = self
            .facets
            .partition_point(|facet| facet.0 < z - self.tallest);
        // A segment of a contour runs from one edge of the mesh to another; an edge is identified by its vertices.
        let mut next: HashMap<(u32, u32), ((u32, u32), DVec2)> = HashMap::new();
        let mut steepest = 0.0f64;
        for &(low, high, facet) in &self.facets[first..] {
            if low >= z {
                break;
            }
            if high < z {
                continue;
            }
            let corners = self.mesh.facets[facet as usize];
            let above = corners.map(|vertex| self.mesh.vertices[vertex as usize].z >= z);
            let mut ends = [None; 2];
            for i in 0..3 {
                let (a, b) = (corners[i], corners[(i + 1) % 3]);
                if above[i] == above[(i + 1) % 3] {
                    continue;
                }
                let [p, q] = [a.min(b), a.max(b)]
                    .map(|vertex| self.mesh.vertices[vertex as usize].as_dvec3());
                let point = p + (q - p) * ((f64::from(z) - p.z) / (q.z - p.z));
                ends[usize::from(above[i])] = Some(((a.min(b), a.max(b)), point.truncate()));
            }
            if let [Some(up), Some(down)] = ends {
                next.insert(up.0, (down.0, up.1));
                steepest = steepest.max(f64::from(self.mesh.n_z_squared(facet as usize)));
            }
        }
        let mut contours = Vec::new();
        while let Some(&start) = next.keys().next() {
            let mut contour = Vec::new();
            let mut edge = start;
            while let Some((following, point)) = next.remove(&edge) {
                contour.push(point);
                edge = following;
            }
            contours.push(contour);
        }
        Section {
            contours,
            steepest: steepest.sqrt(),
        }
    }

    /// Uniform layers: returns their number and the number of contour points.
    pub fn uniform(&self, height: f32, layer: f32) -> (usize, usize) {
        let layers = (height / layer).round() as usize;
        let points = (0..layers).map(|k| self.points((k as f32 + 0.5) * layer));
        (layers, points.sum())
    }

    /// The greedy method of \[3\]: each layer is as thick as the largest |`n_z`| at its plane allows.
    pub fn local(
        &self,
        height: f32,
        [least, greatest]: [f32; 2],
        tolerance: f64,
    ) -> (usize, usize) {
        let (mut z, mut layers, mut points) = (0.0, 0, 0);
        while z < height {
            let section = self.cut(z.max(1e-4));
            points += section.contours.iter().map(Vec::len).sum::<usize>();
            let allowed = (tolerance / section.steepest.max(1e-9)) as f32;
            z += allowed.clamp(least, greatest);
            layers += 1;
        }
        (layers, points)
    }

    fn points(&self, z: f32) -> usize {
        self.cut(z).contours.iter().map(Vec::len).sum()
    }
}
