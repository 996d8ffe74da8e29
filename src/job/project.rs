//! Projects: models, options and places in one file. It is a 3MF, which other programs read as models in their poses.
//!
//! A part of our own holds the options as JSON, and beside it stand the files of the models as they were opened, so that a project gives
//! the same plans and print files, bit for bit. The meshes of the 3MF are for others; they have neither supports nor voids.

use std::fmt::Write as _;

use glam::{DAffine3, DMat3, DVec3, Vec3};
use rustc_hash::FxHashMap;
use serde::{Deserialize, Serialize};

use super::{Error, JobOptions, OptionsError, Placement};
use crate::archive::{File, write_zip};
use crate::arrange::TURN_DEG;
use crate::model::read::threemf::ThreeMfError;
use crate::model::read::{self, ReadError, ReadOptions, Triangles};
use crate::model::{MeshError, Pose, rotation_matrix};

/// Name of the part that makes a 3MF a project.
const PART: &str = "Metadata/cusp/project.json";
const MODEL: &str = "3D/3dmodel.model";

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
    /// Reads a project; `None` if the bytes are none.
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
        let json = serde_json::to_vec(&self.part).map_err(crate::archive::ArchiveError::write)?;
        let mut files: Vec<File> = vec![
            ("[Content_Types].xml".to_owned(), CONTENT_TYPES.into()),
            ("_rels/.rels".to_owned(), RELATIONSHIPS.into()),
            (MODEL.to_owned(), self.model()?.into_bytes()),
            (PART.to_owned(), json),
        ];
        for (number, file) in (1..).zip(&self.files) {
            files.push((file_name(number), file.clone()));
        }
        for (number, weights) in (1..).zip(&self.weights) {
            if !weights.is_empty() {
                files.push((weights_name(number), weights.clone()));
            }
        }
        Ok(write_zip(&files)?)
    }

    /// The part with the meshes, each an object, and the copies as items.
    fn model(&self) -> Result<String, Error> {
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
        let mut text = String::from(HEAD);
        let mut items = String::new();
        for (model, (file, ProjectModel { name, reading })) in
            self.files.iter().zip(&self.part.models).enumerate()
        {
            let contents = read::read_with(file, reading)?;
            let id = model + 1;
            let _ = writeln!(
                text,
                r#"  <object id="{id}" type="model" name="{}"><mesh>"#,
                escaped(name)
            );
            write_mesh(&mut text, &contents.triangles);
            text.push_str("  </mesh></object>\n");
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
                let on_plate = standing(&contents.triangles, &turned, middle_mm)?;
                let numbers = on_plate.to_cols_array().map(|number| number.to_string());
                let _ = writeln!(
                    items,
                    r#"  <item objectid="{id}" transform="{}"/>"#,
                    numbers.join(" ")
                );
            }
        }
        let _ = write!(
            text,
            " </resources>\n <build>\n{items} </build>\n</model>\n"
        );
        Ok(text)
    }
}

/// Distance of plates in the 3MF, in widths of a plate.
const PLATES_APART: f64 = 1.2;

/// The transform that puts a model on the plate in a pose, with the middle of its box at `middle_mm`.
fn standing(triangles: &Triangles, pose: &Pose, middle_mm: DVec3) -> Result<DAffine3, MeshError> {
    let rotation = match pose.rotation {
        Some(rotation) => rotation_matrix(rotation)?,
        None => DMat3::IDENTITY,
    };
    let corners = triangles.as_flattened().iter();
    let (low, high) = corners
        .map(|corner| rotation * corner.as_dvec3())
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

/// Writes vertices and triangles, in the order of the file.
fn write_mesh(text: &mut String, triangles: &Triangles) {
    let mut vertices: FxHashMap<[u32; 3], usize> = FxHashMap::default();
    let mut facets = String::new();
    text.push_str("   <vertices>\n");
    for corners in triangles {
        let [a, b, c] = corners.map(|corner: Vec3| {
            let next = vertices.len();
            *vertices
                .entry(corner.to_array().map(f32::to_bits))
                .or_insert_with(|| {
                    let _ = writeln!(
                        text,
                        r#"<vertex x="{}" y="{}" z="{}"/>"#,
                        corner.x, corner.y, corner.z
                    );
                    next
                })
        });
        // 3MF has no triangles without area by their vertices.
        if a != b && b != c && c != a {
            let _ = writeln!(facets, r#"<triangle v1="{a}" v2="{b}" v3="{c}"/>"#);
        }
    }
    text.push_str("   </vertices>\n   <triangles>\n");
    text.push_str(&facets);
    text.push_str("   </triangles>\n");
}

/// Text as the value of an attribute; characters that XML does not have are left out.
fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '"' => escaped.push_str("&quot;"),
            '\u{fffe}' | '\u{ffff}' => (),
            character if character.is_control() => (),
            character => escaped.push(character),
        }
    }
    escaped
}

fn file_name(number: usize) -> String {
    format!("Metadata/cusp/model-{number}.bin")
}

fn weights_name(number: usize) -> String {
    format!("Metadata/cusp/weights-{number}.bin")
}

const CONTENT_TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
 <Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
 <Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
 <Default Extension="json" ContentType="application/json"/>
 <Default Extension="bin" ContentType="application/octet-stream"/>
</Types>
"#;

const RELATIONSHIPS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
 <Relationship Target="/3D/3dmodel.model" Id="model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
"#;

const HEAD: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xml:lang="en" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
 <metadata name="Application">Cusp</metadata>
 <resources>
"#;
