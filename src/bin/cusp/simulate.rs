//! Measures what a print file prints against the model.

use std::fs;
use std::path::PathBuf;

use clap::Args;
use cusp_slicer::model::{Mesh, ModelUnit, Pose, read};
use cusp_slicer::simulation::{
    Deviation, Knowledge, Placement, Simulation, SimulationError, simulate as measure,
};

use crate::failure::{Failure, in_file};
use crate::progress::Bar;
use crate::terminal::{print, print_json};
use crate::values::{length, rotation};
use crate::watch::stop_on_interrupt;

/// A model and a print file of it.
#[derive(Args)]
pub struct Simulating {
    /// Model: 3MF, OBJ or STL
    model: PathBuf,
    /// Print file in any format that `cusp inspect` reads, by whichever program
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
    /// Whether the masks are mirrored left to right [default: what the print file says]
    #[arg(long, value_name = "BOOL")]
    mirror: Option<bool>,
}

impl Simulating {
    /// What is known besides the print file. A unit that the model states is already accounted for.
    fn knowledge(&self, stated: Option<ModelUnit>) -> Knowledge {
        let pose = Pose {
            rotation: self.rotation,
            height_mm: self.height,
            unit: self.unit.filter(|_| stated.is_none()),
        };
        Knowledge {
            pose: (pose != Pose::default()).then_some(pose),
            is_mirrored: self.mirror,
        }
    }
}

pub fn simulate(simulating: &Simulating) -> Result<(), Failure> {
    let (model, print_file) = (&*simulating.model, &*simulating.print);
    let bytes = fs::read(model).map_err(|error| in_file(model, &error))?;
    let contents = read::read(&bytes).map_err(|error| in_file(model, &error))?;
    let mesh = Mesh::from_triangles(&contents.triangles).map_err(|error| in_file(model, &error))?;
    let printed = fs::read(print_file).map_err(|error| in_file(print_file, &error))?;
    stop_on_interrupt();
    let bar = Bar::new();
    let mut progress = |fraction| bar.show("simulate", fraction);
    let simulation = measure(
        &mesh,
        &printed,
        &simulating.knowledge(contents.unit),
        &mut progress,
    )
    .map_err(|error| match error {
        SimulationError::Cancelled(_) => Failure::interrupted(),
        SimulationError::Mesh(error) => in_file(model, &error).into(),
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
    let placement = match simulation.placement {
        Placement::Stated => "centred on the masks, as the file says".to_owned(),
        Placement::Centre => "centred on the masks, as the lit pixels are".to_owned(),
        Placement::LitPixels => {
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
