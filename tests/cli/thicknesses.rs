//! Layers of given, few or gradual thicknesses, a fixed first layer, and the front of `compare`.

use serde_json::Value;
use tempfile::TempDir;

use super::{assert_fails, cusp, json, on_cpu, sphere};
use crate::common::assert_near;

fn numbers(values: &Value) -> Vec<f64> {
    let values = values.as_array().unwrap().iter();
    values.map(|value| value.as_f64().unwrap()).collect()
}

fn planned(ball: &str, options: &[&str]) -> Value {
    let plan = json(&on_cpu(&[&["plan", ball, "--json"], options].concat()));
    assert!(plan["max_error"].as_f64() <= plan["tolerance"].as_f64());
    assert!(plan["warnings"].as_array().unwrap().is_empty(), "{plan}");
    plan
}

#[test]
fn thicknesses_keep_to_their_rule() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let free = planned(&ball, &[]);
    let layers = |plan: &Value| plan["layers"].as_u64().unwrap();

    // Thicker than the default range, which given thicknesses replace.
    let given = planned(&ball, &["--thicknesses", "0.05,0.08,0.2"]);
    for thickness in numbers(&given["thickness_mm"]) {
        assert!(
            [0.05, 0.08, 0.2]
                .iter()
                .any(|mm| (mm - thickness).abs() < 1e-9),
            "{thickness}"
        );
    }
    let few = planned(&ball, &["--max-thicknesses", "2"]);
    let mut distinct = numbers(&few["thickness_mm"]);
    distinct.sort_by(f64::total_cmp);
    distinct.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    assert!(distinct.len() <= 2, "{distinct:?}");
    let gradual = planned(&ball, &["--max-change", "0.004"]);
    for two in numbers(&gradual["thickness_mm"]).windows(2) {
        assert!((two[0] - two[1]).abs() < 0.004 + 1e-9, "{two:?}");
    }
    let jumps = numbers(&free["thickness_mm"]);
    let jumps = jumps.windows(2).map(|two| (two[0] - two[1]).abs());
    assert!(
        jumps.fold(0.0, f64::max) > 0.005,
        "the rule has something to do"
    );
    for plan in [&few, &gradual] {
        assert!(layers(plan) >= layers(&free));
    }
}

#[test]
fn a_first_layer_is_as_thick_as_asked_and_a_server_verifies_it() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (plan, print) = (path("plan.json"), path("print.zip"));
    let options = ["--first-layer", "0.3", "--max-thicknesses", "3"];
    let sliced = on_cpu(&[&["slice", &ball, "-o", &print, "--json"], &options[..]].concat());
    let report = json(&sliced);
    assert_near(report["thickness_mm"][0].as_f64().unwrap(), 0.3, 1e-9);
    // The tolerance holds above it, the deviation is that of the whole print: half of the first layer, at the ball's pole.
    assert!(report["max_error"].as_f64() <= report["tolerance"].as_f64());
    let deviation_mm = report["max_deviation_mm"].as_f64().unwrap();
    assert!((0.14..=0.15).contains(&deviation_mm), "{deviation_mm}");
    assert!(report["warnings"].as_array().unwrap().is_empty());

    std::fs::write(&plan, &sliced.stdout).unwrap();
    let verified = json(&cusp(&[
        "verify", &plan, &ball, "--print", &print, "--json",
    ]));
    assert_eq!(verified["print_is_same"], true);

    // Uniform layers stand on it as well.
    let uniform = [
        "--planner",
        "uniform",
        "--layer",
        "0.1",
        "--first-layer",
        "0.3",
    ];
    let report = json(&on_cpu(
        &[&["plan", &ball, "--json"], &uniform[..]].concat(),
    ));
    let thickness_mm = numbers(&report["thickness_mm"]);
    assert_near(thickness_mm[0], 0.3, 1e-9);
    assert!(thickness_mm[1..].iter().all(|mm| (mm - 0.1).abs() < 1e-9));
}

#[test]
fn rules_that_exclude_each_other_are_told() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let run = |options: &[&str]| on_cpu(&[&["plan", &ball], options].concat());
    for other in [
        ["--layer-max", "0.2"],
        ["--max-thicknesses", "2"],
        ["--max-change", "0.01"],
    ] {
        let both = run(&[&["--thicknesses", "0.05,0.1"], &other[..]].concat());
        assert_fails(&both, 2, "cannot be used with");
    }
    let goal = run(&["--max-change", "0.01", "--max-layers", "90"]);
    assert_fails(&goal, 1, "max_change_mm does not go with max_layers");
    let planner = run(&["--max-thicknesses", "2", "--planner", "greedy"]);
    assert_fails(&planner, 1, "max_thicknesses does not go with planner");
    assert_fails(&run(&["--max-thicknesses", "0"]), 2, "0 is not in");
    assert_fails(&run(&["--thicknesses", "0.1,x"]), 2, "positive number");
    assert_fails(
        &run(&["--thicknesses", "0.12", "--tolerance", "0.01"]),
        1,
        "raise the tolerance to",
    );
    assert_fails(
        &run(&["--printer", "shuffle", "--first-layer", "0.4"]),
        1,
        "stay within its limits",
    );
    assert_fails(&run(&["--first-layer", "6"]), 1, "too thick");
}

#[test]
fn compare_sets_the_least_sum_beside_the_least_maximum() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let shown = on_cpu(&["compare", &ball, "--max-change", "0.01"]);
    let shown = String::from_utf8(shown.stdout).unwrap();
    assert!(shown.contains("gradual ") && shown.contains("least sum of volume error"));

    let comparison = json(&on_cpu(&["compare", &ball, "--json"]));
    let front = comparison["front"].as_array().unwrap();
    assert_eq!(front.len(), 9);
    let layers: Vec<u64> = front
        .iter()
        .map(|point| point["layers"].as_u64().unwrap())
        .collect();
    assert!(layers.is_sorted_by(|a, b| a < b), "{layers:?}");
    assert_eq!(
        (layers[0], layers[8]),
        (40, 120),
        "6 mm in layers of 0.15 and 0.05 mm"
    );
    let mut gained = 0;
    for point in front {
        let of = |plan: &str, error: &str| point[plan][error].as_f64().unwrap();
        let [sum, other_sum] = ["least_sum", "least_maximum"].map(|it| of(it, "volume_mm3"));
        let [other_max, max] = ["least_sum", "least_maximum"].map(|it| of(it, "max_error"));
        assert!(sum <= other_sum && max <= other_max, "{point}");
        gained += u32::from(sum < 0.97 * other_sum);
    }
    assert!(
        gained >= 3,
        "{gained} points at which the sum is worth planning for"
    );
}
