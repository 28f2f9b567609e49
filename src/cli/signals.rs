//! Ctrl-C and SIGTERM: the first signal asks the batch to stop after the files that are being
//! worked on, a second one ends the program at once.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, LazyLock};

/// Number of the first signal that arrived, such as 2 for SIGINT, or 0 if none has arrived.
///
/// It lies in an [`Arc`] because the signal handler keeps a reference of its own.
static SIGNAL: LazyLock<Arc<AtomicUsize>> = LazyLock::new(Arc::default);

/// Starts to catch SIGINT (Ctrl-C) and SIGTERM.
pub fn listen() {
    let asked = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        // The order matters: the first signal sets the flag, and the flag makes the next signal do
        // its default action. Errors are ignored: without these handlers a signal ends the program
        // at once, and the next run continues from there.
        let _ = flag::register_conditional_default(signal, Arc::clone(&asked));
        let _ = flag::register(signal, Arc::clone(&asked));
        if let Ok(number) = usize::try_from(signal) {
            let _ = flag::register_usize(signal, Arc::clone(&SIGNAL), number);
        }
    }
}

/// Returns the number of the signal that asked the program to stop, or `None` without a signal.
pub fn received() -> Option<u8> {
    match SIGNAL.load(Ordering::Relaxed) {
        0 => None,
        number => u8::try_from(number).ok(),
    }
}
