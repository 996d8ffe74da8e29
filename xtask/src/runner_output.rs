//! Reads counts from the output of test runners.

use std::path::Path;

use anyhow::{Context, Result};
use serde_json::Value;

/// Counts of individual tests.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Tests that ran and passed.
    pub passed: usize,
    /// Tests that ran and failed.
    pub failed: usize,
    /// Suites and names of those that failed, as far as the runner tells them.
    pub failures: Vec<String>,
    /// Tests that did not run.
    pub ignored: Vec<Ignored>,
}

/// A test that did not run.
#[derive(Debug, PartialEq, Eq)]
pub struct Ignored {
    /// Suite and name.
    pub name: String,
    /// The reason that the runner gives; may be empty.
    pub reason: String,
}

impl Tally {
    fn ignore(&mut self, name: impl Into<String>, reason: impl Into<String>) {
        self.ignored.push(Ignored {
            name: name.into(),
            reason: reason.into(),
        });
    }
}

/// Reads the output of `cargo test` (libtest, or a harness that writes like it)
/// and of wasm-bindgen's test runner: any number of suites.
///
/// # Errors
///
/// Fails if a summary line has no counts. No summary line at all is an empty
/// tally, which callers treat as a failure.
pub fn libtest(text: &str) -> Result<Tally> {
    let mut tally = Tally::default();
    let mut suite = String::new();
    let mut named = 0;
    for line in text.lines() {
        let line = without_colour(line);
        let line = line.trim();
        if let Some(rest) = line.strip_prefix("test result: ") {
            let count = |what| {
                count_before(rest, what)
                    .with_context(|| format!("no count of {what} in \"{line}\""))
            };
            tally.passed += count("passed")?;
            tally.failed += count("failed")?;
            let nameless = count("ignored")?.saturating_sub(named);
            if nameless > 0 {
                tally.ignore(format!("{suite}: {nameless} more"), "");
            }
            named = 0;
        } else if let Some(rest) = line.strip_prefix("test ") {
            if let Some((name, outcome)) = rest.split_once(" ... ") {
                let name = format!("{suite}: {}", name.trim_end());
                if let Some(reason) = outcome.strip_prefix("ignored") {
                    tally.ignore(name, bare(reason));
                    named += 1;
                } else if outcome.starts_with("FAIL") {
                    tally.failures.push(name);
                }
            }
        } else if let Some(name) = suite_name(line) {
            name.clone_into(&mut suite);
        }
    }
    Ok(tally)
}

/// Reads the output of vitest's JSON reporter.
///
/// # Errors
///
/// Fails if this is not such a report.
pub fn vitest(json: &str) -> Result<Tally> {
    let report: Value = serde_json::from_str(json).context("not the report of vitest")?;
    let count = |key: &str| {
        report[key]
            .as_u64()
            .with_context(|| format!("no {key} in the report of vitest"))
    };
    let mut tally = Tally {
        passed: count("numPassedTests")? as usize,
        failed: count("numFailedTests")? as usize,
        ..Tally::default()
    };
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    for file in list(&report["testResults"]) {
        let tests = list(&file["assertionResults"]);
        let path = Path::new(text(&file["name"]));
        let suite = path.file_name().unwrap_or_default().to_string_lossy();
        // A file that fails outside its tests (it does not load, for example)
        // has no failed test.
        let status = |test: &Value, wanted: &str| test["status"] == wanted;
        if status(&file, "failed") && !tests.iter().any(|test| status(test, "failed")) {
            tally.failed += 1;
            tally.failures.push(suite.to_string());
        }
        for test in tests {
            let name = format!("{suite}: {}", text(&test["fullName"]));
            if status(&test, "failed") {
                tally.failures.push(name);
            } else if ["pending", "skipped", "todo", "disabled"]
                .iter()
                .any(|&word| status(&test, word))
            {
                // Vitest records no reason itself; a test may leave one here.
                tally.ignore(name, text(&test["meta"]["reason"]));
            }
        }
    }
    Ok(tally)
}

