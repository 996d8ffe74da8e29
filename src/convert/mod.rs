//! A print file made from another: the same layers, exposures and pixels, in another format or for another printer.

mod settings;

use std::sync::Arc;

use serde::Serialize;
use serde_json::json;
use settings::Exposures;

use crate::archive::read::{
    FileFinding, Flips, Inspection, Layer as LayerRead, Metadata, Preview, PrintFile,
};
use crate::archive::{self, ArchiveError, Layer, Manifest, PreviewScene, PrintJob, Screen};
use crate::format::Format;
use crate::job::{OptionsError, SCHEMA, find_printer};
use crate::mask::{LEVELS, LayerRuns, Run, RunReader, RunSource};
use crate::parallel;
use crate::printer::{Printer, PrinterChoice};
use crate::progress::Progress;
use crate::quantity::{Quantity, QuantityError};
use crate::resin::Resin;
use crate::warning::Warning;

/// Changes to a print file. Absent values stay the same.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Target {
    /// The format; the printer's if absent.
    pub format: Option<Format>,
    /// The printer; the one that the file names if absent, where it is known.
    pub printer: Option<PrinterChoice>,
    /// True if masks are mirrored left to right; as the printer has them if absent.
    pub mirror: Option<bool>,
    /// A resin, whose exposures, rests and moves replace those of the file. Its compensation does not count: masks stay as they are.
    pub resin: Option<Resin>,
}

/// A conversion, checked and ready to be written.
pub struct Conversion<'a> {
    file: &'a PrintFile<'a>,
    format: Format,
    printer: Option<Arc<Printer>>,
    screen: Screen,
    /// Transformation from stored masks to masks seen from above.
    flips: Flips,
    layers: Vec<Layer>,
    resin: Resin,
    transition_layers: usize,
    volume_ml: f64,
    losses: Vec<Loss>,
}

/// Error of converting a print file. `Display` writes one sentence.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ConvertError {
    /// The file is not whole, or its layers are in no order that can be printed.
    #[error("it cannot be converted: {0}")]
    Unsound(FileFinding),
    /// The printer is unknown, or badly described.
    #[error(transparent)]
    Options(#[from] OptionsError),
    /// Neither the caller nor the printer says which format.
    #[error("no format is given, and no known printer that has one; name a format or a printer")]
    NoFormat,
    /// The masks are made for another screen.
    #[error(
        "its masks are {} × {} pixels of {:.4} × {:.4} mm, and the screen of the {model} has {} × {} of {:.4} × {:.4} mm; slice \
         the model for that printer",
        pixels[0], pixels[1], pixel_mm[0], pixel_mm[1], screen[0], screen[1], screen_mm[0], screen_mm[1]
    )]
    OtherScreen {
        /// Make and model of the printer.
        model: String,
        /// Columns and rows of the masks.
        pixels: [u32; 2],
        /// Sides of their pixels in millimetres.
        pixel_mm: [f64; 2],
        /// Columns and rows of the screen.
        screen: [u32; 2],
        /// Sides of its pixels in millimetres.
        screen_mm: [f64; 2],
    },
    /// The print is higher than the printer.
    #[error("it is {height_mm:.3} mm high, and the {model} prints up to {greatest_mm} mm")]
    TooHigh {
        /// Make and model of the printer.
        model: String,
        /// Height of the print in millimetres.
        height_mm: f64,
        /// Height that the printer prints in millimetres.
        greatest_mm: f64,
    },
    /// A layer is thinner or thicker than the printer prints.
    #[error(
        "its layer {layer} is {thickness_mm:.3} mm thick, and the {model} prints {} to {} mm",
        range_mm[0], range_mm[1]
    )]
    Thickness {
        /// Make and model of the printer.
        model: String,
        /// Number of the layer, from 1.
        layer: usize,
        /// Its thickness in millimetres.
        thickness_mm: f64,
        /// Thicknesses that the printer prints, in millimetres.
        range_mm: [f64; 2],
    },
    /// The file does not say how long its layers are exposed.
    #[error("it does not say how long its layers are exposed; give a resin, which does")]
    NoExposure,
    /// The format has one exposure for all layers above the bottom layers, and the file has several.
    #[error(
        "{} files have one exposure above the bottom layers, and this file has several; choose {}, or give a resin",
        format.name(), Format::VARIABLE.map(Format::name).join(", ")
    )]
    OneExposure {
        /// The format asked for.
        format: Format,
    },
    /// A number of the resin, or of the file, is out of bounds.
    #[error(transparent)]
    Resin(#[from] QuantityError),
    /// The new file cannot be written, or cannot have these layers.
    #[error(transparent)]
    Archive(#[from] ArchiveError),
}

/// Something of a print file that its conversion does not have. `Display` writes one sentence.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, thiserror::Error)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(tag = "code", content = "detail", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Loss {
    /// Lifts or speeds differ between layers.
    #[error("lifts and speeds differ between layers; all layers now have those of layer {layer}")]
    Moves {
        /// Number of the layer whose moves all layers have, from 1.
        layer: usize,
    },
    /// Rests are at several times of a layer, or differ between layers.
    #[error(
        "rests differ between layers, or follow the exposure; all layers now rest {wait_s} s before it"
    )]
    Rests {
        /// Rest of each layer in seconds.
        wait_s: f64,
    },
    /// The format has fewer greys.
    #[error("greys are rounded down to {levels} levels, which is all that the format has")]
    Greys {
        /// Number of levels, black and white included.
        levels: u32,
    },
    /// Nothing says whether the masks are mirrored.
    #[error(
        "neither the file nor its printer says whether masks are mirrored; they stay as they are"
    )]
    Mirroring,
}

