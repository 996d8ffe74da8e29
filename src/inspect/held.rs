//! Contacts of supports: the surfaces that they hold, and thin places that are due to a tip.

use super::collect::Frame;
use super::rows::{Disc, Rows, Span};
use crate::argsort::sort_by_number;

/// Places where supports touch the model and each other.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Held {
    /// Contacts: x, y and z in millimetres, as in findings.
    pub contacts_mm: Vec<[f64; 3]>,
    /// Distance within which each contact holds a surface that is too flat to support itself: sideways within the lit
    /// pixels, and upward.
    pub reach_mm: f64,
    /// Tops of pillars in voids, and the distance up to which each holds the ceiling.
    pub ceilings_mm: Vec<([f64; 3], f64)>,
    /// Radius of a tip. Walls and gaps within it are its own.
    pub tip_reach_mm: f64,
    /// Length of a tip down from its contact.
    pub tip_mm: f64,
    /// Joints of branches.
    pub joints_mm: Vec<[f64; 3]>,
    /// Distance from a joint within which gaps are those between its branches.
    pub joint_reach_mm: f64,
    /// Pull of the film against which they hold, at a disc of 20 mm, in kPa; the usual one if absent.
    pub film_kpa: Option<f64>,
}

/// Cylinders around points, in pixels.
pub(super) struct Holds {
    disc: Disc,
    below_mm: f64,
    above_mm: f64,
    /// Column, row and height of each point.
    points: Vec<(i32, i32, f64)>,
}

impl Holds {
    /// The tips.
    pub fn of_tips(held: &Held, frame: &Frame<'_>) -> Self {
        Self::new(&held.contacts_mm, held.tip_reach_mm, held.tip_mm, frame)
    }

    /// The joints of branches.
    pub fn of_joints(held: &Held, frame: &Frame<'_>) -> Self {
        let reach_mm = held.joint_reach_mm;
        Self::new(&held.joints_mm, reach_mm, reach_mm, frame)
    }

    fn new(points_mm: &[[f64; 3]], reach_mm: f64, below_mm: f64, frame: &Frame<'_>) -> Self {
        let points = points_mm.iter().map(|&[x_mm, y_mm, z_mm]| {
            let [column, row] = frame.pixel(x_mm, y_mm);
            (column, row, z_mm)
        });
        Self {
            disc: Disc::new(reach_mm, frame.grid),
            below_mm,
            above_mm: reach_mm,
            points: points.collect(),
        }
    }

    /// Removes the pixels within these cylinders from a layer.
    pub fn take_from(&self, rows: &mut Rows, layer: usize, frame: &Frame<'_>) {
        if rows.is_blank() {
            return;
        }
        let [bottom_mm, top_mm] = [layer, layer + 1].map(|boundary| frame.z_mm[boundary]);
        let near = self
            .points
            .iter()
            .filter(|(.., z_mm)| z_mm - self.below_mm < top_mm && bottom_mm < z_mm + self.above_mm);
        let near: Vec<_> = near.collect();
        if near.is_empty() {
            return;
        }
        let mut theirs = Rows::default();
        let mut spans: Vec<Span> = Vec::new();
        for row in 0..rows.len() {
            spans.clear();
            spans.extend(near.iter().filter_map(|(column, middle, _)| {
                let half_width = self.disc.half_width(row - middle)?;
                Some(Span {
                    start: column - half_width,
                    end: column + half_width + 1,
                })
            }));
            sort_by_number(&mut spans, |span| f64::from(span.start));
            for &span in &spans {
                theirs.push(span);
            }
            theirs.end_row();
        }
        *rows = rows.without(&theirs);
    }
}
