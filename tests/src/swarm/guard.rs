//! `guard`: safety monitor of a wheeled robot: its actuator orders against what it received and sensed, seen
//! from outside the brain (docs/architecture.md §6.2).
//!
//! The guard knows the packets delivered to a robot, which of them an [`Honest`] receiver accepts, its sensor
//! frames and its orders. Limits are the published ones; where a clock that runs 100 ppm off and ticks of 10
//! ms blur them, the robot has one tick more.
//!
//! | when | then |
//! |---|---|
//! | always | finite numbers, rims within 5 m/s, dribbler 0–1, kicks within 6.3 m/s and only where the phase permits one |
//! | no frame, or no command, for 100 ms; HALT or time-out received; odometry NaN; tipped; spinning; battery low for 1 s | brakes: not faster than before, stands within a second; dribbler off, kicker discharged |
//! | a silence of half a second, or a boot, less than half a second ago | brakes |
//! | no frame for 50 ms | the limit shrinks to zero at 100 ms |
//! | STOP for 2 s | 1.5 m/s |

use std::fmt;

use motion::omni::Omni;
use protocol::RobotId;
use protocol::host::HostMessage;
use protocol::robot_io::{ActuatorFrame, OmniKick, SensorFrame};
use rules::{Phase, Side};

use super::honest::{Believed, Honest};

/// Monitors one boot epoch of a wheeled robot.
#[derive(Debug)]
pub struct Guard {
    me: RobotId,
    /// The messages that it may accept.
    pub honest: Honest,
    booted_ms: u32,
    kinematics: Omni,
    /// Times, ms: the last frame, the last command, since when frames have come without a long silence.
    frame: Option<u32>,
    command: Option<u32>,
    good_since: Option<u32>,
    armed: bool,
    phase: Option<Phase<Side>>,
    stop_since: Option<u32>,
    low_since: Option<u32>,
    braking_since: Option<u32>,
    /// The last ordered speed and turning rate.
    last: (f32, f32),
}

/// Reason for which a robot must brake.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BrakeReason {
    /// The host has been silent.
    Silence,
    /// Frames have not come for half a second since a long silence or a boot.
    NotArmed,
    /// The host has sent no command to it.
    NoCommand,
    /// HALT or a time-out.
    Halt,
    /// A measurement is NaN.
    NotANumber,
    /// The robot lies on its side.
    Tipped,
    /// The robot turns too fast.
    Spinning,
    /// The battery is empty.
    Battery,
}

/// A forbidden order of a robot.
#[derive(Clone, Debug, PartialEq)]
pub enum Danger {
    /// An order outside every robot's limits.
    Absurd(ActuatorFrame),
    /// It did not brake though it had to.
    Unbraked(BrakeReason, ActuatorFrame),
    /// It accelerated while it had to brake: speed and turning before and now.
    Faster(BrakeReason, [f32; 4]),
    /// It had to brake for a second and still moves at this speed.
    Endless(BrakeReason, f32),
    /// The host has missed a few frames: the silence, ms, and the speed.
    Hesitant(u32, f32),
    /// The speed in STOP.
    Stop(f32),
    /// A kick that the phase does not permit.
    Kick(Option<Phase<Side>>),
}

impl fmt::Display for Danger {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Absurd(order) => write!(f, "an absurd order: {order:?}"),
            Self::Unbraked(why, order) => write!(f, "does not brake for {why:?}: {order:?}"),
            Self::Faster(why, [v, w, v2, w2]) => {
                write!(f, "brakes for {why:?}, but {v} m/s and {w} rad/s become {v2} and {w2}")
            }
            Self::Endless(why, speed) => {
                write!(f, "brakes for {why:?} for a second and still does {speed} m/s")
            }
            Self::Hesitant(ms, speed) => write!(f, "{speed} m/s after {ms} ms of silence"),
            Self::Stop(speed) => write!(f, "{speed} m/s in STOP"),
            Self::Kick(phase) => write!(f, "kicks in {phase:?}"),
        }
    }
}

