//! Places of copies: apart from each other, on the plate, and on the fewest plates.

use cusp_slicer::arrange::{ArrangeError, Arranging};
use cusp_slicer::job::{Job, JobOptions, ModelOptions, Options, Placement};
use cusp_slicer::prepare::Hollowing;
use glam::Vec3;

use super::{job, options, pixels, placed, plan, plate, supported};
use crate::common::solids;

/// For each plate and model, the pixels that it lights in any layer, found from the masks of the plate with nothing else on it.
fn shadows(
    models: &[&solids::Triangles],
    options: &JobOptions,
    found: &[Placement],
) -> Vec<Vec<[i64; 2]>> {
    found
        .iter()
        .map(|place| {
            let mut alone = plate(models);
            let options = placed(options, &[Placement { plate: 0, ..*place }]);
            let report = plan(&mut alone, &options).unwrap();
            let mut lit = vec![vec![false; 400]; 300];
            for layer in 0..report.plates[0].layers {
                let mask = pixels(&alone.mask(0, layer).unwrap(), 400);
                for (all, row) in lit.iter_mut().zip(&mask) {
                    for (all, pixel) in all.iter_mut().zip(row) {
                        *all |= pixel;
                    }
                }
            }
            let rows = (0i64..).zip(lit);
            rows.flat_map(|(row, columns)| {
                let lit = (0i64..).zip(columns).filter(|(_, lit)| *lit);
                lit.map(move |(column, _)| [column, row])
                    .collect::<Vec<_>>()
            })
            .collect()
        })
        .collect()
}

/// The least distance between two sets of pixels in millimetres, from edge to edge.
fn distance_mm(a: &[[i64; 2]], b: &[[i64; 2]]) -> f64 {
    let gap = |a: i64, b: i64| ((a - b).abs() - 1).max(0) as f64 * 0.1;
    let pairs = a.iter().flat_map(|a| {
        b.iter().map(move |b| {
            let (x_mm, y_mm) = (gap(a[0], b[0]), gap(a[1], b[1]));
            x_mm * x_mm + y_mm * y_mm
        })
    });
    pairs.fold(f64::INFINITY, f64::min).sqrt()
}

/// The pixels of a set that have a neighbour outside it: distances between sets are between these.
fn edge(set: &[[i64; 2]]) -> Vec<[i64; 2]> {
    let all: std::collections::HashSet<[i64; 2]> = set.iter().copied().collect();
    let around = [[1, 0], [-1, 0], [0, 1], [0, -1]];
    let is_edge = |pixel: &&[i64; 2]| {
        let beside = around.map(|by| [pixel[0] + by[0], pixel[1] + by[1]]);
        beside.iter().any(|pixel| !all.contains(pixel))
    };
    set.iter().filter(is_edge).copied().collect()
}

#[test]
fn arranged_copies_are_as_far_apart_as_asked_and_on_their_plate() {
    let (l_shape, ball, bar) = (
        {
            let mut l_shape = solids::cuboid(Vec3::new(9.0, 2.0, 1.0));
            l_shape.extend(solids::cuboid(Vec3::new(2.0, 8.0, 1.0)));
            l_shape
        },
        solids::sphere(2.5, 2),
        solids::cuboid(Vec3::new(12.0, 1.5, 2.0)),
    );
    let long = solids::cuboid(Vec3::new(28.0, 8.0, 1.0));
    let models = [&l_shape, &ball, &bar, &long];
    let mut turned = 0;
    for (spacing_mm, turn_deg, copies) in [
        (0.0, 0, [3, 2, 2, 0]),
        (1.3, 90, [4, 5, 6, 1]),
        (1.0, 15, [0, 0, 0, 4]),
        (2.0, 15, [4, 8, 4, 0]),
    ] {
        let options = JobOptions {
            arranging: Arranging {
                spacing_mm,
                turn_deg,
            },
            ..job(options(), &copies)
        };
        let found = plate(&models).arrange(&options).unwrap();
        for (model, copies) in copies.into_iter().enumerate() {
            let of_model = found.iter().filter(|place| place.model == model);
            assert_eq!(of_model.count(), copies);
        }
        turned += found.iter().filter(|place| place.turn_deg > 0).count();
        assert!(found.iter().all(|place| {
            place.turn_deg == 0
                || turn_deg > 0 && (place.turn_deg % turn_deg == 0 || place.turn_deg % 90 == 0)
        }));
        let edges: Vec<_> = shadows(&models, &options, &found)
            .iter()
            .map(|set| edge(set))
            .collect();
        for (a, edge_a) in found.iter().zip(&edges) {
            for (b, edge_b) in found.iter().zip(&edges) {
                if std::ptr::eq(a, b) || a.plate != b.plate {
                    continue;
                }
                let apart_mm = distance_mm(edge_a, edge_b);
                assert!(
                    apart_mm >= spacing_mm - 1e-9,
                    "{apart_mm} of {spacing_mm}: {a:?} {b:?}"
                );
                assert!(edge_a.iter().all(|pixel| !edge_b.contains(pixel)));
            }
        }
        assert_eq!(
            plate(&models).problems(&placed(&options, &found)).unwrap(),
            []
        );
    }
    assert!(turned > 0);
}

