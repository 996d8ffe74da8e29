//! Metric profiles: the error density along z, one value per bin (section 3.1), for six metrics and from two sources.

pub mod area;
mod creases;
pub mod cusp;
pub mod deviation;
pub mod facet_bins;
pub mod filament_roundness;
mod hidden;
pub mod largest;
pub mod normal_cones;
pub mod roughness;
pub mod section;
pub(crate) mod shapes;
pub mod snap_planes;
pub mod steepest;
pub mod volume;
pub mod weighted;

use serde::{Deserialize, Serialize};

use crate::grid::Bins;
use deviation::{DeviationError, DeviationsAbove};
use largest::{LargestAbove, LargestError};
use volume::VolumeError;

/// Metric of a profile.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Metric {
    /// Cusp height, in millimetres (eq. 3 to 6).
    #[default]
    Cusp,
    /// Distance from the print to the model, in millimetres: see [`deviation`].
    Deviation,
    /// Cusp height with the roundness of filament, in millimetres: see [`filament_roundness`].
    #[serde(rename = "filament-roundness", alias = "thread")]
    #[cfg_attr(feature = "cli", value(name = "filament-roundness", alias = "thread"))]
    FilamentRoundness,
    /// Surface roughness Ra, in millimetres (eq. 7 to 10).
    Roughness,
    /// Area deviation, a fraction (eq. 11 to 14).
    Area,
    /// Volume deviation, in mm³ (eq. 15 to 20).
    Volume,
}

impl Metric {
    /// All metrics.
    pub const ALL: [Self; 6] = [
        Self::Cusp,
        Self::Deviation,
        Self::FilamentRoundness,
        Self::Roughness,
        Self::Area,
        Self::Volume,
    ];

    /// The row of the metric: a new one is a file with a row, and a line here.
    fn row(self) -> &'static Row {
        match self {
            Self::Cusp => &cusp::ROW,
            Self::Deviation => &deviation::ROW,
            Self::FilamentRoundness => &filament_roundness::ROW,
            Self::Roughness => &roughness::ROW,
            Self::Area => &area::ROW,
            Self::Volume => &volume::ROW,
        }
    }

    /// The name of the metric, as in reports.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// Returns true if it is computed from normal cones.
    pub fn needs_cones(self) -> bool {
        matches!(self.row().error, ErrorRule::Deviation)
    }

    /// Returns true if it is computed from the areas of sections.
    pub fn needs_areas(self) -> bool {
        matches!(self.row().error, ErrorRule::Area | ErrorRule::Volume)
    }

    /// Returns true if its errors are distances of the print from the model.
    pub fn is_distance(self) -> bool {
        self.row().is_distance
    }

    /// The unit of its errors and tolerances; empty for a fraction.
    pub fn unit(self) -> &'static str {
        self.row().unit
    }

    /// The default tolerance, in the metric's unit.
    pub fn default_tolerance(self) -> f64 {
        self.row().default_tolerance
    }

    /// Usual tolerances, from and to, in the metric's unit. Forms take no others; the core takes all that [`Quantity::Tolerance`] allows.
    ///
    /// [`Quantity::Tolerance`]: crate::quantity::Quantity::Tolerance
    pub(crate) fn tolerances(self) -> [f64; 2] {
        self.row().tolerances
    }

    /// The greatest density; `None` if it depends on the model.
    pub(crate) fn greatest_density(self) -> Option<f32> {
        self.row().greatest_density
    }

    /// Formats an error or tolerance with its unit, to at most four decimals; a fraction is shown as a percentage.
    pub fn format(self, error: f64) -> String {
        let (number, unit) = match self {
            Self::Area => (error * 100.0, "%"),
            metric => (error, metric.unit()),
        };
        let decimals = match number {
            number if number >= 10.0 => 1,
            number if number >= 1.0 => 2,
            _ => 4,
        };
        format!("{number:.decimals$} {unit}")
    }
}

/// Everything that distinguishes a metric from others, except its words.
struct Row {
    /// Name in options and reports.
    name: &'static str,
    /// Unit of errors and tolerances; empty for a fraction, which is shown as a percentage.
    unit: &'static str,
    /// Default tolerance on resin printers, in that unit.
    default_tolerance: f64,
    /// Usual tolerances, from and to: the last is the error of a layer of 1 mm, or more than any model's.
    tolerances: [f64; 2],
    /// Greatest density; `None` if it depends on the model.
    greatest_density: Option<f32>,
    /// True if errors are distances of the print from the model.
    is_distance: bool,
    error: ErrorRule,
}

/// Rule for the error of a layer.
enum ErrorRule {
    /// The sum of a density of the steepest surface in each bin.
    Slope(&'static dyn SlopeDensity),
    /// The sum of [`area::density`].
    Area,
    /// [`VolumeError`].
    Volume,
    /// [`DeviationError`].
    Deviation,
}

/// A density that depends on the slope of the surface alone.
trait SlopeDensity: Sync {
    /// The density of a surface with this `n_z²`.
    fn of(&self, square: f32) -> f32;

    /// The density of a bin without any surface.
    fn without(&self) -> f32 {
        0.0
    }

