//! Print files from masks, plan and exposures. Each format has a source file of its own.

mod ctb;
mod fields;
mod goo;
pub mod layer_profile;
mod photon_workshop;
pub mod png;
mod preview;
mod pw0;
mod raster;
pub mod read;
pub mod runs;
mod schedule;
mod survey;
pub(crate) mod threemf;
mod transfer;
mod zip;

use std::collections::BTreeMap;
use std::io::Write;

pub use preview::{PlacedMesh, PreviewScene};
pub use schedule::{SAME_S, Schedule};
use serde::Serialize;
use serde_json::value::RawValue;
use survey::{Bounds, Survey};

use crate::format::Format;
use crate::mask::{LayerRuns, Run, RunSource};
use crate::parallel;
use crate::plan::uniform::UniformLayers;
use crate::printer::{Printer, Refusal, are_equal, check_thicknesses};
use crate::progress::{Cancelled, Progress, report};
use crate::resin::Resin;

/// The encoder of a format; `None` if its files have no masks: [`layer_profile`] writes these.
fn encoder(format: Format) -> Option<&'static dyn Encoder> {
    Some(match format {
        Format::Png => &zip::Zip(&zip::masks::Masks),
        Format::Chitubox => &zip::Zip(&zip::chitubox::Chitubox),
        Format::Uvj => &zip::Zip(&zip::uvj::Uvj),
        Format::Sl1 => &zip::Zip(&zip::sl1::Sl1),
        Format::Goo => &goo::Goo,
        Format::PhotonWorkshop => &photon_workshop::PhotonWorkshop,
        Format::AnycubicZip => &zip::Zip(&zip::anycubic::Anycubic),
        Format::Ctb => &ctb::Ctb,
        Format::Nanodlp => &zip::Zip(&zip::nanodlp::Nanodlp),
        Format::Prusa3mf | Format::Orca3mf => return None,
    })
}

/// A print format. A zip of masks implements [`zip::Container`] instead, and [`zip::Zip`] encodes it.
trait Encoder: Sync {
    /// Encodes a layer of these.
    fn layer(
        &self,
        canvas: Canvas,
        runs: &LayerRuns,
        layer: usize,
    ) -> Result<EncodedLayer, ArchiveError>;

    /// Writes the file sequentially, without seeking. Fails with [`ArchiveError::AllBlack`] if every mask is black.
    fn encode(
        &self,
        job: &PrintJob<'_>,
        writer: &mut dyn Write,
        progress: &mut Progress<'_>,
    ) -> Result<(), ArchiveError>;
}

/// Error of writing a print file.
#[derive(Debug, thiserror::Error, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum ArchiveError {
    /// The progress callback asked to stop.
    #[error(transparent)]
    #[serde(rename = "cancelled")]
    Cancelled(#[from] Cancelled),
    /// No pixel of any mask is lit.
    #[error(
        "all masks are black: the model encloses nothing at the middle of any layer; check \
         the model, or choose thinner layers"
    )]
    #[serde(rename = "all-black")]
    AllBlack,
    /// The format has one thickness for all layers, and the plan has several.
    #[error(
        "{} files have one thickness for all layers, and this plan has several; choose {}, or {}",
        format.name(),
        others.map(Format::name).join(", "),
        in_place(best.as_ref())
    )]
    #[serde(rename = "uniform-only")]
    UniformOnly {
        /// The format asked for.
        format: Format,
        /// The formats that have several.
        others: [Format; 5],
        /// The best uniform layers within tolerance, if any are.
        best: Option<UniformLayers>,
    },
    /// The printer takes one thickness for all layers, and the plan has several.
    #[error(
        "the {model} takes one thickness for all layers, and this plan has several; choose {}",
        in_place(best.as_ref())
    )]
    #[serde(rename = "printer-uniform-only")]
    PrinterUniformOnly {
        /// Make and model of the printer.
        model: String,
        /// The best uniform layers within tolerance, if any are.
        best: Option<UniformLayers>,
    },
    /// The format is for slicers of filament printers: its files have no masks.
    #[error(
        "{} files hold a model and its layers, and no masks; slice the model itself into this format, or choose another",
        format.name()
    )]
    #[serde(rename = "no-masks")]
    NoMasks {
        /// The format asked for.
        format: Format,
    },
    /// The first layer is not as thick as set in the slicer.
    #[error(
        "the first layer of this plan is {layer_mm} mm thick, not {first_layer_mm} mm as set; the model is lower than that, \
         so choose a thinner first layer"
    )]
    #[serde(rename = "other-first-layer")]
    OtherFirstLayer {
        /// Thickness of the plan's first layer.
        layer_mm: f64,
        /// Thickness that the slicer prints.
        first_layer_mm: f64,
    },
    /// Bytes could not be written: the disk is full, say.
    #[error("the print file could not be written: {system}")]
    #[serde(rename = "archive-write")]
    Write {
        /// The system's message, untranslated.
        system: String,
    },
}

