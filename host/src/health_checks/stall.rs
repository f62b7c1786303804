//! `stall`: distinction of stalls of this computer, of vision and of the radio. A stall of one appears as a
//! stall of the others: a computer that does not run receives nothing, and without vision the host sends
//! nothing after half a second. So they are checked in this order.

use protocol::{Duration, Instant};
use thiserror::Error;

use crate::Host;
use crate::radio::Radio;

/// The host's loop wakes at least every 100 ms; at twice that, robots brake.
const HOST_STALL: Duration = Duration::millis(200);
/// After a stall of the computer queued packets are received within this time.
const CATCH_UP_TIME: Duration = Duration::millis(300);
/// Twenty camera frames; teams report blackouts of 0.2 s, which the host bridges.
const VISION_STALL: Duration = Duration::millis(300);
/// A robot sends beacons at 20 Hz and telemetry at 10 Hz.
const RADIO_STALL: Duration = Duration::millis(300);
/// Robots not received for this time were switched off.
const SWITCHED_OFF: Duration = Duration::millis(10_000);
/// Robots brake at 100 ms; telemetry that reports more than twice that is no single gap.
const DOWN_STALL: Duration = Duration::millis(250);
/// Older telemetry is out of date; it comes at 10 Hz.
const TELEMETRY_NEW: Duration = Duration::millis(250);
/// Snapshots go out at 60 Hz or more.
const SNAPSHOT_GAP_MAX: Duration = Duration::millis(50);
/// Robots that receive nothing are a stall of the radio once snapshots have gone out for this time:
/// [`DOWN_STALL`] and the age of telemetry.
const SENT_FOR_MIN: Duration = Duration::millis(DOWN_STALL.0 / 1_000 + TELEMETRY_NEW.0 / 1_000);
/// A stall that is over is reported for this time, so that it can be read.
const REPORTED_FOR: Duration = Duration::millis(3_000);

/// A stall, and its duration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Stall {
    /// This computer did not run the host.
    #[error(
        "host stall: this computer did not run the host for {:.1} s, robots brake after 0.1 s; close other programs, and switch \
         power saving and sleep off",
        lasted.as_secs_f32()
    )]
    Host {
        /// Duration of the stall, now over.
        lasted: Duration,
    },
    /// No camera frame comes though the computer runs.
    #[error(
        "vision stall: no camera frame for {:.1} s while this computer and the radio go on, robots brake after 0.6 s; look at \
         SSL-Vision, its cameras and the network cable",
        since.as_secs_f32()
    )]
    Vision {
        /// Since the last one, or since the computer runs again.
        since: Duration,
    },
    /// No robot is received, though at least one was, the computer runs and vision comes.
    #[error(
        "radio stall: no robot is received for {:.1} s while this computer and vision go on; look at the base station, its cable \
         and power, and the channel",
        since.as_secs_f32()
    )]
    RadioUp {
        /// Since the last frame of any of them.
        since: Duration,
    },
    /// Robots are received and none receives us, though snapshots go out.
    #[error(
        "radio stall: robots are received but none receives us for {:.1} s, they brake after 0.1 s; look at the base station's \
         sender, and for another sender on the channel",
        since.as_secs_f32()
    )]
    RadioDown {
        /// The shortest time for which one of them received nothing.
        since: Duration,
    },
}

impl Stall {
    /// Place of the stall: `host`, `vision` or `radio`.
    pub const fn place(&self) -> &'static str {
        match self {
            Self::Host { .. } => "host",
            Self::Vision { .. } => "vision",
            Self::RadioUp { .. } | Self::RadioDown { .. } => "radio",
        }
    }
}

/// Times at which host, vision and radio ran.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Stalls {
    ran: Option<Instant>,
    /// Time for which the computer did not run, and since when it runs again.
    host: Option<(Duration, Instant)>,
    /// Since when snapshots have gone out without a pause.
    sends_since: Option<Instant>,
    /// The last stall, and until when it is reported.
    current: Option<(Stall, Instant)>,
}

/// Times of the newest frames.
#[derive(Clone, Copy, Debug, Default)]
struct Last {
    /// Arrival of the newest camera frame.
    frame: Option<Instant>,
    /// The newest frame of any robot.
    robot: Option<Instant>,
    /// The newest snapshot that went out.
    sent: Option<Instant>,
    /// Shortest time for which a robot with new telemetry had received nothing.
    unheard: Option<Duration>,
}

impl Last {
    fn of(host: &Host, now: Instant) -> Self {
        let radio = host.radio();
        let received = protocol::RobotId::all().filter_map(|id| radio.quality(id));
        Self {
            frame: host.last_camera_frame(),
            robot: received.filter_map(crate::radio::Quality::received_at).max(),
            sent: radio.transmitted(),
            unheard: unheard(radio, now),
        }
    }
}

fn unheard(radio: &Radio, now: Instant) -> Option<Duration> {
    let reported = radio.present(now).filter_map(|id| radio.quality(id)?.telemetry());
    let new = reported.filter(|(at, reported)| now.since(*at) < TELEMETRY_NEW && reported.received > 0);
    new.map(|(at, reported)| Duration(u64::from(reported.silence) * 100 + now.since(*at).0)).min()
}

