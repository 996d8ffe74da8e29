//! Contacts: a model needs supports at its lowest points, and on surfaces that are too flat to support themselves.

use glam::DVec3;

use super::super::surface::{self, Squares, Surface};
use super::held::Held;
use super::islands::islands;
use super::loads::{Candidate, Loads};
use super::rays::{Rays, Stretch};
use super::{SupportLoad, SupportProfile};
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
    /// True if it only shares the pull of the film: the surface holds without it.
    pub is_for_load: bool,
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

/// Height of the layer in which a surface begins, and in which contacts must hold it, in micrometres.
const FIRST_LAYER_UM: f64 = 50.0;

/// Radius that a contact holds around a lowest point of rays, in spacings: half of that on a level surface.
const LONE: f64 = 0.5;

/// Places new contacts: those that hold the model together with the given ones, and those that it would need on protected
/// facets, and the largest load of all.
pub(super) fn place(
    model: &Surface<'_>,
    ldi: &Ldi,
    wishes: &Wishes<'_>,
) -> (Vec<Contact>, Vec<Contact>, Option<SupportLoad>) {
    let (mesh, profile) = (model.mesh, wishes.profile);
    let rays = Rays::new(ldi);
    let stands = |at: DVec3| profile.lift_mm + at.z <= ON_PLATE_MM;
    let is_protected = |facet: u32| surface::is_protected(wishes.weights, facet);
    let contact = |at: DVec3| model.contact(at, profile.contact_mm, profile.contact_mm);
    let most_mm = profile.reach_mm(profile.self_supporting_slope);
    let mut held = Held::new(&rays, most_mm);
    // The plate holds what stands on it.
    let standing = (0..rays.stretches.len()).filter(|&it| stands(rays.at(it)));
    let standing: Vec<usize> = standing.collect();
    held.insert(&standing);
    let mut points = Points::new(mesh);
    let mut placed: [Vec<Contact>; 2] = Default::default();
    let mut add = |held: &mut Held<'_>, points: &mut Points, at: DVec3| {
        let found = contact(at);
        let protected = found.is_some_and(|it| is_protected(it.facet));
        placed[usize::from(protected)].extend(found);
        points.insert(at);
        if !protected {
            held.insert_at(at);
        }
    };
    for contact in wishes.given {
        points.insert(contact.at);
        held.insert_at(contact.at);
    }
    let same_mm = SAME * profile.contact_mm;
    for at in lowest_points(mesh, &rays, same_mm) {
        if !stands(at) && !points.is_near(at, same_mm) {
            add(&mut held, &mut points, at);
        }
    }
    let pitch_mm = ldi.grid.pitch_mm;
    let lone_mm = LONE * profile.spacing_mm;
    for island in islands(&rays, |it| held.away_mm(it) <= pitch_mm) {
        let at = rays.at(island.stretch);
        let is_near = if island.is_lone {
            points.is_near(at, lone_mm)
        } else if island.joins_soon {
            held.away_mm(island.stretch) < lone_mm
        } else {
            points.is_near(at, 2.0 * same_mm)
        };
        let is_of_model = rays.stretches[island.stretch].facet < ldi.classes.model_end();
        if is_of_model && !is_near {
            add(&mut held, &mut points, at);
        }
    }
    let mut places = overhangs(mesh, &rays, profile);
    sort_by_number(&mut places, |place| micrometres(place.at.z));
    // Within the first layer, edges come after the rest: what begins later cannot hold them. Protected facets come last, and so show what
    // stays without support.
    sort_by_number(&mut places, |place| f64::from(u8::from(place.is_edge)));
    sort_by_number(&mut places, |place| {
        (micrometres(place.at.z) / FIRST_LAYER_UM).floor()
    });
    for protected in [false, true] {
        for place in places
            .iter()
            .filter(|it| is_protected(it.facet) == protected)
        {
            if held.away_mm(place.stretch) >= profile.reach_mm(place.slope) {
                add(&mut held, &mut points, place.at);
                held.insert(&[place.stretch]);
            }
        }
    }
    let [placed, missed] = placed;
    let loads = Loads::new(&rays, profile, standing);
    let candidates: Vec<Candidate> = surfaces(mesh, &rays, STEEPEST)
        .filter(|it| !stands(it.at) && !is_protected(it.facet))
        .map(|it| Candidate {
            stretch: it.stretch,
            at: it.at,
        })
        .collect();
    let mut all = wishes.given.to_vec();
    all.extend(placed);
    let fixed = wishes.given.len();
    let largest = loads.relieve(&mut all, fixed, &candidates, &contact);
    let largest = largest.map(|it| SupportLoad {
        newtons: it.newtons,
        limit_n: loads.most_n(all[it.contact].diameter_mm),
        at_mm: all[it.contact].at.to_array(),
        layer_mm: it.z_mm,
    });
    (all.split_off(fixed), missed, largest)
}

