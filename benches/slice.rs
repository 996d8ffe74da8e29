//! Time of `cusp slice` as a whole process, STL to print file:
//! `cargo xtask bench slice [--format NAME|all] [--peer] [--growth] [MODEL.stl …]`.
//!
//! A sphere of 40 mm and 80,000 facets on a 12K screen, in one format or in all; then each model named, 60 mm high, at 2048 pixels along
//! its longer side, in uniform layers of 0.05 mm. With `--peer`, `prusa-slicer`, which must be on PATH, slices the same models. With
//! `--growth`, only how time grows with facets, rays, layers and copies.

#[path = "paper/models.rs"]
#[expect(dead_code, reason = "a ball is enough here")]
mod models;
#[path = "../tests/common/peer.rs"]
mod peer;
#[path = "../tests/common/solids.rs"]
#[expect(dead_code, reason = "the tests use the solids; here only their file")]
mod solids;

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use cusp_slicer::format::Format;
use cusp_slicer::model::read;
use cusp_slicer::model::{Mesh, Pose};

const ROUNDS: usize = 5;
const HEIGHT_MM: f64 = 60.0;
const RAYS: f64 = 2048.0;

/// The time a command takes, in seconds.
fn time(command: &mut Command) -> f64 {
    let clock = Instant::now();
    let status = command.stdout(Stdio::null()).stderr(Stdio::null()).status();
    assert!(
        status.is_ok_and(|status| status.success()),
        "{command:?} failed"
    );
    clock.elapsed().as_secs_f64()
}

