//! Acceptance rules of a shop: thresholds, and the severity of each kind of finding.

use serde::{Deserialize, Serialize};

use super::finding::{Code, Finding};

/// Severity of a finding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Ignored: the checks do not look for it.
    Ignore,
    /// Reported, though it spoils no print.
    Note,
    /// A person should check it before printing.
    Review,
    /// The print is rejected.
    Reject,
}

/// Thresholds of the checks, and the severity of their findings. The defaults are the least strict of the rules that
/// printing services publish for resin, so most services would ask about every finding.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(default, deny_unknown_fields)]
pub struct Limits {
    /// Islands count from this area on: the largest of a layer before they join something, in mm².
    pub island_mm2: f64,
    /// A body that touches no other and has fewer pixels than this in every layer is a speck.
    pub speck_px: u32,
    /// The flattest surface that supports itself, as its rise over its run.
    pub self_supporting_slope: f64,
    /// Greatest overhang of a flatter surface, in millimetres.
    pub overhang_mm: f64,
    /// Greatest span of it from one support to another, in millimetres.
    pub bridge_mm: f64,
    /// Cups count from this area on: the largest of a layer, in mm².
    pub cup_mm2: f64,
    /// Traps count from this volume on, in millilitres.
    pub trap_ml: f64,
    /// The narrowest drain of a hollow, in millimetres.
    #[serde(alias = "escape_mm")]
    pub drain_mm: f64,
    /// The thinnest wall, across layers, in millimetres.
    pub wall_mm: f64,
    /// The thinnest floor or roof, along z, in millimetres.
    pub floor_mm: f64,
    /// The narrowest gap, across layers, in millimetres.
    pub gap_mm: f64,
    /// The smallest hole, across layers, in millimetres.
    pub hole_mm: f64,
    /// The lowest gap, along z, in millimetres.
    pub low_gap_mm: f64,
    /// Thin roofs and closed gaps, which print-through makes, count from this area on: the largest of a layer, in mm².
    pub print_through_mm2: f64,
    /// The largest area of a layer, in mm²; no limit if absent.
    pub peel_mm2: Option<f64>,
    /// The largest growth of the area from one layer to the next, in mm²; no limit if absent.
    pub peel_jump_mm2: Option<f64>,
    /// The least area on the plate as a fraction of the largest layer's; no limit if absent.
    pub contact: Option<f64>,
    /// Islands and loose bodies below this volume are notes, in mm³: flakes that the next layer catches.
    pub note_mm3: f64,
    /// Islands and loose bodies are rejected from this volume on, in mm³: pieces that drift in the vat, or hang from their arm alone.
    pub reject_mm3: f64,
    /// Traps, cups and hollows with narrow drains below this volume are notes, in millilitres: a drop.
    pub note_ml: f64,
    /// Thin floors and low gaps below this area are notes, in mm², as are walls, gaps and holes of less than this area times their
    /// limit: tips and edges of every model.
    pub note_mm2: f64,
    /// The severity of each kind of finding, at most: small findings have a lower one.
    pub severity: Severities,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            island_mm2: 0.01,
            speck_px: 4,
            // 19° from level.
            self_supporting_slope: 0.344,
            overhang_mm: 1.0,
            bridge_mm: 5.0,
            cup_mm2: 1.0,
            trap_ml: 0.001,
            drain_mm: 2.0,
            wall_mm: 0.4,
            floor_mm: 0.4,
            gap_mm: 0.3,
            hole_mm: 0.5,
            low_gap_mm: 0.3,
            print_through_mm2: 1.0,
            peel_mm2: None,
            peel_jump_mm2: None,
            contact: None,
            note_mm3: 0.5,
            reject_mm3: 10.0,
            note_ml: 0.05,
            note_mm2: 0.25,
            severity: Severities::default(),
        }
    }
}

/// The largest severity of each kind of finding, by its code.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Severities {
    /// Lit pixels with nothing below, which join something later.
    pub island: Severity,
    /// A body that touches neither the plate nor another body.
    pub loose_body: Severity,
    /// A body on the plate that touches no other.
    pub separate_body: Severity,
    /// A loose body of a few pixels or of one layer.
    pub speck: Severity,
    /// A surface that reaches out too far.
    pub overhang: Severity,
    /// A hollow that is open only away from the plate.
    pub cup: Severity,
    /// A hollow that is open nowhere.
    pub trap: Severity,
    /// A hollow whose openings are too narrow.
    #[serde(alias = "small-escape")]
    pub narrow_drain: Severity,
    /// A wall that is too thin.
    pub thin_wall: Severity,
    /// A floor or a roof that is too thin.
    pub thin_floor: Severity,
    /// A gap that is too narrow.
    pub narrow_gap: Severity,
    /// A hole that is too small.
    pub small_hole: Severity,
    /// A gap that is too low.
    pub low_gap: Severity,
    /// A roof that is thinner than light cures.
    pub thin_roof: Severity,
    /// A gap that light closes.
    pub closed_gap: Severity,
    /// A layer that is too large.
    pub peel_area: Severity,
    /// A layer that is too much larger than the one below.
    pub peel_jump: Severity,
    /// Too little area on the plate.
    pub small_contact: Severity,
}

impl Default for Severities {
    fn default() -> Self {
        Self {
            island: Severity::Reject,
            loose_body: Severity::Reject,
            separate_body: Severity::Ignore,
            speck: Severity::Note,
            overhang: Severity::Review,
            cup: Severity::Review,
            trap: Severity::Reject,
            narrow_drain: Severity::Review,
            thin_wall: Severity::Review,
            thin_floor: Severity::Review,
            narrow_gap: Severity::Review,
            small_hole: Severity::Review,
            low_gap: Severity::Review,
            thin_roof: Severity::Review,
            closed_gap: Severity::Review,
            peel_area: Severity::Review,
            peel_jump: Severity::Review,
            small_contact: Severity::Review,
        }
    }
}

