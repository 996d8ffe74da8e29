//! Supports that a file brings along: thin bodies that hold the model on the plate.
//!
//! Slicers export supports as many small bodies that overlap: feet, pillars, braces, and tips that taper into the model. Such bodies hang
//! together and stand on the plate. The model hangs on their tips, which end inside it, so nothing beyond a tip is a support.

use glam::DVec3;

use super::bodies::{numbered, windings_at};
use super::mesh::{Mesh, sixfold_volume};
use crate::argsort::sort_by_number;
use crate::union_find;

/// Greatest thickness of a member of supports, as four times its volume over its surface: that is the diameter of a long cylinder.
const THICKEST_MM: f64 = 4.0;

/// Greatest height of a foot or a raft.
const FLAT_MM: f64 = 4.0;

/// Tolerance of contact with the plate and between members.
const NEAR_MM: f64 = 0.05;

/// Greatest ratio of a tip's radius to that of its other end.
const TAPER: f64 = 0.85;

/// Greatest radius of a tip where it meets the model.
const TIP_MM: f64 = 0.8;

/// Least distance of the model from the plate.
const LIFTED_MM: f64 = 0.5;

/// Radius of what is a tip in any case where it meets the model.
const NARROW_MM: f64 = 0.45;

/// Part of the largest body's volume that makes another one a part of the model.
const AS_LARGE: f64 = 0.8;

/// Least number of tips.
const FEWEST: usize = 3;

/// Ratio of a member's volume to that of the cone along it: blades and plates have less.
const FILLING: std::ops::RangeInclusive<f64> = 0.4..=2.6;

/// Greatest height of feet above the lowest point: exports of branching supports are placed on the plate by a brace that is lower.
const FEET_MM: f64 = 2.0;

/// Greatest distance of a vertex from the cone, as a part of the cone's greater radius: members that are joined have more.
const OFF: f64 = 0.6;

/// Part of a member's length that belongs to each of its ends.
const END: f64 = 0.35;

/// Supports among the bodies of a mesh.
pub(super) struct OwnSupports {
    /// True for each facet of the mesh that is of a support.
    pub is_support: Vec<bool>,
    /// Places where they hold the model.
    pub tips: Vec<DVec3>,
    /// Height of their feet: what is lower belongs below the plate.
    pub feet: f32,
}

/// A body as a cone with round ends along its longest direction.
struct Member {
    min: DVec3,
    max: DVec3,
    /// Ends of its axis, the higher one last, and the radii there.
    ends: [DVec3; 2],
    radii: [f64; 2],
    volume: f64,
    is_thin: bool,
    /// True if the cone fills as much as the body does.
    is_cone: bool,
    /// Numbers of its vertices.
    vertices: Vec<u32>,
}

