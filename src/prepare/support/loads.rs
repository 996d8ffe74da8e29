//! Loads of contacts: the film pulls at every layer, and what holds the piece below shares the pull.
//!
//! A piece is taken for rigid and its contacts for springs as stiff as they are large, so loads are linear in x and y, and their sum
//! and their moment are those of the pull. What stands on the plate holds as well.

use glam::{DVec2, DVec3};

use super::SupportProfile;
use super::contacts::Contact;
use super::pieces::Pieces;
use super::rays::Rays;

/// Radius of the disc at which the pressure of a film is measured.
const DISC_MM: f64 = 10.0;

/// Least distances of a contact that is added from all others, in spacings: where they are as close, tips become wider, and then contacts
/// closer.
const BESIDE: [f64; 2] = [0.75, 0.4];

/// The largest diameter of a tip, in those of the profile.
const LARGEST: f64 = 2.0;

/// Distance from a contact within which a moment is held by the bending of its pillar: half the radius of one of a millimetre.
const BENDING_MM: f64 = 0.25;

/// Least height of a slice.
const SLICE_MM: f64 = 0.1;

/// The most slices.
const MOST_SLICES: f64 = 1000.0;

/// The most rounds in which tips become wider: each takes more of the load from the others.
const ROUNDS: usize = 8;

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

    fn join(&mut self, other: &Self) {
        self.stiffness += other.stiffness;
        self.first += other.first;
        for (sum, its) in self.second.iter_mut().zip(other.second) {
            *sum += its;
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

/// The pull at a piece in a slice, and what holds it.
struct Pull {
    root: u32,
    z_mm: f64,
    force_n: f64,
    middle: DVec2,
    /// Springs of the rays that stand on the plate.
    standing: Springs,
    contacts: Vec<usize>,
}

impl Pull {
    /// Load by the area of a tip at each place, in N/mm².
    fn loads(&self, contacts: &[Contact]) -> impl Fn(DVec2) -> f64 + use<> {
        let mut springs = self.standing;
        for &contact in &self.contacts {
            let it = &contacts[contact];
            springs.add(it.at.truncate(), tip_mm2(it.diameter_mm));
        }
        springs.loads(self.force_n, self.middle)
    }
}

/// Visits a pull, given the pieces and the contacts; returns the stretch of a contact that it adds.
type Visit<'a> = dyn FnMut(&mut Pieces<'_>, Pull, &mut Vec<Contact>) -> Option<usize> + 'a;

/// Slices of the print from the lowest up.
pub(super) struct Loads<'a> {
    rays: &'a Rays<'a>,
    profile: &'a SupportProfile,
    /// Stretches that stand on the plate.
    standing: Vec<usize>,
}

impl<'a> Loads<'a> {
    pub fn new(rays: &'a Rays<'a>, profile: &'a SupportProfile, standing: Vec<usize>) -> Self {
        Self {
            rays,
            profile,
            standing,
        }
    }

    /// Adds contacts where those below a slice bear too much, by `contact`, the farthest from all others first; then makes tips wider, and then
    /// adds contacts closer to the others. The first `fixed` keep their size. Returns the largest load.
    pub fn relieve(
        &self,
        contacts: &mut Vec<Contact>,
        fixed: usize,
        candidates: &[Candidate],
        contact: &dyn Fn(DVec3) -> Option<Contact>,
    ) -> Option<Load> {
        if self.profile.film_kpa() == 0.0 {
            return None;
        }
        let mut loads = Vec::new();
        for beside in BESIDE {
            let least_mm = beside * self.profile.spacing_mm;
            self.add(contacts, candidates, contact, least_mm);
            let mut pulls = Vec::new();
            self.sweep(contacts, &mut |_, pull, _| {
                pulls.push(pull);
                None
            });
            loads = self.widen(&pulls, contacts, fixed);
            let is_most = |it: &Load| it.newtons <= self.most_n(contacts[it.contact].diameter_mm);
            if loads.iter().all(is_most) {
                break;
            }
        }
        let all = loads.into_iter();
        all.reduce(|a, b| if b.newtons > a.newtons { b } else { a })
    }

    /// Adds contacts where those below a slice bear too much, each at least `least_mm` from all others.
    fn add(
        &self,
        contacts: &mut Vec<Contact>,
        candidates: &[Candidate],
        contact: &dyn Fn(DVec3) -> Option<Contact>,
        least_mm: f64,
    ) {
        let away_mm = |at: DVec3, contacts: &[Contact]| {
            let each = contacts.iter().map(|it| it.at.distance(at));
            each.fold(f64::INFINITY, f64::min)
        };
        // Those that are far enough from all contacts, each with its distance from the nearest one.
        let mut open: Vec<(f64, &Candidate)> = candidates
            .iter()
            .map(|it| (away_mm(it.at, contacts), it))
            .filter(|it| it.0 >= least_mm)
            .collect();
        self.sweep(contacts, &mut |pieces, pull, contacts| {
            let load = pull.loads(contacts);
            let bears = |&it: &usize| load(contacts[it].at.truncate()) <= self.profile.tip_mpa;
            if pull.contacts.iter().all(bears) {
                return None;
            }
            // The candidate of the overloaded piece that is farthest from all contacts.
            let mut best: Option<(f64, &Candidate)> = None;
            for &(gap_mm, candidate) in &open {
                if best.is_none_or(|best| gap_mm > best.0)
                    && candidate.at.z < pull.z_mm
                    && pieces.root(candidate.stretch) == pull.root
                {
                    best = Some((gap_mm, candidate));
                }
            }
            let (_, candidate) = best?;
            let added = contact(candidate.at);
            let at = added.map_or(candidate.at, |it| it.at);
            open.retain_mut(|(gap_mm, it)| {
                *gap_mm = gap_mm.min(it.at.distance(at));
                *gap_mm >= least_mm
            });
            contacts.push(Contact {
                is_for_load: true,
                ..added?
            });
            Some(candidate.stretch)
        });
    }

