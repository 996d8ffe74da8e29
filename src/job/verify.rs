//! Checks that a submitted plan is the one that its model and options give. A shop needs this before it accepts a plan from
//! a customer's browser.

use serde::Deserialize;
use serde_json::Value;

use super::report::OF_THE_MACHINE;
use super::{Options, Report, SCHEMA};
use crate::model::ModelFile;
use crate::warning::Warning;

/// Why a plan is rejected.
#[derive(Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum VerifyError {
    /// The file is not the report of a plan.
    #[error("it is no plan as `cusp plan --json` prints it: {system}")]
    NotAPlan {
        /// What the parser said.
        system: String,
    },
    /// The report has another schema version, with other names or meanings.
    #[error("it has schema {found}, and this program knows {SCHEMA}; use the version that made it")]
    OtherSchema {
        /// Schema version of the report.
        found: u64,
    },
    /// The plan was made from another file.
    #[error("it was made from another model: one of {bytes} bytes with the CRC-32 {crc32:08x}")]
    OtherModel {
        /// Length of that model's file.
        bytes: usize,
        /// CRC-32 of that model's file.
        crc32: u32,
    },
    /// The plan was made with other weights of facets than were given here.
    #[error(
        "it was made with other weights of facets; give the file of weights that it was made with"
    )]
    OtherWeights,
    /// The model and the options give another plan.
    #[error(
        "it is not what the model and its options give: {key} is {}, but should be {}",
        in_short(claimed),
        in_short(found)
    )]
    Differs {
        /// Path of the first difference, such as `z_mm[3]`.
        key: String,
        /// The value in the plan.
        claimed: Value,
        /// The value that is correct.
        found: Value,
    },
    /// The plan matches, but its largest error exceeds the tolerance.
    #[error("its largest error is {max_error}, more than the tolerance of {tolerance}")]
    ToleranceExceeded {
        /// The largest error, in the metric's unit.
        max_error: f64,
        /// The tolerance.
        tolerance: f64,
    },
}

/// A submitted plan.
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
    /// Reads the JSON of a report, or the manifest of a print file, and checks that it is for this model.
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

    /// The options that the plan claims to have been made with.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// Compares the plan with `made`, which was planned again with [`Self::options`]. Then checks that the tolerance holds
    /// on the mesh.
    ///
    /// # Errors
    /// [`VerifyError::OtherWeights`], [`VerifyError::Differs`], [`VerifyError::ToleranceExceeded`].
    pub fn check(&self, made: &Report) -> Result<(), VerifyError> {
        if self.report["weights_crc32"].as_u64() != made.weights_crc32.map(u64::from) {
            return Err(VerifyError::OtherWeights);
        }
        // A round trip through text, like that of the claim, so that both have their numbers parsed alike.
        let text = serde_json::to_string(made);
        let value = text.and_then(|text| serde_json::from_str(&text));
        let expected: Value = value.map_err(|error| VerifyError::NotAPlan {
            system: error.to_string(),
        })?;
        for (key, expected) in expected.as_object().into_iter().flatten() {
            // Some warnings are about the machine; the others follow from the rest of the report.
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

/// Finds the first difference between two values. 5 and 5.0 are equal, and so are an absent value and null.
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
