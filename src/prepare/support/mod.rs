//! Supports: what holds a model where nothing is below it, as bodies of their own class.
//!
//! Contacts are found (`contacts.rs`), each gets a tip and a way down that keeps clear of the model (`clearance.rs`), ways join to trees
//! (`trees.rs`), and these become bodies (`shapes.rs`).

mod clearance;
mod contacts;
mod held;
mod islands;
mod loads;
mod pieces;
mod rays;
mod shapes;
mod trees;

use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::columns::Columns;
use super::lengths::{self, BadLength};
use super::shell::Shell;
use super::surface::Surface;
use crate::argsort::sort_by_number;
use crate::grid::Grid;
use crate::ldi::{LdiError, cpu};
use crate::model::{Bounds, Mesh};
use crate::progress::{Progress, report};
use clearance::Clearance;
use contacts::{Contact, Wishes};
pub(crate) use loads::peel_n;
use trees::Trees;

/// Options of supports.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(default, try_from = "Asked")]
#[cfg_attr(feature = "cli", schemars(!try_from))]
pub struct Supporting {
    /// Strength and density of supports.
    pub strength: SupportStrength,
    /// Sizes in place of those of the strength, which apply where one is absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub profile: Option<SupportProfile>,
    /// Supports at these points. If absent, they are placed automatically.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<Vec<SupportPoint>>,
    /// True if more are placed automatically where these points do not hold the model.
    pub fill: bool,
    /// True if automatic points keep off facets that weigh more than a half. Those that the model would need there are unreached.
    pub protect: bool,
}

/// Supports as options give them: with some sizes, or none.
#[derive(Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Asked {
    strength: SupportStrength,
    profile: Option<Map<String, Value>>,
    points: Option<Vec<SupportPoint>>,
    fill: bool,
    #[serde(alias = "spare")]
    protect: bool,
}

impl TryFrom<Asked> for Supporting {
    type Error = serde_json::Error;

    fn try_from(asked: Asked) -> Result<Self, serde_json::Error> {
        let usual = asked.strength.profile();
        let profile = asked.profile.map(|sizes| usual.with_sizes(sizes));
        Ok(Self {
            strength: asked.strength,
            profile: profile.transpose()?,
            points: asked.points,
            fill: asked.fill,
            protect: asked.protect,
        })
    }
}

/// Strength and density of supports.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema, clap::ValueEnum))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum SupportStrength {
    /// For small models with much detail: thin tips that leave hardly a mark.
    Light,
    /// For most models.
    #[default]
    Medium,
    /// For large and solid models.
    Heavy,
}

/// A point that is supported.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(deny_unknown_fields)]
pub struct SupportPoint {
    /// Its place on the surface: x and y from the model's middle, z from its lowest point.
    pub at_mm: [f64; 3],
    /// Diameter of its tip; the profile's if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact_mm: Option<f64>,
}

/// All sizes of supports.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(default, deny_unknown_fields)]
pub struct SupportProfile {
    /// Distance by which the model is lifted above the plate.
    pub lift_mm: f64,
    /// The flattest surface that supports itself, as its rise over its run.
    pub self_supporting_slope: f64,
    /// Radius that a contact holds on a level surface. It is half as large again on one that just does not support
    /// itself.
    pub spacing_mm: f64,
    /// Diameter of a tip where it touches the model.
    pub contact_mm: f64,
    /// Depth of a tip in the model.
    pub penetration_mm: f64,
    /// Length of a tip.
    pub tip_mm: f64,
    /// Diameter of a pillar below one tip. Its area grows by a sixth for each tip more.
    pub pillar_mm: f64,
    /// Distance that pillars keep from the model.
    pub clearance_mm: f64,
    /// Horizontal reach of a branch to another pillar.
    pub branch_mm: f64,
    /// Greatest height of a pillar that stands alone. Taller ones are braced with those nearby.
    pub brace_mm: f64,
    /// Diameter of a foot on the plate.
    pub foot_mm: f64,
    /// Thickness of a foot on the plate.
    pub foot_thickness_mm: f64,
    /// True if all feet stand on one raft.
    pub raft: bool,
    /// Thickness of the raft.
    pub raft_thickness_mm: f64,
    /// Distance by which the raft reaches beyond the feet.
    pub raft_margin_mm: f64,
    /// Slope of the raft's side, as its rise over its run: its top is wider, so that a scraper gets under it.
    pub raft_slope: f64,
    /// Distance between the bars of the raft, between which resin leaves it; 0 for a closed raft.
    pub raft_hole_mm: f64,
    /// Pull of the film per area at a disc of 20 mm, in kPa: the printer's, or else 15, if absent; 0 if supports need not bear it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub film_kpa: Option<f64>,
    /// Greatest stress of a tip where it touches the model, in N/mm².
    pub tip_mpa: f64,
}

