//! `bench`: a robot on a stand, of simulated parts, with a fault: what [`BringUp`] is played
//! against without hardware. Deterministic by its seed.

use protocol::{Duration, Instant};
use rules::RobotSpec;

use super::{BenchStep, BringUp, CheckReport, RadioCounts, Reading};
use crate::ports::Seen;
use crate::wheel::{CONTROL_PERIOD, Motors, WHEELS};

/// A fault of the parts or of their wires.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Everything as it should be.
    None,
    /// The battery's divider is open.
    NoDivider,
    /// The battery is empty.
    EmptyBattery,
    /// The IMU does not answer.
    NoImu,
    /// The IMU is mounted upside down.
    ImuUpsideDown,
    /// The cables of these two encoders are swapped.
    SwappedEncoders(u8, u8),
    /// This motor's phases or direction are swapped.
    ReversedMotor(u8),
    /// The two lines of this encoder are swapped.
    ReversedEncoder(u8),
    /// This motor gets no current.
    DeadWheel(u8),
    /// This encoder's cable is off.
    DeadEncoder(u8),
    /// This driver's direction is stuck forwards.
    StuckDirection(u8),
    /// This driver's inputs are joined with those of the next wheel.
    JoinedDrivers(u8),
    /// This encoder has half the lines that the firmware expects.
    CoarseEncoder(u8),
    /// The radio is off.
    NoRadio,
    /// The radio's plug is loose: bytes are lost on the line.
    LooseRadio,
    /// The radio's antenna is off: frames are lost in the air.
    NoAntenna,
    /// The break-beam sensor's lamp is off.
    NoLamp,
    /// The break-beam sensor's output is stuck low.
    StuckBeam,
}

impl Fault {
    /// A fault of each kind by name; of wheels the first or the first two.
    pub const EXAMPLES: [(&'static str, Self); 18] = [
        ("none", Self::None),
        ("no-divider", Self::NoDivider),
        ("empty-battery", Self::EmptyBattery),
        ("no-imu", Self::NoImu),
        ("imu-upside-down", Self::ImuUpsideDown),
        ("swapped-encoders", Self::SwappedEncoders(0, 1)),
        ("reversed-motor", Self::ReversedMotor(0)),
        ("reversed-encoder", Self::ReversedEncoder(0)),
        ("dead-wheel", Self::DeadWheel(0)),
        ("dead-encoder", Self::DeadEncoder(0)),
        ("stuck-direction", Self::StuckDirection(0)),
        ("joined-drivers", Self::JoinedDrivers(0)),
        ("coarse-encoder", Self::CoarseEncoder(0)),
        ("no-radio", Self::NoRadio),
        ("loose-radio", Self::LooseRadio),
        ("no-antenna", Self::NoAntenna),
        ("no-lamp", Self::NoLamp),
        ("stuck-beam", Self::StuckBeam),
    ];
}

/// Robot on a stand, of simulated parts.
#[derive(Clone, Debug)]
pub struct Bench {
    fault: Fault,
    noise: u32,
    /// Rim speeds of the wheels, m/s.
    rims: [f32; WHEELS],
    radio: RadioCounts,
    steps: u32,
}

impl Bench {
    /// At rest, with that fault; `seed` draws the noise of its sensors.
    pub const fn new(fault: Fault, seed: u32) -> Self {
        let radio = RadioCounts { received: 0, lost: 0, line_errors: 0 };
        Self { fault, noise: seed.wrapping_mul(0x9e37_79b9) | 1, rims: [0.0; WHEELS], radio, steps: 0 }
    }

    /// −1 to 1, evenly: xorshift (Marsaglia 2003), enough for noise.
    fn dice(&mut self) -> f32 {
        self.noise ^= self.noise << 13;
        self.noise ^= self.noise >> 17;
        self.noise ^= self.noise << 5;
        (self.noise >> 8) as f32 / 8_388_608.0 - 1.0
    }

    /// A millisecond with these motors; `ball`: a person holds a ball before the dribbler.
    pub fn step(&mut self, motors: Motors, ball: bool) -> Reading {
        self.steps += 1;
        let mut duty = match motors {
            Motors::Driven(duty) => duty,
            Motors::Released => [0.0; WHEELS],
        };
        match self.fault {
            Fault::ReversedMotor(n) => change(&mut duty, n, |duty| -duty),
            Fault::DeadWheel(n) => change(&mut duty, n, |_| 0.0),
            Fault::StuckDirection(n) => change(&mut duty, n, f32::abs),
            Fault::JoinedDrivers(n) => {
                let with = duty.get(usize::from(n)).copied().unwrap_or(0.0);
                change(&mut duty, (n + 1) % WHEELS as u8, |duty| duty + with);
            }
            _ => {}
        }
        for (speed, duty) in self.rims.iter_mut().zip(duty) {
            let pull = duty * RobotSpec::OURS.wheels.free_speed - *speed;
            *speed += pull / TIME_CONSTANT_STEPS;
        }
        let mut rims = self.rims;
        for speed in &mut rims {
            *speed += self.dice() * ENCODER_NOISE;
        }
        match self.fault {
            Fault::SwappedEncoders(a, b) => rims.swap(usize::from(a), usize::from(b)),
            Fault::ReversedEncoder(n) => change(&mut rims, n, |speed| -speed),
            Fault::DeadEncoder(n) => change(&mut rims, n, |_| 0.0),
            Fault::CoarseEncoder(n) => change(&mut rims, n, |speed| speed * 0.4),
            _ => {}
        }
        self.receive();
        Reading { rims, seen: self.look(ball), radio: self.radio }
    }

