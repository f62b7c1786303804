//! Has somebody pressed Ctrl-C? Whoever runs for long looks now and then, and ends in order; a second time ends it at once.

use std::sync::atomic::{AtomicBool, Ordering};

/// Turns true at the first Ctrl-C from now on.
pub(crate) fn stopped_by_hand() -> &'static AtomicBool {
    static STOPPED: AtomicBool = AtomicBool::new(false);
    // Where no handler can be set, or one is there already, Ctrl-C does what it did before.
    let _ = ctrlc::try_set_handler(|| {
        if STOPPED.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    });
    &STOPPED
}
