//! Completions and manual pages.

use tempfile::TempDir;

use super::{assert_fails, cusp, names};

#[test]
fn every_shell_has_completions_with_formats_and_printers() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let output = cusp(&["completions", shell]);
        assert!(output.status.success());
        let script = String::from_utf8(output.stdout).unwrap();
        assert!(script.contains("layer-max"), "{shell}");
        // The last two complete no values.
        if !["powershell", "elvish"].contains(&shell) {
            for value in ["photon-workshop", "saturn-4-ultra-12k", "roughness"] {
                assert!(script.contains(value), "{shell} {value}");
            }
        }
    }
    assert_fails(&cusp(&["completions", "tcsh"]), 2, "elvish");
}

#[test]
fn every_command_has_a_manual_page() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().display().to_string();
    assert!(cusp(&["man", "-o", &path]).status.success());
    let help = String::from_utf8(cusp(&["--help"]).stdout).unwrap();
    let commands = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let commands = commands.map_while(|line| line.strip_prefix("  "));
    // Descriptions may go on in further lines.
    let commands = commands.filter(|line| !line.starts_with(' '));
    let commands = commands.filter_map(|line| line.split_whitespace().next());
    let mut expected: Vec<String> = commands
        .filter(|command| *command != "help")
        .map(|command| format!("cusp-{command}.1"))
        .collect();
    assert!(expected.len() >= 15, "{expected:?}");
    expected.push("cusp.1".to_owned());
    for calibration in ["layers", "exposure", "cure", "resin"] {
        expected.push(format!("cusp-calibrate-{calibration}.1"));
    }
    expected.sort();
    assert_eq!(names(&folder), expected);
    for name in names(&folder) {
        let page = std::fs::read_to_string(folder.path().join(&name)).unwrap();
        let title = name.trim_end_matches(".1");
        assert!(page.contains(&format!(".TH {title} 1")), "{page}");
    }
    let printed = cusp(&["man"]).stdout;
    let written = std::fs::read(folder.path().join("cusp.1")).unwrap();
    assert_eq!(printed.trim_ascii_end(), written.trim_ascii_end());
    let nowhere = folder.path().join("nowhere").display().to_string();
    assert_fails(
        &cusp(&["man", "-o", &nowhere]),
        1,
        "at the end of its name makes one",
    );
}

#[test]
fn schemas_are_printed_by_name_and_written_all() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().display().to_string();
    assert!(cusp(&["schema", "-o", &path]).status.success());
    let files = names(&folder);
    assert!(files.len() >= 25, "{files:?}");
    for file in files {
        let written = std::fs::read(folder.path().join(&file)).unwrap();
        let schema: serde_json::Value = serde_json::from_slice(&written).unwrap();
        assert_eq!(schema["$schema"], "http://json-schema.org/draft-07/schema#");
        let name = file.strip_suffix(".schema.json").unwrap();
        let printed = cusp(&["schema", name]).stdout;
        assert_eq!(printed.trim_ascii_end(), written.trim_ascii_end(), "{name}");
    }
    assert_fails(&cusp(&["schema", "plans"]), 2, "'plan'");
    assert_fails(&cusp(&["schema"]), 2, "<NAME>");
}
