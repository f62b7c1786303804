//! `sensed`: an episode's world as a host estimates it: places and velocities by its tracker from cameras'
//! late and noisy frames, and robots' own reports of ball contact.

use hil_sim::small_size::camera::Cameras;
use hil_sim::small_size::compatibility::Profile;
use hil_sim::small_size::worlds::VisionModel;
use hil_sim::small_size::{Ball, World};
use host::tracking::Tracker;
use protocol::Instant;

/// Cameras over an episode's field, and the tracker behind them.
#[derive(Clone, Debug)]
pub struct SensedWorld {
    cameras: Cameras,
    tracker: Tracker,
    /// The estimated state; what was not seen yet is where it was placed at the start.
    pub estimated: World,
}

impl SensedWorld {
    /// At the start of an episode.
    pub fn new(world: &World, vision: VisionModel, seed: u64) -> Self {
        let cameras = Cameras::of_model(Profile::Ours, 0.0, world, vision, seed);
        Self { cameras, tracker: Tracker::default(), estimated: world.clone() }
    }

    /// Takes the frames that are due; to be called after every step of the world.
    pub fn look(&mut self, world: &World) {
        self.cameras.watch(world);
        while let Some(packet) = self.cameras.poll(world.now()) {
            self.tracker.handle(&packet, now(world));
        }
    }

    /// Estimates the state as it is now.
    pub fn estimate(&mut self, world: &World) {
        let tracked = self.tracker.world(now(world));
        if let Some(ball) = tracked.ball {
            let seen = Ball {
                height: ball.height,
                climb: ball.climb,
                ..Ball::rolling(ball.position, ball.velocity)
            };
            self.estimated.put_ball(seen);
        }
        for robot in world.robots() {
            let contact = robot.ball_contact;
            if let Some(seen) = tracked.robot(robot.who) {
                let estimated = self.estimated.put(robot.who, seen.pose);
                (estimated.velocity, estimated.turning) = (seen.velocity, seen.angular);
            }
            self.estimated.alter(robot.who, |estimated| estimated.ball_contact = contact);
        }
    }
}

fn now(world: &World) -> Instant {
    Instant(world.now() * 1_000)
}
