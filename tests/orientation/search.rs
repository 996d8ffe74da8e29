//! The search as a state machine, on candidates with a closed form: results in any order give the same outcome.

use std::f64::consts::PI;

use crate::common::assert_near;
use cusp_slicer::Error;
use cusp_slicer::orientation::shard::Shard;
use cusp_slicer::orientation::{
    Candidate, Cost, Exclusion, Metrics, Quality, Search, SearchError, SearchOptions, SearchResult,
    Task, TaskResult,
};
use fastrand::Rng;
use glam::DVec3;

const COUNT: usize = 300;

/// The planted best direction.
fn planted() -> DVec3 {
    DVec3::new(0.48, -0.6, 0.64)
}

fn options() -> SearchOptions {
    SearchOptions {
        directions: COUNT,
        alpha: 0.5,
        cost: Cost::Time,
        quality: Quality::Roughness,
        ..SearchOptions::default()
    }
}

/// Directions spread over the whole sphere.
fn directions(count: usize) -> Vec<[f64; 3]> {
    let direction = |i: usize| {
        let z = 1.0 - (2 * i + 1) as f64 / count as f64;
        let (sine, cosine) = (i as f64 * PI * (3.0 - 5f64.sqrt())).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        DVec3::new(radius * cosine, radius * sine, z).to_array()
    };
    (0..count).map(direction).collect()
}

/// A valley around the planted direction, a shallower one opposite, a third perpendicular to it, and a cap of excluded
/// directions.
fn measure(direction: [f64; 3]) -> Candidate {
    let at = DVec3::from_array(direction);
    let near = |to: DVec3, depth: f64| depth * (8.0 * (at.dot(to) - 1.0)).exp();
    let across = planted().any_orthonormal_vector();
    let height = 2.0 - near(planted(), 1.0) - near(-planted(), 0.8) - near(across, 0.9);
    let is_excluded = at.z > 0.95;
    let metrics = Metrics {
        layers: 100,
        print_time_s: 1000.0 * height,
        max_error: 0.05,
        roughness_mm: 0.01 * height + 0.001 * at.x,
        overhang_mm2: 0.0,
        islands: 0,
        cups_mm2: 0.0,
        support_ml: 0.0,
        contact_mm2: 0.0,
    };
    Candidate {
        direction,
        rotation: [0.0, 0.0, 0.0, 1.0],
        size_mm: [1.0; 3],
        excluded: is_excluded.then_some(Exclusion::TooHigh),
        metrics: (!is_excluded).then_some(metrics),
        energy: None,
    }
}

fn evaluate(task: Task) -> TaskResult {
    TaskResult {
        number: task.number,
        candidates: task.directions.into_iter().map(measure).collect(),
    }
}

fn search() -> Search {
    Search::new(options(), directions(COUNT)).unwrap()
}

/// Runs a search one task at a time.
fn run(mut search: Search) -> SearchResult {
    loop {
        if let Some(result) = search.result() {
            return result;
        }
        for task in search.next_tasks(1) {
            search.accept(evaluate(task)).unwrap();
        }
    }
}

#[test]
fn the_planted_direction_is_found() {
    let result = run(search());
    assert_eq!(result.candidates.len(), COUNT);
    assert_eq!(result.best.len(), 3);
    let [first, second, third] = [0, 1, 2].map(|i| DVec3::from_array(result.best[i].direction));
    assert!(first.angle_between(planted()).to_degrees() < 1.0);
    assert!(second.dot(planted()).abs() < 0.05);
    assert!(third.dot(planted()) < -0.99);
}

#[test]
fn any_order_of_results_gives_the_same_result() {
    let expected = run(search());
    for seed in 0..40 {
        let mut rng = Rng::with_seed(seed);
        let mut search = search();
        let mut out: Vec<Task> = Vec::new();
        while search.result().is_none() {
            assert!(!search.is_done());
            out.extend(search.next_tasks(rng.usize(0..20)));
            if out.is_empty() {
                continue;
            }
            let task = out.swap_remove(rng.usize(0..out.len()));
            if rng.u8(0..8) > 0 {
                search.accept(evaluate(task)).unwrap();
            } else {
                // The worker is lost, or its result comes too late.
                search.put_back(task.number).unwrap();
                let number = task.number;
                let late = search.accept(evaluate(task));
                assert_eq!(late, Err(SearchError::Task { task: number }));
            }
        }
        assert!(out.is_empty() && search.is_done() && search.next_tasks(9).is_empty());
        assert_eq!(search.result().unwrap(), expected, "seed {seed}");
    }
}

