//! Hollowing: the void deep inside a model, which need not be printed.
//!
//! The model is known by the height ranges of columns (`columns.rs`), as overlapping bodies are: one solid. The points
//! at least a wall and half a cavity away from the outside are the core of the void; the void is all that is within
//! half a cavity of that core. So every point of it is in a ball of the cavity's diameter that is void as well, walls
//! are thick enough wherever the void ends, and narrow places, which would hold resin, stay solid. Struts of a lattice
//! are left standing in it.
//!
//! A cavity of the model that lies so deep is joined to the void: the walls that the void keeps from the outside it does not keep from
//! such a cavity, around which it would leave a loose shell (`cavities.rs`).

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::basins::Basins;
use super::cavities::Cavities;
use super::columns::{Columns, MARGIN, To};
use super::drain::{self, AutoDrain, Drain};
use super::joined::{Closed, Joined, closed_of, joined};
use super::lattice::Lattice as Struts;
use super::lengths::{self, BadLength};
use super::pillars::{Ceilings, Pillar};
use super::pits;
use super::shell::Shell;
use super::surface;
use super::surface_nets::{Lattice, Nets};
use crate::grid::Grid;
use crate::ldi::{LdiError, cpu};
use crate::model::{Bounds, Mesh};
use crate::parallel;
use crate::progress::{Progress, report};

/// Options of hollowing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(default, deny_unknown_fields)]
pub struct Hollowing {
    /// Thickness of the walls: at least this everywhere, less the resolution that the report states. If 0, nothing is hollowed, and holes
    /// drain the closed cavities that the model has.
    pub wall_mm: f64,
    /// Diameter of the smallest cavity: a ball of this size fits into the void everywhere.
    pub cavity_mm: f64,
    /// Struts that are left standing in the void.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub infill: Option<Infill>,
    /// True if pillars hold ceilings of the void that are wider than a bridge of 5 mm.
    pub pillars: bool,
    /// Drain holes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub drains: Vec<Drain>,
    /// More drain holes, placed automatically.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub auto_drain: Option<AutoDrain>,
}

impl Default for Hollowing {
    /// Walls of 2 mm, and no cavity narrower than that.
    fn default() -> Self {
        Self {
            wall_mm: 2.0,
            cavity_mm: 2.0,
            infill: None,
            pillars: true,
            drains: Vec::new(),
            auto_drain: None,
        }
    }
}

/// Struts along the four space diagonals, which support themselves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(default, deny_unknown_fields)]
pub struct Infill {
    /// From one node of the lattice to the next, along the axes.
    pub spacing_mm: f64,
    /// Diameter of the struts.
    pub strut_mm: f64,
}

impl Default for Infill {
    /// Struts of 1 mm, 8 mm apart.
    fn default() -> Self {
        Self {
            spacing_mm: 8.0,
            strut_mm: 1.0,
        }
    }
}

/// The least walls. Thinner ones are below what resin holds, and what hollowing resolves.
pub(crate) const LEAST_WALL_MM: f64 = 0.4;

/// The thinnest struts.
const LEAST_STRUT_MM: f64 = 0.4;

/// The largest walls, cavities and holes: no plate is as wide.
const MOST_LENGTH_MM: f64 = 1000.0;

/// The narrowest drain holes.
const LEAST_DRAIN_MM: f64 = 0.5;

impl Hollowing {
    /// Checks the lengths.
    pub(crate) fn check(&self) -> Result<(), BadLength> {
        let of_infill = self.infill.map(|infill| {
            [
                ("hollow.infill.strut_mm", infill.strut_mm, LEAST_STRUT_MM),
                (
                    "hollow.infill.spacing_mm",
                    infill.spacing_mm,
                    2.0 * infill.strut_mm,
                ),
            ]
        });
        let least_wall_mm = if self.drains_alone() {
            0.0
        } else {
            LEAST_WALL_MM
        };
        let lengths = [
            ("hollow.wall_mm", self.wall_mm, least_wall_mm),
            ("hollow.cavity_mm", self.cavity_mm, 0.0),
        ];
        let of_drains = self.drains.iter();
        let of_drains = of_drains.map(|it| ("hollow.drains.diameter_mm", it.diameter_mm));
        let automatic = self.auto_drain.iter();
        let automatic = automatic.map(|it| ("hollow.auto_drain.diameter_mm", it.diameter_mm));
        let of_drains = of_drains.chain(automatic);
        let of_drains = of_drains.map(|(option, mm)| (option, mm, LEAST_DRAIN_MM));
        let lengths = lengths.into_iter().chain(of_infill.into_iter().flatten());
        let lengths = lengths.chain(of_drains);
        lengths::check(lengths, MOST_LENGTH_MM)
    }