    /// The density of each bin from its largest `n_z²`. Compiled for each density, so that its loop is vectorised.
    fn densities(&self, steepest: &[f32]) -> Vec<f32> {
        steepest::densities(steepest, self.without(), |square| self.of(square))
    }
}

/// Source of a profile.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Source {
    /// Every facet: the tolerance holds on the mesh.
    #[default]
    Exact,
    /// The hits of the LDI, as in section 3.2: what rays miss is not seen. Planes at sharp changes are those of every facet, as rays miss
    /// upright walls.
    Sampled,
}

/// The shape of a model along z, from which all metrics are computed.
#[derive(Debug, Clone)]
pub struct Shape {
    /// The bins that the values belong to.
    pub bins: Bins,
    /// The largest `n_z²` of each bin: see [`steepest`].
    pub steepest: Vec<f32>,
    /// The largest `n_z²` of the normal cones of each bin: see [`normal_cones`]. Empty where only other metrics than the deviation
    /// are asked for.
    pub cones: Vec<f32>,
    /// The area of the section at the middle of each bin, in mm²: see [`section`]. Empty unless the metric is the area
    /// or volume deviation.
    pub areas_mm2: Vec<f64>,
}

impl Shape {
    /// The profile of a metric. A metric of areas needs [`Self::areas_mm2`], the deviation [`Self::cones`].
    pub fn profile(&self, metric: Metric) -> Profile {
        let density = match metric.row().error {
            ErrorRule::Slope(slope) => slope.densities(&self.steepest),
            ErrorRule::Deviation => steepest::densities(&self.cones, 0.0, cusp::density_of),
            ErrorRule::Area => area::density(&self.areas_mm2, self.bins),
            ErrorRule::Volume => self.areas_mm2.iter().map(|&area| area as f32).collect(),
        };
        Profile {
            bins: self.bins,
            density,
        }
    }

    /// The errors of layers under a metric.
    pub fn errors(&self, metric: Metric) -> LayerErrors {
        match metric.row().error {
            ErrorRule::Deviation => {
                LayerErrors::Deviation(DeviationError::new(&self.cones, self.bins))
            }
            ErrorRule::Volume => LayerErrors::Volume(VolumeError::new(&self.areas_mm2, self.bins)),
            ErrorRule::Slope(_) | ErrorRule::Area => {
                LayerErrors::Sum(self.profile(metric).error_sum())
            }
        }
    }
}

/// The density of deviation errors along the height of a model, φ̃ (section 3.1).
///
/// The error of a layer is the sum of the densities of its bins times the bin size (eq. 1). The volume deviation is the
/// exception: its profile is the area of sections (eq. 17). That of the deviation, which is no sum either, is the largest
/// |`n_z`| over normal cones.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// The bins that `density` belongs to.
    pub bins: Bins,
    /// φ̃, one value per bin from the plate upward: error per millimetre of thickness, or mm² for the volume deviation.
    pub density: Vec<f32>,
}

/// Steps of an error sum per bin of density 1, about the precision of a density.
const STEPS_PER_BIN: f64 = 1e7;

impl Profile {
    /// The running sum of errors, which gives the error of any layer in constant time.
    pub fn error_sum(&self) -> ErrorSum {
        let mut total = 0;
        let mut sums = Vec::with_capacity(self.density.len() + 1);
        sums.push(0);
        for &density in &self.density {
            // Signed, which is one instruction on x86-64.
            total += ((f64::from(density) * STEPS_PER_BIN + 0.5) as i64).cast_unsigned();
            sums.push(total);
        }
        ErrorSum {
            bins: self.bins,
            sums,
        }
    }
}

/// The error below each bin boundary, in whole ten-millionths of a bin of density 1, so that sums are exact.
#[derive(Debug, Clone)]
pub struct ErrorSum {
    bins: Bins,
    sums: Vec<u64>,
}

impl ErrorSum {
    /// The error of the layer between two boundaries in steps, `ε_k` of eq. 1.
    #[inline]
    pub fn steps_between(&self, lower: u32, upper: u32) -> u64 {
        self.steps_below(upper) - self.steps_below(lower)
    }

    fn split(&self, parts: usize) -> Self {
        let mut total = 0;
        let mut sums = vec![total];
        for pair in self.sums.windows(2) {
            // A step is a part of a bin, so it becomes as much smaller as the bin.
            let density = pair[1] - pair[0];
            sums.extend((0..parts).map(|_| {
                total += density;
                total
            }));
        }
        Self {
            bins: self.bins.split(parts),
            sums,
        }
    }

    /// The error of everything below a boundary, in steps. Above the last bin nothing is added.
    pub fn steps_below(&self, boundary: u32) -> u64 {
        self.sums[(boundary as usize).min(self.bins.count)]
    }
}

/// Each value as often as a bin has parts.
fn repeated<T: Copy>(values: &[T], parts: usize) -> Vec<T> {
    let values = values.iter();
    values
        .flat_map(|&it| std::iter::repeat_n(it, parts))
        .collect()
}

