//! `orient`: one model, a batch, and shards of a batch.

use std::process::Output;

use serde_json::Value;
use tempfile::TempDir;

use super::{assert_fails, cusp, json, model, on_cpu, slab, sphere};

#[test]
fn orient_finds_the_best_direction_and_applies_it() {
    let folder = TempDir::new().unwrap();
    let model = slab(&folder);
    let flat = folder.path().join("flat.stl").display().to_string();
    let output = cusp(&[
        "orient",
        &model,
        "--directions",
        "60",
        "--apply",
        "1",
        "-o",
        &flat,
        "--json",
    ]);
    let found = json(&output);
    let best = &found["best"][0];
    assert_eq!(
        found["model"],
        json(&on_cpu(&["plan", &model, "--json"]))["models"][0]["file"]
    );
    assert!((best["size_mm"][2].as_f64().unwrap() - 2.0).abs() < 1e-4);
    assert!(best["energy"].as_f64() < found["now"]["energy"].as_f64());
    let plan = json(&on_cpu(&["plan", &flat, "--json"]));
    assert_eq!(plan["layers"], best["metrics"]["layers"]);
    // Planning with the rotation that it reports gives the same.
    let rotation: Vec<String> = best["rotation"]
        .as_array()
        .unwrap()
        .iter()
        .map(Value::to_string)
        .collect();
    let rotation = format!("--rotation={}", rotation.join(","));
    assert_eq!(
        json(&on_cpu(&["plan", &model, &rotation, "--json"]))["layers"],
        plan["layers"]
    );

    let words = cusp(&[
        "orient",
        &model,
        "--directions",
        "60",
        "--quality",
        "overhang",
        "--cost",
        "time",
    ]);
    let words = String::from_utf8(words.stdout).unwrap();
    assert!(words.contains("72 directions"), "{words}");
    assert!(words.contains("\nnow "), "{words}");
    assert!(words.contains("--rotation="), "{words}");
    let none = cusp(&[
        "orient",
        &model,
        "--directions",
        "60",
        "--tolerance",
        "0.0001",
    ]);
    assert!(none.status.success());
    let none = String::from_utf8(none.stdout).unwrap();
    assert!(
        none.contains("72 without a plan within tolerance"),
        "{none}"
    );
    assert!(none.contains("no orientation"), "{none}");

    assert_fails(&cusp(&["orient", &model, "--apply", "1"]), 2, "--output");
    assert_fails(&cusp(&["orient", &model, "--alpha", "2"]), 2, "from 0 to 1");
    let ranked = ["orient", &model, "--directions", "60", "--json"];
    let ranked = json(&cusp(&[&ranked[..], &["--rank", "height=1"]].concat()));
    assert_eq!(ranked["search"]["ranking"]["height"], 1.0);
    let height = |candidate: &Value| candidate["size_mm"][2].as_f64().unwrap();
    let candidates = ranked["candidates"].as_array().unwrap();
    let least = candidates.iter().map(height).fold(f64::INFINITY, f64::min);
    assert!(height(&ranked["best"][0]) <= least);
    assert_fails(
        &cusp(&["orient", &model, "--rank", "beauty=1"]),
        2,
        "islands=3",
    );
    let both = ["orient", &model, "--rank", "height=1", "--alpha", "0.5"];
    assert_fails(&cusp(&both), 2, "cannot be used with");
    let two = cusp(&["orient", &model, &model, "--apply", "1", "-o", &flat]);
    assert_fails(&two, 1, "--apply is for one model");
    let itself = cusp(&["orient", &model, "--apply", "1", "-o", &model]);
    assert_fails(&itself, 1, "is the model itself");
}

#[test]
fn shards_of_a_batch_give_what_one_process_gives() {
    let folder = TempDir::new().unwrap();
    let [slab, ball] = [slab(&folder), sphere(&folder)];
    let batch = |more: &[&str]| {
        let models = [
            "orient",
            &slab,
            &ball,
            "--directions",
            "40",
            "--bin",
            "0.01",
        ];
        cusp(&[&models[..], more].concat())
    };
    let parts: Vec<String> = (1..=3)
        .map(|number| {
            let part = batch(&["--shard", &format!("{number}/3")]);
            assert!(part.status.success());
            let path = folder.path().join(format!("part-{number}.jsonl"));
            std::fs::write(&path, part.stdout).unwrap();
            path.display().to_string()
        })
        .collect();
    let merge = |places: &[usize]| {
        let parts = places.iter().map(|&place| parts[place].as_str());
        let arguments: Vec<&str> = ["--json", "--merge"].into_iter().chain(parts).collect();
        batch(&arguments)
    };
    let whole = batch(&["--json"]);
    assert_eq!(String::from_utf8_lossy(&whole.stdout).lines().count(), 2);
    assert_eq!(merge(&[2, 0, 1]).stdout, whole.stdout);

    for (places, words) in [
        (&[0, 1][..], "directions are missing"),
        (&[0, 1, 2, 1], "measured twice, in shards 2/3 and 2/3"),
    ] {
        assert_only_bad(&merge(places), "", &[(&slab, words), (&ball, words)]);
    }
    let other = cusp(&["orient", &slab, "--directions", "40", "--merge", &parts[0]]);
    assert_fails(&other, 1, "other options");
    assert_fails(&batch(&["--shard", "4/3"]), 2, "from 1/N to N/N");
    assert_fails(&batch(&["--merge", &slab]), 1, "slab.stl");
}