#[test]
fn every_direction_is_handed_out_once_and_all_over_the_sphere() {
    let all = directions(COUNT);
    let mut search = search();
    let mut seen: Vec<[f64; 3]> = Vec::new();
    for task in search.next_tasks(usize::MAX) {
        seen.extend(task.directions);
        let upper = seen.iter().filter(|it| it[2] > 0.0).count();
        assert!((2 * upper).abs_diff(seen.len()) <= 10, "{upper}");
    }
    assert_eq!(search.next_tasks(1), []);
    let key = |it: &[f64; 3]| all.iter().position(|other| other == it).unwrap();
    let mut places: Vec<usize> = seen.iter().map(key).collect();
    places.sort_unstable();
    assert!(places.into_iter().eq(0..COUNT));
}

#[test]
fn progress_never_falls_and_ends_at_one() {
    let mut search = search();
    assert_eq!(search.progress(), 0.0);
    let mut before = 0.0;
    while !search.is_done() {
        for task in search.next_tasks(3) {
            search.accept(evaluate(task)).unwrap();
            assert!(search.progress() >= before);
            before = search.progress();
            let is_measuring = search.measured() < COUNT;
            assert_eq!(before < 0.8, is_measuring, "{before}");
            if is_measuring {
                assert_near(before, 0.8 * search.measured() as f64 / COUNT as f64, 1e-12);
            }
        }
    }
    assert_eq!(before, 1.0);
}

#[test]
fn what_is_known_so_far_is_rated_by_itself() {
    let mut search = search();
    assert!(search.rated().iter().all(Option::is_none));
    for task in search.next_tasks(10) {
        search.accept(evaluate(task)).unwrap();
    }
    let rated = search.rated();
    let known: Vec<&Candidate> = rated.iter().flatten().collect();
    assert_eq!((rated.len(), known.len()), (COUNT, search.measured()));
    let of = |term: fn(&Metrics) -> f64| {
        known
            .iter()
            .filter_map(move |it| it.metrics.map(|it| term(&it)))
    };
    let most = |term| of(term).fold(0.0, f64::max);
    let (time, roughness) = (most(|it| it.print_time_s), most(|it| it.roughness_mm));
    for candidate in &known {
        let Some(metrics) = candidate.metrics else {
            assert_eq!(candidate.energy, None);
            continue;
        };
        let expected = 0.5 * metrics.print_time_s / time + 0.5 * metrics.roughness_mm / roughness;
        assert_near(candidate.energy.unwrap(), expected, 1e-12);
    }
    for (candidate, direction) in rated.iter().zip(search.directions()) {
        assert!(
            candidate
                .as_ref()
                .is_none_or(|it| it.direction == *direction)
        );
    }
    // At the end, the rated candidates are those of the result.
    let result = run(search.clone());
    assert_eq!(search.next_tasks(0), []);
    let last = Search::of_measured(options(), result.candidates.clone()).unwrap();
    let last: Vec<Candidate> = last.rated().into_iter().flatten().collect();
    assert_eq!(last, result.candidates);
}

#[test]
fn candidates_of_another_search_are_rated_without_being_measured() {
    let before = run(search()).candidates;
    let other = SearchOptions {
        alpha: 1.0,
        quality: Quality::Error,
        ..options()
    };
    let mut again = Search::of_measured(other, before).unwrap();
    assert_eq!((again.measured(), again.progress()), (COUNT, 0.8));
    // Only the rings of the refinements are measured.
    let tasks = again.next_tasks(usize::MAX);
    assert!(tasks.len() <= 5 && tasks.iter().all(|task| task.directions.len() == 6));
    for task in tasks {
        again.accept(evaluate(task)).unwrap();
    }
    let fresh = Search::new(other, directions(COUNT)).unwrap();
    assert_eq!(run(again), run(fresh));
}