/// Alternative to layers of several thicknesses, for a sentence.
fn in_place(best: Option<&UniformLayers>) -> String {
    best.map_or_else(
        || "the uniform planner".to_owned(),
        |best| format!("{best}, which keep the tolerance"),
    )
}

impl ArchiveError {
    /// Wraps the error of a failed write.
    pub(crate) fn write(error: impl std::fmt::Display) -> Self {
        Self::Write {
            system: error.to_string(),
        }
    }
}

impl From<std::io::Error> for ArchiveError {
    fn from(error: std::io::Error) -> Self {
        Self::write(error)
    }
}

/// The screen that shows the masks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Screen {
    /// Columns and rows.
    pub pixels: [u32; 2],
    /// Sides of a pixel in x and y, in millimetres.
    pub pitch_mm: [f64; 2],
    /// True if the masks are mirrored left to right, for a printer that lights the resin from below.
    pub is_mirrored: bool,
    /// Level of anti-aliasing; 1 means that pixels are either lit or dark.
    pub antialias: u32,
}

impl Screen {
    /// Sides in x and y, in millimetres.
    pub fn size_mm(&self) -> [f64; 2] {
        [0, 1].map(|axis| f64::from(self.pixels[axis]) * self.pitch_mm[axis])
    }

    /// A box of pixels as least and greatest x and y from the middle of the screen, in millimetres; all 0 without lit pixels.
    ///
    /// x grows with columns and y with rows, as formats have it that state such a box.
    fn bounds_mm(&self, bounds: Option<Bounds>) -> [f64; 4] {
        let Some(bounds) = bounds else {
            return [0.0; 4];
        };
        std::array::from_fn(|side| {
            let axis = side % 2;
            let from_middle = f64::from(bounds[side]) - f64::from(self.pixels[axis]) / 2.0;
            tidy(from_middle * self.pitch_mm[axis])
        })
    }

    /// The canvas of its masks.
    pub(crate) fn canvas(&self) -> Canvas {
        Canvas {
            pixels: self.pixels,
            antialias: self.antialias,
        }
    }

    /// Number of pixels.
    pub fn area(&self) -> u64 {
        self.canvas().area()
    }
}

/// Canvas of masks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Canvas {
    /// Columns and rows.
    pub pixels: [u32; 2],
    /// Level of anti-aliasing; 1 means that pixels are either lit or dark.
    pub antialias: u32,
}

impl Canvas {
    fn area(self) -> u64 {
        u64::from(self.pixels[0]) * u64::from(self.pixels[1])
    }
}

/// A layer of a print file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layer {
    /// Top of the layer, in millimetres above the plate.
    pub z_mm: f64,
    /// Thickness in millimetres.
    pub thickness_mm: f64,
    /// Exposure in seconds.
    pub exposure_s: f64,
}

