//! Checks that a submitted plan is the one that its model and options give. A shop needs this before it accepts a plan from
//! a customer's browser.

use serde::{Deserialize, Serialize, Serializer};
use serde_json::Value;

use super::report::OF_THE_MACHINE;
use super::stages::stage::StageProgress;
use super::{Error, Job, JobOptions, ModelOptions, Options, Placement, Report, SCHEMA};
use crate::arrange::Arranging;
use crate::model::ModelFile;
use crate::model::read::ReadOptions;
use crate::warning::Warning;

/// Reason for which a plan is rejected.
#[derive(Debug, PartialEq, thiserror::Error, Serialize)]
#[serde(tag = "code", content = "detail", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum VerifyError {
    /// The file is not the report of a plan.
    #[error("it is not a plan in the format of `cusp plan --json`: {system}")]
    NotAPlan {
        /// The parser's message.
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
    /// A plate has a model that the job does not have.
    #[error(
        "it has a model {model_number}, and {models} {} given; give all models in their order, or the job file",
        if *models == 1 { "is" } else { "are" }
    )]
    NoModel {
        /// The model, counted from 1.
        model_number: usize,
        /// Number of models of the job.
        models: usize,
    },
    /// The plan was made with other weights of facets than were given here.
    #[error(
        "it was made with other weights of facets; give the file of weights that it was made with"
    )]
    OtherWeights,
    /// The plan has lists of wrong lengths, or heights that do not ascend, so no model and options give it.
    #[error("it is inconsistent: {key} does not match the rest")]
    Contradicts {
        /// Path of the contradicting value, such as `z_mm[3]`.
        key: String,
    },
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
        #[serde(serialize_with = "in_few_words")]
        claimed: Value,
        /// The value that is correct.
        #[serde(serialize_with = "in_few_words")]
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
    /// The plan gives another print file.
    #[error("it is not the print file that this plan gives")]
    OtherPrint,
}

/// A submitted plan of a plate.
#[derive(Debug, Clone)]
pub struct Claim {
    report: Value,
    plate: ClaimedPlate,
}

#[derive(Deserialize)]
struct Whole {
    print_time_s: f64,
    resin_ml: f64,
    plates: Vec<Value>,
}

impl Claim {
    /// Reads the plans of all plates of a job, the plan of one, or the manifest of its print file, and checks that they are for these
    /// models.
    ///
    /// # Errors
    /// [`VerifyError::NotAPlan`], [`VerifyError::OtherSchema`], [`VerifyError::OtherModel`], [`VerifyError::NoModel`]; and
    /// [`VerifyError::Differs`] if the plates of a job are not numbered one after the other, or do not add up to its time and resin.
    pub fn read(json: &str, models: &[&ModelFile]) -> Result<Vec<Self>, VerifyError> {
        let report = read(json)?;
        if !report["plates"].is_array() {
            return Ok(vec![Self::of(report, models)?]);
        }
        let Whole {
            print_time_s,
            resin_ml,
            plates,
        } = Whole::deserialize(&report).map_err(not_a_plan)?;
        if plates.is_empty() {
            let system = "it has no plates".to_owned();
            return Err(VerifyError::NotAPlan { system });
        }
        let claims = plates.iter().cloned();
        let claims = claims.map(|plate| Self::of(plate, models));
        let claims = claims.collect::<Result<Vec<_>, _>>()?;
        let sum = |key: &str| plates.iter().filter_map(|plate| plate[key].as_f64()).sum();
        let sums: [f64; 2] = ["print_time_s", "resin_ml"].map(sum);
        compare("print_time_s", &print_time_s.into(), &sums[0].into())?;
        compare("resin_ml", &resin_ml.into(), &sums[1].into())?;
        let count = plates.len();
        for (number, plate) in plates.iter().enumerate() {
            for (key, expected) in [("plate", number), ("plate_count", count)] {
                let path = format!("plates[{number}].{key}");
                compare(&path, &plate[key], &expected.into())?;
            }
        }
        Ok(claims)
    }

