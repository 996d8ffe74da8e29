//! Finds the facets that lie wholly inside the solid where bodies overlap. They are not part of the printed surface.

use std::sync::atomic::AtomicU8;
use std::sync::atomic::Ordering::Relaxed;

use super::projection::Projection;
use super::{Hit, MeshRays, Overlaps, RayImage, Rays, Survey};
use crate::grid::Grid;
use crate::model::crossing::crossed;
use crate::model::{Mesh, bodies};
use crate::parallel;
use crate::progress::{Cancelled, Progress};

/// Visibility of the facets of a mesh, as an LDI shows it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Visibility {
    /// For each facet, true if it is wholly inside: at least one ray meets it, all that do are inside the solid there,
    /// and no other facet passes through it; or the rays show the same of its whole body. Empty if there is no such
    /// facet.
    pub hidden: Vec<bool>,
    /// The facets that are not hidden although a ray meets them inside the solid, argsort: they may cross the surface.
    pub partly_inside: Vec<u32>,
    /// True if bodies overlap without hiding whole facets, or a body is inverted. The areas of sections are then not
    /// the sum of the areas that facets enclose.
    pub overlaps: bool,
}

const MET: u8 = 1;
const ON_SURFACE: u8 = 2;
const INSIDE: u8 = 4;

/// Finds the hidden facets of a mesh, whose rays `survey` surveyed. A facet that no ray meets counts as visible,
/// unless its body is hidden.
///
/// Cost: none if rays pass through one body after another; otherwise linear in facets, and in the hits of rays that overlap, or of all
/// if those are not known.
///
/// # Errors
/// [`Cancelled`].
pub fn visibility(
    rays: MeshRays<'_>,
    survey: &Survey,
    progress: &mut Progress<'_>,
) -> Result<Visibility, Cancelled> {
    let MeshRays {
        mesh,
        image,
        overlaps,
    } = rays;
    // Voids and supports do not belong to the surface that profiles measure.
    let model_end = mesh.classes.model_end();
    if survey.is_in_turn {
        return Ok(Visibility {
            hidden: Vec::new(),
            partly_inside: Vec::new(),
            overlaps: false,
        });
    }
    let bodies = bodies(mesh.vertices.len(), &mesh.facets);
    let mut seen = match overlaps {
        Some(overlaps) => seen_where_bodies_overlap(mesh, &bodies, overlaps, image.grid()),
        None => seen_along(mesh, image, &mut |fraction| progress(0.5 * fraction))?,
    };
    let met_inside: Vec<bool> = seen.iter().map(|seen| seen & INSIDE != 0).collect();
    for seen in &mut seen {
        *seen &= !INSIDE;
    }
    let mut body_seen = vec![0u8; mesh.vertices.len()];
    for (&seen, &body) in seen.iter().zip(&bodies) {
        body_seen[body as usize] |= seen;
    }
    // Between the rays, or beyond a body that it passes through, a part of a facet may be outside, and with it the body.
    let doubtful: Vec<u32> = (0..model_end)
        .filter(|&facet| seen[facet as usize] == MET)
        .collect();
    for (&facet, is_crossed) in doubtful.iter().zip(crossed(mesh, &doubtful)) {
        if is_crossed {
            seen[facet as usize] |= ON_SURFACE;
            body_seen[bodies[facet as usize] as usize] |= ON_SURFACE;
        }
    }
    let is_hidden_body = |facet: usize| body_seen[bodies[facet] as usize] == MET;
    let hidden: Vec<bool> = (0..seen.len())
        .map(|facet| seen[facet] == MET || is_hidden_body(facet))
        .collect();
    let is_partly = |&facet: &u32| met_inside[facet as usize] && !hidden[facet as usize];
    let partly_inside = (0..mesh.surface_facets as u32).filter(is_partly).collect();
    // A body that has lost part of its walls encloses no measurable area.
    let is_open = (0..seen.len())
        .any(|facet| hidden[facet] && !is_hidden_body(facet) && mesh.n_z_squared(facet) < 1.0);
    // Without the hidden bodies, does every ray enter and leave one body after another? One may begin where another ends.
    let is_union = |hits: &[Hit]| {
        is_one_solid(hits, |hit| {
            hit.facet() < model_end && !is_hidden_body(hit.facet() as usize)
        })
    };
    let mut second = |fraction| progress(0.5 + 0.5 * fraction);
    let are_unions = match overlaps {
        // Other rays meet no hidden body.
        Some(overlaps) => overlaps.all(is_union),
        None => image.all(is_union, &mut second)?,
    };
    Ok(Visibility {
        hidden,
        partly_inside,
        overlaps: is_open || !are_unions,
    })
}

