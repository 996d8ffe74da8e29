//! Errors and warnings are data: their details hold numbers and names, and their sentences contain all of these.

use serde::Serialize;
use serde_json::Value;

use super::{Error, Work};
use crate::archive::ArchiveError;
use crate::arrange::ArrangeError;
use crate::format::Format;
use crate::grid::GridError;
use crate::inspect::LimitsError;
use crate::job::OptionsError;
use crate::ldi::{GpuFault, LdiError};
use crate::model::read::PartKind;
use crate::model::read::ReadError;
use crate::model::read::kind::FileKind;
use crate::model::read::obj::ObjError;
use crate::model::read::stl::{StlError, StlExpected};
use crate::model::read::threemf::{ThreeMfError, ThreeMfFeature, XmlFault};
use crate::model::weights::WeightsError;
use crate::model::{MeshError, ModelUnit};
use crate::orientation::SearchError;
use crate::orientation::shard::{MergeError, Shard};
use crate::plan::PlanError;
use crate::plan::uniform::UniformLayers;
use crate::price::PriceError;
use crate::profile::Metric;
use crate::progress::Cancelled;
use crate::quantity::{Quantity, QuantityError, Unit};
use crate::warning::{UnitReading, Warning};

/// Makes one value of each variant that does not hold another error. A missing variant does not compile.
macro_rules! one_of_each {
    ($type:ident except [$($holder:ident),*]: $($variant:ident $fields:tt,)*) => {{
        let _ = |it: $type| match it {
            $($type::$variant { .. } => (),)*
            $($type::$holder(..) => (),)*
        };
        vec![$($type::$variant $fields),*]
    }};
}

fn read_errors() -> Vec<ReadError> {
    let mut errors = one_of_each!(ReadError except [Stl, ThreeMf, Obj]:
        Empty {},
        OtherKind { kind: FileKind::Step },
        NoPlate { plate_number: 4, plates: 3 },
        UnknownKind {},
    );
    errors.extend(stl_errors().into_iter().map(ReadError::from));
    errors.extend(threemf_errors().into_iter().map(ReadError::from));
    errors.extend(obj_errors().into_iter().map(ReadError::from));
    errors
}

fn stl_errors() -> Vec<StlError> {
    one_of_each!(StlError except []:
        Truncated { declared_facets: 12, expected_bytes: 684, found_bytes: 350 },
        WrongFacetCount { declared_facets: 12, found_facets: 34 },
        NotFiniteBinary { byte: 96, facet: 7 },
        NotFiniteText { line: 5, text: "inf".to_owned() },
        Syntax { line: 6, expected: StlExpected::Coordinate, found: "1,5".to_owned() },
        EndOfText { line: 8, expected: StlExpected::Endloop },
        NoFacets {},
    )
}

fn threemf_errors() -> Vec<ThreeMfError> {
    let part = || "3D/3dmodel.model".to_owned();
    one_of_each!(ThreeMfError except []:
        NoDirectory {},
        NoPart { part: part() },
        DamagedPart { part: part() },
        Packed { part: part(), method: 14 },
        TooLarge { part: part(), most_bytes: 67_108_864 },
        Xml { part: part(), line: 12, fault: XmlFault::CutShort },
        BadAttribute { part: part(), line: 13, attribute: "v2".to_owned(), found: "1,5".to_owned() },
        NoVertex { part: part(), line: 14, vertex: 8, vertices: 7 },
        NoObject { part: part(), line: 15, object: 3 },
        Nested { part: part(), line: 16, object: 4, most_levels: 64 },
        TooMany { most_facets: 16_777_216 },
        Overflow { part: part(), object: 5 },
        Feature { part: part(), object: 6, feature: ThreeMfFeature::BeamLattice },
        Encrypted { part: part() },
        Extension { part: part(), extension: "https://example.org/2026/01".to_owned() },
        NoFacets { skipped: 2 },
    )
}

fn obj_errors() -> Vec<ObjError> {
    one_of_each!(ObjError except []:
        BadVertex { line: 7, found: "1,5".to_owned() },
        BadCorner { line: 8, found: "9//9".to_owned(), vertices: 6 },
        FewCorners { line: 9, corners: 2 },
        FreeForm { line: 10, keyword: "surf".to_owned() },
        TooMany { line: 11, most_facets: 65_536 },
        NoFaces {},
    )
}

