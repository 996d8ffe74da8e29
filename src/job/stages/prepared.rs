//! A model on the plate with its voids and supports, ready to be sampled. It does not depend on pixels.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use glam::DVec3;
use serde::Serialize;
use web_time::Instant;

use super::parts::Sampling;
use super::stage::ms_since;
use crate::arrange::{Outline, Screen, shadow_mm2};
use crate::grid::{Grid, GridError};
use crate::job::report::mesh_warnings;
use crate::job::{Error, Timings};
use crate::ldi::LdiError;
use crate::model::{Bounds, FacetClass, Mesh, Pose, rotation_matrix};
use crate::prepare::{
    self, Drain, Hollowing, SupportLoad, SupportPoint, Supporting, Supports, Void,
};
use crate::progress::Progress;
use crate::warning::Warning;

/// A model that is ready to be sampled. Immutable and shared.
#[derive(Debug)]
pub struct Prepared {
    of: Preparing,
    pub mesh: Mesh,
    /// The box of its surface, without supports.
    pub surface: Bounds,
    /// The box of all that is printed.
    pub printed: Bounds,
    /// Its void, if it is hollowed.
    pub hollowed: Option<Hollowed>,
    /// Its supports, if it has any; their facets are in the mesh.
    pub supports: Option<Supports>,
    pub warnings: Vec<Warning>,
    /// The hollow model without its supports, if it has both: a change of supports hollows nothing again.
    unsupported: Option<Arc<Unsupported>>,
    shadow: Shadow,
}

/// Results about its shadow on the plate, once they were asked for.
#[derive(Debug, Default)]
struct Shadow {
    area_mm2: OnceLock<f64>,
    /// The last two: one is in cells for arranging, the other in pixels for checks of places.
    outlines: Mutex<Vec<(Screen, Arc<Outline>)>>,
}

/// A model on the plate with its void, before it is supported.
#[derive(Debug, Clone)]
struct Unsupported {
    mesh: Mesh,
    hollowed: Option<Hollowed>,
    warnings: Vec<Warning>,
}

/// The options that decide its preparation.
#[derive(Debug, Clone, PartialEq)]
struct Preparing {
    pose: Pose,
    hollow: Option<Hollowing>,
    supports: Option<Supporting>,
    wider_mm: f64,
    /// The weights of facets that say where no contact and no hole may be, if they do.
    protected: Option<Vec<f32>>,
}

/// The void of a hollowed model.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Hollowed {
    /// Volume of the void, without what its struts take.
    pub void_ml: f64,
    /// The drain holes that meet it, each with its depth: those asked for, then those placed automatically. None of
    /// plates with several models, each of which has a frame of its own.
    pub drains: Vec<Drain>,
    /// Number of pillars that hold ceilings of the void.
    pub pillars: usize,
    /// Walls may be thinner than asked by this.
    pub resolution_mm: f64,
    /// Tops of these pillars, from the model's lowest point, and the distance up to which each holds the ceiling.
    #[serde(skip)]
    pub ceilings_mm: Vec<([f64; 3], f64)>,
}

/// The supports of a model.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Supported {
    /// Volume of the supports outside the model.
    pub support_ml: f64,
    /// Distance by which the model is lifted above the plate.
    pub lift_mm: f64,
    /// The points that are supported, from the highest down. None of plates with several models, as of drain holes.
    pub points: Vec<SupportPoint>,
    /// The points that no support reaches, or may touch.
    pub unreached: Vec<SupportPoint>,
    /// Supports that stand on the model, where they leave a mark.
    pub on_model: usize,
    /// The largest load of a tip; absent if nothing is held, or if loads do not count.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load: Option<SupportLoad>,
    /// Points where pillars, branches and braces join, from the model's lowest point.
    #[serde(skip)]
    pub joints_mm: Vec<[f64; 3]>,
}

/// The fraction of the stage of rays that hollowing and supports take, if there are any.
pub const PREPARING_SHARE: f64 = 0.5;

