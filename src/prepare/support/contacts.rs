//! Contacts: a model needs supports at its lowest points, and on surfaces that are too flat to support themselves.

use glam::DVec3;

use super::super::surface::{self, Squares, Surface};
use super::SupportProfile;
use crate::argsort::sort_by_number;
use crate::ldi::Ldi;
use crate::model::{Across, Mesh};
use crate::union_find;

/// A place on the surface that needs a support.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Contact {
    pub at: DVec3,
    /// The outward normal of the surface there, of length 1.
    pub normal: DVec3,
    /// Diameter of the tip.
    pub diameter_mm: f64,
    /// The facet that is nearest.
    pub facet: u32,
}

/// Inputs that decide where contacts go, besides the model.
pub(super) struct Wishes<'a> {
    pub profile: &'a SupportProfile,
    /// Contacts that are there already.
    pub given: &'a [Contact],
    /// Weights of the facets; those that are protected get no contact.
    pub weights: Option<&'a [f32]>,
}

/// Greatest height above the plate at which a surface stands on it.
const ON_PLATE_MM: f64 = 0.02;

/// Distance at which one tip holds two lowest points, in contact diameters.
const SAME: f64 = 0.5;

/// Radius that a contact holds around a lone entry (see `lone_entries`), in spacings: half of that on a level surface.
const LONE: f64 = 0.5;

/// Places new contacts: those that hold the model together with the given ones, and those that it would need on protected
/// facets. Both ascend, which is the order in which they are printed.
pub(super) fn place(
    model: &Surface<'_>,
    ldi: &Ldi,
    wishes: &Wishes<'_>,
) -> (Vec<Contact>, Vec<Contact>) {
    let (mesh, profile) = (model.mesh, wishes.profile);
    let mut held = Held::new(mesh);
    for contact in wishes.given {
        held.insert(contact.at);
    }
    let (mut contacts, mut missed) = (Vec::new(), Vec::new());
    let stands = |at: DVec3| profile.lift_mm + at.z <= ON_PLATE_MM;
    let is_protected = |facet: u32| surface::is_protected(wishes.weights, facet);
    let same_mm = SAME * profile.contact_mm;
    let contact = |at: DVec3| model.contact(at, profile.contact_mm, profile.contact_mm);
    let rays = Rays::new(ldi);
    let lowest = lowest_points(mesh, ldi, same_mm).into_iter();
    let lowest = lowest.map(|at| (at, same_mm));
    let lone_mm = LONE * profile.spacing_mm;
    let lone = lone_entries(&rays).into_iter().map(|at| (at, lone_mm));
    for (at, same_mm) in lowest.chain(lone) {
        if stands(at) || held.is_near(at, same_mm) {
            continue;
        }
        match contact(at) {
            // Facets nearby may still get contacts.
            Some(it) if is_protected(it.facet) => missed.push(it),
            found => {
                held.insert(at);
                contacts.extend(found);
            }
        }
    }
    let mut places = overhangs(mesh, &rays, profile);
    sort_by_number(&mut places, |place| micrometres(place.at.z));
    // Edges come after the rest. Spared facets come last, and so show what stays without support.
    for (protected, is_edge) in [(false, false), (false, true), (true, false), (true, true)] {
        let these =
            |place: &&Place| place.is_edge == is_edge && is_protected(place.facet) == protected;
        for place in places.iter().filter(these) {
            if held.is_near(place.at, profile.reach_mm(place.slope)) {
                continue;
            }
            held.insert(place.at);
            // The plate holds what stands on it.
            if !stands(place.at) {
                let to = if protected {
                    &mut missed
                } else {
                    &mut contacts
                };
                to.extend(contact(place.at));
            }
        }
    }
    (contacts, missed)
}

/// Points that are held, by squares.
struct Held {
    squares: Squares,
    points: Vec<Vec<DVec3>>,
}

impl Held {
    fn new(mesh: &Mesh) -> Self {
        let squares = Squares::below(mesh);
        Self {
            points: vec![Vec::new(); squares.count()],
            squares,
        }
    }

    #[inline]
    fn insert(&mut self, at: DVec3) {
        for square in self.squares.within(at, at) {
            self.points[square].push(at);
        }
    }

    fn is_near(&self, at: DVec3, reach_mm: f64) -> bool {
        let reach = DVec3::splat(reach_mm);
        let mut squares = self.squares.within(at - reach, at + reach);
        squares.any(|square| {
            let mut points = self.points[square].iter();
            points.any(|it| it.distance(at) < reach_mm)
        })
    }
}

