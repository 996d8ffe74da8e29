//! Options for arranging copies.

use serde::{Deserialize, Serialize};

use super::ArrangeError;
use crate::model::TURNS;

/// Options for arranging copies.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
#[serde(default, deny_unknown_fields)]
pub struct Arranging {
    /// Least distance between two copies, in millimetres.
    pub spacing_mm: f64,
    /// Copies may be turned about z by multiples of this many degrees, itself a multiple of 15 that divides 360; 0 leaves them
    /// as they are. They are turned only where that saves a plate.
    pub turn_deg: u32,
}

impl Default for Arranging {
    fn default() -> Self {
        Self {
            spacing_mm: 2.0,
            turn_deg: 45,
        }
    }
}

/// Degrees of a step by which copies turn.
pub const TURN_DEG: u32 = 360 / TURNS;

impl Arranging {
    /// # Errors
    /// [`ArrangeError::BadSpacing`], [`ArrangeError::BadTurn`].
    pub fn check(&self) -> Result<(), ArrangeError> {
        let Self {
            spacing_mm,
            turn_deg,
        } = *self;
        if !(0.0..=MAX_SPACING_MM).contains(&spacing_mm) {
            return Err(ArrangeError::BadSpacing { spacing_mm });
        }
        if turn_deg % TURN_DEG != 0 || (turn_deg > 0 && 360 % turn_deg != 0) {
            return Err(ArrangeError::BadTurn { turn_deg });
        }
        Ok(())
    }

    /// Sets of turns to try, in steps of 15°, from the fewest to the most.
    pub(super) fn turns(&self) -> Vec<Vec<u32>> {
        let mut sets = vec![vec![0]];
        let step = self.turn_deg / TURN_DEG;
        if step > 0 {
            for step in [TURNS / 4, step] {
                let set: Vec<u32> = (0..TURNS).step_by(step as usize).collect();
                if step % (self.turn_deg / TURN_DEG) == 0 && !sets.contains(&set) {
                    sets.push(set);
                }
            }
        }
        sets
    }
}

/// The greatest distance between copies that can be asked for.
const MAX_SPACING_MM: f64 = 100.0;
