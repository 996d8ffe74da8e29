//! Prints that measure a printer: whether it prints layers of several thicknesses, which exposure each thickness needs, and how deep
//! layers cure below themselves.

use std::io::Write;
use std::sync::Arc;

use glam::Vec3;
use serde::Serialize;

use crate::archive::ArchiveError;
use crate::compensation::Compensation;
use crate::cure::Bridge;
use crate::format::{Format, FormatThicknesses};
use crate::job::{
    Backend, Error, Job, JobOptions, LoadedModel, Options, Output, Report, Snap, StageProgress,
};
use crate::plan::HeightRange;
use crate::printer::{PrinterChoice, VariableLayers};
use crate::quantity::Quantity;
use crate::resin::Resin;

/// A print that measures a printer: a model made for it, its layers and their exposures.
#[derive(Debug, Clone)]
pub struct Calibration {
    /// The model, as boxes from a corner to the opposite one. Where they overlap they are one body.
    boxes: Vec<[Vec3; 2]>,
    sections: Vec<Section>,
    options: Options,
}

/// Consecutive layers of one thickness and exposure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Section {
    /// Bottom of the lowest layer, in millimetres above the plate.
    pub from_mm: f64,
    /// Thickness of each layer in millimetres.
    pub layer_mm: f64,
    /// Number of layers.
    pub layers: usize,
    /// Exposure of each layer in seconds; that of the resin if absent.
    pub exposure_s: Option<f64>,
}

impl Section {
    /// Top of the highest layer, rounded to the nanometre.
    fn to_mm(self) -> f64 {
        let to_mm = self.from_mm + self.layer_mm * self.layers as f64;
        (to_mm * 1e6).round() / 1e6
    }
}

/// Layers of a section.
const LAYERS: usize = 10;
/// Thicknesses of the two towers' layers in millimetres.
const TOWERS_MM: [f64; 2] = [0.05, 0.1];
/// Side of a tower in millimetres.
const SIDE_MM: f32 = 10.0;
/// Distance between the middles of towers of the exposure test in millimetres.
const PITCH_MM: f32 = 12.0;
/// Length and width of a bridge, side of its posts, distance of rows of bridges, and thickness of the base below, in millimetres.
const SPAN_MM: f32 = 8.0;
const BRIDGE_MM: f32 = 3.0;
const POST_MM: f32 = 3.0;
const ROW_MM: f32 = 12.0;
const BASE_MM: f32 = 1.0;
/// Height of the lower row of bridges, and of the upper one above it: jaws of a caliper reach below.
const RISE_MM: [f64; 2] = [5.0, 1.5];
/// Widths of ridges and slots in millimetres.
const WIDTHS_MM: [f32; 4] = [0.1, 0.2, 0.3, 0.4];

impl Calibration {
    /// Numbers of layers of the bridges of [`Self::cure`], from the left.
    pub const BRIDGES: [u8; 6] = [1, 2, 3, 4, 6, 8];

    /// Usual thicknesses of their layers, in front and behind.
    pub const BRIDGES_MM: [f64; 2] = [0.05, 0.1];

    /// Bridges of the usual thicknesses by what they measure in millimetres, those in front first. NaN stands for one that was not measured.
    pub fn measured_bridges(measured_mm: &[f64]) -> Vec<Bridge> {
        let bridges = Self::BRIDGES_MM.into_iter();
        let bridges = bridges.flat_map(|layer_mm| Self::BRIDGES.map(|layers| (layer_mm, layers)));
        let measured = bridges.zip(measured_mm).filter(|(_, mm)| !mm.is_nan());
        let measured = measured.map(|((layer_mm, layers), &measured_mm)| Bridge {
            layer_mm,
            layers: u32::from(layers),
            measured_mm,
        });
        measured.collect()
    }

