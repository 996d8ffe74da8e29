//! From the printed surface to the model.
//!
//! The printed surface of a layer is its walls and shelves: the sides of lit pixels next to dark ones, as high as the
//! layer; the tops of lit pixels under dark ones; and their undersides above dark ones. Rows give them as rectangles.
//!
//! The distance from a rectangle to one facet is a convex function, so the greatest is at one of four corners, and no point
//! of the rectangle is farther from the model than that. Where this does not exceed the greatest distance of the layer so
//! far, nothing else is asked; elsewhere the rectangle is halved, down to the face of one pixel, whose middle and corners are
//! asked. Means are over every n-th face.

use glam::DVec3;

use super::deviation::Tally;
use super::nearest::Facets;
use super::printed::Printed;
use crate::archive::read::{Mask, combine};
use crate::parallel;
use crate::progress::{Cancelled, Progress};

/// Number of layers that one thread examines in turn.
const RUN: usize = 4;
/// Number of faces of a layer over which its mean is taken; all of them if it has fewer.
const SAMPLES: usize = 512;
/// Maximum number of cells in x and y for which the last nearest facet is remembered.
const CELLS: u32 = 512;

/// The tallies of all layers.
pub(super) fn measure(
    printed: &Printed,
    facets: &Facets,
    progress: &mut Progress<'_>,
    share: [f64; 2],
) -> Result<Vec<Tally>, Cancelled> {
    let layers = printed.layers();
    let runs = (0..layers)
        .step_by(RUN)
        .map(|first| first..(first + RUN).min(layers));
    let mut tallies = Vec::with_capacity(layers);
    parallel::map_in_groups(
        runs.collect::<Vec<_>>().into_iter(),
        |run| {
            let mut hints = Hints::of(printed);
            run.map(|layer| Survey::of(printed, facets, layer, &mut hints))
                .collect()
        },
        |run: Vec<Tally>| {
            tallies.extend(run);
            Ok::<_, Cancelled>(())
        },
        progress,
        share,
    )?;
    Ok(tallies)
}

/// A row of faces of pixels that form a rectangle.
#[derive(Debug, Clone, Copy)]
struct Faces {
    kind: Kind,
    /// Column and row of the first pixel, or of the first corner of a wall.
    column: i32,
    row: i32,
    /// Number of faces.
    count: i32,
    /// The side that is printed. Faces of either side have hints of their own, for thin walls have facets on both.
    side: bool,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    /// A wall along y: the left side of a column.
    AlongY,
    /// A wall along x: the upper side of a row.
    AlongX,
    /// A shelf; `side` is set for the top of the layer.
    Shelf,
}

/// All faces of a layer.
fn faces_of(printed: &Printed, layer: usize) -> Vec<Faces> {
    let dark = Mask::default();
    let mask = &printed.masks[layer];
    let below = layer
        .checked_sub(1)
        .map_or(&dark, |below| &printed.masks[below]);
    let above = printed.masks.get(layer + 1).unwrap_or(&dark);
    let mut faces = Vec::new();
    let mut differences = |a: &[u16], b: &[u16], kind: Kind, row: i32, side: bool| {
        let only_a = combine(a, b, |a, b| a && !b);
        faces.extend(only_a.map(|(from, to)| Faces {
            kind,
            column: i32::from(from),
            row,
            count: i32::from(to) - i32::from(from),
            side,
        }));
    };
    let rows = mask.rows();
    for row in rows.clone() {
        let here = mask.row(row);
        differences(here, above.row(row), Kind::Shelf, row, true);
        differences(here, below.row(row), Kind::Shelf, row, false);
        differences(here, mask.row(row - 1), Kind::AlongX, row, true);
        differences(here, mask.row(row + 1), Kind::AlongX, row + 1, false);
    }
    for row in rows {
        let changes = mask.row(row).iter().enumerate();
        faces.extend(changes.map(|(place, &column)| Faces {
            kind: Kind::AlongY,
            column: i32::from(column),
            row,
            count: 1,
            side: place & 1 == 1,
        }));
    }
    faces
}

/// For each cell of some pixels, the facet that was nearest to the last point asked there.
struct Hints {
    shift: u32,
    width: usize,
    facets: Vec<u32>,
}

impl Hints {
    const NONE: u32 = u32::MAX;

    fn of(printed: &Printed) -> Self {
        let [width, height] = printed.pixels;
        let side = width.max(height);
        let shift = (2..16).find(|&shift| side >> shift < CELLS).unwrap_or(2);
        // Corners lie beyond the last pixel.
        let cells = |side: u32| (side >> shift) as usize + 1;
        Self {
            shift,
            width: cells(width),
            facets: vec![Self::NONE; 2 * cells(width) * cells(height)],
        }
    }

