//! Mesh saliency: how much each facet stands out from what is around it, after Lee, Varshney and Jacobs, *Mesh Saliency*
//! (2005), as section 4.2 weights facets.
//!
//! Mean curvature is averaged around each vertex at a finer and a coarser scale; where the two differ, something stands out. It
//! differs from the article in one thing: averages are weighted by area, so that they do not depend on how finely a surface
//! is divided.

use glam::{DVec3, IVec3};
use rustc_hash::FxHashMap;

use crate::mesh::Mesh;
use crate::parallel::map_in_groups;
use crate::progress::{Cancelled, Progress, report};

/// The unit of scales, as a part of the diagonal of the model's bounding box.
const UNIT: f64 = 0.003;
/// Finer scales, in units. Each is compared with its double.
const SCALES: [usize; 5] = [2, 3, 4, 5, 6];
/// All scales that averages are taken at, the largest first, in units.
const AVERAGES: [usize; 8] = [12, 10, 8, 6, 5, 4, 3, 2];
/// Averages reach so many times their scale.
const REACH: f64 = 2.0;
/// Side of the cells that vertices are sorted into, in units.
const CELL: f64 = 8.0;
/// Vertices that are averaged in a row.
const CHUNK: usize = 512;

/// The saliency of each facet of the surface, 0 to 1: the most salient has 1. All are 0 where nothing stands out.
///
/// Cost: vertices times those within 7.2 % of the diagonal of each.
///
/// # Errors
/// [`Cancelled`] if `progress` asks for it.
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
    let normal = |value: f64| if most > 0.0 { value / most } else { 0.0 };
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

/// Vertices with what is averaged, those of the surface only, sorted by cell.
struct Surface {
    points: Vec<DVec3>,
    /// Mean curvature, positive where the surface is convex, in 1/mm.
    curvature: Vec<f64>,
    /// A third of the area of the facets around, in mm².
    area: Vec<f64>,
}

impl Surface {
    /// Mean curvature by Taubin's estimator: normal curvatures along the edges around a vertex, weighted by the
    /// areas of the facets that they belong to. It asks for no order of facets around a vertex, so that open meshes and
    /// edges of many facets are as good as any.
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
        let cells = Cells::new(self, unit_mm * CELL);
        let kernel = Kernel::new(unit_mm);
        let count = self.points.len();
        let firsts: Vec<usize> = (0..count).step_by(CHUNK).collect();
        let mut averages = Vec::with_capacity(count);
        map_in_groups(
            firsts.into_iter(),
            |first| {
                let vertices = first..(first + CHUNK).min(count);
                let around = |vertex: usize| kernel.averages(&cells, self.points[vertex]);
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

/// What a vertex adds to averages.
#[derive(Clone, Copy)]
struct Sample {
    point: DVec3,
    area: f64,
    /// Curvature times area.
    bent: f64,
}

/// Samples by the cell that they are in.
struct Cells {
    samples: Vec<Sample>,
    ranges: FxHashMap<IVec3, (u32, u32)>,
    side_mm: f64,
}

impl Cells {
    fn new(surface: &Surface, side_mm: f64) -> Self {
        let mut order: Vec<(IVec3, u32)> = (0..surface.points.len())
            .filter(|&vertex| surface.area[vertex] > 0.0)
            .map(|vertex| (cell_of(surface.points[vertex], side_mm), vertex as u32))
            .collect();
        order.sort_unstable_by_key(|&(cell, vertex)| (cell.to_array(), vertex));
        let mut ranges = FxHashMap::default();
        let mut first = 0;
        for cell in order.chunk_by(|a, b| a.0 == b.0) {
            let end = first + cell.len() as u32;
            ranges.insert(cell[0].0, (first, end));
            first = end;
        }
        let sample = |&(_, vertex): &(IVec3, u32)| {
            let vertex = vertex as usize;
            Sample {
                point: surface.points[vertex],
                area: surface.area[vertex],
                bent: surface.area[vertex] * surface.curvature[vertex],
            }
        };
        Self {
            samples: order.iter().map(sample).collect(),
            ranges,
            side_mm,
        }
    }

    fn of(&self, cell: IVec3) -> &[Sample] {
        self.ranges.get(&cell).map_or(&[], |&(first, end)| {
            &self.samples[first as usize..end as usize]
        })
    }
}

fn cell_of(point: DVec3, side_mm: f64) -> IVec3 {
    (point / side_mm).floor().as_ivec3()
}

/// Gaussian weights of all scales.
struct Kernel {
    /// exp(−2 i / [`STEPS`](Self::STEPS)): the weight at a part i of the square of a scale's reach.
    weights: Vec<f64>,
    /// For each of [`AVERAGES`], its reach squared and the steps a mm² of distance squared.
    reaches: [(f64, f64); AVERAGES.len()],
}

impl Kernel {
    const STEPS: usize = 2048;

    fn new(unit_mm: f64) -> Self {
        // exp by its series, in basic arithmetic alone: the same on every machine.
        let step = REACH * REACH * 0.5 / Self::STEPS as f64;
        let ratio = 1.0 - step * (1.0 - step / 2.0 * (1.0 - step / 3.0 * (1.0 - step / 4.0)));
        let mut weights = Vec::with_capacity(Self::STEPS);
        let mut weight = 1.0;
        for _ in 0..Self::STEPS {
            weights.push(weight);
            weight *= ratio;
        }
        Self {
            weights,
            reaches: AVERAGES.map(|units| {
                let reach_mm = REACH * units as f64 * unit_mm;
                let square = reach_mm * reach_mm;
                (square, Self::STEPS as f64 / square)
            }),
        }
    }

    fn averages(&self, cells: &Cells, point: DVec3) -> [f64; AVERAGES.len()] {
        let mut sums = [(0.0, 0.0); AVERAGES.len()];
        let middle = cell_of(point, cells.side_mm);
        let farthest = self.reaches[0].0;
        let reach = (farthest.sqrt() / cells.side_mm).ceil() as i32;
        for x in -reach..=reach {
            for y in -reach..=reach {
                for z in -reach..=reach {
                    for sample in cells.of(middle + IVec3::new(x, y, z)) {
                        let square = (sample.point - point).length_squared();
                        for (sum, &(reach, steps)) in sums.iter_mut().zip(&self.reaches) {
                            // Scales become smaller, so that no other reaches as far either.
                            if square >= reach {
                                break;
                            }
                            let weight =
                                self.weights[((square * steps) as usize).min(Self::STEPS - 1)];
                            sum.0 += weight * sample.bent;
                            sum.1 += weight * sample.area;
                        }
                    }
                }
            }
        }
        sums.map(|(bent, area)| if area > 0.0 { bent / area } else { 0.0 })
    }
}

/// The article's non-linear suppression: scales with one high peak count for more than those with many alike.
fn suppress(mesh: &Mesh, values: &mut [f64]) {
    let most = greatest(values);
    if most <= 0.0 {
        return;
    }
    for value in values.iter_mut() {
        *value /= most;
    }
    let mut is_peak = vec![true; values.len()];
    for &[a, b, c] in &mesh.facets[..mesh.surface_facets] {
        for (one, other) in [(a, b), (b, c), (c, a)] {
            let (one, other) = (one as usize, other as usize);
            is_peak[one] &= values[one] > values[other];
            is_peak[other] &= values[other] > values[one];
        }
    }
    // All peaks but the highest, which is 1.
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