/// Finds the supports of a mesh in millimetres. `None` if it has none.
///
/// Cost: linear in facets, and in pairs of thin bodies that overlap in x.
pub(super) fn find(mesh: &Mesh) -> Option<OwnSupports> {
    if mesh.largest_above < LIFTED_MM {
        return None;
    }
    let (number_of, members) = members(mesh);
    let plate = members
        .iter()
        .map(|it| it.min.z)
        .fold(f64::INFINITY, f64::min);
    let is_flat = |it: &Member| it.max.z - plate <= FLAT_MM;
    let tall = members.iter().filter(|it| !is_flat(it));
    let largest = tall.map(|it| it.volume).fold(0.0, f64::max);
    let is_thin: Vec<bool> = members
        .iter()
        .map(|it| is_flat(it) || it.is_thin && it.volume < AS_LARGE * largest)
        .collect();
    let model = (0..members.len()).filter(|&it| !is_thin[it]);
    let lowest = model
        .map(|it| members[it].min.z)
        .fold(f64::INFINITY, f64::min);
    if lowest == f64::INFINITY || lowest < plate + LIFTED_MM {
        return None;
    }
    let rafts: Vec<&Member> = members.iter().filter(|it| is_flat(it)).collect();
    let parts: Vec<usize> = (0..members.len()).filter(|&it| is_thin[it]).collect();
    let bottoms = parts.iter().map(|&it| members[it].min.z);
    let feet = level(bottoms.filter(|&z| z <= plate + FEET_MM).collect());
    // On the plate, or on a raft.
    let stands = |it: &Member| {
        let on_raft = |raft: &&Member| {
            it.min.z <= raft.max.z + NEAR_MM
                && it.min.truncate().cmple(raft.max.truncate()).all()
                && it.max.truncate().cmpge(raft.min.truncate()).all()
        };
        it.min.z <= feet + NEAR_MM || rafts.iter().any(on_raft)
    };
    let groups = linked(mesh, &members, &parts);
    let mut is_standing = vec![false; members.len()];
    for &part in &parts {
        is_standing[groups[part]] |= stands(&members[part]);
    }
    let is_part = |it: usize| is_thin[it] && is_standing[groups[it]];
    // Narrow ends, and the vertices of bodies that are more than a cone.
    let mut tips = Vec::new();
    for &part in &parts {
        let member = &members[part];
        if member.is_cone {
            let ends = (0..2).filter(|&end| member.is_tip(end));
            tips.extend(ends.map(|end| (part, member.ends[end])));
        } else if is_part(part) && !is_flat(member) {
            let vertices = member.vertices.iter();
            tips.extend(vertices.map(|&it| (part, mesh.vertices[it as usize].as_dvec3())));
        }
    }
    let points: Vec<DVec3> = tips.iter().map(|it| it.1).collect();
    let around = windings_at(mesh, &points, |facet, _| is_part(number_of[facet] as usize));
    let mut around = around.into_iter();
    tips.retain(|_| around.next().is_some_and(|it| it != 0));
    let tips = narrow(tips);
    let mut held = vec![0usize; members.len()];
    for &(part, _) in &tips {
        held[groups[part]] += 1;
    }
    // Those that stand and hold, feet, and those that lead from one place of the model to another.
    let is_own: Vec<bool> = (0..members.len())
        .map(|it| {
            let held = held[groups[it]];
            is_thin[it] && (held > 1 || is_part(it) && (held > 0 || is_flat(&members[it])))
        })
        .collect();
    let tips: Vec<DVec3> = tips
        .into_iter()
        .filter(|it| is_own[it.0])
        .map(|it| it.1)
        .collect();
    (tips.len() >= FEWEST).then(|| OwnSupports {
        is_support: number_of.iter().map(|&it| is_own[it as usize]).collect(),
        tips,
        feet: feet as f32,
    })
}

/// The lowest of the heights that most others are near.
fn level(mut heights: Vec<f64>) -> f64 {
    sort_by_number(&mut heights, |&it| it);
    let (mut most, mut level) = (0, f64::INFINITY);
    let mut end = 0;
    for (first, &height) in heights.iter().enumerate() {
        while heights.get(end).is_some_and(|it| *it <= height + NEAR_MM) {
            end += 1;
        }
        if end - first > most {
            (most, level) = (end - first, height);
        }
    }
    level
}

/// Middles of places where members end in the model, without those too wide for tips. Points of a place are close together.
fn narrow(points: Vec<(usize, DVec3)>) -> Vec<(usize, DVec3)> {
    let mut places: Vec<(usize, Vec<DVec3>)> = Vec::new();
    let mut last = 0;
    for (part, at) in points {
        // Points of a member follow each other.
        if places.get(last).is_some_and(|it| it.0 != part) {
            last = places.len();
        }
        let near = |it: &&mut (usize, Vec<DVec3>)| it.1[0].distance(at) <= 2.0 * TIP_MM;
        match places[last..].iter_mut().find(near) {
            Some(place) => place.1.push(at),
            None => places.push((part, vec![at])),
        }
    }
    let middles = places.into_iter().filter_map(|(part, points)| {
        let middle = points.iter().sum::<DVec3>() / points.len() as f64;
        let is_narrow = points.iter().all(|it| it.distance(middle) <= TIP_MM);
        is_narrow.then_some((part, middle))
    });
    middles.collect()
}

