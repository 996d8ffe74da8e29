//! Inspection: all layers decoded, and the findings.

use serde::Serialize;

use super::finding::{Faults, Tally, of_settings};
use super::mask::Collector;
use super::{FileFinding, Layer, LayerFault, Mask, Metadata, PrintFile};
use crate::parallel;
use crate::progress::{Cancelled, Progress, report};

/// Metadata of a print file, and statistics of its masks.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify), tsify(missing_as_null))]
pub struct Inspection {
    /// Metadata of the print as a whole.
    #[serde(flatten)]
    pub metadata: Metadata,
    /// Number of layers.
    pub layers: usize,
    /// Top of the last layer whose top is a finite number, in millimetres.
    pub height_mm: f64,
    /// The thinnest and the thickest layer, in millimetres; absent without layers.
    pub thickness_range_mm: Option<[f64; 2]>,
    /// The shortest and the longest exposure that layers state, in seconds.
    pub exposure_range_s: Option<[f64; 2]>,
    /// Volume of the lit pixels, each as high as its layer, in millilitres. Grey pixels count as their brightness.
    pub lit_volume_ml: f64,
    /// Sizes of the previews that could be decoded.
    pub previews: Vec<PreviewSize>,
    /// Faults of the file.
    pub warnings: Vec<FileFinding>,
    /// Each layer, from the plate upward.
    pub layer_values: Vec<LayerInspection>,
}

/// Size of a preview.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify), tsify(missing_as_null))]
pub struct PreviewSize {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// Values that a file states for a layer, and statistics of its mask.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify), tsify(missing_as_null))]
pub struct LayerInspection {
    /// Values stated in the file.
    #[serde(flatten)]
    pub layer: Layer,
    /// Number of pixels that are not black; absent if the mask cannot be decoded.
    pub lit_pixels: Option<u64>,
    /// Number of those that are not white either.
    pub grey_pixels: Option<u64>,
}

/// Statistics of a layer's mask.
#[derive(Default)]
struct Light {
    lit: u64,
    grey: u64,
    /// The sum of all pixels, of which white is 255.
    brightness: u64,
}

/// Decodes all layers and previews of a file.
///
/// # Errors
/// [`Cancelled`], if the progress callback asks for it. Faults of the file are in [`Inspection::warnings`].
pub fn inspect(file: &PrintFile<'_>, progress: &mut Progress<'_>) -> Result<Inspection, Cancelled> {
    look_through(file, None, progress)
}

/// The same, and passes the mask of each layer on, from the plate upward, seen from above: what could be decoded of it.
///
/// # Errors
/// [`Cancelled`].
pub fn inspect_masks(
    file: &PrintFile<'_>,
    take: &mut dyn FnMut(Mask),
    progress: &mut Progress<'_>,
) -> Result<Inspection, Cancelled> {
    look_through(file, Some(take), progress)
}

fn look_through(
    file: &PrintFile<'_>,
    mut take: Option<&mut dyn FnMut(Mask)>,
    progress: &mut Progress<'_>,
) -> Result<Inspection, Cancelled> {
    report(progress, 0.0)?;
    let (metadata, layers) = (file.metadata(), file.layers());
    let mut warnings = of_settings(metadata, layers);
    warnings.extend(file.contents.findings.iter().cloned());

    let mut layer_values = Vec::with_capacity(layers.len());
    let (mut black, mut faults) = (Tally::default(), Faults::default());
    let pixel_mm2 = metadata.pixel_mm[0] * metadata.pixel_mm[1];
    let mut volume_mm3 = 0.0;
    let has_masks = take.is_some();
    parallel::map_in_groups(
        0..layers.len(),
        |place| light(file, place, has_masks),
        |(light, mask, fault): (Light, Option<Mask>, Option<LayerFault>)| {
            if let (Some(take), Some(mask)) = (&mut take, mask) {
                take(mask);
            }
            let place = layer_values.len();
            let layer = layers[place];
            let is_whole = fault.is_none();
            if let Some(fault) = fault {
                faults.count(place + 1, fault);
            } else if light.lit == 0 {
                let below = place.checked_sub(1).map(|below| layers[below].z_mm);
                black.count(place + 1, below.unwrap_or(0.0));
            }
            if layer.thickness_mm.is_finite() {
                volume_mm3 += light.brightness as f64 / 255.0 * pixel_mm2 * layer.thickness_mm;
            }
            layer_values.push(LayerInspection {
                layer,
                lit_pixels: is_whole.then_some(light.lit),
                grey_pixels: is_whole.then_some(light.grey),
            });
            Ok::<_, Cancelled>(())
        },
        progress,
        [0.0, 1.0],
    )?;
    if let Some((first_layer, from_mm)) = black.first {
        warnings.push(FileFinding::BlackLayers {
            layers: black.layers,
            first_layer,
            from_mm,
        });
    }
    warnings.extend(faults.findings());

    let mut previews = Vec::with_capacity(file.previews());
    for place in 0..file.previews() {
        match file.preview(place) {
            Some(preview) => previews.push(PreviewSize {
                width: preview.width,
                height: preview.height,
            }),
            None => warnings.push(FileFinding::BadPreview { preview: place + 1 }),
        }
    }
    let mut tops_mm = layers.iter().map(|layer| layer.z_mm);
    Ok(Inspection {
        metadata: metadata.clone(),
        layers: layers.len(),
        height_mm: tops_mm.rfind(|z_mm| z_mm.is_finite()).unwrap_or(0.0),
        thickness_range_mm: range(layers.iter().map(|layer| layer.thickness_mm)),
        exposure_range_s: range(layers.iter().filter_map(|layer| layer.exposure_s)),
        lit_volume_ml: volume_mm3 / 1000.0,
        previews,
        warnings,
        layer_values,
    })
}

fn light(
    file: &PrintFile<'_>,
    layer: usize,
    has_mask: bool,
) -> (Light, Option<Mask>, Option<LayerFault>) {
    let metadata = file.metadata();
    let mut light = Light::default();
    let mut collector = has_mask.then(|| Collector::new(metadata.pixels[0]));
    let decoded = file.runs(layer, &mut |grey, count| {
        if let Some(collector) = &mut collector {
            collector.run(grey, count);
        }
        let count = u64::from(count);
        light.brightness += u64::from(grey) * count;
        match grey {
            0 => {}
            255 => light.lit += count,
            _ => {
                light.lit += count;
                light.grey += count;
            }
        }
    });
    let mask = collector.map(|collector| {
        let stored = collector.finish();
        stored.seen_from_above(metadata.pixels, metadata.flips())
    });
    (light, mask, decoded.err())
}

/// The least and the greatest of the finite values.
fn range(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let finite = values.filter(|value| value.is_finite());
    finite.fold(None, |range: Option<[f64; 2]>, value| {
        let [least, greatest] = range.unwrap_or([value; 2]);
        Some([least.min(value), greatest.max(value)])
    })
}
