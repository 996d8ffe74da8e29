//! Findings of the checks, and their sentences.

use std::fmt::{self, Display, Formatter};

use serde::Serialize;

use super::limits::Severity;

/// The kinds of findings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "kebab-case")]
pub enum Code {
    /// Lit pixels with nothing below, which join something later.
    Island,
    /// A body that touches neither the plate nor another body.
    LooseBody,
    /// A body on the plate that touches no other, except the largest.
    SeparateBody,
    /// A loose body of a few pixels or of one layer.
    Speck,
    /// A surface that is too flat to support itself reaches out too far.
    Overhang,
    /// A hollow that is open only away from the plate while it is printed.
    Cup,
    /// A hollow that is open nowhere once it is printed.
    Trap,
    /// A hollow that resin leaves only through openings that are too narrow.
    NarrowDrain,
    /// A wall, or another part, that is too thin within layers.
    ThinWall,
    /// A floor, a roof, or another part, that is too thin along z.
    ThinFloor,
    /// A gap, or a hole, that is too narrow within layers.
    NarrowGap,
    /// A hole that is too small, however it is measured within layers.
    SmallHole,
    /// A gap that is too low along z.
    LowGap,
    /// A roof so thin that its last layer alone cures too deep below it.
    ThinRoof,
    /// A gap that closes, as light through its roof cures it.
    ClosedGap,
    /// A layer that is too large to peel off.
    PeelArea,
    /// A layer that is too much larger than the one below.
    PeelJump,
    /// Too little area on the plate.
    SmallContact,
}

impl Code {
    /// All kinds, in the order in which findings are listed.
    pub const ALL: [Self; 18] = [
        Self::Island,
        Self::LooseBody,
        Self::SeparateBody,
        Self::Speck,
        Self::Overhang,
        Self::Cup,
        Self::Trap,
        Self::NarrowDrain,
        Self::ThinWall,
        Self::ThinFloor,
        Self::NarrowGap,
        Self::SmallHole,
        Self::LowGap,
        Self::ThinRoof,
        Self::ClosedGap,
        Self::PeelArea,
        Self::PeelJump,
        Self::SmallContact,
    ];

    /// The code, as in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Island => "island",
            Self::LooseBody => "loose-body",
            Self::SeparateBody => "separate-body",
            Self::Speck => "speck",
            Self::Overhang => "overhang",
            Self::Cup => "cup",
            Self::Trap => "trap",
            Self::NarrowDrain => "narrow-drain",
            Self::ThinWall => "thin-wall",
            Self::ThinFloor => "thin-floor",
            Self::NarrowGap => "narrow-gap",
            Self::SmallHole => "small-hole",
            Self::LowGap => "low-gap",
            Self::ThinRoof => "thin-roof",
            Self::ClosedGap => "closed-gap",
            Self::PeelArea => "peel-area",
            Self::PeelJump => "peel-jump",
            Self::SmallContact => "small-contact",
        }
    }
}

/// Something that may fail, and where.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Finding {
    /// Its kind.
    pub code: Code,
    /// Its severity.
    pub severity: Severity,
    /// A point of it: x, y and z in millimetres, with the model centred on x = y = 0 and the plate at z = 0.
    pub at_mm: [f64; 3],
    /// The smallest and the largest x, y and z of it.
    pub bounds_mm: [[f64; 3]; 2],
    /// The first and the last layer of it, from 0.
    pub layers: [usize; 2],
    /// Its largest area in a layer, in mm².
    pub area_mm2: f64,
    /// Its volume in mm³: the lit volume of a body, or of an island until it joins another, the dark volume of a cup or
    /// a trap, and of a narrow drain the dark volume with room for the limit.
    pub volume_mm3: f64,
    /// For islands, the layer that joins them with something else, from 0.
    pub joins_layer: Option<usize>,
    /// The limit that it exceeds or falls below, in the unit of the limit.
    pub limit: f64,
}

impl Finding {
    /// Weight by which it is compared with others of its kind.
    pub(super) fn weight(&self) -> f64 {
        match self.code {
            Code::Cup
            | Code::ThinRoof
            | Code::ClosedGap
            | Code::PeelArea
            | Code::PeelJump
            | Code::SmallContact => self.area_mm2,
            _ => self.volume_mm3,
        }
    }
}

/// One sentence that states the finding, and what to do.
impl Display for Finding {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [first, last] = self.layers.map(|layer| layer + 1);
        let (area, volume, limit) = (self.area_mm2, self.volume_mm3, self.limit);
        match self.code {
            Code::Island => {
                let joins = self.joins_layer.map_or(last + 1, |layer| layer + 1);
                write!(
                    f,
                    "an island starts in layer {first} and joins the rest in layer {joins}, after growing to {volume:.3} mm³; \
                     support it, or turn the model"
                )
            }
            Code::LooseBody => write!(
                f,
                "a body of {volume:.3} mm³ touches neither the plate nor another body; support it, join it, or leave it out"
            ),
            Code::SeparateBody => write!(
                f,
                "a body of {volume:.3} mm³ on the plate touches no other; join them if they are meant to be one"
            ),
            Code::Speck => write!(
                f,
                "a few pixels touch nothing, {area:.4} mm² in {} layers; remove them from the model",
                last + 1 - first
            ),
            Code::Overhang => write!(
                f,
                "surfaces of {area:.2} mm² overhang by more than {limit} mm, too flat to support themselves; support them, or turn the model"
            ),
            Code::Cup => write!(
                f,
                "a hollow of {:.3} ml opens only away from the plate, and sucks at the film with up to {area:.1} mm²; make a hole near the \
                 plate, or turn the model",
                volume / 1e3
            ),
            Code::Trap => write!(
                f,
                "{:.3} ml of resin are enclosed; make two holes to drain them",
                volume / 1e3
            ),
            Code::NarrowDrain => write!(
                f,
                "at least {:.3} ml of resin can drain only through openings narrower than {limit} mm; widen them, or add one",
                volume / 1e3
            ),
            Code::ThinWall => write!(
                f,
                "a wall is thinner than {limit} mm over {volume:.3} mm³; make it thicker, or the model larger"
            ),
            Code::ThinFloor => write!(
                f,
                "a floor is thinner than {limit} mm along z over {area:.2} mm²; make it thicker, or the model larger"
            ),
            Code::NarrowGap => write!(
                f,
                "a gap is narrower than {limit} mm over {volume:.3} mm³ and may close; make it wider, or the model larger"
            ),
            Code::SmallHole => write!(
                f,
                "a hole is smaller than {limit} mm over {volume:.3} mm³ and may close; make it wider, or the model larger"
            ),
            Code::LowGap => write!(
                f,
                "a gap is lower than {limit} mm along z over {area:.2} mm² and may close; make it higher, or turn the model"
            ),
            Code::ThinRoof => write!(
                f,
                "a roof of {area:.2} mm² is so thin that its last layer alone cures too deep; make it thicker, or turn the model"
            ),
            Code::ClosedGap => write!(
                f,
                "a gap of {area:.2} mm² closes, as light through its roof cures it; make it higher, or turn the model"
            ),
            Code::PeelArea => write!(
                f,
                "the layer peels {area:.1} mm² off the film, more than the limit of {limit}; turn the model, or hollow it"
            ),
            Code::PeelJump => write!(
                f,
                "the layer peels {area:.1} mm² more off the film than the one below; the limit is {limit}; turn the model"
            ),
            Code::SmallContact => write!(
                f,
                "only {area:.2} mm² hold the print on the plate, less than {limit} of its largest layer; put it on a raft, or turn \
                 it"
            ),
        }
    }
}
