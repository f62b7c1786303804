//! `bring_up`: checks of a robot whose parts are wired for the first time: battery, sensors at rest, each
//! wheel both ways, radio, break-beam sensor. Sans-IO, stepped at the pace of the control loop; the robot on
//! a stand, wheels off the ground, the kicker's board unplugged.
//!
//! Each check takes what the board's ports measure ([`Reading`]), drives at most one wheel, and ends with
//! what it measured or with what is wrong ([`Finding`]) and what to look at. No check waits for ever, and
//! none depends on another: one broken part hides no other. [`Results`] reports the state of each to the
//! host, [`RobotLog`] the board's log. Once the host arms the kicker, [`Kicks`] fires raw pulses.
//! [`mod@bench`] is a robot of simulated parts with faults to plant.

pub mod bench;
mod kicks;
mod listener;
mod results;
mod robot_log;

use brain::governor::BATTERY_LOW;
use protocol::{Duration, Instant};
use rules::RobotSpec;

pub use kicks::Kicks;
pub use listener::Listener;
pub use protocol::bring_up::{CHECKS, Check, CheckReport, Finding};
pub use results::{REPORT_EVERY, Results};
pub use robot_log::{LogRing, RobotLog};

use crate::ports::Seen;
use crate::wheel::{Motors, WHEELS};

/// Measurements of the board's ports in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Rim speeds, m/s; NaN where an encoder is known to be broken.
    pub rims: [f32; WHEELS],
    /// Readings of the probes.
    pub seen: Seen,
    /// The radio so far.
    pub radio: RadioCounts,
}

/// Counts of the radio since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RadioCounts {
    /// Frames that were received whole.
    pub received: u32,
    /// Frames that are missing between them, by their numbers.
    pub lost: u32,
    /// Errors of the line to the radio: framing, overrun, noise.
    pub line_errors: u32,
}

/// Output of the board until the next step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BenchStep {
    /// Motors: at most one of them is driven.
    pub motors: Motors,
    /// A check that has just ended.
    pub report: Option<CheckReport>,
    /// The check that runs; none: the list is done.
    pub check: Option<Check>,
}

/// The checks under way.
#[derive(Clone, Debug)]
pub struct BringUp {
    next: usize,
    since: Option<Instant>,
    /// Mean of what matters, over the window of the check.
    sums: [f32; WHEELS],
    count: u16,
    /// The radio's counts when its check began.
    radio: RadioCounts,
    /// Time since which the beam is interrupted.
    interrupted: Option<(Instant, bool)>,
    /// The check's result, while the wheel runs down.
    pending: Option<Result<f32, Finding>>,
}

impl BringUp {
    /// Checks of which none has started.
    pub const fn new() -> Self {
        Self {
            next: 0,
            since: None,
            sums: [0.0; WHEELS],
            count: 0,
            radio: RadioCounts { received: 0, lost: 0, line_errors: 0 },
            interrupted: None,
            pending: None,
        }
    }

    /// One step, 1 ms after the last: takes what was measured since, and returns what to drive.
    pub fn step(&mut self, now: Instant, reading: &Reading) -> BenchStep {
        while CHECKS.get(self.next).copied().is_some_and(is_absent) {
            self.next += 1;
        }
        let Some(check) = CHECKS.get(self.next).copied() else {
            return BenchStep { motors: Motors::Released, report: None, check: None };
        };
        let since = *self.since.get_or_insert_with(|| {
            self.radio = reading.radio;
            now
        });
        let passed = now.since(since);
        let (result, motors) = match check {
            Check::Battery => (battery(passed, &reading.seen), Motors::Released),
            Check::Rest => (self.rest(passed, reading), Motors::Released),
            Check::Wheel { wheel, forwards } => self.wheel(passed, reading, wheel, forwards),
            Check::Radio => (self.radio(passed, reading.radio), Motors::Released),
            Check::Beam => (self.beam(now, passed, reading.seen.ball), Motors::Released),
        };
        let report = result.map(|result| {
            *self = Self { next: self.next + 1, ..Self::new() };
            CheckReport { check, result }
        });
        BenchStep { motors, report, check: Some(check) }
    }