impl Stalls {
    /// The host's loop runs now.
    pub(super) fn ran(&mut self, now: Instant) {
        if let Some(last) = self.ran.replace(now)
            && now.since(last) >= HOST_STALL
        {
            self.host = Some((now.since(last), now));
        }
    }

    pub(super) fn look(&mut self, now: Instant, host: &Host) -> Option<Stall> {
        self.see(now, &Last::of(host, now))
    }

    fn see(&mut self, now: Instant, last: &Last) -> Option<Stall> {
        let sends = last.sent.is_some_and(|at| now.since(at) < SNAPSHOT_GAP_MAX) && self.runs_again(now);
        self.sends_since = sends.then(|| self.sends_since.unwrap_or(now));
        if let Some(stall) = self.goes_on(now, last) {
            self.current = Some((stall, now + REPORTED_FOR));
        }
        self.current.filter(|(_, until)| now < *until).map(|(stall, _)| stall)
    }

    /// Whether the computer runs, and for long enough after its last stall.
    fn runs_again(&self, now: Instant) -> bool {
        self.host.is_none_or(|(_, since)| now.since(since) >= CATCH_UP_TIME)
    }

    /// The stall that persists now.
    fn goes_on(&self, now: Instant, last: &Last) -> Option<Stall> {
        // Packets queued during a stall of the computer come at once after it.
        let runs_since = self.host.map_or(Instant(0), |(_, since)| since);
        if let Some((lasted, _)) = self.host.filter(|_| !self.runs_again(now)) {
            return Some(Stall::Host { lasted });
        }
        let since = |at: Instant| now.since(at.max(runs_since));
        if let Some(frame) = last.frame
            && since(frame) >= VISION_STALL
        {
            return Some(Stall::Vision { since: since(frame) });
        }
        if let Some(robot) = last.robot
            && since(robot) >= RADIO_STALL
            && since(robot) < SWITCHED_OFF
        {
            return Some(Stall::RadioUp { since: since(robot) });
        }
        let long = self.sends_since.is_some_and(|since| now.since(since) >= SENT_FOR_MIN);
        let unheard = last.unheard.filter(|silent| silent.0 >= DOWN_STALL.0 && long);
        unheard.map(|since| Stall::RadioDown { since })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The stall reported every 100 ms of 20 s, if the given part stalls from 5 s to `until`, ms.
    fn current(until: u64, still: &str) -> Vec<(u64, Option<Stall>)> {
        let mut stalls = Stalls::default();
        let mut current = Vec::new();
        let (mut last, mut count) = (Last::default(), 0);
        for ms in (0..20_000).step_by(10) {
            let now = Instant(ms * 1_000);
            let stands = |what: &str| still == what && (5_000..until).contains(&ms);
            if stands("host") {
                continue;
            }
            stalls.ran(now);
            let quiet = last.frame.is_some_and(|at| now.since(at).0 > 500_000);
            if !stands("vision") && !stands("all") {
                last.frame = Some(now);
            }
            if !stands("up") && !stands("radio") {
                last.robot = Some(now);
            }
            if !quiet {
                last.sent = Some(now);
            }
            // Telemetry comes every 100 ms; between, its last report stays valid.
            let silent = last.sent.map_or(0, |at| now.since(at).0) / 1_000;
            let silent = if stands("down") { ms - 5_000 } else { silent };
            if ms.is_multiple_of(100) {
                count = silent;
            } else {
                count += 10;
            }
            last.unheard = (!stands("up") && !stands("radio")).then_some(Duration::millis(count));
            if ms.is_multiple_of(100) {
                current.push((ms, stalls.see(now, &last)));
            }
        }
        current
    }

    #[test]
    fn each_stall_is_found_within_half_a_second_and_no_other_with_it() {
        for (still, place, description) in [
            ("host", "host", "this computer did not run"),
            ("vision", "vision", "no camera frame"),
            ("up", "radio", "no robot is received"),
            ("radio", "radio", "no robot is received"),
            ("down", "radio", "none receives us"),
        ] {
            let current = current(7_000, still);
            let count: Vec<_> = current.iter().filter_map(|(ms, stall)| Some((*ms, (*stall)?))).collect();
            let first = count[0].0;
            let latest = if still == "host" { 7_000 } else { 5_500 };
            assert!((5_000..=latest).contains(&first), "{still}: {first} ms");
            for (ms, stall) in &count {
                assert!(
                    stall.place() == place && stall.to_string().contains(description),
                    "{still}, {ms}: {stall}"
                );
            }
            assert!(count.last().unwrap().0 <= 10_500, "{still}: it is over");
        }
    }

    #[test]
    fn gaps_of_150_ms_are_no_stall() {
        for still in ["host", "vision", "up", "radio", "down"] {
            assert!(current(5_150, still).iter().all(|(_, stall)| stall.is_none()), "{still}");
        }
    }

    #[test]
    fn robots_that_are_switched_off_are_no_stall_for_ever() {
        let current = current(20_000, "radio");
        assert!(current.iter().any(|(ms, stall)| *ms < 6_000 && stall.is_some()));
        assert!(current.iter().all(|(ms, stall)| *ms < 18_500 || stall.is_none()));
    }
}