#[test]
fn supports_count_when_copies_are_arranged() {
    // The feet of its supports stand next to its stem.
    let tee = {
        let mut tee = solids::cuboid(Vec3::new(8.0, 6.0, 1.0));
        tee.extend(solids::moved(
            &solids::cuboid(Vec3::new(1.0, 1.0, 4.0)),
            Vec3::new(0.0, 2.0, -4.0),
        ));
        tee
    };
    let ball = solids::sphere(3.0, 3);
    let models = [&tee, &ball];
    let options = JobOptions {
        arranging: Arranging {
            spacing_mm: 1.0,
            turn_deg: 15,
        },
        ..job(supported(), &[5, 2])
    };
    let found = plate(&models).arrange(&options).unwrap();
    let sets = shadows(&models, &options, &found);
    for (a, of_a) in found.iter().zip(&sets) {
        for (b, of_b) in found.iter().zip(&sets) {
            if !std::ptr::eq(a, b) && a.plate == b.plate {
                let apart_mm = distance_mm(&edge(of_a), &edge(of_b));
                assert!(apart_mm >= 1.0 - 1e-9, "{apart_mm}: {a:?} {b:?}");
            }
        }
    }
    assert_eq!(
        plate(&models).problems(&placed(&options, &found)).unwrap(),
        []
    );
    // An overlap of supports alone is a problem.
    let near = [0.0, 7.2].map(|x_mm| Placement {
        model: 0,
        plate: 0,
        x_mm,
        y_mm: 0.0,
        turn_deg: 90,
    });
    let bare = job(super::options(), &[2, 0]);
    assert_eq!(plate(&models).problems(&placed(&bare, &near)).unwrap(), []);
    let problems = plate(&models).problems(&placed(&options, &near)).unwrap();
    assert!(!problems.is_empty());
}

#[test]
fn prepared_models_that_fit_only_when_turned_are_turned() {
    let hollow = Options {
        hollow: Some(Hollowing {
            wall_mm: 1.0,
            ..Hollowing::default()
        }),
        ..options()
    };
    let plans = |length_mm: f32, options: &Options, turn_deg: u32| {
        let bar = solids::cuboid(Vec3::new(length_mm, 3.0, 5.0));
        let options = JobOptions {
            arranging: Arranging {
                turn_deg,
                ..Arranging::default()
            },
            ..job(options.clone(), &[2])
        };
        let planned = plan(&mut plate(&[&bar]), &options);
        planned.map_err(|error| error.code())
    };
    // What takes time to prepare is refused before that.
    let refused = ["plate-too-small", "model-too-large", "model-too-large"];
    for (options, code) in [options(), hollow, supported()].into_iter().zip(refused) {
        let report = plans(42.0, &options, 15).unwrap();
        let places = report.plates.iter().flat_map(|plate| &plate.placements);
        assert!(places.clone().all(|place| place.turn_deg % 90 != 0));
        assert_eq!(places.count(), 2);
        // The plate is 40 mm wide, and its diagonal 50 mm long.
        assert_eq!(plans(42.0, &options, 0).unwrap_err(), code);
        assert_eq!(plans(51.0, &options, 15).unwrap_err(), code);
    }
}

fn plates_of(
    models: &[&solids::Triangles],
    copies: &[usize],
    spacing_mm: f64,
    turn_deg: u32,
) -> usize {
    let options = JobOptions {
        arranging: Arranging {
            spacing_mm,
            turn_deg,
        },
        ..job(options(), copies)
    };
    let found = plate(models).arrange(&options).unwrap();
    found.iter().map(|place| place.plate + 1).max().unwrap()
}

