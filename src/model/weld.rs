//! Welding: equal corners of triangles become one vertex.

use std::iter::once;

use glam::Vec3;
use rustc_hash::FxHashMap;

use super::FacetLists;
use crate::parallel;

/// Binary logarithm of the number of recent corners that are kept: most facets share corners with one shortly before.
const RECENT_BITS: u32 = 12;

/// Approximate number of corners in a bucket: a table of as many stays in the cache.
const BUCKET: usize = 8192;

/// Gives equal corners one index, in order of first use. Facets with fewer than three distinct corners are kept here; the caller drops
/// them.
///
/// Corners that differ from those shortly before are put into buckets by their hashes, and equal ones found bucket by bucket: a table
/// of all would be larger than the cache. Cost: linear in triangles.
pub(crate) fn weld(triangles: &[[Vec3; 3]]) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    // Not a number, which equals no corner.
    let mut recent = vec![(Vec3::NAN, 0); 1 << RECENT_BITS];
    let mut corners: Vec<Vec3> = Vec::with_capacity(triangles.len() / 2);
    let mut place_of = |corner: Vec3| {
        // Adding zero turns -0 into 0, so that both have the same bits.
        let corner = corner + Vec3::ZERO;
        let known = &mut recent[leading(hash(corner), RECENT_BITS)];
        if known.0 != corner {
            *known = (corner, corners.len() as u32);
            corners.push(corner);
        }
        known.1
    };
    let triangles = triangles.iter();
    let mut facets: Vec<[u32; 3]> = triangles.map(|it| it.map(&mut place_of)).collect();

    // The lists hold corners in place of facets.
    let bits = (corners.len() / BUCKET).max(1).ilog2();
    let bucket_of = |place: u32| once(leading(hash(corners[place as usize]), bits));
    let buckets = FacetLists::new(1 << bits, 0..corners.len() as u32, bucket_of);
    // The first of the corners that equal each one.
    let firsts = parallel::map((0..1 << bits).collect(), |bucket| {
        let places = buckets.of(bucket);
        let mut first_of = FxHashMap::default();
        first_of.reserve(places.len());
        let first = |&place: &u32| {
            *first_of
                .entry(bits_of(corners[place as usize]))
                .or_insert(place)
        };
        places.iter().map(first).collect::<Vec<u32>>()
    });
    let mut index_of = vec![0; corners.len()];
    for (bucket, firsts) in firsts.iter().enumerate() {
        for (&place, &first) in buckets.of(bucket).iter().zip(firsts) {
            index_of[place as usize] = first;
        }
    }
    let mut count = 0;
    for place in 0..corners.len() {
        let first = index_of[place] as usize;
        if first == place {
            corners[count] = corners[place];
            index_of[place] = count as u32;
            count += 1;
        } else {
            index_of[place] = index_of[first];
        }
    }
    corners.truncate(count);
    corners.shrink_to_fit();
    for place in facets.as_flattened_mut() {
        *place = index_of[*place as usize];
    }
    (corners, facets)
}

fn bits_of(corner: Vec3) -> [u32; 3] {
    corner.to_array().map(f32::to_bits)
}

/// A hash of which the leading bits differ most.
fn hash(corner: Vec3) -> u32 {
    let [x, y, z] = bits_of(corner);
    // 2³² over the golden ratio.
    (x ^ y.rotate_left(11) ^ z.rotate_left(22)).wrapping_mul(0x9E37_79B1)
}

fn leading(hash: u32, bits: u32) -> usize {
    (u64::from(hash) << bits >> 32) as usize
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;

    #[test]
    fn equal_corners_get_one_index_in_order_of_first_use() {
        let mut state = 1u32;
        let mut coordinate = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let coordinate = (state >> 27) as f32 - 16.0;
            if coordinate == 0.0 && state & 1 << 20 == 0 {
                -0.0
            } else {
                coordinate
            }
        };
        let mut corner = |()| Vec3::from_array([(); 3].map(|()| coordinate()));
        let triangles: Vec<[Vec3; 3]> = (0..30_000).map(|_| [(); 3].map(&mut corner)).collect();
        let is_negative_zero = |it: f32| it == 0.0 && it.is_sign_negative();
        let has_negative_zero = |it: &Vec3| it.to_array().into_iter().any(is_negative_zero);
        assert!(triangles.iter().flatten().any(has_negative_zero));
        let (vertices, facets) = weld(&triangles);
        let mut index_of: HashMap<[i32; 3], u32> = HashMap::new();
        for (corners, facet) in triangles.iter().zip(&facets) {
            for (corner, &index) in corners.iter().zip(facet) {
                let next = index_of.len() as u32;
                let key = corner.to_array().map(|it| it as i32);
                assert_eq!(*index_of.entry(key).or_insert(next), index);
                assert_eq!(vertices[index as usize], *corner);
            }
        }
        assert_eq!(vertices.len(), index_of.len());
        assert!(vertices.len() > 2 * BUCKET, "several buckets");
        assert!(!vertices.iter().any(has_negative_zero));
    }
}
