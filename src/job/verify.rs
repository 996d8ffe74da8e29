//! Whether a plan that somebody sent is the one that its model and options give: what a shop asks before it accepts the
//! work of a customer's browser.

use serde::Deserialize;
use serde_json::Value;

use super::report::OF_THE_MACHINE;
use super::{Options, Report, SCHEMA};
use crate::model::ModelFile;
use crate::warning::Warning;

/// Why a plan is not accepted.
#[derive(Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum VerifyError {
    /// The file is no report of a plan.
    #[error("it is no plan as `cusp plan --json` prints it: {system}")]
    NotAPlan {
        /// What the parser said.
        system: String,
    },
    /// The report is of a version with other names or meanings.
    #[error("it has schema {found}, and this program knows {SCHEMA}; use the version that made it")]
    OtherSchema {
        /// Its version.
        found: u64,
    },
    /// The plan was made from another file.
    #[error("it was made from another model: one of {bytes} bytes with the CRC-32 {crc32:08x}")]
    OtherModel {
        /// Length of that model's file.
        bytes: usize,
        /// Its CRC-32.
        crc32: u32,
    },
    /// The plan was made with other weights of facets, or with some where none are given.
    #[error(
        "it was made with other weights of facets; give the file of weights that it was made with"
    )]
    OtherWeights,
    /// The model and the options give something else.
    #[error(
        "it is not what the model and its options give: {key} is {}, but should be {}",
        in_short(claimed),
        in_short(found)
    )]
    Differs {
        /// The first place that differs.
        key: String,
        /// What the plan says there.
        claimed: Value,
        /// What it should say.
        found: Value,
    },
    /// The plan is right, but its layers leave larger errors than the tolerance.
    #[error("its largest error is {max_error}, more than the tolerance of {tolerance}")]
    ToleranceExceeded {
        /// The largest error, in the metric's unit.
        max_error: f64,
        /// The tolerance.
        tolerance: f64,
    },
}

/// A plan as somebody sent it.
#[derive(Debug, Clone)]
pub struct Claim {
    report: Value,
    options: Options,
}

#[derive(Deserialize)]
struct Head {
    model: ModelFile,
    options: Options,
}

impl Claim {
    /// Reads the JSON of a report, or the manifest of a print file, and makes sure that it is about this model.
    ///
    /// # Errors
    /// [`VerifyError::NotAPlan`], [`VerifyError::OtherSchema`], [`VerifyError::OtherModel`].
    pub fn read(json: &str, model: &ModelFile) -> Result<Self, VerifyError> {
        let not_a_plan = |error: serde_json::Error| VerifyError::NotAPlan {
            system: error.to_string(),
        };
        let report: Value = serde_json::from_str(json).map_err(not_a_plan)?;
        let found = report["schema"].as_u64().unwrap_or(u64::from(SCHEMA));
        if found != u64::from(SCHEMA) {
            return Err(VerifyError::OtherSchema { found });
        }
        let Head {
            model: claimed,
            options,
        } = Head::deserialize(&report).map_err(not_a_plan)?;
        if claimed != *model {
            return Err(VerifyError::OtherModel {
                bytes: claimed.bytes,
                crc32: claimed.crc32,
            });
        }
        Ok(Self { report, options })
    }

    /// The options that the plan claims to be made with.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// Compares the plan with the one that was made anew with [`Self::options`]; then asks whether the tolerance
    /// holds on the mesh.
    ///
    /// # Errors
    /// [`VerifyError::OtherWeights`], [`VerifyError::Differs`], [`VerifyError::ToleranceExceeded`].
    pub fn check(&self, made: &Report) -> Result<(), VerifyError> {
        if self.report["weights_crc32"].as_u64() != made.weights_crc32.map(u64::from) {
            return Err(VerifyError::OtherWeights);
        }
        // Through text, as the claim went, so that both had their numbers read alike.
        let text = serde_json::to_string(made);
        let value = text.and_then(|text| serde_json::from_str(&text));
        let expected: Value = value.map_err(|error| VerifyError::NotAPlan {
            system: error.to_string(),
        })?;
        for (key, expected) in expected.as_object().into_iter().flatten() {
            // Of the warnings some are about the machine; all that count here follow from the rest of the report.
            if !OF_THE_MACHINE.contains(&key.as_str()) && key != "warnings" {
                compare(key, &self.report[key], expected)?;
            }
        }
        if made.warnings.iter().any(|warning| {
            matches!(
                warning,
                Warning::ToleranceExceeded { .. } | Warning::ToleranceExceededOnMesh { .. }
            )
        }) {
            return Err(VerifyError::ToleranceExceeded {
                max_error: made.max_error,
                tolerance: made.tolerance,
            });
        }
        Ok(())
    }
}

/// Finds the first place where two values differ. 5 and 5.0 are the same number, and what is absent is null.
fn compare(key: &str, claimed: &Value, expected: &Value) -> Result<(), VerifyError> {
    match (claimed, expected) {
        (Value::Object(claimed), Value::Object(expected)) => {
            let keys = claimed.keys().chain(expected.keys());
            for inner in keys {
                let [claimed, expected] = [claimed, expected].map(|it| it.get(inner));
                let null = &Value::Null;
                compare(
                    &format!("{key}.{inner}"),
                    claimed.unwrap_or(null),
                    expected.unwrap_or(null),
                )?;
            }
            Ok(())
        }
        (Value::Array(claimed), Value::Array(expected)) if claimed.len() == expected.len() => {
            for (index, (claimed, expected)) in claimed.iter().zip(expected).enumerate() {
                compare(&format!("{key}[{index}]"), claimed, expected)?;
            }
            Ok(())
        }
        (Value::Number(claimed), Value::Number(expected))
            if claimed.as_f64() == expected.as_f64() =>
        {
            Ok(())
        }
        _ if claimed == expected => Ok(()),
        _ => Err(VerifyError::Differs {
            key: key.to_owned(),
            claimed: claimed.clone(),
            found: expected.clone(),
        }),
    }
}

fn in_short(value: &Value) -> String {
    match value {
        Value::Array(items) => format!("a list of {}", items.len()),
        Value::Object(_) => "an object".to_owned(),
        Value::Null => "absent".to_owned(),
        other => other.to_string(),
    }
}