impl Prepared {
    /// Poses the model, and adds voids and supports unless it does not fit the printer, in no direction if copies may turn. The void is
    /// that of `last`, if that is hollowed alike.
    ///
    /// # Errors
    /// [`Error::Mesh`], [`Error::Grid`], [`Error::Ldi`].
    pub fn new(
        model: &Mesh,
        sampling: &Sampling,
        may_turn: bool,
        protected: Option<&[f32]>,
        last: Option<&Self>,
        timings: &mut Timings,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Error> {
        let hollowed_alike = last.and_then(|last| last.unsupported(sampling, protected));
        // Share of the progress that belongs to hollowing.
        let between = match (&sampling.hollow, &sampling.supports) {
            (Some(_), Some(_)) if hollowed_alike.is_none() => 0.5,
            (Some(_), None) if hollowed_alike.is_none() => 1.0,
            _ => 0.0,
        };
        let unsupported = if let Some(alike) = hollowed_alike {
            alike
        } else {
            let mut within = |fraction| progress(between * fraction);
            let made =
                Unsupported::new(model, sampling, may_turn, protected, timings, &mut within)?;
            Arc::new(made)
        };
        let clock = Instant::now();
        let is_both = sampling.hollow.is_some() && sampling.supports.is_some();
        let kept = is_both.then(|| Arc::clone(&unsupported));
        let Unsupported {
            mut mesh,
            hollowed,
            mut warnings,
        } = Arc::unwrap_or_clone(unsupported);
        let mut supports = None;
        if let Some(supporting) = &sampling.supports {
            let mut within = |fraction| progress(between + (1.0 - between) * fraction);
            let mut made =
                prepare::support(&mesh, supporting, protected, sampling.wider_mm, &mut within)?;
            let shell = std::mem::take(&mut made.shell);
            mesh.add(&shell.vertices, &shell.facets, FacetClass::Support);
            mesh.lift(made.lift_mm);
            warnings.extend(support_warnings(&made));
            supports = Some(made);
        } else if !mesh.own_tips().is_empty() {
            let lift_mm = mesh.raised_mm();
            supports = Some(Supports::of_file(mesh.own_tips(), lift_mm));
            mesh.lift(lift_mm);
        }
        timings.ldi += ms_since(clock);
        Ok(Self {
            of: Preparing {
                pose: sampling.pose,
                hollow: sampling.hollow.clone(),
                supports: sampling.supports.clone(),
                wider_mm: sampling.wider_mm,
                protected: protected.map(<[f32]>::to_vec),
            },
            surface: mesh.bounds(),
            printed: mesh.printed_bounds(),
            mesh,
            hollowed,
            supports,
            warnings,
            unsupported: kept,
            shadow: Shadow::default(),
        })
    }

    /// The model before it was supported, if these options make the same.
    fn unsupported(
        &self,
        sampling: &Sampling,
        protected: Option<&[f32]>,
    ) -> Option<Arc<Unsupported>> {
        let is_alike = self.of.pose == sampling.pose
            && self.of.hollow == sampling.hollow
            && self.of.hollow.is_some()
            && self.of.protected.as_deref() == protected;
        match (&self.unsupported, &self.supports) {
            _ if !is_alike => None,
            (Some(unsupported), _) => Some(Arc::clone(unsupported)),
            (None, Some(_)) => None,
            (None, None) => Some(Arc::new(Unsupported {
                mesh: self.mesh.clone(),
                hollowed: self.hollowed.clone(),
                warnings: self.warnings.clone(),
            })),
        }
    }

    /// Distance by which supports lift the model above the plate.
    pub fn lift_mm(&self) -> f64 {
        self.supports.as_ref().map_or(0.0, |it| it.lift_mm)
    }

    /// The same after some turns of 15° about z, with the same voids and supports.
    ///
    /// # Errors
    /// [`Error::Mesh`].
    pub fn turned(&self, turns: u32) -> Result<Self, Error> {
        let turn = Pose::default().turned(turns);
        let mut mesh = self.mesh.on_plate(&turn)?;
        mesh.lift(self.lift_mm());
        let rotation = rotation_matrix(turn.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]))?;
        // Its middle has moved, by the same vector as any vertex.
        let [before, after] = [&self.mesh, &mesh].map(|it| it.vertices[0].as_dvec3());
        let by = (after - rotation * before).with_z(0.0);
        let place = |at: [f64; 3]| (rotation * DVec3::from_array(at) + by).to_array();
        Ok(Self {
            of: Preparing {
                pose: self.of.pose.turned(turns),
                ..self.of.clone()
            },
            surface: mesh.bounds(),
            printed: mesh.printed_bounds(),
            mesh,
            hollowed: self.hollowed.as_ref().map(|it| it.moved(place)),
            supports: self.supports.as_ref().map(|it| it.moved(place)),
            warnings: self.warnings.clone(),
            unsupported: None,
            shadow: Shadow::default(),
        })
    }

    /// The true area of its shadow.
    pub fn shadow_mm2(&self) -> f64 {
        *self.shadow.area_mm2.get_or_init(|| shadow_mm2(&self.mesh))
    }

    /// Its shadow on a plate.
    pub fn outline(&self, screen: &Screen) -> Arc<Outline> {
        let outlines = self.shadow.outlines.lock();
        let mut outlines = outlines.unwrap_or_else(PoisonError::into_inner);
        if let Some((_, known)) = outlines.iter().find(|(of, _)| of == screen) {
            return Arc::clone(known);
        }
        let outline = Arc::new(Outline::of(&self.mesh, screen));
        if outlines.len() == 2 {
            outlines.remove(0);
        }
        outlines.push((*screen, Arc::clone(&outline)));
        outline
    }

    /// Returns true if it is `upright` made with these options, which may turn it.
    pub fn is_turned(&self, upright: &Self, sampling: &Sampling) -> bool {
        self.is_of(sampling, upright.of.protected.as_deref())
    }

    /// Returns true if it is what [`Prepared::new`] would make.
    pub fn is_of(&self, sampling: &Sampling, protected: Option<&[f32]>) -> bool {
        let Preparing {
            pose,
            hollow,
            supports,
            wider_mm,
            protected: of,
        } = &self.of;
        *pose == sampling.pose
            && *hollow == sampling.hollow
            && *supports == sampling.supports
            && *wider_mm == sampling.wider_mm
            && of.as_deref() == protected
    }

    /// Returns true if voids or supports are made.
    pub fn takes_time(sampling: &Sampling) -> bool {
        sampling.hollow.is_some() || sampling.supports.is_some()
    }

    /// The pixels of the masks.
    ///
    /// # Errors
    /// [`GridError`], also if the model or its supports do not fit the printer.
    pub fn grid(&self, sampling: &Sampling) -> Result<Grid, GridError> {
        let mut model = self.surface;
        let lift = DVec3::new(0.0, 0.0, self.lift_mm());
        (model.min, model.max) = (model.min - lift, model.max - lift);
        let grid = sampling.grid(&model, self.lift_mm())?;
        match self.supports {
            Some(_) => sampling.grid_around(grid, &self.printed),
            None => Ok(grid),
        }
    }
}

