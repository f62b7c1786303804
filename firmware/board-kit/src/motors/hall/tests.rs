//! `tests`: of the commutation, against a truth table made by hand and against a motor that turns.

use super::PhaseOutput::{Floating, High, Low};
use super::*;
use crate::encoders::EncoderCounts;
use crate::motors::testing::{Pin, Pwm};
use crate::motors::{Bridges, MotorDrivers};
use std::f64::consts::{PI, TAU};

/// A over B, B over C, C over A; then who is highest and who is lowest, worked out by hand.
const TRUTH: [(bool, bool, bool, Option<[PhaseOutput; 3]>); 8] = [
    (false, false, false, None),
    // A > C > B
    (true, false, false, Some([High, Low, Floating])),
    // B > A > C
    (false, true, false, Some([Floating, High, Low])),
    // A > B > C
    (true, true, false, Some([High, Floating, Low])),
    // C > B > A
    (false, false, true, Some([Low, Floating, High])),
    // C > A > B
    (true, false, true, Some([Floating, Low, High])),
    // B > C > A
    (false, true, true, Some([Low, High, Floating])),
    (true, true, true, None),
];

#[test]
fn the_table_is_the_one_made_by_hand_and_backwards_swaps_battery_and_ground() {
    for (a, b, c, outputs) in TRUTH {
        let code = u8::from(a) | u8::from(b) << 1 | u8::from(c) << 2;
        assert_eq!(commutation(code, false), outputs, "{code:03b}");
        let swapped = outputs.map(|each| {
            each.map(|output| match output {
                High => Low,
                Low => High,
                Floating => Floating,
            })
        });
        assert_eq!(commutation(code, true), swapped, "{code:03b} backwards");
    }
}

/// A motor, its driver's wires and its sensors. SI units; a phase has resistance and
/// back-EMF, its inductance (0.1 ms) is over within a step.
struct Motor {
    pwm: [Pwm; 3],
    enables: [Pin; 3],
    sensors: [Pin; 3],
    pairs: f64,
    angle: f64,
    speed: f64,
}

const BATTERY: f64 = 16.0;
const PHASE_OHM: f64 = 0.5;
/// V s/rad, and N m/A.
const CONSTANT: f64 = 0.02;
const INERTIA: f64 = 1e-5;
/// N m, against any motion, and N m s/rad.
const FRICTION: (f64, f64) = (0.004, 2e-6);
const STEP: f64 = 20e-6;

impl Motor {
    /// With one pair of poles.
    fn new(angle: f64) -> Self {
        Self::with_pairs(1.0, angle)
    }

    fn with_pairs(pairs: f64, angle: f64) -> Self {
        Self {
            pairs,
            pwm: core::array::from_fn(|_| Pwm::new()),
            enables: core::array::from_fn(|_| Pin::new()),
            sensors: core::array::from_fn(|_| Pin::new()),
            angle,
            speed: 0.0,
        }
    }

    fn driver(&self) -> ThreePwm<Pwm, Pin, Pin> {
        self.sense();
        ThreePwm::new(self.pwm.clone(), self.enables.clone(), self.sensors.clone())
    }

    /// Back-EMF of a phase for 1 rad/s and torque for 1 A, as a share of [`CONSTANT`].
    fn shape(&self) -> [f64; 3] {
        [0.0, -TAU / 3.0, TAU / 3.0].map(|lag| (self.pairs * self.angle + lag).cos())
    }

    fn sense(&self) {
        let [a, b, c] = self.shape();
        for (sensor, high) in self.sensors.iter().zip([a > b, b > c, c > a]) {
            sensor.put(high);
        }
    }

    fn step(&mut self) {
        let shape = self.shape();
        let on: std::vec::Vec<usize> = (0..3).filter(|n| self.enables[*n].is_set()).collect();
        let mut torque = 0.0;
        if let [one, other] = on[..] {
            let volts = |n: usize| BATTERY * f64::from(self.pwm[n].duty()) / 1000.0;
            let emf = CONSTANT * self.speed * (shape[one] - shape[other]);
            let current = (volts(one) - volts(other) - emf) / (2.0 * PHASE_OHM);
            torque = CONSTANT * current * (shape[one] - shape[other]);
        } else {
            assert!(on.is_empty(), "current through {} phases", on.len());
        }
        let (dry, viscous) = FRICTION;
        let free = self.speed + (torque - viscous * self.speed) / INERTIA * STEP;
        let stop = dry / INERTIA * STEP;
        self.speed = free.signum() * (free.abs() - stop).max(0.0);
        self.angle += self.speed * STEP;
        self.sense();
    }

    /// Runs for that many seconds, commutated at each edge.
    fn run(&mut self, driver: &mut ThreePwm<Pwm, Pin, Pin>, seconds: f64) {
        for _ in 0..(seconds / STEP) as u32 {
            let before = self.sensors.each_ref().map(Pin::is_set);
            self.step();
            if self.sensors.each_ref().map(Pin::is_set) != before {
                assert!(driver.commutate());
            }
        }
    }
}

#[test]
fn a_motor_turns_both_ways_from_any_angle_and_its_edges_are_counted() {
    for start in 0..24 {
        let mut motor = Motor::new(f64::from(start) * TAU / 24.0 + 0.01);
        let mut driver = motor.driver();
        for (duty, sign) in [(0.5, 1.0), (-0.5, -1.0)] {
            assert!(driver.set(duty));
            // The time of what the last share has left.
            motor.run(&mut driver, 0.3);
            let (angle, count) = (motor.angle, driver.count());
            motor.run(&mut driver, 0.2);
            // 8 V over the mean of 1.65 times the constant, less friction.
            let expected = sign * 8.0 / (1.65 * CONSTANT);
            assert!((motor.speed / expected - 1.0).abs() < 0.15, "{start}: {} of {expected}", motor.speed);
            let sixths = (motor.angle - angle) / (PI / 3.0);
            let counted = f64::from(driver.count().wrapping_sub(count).cast_signed());
            assert!((counted - sixths).abs() <= 2.0, "{counted} of {sixths}");
        }
    }
}