    /// Two towers side by side: both have ten layers of 50 µm, and one goes on with ten of 100 µm. They are 0.5 and 1.5 mm high
    /// if the printer moves to the height of each layer; 0.5 and 1.0 mm, or 1.0 and 2.0 mm, if it takes one thickness for all.
    ///
    /// Of `options`, printer, screen, format and resin count.
    ///
    /// # Errors
    /// [`Error::Options`] if the printer is unknown.
    pub fn layers(options: &Options) -> Result<Self, Error> {
        let mut from_mm = 0.0;
        let sections = TOWERS_MM.map(|layer_mm| {
            let section = Section {
                from_mm,
                layer_mm,
                layers: LAYERS,
                exposure_s: None,
            };
            from_mm = section.to_mm();
            section
        });
        let tower = |index: u8| {
            let x = f32::from(index) * SIDE_MM;
            let top = sections[usize::from(index)].to_mm() as f32;
            // They touch, so that they come off the plate together.
            [Vec3::new(x, 0.0, 0.0), Vec3::new(x + SIDE_MM, SIDE_MM, top)]
        };
        Self::new(vec![tower(0), tower(1)], sections.to_vec(), options)
    }

    /// A grid of towers, one for each pair of a thickness (rows, from the front) and an exposure (columns, from the left). The
    /// top of each has layers of that thickness and exposure, with ridges and slots of 0.1 to 0.4 mm. The first tower has a
    /// bump at its side.
    ///
    /// # Errors
    /// [`Error::Options`] if the printer is unknown; [`Error::Plan`] for a thickness or an exposure out of bounds;
    /// [`Error::Archive`] if the format has no exposure for each layer.
    pub fn exposure(
        options: &Options,
        thickness_mm: &[f64],
        exposure_s: &[f64],
    ) -> Result<Self, Error> {
        let check = |quantity: Quantity, values: &[f64]| {
            let mut values = values.iter();
            values.try_for_each(|&value| quantity.check(value).map(|_| ()))
        };
        let checked = check(Quantity::Layer, thickness_mm);
        let checked = checked.and(check(Quantity::Exposure, exposure_s));
        checked.map_err(crate::plan::PlanError::from)?;
        let Some(&first_mm) = thickness_mm.first() else {
            return Self::layers(options);
        };
        // The bottom layers have an exposure of their own.
        let mut sections = vec![Section {
            from_mm: 0.0,
            layer_mm: first_mm,
            layers: options.resin.bottom_layers.max(1),
            exposure_s: None,
        }];
        let mut boxes = Vec::new();
        for (row, &layer_mm) in thickness_mm.iter().enumerate() {
            for (column, &exposure_s) in exposure_s.iter().enumerate() {
                let section = Section {
                    from_mm: sections[sections.len() - 1].to_mm(),
                    layer_mm,
                    layers: LAYERS,
                    exposure_s: Some(exposure_s),
                };
                let corner = Vec3::new(column as f32, row as f32, 0.0) * PITCH_MM;
                add_tower(&mut boxes, corner, section);
                sections.push(section);
            }
        }
        let bump_mm = sections[0].to_mm() as f32;
        boxes.push([Vec3::new(-1.0, 3.0, 0.0), Vec3::new(0.5, 5.0, bump_mm)]);
        let calibration = Self::new(boxes, sections, options)?;
        let format = calibration.options.resolve()?.output.format;
        if format.thicknesses() != FormatThicknesses::Any {
            return Err(Error::Archive(ArchiveError::UniformOnly {
                format,
                others: Format::VARIABLE,
                best: None,
            }));
        }
        Ok(calibration)
    }

