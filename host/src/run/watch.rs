//! `watch`: what the host waits for, and what the operator should do about it; each reported once when it
//! starts, and once when it is over.

use crate::Host;
use crate::config::TeamConfig;
use crate::referee::Silence;
use protocol::{Duration, Instant};

use super::inbox::Source;

/// A source is given this long after the start: messages come within 2 s, and a source that is there has had
/// time to send.
const START_TIME: Duration = Duration::millis(1_000);
/// Camera frames that arrive after a longer pause are reported; their absence is an alarm
/// ([`super::alarms`]).
const VISION_SILENT_AFTER: Duration = Duration::millis(1_000);
/// Robots take this long to boot where they are processes of ours.
const ROBOTS_BOOT_TIME: Duration = Duration::millis(1_500);

/// Which source was received when, and what was reported of it.
#[derive(Debug)]
pub(super) struct Watch {
    vision: Waiting,
    referee: Waiting,
    robots: Waiting,
    tracker: Waiting,
    /// What is missing now, for the page.
    missing: Vec<String>,
    link_advice: String,
}

/// A source that may be missing.
#[derive(Debug, Default)]
struct Waiting {
    announced: bool,
    ever: bool,
    /// How it is received, or why it cannot be.
    via: String,
}

impl Waiting {
    /// A message where a source becomes missing or returns.
    fn see(
        &mut self,
        missing: bool,
        wait: impl FnOnce(&Self) -> String,
        here: impl FnOnce() -> String,
    ) -> Option<String> {
        if missing {
            return (!std::mem::replace(&mut self.announced, true)).then(|| wait(self));
        }
        let changed = std::mem::take(&mut self.announced) || !self.ever;
        self.ever = true;
        changed.then(here)
    }
}

impl Watch {
    pub(super) fn new(link_advice: String) -> Self {
        let [vision, referee, robots, tracker] = <[Waiting; 4]>::default();
        Self { vision, referee, robots, tracker, missing: Vec::new(), link_advice }
    }

    /// A source is now received on `via`.
    pub(super) fn open(&mut self, source: Source, via: &str) {
        self.of(source).via = format!("received on {via}");
    }

    /// A source cannot be received, with the reason.
    pub(super) fn trouble(&mut self, source: Source, reason: &str) -> String {
        reason.clone_into(&mut self.of(source).via);
        format!("{}: {reason}; it is tried again", source.name())
    }

    /// How vision is received, or why it cannot be.
    pub(super) fn vision_path(&self) -> &str {
        &self.vision.via
    }

    /// This is missing too, once sources have had time to send.
    pub(super) fn misses(&mut self, now: Instant, what: Option<String>) {
        self.missing.extend(what.filter(|_| now.0 >= START_TIME.0));
    }

    /// What is missing now, each in a sentence.
    pub(super) fn missing(&self) -> &[String] {
        &self.missing
    }

    fn of(&mut self, source: Source) -> &mut Waiting {
        match source {
            Source::Vision => &mut self.vision,
            Source::Referee => &mut self.referee,
            Source::Robots => &mut self.robots,
            Source::Tracker => &mut self.tracker,
        }
    }

    /// Reports which sources became missing or returned.
    pub(super) fn look(&mut self, now: Instant, host: &Host, config: &TeamConfig, lines: &mut Vec<String>) {
        if now.0 < START_TIME.0 {
            return;
        }
        self.missing.clear();
        let silent = host.last_camera_frame().is_none_or(|last| now.since(last) > VISION_SILENT_AFTER);
        let came =
            self.vision.see(silent, |_| String::new(), || format!("vision comes from {}", config.vision));
        lines.extend(came.filter(|line| !line.is_empty()));
        let silence = host.listener().silence(now);
        let waits = format!(
            "waiting for the referee at {} ({}): robots halt until then; is the game controller running and publishing \
             there (--referee)?",
            config.referee, self.referee.via
        );
        let never = matches!(silence, Silence::Never(_));
        self.missing.extend(never.then(|| waits.clone()));
        // A source that falls silent is an alarm.
        let came = self.referee.see(
            !matches!(silence, Silence::Received(_)),
            |_| if never { waits } else { String::new() },
            || {
                format!(
                    "the referee is received: {}",
                    host.listener().source().map_or_else(String::new, ToString::to_string)
                )
            },
        );
        lines.extend(came.filter(|line| !line.is_empty()));
        let there: Vec<_> = host.radio().present(now).map(|robot| robot.number().to_string()).collect();
        if !there.is_empty() || now.0 >= ROBOTS_BOOT_TIME.0 {
            let waits = format!("waiting for robots: none is received; {}", self.link_advice);
            self.missing.extend(there.is_empty().then(|| waits.clone()));
            lines.extend(self.robots.see(
                there.is_empty(),
                |_| waits,
                || format!("robots are received: {}", there.join(" ")),
            ));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_is_reported_once_and_so_is_that_it_came() {
        let mut waiting = Waiting::default();
        let mut see = |missing| waiting.see(missing, |_| "waits".to_owned(), || "came".to_owned());
        assert_eq!(see(true).as_deref(), Some("waits"));
        assert_eq!(see(true), None);
        assert_eq!(see(false).as_deref(), Some("came"));
        assert_eq!(see(false), None);
        assert_eq!(see(true).as_deref(), Some("waits"));
    }

    #[test]
    fn what_is_there_from_the_start_is_reported_too() {
        let mut waiting = Waiting::default();
        assert_eq!(waiting.see(false, |_| String::new(), || "came".to_owned()).as_deref(), Some("came"));
    }
}
