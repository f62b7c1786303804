//! `parts`: tests of robots that say which of their parts failed, and drive on without it.

use geometry::{Angle, Body, Field, Twist, Vector};
use motion::omni::Omni;
use protocol::parts::{Part, PartState};
use protocol::robot_io::{ActuatorFrame, OmniKick};

use chassis::{Chance, Chassis, PartFault};

mod chassis;
mod in_match;
mod places;

/// A driver who goes on as in a match: runs, turns, stops; pushed by others now and then.
struct Driver {
    chance: Chance,
    wanted: Twist<Field>,
    ordered: Twist<Field>,
    heading: f32,
    steps_left: u32,
    push_left: u32,
}

impl Driver {
    fn new(seed: u64) -> Self {
        let (chance, zero) = (Chance::new(seed + 7), Twist::default());
        Self { chance, wanted: zero, ordered: zero, heading: 0.0, steps_left: 0, push_left: 0 }
    }

    /// One step of 10 ms.
    fn step(&mut self, chassis: &mut Chassis) {
        if self.steps_left == 0 {
            self.steps_left = self.chance.between(30.0, 150.0) as u32;
            let speed = if self.chance.between(0.0, 1.0) < 0.2 { 0.0 } else { self.chance.between(0.3, 2.5) };
            let direction = Angle::new(self.chance.between(-3.1, 3.1));
            let turning = if speed > 0.0 { self.chance.between(-4.0, 4.0) } else { 0.0 };
            self.wanted = Twist { linear: Vector::polar(speed, direction), angular: turning };
        }
        if self.push_left == 0 {
            self.push_left = self.chance.between(100.0, 500.0) as u32;
        }
        (self.steps_left, self.push_left) = (self.steps_left - 1, self.push_left - 1);
        let pushed = self.push_left < 50;
        chassis.push = if pushed { Vector::new(3.0, -2.0) } else { Vector::default() };
        let change = (self.wanted.linear - self.ordered.linear).clamped(0.03);
        self.ordered.linear += change;
        self.ordered.angular += (self.wanted.angular - self.ordered.angular).clamp(-0.3, 0.3);
        self.heading += chassis.twist.angular * 0.01;
        let (s, c) = Angle::new(self.heading).sin_cos();
        let (x, y) = (self.ordered.linear.x(), self.ordered.linear.y());
        let linear: Vector<Body> = Vector::new(c * x + s * y, c * y - s * x);
        let wheels = Omni::default().rims(Twist { linear, angular: self.ordered.angular });
        chassis.drive(ActuatorFrame::Omni { wheels, dribbler: 0.0, kick: OmniKick::None });
    }
}

/// The fault of that number, and the part that has it.
fn fault(number: u64) -> (PartFault, Part) {
    let wheel = (number / 5 % 4) as u8;
    match number % 5 {
        0 | 1 => (PartFault::MotorOpen(wheel), Part::motor(wheel)),
        2 => (PartFault::EncoderDead(wheel), Part::encoder(wheel)),
        3 => (PartFault::EncoderWild(wheel), Part::encoder(wheel)),
        _ if wheel.is_multiple_of(2) => (PartFault::GyroscopeStuck, Part::GYROSCOPE),
        _ => (PartFault::GyroscopeOff(2.0), Part::GYROSCOPE),
    }
}

/// Time until the first part is named, s, and that part; of 4 s.
fn first_named(seed: u64, planted: PartFault) -> Option<(f32, Part)> {
    let (mut chassis, mut driver) = (Chassis::new(seed), Driver::new(seed));
    let at = Chance::new(seed + 13).between(300.0, 3_000.0) as u32;
    for _ in 0..at {
        driver.step(&mut chassis);
        assert_eq!(chassis.report().in_state(PartState::Failed).next(), None, "{seed}: before the fault");
    }
    chassis.plant(Some(planted));
    (1..400).find_map(|step| {
        driver.step(&mut chassis);
        let named = chassis.report().in_state(PartState::Failed).next();
        named.map(|part| (step as f32 * 0.01, part))
    })
}

/// Parts that are named in so many minutes without a fault.
fn named_without_fault(minutes: std::ops::Range<u64>) -> Vec<(u64, Part)> {
    let mut named = Vec::new();
    for seed in minutes {
        let (mut chassis, mut driver) = (Chassis::new(seed), Driver::new(seed));
        for _ in 0..6_000 {
            driver.step(&mut chassis);
        }
        named.extend(chassis.report().in_state(PartState::Failed).map(|part| (seed, part)));
    }
    named
}

/// Of the faults of these numbers: how many are named rightly within 2 s, rightly later or not, and wrongly.
fn judged(numbers: std::ops::Range<u64>) -> [u32; 3] {
    let mut judged = [0; 3];
    for number in numbers {
        let (planted, part) = fault(number);
        let named = first_named(1_000 + number, planted);
        let kind = match named {
            Some((_, other)) if other != part => 2,
            Some((took, _)) if took <= 2.0 => 0,
            _ => 1,
        };
        if kind > 0 {
            println!("{number} {planted:?}: {named:?}");
        }
        judged[kind] += 1;
    }
    judged
}

#[test]
fn of_400_planted_faults_nine_of_ten_are_named_within_2_s() {
    let [in_time, late, wrong] = judged(20..420);
    println!("{in_time} in time, {late} later or not, {wrong} wrong");
    assert!(in_time >= 360 && wrong <= 8, "{in_time} in time, {late} later, {wrong} wrong");
}

#[test]
fn in_100_minutes_without_a_fault_no_part_is_named() {
    assert_eq!(named_without_fault(100..200), []);
}
