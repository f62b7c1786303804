//! `telemeter`: what the robot sends about itself: beacons (docs/architecture.md §5.1) and, where a host
//! leads, telemetry (docs/architecture.md §6.1).

use geometry::{Field, Vector};
use protocol::host::{Condition, Telemetry};
use protocol::quantized::length_to_mm;
use protocol::robot_io::SensorFrame;
use protocol::team::{BallQuality, BallReport, Beacon, Role, Status};
use protocol::{Duration, Instant, RobotId};

use super::Brain;
use crate::governor::{LimitReason, Ruling};

/// What was sent last, and when.
#[derive(Clone, Debug, Default)]
pub(super) struct Spoken {
    beacon: Option<Instant>,
    /// When a part of a decision was sent.
    explained: Option<Instant>,
    /// Step counter, wrapping: see [`Spoken::has_turn`].
    steps: u8,
    telemetry: Option<(Instant, Condition)>,
    /// The host that leads has not yet received telemetry that names it.
    new_host: bool,
    /// What the body reported last.
    battery: Option<f32>,
    contact: bool,
    kicker_ready: bool,
    tipped: bool,
    /// When more packets were left unopened than a team sends.
    flooded: Option<Instant>,
    /// Beacons left unopened, less [`BEACONS_OF_STEP`] for each step.
    unopened: u8,
}

impl Spoken {
    pub(super) fn sense(&mut self, sensors: &SensorFrame) {
        self.battery = sensors.health.battery;
        self.contact = sensors.ball_contact;
        self.kicker_ready = sensors.health.kicker_ready;
        self.tipped = sensors.health.tipped;
    }

    /// Counts a step; returns whether it is this robot's turn, which comes every `every` steps. Teammates
    /// have different turns by their numbers: simultaneous frames collide, and five beacons in one step take
    /// long to open.
    pub(super) fn has_turn(&mut self, robot: RobotId, every: u8) -> bool {
        self.steps = (self.steps + 1) % every;
        self.unopened = self.unopened.saturating_sub(BEACONS_OF_STEP);
        usize::from(self.steps) == robot.index() % usize::from(every)
    }

    /// Requests telemetry that names the host which has welcomed this robot.
    pub(super) fn owes_telemetry(&mut self) {
        self.new_host = true;
    }

    /// Telemetry is due, whether or not something has changed.
    pub(super) fn is_silent_for_long(&self, now: Instant) -> bool {
        self.telemetry.is_none_or(|(last, _)| now.since(last) >= TELEMETRY_PERIOD)
    }

    pub(super) fn beacon(&mut self, now: Instant) {
        self.beacon = Some(now);
    }

    /// A packet was left unopened: a flood, unless it is a beacon or a part of a snapshot, and no more came
    /// than a team sends.
    pub(super) fn leave_unopened(&mut self, now: Instant, is_usual: bool) {
        self.unopened = self.unopened.saturating_add(u8::from(is_usual));
        if !is_usual || self.unopened > BEACONS_AT_ONCE {
            self.flooded = Some(now);
        }
    }

    pub(super) fn explained(&mut self, now: Instant) {
        self.explained = Some(now);
    }

    /// Whether this step has a message already: sealing costs time, and the next step comes soon.
    pub(super) fn spoke_at(&self, now: Instant) -> bool {
        let telemetry = self.telemetry.map(|(at, _)| at);
        [self.beacon, telemetry, self.explained].contains(&Some(now))
    }
}

