//! Has somebody pressed Ctrl-C, or asked the program to end (SIGTERM)? Whoever runs for long looks now and then, and ends in order;
//! a second time ends it at once.

use std::sync::atomic::AtomicBool;
use std::sync::{Arc, LazyLock};

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// Turns true at the first Ctrl-C or SIGTERM from now on.
pub(crate) fn stopped_by_hand() -> &'static AtomicBool {
    static STOPPED: LazyLock<Arc<AtomicBool>> = LazyLock::new(|| {
        let stopped = Arc::new(AtomicBool::new(false));
        for signal in [SIGINT, SIGTERM] {
            // Where no handler can be set a signal does what it did before. The order matters: the first signal finds the flag down.
            let _ = flag::register_conditional_shutdown(signal, 128 + signal, stopped.clone())
                .and_then(|_| flag::register(signal, stopped.clone()));
        }
        stopped
    });
    &STOPPED
}
