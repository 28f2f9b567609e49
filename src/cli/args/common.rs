use super::progress::{Bar, Failures, Lines, Steps, Watched};
use crate::cli::signals;
use anyhow::{Context, Result};
use clap::Args;
use conemosaic::batch::Progress;
use std::io::{IsTerminal, Write};

/// Options that mean the same in every command.
#[derive(Args)]
pub struct Common {
    /// Seed of the random numbers
    ///
    /// A whole number, 0 or more. The same seed gives the same output.
    #[arg(long, global = true, value_name = "N", default_value_t = 1, help_heading = "Common options")]
    pub seed: u64,
    /// Number of processor cores to use (1–1024) [default: all]
    ///
    /// The output is the same for any number.
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), help_heading = "Common options")]
    pub threads: Option<u16>,
    /// Print nothing but errors and the files that failed
    #[arg(long, short, global = true, help_heading = "Common options")]
    pub quiet: bool,
    /// Print diagnostics: -v lists the steps, -vv also their times
    #[arg(long, short, global = true, action = clap::ArgAction::Count, conflicts_with = "quiet", help_heading = "Common options")]
    pub verbose: u8,
}

impl Common {
    /// Sets the number of threads and the level of diagnostics.
    ///
    /// # Errors
    /// Fails if the threads cannot be started.
    pub fn apply(&self) -> Result<()> {
        let level = match self.verbose {
            0 => tracing::Level::ERROR,
            1 => tracing::Level::DEBUG,
            _ => tracing::Level::TRACE,
        };
        tracing_subscriber::fmt()
            .with_max_level(level)
            .with_writer(std::io::stderr)
            .with_ansi(std::io::stderr().is_terminal())
            .without_time()
            .init();
        if let Some(threads) = self.threads {
            rayon::ThreadPoolBuilder::new()
                .num_threads(usize::from(threads))
                .build_global()
                .context("cannot start the threads asked for")?;
        }
        Ok(())
    }

    /// Returns the display of progress for a batch, and starts to catch signals.
    ///
    /// Progress is shown as a bar on a terminal and as one line per file elsewhere; with `--quiet`
    /// only failures are shown. From the call on, Ctrl-C and SIGTERM stop the batch instead of the
    /// program.
    pub fn progress(&self) -> Box<dyn Progress> {
        signals::listen();
        let shown: Box<dyn Progress> = if self.quiet {
            Box::new(Failures)
        } else if std::io::stderr().is_terminal() {
            Box::new(Bar::new())
        } else {
            Box::new(Lines::new())
        };
        Box::new(Watched(shown))
    }

    /// Returns a progress bar for one long task; it stays hidden with `--quiet`.
    pub fn steps(&self) -> Steps {
        if self.quiet { Steps::hidden() } else { Steps::shown() }
    }

    /// Prints a text to standard output, unless the text is empty or `--quiet` is set.
    ///
    /// A closed pipe (`| head`) is not an error.
    pub fn say(&self, text: &str) {
        if !self.quiet && !text.is_empty() {
            let _ = writeln!(std::io::stdout(), "{text}");
        }
    }
}