    fn receive(&mut self) {
        if !self.steps.is_multiple_of(STEPS_PER_FRAME) || self.fault == Fault::NoRadio {
            return;
        }
        let luck = self.dice();
        match self.fault {
            Fault::LooseRadio if luck < -0.4 => {
                self.radio.lost += 1;
                self.radio.line_errors += 1;
            }
            Fault::NoAntenna if luck < 0.2 => self.radio.lost += 1,
            // A healthy link loses 2 %.
            _ if luck < -0.96 => self.radio.lost += 1,
            _ => self.radio.received += 1,
        }
    }

    fn look(&mut self, ball: bool) -> Seen {
        let volts = if self.fault == Fault::EmptyBattery { 12.4 } else { 15.6 };
        let turn = (self.steps > GYRO_STEPS && self.fault != Fault::NoImu).then(|| self.dice() * GYRO_NOISE);
        Seen {
            turn,
            ball: match self.fault {
                Fault::NoLamp => true,
                Fault::StuckBeam => false,
                _ => ball,
            },
            tipped: self.fault == Fault::ImuUpsideDown,
            battery: (self.fault != Fault::NoDivider).then(|| volts + self.dice() * DIVIDER_NOISE),
            kicker_ready: false,
        }
    }
}

fn change(values: &mut [f32; WHEELS], n: u8, with: impl Fn(f32) -> f32) {
    if let Some(value) = values.get_mut(usize::from(n)) {
        *value = with(*value);
    }
}

/// Plays the whole list on that robot, and passes each report on; a person holds a ball for a second, two
/// seconds after asked to. Returns how long it took.
pub fn play(fault: Fault, seed: u32, mut on_report: impl FnMut(CheckReport)) -> Duration {
    play_steps(fault, seed, |step| step.report.into_iter().for_each(&mut on_report))
}

/// Plays as [`play`] does, with each step of 1 ms passed on.
pub fn play_steps(fault: Fault, seed: u32, mut on_step: impl FnMut(&BenchStep)) -> Duration {
    let (mut bench, mut list) = (Bench::new(fault, seed), BringUp::new());
    let (mut motors, mut asked) = (Motors::Released, None);
    let mut now = Instant(0);
    loop {
        let held = asked.is_some_and(|asked| (BALL_COMES..BALL_GOES).contains(&now.since(asked)));
        let reading = bench.step(motors, held);
        let step = list.step(now, &reading);
        motors = step.motors;
        if step.check == Some(super::Check::Beam) && asked.is_none() {
            asked = Some(now);
        }
        on_step(&step);
        if step.check.is_none() {
            return now.since(Instant(0));
        }
        now += CONTROL_PERIOD;
    }
}

/// A motor reaches two thirds of a change in 30 ms (estimate).
const TIME_CONSTANT_STEPS: f32 = 30.0;
/// One count of the encoder in a step, m/s.
const ENCODER_NOISE: f32 = 0.03;
/// Noise of the gyroscope, rad/s.
const GYRO_NOISE: f32 = 0.01;
/// The gyroscope knows its offset after so many steps.
const GYRO_STEPS: u32 = 600;
/// Noise of the battery's divider, V.
const DIVIDER_NOISE: f32 = 0.05;
/// A host sends a frame every 10 ms.
const STEPS_PER_FRAME: u32 = 10;
/// The ball comes so long after it was asked for, and goes.
const BALL_COMES: Duration = Duration::millis(2_000);
const BALL_GOES: Duration = Duration::millis(3_000);

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::super::{CHECKS, Check, Finding};
    use super::*;

    fn reports(fault: Fault, seed: u32) -> Vec<CheckReport> {
        let mut all = Vec::new();
        let took = play(fault, seed, |report| all.push(report));
        assert!(took < Duration::millis(60_000), "{took:?}");
        assert_eq!(all.iter().map(|report| report.check).collect::<Vec<_>>(), CHECKS);
        all
    }

    fn findings(fault: Fault, seed: u32) -> Vec<(Check, Finding)> {
        reports(fault, seed).iter().filter_map(|one| Some((one.check, one.result.err()?))).collect()
    }

    #[test]
    fn a_healthy_robot_passes_every_check_with_any_noise() {
        for seed in 0..200 {
            assert_eq!(findings(Fault::None, seed), [], "seed {seed}");
        }
        let wheels: Vec<f32> = reports(Fault::None, 1)
            .iter()
            .filter(|report| matches!(report.check, Check::Wheel { .. }))
            .filter_map(|report| report.result.ok())
            .collect();
        assert_eq!(wheels.len(), 8);
        // A motor without load runs at its duty times its free speed.
        let free = 0.16 * RobotSpec::OURS.wheels.free_speed;
        assert!(wheels.iter().all(|speed| (speed.abs() - free).abs() < 0.02), "{wheels:?}");
    }

