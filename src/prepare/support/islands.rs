//! Islands: pieces of the print that begin with nothing below them.

use super::rays::Rays;
use crate::union_find;
use crate::ways::AROUND;

/// Height within which an island joins what is held, so that no layer shows it.
const JOINS_MM: f32 = 0.05;

/// A piece while the sweep rises.
#[derive(Clone, Copy)]
struct Piece {
    /// The stretch at which it begins.
    lowest: usize,
    is_held: bool,
    rays: u32,
}

/// A piece that begins with nothing below it.
pub(super) struct Island {
    /// Its lowest stretch.
    pub stretch: usize,
    /// True if it joins others before a layer shows it, as far as rays tell: a gap narrower than rays may part them.
    pub joins_soon: bool,
    /// True if no adjacent ray is in it.
    pub is_lone: bool,
}

/// The islands of the print. Those that rise by more than a layer are held from then on; `is_held` is true for stretches that are held
/// already.
pub(super) fn islands(rays: &Rays<'_>, is_held: impl Fn(usize) -> bool) -> Vec<Island> {
    let stretches = &rays.stretches;
    let mut parent: Vec<u32> = (0..stretches.len() as u32).collect();
    let mut pieces: Vec<Piece> = (0..stretches.len())
        .map(|stretch| Piece {
            lowest: stretch,
            is_held: is_held(stretch),
            rays: 1,
        })
        .collect();
    let mut found = Vec::new();
    let mut end = |piece: &Piece, z_mm: f32| {
        let stretch = piece.lowest;
        let rise_mm = z_mm - stretches[stretch].from_mm;
        let joins_soon = rise_mm <= JOINS_MM;
        // Higher points of a slope are no islands.
        if rise_mm <= 0.0 {
            return false;
        }
        found.push(Island {
            stretch,
            joins_soon,
            is_lone: piece.rays == 1,
        });
        !joins_soon
    };
    for here in rays.ascending() {
        let (ray, z_mm) = (stretches[here].ray, stretches[here].from_mm);
        for step in AROUND {
            for there in rays.near(ray, step) {
                // Those that begin higher join when it is their turn.
                let begins = (stretches[there].from_mm, there) < (z_mm, here);
                if !begins || !rays.overlap(here, there) {
                    continue;
                }
                let ends = [here, there].map(|it| union_find::find(&mut parent, it as u32));
                if ends[0] == ends[1] {
                    continue;
                }
                let [a, b] = ends.map(|it| pieces[it as usize]);
                let [low, high] = if order(&a, rays) <= order(&b, rays) {
                    [a, b]
                } else {
                    [b, a]
                };
                // An island that gets a contact holds what it joins.
                let mut is_held = high.is_held || end(&high, z_mm);
                if is_held && !low.is_held {
                    end(&low, z_mm);
                }
                is_held |= low.is_held;
                let root = union_find::unite(&mut parent, ends[0], ends[1]);
                pieces[root as usize] = Piece {
                    lowest: low.lowest,
                    is_held,
                    rays: low.rays + high.rays,
                };
            }
        }
    }
    let roots = (0..stretches.len()).filter(|&it| parent[it] == it as u32);
    let loose = roots.map(|root| pieces[root]).filter(|it| !it.is_held);
    for piece in loose {
        end(&piece, f32::INFINITY);
    }
    found
}

/// Order in which pieces begin.
fn order(piece: &Piece, rays: &Rays<'_>) -> (u32, usize) {
    let z_mm = rays.stretches[piece.lowest].from_mm;
    // Heights above the plate are not negative.
    (z_mm.max(0.0).to_bits(), piece.lowest)
}