/// Heights and thicknesses that differ by no more are one: files round heights to a micrometre, and the rest is for the last
/// digits of sums.
const SAME_MM: f64 = 1.001e-3;
/// Sides of pixels that differ by a smaller part are equal: files state them to the micrometre.
const SAME_PITCH: f64 = 0.02;

impl<'a> Conversion<'a> {
    /// Checks that `target` can hold the contents of the file.
    ///
    /// # Errors
    /// Any [`ConvertError`]; of [`ArchiveError`] those that writing has besides.
    pub fn new(
        file: &'a PrintFile<'a>,
        inspection: &Inspection,
        target: &Target,
    ) -> Result<Self, ConvertError> {
        let unsound = inspection.warnings.iter().find(|finding| {
            matches!(
                finding,
                FileFinding::NoLayers
                    | FileFinding::BadHeights { .. }
                    | FileFinding::BadExposures { .. }
                    | FileFinding::BadNominalValues
                    | FileFinding::FirstLayerBelowPlate { .. }
                    | FileFinding::HeightsNotAscending { .. }
                    | FileFinding::BadLayers { .. }
            )
        });
        if let Some(finding) = unsound {
            return Err(ConvertError::Unsound(finding.clone()));
        }
        let metadata = file.metadata();
        let old = metadata.known_printer();
        let named = find_printer(target.printer.as_ref())?;
        let printer = named.or_else(|| old.clone());
        let format = target
            .format
            .or(printer.as_deref().map(|printer| printer.format))
            .ok_or(ConvertError::NoFormat)?;
        if Format::FILAMENT.contains(&format) {
            return Err(ArchiveError::NoMasks { format }.into());
        }

        let (screen, flips, says_mirroring) = screen(metadata, printer.as_deref(), target.mirror);
        let greys = inspection.layer_values.iter();
        let has_greys = greys
            .filter_map(|layer| layer.grey_pixels)
            .any(|greys| greys > 0);
        let screen = Screen {
            antialias: if has_greys {
                LEVELS[LEVELS.len() - 1]
            } else {
                1
            },
            ..screen
        };
        for side_mm in screen.pitch_mm {
            Quantity::Pitch.check(side_mm)?;
        }
        let layers_read = settings::without_noise(metadata, file.layers());
        if let Some(printer) = &printer {
            check_printer(printer, &screen, &layers_read)?;
        }
        let Exposures {
            resin,
            exposure_s,
            transition_layers,
        } = settings::exposures(metadata, &layers_read, target.resin.as_ref())?;
        resin.check()?;
        let layers: Vec<Layer> = layers_read
            .iter()
            .zip(exposure_s)
            .map(|(layer, exposure_s)| Layer {
                z_mm: layer.z_mm,
                thickness_mm: layer.thickness_mm,
                exposure_s,
            })
            .collect();
        settings::check_exposures(format, &layers, resin.bottom_layers, transition_layers)?;

        let mut losses = Vec::new();
        if target.resin.is_none() {
            losses.extend(settings::lost_moves(file.layers(), &resin));
        }
        let (before, after) = (metadata.format.grey_levels(), format.grey_levels());
        if has_greys && after < before {
            losses.push(Loss::Greys { levels: after });
        }
        if !says_mirroring {
            losses.push(Loss::Mirroring);
        }
        let stated_ml = metadata.volume_ml.filter(|&volume_ml| volume_ml > 0.0);
        Ok(Self {
            file,
            format,
            printer,
            screen,
            flips,
            layers,
            resin,
            transition_layers,
            volume_ml: stated_ml.unwrap_or(inspection.lit_volume_ml),
            losses,
        })
    }

