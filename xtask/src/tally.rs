//! Results of test runners, and the summary of all steps.

use std::{path::Path, process::ExitStatus, time::Duration};

use anyhow::{Context, Result, ensure};
use serde_json::Value;

/// Results of a test runner.
#[derive(Debug, Default, PartialEq)]
pub struct Tally {
    /// Tests that passed.
    pub passed: usize,
    /// Tests that failed, by name.
    pub failed: Vec<String>,
    /// Tests that did not run, by name and reason: their requirements are absent.
    pub ignored: Vec<String>,
}

/// One step's result.
pub struct Record {
    /// The step's name.
    pub step: String,
    /// Its tests, or the reason for its failure as a whole.
    pub result: Result<Tally>,
    /// Its duration.
    pub elapsed: Duration,
}

impl Tally {
    /// Reads the output of `cargo test` (libtest, or a harness that writes like it) and of wasm-bindgen's test runner.
    pub fn of_libtest(status: ExitStatus, text: &str) -> Result<Self> {
        let mut tally = Self::default();
        for line in text.lines() {
            if let Some(counts) = line.trim().strip_prefix("test result: ") {
                let words: Vec<&str> = counts.split_whitespace().collect();
                let passed = words.iter().position(|word| word.starts_with("passed"));
                let count = passed.and_then(|place| words.get(place.checked_sub(1)?)?.parse().ok());
                tally.passed += count.unwrap_or(0);
            } else if let Some((name, outcome)) = line
                .strip_prefix("test ")
                .and_then(|test| test.split_once(" ... "))
            {
                let name = name.trim();
                if let Some(why) = outcome.strip_prefix("ignored") {
                    tally.ignored.push(format!("{name}{why}"));
                } else if outcome.starts_with("FAIL") {
                    tally.failed.push(name.to_owned());
                }
            }
        }
        tally.judged(status)
    }

    /// Reads the output of vitest's JSON reporter.
    pub fn of_vitest(status: ExitStatus, json: &str) -> Result<Self> {
        let report: Value = serde_json::from_str(json).context("no report of vitest")?;
        let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
        let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        let mut tally = Self::default();
        for file in list(&report["testResults"]) {
            let path = text(&file["name"]);
            let path = Path::new(&path).file_name().unwrap_or_default().display();
            for test in list(&file["assertionResults"]) {
                let name = format!("{path}: {}", text(&test["fullName"]));
                match test["status"].as_str() {
                    Some("passed") => tally.passed += 1,
                    Some("failed") => tally.failed.push(name),
                    // Vitest records no reason itself; a test may leave one here.
                    _ => tally
                        .ignored
                        .push(format!("{name}, {}", text(&test["meta"]["reason"]))),
                }
            }
            // A file that does not load has no failed test.
            if file["status"] == "failed" && list(&file["assertionResults"]).is_empty() {
                tally.failed.push(path.to_string());
            }
        }
        tally.judged(status)
    }

    /// Reads the verbose output of Python's unittest.
    pub fn of_unittest(status: ExitStatus, text: &str) -> Result<Self> {
        let mut tally = Self::default();
        for line in text.lines() {
            let Some((name, outcome)) = line.rsplit_once(" ... ") else {
                continue;
            };
            match outcome {
                "ok" => tally.passed += 1,
                "FAIL" | "ERROR" => tally.failed.push(name.to_owned()),
                why => tally.ignored.push(format!("{name}, {why}")),
            }
        }
        tally.judged(status)
    }

    fn judged(self, status: ExitStatus) -> Result<Self> {
        ensure!(
            status.success() || !self.failed.is_empty(),
            "the test runner failed ({status})"
        );
        ensure!(
            !status.success() || self.passed + self.ignored.len() > 0,
            "no test was run"
        );
        Ok(self)
    }
}

impl Record {
    /// A step that fails as a whole counts as one test.
    fn failed(&self) -> usize {
        self.result.as_ref().map_or(1, |tally| tally.failed.len())
    }
}

/// Prints a table of the steps, the tests that did not run or failed, and one line of totals. Returns true if nothing failed.
pub fn summarise(records: &[Record]) -> bool {
    println!(
        "\n{:<10}{:>8}{:>8}{:>9}{:>9}",
        "step", "passed", "failed", "skipped", "minutes"
    );
    let none = Tally::default();
    let (mut passed, mut failed, mut skipped) = (0, 0, 0);
    for record in records {
        let tally = record.result.as_ref().unwrap_or(&none);
        passed += tally.passed;
        failed += record.failed();
        skipped += tally.ignored.len();
        println!(
            "{:<10}{:>8}{:>8}{:>9}{:>9.1}",
            record.step,
            tally.passed,
            record.failed(),
            tally.ignored.len(),
            record.elapsed.as_secs_f64() / 60.0,
        );
    }
    for Record { step, result, .. } in records {
        match result {
            Ok(tally) => {
                tally
                    .ignored
                    .iter()
                    .for_each(|test| println!("ignored: {step}: {test}"));
                tally
                    .failed
                    .iter()
                    .for_each(|test| println!("failed: {step}: {test}"));
            }
            Err(error) => println!("failed: {step}: {error:#}"),
        }
    }
    println!("{passed} passed, {failed} failed, {skipped} skipped");
    failed == 0
}

#[cfg(test)]
mod tests {
    use std::process::Command;

    use super::*;

    /// The status of a program that succeeds or fails.
    fn status(is_good: bool) -> ExitStatus {
        let name = if is_good { "true" } else { "false" };
        Command::new(name).status().unwrap()
    }

    #[test]
    fn tests_that_fail_or_do_not_run_are_named() {
        let text = "test a ... ok\ntest gpu::b ... ignored, no adapter\ntest c ... FAILED\n\
                    test result: FAILED. 1 passed; 1 failed; 1 ignored; 0 measured; 0 filtered out\n";
        let expected = Tally {
            passed: 1,
            failed: vec!["c".into()],
            ignored: vec!["gpu::b, no adapter".into()],
        };
        assert_eq!(Tally::of_libtest(status(false), text).unwrap(), expected);
        let json = r#"{"testResults":[{"name":"/x/a.test.ts","status":"failed","assertionResults":[
            {"fullName":"b","status":"failed"},{"fullName":"c","status":"passed"},
            {"fullName":"d","status":"pending","meta":{"reason":"no lighttpd"}}]},
            {"name":"/x/broken.test.ts","status":"failed","assertionResults":[]}]}"#;
        let tally = Tally::of_vitest(status(false), json).unwrap();
        assert_eq!(tally.failed, ["a.test.ts: b", "broken.test.ts"]);
        assert_eq!(tally.ignored, ["a.test.ts: d, no lighttpd"]);
        let text =
            "test_a (x.A) ... ok\ntest_b (x.A) ... skipped 'no dask'\nRan 2 tests in 1s\n\nOK";
        let tally = Tally::of_unittest(status(true), text).unwrap();
        assert_eq!((tally.passed, tally.ignored.len()), (1, 1));
    }

    #[test]
    fn a_runner_that_fails_without_a_word_or_runs_nothing_fails() {
        assert!(Tally::of_libtest(status(false), "error: could not compile").is_err());
        assert!(Tally::of_libtest(status(true), "").is_err());
    }
}
