//! Measures the print of a print file against the model.

use std::fs;
use std::path::PathBuf;

use clap::Args;
use cusp_slicer::archive::read::PrintedCopy;
use cusp_slicer::model::read::ReadOptions;
use cusp_slicer::model::{ModelUnit, Pose, read};
use cusp_slicer::simulation::{
    Deviation, Knowledge, Original, Placement, Simulation, SimulationError, simulate as measure,
};

use crate::failure::{Failure, in_file};
use crate::files::read_resin;
use crate::job_file::JobFile;
use crate::progress::Bar;
use crate::terminal::{print, print_json};
use crate::values::{length, rotation};
use crate::watch::stop_on_interrupt;

/// Models and a print file of them.
#[derive(Args)]
pub struct Simulating {
    /// All models in the print file, in order: 3MF, OBJ or STL. Or one job file or project of `cusp plate`
    #[arg(required = true, value_name = "MODEL")]
    models: Vec<PathBuf>,
    /// Print file in any format that `cusp inspect` reads, from any program
    #[arg(value_name = "PRINTFILE")]
    print: PathBuf,
    /// Print one JSON object, with the distances of every layer
    #[arg(long)]
    pub json: bool,
    /// Rotation of the model by a quaternion, where the print file does not say it
    #[arg(long, value_name = "X,Y,Z,W", value_parser = rotation, allow_hyphen_values = true)]
    rotation: Option<[f64; 4]>,
    /// Height to which the model was scaled, where the print file does not say it
    #[arg(long, value_name = "MM", value_parser = length)]
    height: Option<f64>,
    /// Unit of a model that states none, where the print file does not say it
    #[arg(long, value_enum, hide_possible_values = true, value_name = "UNIT")]
    unit: Option<ModelUnit>,
    /// The plate of the job file, from 1, where the print file does not say where its copies stand
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    job_plate: u32,
    /// True if the masks are mirrored left to right [default: as the print file says]
    #[arg(long, value_name = "BOOL")]
    mirror: Option<bool>,
    /// Simulate print-through, by the `print_through` of this resin, a JSON file, and the exposures in the print file
    #[arg(long, value_name = "RESIN.json")]
    cure: Option<PathBuf>,
}

/// The models to measure, as they are in their files.
struct Originals {
    paths: Vec<PathBuf>,
    models: Vec<Original>,
    /// Copies of the models, by the job file.
    copies: Vec<PrintedCopy>,
}

impl Originals {
    fn read(simulating: &Simulating) -> Result<Self, Failure> {
        let mut originals = Self {
            paths: Vec::new(),
            models: Vec::new(),
            copies: Vec::new(),
        };
        let Some(file) = JobFile::of(&simulating.models)? else {
            for path in &simulating.models {
                let bytes = fs::read(path).map_err(|error| in_file(path, &error))?;
                originals.add(path.clone(), &bytes, &ReadOptions::default())?;
            }
            return Ok(originals);
        };
        let folder = simulating.models[0].parent();
        for model in &file.models {
            let bytes = model.bytes(folder)?;
            originals.add(model.path(folder), &bytes, &model.reading())?;
        }
        let shared = Pose {
            rotation: file.options.rotation,
            height_mm: file.options.height_mm,
            unit: file.options.unit,
        };
        let on_plate = file.placements.iter();
        let on_plate = on_plate.filter(|it| it.plate + 1 == simulating.job_plate as usize);
        let copies = on_plate.map(|place| {
            let own = file.models.get(place.model);
            PrintedCopy {
                model: place.model,
                pose: own.map_or(shared, |own| own.own().pose_over(shared)),
                turn_deg: place.turn_deg,
                middle_mm: [place.x_mm, place.y_mm],
            }
        });
        originals.copies = copies.collect();
        Ok(originals)
    }

