//! The command line as given, and errors of usage that clap's attributes cannot express.

use std::collections::HashSet;
use std::path::Path;
use std::sync::OnceLock;
use std::sync::atomic::Ordering;

use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{ArgMatches, Args, Command, FromArgMatches, Id};
use serde_json::Value;

use crate::failure::{Failed, IS_JSON, Problem, is_standard};
use crate::terminal::print_json;

/// Makes the whole command line, whose parts describe their usage. Set once, before it is parsed.
pub static COMMAND_LINE: OnceLock<fn() -> Command> = OnceLock::new();

/// The names of arguments that are on the command line. All others have their defaults, before which a file of settings goes.
pub struct Given(HashSet<String>);

impl Given {
    pub fn has(&self, name: &str) -> bool {
        self.0.contains(name)
    }

    /// Puts a value in place of another if it is not merely the default.
    pub fn put<T>(&self, name: &str, place: &mut T, value: T) {
        if self.has(name) {
            *place = value;
        }
    }
}

impl FromArgMatches for Given {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let names = matches.ids().map(Id::as_str);
        let given =
            names.filter(|name| matches.value_source(name) == Some(ValueSource::CommandLine));
        Ok(Self(given.map(str::to_owned).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for Given {
    fn augment_args(command: Command) -> Command {
        command
    }

    fn augment_args_for_update(command: Command) -> Command {
        command
    }
}

/// Exits with a usage error, for programs in JSON too, or with the help or version that was asked for.
pub fn exit(error: &clap::Error) -> ! {
    if error.use_stderr() && IS_JSON.load(Ordering::Relaxed) {
        let text = error.render().to_string();
        // The text after an empty line is for people: tips and the usage.
        let reason = text.split("\n\n").next().unwrap_or_default();
        let words: Vec<&str> = reason.split_whitespace().collect();
        let message = words.join(" ");
        let error = Problem {
            code: "usage".to_owned(),
            message: message
                .strip_prefix("error: ")
                .unwrap_or(&message)
                .to_owned(),
            detail: Value::Null,
            file: None,
        };
        let _ = print_json(&Failed { error });
    }
    error.exit()
}

/// Exits with a usage error of a command.
pub fn wrong_usage(command: &str, message: &str) -> ! {
    let make = COMMAND_LINE.get().expect("main sets it");
    let mut cli = make();
    cli.build();
    let command = cli.find_subcommand_mut(command);
    let command = command.expect("the command that was parsed");
    exit(&command.error(ErrorKind::ArgumentConflict, message))
}

/// Exits with a usage error if both a file and a report would go to standard output.
pub fn check_json(command: &str, output: Option<&Path>, json: bool) {
    if json && output.is_some_and(is_standard) {
        let message = "--json and -o - would both write to standard output; leave one of them out";
        wrong_usage(command, message);
    }
}
