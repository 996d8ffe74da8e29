//! From the model to the printed surface.
//!
//! Facets are split into triangles of a few pixels, whose middles give the means; vertices are asked as well. No point of a
//! triangle is farther from the printed surface than its farthest corner is from any one point of that surface, so the point
//! nearest to the middle bounds the whole triangle. Where this exceeds neither the greatest distance of all so far by more than
//! [`precision_mm`], nor that of the triangle's layers by more than twice as much, nothing else is asked; elsewhere the
//! triangle is split into four, again and again. Facets that are not on the surface of the
//! solid are left out; so are, where facets meet, the visible parts of a triangle of a few pixels whose middle and
//! corners are hidden.

use glam::DVec3;

use super::deviation::Tally;
use super::hidden::{Meeting, Visibility, is_hidden, meeting};
use super::nearest::{Facets, Triangle};
use super::printed::Printed;
use crate::model::Mesh;
use crate::parallel;
use crate::progress::{Cancelled, Progress};

/// Number of facets or vertices that one thread examines in turn.
const RUN: usize = 64;
/// Means are over the middles of triangles whose corners are within this many pixels of them.
const SAMPLE_PIXELS: f64 = 4.0;

/// Amount by which the greatest distance found may be too small, in millimetres: half a pixel. Those of layers may be
/// too small by twice as much.
pub(super) fn precision_mm(printed: &Printed) -> f64 {
    printed.pitch.min_element() * 0.5
}

/// The tallies of all layers.
pub(super) fn measure(
    mesh: &Mesh,
    facets: &Facets,
    visibility: &[Visibility],
    printed: &Printed,
    progress: &mut Progress<'_>,
    [from, to]: [f64; 2],
) -> Result<Vec<Tally>, Cancelled> {
    let mut tallies = vec![Tally::default(); printed.layers()];
    let at = |part: f64| from + (to - from) * part;
    let mut counts = vec![false; mesh.vertices.len()];
    for (corners, _) in facets_that(mesh, visibility, |it| it == Visibility::Surface) {
        for &vertex in corners {
            counts[vertex as usize] = true;
        }
    }
    let vertices = mesh
        .vertices
        .iter()
        .zip(counts)
        .filter(|(_, counts)| *counts);
    let vertices: Vec<DVec3> = vertices.map(|(vertex, _)| vertex.as_dvec3()).collect();
    let ask = |run: &[DVec3]| {
        let mut hint = None;
        let nearest = |&vertex| {
            let found = printed.nearest(vertex, hint);
            hint = Some(found.point);
            (vertex, found.squared)
        };
        run.iter().map(nearest).collect()
    };
    let mut raise = |found: Vec<(DVec3, f64)>| {
        for (vertex, squared) in found {
            tallies[printed.layer_of(vertex.z)].raise(squared, vertex);
        }
        Ok::<_, Cancelled>(())
    };
    parallel::map_in_groups(
        vertices.chunks(RUN),
        ask,
        &mut raise,
        progress,
        [from, at(0.1)],
    )?;

    // Facets of a run are about as high, so they share layers.
    let mut order: Vec<u32> = facets_that(mesh, visibility, |it| it != Visibility::Hidden)
        .map(|(_, facet)| facet)
        .collect();
    let lowest = |facet: u32| facets.triangles[facet as usize].map(|corner| corner.z);
    order.sort_by(|&a, &b| {
        let [a, b] = [lowest(a), lowest(b)].map(|[p, q, r]| p.min(q).min(r));
        a.total_cmp(&b)
    });
    for (phase, share) in [
        (Phase::Sample, [at(0.1), at(0.4)]),
        (Phase::Search, [at(0.4), to]),
    ] {
        let start = tallies.clone();
        let survey =
            |run: &[u32]| Survey::of(run, phase, (mesh, facets, visibility), printed, &start);
        let mut merge = |survey: Survey<'_>| {
            for (all, found) in tallies[survey.first..].iter_mut().zip(&survey.tallies) {
                all.merge(found);
            }
            Ok::<_, Cancelled>(())
        };
        parallel::map_in_groups(order.chunks(RUN), survey, &mut merge, progress, share)?;
    }
    Ok(tallies)
}

