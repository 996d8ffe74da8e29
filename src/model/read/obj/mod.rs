//! OBJ text to triangles.
//!
//! OBJ carries no unit; coordinates are taken as they are, with z up. Vertices and faces count. Normals, texture coordinates,
//! colours, materials, groups and objects do not: all faces together are the model.

mod error;
mod polygon;

use glam::Vec3;

use super::text::{lines, quoted, words};
use super::{Contents, Triangles};

pub use error::ObjError;

/// Keywords of free-form surfaces, old ones too. Curves and points have no area, and are ignored.
const SURFACES: [&[u8]; 4] = [b"surf", b"bsp", b"bzp", b"cdp"];

/// Bytes of a file for each of its facets at least, and facets that any file may have. A facet of a mesh takes 20 bytes or more, half a
/// vertex included, but a face may name the same corners time and again in two bytes each.
const LEAST_BYTES: usize = 12;
const FREE_FACETS: usize = 1 << 16;

/// Reads the faces of an OBJ as triangles, in file order.
///
/// Corners are `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 1, or backwards from the last vertex so far if negative.
/// Polygons are cut into triangles. A line that ends with `\` goes on in the next, and a word that begins with `#` begins a comment.
///
/// # Errors
/// [`ObjError`], with the line where reading failed.
pub(super) fn read(bytes: &[u8]) -> Result<Contents, ObjError> {
    let vertices = vertices(bytes)?;
    let most_facets = FREE_FACETS + bytes.len() / LEAST_BYTES;
    let mut triangles = Triangles::new();
    let (mut so_far, mut corners) = (0, Vec::new());
    for (line, text) in lines(bytes) {
        let mut words = words(&text).take_while(|word| !word.starts_with(b"#"));
        match words.next() {
            Some(b"v") => so_far += 1,
            Some(b"f") => {
                corners.clear();
                for word in words {
                    if triangles.len() + corners.len() > most_facets + 1 {
                        return Err(ObjError::TooMany { line, most_facets });
                    }
                    let corner = corner(word, so_far, vertices.len());
                    corners.push(
                        vertices[corner.ok_or_else(|| ObjError::BadCorner {
                            line,
                            found: quoted(word),
                            vertices: vertices.len() as u64,
                        })?],
                    );
                }
                if corners.len() < 3 {
                    let corners = corners.len() as u64;
                    return Err(ObjError::FewCorners { line, corners });
                }
                polygon::cut(&corners, |places| {
                    triangles.push(places.map(|place| corners[place]));
                });
            }
            Some(keyword) if SURFACES.contains(&keyword) => {
                let keyword = quoted(keyword);
                return Err(ObjError::FreeForm { line, keyword });
            }
            _ => (),
        }
    }
    if triangles.is_empty() {
        return Err(ObjError::NoFaces);
    }
    Ok(Contents::without_unit(triangles))
}

fn vertices(bytes: &[u8]) -> Result<Vec<Vec3>, ObjError> {
    let mut vertices = Vec::new();
    for (line, text) in lines(bytes) {
        let mut words = words(&text);
        if words.next() != Some(b"v") {
            continue;
        }
        let mut vertex = Vec3::ZERO;
        // A weight or a colour may follow.
        for axis in 0..3 {
            let word = words.next().unwrap_or_default();
            vertex[axis] = number(word).ok_or_else(|| ObjError::BadVertex {
                line,
                found: quoted(word),
            })?;
        }
        vertices.push(vertex);
    }
    Ok(vertices)
}

fn number(word: &[u8]) -> Option<f32> {
    let value: f32 = str::from_utf8(word).ok()?.parse().ok()?;
    value.is_finite().then_some(value)
}

/// The place of the vertex of a corner, which may be further down in the file.
fn corner(word: &[u8], so_far: usize, vertices: usize) -> Option<usize> {
    let number = word.split(|&byte| byte == b'/').next()?;
    let number: i64 = str::from_utf8(number).ok()?.parse().ok()?;
    let place = if number < 0 {
        (so_far as i64).checked_add(number)?
    } else {
        number - 1
    };
    let place = usize::try_from(place).ok()?;
    (place < vertices).then_some(place)
}
