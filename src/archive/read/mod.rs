//! Print files as their readers see them: metadata and masks. Each format has a file of its own; no code is shared with
//! the encoders, so that each checks the other.
//!
//! ```
//! use cusp_slicer::archive::read::PrintFile;
//!
//! # fn example(bytes: &[u8]) -> Result<(), cusp_slicer::archive::read::PrintFileError> {
//! let file = PrintFile::open(bytes)?;
//! println!("{} layers for a {:?}", file.layers().len(), file.metadata().printer);
//! let mask = file.mask(0, file.metadata().flips())?;
//! println!("the first layer has light in the rows {:?}", mask.rows());
//! # Ok(())
//! # }
//! ```
//!
//! The format is recognised by content. Bytes are held once, and layers are decoded on request. Every value in a file
//! is checked before use: bad input is an error or a [`FileFinding`], and no file makes a reader allocate much more
//! than its size justifies.

mod anycubic_zip;
mod bytes;
mod chitubox;
mod container;
mod ctb;
mod error;
mod finding;
mod goo;
mod image;
mod manifest;
mod mask;
mod metadata;
mod nanodlp;
mod photon_workshop;
mod preview;
mod pw0;
mod report;
mod runs;
mod sl1;
mod surface;
mod uvj;

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Write;
use std::ops::Range;

pub use bytes::Bytes;
pub use error::{LayerFault, PrintFileError, UnreadKind};
pub use finding::FileFinding;
pub use mask::{Flips, Mask, changes_up_to, combine};
pub use metadata::{Layer, Metadata, Preview};
pub use report::{Inspection, LayerInspection, PreviewSize, inspect, inspect_masks};
pub use runs::Sink;
pub use surface::surface;

use crate::format::Format;
use crate::grid::MAX_SIDE;
use crate::model::Pose;
use container::Archive;
use finding::Tally;
use image::Expected;
use mask::Collector;
use preview::Picture;
use runs::Coverage;

/// A print file in memory, with its settings read.
pub struct PrintFile<'a> {
    bytes: Bytes<'a>,
    archive: Option<Archive<'a>>,
    contents: Contents,
}

/// A copy of a model in the masks.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PrintedCopy {
    /// The model, by its index.
    pub model: usize,
    /// Its pose before turns.
    pub pose: Pose,
    /// Turn about z after that, counter-clockwise as seen from above: a multiple of 15.
    pub turn_deg: u32,
    /// The middle of the box around the turned model, to the right of the middle of the masks and to its back.
    pub middle_mm: [f64; 2],
}

/// Result of a format's reader.
struct Contents {
    metadata: Metadata,
    layers: Vec<Layer>,
    coding: Coding,
    places: Places,
    pictures: Vec<Picture>,
    /// The copies in the masks, if the file says so.
    copies: Option<Vec<PrintedCopy>>,
    /// Faults other than those of layers and heights.
    findings: Vec<FileFinding>,
}

impl Contents {
    /// Takes out exposures and nominal values that are not finite, as if they were not stated, and keeps the findings.
    fn take_not_finite(&mut self) {
        let found = finding::take_not_finite(&mut self.metadata, &mut self.layers);
        self.findings.splice(0..0, found);
    }
}

/// Encoding of layers.
#[derive(Debug, Clone, Copy)]
enum Coding {
    Png,
    /// PNGs in which each colour of a pixel is a pixel of the mask.
    PngOfSubpixels,
    Pw0,
    /// True if greys go to 255 rather than 15.
    Goo {
        is_fine: bool,
    },
    Ctb {
        key: u32,
    },
}

/// Location of each layer's data, from the plate upward.
enum Places {
    /// Bytes of the file.
    InFile(Vec<Range<u64>>),
    /// Names in the zip.
    InZip(Vec<String>),
}

impl<'a> PrintFile<'a> {
    /// Reads the settings, in whatever format they are.
    ///
    /// # Errors
    /// [`PrintFileError`], but not its `Layer`: masks are not decoded.
    pub fn open(bytes: impl Into<Bytes<'a>>) -> Result<Self, PrintFileError> {
        let bytes = bytes.into();
        let start = bytes.as_ref();
        let (archive, mut contents) = if goo::is(start) {
            (None, goo::read(start)?)
        } else if let Some(magic) = ctb::magic(start) {
            (None, ctb::read(start, magic)?)
        } else if photon_workshop::is(start) {
            (None, photon_workshop::read(start)?)
        } else {
            let mut archive = Archive::open(bytes.clone())?;
            let contents = read_archive(&mut archive)?;
            (Some(archive), contents)
        };
        contents.take_not_finite();
        let [width, height] = contents.metadata.pixels;
        let side = 1..=MAX_SIDE;
        if !side.contains(&width) || !side.contains(&height) {
            return Err(PrintFileError::TooManyPixels {
                width,
                height,
                max_side: MAX_SIDE,
            });
        }
        Ok(Self {
            bytes,
            archive,
            contents,
        })
    }

    /// Metadata of the print as a whole.
    pub fn metadata(&self) -> &Metadata {
        &self.contents.metadata
    }

