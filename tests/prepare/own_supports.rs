//! Supports in files: what is recognised, and how it is printed.

use crate::common::Slicer;
use cusp_slicer::compensation::Compensation;
use cusp_slicer::inspect::{Code, Limits};
use cusp_slicer::job::{Options, Planner};
use cusp_slicer::model::read::ReadOptions;
use cusp_slicer::model::{FacetClass, Mesh};
use cusp_slicer::prepare::{SupportProfile, SupportStrength, Supporting, support};
use cusp_slicer::progress::silent;
use cusp_slicer::resin::Resin;
use cusp_slicer::warning::Warning;
use glam::{DVec3, Vec3};

use super::plan;
use crate::common::{assert_near, load, on_plate, quiet, solids};

fn triangles_of(mesh: &Mesh, facets: &[[u32; 3]]) -> solids::Triangles {
    let corner = |vertex: u32| mesh.vertices[vertex as usize];
    facets.iter().map(|it| it.map(corner)).collect()
}

/// A model with its supports, as another program would export it, and the number of its own facets.
fn exported(triangles: &solids::Triangles, supporting: &Supporting) -> (solids::Triangles, usize) {
    let mut mesh = on_plate(triangles);
    let own = triangles_of(&mesh, &mesh.facets);
    let made = support(&mesh, supporting, None, 0.0, &mut silent).unwrap();
    mesh.add(
        &made.shell.vertices,
        &made.shell.facets,
        FacetClass::Support,
    );
    mesh.lift(made.lift_mm);
    (triangles_of(&mesh, &mesh.facets), own.len())
}

/// Facets of supports and of the model among those that a reader takes for supports.
fn recognised(triangles: &solids::Triangles, own: usize) -> [usize; 2] {
    let mesh = Mesh::from_triangles(triangles).unwrap();
    let mesh = mesh.with_own_supports(triangles, false).unwrap();
    let key = |corners: &[Vec3; 3]| corners.map(|it| it.to_array().map(f32::to_bits));
    let theirs = triangles_of(&mesh, mesh.of_class(FacetClass::Support));
    let theirs: std::collections::HashSet<_> = theirs.iter().map(key).collect();
    let count = |of: &[[Vec3; 3]]| of.iter().filter(|it| theirs.contains(&key(it))).count();
    [count(&triangles[own..]), count(&triangles[..own])]
}

fn models() -> Vec<(&'static str, solids::Triangles)> {
    let mut figure = solids::moved(&solids::sphere(8.0, 5), Vec3::new(0.0, 0.0, 20.0));
    figure.extend(solids::moved(
        &solids::sphere(4.0, 4),
        Vec3::new(0.0, 0.0, 30.0),
    ));
    // A spear in its hand, which supports hold at its lower end.
    figure.extend(solids::moved(
        &solids::cylinder(0.8, 40.0, 4),
        Vec3::new(8.0, 0.0, 0.0),
    ));
    let mut all = solids::all();
    all.push(("figure with a spear", figure));
    all.push(("plate", solids::cuboid(Vec3::new(40.0, 30.0, 2.0))));
    all
}

#[test]
fn supports_of_every_strength_are_recognised_in_exported_files() {
    let (mut found, mut supports, mut wrong, mut model) = (0, 0, 0, 0);
    for (name, triangles) in models() {
        for strength in [
            SupportStrength::Light,
            SupportStrength::Medium,
            SupportStrength::Heavy,
        ] {
            for raft in [false, true] {
                let profile = SupportProfile {
                    raft,
                    ..strength.profile()
                };
                let supporting = Supporting {
                    profile: Some(profile),
                    ..Supporting::default()
                };
                let (all, own) = exported(&triangles, &supporting);
                let [right, false_alarms] = recognised(&all, own);
                println!(
                    "{name} {strength:?} {raft}: {right} of {}, {false_alarms} of {own}",
                    all.len() - own
                );
                found += right;
                supports += all.len() - own;
                wrong += false_alarms;
                model += own;
            }
        }
    }
    assert!(found * 1000 >= supports * 999, "{found} of {supports}");
    assert!(wrong * 100 <= model, "{wrong} of {model}");
}