    /// The choices with which the model of a plan was read; defaults if it does not state them. They are verified with
    /// the rest.
    pub fn read_options(json: &str) -> ReadOptions {
        let first = |report: &Value| match &report["plates"] {
            Value::Array(plates) => plates.first()?["models"].get(0).cloned(),
            _ => report["models"].get(0).cloned(),
        };
        let model = read(json).ok().and_then(|report| first(&report));
        let file = model.and_then(|model| ModelFile::deserialize(&model["file"]).ok());
        file.map_or_else(ReadOptions::default, |file| file.read_options())
    }

    fn of(report: Value, models: &[&ModelFile]) -> Result<Self, VerifyError> {
        let plate = ClaimedPlate::deserialize(&report).map_err(not_a_plan)?;
        if plate.plate >= plate.plate_count {
            let key = "plate".to_owned();
            return Err(VerifyError::Contradicts { key });
        }
        for (claimed, model) in plate.files() {
            match models.get(model) {
                None => {
                    return Err(VerifyError::NoModel {
                        // A submitted number may be any.
                        model_number: model.saturating_add(1),
                        models: models.len(),
                    });
                }
                Some(found) if claimed == *found => {}
                Some(_) => {
                    return Err(VerifyError::OtherModel {
                        bytes: claimed.bytes,
                        crc32: claimed.crc32,
                    });
                }
            }
        }
        check_itself(&report)?;
        Ok(Self { report, plate })
    }

    /// The options that the plan claims to have been made with.
    pub fn options(&self) -> &Options {
        &self.plate.options
    }