    /// Returns true if holes drain the cavities that the model has, and nothing is hollowed.
    pub(crate) fn drains_alone(&self) -> bool {
        self.wall_mm == 0.0
    }
}

/// The void in a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Void {
    /// Its surface, without drain holes.
    pub shell: Shell,
    /// Pillars that hold its ceilings.
    pub pillars: Vec<Pillar>,
    /// Each drain hole that meets it, and its surface.
    pub drains: Vec<(Drain, Shell)>,
    /// Drain holes that meet no void, by their places among those asked for.
    pub astray: Vec<usize>,
    /// Basins that stay full, since nothing leads out of them on a level or downward.
    pub undrained: usize,
    /// Walls may be thinner than asked by this, and are a third of it thicker on average.
    pub resolution_mm: f64,
    /// The cavities of the model that are not joined to it, if there are any.
    pub closed: Option<Closed>,
}

/// Columns in the thickness of a wall: the error of a column is at most an eighth of it.
const COLUMNS_OF_WALL: f64 = 8.0;

/// Columns in the thickness of a strut.
const COLUMNS_OF_STRUT: f64 = 6.0;

/// The same for the thinnest walls and on the largest models.
const LEAST_COLUMNS_OF_WALL: f64 = 3.0;

/// The finest columns of all others.
const LEAST_PITCH_MM: f64 = 0.125;

/// The most points at which distances are found.
const MOST_POINTS: f64 = 2e8;

/// The most columns of a model: as many as a plate of 600 by 600 mm has at the coarsest for walls of 0.4 mm.
const MOST_COLUMNS: usize = 25_000_000;

/// Columns of a slice that takes tens of milliseconds.
const LARGE_SLICE: usize = 1_000_000;

/// Bytes that a column takes while distances are found.
const COLUMN_BYTES: f64 = 64.0;

/// No model that is printed is as long.
const MOST_MM: f64 = 1e5;

/// Columns from one node of the void's surface to the next.
const STRIDE: usize = 2;

/// Greatest depth of a basin that may be missed, in distances between nodes of the void's surface.
const PIT: f32 = 2.0;

