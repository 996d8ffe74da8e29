//! Tips, the pillars below them, and how pillars join to trees.
//!
//! A contact's tip leads away from the surface. From its end a pillar goes down to the plate by the shortest way, or a branch to a pillar
//! that is there already, whichever is shorter. A pillar with more tips is thicker.

use glam::DVec3;

use super::clearance::{Clearance, End, is_steep};
use super::contacts::Contact;
use super::shapes::Shapes;
use super::{LEAST_CLEARANCE_MM, SupportProfile};
use crate::argsort;
use crate::ldi::LdiError;
use crate::prepare::round::circle;
use crate::prepare::shell::Shell;
use crate::progress::{Progress, report};

/// No node.
const NONE: u32 = u32::MAX;

/// The most tips that a pillar holds, and one that stands on the model.
const MOST_TIPS: u32 = 24;
const MOST_TIPS_ON_MODEL: u32 = 4;

/// Growth of a pillar's area with each tip beyond the first.
const GROWTH: f64 = 1.0 / 6.0;

/// The longest part of a pillar between two nodes. Branches join at nodes.
const PART_MM: f64 = 1.5;

/// Cost of a foot on the plate, as a length of pillar.
const FOOT_COST_MM: f64 = 5.0;

/// Number of nearest pillars that are tried.
const TRIES: usize = 12;

/// Clearances at which pillars are tried, as parts of what is asked.
const CLEARANCES: [f64; 3] = [1.0, 0.5, 0.2];

/// Lengths of tips that are tried, as parts of the usual one.
const LENGTHS: [f64; 3] = [1.0, 0.7, 0.4];

/// Part of the clearance that a pillar keeps where it is thicker so as not to buckle.
const STIFF: f64 = 0.8;

/// Diameter of a brace, as a part of a pillar's.
const BRACE: f64 = 0.7;

/// Diameter at the foot of a pillar on the model, in those of a contact.
const FOOT_ON_MODEL: f64 = 1.5;

/// Height over which a pillar widens to its foot on the plate, as a part of the foot's diameter.
const FLARE: f64 = 0.4;

/// The most that a floor may rise below a strut.
const MOST_STEP_MM: f64 = 0.3;

/// Least gap between feet on the plate.
const BETWEEN_FEET_MM: f64 = 0.6;

/// Least ratio of a foot's radius to its pillar's.
const WIDER: f64 = 1.2;

/// Length of a strut up to which only its two surfaces are near.
const CLOSE_MM: f64 = 1.0;

/// The thickest part of a strut between two surfaces, as a part of its length.
const STRUT: f64 = 0.3;

/// The largest distance from the model that a pillar's middle needs.
pub(super) fn most_mm(profile: &SupportProfile) -> f64 {
    radius_mm(profile, MOST_TIPS) + profile.clearance_mm
}

fn radius_mm(profile: &SupportProfile, tips: u32) -> f64 {
    let area = 1.0 + GROWTH * (f64::from(tips) - 1.0);
    profile.pillar_mm / 2.0 * area.sqrt()
}

/// A point of a pillar.
struct Node {
    at: DVec3,
    /// The node below, [`NONE`] at a foot.
    down: u32,
    /// The tips that it holds.
    tips: u32,
    /// The nodes that it is below of.
    above: u32,
    /// True if the pillar goes straight on here.
    is_straight: bool,
}

/// From a contact to the end of its tip.
struct Tip {
    at: DVec3,
    /// Away from the model.
    along: DVec3,
    end: DVec3,
    radius_mm: f64,
    end_mm: f64,
}

/// All supports of a model.
pub(super) struct Trees {
    clearance: Clearance,
    profile: SupportProfile,
    /// Distance that pillars keep from the model.
    clear_mm: f64,
    nodes: Vec<Node>,
    /// The lowest nodes, and the surface that they stand on.
    feet: Vec<(u32, End)>,
    tips: Vec<Tip>,
    /// Short supports between two surfaces of the model: their ends, radii there, and the radius halfway.
    struts: Vec<([DVec3; 2], [f64; 2], f64)>,
    braces: Vec<[DVec3; 2]>,
    /// Least radius of the pillar at each node, so that it does not buckle.
    least_mm: Vec<f64>,
}

