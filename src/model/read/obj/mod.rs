//! OBJ text to triangles.
//!
//! OBJ carries no unit; coordinates are taken as they are, with z up. Vertices and faces count. Normals, texture coordinates,
//! colours, materials, groups and objects do not: all faces together are the model.

mod error;
mod polygon;

use std::borrow::Cow;

use glam::Vec3;

use super::text::quoted;
use super::{Contents, Triangles};

pub use error::ObjError;

/// Keywords of free-form surfaces, old ones too. Curves and points have no area, and are ignored.
const SURFACES: [&[u8]; 4] = [b"surf", b"bsp", b"bzp", b"cdp"];

/// Reads the faces of an OBJ as triangles, in file order.
///
/// Corners are `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 1, or backwards from the last vertex so far if negative.
/// Polygons are cut into triangles. A line that ends with `\` goes on in the next.
///
/// # Errors
/// [`ObjError`], with the line where reading failed.
pub(super) fn read(bytes: &[u8]) -> Result<Contents, ObjError> {
    let vertices = vertices(bytes)?;
    let mut triangles = Triangles::new();
    let (mut so_far, mut corners) = (0, Vec::new());
    for (line, text) in lines(bytes) {
        let mut words = words(&text);
        match words.next() {
            Some(b"v") => so_far += 1,
            Some(b"f") => {
                corners.clear();
                for word in words {
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

/// Whether the first line that is neither empty nor a comment begins with a word of OBJ, and goes on after it.
pub(super) fn is_obj(head: &[u8]) -> bool {
    const WORDS: [&[u8]; 9] = [
        b"v", b"vn", b"vt", b"f", b"o", b"g", b"s", b"mtllib", b"usemtl",
    ];
    let mut lines = lines(head).map(|(_, text)| text);
    let first = lines.find(|line| {
        let line = line.trim_ascii();
        !line.is_empty() && !line.starts_with(b"#")
    });
    let first = first.unwrap_or_default();
    let mut words = words(&first);
    words.next().is_some_and(|word| WORDS.contains(&word)) && words.next().is_some()
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

fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    let words = line.split(u8::is_ascii_whitespace);
    words.filter(|word| !word.is_empty())
}

/// The lines of a text with their numbers, from 1. Lines end with LF, CR or both; those that go on in the next are joined.
fn lines(bytes: &[u8]) -> impl Iterator<Item = (u64, Cow<'_, [u8]>)> {
    let mut rest = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut number = 0;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        number += 1;
        let first = number;
        let mut line = Cow::Borrowed(next_line(&mut rest));
        while line.ends_with(b"\\") {
            let joined = line.to_mut();
            joined.pop();
            joined.push(b' ');
            joined.extend(next_line(&mut rest));
            number += 1;
        }
        Some((first, line))
    })
}

fn next_line<'a>(rest: &mut &'a [u8]) -> &'a [u8] {
    let end = rest.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
    let (line, after) = rest.split_at(end.unwrap_or(rest.len()));
    let length = after.len().min(1 + usize::from(after.starts_with(b"\r\n")));
    *rest = &after[length..];
    line
}