#[test]
fn a_bad_model_does_not_stop_the_others_of_a_batch() {
    let folder = TempDir::new().unwrap();
    let [slab, ball] = [slab(&folder), sphere(&folder)];
    let poem = model(&folder, "poem.stl", b"solid as a rock");
    let absent = folder.path().join("absent.stl").display().to_string();
    let orient = |models: &[&str], more: &[&str]| {
        let fixed = ["orient", "--directions", "40", "--bin", "0.01"];
        cusp(&[&fixed[..], models, more].concat())
    };
    let good = |more: &[&str]| {
        let output = orient(&[&slab, &ball], more);
        assert!(output.status.success());
        assert_eq!(String::from_utf8_lossy(&output.stderr), "");
        String::from_utf8(output.stdout).unwrap()
    };
    let models = [&poem, &slab, &absent, &ball].map(String::as_str);
    let bad = [(poem.as_str(), ""), (absent.as_str(), "No such file")];
    for how in [&[][..], &["--json"], &["--shard", "1/1"]] {
        assert_only_bad(&orient(&models, how), &good(how), &bad);
    }
    // Merging reports the same bad models.
    let part = model(&folder, "part.jsonl", good(&["--shard", "1/1"]).as_bytes());
    let merged = orient(&models, &["--json", "--merge", &part]);
    assert_only_bad(&merged, &good(&["--json"]), &bad);
    assert_only_bad(&orient(&[&absent], &[]), "", &bad[1..]);

    // A weights file belongs to one model.
    let weights = folder.path().join("slab.weights").display().to_string();
    assert!(cusp(&["saliency", &slab, "-o", &weights]).status.success());
    let weighed = ["--json", "--weights", &weights];
    let alone = orient(&[&slab], &weighed);
    assert!(alone.status.success());
    assert_only_bad(
        &orient(&[&ball, &slab], &weighed),
        &String::from_utf8(alone.stdout).unwrap(),
        &[(&ball, "slab.weights: these weights are for another mesh")],
    );

    // An error that concerns every model is reported once.
    for (how, words) in [
        (
            ["--layer-min", "0.2"],
            "cusp: the least layer thickness of 0.2 mm",
        ),
        (["--printer", "none"], "cusp: there is no printer none"),
        (["--weights", &slab], "no file of weights"),
        (["--weights", &absent], "absent.stl: No such file"),
        (["--resin", &absent], "absent.stl: No such file"),
    ] {
        assert_fails(&orient(&models, &how), 1, words);
        let merge = [&how[..], &["--merge", &part]].concat();
        assert_fails(&orient(&models, &merge), 1, words);
    }
}

/// Asserts that a batch writes `stdout`, besides the lines of failures, and reports exactly these bad models, each with
/// an error that contains its text.
#[track_caller]
fn assert_only_bad(output: &Output, stdout: &str, bad: &[(&str, &str)]) {
    let printed = String::from_utf8_lossy(&output.stdout);
    let is_failure = |line: &&str| line.starts_with("{\"error\":");
    let failures = printed.lines().filter(is_failure);
    let failures: Vec<Value> = failures
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    if !failures.is_empty() {
        let models = failures
            .iter()
            .map(|line| line["error"]["file"].as_str().unwrap());
        assert!(models.eq(bad.iter().map(|(model, _)| *model)), "{printed}");
    }
    let others: Vec<&str> = printed
        .split_inclusive('\n')
        .filter(|line| !is_failure(line))
        .collect();
    assert_eq!(others.concat(), stdout);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    let lines: Vec<&str> = stderr.lines().collect();
    assert_eq!(lines.len(), bad.len(), "{stderr}");
    for (line, (model, words)) in lines.iter().zip(bad) {
        assert!(line.starts_with(&format!("cusp: {model}: ")), "{line}");
        assert!(line.contains(words), "{line}");
    }
}
