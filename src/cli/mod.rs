//! The command line: one file a subcommand. Arguments become options, options go into one call, its outcome becomes
//! words and an exit code. Only here is anything printed.

mod agree;
mod args;
mod compare;
mod completions;
mod detect;
mod measure;
mod metrics;
mod mosaic_args;
mod paper;
mod remedies;
mod render;
mod run;
mod sample;
mod signals;
mod validate;

use args::Common;
use clap::error::ErrorKind;
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use conemosaic::batch::{BatchError, Ending};
use conemosaic::report::{counted, table};
use std::io::Write;
use std::process::ExitCode;

const ABOUT: &str =
    "Finds the cones in images of the human retina, measures their mosaic, compares it with point samplers";

const AFTER: &str = "\
Start with:
  conemosaic run FOLDER --out report     the whole job, for a folder of PNG or TIFF images
  conemosaic COMMAND --help              what a command does, with an example

Exit codes: 0 all done; 1 nothing done (wrong arguments, no input, no place to write);
2 some or all files failed: they are listed in failures.csv with their reasons;
130, 143 stopped by Ctrl-C or SIGTERM: the same command goes on.";

#[derive(Parser)]
#[command(name = "conemosaic", version, about = ABOUT, after_help = AFTER, max_term_width = 110)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    #[command(flatten)]
    common: Common,
}

#[derive(Subcommand)]
enum Command {
    Run(Box<run::Run>),
    Detect(detect::Detect),
    Measure(Box<measure::Measure>),
    Compare(Box<compare::Compare>),
    Validate(Box<validate::Validate>),
    Agree(agree::Agree),
    Sample(sample::Sample),
    Render(Box<render::Render>),
    Paper(paper::Paper),
    Metrics(metrics::Metrics),
    Completions(completions::Completions),
}

/// How a command ended.
enum Done {
    /// Everything was done.
    Completely,
    /// Some files failed and are listed.
    WithFailures,
    /// A signal of this number stopped it.
    Stopped(u8),
}

impl Done {
    /// How a batch ended.
    fn of<T>(failures: &[T], ending: &Ending) -> Self {
        match (ending.stopped(), signals::received()) {
            (true, Some(signal)) => Self::Stopped(signal),
            _ if failures.is_empty() => Self::Completely,
            _ => Self::WithFailures,
        }
    }
}

/// What a person should know about the end of a batch of `total` files; empty if there is nothing.
fn ending_words(ending: &Ending, total: usize) -> String {
    let mut lines = Vec::new();
    if ending.stopped() {
        let done = total - ending.left.min(total);
        lines.push(format!("Stopped after {done} of {total} files: run the same command again to go on"));
    }
    let leftovers = &ending.leftovers;
    if !leftovers.moved.is_empty() {
        let files = counted(leftovers.moved.len(), "file");
        let place = leftovers.place.display();
        lines.push(format!(
            "{files} of earlier results that this run does not have, or that were changed: moved to {place}"
        ));
    }
    if !leftovers.foreign.is_empty() {
        let names = leftovers.foreign.join(", ");
        lines.push(format!("Not of this run, and left where they are: {names}"));
    }
    lines.join("\n")
}

/// Runs the program.
pub fn main() -> ExitCode {
    let parsed = command().try_get_matches().and_then(|matches| Cli::from_arg_matches(&matches));
    let cli = match parsed {
        Ok(cli) => cli,
        Err(message) => return say_usage(&message),
    };
    let common = &cli.common;
    let result = common.apply().and_then(|()| match cli.command {
        Command::Run(command) => command.execute(common),
        Command::Detect(command) => command.execute(common),
        Command::Measure(command) => command.execute(common),
        Command::Compare(command) => command.execute(common),
        Command::Validate(command) => command.execute(common),
        Command::Agree(command) => command.execute(common),
        Command::Sample(command) => command.execute(common),
        Command::Paper(command) => command.execute(common),
        Command::Render(command) => command.execute(common),
        Command::Metrics(command) => command.execute(common),
        Command::Completions(command) => command.execute(&mut self::command()),
    });
    match result {
        Ok(Done::Completely) => ExitCode::SUCCESS,
        Ok(Done::WithFailures) => ExitCode::from(2),
        Ok(Done::Stopped(signal)) => ExitCode::from(128 + signal),
        Err(error) => {
            complain(&said_once(&error));
            ExitCode::from(1)
        }
    }
}

