//! The command line: one file a subcommand. Arguments become options, options go into one call, its outcome becomes
//! words and an exit code. Only here is anything printed.

mod common;
mod compare;
mod completions;
mod detect;
mod measure;
mod progress;
mod render;
mod run;
mod sample;
mod scale;
mod validate;

use clap::{CommandFactory, Parser, Subcommand};
use common::Common;
use std::process::ExitCode;

const ABOUT: &str =
    "Finds the cones in images of the human retina, measures their mosaic, compares it with point samplers";

const AFTER: &str = "\
Start with:
  conemosaic run FOLDER --out report     the whole job, for a folder of PNG or TIFF images
  conemosaic COMMAND --help              what a command does, with an example

Exit codes: 0 all done; 1 nothing done (wrong arguments, no input, no place to write);
2 done, but some files failed: they are listed in failures.csv with their reasons.";

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
    Run(run::Run),
    Detect(detect::Detect),
    Measure(measure::Measure),
    Compare(compare::Compare),
    Validate(validate::Validate),
    Sample(sample::Sample),
    Render(render::Render),
    Completions(completions::Completions),
}

/// How a command ended.
enum Done {
    /// Everything was done.
    Completely,
    /// Some files failed and are listed.
    WithFailures,
}

impl Done {
    fn with<T>(failures: &[T]) -> Self {
        if failures.is_empty() { Self::Completely } else { Self::WithFailures }
    }
}

/// Runs the program.
pub fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(message) => {
            // a broken pipe is the reader's choice
            let _ = message.print();
            return if message.use_stderr() { ExitCode::from(1) } else { ExitCode::SUCCESS };
        }
    };
    let common = &cli.common;
    let result = common.apply().and_then(|()| match cli.command {
        Command::Run(command) => command.execute(common),
        Command::Detect(command) => command.execute(common),
        Command::Measure(command) => command.execute(common),
        Command::Compare(command) => command.execute(common),
        Command::Validate(command) => command.execute(common),
        Command::Sample(command) => command.execute(common),
        Command::Render(command) => command.execute(common),
        Command::Completions(command) => command.execute(&mut Cli::command()),
    });
    match result {
        Ok(Done::Completely) => ExitCode::SUCCESS,
        Ok(Done::WithFailures) => ExitCode::from(2),
        Err(error) => {
            let words = format!("{error:#}");
            eprintln!("error: {}", words.split_whitespace().collect::<Vec<_>>().join(" "));
            ExitCode::from(1)
        }
    }
}
