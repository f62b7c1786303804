//! `governor`: the last limits before the motors, independent of the brain's intents (docs/architecture.md
//! §6.2; rules 2026).
//!
//! | why | what is left |
//! |---|---|
//! | HALT or time-out; no host for 100 ms; booted, or the host silent for 0.5 s, less than 0.5 s ago; no command for 100 ms; own place unknown; tipped; spinning; battery low; not a number | brakes at the limit, dribbler off, kicker discharged |
//! | no host for 50 ms | the speed left shrinks to nothing at 100 ms |
//! | STOP | 1.3 m/s, the rules' 1.5 less the noise of wheels |
//! | a kick that is too fast, or that the phase does not allow | a kick of 6.24 m/s (7.1 in 2013), or none |
//!
//! Motors are released only while the robot stands: after half a second without command (host silent), tipped
//! or with an empty battery ([`Governor::has_let_go`]). If it is pushed then, it brakes again; a command to
//! move ends the release. In HALT it holds its place. A robot that expects no host (`BrainConfig::hosted`) is
//! held to everything but the host's silence. A frame of the host counts as received on arrival while it is
//! at most [`LATENCY_MAX`] old, and earlier by its excess age otherwise: with nothing but withheld frames of
//! a dead host the robot slows down from an age of 150 ms on and brakes at 200 ms. After a gap of less than
//! `LONG_SILENCE` it continues with the first fresh frame. Body frame, SI.

use geometry::{Body, Twist, Vector, math};
use protocol::robot_io::{Health, OmniKick};
use protocol::{Duration, Instant};
use rules::{League, Phase, RobotSpec, Side};

/// Motion, dribbler and kick that the brain wants for the coming step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wanted {
    /// Velocity of the body, m/s and rad/s.
    pub twist: Twist<Body>,
    /// Share of the dribbler's full speed, 0–1.
    pub dribbler: f32,
    /// Kick order to the kicker.
    pub kick: OmniKick,
}

impl Wanted {
    /// Standing still, without dribbler or kick.
    pub const STAND: Self = Self {
        twist: Twist { linear: Vector::new(0.0, 0.0), angular: 0.0 },
        dribbler: 0.0,
        kick: OmniKick::None,
    };
}

/// Inputs of the governor about robot, host and game.
#[derive(Clone, Copy, Debug)]
pub struct Circumstances<'s> {
    /// Time of this step, the robot's own clock.
    pub now: Instant,
    /// Reception of the host's frames; `None` where no host is expected.
    pub host: Option<Hearing>,
    /// The phase of the game; `None` if none was received.
    pub phase: Option<Phase<Side>>,
    /// Whether its own place is known.
    pub placed: bool,
    /// State of the body.
    pub health: &'s Health,
    /// Measured motion of the body.
    pub odometry: Twist<Body>,
}

/// How recently frames of the host were received.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hearing {
    /// Time of its last frame.
    pub frame: Option<Instant>,
    /// Time of its last command to this robot.
    pub command: Option<Instant>,
}

/// Why a robot is limited or brakes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u16)]
pub enum LimitReason {
    /// HALT or a time-out.
    Halt = 1,
    /// The host is silent, or has not been received again for long enough.
    Silence = 1 << 1,
    /// The host is received, but has no command for this robot.
    NoCommand = 1 << 2,
    /// Its own place is unknown.
    Lost = 1 << 3,
    /// The robot lies on its side.
    Tipped = 1 << 4,
    /// It turns faster than any robot should.
    Spinning = 1 << 5,
    /// The battery is too low to play.
    Battery = 1 << 6,
    /// NaN, wanted or measured.
    NotANumber = 1 << 7,
    /// Speed limit of STOP.
    StopSpeed = 1 << 8,
    /// The host has missed a few frames.
    Hesitant = 1 << 9,
    /// The ordered kick would be too fast.
    BallSpeed = 1 << 10,
    /// The ball may not be kicked now.
    NoKick = 1 << 11,
    /// The motion wanted is faster than any robot's.
    Reach = 1 << 12,
}

/// A set of reasons.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Reasons(u16);

impl Reasons {
    /// Whether `why` is one of them.
    pub fn has(self, why: LimitReason) -> bool {
        self.0 & why as u16 != 0
    }