/// The body of each facet, and all bodies.
fn members(mesh: &Mesh) -> (Vec<u32>, Vec<Member>) {
    let (number_of, roots) = numbered(mesh);
    let mut facets: Vec<Vec<usize>> = vec![Vec::new(); roots.len()];
    for (facet, &number) in number_of.iter().enumerate() {
        facets[number as usize].push(facet);
    }
    let members = facets.iter().map(|facets| Member::new(mesh, facets));
    let members = members.collect();
    (number_of, members)
}

impl Member {
    fn new(mesh: &Mesh, facets: &[usize]) -> Self {
        let first = mesh.corners(facets[0])[0];
        let (mut min, mut max) = (first, first);
        let (mut volume, mut area) = (0.0, 0.0);
        for &facet in facets {
            let corners = mesh.corners(facet);
            for corner in corners {
                (min, max) = (min.min(corner), max.max(corner));
            }
            let [a, b, c] = corners.map(|corner| corner - first);
            volume += sixfold_volume([a, b, c]) / 6.0;
            area += (b - a).cross(c - a).length() / 2.0;
        }
        let mut member = Self {
            min,
            max,
            ends: [first; 2],
            radii: [0.0; 2],
            volume,
            is_thin: volume > 0.0 && 4.0 * volume <= THICKEST_MM * area,
            is_cone: false,
            vertices: Vec::new(),
        };
        // The model itself needs no more.
        if member.is_thin || max.z - min.z <= FLAT_MM {
            let corners = facets.iter().flat_map(|&it| mesh.facets[it]);
            member.vertices.extend(corners);
            member.vertices.sort_unstable();
            member.vertices.dedup();
            member.lay_cone(mesh);
        }
        member
    }

    /// Lays a cone along the member.
    fn lay_cone(&mut self, mesh: &Mesh) {
        let vertices = self.vertices.iter();
        let points = vertices.map(|&it| mesh.vertices[it as usize].as_dvec3());
        let points: Vec<DVec3> = points.collect();
        let (ends, radii) = cone(&points);
        let [low, high] = radii;
        let length = ends[0].distance(ends[1]);
        let filled = std::f64::consts::FRAC_PI_3 * length * (low * low + low * high + high * high);
        (self.ends, self.radii) = (ends, radii);
        let off_mm = OFF * low.max(high);
        let is_near = |at: &DVec3| {
            let (_, part) = closest([*at; 2], ends);
            let (axis, radius) = self.at(part);
            // A foot may be wider.
            at.z <= self.min.z + NEAR_MM || axis.distance(*at) <= radius + off_mm
        };
        self.is_cone = FILLING.contains(&(self.volume / filled)) && points.iter().all(is_near);
    }

    /// Returns true if an end is as narrow as a tip.
    fn is_tip(&self, end: usize) -> bool {
        let radius = self.radii[end];
        radius <= NARROW_MM || radius <= TIP_MM && self.tapers(end)
    }

    fn tapers(&self, end: usize) -> bool {
        self.radii[end] <= TAPER * self.radii[1 - end]
    }

    /// Returns true if a part of the length is at an end that tapers.
    fn is_at_tip(&self, part: f64) -> bool {
        let end = usize::from(part > 0.5);
        (part - 0.5).abs() > 0.2 && self.is_tip(end) && self.tapers(end)
    }

    /// The point of the axis at a part of the length, and the radius there.
    fn at(&self, part: f64) -> (DVec3, f64) {
        let ([low, high], [low_mm, high_mm]) = (self.ends, self.radii);
        (
            low + (high - low) * part,
            low_mm + (high_mm - low_mm) * part,
        )
    }
}