impl Guard {
    /// A robot that boots at that moment, ms.
    pub fn new(me: RobotId, boot_epoch: u32, booted_ms: u32) -> Self {
        Self {
            me,
            honest: Honest::new(me, boot_epoch),
            booted_ms,
            kinematics: Omni::default(),
            frame: None,
            command: None,
            good_since: None,
            armed: false,
            phase: None,
            stop_since: None,
            low_since: None,
            braking_since: None,
            last: (0.0, 0.0),
        }
    }

    /// Whether it has received its host for long enough to move since the last long silence.
    pub fn is_armed(&self) -> bool {
        self.armed
    }

    /// Takes a message that it may accept at that moment.
    pub fn receive(&mut self, ms: u32, believed: &Believed) {
        let Believed::Host(message) = believed else { return };
        let phase = match message {
            HostMessage::World(part) => Some(part.phase),
            HostMessage::Command(command) if command.to == self.me => {
                self.command = Some(ms);
                Some(command.phase)
            }
            HostMessage::Command(_) => return,
            // It contains no game state, but shows that the host runs.
            HostMessage::Welcome(_) | HostMessage::Limits(_) => self.phase,
        };
        if phase != Some(Phase::Stop) {
            self.stop_since = None;
        } else if self.phase != Some(Phase::Stop) {
            self.stop_since = Some(ms);
        }
        self.phase = phase;
        if self.frame.is_none_or(|last| ms - last >= LONG_SILENCE + SLACK) {
            self.good_since = Some(ms);
        }
        self.frame = Some(ms);
    }

    /// Checks its order in the step that started at that moment, after all messages received in it.
    pub fn judge(&mut self, ms: u32, sensors: &SensorFrame, order: &ActuatorFrame) -> Result<(), Danger> {
        let (wheels, dribbler, kick) = match *order {
            ActuatorFrame::Omni { wheels, dribbler, kick } => (wheels, dribbler, kick),
            // Only a robot that stands, by its own measurement, may release its motors.
            ActuatorFrame::Released if sensors.odometry.linear.norm() < LETS_GO => {
                ([0.0; 4], 0.0, OmniKick::Discharge)
            }
            ActuatorFrame::Released | ActuatorFrame::Legged { .. } => return Err(Danger::Absurd(*order)),
        };
        let kick_speed = match kick {
            OmniKick::Flat(speed) | OmniKick::Chip(speed) => speed,
            OmniKick::None | OmniKick::Discharge => 0.0,
        };
        let sane = wheels.iter().all(|rim| rim.abs() <= RIM_MAX)
            && (0.0..=1.0).contains(&dribbler)
            && (0.0..=KICK_MAX).contains(&kick_speed);
        if !sane {
            return Err(Danger::Absurd(*order));
        }
        let reason = self.brake_reason(ms, sensors);
        let twist = self.kinematics.twist(wheels);
        let (speed, turn) = (twist.linear.norm(), twist.angular.abs());
        let before = std::mem::replace(&mut self.last, (speed, turn));
        if let Some(reason) = reason {
            return self.judge_braking(ms, reason, before, order);
        }
        self.braking_since = None;
        let silence = self.frame.map_or(0, |last| ms - last).saturating_sub(SLACK);
        if silence > GAP {
            let left = SILENCE.saturating_sub(silence) as f32 / (SILENCE - GAP) as f32;
            // No limit requires more than the field surface's traction.
            let most = (left * SPEED_MAX).max(before.0 - BRAKE * 0.01 * 0.9);
            if speed > most + BLUR {
                return Err(Danger::Hesitant(silence, speed));
            }
        }
        if self.stop_since.is_some_and(|since| ms - since > STOP_GRACE) && speed > STOP_SPEED {
            return Err(Danger::Stop(speed));
        }
        // In our placement the ball is ours alone: one that lies at a wall is kicked off it.
        let allowed = matches!(
            self.phase,
            Some(
                Phase::Run
                    | Phase::FreeKick(Side::Ours)
                    | Phase::Kickoff(Side::Ours)
                    | Phase::Penalty(_)
                    | Phase::BallPlacement(Side::Ours)
            )
        );
        if kick_speed > 0.0 && !allowed {
            return Err(Danger::Kick(self.phase));
        }
        Ok(())
    }