    fn add(&mut self, path: PathBuf, bytes: &[u8], options: &ReadOptions) -> Result<(), Failure> {
        let contents = read::read_with(bytes, options).map_err(|error| in_file(&path, &error))?;
        let original = Original::of(&contents).map_err(|error| in_file(&path, &error))?;
        self.models.push(original);
        self.paths.push(path);
        Ok(())
    }
}

impl Simulating {
    /// Knowledge besides the print file.
    fn knowledge(&self, copies: Vec<PrintedCopy>) -> Result<Knowledge, Failure> {
        let pose = Pose {
            rotation: self.rotation,
            height_mm: self.height,
            unit: self.unit,
        };
        let cure = self.cure.as_deref().map(|path| {
            let resin = read_resin(Some(path))?;
            resin.check().map_err(|error| in_file(path, &error))?;
            if resin.print_through.is_none() {
                return Err(in_file(
                    path,
                    &"the resin has no `print_through`, which --cure needs",
                )
                .into());
            }
            Ok::<_, Failure>(resin)
        });
        Ok(Knowledge {
            pose: (pose != Pose::default()).then_some(pose),
            copies,
            is_mirrored: self.mirror,
            cure: cure.transpose()?,
        })
    }
}

pub fn simulate(simulating: &Simulating) -> Result<(), Failure> {
    let print_file = &*simulating.print;
    let mut originals = Originals::read(simulating)?;
    let printed = fs::read(print_file).map_err(|error| in_file(print_file, &error))?;
    stop_on_interrupt();
    let bar = Bar::new();
    let mut progress = |fraction| bar.show("simulate", fraction);
    let knowledge = simulating.knowledge(std::mem::take(&mut originals.copies))?;
    let simulation = measure(&originals.models, &printed, &knowledge, &mut progress);
    let simulation = simulation.map_err(|error| match error {
        SimulationError::Cancelled(_) => Failure::interrupted(),
        SimulationError::Mesh { model, error } => in_file(&originals.paths[model], &error).into(),
        error => in_file(print_file, &error).into(),
    })?;
    drop(bar);
    if simulating.json {
        return Ok(print_json(&simulation)?);
    }
    Ok(print(&describe(&simulation))?)
}

fn describe(simulation: &Simulation) -> String {
    let [width, height] = simulation.pixels;
    let [pitch_x, pitch_y] = simulation.pixel_mm;
    let [size_x, size_y, size_z] = simulation.model_mm;
    let [x, y] = simulation.offset_mm;
    let placement = match (simulation.placement, simulation.copies) {
        (Placement::Stated, 1) => "placed as the file says".to_owned(),
        (Placement::Stated, copies) => format!("{copies} copies, placed as the file says"),
        (Placement::Centre, _) => "centred on the masks, as the lit pixels are".to_owned(),
        (Placement::LitPixels, _) => {
            format!("centred on the lit pixels; the masks' centre is {x:.3}, {y:.3} mm from there")
        }
    };
    let hidden = match simulation.hidden_facets {
        0 => String::new(),
        facets => format!("; {facets} facets that are not on its surface left out"),
    };
    format!(
        "print           {} layers, {:.3} mm high, of {width} × {height} pixels of {pitch_x:.4} × {pitch_y:.4} mm ({})\n\
         model           {size_x:.3} × {size_y:.3} × {size_z:.3} mm, {placement}{hidden}\n\
         print to model  {}\n\
         model to print  {}\n\
         resolution      half a pixel's diagonal is {:.4} mm; maxima are found to {:.4} mm",
        simulation.layers,
        simulation.height_mm,
        simulation.format.name(),
        describe_deviation(&simulation.print_to_model),
        describe_deviation(&simulation.model_to_print),
        simulation.half_pixel_diagonal_mm,
        simulation.precision_mm,
    )
}

fn describe_deviation(deviation: &Deviation) -> String {
    let [x, y, z] = deviation.at_mm;
    format!(
        "at most {:.4} mm, at {x:.3}, {y:.3}, {z:.3}; {:.4} mm on average",
        deviation.max_mm, deviation.mean_mm
    )
}