/// Reads the verbose output of Python's unittest.
///
/// # Errors
///
/// Fails if there is no count of tests: it did not complete.
pub fn unittest(text: &str) -> Result<Tally> {
    let ran = text
        .lines()
        .rev()
        .find_map(|line| line.strip_prefix("Ran ")?.split(' ').next()?.parse().ok());
    let ran: usize = ran.context("unittest left no count")?;
    // `OK`, `OK (skipped=1)` or `FAILED (failures=2, errors=1)`.
    let counts = text
        .lines()
        .rev()
        .find_map(|line| line.strip_prefix("OK").or(line.strip_prefix("FAILED")))
        .context("unittest left no result")?;
    let count = |what: &str| {
        let counts = counts.trim_matches([' ', '(', ')']).split(", ");
        let mut found = counts.filter_map(|count| count.strip_prefix(what)?.parse().ok());
        found.next().unwrap_or(0)
    };
    let skipped: usize = count("skipped=");
    let failed = count("failures=") + count("errors=") + count("unexpected successes=");
    let mut tally = Tally {
        // Subtests of one test may fail several times.
        passed: ran.saturating_sub(failed + skipped),
        failed,
        ..Tally::default()
    };
    for line in text.lines() {
        if let Some((name, reason)) = line.split_once(" ... skipped ") {
            let name = name.split(' ').next().unwrap_or_default();
            tally.ignore(name, reason.trim_matches(['\'', '"']));
        } else if let Some(test) = line.strip_prefix("FAIL: ").or(line.strip_prefix("ERROR: ")) {
            tally.failures.push(test.to_owned());
        }
    }
    let nameless = skipped.saturating_sub(tally.ignored.len());
    if nameless > 0 {
        tally.ignore(format!("{nameless} more"), "");
    }
    Ok(tally)
}

/// Cargo's announcement of what it runs next: `Running tests/web.rs (target/…)`
/// or `Doc-tests cusp_slicer`.
fn suite_name(line: &str) -> Option<&str> {
    if line.starts_with("Doc-tests ") {
        return Some(line);
    }
    let (name, _) = line.strip_prefix("Running ")?.split_once(" (")?;
    Some(name.strip_prefix("unittests ").unwrap_or(name))
}

/// The reason in `, reason` (libtest) or ` (reason)` (libtest-mimic).
fn bare(reason: &str) -> &str {
    let reason = reason.trim_start_matches(',').trim();
    reason
        .strip_prefix('(')
        .and_then(|inner| inner.strip_suffix(')'))
        .unwrap_or(reason)
}

/// `5` for `passed` in `ok. 5 passed; 0 failed`.
fn count_before(text: &str, what: &str) -> Option<usize> {
    text.split([';', '.'])
        .find_map(|part| part.trim().strip_suffix(what)?.trim_end().parse().ok())
}

