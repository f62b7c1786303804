//! `radio_alarms`: robots that refuse this host, or that it refuses, for terminal and page: at once, and
//! again every [`REPEAT_AFTER`] while it lasts. Times on the host's clock.

use crate::radio::{Radio, RadioWarning};
use protocol::{Duration, Instant};

/// A lasting problem is reported again after this.
const REPEAT_AFTER: Duration = Duration::millis(10_000);

/// What was reported, and when.
#[derive(Debug, Default)]
pub(super) struct RadioAlarms {
    message: Vec<(RadioWarning, Instant)>,
}

impl RadioAlarms {
    /// The lines to print now.
    pub(super) fn look(&mut self, now: Instant, radio: &Radio) -> Vec<String> {
        let current: Vec<RadioWarning> = radio.warnings(now).collect();
        self.message.retain(|(warning, at)| current.contains(warning) || now.since(*at) < REPEAT_AFTER);
        let mut lines = Vec::new();
        for warning in current {
            match self.message.iter_mut().find(|(known, _)| *known == warning) {
                Some((_, at)) if now.since(*at) < REPEAT_AFTER => continue,
                Some((_, at)) => *at = now,
                None => self.message.push((warning, now)),
            }
            let shell = warning.robot().map(|robot| (robot, radio.numbers().shell(robot)));
            let shell = shell.filter(|(robot, shell)| robot != shell);
            let shell =
                shell.map(|(robot, shell)| format!(" ({robot} is the radio number of shell {shell})"));
            lines.push(format!("radio    {warning}{}", shell.unwrap_or_default()));
        }
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radio::RadioSettings;
    use protocol::frame::TeamKey;
    use protocol::host::Telemetry;
    use protocol::link::Link;
    use protocol::team::TeamMessage;
    use protocol::{RobotId, TeamId};

    #[test]
    fn a_robot_that_follows_a_later_host_is_said_at_once_and_every_ten_seconds() {
        let (team, id) = (TeamId(2), RobotId::new(3).unwrap());
        let mut radio = Radio::new(RadioSettings::new(team, 70));
        let mut robot = Link::new(team, id, TeamKey::ZERO.of_robot(id), 5);
        let (mut alarms, mut message) = (RadioAlarms::default(), Vec::new());
        for n in 0..250_u64 {
            let now = Instant(n * 100_000);
            let telemetry = Telemetry { host: 71, ..Telemetry::default() };
            assert!(radio.handle_packet(now, &robot.seal(&TeamMessage::Telemetry(telemetry))).is_err());
            message.extend(alarms.look(now, &radio).into_iter().map(|description| (n, description)));
        }
        assert_eq!(message.iter().map(|(n, _)| *n).collect::<Vec<_>>(), [0, 100, 200]);
        assert!(
            message[0].1.contains("robot 3 refuses this host")
                && message[0].1.contains("set this computer's clock")
        );
    }
}