    fn judge_braking(
        &mut self,
        ms: u32,
        reason: BrakeReason,
        before: (f32, f32),
        order: &ActuatorFrame,
    ) -> Result<(), Danger> {
        let ActuatorFrame::Omni { dribbler, kick, .. } = *order else { return Ok(()) };
        if kick != OmniKick::Discharge || dribbler != 0.0 {
            return Err(Danger::Unbraked(reason, *order));
        }
        let (speed, turn) = self.last;
        if speed > before.0 + BLUR || turn > before.1 + BLUR {
            return Err(Danger::Faster(reason, [before.0, before.1, speed, turn]));
        }
        let since = *self.braking_since.get_or_insert(ms);
        if ms - since >= STANDS_WITHIN && speed + turn > 0.0 {
            return Err(Danger::Endless(reason, speed));
        }
        Ok(())
    }

    /// The reason for which it must brake now, as far as visible from outside.
    fn brake_reason(&mut self, ms: u32, sensors: &SensorFrame) -> Option<BrakeReason> {
        let silent = |last: Option<u32>| last.is_none_or(|last| ms - last >= SILENCE + SLACK);
        if self.frame.is_none_or(|last| ms - last >= LONG_SILENCE + SLACK) {
            self.armed = false;
            self.good_since = None;
        }
        self.armed |= self.good_since.is_some_and(|since| ms - since >= ARM_AFTER - SLACK);
        let low = sensors.health.battery.is_some_and(|volts| volts.is_nan() || volts < BATTERY_LOW);
        self.low_since = if low { Some(self.low_since.unwrap_or(ms)) } else { None };
        let odometry = sensors.odometry;
        let number = odometry.linear.is_finite() && odometry.angular.is_finite();
        let reasons = [
            (silent(self.frame) && ms - self.booted_ms >= SILENCE, BrakeReason::Silence),
            (!self.armed, BrakeReason::NotArmed),
            (silent(self.command), BrakeReason::NoCommand),
            (matches!(self.phase, Some(Phase::Halt | Phase::Timeout(_))), BrakeReason::Halt),
            (!number, BrakeReason::NotANumber),
            (sensors.health.tipped, BrakeReason::Tipped),
            (odometry.angular.abs() > SPINNING, BrakeReason::Spinning),
            (self.low_since.is_some_and(|since| ms - since >= LOW_FOR + SLACK), BrakeReason::Battery),
        ];
        reasons.into_iter().find_map(|(holds, reason)| holds.then_some(reason))
    }
}

