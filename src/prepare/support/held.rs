//! Distances of surfaces from the contacts that hold them, within the print and never through air.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::rays::{AROUND, Rays};

/// Offsets of rays two steps on and one aside, and those of the two rays between. With the rays around, lengths of ways
/// are at most 2.8 % too long.
const KNIGHTS: [([isize; 2], [[isize; 2]; 2]); 8] = [
    ([2, 1], [[1, 0], [1, 1]]),
    ([1, 2], [[0, 1], [1, 1]]),
    ([-1, 2], [[0, 1], [-1, 1]]),
    ([-2, 1], [[-1, 0], [-1, 1]]),
    ([-2, -1], [[-1, 0], [-1, -1]]),
    ([-1, -2], [[0, -1], [-1, -1]]),
    ([1, -2], [[0, -1], [1, -1]]),
    ([2, -1], [[1, 0], [1, -1]]),
];

/// Distance of each ray's lower ends from the nearest contact, along the lower surface of their piece.
pub(super) struct Held<'a> {
    rays: &'a Rays<'a>,
    most_mm: f32,
    /// By stretch.
    away_mm: Vec<f32>,
}

impl<'a> Held<'a> {
    /// No contact yet. Distances beyond `most_mm` stay unknown.
    pub fn new(rays: &'a Rays<'a>, most_mm: f64) -> Self {
        Self {
            rays,
            most_mm: most_mm as f32,
            away_mm: vec![f32::INFINITY; rays.stretches.len()],
        }
    }

    /// Distance of a stretch's lower end from the nearest contact.
    pub fn away_mm(&self, stretch: usize) -> f64 {
        f64::from(self.away_mm[stretch])
    }

    /// Adds contacts at the lower ends of stretches, given with their rays.
    pub fn insert(&mut self, contacts: impl Iterator<Item = (usize, usize)>) {
        self.spread(contacts.map(|(ray, stretch)| (0.0, ray, stretch)).collect());
    }

    /// Adds a contact at a point of the surface.
    pub fn insert_at(&mut self, at: DVec3) {
        let rays = self.rays;
        let Some(middle) = rays.nearest(at) else {
            return;
        };
        let pitch_mm = rays.ldi.grid.pitch_mm as f32;
        let z_mm = at.z as f32;
        let around = AROUND.into_iter().chain([[0, 0]]);
        let around = around.filter_map(|step| rays.beside(middle, step));
        let near = around.flat_map(|ray| rays.of_ray(ray).map(move |stretch| (ray, stretch)));
        let near = near.filter(|&(_, stretch)| {
            let it = &rays.stretches[stretch];
            it.from_mm - 2.0 * pitch_mm <= z_mm && z_mm <= it.to_mm + pitch_mm
        });
        self.spread(
            near.map(|(ray, stretch)| (rays.at(ray, stretch).distance(at) as f32, ray, stretch))
                .collect(),
        );
    }

    /// Spreads shorter distances from stretches to those connected to them.
    fn spread(&mut self, from: Vec<(f32, usize, usize)>) {
        let rays = self.rays;
        // Bits of numbers that are not negative are in the order of the numbers.
        let mut next = BinaryHeap::new();
        for (away_mm, ray, stretch) in from {
            if away_mm < self.away_mm[stretch].min(self.most_mm) {
                self.away_mm[stretch] = away_mm;
                next.push(Reverse((away_mm.to_bits(), stretch, ray)));
            }
        }
        let pitch_mm = rays.ldi.grid.pitch_mm as f32;
        let runs_mm2 = [1.0, 2.0, 5.0].map(|squares: f32| squares * pitch_mm * pitch_mm);
        while let Some(Reverse((bits, here, ray))) = next.pop() {
            let away_mm = f32::from_bits(bits);
            if away_mm > self.away_mm[here] {
                continue;
            }
            let mut reach = |ray: usize, there: usize, run_mm2: f32| {
                let rise_mm = rays.stretches[there].from_mm - rays.stretches[here].from_mm;
                let total_mm = away_mm + (run_mm2 + rise_mm * rise_mm).sqrt();
                if total_mm < self.away_mm[there].min(self.most_mm) {
                    self.away_mm[there] = total_mm;
                    next.push(Reverse((total_mm.to_bits(), there, ray)));
                }
            };
            for step in AROUND {
                let run_mm2 = runs_mm2[usize::from(step[0] != 0 && step[1] != 0)];
                for there in rays.near(ray, step).filter(|&it| rays.overlap(here, it)) {
                    let beside = rays.beside(ray, step).unwrap_or(ray);
                    reach(beside, there, run_mm2);
                }
            }
            for (step, between) in KNIGHTS {
                let passes = |there: usize| {
                    between.iter().all(|&step| {
                        let mut those = rays.near(ray, step);
                        those.any(|it| rays.overlap(here, it) && rays.overlap(it, there))
                    })
                };
                for there in rays.near(ray, step).filter(|&it| passes(it)) {
                    let beside = rays.beside(ray, step).unwrap_or(ray);
                    reach(beside, there, runs_mm2[2]);
                }
            }
        }
    }
}
