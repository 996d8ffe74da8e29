//! Files that packagers install with the program: completions and manual pages, made from its arguments.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use clap_complete::Shell;
use clap_mangen::Man;

use crate::failure::Failure;
use crate::files::{Output, make_folder};
use crate::terminal::print;

/// Prints the completions for a shell.
pub fn completions(mut cli: clap::Command, shell: Shell) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut cli, "cusp", &mut script);
    let script = String::from_utf8_lossy(&script);
    Ok(print(script.trim_end())?)
}

/// Writes a manual page for each command, as `cusp-slice.1`, and `cusp.1`; or prints that alone.
pub fn man(mut cli: clap::Command, folder: Option<&Path>) -> Result<(), Failure> {
    cli.build();
    let Some(folder) = folder else {
        let page = page_of(&cli)?;
        return Ok(print(String::from_utf8_lossy(&page).trim_end())?);
    };
    make_folder(folder)?;
    let mut pages = Vec::new();
    collect(&cli, &mut pages)?;
    for (path, page) in pages {
        Output::new(&folder.join(path), None, "")?.write_bytes(&page)?;
    }
    Ok(())
}

/// The pages of a command and of all below it.
fn collect(command: &clap::Command, pages: &mut Vec<(PathBuf, Vec<u8>)>) -> Result<(), Failure> {
    let name = Man::new(command.clone()).get_filename();
    pages.push((name.into(), page_of(command)?));
    // A page of `help` would say what `--help` says.
    let below = command.get_subcommands();
    for command in below.filter(|command| command.get_name() != "help") {
        collect(command, pages)?;
    }
    Ok(())
}

fn page_of(command: &clap::Command) -> Result<Vec<u8>, Failure> {
    let version = env!("CARGO_PKG_VERSION");
    let man = Man::new(command.clone()).source(format!("cusp {version}"));
    let mut page = Vec::new();
    man.render(&mut page).map_err(|error| error.to_string())?;
    page.flush().map_err(|error| error.to_string())?;
    Ok(page)
}