    fn rest(&mut self, passed: Duration, reading: &Reading) -> Option<Result<f32, Finding>> {
        if passed + MEAN_WINDOW >= REST_TIME {
            self.add(reading.rims);
        }
        if passed < REST_TIME {
            return None;
        }
        let means = self.means();
        for (wheel, mean) in (0..).zip(means) {
            if !mean.is_finite() {
                return Some(Err(Finding::NoEncoder(wheel)));
            }
            if mean.abs() > STANDING_SPEED_MAX {
                return Some(Err(Finding::MovesAlone(wheel, mean)));
            }
        }
        Some(match reading.seen.turn {
            _ if reading.seen.tipped => Err(Finding::Tipped),
            None => Err(Finding::NoGyroscope),
            Some(rate) if rate.abs() > DRIFT_MAX => Err(Finding::Drifts(rate)),
            Some(rate) => Ok(rate),
        })
    }

    fn wheel(
        &mut self,
        passed: Duration,
        reading: &Reading,
        wheel: u8,
        forwards: bool,
    ) -> (Option<Result<f32, Finding>>, Motors) {
        let sign = if forwards { 1.0 } else { -1.0 };
        if passed < DRIVE_TIME {
            if passed + MEAN_WINDOW >= DRIVE_TIME {
                self.add(reading.rims);
            }
            let mut duty = [0.0; WHEELS];
            if let Some(one) = duty.get_mut(usize::from(wheel)) {
                *one = sign * WHEEL_DUTY;
            }
            return (None, Motors::Driven(duty));
        }
        let means = self.means();
        let result = *self.pending.get_or_insert_with(|| judge(means, usize::from(wheel), sign));
        let fastest = reading
            .rims
            .into_iter()
            .filter(|speed| speed.is_finite())
            .fold(0.0_f32, |most, speed| if speed.abs() > most.abs() { speed } else { most });
        if fastest.abs() <= STANDING_SPEED_MAX {
            return (Some(result), Motors::Released);
        }
        let late = passed >= DRIVE_TIME + RUN_DOWN_MAX;
        let result = result.and(Err(Finding::KeepsTurning(fastest)));
        (late.then_some(result), Motors::Released)
    }

    fn radio(&mut self, passed: Duration, counts: RadioCounts) -> Option<Result<f32, Finding>> {
        if passed < RADIO_TIME {
            return None;
        }
        let received = counts.received.wrapping_sub(self.radio.received);
        let lost = counts.lost.wrapping_sub(self.radio.lost);
        let errors = counts.line_errors.wrapping_sub(self.radio.line_errors);
        Some(if received == 0 && errors == 0 {
            Err(Finding::Silent)
        } else if errors > received / FRAMES_PER_LINE_ERROR_MIN {
            Err(Finding::LineErrors(errors, received))
        } else if lost > (received + lost) / FRAMES_PER_LOSS_MIN {
            Err(Finding::Loses(received, lost))
        } else {
            Ok(received as f32)
        })
    }

    fn beam(&mut self, now: Instant, passed: Duration, ball: bool) -> Option<Result<f32, Finding>> {
        match self.interrupted {
            None if passed < SETTLE_TIME => None,
            None if passed < SETTLE_TIME + MEAN_WINDOW => {
                // A beam that is interrupted from the start proves nothing.
                if ball { Some(Err(Finding::Blocked)) } else { None }
            }
            None if ball => {
                self.interrupted = Some((now, false));
                None
            }
            None => (passed >= BALL_TIMEOUT).then_some(Err(Finding::NeverInterrupted)),
            Some((since, _)) if !ball => {
                let held = now.since(since);
                if held >= BALL_HELD_MIN {
                    return Some(Ok(held.0 as f32 * 1e-6));
                }
                // A hand that passes by is no ball.
                self.interrupted = None;
                None
            }
            Some(_) => (passed >= BALL_TIMEOUT).then_some(Err(Finding::StaysInterrupted)),
        }
    }

    fn add(&mut self, rims: [f32; WHEELS]) {
        for (sum, speed) in self.sums.iter_mut().zip(rims) {
            *sum += speed;
        }
        self.count = self.count.saturating_add(1);
    }

    fn means(&self) -> [f32; WHEELS] {
        let count = f32::from(self.count.max(1));
        self.sums.map(|sum| sum / count)
    }
}

impl Default for BringUp {
    fn default() -> Self {
        Self::new()
    }
}

