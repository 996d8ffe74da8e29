//! The arguments of commands.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use cusp_slicer::arrange::Arranging;
use cusp_slicer::filament::USUAL_NOZZLE_MM;
use cusp_slicer::format::Format;
use cusp_slicer::job::{BIN_MM, Backend, GpuMethod, LAYERS_MM, Minimize, Options, Planner, Snap};
use cusp_slicer::misnamed::with_nearest;
use cusp_slicer::model::ModelUnit;
use cusp_slicer::model::read::ReadOptions;
use cusp_slicer::plan::HeightRange;
use cusp_slicer::prepare::{AutoDrain, Hollowing, SupportStrength, Supporting};
use cusp_slicer::profile::{Metric, Source};
use serde_json::{Map, Value, json};

use crate::budget::Budget;
use crate::config::{self, SettingsFile};
use crate::failure::Failure;
use crate::files::{Reading, WeightsFile, printer_choice, read_json, read_resin};
use crate::usage::{Given, wrong_usage};
use crate::values::{
    DrainArg, PrinterName, antialias, drain, height_range, length, mesh_file, not_negative, pitch,
    pixels, positive, rotation, size, stl_file, uniform_layer,
};

/// Models, and how to slice them.
#[derive(Args)]
pub struct Slicing {
    /// Models: 3MF, OBJ or STL; - is standard input. Or one job file or project of `cusp plate`
    #[arg(required = true, value_name = "MODEL")]
    pub models: Vec<PathBuf>,
    /// Print one JSON object; for a batch one per model, each on its own line
    #[arg(long)]
    pub json: bool,
    /// Print all models together, on the fewest plates: MODEL:3 is three copies
    #[arg(long, help_heading = "Plate")]
    pub arrange: bool,
    #[command(flatten)]
    pub places: Places,
    /// Write the model as it prints, with its voids and supports: an .stl or .3mf for other programs
    #[arg(long, value_name = "FILE", value_parser = mesh_file, help_heading = "Model")]
    pub export: Option<PathBuf>,
    /// Write a plug for each drain hole, to print and glue in once the resin is out: an .stl
    #[arg(long, value_name = "FILE", value_parser = stl_file, help_heading = "Model")]
    pub plugs: Option<PathBuf>,
    #[command(flatten)]
    pub budget: Budget,
    #[command(flatten)]
    pub choices: Choices,
}

/// Rules by which models are arranged.
#[derive(Default, Args)]
pub struct Places {
    /// Copies of each model that is given without a number, unlike MODEL:3
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), help_heading = "Plate")]
    pub copies: Option<u32>,
    /// Least distance between copies [default: 2]
    #[arg(long, value_name = "MM", value_parser = not_negative, help_heading = "Plate")]
    spacing: Option<f64>,
    /// Turn copies about z in steps of this where that saves a plate: a multiple of 15 that divides 360; 0 turns none [default: 45]
    #[arg(long, value_name = "DEGREES", help_heading = "Plate")]
    turn: Option<u32>,
}

impl Places {
    pub fn are_given(&self) -> bool {
        self.copies.is_some() || self.spacing.is_some() || self.turn.is_some()
    }

    /// Copies of a model that names no number of its own.
    pub fn copies(&self) -> usize {
        self.copies.map_or(1, |copies| copies as usize)
    }

    pub fn arranging(&self, arranging: Arranging) -> Arranging {
        Arranging {
            spacing_mm: self.spacing.unwrap_or(arranging.spacing_mm),
            turn_deg: self.turn.unwrap_or(arranging.turn_deg),
        }
    }
}

