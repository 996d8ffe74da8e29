//! Projects: models, options and places in one file. It is a 3MF, which other programs read as models in their poses.
//!
//! A part of our own holds the options as JSON, and beside it stand the files of the models as they were opened, so that a project gives
//! the same plans and print files, bit for bit. The meshes of the 3MF are for others; they have neither supports nor voids.

use std::fmt::Write as _;
use std::io::Write;

use glam::{DAffine3, DMat3, DVec3, Vec3};
use serde::{Deserialize, Serialize};

use crate::archive::{ArchiveError, threemf};
use crate::arrange::TURN_DEG;
use crate::job::{Error, JobOptions, OptionsError, Placement};
use crate::model::read::threemf::ThreeMfError;
use crate::model::read::{self, ReadError, ReadOptions};
use crate::model::{MeshError, Pose, rotation_matrix, weld};
use crate::xml::escaped;

/// Name of the part that makes a 3MF a project.
const PART: &str = "Metadata/cusp/project.json";

/// A job with the files of its models.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Project {
    /// Contents of the part.
    pub part: ProjectPart,
    /// The file of each model, as it was opened.
    pub files: Vec<Vec<u8>>,
    /// The weights of each model's facets, single-precision and little-endian; empty if it has none.
    pub weights: Vec<Vec<u8>>,
}

/// Options and names of a project.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(deny_unknown_fields)]
pub struct ProjectPart {
    /// Options, those of each model, and places.
    pub job: JobOptions,
    /// The models, in the order of their options.
    pub models: Vec<ProjectModel>,
    /// Text for the program that wrote the project, such as the state of its form.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub form: String,
}

/// A model of a project.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(deny_unknown_fields)]
pub struct ProjectModel {
    /// Name of its file.
    pub name: String,
    /// Choices with which it is read.
    #[serde(default)]
    pub reading: ReadOptions,
}

/// The file of a model, and its weights; these are empty if it has none.
pub type ModelBytes = (Vec<u8>, Vec<u8>);

impl Project {
    /// Reads a project; `None` if the bytes are no project.
    ///
    /// # Errors
    /// [`Error::Read`] if it is damaged, [`Error::Options`] if its part cannot be read.
    pub fn read(bytes: &[u8]) -> Result<Option<Self>, Error> {
        let Some(part) = Self::part_of(bytes)? else {
            return Ok(None);
        };
        let part: ProjectPart = serde_json::from_slice(&part).map_err(|error| {
            let system = format!("{PART}: {error}");
            OptionsError::Unreadable { system }
        })?;
        let (files, weights): (Vec<_>, Vec<_>) = Self::files_of(bytes)?.into_iter().unzip();
        if files.len() < part.models.len() {
            let part = file_name(files.len() + 1);
            return Err(ReadError::from(ThreeMfError::NoPart { part }).into());
        }
        Ok(Some(Self {
            part,
            files,
            weights,
        }))
    }

    /// The files of the models of a project, each with its weights.
    ///
    /// # Errors
    /// [`Error::Read`] if the project is damaged.
    pub fn files_of(bytes: &[u8]) -> Result<Vec<ModelBytes>, Error> {
        let mut files = Vec::new();
        while let Some(file) = read::threemf::part(bytes, &file_name(files.len() + 1))? {
            let weights = read::threemf::part(bytes, &weights_name(files.len() + 1))?;
            files.push((file, weights.unwrap_or_default()));
        }
        Ok(files)
    }

    /// The part of a project as JSON; `None` if the bytes are no project.
    ///
    /// # Errors
    /// [`Error::Read`] if it is damaged.
    pub fn part_of(bytes: &[u8]) -> Result<Option<Vec<u8>>, Error> {
        Ok(read::threemf::part(bytes, PART)?)
    }

    /// Writes the project. For programs that read it as models, copies stand at their places; if these are not given, there is one of each
    /// model.
    ///
    /// # Errors
    /// [`Error::Read`] and [`Error::Mesh`] if a file is no model, [`Error::Options`], [`Error::Archive`].
    pub fn to_bytes(&self) -> Result<Vec<u8>, Error> {
        let json = serde_json::to_vec(&self.part).map_err(ArchiveError::write)?;
        let model = self.model()?;
        let types = [
            ("json", "application/json"),
            ("bin", "application/octet-stream"),
        ];
        let mut bytes = Vec::new();
        let mut zip = threemf::begin(&mut bytes, &types, &mut writes(&model))?;
        threemf::add(&mut zip, PART, &mut writes(&json))?;
        for (number, file) in (1..).zip(&self.files) {
            threemf::add(&mut zip, &file_name(number), &mut writes(file))?;
        }
        for (number, weights) in (1..).zip(&self.weights) {
            if !weights.is_empty() {
                threemf::add(&mut zip, &weights_name(number), &mut writes(weights))?;
            }
        }
        zip.finish().map_err(ArchiveError::write)?;
        Ok(bytes)
    }

