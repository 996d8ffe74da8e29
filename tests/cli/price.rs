//! `price`, and the verdict and the price of `verify`.

use serde_json::{Value, json};
use tempfile::TempDir;

use super::{assert_fails, cusp, json, model, on_cpu, sphere};
use crate::common::{binary_stl, solids};

/// A cent for a second, another for a microlitre, and a tenth off from three copies on.
const PRICES: &str = r#"{
    "currency": "EUR",
    "setup": 300,
    "machine_per_h": 3600,
    "resin_per_ml": 1000,
    "finishes": [{ "name": "sanded", "per_copy": 250 }],
    "quantity_breaks": [{ "copies": 3, "discount": 0.1 }]
}"#;

const PLATE: [&str; 4] = ["--pixels", "400x300", "--pitch", "0.1"];

fn amount(price: &Value, kind: &str) -> i64 {
    let lines = price["lines"].as_array().unwrap();
    let line = lines.iter().find(|line| line["kind"] == kind);
    line.map_or(0, |line| line["amount"].as_i64().unwrap())
}

#[test]
fn supports_in_the_plan_are_charged_once() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let estimating = PRICES.replace("\"setup\"", "\"supports\": 0.15, \"setup\"");
    let estimating = estimating.replace("\"per_copy\": 250", "\"per_ml\": 1000");
    let prices = model(&folder, "prices.json", estimating.as_bytes());
    let price = |more: &[&str]| {
        let command = ["price", &ball, "--prices", &prices, "--finish", "sanded"];
        json(&on_cpu(&[&command, &PLATE[..], more, &["--json"]].concat()))
    };
    let bare = price(&[]);
    let ml = |price: &Value, key: &str| price["items"][0][key].as_f64().unwrap();
    let rounded = |amount: f64| amount.round() as i64;
    let model_ml = ml(&bare, "resin_ml");
    assert_eq!(amount(&bare, "supports"), rounded(150.0 * model_ml));
    assert_eq!(amount(&bare, "finish"), rounded(1000.0 * model_ml));
    let held = price(&["--supports", "auto"]);
    let (resin_ml, support_ml) = (ml(&held, "resin_ml"), ml(&held, "support_ml"));
    assert!(support_ml > 0.0 && (resin_ml - support_ml - model_ml).abs() < 1e-3 * model_ml);
    assert_eq!(amount(&held, "resin"), rounded(1000.0 * resin_ml));
    assert_eq!(amount(&held, "supports"), 0);
    assert_eq!(
        amount(&held, "finish"),
        rounded(1000.0 * (resin_ml - support_ml))
    );
}

#[test]
fn copies_cost_what_their_plan_needs() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let prices = model(&folder, "prices.json", PRICES.as_bytes());
    let price = |more: &[&str]| {
        let command = ["price", &ball, "--prices", &prices, "--json"];
        json(&on_cpu(&[&command, &PLATE[..], more].concat()))
    };
    let report = json(&on_cpu(&[&["plan", &ball, "--json"], &PLATE[..]].concat()));
    let one = price(&[]);
    assert_eq!(one["print_time_s"], report["print_time_s"]);
    assert_eq!(one["resin_ml"], report["resin_ml"]);
    let time_s = report["print_time_s"].as_f64().unwrap();
    let resin_ml = report["resin_ml"].as_f64().unwrap();
    let rounded = |amount: f64| amount.round() as i64;
    assert_eq!(amount(&one, "machine"), rounded(time_s));
    assert_eq!(amount(&one, "resin"), rounded(resin_ml * 1e3));
    assert_eq!((amount(&one, "finish"), amount(&one, "discount")), (0, 0));

    // Five on a plate need hardly more time than one.
    let five = price(&["--copies", "5", "--finish", "sanded"]);
    assert_eq!((&five["copies"], &five["plates"]), (&json!(5), &json!(1)));
    assert_eq!(amount(&five, "machine"), rounded(time_s));
    assert_eq!(amount(&five, "resin"), rounded(resin_ml * 5e3));
    assert_eq!(amount(&five, "finish"), 1250);
    let discounted: i64 = ["machine", "resin", "finish"]
        .map(|kind| amount(&five, kind))
        .iter()
        .sum();
    assert_eq!(
        amount(&five, "discount"),
        -rounded(discounted as f64 / 10.0)
    );
    let total = five["total"].as_i64().unwrap();
    assert_eq!(total, 300 + discounted + amount(&five, "discount"));

    let command = ["price", &ball, "--prices", &prices, "--copies", "5"];
    let output = on_cpu(&[&command, &PLATE[..], &["--finish", "sanded"]].concat());
    let shown = String::from_utf8(output.stdout).unwrap();
    let (units, cents) = (total / 100, total % 100);
    let said = format!("{units}.{cents:02} EUR for 5 copies on 1 plate");
    assert!(shown.contains(&said), "{shown}");
    assert!(shown.starts_with("setup "), "{shown}");
    assert_eq!(shown.lines().count(), 6, "{shown}");
}