/// The arguments. A negative number after an option is its value, so that the error says which values there are.
fn command() -> clap::Command {
    let may_be_negative = |arg: clap::Arg| {
        let takes_value = !arg.is_positional() && arg.get_action().takes_values();
        if takes_value { arg.allow_negative_numbers(true) } else { arg }
    };
    Cli::command().mut_args(may_be_negative).mut_subcommands(|command| command.mut_args(may_be_negative))
}

/// Help as it is; what is wrong with the arguments in one line.
fn say_usage(message: &clap::Error) -> ExitCode {
    if !message.use_stderr() || message.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        // a broken pipe is the reader's choice
        let _ = message.print();
        return if message.use_stderr() { ExitCode::from(1) } else { ExitCode::SUCCESS };
    }
    let text = message.to_string();
    let text = text.split("\nUsage:").next().unwrap_or_default();
    let text = text.split("\nFor more information").next().unwrap_or_default();
    let text = text
        .trim()
        .trim_start_matches("error: ")
        .split("\n\n")
        .filter(|part| !part.trim_start().starts_with("tip: to pass"))
        .collect::<Vec<_>>()
        .join("; ")
        .replace("invalid digit found in string", "expected a whole number, 0 or more")
        .replace("invalid float literal", "expected a number");
    let named = std::env::args().skip(1).find(|word| Cli::command().find_subcommand(word).is_some());
    let help = named.map_or("conemosaic --help".to_owned(), |name| format!("conemosaic {name} --help"));
    complain(&format!("{text} (see {help})"));
    ExitCode::from(1)
}

/// The error and its causes; those that a message has already told are not told again.
fn said_once(error: &anyhow::Error) -> String {
    let mut text = String::new();
    let words = |cause: &(dyn std::error::Error + 'static)| match cause.downcast_ref::<BatchError>() {
        Some(error) => remedies::words(error),
        None => cause.to_string(),
    };
    for cause in error.chain().map(words) {
        if text.is_empty() {
            text = cause;
        } else if !text.contains(&cause) {
            text = format!("{text}: {cause}");
        }
    }
    text
}

fn complain(text: &str) {
    let _ = writeln!(std::io::stderr(), "error: {}", one_line(text));
}

/// What file names hold must neither break the line nor steer the terminal.
fn one_line(text: &str) -> String {
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    words.chars().map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c }).collect()
}

/// More rows than these are for the file.
const MOST_ROWS: usize = 24;

/// The first rows of a table, and where the others are.
fn short_table(headers: &[&str], rows: &[Vec<String>], file: &str) -> String {
    let mut text = table(headers, &rows[..rows.len().min(MOST_ROWS)]);
    if rows.len() > MOST_ROWS {
        text.push_str(&format!("\n… and {} more in {file}", rows.len() - MOST_ROWS));
    }
    text
}

/// Files whose warnings are told on the terminal.
const MOST_WARNED: usize = 5;

/// The warnings of the first files that have any, and where the others are; empty without.
fn warnings_table<'a>(warned: impl Iterator<Item = (&'a str, &'a [String])>, file: &str) -> String {
    let warned: Vec<(&str, &[String])> = warned.filter(|(_, warnings)| !warnings.is_empty()).collect();
    let mut text = String::new();
    for (name, warnings) in warned.iter().take(MOST_WARNED) {
        for warning in *warnings {
            text.push_str(&format!(
                "\n! {}",
                one_line(&remedies::with_options(&format!("{name}: {warning}")))
            ));
        }
    }
    if warned.len() > MOST_WARNED {
        let more = counted(warned.len() - MOST_WARNED, "file");
        text.push_str(&format!("\n! … and {more} more with warnings: column warnings of {file}"));
    }
    text
}
