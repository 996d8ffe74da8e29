//! Several models at once.

use std::process::Output;

use serde_json::Value;
use tempfile::TempDir;

use super::{assert_fails, cusp, json, model, names, of_only_plate, on_cpu, slab, sphere};
use crate::common::{binary_stl, solids};

const QUICK: [&str; 4] = ["--pitch", "0.1", "--backend", "cpu"];

fn quick(arguments: &[&str]) -> Output {
    cusp(&[arguments, &QUICK].concat())
}

/// The lines of a batch by model, which end in any order.
fn lines(output: &Output) -> Vec<Value> {
    let text = String::from_utf8(output.stdout.clone()).unwrap();
    let lines = text.lines().map(|line| serde_json::from_str(line).unwrap());
    let mut lines: Vec<Value> = lines.collect();
    lines.sort_by_key(|line| line["model"].to_string());
    lines
}

fn folder_in(folder: &TempDir, name: &str) -> String {
    let path = folder.path().join(name);
    std::fs::create_dir(&path).unwrap();
    format!("{}/", path.display())
}

fn files_in(folder: &str) -> Vec<String> {
    let files = std::fs::read_dir(folder).unwrap();
    let names = files.map(|file| file.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}

#[test]
fn each_model_of_a_batch_gives_the_print_file_that_it_gives_alone() {
    let folder = TempDir::new().unwrap();
    let (ball, slab) = (sphere(&folder), slab(&folder));
    let (prints, alone) = (folder_in(&folder, "prints"), folder_in(&folder, "alone"));
    let output = quick(&["slice", &ball, &slab, "-o", &prints, "--json"]);
    assert!(output.status.success());
    let lines = lines(&output);
    assert_eq!(lines.len(), 2);
    for (line, (model, name)) in lines.iter().zip([(&ball, "ball"), (&slab, "slab")]) {
        let print = format!("{prints}{name}.zip");
        assert_eq!(line["model"], **model);
        assert_eq!(line["output"], *print);
        assert_eq!(line["error"], Value::Null);
        let file = format!("{alone}{name}.zip");
        let report = json(&quick(&["slice", model, "-o", &file, "--json"]));
        assert_eq!(line["report"]["plates"][0]["z_mm"], report["z_mm"]);
        assert!(std::fs::read(&file).unwrap() == std::fs::read(&print).unwrap());
    }
    assert_eq!(files_in(&prints), ["ball.zip", "slab.zip"]);
}

#[test]
fn a_batch_larger_than_the_machine_writes_every_file_with_its_line() {
    let folder = TempDir::new().unwrap();
    let prints = folder_in(&folder, "prints");
    let models: Vec<String> = (1..=23)
        .map(|size| {
            let cube = solids::cube(size as f32 / 10.0 + 0.1);
            model(&folder, &format!("cube.{size}.stl"), &binary_stl(&cube))
        })
        .collect();
    let mut arguments = vec!["slice"];
    arguments.extend(models.iter().map(|model| &**model));
    arguments.extend(["-o", &prints]);
    let told = quick(&arguments);
    assert!(told.status.success());
    let told = String::from_utf8(told.stdout).unwrap();
    assert_eq!(told.lines().count(), 23);
    for size in 1..=23 {
        let words = format!("cube.{size}.stl: {prints}cube.{size}.zip: ");
        assert!(told.contains(&words), "{told}");
        let file = std::fs::File::open(format!("{prints}cube.{size}.zip")).unwrap();
        assert!(zip::ZipArchive::new(file).unwrap().len() > 1);
    }
}

#[test]
fn a_folder_takes_a_single_model_by_its_name_and_the_extension_of_the_printer() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let prints = folder_in(&folder, "prints");
    // A folder that exists needs no separator.
    let prints = prints.trim_end_matches('/');
    let output = on_cpu(&["slice", &ball, "-o", prints, "--printer", "saturn-3-ultra"]);
    assert!(output.status.success());
    assert_eq!(files_in(prints), ["ball.goo"]);
}