/// The void in a model that stands on the plate: none if it is nowhere thick enough, or if the model has no closed cavity of its own where
/// only these are drained.
///
/// `weights` are those of the facets of the surface, if they say where no drain hole should be.
///
/// Cost: linear in the points of the lattice, times the columns in a wall and half a cavity.
///
/// # Errors
/// [`LdiError::Cancelled`], [`LdiError::OutOfMemory`], [`LdiError::TooManyFacets`].
pub fn hollow(
    mesh: &Mesh,
    hollowing: &Hollowing,
    weights: Option<&[f32]>,
    progress: &mut Progress<'_>,
) -> Result<Option<Void>, LdiError> {
    let bounds = mesh.bounds();
    let size = bounds.size();
    // The largest ball of void with its wall must fit.
    let least_mm = 2.0 * hollowing.wall_mm + hollowing.cavity_mm;
    let is_too_thin = !hollowing.drains_alone() && least_mm > size.min_element();
    if is_too_thin || size.max_element() > MOST_MM {
        return Ok(None);
    }
    let pitch_mm = pitch_mm(hollowing, size.x * size.y * size.z);
    let grid = grid_of(&bounds, pitch_mm)?;
    let ldi = cpu::sample(mesh, &grid, &mut |fraction| progress(0.1 * fraction))?;
    let model = Columns::of_model(&ldi);
    drop(ldi);
    let half_mm = (hollowing.cavity_mm / 2.0) as f32;
    // The outside is found half a column too far away on average.
    let error_mm = pitch_mm as f32 / 2.0;
    let depth_mm = hollowing.wall_mm as f32 + half_mm + error_mm;
    let depth_mm = (!hollowing.drains_alone()).then_some(depth_mm);
    let cavities = Cavities::of(&model);
    // Struts hold the shell of a cavity, and would end in the air in one that has none.
    let has_struts = hollowing.infill.is_some() && !hollowing.drains_alone();
    let may_join = vec![!has_struts; cavities.all.len()];
    let Joined {
        model,
        cavities: joined,
        closed,
        core,
    } = joined(model, &cavities, may_join, depth_mm, &mut |fraction| {
        progress(0.1 + 0.5 * fraction)
    })?;
    let struts = hollowing.infill.filter(|_| has_struts);
    let struts = struts.map(|infill| Struts::new(&infill));
    // So is the core.
    let reach_mm = half_mm + error_mm;
    let joined_mm = joined.as_ref().and_then(Columns::extent_mm);
    let extents = core.extent_mm().into_iter().chain(joined_mm);
    let Some([low_mm, high_mm]) = extents.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]) else {
        report(progress, 1.0)?;
        return Ok(None);
    };
    let lattice = lattice_of(&model, &grid, low_mm - reach_mm);
    let slices = Slices {
        lattice,
        // The lowest slice is outside, and so is the last.
        count: ((high_mm - low_mm + 2.0 * reach_mm) / lattice.spacing_mm) as usize + 4,
        core: &core,
        joined: joined.as_ref(),
        reach_mm,
        most_mm: reach_mm + 2.0 * lattice.spacing_mm,
        struts: struts.as_ref(),
        has_basins: hollowing.auto_drain.is_some(),
    };
    let Depths {
        field,
        is_cavity,
        basins,
    } = slices.depths(&mut |fraction| progress(0.6 + 0.3 * fraction))?;
    let slices = slices.count;
    let (mut automatic, mut undrained) = (Vec::new(), 0);
    if let Some(hole) = hollowing.auto_drain {
        // A hole as wide as the model would remove all of it.
        let is_small = hole.diameter_mm < size.min_element();
        // The radius that the hole cuts away, or the resolution of the columns if that is larger.
        let reach_mm = (hole.diameter_mm / 2.0).max(2.0 * pitch_mm);
        let is_protected =
            surface::protected_within(mesh, weights.filter(|_| hole.protect), reach_mm);
        let place = |lowest_mm| {
            let place = || drain::place(&model, &lattice, lowest_mm, hole, &is_protected);
            is_small.then(place).flatten()
        };
        (automatic, undrained) = holes_of(basins, &lattice, &place, progress)?;
    }
    let mut standing = Standing {
        lattice,
        struts,
        pillars: Vec::new(),
        holes: hollowing.drains.iter().chain(&automatic).copied().collect(),
        hole_mm: 2.0 * f64::from(depth_mm.unwrap_or(half_mm)),
        below: Vec::new(),
    };
    if hollowing.pillars && !hollowing.drains_alone() {
        standing.hold_ceilings(&field, &is_cavity, progress)?;
    }
    let mut nets = Nets::new(lattice);
    for slice in 0..slices {
        report(progress, 0.95 + 0.05 * slice as f64 / slices as f64)?;
        let mut depths_mm = field.slice(slice);
        standing.leave(slice, &mut depths_mm);
        nets.add(depths_mm);
    }
    let shell = nets.finish();
    report(progress, 1.0)?;
    if shell.facets.is_empty() {
        return Ok(None);
    }
    let mut void = Void {
        shell,
        pillars: standing.pillars,
        drains: Vec::new(),
        astray: Vec::new(),
        undrained,
        resolution_mm: pitch_mm,
        closed: closed_of(&cavities, &closed, &lattice, model.pitch_mm),
    };
    void.drill_all(&hollowing.drains, &automatic, &bounds, progress)?;
    void.fill_pits(lattice.spacing_mm);
    Ok(Some(void))
}

