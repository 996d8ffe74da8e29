//! Masks whose changes are found slab by slab, while they are read.
//!
//! All masks together have as many changes as an LDI has hits. If neither fits into memory, a few layers at a time do:
//! a slab is the number of layers whose changes fit the limit. Its hits are found again, and a winding number per ray
//! says how each enters it.

use std::collections::BTreeMap;
use std::ops::Range;

use super::runs::ReadPlace;
use super::samples::SublayerOf;
use super::window::Place;
use super::{
    Band, Change, Compensations, LayerRuns, Masks, RunReader, RunSource, Samples, Side, Span,
    each_change,
};
use crate::grid::Grid;
use crate::ldi::cpu::Scan;
use crate::ldi::projection::Projection;
use crate::ldi::{Hit, RayImage, printed_crossings};
use crate::model::{FacetClasses, Mesh, Winding};
use crate::parallel;
use crate::plan::Plan;

/// The masks of a plan: those of [`Masks::new`], without an LDI.
#[derive(Debug)]
pub struct SlabMasks<'a> {
    mesh: &'a Mesh,
    /// The rays.
    rays: Grid,
    plan: &'a Plan,
    grid: Grid,
    samples: Samples,
    place: Place,
    /// The layers of each slab.
    slabs: Vec<Range<usize>>,
}

impl<'a> SlabMasks<'a> {
    /// The masks of `plan` on `grid` of a mesh whose rays pass through `rays`. The changes of a slab take about `slab_bytes`, or are
    /// those of a single layer.
    pub fn new(
        mesh: &'a Mesh,
        rays: Grid,
        plan: &'a Plan,
        grid: &Grid,
        samples: Samples,
        side: Side,
        slab_bytes: u64,
    ) -> Self {
        let most = (slab_bytes / Masks::bytes_per_hit(samples)) as f64;
        let mut slabs: Vec<Range<usize>> = Vec::new();
        let mut held = 0.0;
        for (layer, hits) in hits_of_layers(mesh, &rays, plan).into_iter().enumerate() {
            held += hits;
            match slabs.last_mut() {
                Some(slab) if held <= most => slab.end = layer + 1,
                _ => {
                    slabs.push(layer..layer + 1);
                    held = hits;
                }
            }
        }
        Self {
            mesh,
            place: Place::new(&rays, grid, samples, side),
            rays,
            plan,
            grid: *grid,
            samples,
            slabs,
        }
    }
}

/// About how many hits each layer has: those of a facet are spread evenly over the layers that it reaches into.
fn hits_of_layers(mesh: &Mesh, rays: &Grid, plan: &Plan) -> Vec<f64> {
    let layers = plan.layers();
    let middles = SublayerOf::new(plan, 1);
    let layer_of = |z_mm: f32| (middles.first_above(z_mm) as usize).min(layers - 1);
    // Increase in hits from each layer to the next.
    let mut rises = vec![0.0; layers + 1];
    for facet in 0..mesh.facets.len() {
        let of = mesh.facets[facet].map(|vertex| layer_of(mesh.vertices[vertex as usize].z));
        let (first, last) = (of[0].min(of[1]).min(of[2]), of[0].max(of[1]).max(of[2]));
        let hits = mesh.projected_mm2(facet) / rays.pixel_mm2() / (last - first + 1) as f64;
        rises[first] += hits;
        rises[last + 1] -= hits;
    }
    let mut hits = 0.0;
    let rises = rises.into_iter().take(layers);
    rises
        .map(|rise| {
            hits += rise;
            hits
        })
        .collect()
}

/// The masks of [`Masks::compensated`], without an LDI.
#[derive(Debug)]
pub struct CompensatedSlabs<'a> {
    /// The masks without compensation, whose slabs these have, too.
    pub masks: SlabMasks<'a>,
    /// The rays.
    pub image: RayImage<'a>,
    /// The side from which masks are seen.
    pub side: Side,
    /// Compensations in the masks.
    pub compensations: &'a Compensations,
}

