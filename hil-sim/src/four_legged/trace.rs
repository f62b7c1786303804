//! `trace`: trace hash of a trial. A hash of all state and all messages, tick by tick, as
//! docs/architecture.md §2.5 lists them.
//!
//! Per tick, in order: the tick's number (u32); the ball's position and velocity; every robot's pose and
//! velocity in its own frame, attackers by id and then opponents in their order (f32 bits); every order to a
//! body (robot id, postcard bytes); every packet delivered, in delivery order (receiver id, length, bytes).
//! All little endian. The simulator computes it, so native and QEMU runs are hashed by the same code.

use protocol::RobotId;
use protocol::robot_io::ActuatorFrame;
use serde::{Deserialize, Serialize};

use crate::four_legged::world::{LeggedBall, LeggedWorld, Walker};
use crate::hash::Fnv;

/// A running hash of a trial.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct TraceHash(pub(crate) Fnv);

impl TraceHash {
    /// Hashes the start of a tick with this state of the world.
    pub fn tick(&mut self, number: u32, world: &LeggedWorld) {
        self.0.add(&number.to_le_bytes());
        self.ball(&world.ball);
        for walker in &world.walkers {
            self.robot(walker);
        }
    }

    /// Hashes an order to a robot's body.
    pub fn order(&mut self, robot: RobotId, order: &ActuatorFrame) {
        self.0.add(&[robot.number()]);
        self.frame(order);
    }

    /// An order's postcard bytes.
    pub(crate) fn frame(&mut self, order: &ActuatorFrame) {
        let mut bytes = [0; ORDER_LEN_MAX];
        if let Ok(bytes) = postcard::to_slice(order, &mut bytes) {
            self.0.add(bytes);
        }
    }

    /// Hashes a packet delivered to a robot.
    pub fn packet(&mut self, receiver: RobotId, packet: &[u8]) {
        self.0.add(&[receiver.number(), packet.len() as u8]);
        self.0.add(packet);
    }

    /// The hash as sixteen hexadecimal digits.
    pub fn digits(&self) -> String {
        self.0.to_string()
    }

    fn ball(&mut self, ball: &LeggedBall) {
        let (p, v) = (ball.position, ball.velocity);
        for value in [p.x(), p.y(), v.x(), v.y()] {
            self.0.add_f32(value);
        }
    }

    fn robot(&mut self, walker: &Walker) {
        let (pose, twist) = (walker.pose, walker.twist);
        let (p, v) = (pose.position, twist.linear);
        for value in [p.x(), p.y(), pose.heading.radians(), v.x(), v.y(), twist.angular] {
            self.0.add_f32(value);
        }
    }
}

/// The longest order in postcard bytes: a tag, four wheels, a dribbler, a kick with its speed.
const ORDER_LEN_MAX: usize = 32;

#[cfg(test)]
mod tests {
    use geometry::{Point, Twist, Vector};
    use protocol::robot_io::{LeggedKick, LeggedPrimitive, OmniKick};

    use super::*;
    use crate::Parameters;

    fn order(x: f32) -> ActuatorFrame {
        let walk = Twist { linear: Vector::new(x, 0.0), angular: 0.0 };
        ActuatorFrame::Legged { walk, primitive: LeggedPrimitive::Kick(LeggedKick::Pass(1.0)) }
    }

    fn hash(fill: impl Fn(&mut TraceHash)) -> String {
        let mut hash = TraceHash::default();
        fill(&mut hash);
        hash.digits()
    }

    #[test]
    fn a_resting_world_is_hashed_as_the_module_documents() {
        let world = LeggedWorld::new(Parameters::four_legged(), 0, Point::new(1.0, -2.0), Vec::new());
        let mut by_hand = Fnv::default();
        by_hand.add(&[7, 0, 0, 0]);
        // 1.0 is 0x3f800000 and −2.0 is 0xc0000000.
        by_hand.add(&[0, 0, 0x80, 0x3f, 0, 0, 0, 0xc0, 0, 0, 0, 0, 0, 0, 0, 0]);
        assert_eq!(hash(|h| h.tick(7, &world)), by_hand.to_string());
    }

    #[test]
    fn the_last_bit_of_an_order_counts() {
        let robot = RobotId::new(1).unwrap();
        let flipped = f32::from_bits(0.25_f32.to_bits() ^ 1);
        assert_ne!(hash(|h| h.order(robot, &order(0.25))), hash(|h| h.order(robot, &order(flipped))));
    }

    #[test]
    fn every_order_fits_its_buffer() {
        let omni = ActuatorFrame::Omni { wheels: [1.0; 4], dribbler: 1.0, kick: OmniKick::Chip(2.0) };
        for frame in [order(1.0), omni] {
            assert!(postcard::to_slice(&frame, &mut [0; ORDER_LEN_MAX]).is_ok());
        }
    }
}
