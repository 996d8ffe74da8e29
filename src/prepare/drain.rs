//! Drain holes: straight channels from the outside into a void, as bodies of the void's class.

use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};

use super::columns::Columns;
use super::round::{circle, rim};
use super::shell::Shell;
use super::surface_nets::Lattice;
use crate::model::Bounds;

/// A drain hole.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(deny_unknown_fields)]
pub struct Drain {
    /// The point where it enters the model, in the frame of reports: centred on x = y = 0, with the plate at z = 0.
    pub at_mm: [f64; 3],
    /// Its inward direction, of any length but 0.
    pub direction: [f64; 3],
    /// Its diameter.
    pub diameter_mm: f64,
    /// Its depth; if absent, it goes on until all of it is in the void.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub depth_mm: Option<f64>,
}

/// Drain holes that are placed automatically: one for each basin of the void, by the shortest way out.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(default, deny_unknown_fields)]
pub struct AutoDrain {
    /// Diameter of the holes.
    pub diameter_mm: f64,
    /// True if they keep off facets that weigh more than a half, where another way leads out. Resin that stays inside is worse than a
    /// hole that shows.
    #[serde(alias = "spare")]
    pub protect: bool,
}

impl Default for AutoDrain {
    /// Holes of 3 mm, through which resin flows in seconds.
    fn default() -> Self {
        Self {
            diameter_mm: 3.0,
            protect: false,
        }
    }
}

/// Doublings from four points of a circle to those of a hole.
pub(super) const DOUBLINGS: u32 = 3;

/// No plate is as wide or as high.
const MOST_MM: f64 = 1e5;

/// A hole that has a place.
struct Bore {
    at: DVec3,
    /// A unit vector.
    along: DVec3,
    /// The points of its rim, from its middle.
    rim: Vec<DVec3>,
}

impl Bore {
    /// `None` if its direction has no length, or if it is farther away or larger than any plate.
    fn new(drain: &Drain) -> Option<Self> {
        let numbers = drain
            .at_mm
            .into_iter()
            .chain([drain.diameter_mm])
            .chain(drain.depth_mm);
        if !numbers.into_iter().all(|mm| mm.abs() <= MOST_MM)
            || drain.depth_mm.is_some_and(|mm| mm <= 0.0)
        {
            return None;
        }
        let direction = DVec3::from_array(drain.direction);
        // By its largest component first, so that no square overflows.
        let direction = direction / direction.abs().max_element();
        let along = direction / direction.length();
        if !along.is_finite() {
            return None;
        }
        let rim = rim(along, drain.diameter_mm / 2.0, DOUBLINGS);
        Some(Self {
            at: DVec3::from_array(drain.at_mm),
            along,
            rim,
        })
    }

    /// Depth at which the whole width of the hole is in the void of a shell; `None` if its axis never is.
    fn depth_mm(&self, shell: &Shell) -> Option<f64> {
        let near = self.near(shell);
        let [enters, leaves] = first_mm(&near, self.at, self.along)?;
        // A rim enters a slanted wall later, or misses the void.
        let rims = self.rim.iter();
        let rims = rims.filter_map(|&rim| first_mm(&near, self.at + rim, self.along));
        Some(rims.map(|rim| rim[0]).fold(enters, f64::max).min(leaves))
    }

    /// Returns true if the hole meets the void of a shell within a depth.
    fn meets(&self, shell: &Shell, depth_mm: f64) -> bool {
        let near = self.near(shell);
        let lines = self.rim.iter().chain([&DVec3::ZERO]);
        let mut enters = lines.filter_map(|&rim| first_mm(&near, self.at + rim, self.along));
        enters.any(|enters| enters[0] <= depth_mm)
    }

    /// The facets that the hole may meet.
    fn near(&self, shell: &Shell) -> Vec<[DVec3; 3]> {
        let radius_mm = self.rim[0].length();
        let facets = shell.facets.iter();
        let facets = facets.map(|it| it.map(|vertex| shell.vertices[vertex as usize].as_dvec3()));
        let is_near = |[a, b, c]: &[DVec3; 3]| {
            let from = *a - self.at;
            let away_mm = (from - self.along * from.dot(self.along)).length();
            away_mm - a.distance(*b).max(a.distance(*c)) <= radius_mm
        };
        facets.filter(is_near).collect()
    }

