//! Distances of surfaces from the contacts that hold them, within the print and never through air.

use glam::DVec3;

use super::rays::Rays;
use crate::ways::{self, AROUND, KNIGHTS};

/// Distance of each ray's lower ends from the nearest contact, along the lower surface of their piece.
pub(super) struct Held<'a> {
    rays: &'a Rays<'a>,
    most_mm: f32,
    /// By stretch.
    away_mm: Vec<f32>,
    /// Memory for the stretches around one that overlap it, by step.
    around: [Vec<usize>; 8],
}

impl<'a> Held<'a> {
    /// No contact yet. Distances beyond `most_mm` stay unknown.
    pub fn new(rays: &'a Rays<'a>, most_mm: f64) -> Self {
        Self {
            rays,
            most_mm: most_mm as f32,
            away_mm: vec![f32::INFINITY; rays.stretches.len()],
            around: Default::default(),
        }
    }

    /// Distance of a stretch's lower end from the nearest contact.
    pub fn away_mm(&self, stretch: usize) -> f64 {
        f64::from(self.away_mm[stretch])
    }

    /// Adds contacts at the lower ends of stretches.
    pub fn insert(&mut self, contacts: &[usize]) {
        let contacts = contacts.iter().map(|&it| (0.0, it));
        self.spread(&contacts.collect::<Vec<_>>());
    }

    /// Adds a contact at a point of the surface.
    pub fn insert_at(&mut self, at: DVec3) {
        let rays = self.rays;
        let pitch_mm = rays.ldi.grid.pitch_mm as f32;
        let z_mm = at.z as f32;
        let near = rays.stretches_at(at).filter(|&stretch| {
            let it = &rays.stretches[stretch];
            it.from_mm - 2.0 * pitch_mm <= z_mm && z_mm <= it.to_mm + pitch_mm
        });
        let near = near.map(|it| (rays.at(it).distance(at) as f32, it));
        self.spread(&near.collect::<Vec<_>>());
    }

    /// Spreads shorter distances from stretches to those connected to them.
    fn spread(&mut self, from: &[(f32, usize)]) {
        let rays = self.rays;
        let pitch_mm = rays.ldi.grid.pitch_mm as f32;
        let runs_mm2 = [1.0, 2.0, 5.0].map(|squares: f32| squares * pitch_mm * pitch_mm);
        let around = &mut self.around;
        ways::spread(&mut self.away_mm, self.most_mm, from, &mut |here, reach| {
            let ray = rays.stretches[here].ray;
            let mut reach = |there: usize, run_mm2: f32| {
                let rise_mm = rays.stretches[there].from_mm - rays.stretches[here].from_mm;
                reach(there, (run_mm2 + rise_mm * rise_mm).sqrt());
            };
            for (step, around) in AROUND.into_iter().zip(&mut *around) {
                let run_mm2 = runs_mm2[usize::from(step[0] != 0 && step[1] != 0)];
                around.clear();
                around.extend(rays.near(ray, step).filter(|&it| rays.overlap(here, it)));
                for &there in &*around {
                    reach(there, run_mm2);
                }
            }
            for (step, between) in KNIGHTS {
                let between = between.map(|it| &around[it]);
                if between.iter().any(|it| it.is_empty()) {
                    continue;
                }
                let passes = |there: usize| {
                    let mut all = between.iter();
                    all.all(|those| those.iter().any(|&it| rays.overlap(it, there)))
                };
                for there in rays.near(ray, step).filter(|&it| passes(it)) {
                    reach(there, runs_mm2[2]);
                }
            }
        });
    }
}