impl Default for SupportProfile {
    /// [`SupportStrength::Medium`].
    fn default() -> Self {
        SupportStrength::Medium.profile()
    }
}

impl SupportStrength {
    /// The sizes of supports.
    pub fn profile(self) -> SupportProfile {
        let medium = SupportProfile {
            lift_mm: 5.0,
            // 30° from level.
            self_supporting_slope: 0.577,
            spacing_mm: 3.0,
            contact_mm: 0.4,
            penetration_mm: 0.2,
            tip_mm: 2.0,
            pillar_mm: 1.0,
            clearance_mm: 0.5,
            branch_mm: 10.0,
            brace_mm: 15.0,
            foot_mm: 4.0,
            foot_thickness_mm: 0.5,
            raft: false,
            raft_thickness_mm: 1.0,
            raft_margin_mm: 2.0,
            raft_slope: 1.0,
            raft_hole_mm: 4.0,
            film_kpa: None,
            // A tip of 0.4 mm bears 0.25 N, a fifth of what breaks it.
            tip_mpa: 2.0,
        };
        match self {
            Self::Medium => medium,
            Self::Light => SupportProfile {
                contact_mm: 0.3,
                penetration_mm: 0.15,
                pillar_mm: 0.8,
                spacing_mm: 2.5,
                foot_mm: 3.0,
                ..medium
            },
            Self::Heavy => SupportProfile {
                contact_mm: 0.6,
                penetration_mm: 0.3,
                tip_mm: 2.5,
                pillar_mm: 1.5,
                spacing_mm: 4.0,
                foot_mm: 6.0,
                foot_thickness_mm: 0.8,
                ..medium
            },
        }
    }
}

/// Pull of the film of a printer that states none: between the 12 and 18 kPa of common films.
pub(crate) const FILM_KPA: f64 = 15.0;

