//! Memory, measured by a counting allocator.

use crate::common::Slicer;
use cusp_slicer::Error;
use cusp_slicer::job::{Backend, Options};
use cusp_slicer::orientation::Task;
use glam::Vec3;

use crate::ALLOCATOR;
use crate::common::{binary_stl, in_own_process, quiet, solids};

#[test]
fn searches_and_bounded_jobs_take_the_memory_that_they_say() {
    let name = "memory::searches_and_bounded_jobs_take_the_memory_that_they_say";
    in_own_process(name, || {
        a_search_takes_the_memory_that_the_description_of_a_model_says();
        a_job_takes_no_more_memory_than_it_may();
    });
}

/// Within the least memory that it says it can do with, and within more, where it holds more layers at a time.
fn a_job_takes_no_more_memory_than_it_may() {
    let stl = binary_stl(&solids::sphere(20.0, 7));
    for (pixels, antialias) in [(3000, 1), (1000, 4)] {
        let options = Options {
            pixels: Some([pixels; 2]),
            pitch_mm: Some(50.0 / f64::from(pixels)),
            antialias,
            backend: Backend::Cpu,
            ..Options::default()
        };
        let plan = |bytes| {
            let before = ALLOCATOR.current_usage();
            ALLOCATOR.reset_peak_usage();
            let mut slicer = Slicer::load(&stl).unwrap().with_memory(bytes);
            pollster::block_on(slicer.plan(&options, &mut quiet))?;
            slicer.write_archive(std::io::sink(), &mut quiet)?;
            Ok::<_, Error>((ALLOCATOR.peak_usage() - before) as u64)
        };
        let Err(Error::MemoryBound { needed_bytes, .. }) = plan(1) else {
            panic!("a job within one byte");
        };
        for bytes in [needed_bytes, needed_bytes + (64 << 20), 1 << 40] {
            let measured = plan(bytes).unwrap();
            assert!(
                measured <= bytes,
                "{antialias}: {measured} bytes of {bytes}"
            );
        }
    }
}

fn a_search_takes_the_memory_that_the_description_of_a_model_says() {
    // Large enough for its working memory to exceed the block that `keep_memory` allocates and frees.
    let welded = solids::sphere(20.0, 8);
    let loose = apart(&welded);
    for (name, triangles) in [("welded", welded), ("loose", loose)] {
        let stl = binary_stl(&triangles);
        drop(triangles);
        let before = ALLOCATOR.current_usage();
        let mut slicer = Slicer::load(&stl).unwrap();
        let info = slicer.info();
        ALLOCATOR.reset_peak_usage();
        let task = Task {
            number: 0,
            directions: vec![[0.0, 0.6, 0.8]],
        };
        slicer.evaluate(&Options::default(), task).unwrap();
        let measured = ALLOCATOR.peak_usage() - before;
        let part = measured as f64 / info.search_bytes as f64;
        assert!(
            (0.8..=1.05).contains(&part),
            "{name}: {measured} bytes measured, {} said ({} facets, {} vertices)",
            info.search_bytes,
            info.facets,
            info.vertices
        );
    }
}

/// The same triangles, shrunk so that none touches another.
fn apart(triangles: &[[Vec3; 3]]) -> Vec<[Vec3; 3]> {
    let shrunk = |&[a, b, c]: &[Vec3; 3]| {
        let middle = (a + b + c) / 3.0;
        [a, b, c].map(|corner| corner + (middle - corner) * 0.1)
    };
    triangles.iter().map(shrunk).collect()
}
