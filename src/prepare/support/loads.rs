//! Loads of contacts: the film pulls at every layer, and what holds the piece below shares the pull.
//!
//! A piece is taken for rigid and its contacts for springs as stiff as they are large, so loads are linear in x and y, and their sum
//! and their moment are those of the pull. What stands on the plate holds as well.

use glam::{DVec2, DVec3};

use super::SupportProfile;
use super::contacts::Contact;
use super::rays::Rays;
use crate::union_find;
use crate::ways::AROUND;

/// Radius of the disc at which the pressure of a film is measured.
const DISC_MM: f64 = 10.0;

/// Least distance of a contact that is added from all others, in spacings: where they are as close, tips become wider instead.
const BESIDE: f64 = 0.75;

/// The largest diameter of a tip, in those of the profile.
const LARGEST: f64 = 2.0;

/// Distance from a contact within which a moment is held by the bending of its pillar.
const BENDING_MM: f64 = 1.0;

/// Least height of a slice.
const SLICE_MM: f64 = 0.5;

/// The most slices.
const MOST_SLICES: f64 = 64.0;

/// Pull of the film at a region of a layer. For the same area it grows with the root of area over perimeter: a disc of 314 mm² pulls with 6.16 N
/// where a triangle pulls with 5.45 (Pan et al., 2017).
pub(crate) fn peel_n(area_mm2: f64, perimeter_mm: f64, film_kpa: f64) -> f64 {
    if perimeter_mm <= 0.0 {
        return 0.0;
    }
    let radius_mm = 2.0 * area_mm2 / perimeter_mm;
    film_kpa * 1e-3 * area_mm2 * (radius_mm / DISC_MM).sqrt()
}

/// The largest load of a contact, and when.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Load {
    pub contact: usize,
    pub newtons: f64,
    /// Height of the layer at which the film pulls.
    pub z_mm: f64,
}

/// A lower end of a ray where a contact may be added.
pub(super) struct Candidate {
    pub stretch: usize,
    pub at: DVec3,
}

/// Sums over what holds a piece: stiffness, and its first and second moments.
#[derive(Default, Clone, Copy)]
struct Springs {
    stiffness: f64,
    first: DVec2,
    second: [f64; 3],
}

impl Springs {
    fn add(&mut self, at: DVec2, stiffness: f64) {
        self.stiffness += stiffness;
        self.first += at * stiffness;
        let own = BENDING_MM * BENDING_MM;
        let squares = [at.x * at.x + own, at.x * at.y, at.y * at.y + own];
        for (sum, square) in self.second.iter_mut().zip(squares) {
            *sum += square * stiffness;
        }
    }

    /// Load per stiffness at each place, when a force pulls at one.
    fn loads(&self, force_n: f64, at: DVec2) -> impl Fn(DVec2) -> f64 + use<> {
        let middle = self.first / self.stiffness;
        let [xx, xy, yy] = [
            self.second[0] - middle.x * self.first.x,
            self.second[1] - middle.x * self.first.y,
            self.second[2] - middle.y * self.first.y,
        ];
        let moment = (at - middle) * force_n;
        let determinant = xx * yy - xy * xy;
        let slope = DVec2::new(
            (moment.x * yy - moment.y * xy) / determinant,
            (moment.y * xx - moment.x * xy) / determinant,
        );
        let mean = force_n / self.stiffness;
        move |place| mean + slope.dot(place - middle)
    }
}

/// Part of a slice that is one piece with what is below it.
#[derive(Default, Clone, Copy)]
struct Region {
    rays: f64,
    /// Dark rays beside those of the region; those at corners count by the root of a half.
    edges: f64,
    sum: DVec2,
}

/// Visits a piece in a slice, given the union-find of all stretches and the contacts.
type Visit<'a> = dyn FnMut(&mut [u32], &Slice<'_>, &mut Vec<Contact>) -> Option<usize> + 'a;

/// The parts of a slice, each with the root of its piece.
type Regions = Vec<(u32, Region)>;

/// Slices of the print from the lowest up.
pub(super) struct Loads<'a> {
    rays: &'a Rays<'a>,
    profile: &'a SupportProfile,
    order: Vec<usize>,
    /// Stretches that stand on the plate.
    standing: Vec<usize>,
}

impl<'a> Loads<'a> {
    pub fn new(rays: &'a Rays<'a>, profile: &'a SupportProfile, standing: Vec<usize>) -> Self {
        Self {
            order: rays.ascending(),
            rays,
            profile,
            standing,
        }
    }