/// The errors of layers as planners see them. They are whole steps, so every planner on every machine agrees on whether
/// a layer is within tolerance.
#[derive(Debug, Clone)]
pub enum LayerErrors {
    /// A sum over the bins of the layer.
    Sum(ErrorSum),
    /// The volume deviation, which depends on where the layer begins.
    Volume(VolumeError),
    /// The deviation, which depends on where the layer begins and ends.
    Deviation(DeviationError),
    /// The largest over several models.
    Largest(LargestError),
}

impl LayerErrors {
    /// The bins that layers consist of.
    pub fn bins(&self) -> Bins {
        match self {
            Self::Sum(errors) => errors.bins,
            Self::Volume(errors) => errors.bins,
            Self::Deviation(errors) => errors.bins,
            Self::Largest(errors) => errors.bins(),
        }
    }

    /// The same errors in finer bins, each bin divided into `parts` that have its density, shape or area.
    #[must_use]
    pub fn split(&self, parts: usize) -> Self {
        match self {
            Self::Sum(errors) => Self::Sum(errors.split(parts)),
            Self::Volume(errors) => Self::Volume(errors.split(parts)),
            Self::Deviation(errors) => Self::Deviation(errors.split(parts)),
            Self::Largest(errors) => Self::Largest(errors.split(parts)),
        }
    }

    /// Returns true if errors never shrink as a layer grows at either end.
    pub fn is_monotone(&self) -> bool {
        match self {
            Self::Sum(_) => true,
            Self::Volume(_) | Self::Deviation(_) => false,
            Self::Largest(errors) => errors.is_monotone(),
        }
    }

    /// The error of the layer between two boundaries, in steps. Above the last bin nothing is added.
    #[inline]
    pub fn steps_between(&self, lower: u32, upper: u32) -> u64 {
        match self {
            Self::Sum(errors) => return errors.steps_between(lower, upper),
            Self::Largest(errors) => return errors.steps_between(lower, upper),
            Self::Volume(_) | Self::Deviation(_) => {}
        }
        match self.layers_above(lower, u64::MAX).up_to(upper) {
            Reach::Within(error) => error,
            // Nothing exceeds this tolerance.
            Reach::Beyond | Reach::BeyondFromHere => u64::MAX,
        }
    }

    /// The layers that begin at a boundary, held against a tolerance in steps.
    pub fn layers_above(&self, lower: u32, tolerance: u64) -> LayersAbove<'_> {
        LayersAbove {
            lower,
            tolerance,
            errors: match self {
                Self::Sum(errors) => ErrorsAbove::Sum(errors),
                Self::Volume(errors) => ErrorsAbove::Volume(errors, lower, 0),
                Self::Deviation(errors) => ErrorsAbove::Deviation(errors.above(lower, tolerance)),
                Self::Largest(errors) => ErrorsAbove::Largest(errors.above(lower, tolerance)),
            },
        }
    }

    fn steps_per_unit(&self) -> f64 {
        match self {
            Self::Sum(ErrorSum { bins, .. }) | Self::Deviation(DeviationError { bins, .. }) => {
                STEPS_PER_BIN / bins.size_mm
            }
            Self::Volume(errors) => errors.steps_per_mm3(),
            Self::Largest(errors) => errors.tallest().steps_per_unit(),
        }
    }

    /// A number of steps in the metric's unit.
    pub fn to_value(&self, steps: u64) -> f64 {
        steps as f64 / self.steps_per_unit()
    }

    /// The number of steps nearest to an error in the metric's unit.
    pub fn to_steps(&self, error: f64) -> u64 {
        (error * self.steps_per_unit() + 0.5) as u64
    }
}

/// The layers that begin at the same boundary, asked for from the thinnest to the thickest.
#[derive(Debug)]
pub struct LayersAbove<'a> {
    lower: u32,
    tolerance: u64,
    errors: ErrorsAbove<'a>,
}

#[derive(Debug)]
enum ErrorsAbove<'a> {
    Sum(&'a ErrorSum),
    /// With the boundary up to which errors have been added up, and their sum.
    Volume(&'a VolumeError, u32, u64),
    Deviation(DeviationsAbove<'a>),
    Largest(LargestAbove<'a>),
}

/// Result of measuring a layer against the tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reach {
    /// It is, with this error in steps.
    Within(u64),
    /// It is not, but a thicker one may be.
    Beyond,
    /// Neither it nor any thicker one is.
    BeyondFromHere,
}

impl LayersAbove<'_> {
    /// The layer that ends at `upper`.
    pub fn up_to(&mut self, upper: u32) -> Reach {
        let error = match &mut self.errors {
            ErrorsAbove::Sum(errors) => errors.steps_between(self.lower, upper),
            ErrorsAbove::Volume(errors, measured, error) => {
                let added = (*measured..upper).map(|bin| errors.steps_of(self.lower, bin));
                *error = added.fold(*error, u64::saturating_add);
                *measured = upper;
                *error
            }
            ErrorsAbove::Deviation(deviations) => return deviations.up_to(upper),
            ErrorsAbove::Largest(largest) => return largest.up_to(upper),
        };
        if error <= self.tolerance {
            Reach::Within(error)
        } else {
            Reach::BeyondFromHere
        }
    }
}
