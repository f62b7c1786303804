//! `alarms`: faults that an operator should act on now, for terminal and page. Each is printed at once, and
//! again every [`REPEAT_AFTER`] while it lasts. Times on the host's clock.

use crate::Host;
use crate::health_checks::{Finding, HealthChecks};
use protocol::{Duration, Instant};

use super::inbox::Dropped;

/// An alarm that lasts is printed again after this.
const REPEAT_AFTER: Duration = Duration::millis(10_000);
/// A robot that was missing for longer than this counts as a new one.
const FORGOTTEN_AFTER: Duration = Duration::millis(10_000);
/// Drops and the line's lateness are displayed for this long after the last one.
const SHOWN_FOR: Duration = Duration::millis(3_000);

/// Something that is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Alarm {
    /// What the alarm is about: its text changes with the figures, this key does not.
    matter: String,
    text: String,
    /// It is printed again while it lasts.
    repeats: bool,
}

/// Current faults, and when each was printed.
#[derive(Debug, Default)]
pub(super) struct Alarms {
    health_checks: HealthChecks,
    printed: Vec<(String, Instant, Instant)>,
    dropped: Dropped,
    /// What was dropped recently, and until when that is displayed.
    drops: Vec<(&'static str, u64, Instant)>,
    slow: Option<(String, Instant)>,
    bad_answer: Option<(String, Instant)>,
    now: Vec<String>,
}

impl Alarms {
    /// Records that the host's loop runs: if more than 100 ms have passed, this computer was blocked.
    pub(super) fn ran(&mut self, now: Instant) {
        self.health_checks.ran(now);
    }

    /// Records that the robots' line is too slow.
    pub(super) fn slow(&mut self, now: Instant, text: String) {
        self.slow = Some((text, now));
    }

    /// Records that an answer of the team's own strategy was refused.
    pub(super) fn bad_answer(&mut self, now: Instant, text: String) {
        self.bad_answer = Some((text, now));
    }

    /// Current faults, for the page.
    pub(super) fn now(&self) -> &[String] {
        &self.now
    }

    /// Checks all alarms; returns the lines to print. `vision` is where vision is received.
    pub(super) fn look(
        &mut self,
        now: Instant,
        host: &Host,
        dropped: Dropped,
        vision: impl Fn() -> String,
    ) -> Vec<String> {
        let mut alarms: Vec<_> = (host.listener().warnings(now).iter())
            .map(|warning| Alarm {
                matter: warning.matter(),
                text: format!("referee  {warning}"),
                repeats: warning.is_urgent(),
            })
            .collect();
        alarms.extend(self.health_checks.look(now, host).into_iter().map(|finding| Alarm {
            matter: finding.matter(),
            text: match finding {
                Finding::VisionPort(_) => format!("vision   {finding} [{}]", vision()),
                _ => format!("{:<8} {finding}", finding.heading()),
            },
            repeats: finding.is_urgent(),
        }));
        alarms.extend(self.drops(now, dropped));
        for (matter, fault) in [("line", &self.slow), ("strategy", &self.bad_answer)] {
            let lasting = fault.as_ref().filter(|(_, at)| now.since(*at) < SHOWN_FOR);
            alarms.extend(lasting.map(|(text, _)| Alarm {
                matter: matter.to_owned(),
                text: text.clone(),
                repeats: true,
            }));
        }
        self.print(now, alarms)
    }

    fn drops(&mut self, now: Instant, dropped: Dropped) -> Vec<Alarm> {
        let before = std::mem::replace(&mut self.dropped, dropped);
        let changes = [
            (
                "vision packets came faster than they can be used; the oldest were dropped",
                dropped.vision,
                before.vision,
            ),
            (
                "referee packets came faster than they can be used; the oldest were dropped",
                dropped.referee,
                before.referee,
            ),
            (
                "frames of robots came faster than they can be used; the oldest were dropped",
                dropped.robots,
                before.robots,
            ),
            (
                "datagrams on vision's port were longer than vision sends, and refused",
                dropped.vision_oversized,
                before.vision_oversized,
            ),
            (
                "datagrams on the referee's port were longer than it sends, and refused",
                dropped.referee_oversized,
                before.referee_oversized,
            ),
        ];
        for (what, after, before) in changes.into_iter().filter(|(_, after, before)| after > before) {
            match self.drops.iter_mut().find(|(known, ..)| *known == what) {
                Some((_, number, at)) => (*number, *at) = (*number + (after - before), now),
                None => self.drops.push((what, after - before, now)),
            }
        }
        self.drops.retain(|(_, _, at)| now.since(*at) < SHOWN_FOR);
        let alarm = |(what, number, _): &(&str, u64, Instant)| Alarm {
            matter: (*what).to_owned(),
            text: format!("network  {number} {what}; does another program flood the port?"),
            repeats: true,
        };
        self.drops.iter().map(alarm).collect()
    }

    fn print(&mut self, now: Instant, alarms: Vec<Alarm>) -> Vec<String> {
        self.printed.retain(|(_, seen, _)| now.since(*seen) < FORGOTTEN_AFTER);
        self.now = alarms.iter().map(|alarm| alarm.text.clone()).collect();
        let mut lines = Vec::new();
        for Alarm { matter, text, repeats } in alarms {
            if let Some((_, seen, last)) = self.printed.iter_mut().find(|(known, ..)| *known == matter) {
                *seen = now;
                if repeats && now.since(*last) >= REPEAT_AFTER {
                    *last = now;
                    lines.push(text);
                }
            } else {
                self.printed.push((matter, now, now));
                lines.push(text);
            }
        }
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn alarm(repeats: bool) -> Vec<Alarm> {
        vec![Alarm { matter: "m".into(), text: "w".into(), repeats }]
    }

    #[test]
    fn an_alarm_is_printed_at_once_and_again_while_it_lasts() {
        let mut alarms = Alarms::default();
        let printed = |alarms: &mut Alarms, from: u64, repeats| {
            let times = (from..from + 35_000).step_by(100).map(Instant).map(|now| Instant(now.0 * 1_000));
            times.map(|now| alarms.print(now, alarm(repeats)).len()).sum::<usize>()
        };
        assert_eq!(printed(&mut alarms, 0, true), 4, "at 0, 10, 20 and 30 s");
        assert_eq!(alarms.now(), ["w"]);
        assert!(alarms.print(Instant(36_000_000), vec![]).is_empty() && alarms.now().is_empty());
        assert_eq!(printed(&mut alarms, 50_000, false), 1);
    }

    #[test]
    fn drops_are_counted_up_while_they_go_on() {
        let mut alarms = Alarms::default();
        let dropped = |vision| Dropped { vision, ..Dropped::default() };
        assert_eq!(alarms.drops(Instant(0), dropped(0)).len(), 0);
        alarms.drops(Instant(100_000), dropped(5));
        let now = alarms.drops(Instant(200_000), dropped(12));
        assert!(now[0].text.contains("12 vision packets came faster than they can be used"), "{now:?}");
        assert!(alarms.drops(Instant(200_000) + SHOWN_FOR, dropped(12)).is_empty());
    }
}