/// A body of revolution from the plate up, of radii at heights.
fn turned(profile: &[[f64; 2]]) -> solids::Triangles {
    const SIDES: usize = 20;
    let ring = |[radius, z]: [f64; 2]| -> Vec<Vec3> {
        let side = |side: usize| {
            let (sin, cos) = (std::f64::consts::TAU * side as f64 / SIDES as f64).sin_cos();
            DVec3::new(radius * cos, radius * sin, z).as_vec3()
        };
        (0..SIDES).map(side).collect()
    };
    let mut all = Vec::new();
    for pair in profile.windows(2) {
        let [low, high] = [pair[0], pair[1]].map(ring);
        for side in 0..SIDES {
            let next = (side + 1) % SIDES;
            all.push([low[side], low[next], high[next]]);
            all.push([low[side], high[next], high[side]]);
        }
    }
    let [first, last] = [profile[0], profile[profile.len() - 1]].map(ring);
    for side in 1..SIDES - 1 {
        all.push([first[0], first[side + 1], first[side]]);
        all.push([last[0], last[side], last[side + 1]]);
    }
    all
}

/// A ball above a plane as another program supports it: pillars welded to their feet, heads of ball and cone, balls as joints, and
/// braces, of which the lowest reaches below the feet.
#[test]
fn supports_of_other_structure_are_recognised() {
    let ball = solids::moved(&solids::sphere(8.0, 6), Vec3::new(0.0, 0.0, 14.0));
    let mut supports = Vec::new();
    let steps = [-1, 0, 1].map(|it| f64::from(it) * 3.0);
    for (x, y) in steps.into_iter().flat_map(|x| steps.map(|y| (x, y))) {
        let contact_mm = 14.0 - (64.0 - x * x - y * y).sqrt();
        let at = |triangles: solids::Triangles| {
            solids::moved(&triangles, DVec3::new(x, y, 0.0).as_vec3())
        };
        let neck_mm = contact_mm - 2.0;
        supports.extend(at(turned(&[[1.5, 0.4], [0.5, 1.4], [0.5, neck_mm]])));
        supports.extend(at(turned(&[
            [0.1, neck_mm - 0.5],
            [0.45, neck_mm - 0.2],
            [0.5, neck_mm],
            [0.2, contact_mm],
            [0.05, contact_mm + 0.25],
        ])));
        let joint = solids::sphere(0.5, 3);
        let joint = solids::moved(&joint, Vec3::new(0.0, 0.0, neck_mm as f32));
        supports.extend(at(joint));
    }
    // Between pillars, from below the feet.
    let brace = turned(&[[0.4, 0.0], [0.4, 3.0]]);
    let lean = |it: Vec3| it + Vec3::new(it.z - 1.5, 0.0, 0.0);
    supports.extend(brace.iter().map(|corners| corners.map(lean)));
    let all = [&ball[..], &supports].concat();
    let mesh = Mesh::from_triangles(&all).unwrap();
    let mesh = mesh.with_own_supports(&all, false).unwrap();
    let theirs = mesh.of_class(FacetClass::Support);
    assert_eq!(theirs.len(), supports.len());
    assert_eq!(mesh.facets.len() - theirs.len(), ball.len());
    // The feet stand on the plate, and the brace ends there.
    assert_near(mesh.raised_mm(), 6.0 - 0.4, 1e-6);
}

#[test]
fn bodies_of_models_are_no_supports() {
    let leg = |x: f32, y: f32| {
        let legs = solids::cylinder(1.0, 20.0, 4);
        solids::moved(&legs, Vec3::new(x, y, 0.0))
    };
    let mut table = solids::moved(
        &solids::cuboid(Vec3::new(30.0, 20.0, 2.0)),
        Vec3::new(0.0, 0.0, 19.5),
    );
    for [x, y] in [[3.0, 3.0], [27.0, 3.0], [3.0, 17.0], [27.0, 17.0]] {
        table.extend(leg(x, y));
    }
    // Cones beside a figure, as grass.
    let mut meadow = solids::cuboid(Vec3::new(30.0, 20.0, 1.0));
    for place in 0..12 {
        let at = Vec3::new(2.0 * place as f32 + 2.0, 4.0, 0.5);
        meadow.extend(solids::moved(&solids::cone(0.8, 6.0, 4), at));
    }
    meadow.extend(solids::moved(
        &solids::sphere(6.0, 5),
        Vec3::new(15.0, 12.0, 6.5),
    ));
    let torture = solids::torture().into_iter().map(|it| (it.0, it.1));
    let all = models().into_iter().chain(torture);
    for (name, triangles) in all.chain([("table", table), ("meadow", meadow)]) {
        let found = recognised(&triangles, triangles.len());
        assert_eq!(found, [0, 0], "{name}");
    }
}