/// The holes that `place` gives for the lowest point of each basin, and the number of basins that stay full.
fn holes_of(
    basins: Basins,
    lattice: &Lattice,
    place: &dyn Fn(Vec3) -> Option<Drain>,
    progress: &mut Progress<'_>,
) -> Result<(Vec<Drain>, usize), LdiError> {
    let (mut holes, mut undrained) = (Vec::new(), 0);
    for (slice, node) in basins.finish() {
        report(progress, 0.9)?;
        match place(lattice.node_mm(node % lattice.width, node / lattice.width, slice)) {
            Some(hole) => holes.push(hole),
            None => undrained += 1,
        }
    }
    Ok((holes, undrained))
}

impl Void {
    /// Adds the drain holes that are asked for, and notes those that meet no void; then those that are placed automatically.
    fn drill_all(
        &mut self,
        drains: &[Drain],
        automatic: &[Drain],
        bounds: &Bounds,
        progress: &mut Progress<'_>,
    ) -> Result<(), LdiError> {
        for (place, drain) in drains.iter().enumerate() {
            report(progress, 1.0)?;
            if !self.drill(drain, bounds) {
                self.astray.push(place);
            }
        }
        for drain in automatic {
            report(progress, 1.0)?;
            self.undrained += usize::from(!self.drill(drain, bounds));
        }
        Ok(())
    }

    /// Adds a drain hole; `false` if it does not meet the void.
    fn drill(&mut self, drain: &Drain, bounds: &Bounds) -> bool {
        let Some((shell, depth_mm)) = drain::bore(&self.shell, drain, bounds) else {
            return false;
        };
        let drilled = Drain {
            depth_mm: Some(depth_mm),
            ..*drain
        };
        self.drains.push((drilled, shell));
        true
    }

    /// Fills the pits that basins may have missed.
    fn fill_pits(&mut self, spacing_mm: f32) {
        if self.drains.is_empty() {
            return;
        }
        let vertices = &self.shell.vertices;
        let mut outlets = vec![false; vertices.len()];
        for (drain, _) in &self.drains {
            let is_within = drain::within(drain, 0.0, spacing_mm.into());
            for (&vertex, outlet) in vertices.iter().zip(&mut outlets) {
                *outlet |= is_within(vertex);
            }
        }
        pits::fill(&mut self.shell, PIT * spacing_mm, &outlets);
    }
}

/// The columns of a model's box.
fn grid_of(bounds: &Bounds, pitch_mm: f64) -> Result<Grid, LdiError> {
    let grid = Grid::of_pitch(bounds, pitch_mm).ok();
    grid.filter(|grid| grid.pixels() <= MOST_COLUMNS)
        .ok_or_else(|| {
            let size = bounds.size();
            let columns = size.x * size.y / (pitch_mm * pitch_mm);
            LdiError::OutOfMemory {
                hits: columns as u64,
                needed_bytes: (columns * COLUMN_BYTES) as u64,
            }
        })
}

/// Makes depths in the void of distances to its core, and of depths in cavities that are joined to it, if there are any.
fn depths(distances: &mut [f32], reach_mm: f32, cavities: Option<Vec<f32>>, pitch_mm: f32) {
    for distance in distances.iter_mut() {
        *distance = reach_mm - *distance;
    }
    for (depth, within_mm) in distances.iter_mut().zip(cavities.into_iter().flatten()) {
        // Within its walls by as much as columns do not resolve.
        *depth = depth.max(within_mm - pitch_mm);
    }
}

/// Takes struts out of the void in a slice.
fn leave_standing(struts: &Struts, lattice: &Lattice, slice: usize, field: &mut [f32]) {
    let inside = field.iter_mut().enumerate().filter(|it| *it.1 > 0.0);
    for (place, field) in inside {
        let (column, row) = (place % lattice.width, place / lattice.width);
        *field = field.min(struts.distance_mm(lattice.node_mm(column, row, slice)));
    }
}