    /// Adds contacts where those below a slice bear too much, by `contact`, the farthest from all others first; then makes tips larger.
    /// Contacts before `fixed` keep their size. Returns the largest load.
    pub fn relieve(
        &self,
        contacts: &mut Vec<Contact>,
        fixed: usize,
        candidates: &[Candidate],
        contact: &dyn Fn(DVec3) -> Option<Contact>,
    ) -> Option<Load> {
        if self.profile.film_kpa == 0.0 {
            return None;
        }
        let away_mm = |at: DVec3, contacts: &[Contact]| {
            let each = contacts.iter().map(|it| it.at.distance(at));
            each.fold(f64::INFINITY, f64::min)
        };
        let mut gaps_mm: Vec<f64> = candidates
            .iter()
            .map(|it| away_mm(it.at, contacts))
            .collect();
        let least_mm = BESIDE * self.profile.spacing_mm;
        let mut regions = Vec::new();
        self.sweep(&mut regions, contacts, &mut |parent, slice, contacts| {
            if !slice.is_overloaded {
                return None;
            }
            // The candidate of the overloaded piece that is farthest from all contacts.
            let mut best: Option<(f64, usize)> = None;
            for (place, (candidate, &gap_mm)) in candidates.iter().zip(&gaps_mm).enumerate() {
                let is_best = gap_mm >= least_mm && best.is_none_or(|best| gap_mm > best.0);
                if is_best
                    && candidate.at.z < slice.z_mm
                    && union_find::find(parent, candidate.stretch as u32) == slice.root
                {
                    best = Some((gap_mm, place));
                }
            }
            let (_, place) = best?;
            gaps_mm[place] = 0.0;
            let added = contact(candidates[place].at)?;
            for (gap_mm, candidate) in gaps_mm.iter_mut().zip(candidates) {
                *gap_mm = gap_mm.min(candidate.at.distance(added.at));
            }
            contacts.push(Contact {
                is_for_load: true,
                ..added
            });
            Some(candidates[place].stretch)
        });
        let mut largest = Vec::new();
        for _ in 0..3 {
            largest = self.largest(&mut regions, contacts);
            let mut is_wider = false;
            for (contact, load) in contacts.iter_mut().zip(&largest).skip(fixed) {
                let most_n = self.most_n(contact.diameter_mm);
                if load.newtons > most_n {
                    let wider = (load.newtons / most_n).sqrt();
                    // Whole micrometres, as in reports.
                    let wider_mm = (contact.diameter_mm * wider * 1e3).ceil() / 1e3;
                    let wider_mm = wider_mm.min(LARGEST * self.profile.contact_mm);
                    is_wider |= wider_mm != contact.diameter_mm;
                    contact.diameter_mm = wider_mm;
                }
            }
            if !is_wider {
                break;
            }
        }
        let all = largest.into_iter();
        all.reduce(|a, b| if b.newtons > a.newtons { b } else { a })
    }

    /// The largest force that a tip bears.
    pub fn most_n(&self, diameter_mm: f64) -> f64 {
        tip_mm2(diameter_mm) * self.profile.tip_mpa
    }

    /// The largest load of each contact.
    fn largest(&self, regions: &mut Vec<Regions>, contacts: &mut Vec<Contact>) -> Vec<Load> {
        let mut largest: Vec<Load> = (0..contacts.len())
            .map(|contact| Load {
                contact,
                newtons: 0.0,
                z_mm: 0.0,
            })
            .collect();
        self.sweep(regions, contacts, &mut |_, slice, contacts| {
            for &contact in slice.contacts {
                let it = &contacts[contact];
                let newtons = (slice.load)(it.at.truncate()) * tip_mm2(it.diameter_mm);
                if newtons > largest[contact].newtons {
                    largest[contact] = Load {
                        contact,
                        newtons,
                        z_mm: slice.z_mm,
                    };
                }
            }
            None
        });
        largest
    }