    /// Whether there is no reason.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether any of `these` is one of them.
    fn has_any(self, these: &[LimitReason]) -> bool {
        these.iter().any(|why| self.has(*why))
    }

    fn add_if(&mut self, holds: bool, why: LimitReason) {
        if holds {
            self.0 |= why as u16;
        }
    }
}

/// The governor's decision on a wanted motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ruling {
    /// Passed unchanged: no limit applied.
    Allowed,
    /// Passed with less speed or kick.
    Limited(Reasons),
    /// Refused: it brakes, or stands.
    Braking(Reasons),
}

/// The governor of one robot.
#[derive(Clone, Debug)]
pub struct Governor {
    league: League,
    /// The motion allowed last.
    last: Twist<Body>,
    last_at: Option<Instant>,
    /// Since when the host has been received without a long silence.
    received_since: Option<Instant>,
    last_frame: Option<Instant>,
    low_since: Option<Instant>,
    /// Since when it has stood still without a command.
    left_since: Option<Instant>,
    let_go: bool,
}

impl Governor {
    /// The governor of a robot of that league that has just booted.
    pub fn new(league: League) -> Self {
        Self {
            league,
            last: Twist::default(),
            last_at: None,
            received_since: None,
            last_frame: None,
            low_since: None,
            left_since: None,
            let_go: false,
        }
    }

    /// Counts a frame of the host as received at `received`, never before the last.
    pub fn receive_host(&mut self, received: Instant) {
        if self.last_frame.is_some_and(|last| received.since(last) >= LONG_SILENCE) {
            self.received_since = None;
        }
        self.last_frame = Some(received);
    }

    /// The allowed part of the wanted motion. Must be called every step; its result goes to the body.
    pub fn rule(&mut self, at: &Circumstances<'_>, wanted: &Wanted) -> (Wanted, Ruling) {
        let step = self.last_at.map_or(STEP_MAX, |last| at.now.since(last)).min(STEP_MAX).as_secs_f32();
        self.last_at = Some(at.now);
        let braking = self.reasons_to_brake(at, wanted);
        let (given, ruling) = if braking.is_empty() {
            self.limited(at, wanted, step)
        } else {
            (self.braked(at, step), Ruling::Braking(braking))
        };
        self.last = given.twist;
        let left = braking.has_any(&LETS_GO) && given.twist == Twist::default() && stands(at.odometry);
        self.left_since = if left { Some(self.left_since.unwrap_or(at.now)) } else { None };
        self.let_go = self.left_since.is_some_and(|since| at.now.since(since) >= LET_GO_AFTER);
        (given, ruling)
    }

    /// Whether the motors may be without current: the robot stands, and has no command.
    pub fn has_let_go(&self) -> bool {
        self.let_go
    }

    /// The motion allowed last.
    pub fn last(&self) -> Twist<Body> {
        self.last
    }

    fn reasons_to_brake(&mut self, at: &Circumstances<'_>, wanted: &Wanted) -> Reasons {
        let mut why = Reasons::default();
        if let Some(hearing) = at.host {
            let silent = |last: Option<Instant>| last.is_none_or(|last| at.now.since(last) >= SILENCE);
            // From the step on in which it came: a frame with a long latency counts as received before that.
            let gone = hearing.frame.is_none_or(|last| at.now.since(last) > LONG_SILENCE);
            self.received_since = if gone { None } else { Some(self.received_since.unwrap_or(at.now)) };
            let disarmed = self.received_since.is_none_or(|since| at.now.since(since) < ARM_AFTER);
            let silence = disarmed || silent(hearing.frame);
            why.add_if(silence, LimitReason::Silence);
            why.add_if(!silence && silent(hearing.command), LimitReason::NoCommand);
        }
        let low = at.health.battery.is_some_and(|volts| volts < BATTERY_LOW || volts.is_nan());
        self.low_since = if low { Some(self.low_since.unwrap_or(at.now)) } else { None };
        why.add_if(matches!(at.phase, Some(Phase::Halt | Phase::Timeout(_))), LimitReason::Halt);
        why.add_if(!at.placed, LimitReason::Lost);
        why.add_if(at.health.tipped, LimitReason::Tipped);
        why.add_if(at.odometry.angular.abs() > SPINNING, LimitReason::Spinning);
        why.add_if(self.low_since.is_some_and(|since| at.now.since(since) >= LOW_FOR), LimitReason::Battery);
        why.add_if(!is_finite(wanted.twist) || !is_finite(at.odometry), LimitReason::NotANumber);
        why.add_if(!wanted.dribbler.is_finite() || !is_kick(wanted.kick), LimitReason::NotANumber);
        why
    }