/// Slices of the void.
struct Slices<'a> {
    lattice: Lattice,
    count: usize,
    core: &'a Columns,
    joined: Option<&'a Columns>,
    /// Distance of the void's surface from its core.
    reach_mm: f32,
    /// The largest distance that matters.
    most_mm: f32,
    struts: Option<&'a Struts>,
    /// True if basins are looked for.
    has_basins: bool,
}

/// Depths in the void, and what follows from them.
struct Depths {
    field: Field,
    /// Columns of nodes that pass a cavity, in which nothing stands.
    is_cavity: Vec<bool>,
    basins: Basins,
}

impl Slices<'_> {
    fn depths(&self, progress: &mut Progress<'_>) -> Result<Depths, LdiError> {
        let lattice = self.lattice;
        let nodes = lattice.width * lattice.height;
        let mut basins = Basins::new(lattice.width, nodes, lattice.spacing_mm);
        let mut field = Field::default();
        let mut is_cavity = vec![false; nodes];
        let group = slices_at_a_time(self.core);
        for from in (0..self.count).step_by(group) {
            report(progress, from as f64 / self.count as f64)?;
            let these = from..(from + group).min(self.count);
            let heights_mm = these.clone().map(|it| lattice.node_mm(0, 0, it).z);
            let heights_mm: Vec<f32> = heights_mm.collect();
            let to_core = self.core;
            let distances = to_core.distances_mm(To::Solid, &heights_mm, self.most_mm, STRIDE);
            let within = self.joined.map_or_else(Vec::new, |joined| {
                joined.distances_mm(To::Outside, &heights_mm, self.most_mm, STRIDE)
            });
            let mut within = within.into_iter();
            for (mut depths_mm, slice) in distances.into_iter().zip(these) {
                let within = within.next();
                for (is_cavity, within_mm) in is_cavity.iter_mut().zip(within.iter().flatten()) {
                    *is_cavity |= *within_mm > 0.0;
                }
                depths(&mut depths_mm, self.reach_mm, within, self.core.pitch_mm);
                field.push(&depths_mm, self.reach_mm - self.most_mm);
                if !self.has_basins {
                    continue;
                }
                if let Some(struts) = self.struts {
                    leave_standing(struts, &lattice, slice, &mut depths_mm);
                }
                basins.add(&depths_mm);
            }
        }
        Ok(Depths {
            field,
            is_cavity,
            basins,
        })
    }
}

/// Depths in the void by slices, as runs of equal numbers: they differ only near its surface.
#[derive(Default)]
struct Field {
    runs: Vec<(f32, u32)>,
    /// The end of each slice in `runs`.
    ends: Vec<usize>,
}

impl Field {
    /// Appends a slice. Depths below `least_mm` are as good as that.
    fn push(&mut self, depths_mm: &[f32], least_mm: f32) {
        let from = self.runs.len();
        for depth_mm in depths_mm.iter().map(|it| it.max(least_mm)) {
            match self.runs[from..].last_mut() {
                Some((last, count)) if *last == depth_mm => *count += 1,
                _ => self.runs.push((depth_mm, 1)),
            }
        }
        self.ends.push(self.runs.len());
    }

    fn slice(&self, slice: usize) -> Vec<f32> {
        let from = slice.checked_sub(1).map_or(0, |before| self.ends[before]);
        let runs = self.runs[from..self.ends[slice]].iter();
        runs.flat_map(|&(depth_mm, count)| std::iter::repeat_n(depth_mm, count as usize))
            .collect()
    }
}

/// Struts and pillars that are left standing in a void.
struct Standing {
    lattice: Lattice,
    struts: Option<Struts>,
    pillars: Vec<Pillar>,
    holes: Vec<Drain>,
    /// Depth of holes that end where all of them is in the void.
    hole_mm: f64,
    /// Nodes of the last slice that are not void; none before the first.
    below: Vec<bool>,
}

/// Least distance of a pillar's middle from a drain hole.
const BESIDE_HOLE_MM: f64 = 1.0;

