//! Sublayers at which the rays of a pixel become lit and dark.

use super::samples::SublayerOf;
use crate::cure::{Cure, Light, LitRange};
use crate::ldi::{Hit, printed_entries, printed_ranges};
use crate::model::FacetClasses;

/// Compensation of surfaces that face down, below which light cures more than the layer.
#[derive(Debug, Clone, PartialEq)]
pub enum Raise {
    /// By a distance in millimetres.
    By(f64),
    /// By as much as the layers above cure below them.
    Cured {
        /// Depths to which layers cure.
        cure: Cure,
        /// Steps of brightness that put bottoms between those of layers; 1 for none.
        greys: u32,
    },
}

/// Lit ranges of rays in the masks.
pub(super) trait LitRanges {
    /// Calls `emit(on, off)` for the first lit sublayer and the first dark one above of each range of a ray. `column` is overwritten.
    fn of_ray(
        &self,
        hits: &[Hit],
        classes: FacetClasses,
        column: &mut Column,
        emit: impl FnMut(u32, u32),
    );
}

impl LitRanges for SublayerOf {
    #[inline]
    fn of_ray(
        &self,
        hits: &[Hit],
        classes: FacetClasses,
        _: &mut Column,
        mut emit: impl FnMut(u32, u32),
    ) {
        printed_ranges(hits, classes, |z_in, z_out| {
            emit(self.first_above(z_in), self.first_above(z_out));
        });
    }
}

impl LitRanges for Entries<'_> {
    fn of_ray(
        &self,
        hits: &[Hit],
        classes: FacetClasses,
        column: &mut Column,
        mut emit: impl FnMut(u32, u32),
    ) {
        self.each(hits, classes, column, |on, off, _| emit(on, off));
    }
}

/// Memory for the ranges of one ray, from the plate upward; it serves one ray after another.
pub(super) type Column = Vec<Lit>;

/// Range of a ray before compensation.
#[derive(Clone, Copy)]
pub(super) struct Lit {
    on: u32,
    off: u32,
    z_in: f32,
    is_support: bool,
}

/// Lit ranges whose entries are compensated.
pub(super) struct Entries<'a> {
    pub sublayer_of: &'a SublayerOf,
    /// Sublayers of a layer.
    pub parts: u32,
    pub raise: &'a Raise,
}

impl Entries<'_> {
    /// Calls `emit(on, off, unraised)` for the lit ranges of a ray: its first sublayer, the first dark one above, and the first one without
    /// compensation. A range of which compensation leaves nothing has `on >= off`.
    ///
    /// Entries in the first layer stay, as nothing cures below the plate, and so do those of a range that is lit up to them.
    pub fn each(
        &self,
        hits: &[Hit],
        classes: FacetClasses,
        column: &mut Column,
        mut emit: impl FnMut(u32, u32, u32),
    ) {
        let sublayer_of = self.sublayer_of;
        match self.raise {
            Raise::By(distance_mm) => {
                let mut last_off = 0;
                printed_ranges(hits, classes, |z_in, z_out| {
                    let unraised = sublayer_of.first_above(z_in);
                    let off = sublayer_of.first_above(z_out);
                    let stays = unraised < self.parts || unraised == last_off;
                    let on = if stays {
                        unraised
                    } else {
                        sublayer_of.first_above((f64::from(z_in) + distance_mm) as f32)
                    };
                    last_off = off;
                    emit(on, off, unraised);
                });
            }
            Raise::Cured { cure, .. } => self.each_cured(cure, hits, classes, column, |it| {
                emit(it.on, it.off, it.unraised);
            }),
        }
    }

    /// Calls `emit` for the lit ranges of a ray whose entries make up for cure below them, from the highest down, as light comes from above.
    pub fn each_cured(
        &self,
        cure: &Cure,
        hits: &[Hit],
        classes: FacetClasses,
        ranges: &mut Column,
        mut emit: impl FnMut(&CuredRange),
    ) {
        let parts = self.parts;
        let greys = match self.raise {
            Raise::Cured { greys, .. } => *greys,
            Raise::By(_) => 1,
        };
        ranges.clear();
        printed_entries(hits, classes, |z_in, z_out, is_support| {
            let [on, off] = [z_in, z_out].map(|z_mm| self.sublayer_of.first_above(z_mm));
            match ranges.last_mut() {
                Some(last) if on <= last.off => last.off = off.max(last.off),
                _ if on < off => ranges.push(Lit {
                    on,
                    off,
                    z_in,
                    is_support,
                }),
                _ => {}
            }
        });
        // Most rays leave the plate and meet nothing above.
        if let [it] = ranges[..]
            && it.on < parts
        {
            return emit(&CuredRange::new(it, None, parts));
        }
        let mut light: Option<Light> = None;
        for place in (0..ranges.len()).rev() {
            let it = ranges[place];
            let below = place.checked_sub(1).map(|place| ranges[place]);
            let mut range = CuredRange::new(it, below, parts);
            let lit = range.lit;
            if lit.first < lit.end {
                range.is_raised = lit.first > 0 && !it.is_support;
                if range.is_raised {
                    range.lit = cure.raised(lit.first..lit.end, light, range.z_mm, greys);
                    let mut on = range.lit.first as u32 * parts;
                    if range.lit.brightness < 1.0 {
                        let black = (1.0 - range.lit.brightness) * f64::from(parts);
                        on += black.round() as u32;
                    }
                    // A top that ends within a layer leaves less of it for greys.
                    range.on = on.min(it.off - 1);
                    if let Some(below) = below {
                        // A whole layer may begin within a gap that is thinner than one.
                        range.on = range.on.max(below.off);
                    }
                }
                light = range
                    .below
                    .and_then(|end| cure.light_below(range.lit, light, end));
            }
            emit(&range);
        }
    }
}

/// Lit range of a ray, compensated for the cure below its entry.
pub(super) struct CuredRange {
    /// Its first sublayer without compensation, and the first dark one above.
    pub unraised: u32,
    pub off: u32,
    /// Its first sublayer with compensation.
    pub on: u32,
    /// Its first layer without compensation.
    pub unraised_layer: usize,
    /// Its lit layers.
    pub lit: LitRange,
    /// Height of the model's surface.
    pub z_mm: f64,
    /// True if its entry is compensated.
    pub is_raised: bool,
    /// The first dark layer above the range below.
    pub below: Option<usize>,
}

impl CuredRange {
    /// Returns true if no other layer of the range could be its first, and this one cures too deep: down to `bottom_mm`.
    pub fn is_thin(&self, cure: &Cure, bottom_mm: f64) -> bool {
        let LitRange { first, end, .. } = self.lit;
        let half_mm = 0.5 * cure.thickness_mm(first);
        self.is_raised && first + 1 == end && bottom_mm - self.z_mm < -half_mm
    }

    /// Returns true if it cures down to the range below.
    pub fn closes_gap(&self, cure: &Cure, bottom_mm: f64) -> bool {
        let reaches = |below| bottom_mm <= cure.boundary_mm(below);
        self.is_raised && self.below.is_some_and(reaches)
    }

    /// A range without compensation, and the one below.
    #[inline]
    fn new(it: Lit, below: Option<Lit>, parts: u32) -> Self {
        let layer = (it.on / parts) as usize;
        Self {
            unraised: it.on,
            on: it.on,
            off: it.off,
            unraised_layer: layer,
            // A layer of several heights is lit if most of them are.
            lit: LitRange::white(layer, ((it.off + parts / 2) / parts) as usize),
            z_mm: f64::from(it.z_in),
            is_raised: false,
            below: below.map(|below| (below.off / parts) as usize),
        }
    }
}
