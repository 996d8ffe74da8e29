//! STL bytes to triangles, binary and ASCII.
//!
//! STL carries no unit; coordinates are taken as millimetres with z up. The normals stored in the
//! file are ignored, since many exporters write zeros or NaN there: orientation comes from the order of
//! the corners.

mod error;

use glam::Vec3;

use super::text::quoted;

pub use error::{StlError, StlExpected};

/// Bytes before the first facet of a binary STL: an 80 byte header and the facet count.
const BINARY_HEADER_BYTES: usize = 84;
/// Bytes of one facet of a binary STL: normal, three corners, attribute word.
const BINARY_FACET_BYTES: usize = 50;

/// Reads the triangles of a binary or ASCII STL, corners in file order.
///
/// A file whose length matches the facet count at byte 80 is binary, whatever its header says, since many binary files begin
/// with `solid`. ASCII may hold several solids. Keywords are matched without regard to case, and lines end with LF, CR or
/// both. A whole file may be on one line: the name of a solid ends with its line or before `facet normal`. Common
/// mistakes of writers are accepted: closing words in two (`end loop`), words behind a facet or a solid, no `endsolid`.
///
/// # Errors
/// [`StlError`], with the byte offset or the line where reading failed.
pub(super) fn read(bytes: &[u8]) -> Result<Vec<[Vec3; 3]>, StlError> {
    let triangles = if is_binary(bytes, bytes.len() as u64) {
        read_binary(bytes)?
    } else {
        read_ascii(bytes)?
    };
    if triangles.is_empty() {
        return Err(StlError::NoFacets);
    }
    Ok(triangles)
}

/// Returns true if a file with these first bytes and this length is an STL.
pub(super) fn is_stl(head: &[u8], length: u64) -> bool {
    is_binary(head, length) || looks_like_text(head)
}

fn is_binary(head: &[u8], length: u64) -> bool {
    declared_facets(head).is_some_and(|count| {
        let expected = binary_length(count);
        (expected..expected + BINARY_FACET_BYTES as u64).contains(&length)
    })
}

/// The error of a binary STL whose length does not match its facet count. `None` for text, and for files too short to have a
/// facet count.
pub(super) fn wrong_length(head: &[u8], length: u64) -> Option<StlError> {
    let declared = declared_facets(head)?;
    let is_utf16 = head.starts_with(b"\xff\xfe") || head.starts_with(b"\xfe\xff");
    let is_text = head
        .iter()
        .take(1024)
        .all(|byte| byte.is_ascii_graphic() || byte.is_ascii_whitespace() || !byte.is_ascii());
    if is_text || is_utf16 {
        return None;
    }
    let found = (length - BINARY_HEADER_BYTES as u64) / BINARY_FACET_BYTES as u64;
    Some(if declared > found {
        StlError::Truncated {
            declared_facets: declared,
            expected_bytes: binary_length(declared),
            found_bytes: length,
        }
    } else {
        StlError::WrongFacetCount {
            declared_facets: declared,
            found_facets: found,
        }
    })
}

fn declared_facets(head: &[u8]) -> Option<u64> {
    let count = head.get(80..BINARY_HEADER_BYTES)?;
    Some(u64::from(u32::from_le_bytes([
        count[0], count[1], count[2], count[3],
    ])))
}

fn binary_length(facets: u64) -> u64 {
    BINARY_HEADER_BYTES as u64 + facets * BINARY_FACET_BYTES as u64
}

/// Returns true if the file begins as an ASCII STL does: `solid`, then no zero byte in the first lines.
fn looks_like_text(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(1024)];
    let word = head.trim_ascii_start();
    let word = word.strip_prefix(b"\xef\xbb\xbf").unwrap_or(word);
    word.len() >= 5 && word[..5].eq_ignore_ascii_case(b"solid") && !head.contains(&0)
}