fn mesh_errors() -> Vec<MeshError> {
    one_of_each!(MeshError except []:
        NoArea { facets: 12 },
        ZeroHeight {},
        BadHeight { height_mm: -3.5 },
        BadRotation {},
        Overflow {},
    )
}

fn quantity_errors() -> Vec<QuantityError> {
    one_of_each!(QuantityError except []:
        BadLength {
            quantity: Quantity::LiftSpeed,
            value: -2.5,
            unit: Unit::MillimetrePerMinute,
            least: 0.1,
            most: 1e6,
        },
        BadTime { quantity: Quantity::Wait, value_s: -1.5, most_s: 1e5 },
        BadExposures { previous_mm: 0.1, next_mm: 0.05 },
        BadCompensation { value_mm: 2.5, least_mm: -1.0, most_mm: 1.0 },
    )
}

fn grid_errors() -> Vec<GridError> {
    one_of_each!(GridError except [Quantity]:
        BadSize { width: 40_000, height: 123, max_side: 32_768, max_pixels: 268_435_456 },
        TooFine { width: 50_000, height: 456, max_side: 32_768, max_pixels: 268_435_456 },
        ModelTooLarge {
            model_mm_x: 200.5,
            model_mm_y: 100.25,
            grid_mm_x: 143.75,
            grid_mm_y: 89.5,
            fitting_scale: 0.7125,
        },
        ModelTooHigh { model_mm_z: 300.5, printer_mm_z: 180.25, fitting_scale: 0.5998 },
        TooManyBins { height_mm: 5000.5, bin_mm: 0.001 },
    )
}

fn arrange_errors() -> Vec<ArrangeError> {
    one_of_each!(ArrangeError except []:
        Empty {},
        NoSize {},
        BadSpacing { spacing_mm: -1.5 },
        TooManyCopies { copies: 20_000, most_copies: 10_000 },
        OtherCopies { model_number: 2, copies: 3, places: 1 },
        EmptyPlate { plate_number: 2 },
        BadTurn { turn_deg: 50 },
        TooLarge { model_number: 2, size_mm: [200.5, 100.25], plate_mm: [143.75, 89.5] },
        Outside { model_number: 3, copy_number: 5, plate_number: 2 },
        Collision { model_numbers: [3, 4], copy_numbers: [5, 1], plate_number: 2 },
        NoModel { model_number: 7, models: 3 },
        NoPlate { plate_number: 7, plates: 3 },
    )
}

fn weights_errors() -> Vec<WeightsError> {
    one_of_each!(WeightsError except []:
        NotWeights {},
        OtherMesh { weights_facets: 12, mesh_facets: 34 },
        OutOfRange { facet: 7, weight: 1.5 },
    )
}

fn ldi_errors() -> Vec<LdiError> {
    one_of_each!(LdiError except []:
        Cancelled (Cancelled),
        OutOfMemory { hits: 123, needed_bytes: 984 },
        TooManyFacets { facets: 3_000_000_000, most: 2_147_483_648 },
        NoHits { pitch_mm: 0.05 },
        NoGpu { system: "No adapter was found.".to_owned() },
        GpuEmulated { adapter: "llvmpipe (LLVM 19)".to_owned() },
        GpuTooSmall { facets: 12, needed_bytes: 345, limit_bytes: 234 },
        GpuFailed { fault: GpuFault::DeviceLost, system: Some("It was unplugged.".to_owned()) },
    )
}