    /// The bore between two depths with a lid at both ends, clipped to the model's box, which is above the plate: rays
    /// are sampled only there.
    fn shell(&self, from_mm: f64, to_mm: f64, bounds: &Bounds) -> Shell {
        let sides = self.rim.len() as u32;
        let (low, high) = (bounds.min, bounds.max);
        let point = |rim: DVec3, along_mm: f64| {
            let begin = self.at + rim;
            // The stretch of its line that is within the box.
            let (mut first_mm, mut last_mm) = (from_mm, to_mm);
            for axis in 0..3 {
                let ends = [low[axis], high[axis]];
                let ends = ends.map(|end| (end - begin[axis]) / self.along[axis]);
                if ends.iter().all(|end| end.is_finite()) {
                    first_mm = first_mm.max(ends[0].min(ends[1]));
                    last_mm = last_mm.min(ends[0].max(ends[1]));
                }
            }
            let within_mm = along_mm.min(last_mm).max(first_mm).clamp(from_mm, to_mm);
            (begin + self.along * within_mm).clamp(low, high).as_vec3()
        };
        let mut shell = Shell::default();
        for along_mm in [from_mm, to_mm] {
            let rim = self.rim.iter().map(|&rim| point(rim, along_mm));
            shell.vertices.extend(rim);
        }
        shell
            .vertices
            .extend([from_mm, to_mm].map(|along_mm| point(DVec3::ZERO, along_mm)));
        let lids = [2 * sides, 2 * sides + 1];
        for side in 0..sides {
            let next = (side + 1) % sides;
            let (a, b, c, d) = (side, next, sides + next, sides + side);
            shell.facets.extend([[a, b, c], [a, c, d]]);
            shell.facets.extend([[lids[0], b, a], [lids[1], d, c]]);
        }
        shell
    }
}

/// Distances in millimetres from the start of a ray outside a closed surface to its first entry and the exit that
/// follows.
fn first_mm(facets: &[[DVec3; 3]], from: DVec3, along: DVec3) -> Option<[f64; 2]> {
    let crossings = facets.iter().filter_map(|corners| {
        let [a, b, c] = corners.map(|corner| corner - from);
        // Signed volumes with the ray.
        let sides = [b.cross(c), c.cross(a), a.cross(b)].map(|it| it.dot(along));
        let normal = (b - a).cross(c - a);
        let across = normal.dot(along);
        let is_met = sides.iter().all(|&side| side <= 0.0) || sides.iter().all(|&side| side >= 0.0);
        let at_mm = normal.dot(a) / across;
        (is_met && at_mm > 0.0 && at_mm.is_finite()).then_some((at_mm, across < 0.0))
    });
    let crossings: Vec<(f64, bool)> = crossings.collect();
    let first = |wants_entry: bool, after_mm: f64| {
        let those = crossings
            .iter()
            .filter(|&&(at_mm, is_entry)| is_entry == wants_entry && at_mm > after_mm);
        those.map(|it| it.0).reduce(f64::min)
    };
    let enters = first(true, 0.0)?;
    Some([enters, first(false, enters)?])
}

/// The hole as a body, and its depth; `None` if it does not meet the void.
///
/// It begins a diameter before its place, so that a slanted surface does not close a part of it.
pub(super) fn bore(shell: &Shell, drain: &Drain, bounds: &Bounds) -> Option<(Shell, f64)> {
    let bore = Bore::new(drain)?;
    let depth_mm = match drain.depth_mm {
        Some(depth_mm) => bore.meets(shell, depth_mm).then_some(depth_mm)?,
        None => bore.depth_mm(shell)?,
    };
    let begin_mm = -drain.diameter_mm;
    Some((bore.shell(begin_mm, depth_mm, bounds), depth_mm))
}