impl RunSource for CompensatedSlabs<'_> {
    /// Compensation depends on all hits of a ray, so each slab passes over all rays.
    fn reader(&self) -> Box<dyn RunReader + '_> {
        let Self {
            image,
            side,
            compensations,
            ref masks,
        } = *self;
        let SlabMasks {
            plan,
            ref grid,
            samples,
            ..
        } = *masks;
        Reader::boxed(&masks.slabs, move |layers| {
            image.read(|image| {
                Masks::compensated_layers(image, plan, layers, grid, samples, side, compensations)
            })
        })
    }
}

impl RunSource for SlabMasks<'_> {
    fn reader(&self) -> Box<dyn RunReader + '_> {
        let bands = self.place.bands();
        let windings = bands.iter().map(|rows| {
            let rays = rows.len() * self.rays.width as usize;
            Windings::new(rays, self.mesh.classes)
        });
        let carried = bands.iter().map(|_| Vec::new()).collect();
        let mut finder = Finder {
            projection: Projection::new(self.mesh, &self.rays),
            sublayer_of: SublayerOf::new(self.plan, self.samples.sublayers),
            windings: windings.collect(),
            carried,
            bands,
            masks: self,
        };
        Reader::boxed(&self.slabs, move |layers| finder.find(layers))
    }
}

/// Reads masks that `find` makes slab by slab.
struct Reader<'a, F> {
    slabs: &'a [Range<usize>],
    find: F,
    /// The next slab.
    next: usize,
    /// The masks of the slab before it, and how far they have been read.
    slab: Option<(Masks, ReadPlace)>,
}

impl<'a, F: FnMut(Range<usize>) -> Masks + 'a> Reader<'a, F> {
    fn boxed(slabs: &'a [Range<usize>], find: F) -> Box<dyn RunReader + 'a> {
        Box::new(Self {
            slabs,
            find,
            next: 0,
            slab: None,
        })
    }

    /// Finds the masks of the next slab in place of the last.
    fn open_slab(&mut self) {
        let read = self.slab.take().map(|(_, read)| read);
        let masks = (self.find)(self.slabs[self.next].clone());
        self.next += 1;
        let read = read.map_or_else(|| ReadPlace::new(&masks), ReadPlace::restarted);
        self.slab = Some((masks, read));
    }
}

impl<'a, F: FnMut(Range<usize>) -> Masks + 'a> RunReader for Reader<'a, F> {
    fn next(&mut self, layers: usize) -> LayerRuns {
        let mut found = Vec::new();
        let mut left = layers;
        while left > 0 {
            match &mut self.slab {
                Some((masks, read)) if read.left(masks) > 0 => {
                    let count = left.min(read.left(masks));
                    left -= count;
                    found.push(read.next(masks, count));
                }
                _ => self.open_slab(),
            }
        }
        LayerRuns::joined(found)
    }
}

/// Finds the masks of one slab after another.
struct Finder<'a> {
    masks: &'a SlabMasks<'a>,
    projection: Projection<'a>,
    sublayer_of: SublayerOf,
    /// The rows of rays of each band of pixels.
    bands: Vec<Range<usize>>,
    /// For each band, the winding numbers with which its rays enter the next slab.
    windings: Vec<Windings>,
    /// For each band, changes that already belong to the next slab.
    carried: Vec<Vec<Change>>,
}

