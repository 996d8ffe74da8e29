//! Cavities of a model: those that are joined to its void, and those that stay closed.

use super::cavities::Cavities;
use super::columns::Columns;
use super::hollow::core;
use super::surface_nets::Lattice;
use crate::ldi::LdiError;
use crate::progress::Progress;

/// Cavities of a model that stay closed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Closed {
    /// Number of such cavities.
    pub cavities: usize,
    /// Volume of all of them.
    pub volume_mm3: f64,
    /// A point in the largest.
    pub at_mm: [f64; 3],
}

/// The smallest cavity that is reported: the least volume of a trap by the checks' own limits.
const LEAST_CAVITY_MM3: f64 = 1.0;

/// A model with the cavities that are joined to its void.
pub(super) struct Joined {
    /// The model with these filled.
    pub model: Columns,
    /// The cavities alone, if there are any.
    pub cavities: Option<Columns>,
    /// The others.
    pub closed: Vec<bool>,
    /// The core of the void.
    pub core: Columns,
}

/// Joins the cavities that the core of the void meets once they are filled: the passages between them are as wide as
/// the smallest cavity. If `depth_mm` is absent, the void has no core, and all cavities are joined.
pub(super) fn joined(
    model: Columns,
    cavities: &Cavities,
    mut is_joined: Vec<bool>,
    depth_mm: Option<f32>,
    progress: &mut Progress<'_>,
) -> Result<Joined, LdiError> {
    let Some(depth_mm) = depth_mm else {
        return Ok(Joined {
            cavities: (!cavities.all.is_empty()).then(|| cavities.as_solid(&model, &is_joined)),
            core: model.of_changes(&[]),
            model: cavities.filled(&model, &is_joined),
            closed: vec![false; is_joined.len()],
        });
    };
    // With fewer cavities filled the core is smaller, so this ends: mostly at once.
    let mut rounds = 1.0;
    loop {
        let filled = if is_joined.contains(&true) {
            Some(cavities.filled(&model, &is_joined))
        } else {
            None
        };
        let begun = 1.0 - 1.0 / rounds;
        let mut within = |fraction| progress(begun + fraction / (rounds * (rounds + 1.0)));
        let core = core(filled.as_ref().unwrap_or(&model), depth_mm, &mut within)?;
        rounds += 1.0;
        let meets = cavities.that_meet(&model, &core);
        let still = is_joined
            .iter()
            .zip(&meets)
            .map(|(&is, &meets)| is && meets);
        let still: Vec<bool> = still.collect();
        if still == is_joined {
            let alone = filled.is_some();
            let alone = alone.then(|| cavities.as_solid(&model, &is_joined));
            return Ok(Joined {
                model: filled.unwrap_or(model),
                cavities: alone,
                closed: is_joined.iter().map(|it| !it).collect(),
                core,
            });
        }
        is_joined = still;
    }
}

/// The cavities that stay closed and are large enough to report.
pub(super) fn closed_of(
    cavities: &Cavities,
    is_closed: &[bool],
    lattice: &Lattice,
    pitch_mm: f32,
) -> Option<Closed> {
    let closed = cavities.all.iter().zip(is_closed);
    let closed =
        closed.filter(|(cavity, is_closed)| **is_closed && cavity.volume_mm3 >= LEAST_CAVITY_MM3);
    let closed: Vec<_> = closed.map(|it| it.0).collect();
    let largest = closed
        .iter()
        .copied()
        .reduce(|a, b| if b.volume_mm3 > a.volume_mm3 { b } else { a })?;
    let at_mm = largest.at_mm(lattice.origin_mm, pitch_mm);
    Some(Closed {
        cavities: closed.len(),
        volume_mm3: closed.iter().map(|cavity| cavity.volume_mm3).sum(),
        at_mm: at_mm.to_array().map(f64::from),
    })
}