fn plan_errors() -> Vec<PlanError> {
    one_of_each!(PlanError except [Quantity]:
        UpsideDownRange { layer_min_mm: 0.05, layer_max_mm: 0.04 },
        EmptyRange { layer_min_mm: 0.051, layer_max_mm: 0.053, step_mm: 0.01 },
        NotWholeBins { quantity: Quantity::Step, length_mm: 0.013, bin_mm: 0.002 },
        NotWholeSteps { quantity: Quantity::FirstLayer, length_mm: 0.205, step_mm: 0.01 },
        BadRange { from_mm: 5.5, to_mm: 2.5 },
        BadPlane { z_mm: 12.5, height_mm: 10.25 },
        LayerTooThick { layer_mm: 5.5, height_mm: 2.25 },
        Infeasible {
            from_mm: 12.34,
            to_mm: 12.39,
            model_number: Some(2),
            tolerance: 0.02,
            layer_min_mm: 0.05,
            least_tolerance: Some(0.0487),
            largest_layer_min_mm: Some(0.024),
        },
        LayersDoNotFit { from_mm: 1.5, to_mm: 1.625, layer_min_mm: 0.1, layer_max_mm: 0.12 },
        ThicknessesDoNotFit {
            from_mm: 1.5,
            to_mm: 1.625,
            model_number: None,
            tolerance: 0.065,
            thicknesses_mm: vec![0.05, 0.1],
            least_tolerance: None,
        },
        TooFewThicknesses { thicknesses: 1, enough: 3 },
        NotGradual { change_mm: 0.01, least_change_mm: 0.016 },
        LayersOutOfReach { layers: 10, least_layers: 67 },
        TimeOutOfReach { time_s: 60.5, least_time_s: 1234.0 },
    )
}

fn archive_errors() -> Vec<ArchiveError> {
    one_of_each!(ArchiveError except []:
        Cancelled (Cancelled),
        AllBlack {},
        UniformOnly {
            format: Format::Sl1,
            others: Format::VARIABLE,
            best: Some(UniformLayers { layer_mm: 0.07, layers: 857 }),
        },
        PrinterUniformOnly {
            model: "Anycubic Photon Mono M5s".to_owned(),
            best: None,
        },
        NoMasks { format: Format::Prusa3mf },
        OtherFirstLayer { layer_mm: 0.15, first_layer_mm: 0.2 },
        Write { system: "No space left on device.".to_owned() },
    )
}

fn options_errors() -> Vec<OptionsError> {
    one_of_each!(OptionsError except []:
        Unreadable { system: "unknown field `rayz`".to_owned() },
        UnknownPrinter {
            printer: "saturn".to_owned(),
            similar: vec!["saturn-3".to_owned(), "saturn-4".to_owned()],
            known: 110,
        },
        BadPrinter { printer: "mine".to_owned(), field: "pitch_um" },
        PixelsWithoutPitch {},
        BadAntialias { antialias: 3, known: [1, 2, 4, 8] },
        BadLength { option: "hollow.wall_mm", value_mm: 0.1, least_mm: 0.4, most_mm: 1000.0 },
        BadWeightMin { weight_min: 1.5 },
        SeveralTargets {},
        Contradictory {
            option: "max_change_mm",
            other: "max_layers",
        },
        PrinterLayers {
            model: "Phrozen Shuffle".to_owned(),
            printer_min_mm: 0.01,
            printer_max_mm: 0.3,
            layer_min_mm: 0.005,
            layer_max_mm: 0.5,
        },
        PrinterStep { model: "Phrozen Shuffle".to_owned(), printer_step_mm: 0.01, step_mm: 0.015 },
        ResinPrinter { format: Format::Prusa3mf, model: "Phrozen Shuffle".to_owned() },
        NozzleWithoutFilament { formats: Format::FILAMENT },
        BadNozzle { nozzle_mm: 4.0, least_mm: 0.15, most_mm: 2.5 },
        NozzleLayers {
            slicers: vec!["OrcaSlicer", "Bambu Studio"],
            nozzle_mm: 0.4,
            nozzle_min_mm: 0.08,
            nozzle_max_mm: 0.28,
            layer_min_mm: 0.05,
            layer_max_mm: 0.3,
        },
    )
}

fn limits_errors() -> Vec<LimitsError> {
    one_of_each!(LimitsError except []:
        OutOfBounds { limit: "wall_mm", value: -0.5, least: 0.0, most: 20.0 },
    )
}

fn search_errors() -> Vec<SearchError> {
    one_of_each!(SearchError except []:
        Directions { directions: 0, most: 100_000 },
        Alpha { alpha: 1.5 },
        Limit { limit: "most_cups_mm2", value: -1.0 },
        Task { task: 7 },
        Candidate { place: 12 },
    )
}

fn price_errors() -> Vec<PriceError> {
    one_of_each!(PriceError except []:
        OutOfBounds { field: "discount", value: 1.5, least: 0.0, most: 1.0 },
        BadPrices { field: "quantity_breaks" },
        NoFinish { finish: "gilded".to_owned(), known: vec!["sanded".to_owned(), "primed".to_owned()] },
    )
}

