//! Draws figures 4 and 5: profiles of a model, and the plans made from them.

use std::fmt::Write as _;

use cusp_slicer::profile::Metric;

/// One profile and its plan.
pub struct Panel {
    pub title: String,
    pub metric: Metric,
    pub tolerance: f64,
    pub density: Vec<f32>,
    pub z_mm: Vec<f64>,
    /// Planes to mark.
    pub planes_mm: Vec<f64>,
}

const WIDTH: f64 = 170.0;
const HEIGHT: f64 = 360.0;
const GAP: f64 = 24.0;
/// Points in a profile's polyline.
const POINTS: usize = 240;

/// Draws the panels side by side, z upward, on a white background that suits light and dark pages.
pub fn draw(name: &str, panels: &[Panel]) -> String {
    let width = panels.len() as f64 * (WIDTH + GAP) + GAP;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {}\" font-family=\"sans-serif\" font-size=\"12\">\n\
         <title>Metric profiles and plans of the {name}</title>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
        HEIGHT + 70.0
    );
    for (index, panel) in panels.iter().enumerate() {
        let left = GAP + index as f64 * (WIDTH + GAP);
        let _ = writeln!(svg, "<g transform=\"translate({left} 30)\">");
        let top_mm = panel.z_mm.last().copied().unwrap_or(1.0);
        let y = |z_mm: f64| HEIGHT * (1.0 - z_mm / top_mm);
        for layer in panel.z_mm.windows(2) {
            let _ = writeln!(
                svg,
                "<rect x=\"{}\" y=\"{:.2}\" width=\"40\" height=\"{:.2}\" fill=\"{}\"/>",
                WIDTH - 40.0,
                y(layer[1]),
                y(layer[0]) - y(layer[1]) + 0.1,
                colour((layer[1] - layer[0] - 0.05) / 0.1)
            );
        }
        for &z_mm in &panel.planes_mm {
            let _ = writeln!(
                svg,
                "<path d=\"M{} {:.2}h60\" stroke=\"#111\" stroke-width=\"1.5\"/>",
                WIDTH - 50.0,
                y(z_mm)
            );
        }
        let most = panel
            .density
            .iter()
            .copied()
            .fold(f32::MIN_POSITIVE, f32::max);
        let step = panel.density.len().div_ceil(POINTS);
        let line: Vec<String> = panel
            .density
            .chunks(step)
            .enumerate()
            .map(|(point, bins)| {
                let value = bins.iter().copied().fold(0.0, f32::max) / most;
                let z = (point as f64 + 0.5) * step as f64 / panel.density.len() as f64;
                format!(
                    "{:.1},{:.1}",
                    f64::from(value) * (WIDTH - 50.0),
                    HEIGHT * (1.0 - z)
                )
            })
            .collect();
        let _ = writeln!(
            svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"#334\" stroke-width=\"0.8\"/>\n\
             <text y=\"-10\">{}</text>\n\
             <text y=\"{}\">{} layers within {} {}</text>\n</g>",
            line.join(" "),
            panel.title,
            HEIGHT + 20.0,
            panel.z_mm.len() - 1,
            panel.tolerance,
            panel.metric.unit()
        );
    }
    svg.push_str("</svg>\n");
    svg
}

/// From red for the thinnest layers to blue for the thickest, as in the paper.
fn colour(part: f64) -> String {
    let part = part.clamp(0.0, 1.0);
    format!("hsl({:.0} 75% 55%)", part * 225.0)
}