/// The printer and the resin.
#[derive(Args)]
pub struct Target {
    /// Printer, which sets pixels, pitch, mirroring and format: a name of `cusp printers`, or a JSON file that describes it
    #[arg(long, value_name = "NAME|FILE.json", value_parser = PrinterName, hide_possible_values = true, help_heading = "Printer")]
    pub printer: Option<String>,
    #[arg(long, value_name = "WxH", value_parser = pixels, help = pixels_help(), requires = "pitch", help_heading = "Printer")]
    pixels: Option<[u32; 2]>,
    /// Pixel size, or pixel sizes in x and y: 0.019 or 0.019x0.024
    #[arg(long, value_name = "MM", value_parser = pitch, help_heading = "Printer")]
    pitch: Option<[f64; 2]>,
    /// Anti-alias edges: average each pixel over this many rays, at as many heights within its layer
    #[arg(long, value_name = "LEVEL", default_value_t = Options::default().antialias, value_parser = antialias, help_heading = "Printer")]
    aa: u32,
    /// Mirror the masks left to right
    #[arg(long, value_name = "BOOL", help_heading = "Printer")]
    mirror: Option<bool>,
    /// Format of the print file [default: the printer's, or png]
    #[arg(long, value_enum, help_heading = "Printer")]
    format: Option<Format>,
    #[arg(long, value_name = "MM", value_parser = length, help = nozzle_help(), help_heading = "Printer")]
    nozzle: Option<f64>,
    /// Resin, as a JSON file: exposures, bottom layers, lift, compensation
    #[arg(long, value_name = "FILE", help_heading = "Printer")]
    resin: Option<PathBuf>,
    /// Minimum width to which compensation in x and y may thin a feature; narrower features are not changed
    #[arg(long, value_name = "MM", value_parser = not_negative, help_heading = "Printer")]
    min_feature: Option<f64>,
}

impl Target {
    /// The options that it sets; all others have their defaults.
    pub fn options(&self) -> Result<Options, Failure> {
        let mut options = Options {
            antialias: self.aa,
            ..Options::default()
        };
        self.put_into(&mut options)?;
        Ok(options)
    }

    /// Replaces options of a file by those on the command line; anti-aliasing, which has a default there, is left out.
    fn put_into(&self, options: &mut Options) -> Result<(), Failure> {
        if let Some(printer) = &self.printer {
            options.printer = Some(printer_choice(printer)?);
        }
        if let Some([x_mm, y_mm]) = self.pitch {
            (options.pitch_mm, options.pitch_y_mm) = (Some(x_mm), Some(y_mm));
        }
        if let Some(resin) = &self.resin {
            options.resin = read_resin(Some(resin))?;
        }
        put(&mut options.pixels, self.pixels);
        put(&mut options.mirror, self.mirror);
        put(&mut options.format, self.format);
        put(&mut options.nozzle_mm, self.nozzle);
        put(&mut options.min_feature_mm, self.min_feature);
        Ok(())
    }
}

/// Puts a value that is on the command line in place of another.
fn put<T>(place: &mut Option<T>, given: Option<T>) {
    if given.is_some() {
        *place = given;
    }
}

/// Choices that a model file leaves to its reader.
#[derive(Args)]
#[command(next_help_heading = "Model")]
#[expect(
    clippy::struct_excessive_bools,
    reason = "independent choices, each of which may be made or not"
)]
pub struct ReadChoices {
    /// The plate of a 3MF project that has several, from 1 [default: 1]
    #[arg(long, value_name = "N")]
    plate: Option<u32>,
    /// Read objects that a 3MF calls surfaces as models, too
    #[arg(long)]
    surfaces: bool,
    /// Close every hole, not only wide bent ones, by a curved cap: the surface where the generalised winding number is one half
    #[arg(long)]
    curved_caps: bool,
    /// Read bodies that look like supports as parts of the model, and not as its supports
    #[arg(long)]
    supports_as_model: bool,
    /// Mirror the model in the plane x = 0 of the file
    #[arg(long)]
    mirrored: bool,
}

impl ReadChoices {
    pub fn options(&self) -> ReadOptions {
        ReadOptions {
            plate_number: self.plate,
            surfaces: self.surfaces,
            curved_caps: self.curved_caps,
            supports_as_model: self.supports_as_model,
            mirrored: self.mirrored,
        }
    }
}

