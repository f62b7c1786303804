//! `terminal`: lines and status for the operator, printed by a thread of their own: a terminal that is
//! stopped (Ctrl-S, a full pipe) must not stop the thread that controls robots. What does not fit into
//! [`LINES_MAX`] is dropped and counted.

use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use crate::output::note;
use crate::progress::Progress;

/// Lines that wait for the terminal.
const LINES_MAX: usize = 256;
/// A terminal that does not take the last lines in this time is not waited for.
const AT_END: Duration = Duration::from_secs(1);

enum Print {
    Line(String),
    Status(String),
}

pub(super) struct Terminal {
    prints: SyncSender<Print>,
    thread: JoinHandle<()>,
    dropped: u64,
}

impl Terminal {
    pub(super) fn open() -> Self {
        let (prints, waiting) = sync_channel(LINES_MAX);
        Self { prints, thread: thread::spawn(move || print(&waiting)), dropped: 0 }
    }

    pub(super) fn line(&mut self, line: String) {
        let line = match self.dropped {
            0 => line,
            dropped => {
                format!("{line}\n{dropped} lines before this one were dropped: the terminal took none")
            }
        };
        match self.prints.try_send(Print::Line(line)) {
            Ok(()) => self.dropped = 0,
            Err(_) => self.dropped += 1,
        }
    }

    /// Prints the line that is replaced by the next of its kind.
    pub(super) fn status(&self, line: String) {
        let _ = self.prints.try_send(Print::Status(line));
    }

    pub(super) fn close(self) {
        drop(self.prints);
        let until = Instant::now() + AT_END;
        while !self.thread.is_finished() && Instant::now() < until {
            thread::sleep(Duration::from_millis(5));
        }
    }
}

fn print(waiting: &Receiver<Print>) {
    let bar = Progress::open();
    for print in waiting {
        match print {
            Print::Line(line) => bar.aside(|| note!("{line}")),
            Print::Status(line) => bar.set_text(line),
        }
    }
}