impl Brain<'_> {
    /// How well this robot knows the ball; a robot led by a host does not tell.
    fn ball_quality(&self, now: Instant, velocity: Vector<Field>) -> BallQuality {
        if cfg!(feature = "legged") && self.host.is_none() && self.belief.ball_sigma > 0.0 {
            BallQuality::new(self.belief.ball_sigma, self.belief.ball_age(now), velocity)
        } else {
            BallQuality::default()
        }
    }

    pub(super) fn beacon(&self, now: Instant) -> Beacon {
        let mut status = Status::default();
        if self.awake && self.was_available {
            status = status.with(Status::AVAILABLE);
        }
        if self.config.retriever {
            status = status.with(Status::RETRIEVER);
        }
        if self.belief.holds_ball {
            status = status.with(Status::HOLDS_BALL);
        }
        if cfg!(feature = "legged")
            && let Some(execution) = &self.execution
        {
            status = status.with_shot(execution.shot_rule());
        }
        Beacon {
            pose: self.belief.pose.into(),
            ball: self.belief.ball.map(|ball| BallReport {
                at: ball.position.into(),
                distance: length_to_mm(ball.position.distance(self.belief.pose.position)),
                quality: self.ball_quality(now, ball.velocity),
            }),
            status,
            case_base: self.base.hash(),
            cycle: self.cycle.state().cloned(),
            progress: self.cycle.progress,
            role: if self.execution.is_some() { Role::None } else { self.reactive.role() },
        }
    }

    /// Telemetry for the host, if due: ten times a second, and at once when something changes.
    pub(super) fn telemetry(&mut self, now: Instant) -> Option<Telemetry> {
        let arrived = self.host.as_ref()?.arrived();
        let reasons = self.actuation.reasons();
        let spoken = &self.spoken;
        let condition = [
            (spoken.contact, Condition::BALL_CONTACT),
            (spoken.kicker_ready, Condition::KICKER_READY),
            (spoken.tipped, Condition::TIPPED),
            (self.actuation.is_battery_low(), Condition::BATTERY_LOW),
            (self.actuation.ruling() != Ruling::Allowed, Condition::GOVERNED),
            (reasons.has(LimitReason::Silence), Condition::LINK_LOST),
            (spoken.flooded.is_some_and(|last| now.since(last) < FLOODED_FOR), Condition::FLOODED),
        ];
        let set = |all: Condition, (holds, bit): (bool, Condition)| if holds { all.with(bit) } else { all };
        let condition = condition.into_iter().fold(Condition::default(), set);
        // One message a step: sealing costs time, and the next step comes soon.
        let spoke_now = spoken.beacon == Some(now);
        let due = !spoke_now
            && (spoken.is_silent_for_long(now)
                || spoken.telemetry.is_some_and(|(last, reported)| {
                    let changed = reported != condition || spoken.new_host;
                    changed && now.since(last) >= TELEMETRY_LEAST
                }));
        if !due {
            return None;
        }
        (self.spoken.telemetry, self.spoken.new_host) = (Some((now, condition)), false);
        // In 0.1 ms: the host computes its round trips from it.
        let silence = arrived.map_or(u64::MAX, |last| now.since(last).0 / 100);
        let battery = self.spoken.battery.map_or(0.0, |volts| volts * 100.0);
        Some(Telemetry {
            condition,
            battery: battery.clamp(0.0, f32::from(u16::MAX)) as u16,
            silence: silence.min(u64::from(u16::MAX)) as u16,
            // The link fills in its own counters.
            ..Telemetry::default()
        })
    }
}

/// The robot reports a flooded radio for so long after it has left too many packets unopened.
const FLOODED_FOR: Duration = Duration::millis(1_000);
/// Beacons of a step of 10 ms: ten teammates, the most of a league, send twenty each a second.
const BEACONS_OF_STEP: u8 = 2;
/// Beacons and handshakes at once, when all ten teammates tell of a change of their cycle, twice.
const BEACONS_AT_ONCE: u8 = 20;
/// Period of the telemetry: ten times a second.
const TELEMETRY_PERIOD: Duration = Duration::millis(100);
/// But not in every step while something toggles, as a break-beam sensor does.
const TELEMETRY_LEAST: Duration = Duration::millis(20);

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a flood is reported where this number of beacons is left unopened in each of 100 steps.
    fn is_flooded(beacons: u8) -> bool {
        let mut spoken = Spoken::default();
        for step in 0..100 {
            spoken.has_turn(RobotId::ZERO, 5);
            for _ in 0..beacons {
                spoken.leave_unopened(Instant(step * 10_000), true);
            }
        }
        spoken.flooded.is_some()
    }

    #[test]
    fn beacons_that_teammates_send_are_no_flood_and_more_of_them_are() {
        assert!(!is_flooded(BEACONS_OF_STEP) && is_flooded(BEACONS_OF_STEP + 1) && is_flooded(12));
        let mut spoken = Spoken::default();
        (0..BEACONS_AT_ONCE).for_each(|_| spoken.leave_unopened(Instant(0), true));
        assert_eq!(spoken.flooded, None, "all teammates tell of a change at once");
        spoken.leave_unopened(Instant(0), false);
        assert_eq!(spoken.flooded, Some(Instant(0)), "a command that no step had time for");
    }
}