fn merge_errors() -> Vec<MergeError> {
    let [shard, second] = [1, 2].map(|number| Shard { number, count: 3 });
    one_of_each!(MergeError except []:
        None {},
        OtherVersion { shard, theirs: "0.0.9".to_owned(), ours: "0.1.0".to_owned() },
        OtherOptions { shard },
        Duplicate { place: 12, first: shard, second },
        Damaged { shard },
        Gap { missing: 4, total: 30, first: 17 },
    )
}

fn errors() -> Vec<Error> {
    let mut errors = one_of_each!(Error except [Options, Read, Mesh, Grid, Weights, Ldi, Plan, Arrange, Archive, Limits, Search, Price, Merge]:
        NoLayer { layer: 12, layers: 10 },
        MemoryBound { needed_bytes: 2_000_000_000, allowed_bytes: 1_000_000_000 },
        TimeBound { work: Work::Layers, needed_s: 3600.0, allowed_s: 300.0 },
        NoPlan {},
        FloatingPieces { pieces: 2, volume_mm3: 3.25, layer_number: 41, at_mm: [1.5, -2.0, 2.05] },
    );
    errors.extend(options_errors().into_iter().map(Error::from));
    errors.extend(read_errors().into_iter().map(Error::from));
    errors.extend(mesh_errors().into_iter().map(Error::from));
    for error in quantity_errors() {
        errors.push(Error::Grid(error.clone().into()));
        errors.push(Error::Plan(error.into()));
    }
    errors.extend(grid_errors().into_iter().map(Error::from));
    errors.extend(weights_errors().into_iter().map(Error::from));
    errors.extend(ldi_errors().into_iter().map(Error::from));
    errors.extend(arrange_errors().into_iter().map(Error::from));
    errors.extend(plan_errors().into_iter().map(Error::from));
    errors.extend(archive_errors().into_iter().map(Error::from));
    errors.extend(limits_errors().into_iter().map(Error::from));
    errors.extend(search_errors().into_iter().map(Error::from));
    errors.extend(price_errors().into_iter().map(Error::from));
    errors.extend(merge_errors().into_iter().map(Error::from));
    errors
}

fn warnings() -> Vec<Warning> {
    let metric = Metric::Cusp;
    one_of_each!(Warning except []:
        DegenerateFacets { facets: 12 },
        InsideOut {},
        TurnedFacets { facets: 12 },
        Unorientable { edges: 3 },
        OpenMesh { open_edges: 12, holes: 3 },
        SkippedObjects { objects: 2 },
        SubtractedPart { name: "hole".into() },
        SkippedPart { name: "dense".into(), kind: PartKind::Modifier },
        OtherPlates { plate_number: 1, plates: 3 },
        OddSize {
            size_mm: 0.8,
            readings: vec![
                UnitReading { unit: ModelUnit::Inch, size_mm: 20.32 },
                UnitReading { unit: ModelUnit::Centimeter, size_mm: 8.0 },
            ],
        },
        UnitStated { stated: ModelUnit::Centimeter, given: ModelUnit::Inch },
        NothingHollowed { wall_mm: 2.0, cavity_mm: 2.0 },
        NothingToDrain {},
        DrainAstray { drain_number: 2 },
        Undrained { basins: 3 },
        ClosedCavities { cavities: 2, volume_mm3: 345.5, at_mm: [1.25, -2.5, 12.75] },
        SupportAstray { point_number: 2 },
        Unsupported { points: 3 },
        OwnSupports { tips: 42, replaced: false },
        UnclosedRays { unclosed: 12, rays: 345 },
        MissedBodies { bodies: 2, at_mm: [1.25, -2.5, 12.75] },
        ToleranceExceeded { planner: "greedy".to_owned(), metric, tolerance: 0.05, max_error: 0.0712 },
        ToleranceExceededOnMesh { metric, tolerance: 0.05, max_error: 0.0712 },
        SampledSections {},
        TopMoved { top_mm: 9.95, height_mm: 10.025 },
        BlackLayers { layers: 12, from_mm: 1.25 },
        ErasedParts { layers: 12, from_mm: 1.25, area_mm2: 3.75 },
        ThinRoofs { area_mm2: 3.75, deep_mm: 0.125, at_mm: [1.25, -2.5, 12.75] },
        ClosedGaps { area_mm2: 3.75, at_mm: [1.25, -2.5, 12.75] },
        OneThickness {
            taker: "Anycubic Photon Mono M5s".to_owned(),
            best: Some(UniformLayers { layer_mm: 0.07, layers: 857 }),
        },
        ExtrapolatedExposures { layers: 12, thinnest_mm: 0.05, thickest_mm: 0.1 },
        UntriedThicknesses { model: "Elegoo Saturn 3".to_owned() },
        UntriedSlicer { slicers: vec!["OrcaSlicer", "Bambu Studio"] },
        GpuTooSmall { needed_bytes: 345, limit_bytes: 234 },
        GpuFailed { fault: GpuFault::Error, system: Some("Out of memory.".to_owned()) },
    )
}

