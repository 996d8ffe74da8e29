//! The zip of a 3MF, and its parts as streams.

use std::cell::Cell;

use flate2::{Decompress, FlushDecompress, Status};
use rawzip::{CompressionMethod, ZipArchive, ZipArchiveEntryWayfinder, ZipSliceArchive};

use super::ThreeMfError;
use crate::crc::Crc32;
use crate::model::read::text::named;

/// The parts that are read may always inflate to this many bytes in all,
const ALWAYS_BYTES: u64 = 1 << 23;
/// and to this many times the size of the package. The text of a mesh inflates five- to tenfold.
const MOST_RATIO: u64 = 200;

/// The parts of a 3MF.
pub struct Package<'a> {
    zip: ZipSliceArchive<&'a [u8]>,
    entries: Vec<Entry>,
    /// Bytes that parts may inflate to, and how many of them are left.
    most_bytes: u64,
    left_bytes: Cell<u64>,
}

struct Entry {
    name: String,
    method: CompressionMethod,
    is_encrypted: bool,
    place: ZipArchiveEntryWayfinder,
}

impl<'a> Package<'a> {
    pub fn new(bytes: &'a [u8]) -> Result<Self, ThreeMfError> {
        let damaged = |_| ThreeMfError::NoDirectory;
        let zip = ZipArchive::from_slice(bytes).map_err(damaged)?;
        let mut entries = Vec::new();
        let mut records = zip.entries();
        while let Some(record) = records.next_entry().map_err(damaged)? {
            let mut name = record.file_path().as_ref().to_vec();
            for byte in name.iter_mut().filter(|byte| **byte == b'\\') {
                *byte = b'/';
            }
            entries.push(Entry {
                name: String::from_utf8_lossy(name.strip_prefix(b"/").unwrap_or(&name))
                    .into_owned(),
                method: record.compression_method(),
                is_encrypted: record.flags().is_encrypted(),
                place: record.wayfinder(),
            });
        }
        let most_bytes = ALWAYS_BYTES.max(MOST_RATIO * bytes.len() as u64);
        Ok(Self {
            zip,
            entries,
            most_bytes,
            left_bytes: Cell::new(most_bytes),
        })
    }

    /// Returns true if a part has a name that ends so, whatever the case of its letters.
    pub fn has_ending(&self, end: &str) -> bool {
        let mut names = self.entries.iter().map(|entry| entry.name.as_bytes());
        names.any(|name| {
            let tail = name
                .len()
                .checked_sub(end.len())
                .map(|start| &name[start..]);
            tail.is_some_and(|tail| tail.eq_ignore_ascii_case(end.as_bytes()))
        })
    }

    /// The name by which the package knows a part, since the case of letters does not count and some writers encode them.
    pub fn find(&self, part: &str) -> Option<&str> {
        let part = &resolved(part);
        let with_name = |name: &str| {
            let mut entries = self.entries.iter();
            entries.find(|entry| entry.name.eq_ignore_ascii_case(name))
        };
        let entry = with_name(part).or_else(|| with_name(&percent_decoded(part)));
        entry.map(|entry| &*entry.name)
    }

    /// Opens a part. Its name is as [`Self::find`] returns it.
    pub fn open(&self, part: &str) -> Result<Part<'_>, ThreeMfError> {
        let entry = self.entries.iter().find(|entry| entry.name == part);
        let name = named(part.as_bytes());
        let Some(entry) = entry else {
            return Err(ThreeMfError::NoPart { part: name });
        };
        let inflater = match entry.method {
            CompressionMethod::STORE if !entry.is_encrypted => None,
            CompressionMethod::DEFLATE if !entry.is_encrypted => {
                Some(Box::new(Decompress::new(false)))
            }
            method => {
                let method = method.as_u16();
                return Err(ThreeMfError::Packed { part: name, method });
            }
        };
        let Ok(found) = self.zip.get_entry(entry.place) else {
            return Err(ThreeMfError::DamagedPart { part: name });
        };
        let rest = found.data();
        Ok(Part {
            name,
            inflater,
            most_bytes: self.most_bytes,
            left_bytes: &self.left_bytes,
            rest,
            claim: found.claim_verifier(),
            crc: Crc32::default(),
            length: 0,
        })
    }
}

/// A part that is being read.
pub struct Part<'a> {
    pub name: String,
    inflater: Option<Box<Decompress>>,
    rest: &'a [u8],
    most_bytes: u64,
    /// Bytes that this part and those after it may inflate to.
    left_bytes: &'a Cell<u64>,
    /// Length and checksum that it must have in the end.
    claim: rawzip::ZipVerification,
    crc: Crc32,
    length: u64,
}

impl Part<'_> {
    /// Reads on, and returns how many bytes were read; 0 at the end of a part that is whole.
    pub fn read(&mut self, into: &mut [u8]) -> Result<usize, ThreeMfError> {
        let count = match &mut self.inflater {
            None => {
                let count = self.rest.len().min(into.len());
                into[..count].copy_from_slice(&self.rest[..count]);
                self.rest = &self.rest[count..];
                count
            }
            Some(inflater) => {
                inflate(inflater, &mut self.rest, into).ok_or_else(|| self.damaged())?
            }
        };
        self.crc.update(&into[..count]);
        self.length += count as u64;
        let left_bytes = self.left_bytes.get().checked_sub(count as u64);
        self.left_bytes
            .set(left_bytes.ok_or_else(|| ThreeMfError::TooLarge {
                part: self.name.clone(),
                most_bytes: self.most_bytes,
            })?);
        let is_whole =
            self.claim.crc == self.crc.checksum() && self.claim.uncompressed_size == self.length;
        if count == 0 && !is_whole {
            return Err(self.damaged());
        }
        Ok(count)
    }

    fn damaged(&self) -> ThreeMfError {
        ThreeMfError::DamagedPart {
            part: self.name.clone(),
        }
    }
}

/// Inflates some bytes; 0 at the end of the stream, `None` if it is damaged.
fn inflate(inflater: &mut Decompress, rest: &mut &[u8], into: &mut [u8]) -> Option<usize> {
    loop {
        let (read, written) = (inflater.total_in(), inflater.total_out());
        let status = inflater
            .decompress(rest, into, FlushDecompress::None)
            .ok()?;
        *rest = &rest[(inflater.total_in() - read) as usize..];
        let count = (inflater.total_out() - written) as usize;
        if count > 0 || status == Status::StreamEnd {
            return Some(count);
        }
        // Without progress the stream is cut short.
        if inflater.total_in() == read {
            return None;
        }
    }
}

/// A path from the root of the package, without `.` and `..`.
fn resolved(path: &str) -> String {
    let mut steps = Vec::new();
    for step in path.split('/') {
        match step {
            "" | "." => (),
            ".." => drop(steps.pop()),
            step => steps.push(step),
        }
    }
    steps.join("/")
}

/// A name with its `%` sequences replaced.
fn percent_decoded(name: &str) -> String {
    let mut decoded = Vec::new();
    let mut rest = name.as_bytes();
    while let Some((&byte, after)) = rest.split_first() {
        let code = (byte == b'%').then(|| after.get(..2)).flatten();
        let code = code.and_then(|code| u8::from_str_radix(str::from_utf8(code).ok()?, 16).ok());
        decoded.push(code.unwrap_or(byte));
        rest = if code.is_some() { &after[2..] } else { after };
    }
    String::from_utf8_lossy(&decoded).into_owned()
}
