//! Renders models from the front, facet by facet in a given colour, side by side in one PNG.

use glam::{DVec3, Vec3};

use crate::png_file;

/// Height of a model in pixels.
const HEIGHT: usize = 340;
/// Pixels around each model.
const MARGIN: usize = 14;

/// A colour, red, green and blue from 0 to 1.
pub type Colour = [f64; 3];

/// Draws models side by side.
pub struct Picture {
    width: usize,
    pixels: Vec<[u8; 3]>,
    columns: usize,
    panel: usize,
}

impl Picture {
    /// A picture with room for `panels` models of this size.
    pub fn new(panels: usize, size: DVec3) -> Self {
        let panel = (size.x / size.z * HEIGHT as f64) as usize + 2 * MARGIN;
        let width = panel * panels;
        Self {
            width,
            pixels: vec![[255; 3]; width * (HEIGHT + 2 * MARGIN)],
            columns: 0,
            panel,
        }
    }

    /// Adds a model seen from the front, along y, lit from the upper left. `colour` takes a facet and a height as a fraction of
    /// the model's.
    pub fn add(&mut self, facets: &[[Vec3; 3]], colour: impl Fn(usize, f64) -> Colour) {
        let all = || facets.iter().flatten().map(|corner| corner.as_dvec3());
        let min = all().fold(DVec3::INFINITY, DVec3::min);
        let max = all().fold(DVec3::NEG_INFINITY, DVec3::max);
        let scale = HEIGHT as f64 / (max.z - min.z);
        let left = (self.columns * self.panel + MARGIN) as f64;
        let place = |corner: Vec3| {
            let corner = corner.as_dvec3();
            let x = left + (corner.x - min.x) * scale;
            let y = MARGIN as f64 + (max.z - corner.z) * scale;
            DVec3::new(x, y, corner.y)
        };
        let mut depths = vec![f64::INFINITY; self.pixels.len()];
        for (index, facet) in facets.iter().enumerate() {
            let [a, b, c] = facet.map(Vec3::as_dvec3);
            let normal = (b - a).cross(c - a).normalize_or_zero();
            let light = 0.55 + 0.45 * normal.dot(DVec3::new(-0.4, -0.75, 0.53)).max(0.0);
            let [a, b, c] = facet.map(place);
            let area = (b - a).truncate().perp_dot((c - a).truncate());
            if area.abs() < 1e-9 {
                continue;
            }
            let low = a.min(b).min(c).floor();
            let high = a.max(b).max(c).ceil();
            for y in low.y.max(0.0) as usize..=high.y as usize {
                for x in low.x.max(0.0) as usize..=high.x as usize {
                    let point = glam::DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                    let part = |p: DVec3, q: DVec3| {
                        (p.truncate() - point).perp_dot(q.truncate() - point) / area
                    };
                    let [u, v, w] = [part(b, c), part(c, a), part(a, b)];
                    let pixel = y * self.width + x;
                    if u < 0.0
                        || v < 0.0
                        || w < 0.0
                        || pixel >= self.pixels.len()
                        || x >= self.width
                    {
                        continue;
                    }
                    let depth = u * a.z + v * b.z + w * c.z;
                    if depth < depths[pixel] {
                        depths[pixel] = depth;
                        let height = 1.0 - (point.y - MARGIN as f64) / HEIGHT as f64;
                        self.pixels[pixel] = colour(index, height.clamp(0.0, 1.0))
                            .map(|part| (255.0 * (part * light).clamp(0.0, 1.0)) as u8);
                    }
                }
            }
        }
        self.columns += 1;
    }

    /// The picture as a PNG.
    pub fn png(&self) -> Vec<u8> {
        png_file::encoded(self.width, &self.pixels)
    }
}
