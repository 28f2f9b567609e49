//! The command line, with one file per command.
//!
//! Each command turns its arguments into options, passes them to one function of the library, and
//! turns the outcome into printed text and an exit code. Nothing is printed anywhere else.

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
#[cfg(test)]
mod tests;
mod validate;

use args::Common;
use clap::error::ErrorKind;
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use conemosaic::batch::{BatchError, Ending};
use conemosaic::report::{counted, table};
use std::io::Write;
use std::process::ExitCode;

/// Description of the program at the top of its help.
const ABOUT: &str = "\
Finds cones in images of the human retina and measures their mosaic

Cones are cone photoreceptors. Images may be confocal or split-detector adaptive-optics \
ophthalmoscopy or histology. The mosaic is measured (density, spacing, regularity) and compared \
with samplers, which are models of random point patterns. Hand marks and the results of other \
programs can be measured and scored as well.";

/// First steps and exit codes, for the end of the help of the program.
const AFTER: &str = "\
First steps:
  conemosaic run FOLDER --out report
      finds, measures and reports the cones of all PNG and TIFF images in FOLDER
  conemosaic COMMAND -h
      lists the options of a command
  conemosaic COMMAND --help
      explains the command and its options in full, with examples

Exit codes:
  0         everything was done
  1         nothing was done: the arguments are wrong, there is no input, or
            results cannot be written
  2         some or all files failed; failures.csv lists them with the reasons
  130, 143  stopped by Ctrl-C (130) or SIGTERM (143); the same command given
            again continues";

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

/// Outcome of a command that did not end with an error.
enum Done {
    /// Everything that was asked for is done.
    Completely,
    /// Some files failed and are listed in the results.
    WithFailures,
    /// A signal with this number stopped the command.
    Stopped(u8),
}

impl Done {
    /// Returns the outcome of a batch: stopped by a signal, with `failures`, or complete.
    fn of<T>(failures: &[T], ending: &Ending) -> Self {
        match (ending.stopped(), signals::received()) {
            (true, Some(signal)) => Self::Stopped(signal),
            _ if failures.is_empty() => Self::Completely,
            _ => Self::WithFailures,
        }
    }
}

/// Describes for the user the end of a batch of `total` files.
///
/// The text is empty if all files were done and the folder of the results holds nothing from
/// elsewhere.
fn ending_words(ending: &Ending, total: usize) -> String {
    let mut lines = Vec::new();
    if ending.stopped() {
        let done = total - ending.left.min(total);
        lines.push(format!("Stopped after {done} of {total} files. Run the same command again to continue."));
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
        lines.push(format!("Files that are not of this run, left where they are: {names}"));
    }
    lines.join("\n")
}

/// Runs the program and returns its exit code.
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

/// Returns the description of the command line for clap.
///
/// A negative number after an option counts as the value of the option. The error then names the
/// values that are allowed, and does not complain of an unknown option.
fn command() -> clap::Command {
    let may_be_negative = |arg: clap::Arg| {
        let takes_value = !arg.is_positional() && arg.get_action().takes_values();
        if takes_value { arg.allow_negative_numbers(true) } else { arg }
    };
    Cli::command().mut_args(may_be_negative).mut_subcommands(|command| command.mut_args(may_be_negative))
}

/// Prints help and version as they are, and errors in the arguments as one line.
///
/// Returns the exit code.
fn say_usage(message: &clap::Error) -> ExitCode {
    if !message.use_stderr() || message.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        // a closed pipe, as in `| head`, is not an error
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

/// Returns the text of an error and its causes, without causes that the text already contains.
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

/// Prints an error as one line to standard error.
fn complain(text: &str) {
    let _ = writeln!(std::io::stderr(), "error: {}", one_line(text));
}

/// Returns a text as one line without control characters.
///
/// Texts contain file names, which may contain line breaks and escape sequences that would
/// otherwise reach the terminal.
fn one_line(text: &str) -> String {
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    words.chars().map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c }).collect()
}

/// Number of rows after which a printed table is cut, chosen by eye; the file has the other rows.
const MOST_ROWS: usize = 24;

/// Returns the first [`MOST_ROWS`] rows of a table, and a line that says which file holds the
/// others.
fn short_table(headers: &[&str], rows: &[Vec<String>], file: &str) -> String {
    let mut text = table(headers, &rows[..rows.len().min(MOST_ROWS)]);
    if rows.len() > MOST_ROWS {
        text.push_str(&format!("\n… and {} more in {file}", rows.len() - MOST_ROWS));
    }
    text
}

/// Number of files whose warnings are printed; those of further files are only counted.
const MOST_WARNED: usize = 5;

/// Returns the warnings of the first [`MOST_WARNED`] files that have any, one per line.
///
/// `warned` has the name and the warnings of each file. A last line says that the table `file` has
/// the other warnings. The text is empty if there are no warnings.
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
        text.push_str(&format!("\n! … and {more} more with warnings: see column warnings of {file}"));
    }
    text
}