#[test]
fn a_supported_model_is_read_as_it_was_made() {
    let ball = solids::sphere(8.0, 6);
    let options = Options {
        supports: Some(Supporting::default()),
        pitch_mm: Some(0.1),
        ..Options::default()
    };
    let made = plan(&mut load(&ball), &options);
    let bare = Options {
        supports: None,
        ..options.clone()
    };
    let (all, _) = exported(&ball, &Supporting::default());
    let stl = solids::binary_stl(&all);
    let mut slicer = Slicer::load(&stl).unwrap();
    let read = plan(&mut slicer, &bare);
    // Profile, heights and resin are those of the model and its supports.
    assert_eq!(read.z_mm, made.z_mm);
    assert_near(read.resin_ml, made.resin_ml, 1e-3 * made.resin_ml);
    let [ours, theirs] = [&made, &read].map(|it| it.models[0].supported.clone().unwrap());
    assert_eq!(theirs.lift_mm, ours.lift_mm);
    assert_eq!(theirs.points.len(), ours.points.len());
    assert_near(theirs.support_ml, ours.support_ml, 1e-3 * ours.support_ml);
    let kept = Warning::OwnSupports {
        tips: theirs.points.len(),
        replaced: false,
    };
    assert!(read.all_warnings().contains(&kept));
    let found = slicer.inspect(&Limits::default(), &mut quiet).unwrap();
    let counts = found.counts.iter();
    let faults = counts.filter(|it| [Code::Island, Code::Overhang].contains(&it.code));
    assert_eq!(faults.count(), 0, "{:?}", found.counts);
    // Supports that are asked for replace them.
    let replaced = plan(&mut slicer, &options);
    assert_eq!(replaced.z_mm, made.z_mm);
    assert_near(replaced.resin_ml, made.resin_ml, 1e-3 * made.resin_ml);
    // Read as a model, they are lifted by nothing, and errors are theirs, too.
    let as_model = ReadOptions {
        supports_as_model: true,
        ..ReadOptions::default()
    };
    let whole = plan(&mut Slicer::load_with(&stl, &as_model).unwrap(), &bare);
    assert!(whole.models[0].supported.is_none());
    assert!(
        whole.layers > read.layers,
        "{} {}",
        whole.layers,
        read.layers
    );
}

#[test]
fn tips_of_a_file_stay_as_wide_when_masks_shrink() {
    let light = Supporting {
        strength: SupportStrength::Light,
        ..Supporting::default()
    };
    let (all, _) = exported(&solids::cuboid(Vec3::new(8.0, 8.0, 3.0)), &light);
    // A layer through the tips, a tenth of a millimetre below the slab.
    let area_mm2 = |xy_mm| {
        let options = Options {
            resin: Resin {
                compensation: Compensation {
                    xy_mm,
                    ..Compensation::default()
                },
                ..Resin::default()
            },
            planner: Planner::Uniform { layer_mm: 0.05 },
            pitch_mm: Some(0.025),
            ..Options::default()
        };
        let mut slicer = load(&all);
        plan(&mut slicer, &options);
        let found = slicer.inspect(&Limits::default(), &mut quiet).unwrap();
        found.peel.area_mm2[97]
    };
    let [as_modelled, shrunk] = [0.0, 0.15].map(area_mm2);
    assert!(as_modelled > 0.5);
    let ratio = shrunk / as_modelled;
    assert!((0.95..1.2).contains(&ratio), "{ratio}");
}