    /// Values of each layer, from the plate upward.
    pub fn layers(&self) -> &[Layer] {
        &self.contents.layers
    }

    /// The copies of models in the masks, if the file says so.
    pub fn copies(&self) -> Option<&[PrintedCopy]> {
        self.contents.copies.as_deref()
    }

    /// Decodes a layer as stored, and passes its runs to `sink`. They cover every pixel of the mask, unless there is an error:
    /// then what could be decoded has been passed.
    ///
    /// # Errors
    /// [`LayerFault`].
    ///
    /// # Panics
    /// If there is no such layer; the first is 0.
    pub fn runs(&self, layer: usize, sink: &mut Sink<'_>) -> Result<(), LayerFault> {
        let metadata = self.metadata();
        let data = self.data(layer)?;
        let mut coverage = Coverage::new(metadata.mask_pixels(), sink);
        let [width, height] = metadata.pixels;
        let mut each = |grey, count| coverage.run(grey, count);
        match self.contents.coding {
            Coding::Png => image::rows(&data, self.expected(layer, width, height), |row| {
                image::row_runs(row, width, &mut each)
            }),
            Coding::PngOfSubpixels => {
                let expected = self.expected(layer, width.div_ceil(3), height);
                image::rows(&data, expected, |row| {
                    image::subpixel_runs(row, width, &mut each)
                })
            }
            Coding::Pw0 => pw0::decode(&data, &mut coverage),
            Coding::Goo { is_fine } => goo::decode(&data, is_fine, &mut coverage),
            Coding::Ctb { key } => ctb::decode(&data, key, layer as u32, &mut coverage),
        }
    }

    /// Decodes a layer's mask, and turns it over as `flips` says: [`Metadata::flips`], unless more is known.
    ///
    /// # Errors
    /// [`PrintFileError::Layer`].
    ///
    /// # Panics
    /// If there is no such layer; the first is 0.
    pub fn mask(&self, layer: usize, flips: Flips) -> Result<Mask, PrintFileError> {
        let mask = self.stored_mask(layer);
        let mask = mask.map_err(|fault| at_layer(layer, fault))?;
        Ok(mask.seen_from_above(self.metadata().pixels, flips))
    }

    /// The grey pixels of a layer by their brightness, turned over as `flips` says. White and black ones are left out.
    ///
    /// # Errors
    /// [`PrintFileError::Layer`].
    ///
    /// # Panics
    /// If there is no such layer; the first is 0.
    pub fn greys(&self, layer: usize, flips: Flips) -> Result<Vec<(u8, Mask)>, PrintFileError> {
        let [width, height] = self.metadata().pixels;
        let mut greys: BTreeMap<u8, (Collector, u32)> = BTreeMap::new();
        let mut place = 0;
        let decoded = self.runs(layer, &mut |grey, count| {
            if !matches!(grey, 0 | u8::MAX) {
                let it = greys.entry(grey);
                let (collector, end) = it.or_insert_with(|| (Collector::new(width), 0));
                collector.run(0, place - *end);
                collector.run(u8::MAX, count);
                *end = place + count;
            }
            place += count;
        });
        decoded.map_err(|fault| at_layer(layer, fault))?;
        let greys = greys.into_iter().map(|(grey, (collector, _))| {
            let mask = collector.finish();
            (grey, mask.seen_from_above([width, height], flips))
        });
        Ok(greys.collect())
    }

    fn stored_mask(&self, layer: usize) -> Result<Mask, LayerFault> {
        let [width, height] = self.metadata().pixels;
        if !matches!(self.contents.coding, Coding::Png) {
            let mut collector = Collector::new(width);
            self.runs(layer, &mut |grey, count| collector.run(grey, count))?;
            return Ok(collector.finish());
        }
        // Rows of bits become changes without a look at each pixel.
        let png = self.data(layer)?;
        let (mut mask, mut row, mut columns) = (Mask::default(), 0, Vec::new());
        image::rows(&png, self.expected(layer, width, height), |pixels| {
            columns.clear();
            image::scan(pixels, width, &mut columns);
            mask.push(row, &columns);
            row += 1;
            Ok(())
        })?;
        Ok(mask)
    }

    /// Writes the mask of a layer as stored, as a PNG of 8 bits of grey.
    ///
    /// # Errors
    /// [`PrintFileError::Layer`], or the writer's error.
    ///
    /// # Panics
    /// If there is no such layer; the first is 0.
    pub fn write_png(
        &self,
        layer: usize,
        writer: impl Write,
    ) -> std::io::Result<Result<(), PrintFileError>> {
        let decoded = image::write_grey(writer, self.metadata().pixels, |sink| {
            self.runs(layer, sink)
        });
        decoded.map(|decoded| decoded.map_err(|fault| at_layer(layer, fault)))
    }

    /// Number of previews.
    pub fn previews(&self) -> usize {
        self.contents.pictures.len()
    }

