//! `progress`: how far long work is, on one line of a terminal's stderr and nowhere else.

use std::fmt::Write as _;
use std::io::{self, IsTerminal as _, Write as _};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use feed::recording::ReadObserver;

use crate::output::note;

/// Time between two drawings: more often than this an eye sees nothing new.
const REDRAW_EVERY: Duration = Duration::from_millis(100);
/// Width of a bar, characters.
const BAR_WIDTH: u64 = 40;

/// A line that is drawn over itself, and goes when this is dropped.
#[derive(Debug)]
pub(crate) struct Progress(Mutex<Line>);

#[derive(Debug)]
struct Line {
    visible: bool,
    prefix: String,
    unit: &'static str,
    done: u64,
    of: Option<u64>,
    /// When and from where the work of this run started: what an earlier run did does not predict how long
    /// the rest takes.
    start: (Instant, u64),
    drawn: Option<Instant>,
}

impl Progress {
    /// Of work whose end is not known, or not yet.
    pub(crate) fn open() -> Self {
        Self::new("", None)
    }

    /// Of that many steps, which are called `unit`.
    pub(crate) fn of(steps: u64, unit: &'static str) -> Self {
        Self::new(unit, Some(steps))
    }

    /// A line that is never drawn.
    pub(crate) fn silent() -> Self {
        let progress = Self::open();
        progress.line().visible = false;
        progress
    }

    fn new(unit: &'static str, of: Option<u64>) -> Self {
        let (visible, start) = (io::stderr().is_terminal(), (Instant::now(), 0));
        Self(Mutex::new(Line { visible, prefix: String::new(), unit, done: 0, of, start, drawn: None }))
    }

    /// The text before the bar, or all of the line where the end is not known.
    pub(crate) fn set_text(&self, prefix: impl Into<String>) {
        let mut line = self.line();
        line.prefix = prefix.into();
        line.draw();
    }

    /// So many steps more are done.
    pub(crate) fn add(&self, steps: u64) {
        let mut line = self.line();
        line.done += steps;
        line.draw();
    }

    /// So many steps are done.
    pub(crate) fn reach(&self, done: u64) {
        let mut line = self.line();
        line.done = done;
        line.draw();
    }

    /// Sets the numbers of steps done and of all steps.
    pub(crate) fn set(&self, done: u64, of: u64) {
        let mut line = self.line();
        if line.of != Some(of) {
            line.start = (Instant::now(), done);
        }
        (line.done, line.of) = (done, Some(of));
        line.draw();
    }

    /// Does something that writes to the terminal, with the line cleared.
    pub(crate) fn aside<T>(&self, write: impl FnOnce() -> T) -> T {
        let mut line = self.line();
        line.clear();
        let written = write();
        line.draw();
        written
    }

    fn line(&self) -> MutexGuard<'_, Line> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl ReadObserver for Progress {
    fn record(&self) {
        self.add(1);
    }

    fn note(&self, line: &str) {
        self.aside(|| note!("{line}"));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.line().clear();
    }
}

impl Line {
    fn draw(&mut self) {
        let now = Instant::now();
        if !self.visible || self.drawn.is_some_and(|drawn| now.duration_since(drawn) < REDRAW_EVERY) {
            return;
        }
        self.drawn = Some(now);
        // Cut off at the terminal's edge: a second row would stay. A terminal that is gone is no loss.
        let _ = write!(io::stderr().lock(), "\r\x1b[K\x1b[?7l{}\x1b[?7h", self.text(now));
    }

    fn clear(&mut self) {
        if self.drawn.take().is_some() {
            let _ = write!(io::stderr().lock(), "\r\x1b[K");
        }
    }

    fn text(&self, now: Instant) -> String {
        let Some(of) = self.of else {
            return if self.prefix.is_empty() { self.done.to_string() } else { self.prefix.clone() };
        };
        let full = (BAR_WIDTH * self.done.min(of)).checked_div(of).unwrap_or(0) as usize;
        let bar = "█".repeat(full) + &"░".repeat(BAR_WIDTH as usize - full);
        let gap = if self.prefix.is_empty() { "" } else { " " };
        let mut text = format!("{}{gap}{bar} {}/{of}", self.prefix, self.done);
        if !self.unit.is_empty() {
            let _ = write!(text, " {}", self.unit);
        }
        let (start, before) = self.start;
        let steps = self.done.saturating_sub(before);
        if steps > 0 && of > self.done {
            let left = now.duration_since(start).as_secs_f64() * (of - self.done) as f64 / steps as f64;
            let _ = write!(text, ", {left:.0} s to go");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_reports_how_much_is_done_and_how_long_the_rest_takes() {
        let progress = Progress::of(8, "problems");
        let mut line = progress.line();
        line.visible = false;
        line.done = 4;
        line.start.1 = 2;
        let text = line.text(line.start.0 + Duration::from_secs(10));
        assert_eq!(text, format!("{}{} 4/8 problems, 20 s to go", "█".repeat(20), "░".repeat(20)));
        line.done = 8;
        assert!(line.text(Instant::now()).ends_with("8/8 problems"));
    }

    #[test]
    fn work_without_an_end_reports_its_steps_or_its_words() {
        let progress = Progress::open();
        progress.line().visible = false;
        progress.add(7);
        assert_eq!(progress.line().text(Instant::now()), "7");
        progress.set_text("80 packets a second");
        assert_eq!(progress.line().text(Instant::now()), "80 packets a second");
        let nothing = Progress::of(0, "");
        assert!(nothing.line().text(Instant::now()).ends_with("0/0"));
    }
}
