use super::progress::{Bar, Failures, Lines, Steps, Watched};
use crate::cli::signals;
use anyhow::{Context, Result};
use clap::Args;
use conemosaic::batch::Progress;
use std::io::{IsTerminal, Write};

/// What means the same for every command.
#[derive(Args)]
pub struct Common {
    /// Seed of everything random: the same seed gives the same output
    #[arg(long, global = true, value_name = "N", default_value_t = 1, help_heading = "Common options")]
    pub seed: u64,
    /// Cores to use [default: all]; the output is the same for any number
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), help_heading = "Common options")]
    pub threads: Option<u16>,
    /// Print errors and failed files only
    #[arg(long, short, global = true, help_heading = "Common options")]
    pub quiet: bool,
    /// Print diagnostics (-v what is done, -vv how long it takes)
    #[arg(long, short, global = true, action = clap::ArgAction::Count, conflicts_with = "quiet", help_heading = "Common options")]
    pub verbose: u8,
}

impl Common {
    /// Sets up threads and diagnostics.
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

    /// A bar on a terminal, lines elsewhere, failures only if quiet.
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

    /// A bar for one long task; none if quiet.
    pub fn steps(&self) -> Steps {
        if self.quiet { Steps::hidden() } else { Steps::shown() }
    }

    /// Prints unless quiet. A reader that stops listening (`| head`) is no error.
    pub fn say(&self, text: &str) {
        if !self.quiet && !text.is_empty() {
            let _ = writeln!(std::io::stdout(), "{text}");
        }
    }
}