fn read_binary(bytes: &[u8]) -> Result<Vec<[Vec3; 3]>, StlError> {
    let body = &bytes[BINARY_HEADER_BYTES..];
    let records = body.chunks_exact(BINARY_FACET_BYTES);
    let mut triangles = Vec::with_capacity(records.len());
    for (facet, record) in records.enumerate() {
        let mut corners = [Vec3::ZERO; 3];
        for (corner, chunk) in corners.iter_mut().zip(record[12..48].chunks_exact(12)) {
            *corner = bytemuck::pod_read_unaligned(chunk);
        }
        if let Some(bad) = corners
            .iter()
            .flat_map(Vec3::to_array)
            .position(|coordinate| !coordinate.is_finite())
        {
            let start = BINARY_HEADER_BYTES + facet * BINARY_FACET_BYTES + 12;
            return Err(StlError::NotFiniteBinary {
                byte: (start + 4 * bad) as u64,
                facet: facet as u64,
            });
        }
        triangles.push(corners);
    }
    Ok(triangles)
}

/// The words of an ASCII STL, and the line of each.
struct Words<'a> {
    rest: &'a [u8],
    line: u64,
    /// True if the last `solid` shared its line with what follows its name.
    is_run_on: bool,
}

impl<'a> Words<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self {
            rest: bytes,
            line: 1,
            is_run_on: false,
        }
    }

    fn next(&mut self) -> Option<&'a [u8]> {
        while let Some(byte) = self.rest.first().filter(|byte| byte.is_ascii_whitespace()) {
            let is_line_end = *byte == b'\n' || *byte == b'\r';
            let length = 1 + usize::from(self.rest.starts_with(b"\r\n"));
            self.rest = &self.rest[length..];
            // The end of the last line does not begin another.
            self.line += u64::from(is_line_end && !self.rest.is_empty());
        }
        let (word, rest) = split_word(self.rest);
        self.rest = rest;
        (!word.is_empty()).then_some(word)
    }

    /// Skips the name after `solid`, which is free text. It ends with its line, or before `facet normal` or `endsolid` in a
    /// file that is on one line.
    fn skip_name(&mut self) {
        self.is_run_on = self.skip_rest();
    }

    /// Skips words to the end of their line, or to what may follow a name or a facet; returns true if that came first.
    fn skip_rest(&mut self) -> bool {
        self.skip_free_text(|word, after| {
            let next = split_word(after).0;
            is(word, "endsolid")
                || is(word, "end") && is(next, "solid")
                || is(word, "facet") && is(next, "normal")
        })
    }

    /// Skips the name after `endsolid`. It ends with its line, or before `solid` in a file whose names do not end with their
    /// lines. In other files `solid` may be part of the name.
    fn skip_closing_name(&mut self) {
        if self.is_run_on {
            self.skip_free_text(|word, _| is(word, "solid"));
        } else {
            self.skip_free_text(|_, _| false);
        }
    }

    /// Skips words until `is_end` holds for one and the rest of its line, and returns true if it did before the line ended.
    fn skip_free_text(&mut self, is_end: impl Fn(&[u8], &[u8]) -> bool) -> bool {
        loop {
            self.rest = trim_blanks(self.rest);
            let (word, after) = split_word(self.rest);
            if word.is_empty() {
                return false;
            }
            if is_end(word, trim_blanks(after)) {
                return true;
            }
            self.rest = after;
        }
    }

    fn expect(&mut self, words: &[&str], expected: StlExpected) -> Result<(), StlError> {
        words.iter().try_for_each(|wanted| match self.next() {
            Some(word) if is(word, wanted) => Ok(()),
            Some(word) => Err(self.syntax(expected, word)),
            None => Err(self.end(expected)),
        })
    }

    /// Expects a closing word in one or, as some writers have it, in two: `end loop`.
    fn expect_end(
        &mut self,
        whole: &str,
        last: &str,
        expected: StlExpected,
    ) -> Result<(), StlError> {
        match self.next() {
            Some(word) if is(word, whole) => Ok(()),
            Some(word) if is(word, "end") && self.is_next(last) => self.expect(&[last], expected),
            Some(word) => Err(self.syntax(expected, word)),
            None => Err(self.end(expected)),
        }
    }

    /// Returns true if this is the next word of the line.
    fn is_next(&self, word: &str) -> bool {
        is(split_word(trim_blanks(self.rest)).0, word)
    }

    fn number(&mut self, expected: StlExpected) -> Result<f32, StlError> {
        let word = self.next().ok_or_else(|| self.end(expected))?;
        let text = String::from_utf8_lossy(word);
        let value: f32 = text.parse().map_err(|_| self.syntax(expected, word))?;
        if value.is_finite() {
            Ok(value)
        } else {
            Err(StlError::NotFiniteText {
                line: self.line,
                text: quoted(word),
            })
        }
    }

    fn syntax(&self, expected: StlExpected, found: &[u8]) -> StlError {
        StlError::Syntax {
            line: self.line,
            expected,
            found: quoted(found),
        }
    }

    fn end(&self, expected: StlExpected) -> StlError {
        StlError::EndOfText {
            line: self.line,
            expected,
        }
    }
}

