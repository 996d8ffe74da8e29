//! Settings from a file: TOML with the names of [`Options`], and paths relative to the file.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use cusp_slicer::job::Options;
use cusp_slicer::misnamed::with_nearest;
use serde::Deserialize as _;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

use crate::failure::{Failure, in_file};
use crate::files::{printer_choice, read_resin};

/// Contents of a file of settings; defaults for the rest.
#[derive(Default)]
pub struct SettingsFile {
    pub options: Options,
    /// The file of weights.
    pub weights: Option<PathBuf>,
}

/// Reads a file of settings.
pub fn read(path: &Path) -> Result<SettingsFile, Failure> {
    let text = fs::read_to_string(path).map_err(|error| in_file(path, &error))?;
    let wrong = |span: Option<Range<usize>>, reason: &str| -> Failure {
        let line = span.map(|span| text[..span.start.min(text.len())].matches('\n').count() + 1);
        let line = line.map_or(String::new(), |line| format!("line {line}: "));
        in_file(path, &format!("{line}{reason}")).into()
    };
    let in_toml = |error: &toml::de::Error| wrong(error.span(), &with_nearest(error.message()));
    let mut table = DeTable::parse(&text).map_err(|error| in_toml(&error))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    // These three may be files.
    let weights = take_path(&mut table, "weights", |value| !value.is_empty());
    let resin = take_path(&mut table, "resin", |_| true);
    let printer = take_path(&mut table, "printer", is_json);
    if let Some(value) = table.get_ref().get("weights") {
        let reason = "`weights` is the path of a file of weights, as text";
        return Err(wrong(Some(value.span()), reason));
    }
    let mut options =
        Options::deserialize(Deserializer::from(table)).map_err(|error| in_toml(&error))?;
    if let Some(resin) = resin {
        options.resin = read_resin(Some(&folder.join(resin)))?;
    }
    if let Some(printer) = printer {
        options.printer = Some(printer_choice(&folder.join(printer).to_string_lossy())?);
    }
    Ok(SettingsFile {
        options,
        weights: weights.map(|weights| folder.join(weights)),
    })
}

/// Takes a text that names a file out of the table.
fn take_path(
    table: &mut Spanned<DeTable<'_>>,
    name: &str,
    names_file: impl Fn(&str) -> bool,
) -> Option<String> {
    let value = table.get_ref().get(name).map(Spanned::get_ref);
    let text = value.and_then(DeValue::as_str)?.to_owned();
    if !names_file(&text) {
        return None;
    }
    table.get_mut().remove(name);
    Some(text)
}

fn is_json(text: &str) -> bool {
    Path::new(text)
        .extension()
        .is_some_and(|extension| extension == "json")
}