    /// Plans the plate again, on a job of these models. Its plan is then the only one.
    ///
    /// # Errors
    /// Those of [`Job::plan`].
    pub async fn plan_again<'a>(
        &self,
        models: &'a mut Job,
        progress: &mut StageProgress<'_>,
    ) -> Result<&'a Report, Error> {
        models.plan_claimed(&self.plate, progress).await
    }

    /// Compares the plan with `made`, which [`Self::plan_again`] returns. Then checks that the tolerance holds
    /// on the mesh.
    ///
    /// # Errors
    /// [`VerifyError::OtherWeights`], [`VerifyError::Differs`], [`VerifyError::ToleranceExceeded`].
    pub fn check(&self, made: &Report) -> Result<(), VerifyError> {
        for (place, model) in made.models.iter().enumerate() {
            let claimed = &self.report["models"][place]["weights_crc32"];
            if claimed.as_u64() != model.weights_crc32.map(u64::from) {
                return Err(VerifyError::OtherWeights);
            }
        }
        // A round trip through text, like that of the claim, so that both have their numbers parsed alike.
        let text = serde_json::to_string(made);
        let value = text.and_then(|text| serde_json::from_str(&text));
        let expected: Value = value.map_err(not_a_plan)?;
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

#[expect(clippy::needless_pass_by_value, reason = "errors are mapped by value")]
fn not_a_plan(error: serde_json::Error) -> VerifyError {
    VerifyError::NotAPlan {
        system: error.to_string(),
    }
}

/// The JSON of a report of this version.
fn read(json: &str) -> Result<Value, VerifyError> {
    let report: Value = serde_json::from_str(json).map_err(not_a_plan)?;
    let found = report["schema"].as_u64().unwrap_or(u64::from(SCHEMA));
    if found == u64::from(SCHEMA) {
        Ok(report)
    } else {
        Err(VerifyError::OtherSchema { found })
    }
}

/// Checks what needs no work, before any is done: lists have a value for each layer, and heights ascend from the plate by the
/// thicknesses.
fn check_itself(report: &Value) -> Result<(), VerifyError> {
    let contradicts = |key: &str| VerifyError::Contradicts {
        key: key.to_owned(),
    };
    let layers = report["layers"].as_u64();
    let layers = layers.ok_or_else(|| contradicts("layers"))? as usize;
    let list = |key: &str, length: usize| match &report[key] {
        Value::Array(items) if items.len() == length => Ok(items),
        _ => Err(contradicts(key)),
    };
    let heights_mm = list("z_mm", layers.saturating_add(1))?;
    let thicknesses_mm = list("thickness_mm", layers)?;
    list("exposure_s", layers)?;
    if !report["layer_files"].is_null() {
        list("layer_files", layers)?;
    }
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    if number(&heights_mm[0]) != 0.0 {
        return Err(contradicts("z_mm[0]"));
    }
    for (layer, (ends, thickness_mm)) in heights_mm.windows(2).zip(thicknesses_mm).enumerate() {
        let [bottom_mm, top_mm] = [&ends[0], &ends[1]].map(number);
        let apart_mm = (top_mm - bottom_mm - number(thickness_mm)).abs();
        // Heights are rounded to the picometre. NaN fails both comparisons.
        if !(top_mm > bottom_mm && apart_mm < 1e-6) {
            return Err(contradicts(&format!("z_mm[{}]", layer + 1)));
        }
    }
    Ok(())
}

/// Finds the first difference between two values. 5 and 5.0 are equal, and so are an absent value and null.
fn compare(key: &str, claimed: &Value, expected: &Value) -> Result<(), VerifyError> {
    match (claimed, expected) {
        (Value::Object(claimed), Value::Object(expected)) => {
            let keys = claimed.keys().chain(expected.keys());
            // Those of a plate's models are like those of a report.
            for inner in keys.filter(|inner| *inner != "warnings") {
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

/// A list may be as long as the plan has layers.
fn in_few_words<S: Serializer>(value: &Value, serializer: S) -> Result<S::Ok, S::Error> {
    match value {
        Value::Array(_) | Value::Object(_) => serializer.serialize_str(&in_short(value)),
        other => other.serialize(serializer),
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

/// A plate of a submitted plan: its options and placements, without the results that follow from them.
#[derive(Debug, Clone, PartialEq, Deserialize)]
struct ClaimedPlate {
    options: Options,
    plate: usize,
    plate_count: usize,
    models: Vec<ClaimedModel>,
    placements: Vec<Placement>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
struct ClaimedModel {
    model: usize,
    file: ModelFile,
    options: ModelOptions,
}

impl ClaimedPlate {
    /// The files of its models, and their indices in the job.
    fn files(&self) -> impl Iterator<Item = (&ModelFile, usize)> {
        self.models.iter().map(|model| (&model.file, model.model))
    }

    /// The job that has only this plate.
    fn job(&self) -> JobOptions {
        let count = self.models.iter().map(|model| model.model + 1).max();
        let absent = ModelOptions {
            copies: 0,
            ..ModelOptions::default()
        };
        let mut models = vec![absent; count.unwrap_or(0)];
        for model in &self.models {
            let placed = self.placements.iter();
            models[model.model] = ModelOptions {
                copies: placed.filter(|it| it.model == model.model).count(),
                ..model.options.clone()
            };
        }
        JobOptions {
            options: self.options.clone(),
            models,
            arranging: Arranging::default(),
            placements: self
                .placements
                .iter()
                .map(|place| Placement { plate: 0, ..*place })
                .collect(),
        }
    }
}

impl Job {
    /// Plans a submitted plate again, as the only one, and numbers it as it was.
    ///
    /// # Errors
    /// Those of [`Job::plan`].
    async fn plan_claimed(
        &mut self,
        claimed: &ClaimedPlate,
        progress: &mut StageProgress<'_>,
    ) -> Result<&Report, Error> {
        let job = claimed.job();
        // Alone on a plate of several, a model still has options of its own.
        let is_alone = claimed.plate_count == 1 && self.is_alone(&job);
        self.plan_as(&job, is_alone, progress).await?;
        let report = &mut self.plate_mut(0)?.report;
        (report.plate, report.plate_count) = (claimed.plate, claimed.plate_count);
        for place in &mut report.placements {
            place.plate = claimed.plate;
        }
        Ok(report)
    }
}
