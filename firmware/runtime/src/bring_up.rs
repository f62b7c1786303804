//! `bring_up`: checks of a robot whose parts are wired for the first time: battery, sensors at rest, each
//! wheel both ways, radio, break-beam sensor. Sans-IO, stepped at the pace of the control loop; the robot on
//! a stand, wheels off the ground, the kicker's board unplugged.
//!
//! Each check takes what the board's ports measure ([`Reading`]), drives at most one wheel, and ends with
//! what it measured or with what is wrong ([`Finding`]) and what to look at. No check waits for ever, and
//! none depends on another: one broken part hides no other. [`mod@bench`] is a robot of simulated parts with
//! faults to plant.

pub mod bench;
mod listener;

use core::fmt;

use brain::governor::BATTERY_LOW;
use protocol::{Duration, Instant};
use rules::RobotSpec;

pub use listener::Listener;

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

/// A check of the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Check {
    /// Its voltage is measured, and within that of four cells.
    Battery,
    /// At rest wheels stand, the gyroscope knows its offset and the robot does not lie on its side.
    Rest,
    /// One wheel turns the way it is driven, and no other does.
    Wheel {
        /// 0 to 3: front right, back right, back left, front left.
        wheel: u8,
        /// Its rim runs to the left, seen from the robot's centre: it would turn the robot counter-clockwise.
        forwards: bool,
    },
    /// Frames of the host arrive.
    Radio,
    /// The beam is interrupted by a ball that is held before the dribbler, and free again without it.
    Beam,
}

/// The list, in its order: what others rest on first.
pub const CHECKS: [Check; 12] = [
    Check::Battery,
    Check::Rest,
    wheel(0, true),
    wheel(0, false),
    wheel(1, true),
    wheel(1, false),
    wheel(2, true),
    wheel(2, false),
    wheel(3, true),
    wheel(3, false),
    Check::Radio,
    Check::Beam,
];

const fn wheel(wheel: u8, forwards: bool) -> Check {
    Check::Wheel { wheel, forwards }
}

const NAMES: [&str; WHEELS] = ["front right", "back right", "back left", "front left"];

impl fmt::Display for Check {
    /// What is checked, and what a person has to see or do.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Battery => f.write_str("battery: nothing moves"),
            Self::Rest => f.write_str("sensors at rest: leave the robot alone"),
            Self::Wheel { wheel, forwards } => {
                let name = NAMES.get(usize::from(*wheel)).copied().unwrap_or("no");
                let way = if *forwards { "counter-clockwise" } else { "clockwise" };
                write!(f, "{name} wheel: it turns, as to turn the robot {way}")
            }
            Self::Radio => f.write_str("radio: a host of its team sends"),
            Self::Beam => {
                f.write_str("break-beam sensor: hold a ball before the dribbler, then take it away")
            }
        }
    }
}

/// What is wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Finding {
    /// The battery's voltage is not measured.
    NoVoltage,
    /// Its voltage, V, is none of four cells.
    Voltage(f32),
    /// No gyroscope answers, or it never came to rest.
    NoGyroscope,
    /// The turning rate at rest, rad/s.
    Drifts(f32),
    /// The accelerometer says that the robot lies on its side.
    Tipped,
    /// This wheel moves although none is driven, m/s.
    MovesAlone(u8, f32),
    /// This wheel's encoder is known to be broken.
    NoEncoder(u8),
    /// It is driven and no encoder sees anything.
    NoMotion,
    /// It runs the wrong way, m/s.
    Reversed(f32),
    /// Another wheel's encoder counts in its place, m/s.
    CountedBy(u8, f32),
    /// Another wheel moves too, m/s.
    MovesToo(u8, f32),
    /// Its speed, and what the motor's constant says, m/s.
    Speed(f32, f32),
    /// It does not stop without current, m/s.
    KeepsTurning(f32),
    /// Nothing was received.
    Silent,
    /// Frames received and lost.
    Loses(u32, u32),
    /// Errors of the line, and frames received.
    LineErrors(u32, u32),
    /// The beam is interrupted without a ball.
    Blocked,
    /// The beam was never interrupted.
    NeverInterrupted,
    /// The beam stayed interrupted.
    StaysInterrupted,
}

impl fmt::Display for Finding {
    /// What was measured, and what to look at.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = |wheel: &u8| NAMES.get(usize::from(*wheel)).copied().unwrap_or("no");
        match self {
            Self::NoVoltage => f.write_str("no voltage is measured: the divider's wire"),
            Self::Voltage(volts) => write!(f, "{volts:.1} V is none of four cells: charge it, or measure the divider"),
            Self::NoGyroscope => f.write_str("no gyroscope: power, wires and chip select of the IMU; was it moved?"),
            Self::Drifts(rate) => write!(f, "it turns by {rate:.2} rad/s at rest: the IMU is loose, or was moved"),
            Self::Tipped => f.write_str("it lies on its side, says the IMU: its z axis must point up"),
            Self::MovesAlone(wheel, speed) => {
                write!(f, "the {} wheel runs {speed:.2} m/s by itself: encoder's ground and shield, or a driver that is always on", name(wheel))
            }
            Self::NoEncoder(wheel) => write!(f, "the {} wheel's encoder is broken: cable and supply", name(wheel)),
            Self::NoMotion => f.write_str("nothing turns: motor's cable, its driver and its enable; if it does turn, the encoder's cable"),
            Self::Reversed(speed) => {
                write!(f, "it runs the wrong way, {speed:.2} m/s: if it looks right, swap the encoder's two lines, else two phases or the direction's wire")
            }
            Self::CountedBy(wheel, speed) => {
                write!(f, "the encoder of the {} wheel counts {speed:.2} m/s in its place: swap the two encoders' cables, or the two motors'", name(wheel))
            }
            Self::MovesToo(wheel, speed) => {
                write!(f, "the {} wheel moves too, {speed:.2} m/s: a driver's inputs are joined", name(wheel))
            }
            Self::Speed(speed, expected) => {
                write!(f, "{speed:.2} m/s, not {expected:.2}: gear, friction, lines of the encoder, or the wheel's radius")
            }
            Self::KeepsTurning(speed) => write!(f, "{speed:.2} m/s a second after its current was off: its driver's enable"),
            Self::Silent => f.write_str("nothing received: is a host of its team running; power and wires of the radio"),
            Self::Loses(received, lost) => write!(f, "{lost} of {} frames lost: antenna, plug, channel", received + lost),
            Self::LineErrors(errors, received) => {
                write!(f, "{errors} errors on the radio's line beside {received} frames: its rate, ground and plug")
            }
            Self::Blocked => f.write_str("interrupted without a ball: align lamp and sensor; daylight"),
            Self::NeverInterrupted => f.write_str("never interrupted: lamp and sensor face each other behind the ball, or its wire is stuck"),
            Self::StaysInterrupted => f.write_str("still interrupted after the ball was taken away, or it was not taken away"),
        }
    }
}

/// The result of a check; what passed has the value that was measured, in the check's unit (V, rad/s, m/s,
/// frames received, s of interruption).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CheckReport {
    /// Which check.
    pub check: Check,
    /// What it measured, or what is wrong.
    pub result: Result<f32, Finding>,
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
