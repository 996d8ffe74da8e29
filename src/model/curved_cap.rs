//! Caps over wide holes whose borders do not lie in a plane.
//!
//! A point is inside an open surface where its generalised winding number exceeds one half (Jacobson, Kavan and Sorkine-Hornung, Robust
//! inside-outside segmentation using generalized winding numbers, 2013). Beside a hole that is where the border is seen under a solid angle of
//! more than 2π, whatever the surface around it. Over a border in a plane this is the plane; over others a fan around the middle would be
//! a cone, and such a cap is curved.

use glam::{DVec3, Vec3};

use crate::parallel;

/// Width of a hole, as a fraction of the model's largest side, from which on its cap is curved,
const WIDE: f64 = 0.1;
/// and how far its border leaves a plane, as a fraction of its width.
const BENT: f64 = 0.05;
/// Longest border that is curved: the cost is its length for each vertex of the cap.
const MOST_EDGES: usize = 4096;
/// Spokes and rings of a cap.
const SPOKES: usize = 48;
const RINGS: usize = 6;
/// Halvings of the distance between a fan and the cap: to a 65,536th of the hole's width.
const HALVINGS: usize = 16;

/// Factor by which a product that has shrunk or grown as far is scaled.
const LARGE: f64 = 1e100;

/// A hole whose cap is curved.
pub(super) struct Bent {
    border: Vec<DVec3>,
    middle: DVec3,
    /// The direction in which the cap faces.
    normal: DVec3,
    width: f64,
    /// The farthest that the border leaves the plane through the middle.
    rise: f64,
}

impl Bent {
    /// The hole, unless its border has too few or too many edges, or no area.
    pub fn of(hole: &[u32], vertices: &[Vec3]) -> Option<Self> {
        if !(4..=MOST_EDGES).contains(&hole.len()) {
            return None;
        }
        let border: Vec<DVec3> = hole
            .iter()
            .map(|&vertex| vertices[vertex as usize].as_dvec3())
            .collect();
        let middle = border.iter().sum::<DVec3>() / border.len() as f64;
        let (mut normal, mut width) = (DVec3::ZERO, 0.0_f64);
        for (a, b) in edges(&border) {
            normal += (a - middle).cross(b - middle);
            width = width.max(2.0 * a.distance(middle));
        }
        let normal = normal.try_normalize()?;
        let rises = border.iter().map(|it| (*it - middle).dot(normal).abs());
        let rise = rises.fold(0.0, f64::max);
        Some(Self {
            border,
            middle,
            normal,
            width,
            rise,
        })
    }

    /// Returns true if it is wide for a model whose largest side this is, and bent.
    pub fn is_wide(&self, side: f64) -> bool {
        self.width > WIDE * side && self.rise > BENT * self.width
    }

    /// Closes the hole. The vertices within its border are added to `vertices`.
    pub fn cap(&self, hole: &[u32], vertices: &mut Vec<Vec3>, facets: &mut Vec<[u32; 3]>) {
        let count = hole.len();
        let spokes = SPOKES.min(count);
        let centre = vertices.len() as u32;
        // The middle, and rings from the inside out; the border is the last.
        let mut fan = vec![self.middle];
        for ring in 1..RINGS {
            let part = ring as f64 / RINGS as f64;
            let rim = (0..spokes).map(|spoke| self.border[spoke * count / spokes]);
            fan.extend(rim.map(|rim| self.middle + (rim - self.middle) * part));
        }
        vertices.extend(parallel::map(fan, |point| self.raised(point)));
        let mut inner = vec![centre; spokes];
        for ring in 1..RINGS {
            let first = centre + 1 + ((ring - 1) * spokes) as u32;
            let outer: Vec<u32> = (first..first + spokes as u32).collect();
            for spoke in 0..spokes {
                let next = (spoke + 1) % spokes;
                facets.push([outer[spoke], outer[next], inner[spoke]]);
                if ring > 1 {
                    facets.push([inner[spoke], outer[next], inner[next]]);
                }
            }
            inner = outer;
        }
        for spoke in 0..spokes {
            let next = (spoke + 1) % spokes;
            let (from, to) = (spoke * count / spokes, (spoke + 1) * count / spokes);
            for at in from..to {
                facets.push([hole[at], hole[(at + 1) % count], inner[spoke]]);
            }
            facets.push([inner[spoke], hole[to % count], inner[next]]);
        }
    }

    /// A point of the fan, moved along the normal to where the border is seen under a solid angle of 2π.
    fn raised(&self, point: DVec3) -> Vec3 {
        let near = 1e-6 * self.width;
        let direction = if self.is_wide_from(point + self.normal * near) {
            self.normal
        } else {
            -self.normal
        };
        let mut bounds = [near, self.width];
        if self.is_wide_from(point + direction * bounds[1]) {
            return point.as_vec3();
        }
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(bounds[0], bounds[1]);
            let is_wide = self.is_wide_from(point + direction * middle);
            bounds[usize::from(!is_wide)] = middle;
        }
        (point + direction * bounds[0]).as_vec3()
    }

    /// Returns true if the fan subtends a solid angle of more than 2π. Half the angle is the argument of a product of
    /// complex numbers, one per facet (van Oosterom and Strackee, The solid angle of a plane triangle, 1983), so it
    /// suffices to count its half-turns.
    fn is_wide_from(&self, eye: DVec3) -> bool {
        let to_middle = self.middle - eye;
        let middle_length = to_middle.length();
        let (mut re, mut im, mut turns) = (1.0_f64, 0.0_f64, 0);
        let Some(last) = self.border.last() else {
            return false;
        };
        let mut a = *last - eye;
        let mut a_length = a.length();
        for b in &self.border {
            let b = *b - eye;
            let b_length = b.length();
            let volume = a.dot(b.cross(to_middle));
            let rest = a_length * b_length * middle_length
                + a.dot(b) * middle_length
                + b.dot(to_middle) * a_length
                + to_middle.dot(a) * b_length;
            (a, a_length) = (b, b_length);
            if rest == 0.0 && volume == 0.0 {
                continue;
            }
            let before = im;
            (re, im) = (re * rest - im * volume, re * volume + im * rest);
            // Signs alone count, so the product may shrink or grow, but not vanish.
            let size = re.abs() + im.abs();
            if size < 1.0 / LARGE {
                (re, im) = (re * LARGE, im * LARGE);
            } else if size > LARGE {
                (re, im) = (re / LARGE, im / LARGE);
            }
            if re < 0.0 && (before < 0.0) != (im < 0.0) {
                turns += if im < 0.0 { 1 } else { -1 };
            }
        }
        turns != 0
    }
}

/// The edges of a closed line.
fn edges(border: &[DVec3]) -> impl Iterator<Item = (DVec3, DVec3)> {
    let next = border.iter().cycle().skip(1);
    border.iter().copied().zip(next.copied())
}
