//! A model as it was read, with results that hold in every pose.

use glam::Vec3;
use web_time::Instant;

use super::report::odd_size;
use super::stages::facet_shapes::{Extra, shapes_of};
use super::stages::measured::weights_with_greys;
use super::stages::parts::{Layering, Resolved};
use super::stages::planning::Planning;
use super::stages::stage::{Stage, StageProgress, ms_since};
#[cfg(not(target_arch = "wasm32"))]
use super::stages::work;
use super::{Error, MeshInfo, Options, Preview};
use crate::grid::Bins;
use crate::ldi::LdiError;
use crate::model::read::{PartKind, ReadOptions};
use crate::model::{FacetClass, FileFacts, Mesh, ModelFile, Pose, read, saliency, weights};
use crate::orientation::Surface;
use crate::parallel;
use crate::profile::facet_bins::FacetBins;
use crate::profile::{Profile, Source};
use crate::warning::Warning;

/// A model as it was read, with the weights of its facets.
#[derive(Debug)]
pub struct LoadedModel {
    pub(super) mesh: Mesh,
    pub(super) facts: FileFacts,
    /// Saliency of each facet of the surface, once computed.
    saliency: Option<Vec<f32>>,
    /// The user's weight of each facet of the surface, if set.
    pub(super) painted: Option<Vec<f32>>,
    /// Milliseconds that reading took, until a plan has reported them.
    pub(super) load_ms: f64,
    /// The surface for orientation searches, and the pose to whose height it is scaled, if it has one.
    pub(super) surface: Option<(Option<Pose>, Surface)>,
    /// Seconds of processor time that a stage may take, if that is bounded.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) cpu_time_s: Option<f64>,
}

impl LoadedModel {
    /// Reads a model; of a project with several plates, the first.
    ///
    /// # Errors
    /// [`Error::Read`], [`Error::Mesh`].
    pub fn read(bytes: &[u8]) -> Result<Self, Error> {
        Self::read_with(bytes, &ReadOptions::default())
    }

    /// Reads a model with choices.
    ///
    /// # Errors
    /// [`Error::Read`], [`Error::Mesh`].
    pub fn read_with(bytes: &[u8], options: &ReadOptions) -> Result<Self, Error> {
        let clock = Instant::now();
        let (file, contents) =
            parallel::beside(|| ModelFile::of(bytes), || read::read_with(bytes, options));
        let contents = contents?;
        let facts = FileFacts::new(&file, options, &contents);
        let mut model = Self::of_triangles(&contents.triangles, facts)?;
        model.mesh = model.mesh.without(&contents.negative)?;
        model.load_ms = ms_since(clock);
        Ok(model)
    }

    /// A model that was read elsewhere.
    ///
    /// # Errors
    /// [`Error::Mesh`].
    pub fn of_triangles(triangles: &[[Vec3; 3]], facts: FileFacts) -> Result<Self, Error> {
        let clock = Instant::now();
        let all_curved = facts.file.curved_caps;
        let mut mesh = Mesh::with_caps(triangles, all_curved)?;
        if !facts.file.supports_as_model {
            mesh = mesh.with_own_supports(triangles, all_curved)?;
        }
        Ok(Self {
            mesh,
            facts,
            saliency: None,
            painted: None,
            load_ms: ms_since(clock),
            surface: None,
            #[cfg(not(target_arch = "wasm32"))]
            cpu_time_s: None,
        })
    }

    /// Describes the model in the frame of its file.
    pub fn info(&self) -> MeshInfo {
        let mut info = MeshInfo::of(&self.mesh);
        info.unit = self.facts.unit;
        info.warnings.extend(self.file_warnings(Pose::default()));
        info
    }

