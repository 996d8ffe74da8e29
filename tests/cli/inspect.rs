//! `inspect`.

use std::fs;

use tempfile::TempDir;

use super::{assert_fails, cusp, json, model, names, on_cpu, sphere};

/// The print file of a ball, 3 mm high.
fn print_file(folder: &TempDir, format: &str) -> String {
    let print = folder.path().join("print.file").display().to_string();
    let ball = sphere(folder);
    let options = ["--pitch", "0.05", "--height", "3", "--format", format];
    let sliced = on_cpu(&[&["slice", &ball, "-o", &print][..], &options].concat());
    assert!(sliced.status.success());
    print
}

#[test]
fn a_print_file_says_what_is_in_it() {
    let folder = TempDir::new().unwrap();
    for format in ["png", "chitubox", "uvj"] {
        let print = print_file(&folder, format);
        let output = cusp(&["inspect", &print, "--json"]);
        assert_eq!(String::from_utf8_lossy(&output.stderr), "");
        let found = json(&output);
        assert_eq!(found["format"], format);
        let layers = found["layer_values"].as_array().unwrap();
        assert_eq!(found["layers"], layers.len());
        let top = &layers[layers.len() - 1];
        assert_eq!(found["height_mm"], top["z_mm"]);
        assert!(top["lit_pixels"].as_u64().unwrap() > 0);
        assert!(top["exposure_s"].as_f64().unwrap() > 1.0);
        assert_eq!(found["warnings"], serde_json::json!([]));
        // A ball of 3 mm has 14.137 mm³.
        let volume_ml = found["lit_volume_ml"].as_f64().unwrap();
        assert!((0.0138..0.0145).contains(&volume_ml), "{volume_ml}");

        let text = String::from_utf8(cusp(&["inspect", &print]).stdout).unwrap();
        let line = |name: &str| text.lines().find(|line| line.starts_with(name)).unwrap();
        assert!(line("format ").contains(format));
        assert!(line("layers ").contains(&format!("{} of 0.", layers.len())));
        assert!(line("exposure ").contains(" s"), "{text}");
    }
}

#[test]
fn the_mask_of_a_layer_is_written_as_a_png() {
    let folder = TempDir::new().unwrap();
    let print = print_file(&folder, "png");
    let found = json(&cusp(&["inspect", &print, "--json"]));
    let mask = folder.path().join("mask.png").display().to_string();
    let output = cusp(&["inspect", &print, "--layer", "2", "-o", &mask]);
    assert!(output.status.success());
    let png = std::io::BufReader::new(fs::File::open(&mask).unwrap());
    let mut png = png::Decoder::new(png).read_info().unwrap();
    let mut pixels = vec![0; png.output_buffer_size().unwrap()];
    let info = png.next_frame(&mut pixels).unwrap();
    let size = serde_json::json!([info.width, info.height]);
    assert_eq!(found["pixels"], size);
    let lit = pixels.iter().filter(|&&pixel| pixel > 0).count();
    assert_eq!(found["layer_values"][1]["lit_pixels"], lit);

    let absent = cusp(&["inspect", &print, "--layer", "9999", "-o", &mask]);
    assert_fails(&absent, 1, "there is no layer 9999");
    let itself = cusp(&["inspect", &print, "--layer", "1", "-o", &print]);
    assert_fails(&itself, 1, "is the print file itself");
    let incomplete: [(&[&str], &str); 3] = [
        (&["--layer", "1"], "--output"),
        (&["-o", &mask], "--layer"),
        (&["--layer", "0", "-o", &mask], "--layer"),
    ];
    for (options, words) in incomplete {
        assert_fails(&cusp(&[&["inspect", &print], options].concat()), 2, words);
    }
    assert_eq!(names(&folder), ["ball.stl", "mask.png", "print.file"]);
}

#[test]
fn a_damaged_file_is_described_with_warnings() {
    let folder = TempDir::new().unwrap();
    let print = print_file(&folder, "png");
    let mut bytes = fs::read(&print).unwrap();
    // In the data of the first mask.
    bytes[60] ^= 0x55;
    fs::write(&print, bytes).unwrap();
    let output = cusp(&["inspect", &print]);
    assert_eq!(output.status.code(), Some(0));
    let stderr = String::from_utf8(output.stderr).unwrap();
    let start = "cusp: warning: 1 layer is damaged, first layer 1: ";
    assert!(stderr.starts_with(start), "{stderr}");
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.starts_with("format "));
}

#[test]
fn what_is_no_print_file_is_refused() {
    let folder = TempDir::new().unwrap();
    let ball = sphere(&folder);
    assert_fails(&cusp(&["inspect", &ball]), 1, "it is no print file");
    assert_fails(&cusp(&["inspect", "absent.goo"]), 1, "absent.goo");
    let start = 0x12FD_0107_u32.to_le_bytes();
    let encrypted = model(&folder, "a.ctb", &[&start[..], &[0; 99]].concat());
    assert_fails(&cusp(&["inspect", &encrypted]), 1, "encrypted CTB");
}
