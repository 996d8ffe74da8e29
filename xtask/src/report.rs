//! The results of the steps, and the summary.

use std::{fmt::Write, process::ExitStatus, time::Duration};

use anyhow::Result;

use crate::runner_output::Tally;

/// The result of a step as a whole.
#[derive(Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It ran and found no failure.
    Passed,
    /// It found a failure, or did not complete.
    Failed(String),
    /// This machine lacks a prerequisite.
    Skipped(String),
}

/// One step's result.
pub struct Record {
    /// The step's name.
    pub step: String,
    /// Its result.
    pub verdict: Verdict,
    /// The tests that it ran; all zero for a step that runs none.
    pub tally: Tally,
    /// How long it took.
    pub elapsed: Duration,
}

impl Record {
    /// A failed step without failed tests counts as one.
    fn failed(&self) -> usize {
        match self.verdict {
            Verdict::Failed(_) => self.tally.failed.max(1),
            Verdict::Passed | Verdict::Skipped(_) => self.tally.failed,
        }
    }

    fn skipped(&self) -> usize {
        self.tally.ignored.len() + usize::from(matches!(self.verdict, Verdict::Skipped(_)))
    }
}

/// Judges a test runner by its exit status and its output: it passed only if
/// both say so and at least one test ran.
pub fn judge(status: ExitStatus, tally: Result<Tally>) -> (Verdict, Tally) {
    let tally = match tally {
        Ok(tally) => tally,
        Err(error) => return (Verdict::Failed(format!("{error:#}")), Tally::default()),
    };
    let verdict = if !status.success() {
        Verdict::Failed(status.to_string())
    } else if tally.failed > 0 {
        Verdict::Failed("tests failed, though the runner reports success".into())
    } else if tally.passed == 0 {
        Verdict::Failed("no test was run".into())
    } else {
        Verdict::Passed
    };
    (verdict, tally)
}

/// Like [`judge`], for tests of what not every machine has: where all of them are
/// ignored, so is the step.
pub fn judge_optional(status: ExitStatus, tally: Result<Tally>) -> (Verdict, Tally) {
    match tally {
        Ok(tally)
            if status.success()
                && tally.passed + tally.failed == 0
                && !tally.ignored.is_empty() =>
        {
            (Verdict::Skipped("all tests were ignored".into()), tally)
        }
        tally => judge(status, tally),
    }
}

/// Whether nothing failed.
pub fn is_good(records: &[Record]) -> bool {
    records.iter().all(|record| record.failed() == 0)
}

