//! The GPU backend against the CPU's, solid by solid, on whatever adapter wgpu finds: the same LDI to the
//! last bit. Reported as ignored where there is none.

mod common;

use common::{on_plate, solids};
use cusp_slicer::grid::Grid;
use cusp_slicer::ldi::{Ldi, LdiError, cpu, gpu};
use cusp_slicer::progress::silent;
use libtest_mimic::{Arguments, Completion, Failed, Trial};

fn sample_both(
    triangles: &solids::Triangles,
    rays: u32,
    tiling: gpu::Tiling,
) -> Result<(Ldi, Ldi, String), LdiError> {
    let mesh = on_plate(triangles);
    let grid = Grid::around(&mesh.bounds(), rays).unwrap();
    let expected = cpu::sample(&mesh, &grid, &mut silent)?;
    let mut progress = silent;
    let job = gpu::sample(&mesh, &grid, gpu::Adapters::Any, tiling, &mut progress);
    let (found, adapter) = pollster::block_on(job)?;
    Ok((expected, found, adapter))
}

fn compare(triangles: &solids::Triangles, rays: u32, tiling: gpu::Tiling) -> Result<(), Failed> {
    let (expected, found, adapter) = sample_both(triangles, rays, tiling)?;
    let differing = (0..expected.rays()).find(|&ray| expected.ray(ray) != found.ray(ray));
    match differing {
        Some(ray) => Err(format!(
            "ray {ray} differs on {adapter}: {:?} against {:?}",
            found.ray(ray),
            expected.ray(ray)
        )
        .into()),
        None => Ok(()),
    }
}

type Test = Box<dyn Fn() -> Result<(), Failed> + Send>;

fn tests() -> Vec<(String, Test)> {
    let whole = gpu::Tiling::default();
    let small = gpu::Tiling { side: 77 };
    let mut tests: Vec<(String, Test)> = Vec::new();
    for (name, triangles) in solids::all() {
        let same = triangles.clone();
        let title = format!("gpu equals cpu on the {name}");
        tests.push((title, Box::new(move || compare(&triangles, 300, whole))));
        let title = format!("tiles have no seams on the {name}");
        tests.push((title, Box::new(move || compare(&same, 200, small))));
    }
    for (name, triangles, rays) in solids::torture() {
        let variants = [
            ("", triangles.clone()),
            (", mirrored", solids::mirrored(&triangles)),
            (", turned", solids::turned(&triangles)),
            (", shuffled", solids::shuffled(&triangles)),
        ];
        for (variant, triangles) in variants {
            let title = format!("gpu equals cpu on {name}{variant}");
            tests.push((title, Box::new(move || compare(&triangles, rays, whole))));
        }
    }
    tests.push((
        "gpu equals cpu on large facets".to_owned(),
        Box::new(move || compare(&solids::cone(9.0, 14.0, 4), 2500, whole)),
    ));
    tests.push((
        "gpu equals cpu on needles".to_owned(),
        Box::new(move || compare(&solids::cylinder(9.0, 1.0, 400), 1200, whole)),
    ));
    tests.push((
        "tiles have no seams on large facets".to_owned(),
        Box::new(|| compare(&solids::cone(9.0, 14.0, 4), 2500, gpu::Tiling { side: 640 })),
    ));
    tests
}

fn main() {
    let arguments = Arguments::from_args();
    let probe = sample_both(&solids::cube(1.0), 4, gpu::Tiling::default());
    let missing = match probe {
        Err(LdiError::NoGpu { reason }) => Some(reason),
        _ => None,
    };
    let trials = tests()
        .into_iter()
        .map(|(title, test)| {
            let missing = missing.clone();
            Trial::ignorable_test(title, move || match missing {
                Some(reason) => Ok(Completion::ignored_with(reason)),
                None => test().map(|()| Completion::Completed),
            })
        })
        .collect();
    libtest_mimic::run(&arguments, trials).exit();
}