    fn slot(&mut self, faces: &Faces) -> &mut u32 {
        let column = (faces.column + faces.count / 2) as usize >> self.shift;
        let row = faces.row as usize >> self.shift;
        &mut self.facets[2 * (row * self.width + column) + usize::from(faces.side)]
    }
}

/// The examination of one layer.
struct Survey<'a> {
    printed: &'a Printed,
    facets: &'a Facets,
    hints: &'a mut Hints,
    /// Heights of the layer's underside and top.
    z: [f64; 2],
    tally: Tally,
}

impl<'a> Survey<'a> {
    fn of(printed: &'a Printed, facets: &'a Facets, layer: usize, hints: &'a mut Hints) -> Tally {
        let mut survey = Self {
            printed,
            facets,
            hints,
            z: [printed.z_mm[layer], printed.z_mm[layer + 1]],
            tally: Tally::default(),
        };
        let faces = faces_of(printed, layer);
        survey.sample(&faces);
        for faces in faces {
            survey.search(faces);
        }
        survey.tally
    }

    /// Takes the mean over every n-th face. Walls are asked at three heights: the distance is often greatest at both ends and
    /// least in between, and the trapezoid rule is exact where it is linear on either side of the middle.
    fn sample(&mut self, faces: &[Faces]) {
        let total: usize = faces.iter().map(|faces| faces.count as usize).sum();
        let step = (total / SAMPLES).max(1);
        let mut ahead = step / 2;
        for &faces in faces {
            while ahead < faces.count as usize {
                let face = Faces {
                    column: faces.column + ahead as i32,
                    count: 1,
                    ..faces
                };
                let corners = self.corners(&face);
                let area = (corners[1] - corners[0]).length() * (corners[2] - corners[0]).length();
                if face.kind == Kind::Shelf {
                    let squared = self.ask(&face, middle(&corners));
                    self.tally.average(squared, area);
                } else {
                    let ends = [
                        (corners[0] + corners[1]) * 0.5,
                        (corners[2] + corners[3]) * 0.5,
                    ];
                    for (point, part) in [(ends[0], 0.25), (middle(&corners), 0.5), (ends[1], 0.25)]
                    {
                        let squared = self.ask(&face, point);
                        self.tally.average(squared, area * part);
                    }
                }
                ahead += step;
            }
            ahead -= faces.count as usize;
        }
    }

    /// Finds the greatest distance of a rectangle, if it is greater than the greatest so far.
    fn search(&mut self, faces: Faces) {
        let corners = self.corners(&faces);
        let hint = *self.hints.slot(&faces);
        if hint != Hints::NONE && self.is_within(&corners, hint) {
            return;
        }
        self.ask(&faces, middle(&corners));
        let facet = *self.hints.slot(&faces);
        if self.is_within(&corners, facet) {
            return;
        }
        if faces.count == 1 {
            for corner in corners {
                if self.facets.to(corner, facet).squared > self.tally.squared {
                    self.ask(&faces, corner);
                }
            }
            return;
        }
        let half = faces.count / 2;
        self.search(Faces {
            count: half,
            ..faces
        });
        self.search(Faces {
            column: faces.column + half,
            count: faces.count - half,
            ..faces
        });
    }

    /// Returns true if no corner is farther from a facet than the greatest distance so far.
    fn is_within(&self, corners: &[DVec3; 4], facet: u32) -> bool {
        let mut corners = corners.iter();
        corners.all(|&corner| self.facets.to(corner, facet).squared <= self.tally.squared)
    }

    /// Counts a point for the maximum, and returns the square of its distance.
    fn ask(&mut self, faces: &Faces, point: DVec3) -> f64 {
        let slot = self.hints.slot(faces);
        let hint = (*slot != Hints::NONE).then_some(*slot);
        let near = self.facets.nearest(point, hint);
        *slot = near.facet;
        self.tally.raise(near.squared, point);
        near.squared
    }

    /// The corners of a rectangle: two on one side, then the two opposite.
    fn corners(&self, faces: &Faces) -> [DVec3; 4] {
        let Faces {
            column, row, count, ..
        } = *faces;
        let [floor, top] = self.z;
        let at = |column: i32, row: i32, z: f64| self.printed.at(column, row).extend(z);
        match faces.kind {
            Kind::AlongY => [
                at(column, row, floor),
                at(column, row + 1, floor),
                at(column, row, top),
                at(column, row + 1, top),
            ],
            Kind::AlongX => [
                at(column, row, floor),
                at(column + count, row, floor),
                at(column, row, top),
                at(column + count, row, top),
            ],
            Kind::Shelf => {
                let z = if faces.side { top } else { floor };
                [
                    at(column, row, z),
                    at(column + count, row, z),
                    at(column, row + 1, z),
                    at(column + count, row + 1, z),
                ]
            }
        }
    }
}

fn middle(corners: &[DVec3; 4]) -> DVec3 {
    (corners[0] + corners[1] + corners[2] + corners[3]) * 0.25
}
