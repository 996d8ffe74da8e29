//! The bodies that supports are made of. They may overlap: along a ray they are one.

use glam::DVec3;

use super::SupportProfile;
use crate::argsort::sort_by_number;
use crate::prepare::round::{circle, rim};
use crate::prepare::shell::Shell;

/// Doublings from four points of a circle to those around a support.
const DOUBLINGS: u32 = 2;

/// Ratio of a polyhedron of 16 by 16 corners to the ball inside it: the square of the secant of half the angle between
/// two corners.
const ENCLOSING: f64 = 1.04;

/// Width of the bars and of the frame of a raft with holes.
const BAR_MM: f64 = 2.0;

/// Distance by which the disc under a foot in the middle of a hole overlaps the bars.
const OVERLAP_MM: f64 = 0.3;

/// Bodies, each a closed surface.
#[derive(Debug)]
pub(super) struct Shapes {
    pub shell: Shell,
    /// Added to all radii, for masks that are narrower than what they print.
    wider_mm: f64,
}

impl Shapes {
    pub fn new(wider_mm: f64) -> Self {
        Self {
            shell: Shell::default(),
            wider_mm,
        }
    }

    /// A round body from one point to another, with these radii at its ends.
    pub fn cone(&mut self, from: DVec3, from_mm: f64, to: DVec3, to_mm: f64) {
        let length_mm = from.distance(to);
        if length_mm == 0.0 {
            return;
        }
        let along = (to - from) / length_mm;
        let rim = |middle: DVec3, radius_mm: f64| {
            let rim = rim(along, radius_mm + self.wider_mm, DOUBLINGS).into_iter();
            rim.map(|it| middle + it).collect()
        };
        self.shell.drum(rim(from, from_mm), rim(to, to_mm));
    }

    /// A ball, as a stack of rims. It encloses the round one, and so the rims of struts that end in its middle.
    pub fn ball(&mut self, middle: DVec3, radius_mm: f64) {
        let radius_mm = (radius_mm + self.wider_mm) * ENCLOSING;
        let around = circle(DOUBLINGS);
        let sides = around.len() as u32;
        let begin = self.shell.vertices.len() as u32;
        // Heights and radii from the lowest point to the highest.
        let profile = circle(DOUBLINGS);
        let quarter = profile.len() / 4;
        let bands: Vec<[f64; 2]> = (1..2 * quarter)
            .map(|step| profile[(3 * quarter + step) % profile.len()])
            .collect();
        let mut points = vec![middle - DVec3::Z * radius_mm];
        for [radius, height] in &bands {
            let rim = around.iter();
            points.extend(
                rim.map(|[x, y]| middle + DVec3::new(x * radius, y * radius, *height) * radius_mm),
            );
        }
        points.push(middle + DVec3::Z * radius_mm);
        self.shell
            .vertices
            .extend(points.iter().copied().map(DVec3::as_vec3));
        let top = begin + points.len() as u32 - 1;
        let rim = |band: u32, side: u32| begin + 1 + band * sides + side % sides;
        let last = bands.len() as u32 - 1;
        for side in 0..sides {
            self.shell
                .facets
                .push([begin, rim(0, side + 1), rim(0, side)]);
            self.shell
                .facets
                .push([top, rim(last, side), rim(last, side + 1)]);
            for band in 0..last {
                let [a, b] = [rim(band, side), rim(band, side + 1)];
                let [c, d] = [rim(band + 1, side), rim(band + 1, side + 1)];
                self.shell.facets.extend([[a, b, d], [a, d, c]]);
            }
        }
    }

    /// A plate under feet: the convex hull of circles around them, wider at its top, so that a scraper gets under it. With holes it has
    /// bars along y below, bars along x and a frame across them, and a disc under each foot: no hole is closed around while it is printed,
    /// so none sucks at the film.
    pub fn raft(&mut self, feet: &[DVec3], profile: &SupportProfile) {
        let radius_mm = profile.foot_mm / 2.0 + profile.raft_margin_mm;
        let thickness_mm = profile.raft_thickness_mm;
        let top_mm = radius_mm + thickness_mm / profile.raft_slope;
        let around = circle(DOUBLINGS);
        // Each point of an outline is a point of a circle around a foot.
        let mut rim: Vec<(DVec3, [f64; 2])> = Vec::new();
        for &foot in feet {
            rim.extend(around.iter().map(|&[x, y]| (foot, [x, y])));
        }
        let outline = |radius_mm: f64, z_mm: f64| {
            move |&(foot, [x, y]): &(DVec3, [f64; 2])| {
                foot + DVec3::new(x * radius_mm, y * radius_mm, z_mm)
            }
        };
        let hull = hull(rim, outline(radius_mm, 0.0));
        if hull.len() < 3 {
            return;
        }
        let of = |radius_mm: f64, z_mm: f64| -> Vec<DVec3> {
            hull.iter().map(outline(radius_mm, z_mm)).collect()
        };
        let (bottom, top) = (of(radius_mm, 0.0), of(top_mm, thickness_mm));
        let inner_mm = radius_mm - BAR_MM + self.wider_mm;
        if profile.raft_hole_mm <= self.wider_mm || inner_mm <= 0.0 {
            return self.shell.drum(bottom, top);
        }
        let half_mm = thickness_mm / 2.0;
        let (outer, inner) = (of(radius_mm, half_mm), of(inner_mm, half_mm));
        let above = of(inner_mm, thickness_mm);
        for side in 0..hull.len() {
            let next = (side + 1) % hull.len();
            self.shell.drum(
                vec![outer[side], outer[next], inner[next], inner[side]],
                vec![top[side], top[next], above[next], above[side]],
            );
        }
        let step_mm = profile.raft_hole_mm + BAR_MM;
        self.bars(&of(radius_mm, 0.0), 0, step_mm, half_mm);
        // They end within the frame.
        self.bars(&of(radius_mm - BAR_MM / 2.0, half_mm), 1, step_mm, half_mm);
        let disc_mm = (profile.foot_mm / 2.0).max(profile.raft_hole_mm / 2.0 + OVERLAP_MM);
        for &foot in feet {
            self.cone(foot, disc_mm, foot + DVec3::Z * thickness_mm, disc_mm);
        }
    }