    /// Bridges of 1, 2, 3, 4, 6 and 8 layers over nothing, from the left, numbered: in front of the first thickness, behind of the second.
    /// Measured with a caliper, they say how deep layers cure below themselves ([`crate::cure::fit`]).
    ///
    /// # Errors
    /// [`Error::Options`] if the printer is unknown; [`Error::Plan`] for a thickness out of bounds.
    pub fn cure(options: &Options, thickness_mm: [f64; 2]) -> Result<Self, Error> {
        for layer_mm in thickness_mm {
            let checked = Quantity::Layer.check(layer_mm);
            checked.map_err(crate::plan::PlanError::from)?;
        }
        let most = usize::from(Self::BRIDGES[Self::BRIDGES.len() - 1]);
        let layers_in = |height_mm: f64| (height_mm / thickness_mm[0]).ceil() as usize;
        let [first, between] = RISE_MM.map(layers_in);
        let lower = Section {
            from_mm: 0.0,
            layer_mm: thickness_mm[0],
            layers: first + most + between,
            exposure_s: None,
        };
        let upper = Section {
            from_mm: lower.to_mm(),
            layer_mm: thickness_mm[1],
            layers: most,
            exposure_s: None,
        };
        let step_mm = SPAN_MM + POST_MM;
        let length_mm = Self::BRIDGES.len() as f32 * step_mm + POST_MM;
        let mut boxes = vec![[Vec3::ZERO, Vec3::new(length_mm, 2.0 * ROW_MM, BASE_MM)]];
        let bottoms_mm = [first as f64 * thickness_mm[0], upper.from_mm];
        for (row, (layer_mm, bottom_mm)) in thickness_mm.into_iter().zip(bottoms_mm).enumerate() {
            let y = row as f32 * ROW_MM + ROW_MM / 2.0;
            let z = |layers: u8| (bottom_mm + layer_mm * f64::from(layers)) as f32;
            for post in 0..=Self::BRIDGES.len() {
                let x = post as f32 * step_mm;
                let top = Vec3::new(x + POST_MM, y + BRIDGE_MM, z(most as u8));
                boxes.push([Vec3::new(x, y, 0.0), top]);
            }
            for (place, layers) in Self::BRIDGES.into_iter().enumerate() {
                let x = place as f32 * step_mm;
                let end = x + step_mm + POST_MM;
                let top = Vec3::new(end, y + BRIDGE_MM, z(layers));
                boxes.push([Vec3::new(x, y, z(0)), top]);
                add_digit(
                    &mut boxes,
                    Vec3::new(x + step_mm / 2.0, y - 4.5, BASE_MM),
                    layers,
                );
            }
        }
        let uncompensated = Options {
            resin: Resin {
                print_through: None,
                compensation: Compensation {
                    z_mm: 0.0,
                    ..options.resin.compensation
                },
                ..options.resin.clone()
            },
            ..options.clone()
        };
        Self::new(boxes, vec![lower, upper], &uncompensated)
    }

    fn new(
        boxes: Vec<[Vec3; 2]>,
        sections: Vec<Section>,
        options: &Options,
    ) -> Result<Self, Error> {
        let Output {
            printer, format, ..
        } = options.resolve()?.output;
        if !format.has_masks() {
            return Err(ArchiveError::NoMasks { format }.into());
        }
        // The print itself is to show if the printer prints several thicknesses.
        let printer = printer.map(|printer| {
            let mut printer = Arc::unwrap_or_clone(printer);
            printer.variable_layers = VariableLayers::Yes;
            PrinterChoice::Own(Arc::new(printer))
        });
        let thickness_mm = || sections.iter().map(|section| section.layer_mm);
        let ranges = sections.iter().map(|section| HeightRange {
            from_mm: section.from_mm,
            to_mm: section.to_mm(),
            layer_min_mm: section.layer_mm,
            layer_max_mm: section.layer_mm,
        });
        let options = Options {
            printer,
            pixels: options.pixels,
            pitch_mm: options.pitch_mm,
            pitch_y_mm: options.pitch_y_mm,
            mirror: options.mirror,
            format: options.format,
            rays: options.rays,
            antialias: options.antialias,
            resin: options.resin.clone(),
            ranges: ranges.collect(),
            planes_mm: sections[1..]
                .iter()
                .map(|section| section.from_mm)
                .collect(),
            layer_min_mm: Some(thickness_mm().fold(f64::INFINITY, f64::min)),
            layer_max_mm: Some(thickness_mm().fold(0.0, f64::max)),
            snap: Snap::Off,
            backend: Backend::Cpu,
            ..Options::default()
        };
        Ok(Self {
            boxes,
            sections,
            options,
        })
    }

    /// Its layers, from the plate upward.
    pub fn sections(&self) -> &[Section] {
        &self.sections
    }

    /// The model as a binary STL.
    pub fn stl(&self) -> Vec<u8> {
        let facets: Vec<[Vec3; 3]> = self.boxes.iter().flat_map(|&[a, b]| facets(a, b)).collect();
        let mut stl = vec![0; 80];
        stl.extend((facets.len() as u32).to_le_bytes());
        for facet in facets {
            stl.extend([0; 12]);
            for corner in facet {
                stl.extend(corner.to_array().into_iter().flat_map(f32::to_le_bytes));
            }
            stl.extend([0; 2]);
        }
        stl
    }