    /// The format of the new file.
    pub fn format(&self) -> Format {
        self.format
    }

    /// Warnings about the exposures of a resin that was given.
    pub fn warnings(&self) -> Vec<Warning> {
        let thickness_mm: Vec<f64> = self.layers.iter().map(|it| it.thickness_mm).collect();
        Warning::of_exposures(&self.resin, &thickness_mm)
            .into_iter()
            .collect()
    }

    /// The printer of the new file, if one is named or known.
    pub fn printer(&self) -> Option<&Printer> {
        self.printer.as_deref()
    }

    /// Total time of all layers, in seconds.
    pub fn print_time_s(&self) -> f64 {
        archive::print_time_s(&self.resin, &self.layers)
    }

    /// Contents of the old file that the new one lacks.
    pub fn losses(&self) -> &[Loss] {
        &self.losses
    }

    /// Writes the new file, sequentially, and returns the writer.
    ///
    /// # Errors
    /// [`ArchiveError`].
    pub fn write<W: std::io::Write>(
        &self,
        writer: W,
        progress: &mut Progress<'_>,
    ) -> Result<W, ArchiveError> {
        let height_mm = self.layers.last().map_or(0.0, |layer| layer.z_mm);
        let job = PrintJob {
            screen: self.screen,
            layers: &self.layers,
            masks: archive::MaskSource::Runs(self),
            height_mm,
            resin: &self.resin,
            transition_layers: self.transition_layers,
            resin_ml: self.volume_ml,
            printer: self.printer(),
            look: &|_| self.look(),
            best_uniform: &|| None,
            manifest: &|| self.manifest(),
        };
        archive::write(self.format, &job, writer, progress)
    }

    /// The largest preview of the file, or else its masks on top of each other.
    fn look(&self) -> PreviewScene {
        let previews = (0..self.file.previews()).filter_map(|place| self.file.preview(place));
        let largest =
            previews.max_by_key(|preview| u64::from(preview.width) * u64::from(preview.height));
        largest.map_or_else(|| self.stacked(), |preview| preview_scene(&preview))
    }

    /// Masks of layers spread over the height, the higher the brighter.
    fn stacked(&self) -> PreviewScene {
        /// Layers that are drawn.
        const LAYERS: usize = 64;
        /// Pixels of the longer side.
        const SIDE: u32 = 512;
        let [width, height] = self.screen.pixels;
        let step = width.max(height).div_ceil(SIDE);
        let [columns, rows] = [width, height].map(|side| side.div_ceil(step));
        let mut brightness = vec![0; columns as usize * rows as usize];
        let layers = self.layers.len();
        for part in 1..=LAYERS.min(layers) {
            let layer = part * layers / LAYERS.min(layers) - 1;
            let Ok(mask) = self.file.mask(layer, self.flips) else {
                continue;
            };
            let grey = (60 + 195 * (layer + 1) / layers) as u8;
            for row in 0..rows {
                let changes = mask.row((row * step) as i32);
                for run in changes.chunks_exact(2) {
                    let [first, end] =
                        [run[0], run[1]].map(|column| u32::from(column).div_ceil(step));
                    let place = (row * columns) as usize;
                    brightness[place + first as usize..place + end as usize].fill(grey);
                }
            }
        }
        PreviewScene::from_picture([columns, rows], self.screen.pitch_mm, brightness)
    }

