//! 3MF to triangles: a zip of XML parts, with objects, their components, and the items to build of them.
//!
//! Facets count, and where they are: units, transforms, components in other parts (the production extension). Colours,
//! materials and textures do not, nor do slicers' settings, except for parts that are not solids. A part is inflated and read as a stream; only the objects of the file are
//! held in memory, and then their triangles.

mod build;
mod error;
mod model;
mod namespaces;
mod package;
mod settings;
mod values;
mod xml;

use super::kind::FileKind;
use super::{Contents, PlateChoice, ReadError, ReadOptions, head_of};
use build::Build;
use package::Package;
use settings::Settings;
use xml::{Tag, Tags, unescaped};

pub use error::{ThreeMfError, ThreeMfFeature, XmlFault};

/// The type of the relationship that leads to the model.
const MODEL: &[u8] = b"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";
/// The usual name of the model part.
const USUAL_MODEL: &str = "3D/3dmodel.model";

/// Reads the build of a 3MF: the facets of all its items, or of those on one plate, once for each placement, in file
/// order.
///
/// # Errors
/// [`ThreeMfError`], with the part and the line where reading failed; [`ReadError::OtherKind`] for other zips.
pub(super) fn read(bytes: &[u8], options: &ReadOptions) -> Result<Contents, ReadError> {
    let package = Package::new(bytes).map_err(|error| match FileKind::of_zip(head_of(bytes)) {
        None => ReadError::from(error),
        Some(kind) => ReadError::OtherKind { kind },
    })?;
    let start = match start(&package)? {
        Some(start) => start,
        None if package.has_ending(".amf") => {
            let kind = FileKind::Amf;
            return Err(ReadError::OtherKind { kind });
        }
        None if package.has_ending(".model") => USUAL_MODEL.to_owned(),
        None => {
            let kind = FileKind::Zip;
            return Err(ReadError::OtherKind { kind });
        }
    };
    let settings = Settings::of(&package)?;
    let plates = settings.plates.len() as u32;
    let plate = (plates > 1).then(|| PlateChoice {
        plate_number: options.plate_number.unwrap_or(1).clamp(1, plates),
        plates,
    });
    let (build, root) = Build::of(&package, &start, &settings, plate, options.surfaces)?;
    if build.triangles.is_empty() {
        let skipped = build.skipped;
        return Err(ThreeMfError::NoFacets { skipped }.into());
    }
    Ok(Contents {
        unit: Some(root.unit),
        skipped_objects: build.skipped,
        triangles: build.triangles,
        negative: build.negative,
        parts: build.parts,
        plate,
    })
}

/// Reads a part of a zip by its name; `None` if there is no such part, or if the bytes are no zip.
///
/// # Errors
/// [`ThreeMfError`] if the part is damaged or too large.
pub fn part(bytes: &[u8], name: &str) -> Result<Option<Vec<u8>>, ReadError> {
    let Ok(package) = Package::new(bytes) else {
        return Ok(None);
    };
    let Some(name) = package.find(name) else {
        return Ok(None);
    };
    let mut part = package.open(name)?;
    let (mut whole, mut chunk) = (Vec::new(), vec![0; 1 << 16]);
    loop {
        match part.read(&mut chunk)? {
            0 => return Ok(Some(whole)),
            count => whole.extend_from_slice(&chunk[..count]),
        }
    }
}

/// The part that the package's relationships name as the model.
fn start(package: &Package<'_>) -> Result<Option<String>, ThreeMfError> {
    let usual = || package.find(USUAL_MODEL).map(str::to_owned);
    let Some(part) = package.find("_rels/.rels") else {
        return Ok(usual());
    };
    let mut tags = Tags::of(package.open(part)?)?;
    let mut found = None;
    while let Some(tag) = tags.next()? {
        let Tag::Start { attributes, .. } = tag else {
            continue;
        };
        let (mut is_model, mut target) = (false, None);
        for attribute in attributes {
            match attribute {
                Ok((b"Type", MODEL)) => is_model = true,
                Ok((b"Target", value)) => target = Some(unescaped(value).into_owned()),
                Ok(_) => (),
                Err(fault) => return Err(tags.fault(fault)),
            }
        }
        if let Some(target) = target.filter(|_| is_model && found.is_none()) {
            found = Some(String::from_utf8_lossy(&target).into_owned());
        }
    }
    Ok(found.or_else(usual))
}
