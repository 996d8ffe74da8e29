//! Printability: what will fail, and where, found on the masks of a plan before anything is printed.
//!
//! All checks see the plan's own layers, so thicker layers have their own overhangs and islands. A pixel is solid if at least
//! half of its samples are lit. Lit and dark pixels alike hang together across sides: four in a layer, and the pixels above and
//! below. Where something is decided there are whole pixels and whole bins, so results are the same on every machine.
//! `docs/printability.md` defines each check with a picture.

mod bodies;
mod bridges;
mod collect;
mod columns;
mod components;
mod drain_openings;
mod finding;
mod forest;
mod held;
mod holes;
mod hollows;
mod layer;
mod limits;
mod overhang;
mod peel;
mod regions;
mod rows;
mod solid;
mod surfaces;
mod sweep;
mod thickness;

use serde::Serialize;

pub use finding::{Code, Finding};
pub use held::Held;
pub use limits::{Limits, LimitsError, Severities, Severity};
pub use peel::Peel;
pub(crate) use solid::retain_held;

use crate::grid::Grid;
use crate::mask::{Masks, RunSource, Window};
use crate::plan::Plan;
use crate::progress::{Cancelled, Progress, report};
use collect::{Collector, Frame};
use layer::{Marked, Reader};
use rows::Area;
use sweep::Sweep;

/// Decision of a shop about a print.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Prints it.
    Ok,
    /// Has a person check it.
    Review,
    /// Does not print it like this.
    Reject,
}

/// Number of findings of a kind. Only the largest are listed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Count {
    /// The kind.
    pub code: Code,
    /// Number of findings.
    pub found: usize,
}

/// Result of the checks.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Printability {
    /// The largest severity of all findings.
    pub verdict: Verdict,
    /// The findings, by kind, from the most severe and the largest down: at most a hundred of each kind.
    pub findings: Vec<Finding>,
    /// The kinds that were found.
    pub counts: Vec<Count>,
    /// Number of bodies that touch no other.
    pub bodies: usize,
    /// Areas to be peeled off the film, layer by layer.
    pub peel: Peel,
}

/// Pieces that begin with nothing below them and grow by more than a flake before they join what stands on the plate.
///
/// Cost: that of [`inspect`] for islands alone.
///
/// # Errors
/// [`Cancelled`].
pub fn floating(
    masks: &dyn RunSource,
    window: &Window,
    grid: &Grid,
    plan: &Plan,
    progress: &mut Progress<'_>,
) -> Result<Vec<Finding>, Cancelled> {
    let limits = Limits::of_floating();
    let frame = Frame::new(grid, Area::new(window, grid), plan);
    let reader = Reader::new(masks.reader(), Marked::default(), &frame, &limits);
    let mut findings = read(reader, &frame, &limits, &Held::default(), progress)?.findings;
    findings.retain(|it| it.severity > Severity::Note);
    Ok(findings)
}

/// Checks the masks of a plan, which must be seen from above. `unmended` are roofs that are too thin for a cure, and gaps that it closes,
/// as masks of their own. Surfaces near the contacts of supports are no overhangs, and
/// walls and gaps at their tips are no findings.
///
/// The result does not depend on the number of threads.
///
/// Cost: linear in the runs of all layers. Memory: a few dozen layers as runs.
///
/// # Errors
/// [`Cancelled`].
pub fn inspect(
    masks: &Masks,
    unmended: Option<&[Masks; 2]>,
    plan: &Plan,
    limits: &Limits,
    held: &Held,
    progress: &mut Progress<'_>,
) -> Result<Printability, Cancelled> {
    report(progress, 0.0)?;
    let area = Area::new(&masks.window, &masks.grid);
    let frame = Frame::new(&masks.grid, area, plan);
    let short = columns::short(masks, &frame, limits);
    let mut marked = Marked::default();
    let along_z = short.iter().chain(unmended.into_iter().flatten());
    for (reader, masks) in marked.iter_mut().zip(along_z) {
        *reader = (!masks.is_black()).then(|| masks.reader());
    }
    report(progress, 0.1)?;
    let reader = Reader::new(masks.reader(), marked, &frame, limits);
    read(reader, &frame, limits, held, progress)
}

/// Checks the layers that a reader reads.
fn read(
    mut reader: Reader<'_>,
    frame: &Frame<'_>,
    limits: &Limits,
    held: &Held,
    progress: &mut Progress<'_>,
) -> Result<Printability, Cancelled> {
    let mut collector = Collector::new(limits);
    let mut sweep = Sweep::new(frame, limits, held);
    while reader.done() < 1.0 {
        for layer in reader.next() {
            sweep.advance(layer, &mut collector);
        }
        report(progress, 0.1 + 0.9 * reader.done())?;
    }
    let (bodies, peel) = sweep.finish(&mut collector);
    let (findings, counts) = collector.finish();
    let worst = findings.iter().map(|finding| finding.severity).max();
    Ok(Printability {
        verdict: match worst {
            None | Some(Severity::Ignore | Severity::Note) => Verdict::Ok,
            Some(Severity::Review) => Verdict::Review,
            Some(Severity::Reject) => Verdict::Reject,
        },
        counts: counts
            .into_iter()
            .map(|(code, found)| Count { code, found })
            .collect(),
        findings,
        bodies,
        peel,
    })
}
