//! Appendix A: agreement of an approximated error of a layer with the true one, which a simulated print has.

use std::fmt::Write as _;

use crate::slicer::Slicer;
use cusp_slicer::grid::Bins;
use cusp_slicer::job::{Options, Planner};
use cusp_slicer::model::read;
use cusp_slicer::profile::facet_bins::FacetBins;
use cusp_slicer::profile::normal_cones::{cones, maxima};
use cusp_slicer::profile::{Metric, Shape, steepest};
use cusp_slicer::progress::silent;
use cusp_slicer::simulation::{Knowledge, Original, simulate};

use crate::{BIN_MM, LAYER_MM, Model, mesh_of, options, quiet};

/// Rays: half a pixel's diagonal is what masks do not resolve, and should be far below the errors.
const RAYS: u32 = 4096;

/// Three approximated errors and the true one, in millimetres.
struct Layer {
    /// Thickness times |`n_z`| at the plane below, as conventional slicers have it.
    one_normal: f64,
    /// The integral of the profile.
    integral: f64,
    /// The bound of the metric `deviation`.
    bound: f64,
    /// The greatest distance from the print to the model.
    actual: f64,
}

pub fn write(models: &[Model], text: &mut String) {
    let _ = writeln!(
        text,
        "\n## Appendix A: approximated and true errors\n\n\
         Uniform layers of {} µm at {RAYS} rays, and the distance from the simulated print to the model in each \
         (`cusp simulate`). *One normal* is the layer thickness times |n_z| at the plane below, as conventional slicers have it; \
         *integral* is the paper's cusp height; *bound* is our metric `deviation`. Given are the correlation with the true error \
         over the layers, the true error divided by the approximated one (the slope of the line through 0 that fits best), and the \
         greatest excess over the bound of a layer and those beside it: masks are sampled at mid-layer, so half a cusp height is on either side of the surface, and the slope of a \
         good approximation is 0.5, of a good bound 1. Pixels blur the true error by up to half a diagonal. The 0.72 and 0.86 of the \
         paper's appendix are cusp heights that it reads off a drawing, and have no models to repeat them on.\n\n\
         | model | half diagonal (µm) | one normal: correlation | slope | integral: correlation | slope | bound: correlation | slope | greatest excess (µm) |\n\
         |---|---:|---:|---:|---:|---:|---:|---:|---:|",
        LAYER_MM[1] * 1000.0
    );
    for model in models {
        let (layers, half_diagonal_mm) = layers(model);
        let fits = [
            fit(&layers, |layer| layer.one_normal),
            fit(&layers, |layer| layer.integral),
            fit(&layers, |layer| layer.bound),
        ];
        let fits = fits.map(|[correlation, slope]| format!("{correlation:.2} | {slope:.2}"));
        // A shelf is as far away as the adjacent walls, and one of them is the next layer's.
        let excess = (0..layers.len()).map(|layer| {
            let beside = &layers[layer.saturating_sub(1)..(layer + 2).min(layers.len())];
            let bounds = beside.iter().map(|layer| layer.bound);
            layers[layer].actual - bounds.fold(0.0, f64::max)
        });
        let _ = writeln!(
            text,
            "| {} | {:.1} | {} | {:.1} |",
            model.name,
            half_diagonal_mm * 1000.0,
            fits.join(" | "),
            excess.fold(f64::NEG_INFINITY, f64::max) * 1000.0
        );
    }
}

/// The layers of a model, and half the diagonal of a pixel.
fn layers(model: &Model) -> (Vec<Layer>, f64) {
    let mut slicer = Slicer::load(&model.bytes).expect("a model");
    // Whole bins: 152 µm.
    let layer_mm = (LAYER_MM[1] / BIN_MM).floor() * BIN_MM;
    let options = Options {
        planner: Planner::Uniform { layer_mm },
        rays: RAYS,
        ..options(model)
    };
    let report = pollster::block_on(slicer.plan(&options, &mut quiet)).cloned();
    let report = report.expect("a plan");
    let (print_file, _) = slicer
        .write_archive(Vec::new(), &mut quiet)
        .expect("a file");
    let contents = read::read(&model.bytes).expect("an STL");
    let originals = [Original::of(&contents).expect("a mesh")];
    let simulation = simulate(&originals, &print_file, &Knowledge::default(), &mut silent);
    let simulation = simulation.expect("a simulation");

    let mesh = mesh_of(model);
    let bins = Bins::of_height(model.height_mm, BIN_MM).expect("bins");
    let steepest = steepest::exact(&FacetBins::of(&mesh, bins), &[]);
    let shape = Shape {
        bins,
        cones: maxima(&steepest, &cones(&mesh, bins), |_| true),
        steepest,
        areas_mm2: Vec::new(),
    };
    let cusps = shape.errors(Metric::Cusp);
    let deviations = shape.errors(Metric::Deviation);
    let layers = report
        .z_mm
        .windows(2)
        .zip(&simulation.print_to_model.layers);
    let layers = layers.filter_map(|(z_mm, simulated)| {
        let [lower, upper] = [z_mm[0], z_mm[1]].map(|z_mm| (z_mm / BIN_MM).round() as u32);
        // The last layer may end above the model, where there are no bins.
        let upper = upper.min(bins.count as u32);
        let a_bin = cusps.to_value(cusps.steps_between(lower, lower + 1));
        Some(Layer {
            one_normal: a_bin * f64::from(upper - lower),
            integral: cusps.to_value(cusps.steps_between(lower, upper)),
            bound: deviations.to_value(deviations.steps_between(lower, upper)),
            actual: simulated.max_mm?,
        })
    });
    (layers.collect(), simulation.half_pixel_diagonal_mm)
}

/// The correlation of an approximated error with the true one, and the slope of the line through 0 that fits best.
fn fit(layers: &[Layer], approximated: impl Fn(&Layer) -> f64) -> [f64; 2] {
    let count = layers.len() as f64;
    let mean = |of: &dyn Fn(&Layer) -> f64| layers.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(&approximated), mean(&|layer| layer.actual));
    let covariance = mean(&|layer| (approximated(layer) - x) * (layer.actual - y));
    let variances = mean(&|layer| (approximated(layer) - x).powi(2))
        * mean(&|layer| (layer.actual - y).powi(2));
    let slope = mean(&|layer| approximated(layer) * layer.actual)
        / mean(&|layer| approximated(layer).powi(2));
    [covariance / variances.sqrt(), slope]
}