/// The lowest points of the solid: each is where an island begins. Ascending.
///
/// The lowest vertices of level edges and facets are one point, the one nearest to their middle.
fn lowest_points(mesh: &Mesh, ldi: &Ldi, inward_mm: f64) -> Vec<DVec3> {
    let facets = &mesh.facets[..mesh.classes.surface_end()];
    let roots = level_groups(mesh, facets);
    let at = |corner: usize| mesh.vertices[facets[corner / 3][corner % 3] as usize].as_dvec3();
    let mut is_lowest = vec![true; roots.len()];
    let mut normals = vec![DVec3::ZERO; roots.len()];
    // The box around each group.
    let mut boxes = vec![[DVec3::INFINITY, DVec3::NEG_INFINITY]; roots.len()];
    for facet in 0..facets.len() {
        let [a, b, c] = mesh.corners(facet);
        let lowest = a.z.min(b.z).min(c.z);
        let normal = (b - a).cross(c - a);
        for (&root, at) in roots[3 * facet..].iter().zip([a, b, c]) {
            let root = root as usize;
            is_lowest[root] &= at.z <= lowest;
            normals[root] += normal;
            let [low, high] = &mut boxes[root];
            (*low, *high) = (low.min(at), high.max(at));
        }
    }
    let middle = |root: usize| (boxes[root][0] + boxes[root][1]) * 0.5;
    let mut nearest: Vec<Option<(f64, usize)>> = vec![None; roots.len()];
    for (corner, &root) in roots.iter().enumerate() {
        let root = root as usize;
        // Walls of cavities face up at their lowest points.
        if !is_lowest[root] || normals[root].z >= 0.0 {
            continue;
        }
        let here = at(corner);
        let away_mm = middle(root).distance(here);
        // The same vertex in any order of facets.
        let is_nearer = |(least_mm, other): (f64, usize)| {
            let other = at(other);
            let ties = here.x.total_cmp(&other.x).then(here.y.total_cmp(&other.y));
            away_mm.total_cmp(&least_mm).then(ties).is_lt()
        };
        if nearest[root].is_none_or(is_nearer) {
            nearest[root] = Some((away_mm, corner));
        }
    }
    let found = nearest.iter().enumerate();
    let found = found.filter_map(|(root, nearest)| Some((root, (*nearest)?)));
    let found = found.map(|(root, (away_mm, corner))| {
        let vertex = at(corner);
        // From the edge of a level facet inward.
        let part = if away_mm > inward_mm {
            inward_mm / away_mm
        } else {
            1.0
        };
        vertex + (middle(root) - vertex) * part
    });
    let mut points: Vec<DVec3> = found.filter(|at| !is_buried(ldi, *at)).collect();
    // In the same order for any order of facets.
    sort_by_number(&mut points, |at| at.y);
    sort_by_number(&mut points, |at| at.x);
    sort_by_number(&mut points, |at| at.z);
    points
}

/// No corner.
const NO_CORNER: usize = usize::MAX;

/// For each corner of the facets, the group that it is in: corners of a vertex that lie side by side around it, with those of all vertices
/// that level edges join. Where sheets meet in a vertex alone, its corners are in several groups.
fn level_groups(mesh: &Mesh, facets: &[[u32; 3]]) -> Vec<u32> {
    let mut parent: Vec<u32> = (0..3 * facets.len() as u32).collect();
    let mut unite = |a: usize, b: usize| union_find::unite(&mut parent, a as u32, b as u32);
    // A corner of each vertex whose edges do not identify the adjacent facet.
    let mut whole = vec![NO_CORNER; mesh.vertices.len()];
    for (facet, corners) in facets.iter().enumerate() {
        for edge in 0..3 {
            let next = (edge + 1) % 3;
            let ends = [corners[edge], corners[next]];
            let [a, b] = ends.map(|vertex| mesh.vertices[vertex as usize].z);
            if a == b {
                unite(3 * facet + edge, 3 * facet + next);
            }
            match mesh.neighbours.across(facet, edge) {
                Across::Facet(other) => {
                    let other = other as usize;
                    for (place, vertex) in [(edge, ends[0]), (next, ends[1])] {
                        if let Some(there) = facets[other].iter().position(|&it| it == vertex) {
                            unite(3 * facet + place, 3 * other + there);
                        }
                    }
                }
                Across::Nothing | Across::Several => {
                    whole[ends[0] as usize] = 3 * facet + edge;
                    whole[ends[1] as usize] = 3 * facet + next;
                }
            }
        }
    }
    for (corner, &vertex) in facets.iter().flatten().enumerate() {
        let other = whole[vertex as usize];
        if other != NO_CORNER {
            unite(corner, other);
        }
    }
    (0..3 * facets.len() as u32)
        .map(|corner| union_find::find(&mut parent, corner))
        .collect()
}

