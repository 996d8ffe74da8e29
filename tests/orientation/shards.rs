//! Orientation searches in shards.

use crate::common::{load, quiet, solids};
use cusp_slicer::Error;
use cusp_slicer::job::{Options, OrientationPart, OrientationReport};
use cusp_slicer::orientation::shard::{MergeError, Shard};

use super::{bean, few, options, orient};

fn parts(model: &solids::Triangles, count: usize) -> Vec<OrientationPart> {
    (1..=count)
        .map(|number| {
            let mut slicer = load(model);
            let shard = Shard { number, count };
            let part = slicer.measure_shard(&options(), &few(50), shard, &mut quiet);
            // Through JSON, as between machines.
            let json = serde_json::to_string(&part.unwrap()).unwrap();
            serde_json::from_str(&json).unwrap()
        })
        .collect()
}

fn merge(parts: &[OrientationPart], options: &Options) -> Result<OrientationReport, Error> {
    let mut slicer = load(&bean());
    let search = slicer.merge_shards(options, &few(50), parts)?;
    slicer.finish_search(options, search, &mut quiet)
}

fn merge_error(parts: &[OrientationPart], options: &Options) -> MergeError {
    match merge(parts, options) {
        Err(Error::Merge(error)) => error,
        other => panic!("{other:?}"),
    }
}

#[test]
fn shards_make_the_same_whole_in_any_order() {
    let whole = orient(&bean(), &options(), &few(50));
    for count in [1, 3, 100] {
        let mut parts = parts(&bean(), count);
        parts.reverse();
        // Parts for another model are ignored.
        parts.extend(self::parts(&solids::cube(3.0), 2));
        assert_eq!(merge(&parts, &options()).unwrap(), whole);
    }
}

#[test]
fn shards_that_do_not_make_a_whole_are_refused() {
    let all = parts(&bean(), 3);
    let missing = merge_error(&all[..2], &options());
    assert!(
        matches!(
            missing,
            MergeError::Gap {
                first: 2,
                missing: 18,
                total: 56
            }
        ),
        "{missing}"
    );
    let twice = [&all[..], &all[..1]].concat();
    let twice = merge_error(&twice, &options());
    assert!(
        matches!(twice, MergeError::Duplicate { place: 0, .. }),
        "{twice}"
    );
    // Parts of searches with different numbers of shards overlap.
    let mixed = [&all[..1], &parts(&bean(), 2)[..]].concat();
    let mixed = merge_error(&mixed, &options());
    assert!(matches!(mixed, MergeError::Duplicate { .. }), "{mixed}");
    let other = Options {
        tolerance: Some(0.1),
        ..options()
    };
    let other = merge_error(&all, &other);
    assert!(matches!(other, MergeError::OtherOptions { .. }), "{other}");
    let mut old = all.clone();
    old[1].version = "0.0.1".to_owned();
    let old = merge_error(&old, &options());
    assert!(matches!(old, MergeError::OtherVersion { .. }), "{old}");
    let mut damaged = all.clone();
    damaged[1].candidates.swap(0, 1);
    let damaged = merge_error(&damaged, &options());
    assert!(matches!(damaged, MergeError::Damaged { .. }), "{damaged}");
    let none = merge_error(&parts(&solids::cube(3.0), 1), &options());
    assert!(matches!(none, MergeError::None), "{none}");
}