/// The options of every command that plans.
#[derive(Args)]
pub struct Choices {
    // First: the fields after it take their values away.
    #[command(flatten)]
    given: Given,
    /// Settings as TOML, by the names that reports have under `options`; options on the command line override them
    #[arg(long, value_name = "FILE.toml")]
    config: Option<PathBuf>,
    #[command(flatten)]
    reading: ReadChoices,
    /// Rotate the model by a quaternion
    #[arg(long, value_name = "X,Y,Z,W", value_parser = rotation, allow_hyphen_values = true, help_heading = "Model")]
    rotation: Option<[f64; 4]>,
    /// Scale the model uniformly to this height
    #[arg(long, value_name = "MM", value_parser = length, help_heading = "Model")]
    height: Option<f64>,
    /// Unit of the coordinates in a file that states none: micron, millimeter, centimeter, inch, foot or meter
    #[arg(
        long,
        value_enum,
        hide_possible_values = true,
        value_name = "UNIT",
        help_heading = "Model"
    )]
    unit: Option<ModelUnit>,
    /// Hollow the model, and leave walls of at least this thickness
    #[arg(long, value_name = "MM", value_parser = length, help_heading = "Model")]
    hollow: Option<f64>,
    /// Smallest cavity: a ball of this diameter fits into the void everywhere [default: 2]
    #[arg(long, value_name = "MM", value_parser = not_negative, help_heading = "Model")]
    cavity: Option<f64>,
    /// Structure left standing in the void
    #[arg(long, value_enum, help_heading = "Model")]
    infill: Option<InfillArg>,
    /// Distance between neighbouring nodes of the infill [default: 8]
    #[arg(long, value_name = "MM", value_parser = length, help_heading = "Model")]
    infill_spacing: Option<f64>,
    /// Diameter of the infill's struts [default: 1]
    #[arg(long, value_name = "MM", value_parser = length, help_heading = "Model")]
    strut: Option<f64>,
    /// Make a drain hole in the void or, without --hollow, in a closed cavity of the model: a surface point, an inward direction and a
    /// diameter; or `auto`, a hole wherever resin would be trapped; repeatable
    #[arg(long = "drain", value_name = "auto|X,Y,Z,DX,DY,DZ,DIAMETER", value_parser = drain, allow_hyphen_values = true, help_heading = "Model")]
    drains: Vec<DrainArg>,
    /// Support the model: light, medium or heavy, auto for medium, none, or a JSON file of strength, sizes and points
    #[arg(long, value_name = "STRENGTH|FILE.json", help_heading = "Model")]
    supports: Option<String>,
    /// Lift the model this far above the plate, on its supports [default: 5]
    #[arg(long, value_name = "MM", value_parser = not_negative, help_heading = "Model")]
    lift: Option<f64>,
    /// Write print files of supported or hollow models even if pieces would float in the vat
    #[arg(long, help_heading = "Model")]
    allow_floating: bool,
    /// Put all supports on a raft
    #[arg(long, help_heading = "Model")]
    raft: bool,
    /// Size of supports by its name in `supports.profile`, as `spacing_mm=2.5`; repeatable
    #[arg(long = "support-size", value_name = "NAME=VALUE", value_parser = size, help_heading = "Model")]
    support_sizes: Vec<(String, f64)>,
    #[command(flatten)]
    pub target: Target,
    /// Weight facets by saliency: how much they stand out
    #[arg(long, value_name = "BOOL", num_args = 0..=1, require_equals = true, default_missing_value = "true", help_heading = "Weights")]
    saliency: Option<bool>,
    /// Weight facets by this file; with --saliency, by the product of both
    #[arg(long, value_name = "FILE", help_heading = "Weights")]
    weights: Option<PathBuf>,
    /// Smallest weight of a facet: a facet of weight w may exceed the tolerance by a factor of 1/w
    #[arg(
        long,
        value_name = "WEIGHT",
        default_value_t = Options::default().weight_min,
        help_heading = "Weights"
    )]
    weight_min: f64,
    #[arg(long, value_name = "MM", value_parser = length, help = limit_help("Minimum", LAYERS_MM[0]), help_heading = "Layers")]
    layer_min: Option<f64>,
    #[arg(long, value_name = "MM", value_parser = length, help = limit_help("Maximum", LAYERS_MM[1]), help_heading = "Layers")]
    layer_max: Option<f64>,
    /// Thickness of the first layer, whatever its error: the tolerance holds above it [default for filament printers: half the
    /// width of the nozzle]
    #[arg(long, value_name = "MM", value_parser = length, help_heading = "Layers")]
    first_layer: Option<f64>,
    /// Maximum thickness of layers below the model, where only supports and a raft are [default: as elsewhere]
    #[arg(long, value_name = "MM", value_parser = length, help_heading = "Layers")]
    support_layer: Option<f64>,
    /// The only layer thicknesses, in place of a range: each needs an exposure of its own
    #[arg(long, value_name = "MM,MM,...", value_delimiter = ',', value_parser = length, conflicts_with_all = ["layer_min", "layer_max", "max_thicknesses", "max_change"], help_heading = "Layers")]
    thicknesses: Vec<f64>,
    /// Choose at most this many distinct layer thicknesses: the best ones for the model
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), conflicts_with = "max_change", help_heading = "Layers")]
    max_thicknesses: Option<u32>,
    /// Change the layer thickness by at most this from one layer to the next
    #[arg(long, value_name = "MM", value_parser = not_negative, help_heading = "Layers")]
    max_change: Option<f64>,
    #[arg(long, value_name = "ERROR", value_parser = not_negative, help = tolerance_help(), help_heading = "Layers")]
    tolerance: Option<f64>,
    /// Find the smallest tolerance that needs at most this many layers
    #[arg(
        long,
        value_name = "K",
        conflicts_with = "tolerance",
        help_heading = "Layers"
    )]
    max_layers: Option<usize>,
    /// Find the smallest tolerance that prints in at most this many seconds
    #[arg(long, value_name = "S", value_parser = positive, conflicts_with_all = ["tolerance", "max_layers"], help_heading = "Layers")]
    max_time: Option<f64>,
    /// Metric of the error
    #[arg(long, value_enum, default_value_t = Options::default().metric, help_heading = "Layers")]
    metric: Metric,
    /// Surface on which errors are measured
    #[arg(long, value_enum, default_value_t = Options::default().source, help_heading = "Layers")]
    source: Source,
    /// Rule by which layers are chosen
    #[arg(long, value_enum, default_value = "optimal", help_heading = "Layers")]
    planner: PlannerArg,
    /// Quantity that the optimal planner minimizes
    #[arg(long, value_enum, default_value_t = Options::default().minimize, help_heading = "Layers")]
    minimize: Minimize,
    /// Layer thickness, for --planner uniform only: a length, `finest` or `coarsest`
    #[arg(
        long,
        value_name = "MM",
        value_parser = uniform_layer,
        required_if_eq("planner", "uniform"),
        help_heading = "Layers"
    )]
    layer: Option<Planner>,
    /// Limit layers between heights Z0 and Z1 to MIN to MAX mm; repeatable
    #[arg(long = "range", value_name = "Z0:Z1=MIN:MAX", value_parser = height_range, help_heading = "Layers")]
    ranges: Vec<HeightRange>,
    /// Put a plane at this height; repeatable
    #[arg(long = "plane", value_name = "MM", value_parser = length, help_heading = "Layers")]
    planes: Vec<f64>,
    /// Round heights to multiples of this: the printer's motor step
    #[arg(long, value_name = "MM", value_parser = length, help_heading = "Layers")]
    step: Option<f64>,
    /// Put planes at flats and sharp changes
    #[arg(long, value_enum, default_value_t = Options::default().snap, help_heading = "Layers")]
    snap: Snap,
    #[arg(long, value_name = "MM", value_parser = length, help = bin_help(), help_heading = "Layers")]
    bin: Option<f64>,
    /// Processor that samples the model
    #[arg(long, value_enum, default_value_t = Options::default().backend, help_heading = "Machine")]
    backend: Backend,
    /// Method by which a GPU samples it
    #[arg(long, value_enum, default_value_t = Options::default().gpu_method, help_heading = "Machine")]
    gpu_method: GpuMethod,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum PlannerArg {
    /// The fewest layers within tolerance, or the shortest time
    Optimal,
    /// Layer by layer, as thick as the profile allows
    Greedy,
    /// Layer by layer, as thick as the surface at the plane suggests
    Local,
    /// Layers of one thickness, set by --layer
    Uniform,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum InfillArg {
    /// Nothing
    None,
    /// Struts along the space diagonals, which support themselves
    Lattice,
}

/// Options and choices of reading, from the command line and a file.
pub struct Settings {
    pub options: Options,
    pub reading: Reading,
}

impl Choices {
    /// Exits with a usage error if options of `command` contradict each other in a way that clap's
    /// attributes cannot express.
    pub fn check(&self, command: &str) {
        if self.layer.is_some() && self.planner != PlannerArg::Uniform {
            let message = "--layer is for --planner uniform only; other planners take --layer-min \
                           and --layer-max";
            wrong_usage(command, message);
        }
        // A file of settings may hollow the model, and have an infill.
        if self.config.is_some() {
            return;
        }
        if let (None, Some(name)) = (self.hollow, self.of_hollow()) {
            wrong_usage(
                command,
                &format!("{name} is for hollowed models: add --hollow"),
            );
        }
        let of_infill = [
            self.infill_spacing.map(|_| "--infill-spacing"),
            self.strut.map(|_| "--strut"),
        ];
        let has_infill = self.infill == Some(InfillArg::Lattice);
        if let (false, Some(name)) = (has_infill, of_infill.into_iter().flatten().next()) {
            wrong_usage(
                command,
                &format!("{name} is for an infill: add --infill lattice"),
            );
        }
    }

    /// The settings of the file, if one is given, with those of the command line in their place.
    pub fn settings(&self) -> Result<Settings, Failure> {
        self.settings_over(Options::default())
    }

    /// The same, with `options` in place of the defaults. A file of settings goes before all of them.
    pub fn settings_over(&self, options: Options) -> Result<Settings, Failure> {
        let file = self.config.as_deref().map(config::read).transpose()?;
        let SettingsFile {
            mut options,
            weights,
        } = file.unwrap_or(SettingsFile {
            options,
            weights: None,
        });
        self.target.put_into(&mut options)?;
        self.put_into(&mut options);
        self.put_supports(&mut options)?;
        if let (None, Some(name)) = (&options.hollow, self.of_hollow()) {
            let message = format!("{name} is for hollowed models: add --hollow");
            return Err(Failure::from(message));
        }
        let weights = self.weights.as_ref().or(weights.as_ref());
        Ok(Settings {
            options,
            reading: Reading {
                weights: weights.map(|path| WeightsFile::read(path)).transpose()?,
                options: self.reading.options(),
            },
        })
    }

    fn put_into(&self, options: &mut Options) {
        self.put_goal(options);
        self.put_thicknesses(options);
        self.put_hollow(options);
        put(&mut options.rotation, self.rotation);
        put(&mut options.height_mm, self.height);
        put(&mut options.unit, self.unit);
        options.allow_floating |= self.allow_floating;
        put(&mut options.first_layer_mm, self.first_layer);
        put(&mut options.support_layer_mm, self.support_layer);
        put(&mut options.bin_mm, self.bin);
        put(&mut options.step_mm, self.step);
        if !self.ranges.is_empty() {
            options.ranges.clone_from(&self.ranges);
        }
        if !self.planes.is_empty() {
            options.planes_mm.clone_from(&self.planes);
        }
        if let Some(saliency) = self.saliency {
            options.saliency = saliency;
        }
        let given = &self.given;
        given.put("aa", &mut options.antialias, self.target.aa);
        given.put("weight_min", &mut options.weight_min, self.weight_min);
        given.put("metric", &mut options.metric, self.metric);
        given.put("source", &mut options.source, self.source);
        given.put("minimize", &mut options.minimize, self.minimize);
        given.put("snap", &mut options.snap, self.snap);
        given.put("backend", &mut options.backend, self.backend);
        given.put("gpu_method", &mut options.gpu_method, self.gpu_method);
        let planner = match (self.planner, self.layer) {
            (PlannerArg::Optimal, _) => Planner::Optimal,
            (PlannerArg::Greedy, _) => Planner::Greedy,
            (PlannerArg::Local, _) => Planner::Local,
            (PlannerArg::Uniform, layer) => layer.unwrap_or(Planner::Finest),
        };
        given.put("planner", &mut options.planner, planner);
    }

    /// An option that goes with a hollow model, if one is given.
    fn of_hollow(&self) -> Option<&'static str> {
        let given = [
            self.cavity.map(|_| "--cavity"),
            self.infill.map(|_| "--infill"),
        ];
        given.into_iter().flatten().next()
    }

    fn put_hollow(&self, options: &mut Options) {
        if let Some(wall_mm) = self.hollow {
            options.hollow.get_or_insert_default().wall_mm = wall_mm;
        } else if !self.drains.is_empty() {
            // Holes alone drain the cavities that the model has.
            options.hollow.get_or_insert_with(|| Hollowing {
                wall_mm: 0.0,
                ..Hollowing::default()
            });
        }
        let Some(hollow) = &mut options.hollow else {
            return;
        };
        if let Some(cavity_mm) = self.cavity {
            hollow.cavity_mm = cavity_mm;
        }
        match self.infill {
            Some(InfillArg::None) => hollow.infill = None,
            Some(InfillArg::Lattice) => {
                hollow.infill.get_or_insert_default();
            }
            None => {}
        }
        if !self.drains.is_empty() {
            (hollow.drains, hollow.auto_drain) = (Vec::new(), None);
        }
        for drain in &self.drains {
            match *drain {
                DrainArg::Auto => hollow.auto_drain = Some(AutoDrain::default()),
                DrainArg::At(drain) => hollow.drains.push(drain),
            }
        }
        if let Some(infill) = &mut hollow.infill {
            infill.spacing_mm = self.infill_spacing.unwrap_or(infill.spacing_mm);
            infill.strut_mm = self.strut.unwrap_or(infill.strut_mm);
        }
    }

    fn put_supports(&self, options: &mut Options) -> Result<(), Failure> {
        let of = |strength| {
            Some(Supporting {
                strength,
                ..Supporting::default()
            })
        };
        match self.supports.as_deref() {
            None => {}
            Some("none") => options.supports = None,
            Some("auto") => options.supports = of(SupportStrength::default()),
            Some(name) => {
                options.supports = match SupportStrength::from_str(name, false) {
                    Ok(strength) => of(strength),
                    Err(_) => Some(read_json(Path::new(name))?),
                };
            }
        }
        let lift = self.lift.map(|mm| ("lift_mm".to_owned(), json!(mm)));
        let raft = self.raft.then(|| ("raft".to_owned(), json!(true)));
        let sizes = self.support_sizes.iter();
        let sizes = sizes.map(|(name, size)| (name.clone(), json!(size)));
        let sizes: Map<String, Value> = lift.into_iter().chain(raft).chain(sizes).collect();
        if sizes.is_empty() {
            return Ok(());
        }
        let Some(supports) = &mut options.supports else {
            let text = "--lift, --raft and --support-size are for supported models: add --supports";
            return Err(Failure::from(text.to_owned()));
        };
        let profile = supports.profile().with_sizes(sizes);
        supports.profile = Some(profile.map_err(|error| {
            Failure::from(format!(
                "--support-size: {}",
                with_nearest(&error.to_string())
            ))
        })?);
        Ok(())
    }

    /// A plan has one goal, so one on the command line replaces whichever the file has.
    fn put_goal(&self, options: &mut Options) {
        if self.tolerance.is_some() || self.max_layers.is_some() || self.max_time.is_some() {
            options.tolerance = self.tolerance;
            options.max_layers = self.max_layers;
            options.max_time_s = self.max_time;
        }
    }

    /// So is it with rules for thicknesses, of which single ones go in place of a range.
    fn put_thicknesses(&self, options: &mut Options) {
        let has_range = self.layer_min.is_some() || self.layer_max.is_some();
        let has_rule = self.max_thicknesses.is_some() || self.max_change.is_some();
        if has_rule || !self.thicknesses.is_empty() {
            options.max_thicknesses = self.max_thicknesses.map(|count| count as usize);
            options.max_change_mm = self.max_change;
        }
        if has_rule || has_range || !self.thicknesses.is_empty() {
            options.thicknesses_mm.clone_from(&self.thicknesses);
        }
        put(&mut options.layer_min_mm, self.layer_min);
        put(&mut options.layer_max_mm, self.layer_max);
    }
}