/// Marks of each facet from all rays.
fn seen_along(
    mesh: &Mesh,
    image: RayImage<'_>,
    progress: &mut Progress<'_>,
) -> Result<Vec<u8>, Cancelled> {
    let model_end = mesh.classes.model_end();
    let seen: Vec<AtomicU8> = mesh.facets.iter().map(|_| AtomicU8::new(0)).collect();
    let look = |(): &mut (), rays: Rays<'_>| {
        for hits in rays.each() {
            look_along(hits, model_end, &seen);
        }
    };
    image.fold(|| (), look, progress)?;
    Ok(seen.into_iter().map(AtomicU8::into_inner).collect())
}

/// Marks of the facets that rays meet inside the solid, and of as many others as bodies need: all rays that do not overlap meet
/// facets on the surface.
fn seen_where_bodies_overlap(
    mesh: &Mesh,
    bodies: &[u32],
    overlaps: &Overlaps,
    grid: &Grid,
) -> Vec<u8> {
    let model_end = mesh.classes.model_end();
    let seen: Vec<AtomicU8> = mesh.facets.iter().map(|_| AtomicU8::new(0)).collect();
    overlaps.each(|hits| look_along(hits, model_end, &seen));
    let mut seen: Vec<u8> = seen.into_iter().map(AtomicU8::into_inner).collect();
    let projection = Projection::new(mesh, grid);
    let met_on_surface = |facets: Vec<u32>| {
        let met = parallel::map(facets, |facet| {
            let is_met = overlaps.any_other(&projection, facet, |_| true);
            is_met.then_some(facet)
        });
        met.into_iter().flatten()
    };
    let is_inside = |&facet: &u32| seen[facet as usize] == MET | INSIDE;
    for facet in met_on_surface((0..model_end).filter(is_inside).collect()) {
        seen[facet as usize] |= ON_SURFACE;
    }
    // A body with a facet on the surface is not hidden.
    let mut body_seen = vec![0u8; mesh.vertices.len()];
    for (&seen, &body) in seen.iter().zip(bodies) {
        body_seen[body as usize] |= seen & !INSIDE;
    }
    let is_of_inner_body = |&facet: &u32| {
        let facet = facet as usize;
        seen[facet] == 0 && body_seen[bodies[facet] as usize] == MET
    };
    for facet in met_on_surface((0..model_end).filter(is_of_inner_body).collect()) {
        seen[facet as usize] = MET | ON_SURFACE;
    }
    seen
}

/// Returns true if those hits of a ray whose facets are below `model_end` enter and leave one body after another, and no body touches
/// the next.
#[inline]
pub(super) fn is_in_turn(hits: &[Hit], model_end: u32) -> bool {
    let mut winding = 0;
    let mut last_z_mm = -1.0;
    let mut of_model = hits.iter().filter(|hit| hit.facet() < model_end);
    of_model.all(|hit| {
        winding += hit.winding();
        let rises = hit.z_mm > last_z_mm;
        last_z_mm = hit.z_mm;
        rises && (winding == 0 || winding == 1)
    })
}

/// Returns true if those hits of a ray for which `counts` holds enter and leave one body after another, with hits at the same height taken
/// together.
fn is_one_solid(hits: &[Hit], counts: impl Fn(&Hit) -> bool) -> bool {
    let mut winding = 0;
    hits.chunk_by(|a, b| a.z_mm == b.z_mm).all(|group| {
        let counted = group.iter().filter(|hit| counts(hit));
        winding += counted.map(|hit| hit.winding()).sum::<i32>();
        winding == 0 || winding == 1
    })
}

/// Marks the facets that a ray meets, and those that separate inside from outside.
fn look_along(hits: &[Hit], model_end: u32, seen: &[AtomicU8]) {
    let note = |hit: &Hit, note: u8| {
        let seen = &seen[hit.facet() as usize];
        // Neighbouring rays meet the same facets: most notes are already made.
        if seen.load(Relaxed) & note != note {
            seen.fetch_or(note, Relaxed);
        }
    };
    // Most rays meet no overlap.
    if is_in_turn(hits, model_end) {
        let of_model = hits.iter().filter(|hit| hit.facet() < model_end);
        return of_model.for_each(|hit| note(hit, MET | ON_SURFACE));
    }
    each_of_model(hits, model_end, |hit, is_inside| {
        let of = if is_inside { INSIDE } else { ON_SURFACE };
        note(hit, MET | of);
    });
}

/// Calls `visit` with each hit of a ray with the model, and true if it is inside the solid. Hits at the same height count together:
/// where bodies touch, neither of the two facets is on the surface.
#[inline]
pub(crate) fn each_of_model(hits: &[Hit], model_end: u32, mut visit: impl FnMut(&Hit, bool)) {
    let mut winding = 0;
    for group in hits.chunk_by(|a, b| a.z_mm == b.z_mm) {
        let was_inside = winding != 0;
        let of_model = || group.iter().filter(|hit| hit.facet() < model_end);
        winding += of_model().map(|hit| hit.winding()).sum::<i32>();
        let is_inside = was_inside && winding != 0;
        of_model().for_each(|hit| visit(hit, is_inside));
    }
}
