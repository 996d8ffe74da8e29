//! Faults of a print file that can be read.

use serde::Serialize;

use super::{Layer, LayerFault, Metadata};

/// Something in a print file that its user should know: a stable code and typed details. `Display` writes one sentence.
/// Layers are numbered from 1; where several have the same fault, the details are the first one's.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify), tsify(missing_as_null))]
#[serde(tag = "code", content = "detail", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FileFinding {
    /// There is no layer.
    NoLayers,
    /// Layers end at a height that is no finite number.
    BadHeights {
        /// Number of such layers.
        layers: usize,
        /// The first of them.
        first_layer: usize,
    },
    /// Layers have an exposure that is no finite number.
    BadExposures {
        /// Number of such layers.
        layers: usize,
        /// The first of them.
        first_layer: usize,
    },
    /// The nominal layer thickness or a nominal exposure is no finite number.
    BadNominalValues,
    /// The first layer ends at or below the plate.
    FirstLayerBelowPlate {
        /// Its top, in millimetres.
        z_mm: f64,
    },
    /// Layers end at or below the top of the layer before.
    HeightsNotAscending {
        /// Number of such layers.
        layers: usize,
        /// The first of them.
        first_layer: usize,
        /// Its top, in millimetres.
        z_mm: f64,
        /// Top of the layer before, in millimetres.
        below_mm: f64,
    },
    /// Layers are of several thicknesses, and the file says that these do not count.
    IgnoredHeights {
        /// The thinnest, in millimetres.
        thinnest_mm: f64,
        /// The thickest, in millimetres.
        thickest_mm: f64,
        /// The thickness that the printer uses instead, in millimetres.
        layer_mm: Option<f64>,
    },
    /// Layers have no exposure.
    NoExposure {
        /// Number of such layers.
        layers: usize,
        /// The first of them.
        first_layer: usize,
    },
    /// No pixel of these layers is lit.
    BlackLayers {
        /// Number of such layers.
        layers: usize,
        /// The first of them.
        first_layer: usize,
        /// Its bottom, in millimetres above the plate.
        from_mm: f64,
    },
    /// Masks cannot be read, or not as they were written.
    BadLayers {
        /// Number of layers with this kind of fault.
        layers: usize,
        /// The first of them.
        first_layer: usize,
        /// Its fault.
        fault: LayerFault,
    },
    /// The bytes that end a layer's settings and data are not where they should be.
    MissingMarks {
        /// Number of such layers.
        layers: usize,
        /// The first of them.
        first_layer: usize,
    },
    /// The bytes that end the file are missing.
    MissingEnd,
    /// A preview is damaged.
    BadPreview {
        /// Its number, from 1.
        preview: usize,
    },
}

/// Number of layers with the same fault, and the first of them.
pub(super) struct Tally<T> {
    pub layers: usize,
    /// Number of the layer, from 1, and its details.
    pub first: Option<(usize, T)>,
}

impl<T> Default for Tally<T> {
    fn default() -> Self {
        Self {
            layers: 0,
            first: None,
        }
    }
}

impl<T> Tally<T> {
    pub fn count(&mut self, layer: usize, detail: T) {
        self.layers += 1;
        if self.first.is_none() {
            self.first = Some((layer, detail));
        }
    }
}

/// Thicknesses that differ by less are equal: heights are rounded to a micrometre.
const SAME_MM: f64 = 0.0015;

/// Number of layers that are affected, and the first of them, counted from 1; `None` if none is.
fn number_and_first(affected: impl Iterator<Item = bool>) -> Option<[usize; 2]> {
    let mut tally = Tally::default();
    for (place, _) in affected.enumerate().filter(|(_, is_affected)| *is_affected) {
        tally.count(place + 1, ());
    }
    tally
        .first
        .map(|(first_layer, ())| [tally.layers, first_layer])
}

/// Takes out exposures and nominal values that are not finite, and says which there were.
pub(super) fn take_not_finite(metadata: &mut Metadata, layers: &mut [Layer]) -> Vec<FileFinding> {
    let take = |value: &mut Option<f64>| value.take_if(|value| !value.is_finite()).is_some();
    let mut findings = Vec::new();
    let nominal = [
        &mut metadata.layer_mm,
        &mut metadata.exposure_s,
        &mut metadata.bottom_exposure_s,
    ];
    if nominal.map(take).contains(&true) {
        findings.push(FileFinding::BadNominalValues);
    }
    let endless = layers.iter_mut().map(|layer| take(&mut layer.exposure_s));
    findings.extend(number_and_first(endless).map(|[layers, first_layer]| {
        FileFinding::BadExposures {
            layers,
            first_layer,
        }
    }));
    findings
}

