//! `info` and `printers`.

use tempfile::TempDir;

use super::{cusp, json, model};
use crate::common::{assert_near, binary_stl, solids};

#[test]
fn info_describes_the_model() {
    let folder = TempDir::new().unwrap();
    let model = model(&folder, "box.stl", &binary_stl(&solids::cube(20.0)));
    let info = json(&cusp(&["info", &model, "--json"]));
    assert_eq!(
        (&info["facets"], &info["vertices"]),
        (&12.into(), &8.into())
    );
    assert_eq!(
        (&info["closed"], &info["degenerate_facets"]),
        (&true.into(), &0.into())
    );
    assert_near(info["volume_mm3"].as_f64().unwrap(), 8000.0, 1e-6);
    let text = String::from_utf8(cusp(&["info", &model]).stdout).unwrap();
    assert!(text.contains("20.000 × 20.000 × 20.000 mm"), "{text}");
}

#[test]
fn a_model_without_a_unit_and_of_an_odd_size_is_asked_about() {
    let folder = TempDir::new().unwrap();
    let cube = "v 0 0 0\nv 0.5 0 0\nv 0.5 0.5 0\nv 0 0.5 0\nv 0 0 0.5\nv 0.5 0 0.5\nv 0.5 0.5 0.5\nv 0 0.5 0.5\n\
        f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    let model = model(&folder, "cube.obj", cube.as_bytes());
    let text = String::from_utf8(cusp(&["info", &model]).stdout).unwrap();
    assert!(text.contains("in inches it would be 12.7 mm"), "{text}");
    for unit in ["inch", "in"] {
        let plan = json(&cusp(&["plan", &model, "--unit", unit, "--json"]));
        assert_near(plan["height_mm"].as_f64().unwrap(), 12.7, 1e-6);
        assert_eq!(plan["options"]["unit"], "inch");
        assert_eq!(plan["warnings"], serde_json::json!([]));
    }
}

#[test]
fn printers_say_which_files_they_read() {
    let text = String::from_utf8(cusp(&["printers"]).stdout).unwrap();
    let line = |name: &str| text.lines().find(|line| line.starts_with(name)).unwrap();
    assert!(line("name ").ends_with("variable  reads"));
    assert!(line("sl1s ").ends_with("sl1              no        sl1s"));
    assert!(line("saturn-3-ultra ").ends_with("goo              untried   goo"));
    assert!(line("mars-3 ").ends_with("chitubox         untried   ctb by a converter"));
    let json = json(&cusp(&["printers", "--json"]));
    let printers = json.as_array().unwrap();
    let saturn = printers.iter().find(|it| it["name"] == "saturn-3-ultra");
    assert_eq!(saturn.unwrap()["reads"], serde_json::json!(["goo"]));
}