#[test]
fn a_bad_model_does_not_stop_the_batch_and_is_told_again_at_the_end() {
    let folder = TempDir::new().unwrap();
    let prints = folder_in(&folder, "prints");
    let (ball, poem) = (
        sphere(&folder),
        model(&folder, "poem.stl", b"a cube, o cube"),
    );
    let absent = folder.path().join("absent.stl").display().to_string();
    let output = quick(&["slice", &absent, &poem, &ball, "-o", &prints, "--json"]);
    assert_eq!(output.status.code(), Some(1));
    let told = String::from_utf8(output.stderr.clone()).unwrap();
    let told: Vec<&str> = told.lines().collect();
    let (at_once, at_the_end) = told.split_at(2);
    assert_eq!(at_the_end[0], "cusp: 2 of 3 models failed:");
    assert!(at_the_end[1].starts_with(&format!("cusp: {absent}: ")));
    assert!(at_the_end[2].starts_with(&format!("cusp: {poem}: ")));
    assert_eq!(at_the_end.len(), 3);
    for line in at_once {
        assert!(at_the_end.contains(line), "{told:?}");
    }
    let lines = lines(&output);
    let codes: Vec<&Value> = lines.iter().map(|line| &line["error"]["code"]).collect();
    assert_eq!(
        codes,
        ["file", "", "unknown-file-kind"]
            .map(|code| match code {
                "" => Value::Null,
                code => code.into(),
            })
            .iter()
            .collect::<Vec<_>>()
    );
    assert!(
        lines[2]["error"]["message"]
            .as_str()
            .unwrap()
            .contains("not a model")
    );
    assert_eq!(files_in(&prints), ["ball.zip"]);
}

#[test]
fn wrong_options_are_told_once_and_nothing_is_written() {
    let folder = TempDir::new().unwrap();
    let prints = folder_in(&folder, "prints");
    let (ball, slab) = (sphere(&folder), slab(&folder));
    let both = ["slice", &ball, &slab, "-o", &prints, "--layer-min", "0.2"];
    assert_fails(&quick(&both), 1, "is more than the greatest");
    let both = ["plan", &ball, &slab, "--layer-min", "0.2"];
    assert_fails(&quick(&both), 1, "is more than the greatest");
    assert!(files_in(&prints).is_empty());
}

#[test]
fn models_whose_print_files_would_have_one_name_are_refused_before_work() {
    let folder = TempDir::new().unwrap();
    let prints = folder_in(&folder, "prints");
    let (ball, other) = (sphere(&folder), folder_in(&folder, "other"));
    let capital = format!("{other}BALL.stl");
    std::fs::copy(&ball, &capital).unwrap();
    let output = quick(&["slice", &ball, &capital, "-o", &prints]);
    assert_fails(&output, 1, "would both become");
    let output = quick(&["slice", &ball, &ball, "-o", &prints]);
    assert_fails(&output, 1, "would both become");
    assert!(files_in(&prints).is_empty());
}

#[test]
fn several_models_need_a_folder_which_is_made_if_it_is_named_as_one() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let file = folder.path().join("all.zip").display().to_string();
    let output = quick(&["slice", &ball, &ball, "-o", &file]);
    assert_fails(&output, 2, "-o prints/");
    assert_eq!(names(&folder), ["ball.stl"]);
    let prints = folder.path().join("new/prints/").display().to_string();
    assert!(quick(&["slice", &ball, "-o", &prints]).status.success());
    assert_eq!(files_in(&prints), ["ball.zip"]);
}

#[test]
fn plan_and_info_take_several_models() {
    let folder = TempDir::new().unwrap();
    let (ball, slab) = (sphere(&folder), slab(&folder));
    let poem = model(&folder, "poem.stl", b"a cube, o cube");
    for command in ["plan", "info"] {
        let options: &[&str] = if command == "plan" { &QUICK } else { &[] };
        let run = |arguments: &[&str]| cusp(&[&[command], arguments, options].concat());
        let output = run(&[&slab, &ball, &poem, "--json"]);
        assert_eq!(output.status.code(), Some(1));
        let lines = lines(&output);
        assert_eq!(lines.len(), 3);
        assert!(lines[1]["error"]["code"].is_string());
        for (line, model) in [(&lines[0], &ball), (&lines[2], &slab)] {
            let mut alone = json(&run(&[model, "--json"]));
            let mut report = of_only_plate(line["report"].clone());
            for report in [&mut alone, &mut report] {
                report["timings_ms"].take();
            }
            assert_eq!(report, alone);
            assert_eq!(line.get("output"), None);
        }
        let told = String::from_utf8(run(&[&slab, &ball]).stdout).unwrap();
        assert_eq!(told.lines().count(), 2, "{told}");
    }
}

#[test]
fn warnings_name_their_model() {
    let folder = TempDir::new().unwrap();
    let mut open = solids::cube(3.0);
    open.pop();
    let open = model(&folder, "open.stl", &binary_stl(&open));
    let output = quick(&["plan", &open, &sphere(&folder)]);
    assert!(output.status.success());
    let told = String::from_utf8(output.stderr).unwrap();
    let mut told = told.lines();
    assert!(told.all(|line| line.starts_with(&format!("cusp: warning: {open}: "))));
}
