//! All checks, going through the layers from the plate upward.

use super::bodies::Bodies;
use super::collect::{Collector, Frame};
use super::drain_openings::Openings;
use super::finding::Code;
use super::held::{Held, Holds};
use super::hollows::Hollows;
use super::layer::Layer;
use super::limits::Limits;
use super::overhang::Overhangs;
use super::peel::{Peel, Peeling};
use super::regions::Regions;
use crate::prepare::FILM_KPA;

/// The checks of the layers so far.
pub(super) struct Sweep<'a> {
    frame: &'a Frame<'a>,
    bodies: Bodies<'a>,
    hollows: Hollows<'a>,
    openings: Openings<'a>,
    overhangs: Overhangs,
    tips: Holds,
    joints: Holds,
    walls: Regions,
    gaps: Regions,
    holes: Regions,
    floors: Regions,
    low_gaps: Regions,
    roofs: Regions,
    closed_gaps: Regions,
    peeling: Peeling<'a>,
}

impl<'a> Sweep<'a> {
    pub fn new(frame: &'a Frame<'a>, limits: &'a Limits, held: &Held) -> Self {
        let regions = |code, limit_mm, least_height_mm| {
            Regions::new(code, limit_mm, limits.speck_px, least_height_mm)
        };
        let of_print_through = |code| {
            let limit_mm2 = limits.print_through_mm2;
            let least_px = (limit_mm2 / frame.grid.pixel_mm2()).ceil() as u32;
            Regions::new(code, limit_mm2, least_px, 0.0)
        };
        Self {
            frame,
            bodies: Bodies::new(frame, limits),
            hollows: Hollows::new(frame, limits),
            openings: Openings::new(frame, limits),
            overhangs: Overhangs::new(frame, limits, held),
            tips: Holds::of_tips(held, frame),
            joints: Holds::of_joints(held, frame),
            // A region no taller than it is thin is the tip of a feature, or thin along z.
            walls: regions(Code::ThinWall, limits.wall_mm, limits.wall_mm),
            gaps: regions(Code::NarrowGap, limits.gap_mm, limits.gap_mm),
            // A hollow that begins or ends with a tip is no hole.
            holes: regions(Code::SmallHole, limits.hole_mm, limits.hole_mm),
            floors: regions(Code::ThinFloor, limits.floor_mm, 0.0),
            low_gaps: regions(Code::LowGap, limits.low_gap_mm, 0.0),
            roofs: of_print_through(Code::ThinRoof),
            closed_gaps: of_print_through(Code::ClosedGap),
            peeling: Peeling::new(frame, limits, held.film_kpa.unwrap_or(FILM_KPA)),
        }
    }

    pub fn advance(&mut self, layer: Layer, collector: &mut Collector<'_>) {
        let frame = self.frame;
        let number = layer.number;
        self.bodies.advance(&layer, collector);
        let gaps = &layer.alone.gaps;
        self.hollows.advance(number, gaps, &layer.links, collector);
        let (rooms, links) = (&layer.alone.rooms, &layer.room_links);
        self.openings
            .advance(number, rooms, links, gaps, &self.hollows);
        self.overhangs.advance(&layer, frame, collector);
        let mut thin = layer.thin;
        for rows in [&mut thin.walls, &mut thin.gaps, &mut thin.low_gaps] {
            self.tips.take_from(rows, number, frame);
        }
        for rows in [&mut thin.gaps, &mut thin.holes, &mut thin.low_gaps] {
            self.joints.take_from(rows, number, frame);
        }
        let regions = [
            (&mut self.walls, thin.walls),
            (&mut self.gaps, thin.gaps),
            (&mut self.holes, thin.holes),
            (&mut self.floors, thin.floors),
            (&mut self.low_gaps, thin.low_gaps),
            (&mut self.roofs, thin.roofs),
            (&mut self.closed_gaps, thin.closed_gaps),
        ];
        for (regions, rows) in regions {
            regions.advance(number, rows, frame, collector);
        }
        self.peeling.advance(&layer.alone.lit.patches, layer.pull);
    }

    /// The number of bodies, and the areas to be peeled off.
    pub fn finish(self, collector: &mut Collector<'_>) -> (usize, Peel) {
        let frame = self.frame;
        self.overhangs.finish(frame, collector);
        for regions in [
            self.walls,
            self.gaps,
            self.holes,
            self.floors,
            self.low_gaps,
            self.roofs,
            self.closed_gaps,
        ] {
            regions.finish(frame, collector);
        }
        self.openings.finish(&self.hollows, collector);
        self.hollows.finish(collector);
        let bodies = self.bodies.finish(collector);
        (bodies, self.peeling.finish(collector))
    }
}
