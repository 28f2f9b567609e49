//! Ctrl-C and SIGTERM: the first one asks the batch to stop after the files in hand, a second one
//! ends the program at once.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, LazyLock};

static SIGNAL: LazyLock<Arc<AtomicUsize>> = LazyLock::new(Arc::default);

/// Begins to listen.
pub fn listen() {
    let asked = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        // in this order: the default action is armed by the flag that the first signal sets. Without
        // them a signal ends the program as it always did, and the next run goes on from there.
        let _ = flag::register_conditional_default(signal, Arc::clone(&asked));
        let _ = flag::register(signal, Arc::clone(&asked));
        if let Ok(number) = usize::try_from(signal) {
            let _ = flag::register_usize(signal, Arc::clone(&SIGNAL), number);
        }
    }
}

/// The number of the signal that asked the program to stop; `None` if there was none.
pub fn received() -> Option<u8> {
    match SIGNAL.load(Ordering::Relaxed) {
        0 => None,
        number => u8::try_from(number).ok(),
    }
}