/// The help of `--tolerance`, with the library's defaults.
fn tolerance_help() -> String {
    let defaults = Metric::value_variants().iter().map(|metric| {
        let (tolerance, unit, name) = (metric.default_tolerance(), metric.unit(), metric.name());
        let space = if unit.is_empty() { "" } else { " " };
        format!("{tolerance}{space}{unit} for {name}")
    });
    let defaults = defaults.collect::<Vec<_>>().join(", ");
    format!(
        "Largest error of a layer, in the metric's unit. A model that cannot keep the default of volume gets the smallest \
         tolerance possible [default: {defaults}]"
    )
}

fn pixels_help() -> String {
    let rays = Options::default().rays;
    format!(
        "Columns and rows of the masks, with the model at the centre [default: the model's bounding box at {rays} pixels \
         along its longer side]"
    )
}

/// The help of `--layer-min` and `--layer-max`.
fn limit_help(which: &str, usual_mm: f64) -> String {
    format!(
        "{which} layer thickness [default: {usual_mm}; for filament printers, what the nozzle prints]"
    )
}

fn nozzle_help() -> String {
    let formats = Format::FILAMENT.map(Format::name).join(" and ");
    format!(
        "Width of a filament printer's nozzle, for the formats {formats}: it sets the limits of layers [default: {USUAL_NOZZLE_MM}]"
    )
}

fn bin_help() -> String {
    format!(
        "Height of a bin of the profile [default: {BIN_MM}, or what the step or a thickness needs]"
    )
}