/// The steepest surface that gets contacts for the load alone, as its rise over its run: 60° from level.
const STEEPEST: f64 = 1.732;

/// Contacts by squares.
struct Points {
    squares: Squares,
    points: Vec<Vec<DVec3>>,
}

impl Points {
    fn new(mesh: &Mesh) -> Self {
        let squares = Squares::below(mesh);
        Self {
            points: vec![Vec::new(); squares.count()],
            squares,
        }
    }

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
fn lowest_points(mesh: &Mesh, rays: &Rays<'_>, inward_mm: f64) -> Vec<DVec3> {
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
    let mut points: Vec<DVec3> = found.filter(|at| !is_hidden(rays, *at)).collect();
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

/// Returns true if the print goes on below a point along the nearest ray, or if the point is in a void.
fn is_hidden(rays: &Rays<'_>, at: DVec3) -> bool {
    let Some(ray) = rays.nearest(at) else {
        return false;
    };
    let below_mm = (at.z - rays.ldi.grid.pitch_mm) as f32;
    let mut stretches = rays.of_ray(ray).map(|it| &rays.stretches[it]);
    let goes_on = stretches.any(|it| it.from_mm < below_mm && below_mm < it.to_mm);
    goes_on || rays.is_void(ray, at.z as f32)
}

/// A place on a surface that does not support itself.
#[derive(Clone)]
struct Place {
    stretch: usize,
    at: DVec3,
    facet: u32,
    /// Rise over run.
    slope: f64,
    /// True if a tip there would reach beyond the surface.
    is_edge: bool,
}

/// Heights are compared in micrometres: their last digits depend on the order of a facet's corners.
fn micrometres(z_mm: f64) -> f64 {
    (z_mm * 1e3).round()
}

/// Rays' lower ends on surfaces that do not support themselves.
fn overhangs(mesh: &Mesh, rays: &Rays<'_>, profile: &SupportProfile) -> Vec<Place> {
    let mut places: Vec<Place> = surfaces(mesh, rays, profile.self_supporting_slope).collect();
    let pitch_mm = rays.ldi.grid.pitch_mm;
    let reach = (profile.contact_mm / 2.0 / pitch_mm) as isize + 1;
    let around = [[reach, 0], [-reach, 0], [0, reach], [0, -reach]];
    for place in &mut places {
        let rise_mm = (reach as f64 * pitch_mm * (place.slope + 1.0)) as f32;
        let Stretch { ray, from_mm, .. } = rays.stretches[place.stretch];
        let goes_on = |&step: &[isize; 2]| {
            let mut there = rays.near(ray, step).map(|it| &rays.stretches[it]);
            there.any(|it| (it.from_mm - from_mm).abs() <= rise_mm)
        };
        place.is_edge = !around.iter().all(goes_on);
    }
    places
}

/// Rays' lower ends on surfaces of the model that are flatter than a slope.
fn surfaces(mesh: &Mesh, rays: &Rays<'_>, most_slope: f64) -> impl Iterator<Item = Place> {
    let stretches = rays.stretches.iter().enumerate();
    stretches.filter_map(move |(place, stretch)| {
        // Ceilings of voids are held from within.
        if stretch.facet >= rays.ldi.classes.model_end() {
            return None;
        }
        let [a, b, c] = mesh.corners(stretch.facet as usize);
        let normal = (b - a).cross(c - a);
        let run = (normal.x * normal.x + normal.y * normal.y).sqrt();
        // A facet's slope is its normal's run over its rise.
        let slope = run / -normal.z;
        (0.0..most_slope).contains(&slope).then(|| Place {
            stretch: place,
            at: rays.at(place),
            facet: stretch.facet,
            slope,
            is_edge: false,
        })
    })
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
            is_for_load: false,
        })
    }
}

/// Points so near the surface are on it.
const ON_SURFACE_MM: f64 = 0.002;
