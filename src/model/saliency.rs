//! Mesh saliency: how much each facet stands out from its surroundings, after Lee, Varshney and Jacobs, *Mesh Saliency*
//! (2005). Section 4.2 uses it to weight facets.
//!
//! Mean curvature is averaged around each vertex at a finer and a coarser scale; a difference between the two is salient.
//! Unlike in the article, averages are weighted by area, so that they do not depend on how finely a surface is
//! triangulated.

use glam::{DVec3, IVec3};
use rustc_hash::FxHashMap;

use crate::model::Mesh;
use crate::parallel::map_in_groups;
use crate::progress::{Cancelled, Progress, report};

/// The unit of scales, as a fraction of the diagonal of the model's bounding box.
const UNIT: f64 = 0.003;
/// The finer scales, in units. Each is compared with the scale twice as coarse.
const SCALES: [usize; 5] = [2, 3, 4, 5, 6];
/// All scales at which averages are taken, in units.
const AVERAGES: [usize; 8] = [12, 10, 8, 6, 5, 4, 3, 2];
/// Radius of an average, as a multiple of its scale.
const REACH: f64 = 2.0;
/// Cells within reach of a vertex, of all scales together: each is as wide as its scale.
#[cfg(not(target_arch = "wasm32"))]
pub(crate) const CELLS_WITHIN_REACH: usize = AVERAGES.len() * 5 * 5 * 5;
/// Differences of curvature, relative to the curvature, that are rounding.
const NOISE: f64 = 1e-9;
/// Number of vertices that a thread processes at a time.
const CHUNK: usize = 512;

/// The saliency of each facet of the surface, 0 to 1. The most salient facet has 1; all have 1 if none stands
/// out, as then none matters less than another.
///
/// Cost: linear in vertices.
///
/// # Errors
/// [`Cancelled`] if `progress` cancels.
pub fn saliency(mesh: &Mesh, progress: &mut Progress<'_>) -> Result<Vec<f32>, Cancelled> {
    report(progress, 0.0)?;
    let unit_mm = mesh.bounds().size().length() * UNIT;
    let surface = Surface::new(mesh);
    let averages = surface.averages(unit_mm, progress)?;
    let mut sum = vec![0.0; mesh.vertices.len()];
    for scale in SCALES {
        let of = |units: usize| AVERAGES.iter().position(|&average| average == units);
        let (Some(fine), Some(coarse)) = (of(scale), of(2 * scale)) else {
            continue;
        };
        let mut difference: Vec<f64> = averages
            .iter()
            .map(|average| (average[fine] - average[coarse]).abs())
            .collect();
        let curvatures = averages.iter().map(|average| average[fine].abs());
        let curvatures: Vec<f64> = curvatures.collect();
        if greatest(&difference) <= greatest(&curvatures) * NOISE {
            continue;
        }
        suppress(mesh, &mut difference);
        for (sum, difference) in sum.iter_mut().zip(difference) {
            *sum += difference;
        }
    }
    let facets = mesh.facets[..mesh.surface_facets].iter();
    let of_facets: Vec<f64> = facets
        .map(|corners| corners.iter().map(|&vertex| sum[vertex as usize]).sum())
        .collect();
    let most = greatest(&of_facets);
    let normal = |value: f64| if most > 0.0 { value / most } else { 1.0 };
    report(progress, 1.0)?;
    Ok(of_facets
        .into_iter()
        .map(|value| normal(value) as f32)
        .collect())
}

fn greatest(values: &[f64]) -> f64 {
    let mut most = 0.0;
    for &value in values {
        if value > most {
            most = value;
        }
    }
    most
}

/// The curvature and area at every vertex. Vertices that are not on the surface have no area.
struct Surface {
    points: Vec<DVec3>,
    /// Mean curvature, positive where the surface is convex, in 1/mm.
    curvature: Vec<f64>,
    /// A third of the area of the facets around each vertex, in mm².
    area: Vec<f64>,
}

