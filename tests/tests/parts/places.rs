//! `places`: a robot with its brain, under a host that sends it from place to place. m, s, field frame.

use brain::{Brain, BrainConfig};
use geometry::{Angle, Field, GoalEnd, Point, Pose, Vector};
use protocol::host::{Directive, HostCommand, HostMessage, RuleRole, WireRobot, WireWho, WorldPart};
use protocol::parts::{Part, PartState};
use protocol::quantized::{WirePose, to_mm};
use protocol::robot_io::{Health, SensorFrame};
use protocol::{Duration, Instant, RobotId, TeamId};
use rules::{League, Phase, Side};

use crate::chassis::{Chance, Chassis, PartFault};

struct Led<'a> {
    brain: Brain<'a>,
    chassis: Chassis,
    pose: Pose<Field>,
    steps: u64,
}

impl Led<'_> {
    fn velocity(&self) -> Vector<Field> {
        let (s, c) = self.pose.heading.sin_cos();
        let own = self.chassis.twist.linear;
        Vector::new(c * own.x() - s * own.y(), s * own.x() + c * own.y())
    }

    fn show(&mut self, now: Instant, to: Pose<Field>) {
        let velocity = self.velocity();
        let robot = WireRobot {
            who: WireWho { side: Side::Ours, id: ID },
            pose: self.pose.into(),
            vx: to_mm(velocity.x()),
            vy: to_mm(velocity.y()),
        };
        let world = WorldPart {
            snapshot: self.steps as u8,
            part: 0,
            parts: 1,
            phase: Phase::Run,
            placement: None,
            ball: None,
            robots: [robot].into_iter().collect(),
        };
        let command = HostCommand {
            to: ID,
            defending: GoalEnd::Negative,
            phase: Phase::Run,
            rule_role: RuleRole::Player,
            directive: Directive::GoTo { pose: WirePose::from(to) },
        };
        for message in [HostMessage::World(world), HostMessage::Command(command)] {
            self.brain.handle_host_message(now, Duration(0), &message);
        }
    }

    /// One step of 10 ms.
    fn step(&mut self, to: Pose<Field>) {
        self.steps += 1;
        let now = Instant(self.steps * 10_000);
        if !self.steps.is_multiple_of(4) {
            self.show(now, to);
        }
        while let Some(due) = self.brain.poll_timeout().filter(|due| *due <= now) {
            self.brain.handle_timeout(due);
        }
        let sensors = SensorFrame {
            pose: None,
            ball: None,
            opponents: heapless::Vec::new(),
            ball_contact: false,
            busy: false,
            odometry: self.chassis.odometry(),
            health: Health { battery: Some(16.0), tipped: false, kicker_ready: true },
            camera: None,
        };
        self.brain.handle_sensors(now, &sensors);
        while self.brain.poll_message(now).is_some() {}
        if let Some(order) = self.brain.poll_actuators(now) {
            self.chassis.drive(order);
        }
        self.pose.heading = Angle::new(self.pose.heading.radians() + self.chassis.twist.angular * 0.01);
        self.pose.position += self.velocity() * 0.01;
    }
}

/// Seconds that 20 places take, each at most `limit` s, and the least distance from our defence area; with
/// that part broken before.
fn tour(planted: Option<(PartFault, Part)>, limit: f32) -> (f32, f32) {
    let config = BrainConfig::hosted(ID, TeamId(1), League::DivisionB);
    let brain = Brain::new(Instant(0), &config, case_library::division_b());
    let start = Pose { position: Point::new(-2.0, 0.0), heading: Angle::ZERO };
    let mut led = Led { brain, chassis: Chassis::new(1), pose: start, steps: 0 };
    let mut chance = Chance::new(3);
    led.chassis.plant(planted.map(|(fault, _)| fault));
    let (mut total, mut nearest) = (0.0, f32::INFINITY);
    // The first places are those on which a broken part is found.
    for number in 0..30 {
        let turn = Angle::new(chance.between(-3.0, 3.0));
        // Around the defence area, whose front is at x = −3.5.
        let x = chance.between(-4.2, -1.5);
        let y = chance.between(1.5, 2.6) * if number & 1 == 0 { 1.0 } else { -1.0 };
        let y = if number % 3 == 0 { y } else { chance.between(-1.0, 1.0) };
        let x = if y.abs() < 1.4 { x.max(-2.9) } else { x };
        let to = Pose { position: Point::new(x, y), heading: turn };
        let from = led.steps;
        let there = |led: &Led<'_>| {
            led.pose.position.distance(to.position) < 0.03 && led.chassis.twist.linear.norm() < 0.1
        };
        while !there(&led) {
            led.step(to);
            let at = led.pose.position;
            if number >= 10 {
                nearest = nearest.min((at.x() + 3.5).max(at.y().abs() - 1.0));
            }
            let took = (led.steps - from) as f32 * 0.01;
            assert!(
                took < limit,
                "place {number} at {to:?}: {took} s, at {at:?}, {:?}",
                led.chassis.report()
            );
        }
        if number >= 10 {
            total += (led.steps - from) as f32 * 0.01;
        }
    }
    if let Some((_, part)) = planted {
        assert_eq!(led.chassis.report().state(part), PartState::Failed);
    }
    (total, nearest)
}

#[test]
fn a_robot_without_one_motor_or_encoder_reaches_20_places_within_twice_the_time() {
    let (whole, clear) = tour(None, 10.0);
    for wheel in 0..4 {
        for (fault, part) in [
            (PartFault::MotorOpen(wheel), Part::motor(wheel)),
            (PartFault::EncoderDead(wheel), Part::encoder(wheel)),
        ] {
            let (degraded, least) = tour(Some((fault, part)), 20.0);
            println!(
                "{fault:?}: {degraded:.1} s, whole {whole:.1} s; {least:.3} m from the area, whole {clear:.3} m"
            );
            assert!(degraded < 2.0 * whole && least > 0.0);
        }
    }
}

const ID: RobotId = RobotId::ZERO;