    /// Calls `each` for every piece of every slice that contacts hold, again while it returns the stretch of a contact that it added. The
    /// regions of slices are found once.
    fn sweep(&self, regions: &mut Vec<Regions>, contacts: &mut Vec<Contact>, each: &mut Visit<'_>) {
        let rays = self.rays;
        let pitch_mm = rays.ldi.grid.pitch_mm;
        let top_mm = rays.stretches.iter().map(|it| it.to_mm).fold(0.0, f32::max);
        let step_mm = SLICE_MM.max(f64::from(top_mm) / MOST_SLICES);
        let mut parent: Vec<u32> = (0..rays.stretches.len() as u32).collect();
        let mut stretches: Vec<Option<usize>> =
            contacts.iter().map(|it| rays.stretch_at(it.at)).collect();
        let mut next = self.order.iter().copied().peekable();
        for slice in 1..=(f64::from(top_mm) / step_mm) as usize {
            let z_mm = slice as f64 * step_mm;
            while let Some(here) = next.next_if(|&it| f64::from(rays.stretches[it].from_mm) < z_mm)
            {
                let ray = rays.stretches[here].ray;
                for there in AROUND.iter().flat_map(|&step| rays.near(ray, step)) {
                    let begins = rays.stretches[there].from_mm <= rays.stretches[here].from_mm;
                    if begins && rays.overlap(here, there) {
                        union_find::unite(&mut parent, here as u32, there as u32);
                    }
                }
            }
            if regions.len() < slice {
                regions.push(self.regions(&mut parent, z_mm as f32));
            }
            for &(root, region) in &regions[slice - 1] {
                let area_mm2 = region.rays * pitch_mm * pitch_mm;
                // Cauchy and Crofton's formula for four directions.
                let perimeter_mm = region.edges * pitch_mm * std::f64::consts::FRAC_PI_8;
                let force_n = peel_n(area_mm2, perimeter_mm, self.profile.film_kpa);
                let middle = region.sum / region.rays;
                loop {
                    let mut springs = Springs::default();
                    let mut held_by = Vec::new();
                    for (contact, stretch) in stretches.iter().enumerate() {
                        let Some(stretch) = *stretch else { continue };
                        let it = &contacts[contact];
                        if it.at.z < z_mm && union_find::find(&mut parent, stretch as u32) == root {
                            springs.add(it.at.truncate(), tip_mm2(it.diameter_mm));
                            held_by.push(contact);
                        }
                    }
                    if held_by.is_empty() {
                        break;
                    }
                    for &stretch in &self.standing {
                        if union_find::find(&mut parent, stretch as u32) == root {
                            springs.add(rays.at(stretch).truncate(), pitch_mm * pitch_mm);
                        }
                    }
                    let load = springs.loads(force_n, middle);
                    let stress = held_by.iter().map(|&it| load(contacts[it].at.truncate()));
                    let slice = Slice {
                        root,
                        z_mm,
                        contacts: &held_by,
                        is_overloaded: stress.fold(0.0, f64::max) > self.profile.tip_mpa,
                        load: &load,
                    };
                    match each(&mut parent, &slice, contacts) {
                        Some(stretch) => stretches.push(Some(stretch)),
                        None => break,
                    }
                }
            }
        }
    }

    /// The parts of a slice by the piece that they belong to.
    fn regions(&self, parent: &mut [u32], z_mm: f32) -> Regions {
        let rays = self.rays;
        let is_lit = |ray: Option<usize>| {
            let mut those = ray.map_or(0..0, |ray| rays.of_ray(ray));
            those.any(|it| rays.stretches[it].from_mm < z_mm && z_mm < rays.stretches[it].to_mm)
        };
        let mut regions = Regions::new();
        let mut last = 0;
        for (stretch, it) in rays.stretches.iter().enumerate() {
            if !(it.from_mm < z_mm && z_mm < it.to_mm) {
                continue;
            }
            let root = union_find::find(parent, stretch as u32);
            // Most rays are in the same piece as the one before.
            if regions.get(last).is_none_or(|it| it.0 != root) {
                last = regions
                    .iter()
                    .position(|it| it.0 == root)
                    .unwrap_or_else(|| {
                        regions.push((root, Region::default()));
                        regions.len() - 1
                    });
            }
            let region = &mut regions[last].1;
            let [sides, corners] = [&AROUND[..4], &AROUND[4..]].map(|steps| {
                let dark = steps
                    .iter()
                    .filter(|&&step| !is_lit(rays.beside(it.ray, step)));
                dark.count() as f64
            });
            region.rays += 1.0;
            region.edges += sides + corners * std::f64::consts::FRAC_1_SQRT_2;
            region.sum += rays.at(stretch).truncate();
        }
        regions
    }
}

/// A piece in a slice, and what holds it.
struct Slice<'a> {
    root: u32,
    z_mm: f64,
    contacts: &'a [usize],
    is_overloaded: bool,
    /// Load by the area of a tip at a place, in N/mm².
    load: &'a dyn Fn(DVec2) -> f64,
}

fn tip_mm2(diameter_mm: f64) -> f64 {
    std::f64::consts::FRAC_PI_4 * diameter_mm * diameter_mm
}