    /// Warnings about the file, given the pose that options ask for.
    pub(super) fn file_warnings(&self, asked: Pose) -> Vec<Warning> {
        let objects = self.facts.skipped_objects;
        let skipped = (objects > 0).then_some(Warning::SkippedObjects { objects });
        let is_open = self.facts.unit.or(asked.unit).is_none() && asked.height_mm.is_none();
        let odd = is_open.then(|| odd_size(&self.mesh)).flatten();
        let stated = self
            .facts
            .unit
            .zip(asked.unit)
            .filter(|(stated, given)| stated != given);
        let ignored = stated.map(|(stated, given)| Warning::UnitStated { stated, given });
        let parts = self.facts.parts.iter().map(|part| match part.kind {
            PartKind::Negative => Warning::SubtractedPart {
                name: part.name.clone(),
            },
            kind => Warning::SkippedPart {
                name: part.name.clone(),
                kind,
            },
        });
        let plate = self.facts.file.plate.map(|plate| Warning::OtherPlates {
            plate_number: plate.plate_number,
            plates: plate.plates,
        });
        let skipped = skipped.into_iter().chain(plate).chain(parts);
        skipped.chain(odd).chain(ignored).collect()
    }

    /// Resolves options for this model. A unit that the file states beats theirs.
    pub(super) fn resolved(&self, options: &Options) -> Result<Resolved, Error> {
        let mut resolved = options.resolve()?;
        if self.facts.unit.is_some() {
            resolved.sampling.pose.unit = None;
        }
        Ok(resolved)
    }

    /// The identity of the model's file.
    pub fn model_file(&self) -> &ModelFile {
        &self.facts.file
    }

    /// Vertex positions of the surface facets, nine numbers per facet, in millimetres, in the file's frame.
    pub fn positions(&self) -> Vec<f32> {
        surface_positions(&self.mesh)
    }

    /// Vertex positions of the surface facets, nine numbers per facet, in millimetres, with the model on the plate in this
    /// pose: its lowest point at z = 0, and centred on x = y = 0.
    ///
    /// # Errors
    /// [`Error::Mesh`].
    pub fn positions_on_plate(&self, pose: &Pose) -> Result<Vec<f32>, Error> {
        let unit = pose.unit.filter(|_| self.facts.unit.is_none());
        Ok(surface_positions(
            &self.mesh.on_plate(&Pose { unit, ..*pose })?,
        ))
    }

    /// Sets a weight from 0 to 1 for each facet of the surface, or removes all weights. Later plans use them.
    ///
    /// # Errors
    /// [`Error::Weights`].
    pub fn set_weights(&mut self, weights: Option<Vec<f32>>) -> Result<(), Error> {
        if let Some(weights) = &weights {
            weights::check(weights, self.mesh.surface_facets)?;
        }
        self.painted = weights;
        Ok(())
    }

    /// The weights that are set, if any.
    pub fn painted(&self) -> Option<&[f32]> {
        self.painted.as_deref()
    }

    /// The saliency of each facet of the surface, 0 to 1: how much it stands out. It is the same in every pose.
    ///
    /// # Errors
    /// [`Error::Ldi`] if `progress` cancels; [`Error::TimeBound`].
    pub fn saliency(&mut self, progress: &mut StageProgress<'_>) -> Result<&[f32], Error> {
        let saliency = if let Some(saliency) = self.saliency.take() {
            saliency
        } else {
            #[cfg(not(target_arch = "wasm32"))]
            if let Some(allowed_s) = self.cpu_time_s {
                work::check_saliency(&self.mesh, allowed_s)?;
            }
            let mut within = |fraction| progress(Stage::Saliency, fraction);
            saliency::saliency(&self.mesh, &mut within).map_err(LdiError::from)?
        };
        Ok(self.saliency.insert(saliency))
    }

    /// The weight of each facet of the surface: the product of the user's weight and of saliency (section 4.2), or the
    /// one that is set, but at least the minimum weight. `None` if neither is set.
    ///
    /// # Errors
    /// [`Error::Options`], [`Error::Plan`], and those of [`Self::saliency`].
    pub fn weights(
        &mut self,
        options: &Options,
        progress: &mut StageProgress<'_>,
    ) -> Result<Option<Vec<f32>>, Error> {
        self.layering_weights(&options.resolve()?.layering, progress)
    }