impl Standing {
    /// Adds the pillars that hold ceilings.
    fn hold_ceilings(
        &mut self,
        field: &Field,
        is_cavity: &[bool],
        progress: &mut Progress<'_>,
    ) -> Result<(), LdiError> {
        let lattice = self.lattice;
        let holes = self.holes.iter();
        let is_in_hole = holes.map(|it| drain::within(it, self.hole_mm, BESIDE_HOLE_MM));
        let is_in_hole: Vec<_> = is_in_hole.collect();
        let is_blocked = |pillar: &Pillar| {
            let node = (pillar.top_mm - lattice.origin_mm) / lattice.spacing_mm;
            let node = (0.5 - node.y) as usize * lattice.width + (node.x + 0.5) as usize;
            let steps = ((pillar.top_mm.z - pillar.bottom_mm) / lattice.spacing_mm) as usize + 1;
            let mut at = (0..=steps).map(|step| {
                pillar
                    .top_mm
                    .with_z(pillar.bottom_mm + step as f32 * lattice.spacing_mm)
            });
            is_cavity[node] || at.any(|at| is_in_hole.iter().any(|holds| holds(at)))
        };
        let mut ceilings = Ceilings::new(lattice);
        let slices = field.ends.len();
        for slice in 0..slices {
            report(progress, 0.9 + 0.05 * slice as f64 / slices as f64)?;
            let mut depths_mm = field.slice(slice);
            self.leave(slice, &mut depths_mm);
            ceilings.add(&depths_mm, &is_blocked);
        }
        self.below = Vec::new();
        self.pillars = ceilings.pillars;
        Ok(())
    }

    /// Takes what is left standing out of the void in the next slice: struts and pillars as far as they stand on something.
    fn leave(&mut self, slice: usize, depths_mm: &mut [f32]) {
        if self.struts.is_none() && self.pillars.is_empty() {
            return;
        }
        let of_void = depths_mm.to_vec();
        if let Some(struts) = &self.struts {
            leave_standing(struts, &self.lattice, slice, depths_mm);
        }
        for pillar in &self.pillars {
            pillar.leave_standing(&self.lattice, slice, depths_mm);
        }
        let Lattice { width, .. } = self.lattice;
        // Between two nodes, the edge of a hole may part what hangs together at both.
        let spacing_mm = f64::from(self.lattice.spacing_mm);
        let [near, within] = [spacing_mm, 0.0].map(|beside_mm| {
            let holes = self.holes.iter();
            let holes = holes.map(|hole| drain::within(hole, self.hole_mm, beside_mm));
            holes.collect::<Vec<_>>()
        });
        let node_mm = |node: usize, slice| self.lattice.node_mm(node % width, node / width, slice);
        let stands = |node: usize, depths_mm: &[f32]| {
            of_void[node] > 0.0
                && depths_mm[node] <= 0.0
                && !near.iter().any(|is_near| is_near(node_mm(node, slice)))
        };
        // Holes cut walls, too.
        let holds = |below: usize| {
            let is_cut = || within.iter().any(|cuts| cuts(node_mm(below, slice - 1)));
            self.below[below] && !is_cut()
        };
        let is_standing: Vec<bool> = (0..of_void.len()).map(|it| stands(it, depths_mm)).collect();
        // Parts that nothing below holds are left out, where a hole cuts what stands.
        let mut is_held = vec![false; of_void.len()];
        let mut next: Vec<usize> = (0..of_void.len())
            .filter(|&it| is_standing[it] && (self.below.is_empty() || holds(it)))
            .collect();
        for &node in &next {
            is_held[node] = true;
        }
        while let Some(node) = next.pop() {
            for beside in self.around(node) {
                if is_standing[beside] && !is_held[beside] {
                    is_held[beside] = true;
                    next.push(beside);
                }
            }
        }
        for (node, depth_mm) in depths_mm.iter_mut().enumerate() {
            if of_void[node] > 0.0 && *depth_mm <= 0.0 && !is_held[node] {
                *depth_mm = of_void[node];
            }
        }
        self.below = depths_mm.iter().map(|&it| it <= 0.0).collect();
    }