    /// The manifest in a zip of masks, for a print without a plan.
    fn manifest(&self) -> Result<Manifest, serde_json::Error> {
        let screen = &self.screen;
        let manifest = json!({
            "schema": SCHEMA,
            "converted_from": self.file.metadata().format,
            "layers": self.layers.len(),
            "height_mm": self.layers.last().map_or(0.0, |layer| layer.z_mm),
            "print_time_s": self.print_time_s(),
            "printer": self.printer().map(|printer| &printer.model),
            "resin": self.resin,
            "resin_ml": self.volume_ml,
            "mask": {
                "width": screen.pixels[0],
                "height": screen.pixels[1],
                "pitch_mm": screen.pitch_mm[0],
                "pitch_y_mm": screen.pitch_mm[1],
                "antialias": screen.antialias,
                "is_mirrored": screen.is_mirrored,
            },
        });
        serde_json::from_str(&manifest.to_string())
    }
}

/// The screen of the new file without its anti-aliasing, how stored masks become masks seen from above, and whether that is
/// known.
fn screen(
    metadata: &Metadata,
    printer: Option<&Printer>,
    mirror: Option<bool>,
) -> (Screen, Flips, bool) {
    let is_mirrored = metadata.is_mirrored();
    let wanted = mirror
        .or(printer.map(|printer| printer.is_mirrored))
        .or(is_mirrored);
    // Screens light the resin from below.
    let wanted = wanted.unwrap_or(true);
    let flips = Flips {
        mirror_x: is_mirrored.unwrap_or(wanted),
        ..metadata.flips()
    };
    let screen = Screen {
        pixels: metadata.pixels_from_above(),
        pitch_mm: metadata.pixel_mm_from_above(),
        is_mirrored: wanted,
        antialias: 1,
    };
    (screen, flips, is_mirrored.is_some())
}

/// Refuses what does not fit the printer.
fn check_printer(
    printer: &Printer,
    screen: &Screen,
    layers: &[LayerRead],
) -> Result<(), ConvertError> {
    let model = || printer.model.clone();
    let screen_mm = printer.pitch_um.map(|pitch_um| pitch_um / 1e3);
    let is_close = |axis: usize| {
        let (own, other) = (screen_mm[axis], screen.pitch_mm[axis]);
        (own - other).abs() <= SAME_PITCH * own
    };
    if printer.pixels != screen.pixels || !is_close(0) || !is_close(1) {
        return Err(ConvertError::OtherScreen {
            model: model(),
            pixels: screen.pixels,
            pixel_mm: screen.pitch_mm,
            screen: printer.pixels,
            screen_mm,
        });
    }
    let height_mm = layers.last().map_or(0.0, |layer| layer.z_mm);
    if height_mm > printer.volume_mm[2] + SAME_MM {
        return Err(ConvertError::TooHigh {
            model: model(),
            height_mm,
            greatest_mm: printer.volume_mm[2],
        });
    }
    let [least_mm, greatest_mm] = printer.layer_mm;
    let is_printed = |layer: &&LayerRead| {
        (least_mm - SAME_MM..=greatest_mm + SAME_MM).contains(&layer.thickness_mm)
    };
    match layers.iter().position(|layer| !is_printed(&layer)) {
        Some(place) => Err(ConvertError::Thickness {
            model: model(),
            layer: place + 1,
            thickness_mm: layers[place].thickness_mm,
            range_mm: printer.layer_mm,
        }),
        None => Ok(()),
    }
}

/// A picture in the greys of its colours.
fn preview_scene(preview: &Preview) -> PreviewScene {
    let pixels = preview.rgb.chunks_exact(3);
    // As bright as its colours look: ITU-R BT.601.
    let greys = pixels.map(|rgb| {
        let [red, green, blue] = [rgb[0], rgb[1], rgb[2]].map(u32::from);
        ((299 * red + 587 * green + 114 * blue) / 1000) as u8
    });
    PreviewScene::from_picture([preview.width, preview.height], [1.0; 2], greys.collect())
}

impl RunSource for Conversion<'_> {
    fn reader(&self) -> Box<dyn RunReader + '_> {
        Box::new(Reader {
            conversion: self,
            next: 0,
        })
    }
}

struct Reader<'a> {
    conversion: &'a Conversion<'a>,
    next: usize,
}

impl RunReader for Reader<'_> {
    fn next(&mut self, layers: usize) -> LayerRuns {
        let range = self.next..self.next + layers;
        self.next = range.end;
        let conversion = self.conversion;
        LayerRuns::new(parallel::map(range.collect(), |layer| {
            conversion.runs(layer)
        }))
    }
}