/// Returns true if a body of the model goes on below a point, along the nearest ray.
fn is_buried(ldi: &Ldi, at: DVec3) -> bool {
    let pixel = ldi.grid.to_pixels(at.truncate());
    let (column, row) = (pixel.x.floor(), pixel.y.floor());
    let (width, height) = (f64::from(ldi.grid.width), f64::from(ldi.grid.height));
    if !((0.0..width).contains(&column) && (0.0..height).contains(&row)) {
        return false;
    }
    let ray = ldi.ray(row as usize * ldi.grid.width as usize + column as usize);
    let mut is_buried = false;
    crate::ldi::model_ranges(ray, ldi.classes, |from_mm, to_mm| {
        let below_mm = at.z - ldi.grid.pitch_mm;
        is_buried |= f64::from(from_mm) < below_mm && below_mm < f64::from(to_mm);
    });
    is_buried
}

/// A place on a surface that does not support itself.
#[derive(Clone)]
struct Place {
    at: DVec3,
    facet: u32,
    /// Rise over run.
    slope: f64,
    /// True if a tip there would reach beyond the surface.
    is_edge: bool,
}

/// A stretch of a ray in the model.
struct Stretch {
    from_mm: f32,
    to_mm: f32,
    /// Through which the ray enters.
    facet: u32,
}

/// Stretches of the rays in the model.
struct Rays<'a> {
    ldi: &'a Ldi,
    /// The stretches of ray i are those from `starts[i]` to `starts[i + 1]`.
    starts: Vec<usize>,
    stretches: Vec<Stretch>,
}

impl<'a> Rays<'a> {
    fn new(ldi: &'a Ldi) -> Self {
        let end = ldi.classes.model_end();
        let mut rays = Self {
            ldi,
            starts: vec![0],
            stretches: Vec::new(),
        };
        for ray in 0..ldi.rays() {
            let first = rays.stretches.len();
            let mut winding = 0;
            let mut entry = (0.0, 0);
            for hit in ldi.ray(ray).iter().filter(|hit| hit.facet() < end) {
                let was_inside = winding != 0;
                winding += hit.winding();
                match (was_inside, winding != 0) {
                    (false, true) => entry = (hit.z_mm, hit.facet()),
                    (true, false) => match rays.stretches[first..].last_mut() {
                        // Bodies that touch are one.
                        Some(last) if entry.0 <= last.to_mm => last.to_mm = hit.z_mm,
                        _ => rays.stretches.push(Stretch {
                            from_mm: entry.0,
                            to_mm: hit.z_mm,
                            facet: entry.1,
                        }),
                    },
                    _ => {}
                }
            }
            rays.starts.push(rays.stretches.len());
        }
        rays
    }

    #[inline]
    fn of_ray(&self, ray: usize) -> &[Stretch] {
        &self.stretches[self.starts[ray]..self.starts[ray + 1]]
    }

    /// The stretches of the ray at an offset in columns and rows; none beyond the grid.
    fn beside(&self, [column, row]: [usize; 2], [dx, dy]: [isize; 2]) -> &[Stretch] {
        let (width, height) = (self.ldi.grid.width as usize, self.ldi.grid.height as usize);
        match (column.checked_add_signed(dx), row.checked_add_signed(dy)) {
            (Some(x), Some(y)) if x < width && y < height => self.of_ray(y * width + x),
            _ => &[],
        }
    }

    fn each(&self) -> impl Iterator<Item = ([usize; 2], DVec3, &Stretch)> {
        let width = self.ldi.grid.width as usize;
        (0..self.ldi.rays()).flat_map(move |ray| {
            let [column, row] = [ray % width, ray / width];
            let at = self.ldi.grid.centre_mm(column as u32, row as u32);
            let stretches = self.of_ray(ray).iter();
            stretches.map(move |it| ([column, row], at.extend(f64::from(it.from_mm)), it))
        })
    }
}

