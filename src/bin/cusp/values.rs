//! Values of arguments, as text.

use std::ffi::OsStr;
use std::path::PathBuf;

use clap::builder::{PossibleValue, StringValueParser, TypedValueParser};
use clap::{Arg, Command};
use cusp_slicer::job::Planner;
use cusp_slicer::mask::LEVELS;
use cusp_slicer::orientation::Terms;
use cusp_slicer::orientation::shard::Shard;
use cusp_slicer::plan::HeightRange;
use cusp_slicer::prepare::Drain;
use cusp_slicer::printer::PRINTERS;

/// The names of printers, which shells complete; other text is a file, or is refused with the names that are like it.
#[derive(Clone)]
pub struct PrinterName;

impl TypedValueParser for PrinterName {
    type Value = String;

    fn parse_ref(
        &self,
        command: &Command,
        argument: Option<&Arg>,
        value: &OsStr,
    ) -> Result<String, clap::Error> {
        StringValueParser::new().parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue>>> {
        let known = PRINTERS.iter();
        let values = known.map(|it| PossibleValue::new(&*it.name).help(&*it.model));
        Some(Box::new(values))
    }
}

/// Parses a positive length.
pub fn length(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        _ => Err("expected a positive number of millimetres".to_owned()),
    }
}

/// Parses `P` or `PxQ`.
pub fn pitch(text: &str) -> Result<[f64; 2], String> {
    match text.split_once(['x', 'X', '×']) {
        Some((x, y)) => Ok([length(x)?, length(y)?]),
        None => Ok([length(text)?; 2]),
    }
}

/// Parses `X,Y,Z,W`.
pub fn rotation(text: &str) -> Result<[f64; 4], String> {
    let parts = text.split(',').map(|part| part.trim().parse::<f64>());
    let parts: Result<Vec<f64>, _> = parts.collect();
    let parts = parts.ok().and_then(|parts| parts.try_into().ok());
    parts.ok_or_else(|| "expected a quaternion of four numbers: X,Y,Z,W".to_owned())
}

/// A drain hole, or as many as are needed.
#[derive(Clone, Copy)]
pub enum DrainArg {
    Auto,
    At(Drain),
}

/// A size by its name, as `spacing_mm=2.5`.
pub fn size(text: &str) -> Result<(String, f64), String> {
    let parts = text.split_once('=');
    let parts = parts.and_then(|(name, size)| Some((name.trim(), size.trim().parse().ok()?)));
    parts
        .filter(|&(_, size): &(&str, f64)| size.is_finite())
        .map(|(name, size)| (name.to_owned(), size))
        .ok_or_else(|| "give a name and a number, as spacing_mm=2.5".to_owned())
}

/// The index of a term of energies and its weight, as `islands=3`.
pub fn rank(text: &str) -> Result<(usize, f64), String> {
    let of = |name: &str| Terms::NAMES.iter().position(|&it| it == name.trim());
    let parts = text.split_once('=');
    let parts = parts.and_then(|(name, weight)| Some((of(name)?, weight.trim().parse().ok()?)));
    parts
        .filter(|&(_, weight): &(usize, f64)| (0.0..=f64::MAX).contains(&weight))
        .ok_or_else(|| {
            let names = Terms::NAMES.join(", ");
            format!("give a name and a weight, as islands=3; the names are {names}")
        })
}

/// Parses `auto`, or `X,Y,Z,DX,DY,DZ,DIAMETER`.
pub fn drain(text: &str) -> Result<DrainArg, String> {
    if text == "auto" {
        return Ok(DrainArg::Auto);
    }
    let parts = text.split(',').map(|part| part.trim().parse::<f64>());
    let parts: Option<Vec<f64>> = parts.collect::<Result<_, _>>().ok();
    let is_finite = |parts: &Vec<f64>| parts.iter().all(|it| it.is_finite());
    match parts.filter(is_finite).as_deref() {
        Some(&[x, y, z, dx, dy, dz, diameter_mm]) if [dx, dy, dz] != [0.0; 3] => {
            Ok(DrainArg::At(Drain {
                at_mm: [x, y, z],
                direction: [dx, dy, dz],
                diameter_mm,
                depth_mm: None,
            }))
        }
        _ => Err(
            "expected auto, or seven numbers: a point, a direction that is not zero, and a diameter"
                .to_owned(),
        ),
    }
}