#[test]
fn shards_together_measure_what_one_search_does() {
    let whole = run(search());
    for count in [1, 4, COUNT + 1] {
        let mut found = vec![None; COUNT];
        for number in 1..=count {
            let shard = Shard { number, count };
            let mut part = Search::of_shard(options(), directions(COUNT), shard).unwrap();
            for task in part.next_tasks(COUNT) {
                part.accept(evaluate(task)).unwrap();
            }
            assert_eq!((part.rated().len(), part.progress()), (COUNT, 1.0));
            let part = part.result().unwrap();
            assert!(part.best.is_empty());
            for (place, candidate) in shard.places(COUNT).zip(part.candidates) {
                assert!(found[place].replace(candidate).is_none());
            }
        }
        let found = found.into_iter().map(Option::unwrap).collect();
        assert_eq!(run(Search::of_measured(options(), found).unwrap()), whole);
    }
}

#[test]
fn where_nothing_fits_there_is_no_best() {
    let nowhere = |candidate: Candidate| Candidate {
        excluded: Some(Exclusion::NoPlan),
        metrics: None,
        ..candidate
    };
    let candidates = directions(COUNT).into_iter().map(measure).map(nowhere);
    let search = Search::of_measured(options(), candidates.collect()).unwrap();
    assert_eq!((search.is_done(), search.progress()), (true, 1.0));
    assert!(search.result().unwrap().best.is_empty());
    let none = Search::new(options(), Vec::new()).unwrap();
    assert_eq!(none.result().unwrap().candidates, []);
}

#[test]
fn results_of_no_task_are_refused() {
    let mut search = search();
    let task = search.next_tasks(1).remove(0);
    let number = task.number;
    let good = evaluate(task);
    let closed = Err(SearchError::Task { task: number });
    let unknown = TaskResult {
        number: number + 1,
        ..good.clone()
    };
    assert_eq!(
        search.accept(unknown),
        Err(SearchError::Task { task: number + 1 })
    );
    assert_eq!(
        search.put_back(number + 1),
        Err(SearchError::Task { task: number + 1 })
    );
    search.accept(good.clone()).unwrap();
    assert_eq!(search.accept(good), closed);
    assert_eq!(search.put_back(number), closed);
}

#[test]
fn candidates_that_are_not_of_the_task_are_refused() {
    let mut search = search();
    let task = search.next_tasks(1).remove(0);
    let good = evaluate(task);
    let last = good.candidates.len() - 1;
    let bad = |change: &dyn Fn(&mut Vec<Candidate>)| {
        let mut bad = good.clone();
        change(&mut bad.candidates);
        bad
    };
    for (result, place) in [
        (bad(&|it| it.swap(1, 3)), 1),
        (bad(&|it| it.truncate(last)), last),
        (bad(&|it| it.push(it[0].clone())), last + 1),
        (bad(&|it| it[2].metrics = None), 2),
        (bad(&|it| it[4].excluded = Some(Exclusion::NoPlan)), 4),
    ] {
        let refused = search.accept(result);
        assert_eq!(refused, Err(SearchError::Candidate { place }));
        assert_eq!(search.measured(), 0);
    }
    let bad = bad(&|it| it[2].metrics = None).candidates;
    let error = Search::of_measured(options(), bad).unwrap_err();
    assert_eq!(Error::from(error).code(), "search-candidate");
    // The task is still outstanding.
    search.accept(good).unwrap();
    assert_eq!(search.measured(), last + 1);
}

#[test]
fn what_cannot_be_searched_for_has_a_code() {
    let with = |change: fn(&mut SearchOptions)| {
        let mut options = options();
        change(&mut options);
        Search::new(options, directions(3)).unwrap_err()
    };
    for (error, json) in [
        (
            with(|it| it.directions = 0),
            r#"{"code":"bad-directions","detail":{"directions":0,"most":100000}}"#,
        ),
        (
            with(|it| it.directions = 100_001),
            r#"{"code":"bad-directions","detail":{"directions":100001,"most":100000}}"#,
        ),
        (
            with(|it| it.alpha = -0.5),
            r#"{"code":"bad-alpha","detail":{"alpha":-0.5}}"#,
        ),
    ] {
        assert_eq!(serde_json::to_string(&error).unwrap(), json);
    }
}