    /// A node and those beside it in its slice. Between others, surfaces may pass.
    fn around(&self, node: usize) -> impl Iterator<Item = usize> + use<> {
        let Lattice { width, height, .. } = self.lattice;
        let (column, row) = (node % width, node / width);
        let in_row = column.saturating_sub(1)..(column + 2).min(width);
        let in_column = row.saturating_sub(1)..(row + 2).min(height);
        let in_row = in_row.map(move |column| row * width + column);
        in_row.chain(in_column.map(move |row| row * width + column))
    }
}

/// Slices that are made before progress is reported: some for each thread, and fewer of large ones.
fn slices_at_a_time(model: &Columns) -> usize {
    let threads = parallel::threads();
    if model.width * model.height > LARGE_SLICE {
        threads
    } else {
        8 * threads
    }
}

/// The pitch of columns: fine compared with the wall, but coarse enough to keep the number of points within
/// `MOST_POINTS`.
fn pitch_mm(hollowing: &Hollowing, box_mm3: f64) -> f64 {
    let wall_mm = if hollowing.drains_alone() {
        Hollowing::default().wall_mm
    } else {
        hollowing.wall_mm
    };
    let most_mm = wall_mm / LEAST_COLUMNS_OF_WALL;
    let of_struts_mm = hollowing
        .infill
        .map(|infill| infill.strut_mm / COLUMNS_OF_STRUT);
    let mut pitch_mm = (wall_mm / COLUMNS_OF_WALL)
        .min(of_struts_mm.unwrap_or(f64::INFINITY))
        .max(LEAST_PITCH_MM)
        .min(most_mm);
    // By a factor that is exact, and so the same on every machine.
    while box_mm3 / (STRIDE as f64 * pitch_mm * pitch_mm * pitch_mm) > MOST_POINTS {
        pitch_mm *= 1.25;
        if pitch_mm >= most_mm {
            return most_mm;
        }
    }
    pitch_mm
}

/// The nodes of the void's surface: every second column of every second row, and slices as far apart, the first of which is below
/// `bottom_mm`.
fn lattice_of(model: &Columns, grid: &Grid, bottom_mm: f32) -> Lattice {
    let corner = grid.centre_mm(0, 0).as_vec2();
    let margin_mm = MARGIN as f32 * model.pitch_mm;
    let spacing_mm = STRIDE as f32 * model.pitch_mm;
    Lattice {
        width: model.width.div_ceil(STRIDE),
        height: model.height.div_ceil(STRIDE),
        spacing_mm,
        origin_mm: Vec3::new(
            corner.x - margin_mm,
            corner.y + margin_mm,
            bottom_mm - spacing_mm,
        ),
    }
}

/// The points of the model that are at least this deep below its surface.
pub(super) fn core(
    model: &Columns,
    depth_mm: f32,
    progress: &mut Progress<'_>,
) -> Result<Columns, LdiError> {
    let mut changes = Vec::new();
    let Some([low_mm, high_mm]) = model.extent_mm() else {
        return Ok(model.of_changes(&changes));
    };
    let step_mm = STRIDE as f32 * model.pitch_mm;
    let slices = ((high_mm - low_mm) / step_mm) as usize + 2;
    let height_mm = |slice: usize| low_mm + (slice as f32 - 0.5) * step_mm;
    let group = slices_at_a_time(model);
    // At the lowest and the highest slice nothing is inside.
    let mut below = vec![0.0; model.width * model.height];
    for from in (1..=slices).step_by(group) {
        report(progress, from as f64 / slices as f64)?;
        let these = from..(from + group).min(slices + 1);
        let heights_mm: Vec<f32> = these.clone().map(height_mm).collect();
        let distances = model.distances_mm(To::Outside, &heights_mm, depth_mm + 2.0 * step_mm, 1);
        for (here, slice) in distances.into_iter().zip(these) {
            for (column, (&below_mm, &here_mm)) in below.iter().zip(&here).enumerate() {
                if (below_mm < depth_mm) != (here_mm < depth_mm) {
                    let part = (depth_mm - below_mm) / (here_mm - below_mm);
                    let z_mm = height_mm(slice - 1) + part * step_mm;
                    changes.push((column as u32, z_mm));
                }
            }
            below = here;
        }
    }
    Ok(model.of_changes(&changes))
}
