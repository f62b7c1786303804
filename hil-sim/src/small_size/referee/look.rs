//! How does the referee look at the simulated world, and how is done what it asks people for?

use protocol::Instant;

use super::InternalReferee;
use super::observation::{BallSeen, CrashSeen, Observation, RobotSeen};
use super::people::WorldOrder;
use crate::small_size::{Ball, Event, World};

impl InternalReferee {
    /// Looks at the world, every 10 ms or so; `events` are the world's since the last look. Carry out
    /// [`Self::poll_order`] afterwards.
    pub fn look(&mut self, world: &World, events: &[Event]) {
        let before = self.now.0 / STEP_US;
        let begun = self.begun;
        let here = world.robots().iter().filter(|robot| robot.present);
        let robots: Vec<RobotSeen> = here
            .map(|robot| RobotSeen {
                who: robot.who,
                pose: robot.pose,
                velocity: robot.velocity,
                touches_ball: begun && robot.touched_at.is_some_and(|step| step > before),
            })
            .collect();
        let mut fastest = 0.0;
        let mut crashes = Vec::new();
        for event in events {
            match *event {
                Event::Kicked { speed, .. } => fastest = speed.max(fastest),
                Event::Crash { robots, velocities, .. } => {
                    crashes.push(CrashSeen { between: robots, velocities });
                }
                _ => {}
            }
        }
        let Ball { position, height, velocity, climb, .. } = world.ball;
        self.observe(&Observation {
            time: Instant(world.now() * STEP_US),
            ball: Some(BallSeen { position, height, velocity, climb }),
            fastest,
            robots: &robots,
            crashes: &crashes,
        });
    }
}

impl WorldOrder {
    /// Does it.
    pub fn carry_out(self, world: &mut World) {
        match self {
            Self::PutBall(place) => {
                world.put_ball(Ball::at(place));
                world.make_room_for_ball();
            }
            Self::RemoveRobot(who) => world.remove(who),
            Self::ReturnRobot(who, pose) | Self::CarryRobot(who, pose) => {
                world.put(who, pose);
            }
        }
    }
}

/// A step of the world, µs.
const STEP_US: u64 = 1000;
