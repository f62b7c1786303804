//! `bring_up`: checks of a robot whose parts are wired for the first time: battery, sensors at rest, each
//! wheel both ways, radio, break-beam sensor. Sans-IO, stepped at the pace of the control loop; the robot on
//! a stand, wheels off the ground, the kicker's board unplugged.
//!
//! Each check takes what the board's ports measure ([`Reading`]), drives at most one wheel, and ends with
//! what it measured or with what is wrong ([`Finding`]) and what to look at. No check waits for ever, and
//! none depends on another: one broken part hides no other. [`Results`] tells the host how each stands.
//! [`mod@bench`] is a robot of simulated parts with faults to plant.

pub mod bench;
mod listener;
mod results;

use brain::governor::BATTERY_LOW;
use protocol::{Duration, Instant};
use rules::RobotSpec;

pub use listener::Listener;
pub use protocol::bring_up::{CHECKS, Check, CheckReport, Finding};
pub use results::{REPORT_EVERY, Results};

use crate::ports::Seen;
use crate::wheel::{Motors, WHEELS};

/// What the board's ports measured in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Rim speeds, m/s; NaN where an encoder is known to be broken.
    pub rims: [f32; WHEELS],
    /// The probes.
    pub seen: Seen,
    /// The radio so far.
    pub radio: RadioCounts,
}

/// Counts of the radio since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RadioCounts {
    /// Frames received whole.
    pub received: u32,
    /// Frames that are missing between them, by their numbers.
    pub lost: u32,
    /// Errors of the line to the radio: framing, overrun, noise.
    pub line_errors: u32,
}

/// What the board does until the next step.
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
    /// How long the beam was interrupted.
    interrupted: Option<(Instant, bool)>,
    /// The check's result, while the wheel runs down.
    pending: Option<Result<f32, Finding>>,
}

impl BringUp {
    /// Before the first check.
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

