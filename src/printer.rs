//! Printers, as data: those known by name in `printers.json`, and those that users describe the same way.

use std::sync::{Arc, LazyLock};

use serde::{Deserialize, Deserializer, Serialize, de};

use crate::compensation::Compensation;
use crate::format::{Format, FormatThicknesses};
use crate::grid::MAX_SIDE;

/// A resin printer: its screen, its build volume and the file that it takes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(deny_unknown_fields)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "facts that have nothing to do with one another"
)]
pub struct Printer {
    /// Its name in options, as in `--printer NAME`.
    #[serde(default = "own")]
    pub name: String,
    /// Make and model.
    #[serde(default = "own")]
    pub model: String,
    /// Its name in its own files, where that is not make and model.
    #[serde(default)]
    pub machine: Option<String>,
    /// Columns and rows of the masks.
    pub pixels: [u32; 2],
    /// Sides of a pixel in x and y, in micrometres.
    pub pitch_um: [f64; 2],
    /// Build volume in x, y and z, in millimetres.
    pub volume_mm: [f64; 3],
    /// True if masks are mirrored left to right, because the screen lights the resin from below.
    #[serde(default = "yes")]
    pub is_mirrored: bool,
    /// Minimum and maximum layer thickness in millimetres.
    #[serde(default = "any_layer")]
    pub layer_mm: [f64; 2],
    /// Motor step in millimetres: every height is a multiple of it.
    #[serde(default = "usual_step")]
    pub step_mm: f64,
    /// The print format to write for it: one that it reads, or one that other programs convert to one that it reads.
    #[serde(default)]
    pub format: Format,
    /// The version of that format, where it has several: 516, 517 or 518 of `photon-workshop`.
    #[serde(default)]
    pub file_version: Option<u32>,
    /// True if numbers in its files begin with the lowest byte, unlike those of other printers.
    #[serde(default)]
    pub is_little_endian: bool,
    /// True if the vat tilts to release a layer, in place of a lift.
    #[serde(default)]
    pub has_tilting_vat: bool,
    /// True if it reads `format` without a converter.
    #[serde(default = "yes")]
    pub reads_format: bool,
    /// Extensions of the files that it reads, the most common first.
    #[serde(default)]
    pub reads: Vec<String>,
    /// Ability to print layers of several thicknesses.
    #[serde(default)]
    pub variable_layers: VariableLayers,
    /// Source of that statement.
    #[serde(default)]
    pub variable_layers_source: String,
    /// Compensation for prints larger than their masks, whatever the resin.
    #[serde(default, alias = "growth")]
    pub compensation: Compensation,
    /// Pull of its film per area at a disc of 20 mm, in kPa, for supports whose sizes state none.
    #[serde(default)]
    pub film_kpa: Option<f64>,
    /// True if a grey pixel gets light in proportion to its brightness, as measured. Anti-aliased masks then put cured bottoms between those
    /// of layers.
    #[serde(default)]
    pub proportional_greys: bool,
}

/// Largest pull of a film: that of a vacuum.
const MOST_FILM_KPA: f64 = 101.0;

/// Ability of a printer to print layers of several thicknesses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum VariableLayers {
    /// It moves to the height of each layer.
    Yes,
    /// It takes one thickness for all layers, or fails.
    No,
    /// Unknown: `cusp calibrate layers` makes a print that shows it.
    #[default]
    Untried,
}

impl VariableLayers {
    /// Its name, as in descriptions of printers.
    pub fn name(self) -> &'static str {
        match self {
            Self::Yes => "yes",
            Self::No => "no",
            Self::Untried => "untried",
        }
    }
}

fn own() -> String {
    "own printer".to_owned()
}

fn yes() -> bool {
    true
}

/// Layer thicknesses of printers whose makers state no limits.
fn any_layer() -> [f64; 2] {
    [0.01, 0.2]
}

/// The motor step of common z drives.
fn usual_step() -> f64 {
    0.002
}

impl Printer {
    /// The name in the printer's own files.
    pub fn machine(&self) -> &str {
        self.machine.as_deref().unwrap_or(&self.model)
    }

    /// Checks the bounds that the types do not.
    ///
    /// # Errors
    /// The name of the field that is out of bounds.
    pub fn check(&self) -> Result<(), &'static str> {
        let is_positive = |numbers: &[f64]| numbers.iter().all(|it| *it > 0.0 && it.is_finite());
        let [layer_min_mm, layer_max_mm] = self.layer_mm;
        let rules = [
            (
                "pixels",
                self.pixels.iter().all(|side| (1..=MAX_SIDE).contains(side)),
            ),
            ("pitch_um", is_positive(&self.pitch_um)),
            ("volume_mm", is_positive(&self.volume_mm)),
            (
                "layer_mm",
                is_positive(&self.layer_mm) && layer_min_mm <= layer_max_mm,
            ),
            ("step_mm", is_positive(&[self.step_mm])),
            (
                "file_version",
                self.file_version
                    .is_none_or(|version| (516..=518).contains(&version)),
            ),
            ("compensation", self.compensation.check().is_ok()),
            (
                "film_kpa",
                self.film_kpa
                    .is_none_or(|film_kpa| (0.0..=MOST_FILM_KPA).contains(&film_kpa)),
            ),
            (
                "reads",
                self.reads.iter().all(|extension| is_extension(extension)),
            ),
        ];
        match rules.into_iter().find(|(_, holds)| !holds) {
            Some((field, _)) => Err(field),
            None => Ok(()),
        }
    }
}

