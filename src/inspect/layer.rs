//! Layers as the checks see them: results from a layer and the one below, many layers at a time.

use std::sync::Arc;

use super::collect::Frame;
use super::columns;
use super::components::Components;
use super::drain_openings::{self, Extents};
use super::finding::Code;
use super::holes;
use super::hollows::{GapLinks, Gaps};
use super::limits::Limits;
use super::overhang;
use super::peel;
use super::rows::{Disc, Rows, Span};
use super::thickness::Thickness;
use crate::mask::{LayerRuns, RunReader};
use crate::parallel;

/// Layers that are read at a time.
const GROUP: usize = 64;

/// Results from the pixels of a layer alone.
pub(super) struct Alone {
    pub lit: Components,
    pub gaps: Gaps,
    pub rooms: Gaps,
    /// Between which pixels of each row there may be rooms.
    extents: Extents,
}

/// Results from a layer and the one below.
pub(super) struct Layer {
    pub number: usize,
    pub alone: Arc<Alone>,
    /// Pairs of lit components of the layer below and of this one.
    pub contacts: Vec<[u32; 2]>,
    pub links: GapLinks,
    pub room_links: GapLinks,
    /// Width that a self-supporting slope spans in the layer.
    pub width: Disc,
    /// Pixels that would be unsupported if all of the layer below were supported.
    pub flat: Rows,
    /// Pull of a film of 1 kPa, in newtons.
    pub pull: f64,
    pub thin: Thin,
}

/// The pixels of a layer that are too thin.
#[derive(Default)]
pub(super) struct Thin {
    pub walls: Rows,
    pub gaps: Rows,
    pub holes: Rows,
    pub floors: Rows,
    pub low_gaps: Rows,
    pub roofs: Rows,
    pub closed_gaps: Rows,
}

/// Readers of pixels that were found along z, unless there are none: short columns, lit ones and dark ones, thin roofs, and gaps that
/// close.
pub(super) type Marked<'a> = [Option<Box<dyn RunReader + 'a>>; 4];

/// Reads the layers of masks from the plate upward.
pub(super) struct Reader<'a> {
    checks: Checks<'a>,
    masks: Box<dyn RunReader + 'a>,
    marked: Marked<'a>,
    next: usize,
    last: Option<Arc<Alone>>,
}

/// The checks that need no more than a layer and the one below.
struct Checks<'a> {
    frame: &'a Frame<'a>,
    limits: &'a Limits,
    walls: Option<Thickness>,
    gaps: Option<Thickness>,
    /// The disc that must fit into a drain.
    drain: Option<Disc>,
}

impl<'a> Reader<'a> {
    pub fn new(
        masks: Box<dyn RunReader + 'a>,
        marked: Marked<'a>,
        frame: &'a Frame<'a>,
        limits: &'a Limits,
    ) -> Self {
        let thickness = |code, limit_mm| {
            let is_wanted = limits.looks_for(code);
            is_wanted
                .then(|| Thickness::new(limit_mm, frame.grid))
                .flatten()
        };
        let is_wanted = limits.looks_for(Code::NarrowDrain);
        let drain = is_wanted.then(|| Disc::to_fit(limits.drain_mm, frame.grid));
        let checks = Checks {
            frame,
            limits,
            walls: thickness(Code::ThinWall, limits.wall_mm),
            gaps: thickness(Code::NarrowGap, limits.gap_mm),
            drain: drain.flatten(),
        };
        Self {
            checks,
            masks,
            marked,
            next: 0,
            last: None,
        }
    }

    /// Fraction of the layers that have been read.
    pub fn done(&self) -> f64 {
        self.next as f64 / self.checks.frame.layers() as f64
    }