#[test]
fn squares_fill_a_plate_in_rows_and_columns() {
    // 40 × 30 mm hold 4 × 3 squares of 8 mm that are 2 mm apart, and 5 × 3 of 7.7 mm that touch.
    let square = |side| solids::cuboid(Vec3::new(side, side, 1.0));
    assert_eq!(plates_of(&[&square(8.0)], &[12], 2.0, 0), 1);
    assert_eq!(plates_of(&[&square(8.0)], &[13], 2.0, 0), 2);
    assert_eq!(plates_of(&[&square(7.7)], &[15], 0.0, 0), 1);
    assert_eq!(plates_of(&[&square(7.7)], &[16], 0.0, 0), 2);
}

#[test]
fn what_lies_in_a_bay_needs_no_room_of_its_own() {
    // A frame around nearly the whole plate, with a ball inside.
    let mut frame = solids::cuboid(Vec3::new(38.0, 2.0, 1.0));
    frame.extend(solids::moved(&frame.clone(), Vec3::new(0.0, 26.0, 0.0)));
    let side = solids::moved(&solids::cuboid(Vec3::new(2.0, 28.0, 1.0)), Vec3::ZERO);
    frame.extend(solids::moved(&side, Vec3::new(36.0, 0.0, 0.0)));
    frame.extend(side);
    assert_eq!(
        plates_of(&[&frame, &solids::sphere(8.0, 2)], &[1, 1], 2.0, 0),
        1
    );
    assert_eq!(
        plates_of(&[&frame, &solids::sphere(12.5, 2)], &[1, 1], 2.0, 0),
        2
    );
}

#[test]
fn models_are_turned_where_that_saves_a_plate_and_only_there() {
    let bar = solids::cuboid(Vec3::new(28.0, 8.0, 1.0));
    // Three lie one behind the other; a fourth fits only next to them, upright.
    assert_eq!(plates_of(&[&bar], &[4], 1.0, 0), 2);
    assert_eq!(plates_of(&[&bar], &[4], 1.0, 90), 1);
    let three = plate(&[&bar]).arrange(&job(options(), &[3])).unwrap();
    assert!(three.iter().all(|place| place.turn_deg == 0));
}

#[test]
fn high_models_share_a_plate() {
    let column = |height| solids::cuboid(Vec3::new(18.0, 28.0, height));
    // Two fit on a plate: the two high ones belong together.
    let models = [&column(20.0), &column(2.0), &column(19.0), &column(3.0)];
    let found = plate(&models)
        .arrange(&job(options(), &[1, 1, 1, 1]))
        .unwrap();
    let plate_of = |model: usize| found.iter().find(|it| it.model == model).unwrap().plate;
    assert_eq!(plate_of(0), plate_of(2));
    assert_eq!(plate_of(1), plate_of(3));
    assert_ne!(plate_of(0), plate_of(1));
}

fn code<T: std::fmt::Debug>(result: Result<T, cusp_slicer::Error>) -> String {
    result.unwrap_err().code()
}

#[test]
fn a_plate_that_cannot_be_arranged_says_why() {
    let cube = solids::cube(5.0);
    let of = |options: Options, copies| plate(&[&cube]).arrange(&job(options, &[copies]));
    assert_eq!(code(of(Options::default(), 2)), "plate-without-size");
    assert_eq!(code(of(options(), 0)), "plate-empty");
    assert_eq!(
        code(Job::new(Vec::new()).arrange(&job(options(), &[]))),
        "plate-empty"
    );
    let high = Options {
        height_mm: Some(35.0),
        ..options()
    };
    assert_eq!(code(of(high, 1)), "plate-too-small");
    // A model without copies is not in the way.
    let [wide, wider] = [50.0, 60.0].map(|side| solids::cuboid(Vec3::new(side, 5.0, 5.0)));
    let refused = plate(&[&wider, &cube, &wide]).arrange(&job(options(), &[0, 1, 1]));
    let too_large = refused.unwrap_err();
    assert!(
        matches!(
            too_large,
            cusp_slicer::Error::Arrange(ArrangeError::TooLarge {
                model_number: 3,
                ..
            })
        ),
        "{too_large:?}"
    );
    for (spacing_mm, turn_deg, expected) in [
        (-1.0, 0, "bad-spacing"),
        (f64::NAN, 0, "bad-spacing"),
        (1.0, 50, "bad-turn"),
    ] {
        let options = JobOptions {
            arranging: Arranging {
                spacing_mm,
                turn_deg,
            },
            ..job(options(), &[2])
        };
        assert_eq!(code(plate(&[&cube]).arrange(&options)), expected);
    }
}