#[test]
fn a_motor_with_two_sensors_exchanged_does_not_reach_half_its_speed() {
    // So that the test above is known to tell a right table from a wrong one.
    let mut motor = Motor::new(0.3);
    let [a, b, c] = motor.sensors.clone();
    motor.sense();
    let mut driver = ThreePwm::new(motor.pwm.clone(), motor.enables.clone(), [b, a, c]);
    driver.set(0.5);
    motor.run(&mut driver, 0.5);
    assert!(motor.speed.abs() < 0.5 * 8.0 / (1.65 * CONSTANT), "{}", motor.speed);
}

#[test]
fn a_broken_sensor_no_share_and_a_dead_driver_leave_all_phases_floating() {
    let motor = Motor::new(0.3);
    let mut driver = motor.driver();
    let floating = || motor.enables.iter().all(|enable| !enable.is_set());
    assert!(floating() && driver.set(0.5) && !floating());
    driver.off();
    assert!(floating() && driver.commutate() && floating(), "an edge after `off` gives no current");
    assert!(driver.set(0.5) && !floating());
    motor.sensors.iter().for_each(|sensor| sensor.put(true));
    assert!(!driver.commutate() && floating());
    motor.sense();
    assert!(driver.set(0.5) && !floating());
    motor.pwm.iter().for_each(Pwm::break_it);
    assert!(!driver.commutate() && floating());
}

#[test]
fn edges_count_both_ways_and_a_jump_over_half_a_turn_does_not() {
    let mut counter = HallCounter::default();
    assert_eq!([0b001, 0b011, 0b010, 0b110].map(|code| counter.step(code)), [0, 1, 2, 3]);
    assert_eq!([0b010, 0b111, 0b011].map(|code| counter.step(code)), [2, 2, 1]);
    assert_eq!(counter.step(0b100), 1, "half a turn");
    assert_eq!(counter.step(0b001), 3, "an edge was missed");
}

#[test]
fn four_shared_motors_turn_as_driven_with_edges_that_commutate_between_steps() {
    let mut motors = [0.3, 1.7, 3.1, 5.0].map(|angle| Motor::with_pairs(8.0, angle));
    let shared: [HallMotor<Pwm, Pin, Pin>; 4] = core::array::from_fn(|_| HallMotor::new());
    for (motor, shared) in motors.iter().zip(&shared) {
        shared.wire(motor.driver());
    }
    let (dribbler, enable, fault) = (Pwm::new(), Pin::new(), Pin::new());
    fault.put(true);
    let mut bridges = Bridges::new(shared.each_ref(), dribbler, enable.clone(), fault.clone());
    let encoders = shared.each_ref();
    let duty = [1.0, -1.0, 0.5, -0.25];
    let milliseconds = |bridges: &mut Bridges<_, _, _, _>, motors: &mut [Motor; 4], duty: [f32; 4], count| {
        for _ in 0..count {
            bridges.drive(duty, 0.0);
            for (motor, shared) in motors.iter_mut().zip(&shared) {
                for _ in 0..(0.001 / STEP) as u32 {
                    let before = motor.sensors.each_ref().map(Pin::is_set);
                    motor.step();
                    if motor.sensors.each_ref().map(Pin::is_set) != before {
                        // The interrupt.
                        assert!(shared.edge());
                    }
                }
            }
        }
    };
    milliseconds(&mut bridges, &mut motors, duty, 400);
    let (angles, counts) = (motors.each_ref().map(|motor| motor.angle), encoders.counts());
    milliseconds(&mut bridges, &mut motors, duty, 200);
    for n in 0..4 {
        let expected = f64::from(duty[n]) * BATTERY / (1.65 * CONSTANT);
        assert!((motors[n].speed / expected - 1.0).abs() < 0.15, "{n}: {} of {expected}", motors[n].speed);
        let sixths = 8.0 * (motors[n].angle - angles[n]) / (PI / 3.0);
        let counted = f64::from(encoders.counts()[n].wrapping_sub(counts[n]).cast_signed());
        assert!((counted - sixths).abs() <= 2.0, "{n}: {counted} of {sixths}");
    }
    // A driver that has switched itself off takes the current off all, and no edge brings it back.
    fault.put(false);
    milliseconds(&mut bridges, &mut motors, duty, 1);
    assert!(bridges.has_fault() && !enable.is_set());
    assert!(motors.iter().all(|motor| motor.enables.iter().all(|enable| !enable.is_set())));
}

#[test]
fn without_interrupts_full_speed_is_not_reached_and_without_a_driver_nothing_turns() {
    // So that the test above is known to need the edges.
    let mut motor = Motor::with_pairs(8.0, 0.3);
    let shared = HallMotor::new();
    shared.wire(motor.driver());
    for _ in 0..600 {
        (&shared).set(1.0);
        (0..(0.001 / STEP) as u32).for_each(|_| motor.step());
    }
    let reached = motor.speed * 1.65 * CONSTANT / BATTERY;
    assert!(reached < 0.85, "{reached}");
    let empty: HallMotor<Pwm, Pin, Pin> = HallMotor::default();
    assert!(!(&empty).set(0.5) && !empty.edge() && empty.count() == 0);
}
