//! Where supports touch the model: what they hold there, and what is thin because a tip is.

use super::collect::Frame;
use super::rows::{Disc, Rows, Span};

/// The contacts of supports.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Held {
    /// Where they are: x, y and z in millimetres, as in findings.
    pub contacts_mm: Vec<[f64; 3]>,
    /// How far each holds a surface that is too flat to support itself, sideways and upward.
    pub reach_mm: f64,
    /// How far a tip reaches sideways. Walls and gaps there are its own.
    pub tip_reach_mm: f64,
    /// How far a tip reaches down from its contact.
    pub tip_mm: f64,
}

/// Cylinders around the contacts, in pixels.
pub(super) struct Holds {
    disc: Disc,
    below_mm: f64,
    above_mm: f64,
    /// Column, row and height of each contact.
    contacts: Vec<(i32, i32, f64)>,
}

impl Holds {
    /// What contacts hold.
    pub fn of_surfaces(held: &Held, frame: &Frame<'_>) -> Self {
        Self::new(held, held.reach_mm, 0.0, frame)
    }

    /// Where tips are.
    pub fn of_tips(held: &Held, frame: &Frame<'_>) -> Self {
        Self::new(held, held.tip_reach_mm, held.tip_mm, frame)
    }

    fn new(held: &Held, reach_mm: f64, below_mm: f64, frame: &Frame<'_>) -> Self {
        let contacts = held.contacts_mm.iter().map(|&[x_mm, y_mm, z_mm]| {
            let [column, row] = frame.pixel(x_mm, y_mm);
            (column, row, z_mm)
        });
        Self {
            disc: Disc::new(reach_mm, frame.grid),
            below_mm,
            above_mm: reach_mm,
            contacts: contacts.collect(),
        }
    }

    /// Takes what is theirs from pixels of a layer.
    pub fn take_from(&self, rows: &mut Rows, layer: usize, frame: &Frame<'_>) {
        if rows.is_blank() {
            return;
        }
        let [bottom_mm, top_mm] = [layer, layer + 1].map(|boundary| frame.z_mm[boundary]);
        let near = self
            .contacts
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
            spans.sort_unstable_by_key(|span| span.start);
            for &span in &spans {
                theirs.push(span);
            }
            theirs.end_row();
        }
        *rows = rows.without(&theirs);
    }
}