#[test]
fn prices_that_cannot_be_used_are_named() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    let refuses = |text: &str, more: &[&str], words: &str| {
        let prices = model(&folder, "prices.json", text.as_bytes());
        let command = ["price", &ball, "--prices", &prices];
        let output = on_cpu(&[&command, more].concat());
        assert_fails(&output, 1, "prices.json");
        assert_fails(&output, 1, words);
    };
    refuses("{}", &[], "missing field `currency`");
    refuses(
        r#"{ "currency": "euro" }"#,
        &[],
        "ISO 4217 code of three capitals",
    );
    refuses(
        r#"{ "currency": "EUR", "setup": "2" }"#,
        &[],
        "invalid type",
    );
    refuses(
        r#"{ "currency": "EUR", "per_ml": 2 }"#,
        &[],
        "unknown field",
    );
    refuses(
        r#"{ "currency": "EUR", "supports": 50 }"#,
        &[],
        "supports is 50, but must be from 0 to 10",
    );
    refuses(PRICES, &["--finish", "gilded"], "known are sanded");
    // More copies than anybody orders: arranging them would not end.
    let many = format!("{ball}:99999999999");
    let prices = model(&folder, "prices.json", PRICES.as_bytes());
    let output = on_cpu(&["price", &many, "--prices", &prices, "--printer", "mars-4"]);
    assert_fails(&output, 1, "99999999999 copies are too many for a job");
    // The price of one copy needs no printer; a plate of several has a size.
    let prices = model(&folder, "prices.json", PRICES.as_bytes());
    json(&on_cpu(&["price", &ball, "--prices", &prices, "--json"]));
    let several = ["price", &ball, "--prices", &prices, "--copies", "2"];
    assert_fails(&on_cpu(&several), 1, "the size of the plate is not known");
    let output = on_cpu(&["price", &ball, "--prices", "absent.json"]);
    assert_fails(&output, 1, "absent.json");
    assert_fails(&on_cpu(&["price", &ball]), 2, "--prices");
}