/// Ways to hold a tip.
enum Hold {
    /// By a new pillar: its points from the highest down, and the surface that it stands on.
    Pillar(Vec<DVec3>, End),
    /// By a branch to this node.
    Branch(u32),
}

impl Trees {
    pub fn new(clearance: Clearance, profile: SupportProfile) -> Self {
        Self {
            clearance,
            profile,
            clear_mm: profile.clearance_mm,
            nodes: Vec::new(),
            feet: Vec::new(),
            tips: Vec::new(),
            struts: Vec::new(),
            braces: Vec::new(),
            least_mm: Vec::new(),
        }
    }

    fn plate_mm(&self) -> f64 {
        -self.profile.lift_mm
    }

    fn need_mm(&self) -> f64 {
        self.profile.pillar_mm / 2.0 + self.clear_mm
    }

    /// Supports contacts, closer to the model where nothing else reaches one. Returns those that are held, and those that nothing reaches,
    /// less those that would only share loads.
    pub fn add_all<'c>(
        &mut self,
        contacts: &'c [Contact],
        progress: &mut Progress<'_>,
    ) -> Result<(Vec<&'c Contact>, Vec<&'c Contact>), LdiError> {
        // From the highest down, so that others join a pillar as it passes.
        let order = argsort::argsort(contacts.iter().map(|it| -it.at.z));
        let mut left: Vec<&Contact> = order.iter().map(|&it| &contacts[it]).collect();
        let mut held = Vec::new();
        let count = contacts.len() as f64;
        for part in CLEARANCES {
            if left.is_empty() {
                break;
            }
            self.clear_mm = (part * self.profile.clearance_mm).max(LEAST_CLEARANCE_MM);
            self.clearance.find_ways(self.need_mm() as f32);
            let mut unheld = Vec::new();
            for contact in left {
                report(progress, held.len() as f64 / count)?;
                if self.add(contact) {
                    held.push(contact);
                } else if !contact.is_for_load {
                    unheld.push(contact);
                }
            }
            left = unheld;
        }
        self.clear_mm = self.profile.clearance_mm;
        Ok((held, left))
    }

    /// Supports a contact; `false` if there is no way to it. Contacts come from the highest down.
    fn add(&mut self, contact: &Contact) -> bool {
        let above_plate_mm = contact.at.z - self.plate_mm();
        if above_plate_mm > self.profile.tip_mm + self.profile.pillar_mm {
            let mut on_model = None;
            for tip in self.tips_at(contact) {
                let Some(hold) = self.hold(tip.end) else {
                    continue;
                };
                if self.end_of_hold(&hold) == End::Plate {
                    self.insert(tip, hold);
                    return true;
                }
                on_model.get_or_insert((tip, hold));
            }
            if let Some((tip, hold)) = on_model {
                self.insert(tip, hold);
                return true;
            }
        }
        self.add_strut(contact)
    }

    /// The tips that keep clear of the model, the best ones first: away from the surface, but by at most 45° from straight down.
    fn tips_at(&self, contact: &Contact) -> Vec<Tip> {
        let slant = 0.5f64.sqrt();
        let normal = contact.normal;
        let level = (normal.x * normal.x + normal.y * normal.y).sqrt();
        let away = if normal.z <= -slant || level == 0.0 {
            DVec3::new(normal.x, normal.y, -normal.z.abs())
        } else {
            DVec3::new(normal.x / level * slant, normal.y / level * slant, -slant)
        };
        let away = if level == 0.0 { DVec3::NEG_Z } else { away };
        let around = circle(1).into_iter();
        let around = around.map(|[x, y]| DVec3::new(x * slant, y * slant, -slant));
        let ways: Vec<DVec3> = [away, DVec3::NEG_Z].into_iter().chain(around).collect();
        let (radius_mm, end_mm) = (contact.diameter_mm / 2.0, self.profile.pillar_mm / 2.0);
        let tips = LENGTHS.iter().flat_map(|part| {
            ways.iter().filter_map(move |&along| {
                let end = contact.at + along * (self.profile.tip_mm * part);
                let tip = Tip {
                    at: contact.at,
                    along,
                    end,
                    radius_mm,
                    end_mm: end_mm.max(radius_mm),
                };
                self.is_clear(&tip).then_some(tip)
            })
        });
        tips.collect()
    }

    /// Returns true if a tip touches the model only where it should.
    fn is_clear(&self, tip: &Tip) -> bool {
        let need_mm = tip.end_mm + self.clear_mm;
        let is_free = |part: f64| {
            let radius_mm = tip.radius_mm + (tip.end_mm - tip.radius_mm) * part;
            let at = tip.at + (tip.end - tip.at) * part;
            f64::from(self.clearance.distance_mm(at)) >= radius_mm
        };
        let length_mm = tip.at.distance(tip.end);
        // On a slanted surface it is held at its side as well.
        f64::from(self.clearance.distance_mm(tip.end)) >= need_mm.min(0.7 * length_mm)
            && [0.5, 0.65, 0.8, 0.9].into_iter().all(is_free)
            && self.clearance.is_within(tip.end)
    }

    /// The shortest way to hold a point.
    fn hold(&self, at: DVec3) -> Option<Hold> {
        let own = self.clearance.way(at);
        let most_mm = own.map_or(f64::INFINITY, |own| own.0 + FOOT_COST_MM);
        let near = self.nodes.iter().enumerate().filter(|(_, node)| {
            let (x, y) = (at.x - node.at.x, at.y - node.at.y);
            x * x + y * y <= self.profile.branch_mm * self.profile.branch_mm
                && is_steep(at, node.at)
        });
        let near: Vec<(f64, u32)> = near
            .map(|(place, node)| (at.distance(node.at), place as u32))
            .filter(|it| it.0 < most_mm)
            .collect();
        let need_mm = self.need_mm() as f32;
        let joined = argsort::argsort(near.iter().map(|it| it.0)).into_iter();
        let joined = joined.map(|it| near[it].1).take(TRIES);
        let mut joined = joined.filter(|&node| {
            self.bears_more(node)
                && self
                    .clearance
                    .is_clear(at, self.nodes[node as usize].at, need_mm)
        });
        if let Some(node) = joined.next() {
            return Some(Hold::Branch(node));
        }
        let (_, node) = own?;
        let (points, end) = self.clearance.points(node);
        Some(Hold::Pillar(points, end))
    }

    fn end_of_hold(&self, hold: &Hold) -> End {
        match hold {
            Hold::Pillar(_, end) => *end,
            Hold::Branch(node) => self.end_of(*node),
        }
    }

    fn end_of(&self, mut node: u32) -> End {
        while self.nodes[node as usize].down != NONE {
            node = self.nodes[node as usize].down;
        }
        let foot = self.feet.iter().find(|foot| foot.0 == node);
        foot.map_or(End::Plate, |foot| foot.1)
    }

    /// Returns true if a pillar can hold a tip more: there must be room for it to be thicker.
    fn bears_more(&self, mut node: u32) -> bool {
        let end = self.end_of(node);
        let most = match end {
            End::Plate => MOST_TIPS,
            End::Model => MOST_TIPS_ON_MODEL,
        };
        loop {
            let Node { at, down, tips, .. } = self.nodes[node as usize];
            if tips >= most {
                return false;
            }
            if down == NONE {
                return true;
            }
            let need_mm = radius_mm(&self.profile, tips + 1) + self.clear_mm;
            // Above its foot on the model it cannot be clear of it.
            let is_foot = end == End::Model && self.nodes[down as usize].down == NONE;
            if !is_foot && f64::from(self.clearance.distance_mm(at)) < need_mm {
                return false;
            }
            node = down;
        }
    }

    fn insert(&mut self, tip: Tip, hold: Hold) {
        let mut points = vec![tip.end];
        let (mut down, end) = match hold {
            Hold::Branch(node) => {
                points.push(self.nodes[node as usize].at);
                (node, None)
            }
            Hold::Pillar(way, end) => {
                points.extend(way);
                (NONE, Some(end))
            }
        };
        // From the lowest point up.
        if let Some(end) = end {
            self.feet.push((self.nodes.len() as u32, end));
            let at = *points.last().unwrap_or(&tip.end);
            down = self.push(at, NONE, false);
        }
        for pair in points.windows(2).rev() {
            let [to, from] = [pair[0], pair[1]];
            let parts = (from.distance(to) / PART_MM).ceil().max(1.0);
            for part in 1..=parts as usize {
                let at = from + (to - from) * (part as f64 / parts);
                down = self.push(at, down, (part as f64) < parts);
            }
        }
        while down != NONE {
            self.nodes[down as usize].tips += 1;
            down = self.nodes[down as usize].down;
        }
        self.tips.push(tip);
    }

    fn push(&mut self, at: DVec3, down: u32, is_straight: bool) -> u32 {
        if let Some(below) = self.nodes.get_mut(down as usize) {
            below.above += 1;
        }
        self.nodes.push(Node {
            at,
            down,
            tips: 0,
            above: 0,
            is_straight,
        });
        self.nodes.len() as u32 - 1
    }

    /// Holds a contact straight from the surface below, or from the plate, where nothing else fits.
    fn add_strut(&mut self, contact: &Contact) -> bool {
        let top = contact.at;
        // Beyond the error of the columns.
        let below = top - DVec3::Z * 0.3;
        let floors_mm = self.clearance.floors_mm(below);
        let floors_mm = floors_mm.map(|it| it.map(f64::from));
        let [lowest_mm, highest_mm] = floors_mm.map(|it| it.unwrap_or(self.plate_mm()));
        if highest_mm - lowest_mm > MOST_STEP_MM {
            return false;
        }
        let [floor_mm, _] = floors_mm;
        let bottom_mm = lowest_mm;
        let bottom = DVec3::new(top.x, top.y, bottom_mm);
        let length_mm = top.z - bottom_mm;
        let middle = (top + bottom) * 0.5;
        let room_mm = f64::from(self.clearance.distance_mm(middle));
        // Between surfaces closer together than distances are known, they are all that is near.
        let room_mm = if length_mm < CLOSE_MM {
            room_mm.max(0.45 * length_mm)
        } else {
            room_mm
        };
        let end_mm = contact.diameter_mm / 2.0;
        let most_mm = (self.profile.pillar_mm / 2.0).max(end_mm);
        let middle_mm = most_mm.min(STRUT * length_mm).min(room_mm);
        if length_mm < 0.3 || length_mm > 4.0 * self.profile.tip_mm || middle_mm < end_mm * 0.7 {
            return false;
        }
        let foot_mm = if floor_mm.is_some() {
            end_mm
        } else {
            self.foot_mm(bottom, middle_mm)
        };
        self.struts
            .push(([top, bottom], [end_mm.min(middle_mm), foot_mm], middle_mm));
        true
    }

    /// Radius of a foot on the plate, limited by the room that there is.
    fn foot_mm(&self, at: DVec3, pillar_mm: f64) -> f64 {
        let room_mm =
            f64::from(self.clearance.distance_mm(at + DVec3::Z * 0.2)) - self.clear_mm / 2.0;
        let known_mm = most_mm(&self.profile) - self.profile.clearance_mm;
        let foot_mm = (self.profile.foot_mm / 2.0).max(1.5 * pillar_mm);
        if room_mm >= known_mm {
            foot_mm
        } else {
            foot_mm.min(room_mm.max(pillar_mm))
        }
    }

    /// Number of pillars and struts that stand on the model.
    pub fn on_model(&self) -> usize {
        let pillars = self.feet.iter().filter(|foot| foot.1 == End::Model);
        let struts = self.struts.iter().filter(|it| it.0[1].z > self.plate_mm());
        pillars.count() + struts.count()
    }

    /// Points where pillars, branches and braces join.
    pub fn joints(&self) -> Vec<[f64; 3]> {
        let nodes = self.nodes.iter().filter(|node| node.above > 1);
        let joints = nodes.map(|node| node.at);
        let joints = joints.chain(self.braces.iter().flatten().copied());
        joints.map(|at| at.to_array()).collect()
    }

    /// The points of a pillar from its foot up, along what holds most.
    fn trunk(&self, foot: u32, above: &[u32]) -> Vec<DVec3> {
        let mut points = Vec::new();
        let mut node = foot;
        while node != NONE {
            points.push(self.nodes[node as usize].at);
            node = above[node as usize];
        }
        points
    }

    /// Braces tall pillars with those nearby, zigzag from one to the other, and makes those thicker that no brace reaches.
    pub fn brace(&mut self) {
        // For each node the one above that holds most.
        let mut above = vec![NONE; self.nodes.len()];
        for (place, node) in self.nodes.iter().enumerate() {
            if let Some(best) = above.get_mut(node.down as usize) {
                let is_best = self
                    .nodes
                    .get(*best as usize)
                    .is_none_or(|it| it.tips < node.tips);
                if is_best {
                    *best = place as u32;
                }
            }
        }
        let trunks: Vec<Vec<DVec3>> = self
            .feet
            .iter()
            .map(|foot| self.trunk(foot.0, &above))
            .collect();
        let places = 0..trunks.len();
        let on_plate: Vec<usize> = places.filter(|&it| self.feet[it].1 == End::Plate).collect();
        // Heights at which each trunk is held: by its ends, and by braces.
        let ends_mm = trunks.iter().map(|it| vec![it[0].z, it[it.len() - 1].z]);
        let mut held_mm: Vec<Vec<f64>> = ends_mm.collect();
        let feet: Vec<DVec3> = on_plate.iter().map(|&it| trunks[it][0]).collect();
        for pair in nearest_pairs(&feet, self.profile.branch_mm) {
            let pair = pair.map(|it| on_plate[it]);
            let from = self.braces.len();
            let [a, b] = pair.map(|it| &trunks[it]);
            self.brace_pair(a, b);
            // They go from one to the other in turn, so each holds both.
            for [low, high] in &self.braces[from..] {
                for trunk in pair {
                    held_mm[trunk].push(f64::midpoint(low.z, high.z));
                }
            }
        }
        self.least_mm = vec![0.0; self.nodes.len()];
        for (place, heights_mm) in held_mm.into_iter().enumerate() {
            self.stiffen(self.feet[place].0, &above, heights_mm);
        }
    }

    /// Makes a pillar so thick that it does not buckle between the heights at which it is held. By Euler, the force that it bears grows with the
    /// fourth power of its diameter and falls with the square of its free length, so the diameter grows with the root of the length.
    fn stiffen(&mut self, foot: u32, above: &[u32], mut heights_mm: Vec<f64>) {
        argsort::sort_by_number(&mut heights_mm, |it| *it);
        let gaps_mm = heights_mm.windows(2).map(|pair| pair[1] - pair[0]);
        let free_mm = gaps_mm.fold(0.0, f64::max);
        if free_mm <= self.profile.brace_mm {
            return;
        }
        let least_mm = self.profile.pillar_mm / 2.0 * (free_mm / self.profile.brace_mm).sqrt();
        let mut node = foot;
        while node != NONE {
            // Not into the model beside it.
            let at = self.nodes[node as usize].at;
            let room_mm = f64::from(self.clearance.distance_mm(at)) - STIFF * self.clear_mm;
            self.least_mm[node as usize] = least_mm.min(room_mm.max(0.0));
            node = above[node as usize];
        }
    }

    /// Radius of the pillar at a node.
    fn pillar_mm(&self, node: u32) -> f64 {
        let least_mm = self.least_mm.get(node as usize).copied();
        radius_mm(&self.profile, self.nodes[node as usize].tips).max(least_mm.unwrap_or(0.0))
    }

    fn brace_pair(&mut self, a: &[DVec3], b: &[DVec3]) {
        let plate_mm = self.plate_mm();
        let tops = [a, b].map(|trunk| trunk[trunk.len() - 1].z);
        if tops[0].max(tops[1]) - plate_mm < self.profile.brace_mm {
            return;
        }
        let mut z = plate_mm + 0.2 * self.profile.brace_mm;
        let (mut from, mut to) = (a, b);
        loop {
            let Some(low) = at_height(from, z) else {
                return;
            };
            let Some(beside) = at_height(to, z) else {
                return;
            };
            let away_mm = (beside - low).truncate().length();
            // A trunk that leans is met a little higher.
            let reached = [1.0, 1.2, 1.5].into_iter().find_map(|part| {
                let high = at_height(to, z + away_mm * part)?;
                is_steep(high, low).then_some(high)
            });
            let Some(high) = reached else {
                return;
            };
            let need_mm = (BRACE * self.profile.pillar_mm / 2.0 + self.clear_mm) as f32;
            if away_mm > self.profile.pillar_mm && self.clearance.is_clear(low, high, need_mm) {
                self.braces.push([low, high]);
            }
            z = high.z.max(z + self.profile.pillar_mm);
            (from, to) = (to, from);
        }
    }

    /// All bodies, wider by `wider_mm` all around.
    pub fn shell(self, wider_mm: f64) -> Shell {
        let profile = self.profile;
        let mut shapes = Shapes::new(wider_mm);
        for tip in &self.tips {
            let penetration_mm = profile.penetration_mm;
            // As wide as asked where it meets the surface.
            let length_mm = tip.at.distance(tip.end);
            let narrower_mm = (tip.end_mm - tip.radius_mm) * penetration_mm / length_mm;
            let inner_mm = (tip.radius_mm - narrower_mm).max(0.5 * tip.radius_mm);
            shapes.cone(
                tip.at - tip.along * penetration_mm,
                inner_mm,
                tip.end,
                tip.end_mm,
            );
        }
        let is_plain = |node: &Node| node.is_straight && node.above == 1;
        for (place, node) in self.nodes.iter().enumerate() {
            if node.down == NONE || is_plain(node) {
                continue;
            }
            let mut next = node.down;
            while self.nodes[next as usize].down != NONE && is_plain(&self.nodes[next as usize]) {
                next = self.nodes[next as usize].down;
            }
            let below = &self.nodes[next as usize];
            let radius_mm = self.pillar_mm(place as u32);
            shapes.ball(node.at, radius_mm);
            let is_on_model = below.down == NONE && self.end_of(next) == End::Model;
            if is_on_model {
                let foot_mm = (FOOT_ON_MODEL * profile.contact_mm / 2.0).min(radius_mm);
                let foot = below.at - DVec3::Z * profile.penetration_mm;
                shapes.cone(foot, foot_mm, node.at, radius_mm);
            } else {
                shapes.cone(below.at, radius_mm, node.at, radius_mm);
            }
        }
        let mut feet = Vec::new();
        for &(foot, end) in &self.feet {
            if end == End::Plate {
                let (at, pillar_mm) = (self.nodes[foot as usize].at, self.pillar_mm(foot));
                feet.push((at, self.foot_mm(at, pillar_mm), pillar_mm));
            }
        }
        for &([top, bottom], [end_mm, foot_mm], middle_mm) in &self.struts {
            let tip_mm = profile.tip_mm.min((top.z - bottom.z) * 0.5);
            let (upper, lower) = (top - DVec3::Z * tip_mm, bottom + DVec3::Z * tip_mm);
            let into = DVec3::Z * profile.penetration_mm;
            shapes.cone(upper, middle_mm, top, end_mm);
            shapes.cone(top, end_mm, top + into, end_mm);
            shapes.ball(upper, middle_mm);
            if bottom.z <= self.plate_mm() {
                shapes.cone(bottom, middle_mm, upper, middle_mm);
                feet.push((bottom, foot_mm, middle_mm));
            } else {
                shapes.cone(lower, middle_mm, upper, middle_mm);
                shapes.ball(lower, middle_mm);
                shapes.cone(bottom - into, foot_mm, lower, middle_mm);
            }
        }
        // Feet that touch would enclose resin, and gaps between them would close.
        let ats: Vec<DVec3> = feet.iter().map(|foot| foot.0).collect();
        for (place, foot) in feet.iter_mut().enumerate() {
            let others = ats.iter().enumerate().filter(|&(other, _)| other != place);
            let nearest_mm = others
                .map(|(_, at)| at.distance(foot.0))
                .fold(f64::INFINITY, f64::min);
            foot.1 = foot
                .1
                .min((nearest_mm - BETWEEN_FEET_MM) / 2.0)
                .max(WIDER * foot.2);
        }
        for &(at, foot_mm, pillar_mm) in &feet {
            let top = at + DVec3::Z * profile.foot_thickness_mm;
            shapes.cone(at, foot_mm, top, foot_mm);
            let flare_mm = FLARE * 2.0 * foot_mm;
            shapes.cone(at, foot_mm, top + DVec3::Z * flare_mm, pillar_mm);
        }
        if profile.raft {
            let feet: Vec<DVec3> = feet.iter().map(|foot| foot.0).collect();
            shapes.raft(&feet, &profile);
        }
        for &[low, high] in &self.braces {
            let radius_mm = BRACE * profile.pillar_mm / 2.0;
            shapes.cone(low, radius_mm, high, radius_mm);
        }
        shapes.shell
    }
}

