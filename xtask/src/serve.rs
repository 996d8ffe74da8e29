//! Serves the built page on this computer until Ctrl-C.

use std::{
    io::{Read, Write},
    net::{Ipv4Addr, TcpListener, TcpStream},
    process::{Child, Stdio},
    sync::mpsc,
    time::{Duration, Instant},
};

use anyhow::{Context, Result, bail};

use crate::{process::command, project::Project};

const FIRST_PORT: u16 = 8080;
/// How many ports to try.
const PORTS: u16 = 100;
const PATIENCE: Duration = Duration::from_secs(30);

/// Serves `www/dist` on the loopback address, prints the address once it answers,
/// and returns after Ctrl-C.
///
/// # Errors
///
/// Fails if the given port is taken or the server does not start.
pub fn serve(project: &Project, port: Option<u16>) -> Result<()> {
    let port = match port {
        Some(port) if is_free(port) => port,
        Some(port) => bail!("port {port} is taken"),
        None => (FIRST_PORT..FIRST_PORT + PORTS)
            .find(|&port| is_free(port))
            .context("no free port from 8080 on")?,
    };
    // Not through npm: a stopped npm would leave the server running.
    let mut server = command("node");
    server
        .current_dir(&project.www)
        .arg("node_modules/vite/bin/vite.js")
        .args(["preview", "--strictPort", "--host", "127.0.0.1", "--port"])
        .arg(port.to_string())
        .stdout(Stdio::null());
    let (send, stopped) = mpsc::channel();
    ctrlc::set_handler(move || {
        // Without a receiver we are already exiting.
        let _ = send.send(());
    })?;
    let mut server = server
        .spawn()
        .context("cannot start vite's preview server")?;
    let result = watch(&mut server, port, &stopped);
    // It may have exited already: the same Ctrl-C reaches both.
    let _ = server.kill();
    let _ = server.wait();
    result
}

/// Waits for the server to answer, prints its address, and waits for the end.
fn watch(server: &mut Child, port: u16, stopped: &mpsc::Receiver<()>) -> Result<()> {
    let started = Instant::now();
    let mut announced = false;
    loop {
        if !announced && answers(port) {
            println!("http://127.0.0.1:{port}/");
            eprintln!("Press Ctrl-C to stop.");
            announced = true;
        }
        let pause = Duration::from_millis(if announced { 500 } else { 50 });
        if stopped.recv_timeout(pause).is_ok() {
            return Ok(());
        }
        if let Some(status) = server.try_wait()? {
            bail!("the server exited ({status})");
        }
        if !announced && started.elapsed() > PATIENCE {
            bail!("the server does not answer");
        }
    }
}

fn is_free(port: u16) -> bool {
    TcpListener::bind((Ipv4Addr::LOCALHOST, port)).is_ok()
}

/// Whether the page itself answers, not merely an open port.
fn answers(port: u16) -> bool {
    let ask = || -> std::io::Result<bool> {
        let mut stream = TcpStream::connect((Ipv4Addr::LOCALHOST, port))?;
        stream.set_read_timeout(Some(Duration::from_secs(5)))?;
        stream.write_all(b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n")?;
        let mut status = [0; 12];
        stream.read_exact(&mut status)?;
        Ok(&status == b"HTTP/1.1 200")
    };
    ask().unwrap_or(false)
}