fn cusp(model: &Path, output: &Path, options: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_cusp"));
    command.arg("slice").arg(model).arg("-o").arg(output);
    command.args(["--backend", "cpu", "--planner", "uniform"]);
    if !options.contains("--layer") {
        command.args(["--layer", "0.05"]);
    }
    command.args(options.split_whitespace());
    command
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// The most memory that a command holds, in megabytes. 0 where the system does not say.
fn peak_megabytes(command: &mut Command) -> f64 {
    let command = command.stdout(Stdio::null()).stderr(Stdio::null());
    let mut child = command.spawn().expect("a command that starts");
    let status = format!("/proc/{}/status", child.id());
    let mut peak_kb = 0.0f64;
    while child.try_wait().is_ok_and(|exit| exit.is_none()) {
        let text = fs::read_to_string(&status).unwrap_or_default();
        let peak = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kb = peak.and_then(|peak| peak.trim().trim_end_matches(" kB").parse().ok());
        peak_kb = peak_kb.max(kb.unwrap_or(0.0));
        std::thread::sleep(Duration::from_micros(500));
    }
    peak_kb / 1e3
}

fn megabytes(file: &Path) -> f64 {
    fs::metadata(file).expect("a file").len() as f64 / 1e6
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let folder = tempfile::tempdir().expect("a folder");
    let output = folder.path().join("out.zip");
    if arguments.iter().any(|argument| argument == "--growth") {
        return growth(folder.path(), &output);
    }

    println!(
        "A sphere of 40 mm on 11520 × 5120 pixels of 19 × 24 µm, 800 layers of 0.05 mm; medians of {ROUNDS}\n"
    );
    println!("| format | s | file, MB | memory, MB |\n|---|---:|---:|---:|");
    let model = folder.path().join("ball.stl");
    let ball = models::ball(20.0, 199, 202);
    fs::write(&model, solids::binary_stl(&ball)).expect("the ball");
    let formats = Format::MASKS.map(Format::name);
    let chosen = arguments.iter().skip_while(|it| *it != "--format").nth(1);
    let chosen = chosen.filter(|it| *it != "all");
    for format in formats {
        if chosen.is_some_and(|chosen| chosen != format) {
            continue;
        }
        let options = format!("--pixels 11520x5120 --pitch 0.019x0.024 --format {format}");
        let command = || cusp(&model, &output, &options);
        let times = (0..ROUNDS).map(|_| time(&mut command()));
        println!(
            "| {format} | {:.3} | {:.2} | {:.0} |",
            median(times.collect()),
            megabytes(&output),
            peak_megabytes(&mut command())
        );
    }

    let models = arguments
        .iter()
        .filter(|it| Path::new(it).extension().is_some_and(|it| it == "stl"));
    let with_peer = arguments.iter().any(|argument| argument == "--peer");
    for path in models {
        compare(Path::new(path), folder.path(), with_peer);
    }
}

/// Prints times of the usual and of ten times as much of one thing, and the exponent with which time grows.
fn growth(folder: &Path, output: &Path) {
    let ball = |radius: f64, rings: u32| {
        let model = folder.join(format!("{radius}-{rings}.stl"));
        let facets = models::ball(radius, rings, rings);
        fs::write(&model, solids::binary_stl(&facets)).expect("a ball");
        model
    };
    let [usual, fine, small] = [ball(20.0, 224), ball(20.0, 708), ball(4.0, 64)];
    let square = |rays: f64| format!("--pixels {rays}x{rays} --pitch {}", 41.0 / rays);
    let options = square(RAYS);
    let copies =
        |count: u32| format!("--pixels 11520x5120 --pitch 0.019x0.024 --arrange --copies {count}");
    let cases = [
        (
            "facets, 100,000",
            [&usual, &fine],
            [options.clone(), options.clone()],
        ),
        (
            "rays, 2048²",
            [&usual; 2],
            [options.clone(), square(6476.0)],
        ),
        (
            "layers, 800",
            [&usual; 2],
            [options.clone(), format!("{options} --layer 0.005")],
        ),
        (
            "copies, 10 of 8,000 facets",
            [&small; 2],
            [copies(10), copies(100)],
        ),
    ];
    println!("| ten times as many | s | s | exponent |\n|---|---:|---:|---:|");
    for (name, models, options) in cases {
        let mut times = [Vec::new(), Vec::new()];
        for _ in 0..ROUNDS {
            for (times, (model, options)) in times.iter_mut().zip(models.iter().zip(&options)) {
                times.push(time(&mut cusp(model, output, options)));
            }
        }
        let [one_s, ten_s] = times.map(median);
        let exponent = (ten_s / one_s).log10();
        println!("| {name} | {one_s:.3} | {ten_s:.3} | {exponent:.2} |");
    }
}

/// Slices a model in uniform layers with cusp and, `with_peer`, with `prusa-slicer`, alternating each round.
fn compare(path: &Path, folder: &Path, with_peer: bool) {
    let bytes = fs::read(path).expect("a model to read");
    let mesh = Mesh::from_triangles(&read::read(&bytes).expect("an STL").triangles)
        .and_then(|mesh| mesh.on_plate(&Pose::of_height(HEIGHT_MM)))
        .expect("a mesh");
    let size = mesh.bounds().size();
    // With a margin: without one, PrusaSlicer says that the model does not fit.
    let pitch_mm = size.x.max(size.y) / (RAYS - 8.0);
    // Written at its final size, so that both slicers read the same file.
    let scaled: solids::Triangles = mesh.facets[..mesh.surface_facets]
        .iter()
        .map(|facet| facet.map(|vertex| mesh.vertices[vertex as usize]))
        .collect();
    let model = folder.join("model.stl");
    fs::write(&model, solids::binary_stl(&scaled)).expect("the model");
    let (ours, peers) = (folder.join("ours.sl1"), folder.join("peers.sl1"));
    let side_mm = pitch_mm * RAYS;
    let options = format!("--pixels {RAYS}x{RAYS} --pitch {pitch_mm} --format sl1");
    let mut times = [Vec::new(), Vec::new()];
    for _ in 0..ROUNDS {
        times[0].push(time(&mut cusp(&model, &ours, &options)));
        if with_peer {
            let mut peer = peer::prusa_slicer(&model, &peers, folder, side_mm, RAYS as u32);
            times[1].push(time(&mut peer));
        }
    }
    println!(
        "\n{}, {HEIGHT_MM} mm high, {RAYS} × {RAYS} pixels, layers of 0.05 mm, SL1\n",
        path.display()
    );
    println!("| slicer | s | MB |\n|---|---:|---:|");
    let [own, peer] = times;
    let own_s = median(own);
    println!("| cusp | {own_s:.2} | {:.2} |", megabytes(&ours));
    if with_peer {
        let peer_s = median(peer);
        println!("| PrusaSlicer | {peer_s:.2} | {:.2} |", megabytes(&peers));
        println!("\n{:.1} times faster", peer_s / own_s);
        compare_masks(&ours, &peers);
    }
}

/// Prints what fraction of the lit pixels differs between two SL1 files.
fn compare_masks(ours: &Path, peers: &Path) {
    let (ours, peers) = (peer::sl1_masks(ours), peer::sl1_masks(peers));
    let mut lit = 0u64;
    let mut differing = 0u64;
    for (own, peer) in ours.iter().zip(&peers) {
        let is_lit = |pixel: &u8| *pixel > 127;
        let pairs = own.iter().zip(peer);
        differing += pairs.filter(|(a, b)| is_lit(a) != is_lit(b)).count() as u64;
        lit += own.iter().filter(|pixel| is_lit(pixel)).count() as u64;
    }
    println!(
        "masks: {} and {}; {:.3} % of the lit pixels differ",
        ours.len(),
        peers.len(),
        100.0 * differing as f64 / lit as f64
    );
}