#[test]
fn a_verified_plan_has_the_verdict_and_the_price_that_the_shop_computes() {
    let folder = TempDir::new().unwrap();
    let mut hollow = solids::sphere(3.0, 4);
    hollow.extend(solids::inverted(&solids::sphere(2.5, 4)));
    let hollow = model(&folder, "hollow.stl", &binary_stl(&hollow));
    let prices = model(&folder, "prices.json", PRICES.as_bytes());
    let limits = model(&folder, "limits.json", b"{}");
    let lenient = br#"{ "severity": { "trap": "review" } }"#;
    let lenient = model(&folder, "lenient.json", lenient);
    let plan = folder.path().join("plan.json").display().to_string();
    let planned = on_cpu(&["plan", &hollow, "--pitch", "0.05", "--json"]);
    let report = json(&planned);

    // Additions of the sender are not read.
    let mut sent = report.clone();
    sent["price"] = json!({ "currency": "EUR", "total": 1, "lines": [] });
    sent["printability"] = json!({ "verdict": "ok", "findings": [] });
    sent["verdict"] = json!("ok");
    std::fs::write(&plan, sent.to_string()).unwrap();
    let verify = |more: &[&str]| cusp(&[&["verify", &plan, &hollow], more].concat());
    let plain = json(&verify(&["--json"]));
    assert_eq!(
        (&plain["price"], &plain["printability"]),
        (&Value::Null, &Value::Null)
    );

    let time_s = report["print_time_s"].as_f64().unwrap();
    let asked = ["--prices", &prices, "--limits", &lenient];
    let verified = json(&verify(&[&asked[..], &["--json"]].concat()));
    assert_eq!(amount(&verified["price"], "machine"), time_s.round() as i64);
    assert_eq!(verified["printability"]["verdict"], "review");
    assert_eq!(
        verified["printability"]["models"][0]["findings"][0]["code"],
        "trap"
    );
    let copies = ["--copies", "4", "--finish", "sanded", "--json"];
    let verified = json(&verify(&[&asked[..], &copies].concat()));
    // Each counts with its whole time.
    let machine = (time_s * 4.0).round() as i64;
    assert_eq!(amount(&verified["price"], "machine"), machine);
    assert_eq!(amount(&verified["price"], "finish"), 1000);
    let shown = String::from_utf8(verify(&asked).stdout).unwrap();
    let lines: Vec<&str> = shown.lines().collect();
    assert!(lines[0].starts_with("the plan is correct"), "{shown}");
    assert_eq!(lines[1], "verdict: review");
    assert!(
        lines[2].starts_with("price: ") && lines[2].ends_with(" EUR"),
        "{shown}"
    );

    // A rejection is reported, and the exit code says it too.
    let rejected = verify(&["--limits", &limits, "--json"]);
    assert_eq!(rejected.status.code(), Some(1));
    let rejected: Value = serde_json::from_slice(&rejected.stdout).unwrap();
    assert_eq!(rejected["plates"][0]["printability"]["verdict"], "reject");

    // A plan that claims less time is refused before it has a price.
    sent["print_time_s"] = json!(1.0);
    std::fs::write(&plan, sent.to_string()).unwrap();
    assert_fails(&verify(&asked), 1, "print_time_s is 1.0");
    assert_fails(&verify(&["--copies", "4"]), 2, "--prices");
}

#[test]
fn verified_plates_have_a_verdict_a_model_and_a_price_in_all() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    sphere(&folder);
    let mut hollow = solids::sphere(3.0, 4);
    hollow.extend(solids::inverted(&solids::sphere(2.5, 4)));
    model(&folder, "hollow.stl", &binary_stl(&hollow));
    let prices = model(&folder, "prices.json", PRICES.as_bytes());
    let limits = model(&folder, "limits.json", b"{}");
    let (job, plan) = (path("job.json"), path("plan.json"));
    let written = r#"{
        "models": [{ "file": "ball.stl", "copies": 4 }, { "file": "hollow.stl" }],
        "options": { "pixels": [400, 300], "pitch_mm": 0.1, "backend": "cpu" }
    }"#;
    std::fs::write(&job, written).unwrap();
    let planned = cusp(&["plan", &job, "--json"]);
    std::fs::write(&plan, &planned.stdout).unwrap();
    let verified = json(&cusp(&[
        "verify", &plan, &job, "--prices", &prices, "--json",
    ]));
    let price = &verified["price"];
    assert_eq!(price["copies"], 5);
    let time_s = json(&planned)["print_time_s"].as_f64().unwrap();
    assert!((amount(price, "machine") as f64 - time_s).abs() <= 0.6);
    let same = json(&cusp(&["price", &job, "--prices", &prices, "--json"]));
    assert_eq!(
        (&same["total"], &same["lines"]),
        (&price["total"], &price["lines"])
    );

    let output = cusp(&["verify", &plan, &job, "--limits", &limits, "--json"]);
    assert_eq!(output.status.code(), Some(1));
    let verified: Value = serde_json::from_slice(&output.stdout).unwrap();
    let found = &verified["plates"][0]["printability"]["models"];
    let verdicts = [0, 1].map(|model| (&found[model]["model"], &found[model]["verdict"]));
    assert_eq!(verdicts[1], (&json!(1), &json!("reject")));
    assert_eq!(verdicts[0].0, 0);
    assert_ne!(verdicts[0].1, "reject");
    // Findings are those of the model alone in the same layers.
    assert_eq!(found[1]["counts"][0]["code"], "trap");
    let twice = [
        "verify", &plan, &job, "--prices", &prices, "--copies", "2", "--json",
    ];
    assert_eq!(json(&cusp(&twice))["price"]["copies"], 10);
}
