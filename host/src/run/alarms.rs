//! `alarms`: faults that an operator should act on now, for terminal and page. Each is printed at once, and
//! again every [`REPEAT_AFTER`] while it lasts. Times on the host's clock.

use crate::Host;
use crate::health_checks::{Fault, Finding, HealthChecks, Since};
use crate::tracking::senders::SecondVision;
use protocol::{Duration, Instant};

use super::inbox::Dropped;

/// An alarm that lasts is printed again after this.
const REPEAT_AFTER: Duration = Duration::millis(10_000);
/// A robot that was missing for longer than this counts as a new one.
const FORGOTTEN_AFTER: Duration = Duration::millis(10_000);
/// Drops and the line's lateness are displayed for this long after the last one.
const SHOWN_FOR: Duration = Duration::millis(3_000);

/// Current faults, and when each was printed.
#[derive(Debug, Default)]
pub(super) struct Alarms {
    health_checks: HealthChecks,
    since: Since,
    /// Matter of a finding, when it was seen, and when it was printed.
    printed: Vec<(String, Instant, Instant)>,
    dropped: Dropped,
    /// What was dropped recently, and until when that is displayed.
    drops: Vec<(&'static str, u64, Instant)>,
    slow: Option<(String, Instant)>,
    now: Vec<Finding>,
}

impl Alarms {
    /// The alarms of a team of that name.
    pub(super) fn new(name: &str) -> Self {
        Self { health_checks: HealthChecks::default().of_team(name), ..Self::default() }
    }

    /// Records that the host's loop runs: if more than 100 ms have passed, this computer was blocked.
    pub(super) fn ran(&mut self, now: Instant) {
        self.health_checks.ran(now);
    }

    /// Records that the robots' line is too slow.
    pub(super) fn slow(&mut self, now: Instant, text: String) {
        self.slow = Some((text, now));
    }

    /// Current faults, for the page.
    pub(super) fn now(&self) -> &[Finding] {
        &self.now
    }

    /// Checks all alarms; returns the lines to print. `second`: another vision beside the one that is
    /// followed, `vision`: where vision is received, `missing`: sources that were never received, which are
    /// printed elsewhere.
    pub(super) fn look(
        &mut self,
        now: Instant,
        host: &Host,
        dropped: Dropped,
        second: Option<SecondVision>,
        (vision, missing): (&str, &[String]),
    ) -> Vec<String> {
        let mut faults: Vec<_> = host.listener().warnings(now).into_iter().map(Fault::Referee).collect();
        faults.extend(self.health_checks.look(now, host));
        faults.extend(second.map(Fault::SecondVision));
        faults.extend(self.drops(now, dropped));
        let slow = self.slow.as_ref().filter(|(_, at)| now.since(*at) < SHOWN_FOR);
        faults.extend(slow.map(|(text, _)| Fault::SlowLine(text.clone())));
        let mut findings = self.since.date(now, faults);
        let lines = self.print(now, &findings, vision);
        findings.extend(self.since.date(now, missing.iter().cloned().map(Fault::Missing).collect()));
        self.now = findings;
        lines
    }

    fn drops(&mut self, now: Instant, dropped: Dropped) -> Vec<Fault> {
        let before = std::mem::replace(&mut self.dropped, dropped);
        let changes = [
            ("vision packets", dropped.vision, before.vision),
            ("referee packets", dropped.referee, before.referee),
            ("frames of robots", dropped.robots, before.robots),
        ];
        for (what, after, before) in changes.into_iter().filter(|(_, after, before)| after > before) {
            match self.drops.iter_mut().find(|(known, ..)| *known == what) {
                Some((_, number, at)) => (*number, *at) = (*number + (after - before), now),
                None => self.drops.push((what, after - before, now)),
            }
        }
        self.drops.retain(|(_, _, at)| now.since(*at) < SHOWN_FOR);
        self.drops.iter().map(|(what, dropped, _)| Fault::Flood { what, dropped: *dropped }).collect()
    }

    /// The lines of findings that are new, or urgent and not printed for long; `vision`: where vision is
    /// received.
    fn print(&mut self, now: Instant, findings: &[Finding], vision: &str) -> Vec<String> {
        self.printed.retain(|(_, seen, _)| now.since(*seen) < FORGOTTEN_AFTER);
        let mut lines = Vec::new();
        for finding in findings {
            let line = match &finding.fault {
                Fault::VisionPort(_) => format!("{finding} [{vision}]"),
                _ => finding.to_string(),
            };
            let matter = finding.fault.matter();
            if let Some((_, seen, last)) = self.printed.iter_mut().find(|(known, ..)| *known == matter) {
                *seen = now;
                if finding.fault.is_urgent() && now.since(*last) >= REPEAT_AFTER {
                    *last = now;
                    lines.push(line);
                }
            } else {
                self.printed.push((matter, now, now));
                lines.push(line);
            }
        }
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_alarm_is_printed_at_once_and_again_while_it_lasts() {
        let mut alarms = Alarms::default();
        let urgent = Fault::SlowLine("w: x".into());
        let printed = |alarms: &mut Alarms, from: u64, fault: &Fault| {
            let times = (from..from + 35_000).step_by(100).map(Instant).map(|now| Instant(now.0 * 1_000));
            let print = |now| {
                let findings = alarms.since.date(now, vec![fault.clone()]);
                alarms.print(now, &findings, "").len()
            };
            times.map(print).sum::<usize>()
        };
        assert_eq!(printed(&mut alarms, 0, &urgent), 4, "at 0, 10, 20 and 30 s");
        let now = Instant(35_000_000);
        assert_eq!(alarms.since.date(now, vec![urgent])[0].since, Instant(0));
        assert!(alarms.print(Instant(36_000_000), &[], "").is_empty());
        assert_eq!(printed(&mut alarms, 50_000, &Fault::Missing("m".into())), 1);
    }

    #[test]
    fn drops_are_counted_up_while_they_go_on() {
        let mut alarms = Alarms::default();
        let dropped = |vision| Dropped { vision, ..Dropped::default() };
        assert_eq!(alarms.drops(Instant(0), dropped(0)).len(), 0);
        alarms.drops(Instant(100_000), dropped(5));
        let now = alarms.drops(Instant(200_000), dropped(12));
        assert!(
            now[0].to_string().contains("12 vision packets came faster than they can be used"),
            "{now:?}"
        );
        assert!(alarms.drops(Instant(200_000) + SHOWN_FOR, dropped(12)).is_empty());
    }
}