/// Ends of a cone along points, the higher one last, and its radii there.
fn cone(points: &[DVec3]) -> ([DVec3; 2], [f64; 2]) {
    let farthest = |from: DVec3| {
        let away = |at: &DVec3| at.distance_squared(from);
        points.iter().copied().fold(
            from,
            |best, at| if away(&at) > away(&best) { at } else { best },
        )
    };
    let middle = points.iter().sum::<DVec3>() / points.len() as f64;
    let from = farthest(middle);
    let to = farthest(from);
    let length_squared = from.distance_squared(to);
    if length_squared == 0.0 {
        return ([from; 2], [0.0; 2]);
    }
    let part = |at: &DVec3| (*at - from).dot(to - from) / length_squared;
    let of_end = |is_end: &dyn Fn(f64) -> bool| -> Vec<DVec3> {
        points
            .iter()
            .copied()
            .filter(|at| is_end(part(at)))
            .collect()
    };
    let groups = [
        of_end(&|part| part <= END),
        of_end(&|part| part >= 1.0 - END),
    ];
    let mut ends = [0, 1].map(|end| groups[end].iter().sum::<DVec3>() / groups[end].len() as f64);
    let along = (ends[1] - ends[0]).normalize_or_zero();
    let mut radii = [0, 1].map(|end| {
        let away = groups[end]
            .iter()
            .map(|&at| (at - ends[end]).cross(along).length());
        away.sum::<f64>() / groups[end].len() as f64
    });
    if ends[0].z > ends[1].z {
        ends.swap(0, 1);
        radii.swap(0, 1);
    }
    (ends, radii)
}

/// The group of each member: thin ones that overlap, though not at a tip, are in one.
fn linked(mesh: &Mesh, members: &[Member], parts: &[usize]) -> Vec<usize> {
    let mut parents: Vec<u32> = (0..members.len() as u32).collect();
    let mut order = parts.to_vec();
    sort_by_number(&mut order, |&it| members[it].min.x);
    let gap = DVec3::splat(NEAR_MM);
    for (place, &part) in order.iter().enumerate() {
        let a = &members[part];
        let near = order[place + 1..].iter();
        for &other in near.take_while(|&&it| members[it].min.x <= a.max.x + gap.x) {
            let b = &members[other];
            let is_beside = (a.min - gap).cmpgt(b.max).any() || (b.min - gap).cmpgt(a.max).any();
            if !is_beside && are_linked(mesh, a, b) {
                union_find::unite(&mut parents, part as u32, other as u32);
            }
        }
    }
    (0..members.len() as u32)
        .map(|it| union_find::find(&mut parents, it) as usize)
        .collect()
}

/// Returns true if two members overlap elsewhere than at a tip.
fn are_linked(mesh: &Mesh, a: &Member, b: &Member) -> bool {
    if a.is_cone && b.is_cone {
        let (of_a, of_b) = closest(a.ends, b.ends);
        let ((at_a, radius_a), (at_b, radius_b)) = (a.at(of_a), b.at(of_b));
        return at_a.distance(at_b) <= radius_a + radius_b + NEAR_MM
            && !a.is_at_tip(of_a)
            && !b.is_at_tip(of_b);
    }
    // A body that is more than a cone by its vertices, though not by those of its tips, at its top.
    let (body, other) = if a.is_cone { (b, a) } else { (a, b) };
    let vertices = body.vertices.iter();
    let mut vertices = vertices.map(|&it| mesh.vertices[it as usize].as_dvec3());
    vertices.any(|at| {
        let (_, of_other) = closest([at; 2], other.ends);
        let (axis, radius) = other.at(of_other);
        at.z <= body.max.z - LIFTED_MM
            && axis.distance(at) <= radius + NEAR_MM
            && !(other.is_cone && other.is_at_tip(of_other))
    })
}

/// Places of two line segments that are closest to each other, as parts of their lengths.
fn closest([a0, a1]: [DVec3; 2], [b0, b1]: [DVec3; 2]) -> (f64, f64) {
    let (a, b, between) = (a1 - a0, b1 - b0, a0 - b0);
    let (aa, bb, ab) = (a.dot(a), b.dot(b), a.dot(b));
    let (from_a, from_b) = (a.dot(between), b.dot(between));
    let along = |numerator: f64, of: f64| {
        if of > 0.0 {
            (numerator / of).clamp(0.0, 1.0)
        } else {
            0.0
        }
    };
    let of_a = along(ab * from_b - from_a * bb, aa * bb - ab * ab);
    let of_b = along(ab * of_a + from_b, bb);
    (along(ab * of_b - from_a, aa), of_b)
}