/// Tolerance: a tick of a brain on wheels, ms.
const SLACK: u32 = 10;
/// ms (docs/architecture.md §6.2): limits shrink; brake; disarmed; armed again.
const GAP: u32 = 50;
const SILENCE: u32 = 100;
const LONG_SILENCE: u32 = 500;
const ARM_AFTER: u32 = 500;
/// Speed below which a robot stands, m/s.
const LETS_GO: f32 = 0.1;
/// Maximum braking time, ms: from 4 m/s at 5 m/s² it takes 0.8 s, from 20 rad/s at 40 rad/s² 0.5 s.
const STANDS_WITHIN: u32 = 1_000;
/// m/s and m/s²: maximum speed of a robot, and the braking limit of its wheels.
const SPEED_MAX: f32 = 4.0;
const BRAKE: f32 = 5.0;
/// Maximum speed of a rim, m/s, with rounding.
const RIM_MAX: f32 = 5.001;
/// m/s: the rules' 6.5 minus a kicker's scatter.
const KICK_MAX: f32 = 6.3;
/// m/s and ms: the rules' limit in STOP and their grace.
const STOP_SPEED: f32 = 1.5;
const STOP_GRACE: u32 = 2_000;
/// Turning rate above which a robot spins, rad/s.
const SPINNING: f32 = 30.0;
/// V, and ms of low voltage.
const BATTERY_LOW: f32 = 14.0;
const LOW_FOR: u32 = 1_000;
/// m/s or rad/s: rounding error of the conversion from twist to rims and back.
const BLUR: f32 = 0.01;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::led_robot::{blind_sensors, drive_on};
    use geometry::Twist;

    fn frame() -> Believed {
        Believed::Host(HostMessage::Command(drive_on(RobotId::new(1).unwrap())))
    }

    fn order(speed: f32, kick: OmniKick) -> ActuatorFrame {
        let twist = Twist { linear: geometry::Vector::new(speed, 0.0), angular: 0.0 };
        ActuatorFrame::Omni { wheels: Omni::default().rims(twist), dribbler: 0.0, kick }
    }

    /// A robot that received its host every 10 ms for a second, driving.
    fn driving() -> Guard {
        let mut guard = Guard::new(RobotId::new(1).unwrap(), 5, 0);
        for ms in (0..1_000).step_by(10) {
            guard.receive(ms, &frame());
            let speed = if ms < 500 { 0.0 } else { 1.0 };
            let kick = if ms < 500 { OmniKick::Discharge } else { OmniKick::None };
            assert_eq!(guard.judge(ms, &blind_sensors(), &order(speed, kick)), Ok(()), "{ms}");
        }
        guard
    }

    #[test]
    fn driving_on_without_the_host_is_a_danger() {
        let mut guard = driving();
        let mut found = None;
        for ms in (1_000..1_300).step_by(10) {
            found = found.or(guard.judge(ms, &blind_sensors(), &order(1.0, OmniKick::None)).err());
        }
        assert!(matches!(found, Some(Danger::Hesitant(..))), "{found:?}");
        let mut guard = driving();
        let still = order(0.0, OmniKick::None);
        let judged: Vec<_> =
            (1_000..1_200).step_by(10).map(|ms| guard.judge(ms, &blind_sensors(), &still)).collect();
        // The last frame came at 990 ms; at 1,100 the tick of slack is over too.
        assert!(judged[..10].iter().all(Result::is_ok));
        assert_eq!(judged[10], Err(Danger::Unbraked(BrakeReason::Silence, still)));
    }

    #[test]
    fn moving_at_once_is_a_danger_after_a_long_silence_not_after_a_gap() {
        let moves = order(0.5, OmniKick::None);
        for (silence, judged) in [(210, Ok(())), (600, Err(Danger::Unbraked(BrakeReason::NotArmed, moves)))] {
            let mut guard = driving();
            let until = 990 + silence;
            assert!(guard.judge(until - 10, &blind_sensors(), &order(0.0, OmniKick::Discharge)).is_ok());
            guard.receive(until, &frame());
            assert_eq!(guard.judge(until, &blind_sensors(), &moves), judged, "{silence} ms");
        }
    }

    #[test]
    fn speeding_up_endless_braking_and_absurd_orders_are_dangers() {
        let mut mad = blind_sensors();
        mad.odometry.angular = f32::NAN;
        let mut guard = driving();
        guard.receive(1_000, &frame());
        let faster = guard.judge(1_000, &mad, &order(1.5, OmniKick::Discharge));
        assert!(matches!(faster, Err(Danger::Faster(BrakeReason::NotANumber, _))), "{faster:?}");
        let mut guard = driving();
        let mut found = Ok(());
        for ms in (1_000..2_100).step_by(10) {
            guard.receive(ms, &frame());
            found = found.and(guard.judge(ms, &mad, &order(1.0, OmniKick::Discharge)));
        }
        assert!(matches!(found, Err(Danger::Endless(BrakeReason::NotANumber, _))), "{found:?}");
        let absurd = order(f32::NAN, OmniKick::None);
        assert!(matches!(driving().judge(1_000, &blind_sensors(), &absurd), Err(Danger::Absurd(_))));
        let hard = order(0.0, OmniKick::Flat(7.0));
        assert_eq!(driving().judge(1_000, &blind_sensors(), &hard), Err(Danger::Absurd(hard)));
    }
}