    /// Makes tips wider that bear too much, except the first `fixed`. Returns the largest load of each contact.
    fn widen(&self, pulls: &[Pull], contacts: &mut [Contact], fixed: usize) -> Vec<Load> {
        for _ in 0..ROUNDS {
            let mut is_wider = false;
            let loads = largest_loads(pulls, contacts);
            for (contact, load) in contacts.iter_mut().zip(loads).skip(fixed) {
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
        largest_loads(pulls, contacts)
    }

    /// The largest force that a tip bears.
    pub fn most_n(&self, diameter_mm: f64) -> f64 {
        tip_mm2(diameter_mm) * self.profile.tip_mpa
    }

    /// Calls `each` for every piece of every slice that contacts hold, again while it returns the stretch of a contact that it added.
    fn sweep(&self, contacts: &mut Vec<Contact>, each: &mut Visit<'_>) {
        let rays = self.rays;
        let pitch_mm = rays.ldi.grid.pitch_mm;
        let top_mm = rays.stretches.iter().map(|it| it.to_mm).fold(0.0, f32::max);
        let step_mm = SLICE_MM.max(f64::from(top_mm) / MOST_SLICES);
        let mut pieces = Pieces::new(rays);
        let dark = rays.dark(-self.profile.lift_mm as f32);
        let mut dark = Pieces::new(&dark);
        let mut stretches: Vec<Option<usize>> =
            contacts.iter().map(|it| rays.stretch_at(it.at)).collect();
        let of_ray = |&it: &usize| {
            let mut springs = Springs::default();
            springs.add(rays.at(it).truncate(), pitch_mm * pitch_mm);
            (it as u32, springs)
        };
        let mut standing: Vec<(u32, Springs)> = self.standing.iter().map(of_ray).collect();
        for slice in 1..=(f64::from(top_mm) / step_mm) as usize {
            let z_mm = slice as f64 * step_mm;
            pieces.rise(z_mm);
            dark.rise(z_mm);
            // Resin that the film closes in cannot follow: a cup pulls like a solid.
            let cups = pieces.enclosed(&mut dark);
            // Pieces that stand on the plate, by their roots.
            let mut by_root: Vec<(u32, Springs)> = Vec::new();
            for (stretch, springs) in &standing {
                let root = pieces.root(*stretch as usize);
                match by_root.iter_mut().find(|it| it.0 == root) {
                    Some((_, sum)) => sum.join(springs),
                    None => by_root.push((root, *springs)),
                }
            }
            standing = by_root;
            let roots = contacts.iter().zip(&stretches);
            let roots = roots.map(|(contact, &stretch)| {
                let below = stretch.filter(|_| contact.at.z < z_mm);
                below.map(|it| pieces.root(it))
            });
            let roots: Vec<Option<u32>> = roots.collect();
            for (root, mut region) in pieces.regions() {
                for (_, cup) in cups.iter().filter(|it| it.0 == root) {
                    region.fill(cup);
                }
                let all = roots.iter().enumerate();
                let mut held_by: Vec<usize> = all
                    .filter(|it| *it.1 == Some(root))
                    .map(|it| it.0)
                    .collect();
                if held_by.is_empty() {
                    continue;
                }
                let own = standing.iter().find(|it| it.0 == root);
                let own = own.map(|it| it.1).unwrap_or_default();
                let (area_mm2, perimeter_mm) =
                    (region.area_mm2(pitch_mm), region.perimeter_mm(pitch_mm));
                loop {
                    let pull = Pull {
                        root,
                        z_mm,
                        force_n: peel_n(area_mm2, perimeter_mm, self.profile.film_kpa()),
                        middle: region.middle(),
                        standing: own,
                        contacts: held_by.clone(),
                    };
                    let Some(added) = each(&mut pieces, pull, contacts) else {
                        break;
                    };
                    held_by.push(stretches.len());
                    stretches.push(Some(added));
                }
            }
        }
    }
}

/// The largest load of each contact.
fn largest_loads(pulls: &[Pull], contacts: &[Contact]) -> Vec<Load> {
    let mut largest: Vec<Load> = (0..contacts.len())
        .map(|contact| Load {
            contact,
            newtons: 0.0,
            z_mm: 0.0,
        })
        .collect();
    for pull in pulls {
        let load = pull.loads(contacts);
        for &contact in &pull.contacts {
            let it = &contacts[contact];
            let newtons = load(it.at.truncate()) * tip_mm2(it.diameter_mm);
            if newtons > largest[contact].newtons {
                largest[contact] = Load {
                    contact,
                    newtons,
                    z_mm: pull.z_mm,
                };
            }
        }
    }
    largest
}

fn tip_mm2(diameter_mm: f64) -> f64 {
    std::f64::consts::FRAC_PI_4 * diameter_mm * diameter_mm
}