    /// Bars across a convex polygon where a coordinate is constant, at most `step_mm` apart.
    fn bars(&mut self, polygon: &[DVec3], axis: usize, step_mm: f64, thickness_mm: f64) {
        let places = polygon.iter().map(|at| at[axis]);
        let least_mm = places.clone().fold(f64::INFINITY, f64::min);
        let most_mm = places.fold(f64::NEG_INFINITY, f64::max);
        let steps = ((most_mm - least_mm) / step_mm).ceil();
        let along = if axis == 0 { DVec3::X } else { DVec3::NEG_Y };
        let across = along * (BAR_MM / 2.0 + self.wider_mm);
        for bar in 1..steps as usize {
            let at_mm = least_mm + (most_mm - least_mm) * (bar as f64 / steps);
            let Some([from, to]) = chord(polygon, axis, at_mm) else {
                continue;
            };
            let low = vec![from - across, from + across, to + across, to - across];
            let high = low.iter().map(|&at| at + DVec3::Z * thickness_mm);
            let high = high.collect();
            self.shell.drum(low, high);
        }
    }
}

/// Ends of the line across a convex polygon on which a coordinate has this value, in ascending order of the other coordinate.
fn chord(polygon: &[DVec3], axis: usize, at_mm: f64) -> Option<[DVec3; 2]> {
    let next = polygon.iter().cycle().skip(1);
    let mut cuts: Vec<DVec3> = Vec::new();
    for (&a, &b) in polygon.iter().zip(next) {
        if (a[axis] < at_mm) != (b[axis] < at_mm) {
            cuts.push(a + (b - a) * ((at_mm - a[axis]) / (b[axis] - a[axis])));
        }
    }
    let &[a, b] = &cuts[..] else { return None };
    Some(if a[1 - axis] < b[1 - axis] {
        [a, b]
    } else {
        [b, a]
    })
}

/// The convex hull of points in the plane, counter-clockwise.
fn hull<T: Clone>(mut items: Vec<T>, at: impl Fn(&T) -> DVec3) -> Vec<T> {
    sort_by_number(&mut items, |it| at(it).y);
    sort_by_number(&mut items, |it| at(it).x);
    let half = |items: &mut dyn Iterator<Item = &T>| {
        let mut hull: Vec<T> = Vec::new();
        for item in items {
            while let [.., before, last] = &hull[..] {
                let (a, b) = (at(last) - at(before), at(item) - at(before));
                if a.x * b.y - a.y * b.x > 0.0 {
                    break;
                }
                hull.pop();
            }
            hull.push(item.clone());
        }
        hull.pop();
        hull
    };
    let mut hull = half(&mut items.iter());
    hull.extend(half(&mut items.iter().rev()));
    hull
}

#[cfg(test)]
mod tests {
    use super::*;

    fn volume_mm3(make: impl FnOnce(&mut Shapes)) -> f64 {
        let mut shapes = Shapes::new(0.0);
        make(&mut shapes);
        shapes.shell.volume_mm3()
    }

    /// A polygon of 16 corners in a circle of radius 1.
    const POLYGON: f64 = 3.061_467_458_920_718;

    #[test]
    fn bodies_enclose_what_they_should_whichever_way_they_point() {
        let from = DVec3::new(3.0, -2.0, 1.0);
        for along in [
            DVec3::Z,
            DVec3::NEG_Z,
            DVec3::X,
            DVec3::new(1.0, 2.0, -3.0),
            DVec3::new(-3.0, 0.5, 0.25),
        ] {
            let to = from + along;
            let cylinder = volume_mm3(|it| it.cone(from, 0.5, to, 0.5));
            assert!(
                (cylinder - POLYGON * 0.25 * along.length()).abs() < 1e-4,
                "{along} {cylinder}"
            );
            let cone = volume_mm3(|it| it.cone(from, 0.3, to, 0.6));
            let mean = (0.09 + 0.18 + 0.36) / 3.0;
            assert!(
                (cone - POLYGON * mean * along.length()).abs() < 1e-4,
                "{along} {cone}"
            );
        }
        let ball = volume_mm3(|it| it.ball(from, 2.0));
        assert!(ball > 33.51 && ball < 1.1 * 33.51, "{ball}");
    }
}