/// Points where a ray enters the model while no adjacent ray is inside it: only facets closer together than rays
/// connect such a feature to the rest.
fn lone_entries(rays: &Rays<'_>) -> Vec<DVec3> {
    let around = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| [dx, dy]));
    let around: Vec<[isize; 2]> = around.filter(|&it| it != [0, 0]).collect();
    let lone = rays.each().filter(|(place, _, stretch)| {
        let z_mm = stretch.from_mm;
        let meets = |it: &Stretch| it.from_mm <= z_mm && z_mm < it.to_mm;
        !around
            .iter()
            .any(|&step| rays.beside(*place, step).iter().any(meets))
    });
    let mut lone: Vec<DVec3> = lone.map(|it| it.1).collect();
    sort_by_number(&mut lone, |at| micrometres(at.z));
    lone
}

/// Heights are compared in micrometres: their last digits depend on the order of a facet's corners.
fn micrometres(z_mm: f64) -> f64 {
    (z_mm * 1e3).round()
}

/// Rays' lower ends on surfaces that do not support themselves.
fn overhangs(mesh: &Mesh, rays: &Rays<'_>, profile: &SupportProfile) -> Vec<Place> {
    let pitch_mm = rays.ldi.grid.pitch_mm;
    let reach = (profile.contact_mm / 2.0 / pitch_mm) as isize + 1;
    let around = [[reach, 0], [-reach, 0], [0, reach], [0, -reach]];
    let places = rays.each().filter_map(|(place, at, stretch)| {
        let [a, b, c] = mesh.corners(stretch.facet as usize);
        let normal = (b - a).cross(c - a);
        let run = (normal.x * normal.x + normal.y * normal.y).sqrt();
        // A facet's slope is its normal's run over its rise.
        let slope = run / -normal.z;
        if !(0.0..profile.self_supporting_slope).contains(&slope) {
            return None;
        }
        let rise_mm = (reach as f64 * pitch_mm * (slope + 1.0)) as f32;
        let goes_on = |&step: &[isize; 2]| {
            let mut there = rays.beside(place, step).iter();
            there.any(|it| (it.from_mm - stretch.from_mm).abs() <= rise_mm)
        };
        Some(Place {
            at,
            facet: stretch.facet,
            slope,
            is_edge: !around.iter().all(goes_on),
        })
    });
    places.collect()
}

impl Surface<'_> {
    /// The contact at a point, or at the nearest point of the surface within reach, with the mean normal of the facets
    /// that the tip touches.
    ///
    /// Coordinates are whole micrometres, as in reports, so that a report's points give the same contacts.
    pub(super) fn contact(&self, point: DVec3, diameter_mm: f64, reach_mm: f64) -> Option<Contact> {
        let near = self.within(point, reach_mm).into_iter();
        // Of facets equally near to a micrometre the same one, in any order of facets.
        let is_before = |a: &(f64, DVec3, u32), b: &(f64, DVec3, u32)| {
            let [a_um, b_um] = [a.0, b.0].map(|mm| (mm * 1e3).round());
            let ties = a.1.x.total_cmp(&b.1.x).then(a.1.y.total_cmp(&b.1.y));
            a_um.total_cmp(&b_um).then(ties)
        };
        let (away_mm, nearest, facet) = near.min_by(is_before)?;
        let at = if away_mm <= ON_SURFACE_MM {
            point
        } else {
            nearest
        };
        let at = DVec3::from_array(at.to_array().map(|mm| (mm * 1e3).round() / 1e3 + 0.0));
        let radius_mm = diameter_mm / 2.0;
        let mut touched = self.within(at, radius_mm);
        sort_by_number(&mut touched, |it| f64::from(it.2));
        touched.dedup_by_key(|it| it.2);
        let normals = touched.iter().map(|&(away_mm, _, facet)| {
            let [a, b, c] = self.mesh.corners(facet as usize);
            let normal = (b - a).cross(c - a);
            normal / normal.length() * (radius_mm - away_mm)
        });
        let normal = normals.fold(DVec3::ZERO, |sum, it| sum + it);
        let length = normal.length();
        Some(Contact {
            at,
            normal: if length > 0.0 {
                normal / length
            } else {
                DVec3::NEG_Z
            },
            diameter_mm,
            facet,
        })
    }
}

/// Points so near the surface are on it.
const ON_SURFACE_MM: f64 = 0.002;
