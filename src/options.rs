//! What to slice and how, as users say it.

use serde::{Deserialize, Serialize};

use crate::archive::Format;
use crate::error::Error;
use crate::exposure::Resin;
use crate::grid::Bins;
use crate::mask::Samples;
use crate::mesh::Pose;
use crate::plan::optimal::Objective;
use crate::plan::{HeightRange, Limits, uniform};
use crate::printer::{self, Printer};
use crate::profile::{Metric, Source};

/// Where the LDI is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Backend {
    /// The GPU, unless there is none or it is emulated in software.
    #[default]
    Auto,
    /// The GPU, or an error.
    Gpu,
    /// The CPU.
    Cpu,
}

/// How layers are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase", tag = "kind")]
pub enum Planner {
    /// The fewest layers within tolerance, or the shortest time.
    #[default]
    Optimal,
    /// Layer by layer, as thick as the profile allows; may exceed the tolerance.
    Greedy,
    /// Layer by layer, as thick as the surface at the plane suggests; may exceed the tolerance.
    Local,
    /// Layers of one thickness, whatever their error.
    Uniform {
        /// That thickness in millimetres.
        layer_mm: f64,
    },
    /// Uniform layers of the least thickness.
    Finest,
    /// Uniform layers of the greatest thickness.
    Coarsest,
}

impl Planner {
    /// The name of the planner, as in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Optimal => "optimal",
            Self::Greedy => "greedy",
            Self::Local => "local",
            Self::Uniform { .. } => "uniform",
            Self::Finest => "finest",
            Self::Coarsest => "coarsest",
        }
    }
}

/// What the optimal plan has least of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Minimize {
    /// Layers.
    #[default]
    Layers,
    /// Time: exposures and what comes with each layer.
    Time,
}

/// Whether planes go where flats and sharp changes are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Snap {
    /// Wherever layers add up and stay within tolerance beside them.
    #[default]
    Auto,
    /// Only where that is best.
    Off,
}

/// What to slice and how. All lengths are in millimetres.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(default, deny_unknown_fields)]
pub struct Options {
    /// Turn the model from how it stands in its file: a quaternion x, y, z, w of any length but 0.
    pub rotation: Option<[f64; 4]>,
    /// Scale the model evenly to this height; its own height if absent.
    pub height_mm: Option<f64>,
    /// A printer known by name: see [`crate::printer::PRINTERS`]. It gives all that is absent below.
    pub printer: Option<String>,
    /// Columns and rows of the masks, with the model in the middle; needs `pitch_mm`.
    pub pixels: Option<[u32; 2]>,
    /// Side of a pixel in x; alone, with as many pixels as cover the model.
    pub pitch_mm: Option<f64>,
    /// Side of a pixel in y; that in x if absent.
    pub pitch_y_mm: Option<f64>,
    /// Whether print files have their masks mirrored left to right, as printers want them whose screen lights from below.
    pub mirror: Option<bool>,
    /// The print file.
    pub format: Option<Format>,
    /// Pixels along the model's longer horizontal side where neither is given.
    pub rays: u32,
    /// Rays of a pixel, and parts of a layer, that its grey is averaged over: 1, 2, 4 or 8. With 1 pixels are lit or dark.
    pub antialias: u32,
    /// Least layer thickness.
    pub layer_min_mm: f64,
    /// Greatest layer thickness.
    pub layer_max_mm: f64,
    /// Greatest error of a layer in the metric's unit: mm, mm, a fraction or mm³. If absent 0.065 mm of cusp height,
    /// 0.1 mm of roughness, 0.1 of the area, or 1 mm³ and as much more as the model needs.
    pub tolerance: Option<f64>,
    /// Find the least tolerance that needs at most so many layers.
    pub max_layers: Option<usize>,
    /// Find the least tolerance that takes at most so many seconds.
    pub max_time_s: Option<f64>,
    /// Height of a bin of the profile.
    pub bin_mm: f64,
    /// What every height is a multiple of: the printer's motor step, or a bin if absent and no printer is named.
    pub step_mm: Option<f64>,
    /// Height ranges with a layer thickness of their own.
    pub ranges: Vec<HeightRange>,
    /// Heights at which there must be a plane.
    pub planes_mm: Vec<f64>,
    /// Whether planes go where flats and sharp changes are.
    pub snap: Snap,
    /// Area in mm² from which on a flat is worth a plane.
    pub flat_area_mm2: f64,
    /// What the error measures.
    pub metric: Metric,
    /// What errors are measured on.
    pub source: Source,
    /// Whether facets count by how much they stand out: see [`crate::saliency`].
    pub saliency: bool,
    /// What facets count for at least, 0 to 1, where some count for less than others. The error of a facet may be as many
    /// times the tolerance as its weight goes into 1.
    pub weight_min: f64,
    /// How layers are chosen.
    pub planner: Planner,
    /// What the optimal plan has least of.
    pub minimize: Minimize,
    /// How layers are exposed and how long that takes.
    pub resin: Resin,
    /// Where the LDI is sampled.
    pub backend: Backend,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            rotation: None,
            height_mm: None,
            printer: None,
            pixels: None,
            pitch_mm: None,
            pitch_y_mm: None,
            mirror: None,
            format: None,
            rays: 2048,
            antialias: 1,
            layer_min_mm: 0.05,
            layer_max_mm: 0.15,
            tolerance: None,
            max_layers: None,
            max_time_s: None,
            bin_mm: 0.002,
            step_mm: None,
            ranges: Vec::new(),
            planes_mm: Vec::new(),
            snap: Snap::Auto,
            flat_area_mm2: 1.0,
            metric: Metric::Cusp,
            source: Source::Exact,
            saliency: false,
            weight_min: 0.25,
            planner: Planner::Optimal,
            minimize: Minimize::Layers,
            resin: Resin::default(),
            backend: Backend::Auto,
        }
    }
}