/// The facets are examined twice: the better the greatest distances are known, the less is searched.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Phase {
    /// The middles of small triangles.
    Sample,
    /// The places that may exceed the greatest of these.
    Search,
}

fn facets_that<'a>(
    mesh: &'a Mesh,
    visibility: &'a [Visibility],
    counts: impl Fn(Visibility) -> bool + 'a,
) -> impl Iterator<Item = (&'a [u32; 3], u32)> {
    let facets = mesh.facets.iter().zip(0..).zip(visibility);
    facets.filter_map(move |(facet, &visibility)| counts(visibility).then_some(facet))
}

/// The examination of some facets.
struct Survey<'a> {
    facets: &'a Facets,
    printed: &'a Printed,
    /// The lowest layer of these facets, and the tallies from it to the highest.
    first: usize,
    tallies: Vec<Tally>,
    /// The greatest distance of all layers so far.
    greatest: f64,
    precision: f64,
    sample_radius: f64,
}

impl<'a> Survey<'a> {
    fn of(
        run: &[u32],
        phase: Phase,
        (mesh, facets, visibility): (&Mesh, &'a Facets, &[Visibility]),
        printed: &'a Printed,
        start: &[Tally],
    ) -> Self {
        let heights = run
            .iter()
            .flat_map(|&facet| facets.triangles[facet as usize]);
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), it| {
            (low.min(it.z), high.max(it.z))
        });
        let first = printed.layer_of(low);
        let mut survey = Self {
            facets,
            printed,
            first,
            tallies: start[first..=printed.layer_of(high)]
                .iter()
                .map(Tally::without_mean)
                .collect(),
            greatest: start
                .iter()
                .fold(0.0, |most: f64, tally| most.max(tally.squared))
                .sqrt(),
            precision: precision_mm(printed),
            sample_radius: printed.pitch.min_element() * SAMPLE_PIXELS,
        };
        let mut hint = None;
        for &facet in run {
            // All of a facet that no other meets is on the surface.
            let met = match visibility[facet as usize] {
                Visibility::Mixed => meeting(mesh, facets, facet),
                _ => Vec::new(),
            };
            let cut = Cut { facet, met: &met };
            let triangle = &facets.triangles[facet as usize];
            hint = match phase {
                Phase::Sample => survey.sample(triangle, cut, hint),
                Phase::Search => survey.search(triangle, cut, hint),
            };
        }
        survey
    }

    /// Asks the middles of small parts of a triangle. `cut` is what meets it; `hint` is a point of the printed surface, and a
    /// nearer one is returned.
    fn sample(&mut self, triangle: &Triangle, cut: Cut<'_>, hint: Option<DVec3>) -> Option<DVec3> {
        let (middle, radius) = middle_of(triangle);
        if radius > self.sample_radius {
            let mut hint = hint;
            for part in quarters(triangle) {
                match self.rest(&part, cut) {
                    Rest::Hidden => {}
                    Rest::Shown => hint = self.sample(&part, cut.off(), hint),
                    Rest::Met(met) => hint = self.sample(&part, cut.by(&met), hint),
                }
            }
            return hint;
        }
        // Points inside are far from the surface, and asked in vain.
        if !self.is_shown(middle, cut) {
            return hint;
        }
        let found = self.printed.nearest(middle, hint);
        let [a, b, c] = *triangle;
        let tally = &mut self.tallies[self.printed.layer_of(middle.z) - self.first];
        tally.average(found.squared, (b - a).cross(c - a).length() * 0.5);
        tally.raise(found.squared, middle);
        Some(found.point)
    }

    /// Finds the greatest distance of a triangle by layer, where it is greater than the greatest so far.
    fn search(&mut self, triangle: &Triangle, cut: Cut<'_>, hint: Option<DVec3>) -> Option<DVec3> {
        if let Some(point) = hint
            && self.is_within(triangle, point)
        {
            return hint;
        }
        let (middle, radius) = middle_of(triangle);
        let mut hint = hint;
        if self.is_shown(middle, cut) {
            let found = self.printed.nearest(middle, hint);
            let layer = self.printed.layer_of(middle.z) - self.first;
            self.tallies[layer].raise(found.squared, middle);
            self.greatest = self.greatest.max(found.squared.sqrt());
            hint = Some(found.point);
            if self.is_within(triangle, found.point) {
                return hint;
            }
        } else if radius <= self.sample_radius {
            // Facets may coincide, and then every part of one meets the other.
            let inward = triangle.map(|corner| corner + (middle - corner) * 0.1);
            if inward.iter().all(|&point| !self.is_shown(point, cut)) {
                return hint;
            }
        }
        if radius > self.precision {
            for part in quarters(triangle) {
                match self.rest(&part, cut) {
                    Rest::Hidden => {}
                    Rest::Shown => _ = self.search(&part, cut.off(), hint),
                    Rest::Met(met) => _ = self.search(&part, cut.by(&met), hint),
                }
            }
        }
        hint
    }

    /// The facets that still meet a part of a triangle; if there are none, one point decides whether the part is
    /// hidden.
    fn rest(&self, part: &Triangle, cut: Cut<'_>) -> Rest {
        if cut.met.is_empty() {
            return Rest::Shown;
        }
        let met = cut.met.iter().copied();
        let met: Vec<Meeting> = met.filter(|it| it.meets(self.facets, part)).collect();
        if !met.is_empty() {
            Rest::Met(met)
        } else if is_hidden(self.facets, cut.facet, middle_of(part).0) {
            Rest::Hidden
        } else {
            Rest::Shown
        }
    }

    /// Returns true if a point is on the surface of the solid.
    fn is_shown(&self, point: DVec3, cut: Cut<'_>) -> bool {
        cut.met.is_empty() || !is_hidden(self.facets, cut.facet, point)
    }

    /// Returns true if no corner is farther from a point of the printed surface than the greatest distances so far, except for the
    /// precision.
    fn is_within(&self, triangle: &Triangle, point: DVec3) -> bool {
        let bound = triangle.map(|corner| corner.distance_squared(point));
        let bound = bound[0].max(bound[1]).max(bound[2]).sqrt();
        if bound > self.greatest + self.precision {
            return false;
        }
        let bound = bound - 2.0 * self.precision;
        if bound <= 0.0 {
            return true;
        }
        let heights = triangle.map(|corner| corner.z);
        let low = heights[0].min(heights[1]).min(heights[2]);
        let high = heights[0].max(heights[1]).max(heights[2]);
        let layers = self.printed.layer_of(low)..=self.printed.layer_of(high);
        let mut layers = layers.map(|layer| &self.tallies[layer - self.first]);
        layers.all(|tally| bound * bound <= tally.squared)
    }
}