impl Finder<'_> {
    fn find(&mut self, layers: Range<usize>) -> Masks {
        let SlabMasks {
            mesh,
            rays,
            samples,
            place,
            ..
        } = self.masks;
        let heights = self.sublayer_of.slab(&layers, samples.sublayers);
        let width = rays.width as usize;
        let scan = Scan::of_slab(&self.projection, rays, mesh.classes, heights);
        let work = self.bands.iter().cloned();
        let work = work
            .zip(self.windings.drain(..))
            .zip(self.carried.drain(..));
        let sublayer_of = &self.sublayer_of;
        let found = parallel::map(work.collect(), |((rows, mut windings), mut changes)| {
            let area = place.area(&rows);
            let mut rest = rows.start as u32..rows.end as u32;
            let mut first_ray = 0;
            while !rest.is_empty() {
                let scanned = scan.first_of(rest.clone(), heights);
                for (ray, hits) in scanned.rays().each().enumerate() {
                    if hits.is_empty() {
                        continue;
                    }
                    let (row, column) = (ray / width, ray % width);
                    let pixel = place.pixel(rest.start as usize + row, column);
                    let span = Span::of(pixel - area.start);
                    let ray = first_ray + ray;
                    let below = windings.get(ray);
                    let mut flip = |sublayer, sign| {
                        each_change(sublayer, samples.sublayers, sign, span, &mut |change| {
                            change.join(&mut changes);
                        });
                    };
                    let above = flips_along(hits, mesh.classes, below, sublayer_of, &mut flip);
                    windings.set(ray, above);
                }
                let count = scanned.rays().count();
                first_ray += count;
                rest.start += (count / width) as u32;
            }
            let later = changes.extract_if(.., |change| change.layer() >= layers.end);
            let later = later.collect();
            for change in &mut changes {
                change.lower(layers.start);
            }
            let band = Band::new(area, layers.len(), *samples, &changes);
            (windings, later, band)
        });
        let mut bands = Vec::with_capacity(found.len());
        for (windings, later, band) in found {
            self.windings.push(windings);
            self.carried.push(later);
            bands.push(band);
        }
        Masks {
            grid: self.masks.grid,
            samples: *samples,
            window: place.window,
            layers: layers.len(),
            bands,
        }
    }
}

/// Calls `flip(sublayer, sign)` where a ray enters the printed solid, and where it leaves it: see
/// [`printed_crossings`].
fn flips_along(
    hits: &[Hit],
    classes: FacetClasses,
    winding: Winding,
    sublayer_of: &SublayerOf,
    flip: &mut impl FnMut(u32, i8),
) -> Winding {
    let mut entered = None;
    let above = printed_crossings(hits, classes, winding, |z_mm, enters| {
        let sublayer = sublayer_of.first_above(z_mm);
        if enters {
            entered = Some(sublayer);
            return;
        }
        match entered.take() {
            // A range that begins and ends between two sampling heights changes nothing.
            Some(on) if on == sublayer => return,
            Some(on) => flip(on, 1),
            None => {}
        }
        flip(sublayer, -1);
    });
    if let Some(on) = entered {
        flip(on, 1);
    }
    above
}

/// The winding numbers with which rays enter a slab: one byte, or one for each kind of body, and a list of those that are larger.
struct Windings {
    kinds: usize,
    bytes: Vec<i8>,
    large: BTreeMap<usize, Winding>,
}

/// Marks a ray whose winding numbers are listed.
const LARGE: i8 = i8::MIN;

impl Windings {
    fn new(rays: usize, classes: FacetClasses) -> Self {
        let kinds = if classes.is_model_alone() { 1 } else { 3 };
        Self {
            kinds,
            bytes: vec![0; kinds * rays],
            large: BTreeMap::new(),
        }
    }

    fn get(&self, ray: usize) -> Winding {
        let bytes = &self.bytes[self.kinds * ray..][..self.kinds];
        if bytes[0] == LARGE {
            return self.large[&ray];
        }
        let of = |kind: usize| bytes.get(kind).map_or(0, |&byte| i32::from(byte));
        Winding::of([of(0), of(1), of(2)])
    }

    fn set(&mut self, ray: usize, winding: Winding) {
        let bytes = &mut self.bytes[self.kinds * ray..][..self.kinds];
        let numbers = winding.numbers();
        let is_small = numbers.iter().all(|number| number.abs() <= 127);
        if is_small {
            for (byte, number) in bytes.iter_mut().zip(numbers) {
                *byte = number as i8;
            }
        } else {
            bytes[0] = LARGE;
            self.large.insert(ray, winding);
        }
    }
}