/// A table of the steps, the tests that did not run, those that failed, and one line of totals.
pub fn summary(records: &[Record]) -> String {
    let mut text = String::new();
    let mut line = |words: std::fmt::Arguments<'_>| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{words}");
    };
    line(format_args!(
        "\n{:<8}{:<10}{:>8}{:>8}{:>9}{:>9}",
        "step", "result", "passed", "failed", "skipped", "time"
    ));
    for record in records {
        let (word, reason) = match &record.verdict {
            Verdict::Passed => ("ok", ""),
            Verdict::Failed(why) => ("FAILED", why.as_str()),
            Verdict::Skipped(_) => ("skipped", ""),
        };
        let reason = reason.lines().next().unwrap_or_default();
        line(format_args!(
            "{:<8}{word:<10}{:>8}{:>8}{:>9}{:>8.1}s{}{reason}",
            record.step,
            record.tally.passed,
            record.failed(),
            record.skipped(),
            record.elapsed.as_secs_f64(),
            if reason.is_empty() { "" } else { "  " },
        ));
    }
    for record in records {
        if let Verdict::Skipped(why) = &record.verdict {
            line(format_args!("ignored: {} (all of it) — {why}", record.step));
        }
        for test in &record.tally.ignored {
            let why = if test.reason.is_empty() {
                "no reason given"
            } else {
                &test.reason
            };
            line(format_args!(
                "ignored: {}: {} — {why}",
                record.step, test.name
            ));
        }
    }
    for record in records {
        for test in &record.tally.failures {
            line(format_args!("failed: {}: {test}", record.step));
        }
    }
    let sum = |count: fn(&Record) -> usize| records.iter().map(count).sum::<usize>();
    line(format_args!(
        "{} passed, {} failed, {} skipped",
        sum(|record| record.tally.passed),
        sum(Record::failed),
        sum(Record::skipped),
    ));
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runner_output::Ignored;

    fn record(step: &str, verdict: Verdict, tally: Tally) -> Record {
        Record {
            step: step.into(),
            verdict,
            tally,
            elapsed: Duration::from_millis(1_500),
        }
    }

    fn tally(passed: usize, failed: usize) -> Tally {
        Tally {
            passed,
            failed,
            ..Tally::default()
        }
    }

    #[test]
    fn a_step_without_tests_counts_once_when_it_fails() {
        let records = [
            record("native", Verdict::Passed, tally(7, 0)),
            record(
                "check",
                Verdict::Failed("exit status: 2".into()),
                tally(0, 0),
            ),
            record(
                "unit",
                Verdict::Failed("exit status: 1".into()),
                tally(3, 2),
            ),
        ];
        assert!(!is_good(&records));
        assert!(summary(&records).ends_with("\n10 passed, 3 failed, 0 skipped\n"));
    }

    #[test]
    fn what_did_not_run_is_named() {
        let mut native = tally(1, 0);
        native.ignored.push(Ignored {
            name: "tests/gpu.rs: twins".into(),
            reason: "no adapter".into(),
        });
        let records = [
            record("native", Verdict::Passed, native),
            record(
                "gpu",
                Verdict::Skipped("no driver".into()),
                Tally::default(),
            ),
        ];
        assert!(is_good(&records));
        let text = summary(&records);
        assert!(text.contains("\nignored: native: tests/gpu.rs: twins — no adapter\n"));
        assert!(text.contains("\nignored: gpu (all of it) — no driver\n"));
        assert!(text.ends_with("\n1 passed, 0 failed, 2 skipped\n"));
    }

    #[test]
    fn what_failed_is_named_last() {
        let mut e2e = tally(3, 1);
        e2e.failures.push("path.test.ts: drop".into());
        let records = [record("e2e", Verdict::Failed("exit status: 1".into()), e2e)];
        let text = summary(&records);
        assert!(
            text.ends_with("\nfailed: e2e: path.test.ts: drop\n3 passed, 1 failed, 0 skipped\n")
        );
    }

    #[test]
    #[cfg(unix)]
    fn a_runner_must_have_run_something() {
        use std::os::unix::process::ExitStatusExt;
        let (good, bad) = (ExitStatus::from_raw(0), ExitStatus::from_raw(256));
        let verdict = |status, tally| judge(status, tally).0;
        assert_eq!(verdict(good, Ok(tally(1, 0))), Verdict::Passed);
        assert!(matches!(verdict(good, Ok(tally(0, 0))), Verdict::Failed(_)));
        assert!(matches!(verdict(good, Ok(tally(1, 1))), Verdict::Failed(_)));
        assert!(matches!(verdict(bad, Ok(tally(1, 0))), Verdict::Failed(_)));
        assert!(matches!(
            verdict(good, Err(anyhow::anyhow!("odd"))),
            Verdict::Failed(_)
        ));
    }

    #[test]
    #[cfg(unix)]
    fn a_step_whose_tests_were_all_ignored_is_skipped() {
        use std::os::unix::process::ExitStatusExt;
        let (good, bad) = (ExitStatus::from_raw(0), ExitStatus::from_raw(256));
        let verdict = |status, passed, failed, ignored: &[&str]| {
            let mut tally = tally(passed, failed);
            tally.ignored.extend(ignored.iter().map(|&name| Ignored {
                name: name.into(),
                reason: "no Firefox".into(),
            }));
            judge_optional(status, Ok(tally)).0
        };
        let named = ["firefox.test.ts: Firefox"];
        assert!(matches!(verdict(good, 0, 0, &named), Verdict::Skipped(_)));
        assert_eq!(verdict(good, 1, 0, &named), Verdict::Passed);
        assert!(matches!(verdict(bad, 0, 0, &named), Verdict::Failed(_)));
        assert!(matches!(verdict(good, 0, 1, &named), Verdict::Failed(_)));
        assert!(matches!(verdict(good, 0, 0, &[]), Verdict::Failed(_)));
    }
}
