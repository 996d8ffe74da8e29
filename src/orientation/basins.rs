//! Islands and cups along a direction, found on the surface alone.
//!
//! Going up, a part of the surface begins at each of its minima, and ends where it meets one that began lower. If it faces down, the
//! solid begins there: nothing is below it, and it is an island. If it faces up, a hollow begins there. It is a cup up to where it
//! spills into one that began lower. Where the first layer has holes, the plate is the bottom of cups.
//!
//! The checks find the same on masks (`docs/printability.md`). This is an estimate from the surface, in time linear in
//! facets, and good enough to choose between directions.

use glam::DVec3;

use super::minima::Minima;
use super::overlaps::Overlaps;
use crate::argsort::argsort;
use crate::model::FacetLists;

/// Cups count from this area on, in mm², as in the checks.
const CUP_MM2: f64 = 1.0;

/// Least area in the first mask, in mm². Smaller features are smaller than any pixel.
const LEAST_MM2: f64 = 1e-6;

/// The height at which a cup spills is found by steps, each twice as high as the one before; that in which it spills is halved this
/// often.
const HALVINGS: u32 = 4;

/// A mark of vertices that no basin has reached.
const DRY: u32 = 0;

/// The surface of a model with its caps, to find basins on.
#[derive(Debug)]
pub(super) struct Basins {
    vertices_mm: Vec<DVec3>,
    facets: Vec<[u32; 3]>,
    /// The facets at each vertex.
    around: FacetLists,
    minima: Minima,
    overlaps: Option<Overlaps>,
}

/// The islands and cups in a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Found {
    pub islands: usize,
    /// The areas of the cups together, where each is largest.
    pub cups_mm2: f64,
}

/// A direction, with the heights and masks of a print along it.
pub(super) struct Along<'a> {
    pub up: DVec3,
    /// Height of the model.
    pub height_mm: f32,
    /// Heights of the vertices.
    pub heights_mm: &'a [f32],
    /// The middles of the layers, at which masks are taken.
    pub middles_mm: &'a [f32],
}

impl Along<'_> {
    /// Returns true if a vertex is lower than another. Of equal heights one is taken to be lower, so that a flat has one minimum.
    #[inline]
    fn is_lower(&self, one: u32, other: u32) -> bool {
        self.rank(one) < self.rank(other)
    }

    /// A number for each vertex, in the order of their heights.
    fn rank(&self, vertex: u32) -> u64 {
        // Negative zero is zero.
        let bits = (self.heights_mm[vertex as usize] + 0.0).to_bits();
        let is_negative = bits >> 31 == 1;
        let height = if is_negative { !bits } else { bits | 1 << 31 };
        u64::from(height) << 32 | u64::from(vertex)
    }

    fn lowest(&self, [a, b, c]: [u32; 3]) -> u32 {
        let of_two = |a, b| if self.is_lower(b, a) { b } else { a };
        of_two(of_two(a, b), c)
    }
}

/// State of a basin as it fills.
#[derive(Default)]
struct Flood {
    /// The vertices below its level.
    wet: Vec<u32>,
    /// Number of these whose neighbours have been visited.
    done: usize,
    /// Adjacent vertices that are above its level.
    shore: Vec<u32>,
}

impl Basins {
    pub fn new(vertices_mm: Vec<DVec3>, facets: Vec<[u32; 3]>) -> Self {
        let corners = |facet: u32| facets[facet as usize].into_iter().map(|it| it as usize);
        let around = FacetLists::new(vertices_mm.len(), 0..facets.len() as u32, corners);
        let minima = Minima::new(&vertices_mm, &facets, &around);
        let overlaps = Overlaps::new(&vertices_mm, &facets);
        Self {
            vertices_mm,
            facets,
            around,
            minima,
            overlaps,
        }
    }

    /// The facets: first those of the surface, then caps.
    pub fn facets(&self) -> &[[u32; 3]] {
        &self.facets
    }

    /// Finds the basins of the surface along a direction. `low` are the facets that reach down to the first mask, and maybe others, in
    /// ascending order.
    pub fn find(&self, along: &Along<'_>, low: &[u32]) -> Found {
        let &Along {
            heights_mm,
            middles_mm,
            ..
        } = along;
        let mut found = Found {
            islands: 0,
            cups_mm2: self.cups_on_plate_mm2(along, low),
        };
        let mut marks = vec![DRY; heights_mm.len()];
        for (minimum, mark) in self.minima(along).into_iter().zip(1..) {
            let bottom_mm = heights_mm[minimum as usize];
            let layer = middles_mm.partition_point(|&middle_mm| middle_mm < bottom_mm);
            let Some(&level_mm) = middles_mm.get(layer) else {
                break;
            };
            if marks[minimum as usize] != DRY {
                continue;
            }
            marks[minimum as usize] = mark;
            let mut flood = Flood {
                wet: vec![minimum],
                ..Flood::default()
            };
            let is_alone = self.fill(&mut flood, level_mm, along, &mut marks);
            // A basin that begins below the first mask stands on the plate.
            if !is_alone || layer == 0 {
                continue;
            }
            let area_mm2 = self.area_mm2(&flood.wet, level_mm, along);
            if area_mm2.abs() < LEAST_MM2 || flood.wet.iter().any(|&it| self.is_hidden(it)) {
                continue;
            }
            if area_mm2 < 0.0 {
                found.islands += 1;
            } else {
                let cup_mm2 = self.cup_mm2(&mut flood, level_mm, along, &mut marks);
                found.cups_mm2 += if cup_mm2 >= CUP_MM2 { cup_mm2 } else { 0.0 };
            }
        }
        found
    }

