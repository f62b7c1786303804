//! `trace`: trace hash of a match. The hash of docs/architecture.md §2.5 over a Small Size world, tick by
//! tick.
//!
//! Per tick of 10 ms, in order: the tick's number (u32); the ball's position, height, velocity and climb; of
//! every robot present its slot (a byte), pose and velocity, turning; every order to a body (slot, postcard
//! bytes); every packet delivered (receiver's slot, length, bytes). f32 bits, all little endian.

use protocol::robot_io::ActuatorFrame;

use super::World;
use crate::four_legged::trace::TraceHash;
use protocol::Who;

impl TraceHash {
    /// Hashes the start of a tick with this state of the Small Size world.
    pub fn small_size_tick(&mut self, number: u32, world: &World) {
        self.0.add(&number.to_le_bytes());
        let ball = &world.ball;
        let (p, v) = (ball.position, ball.velocity);
        for value in [p.x(), p.y(), ball.height, v.x(), v.y(), ball.climb] {
            self.0.add_f32(value);
        }
        for robot in world.robots().iter().filter(|robot| robot.present) {
            self.0.add(&[robot.who.slot() as u8]);
            let (p, v) = (robot.pose.position, robot.velocity);
            for value in [p.x(), p.y(), robot.pose.heading.radians(), v.x(), v.y(), robot.turning] {
                self.0.add_f32(value);
            }
        }
    }

    /// Hashes an order to a robot's body.
    pub fn small_size_order(&mut self, who: Who, order: &ActuatorFrame) {
        self.0.add(&[who.slot() as u8]);
        self.frame(order);
    }

    /// Hashes a packet delivered to a robot.
    pub fn small_size_packet(&mut self, who: Who, packet: &[u8]) {
        self.0.add(&[who.slot() as u8, packet.len() as u8]);
        self.0.add(packet);
    }
}

#[cfg(test)]
mod tests {
    use geometry::Point;
    use rules::League;

    use super::*;
    use crate::hash::Fnv;
    use crate::small_size::{Ball, Parameters};

    #[test]
    fn a_world_with_a_ball_alone_is_hashed_as_the_module_documents() {
        let mut world = World::new(League::DivisionB, Parameters::of(League::DivisionB).unwrap(), 0);
        world.put_ball(Ball::at(Point::new(1.0, -2.0)));
        let mut by_hand = Fnv::default();
        by_hand.add(&[7, 0, 0, 0]);
        // 1.0 is 0x3f800000 and −2.0 is 0xc0000000; height, velocity and climb are 0.
        by_hand.add(&[0, 0, 0x80, 0x3f, 0, 0, 0, 0xc0]);
        by_hand.add(&[0; 16]);
        let mut hash = TraceHash::default();
        hash.small_size_tick(7, &world);
        assert_eq!(hash.digits(), by_hand.to_string());
    }
}
