use crate::cli::{one_line, remedies, signals};
use conemosaic::batch::{BatchError, Progress};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::Write;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Wrapper of another display of progress, for every batch of the command line.
///
/// It stops the batch on Ctrl-C or SIGTERM, and names in every error the options that remedy it.
pub struct Watched(pub Box<dyn Progress>);

impl Progress for Watched {
    fn begin(&self, total: usize) {
        self.0.begin(total);
    }

    fn done(&self, name: &str, outcome: Result<&str, &str>) {
        self.0.done(name, outcome);
    }

    fn end(&self) {
        self.0.end();
    }

    fn stopped(&self) -> bool {
        signals::received().is_some()
    }

    fn words(&self, error: &BatchError) -> String {
        remedies::words(error)
    }
}

/// Progress bar on a terminal, with the failures printed above it.
pub struct Bar(ProgressBar);

impl Bar {
    /// Returns a bar that stays hidden until the batch begins.
    pub fn new() -> Self {
        Self(ProgressBar::hidden())
    }
}

impl Progress for Bar {
    fn begin(&self, total: usize) {
        self.0.set_draw_target(indicatif::ProgressDrawTarget::stderr());
        self.0.set_length(total as u64);
        if let Ok(style) =
            ProgressStyle::with_template("{bar:32} {pos}/{len}  {per_sec}  {eta} left  {wide_msg}")
        {
            self.0.set_style(style);
        }
    }

    fn done(&self, name: &str, outcome: Result<&str, &str>) {
        match outcome {
            Ok(line) => self.0.set_message(one_line(&format!("{name}: {line}"))),
            Err(reason) => self.0.println(one_line(&format!("failed: {reason}"))),
        }
        self.0.inc(1);
    }

    fn end(&self) {
        self.0.finish_and_clear();
    }
}

/// Progress as one line per file, for logs.
pub struct Lines {
    /// Number of files in the batch.
    total: AtomicUsize,
    /// Number of files that are finished, with or without success.
    done: AtomicUsize,
}

impl Lines {
    /// Returns the display for a batch that has not begun.
    pub const fn new() -> Self {
        Self { total: AtomicUsize::new(0), done: AtomicUsize::new(0) }
    }
}

impl Progress for Lines {
    fn begin(&self, total: usize) {
        self.total.store(total, Ordering::Relaxed);
    }

    fn done(&self, name: &str, outcome: Result<&str, &str>) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        let total = self.total.load(Ordering::Relaxed);
        let line = match outcome {
            Ok(line) => format!("[{done}/{total}] {name}: {line}"),
            Err(reason) => format!("[{done}/{total}] failed: {reason}"),
        };
        let _ = writeln!(std::io::stderr(), "{}", one_line(&line));
    }

    fn end(&self) {}
}

/// Progress that prints nothing but the files that failed.
pub struct Failures;

impl Progress for Failures {
    fn begin(&self, _total: usize) {}

    fn done(&self, _name: &str, outcome: Result<&str, &str>) {
        if let Err(reason) = outcome {
            let _ = writeln!(std::io::stderr(), "{}", one_line(&format!("failed: {reason}")));
        }
    }

    fn end(&self) {}
}

/// Progress bar for the steps of one long task, on a terminal only.
pub struct Steps(ProgressBar);

impl Steps {
    /// Returns a bar on standard error, hidden if that is not a terminal.
    pub fn shown() -> Self {
        let bar = ProgressBar::with_draw_target(None, indicatif::ProgressDrawTarget::stderr());
        if let Ok(style) = ProgressStyle::with_template("{bar:32} step {pos} of at most {len}  {elapsed}") {
            bar.set_style(style);
        }
        Self(bar)
    }

    /// Returns a bar that is never shown.
    pub fn hidden() -> Self {
        Self(ProgressBar::hidden())
    }

    /// Moves the bar to step number `step` of at most `of` steps.
    pub fn at(&self, step: usize, of: usize) {
        self.0.set_length(of as u64);
        self.0.set_position(step as u64);
    }

    /// Takes the bar off the terminal.
    pub fn end(&self) {
        self.0.finish_and_clear();
    }
}