    /// The vertices that are lower than all their neighbours, from the lowest up.
    fn minima(&self, along: &Along<'_>) -> Vec<u32> {
        let is_lowest = |&vertex: &u32| {
            let mut facets = self.around.of(vertex as usize).iter();
            facets.all(|&facet| along.lowest(self.facets[facet as usize]) == vertex)
        };
        let candidates = self.minima.candidates(along.up, along.height_mm);
        let minima: Vec<u32> = candidates.into_iter().filter(is_lowest).collect();
        let heights_mm = minima
            .iter()
            .map(|&vertex| f64::from(along.heights_mm[vertex as usize]));
        let order = argsort(heights_mm).into_iter();
        order.map(|place| minima[place]).collect()
    }

    /// The area of a cup before it spills, when it has been filled up to a level; 0 if it never does: then it is enclosed, in whatever
    /// direction.
    fn cup_mm2(
        &self,
        flood: &mut Flood,
        mut level_mm: f32,
        along: &Along<'_>,
        marks: &mut [u32],
    ) -> f64 {
        let first = flood.wet.len();
        let bottom_mm = along.heights_mm[flood.wet[0] as usize];
        let mut step_mm = (level_mm - bottom_mm).max(along.middles_mm[0]);
        let (mut has_spilled, mut halvings) = (false, 0);
        while halvings < HALVINGS && !flood.shore.is_empty() {
            let (within, shore) = (flood.wet.len(), flood.shore.clone());
            if self.fill(flood, level_mm + step_mm, along, marks) {
                level_mm += step_mm;
            } else {
                for vertex in flood.wet.drain(within..) {
                    marks[vertex as usize] = DRY;
                }
                flood.done = within;
                flood.shore = shore;
                has_spilled = true;
            }
            if has_spilled {
                step_mm /= 2.0;
                halvings += 1;
            } else {
                step_mm *= 2.0;
            }
        }
        let area_mm2 = if has_spilled {
            self.area_mm2(&flood.wet, level_mm, along)
        } else {
            0.0
        };
        // A basin that began higher within it is a cup of its own.
        for &vertex in &flood.wet[first..] {
            marks[vertex as usize] = DRY;
        }
        area_mm2
    }

    /// Fills a basin up to a level; `false` if it spills there into what began lower.
    fn fill(&self, flood: &mut Flood, level_mm: f32, along: &Along<'_>, marks: &mut [u32]) -> bool {
        let minimum = flood.wet[0];
        let mark = marks[minimum as usize];
        let shore = std::mem::take(&mut flood.shore);
        let mut reached = |vertex: u32, flood: &mut Flood| {
            let seen = &mut marks[vertex as usize];
            if *seen == mark {
                return true;
            }
            if along.heights_mm[vertex as usize] > level_mm {
                flood.shore.push(vertex);
                return true;
            }
            if *seen != DRY || along.is_lower(vertex, minimum) {
                return false;
            }
            *seen = mark;
            flood.wet.push(vertex);
            true
        };
        for vertex in shore {
            if !reached(vertex, flood) {
                return false;
            }
        }
        while let Some(&vertex) = flood.wet.get(flood.done) {
            flood.done += 1;
            for &facet in self.around.of(vertex as usize) {
                for beside in self.facets[facet as usize] {
                    if !reached(beside, flood) {
                        return false;
                    }
                }
            }
        }
        true
    }

    /// The area at a level between the walls of the filled part: negative if it is solid.
    fn area_mm2(&self, wet: &[u32], level_mm: f32, along: &Along<'_>) -> f64 {
        let mut twofold_mm2 = 0.0;
        for &vertex in wet {
            for &facet in self.around.of(vertex as usize) {
                let corners = self.facets[facet as usize];
                // Once for each facet.
                if along.lowest(corners) == vertex {
                    let [a, b, c] = corners.map(|it| self.vertices_mm[it as usize]);
                    let part = part_below(
                        corners.map(|it| f64::from(along.heights_mm[it as usize])),
                        f64::from(level_mm),
                    );
                    twofold_mm2 += part * (b - a).cross(c - a).dot(along.up);
                }
            }
        }
        twofold_mm2 / 2.0
    }

