//! Hollowing and supports in the slicer's WebAssembly module. They are in its later part, which is fetched when a plan first asks
//! for them: only [`arrive`], which that part exports, refers to the functions that do the work.

use std::cell::Cell;
use std::hint::black_box;

use super::{Hollowing, Supporting, Supports, Void};
use crate::ldi::LdiError;
use crate::model::Mesh;
use crate::progress::Progress;

type Hollow =
    fn(&Mesh, &Hollowing, Option<&[f32]>, &mut Progress<'_>) -> Result<Option<Void>, LdiError>;
type Support =
    fn(&Mesh, &Supporting, Option<&[f32]>, &mut Progress<'_>) -> Result<Supports, LdiError>;

thread_local! {
    static ARRIVED: Cell<Option<(Hollow, Support)>> = const { Cell::new(None) };
}

/// Hollows and supports models from now on.
pub fn arrive() {
    let functions: (Hollow, Support) = (super::hollow::hollow, super::support::support);
    // A compiler that sees what is stored would call it by name, and so have it in the first part.
    ARRIVED.set(Some(black_box(functions)));
}

fn arrived() -> (Hollow, Support) {
    ARRIVED
        .get()
        .expect("the later part is fetched before a plan with a void or supports")
}

/// [`super::hollow::hollow`].
///
/// # Errors
/// Its own.
pub fn hollow(
    mesh: &Mesh,
    hollowing: &Hollowing,
    weights: Option<&[f32]>,
    progress: &mut Progress<'_>,
) -> Result<Option<Void>, LdiError> {
    arrived().0(mesh, hollowing, weights, progress)
}

/// [`super::support::support`].
///
/// # Errors
/// Its own.
pub fn support(
    mesh: &Mesh,
    supporting: &Supporting,
    weights: Option<&[f32]>,
    progress: &mut Progress<'_>,
) -> Result<Supports, LdiError> {
    arrived().1(mesh, supporting, weights, progress)
}