impl Surface {
    /// Mean curvature by Taubin's estimator: the mean of the normal curvatures along the edges around a vertex, weighted
    /// by the areas of their facets. It does not depend on the order of facets around a vertex, so it works on open meshes
    /// and on edges with more than two facets.
    fn new(mesh: &Mesh) -> Self {
        let count = mesh.vertices.len();
        let points: Vec<DVec3> = mesh
            .vertices
            .iter()
            .map(|vertex| vertex.as_dvec3())
            .collect();
        let mut normals = vec![DVec3::ZERO; count];
        let mut area = vec![0.0; count];
        let facets = &mesh.facets[..mesh.surface_facets];
        let cross = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|vertex| points[vertex as usize]);
            (b - a).cross(c - a)
        };
        for corners in facets {
            let cross = cross(corners);
            for &vertex in corners {
                normals[vertex as usize] += cross;
                area[vertex as usize] += cross.length() / 6.0;
            }
        }
        for normal in &mut normals {
            *normal = normal.normalize_or_zero();
        }
        let mut curvature = vec![0.0; count];
        let mut weights = vec![0.0; count];
        for corners in facets {
            let weight = cross(corners).length();
            for &vertex in corners {
                for &other in corners.iter().filter(|&&other| other != vertex) {
                    let (vertex, other) = (vertex as usize, other as usize);
                    let edge = points[vertex] - points[other];
                    curvature[vertex] +=
                        weight * 2.0 * normals[vertex].dot(edge) / edge.length_squared();
                    weights[vertex] += weight;
                }
            }
        }
        for (curvature, weight) in curvature.iter_mut().zip(weights) {
            if weight > 0.0 {
                *curvature /= weight;
            }
        }
        Self {
            points,
            curvature,
            area,
        }
    }

    /// Gaussian-weighted averages of the curvature around every vertex, one for each of [`AVERAGES`].
    fn averages(
        &self,
        unit_mm: f64,
        progress: &mut Progress<'_>,
    ) -> Result<Vec<[f64; AVERAGES.len()]>, Cancelled> {
        let kernel = Kernel::new();
        let scales = AVERAGES.map(|units| Scale::new(self, units as f64 * unit_mm));
        let count = self.points.len();
        let firsts: Vec<usize> = (0..count).step_by(CHUNK).collect();
        let mut averages = Vec::with_capacity(count);
        map_in_groups(
            firsts.into_iter(),
            |first| {
                let vertices = first..(first + CHUNK).min(count);
                let around = |vertex: usize| {
                    let average = |scale: &Scale| scale.average(&kernel, self.points[vertex]);
                    scales.each_ref().map(average)
                };
                vertices.map(around).collect::<Vec<_>>()
            },
            |chunk| {
                averages.extend(chunk);
                Ok::<_, Cancelled>(())
            },
            progress,
            [0.0, 0.95],
        )?;
        Ok(averages)
    }
}

/// The contribution of one or more vertices to averages.
#[derive(Clone, Copy)]
struct Sample {
    point: DVec3,
    area: f64,
    /// Curvature times area.
    bent: f64,
}

/// The samples of one scale, by cell. Vertices that are close together, relative to the scale, share a sample.
struct Scale {
    samples: Vec<Sample>,
    ranges: FxHashMap<IVec3, (u32, u32)>,
    sigma_mm: f64,
}

impl Scale {
    /// Cells are as wide as the scale, with this number of parts per side and at most one sample in each part. This keeps
    /// the cost from growing with the square of the number of vertices.
    const PARTS: i32 = 4;

