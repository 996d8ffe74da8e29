//! The solid model that a hollow one was made of: would it hold a piece?

use super::collect::Frame;
use super::finding::Finding;
use super::forest::{Forest, Joining};
use super::layer::{Marked, Reader};
use super::limits::Limits;
use super::rows::Area;
use crate::grid::Grid;
use crate::mask::{RunSource, Window};
use crate::plan::Plan;
use crate::progress::{Cancelled, Progress, report};

/// Keeps the findings that the solid model with these masks holds: in the layer in which they begin, it joins them to what stands on
/// the plate.
///
/// Cost: linear in the runs of all layers up to the last one in which a finding begins.
///
/// # Errors
/// [`Cancelled`].
pub fn retain_held(
    findings: &mut Vec<Finding>,
    masks: &dyn RunSource,
    window: &Window,
    grid: &Grid,
    plan: &Plan,
    progress: &mut Progress<'_>,
) -> Result<(), Cancelled> {
    let limits = Limits::of_floating();
    let frame = Frame::new(grid, Area::new(window, grid), plan);
    let mut reader = Reader::new(masks.reader(), Marked::default(), &frame, &limits);
    let mut forest = Forest::new(Joining::Ends);
    let mut held = Vec::new();
    let mut left = std::mem::take(findings);
    while !left.is_empty() && reader.done() < 1.0 {
        for layer in reader.next() {
            forest.rise(&layer, &frame);
            let begins = |it: &mut Finding| it.layers[0] == layer.number;
            held.extend(left.extract_if(.., begins).filter(|it| {
                let pixel = frame.pixel(it.at_mm[0], it.at_mm[1]);
                let component = layer.alone.lit.at(pixel);
                let tree = component.map(|it| forest.of_components()[it as usize]);
                tree.is_some_and(|it| forest.root(it).is_fixed)
            }));
        }
        report(progress, reader.done())?;
    }
    *findings = held;
    Ok(())
}