    /// Decelerates to zero as fast as wheels hold the field surface; starts from the measured motion where
    /// that is slower than the ordered one.
    fn braked(&self, at: &Circumstances<'_>, step: f32) -> Wanted {
        let measured = Some(at.odometry).filter(|twist| is_finite(*twist));
        let linear = measured.map_or(self.last.linear, |twist| {
            if twist.linear.norm() < self.last.linear.norm() { twist.linear } else { self.last.linear }
        });
        let angular = measured.map_or(self.last.angular, |twist| {
            let limit = self.last.angular.abs();
            math::clamp(twist.angular, -limit, limit)
        });
        let speed = (linear.norm() - BRAKE * step).max(0.0);
        let turn = BRAKE_TURN * step;
        let angular = if angular.abs() > turn { angular - turn * angular.signum() } else { 0.0 };
        let twist = Twist { linear: linear.clamped(speed), angular };
        Wanted { twist, dribbler: 0.0, kick: OmniKick::Discharge }
    }

    fn limited(&self, at: &Circumstances<'_>, wanted: &Wanted, step: f32) -> (Wanted, Ruling) {
        let mut why = Reasons::default();
        let silence =
            at.host.and_then(|hearing| hearing.frame).map_or(Duration(0), |last| at.now.since(last));
        let mut limit = SPEED_MAX;
        if at.phase == Some(Phase::Stop) {
            limit = STOP_SPEED;
        }
        if silence > RAMP_FROM {
            let left = SILENCE.0.saturating_sub(silence.0) as f32 / (SILENCE.0 - RAMP_FROM.0) as f32;
            limit = limit.min(left * SPEED_MAX);
        }
        // No limit asks for more deceleration than the field surface allows.
        let allowed = limit.max(self.last.linear.norm() - BRAKE * step);
        let speed = wanted.twist.linear.norm();
        if speed > allowed {
            why.add_if(at.phase == Some(Phase::Stop) && limit <= STOP_SPEED, LimitReason::StopSpeed);
            why.add_if(silence > RAMP_FROM, LimitReason::Hesitant);
            why.add_if(limit >= SPEED_MAX, LimitReason::Reach);
        }
        why.add_if(wanted.twist.angular.abs() > TURN_MAX, LimitReason::Reach);
        let twist = Twist {
            linear: wanted.twist.linear.clamped(allowed),
            angular: wanted.twist.angular.clamp(-TURN_MAX, TURN_MAX),
        };
        let kick = self.kick(at.phase, wanted.kick, &mut why);
        let given = Wanted { twist, dribbler: wanted.dribbler.clamp(0.0, 1.0), kick };
        (given, if why.is_empty() { Ruling::Allowed } else { Ruling::Limited(why) })
    }

    fn kick(&self, phase: Option<Phase<Side>>, kick: OmniKick, why: &mut Reasons) -> OmniKick {
        let (OmniKick::Flat(speed) | OmniKick::Chip(speed)) = kick else { return kick };
        if !phase.is_none_or(may_kick) {
            why.add_if(true, LimitReason::NoKick);
            return OmniKick::None;
        }
        let most = ball_speed(self.league);
        if speed <= most {
            return kick;
        }
        why.add_if(true, LimitReason::BallSpeed);
        match kick {
            OmniKick::Chip(_) => OmniKick::Chip(most),
            _ => OmniKick::Flat(most),
        }
    }
}

/// The fastest ball a robot of that league kicks, m/s.
pub fn ball_speed(league: League) -> f32 {
    RobotSpec::OURS.kicker.fastest_in(league)
}