/// Returns true for points that are in a hole, or no farther from it than a margin. Holes without a depth are taken to be as deep as
/// `depth_mm`.
pub(super) fn within(
    drain: &Drain,
    depth_mm: f64,
    margin_mm: f64,
) -> impl Fn(Vec3) -> bool + use<> {
    let bore = Bore::new(drain);
    let depth_mm = drain.depth_mm.unwrap_or(depth_mm);
    let diameter_mm = drain.diameter_mm;
    move |point| {
        bore.as_ref().is_some_and(|bore| {
            let from = point.as_dvec3() - bore.at;
            let along_mm = from.dot(bore.along);
            let away_mm = (from - bore.along * along_mm).length();
            (-diameter_mm..=depth_mm + margin_mm).contains(&along_mm)
                && away_mm <= diameter_mm / 2.0 + margin_mm
        })
    }
}

/// Distance that a bore goes beyond the void it drains, so that its end does not close it, in diameters.
pub(super) const BEYOND: f64 = 0.25;

/// Free distance that a hole needs outside, in diameters.
const ROOM: f32 = 2.0;

/// The least distance of a hole from the plate, which would close it.
const ABOVE_PLATE_MM: f32 = 0.2;

/// Places a hole that drains a basin by the shortest way, first of those that end on facets that are not protected: level
/// or slanting down, since a hole that leads up would leave resin in. `None` if there is no such way.
pub(super) fn place(
    model: &Columns,
    lattice: &Lattice,
    lowest_mm: Vec3,
    hole: AutoDrain,
    is_protected: &dyn Fn(Vec3) -> bool,
) -> Option<Drain> {
    let diameter_mm = hole.diameter_mm as f32;
    let radius_mm = diameter_mm / 2.0;
    // A level hole begins below the basin, and has as much of the wall below it as is left of it above.
    let level_mm = Vec3::new(lowest_mm.x, lowest_mm.y, lowest_mm.z + radius_mm / 2.0);
    let around = circle(2).into_iter().map(|[x, y]| [x as f32, y as f32]);
    let slant = 0.5f32.sqrt();
    let ways = around
        .clone()
        .map(|[x, y]| (level_mm, Vec3::new(x, y, 0.0)));
    let ways = ways.chain(around.map(|[x, y]| (lowest_mm, Vec3::new(x, y, -1.0) * slant)));
    let ways = ways.chain([(lowest_mm, Vec3::NEG_Z)]);
    let mut best: Option<((bool, f32), Vec3, Vec3)> = None;
    for (from, along) in ways {
        let Some(length_mm) = way_out_mm(model, lattice, from, along, ROOM * diameter_mm) else {
            continue;
        };
        let end = from + along * length_mm;
        // A hole that slants through an upright wall reaches farther down than its radius.
        let below_mm = if along.z < 0.0 {
            radius_mm / slant
        } else {
            radius_mm
        };
        if end.z - below_mm < ABOVE_PLATE_MM {
            continue;
        }
        let cost = (is_protected(end), length_mm);
        if best.is_none_or(|best| cost < best.0) {
            best = Some((cost, end, along));
        }
    }
    let ((_, length_mm), at, along) = best?;
    // As people write them, so that a report's holes can be given again; without -0.
    let rounded = |number: f32| (f64::from(number) * 1e3).round() / 1e3 + 0.0;
    Some(Drain {
        at_mm: at.to_array().map(rounded),
        direction: (-along).to_array().map(rounded),
        diameter_mm: hole.diameter_mm,
        depth_mm: Some(rounded(length_mm) + BEYOND * hole.diameter_mm),
    })
}

/// Distance to the outside, if the way is free for `room_mm` from there.
fn way_out_mm(
    model: &Columns,
    lattice: &Lattice,
    from: Vec3,
    along: Vec3,
    room_mm: f32,
) -> Option<f32> {
    let step_mm = model.pitch_mm / 2.0;
    let is_solid = |step: usize| {
        let at = from + along * (step as f32 * step_mm) - lattice.origin_mm;
        let z_mm = at.z + lattice.origin_mm.z;
        model.holds([at.x / model.pitch_mm, -at.y / model.pitch_mm], z_mm)
    };
    // No way is longer than all columns and their heights.
    let [low_mm, high_mm] = model.extent_mm()?;
    let most_mm = (model.width + model.height) as f32 * model.pitch_mm + high_mm - low_mm;
    let steps = (0..=(most_mm / step_mm) as usize).find(|&step| !is_solid(step))?;
    let room = (room_mm / step_mm) as usize;
    let is_free = (steps..steps + room).all(|step| !is_solid(step));
    is_free.then_some(steps as f32 * step_mm)
}