    /// The next layers; none at the top.
    pub fn next(&mut self) -> Vec<Layer> {
        let first = self.next;
        let count = GROUP.min(self.checks.frame.layers() - first);
        self.next += count;
        let runs = self.masks.next(count);
        let marked = self
            .marked
            .each_mut()
            .map(|reader| reader.as_mut().map(|reader| reader.next(count)));
        let (checks, last) = (&self.checks, self.last.as_ref());
        let alone = parallel::map((0..count).collect(), |place| {
            let lit = Rows::of_layer(&runs, place, &checks.frame.area);
            Arc::new(Alone::new(lit, checks.drain.as_ref()))
        });
        let layers = parallel::map((0..count).collect(), |place| {
            let below = place.checked_sub(1).map(|below| &alone[below]);
            let below = below.or(last).map(Arc::as_ref);
            let thin = checks.thin(&alone[place], &marked, place);
            checks.layer(first + place, &alone[place], below, thin)
        });
        self.last = alone.into_iter().next_back().or(self.last.take());
        layers
    }
}

impl Checks<'_> {
    fn layer(&self, number: usize, alone: &Arc<Alone>, below: Option<&Alone>, thin: Thin) -> Layer {
        let lit = &alone.lit;
        let contacts = below.map_or(Vec::new(), |below| lit.contacts(&below.lit));
        let width = overhang::width(number, self.frame, self.limits);
        let lit_extent = |it: &Alone, row| it.lit.rows.extent(row);
        let of_gaps = links(alone, below, |it| &it.gaps, &lit_extent);
        let of_rooms = self.drain.as_ref().map_or(GapLinks::default(), |disc| {
            let extent = |it: &Alone, row| it.extents.of_row(row, disc);
            links(alone, below, |it| &it.rooms, &extent)
        });
        let below = below.filter(|_| self.limits.looks_for(Code::Overhang));
        let flat = below.map_or(Rows::default(), |below| {
            overhang::unsupported(lit, &below.lit.rows, &contacts, &width)
        });
        Layer {
            number,
            links: of_gaps,
            room_links: of_rooms,
            alone: Arc::clone(alone),
            contacts,
            width,
            flat,
            pull: peel::pull(lit, self.frame.grid),
            thin,
        }
    }

    fn thin(&self, alone: &Alone, marked: &[Option<LayerRuns>; 4], place: usize) -> Thin {
        let lit = &alone.lit.rows;
        let area = &self.frame.area;
        let [floors, low_gaps, roofs, closed_gaps] = marked.each_ref().map(|runs| {
            let rows = runs.as_ref().map(|runs| Rows::of_layer(runs, place, area));
            rows.filter(|rows| !rows.is_blank())
        });
        let wall = |thickness: &Thickness| thickness.thin_walls(lit);
        let gap = |thickness: &Thickness| thickness.thin_gaps(lit, area.columns);
        let disc = |limit_mm| Disc::new(limit_mm, self.frame.grid);
        Thin {
            walls: self.walls.as_ref().map(wall).unwrap_or_default(),
            gaps: self.gaps.as_ref().map(gap).unwrap_or_default(),
            holes: holes::small(&alone.gaps, self.frame, self.limits),
            floors: floors.map_or(Rows::default(), |short| {
                columns::thin(&short, lit, &disc(self.limits.floor_mm))
            }),
            low_gaps: low_gaps.map_or(Rows::default(), |short| {
                let limit = disc(self.limits.low_gap_mm);
                columns::thin(&short, &lit.inverted(limit.rows()), &limit)
            }),
            roofs: roofs.unwrap_or_default(),
            closed_gaps: closed_gaps.unwrap_or_default(),
        }
    }
}

/// Links of dark places of a kind with those of the layer below.
fn links(
    here: &Alone,
    below: Option<&Alone>,
    places: fn(&Alone) -> &Gaps,
    extent: &dyn Fn(&Alone, i32) -> Option<Span>,
) -> GapLinks {
    let extent_here = |row| extent(here, row);
    let Some(below) = below else {
        return GapLinks::new(places(here), &extent_here, None);
    };
    let extent_below = |row| extent(below, row);
    GapLinks::new(
        places(here),
        &extent_here,
        Some((places(below), &extent_below)),
    )
}

impl Alone {
    fn new(lit: Rows, drain: Option<&Disc>) -> Self {
        let extents = drain.map_or(Extents::default(), |disc| Extents::new(&lit, disc));
        let rooms = drain.map(|disc| drain_openings::rooms(&lit, disc, &extents));
        Self {
            rooms: rooms.unwrap_or_default(),
            extents,
            gaps: Gaps::between(&lit),
            lit: Components::new(lit),
        }
    }
}