    /// The part with the meshes, each an object, and the copies as items.
    fn model(&self) -> Result<Vec<u8>, Error> {
        let alone = (0..self.files.len()).map(|model| Placement {
            model,
            ..Placement::MIDDLE
        });
        let alone: Vec<_> = alone.collect();
        let places = match &self.part.job.placements[..] {
            [] => &alone,
            places => places,
        };
        let resolved = self.part.job.options.resolve()?;
        let volume_mm = resolved.output.printer.as_ref().map(|it| it.volume_mm);
        let [width_mm, depth_mm, _] = volume_mm.unwrap_or([200.0; 3]);
        let mut text = Vec::from(threemf::HEAD);
        text.extend(b" <metadata name=\"Application\">Cusp</metadata>\n <resources>\n");
        let mut items = String::new();
        for (model, (file, ProjectModel { name, reading })) in
            self.files.iter().zip(&self.part.models).enumerate()
        {
            let contents = read::read_with(file, reading)?;
            let id = model + 1;
            let (vertices, mut facets) = weld(&contents.triangles);
            // 3MF has no facets that use a vertex twice.
            facets.retain(|[a, b, c]| a != b && b != c && c != a);
            write_object(id, name, &vertices, &facets, &mut text)?;
            let own = self.part.job.of_model(model);
            let mut pose = own.pose_over(resolved.sampling.pose);
            if contents.unit.is_some() {
                pose.unit = None;
            }
            for place in places.iter().filter(|it| it.model == model) {
                let turned = pose.turned(place.turn_deg / TURN_DEG);
                let middle_mm = DVec3::new(
                    place.x_mm + width_mm / 2.0 + place.plate as f64 * PLATES_APART * width_mm,
                    place.y_mm + depth_mm / 2.0,
                    0.0,
                );
                let on_plate = standing(&vertices, &turned, middle_mm)?;
                let numbers = on_plate.to_cols_array().map(|number| number.to_string());
                let _ = writeln!(
                    items,
                    r#"  <item objectid="{id}" transform="{}"/>"#,
                    numbers.join(" ")
                );
            }
        }
        text.extend(format!(" </resources>\n <build>\n{items} </build>\n</model>\n").bytes());
        Ok(text)
    }
}

fn write_object(
    id: usize,
    name: &str,
    vertices: &[Vec3],
    facets: &[[u32; 3]],
    text: &mut Vec<u8>,
) -> Result<(), ArchiveError> {
    let name = escaped(name).replace('"', "&quot;");
    writeln!(
        text,
        "  <object id=\"{id}\" type=\"model\" name=\"{name}\">\n   <mesh>\n    <vertices>"
    )?;
    threemf::write_vertices(vertices, text)?;
    text.extend(b"    </vertices>\n    <triangles>\n");
    threemf::write_facets(facets, text)?;
    text.extend(b"    </triangles>\n   </mesh>\n  </object>\n");
    Ok(())
}

/// Writes these bytes as a part.
fn writes(bytes: &[u8]) -> impl FnMut(&mut dyn Write) -> Result<(), ArchiveError> {
    |file| Ok(file.write_all(bytes)?)
}

/// Distance of plates in the 3MF, in widths of a plate.
const PLATES_APART: f64 = 1.2;

/// The transform that puts a model on the plate in a pose, with the middle of its box at `middle_mm`.
fn standing(vertices: &[Vec3], pose: &Pose, middle_mm: DVec3) -> Result<DAffine3, MeshError> {
    let rotation = match pose.rotation {
        Some(rotation) => rotation_matrix(rotation)?,
        None => DMat3::IDENTITY,
    };
    let (low, high) = vertices
        .iter()
        .map(|vertex| rotation * vertex.as_dvec3())
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), at| {
            (low.min(at), high.max(at))
        });
    if high.z <= low.z {
        return Err(MeshError::ZeroHeight);
    }
    let scale = match pose.height_mm {
        Some(height_mm) => height_mm / (high.z - low.z),
        None => pose.unit_mm(),
    };
    let foot = ((low + high) / 2.0).with_z(low.z);
    Ok(DAffine3::from_mat3_translation(
        rotation * scale,
        middle_mm - foot * scale,
    ))
}

fn file_name(number: usize) -> String {
    format!("Metadata/cusp/model-{number}.bin")
}

fn weights_name(number: usize) -> String {
    format!("Metadata/cusp/weights-{number}.bin")
}
