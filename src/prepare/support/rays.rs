//! Ranges of the print along rays, as a graph: ranges of adjacent rays that overlap are the same piece.

use glam::DVec3;

use crate::argsort::argsort;
use crate::ldi::Ldi;
use crate::model::Winding;
use crate::ways::{AROUND, beside};

/// Gaps that no layer shows.
const CLOSED_MM: f32 = 0.01;

/// A range of a ray in the print.
pub(super) struct Stretch {
    pub ray: usize,
    pub from_mm: f32,
    pub to_mm: f32,
    /// Through which the ray enters: of the model, or of a void.
    pub facet: u32,
}

/// Ranges of all rays in the print.
pub(super) struct Rays<'a> {
    pub ldi: &'a Ldi,
    /// The stretches of ray i are those from `starts[i]` to `starts[i + 1]`.
    starts: Vec<u32>,
    pub stretches: Vec<Stretch>,
}

impl<'a> Rays<'a> {
    pub fn new(ldi: &'a Ldi) -> Self {
        let mut rays = Self {
            ldi,
            starts: vec![0],
            stretches: Vec::new(),
        };
        for ray in 0..ldi.rays() {
            let first = rays.stretches.len();
            let mut winding = Winding::default();
            let mut entry = (0.0, 0);
            for hit in ldi.ray(ray) {
                let was_inside = winding.is_inside();
                winding.pass(ldi.classes.of(hit.facet()), hit.winding());
                match (was_inside, winding.is_inside()) {
                    (false, true) => entry = (hit.z_mm, hit.facet()),
                    (true, false) => match rays.stretches[first..].last_mut() {
                        // Bodies that touch are one.
                        Some(last) if entry.0 <= last.to_mm + CLOSED_MM => last.to_mm = hit.z_mm,
                        _ => rays.stretches.push(Stretch {
                            ray,
                            from_mm: entry.0,
                            to_mm: hit.z_mm,
                            facet: entry.1,
                        }),
                    },
                    _ => {}
                }
            }
            rays.starts.push(rays.stretches.len() as u32);
        }
        rays
    }

    /// Ranges in which there is no print, from a height up.
    pub fn dark(&self, from_mm: f32) -> Self {
        let mut dark = Self {
            ldi: self.ldi,
            starts: vec![0],
            stretches: Vec::new(),
        };
        for ray in 0..self.ldi.rays() {
            let mut from_mm = from_mm;
            let lit = self.of_ray(ray).map(|it| &self.stretches[it]);
            let ends = lit.map(|it| (it.from_mm, it.to_mm, it.facet));
            for (to_mm, next_mm, facet) in ends.chain([(f32::MAX, f32::MAX, 0)]) {
                if from_mm < to_mm {
                    dark.stretches.push(Stretch {
                        ray,
                        from_mm,
                        to_mm,
                        facet,
                    });
                }
                from_mm = next_mm;
            }
            dark.starts.push(dark.stretches.len() as u32);
        }
        dark
    }

    /// The places of a ray's stretches among all.
    #[inline]
    pub fn of_ray(&self, ray: usize) -> std::ops::Range<usize> {
        self.starts[ray] as usize..self.starts[ray + 1] as usize
    }

    /// The ray at an offset in columns and rows; none beyond the grid.
    #[inline]
    pub fn beside(&self, ray: usize, step: [isize; 2]) -> Option<usize> {
        let grid = &self.ldi.grid;
        beside(ray, step, [grid.width as usize, grid.height as usize])
    }

    /// The places of the stretches of the ray at an offset.
    #[inline]
    pub fn near(&self, ray: usize, step: [isize; 2]) -> std::ops::Range<usize> {
        self.beside(ray, step).map_or(0..0, |ray| self.of_ray(ray))
    }

    /// The lower end of a stretch.
    pub fn at(&self, stretch: usize) -> DVec3 {
        let Stretch { ray, from_mm, .. } = self.stretches[stretch];
        let width = self.ldi.grid.width as usize;
        let at = self
            .ldi
            .grid
            .centre_mm((ray % width) as u32, (ray / width) as u32);
        at.extend(f64::from(from_mm))
    }

    /// The stretches from the one that begins lowest up.
    pub fn ascending(&self) -> Vec<usize> {
        argsort(self.stretches.iter().map(|it| f64::from(it.from_mm)))
    }

    /// The stretches of the ray nearest to a point, and of those around it.
    pub fn stretches_at(&self, at: DVec3) -> impl Iterator<Item = usize> {
        let around = AROUND.into_iter().chain([[0, 0]]);
        let middle = self.nearest(at).into_iter();
        let steps = middle.flat_map(move |middle| around.clone().map(move |step| (middle, step)));
        steps.flat_map(|(middle, step)| self.near(middle, step))
    }

    /// The ray nearest to a point; none beyond the grid.
    pub fn nearest(&self, at: DVec3) -> Option<usize> {
        let grid = &self.ldi.grid;
        let pixel = grid.to_pixels(at.truncate());
        let (column, row) = (pixel.x.floor(), pixel.y.floor());
        let is_within = (0.0..f64::from(grid.width)).contains(&column)
            && (0.0..f64::from(grid.height)).contains(&row);
        is_within.then(|| row as usize * grid.width as usize + column as usize)
    }

    /// The stretch whose lower end is nearest to a point, of the rays around it.
    pub fn stretch_at(&self, at: DVec3) -> Option<usize> {
        let stretches = self.stretches_at(at);
        let away_mm = stretches.map(|it| (self.at(it).distance(at), it));
        let nearest = away_mm.reduce(|a, b| if b.0 < a.0 { b } else { a });
        nearest.map(|it| it.1)
    }

    /// Returns true if a point of a ray is in a void of the model.
    pub fn is_void(&self, ray: usize, z_mm: f32) -> bool {
        let mut winding = Winding::default();
        for hit in self.ldi.ray(ray).iter().filter(|hit| hit.z_mm <= z_mm) {
            winding.pass(self.ldi.classes.of(hit.facet()), hit.winding());
        }
        let [_, void, _] = winding.numbers();
        void != 0
    }

    /// Returns true if two stretches of adjacent rays are the same piece.
    #[inline]
    pub fn overlap(&self, a: usize, b: usize) -> bool {
        let (a, b) = (&self.stretches[a], &self.stretches[b]);
        a.from_mm < b.to_mm && b.from_mm < a.to_mm
    }
}