/// Faults of heights and exposures.
pub(super) fn of_settings(metadata: &Metadata, layers: &[Layer]) -> Vec<FileFinding> {
    let mut findings = Vec::new();
    let Some(first) = layers.first() else {
        return vec![FileFinding::NoLayers];
    };
    let nowhere = layers.iter().map(|layer| !layer.z_mm.is_finite());
    findings.extend(number_and_first(nowhere).map(|[layers, first_layer]| {
        FileFinding::BadHeights {
            layers,
            first_layer,
        }
    }));
    let is_finite = |z_mm: f64| z_mm.is_finite();
    if is_finite(first.z_mm) && first.z_mm <= 0.0 {
        findings.push(FileFinding::FirstLayerBelowPlate { z_mm: first.z_mm });
    }
    let mut fallen = Tally::default();
    for (place, pair) in layers.windows(2).enumerate() {
        let (below_mm, z_mm) = (pair[0].z_mm, pair[1].z_mm);
        if is_finite(below_mm) && is_finite(z_mm) && z_mm <= below_mm {
            fallen.count(place + 2, (z_mm, below_mm));
        }
    }
    if let Some((first_layer, (z_mm, below_mm))) = fallen.first {
        findings.push(FileFinding::HeightsNotAscending {
            layers: fallen.layers,
            first_layer,
            z_mm,
            below_mm,
        });
    }
    let thicknesses = || {
        let thicknesses = layers.iter().map(|layer| layer.thickness_mm);
        thicknesses.filter(|thickness_mm| thickness_mm.is_finite())
    };
    let thinnest_mm = thicknesses().fold(f64::INFINITY, f64::min);
    let thickest_mm = thicknesses().fold(f64::NEG_INFINITY, f64::max);
    if metadata.uses_layer_values == Some(false) && thickest_mm - thinnest_mm > SAME_MM {
        findings.push(FileFinding::IgnoredHeights {
            thinnest_mm,
            thickest_mm,
            layer_mm: metadata.layer_mm,
        });
    }
    let unexposed = layers
        .iter()
        .map(|layer| layer.exposure_s.is_some_and(|exposure_s| exposure_s <= 0.0));
    findings.extend(number_and_first(unexposed).map(|[layers, first_layer]| {
        FileFinding::NoExposure {
            layers,
            first_layer,
        }
    }));
    findings
}

/// Faults of layers, one finding for each kind.
#[derive(Default)]
pub(super) struct Faults(Vec<Tally<LayerFault>>);

impl Faults {
    pub fn count(&mut self, layer: usize, fault: LayerFault) {
        let kind = std::mem::discriminant(&fault);
        let is_same = |tally: &&mut Tally<LayerFault>| {
            let first = tally.first.as_ref();
            first.is_some_and(|(_, first)| std::mem::discriminant(first) == kind)
        };
        if let Some(tally) = self.0.iter_mut().find(is_same) {
            tally.count(layer, fault);
        } else {
            let mut tally = Tally::default();
            tally.count(layer, fault);
            self.0.push(tally);
        }
    }

    pub fn findings(self) -> impl Iterator<Item = FileFinding> {
        self.0.into_iter().filter_map(|tally| {
            let (first_layer, fault) = tally.first?;
            Some(FileFinding::BadLayers {
                layers: tally.layers,
                first_layer,
                fault,
            })
        })
    }
}

impl std::fmt::Display for FileFinding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoLayers => f.write_str("the file has no layers; slice the model again"),
            Self::BadHeights {
                layers,
                first_layer,
            } => write!(
                f,
                "{} at a height that is no number, first layer {first_layer}; export the file again",
                are(*layers, "ends", "end")
            ),
            Self::BadExposures {
                layers,
                first_layer,
            } => write!(
                f,
                "{} an exposure that is no number, first layer {first_layer}; check the exposures and export the file again",
                are(*layers, "has", "have")
            ),
            Self::BadNominalValues => f.write_str(
                "the layer thickness or an exposure for all layers is no number; check the settings and export the file again",
            ),
            Self::FirstLayerBelowPlate { z_mm } => write!(
                f,
                "the first layer ends at {z_mm} mm, not above the plate; slice the model again"
            ),
            Self::HeightsNotAscending {
                layers,
                first_layer,
                z_mm,
                below_mm,
            } => write!(
                f,
                "{} not above the layer below, first layer {first_layer}, at {z_mm} mm after {below_mm} mm; slice the model \
                 again",
                are(*layers, "ends", "end")
            ),
            Self::IgnoredHeights {
                thinnest_mm,
                thickest_mm,
                layer_mm,
            } => {
                write!(
                    f,
                    "layers are {thinnest_mm} to {thickest_mm} mm thick, but the file tells the printer to ignore that"
                )?;
                if let Some(layer_mm) = layer_mm {
                    write!(f, " and to rise by {layer_mm} mm")?;
                }
                f.write_str(
                    "; export it with values for each layer, or slice with layers of one thickness",
                )
            }
            Self::NoExposure {
                layers,
                first_layer,
            } => write!(
                f,
                "{} no exposure, first layer {first_layer}; check the exposures and export the file again",
                are(*layers, "has", "have")
            ),
            Self::BlackLayers {
                layers,
                first_layer,
                from_mm,
            } => write!(
                f,
                "{} black, first layer {first_layer}, from {from_mm:.3} mm up: nothing is printed there; look at the masks",
                are(*layers, "is", "are")
            ),
            Self::BadLayers {
                layers,
                first_layer,
                fault,
            } => write!(
                f,
                "{} damaged, first layer {first_layer}: {fault}; copy or export the file again",
                are(*layers, "is", "are")
            ),
            Self::MissingMarks {
                layers,
                first_layer,
            } => write!(
                f,
                "{} not closed by the bytes 0D 0A, first layer {first_layer}; copy or export the file again",
                are(*layers, "is", "are")
            ),
            Self::MissingEnd => f.write_str(
                "the file does not end as it should; copy it again, it may be cut short",
            ),
            Self::BadPreview { preview } => write!(
                f,
                "preview {preview} is damaged; the printer's screen may show noise, the print is not affected"
            ),
        }
    }
}

/// A number of layers with its verb: "1 layer is", "2 layers are".
fn are(layers: usize, one: &str, several: &str) -> String {
    if layers == 1 {
        format!("1 layer {one}")
    } else {
        format!("{layers} layers {several}")
    }
}