impl Options {
    /// The printer, if one is named.
    ///
    /// # Errors
    /// [`Error::Options`] if nobody knows it.
    pub(crate) fn printer(&self) -> Result<Option<&'static Printer>, Error> {
        let Some(name) = &self.printer else {
            return Ok(None);
        };
        let known = || {
            let names: Vec<&str> = printer::PRINTERS
                .iter()
                .map(|printer| printer.name)
                .collect();
            Error::Options {
                reason: format!("there is no printer {name}; known are {}", names.join(", ")),
            }
        };
        printer::named(name).map(Some).ok_or_else(known)
    }

    /// Pixels of masks if they are given.
    ///
    /// # Errors
    /// [`Error::Options`].
    pub(crate) fn plate_pixels(&self) -> Result<Option<[u32; 2]>, Error> {
        let preset = self.printer()?.map(|printer| printer.pixels);
        Ok(self.pixels.or(preset))
    }

    /// Sides of a pixel in x and y, if they are given.
    ///
    /// # Errors
    /// [`Error::Options`].
    pub(crate) fn plate_pitch_mm(&self) -> Result<Option<[f64; 2]>, Error> {
        let printer = self.printer()?;
        let preset = printer.map(|printer| printer.pitch_um.map(|pitch_um| pitch_um / 1e3));
        let given = self
            .pitch_mm
            .map(|x_mm| [x_mm, self.pitch_y_mm.unwrap_or(x_mm)]);
        Ok(given.or(preset))
    }

    /// The print file that is asked for, or that the printer takes.
    ///
    /// # Errors
    /// [`Error::Options`].
    pub(crate) fn format(&self) -> Result<Format, Error> {
        let preset = self.printer()?.map(|printer| printer.format);
        Ok(self.format.or(preset).unwrap_or_default())
    }

    /// Whether print files have their masks mirrored.
    ///
    /// # Errors
    /// [`Error::Options`].
    pub(crate) fn is_mirrored(&self) -> Result<bool, Error> {
        let preset = self.printer()?.map(|printer| printer.is_mirrored);
        Ok(self.mirror.or(preset).unwrap_or(false))
    }

    /// The same wherever rays are cast, which decides nothing.
    pub(crate) fn anywhere(&self) -> Self {
        Self {
            backend: Backend::default(),
            ..self.clone()
        }
    }

    /// How the model stands on the plate.
    pub(crate) fn pose(&self) -> Pose {
        Pose {
            rotation: self.rotation,
            height_mm: self.height_mm,
        }
    }

    /// What the light of a pixel is averaged over.
    ///
    /// # Errors
    /// [`Error::Options`].
    pub(crate) fn samples(&self) -> Result<Samples, Error> {
        Samples::of_level(self.antialias).ok_or_else(|| Error::Options {
            reason: format!(
                "there are anti-aliasing levels 1, 2, 4 and 8, but no {}",
                self.antialias
            ),
        })
    }

    /// What plans must keep to within `tolerance`.
    pub(crate) fn limits(&self, tolerance: f64) -> Limits {
        Limits {
            layer_min_mm: self.layer_min_mm,
            layer_max_mm: self.layer_max_mm,
            tolerance,
            ranges: self.ranges.clone(),
            planes_mm: self.planes_mm.clone(),
            step_mm: self.step_mm.or_else(|| {
                let printer = self.printer().ok().flatten();
                printer.map(|printer| printer.step_mm)
            }),
        }
    }

    /// Finds thicknesses that the printer cannot make.
    fn check_printer(&self) -> Result<(), Error> {
        let Some(printer) = self.printer()? else {
            return Ok(());
        };
        let [least_mm, greatest_mm] = printer.layer_mm;
        if self.layer_min_mm < least_mm || self.layer_max_mm > greatest_mm {
            return Err(Error::Options {
                reason: format!(
                    "the {} makes layers of {least_mm} to {greatest_mm} mm, not {} to {} mm",
                    printer.model, self.layer_min_mm, self.layer_max_mm
                ),
            });
        }
        Ok(())
    }

    /// What plans have least of.
    pub(crate) fn objective(&self) -> Objective<'_> {
        match self.minimize {
            Minimize::Layers => Objective::Layers,
            Minimize::Time => Objective::Time(&self.resin),
        }
    }

    /// Finds what no model could make good, before any time is spent on sampling.
    ///
    /// # Errors
    /// [`Error::Plan`], [`Error::Options`].
    pub fn check(&self) -> Result<(), Error> {
        let bins = Bins {
            count: 1,
            size_mm: self.bin_mm,
        };
        self.check_printer()?;
        self.samples()?;
        if !(0.0..=1.0).contains(&self.weight_min) {
            let reason = format!(
                "the least weight must be from 0 to 1, not {}",
                self.weight_min
            );
            return Err(Error::Options { reason });
        }
        self.resin.check().map_err(crate::plan::PlanError::from)?;
        let given = [
            self.tolerance.is_some(),
            self.max_layers.is_some(),
            self.max_time_s.is_some(),
        ];
        if given.into_iter().filter(|&given| given).count() > 1 {
            let reason =
                "give a tolerance, the most layers or the longest time, but not two of them";
            return Err(Error::Options {
                reason: reason.to_owned(),
            });
        }
        match self.planner {
            Planner::Uniform { layer_mm } => {
                uniform::thickness_in_bins(bins, layer_mm)?;
            }
            _ => self
                .limits(self.tolerance.unwrap_or(self.metric.default_tolerance()))
                .check(bins)?,
        }
        Ok(())
    }
}