/// Splits at the first white space. The word may be empty.
fn split_word(bytes: &[u8]) -> (&[u8], &[u8]) {
    let end = bytes.iter().position(u8::is_ascii_whitespace);
    bytes.split_at(end.unwrap_or(bytes.len()))
}

/// Removes white space from the start, except for line ends.
fn trim_blanks(bytes: &[u8]) -> &[u8] {
    let is_blank = |byte: &u8| byte.is_ascii_whitespace() && !matches!(byte, b'\n' | b'\r');
    let start = bytes.iter().position(|byte| !is_blank(byte));
    &bytes[start.unwrap_or(bytes.len())..]
}

fn is(word: &[u8], keyword: &str) -> bool {
    word.eq_ignore_ascii_case(keyword.as_bytes())
}

fn read_ascii(bytes: &[u8]) -> Result<Vec<[Vec3; 3]>, StlError> {
    let mut words = Words::new(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes));
    let mut triangles = Vec::new();
    words.expect(&["solid"], StlExpected::Solid)?;
    words.skip_name();
    let mut is_open = true;
    loop {
        let Some(word) = words.next() else {
            // Some writers leave the last line out.
            if triangles.is_empty() && is_open {
                return Err(words.end(StlExpected::FacetOrEndsolid));
            }
            return Ok(triangles);
        };
        if is(word, "facet") && (is_open || words.is_next("normal")) {
            triangles.push(read_ascii_facet(&mut words)?);
            is_open = true;
        } else if is(word, "endsolid") || is(word, "end") && words.is_next("solid") {
            words.skip_closing_name();
            is_open = false;
        } else if is(word, "solid") {
            words.skip_name();
            is_open = true;
        } else if is_open {
            return Err(words.syntax(StlExpected::FacetOrEndsolid, word));
        } else {
            // Text behind a solid.
            words.skip_free_text(|word, _| is(word, "solid"));
        }
    }
}

fn read_ascii_facet(words: &mut Words<'_>) -> Result<[Vec3; 3], StlError> {
    words.expect(&["normal"], StlExpected::Normal)?;
    for _ in 0..3 {
        words
            .next()
            .ok_or_else(|| words.end(StlExpected::NormalNumber))?;
    }
    words.expect(&["outer", "loop"], StlExpected::OuterLoop)?;
    let mut corners = [Vec3::ZERO; 3];
    for corner in &mut corners {
        words.expect(&["vertex"], StlExpected::Vertex)?;
        for axis in 0..3 {
            corner[axis] = words.number(StlExpected::Coordinate)?;
        }
    }
    words.expect_end("endloop", "loop", StlExpected::Endloop)?;
    words.expect_end("endfacet", "facet", StlExpected::Endfacet)?;
    words.skip_rest();
    Ok(corners)
}
