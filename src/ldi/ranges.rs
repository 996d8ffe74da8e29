//! The only rule that turns the hits of a ray into the height ranges in which the ray is inside.
//!
//! Inside means a non-zero winding number: overlapping bodies are a union, the orientation of facets decides which
//! bodies are cavities,
//! and bodies inside out that are no cavities have been turned over before (`model/bodies.rs`).

use super::Hit;
use crate::model::{FacetClass, FacetClasses, Winding};

/// Calls `emit(z_in, z_out)` for every height range in which a ray with these hits is inside the printed solid, from the
/// plate upward: see [`Winding::is_inside`].
#[inline]
pub fn printed_ranges(hits: &[Hit], classes: FacetClasses, emit: impl FnMut(f32, f32)) {
    let model_end = classes.model_end();
    // Of a model with voids or supports, too, most rays meet the model alone.
    if classes.is_model_alone() || hits.iter().all(|hit| hit.facet() < model_end) {
        let pass = |winding: &mut i32, hit: Hit| *winding += hit.winding();
        return for_each_range(hits, pass, |winding| winding != 0, emit);
    }
    for_each_range(hits, passing(classes), Winding::is_inside, emit);
}

/// [`printed_ranges`], each with true if the ray enters it through a support.
#[inline]
pub fn printed_entries(hits: &[Hit], classes: FacetClasses, mut emit: impl FnMut(f32, f32, bool)) {
    let model_end = classes.model_end();
    if classes.is_model_alone() || hits.iter().all(|hit| hit.facet() < model_end) {
        return printed_ranges(hits, classes, |z_in, z_out| emit(z_in, z_out, false));
    }
    let pass = passing(classes);
    let mut winding = Winding::default();
    let mut entry = (0.0, false);
    for &hit in hits {
        let was_inside = winding.is_inside();
        pass(&mut winding, hit);
        match (was_inside, winding.is_inside()) {
            (false, true) => entry = (hit.z_mm, winding.is_support_alone()),
            (true, false) if entry.0 < hit.z_mm => emit(entry.0, hit.z_mm, entry.1),
            _ => {}
        }
    }
}

/// [`printed_ranges`] for supports alone: see [`Winding::is_support_alone`].
pub(super) fn support_ranges(hits: &[Hit], classes: FacetClasses, emit: impl FnMut(f32, f32)) {
    let is_support = |hit: &Hit| classes.of(hit.facet()) == FacetClass::Support;
    if !hits.iter().any(is_support) {
        return;
    }
    for_each_range(hits, passing(classes), Winding::is_support_alone, emit);
}

fn passing(classes: FacetClasses) -> impl Fn(&mut Winding, Hit) {
    move |winding, hit| winding.pass(classes.of(hit.facet()), hit.winding())
}

/// [`printed_ranges`] for the model alone, without voids and supports.
pub fn model_ranges(hits: &[Hit], classes: FacetClasses, emit: impl FnMut(f32, f32)) {
    let end = classes.model_end();
    let pass = |winding: &mut i32, hit: Hit| {
        *winding += if hit.facet() < end { hit.winding() } else { 0 };
    };
    for_each_range(hits, pass, |winding| winding != 0, emit);
}

/// Calls `emit(z_mm, enters)` where a ray enters the printed solid, and where it leaves it, from some hits on. `winding` is the one
/// with which it comes to them; returns the one with which it goes on.
pub fn printed_crossings(
    hits: &[Hit],
    classes: FacetClasses,
    winding: Winding,
    emit: impl FnMut(f32, bool),
) -> Winding {
    for_each_crossing(hits, winding, passing(classes), Winding::is_inside, emit)
}

/// Calls `emit` for every height range in which `is_inside` holds for the winding number, which `pass` updates at each
/// hit.
#[inline]
fn for_each_range<W: Copy + Default>(
    hits: &[Hit],
    pass: impl Fn(&mut W, Hit),
    is_inside: impl Fn(W) -> bool,
    mut emit: impl FnMut(f32, f32),
) {
    let mut z_in = 0.0;
    for_each_crossing(hits, W::default(), pass, is_inside, |z_mm, enters| {
        if enters {
            z_in = z_mm;
        } else if z_in < z_mm {
            emit(z_in, z_mm);
        }
    });
}

/// Calls `emit(z_mm, enters)` at every hit that changes whether `is_inside` holds. Returns the winding number above the last.
#[inline]
fn for_each_crossing<W: Copy>(
    hits: &[Hit],
    mut winding: W,
    pass: impl Fn(&mut W, Hit),
    is_inside: impl Fn(W) -> bool,
    mut emit: impl FnMut(f32, bool),
) -> W {
    for &hit in hits {
        let was_inside = is_inside(winding);
        pass(&mut winding, hit);
        match (was_inside, is_inside(winding)) {
            (false, true) => emit(hit.z_mm, true),
            (true, false) => emit(hit.z_mm, false),
            _ => {}
        }
    }
    winding
}
