//! The defaults in the documents are the library's.

use cusp_slicer::inspect::{Code, Limits, Severity};
use cusp_slicer::job::{LAYERS_MM, Options};
use cusp_slicer::orientation::SearchOptions;
use cusp_slicer::profile::Metric;

const CLI: &str = include_str!("../docs/cli.md");
const EMBED: &str = include_str!("../docs/embed.md");
const PRINTABILITY: &str = include_str!("../docs/printability.md");

/// The row of a table that begins with this cell.
fn row<'a>(document: &'a str, cell: &str) -> &'a str {
    let start = format!("| {cell}");
    let mut rows = document.lines().filter(|line| line.starts_with(&start));
    rows.next().unwrap_or_else(|| panic!("no row {start}"))
}

fn assert_says(text: &str, said: &str) {
    assert!(text.contains(said), "`{said}` is missing in: {text}");
}

/// The default tolerance as the documents write it.
fn tolerance(metric: Metric) -> String {
    let written = format!("{} {}", metric.default_tolerance(), metric.unit());
    written.trim_end().to_owned()
}

#[test]
fn the_command_lines_document_names_the_defaults_of_the_library() {
    for metric in Metric::ALL {
        let name = metric.name();
        let row = row(CLI, &format!("`--metric {name}`"));
        let (_, said) = row.split_once("default ").unwrap();
        let said = said.trim_start_matches("tolerance is ");
        assert!(said.starts_with(&tolerance(metric)), "{row}");
    }
    let [min_mm, max_mm] = LAYERS_MM;
    let thickness = format!("`--layer-min {min_mm}`, `--layer-max {max_mm}`");
    assert_says(CLI, &thickness);
    let directions = SearchOptions::default().directions;
    let thousands = format!("{},{:03}", directions / 1000, directions % 1000);
    assert_says(CLI, &format!("evaluates {thousands} directions"));
}

#[test]
fn the_elements_document_names_the_least_weight_of_the_library() {
    let said = format!(
        "`weight_min` ({} by default)",
        Options::default().weight_min
    );
    assert_says(EMBED, &said);
}

#[test]
fn the_document_on_printability_names_the_defaults_of_the_library() {
    let limits = Limits::default();
    let severity = |severity| match severity {
        Severity::Ignore => "ignore",
        Severity::Note => "note",
        Severity::Review => "review",
        Severity::Reject => "reject",
    };
    let fields = [
        ("island_mm2", Some(limits.island_mm2), Code::Island),
        ("speck_px", Some(f64::from(limits.speck_px)), Code::Speck),
        ("overhang_mm", Some(limits.overhang_mm), Code::Overhang),
        ("bridge_mm", Some(limits.bridge_mm), Code::Overhang),
        ("cup_mm2", Some(limits.cup_mm2), Code::Cup),
        ("trap_ml", Some(limits.trap_ml), Code::Trap),
        ("drain_mm", Some(limits.drain_mm), Code::NarrowDrain),
        ("wall_mm", Some(limits.wall_mm), Code::ThinWall),
        ("floor_mm", Some(limits.floor_mm), Code::ThinFloor),
        ("gap_mm", Some(limits.gap_mm), Code::NarrowGap),
        ("hole_mm", Some(limits.hole_mm), Code::SmallHole),
        ("low_gap_mm", Some(limits.low_gap_mm), Code::LowGap),
        (
            "print_through_mm2",
            Some(limits.print_through_mm2),
            Code::ThinRoof,
        ),
        ("peel_mm2", limits.peel_mm2, Code::PeelArea),
        ("peel_jump_mm2", limits.peel_jump_mm2, Code::PeelJump),
        ("contact", limits.contact, Code::SmallContact),
    ];
    for (field, value, code) in fields {
        let row = row(PRINTABILITY, &format!("`{field}`"));
        let value = value.map_or("none".to_owned(), |value| value.to_string());
        assert_says(row, &format!("| {value}"));
        assert_says(row, &format!("| `{}` |", code.name()));
        assert_says(row, severity(limits.severity.of(code)));
    }
    let slope = limits.self_supporting_slope.to_string();
    assert_says(row(PRINTABILITY, "`overhang_mm`"), &slope);
    let volumes_mm3 = format!("| {}, {} |", limits.note_mm3, limits.reject_mm3);
    assert_says(row(PRINTABILITY, "`note_mm3`"), &volumes_mm3);
    let volume_ml = format!("| {} |", limits.note_ml);
    assert_says(row(PRINTABILITY, "`note_ml`"), &volume_ml);
    let area_mm2 = format!("| {} |", limits.note_mm2);
    assert_says(row(PRINTABILITY, "`note_mm2`"), &area_mm2);
    for code in Code::ALL {
        assert_says(
            PRINTABILITY,
            &format!(
                "| `{}` | {}",
                code.name(),
                severity(limits.severity.of(code))
            ),
        );
    }
}