/// Returns true if this can end the name of a file: no path, no dot.
fn is_extension(text: &str) -> bool {
    !text.is_empty()
        && text
            .bytes()
            .all(|it| it.is_ascii_lowercase() || it.is_ascii_digit())
}

/// Reason for which layers of several thicknesses cannot be printed from a file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Refusal<'a> {
    /// The format has one thickness for all layers.
    Format(Format),
    /// The printer takes one thickness for all layers.
    Printer(&'a Printer),
}

/// Checks that a file of `format` for `printer` can have layers of these thicknesses.
///
/// # Errors
/// [`Refusal`].
pub fn check_thicknesses<'a>(
    format: Format,
    printer: Option<&'a Printer>,
    thickness_mm: &[f64],
) -> Result<(), Refusal<'a>> {
    let one_of_printer = printer.filter(|printer| {
        printer.format == format && printer.variable_layers == VariableLayers::No
    });
    let (first, refusal) = match (format.thicknesses(), one_of_printer) {
        (FormatThicknesses::OneAboveFirst, _) => (1, Refusal::Format(format)),
        (FormatThicknesses::One, _) => (0, Refusal::Format(format)),
        (FormatThicknesses::Any, Some(printer)) => (0, Refusal::Printer(printer)),
        (FormatThicknesses::Any, None) => return Ok(()),
    };
    if are_equal(thickness_mm.get(first..).unwrap_or_default()) {
        Ok(())
    } else {
        Err(refusal)
    }
}

/// Returns true if all layers have the same thickness.
pub fn are_equal(thickness_mm: &[f64]) -> bool {
    thickness_mm.windows(2).all(|pair| pair[0] == pair[1])
}

/// All printers known by name, by maker and model.
pub static PRINTERS: LazyLock<Vec<Arc<Printer>>> = LazyLock::new(|| {
    let json = include_str!("printers.json");
    serde_json::from_str::<Vec<Printer>>(json)
        .map(|printers| printers.into_iter().map(Arc::new).collect())
        .expect("printers.json is valid, as a test shows")
});

/// The format of print files that end in this extension, without its dot: those of printers that read them, or those that the
/// format has. Where there are several, the first of [`Format::all`].
pub fn format_of(extension: &str) -> Option<Format> {
    let extension = extension.to_ascii_lowercase();
    let by_name = Format::all().find(|format| format.extension() == extension);
    by_name.or_else(|| {
        let mut readers = PRINTERS.iter().filter(|printer| printer.reads_format);
        let reader = readers.find(|printer| printer.reads.contains(&extension));
        reader.map(|printer| printer.format)
    })
}

/// The printer with this name.
pub fn named(name: &str) -> Option<Arc<Printer>> {
    let printer = PRINTERS.iter().find(|printer| printer.name == name);
    printer.cloned()
}

/// Up to five known names that share a word with this one, those that share the most first.
pub fn similar(name: &str) -> Vec<String> {
    const MOST: usize = 5;
    let name = name.to_ascii_lowercase();
    let words = |name: &'_ str| -> Vec<String> {
        let words = name.split(|it: char| !it.is_ascii_alphanumeric());
        words
            .filter(|word| word.len() > 1)
            .map(str::to_owned)
            .collect()
    };
    let asked = words(&name);
    let shared = |printer: &Printer| {
        let model = words(&printer.model.to_ascii_lowercase());
        asked.iter().filter(|word| model.contains(word)).count()
    };
    let by_shared = (1..=asked.len()).rev();
    let similar = by_shared.flat_map(|count| {
        let printers = PRINTERS.iter();
        printers.filter(move |printer| shared(printer) == count)
    });
    similar
        .take(MOST)
        .map(|printer| printer.name.clone())
        .collect()
}

/// The printer of options: the name of a known one, or a description of one's own.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(untagged)]
pub enum PrinterChoice {
    /// One of [`PRINTERS`].
    Named(String),
    /// One's own.
    Own(Arc<Printer>),
}

impl From<&str> for PrinterChoice {
    fn from(name: &str) -> Self {
        Self::Named(name.to_owned())
    }
}

impl<'de> Deserialize<'de> for PrinterChoice {
    /// By hand, because serde's own choice between the two would hide which field of a description is wrong.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor;

        impl<'de> de::Visitor<'de> for Visitor {
            type Value = PrinterChoice;

            fn expecting(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                formatter.write_str("a printer's name or description")
            }

            fn visit_str<E>(self, name: &str) -> Result<PrinterChoice, E> {
                Ok(PrinterChoice::Named(name.to_owned()))
            }

            fn visit_map<A: de::MapAccess<'de>>(self, map: A) -> Result<PrinterChoice, A::Error> {
                let printer = Printer::deserialize(de::value::MapAccessDeserializer::new(map))?;
                Ok(PrinterChoice::Own(Arc::new(printer)))
            }
        }

        deserializer.deserialize_any(Visitor)
    }
}