impl Conversion<'_> {
    /// The runs of a layer, turned the way that the new file has them.
    fn runs(&self, layer: usize) -> Vec<Run> {
        let [width, height] = self.file.metadata().pixels;
        let mut collector = Collector::new(width);
        let decoded = self
            .file
            .runs(layer, &mut |grey, count| collector.run(grey, count));
        decoded.expect("a layer that was decoded before");
        let Flips {
            mut mirror_x,
            mirror_y,
            exchange,
        } = self.flips;
        let mut runs = collector.runs;
        if exchange {
            turn(&mut runs, [width, height], [mirror_x, mirror_y]);
            runs = exchanged(&runs, [width, height]);
            turn(&mut runs, [height, width], [self.screen.is_mirrored, false]);
        } else {
            mirror_x ^= self.screen.is_mirrored;
            turn(&mut runs, [width, height], [mirror_x, mirror_y]);
        }
        runs
    }
}

/// Collects lit runs, cut at the ends of rows and as long as can be.
struct Collector {
    width: u32,
    next: u32,
    runs: Vec<Run>,
}

impl Collector {
    fn new(width: u32) -> Self {
        Self {
            width,
            next: 0,
            runs: Vec::new(),
        }
    }

    fn run(&mut self, grey: u8, mut count: u32) {
        while grey > 0 && count > 0 {
            let column = self.next % self.width;
            let pixels = count.min(self.width - column);
            match self.runs.last_mut() {
                Some(last)
                    if column > 0 && last.grey == grey && last.first + last.pixels == self.next =>
                {
                    last.pixels += pixels;
                }
                _ => self.runs.push(Run {
                    first: self.next,
                    pixels,
                    grey,
                }),
            }
            self.next += pixels;
            count -= pixels;
        }
        self.next += count;
    }
}

/// Mirrors runs in x or y.
fn turn(runs: &mut [Run], [width, height]: [u32; 2], [mirror_x, mirror_y]: [bool; 2]) {
    if !mirror_x && !mirror_y {
        return;
    }
    for run in &mut *runs {
        let (mut row, mut column) = (run.first / width, run.first % width);
        if mirror_x {
            column = width - column - run.pixels;
        }
        if mirror_y {
            row = height - 1 - row;
        }
        run.first = row * width + column;
    }
    runs.sort_unstable_by_key(|run| run.first);
}

/// Runs whose columns are along y and whose rows are along x, as runs with columns along x.
fn exchanged(runs: &[Run], [width, height]: [u32; 2]) -> Vec<Run> {
    let mut greys = vec![0u8; width as usize * height as usize];
    for run in runs {
        let row = run.first / width;
        for column in run.first % width..run.first % width + run.pixels {
            let place = (width - 1 - column) * height + (height - 1 - row);
            greys[place as usize] = run.grey;
        }
    }
    let mut collector = Collector::new(height);
    for equal in greys.chunk_by(|a, b| a == b) {
        collector.run(equal[0], equal.len() as u32);
    }
    collector.runs
}

#[cfg(test)]
mod tests {
    use super::{Collector, exchanged, turn};

    const SIZE: [u32; 2] = [5, 3];
    const PICTURE: [u8; 15] = [0, 9, 9, 0, 7, 7, 0, 0, 1, 1, 1, 1, 0, 0, 5];

    fn runs(greys: &[u8], width: u32) -> Vec<crate::mask::Run> {
        let mut collector = Collector::new(width);
        for &grey in greys {
            collector.run(grey, 1);
        }
        collector.runs
    }

    #[test]
    fn pixels_are_where_their_mirror_image_was() {
        for mirror_x in [false, true] {
            for mirror_y in [false, true] {
                let mut turned = runs(&PICTURE, 5);
                turn(&mut turned, SIZE, [mirror_x, mirror_y]);
                let expected: Vec<u8> = (0..15)
                    .map(|place| {
                        let (row, column) = (place / 5, place % 5);
                        let row = if mirror_y { 2 - row } else { row };
                        let column = if mirror_x { 4 - column } else { column };
                        PICTURE[row * 5 + column]
                    })
                    .collect();
                assert_eq!(turned, runs(&expected, 5), "{mirror_x} {mirror_y}");
            }
        }
    }

    #[test]
    fn columns_become_rows() {
        // The last column, from the last row up, is the first row.
        let expected = [5, 1, 7, 0, 1, 0, 0, 0, 9, 1, 0, 9, 1, 7, 0];
        assert_eq!(exchanged(&runs(&PICTURE, 5), SIZE), runs(&expected, 3));
    }
}