/// Whether we may kick a ball in that phase.
pub fn may_kick(phase: Phase<Side>) -> bool {
    // A robot that places the ball may kick it, as off a wall (rules: ball placement restricts only where it
    // stops).
    let ours = matches!(
        phase,
        Phase::FreeKick(Side::Ours) | Phase::Kickoff(Side::Ours) | Phase::BallPlacement(Side::Ours)
    );
    ours || matches!(phase, Phase::Run | Phase::Penalty(_))
}

fn is_finite(twist: Twist<Body>) -> bool {
    twist.linear.is_finite() && twist.angular.is_finite()
}

/// Whether it stands, by wheels and gyroscope; false where they report NaN.
fn stands(odometry: Twist<Body>) -> bool {
    odometry.linear.norm() < STANDSTILL_SPEED && odometry.angular.abs() < STANDS_TURN
}

fn is_kick(kick: OmniKick) -> bool {
    match kick {
        OmniKick::Flat(speed) | OmniKick::Chip(speed) => speed.is_finite(),
        OmniKick::None | OmniKick::Discharge => true,
    }
}

/// From this silence of the host on the remaining speed shrinks (docs/architecture.md §6.2).
const RAMP_FROM: Duration = Duration::millis(50);
/// From this silence on the robot brakes (docs/architecture.md §6.2); a command is stale after it too.
pub const SILENCE: Duration = Duration::millis(100);
/// The age up to which a frame counts as received on arrival. With [`SILENCE`] it makes the age at which the
/// robot brakes, and beyond which the link refuses a frame. Radios of the league take 3–10 ms up and down; 60
/// ms each direction is the most that is planned for, and leaves 80 ms without a frame.
pub const LATENCY_MAX: Duration = Duration::millis(100);
const _: () =
    assert!(SILENCE.0 + LATENCY_MAX.0 == protocol::host_clock::AGE_MAX.0, "200 ms of age are silence");
/// After a silence at least this long, that of a host which ended or a link that was lost, the robot waits
/// for [`ARM_AFTER`]. Shorter ones are gaps of the radio and end with the first fresh frame: with gaps of
/// 40–150 ms at random, half a second without one of 50 ms, which was asked for before, is rare (robots stood
/// for 52–78 % of the time in play).
const LONG_SILENCE: Duration = Duration::millis(500);
/// After a boot or a long silence, the host must be received for this time before the robot may move
/// (docs/architecture.md §6.2).
const ARM_AFTER: Duration = Duration::millis(500);
/// Speed limit of a robot in STOP, m/s: 1.5 by the rules, less wheels that run 10 % fast and the vision's
/// noise.
pub const STOP_SPEED: f32 = 1.3;
/// No robot is faster, m/s.
const SPEED_MAX: f32 = RobotSpec::OURS.governor.speed;
/// Nor turns faster, rad/s.
const TURN_MAX: f32 = RobotSpec::OURS.governor.turn;
/// Deceleration on the field surface, m/s².
pub const BRAKE: f32 = RobotSpec::OURS.governor.brake;
/// The same for turning, rad/s².
const BRAKE_TURN: f32 = RobotSpec::OURS.governor.brake_turn;
/// A robot that turns this fast has gone mad, rad/s (TIGERs' robots use the same).
const SPINNING: f32 = 30.0;
/// The battery is too low to play, V.
pub const BATTERY_LOW: f32 = RobotSpec::OURS.battery.low;
/// Minimum duration of a low battery: the voltage sinks briefly when the motors pull.
const LOW_FOR: Duration = Duration::millis(1000);
/// Reasons to brake that may last: no command, or the robot cannot go on.
const LETS_GO: [LimitReason; 3] = [LimitReason::Silence, LimitReason::Tipped, LimitReason::Battery];
/// Standstill time before the motors are released: ten times the host's shortest silence that counts.
const LET_GO_AFTER: Duration = Duration::millis(500);
/// A slower robot stands, m/s and rad/s: a few counts of an encoder in a step, and a gyroscope's noise.
const STANDSTILL_SPEED: f32 = 0.05;
const STANDS_TURN: f32 = 0.2;
/// Longest step: after a gap a robot brakes as in one of these.
const STEP_MAX: Duration = Duration::millis(50);

#[cfg(test)]
mod tests;