impl Unsupported {
    /// Poses the model, and hollows it.
    fn new(
        model: &Mesh,
        sampling: &Sampling,
        may_turn: bool,
        protected: Option<&[f32]>,
        timings: &mut Timings,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Error> {
        let clock = Instant::now();
        // Supports of the options replace those of the file.
        let bare =
            (sampling.supports.is_some() && !model.own_tips().is_empty()).then(|| model.bare());
        let mut mesh = bare.as_ref().unwrap_or(model).on_plate(&sampling.pose)?;
        mesh.widen_supports(sampling.wider_mm);
        if Prepared::takes_time(sampling) {
            sampling.check_fit(&mesh.bounds(), sampling.lift_mm(&mesh), may_turn)?;
        }
        timings.load += ms_since(clock);
        let clock = Instant::now();
        let mut warnings = mesh_warnings(&mesh);
        let tips = model.own_tips().len();
        warnings.extend((tips > 0).then_some(Warning::OwnSupports {
            tips,
            replaced: bare.is_some(),
        }));
        let mut hollowed = None;
        if let Some(hollowing) = &sampling.hollow {
            hollowed = hollow(&mut mesh, hollowing, protected, &mut warnings, progress)?;
        }
        timings.ldi += ms_since(clock);
        Ok(Self {
            mesh,
            hollowed,
            warnings,
        })
    }
}

/// Hollows a mesh, and returns its void, if there is one.
fn hollow(
    mesh: &mut Mesh,
    hollowing: &Hollowing,
    protected: Option<&[f32]>,
    warnings: &mut Vec<Warning>,
    progress: &mut Progress<'_>,
) -> Result<Option<Hollowed>, LdiError> {
    let Some(void) = prepare::hollow(mesh, hollowing, protected, progress)? else {
        warnings.push(if hollowing.drains_alone() {
            Warning::NothingToDrain
        } else {
            Warning::NothingHollowed {
                wall_mm: hollowing.wall_mm,
                cavity_mm: hollowing.cavity_mm,
            }
        });
        return Ok(None);
    };
    let drains = void.drains.iter().map(|drain| &drain.1);
    for shell in std::iter::once(&void.shell).chain(drains) {
        mesh.add(&shell.vertices, &shell.facets, FacetClass::Void);
    }
    warnings.extend(drain_warnings(&void));
    Ok(Some(Hollowed {
        void_ml: void.shell.volume_mm3() / 1e3,
        pillars: void.pillars.len(),
        ceilings_mm: void
            .pillars
            .iter()
            .map(|it| (it.top_mm.as_dvec3().to_array(), it.reach_mm().into()))
            .collect(),
        drains: void.drains.into_iter().map(|drain| drain.0).collect(),
        resolution_mm: void.resolution_mm,
    }))
}

impl Hollowed {
    /// The same, with the tops of its pillars at their places elsewhere.
    fn moved(&self, place: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        let ceilings_mm = self.ceilings_mm.iter();
        Self {
            ceilings_mm: ceilings_mm
                .map(|&(at, reach_mm)| (place(at), reach_mm))
                .collect(),
            ..self.clone()
        }
    }
}

impl Supported {
    pub(in crate::job) fn of(supports: &Supports, support_mm3: f64) -> Self {
        Self {
            support_ml: support_mm3 / 1e3,
            lift_mm: supports.lift_mm,
            points: supports.points.clone(),
            unreached: supports.unreached.clone(),
            on_model: supports.on_model,
            load: supports.load,
            joints_mm: supports.joints_mm.clone(),
        }
    }
}

/// The warnings about holes that drain nothing, and about what stays full or closed.
fn drain_warnings(void: &Void) -> Vec<Warning> {
    let astray = void.astray.iter();
    let mut warnings: Vec<Warning> = astray
        .map(|place| Warning::DrainAstray {
            drain_number: place + 1,
        })
        .collect();
    if void.undrained > 0 {
        warnings.push(Warning::Undrained {
            basins: void.undrained,
        });
    }
    warnings.extend(void.closed.map(|closed| Warning::ClosedCavities {
        cavities: closed.cavities,
        volume_mm3: rounded(closed.volume_mm3),
        at_mm: closed.at_mm.map(rounded),
    }));
    warnings
}

/// Rounds to three decimals, as people write numbers; without -0.
fn rounded(number: f64) -> f64 {
    (number * 1e3).round() / 1e3 + 0.0
}

/// The warnings about points that no support reaches, and about those that are not on the surface.
fn support_warnings(supports: &Supports) -> Vec<Warning> {
    let astray = supports.astray.iter();
    let mut warnings: Vec<Warning> = astray
        .map(|place| Warning::SupportAstray {
            point_number: place + 1,
        })
        .collect();
    if !supports.unreached.is_empty() {
        warnings.push(Warning::Unsupported {
            points: supports.unreached.len(),
        });
    }
    warnings
}