    /// One step, 1 ms after the last: takes what was measured since, and says what to drive.
    pub fn step(&mut self, now: Instant, reading: &Reading) -> BenchStep {
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
        if passed + WINDOW >= RESTS {
            self.add(reading.rims);
        }
        if passed < RESTS {
            return None;
        }
        let means = self.means();
        for (wheel, mean) in (0..).zip(means) {
            if !mean.is_finite() {
                return Some(Err(Finding::NoEncoder(wheel)));
            }
            if mean.abs() > STANDS {
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
        if passed < DRIVEN {
            if passed + WINDOW >= DRIVEN {
                self.add(reading.rims);
            }
            let mut duty = [0.0; WHEELS];
            if let Some(one) = duty.get_mut(usize::from(wheel)) {
                *one = sign * DUTY;
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
        if fastest.abs() <= STANDS {
            return (Some(result), Motors::Released);
        }
        let late = passed >= DRIVEN + RUNS_DOWN;
        let result = result.and(Err(Finding::KeepsTurning(fastest)));
        (late.then_some(result), Motors::Released)
    }

    fn radio(&mut self, passed: Duration, counts: RadioCounts) -> Option<Result<f32, Finding>> {
        if passed < LISTENS {
            return None;
        }
        let received = counts.received.wrapping_sub(self.radio.received);
        let lost = counts.lost.wrapping_sub(self.radio.lost);
        let errors = counts.line_errors.wrapping_sub(self.radio.line_errors);
        Some(if received == 0 && errors == 0 {
            Err(Finding::Silent)
        } else if errors > received / LINE_ERRORS_ONE_IN {
            Err(Finding::LineErrors(errors, received))
        } else if lost > (received + lost) / LOSS_ONE_IN {
            Err(Finding::Loses(received, lost))
        } else {
            Ok(received as f32)
        })
    }

    fn beam(&mut self, now: Instant, passed: Duration, ball: bool) -> Option<Result<f32, Finding>> {
        match self.interrupted {
            None if passed < SETTLES => None,
            None if passed < SETTLES + WINDOW => {
                // A ball that is there from the start tells nothing.
                if ball { Some(Err(Finding::Blocked)) } else { None }
            }
            None if ball => {
                self.interrupted = Some((now, false));
                None
            }
            None => (passed >= PERSON).then_some(Err(Finding::NeverInterrupted)),
            Some((since, _)) if !ball => {
                let held = now.since(since);
                if held >= HELD {
                    return Some(Ok(held.0 as f32 * 1e-6));
                }
                // A hand that passes by is no ball.
                self.interrupted = None;
                None
            }
            Some(_) => (passed >= PERSON).then_some(Err(Finding::StaysInterrupted)),
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

/// What the divider says.
fn battery(passed: Duration, seen: &Seen) -> Option<Result<f32, Finding>> {
    let Some(volts) = seen.battery.filter(|volts| volts.is_finite()) else {
        return (passed >= SETTLES).then_some(Err(Finding::NoVoltage));
    };
    if passed < SETTLES {
        return None;
    }
    Some(if (BATTERY_LOW..=BATTERY_FULL).contains(&volts) { Ok(volts) } else { Err(Finding::Voltage(volts)) })
}

/// What four encoders say of one driven wheel.
fn judge(means: [f32; WHEELS], wheel: usize, sign: f32) -> Result<f32, Finding> {
    let expected = DUTY * RobotSpec::OURS.wheels.free_speed;
    let moves = |speed: f32| speed.abs() > expected * MOVES;
    let own = means.get(wheel).copied().unwrap_or(f32::NAN);
    let other = (0..).zip(means).filter(|(i, _)| usize::from(*i) != wheel).find(|(_, speed)| moves(*speed));
    match other {
        Some((with, speed)) if moves(own) => Err(Finding::MovesToo(with, speed)),
        Some((with, speed)) => Err(Finding::CountedBy(with, speed)),
        None if !own.is_finite() => Err(Finding::NoEncoder(wheel as u8)),
        None if !moves(own) => Err(Finding::NoMotion),
        None if own * sign < 0.0 => Err(Finding::Reversed(own)),
        None if !(expected * SLOWEST..=expected * FASTEST).contains(&own.abs()) => {
            Err(Finding::Speed(own, sign * expected))
        }
        None => Ok(own),
    }
}

/// Duty of a driven wheel, share of the battery's voltage: 1 m/s at the rim without load, slow enough for
/// fingers to be withdrawn.
const DUTY: f32 = 0.16;
/// A sensor's first readings are not used.
const SETTLES: Duration = Duration::millis(200);
/// Readings are averaged over so long.
const WINDOW: Duration = Duration::millis(200);
/// The gyroscope needs half a second at rest for its offset ([`crate::sense::Turn`]).
const RESTS: Duration = Duration::millis(1_500);
/// A wheel is driven for so long: ten times the motors' time constant (30 ms, estimate) and the window.
const DRIVEN: Duration = Duration::millis(500);
/// Without current a wheel stands after so long.
const RUNS_DOWN: Duration = Duration::millis(1_000);
/// The radio is listened to for so long: 200 snapshots of a host at its full rate.
const LISTENS: Duration = Duration::millis(2_000);
/// A person has so long for the ball.
const PERSON: Duration = Duration::millis(20_000);
/// A ball is held for so long.
const HELD: Duration = Duration::millis(300);
/// Full, V; from [`BATTERY_LOW`] on the governor lets the robot play.
const BATTERY_FULL: f32 = RobotSpec::OURS.battery.full;
/// A wheel stands below this speed, m/s: a count of the encoder in a window is a tenth of it.
const STANDS: f32 = 0.02;
/// The gyroscope's error at rest, rad/s: ten times the noise of the usual chips.
const DRIFT_MAX: f32 = 0.05;
/// A wheel moves from this share of the expected speed on.
const MOVES: f32 = 0.2;
/// Motors, batteries and friction without load differ by less.
const SLOWEST: f32 = 0.5;
const FASTEST: f32 = 1.6;
/// More than one frame in so many lost is no healthy link (docs/start.md shows 10 % in red).
const LOSS_ONE_IN: u32 = 10;
/// More line errors than one for so many frames come from the line, not from the air.
const LINE_ERRORS_ONE_IN: u32 = 50;