    /// CRC-32 of the user's weights, if any.
    pub(super) fn weights_crc32(&self) -> Option<u32> {
        self.painted.as_deref().map(weights::crc_of)
    }

    pub(super) fn layering_weights(
        &mut self,
        layering: &Layering,
        progress: &mut StageProgress<'_>,
    ) -> Result<Option<Vec<f32>>, Error> {
        if layering.saliency {
            self.saliency(progress)?;
        }
        Ok(self.known_weights(layering))
    }

    /// The weights from results so far. Saliency that is not computed yet is left out.
    fn known_weights(&self, layering: &Layering) -> Option<Vec<f32>> {
        let saliency = self.saliency.as_ref().filter(|_| layering.saliency);
        if saliency.is_none() && self.painted.is_none() {
            return None;
        }
        let least = layering.weight_min as f32;
        let of = |weights: Option<&Vec<f32>>, facet: usize| weights.map_or(1.0, |it| it[facet]);
        let weight = |facet| {
            let product = of(saliency, facet) * of(self.painted.as_ref(), facet);
            if product < least { least } else { product }
        };
        Some((0..self.mesh.surface_facets).map(weight).collect())
    }

    /// Plans the model in its pose from the facets alone, and returns the plan with the exact profile. Without rays, facets
    /// inside the solid count as well, and layers may have any thickness within the limits. The last plan is kept.
    ///
    /// # Errors
    /// [`Error::Mesh`], [`Error::Grid`], [`Error::Plan`], [`Error::Options`].
    pub fn preview(&self, options: &Options) -> Result<(Preview, Profile), Error> {
        let Resolved {
            sampling, layering, ..
        } = &self.resolved(options)?;
        let mut mesh = self.mesh.on_plate(&sampling.pose)?;
        let lift_mm = sampling.lift_mm(&mesh);
        mesh.lift(lift_mm);
        let size = mesh.bounds().size();
        let height_mm = sampling.height_mm(size.z, lift_mm);
        let bins = Bins::of_height(height_mm, layering.bin_mm)?;
        let facet_bins = FacetBins::of(&mesh, bins);
        let extra = || Ok::<_, Error>(Extra::of(&mesh, layering.metric, bins));
        let weights = weights_with_greys(&mesh, layering, self.known_weights(layering));
        let shapes = shapes_of(&facet_bins, extra, layering, weights)?;
        let planning = Planning::alone(height_mm, &shapes, layering);
        let plan = planning.plan_freely()?;
        let preview = Preview {
            layers: plan.layers(),
            size_mm: size.to_array(),
            lift_mm,
            z_mm: plan.z_mm(),
            thickness_mm: plan.thickness_mm(),
            metric: layering.metric,
            max_error: planning.max_error(&plan),
            print_time_s: plan.print_time_s(&layering.resin),
            bin_mm: bins.size_mm,
            layer_range_mm: layering.layer_range_mm(bins),
        };
        Ok((preview, shapes.profile(layering.metric, Source::Exact)))
    }
}

/// Vertex positions of the surface facets.
fn surface_positions(mesh: &Mesh) -> Vec<f32> {
    positions(&mesh.vertices, &mesh.facets[..mesh.surface_facets])
}

/// Vertex positions of a mesh's facets of a class.
pub(super) fn positions_of(mesh: &Mesh, class: FacetClass) -> Vec<f32> {
    positions(&mesh.vertices, mesh.of_class(class))
}

/// Vertex positions of facets, nine numbers per facet.
pub(super) fn positions(vertices: &[Vec3], facets: &[[u32; 3]]) -> Vec<f32> {
    let facets = facets.iter();
    let corners = facets.flatten().map(|&vertex| vertices[vertex as usize]);
    corners.flat_map(|corner| corner.to_array()).collect()
}