/// Removes the escape sequences that set colours.
fn without_colour(line: &str) -> String {
    let mut plain = String::with_capacity(line.len());
    let mut rest = line;
    while let Some((before, after)) = rest.split_once("\x1b[") {
        plain.push_str(before);
        rest = after
            .find(|c: char| c.is_ascii_alphabetic())
            .map_or("", |end| &after[end + 1..]);
    }
    plain.push_str(rest);
    plain
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ignored(names_and_reasons: &[(&str, &str)]) -> Vec<Ignored> {
        names_and_reasons
            .iter()
            .map(|&(name, reason)| Ignored {
                name: name.into(),
                reason: reason.into(),
            })
            .collect()
    }

    #[test]
    fn cargo_test_with_several_suites() {
        let text = "\
   Compiling cusp-slicer v0.1.0
     Running unittests src/lib.rs (target/debug/deps/cusp_slicer-1)

running 3 tests
test mesh::volume_of_a_cube ... ok
test plan::huge ... ignored
test plan::slow ... ignored, takes an hour

test result: ok. 1 passed; 0 failed; 2 ignored; 0 measured; 0 filtered out; finished in 0.00s

     Running tests/gpu.rs (target/debug/deps/gpu-2)

running 2 tests
test twins ... FAILED
test limits ... ok

failures:

---- twins stdout ----
test result: this is a test's own output? no: it is printed in a failure

test result: FAILED. 1 passed; 1 failed; 0 ignored; 0 measured; 0 filtered out; finished in 1.25s

error: test failed, to rerun pass `--test gpu`
   Doc-tests cusp_slicer

running 2 tests
test src/lib.rs - (line 12) ... ok
test src/grid.rs - grid::Grid (line 3) ... ignored

test result: ok. 1 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.10s
";
        // The planted line looks like a summary and has no counts: better an
        // error than a wrong count.
        assert!(libtest(text).is_err());
        let text = text.replace("test result: this", "test results: this");
        assert_eq!(
            libtest(&text).unwrap(),
            Tally {
                passed: 3,
                failed: 1,
                failures: vec!["tests/gpu.rs: twins".into()],
                ignored: ignored(&[
                    ("src/lib.rs: plan::huge", ""),
                    ("src/lib.rs: plan::slow", "takes an hour"),
                    (
                        "Doc-tests cusp_slicer: src/grid.rs - grid::Grid (line 3)",
                        ""
                    ),
                ]),
            }
        );
    }

    #[test]
    fn colours_do_not_hide_a_test() {
        let text = "\x1b[1m\x1b[32m     Running\x1b[0m tests/gpu.rs (deps/gpu-2)
test twins ... \x1b[33mignored, no adapter\x1b[0m
test result: \x1b[32mok\x1b[0m. 4 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out
";
        let tally = libtest(text).unwrap();
        assert_eq!((tally.passed, tally.failed), (4, 0));
        assert_eq!(
            tally.ignored,
            ignored(&[("tests/gpu.rs: twins", "no adapter")])
        );
    }

    #[test]
    fn libtest_mimic_pads_names_and_brackets_reasons() {
        let text = "\
     Running tests/gpu.rs (target/debug/deps/gpu-2)
test cube         ... ok
test tall cone    ... ignored
test overlapping  ... ignored (no adapter)

test result: ok. 1 passed; 0 failed; 2 ignored; 0 measured; 0 filtered out; finished in 2.43s
";
        let tally = libtest(text).unwrap();
        assert_eq!(
            tally.ignored,
            ignored(&[
                ("tests/gpu.rs: tall cone", ""),
                ("tests/gpu.rs: overlapping", "no adapter"),
            ])
        );
    }

    #[test]
    fn wasm_bindgen_test_in_a_browser() {
        let text = "\
     Running tests/web.rs (target/wasm32-unknown-unknown/release/deps/web-3.wasm)
Running headless tests in Chrome on `http://127.0.0.1:40001/`
Try find `webdriver.json` for configure browser's capabilities:
Ok
running 3 tests
test cube ... ok
test sphere ... FAIL
test torus ... ignored, software adapter

test result: FAILED. 1 passed; 1 failed; 1 ignored; 0 filtered out; finished in 0.50s
";
        let tally = libtest(text).unwrap();
        assert_eq!((tally.passed, tally.failed), (1, 1));
        assert_eq!(tally.failures, ["tests/web.rs: sphere"]);
        assert_eq!(
            tally.ignored,
            ignored(&[("tests/web.rs: torus", "software adapter")])
        );
    }

    #[test]
    fn nameless_ignored_tests_are_still_counted() {
        let text = "     Running tests/gpu.rs (deps/gpu-2)\ntest result: ok. 0 passed; 0 failed; 2 ignored\n";
        assert_eq!(
            libtest(text).unwrap().ignored,
            ignored(&[("tests/gpu.rs: 2 more", "")])
        );
    }

    #[test]
    fn nothing_run_is_an_empty_tally() {
        assert_eq!(libtest("").unwrap(), Tally::default());
        assert_eq!(
            libtest("error: could not compile\n").unwrap(),
            Tally::default()
        );
        assert_eq!(libtest("no tests to run!\n").unwrap(), Tally::default());
    }

    #[test]
    fn unittest_with_all_outcomes() {
        let text = "\
test_batch (test_orient.Orient.test_batch) ... ok
test_killed (test_orient.Orient.test_killed) ... a word of a worker
ok
test_shell (test_orient.Orient.test_shell) ... skipped 'needs a shell'
test_merge (test_orient.Orient.test_merge) ... FAIL
test_error (test_orient.Orient.test_error) ... ERROR

======================================================================
FAIL: test_merge (test_orient.Orient.test_merge)
----------------------------------------------------------------------
AssertionError: 1 != 0

----------------------------------------------------------------------
Ran 5 tests in 12.344s

FAILED (failures=1, errors=1, skipped=1)
";
        assert_eq!(
            unittest(text).unwrap(),
            Tally {
                passed: 2,
                failed: 2,
                failures: vec!["test_merge (test_orient.Orient.test_merge)".into()],
                ignored: ignored(&[("test_shell", "needs a shell")]),
            }
        );
        let good =
            "test_batch (test_orient.Orient.test_batch) ... ok\n\nRan 1 test in 0.1s\n\nOK\n";
        assert_eq!(unittest(good).unwrap().passed, 1);
        let nameless = "Ran 3 tests in 0.1s\n\nOK (skipped=2)\n";
        assert_eq!(
            unittest(nameless).unwrap().ignored,
            ignored(&[("2 more", "")])
        );
        assert!(unittest("Traceback (most recent call last):\n").is_err());
        assert!(unittest("Ran 1 test in 0.1s\n").is_err());
    }

    #[test]
    fn vitest_counts_files_that_do_not_load() {
        let json = r#"{
            "numPassedTests": 2, "numFailedTests": 1, "numPendingTests": 1, "success": false,
            "testResults": [
                { "status": "failed", "name": "/some/where/a.test.ts", "assertionResults": [
                    { "status": "passed", "fullName": "a one" },
                    { "status": "passed", "fullName": "a two" },
                    { "status": "failed", "fullName": "a three" },
                    { "status": "skipped", "fullName": "a four", "meta": { "reason": "no GPU" } }
                ] },
                { "status": "failed", "name": "b.test.ts", "message": "cannot load", "assertionResults": [] }
            ]
        }"#;
        assert_eq!(
            vitest(json).unwrap(),
            Tally {
                passed: 2,
                failed: 2,
                failures: vec!["a.test.ts: a three".into(), "b.test.ts".into()],
                ignored: ignored(&[("a.test.ts: a four", "no GPU")]),
            }
        );
        assert!(vitest("").is_err());
        assert!(vitest("{}").is_err());
    }
}