/// A size by its name in the options, and its least value.
type LeastSize = (&'static str, fn(&SupportProfile) -> f64, f64);

impl SupportProfile {
    /// Least values of all sizes.
    pub(crate) const LEAST: [LeastSize; 18] = [
        ("supports.profile.lift_mm", |it| it.lift_mm, 0.0),
        (
            "supports.profile.self_supporting_slope",
            |it| it.self_supporting_slope,
            0.01,
        ),
        ("supports.profile.spacing_mm", |it| it.spacing_mm, 0.5),
        ("supports.profile.contact_mm", |it| it.contact_mm, 0.1),
        (
            "supports.profile.penetration_mm",
            |it| it.penetration_mm,
            0.0,
        ),
        ("supports.profile.tip_mm", |it| it.tip_mm, 0.5),
        ("supports.profile.pillar_mm", |it| it.pillar_mm, 0.3),
        (
            "supports.profile.clearance_mm",
            |it| it.clearance_mm,
            LEAST_CLEARANCE_MM,
        ),
        ("supports.profile.branch_mm", |it| it.branch_mm, 0.0),
        ("supports.profile.brace_mm", |it| it.brace_mm, 2.0),
        ("supports.profile.foot_mm", |it| it.foot_mm, 0.3),
        (
            "supports.profile.foot_thickness_mm",
            |it| it.foot_thickness_mm,
            0.1,
        ),
        (
            "supports.profile.raft_thickness_mm",
            |it| it.raft_thickness_mm,
            0.2,
        ),
        (
            "supports.profile.raft_margin_mm",
            |it| it.raft_margin_mm,
            0.0,
        ),
        ("supports.profile.raft_slope", |it| it.raft_slope, 0.3),
        ("supports.profile.raft_hole_mm", |it| it.raft_hole_mm, 0.0),
        ("supports.profile.film_kpa", Self::film_kpa, 0.0),
        ("supports.profile.tip_mpa", |it| it.tip_mpa, 0.1),
    ];

    /// The profile with other sizes, by their names in the options.
    ///
    /// # Errors
    /// A size that is unknown, or of another type.
    pub fn with_sizes(self, sizes: Map<String, Value>) -> serde_json::Result<Self> {
        let mut all = serde_json::to_value(self)?;
        if let Value::Object(all) = &mut all {
            all.extend(sizes);
        }
        serde_json::from_value(all)
    }

    /// The pull of the film that counts.
    pub fn film_kpa(&self) -> f64 {
        self.film_kpa.unwrap_or(FILM_KPA)
    }

    /// Radius that a contact holds on a surface of a slope (rise over run): `spacing_mm` on a level one, half as much
    /// again on one that just does not support itself.
    pub fn reach_mm(&self, slope: f64) -> f64 {
        self.spacing_mm * (1.0 + 0.5 * (slope / self.self_supporting_slope).min(1.0))
    }
}

impl Supporting {
    /// The sizes that count.
    pub fn profile(&self) -> SupportProfile {
        self.profile.unwrap_or_else(|| self.strength.profile())
    }

    /// Checks the lengths.
    pub(crate) fn check(&self) -> Result<(), BadLength> {
        let profile = self.profile();
        let least = SupportProfile::LEAST.iter();
        let least = least.map(|&(option, size, least)| (option, size(&profile), least));
        let foot_mm = (
            "supports.profile.foot_mm",
            profile.foot_mm,
            profile.pillar_mm,
        );
        // Supports need room between the raft and the model.
        let below_mm = if profile.raft {
            profile.raft_thickness_mm + LEAST_GAP_MM
        } else {
            0.0
        };
        let lift_mm = ("supports.profile.lift_mm", profile.lift_mm, below_mm);
        let points = self.points.iter().flatten();
        let points = points.filter_map(|point| point.contact_mm);
        let points = points.map(|mm| ("supports.points.contact_mm", mm, 0.1));
        lengths::check(
            least.chain([foot_mm, lift_mm]).chain(points),
            MOST_SUPPORT_MM,
        )
    }
}

/// Least clearance of pillars.
const LEAST_CLEARANCE_MM: f64 = 0.1;

/// Least distance between a raft and the model.
pub(crate) const LEAST_GAP_MM: f64 = 1.0;

/// The largest size of any part.
pub(crate) const MOST_SUPPORT_MM: f64 = 50.0;

/// The supports of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Supports {
    /// Bodies of the supports, which overlap each other and the model.
    pub shell: Shell,
    /// The points that are supported.
    pub points: Vec<SupportPoint>,
    /// The points that no support reaches, or may touch.
    pub unreached: Vec<SupportPoint>,
    /// Points asked for that are not on the surface, by their places among those.
    pub astray: Vec<usize>,
    /// Pillars that stand on the model.
    pub on_model: usize,
    /// Points where pillars, branches and braces join, in millimetres.
    pub joints_mm: Vec<[f64; 3]>,
    /// Distance by which the model is lifted above the plate.
    pub lift_mm: f64,
    /// The largest load of a tip; none if nothing is held, or if loads do not count.
    pub load: Option<SupportLoad>,
}

/// Load of the tip that bears most.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct SupportLoad {
    /// Force with which the film pulls at it, in newtons.
    pub newtons: f64,
    /// The largest force that it is to bear.
    pub limit_n: f64,
    /// Its contact, from the model's middle and lowest point.
    pub at_mm: [f64; 3],
    /// Height of the layer that pulls most, from the model's lowest point.
    pub layer_mm: f64,
}

impl Supports {
    /// Supports that a file brings along: their tips, on a model that stands on the plate, and the distance by which they lift it.
    pub(crate) fn of_file(tips: &[Vec3], lift_mm: f64) -> Self {
        let mut points: Vec<SupportPoint> = tips
            .iter()
            .map(|tip| SupportPoint {
                at_mm: tip.as_dvec3().to_array(),
                contact_mm: None,
            })
            .collect();
        sort_by_number(&mut points, |it| -it.at_mm[2]);
        Self {
            shell: Shell::default(),
            points,
            unreached: Vec::new(),
            astray: Vec::new(),
            on_model: 0,
            joints_mm: Vec::new(),
            lift_mm,
            load: None,
        }
    }

    /// The same, with every point at its place elsewhere. The shell is left out.
    pub(crate) fn moved(&self, place: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        let points = |points: &[SupportPoint]| {
            let moved = points.iter().map(|point| SupportPoint {
                at_mm: place(point.at_mm),
                ..*point
            });
            moved.collect()
        };
        Self {
            shell: Shell::default(),
            points: points(&self.points),
            unreached: points(&self.unreached),
            astray: self.astray.clone(),
            load: self.load.map(|load| SupportLoad {
                at_mm: place(load.at_mm),
                ..load
            }),
            joints_mm: self.joints_mm.iter().map(|&at| place(at)).collect(),
            ..*self
        }
    }
}

/// The pitch of rays, unless the model is large.
const PITCH_MM: f64 = 0.2;

/// The most points at which distances are known.
const MOST_NODES: f64 = 2e7;

