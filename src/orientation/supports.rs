//! Estimate of the supports that a direction needs, without building them (`docs/supports.md`). The constants are those
//! that fit supports of six scans along 14 directions each: `cargo xtask bench support` compares.

use std::f64::consts::PI;

use crate::prepare::SupportProfile;

/// Contacts on a surface per square of the load rule's distance.
const PACKING: f64 = 0.95;

/// Contacts on an island: around its lowest point the surface is seldom large, and has edges.
const FOR_ISLAND: f64 = 4.0;

/// Fraction of a contact's height for which it has a pillar of its own: pillars join on their way down.
const ALONE: f64 = 0.4;

/// An estimate of supports.
#[derive(Debug)]
pub(super) struct Estimate<'a> {
    profile: &'a SupportProfile,
    /// The component along z of the normal of a surface that just supports itself.
    least_n_z: f32,
    /// On surfaces that do not support themselves.
    contacts: f64,
    /// The same, each weighted by the surface that it touches.
    weighted: f64,
    /// From the plate to each of them, together.
    heights_mm: f64,
}

impl<'a> Estimate<'a> {
    pub fn new(profile: &'a SupportProfile) -> Self {
        let slope = profile.self_supporting_slope;
        Self {
            profile,
            least_n_z: (-1.0 / (1.0 + slope * slope).sqrt()) as f32,
            contacts: 0.0,
            weighted: 0.0,
            heights_mm: 0.0,
        }
    }

    /// The component along z of a facet's normal below which it may need contacts.
    pub fn least_n_z(&self) -> f32 {
        self.least_n_z
    }

    /// Returns true if a facet needs contacts.
    pub fn counts(&self, n_z: f32, is_above_plate: bool) -> bool {
        n_z < self.least_n_z && (is_above_plate || self.profile.lift_mm > 0.0)
    }

    /// Adds such a facet.
    pub fn add(&mut self, n_z: f64, area_mm2: f64, height_mm: f64, weight: f64) {
        // Rounding may exceed 1 slightly.
        let run = (1.0 - n_z * n_z).max(0.0).sqrt();
        let reach_mm = self.profile.reach_mm(run / -n_z);
        let contacts = PACKING * area_mm2 / (reach_mm * reach_mm);
        self.contacts += contacts;
        self.weighted += contacts * weight;
        self.heights_mm += contacts * (height_mm + self.profile.lift_mm);
    }

    /// The volume in millilitres and the weighted area of contacts in mm², with those of islands.
    pub fn of_islands(&self, islands: usize) -> [f64; 2] {
        let profile = self.profile;
        // A lifted model hangs from its lowest point.
        let lowest = if profile.lift_mm > 0.0 { 1.0 } else { 0.0 };
        let more = FOR_ISLAND * islands as f64 + lowest;
        let [height_mm, weight] = if self.contacts > 0.0 {
            [self.heights_mm, self.weighted].map(|sum| sum / self.contacts)
        } else {
            [profile.lift_mm, 1.0]
        };
        let circle_mm2 = |diameter_mm: f64| PI / 4.0 * diameter_mm * diameter_mm;
        let foot_mm3 = circle_mm2(profile.foot_mm) * profile.foot_thickness_mm;
        let pillar_mm3 = ALONE * circle_mm2(profile.pillar_mm) * height_mm;
        [
            (self.contacts + more) * (foot_mm3 + pillar_mm3) / 1e3,
            (self.weighted + more * weight) * circle_mm2(profile.contact_mm),
        ]
    }
}
