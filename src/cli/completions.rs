use super::Done;
use anyhow::Result;
use clap::Args;
use clap_complete::{Shell, generate};

/// Examples for the end of the help.
const HELP: &str = include_str!("help/completions.txt").trim_ascii_end();

/// Prints a script that completes commands and options in a shell
///
/// The script goes to the terminal; redirect it to the file where your shell looks for completions.
/// After that, the tabulator key completes the commands and options of conemosaic.
#[derive(Args)]
#[command(after_help = HELP)]
pub struct Completions {
    /// Shell to print the script for
    shell: Shell,
}

impl Completions {
    /// Prints the script for `command`, which describes the complete command line.
    ///
    /// # Errors
    /// Never fails; the return type is that of the other commands.
    pub fn execute(self, command: &mut clap::Command) -> Result<Done> {
        let mut text = Vec::new();
        generate(self.shell, command, "conemosaic", &mut text);
        // a closed pipe, as in `| head`, is not an error
        let _ = std::io::Write::write_all(&mut std::io::stdout(), &text);
        Ok(Done::Completely)
    }
}
