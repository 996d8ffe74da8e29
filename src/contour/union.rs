//! The union of the bodies in a section: the points with a non-zero winding number, as in the LDI.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::{IntOverlayOptions, Overlay};
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::core::solver::Solver;
use i_overlay::i_float::int::point::IntPoint;

use super::section::{Loops, Path};
use super::{Polygon, Ring};

type Shapes = Vec<Vec<Vec<IntPoint<i32>>>>;

/// The printed part of a section, by the rule of [`Winding::is_inside`](crate::model::Winding::is_inside): inside the
/// model and no void, or inside a support.
pub(super) fn union(loops: &Loops) -> Vec<Polygon> {
    let model = contours(&loops.model);
    let voids = contours(&loops.voids);
    let mut shapes = if voids.is_empty() {
        overlay(&model, &voids, OverlayRule::Subject)
    } else {
        overlay(&model, &voids, OverlayRule::Difference)
    };
    if !loops.supports.is_empty() {
        let solid: Vec<_> = shapes.into_iter().flatten().collect();
        shapes = overlay(&solid, &contours(&loops.supports), OverlayRule::Union);
    }
    shapes.into_iter().filter_map(polygon).collect()
}

fn overlay(
    subject: &Vec<Vec<IntPoint<i32>>>,
    clip: &Vec<Vec<IntPoint<i32>>>,
    rule: OverlayRule,
) -> Shapes {
    // Valid by the rules of OGC: outer rings counter-clockwise, holes clockwise, rings that touch at single points at most.
    let options = IntOverlayOptions::ogc();
    let mut overlay = Overlay::from_subj_and_clip_custom(subject, clip, options, Solver::default());
    overlay.overlay(rule, FillRule::NonZero)
}

fn contours(paths: &[Path]) -> Vec<Vec<IntPoint<i32>>> {
    let points = |path: &Path| path.iter().map(|&[x, y]| IntPoint::new(x, y)).collect();
    paths.iter().map(points).collect()
}

fn polygon(shape: Vec<Vec<IntPoint<i32>>>) -> Option<Polygon> {
    let ring = |points: Vec<IntPoint<i32>>| Ring {
        points: points.iter().map(|point| [point.x, point.y]).collect(),
    };
    let mut rings = shape.into_iter().map(ring);
    Some(Polygon {
        outer: rings.next()?,
        holes: rings.collect(),
    })
}