/// Parses the name of a mesh that other programs read.
pub fn mesh_file(text: &str) -> Result<PathBuf, String> {
    named_file(text, &["stl", "3mf"])
}

/// Parses the name of an STL file.
pub fn stl_file(text: &str) -> Result<PathBuf, String> {
    named_file(text, &["stl"])
}

/// A file whose name ends in one of some ways.
fn named_file(text: &str, extensions: &[&str]) -> Result<PathBuf, String> {
    let file = PathBuf::from(text);
    let extension = file.extension().unwrap_or_default();
    if extensions
        .iter()
        .any(|it| extension.eq_ignore_ascii_case(it))
    {
        return Ok(file);
    }
    Err(format!(
        "expected a name that ends in .{}",
        extensions.join(" or .")
    ))
}

/// Parses an anti-aliasing level.
pub fn antialias(text: &str) -> Result<u32, String> {
    let level = text.parse().ok().filter(|level| LEVELS.contains(level));
    level.ok_or_else(|| format!("expected one of the levels {LEVELS:?}"))
}

/// Parses a number that is 0 or more.
pub fn not_negative(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number >= 0.0 && number.is_finite() => Ok(number),
        _ => Err("expected a number that is 0 or more".to_owned()),
    }
}

/// Parses a positive number.
pub fn positive(text: &str) -> Result<f64, String> {
    length(text).map_err(|_| "expected a positive number".to_owned())
}

/// Parses the thickness of uniform layers.
pub fn uniform_layer(text: &str) -> Result<Planner, String> {
    match text {
        "finest" => Ok(Planner::Finest),
        "coarsest" => Ok(Planner::Coarsest),
        _ => Ok(Planner::Uniform {
            layer_mm: length(text)
                .map_err(|reason| format!("{reason}, or `finest` or `coarsest`"))?,
        }),
    }
}

/// Parses `Z0:Z1=MIN:MAX`.
pub fn height_range(text: &str) -> Result<HeightRange, String> {
    let pair = |text: &str| {
        let (first, second) = text.split_once(':')?;
        Some((first.trim().parse().ok()?, second.trim().parse().ok()?))
    };
    text.split_once('=')
        .and_then(|(heights, layers)| {
            let ((from_mm, to_mm), (layer_min_mm, layer_max_mm)) = (pair(heights)?, pair(layers)?);
            Some(HeightRange {
                from_mm,
                to_mm,
                layer_min_mm,
                layer_max_mm,
            })
        })
        .ok_or_else(|| "expected heights and thicknesses in mm, such as 0:5=0.1:0.1".to_owned())
}

/// Parses `WxH`.
pub fn pixels(text: &str) -> Result<[u32; 2], String> {
    text.split_once(['x', 'X', '×'])
        .and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]))
        .filter(|size: &[u32; 2]| !size.contains(&0))
        .ok_or_else(|| "expected columns and rows, such as 3840x2400".to_owned())
}

/// A thickness in mm and the exposure in s measured for it: 0.05=2.4.
pub fn measured(text: &str) -> Result<[f64; 2], String> {
    let pair = text.split_once('=');
    let pair = pair.and_then(|(mm, s)| Some([length(mm).ok()?, positive(s).ok()?]));
    pair.ok_or_else(|| "expected a thickness and its exposure, such as 0.05=2.4".to_owned())
}

/// Parses a number from 0 to 1.
pub fn fraction(text: &str) -> Result<f64, String> {
    let number = text.parse().ok();
    number
        .filter(|number| (0.0..=1.0).contains(number))
        .ok_or_else(|| "expected a number from 0 to 1".to_owned())
}

/// Parses `I/N`.
pub fn shard(text: &str) -> Result<Shard, String> {
    text.split_once('/')
        .and_then(|(number, count)| {
            let shard = Shard {
                number: number.parse().ok()?,
                count: count.parse().ok()?,
            };
            (1..=shard.count).contains(&shard.number).then_some(shard)
        })
        .ok_or_else(|| "expected a shard, from 1/N to N/N".to_owned())
}