    /// Writes the print file. Returns the writer, and the report.
    ///
    /// # Errors
    /// Any [`Error`] of the stages.
    pub async fn write<W: Write>(
        &self,
        writer: W,
        progress: &mut StageProgress<'_>,
    ) -> Result<(W, Report), Error> {
        let mut job = Job::new(vec![LoadedModel::read(&self.stl())?]);
        let options = JobOptions::of(self.options.clone());
        let mut exposure_s = job.plan(&options, progress).await?.plates[0]
            .exposure_s
            .clone();
        let layers = self.sections.iter();
        let layers = layers.flat_map(|section| std::iter::repeat_n(section, section.layers));
        for (layer, section) in exposure_s.iter_mut().zip(layers) {
            *layer = section.exposure_s.unwrap_or(*layer);
        }
        job.expose(0, exposure_s)?;
        let (writer, report) = job.write_archive(0, writer, progress)?;
        Ok((writer, report.clone()))
    }
}

/// A raised digit of seven segments, from the corner at its left and front.
fn add_digit(boxes: &mut Vec<[Vec3; 2]>, corner: Vec3, digit: u8) {
    // Width of a segment, and its length, in millimetres.
    const WIDTH_MM: f32 = 0.5;
    const LENGTH_MM: f32 = 1.5;
    // Top, upper right, lower right, bottom, lower left, upper left, middle: the places of two corners in lengths.
    const SEGMENTS: [[[f32; 2]; 2]; 7] = [
        [[0.0, 2.0], [1.0, 2.0]],
        [[1.0, 1.0], [1.0, 2.0]],
        [[1.0, 0.0], [1.0, 1.0]],
        [[0.0, 0.0], [1.0, 0.0]],
        [[0.0, 0.0], [0.0, 1.0]],
        [[0.0, 1.0], [0.0, 2.0]],
        [[0.0, 1.0], [1.0, 1.0]],
    ];
    const LIT: [u8; 10] = [
        0b011_1111, 0b000_0110, 0b101_1011, 0b100_1111, 0b110_0110, 0b110_1101, 0b111_1101,
        0b000_0111, 0b111_1111, 0b110_1111,
    ];
    let lit = LIT[usize::from(digit % 10)];
    for (segment, [from, to]) in SEGMENTS.into_iter().enumerate() {
        if lit >> segment & 1 == 1 {
            let at = |[x, y]: [f32; 2]| corner + Vec3::new(x * LENGTH_MM, y * LENGTH_MM, 0.0);
            // Into the base, so that they are one body.
            let low = at(from) - Vec3::Z * WIDTH_MM;
            boxes.push([low, at(to) + Vec3::splat(WIDTH_MM)]);
        }
    }
}

/// A tower whose upper half of the section has ridges on its front and slots on its back.
fn add_tower(boxes: &mut Vec<[Vec3; 2]>, corner: Vec3, section: Section) {
    let [middle, top] = [section.layers / 2, section.layers]
        .map(|layers| (section.from_mm + section.layer_mm * layers as f64) as f32);
    let mut add = |from: [f32; 2], to: [f32; 2], top: f32| {
        boxes.push([
            corner + Vec3::new(from[0], from[1], 0.0),
            corner + Vec3::new(to[0], to[1], top),
        ]);
    };
    add([0.0, 0.0], [SIDE_MM, SIDE_MM], middle);
    // Ridges and slots are 2 mm apart, and as long as half the tower, less a millimetre.
    let half = SIDE_MM / 2.0;
    let mut x = 0.0;
    for (index, width) in WIDTHS_MM.into_iter().enumerate() {
        let place = 2.0 * (index as f32 + 1.0);
        add([place, 0.5], [place + width, half - 0.5], top);
        add([x, half], [place, SIDE_MM], top);
        x = place + width;
    }
    add([x, half], [SIDE_MM, SIDE_MM], top);
}

/// The facets of a box between two opposite corners, the first with the smaller coordinates.
fn facets(a: Vec3, b: Vec3) -> [[Vec3; 3]; 12] {
    // Each side as a square, counter-clockwise from outside.
    const SIDES: [[usize; 4]; 6] = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let corner = |index: usize| {
        let pick = |bit: usize, low: f32, high: f32| if index >> bit & 1 == 0 { low } else { high };
        Vec3::new(pick(0, a.x, b.x), pick(1, a.y, b.y), pick(2, a.z, b.z))
    };
    std::array::from_fn(|facet| {
        let side = SIDES[facet / 2];
        let corners = if facet % 2 == 0 { [0, 1, 2] } else { [0, 2, 3] };
        corners.map(|place| corner(side[place]))
    })
}