    /// Every wheel's fault, and what both checks of each wheel must find.
    fn of_wheel(fault: fn(u8) -> Fault, is_it: fn(u8, bool, Finding) -> bool, checks: usize) {
        for wheel in 0..WHEELS as u8 {
            for seed in 0..20 {
                let found = findings(fault(wheel), seed);
                assert_eq!(found.len(), checks, "{:?}: {found:?}", fault(wheel));
                for (check, finding) in &found {
                    let Check::Wheel { wheel: tested, forwards } = check else { panic!("{check:?}") };
                    assert!(
                        *tested == wheel && is_it(wheel, *forwards, *finding),
                        "{:?}: {found:?}",
                        fault(wheel)
                    );
                }
            }
        }
    }

    #[test]
    fn a_fault_of_one_wheel_is_found_at_that_wheel_and_nowhere_else() {
        of_wheel(Fault::ReversedMotor, |_, _, found| matches!(found, Finding::Reversed(_)), 2);
        of_wheel(Fault::ReversedEncoder, |_, _, found| matches!(found, Finding::Reversed(_)), 2);
        of_wheel(Fault::DeadWheel, |_, _, found| found == Finding::NoMotion, 2);
        of_wheel(Fault::DeadEncoder, |_, _, found| found == Finding::NoMotion, 2);
        of_wheel(Fault::CoarseEncoder, |_, _, found| matches!(found, Finding::Speed(..)), 2);
        of_wheel(
            Fault::StuckDirection,
            |_, forwards, found| !forwards && matches!(found, Finding::Reversed(_)),
            1,
        );
        of_wheel(
            Fault::JoinedDrivers,
            |wheel, _, found| matches!(found, Finding::MovesToo(with, _) if with == (wheel + 1) % 4),
            2,
        );
    }

    #[test]
    fn swapped_encoders_are_found_and_each_names_the_other() {
        for a in 0..WHEELS as u8 {
            for b in a + 1..WHEELS as u8 {
                let found = findings(Fault::SwappedEncoders(a, b), u32::from(a * 4 + b));
                assert_eq!(found.len(), 4, "{found:?}");
                for (check, finding) in found {
                    let (Check::Wheel { wheel, .. }, Finding::CountedBy(with, _)) = (check, finding) else {
                        panic!("{check:?}: {finding:?}")
                    };
                    assert!((wheel, with) == (a, b) || (wheel, with) == (b, a));
                }
            }
        }
    }

    #[test]
    fn every_other_fault_is_found_by_its_own_check_alone() {
        for seed in 0..50 {
            let only = |fault: Fault, check: Check, is_it: fn(&Finding) -> bool| {
                let found = findings(fault, seed);
                assert!(
                    found.len() == 1 && found[0].0 == check && is_it(&found[0].1),
                    "{fault:?}: {found:?}"
                );
            };
            only(Fault::NoDivider, Check::Battery, |found| *found == Finding::NoVoltage);
            only(Fault::EmptyBattery, Check::Battery, |found| matches!(found, Finding::Voltage(_)));
            only(Fault::NoImu, Check::Rest, |found| *found == Finding::NoGyroscope);
            only(Fault::ImuUpsideDown, Check::Rest, |found| *found == Finding::Tipped);
            only(Fault::NoRadio, Check::Radio, |found| *found == Finding::Silent);
            only(Fault::LooseRadio, Check::Radio, |found| matches!(found, Finding::LineErrors(..)));
            only(Fault::NoAntenna, Check::Radio, |found| matches!(found, Finding::Loses(..)));
            only(Fault::NoLamp, Check::Beam, |found| *found == Finding::Blocked);
            only(Fault::StuckBeam, Check::Beam, |found| *found == Finding::NeverInterrupted);
        }
    }

    #[test]
    fn a_ball_that_is_never_taken_away_ends_the_check_too_and_a_hand_is_no_ball() {
        let beam = |held: fn(u64) -> bool| {
            let (mut bench, mut list) = (Bench::new(Fault::None, 1), BringUp::new());
            list.next = CHECKS.len() - 1;
            (0..30_000).find_map(|ms| {
                let reading = bench.step(Motors::Released, held(ms));
                list.step(Instant(ms * 1_000), &reading).report
            })
        };
        let result = |held| beam(held).expect("it ends").result;
        assert_eq!(result(|ms| ms > 1_000), Err(Finding::StaysInterrupted));
        assert_eq!(result(|ms| ms > 1_000 && ms < 1_100), Err(Finding::NeverInterrupted));
        assert_eq!(result(|ms| ms < 2_000), Err(Finding::Blocked));
        assert!(result(|ms| ms > 1_000 && ms < 1_500).is_ok());
    }
}