    fn new(surface: &Surface, sigma_mm: f64) -> Self {
        let part_mm = sigma_mm / f64::from(Self::PARTS);
        let cell_of = |part: IVec3| part.div_euclid(IVec3::splat(Self::PARTS));
        let mut order: Vec<(IVec3, IVec3, u32)> = (0..surface.points.len())
            .filter(|&vertex| surface.area[vertex] > 0.0)
            .map(|vertex| {
                let part = (surface.points[vertex] / part_mm).floor().as_ivec3();
                (cell_of(part), part, vertex as u32)
            })
            .collect();
        order.sort_unstable_by_key(|&(cell, part, vertex)| {
            (cell.to_array(), part.to_array(), vertex)
        });
        let mut samples = Vec::new();
        let mut ranges = FxHashMap::default();
        for cell in order.chunk_by(|a, b| a.0 == b.0) {
            let first = samples.len() as u32;
            for part in cell.chunk_by(|a, b| a.1 == b.1) {
                let mut sum = Sample {
                    point: DVec3::ZERO,
                    area: 0.0,
                    bent: 0.0,
                };
                for &(_, _, vertex) in part {
                    let vertex = vertex as usize;
                    let area = surface.area[vertex];
                    sum.point += surface.points[vertex] * area;
                    sum.area += area;
                    sum.bent += area * surface.curvature[vertex];
                }
                sum.point /= sum.area;
                samples.push(sum);
            }
            ranges.insert(cell[0].0, (first, samples.len() as u32));
        }
        Self {
            samples,
            ranges,
            sigma_mm,
        }
    }

    fn average(&self, kernel: &Kernel, point: DVec3) -> f64 {
        let reach_mm = REACH * self.sigma_mm;
        let farthest = reach_mm * reach_mm;
        let steps = Kernel::STEPS as f64 / farthest;
        let first = ((point - reach_mm) / self.sigma_mm).floor().as_ivec3();
        let last = ((point + reach_mm) / self.sigma_mm).floor().as_ivec3();
        let (mut bent, mut area) = (0.0, 0.0);
        for x in first.x..=last.x {
            for y in first.y..=last.y {
                for z in first.z..=last.z {
                    let range = self.ranges.get(&IVec3::new(x, y, z));
                    let Some(&(from, to)) = range else { continue };
                    for sample in &self.samples[from as usize..to as usize] {
                        let square = (sample.point - point).length_squared();
                        if square < farthest {
                            let weight = kernel.weights[(square * steps) as usize];
                            bent += weight * sample.bent;
                            area += weight * sample.area;
                        }
                    }
                }
            }
        }
        if area > 0.0 { bent / area } else { 0.0 }
    }
}

/// Gaussian weights.
struct Kernel {
    /// The weight at i / [`STEPS`](Self::STEPS) of the squared radius: exp(−2 i / [`STEPS`](Self::STEPS)).
    weights: Vec<f64>,
}

impl Kernel {
    const STEPS: usize = 2048;

    fn new() -> Self {
        // exp by its series, with basic arithmetic alone: the same on every machine.
        let step = REACH * REACH * 0.5 / Self::STEPS as f64;
        let ratio = 1.0 - step * (1.0 - step / 2.0 * (1.0 - step / 3.0 * (1.0 - step / 4.0)));
        let mut weight = 1.0;
        // One more, in case an index is rounded up.
        let weights = (0..=Self::STEPS).map(|_| {
            let this = weight;
            weight *= ratio;
            this
        });
        Self {
            weights: weights.collect(),
        }
    }
}

/// The article's non-linear suppression: a scale with one high peak counts for more than one with many similar peaks.
fn suppress(mesh: &Mesh, values: &mut [f64]) {
    let most = greatest(values);
    if most <= 0.0 {
        return;
    }
    for value in values.iter_mut() {
        *value /= most;
    }
    // Centroids of caps and vertices that no facet uses are no peaks.
    let facets = &mesh.facets[..mesh.surface_facets];
    let mut is_peak = vec![false; values.len()];
    for &vertex in facets.iter().flatten() {
        is_peak[vertex as usize] = true;
    }
    for &[a, b, c] in facets {
        for (one, other) in [(a, b), (b, c), (c, a)] {
            let (one, other) = (one as usize, other as usize);
            is_peak[one] &= values[one] > values[other];
            is_peak[other] &= values[other] > values[one];
        }
    }
    // All peaks except the highest, which is 1.
    let (mut sum, mut count) = (0.0, 0u32);
    for (&value, _) in values.iter().zip(is_peak).filter(|it| it.1) {
        if value > 0.0 && value < 1.0 {
            sum += value;
            count += 1;
        }
    }
    let mean = if count > 0 {
        sum / f64::from(count)
    } else {
        0.0
    };
    for value in values {
        *value *= (1.0 - mean) * (1.0 - mean);
    }
}