#[test]
fn copies_that_overlap_or_leave_the_plate_are_found() {
    let (cube, ball) = (solids::cube(4.0), solids::sphere(2.0, 3));
    let place = |model, x_mm, y_mm| Placement {
        model,
        plate: 0,
        x_mm,
        y_mm,
        turn_deg: 0,
    };
    let codes = |placements: &[Placement]| {
        let options = placed(&job(options(), &[1, 1]), placements);
        let problems = plate(&[&cube, &ball])
            .problems(&placed(&options, placements))
            .unwrap();
        let codes: Vec<String> = problems
            .into_iter()
            .map(|problem| cusp_slicer::Error::from(problem).code())
            .collect();
        let planned = plan(&mut plate(&[&cube, &ball]), &options);
        match codes.first() {
            Some(first) => assert_eq!(code(planned), *first),
            None => assert!(planned.is_ok()),
        }
        codes
    };
    assert_eq!(codes(&[place(0, 0.0, 0.0), place(1, 4.2, 0.0)]), [""; 0]);
    assert_eq!(
        codes(&[place(0, 0.0, 0.0), place(1, 3.5, 0.0)]),
        ["plate-collision"]
    );
    // The corner of the cube is next to the ball.
    assert_eq!(codes(&[place(0, 0.0, 0.0), place(1, 3.6, 3.6)]), [""; 0]);
    assert_eq!(codes(&[place(0, 18.5, 0.0)]), ["plate-outside"]);
    assert_eq!(codes(&[place(0, 18.0, -13.0)]), [""; 0]);
    assert_eq!(
        codes(&[place(1, 0.0, 13.5), place(1, 0.0, 13.5)]),
        ["plate-outside", "plate-outside", "plate-collision"]
    );
    assert_eq!(
        code(plate(&[&cube]).problems(&placed(&job(options(), &[1]), &[place(1, 0.0, 0.0)]))),
        "plate-no-model"
    );
}

#[test]
fn every_copy_that_overlaps_is_named_and_no_more_overlaps_than_copies() {
    let (cube, ball) = (solids::cube(4.0), solids::sphere(2.0, 3));
    let place = |model, plate, x_mm| Placement {
        model,
        plate,
        x_mm,
        y_mm: 0.0,
        turn_deg: 0,
    };
    let problems = |placements: &[Placement]| {
        let options = job(options(), &[1, 1]);
        let found = plate(&[&cube, &ball]).problems(&placed(&options, placements));
        found.unwrap()
    };
    // Copies are counted in the order of placements, over all plates.
    let placements = [
        place(0, 1, 0.0),
        place(1, 0, 10.0),
        place(0, 0, 0.0),
        place(0, 0, 13.0),
        place(1, 1, 18.5),
        place(0, 0, -9.0),
    ];
    assert_eq!(
        problems(&placements),
        [
            ArrangeError::Collision {
                model_numbers: [1, 2],
                copy_numbers: [3, 1],
                plate_number: 1
            },
            ArrangeError::Outside {
                model_number: 2,
                copy_number: 2,
                plate_number: 2
            },
        ]
    );
    // 60 copies in one place overlap in 1,770 pairs.
    let crowd = problems(&vec![place(0, 0, 0.0); 60]);
    assert!(crowd.len() < 60);
    let mut named: Vec<usize> = crowd
        .iter()
        .flat_map(|problem| match problem {
            ArrangeError::Collision { copy_numbers, .. } => copy_numbers.to_vec(),
            other => panic!("{other:?}"),
        })
        .collect();
    named.sort_unstable();
    named.dedup();
    assert_eq!(named, (1..=60).collect::<Vec<_>>());
}

#[test]
fn models_have_poses_of_their_own() {
    let bar = solids::cuboid(Vec3::new(35.0, 4.0, 2.0));
    let upright = ModelOptions {
        // A quarter turn about y: 35 mm high.
        rotation: Some([0.0, 1.0, 0.0, 1.0]),
        copies: 2,
        ..ModelOptions::default()
    };
    let options = JobOptions {
        models: vec![upright, ModelOptions::default()],
        ..job(options(), &[])
    };
    let report = plan(&mut plate(&[&bar, &bar]), &options).unwrap();
    let models = &report.plates[0].models;
    let size = |model: usize| models[model].size_mm.map(|mm| (mm * 1e3).round() / 1e3);
    assert_eq!(size(0), [2.0, 4.0, 35.0]);
    assert_eq!(size(1), [35.0, 4.0, 2.0]);
    assert_eq!(models[0].copies, 2);
}