/// Keys of text that is shown untranslated in every language: messages of the system, and names.
const VERBATIM: [&str; 12] = [
    "field", "finish", "system", "adapter", "model", "printer", "similar", "known", "taker",
    "theirs", "ours", "slicers",
];

/// Collects the required parts of a sentence: numbers, and untranslated text. Fails on other prose.
fn collect(key: &str, value: &Value, found: &mut Vec<String>) {
    match value {
        Value::Number(number) => found.push(number.as_i64().map_or_else(
            || number.as_f64().unwrap_or_default().to_string(),
            |number| number.to_string(),
        )),
        Value::String(text) if VERBATIM.contains(&key) => found.push(text.clone()),
        Value::String(text) => assert!(!text.contains(' '), "{key} holds prose: {text}"),
        Value::Array(items) => items.iter().for_each(|item| collect(key, item, found)),
        Value::Object(fields) => {
            for (key, value) in fields {
                collect(key, value, found);
            }
        }
        Value::Bool(_) | Value::Null => (),
    }
}

fn check(coded: &impl Serialize, sentence: &str) {
    let value = serde_json::to_value(coded).unwrap();
    let code = value["code"].as_str().unwrap_or_default();
    let is_kebab = |letter: char| letter.is_ascii_lowercase() || letter == '-';
    assert!(!code.is_empty() && code.chars().all(is_kebab), "{value}");
    let mut keys = value.as_object().unwrap().keys();
    assert!(keys.all(|key| key == "code" || key == "detail"), "{value}");
    let mut found = Vec::new();
    collect("", &value["detail"], &mut found);
    for part in found {
        assert!(sentence.contains(&part), "{part} is not in: {sentence}");
    }
}

#[test]
fn details_hold_no_prose_and_sentences_hold_the_figures() {
    for error in errors() {
        check(&error, &error.to_string());
        let value = serde_json::to_value(&error).unwrap();
        assert_eq!(error.code(), value["code"].as_str().unwrap());
    }
    for warning in warnings() {
        check(&warning, &warning.to_string());
    }
}

/// One of each error and warning with its sentence. The front-end's catalogues are tested against them.
fn samples() -> String {
    fn sample(coded: &impl Serialize, sentence: String) -> Value {
        let mut sample = serde_json::to_value(coded).unwrap();
        sample["message"] = sentence.into();
        sample
    }
    // Shards are merged on the command line only.
    let errors = errors().into_iter();
    let errors = errors.filter(|error| !matches!(error, Error::Merge(_)));
    let samples = serde_json::json!({
        "errors": errors.map(|it| sample(&it, it.to_string())).collect::<Vec<_>>(),
        "warnings": warnings().iter().map(|it| sample(it, it.to_string())).collect::<Vec<_>>(),
    });
    serde_json::to_string_pretty(&samples).unwrap() + "\n"
}

/// `BLESS=1` rewrites the file.
#[test]
fn the_samples_that_catalogues_are_tested_with_are_these() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/problems.json");
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(path, samples()).unwrap();
    }
    let recorded = std::fs::read_to_string(path).unwrap_or_default();
    assert!(recorded == samples(), "run again with BLESS=1: {path}");
}

#[test]
fn words_of_errors_are_those_they_are_serialised_with() {
    for format in Format::all() {
        assert_eq!(serde_json::to_value(format).unwrap(), format.name());
    }
    for unit in [
        Unit::Millimetre,
        Unit::Second,
        Unit::MillimetrePerMinute,
        Unit::GramPerMillilitre,
    ] {
        assert_eq!(serde_json::to_value(unit).unwrap(), unit.symbol());
    }
}