/// Source of the masks of a print file.
#[derive(Clone, Copy)]
pub enum MaskSource<'a> {
    /// Runs, which are read and encoded here.
    Runs(&'a dyn RunSource),
    /// Layers encoded elsewhere: this fetches each group of [`GROUP`] layers, counted from 0, as [`encode_group`]
    /// encodes it.
    Encoded(&'a dyn Fn(usize) -> Vec<u8>),
}

/// Everything that goes into a print file.
#[derive(Clone, Copy)]
pub struct PrintJob<'a> {
    /// The screen.
    pub screen: Screen,
    /// The layers, from the plate upward.
    pub layers: &'a [Layer],
    /// The masks of the layers, as the printer shows them.
    pub masks: MaskSource<'a>,
    /// Height of the model in millimetres. The top of the layers may differ from it by part of a layer.
    pub height_mm: f64,
    /// The resin.
    pub resin: &'a Resin,
    /// Number of layers above the bottom layers over which the exposure falls to the usual one. It is stated in
    /// addition to the exposures of the layers, which follow [`Schedule`] if no layer has values of its own.
    pub transition_layers: usize,
    /// Volume of resin in the model, in millilitres.
    pub resin_ml: f64,
    /// The printer, if the job names one.
    pub printer: Option<&'a Printer>,
    /// Draws the model, for previews whose longest side has this many pixels.
    pub look: &'a dyn Fn(u32) -> PreviewScene,
    /// Finds the best uniform layers within tolerance.
    pub best_uniform: &'a dyn Fn() -> Option<UniformLayers>,
    /// Makes an object that describes the whole job, for formats of our own.
    pub manifest: &'a dyn Fn() -> Result<Manifest, serde_json::Error>,
}

/// The members of a JSON object by name, each as text: a second writer, for values in memory, would make the module of the
/// browser larger.
pub type Manifest = BTreeMap<String, Box<RawValue>>;

impl PrintJob<'_> {
    /// Total time of all layers, in seconds.
    fn print_time_s(&self) -> f64 {
        print_time_s(self.resin, self.layers)
    }

    /// The build volume of the printer in x, y and z, or the volume that the job needs, in millimetres.
    fn volume_mm(&self) -> [f64; 3] {
        let [x_mm, y_mm] = self.screen.size_mm();
        self.printer
            .map_or([x_mm, y_mm, self.height_mm.ceil()], |printer| {
                printer.volume_mm
            })
    }

    /// The middle layer's thickness, for formats that state a single one in addition to those of the layers.
    fn usual_mm(&self) -> f64 {
        let middle = self.layers.get(self.layers.len() / 2);
        middle.map_or(self.resin.layer_mm, |layer| layer.thickness_mm)
    }

    /// Returns true if the layers have values that the file's head does not: several thicknesses, or exposures other than those of
    /// bottom layers, of a fade and of the usual layer.
    fn needs_layer_settings(&self) -> bool {
        let schedule = Schedule {
            bottom_layers: self.resin.bottom_layers,
            bottom_s: self.resin.bottom_exposure_s,
            transition_layers: self.transition_layers,
            usual_s: self.resin.exposure_s(self.usual_mm()),
        };
        !are_equal(&self.thickness_mm())
            || !schedule.fits(self.layers.iter().map(|layer| layer.exposure_s))
    }

    fn thickness_mm(&self) -> Vec<f64> {
        self.layers.iter().map(|layer| layer.thickness_mm).collect()
    }

    /// Refuses layers that the format or the printer does not take.
    fn check(&self, format: Format) -> Result<(), ArchiveError> {
        let best = self.best_uniform;
        let checked = check_thicknesses(format, self.printer, &self.thickness_mm());
        checked.map_err(|refusal| match refusal {
            Refusal::Format(format) => ArchiveError::UniformOnly {
                format,
                others: Format::VARIABLE,
                best: best(),
            },
            Refusal::Printer(printer) => ArchiveError::PrinterUniformOnly {
                model: printer.model.clone(),
                best: best(),
            },
        })
    }
}

/// Total time of these layers, in seconds.
pub(crate) fn print_time_s(resin: &Resin, layers: &[Layer]) -> f64 {
    let exposure_s: Vec<f64> = layers.iter().map(|layer| layer.exposure_s).collect();
    resin.time_s(&exposure_s)
}

/// Writes a print file sequentially, without seeking, and returns the writer.
///
/// The bytes depend on the job alone, not on the number of threads or the machine.
///
/// # Errors
/// [`ArchiveError`].
pub fn write<W: Write>(
    format: Format,
    job: &PrintJob<'_>,
    mut writer: W,
    progress: &mut Progress<'_>,
) -> Result<W, ArchiveError> {
    report(progress, 0.0)?;
    let encoder = encoder(format).ok_or(ArchiveError::NoMasks { format })?;
    job.check(format)?;
    encoder.encode(job, &mut writer, progress)?;
    Ok(writer)
}

