//! `watch`: what the host waits for, and what the operator should do about it; each reported once when it
//! begins, and once when it is over.

use host::Host;
use host::config::TeamConfig;
use host::referee::Silence;
use protocol::{Duration, Instant};

use super::threads::Source;

/// A source is given this long after the start: words come within 2 s, and not before what is there had a chance.
const AT_START: Duration = Duration::millis(1_000);
/// Vision that is silent longer is told of: every robot brakes for want of pictures after half a second.
const VISION_SILENT: Duration = Duration::millis(1_000);
/// Robots take this long to boot where they are processes of ours.
const ROBOTS_BOOT: Duration = Duration::millis(1_500);

/// Who was heard when, and what was said of it.
#[derive(Debug)]
pub(super) struct Watch {
    vision: Waiting,
    referee: Waiting,
    robots: Waiting,
    last_vision: Option<Instant>,
    link_advice: String,
}

/// One thing that may be missing.
#[derive(Debug, Default)]
struct Waiting {
    told: bool,
    ever: bool,
    /// How it is heard, or why it cannot be.
    way: String,
}

impl Waiting {
    /// Words where something begins or ends to be missing.
    fn see(
        &mut self,
        missing: bool,
        wait: impl FnOnce(&Self) -> String,
        here: impl FnOnce() -> String,
    ) -> Option<String> {
        if missing {
            return (!std::mem::replace(&mut self.told, true)).then(|| wait(self));
        }
        let news = std::mem::take(&mut self.told) || !self.ever;
        self.ever = true;
        news.then(here)
    }
}

impl Watch {
    pub(super) fn new(link_advice: String) -> Self {
        let [vision, referee, robots] = <[Waiting; 3]>::default();
        Self { vision, referee, robots, last_vision: None, link_advice }
    }

    /// A source is heard this way now.
    pub(super) fn open(&mut self, source: Source, way: &str) {
        self.of(source).way = format!("heard on {way}");
    }

    /// A source cannot be heard, because.
    pub(super) fn trouble(&mut self, source: Source, words: &str) -> String {
        words.clone_into(&mut self.of(source).way);
        format!("{}: {words}; it is tried again", source.name())
    }

    /// Vision came.
    pub(super) fn vision_came(&mut self, now: Instant) {
        self.last_vision = Some(now);
    }

    fn of(&mut self, source: Source) -> &mut Waiting {
        match source {
            Source::Vision => &mut self.vision,
            Source::Referee => &mut self.referee,
            Source::Robots => &mut self.robots,
        }
    }

    /// What has begun or ended to be missing.
    pub(super) fn look(&mut self, now: Instant, host: &Host, config: &TeamConfig, words: &mut Vec<String>) {
        if now.0 < AT_START.0 {
            return;
        }
        let silent = self.last_vision.is_none_or(|last| now.since(last) > VISION_SILENT);
        words.extend(self.vision.see(
            silent,
            |vision| {
                format!(
                    "waiting for vision at {} ({}): is SSL-Vision or a simulator running, and sends it there? \
                     Cameras send to 224.5.23.2:10006, simulators to 224.5.23.2:10020 (--vision); `onetwo simulate` is one",
                    config.vision, vision.way
                )
            },
            || format!("vision comes from {}", config.vision),
        ));
        let silence = host.listener().silence(now);
        words.extend(self.referee.see(
            !matches!(silence, Silence::Heard(_)),
            |referee| {
                let stands = if referee.ever { "what it said last stands" } else { "robots halt until then" };
                format!(
                    "waiting for the referee at {} ({}): {stands}; is the game controller running, and publishes it there \
                     (--referee)?",
                    config.referee, referee.way
                )
            },
            || format!("the referee is heard: {}", host.listener().source().map_or_else(String::new, ToString::to_string)),
        ));
        let there: Vec<_> = host.radio().present(now).map(|robot| robot.number().to_string()).collect();
        if !there.is_empty() || now.0 >= ROBOTS_BOOT.0 {
            let advice = &self.link_advice;
            words.extend(self.robots.see(
                there.is_empty(),
                |_| format!("waiting for robots: none is heard; {advice}"),
                || format!("robots are heard: {}", there.join(" ")),
            ));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_is_told_once_and_so_is_that_it_came() {
        let mut waiting = Waiting::default();
        let mut see = |missing| waiting.see(missing, |_| "waits".to_owned(), || "came".to_owned());
        assert_eq!(see(true).as_deref(), Some("waits"));
        assert_eq!(see(true), None);
        assert_eq!(see(false).as_deref(), Some("came"));
        assert_eq!(see(false), None);
        assert_eq!(see(true).as_deref(), Some("waits"));
    }

    #[test]
    fn what_is_there_from_the_start_is_told_too() {
        let mut waiting = Waiting::default();
        assert_eq!(waiting.see(false, |_| String::new(), || "came".to_owned()).as_deref(), Some("came"));
    }
}
