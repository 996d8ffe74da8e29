//! `cargo xtask start`: the page, built and served on this computer until Ctrl-C.

use std::{
    net::{Ipv4Addr, TcpListener, TcpStream},
    process::Stdio,
    sync::mpsc,
    thread,
    time::{Duration, Instant},
};

use anyhow::{Context, Result, bail};

use crate::{
    node,
    process::{self, command},
    project::Project,
    wasm,
};

const FIRST_PORT: u16 = 8080;
/// Number of ports to try.
const PORTS: u16 = 100;
const PATIENCE: Duration = Duration::from_secs(30);

/// Builds `www/pkg` and `www/dist`. Packages of npm are fetched while the slicer is compiled.
pub fn build(project: &Project) -> Result<()> {
    let started = Instant::now();
    let step = |number: u32, what: &str| {
        eprintln!("[{number}/4] {what} ({} s)", started.elapsed().as_secs());
    };
    thread::scope(|scope| {
        step(1, "tools and packages");
        let packages = scope.spawn(|| node::ensure_packages(project));
        wasm::ensure_tools(project)?;
        step(2, "the slicer, in Rust");
        wasm::compile(project)?;
        packages.join().expect("no panic")
    })?;
    step(3, "the slicer, for browsers");
    wasm::build(project)?;
    step(4, "the page");
    process::run(node::npm(project)?.args(["run", "build"]))
}

/// Serves `www/dist` on the loopback address, prints the address once it answers,
/// and returns after Ctrl-C.
pub fn serve(project: &Project, port: Option<u16>) -> Result<()> {
    let is_free = |port: &u16| TcpListener::bind((Ipv4Addr::LOCALHOST, *port)).is_ok();
    let port = match port {
        Some(port) if is_free(&port) => port,
        Some(port) => bail!("port {port} is taken"),
        None => (FIRST_PORT..FIRST_PORT + PORTS)
            .find(is_free)
            .context("no free port from 8080 on")?,
    };
    let (send, stopped) = mpsc::channel();
    ctrlc::set_handler(move || {
        // Without a receiver we are already exiting.
        let _ = send.send(());
    })?;
    // Not through npm: a stopped npm would leave the server running.
    let mut server = command("node")
        .current_dir(&project.www)
        .arg("node_modules/vite/bin/vite.js")
        .args(["preview", "--strictPort", "--host", "127.0.0.1", "--port"])
        .arg(port.to_string())
        .stdout(Stdio::null())
        .spawn()
        .context("cannot start vite's preview server")?;
    let started = Instant::now();
    let mut is_announced = false;
    let result = loop {
        if !is_announced && TcpStream::connect((Ipv4Addr::LOCALHOST, port)).is_ok() {
            println!("http://127.0.0.1:{port}/");
            eprintln!("Press Ctrl-C to stop.");
            is_announced = true;
        }
        if stopped.recv_timeout(Duration::from_millis(100)).is_ok() {
            break Ok(());
        }
        if let Some(status) = server.try_wait()? {
            bail!("the server exited ({status})");
        }
        if !is_announced && started.elapsed() > PATIENCE {
            break Err(anyhow::anyhow!("the server does not answer"));
        }
    };
    // It may have exited already: the same Ctrl-C reaches both.
    let _ = server.kill();
    let _ = server.wait();
    result
}
