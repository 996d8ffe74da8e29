//! Memory, measured by a counting allocator.
#![cfg(not(target_arch = "wasm32"))]

mod common;

use common::{binary_stl, solids};
use cusp_slicer::job::{Options, Slicer};
use cusp_slicer::orientation::Task;
use glam::Vec3;
use peak_alloc::PeakAlloc;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// The only test in its binary, so that nothing else allocates at the same time.
#[test]
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