    /// Decodes a preview; `None` if it is damaged.
    ///
    /// # Panics
    /// If there is no such preview; the first is 0.
    pub fn preview(&self, place: usize) -> Option<Preview> {
        let bytes = self.bytes.as_ref();
        match &self.contents.pictures[place] {
            Picture::Words {
                pixels,
                order,
                place,
            } => preview::of_words(bytes, *pixels, *order, place),
            Picture::Ctb { pixels, place } => preview::of_ctb(bytes, *pixels, place),
            Picture::Png(name) => {
                let archive = self.archive.as_ref()?;
                let png = archive.clone().read(name, preview::MOST_BYTES).ok()?;
                preview::of_png(&png)
            }
        }
    }

    fn data(&self, layer: usize) -> Result<Cow<'_, [u8]>, LayerFault> {
        let bytes = self.bytes.as_ref();
        match (&self.contents.places, &self.archive) {
            (Places::InFile(places), _) => {
                let Range { start, end } = places[layer];
                let data = bytes.get(start as usize..end as usize);
                data.map(Cow::Borrowed).ok_or(LayerFault::OutsideFile {
                    end_byte: end,
                    file_bytes: bytes.len() as u64,
                })
            }
            (Places::InZip(names), Some(archive)) => {
                // A copy shares the directory with the original, and has a place of its own.
                let data = archive.clone().read(&names[layer], self.most_bytes());
                data.map(Cow::Owned).map_err(mask_fault)
            }
            (Places::InZip(names), None) => Err(LayerFault::MissingMask {
                name: names[layer].clone(),
            }),
        }
    }

    /// Largest unpacked size of a mask in a zip: four bytes a pixel, and 64 KiB besides, which small files need.
    fn most_bytes(&self) -> u64 {
        4 * self.metadata().mask_pixels() + (1 << 16)
    }

    fn expected(&self, layer: usize, width: u32, height: u32) -> Expected<'_> {
        Expected {
            pixels: [width, height],
            name: match &self.contents.places {
                Places::InZip(names) => &names[layer],
                Places::InFile(_) => "mask",
            },
        }
    }
}

fn at_layer(layer: usize, fault: LayerFault) -> PrintFileError {
    PrintFileError::Layer {
        layer: layer + 1,
        fault,
    }
}

/// The fault of a mask whose file in the zip cannot be read.
fn mask_fault(error: PrintFileError) -> LayerFault {
    match error {
        PrintFileError::MissingFile { name } => LayerFault::MissingMask { name },
        PrintFileError::BadFile { name, system } => LayerFault::BadMask { name, system },
        PrintFileError::TooLarge { name, .. } => LayerFault::BadMask {
            name,
            system: "it unpacks to more than a mask can be".to_owned(),
        },
        error => LayerFault::BadMask {
            name: String::new(),
            system: error.to_string(),
        },
    }
}

fn read_archive(archive: &mut Archive<'_>) -> Result<Contents, PrintFileError> {
    type Read = fn(&mut Archive<'_>) -> Result<Contents, PrintFileError>;
    let by_name: [(&str, Read); 7] = [
        ("manifest.json", manifest::read),
        ("run.gcode", chitubox::read),
        ("layers_controller.conf", anycubic_zip::read),
        ("plate.json", nanodlp::read),
        ("config.json", uvj::read),
        ("config.ini", sl1::read),
        ("anycubic_photon_resins.pwsp", anycubic_zip::read),
    ];
    let found = by_name.iter().find(|(name, _)| archive.has(name));
    let (_, read) = found.ok_or_else(|| without_masks(archive))?;
    read(archive)
}

/// The error for a zip without the settings of a print file.
fn without_masks(archive: &Archive<'_>) -> PrintFileError {
    /// Names under which slicers of filament printers look for layers.
    const LAYERS: [&str; 2] = [
        "Metadata/Slic3r_PE_layer_heights_profile.txt",
        "Metadata/layer_heights_profile.txt",
    ];
    if archive.has("3D/3dmodel.model") {
        PrintFileError::Model {
            has_layers: LAYERS.iter().any(|name| archive.has(name)),
        }
    } else {
        PrintFileError::UnknownZip
    }
}

/// A length that a file states, if it is a positive number.
fn positive(length: Option<f64>) -> Option<f64> {
    length.filter(|length| length.is_finite() && *length > 0.0)
}

/// The side of a pixel, if the number of pixels and the length of all together are stated.
fn side(pixels: u32, length_mm: Option<f64>) -> Option<f64> {
    let length_mm = positive(length_mm)?;
    (pixels > 0).then(|| length_mm / f64::from(pixels))
}

/// Names, joined with spaces.
fn joined(names: &[Option<String>]) -> Option<String> {
    let names: Vec<&str> = names.iter().flatten().map(String::as_str).collect();
    (!names.is_empty()).then(|| names.join(" "))
}

/// The number of layers that a file declares, if `room` bytes hold that many layers of at least `each` bytes.
fn checked_layers(layers: u32, room: u64, each: u64) -> Result<usize, PrintFileError> {
    let (layers, most) = (u64::from(layers), room / each);
    if layers > most {
        return Err(PrintFileError::TooManyLayers { layers, most });
    }
    Ok(layers as usize)
}