/// The point of a pillar at a height; its points ascend.
#[inline]
fn at_height(points: &[DVec3], z: f64) -> Option<DVec3> {
    let pairs = points.windows(2);
    let mut pairs = pairs.filter(|pair| pair[0].z <= z && z <= pair[1].z);
    pairs.next().map(|pair| {
        let part = (z - pair[0].z) / (pair[1].z - pair[0].z);
        pair[0] + (pair[1] - pair[0]) * part
    })
}

/// Pairs that join all pillars within reach of each other by the least distances between their feet: a minimum spanning
/// tree.
fn nearest_pairs(feet: &[DVec3], reach_mm: f64) -> Vec<[usize; 2]> {
    let away_mm = |a: usize, b: usize| feet[a].distance(feet[b]);
    let mut nearest: Vec<(f64, usize)> = vec![(f64::INFINITY, 0); feet.len()];
    let mut is_joined = vec![false; feet.len()];
    let mut pairs = Vec::new();
    let mut next = (!feet.is_empty()).then_some(0);
    while let Some(joined) = next {
        is_joined[joined] = true;
        if nearest[joined].0 <= reach_mm {
            pairs.push([nearest[joined].1, joined]);
        }
        next = None;
        for other in (0..feet.len()).filter(|&it| !is_joined[it]) {
            let away = away_mm(joined, other);
            if away < nearest[other].0 {
                nearest[other] = (away, joined);
            }
            if next.is_none_or(|best| nearest[other].0 < nearest[best].0) {
                next = Some(other);
            }
        }
    }
    pairs
}
