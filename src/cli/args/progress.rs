use crate::cli::{one_line, remedies, signals};
use conemosaic::batch::{BatchError, Progress};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::Write;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Listens to signals, and adds to errors which options help.
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

/// A progress bar; failures scroll by above it.
pub struct Bar(ProgressBar);

impl Bar {
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

/// One line a file, for logs.
pub struct Lines {
    total: AtomicUsize,
    done: AtomicUsize,
}

impl Lines {
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

/// Failures only.
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

/// A bar for the steps of one long task, on a terminal only.
pub struct Steps(ProgressBar);

impl Steps {
    /// Shown on standard error, if that is a terminal.
    pub fn shown() -> Self {
        let bar = ProgressBar::with_draw_target(None, indicatif::ProgressDrawTarget::stderr());
        if let Ok(style) = ProgressStyle::with_template("{bar:32} step {pos} of at most {len}  {elapsed}") {
            bar.set_style(style);
        }
        Self(bar)
    }

    pub fn hidden() -> Self {
        Self(ProgressBar::hidden())
    }

    pub fn at(&self, step: usize, of: usize) {
        self.0.set_length(of as u64);
        self.0.set_position(step as u64);
    }

    pub fn end(&self) {
        self.0.finish_and_clear();
    }
}
