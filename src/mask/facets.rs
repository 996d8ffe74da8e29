//! Masks from facets, and from the rays along which bodies overlap.
//!
//! Along any other ray each hit flips its pixel, whatever the other hits are. A facet gives the flips of a row of pixels as spans,
//! one for each layer that it passes through there, so that no hit is stored or sorted.

use std::ops::Range;

use super::entries::{Column, LitRanges};
use super::samples::SublayerOf;
use super::window::Place;
use super::{Change, Masks, Samples, Side, Span, each_change};
use crate::grid::Grid;
use crate::ldi::projection::Projection;
use crate::ldi::{LdiError, Overlaps, RayImage, Survey, sign_of};
use crate::model::Mesh;
use crate::plan::Plan;
use crate::progress::silent;

impl Masks {
    /// [`Masks::of_facets`] of a mesh whose rays are not known.
    ///
    /// # Errors
    /// [`LdiError::OutOfMemory`].
    pub(crate) fn of_mesh(
        mesh: &Mesh,
        [rays, grid]: [&Grid; 2],
        plan: &Plan,
        samples: Samples,
        side: Side,
    ) -> Result<Self, LdiError> {
        let image = RayImage::Scanned { mesh, grid: *rays };
        let (_, overlaps) = Survey::with_overlaps(image, &mut silent)?;
        let grids = [rays, grid];
        Ok(Self::of_facets(mesh, grids, &overlaps, plan, samples, side))
    }

    /// [`Masks::new`] without an LDI: of a mesh whose rays pass through `rays`, some of which overlap.
    ///
    /// Cost: linear in facets, in the rows that they span, and in the pixels that they cover. Memory: as for [`Masks::new`], with a
    /// change for each layer of a facet's row in place of each hit.
    pub fn of_facets(
        mesh: &Mesh,
        [rays, grid]: [&Grid; 2],
        overlaps: &Overlaps,
        plan: &Plan,
        samples: Samples,
        side: Side,
    ) -> Self {
        let projection = Projection::new(mesh, rays);
        let place = Place::new(rays, grid, samples, side);
        let facets = 0..projection.facets() as u32;
        let lists = projection.in_bands(place.bands().len(), facets, |row| {
            place.band_of(row as usize)
        });
        let sublayer_of = SublayerOf::new(plan, samples.sublayers);
        Self::of_bands(plan.layers(), grid, samples, &place, |rows, changes| {
            let facets = lists.of(place.band_of(rows.start));
            let mut band = BandChanges {
                place: &place,
                first_pixel: place.area(&rows).start,
                side,
                samples,
                changes,
            };
            let rows = rows.start as u32..rows.end as u32;
            let of_rows: Vec<_> = rows.clone().map(|row| overlaps.row(row)).collect();
            for &facet in facets {
                let Some(projected) = projection.facet(facet as usize) else {
                    continue;
                };
                let sign = sign_of(mesh.classes.of(facet), projected.faces_up);
                projected
                    .outline
                    .for_each_span(rows.clone(), |row, columns| {
                        let heights = projected.heights(row);
                        for columns in of_rows[(row - rows.start) as usize].others(columns) {
                            sublayer_of.each_range(heights, columns, |sublayer, columns| {
                                band.add(sublayer, row, columns, sign);
                            });
                        }
                    });
            }
            overlaps.each_of_rows(rows, |row, column, hits| {
                let column_ranges = &mut Column::new();
                sublayer_of.of_ray(hits, mesh.classes, column_ranges, |on, off| {
                    if on < off {
                        band.add_ray(on, row, column, 1);
                        band.add_ray(off, row, column, -1);
                    }
                });
            });
        })
    }
}

/// The changes of a band, as they are collected.
struct BandChanges<'a> {
    place: &'a Place,
    /// The first pixel of the band.
    first_pixel: u32,
    side: Side,
    samples: Samples,
    changes: &'a mut Vec<Change>,
}

impl BandChanges<'_> {
    /// Adds the changes of rays of a row that change at a sublayer.
    fn add(&mut self, sublayer: u32, row: u32, columns: Range<u32>, sign: i8) {
        if self.samples != Samples::ONE {
            for column in columns {
                self.add_ray(sublayer, row, column, sign);
            }
            return;
        }
        let first = match self.side {
            Side::Above => columns.start,
            Side::Below => columns.end - 1,
        };
        let mut first = self.place.pixel(row as usize, first as usize) - self.first_pixel;
        let end = first + columns.len() as u32;
        while first < end {
            let pixels = Span::MOST.min(end - first);
            let span = Span::from(first, pixels);
            self.changes.push(Change::new(sublayer, span, sign));
            first += pixels;
        }
    }

    /// Adds the changes of a ray that changes at a sublayer.
    fn add_ray(&mut self, sublayer: u32, row: u32, column: u32, sign: i8) {
        let pixel = self.place.pixel(row as usize, column as usize);
        let span = Span::of(pixel - self.first_pixel);
        let changes = &mut *self.changes;
        each_change(
            sublayer,
            self.samples.sublayers,
            sign,
            span,
            &mut |change| {
                change.join(changes);
            },
        );
    }
}