    fn is_hidden(&self, vertex: u32) -> bool {
        let facet = self.around.of(vertex as usize)[0];
        self.is_hidden_on(facet, self.vertices_mm[vertex as usize])
    }

    fn is_hidden_on(&self, facet: u32, point: DVec3) -> bool {
        let overlaps = self.overlaps.as_ref();
        overlaps.is_some_and(|it| it.hide(&self.vertices_mm, &self.facets, facet, point))
    }

    /// The areas of the holes of the first layer together, which these facets reach down to.
    fn cups_on_plate_mm2(&self, along: &Along<'_>, low: &[u32]) -> f64 {
        let Some(&level_mm) = along.middles_mm.first() else {
            return 0.0;
        };
        let is_above = |vertex: u32| along.heights_mm[vertex as usize] > level_mm;
        // Point where an edge crosses the level. Both facets at the edge compute the same.
        let crossing = |one: u32, other: u32| {
            let (low, high) = if is_above(one) {
                (other, one)
            } else {
                (one, other)
            };
            let [from, to] = [low, high].map(|it| self.vertices_mm[it as usize]);
            let [of_low, of_high] = [low, high].map(|it| along.heights_mm[it as usize]);
            let part = f64::from(level_mm - of_low) / f64::from(of_high - of_low);
            from + (to - from) * part
        };
        let mut pieces: Vec<Piece> = Vec::new();
        for &facet in low {
            let [a, b, c] = self.facets[facet as usize];
            let above = [a, b, c].map(is_above);
            if above == [true; 3] || above == [false; 3] {
                continue;
            }
            // The corner that is alone on its side, and the next ones around the facet.
            let (alone, next, last) = match above {
                [_, y, z] if y == z => (a, b, c),
                [x, _, z] if x == z => (b, c, a),
                _ => (c, a, b),
            };
            // With the normal to its right, as the outline of a solid runs.
            let ends = if is_above(alone) {
                [next, last]
            } else {
                [last, next]
            };
            pieces.push(Piece {
                facet,
                edges: ends.map(|end| [alone, end]),
                ends: ends.map(|end| crossing(alone, end)),
            });
        }
        self.outlines(&pieces)
            .into_iter()
            .map(|outline| self.hole_mm2(&outline, along.up))
            .fold(0.0, |all, hole_mm2| all + hole_mm2)
    }

    /// Groups pieces, in order of their facets, that continue one another.
    fn outlines<'a>(&self, pieces: &'a [Piece]) -> Vec<Vec<&'a Piece>> {
        let mut is_taken = vec![false; pieces.len()];
        let mut outlines = Vec::new();
        for first in 0..pieces.len() {
            if is_taken[first] {
                continue;
            }
            is_taken[first] = true;
            let mut open = vec![first];
            let mut outline = Vec::new();
            while let Some(place) = open.pop() {
                outline.push(&pieces[place]);
                for [one, other] in pieces[place].edges {
                    for &facet in self.around.of(one as usize) {
                        if self.facets[facet as usize].contains(&other)
                            && let Ok(next) = pieces.binary_search_by_key(&facet, |it| it.facet)
                            && !is_taken[next]
                        {
                            is_taken[next] = true;
                            open.push(next);
                        }
                    }
                }
            }
            outlines.push(outline);
        }
        outlines
    }

    /// The area of an outline if it is that of a hole, large enough to count and not within another body.
    fn hole_mm2(&self, outline: &[&Piece], up: DVec3) -> f64 {
        let origin = outline[0].ends[0];
        let twofold_mm2: f64 = outline
            .iter()
            .map(|it| (it.ends[0] - origin).cross(it.ends[1] - origin).dot(up))
            .sum();
        let hole_mm2 = -twofold_mm2 / 2.0;
        if hole_mm2 >= CUP_MM2 && !self.is_hidden_on(outline[0].facet, origin) {
            hole_mm2
        } else {
            0.0
        }
    }
}

/// The part of an outline on a facet.
struct Piece {
    facet: u32,
    /// The edges of the facet on which it begins and ends, by their vertices.
    edges: [[u32; 2]; 2],
    ends: [DVec3; 2],
}

/// The part of a facet with corners at these heights that is below a level.
fn part_below([a, b, c]: [f64; 3], level_mm: f64) -> f64 {
    let in_order = |a: f64, b: f64| if a <= b { (a, b) } else { (b, a) };
    let (low, high) = in_order(a, b);
    let (middle, high) = in_order(high, c);
    let (low, middle) = in_order(low, middle);
    if level_mm >= high {
        1.0
    } else if level_mm <= low {
        0.0
    } else if level_mm <= middle {
        (level_mm - low) * (level_mm - low) / ((middle - low) * (high - low))
    } else {
        1.0 - (high - level_mm) * (high - level_mm) / ((high - middle) * (high - low))
    }
}
