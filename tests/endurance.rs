//! Many jobs in one process take no more memory than a few.

use crate::common::Slicer;
use cusp_slicer::job::{Backend, Options};
use cusp_slicer::profile::Metric;

use crate::common::{binary_stl, in_own_process, quiet, solids};

/// Jobs, each of the next model in turn.
const JOBS: usize = 1000;
/// Number of jobs after which everything that is made once exists.
const WARM: usize = 40;

/// Memory in use, in bytes.
fn resident_bytes() -> f64 {
    let statm = std::fs::read_to_string("/proc/self/statm").unwrap();
    let pages: f64 = statm.split(' ').nth(1).unwrap().parse().unwrap();
    pages * rustix::param::page_size() as f64
}

/// Twenty models, each as it comes from a file.
fn models() -> Vec<Vec<u8>> {
    let sizes = 1..=10u8;
    let two_of_a_size = |size: u8| {
        let size = f32::from(size);
        let ball = solids::sphere(f64::from(size), 5);
        let slab = solids::cuboid(glam::Vec3::new(size, 2.0 * size, 4.0));
        [ball, slab].map(|triangles| binary_stl(&triangles))
    };
    sizes.flat_map(two_of_a_size).collect()
}

#[test]
fn the_memory_of_many_jobs_is_that_of_a_few() {
    let name = "endurance::the_memory_of_many_jobs_is_that_of_a_few";
    in_own_process(name, many_jobs);
}

fn many_jobs() {
    let models = models();
    let mut warm_bytes = 0.0;
    for job in 0..JOBS {
        let options = Options {
            rays: 128,
            backend: Backend::Cpu,
            metric: Metric::ALL[job % Metric::ALL.len()],
            ..Options::default()
        };
        let mut slicer = Slicer::load(&models[job % models.len()]).unwrap();
        pollster::block_on(slicer.plan(&options, &mut quiet)).unwrap();
        let (file, _) = slicer.write_archive(Vec::new(), &mut quiet).unwrap();
        assert!(!file.is_empty());
        if job + 1 == WARM {
            warm_bytes = resident_bytes();
        }
    }
    let bytes = resident_bytes();
    eprintln!(
        "{:.1} MB after {WARM} jobs, {:.1} MB after {JOBS}",
        warm_bytes / 1e6,
        bytes / 1e6
    );
    assert!(bytes < 1.1 * warm_bytes, "{bytes} > 1.1 × {warm_bytes}");
}