/// Layers that are read and encoded together, in parallel.
pub const GROUP: usize = 32;

/// The mask of a layer, encoded.
#[derive(Debug, PartialEq)]
struct EncodedLayer {
    data: Vec<u8>,
    /// Checksum and length of `data` once inflated, if it is deflated.
    inflated: Option<(u32, u64)>,
    lit_pixels: u64,
    /// Its lit areas, for formats that state them all.
    survey: Option<Survey>,
    /// The box of its lit pixels, for formats that state only that.
    bounds: Option<Bounds>,
}

impl EncodedLayer {
    /// A layer of which a format states no more.
    fn new(data: Vec<u8>, runs: impl Iterator<Item = Run>) -> Self {
        Self {
            data,
            inflated: None,
            lit_pixels: runs.map(|run| u64::from(run.pixels)).sum(),
            survey: None,
            bounds: None,
        }
    }
}

/// Encodes all layers in parallel, and takes them in order.
///
/// # Errors
/// [`ArchiveError`]; [`ArchiveError::AllBlack`] if no layer has a lit pixel.
fn encode_layers(
    job: &PrintJob<'_>,
    encoder: &dyn Encoder,
    take: &mut dyn FnMut(usize, EncodedLayer) -> Result<(), ArchiveError>,
    progress: &mut Progress<'_>,
) -> Result<(), ArchiveError> {
    let total = job.layers.len();
    let canvas = job.screen.canvas();
    let mut encode_next: Box<dyn FnMut(usize, usize) -> Result<_, _> + '_> = match job.masks {
        MaskSource::Runs(masks) => {
            let mut reader = masks.reader();
            Box::new(move |_, count| encode_runs(encoder, canvas, &reader.next(count)))
        }
        MaskSource::Encoded(group_of) => {
            Box::new(move |group, count| transfer::from_bytes(&group_of(group), count))
        }
    };
    let mut is_black = true;
    for first in (0..total).step_by(GROUP) {
        let count = GROUP.min(total - first);
        let encoded = encode_next(first / GROUP, count)?;
        for (layer, encoded) in encoded.into_iter().enumerate() {
            is_black &= encoded.lit_pixels == 0;
            take(first + layer, encoded)?;
        }
        report(progress, (first + count) as f64 / total as f64)?;
    }
    if is_black {
        return Err(ArchiveError::AllBlack);
    }
    Ok(())
}

/// Encodes consecutive layers in parallel.
fn encode_runs(
    encoder: &dyn Encoder,
    canvas: Canvas,
    runs: &LayerRuns,
) -> Result<Vec<EncodedLayer>, ArchiveError> {
    let layers = (0..runs.layers()).collect();
    let encoded = parallel::map(layers, |layer| encoder.layer(canvas, runs, layer));
    encoded.into_iter().collect()
}

/// Encodes a group of layers for [`MaskSource::Encoded`], wherever their runs were read.
///
/// # Errors
/// [`ArchiveError`].
pub fn encode_group(
    format: Format,
    canvas: Canvas,
    runs: &LayerRuns,
) -> Result<Vec<u8>, ArchiveError> {
    let encoder = encoder(format).ok_or(ArchiveError::NoMasks { format })?;
    Ok(transfer::to_bytes(&encode_runs(encoder, canvas, runs)?))
}

/// Rounds to six decimals, which drops the digits that arithmetic adds: 0.15 instead of 0.15000000000000002.
fn tidy(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

/// Formats a number to at most three decimals, without trailing zeros.
fn thousandths(value: f64) -> String {
    decimals(value, 3)
}

/// The same to at most six decimals: thicknesses, whose errors would add up over all layers.
fn millionths(value: f64) -> String {
    decimals(value, 6)
}

fn decimals(value: f64, most: usize) -> String {
    let text = format!("{value:.most$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text.is_empty() || text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}