/// The most rays.
const MOST_RAYS: f64 = 4e6;

/// Greatest distance of a given point from the surface.
const ON_SURFACE_MM: f64 = 2.0;

/// Margin around the model for pillars that pass it, including their feet.
const BESIDE_MM: f64 = 6.0;

/// The supports of a model that stands on the plate, centred on x = y = 0. They are in its frame, so the plate is below it by the lift.
///
/// `weights` are those of the facets of the surface, if they say where no contact may be. `wider_mm` is added to all radii: the width by which
/// masks are narrower than what they print.
///
/// Cost: linear in the points of a lattice around the model, and in contacts times those of all pillars.
///
/// # Errors
/// [`LdiError::Cancelled`], [`LdiError::OutOfMemory`], [`LdiError::TooManyFacets`].
pub fn support(
    mesh: &Mesh,
    supporting: &Supporting,
    weights: Option<&[f32]>,
    wider_mm: f64,
    progress: &mut Progress<'_>,
) -> Result<Supports, LdiError> {
    let profile = supporting.profile();
    let bounds = mesh.bounds();
    let size = bounds.size();
    let beside = DVec3::new(BESIDE_MM, BESIDE_MM, 0.0);
    let around = Bounds {
        min: bounds.min - beside,
        max: bounds.max + beside,
    };
    let room = around.size();
    let stride = clearance::STRIDE as f64;
    let mut pitch_mm = PITCH_MM;
    // By a factor that is exact, and so the same on every machine.
    while room.x * room.y * (size.z + profile.lift_mm)
        / (stride * pitch_mm * stride * pitch_mm * stride * pitch_mm)
        > MOST_NODES
        || room.x * room.y / (pitch_mm * pitch_mm) > MOST_RAYS
    {
        pitch_mm *= 1.25;
    }
    let Ok(grid) = Grid::of_pitch(&around, pitch_mm) else {
        return Err(LdiError::OutOfMemory {
            hits: (room.x * room.y / (pitch_mm * pitch_mm)) as u64,
            needed_bytes: (MOST_NODES * Clearance::NODE_BYTES) as u64,
        });
    };
    let ldi = cpu::sample(mesh, &grid, &mut |fraction| progress(0.2 * fraction))?;
    let surface = Surface::new(mesh);
    let mut astray = Vec::new();
    let mut contacts = Vec::new();
    for (place, point) in supporting.points.iter().flatten().enumerate() {
        let diameter_mm = point.contact_mm.unwrap_or(profile.contact_mm);
        let at = DVec3::from_array(point.at_mm);
        match surface.contact(at, diameter_mm, ON_SURFACE_MM) {
            Some(contact) => contacts.push(contact),
            None => astray.push(place),
        }
    }
    let (mut missed, mut load) = (Vec::new(), None);
    if supporting.fill || supporting.points.is_none() {
        let wishes = Wishes {
            profile: &profile,
            given: &contacts,
            weights: weights.filter(|_| supporting.protect),
        };
        let (placed, left, largest) = contacts::place(&surface, &ldi, &wishes);
        contacts.extend(placed);
        missed = left;
        load = largest;
    }
    let columns = Columns::of_model(&ldi);
    drop(ldi);
    let corner = grid.centre_mm(0, 0).as_vec2();
    let highest_mm = contacts.iter().map(|it| it.at.z).fold(0.0, f64::max);
    // The thickest pillar that there can be needs the largest distance.
    let most_mm = trees::most_mm(&profile);
    let clearance = Clearance::new(
        columns,
        corner.extend(-profile.lift_mm as f32),
        highest_mm as f32,
        most_mm as f32,
        &mut |fraction| progress(0.2 + 0.5 * fraction),
    )?;
    let mut trees = Trees::new(clearance, profile);
    let point = |contact: &Contact| {
        let is_own = contact.diameter_mm != profile.contact_mm;
        SupportPoint {
            at_mm: contact.at.to_array(),
            contact_mm: is_own.then_some(contact.diameter_mm),
        }
    };
    let mut held = |fraction| progress(0.75 + 0.2 * fraction);
    let (held, left) = trees.add_all(&contacts, &mut held)?;
    let unreached = missed.iter().chain(left).map(point).collect();
    let points = held.into_iter().map(point).collect();
    trees.brace();
    let (on_model, joints) = (trees.on_model(), trees.joints());
    let shell = trees.shell(wider_mm);
    report(progress, 1.0)?;
    Ok(Supports {
        shell,
        points,
        unreached,
        astray,
        on_model,
        joints_mm: joints,
        lift_mm: profile.lift_mm,
        load,
    })
}
