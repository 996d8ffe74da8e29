//! The files that `slice` writes, replaces, or refuses to write.

use tempfile::TempDir;

use super::{assert_fails, json, model, names, on_cpu, sphere};
use crate::common::assert_near;

#[test]
fn slice_writes_a_whole_zip_and_nothing_else() {
    let folder = TempDir::new().unwrap();
    let (model, zip) = (sphere(&folder), folder.path().join("out.zip"));
    let output = on_cpu(&[
        "slice",
        &model,
        "-o",
        zip.to_str().unwrap(),
        "--pixels",
        "300x200",
        "--pitch",
        "0.04",
        "--height",
        "3",
        "--json",
    ]);
    let report = json(&output);
    assert_eq!(report["mask"]["width"], 300);
    assert_near(report["height_mm"].as_f64().unwrap(), 3.0, 1e-6);
    let archive = zip::ZipArchive::new(std::fs::File::open(&zip).unwrap()).unwrap();
    assert_eq!(archive.len() as u64, report["layers"].as_u64().unwrap() + 1);
    assert_eq!(names(&folder), ["ball.stl", "out.zip"]);
    // A closed model gives no warning, and there is no progress bar in a pipe.
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}

#[test]
fn a_bound_of_memory_changes_no_byte() {
    let folder = TempDir::new().unwrap();
    let model = sphere(&folder);
    let slice = |name: &str, bound: &[&str]| {
        let zip = folder.path().join(name).to_str().unwrap().to_owned();
        let screen = ["--height", "15", "--pixels", "2000x2000", "--pitch", "0.01"];
        let arguments = [&["slice", &model, "-o", &zip], &screen[..], bound].concat();
        (on_cpu(&arguments), std::fs::read(zip))
    };
    let (output, kept) = slice("kept.zip", &[]);
    assert!(output.status.success(), "{output:?}");
    // Its hits and masks alone take 60 MB.
    let (output, bounded) = slice("bounded.zip", &["--max-memory", "40MB"]);
    assert!(output.status.success(), "{output:?}");
    assert!(kept.unwrap() == bounded.unwrap());

    let (output, file) = slice("none.zip", &["--max-memory", "1MiB"]);
    assert_fails(&output, 1, "and 1048576 are allowed; allow more");
    assert!(file.is_err());
    let (output, _) = slice("none.zip", &["--max-memory", "much"]);
    assert_fails(&output, 2, "--max-memory <SIZE>");
}

#[test]
fn a_failed_slice_leaves_the_old_file() {
    let folder = TempDir::new().unwrap();
    let zip = model(&folder, "out.zip", b"precious");
    let output = on_cpu(&["slice", &sphere(&folder), "-o", &zip, "--tolerance", "0.01"]);
    assert_fails(&output, 1, "raise the tolerance to 0.0");
    assert_eq!(std::fs::read(&zip).unwrap(), b"precious");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
}

#[test]
fn an_output_that_cannot_be_is_refused_before_the_model_is_read() {
    let folder = TempDir::new().unwrap();
    let poem = model(&folder, "poem.stl", b"a poem about a cube");
    let inside = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    std::fs::create_dir_all(inside("folder/poem.zip")).unwrap();
    for (output, words) in [
        (poem.clone(), "is the model itself"),
        (inside("folder/../poem.stl"), "is the model itself"),
        // In a folder the print file has the model's name.
        (inside("folder"), "poem.zip: is a folder"),
        (inside("nowhere/out.zip"), "there is no folder"),
    ] {
        assert_fails(&on_cpu(&["slice", &poem, "-o", &output]), 1, words);
    }
    assert_eq!(std::fs::read(&poem).unwrap(), b"a poem about a cube");
    assert_eq!(names(&folder), ["folder", "poem.stl"]);
}

#[cfg(unix)]
mod unix {
    use std::os::unix::fs::{PermissionsExt, symlink};
    use std::path::Path;
    use std::process::{Command, Stdio};

    use super::*;
    use crate::cli::cusp;

    const QUICK: [&str; 4] = ["--pitch", "0.1", "--backend", "cpu"];

    fn mode(path: impl AsRef<Path>) -> u32 {
        std::fs::metadata(path).unwrap().permissions().mode() & 0o777
    }

    #[test]
    fn a_link_stays_and_its_file_is_written() {
        let folder = TempDir::new().unwrap();
        let ball = sphere(&folder);
        let inside = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
        std::fs::create_dir(inside("prints")).unwrap();
        std::fs::write(inside("prints/old.zip"), b"old").unwrap();
        symlink("prints/old.zip", inside("link.zip")).unwrap();
        let output = cusp(&[&["slice", &ball, "-o", &inside("link.zip")], &QUICK[..]].concat());
        assert!(output.status.success());
        assert!(Path::new(&inside("link.zip")).is_symlink());
        assert!(
            std::fs::read(inside("prints/old.zip"))
                .unwrap()
                .starts_with(b"PK")
        );

        symlink("ball.stl", inside("model.zip")).unwrap();
        let output = cusp(&["slice", &ball, "-o", &inside("model.zip")]);
        assert_fails(&output, 1, "is the model itself");
        symlink("nothing.zip", inside("dangling.zip")).unwrap();
        let output = cusp(&["slice", &ball, "-o", &inside("dangling.zip")]);
        assert_fails(&output, 1, "a link to a file that does not exist");
    }

    #[test]
    fn devices_and_pipes_are_refused() {
        let folder = TempDir::new().unwrap();
        let ball = sphere(&folder);
        let pipe = folder.path().join("pipe");
        assert!(
            Command::new("mkfifo")
                .arg(&pipe)
                .status()
                .unwrap()
                .success()
        );
        for output in ["/dev/null", pipe.to_str().unwrap()] {
            let output = cusp(&["slice", &ball, "-o", output]);
            assert_fails(&output, 1, "a device or a pipe");
        }
        assert_eq!(names(&folder), ["ball.stl", "pipe"]);
    }

    #[test]
    fn a_new_file_obeys_the_umask_and_a_replaced_one_keeps_its_mode() {
        let folder = TempDir::new().unwrap();
        let ball = sphere(&folder);
        let zip = folder.path().join("out.zip");
        let slice_with_umask_027 = || {
            let status = Command::new("sh")
                .args(["-c", "umask 027; exec \"$@\"", "sh"])
                .args([env!("CARGO_BIN_EXE_cusp"), "slice", &ball, "-o"])
                .arg(&zip)
                .args(QUICK)
                .stdout(Stdio::null())
                .status();
            assert!(status.unwrap().success());
        };
        slice_with_umask_027();
        assert_eq!(mode(&zip), 0o640);
        for kept in [0o600, 0o666] {
            std::fs::set_permissions(&zip, PermissionsExt::from_mode(kept)).unwrap();
            slice_with_umask_027();
            assert_eq!(mode(&zip), kept);
        }
    }
}