impl Severities {
    /// Looks for pieces that begin with nothing below them, and for nothing else.
    const FLOATING: Self = {
        let rest = Severity::Ignore;
        Self {
            island: Severity::Review,
            loose_body: Severity::Review,
            separate_body: rest,
            speck: rest,
            overhang: rest,
            cup: rest,
            trap: rest,
            narrow_drain: rest,
            thin_wall: rest,
            thin_floor: rest,
            narrow_gap: rest,
            small_hole: rest,
            low_gap: rest,
            thin_roof: rest,
            closed_gap: rest,
            peel_area: rest,
            peel_jump: rest,
            small_contact: rest,
        }
    };

    /// The largest severity of a kind of finding.
    pub fn of(&self, code: Code) -> Severity {
        match code {
            Code::Island => self.island,
            Code::LooseBody => self.loose_body,
            Code::SeparateBody => self.separate_body,
            Code::Speck => self.speck,
            Code::Overhang => self.overhang,
            Code::Cup => self.cup,
            Code::Trap => self.trap,
            Code::NarrowDrain => self.narrow_drain,
            Code::ThinWall => self.thin_wall,
            Code::ThinFloor => self.thin_floor,
            Code::NarrowGap => self.narrow_gap,
            Code::SmallHole => self.small_hole,
            Code::LowGap => self.low_gap,
            Code::ThinRoof => self.thin_roof,
            Code::ClosedGap => self.closed_gap,
            Code::PeelArea => self.peel_area,
            Code::PeelJump => self.peel_jump,
            Code::SmallContact => self.small_contact,
        }
    }
}

/// The largest thickness or distance that is looked for, in millimetres.
const MOST_MM: f64 = 20.0;

/// Error of invalid limits.
#[derive(Debug, Clone, PartialEq, thiserror::Error, Serialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(tag = "code", content = "detail")]
#[non_exhaustive]
pub enum LimitsError {
    /// A number is out of bounds.
    #[error("{limit} is {value}, but must be from {least} to {most}")]
    #[serde(rename = "bad-limit")]
    OutOfBounds {
        /// The field.
        limit: &'static str,
        /// Its value.
        value: f64,
        /// The smallest possible value.
        least: f64,
        /// The largest possible value.
        most: f64,
    },
}

impl Limits {
    /// The usual limits for pieces that begin with nothing below them, and for nothing else.
    pub(super) fn of_floating() -> Self {
        Self {
            severity: Severities::FLOATING,
            ..Self::default()
        }
    }

    /// Severity of a finding by its kind and size.
    pub(super) fn severity_of(&self, finding: &Finding) -> Severity {
        let Finding {
            code,
            area_mm2,
            volume_mm3,
            limit,
            ..
        } = *finding;
        let is_small = match code {
            Code::Island | Code::LooseBody => volume_mm3 < self.note_mm3,
            Code::Trap | Code::Cup | Code::NarrowDrain => volume_mm3 < self.note_ml * 1e3,
            Code::ThinFloor | Code::LowGap => area_mm2 < self.note_mm2,
            Code::ThinWall | Code::NarrowGap | Code::SmallHole => {
                volume_mm3 < self.note_mm2 * limit
            }
            _ => false,
        };
        let by_size = match code {
            _ if is_small => Severity::Note,
            Code::Island | Code::LooseBody if volume_mm3 < self.reject_mm3 => Severity::Review,
            _ => Severity::Reject,
        };
        by_size.min(self.severity.of(code))
    }

    /// Returns true if findings of a kind matter at all.
    pub fn looks_for(&self, code: Code) -> bool {
        self.severity.of(code) != Severity::Ignore
    }

    /// Checks that every number is within its bounds.
    ///
    /// # Errors
    /// [`LimitsError`].
    pub fn check(&self) -> Result<(), LimitsError> {
        let lengths = [
            ("overhang_mm", self.overhang_mm),
            ("drain_mm", self.drain_mm),
            ("wall_mm", self.wall_mm),
            ("floor_mm", self.floor_mm),
            ("gap_mm", self.gap_mm),
            ("hole_mm", self.hole_mm),
            ("low_gap_mm", self.low_gap_mm),
        ];
        let others = [
            ("island_mm2", Some(self.island_mm2)),
            ("bridge_mm", Some(self.bridge_mm)),
            ("cup_mm2", Some(self.cup_mm2)),
            ("print_through_mm2", Some(self.print_through_mm2)),
            ("trap_ml", Some(self.trap_ml)),
            ("peel_mm2", self.peel_mm2),
            ("peel_jump_mm2", self.peel_jump_mm2),
            ("contact", self.contact),
            ("note_mm3", Some(self.note_mm3)),
            ("reject_mm3", Some(self.reject_mm3)),
            ("note_ml", Some(self.note_ml)),
            ("note_mm2", Some(self.note_mm2)),
        ];
        let slope = (
            "self_supporting_slope",
            self.self_supporting_slope,
            0.01,
            100.0,
        );
        let lengths = lengths.map(|(name, value)| (name, value, 0.0, MOST_MM));
        let others = others.map(|(name, value)| (name, value.unwrap_or(0.0), 0.0, f64::MAX));
        let mut all = lengths.into_iter().chain(others).chain([slope]);
        match all.find(|(_, value, least, most)| !(*least..=*most).contains(value)) {
            Some((limit, value, least, most)) => Err(LimitsError::OutOfBounds {
                limit,
                value,
                least,
                most,
            }),
            None => Ok(()),
        }
    }
}
