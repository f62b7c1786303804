//! `stop`: Ctrl-C and SIGTERM. Long-running verbs poll the flag, and end in order; a second signal ends the
//! program at once.

use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, LazyLock};

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// The signals that end a program in order.
const SIGNALS: [(i32, &str); 2] = [(SIGINT, "Ctrl-C (SIGINT)"), (SIGTERM, "SIGTERM")];

/// Number of the received signal; 0 before.
static WHICH: LazyLock<Arc<AtomicUsize>> = LazyLock::new(Arc::default);

/// The signal's name and the exit code of a program that it ended in order: 128 and its number, as shells
/// count; `None` without a signal.
pub(crate) fn signal() -> Option<(&'static str, ExitCode)> {
    let came = WHICH.load(Ordering::Relaxed);
    let (signal, name) = SIGNALS.into_iter().find(|(signal, _)| *signal as usize == came)?;
    Some((name, ExitCode::from(128 + signal as u8)))
}

/// Becomes true at the first Ctrl-C or SIGTERM from now on.
pub(crate) fn stopped_by_hand() -> &'static AtomicBool {
    static STOPPED: LazyLock<Arc<AtomicBool>> = LazyLock::new(|| {
        let stopped = Arc::new(AtomicBool::new(false));
        for (signal, _) in SIGNALS {
            // If no handler can be set a signal keeps its default action. The order matters: at the first
            // signal the flag is still false.
            let _ = flag::register_conditional_shutdown(signal, 128 + signal, stopped.clone())
                .and_then(|_| flag::register_usize(signal, WHICH.clone(), signal as usize))
                .and_then(|_| flag::register(signal, stopped.clone()));
        }
        stopped
    });
    &STOPPED
}