/// Whether the check is of a wheel that this robot does not have.
fn is_absent(check: Check) -> bool {
    matches!(check, Check::Wheel { wheel, .. } if wheel >= RobotSpec::OURS.wheels.count)
}

/// Result of the battery's check, from the voltage divider.
fn battery(passed: Duration, seen: &Seen) -> Option<Result<f32, Finding>> {
    let Some(volts) = seen.battery.filter(|volts| volts.is_finite()) else {
        return (passed >= SETTLE_TIME).then_some(Err(Finding::NoVoltage));
    };
    if passed < SETTLE_TIME {
        return None;
    }
    Some(if (BATTERY_LOW..=BATTERY_FULL).contains(&volts) { Ok(volts) } else { Err(Finding::Voltage(volts)) })
}

/// Result of a wheel's check, from the mean speeds of all four while it was driven.
fn judge(means: [f32; WHEELS], wheel: usize, sign: f32) -> Result<f32, Finding> {
    let expected = WHEEL_DUTY * RobotSpec::OURS.wheels.free_speed;
    let moves = |speed: f32| speed.abs() > expected * MOVING_SHARE_MIN;
    let own = means.get(wheel).copied().unwrap_or(f32::NAN);
    let other = (0..).zip(means).filter(|(i, _)| usize::from(*i) != wheel).find(|(_, speed)| moves(*speed));
    match other {
        Some((with, speed)) if moves(own) => Err(Finding::MovesToo(with, speed)),
        Some((with, speed)) => Err(Finding::CountedBy(with, speed)),
        None if !own.is_finite() => Err(Finding::NoEncoder(wheel as u8)),
        None if !moves(own) => Err(Finding::NoMotion),
        None if own * sign < 0.0 => Err(Finding::Reversed(own)),
        None if !(expected * SPEED_SHARE_MIN..=expected * SPEED_SHARE_MAX).contains(&own.abs()) => {
            Err(Finding::Speed(own, sign * expected))
        }
        None => Ok(own),
    }
}

/// Duty of a driven wheel, share of the battery's voltage: 1 m/s at the rim without load, slow enough for
/// fingers to be withdrawn.
const WHEEL_DUTY: f32 = 0.16;
/// Start of each check in which readings are not used.
const SETTLE_TIME: Duration = Duration::millis(200);
/// Window over which readings are averaged.
const MEAN_WINDOW: Duration = Duration::millis(200);
/// Length of the check at rest: the gyroscope needs half a second for its offset
/// ([`crate::sense::GyroOffset`]).
const REST_TIME: Duration = Duration::millis(1_500);
/// Time for which a wheel is driven: ten times the motors' time constant (30 ms, estimate) and the window.
const DRIVE_TIME: Duration = Duration::millis(500);
/// Time after which a wheel without current must stand.
const RUN_DOWN_MAX: Duration = Duration::millis(1_000);
/// Length of the radio's check: 200 snapshots of a host at its full rate.
const RADIO_TIME: Duration = Duration::millis(2_000);
/// Time that a person has to hold a ball before the dribbler.
const BALL_TIMEOUT: Duration = Duration::millis(20_000);
/// Shortest interruption of the beam that is a held ball.
const BALL_HELD_MIN: Duration = Duration::millis(300);
/// Voltage of a full battery, V; from [`BATTERY_LOW`] on the governor lets the robot play.
const BATTERY_FULL: f32 = RobotSpec::OURS.battery.full;
/// Largest rim speed of a standing wheel, m/s: a count of the encoder in a window is a tenth of it.
const STANDING_SPEED_MAX: f32 = 0.02;
/// Largest rate of a gyroscope at rest, rad/s: ten times the noise of common chips.
const DRIFT_MAX: f32 = 0.05;
/// Share of the expected speed from which a wheel moves.
const MOVING_SHARE_MIN: f32 = 0.2;
/// Smallest share of the expected speed that motors, batteries and friction without load explain.
const SPEED_SHARE_MIN: f32 = 0.5;
/// Largest share of the expected speed that they explain.
const SPEED_SHARE_MAX: f32 = 1.6;
/// Frames for each lost one on a healthy link, at least (docs/start.md shows 10 % in red).
const FRAMES_PER_LOSS_MIN: u32 = 10;
/// Frames for each error on a healthy line to the radio, at least; more errors do not come from the air.
const FRAMES_PER_LINE_ERROR_MIN: u32 = 50;
