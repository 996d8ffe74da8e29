//! Spatial index over the facets of a model's surface.

use glam::{DVec2, DVec3, Vec3};

use crate::model::Mesh;

/// The facets of a model's surface, by squares.
pub(super) struct Surface<'a> {
    pub mesh: &'a Mesh,
    squares: Squares,
    facets: Vec<Vec<u32>>,
}

impl<'a> Surface<'a> {
    pub fn new(mesh: &'a Mesh) -> Self {
        let squares = Squares::below(mesh);
        let mut facets = vec![Vec::new(); squares.count()];
        for facet in 0..mesh.surface_facets {
            let [a, b, c] = mesh.corners(facet);
            for square in squares.within(a.min(b).min(c), a.max(b).max(c)) {
                facets[square].push(facet as u32);
            }
        }
        Self {
            mesh,
            squares,
            facets,
        }
    }

    /// The facets within a distance of a point, and how far away each is, with its nearest point. A facet may come twice.
    #[inline]
    pub fn within(&self, point: DVec3, reach_mm: f64) -> Vec<(f64, DVec3, u32)> {
        let reach = DVec3::splat(reach_mm);
        let squares = self.squares.within(point - reach, point + reach);
        let facets = squares.flat_map(|square| self.facets[square].iter().copied());
        let found = facets.filter_map(|facet| {
            let [a, b, c] = self.mesh.corners(facet as usize);
            let (low, high) = (a.min(b).min(c) - reach, a.max(b).max(c) + reach);
            if !(low.cmple(point).all() && point.cmple(high).all()) {
                return None;
            }
            let at = nearest_of([a, b, c], point);
            let away_mm = at.distance(point);
            (away_mm <= reach_mm).then_some((away_mm, at, facet))
        });
        found.collect()
    }
}

/// The squares of the plane below a mesh.
pub(super) struct Squares {
    corner: DVec2,
    columns: usize,
    rows: usize,
}

/// Side of a square.
const SQUARE_MM: f64 = 2.0;

impl Squares {
    pub fn below(mesh: &Mesh) -> Self {
        let bounds = mesh.bounds();
        let squares = (bounds.size().truncate() / SQUARE_MM).to_array();
        let [columns, rows] = squares.map(|squares| squares as usize + 1);
        Self {
            corner: bounds.min.truncate(),
            columns,
            rows,
        }
    }

    pub fn count(&self) -> usize {
        self.columns * self.rows
    }

    /// The squares that a box meets, or the nearest ones.
    #[inline]
    pub fn within(&self, low: DVec3, high: DVec3) -> impl Iterator<Item = usize> + use<> {
        let place = |at: DVec3| (at.truncate() - self.corner) / SQUARE_MM;
        let (low, high) = (place(low), place(high));
        let within = |place: f64, count: usize| place.clamp(0.0, (count - 1) as f64) as usize;
        let columns = within(low.x, self.columns)..=within(high.x, self.columns);
        let rows = within(low.y, self.rows)..=within(high.y, self.rows);
        let width = self.columns;
        rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }
}

/// The point of a triangle that is nearest to a point.
fn nearest_of([a, b, c]: [DVec3; 3], point: DVec3) -> DVec3 {
    let normal = (b - a).cross(c - a);
    let is_over = |from: DVec3, to: DVec3| normal.cross(to - from).dot(point - from) >= 0.0;
    if is_over(a, b) && is_over(b, c) && is_over(c, a) {
        let away = normal.dot(point - a) / normal.dot(normal);
        return point - normal * away;
    }
    let of_edge = |from: DVec3, to: DVec3| {
        let edge = to - from;
        let part = edge.dot(point - from) / edge.dot(edge);
        from + edge * part.clamp(0.0, 1.0)
    };
    let ends = [of_edge(a, b), of_edge(b, c), of_edge(c, a)];
    let nearer = |best: DVec3, it: DVec3| {
        if it.distance(point) < best.distance(point) {
            it
        } else {
            best
        }
    };
    ends.into_iter().reduce(nearer).unwrap_or(a)
}

/// Facets that weigh more than this are protected, if weights say where nothing may touch.
const PROTECTED: f32 = 0.5;

/// Returns true if a facet is protected.
pub(super) fn is_protected(weights: Option<&[f32]>, facet: u32) -> bool {
    let weight = weights.and_then(|it| it.get(facet as usize));
    weight.is_some_and(|&weight| weight > PROTECTED)
}

/// Tells whether a facet within a distance of a point is protected.
pub(super) fn protected_within<'a>(
    mesh: &'a Mesh,
    weights: Option<&'a [f32]>,
    reach_mm: f64,
) -> impl Fn(Vec3) -> bool + 'a {
    let surface = weights.map(|_| Surface::new(mesh));
    move |at| {
        surface.as_ref().is_some_and(|surface| {
            let mut near = surface.within(at.as_dvec3(), reach_mm).into_iter();
            near.any(|it| is_protected(weights, it.2))
        })
    }
}