/// A facet, and what meets the part of it that is examined.
#[derive(Clone, Copy)]
struct Cut<'a> {
    facet: u32,
    met: &'a [Meeting],
}

impl Cut<'_> {
    /// A part of the same facet that these meet.
    fn by(self, met: &[Meeting]) -> Cut<'_> {
        Cut { met, ..self }
    }

    /// A part of the same facet that nothing meets.
    fn off(self) -> Self {
        Cut { met: &[], ..self }
    }
}

/// Facets that meet a part of a facet.
enum Rest {
    /// Nothing: it is on the surface.
    Shown,
    /// Nothing: it is inside the solid.
    Hidden,
    /// Facets that meet it; parts of it may be hidden.
    Met(Vec<Meeting>),
}

/// The middle of a triangle, and how far the farthest corner is from it.
fn middle_of(&[a, b, c]: &Triangle) -> (DVec3, f64) {
    let middle = (a + b + c) / 3.0;
    let squared = [a, b, c].map(|corner| corner.distance_squared(middle));
    (middle, squared[0].max(squared[1]).max(squared[2]).sqrt())
}

/// A triangle in four, by the middles of its edges.
fn quarters(&[a, b, c]: &Triangle) -> [Triangle; 4] {
    let (ab, bc, ca) = ((a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5);
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
}
