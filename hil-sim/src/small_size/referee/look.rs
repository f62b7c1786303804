//! `look`: the referee's observations of the simulated world, and the manual acts that it requests.

use protocol::{Instant, Who};

use super::InternalReferee;
use super::field_staff::WorldOrder;
use super::observation::{BallSeen, CrashSeen, Observation, RobotSeen};
use crate::small_size::{Ball, PhysicsEvent, World};

impl InternalReferee {
    /// Observes the world, about every 10 ms; `events` are the world's since the last call. Apply
    /// [`Self::poll_order`] afterwards.
    pub fn look(&mut self, world: &World, events: &[PhysicsEvent]) {
        let sight = Sight::of(world, events, self.begun.then_some(self.now));
        self.observe(&sight.observation());
    }
}

/// Data that an observation borrows.
pub(super) struct Sight {
    pub(super) time: Instant,
    pub(super) ball: BallSeen,
    pub(super) fastest: f32,
    pub(super) robots: Vec<RobotSeen>,
    pub(super) crashes: Vec<CrashSeen>,
}

impl Sight {
    /// The world now, with its events since the last observation, which was at `before`.
    pub(super) fn of(world: &World, events: &[PhysicsEvent], before: Option<Instant>) -> Self {
        let before = before.map(|at| at.0 / STEP_US);
        let since = |step: u64| before.is_some_and(|before| step > before);
        let here = world.robots().iter().filter(|robot| robot.present && !robot.bystander);
        let robots = here
            .map(|robot| RobotSeen {
                who: robot.who,
                pose: robot.pose,
                velocity: robot.velocity,
                touches_ball: robot.touched_at.is_some_and(since),
            })
            .collect();
        let (mut fastest, mut crashes) = (0.0_f32, Vec::new());
        for event in events {
            match *event {
                PhysicsEvent::Kicked { speed, .. } => fastest = speed.max(fastest),
                PhysicsEvent::Crash { robots, velocities, .. }
                    if !robots.iter().any(|who| stands_about(world, *who)) =>
                {
                    crashes.push(CrashSeen { between: robots, velocities });
                }
                _ => {}
            }
        }
        let Ball { position, height, velocity, climb, .. } = world.ball;
        let ball = BallSeen { position, height, velocity, climb };
        Self { time: Instant(world.now() * STEP_US), ball, fastest, robots, crashes }
    }

    fn observation(&self) -> Observation<'_> {
        Observation {
            time: self.time,
            ball: Some(self.ball),
            fastest: self.fastest,
            robots: &self.robots,
            crashes: &self.crashes,
        }
    }
}

fn stands_about(world: &World, who: Who) -> bool {
    world.robot(who).is_some_and(|robot| robot.bystander)
}

impl WorldOrder {
    /// Applies the manual act to the world.
    pub fn carry_out(self, world: &mut World) {
        match self {
            Self::PutBall(place) => {
                world.put_ball(Ball::at(place));
                world.make_room_for_ball();
            }
            Self::RemoveRobot(who) => world.remove(who),
            Self::ReturnRobot(who, pose) | Self::CarryRobot(who, pose) => {
                world.put(who, pose).tipped = false;
            }
        }
    }
}

/// Duration of a step of the world, µs.
const STEP_US: u64 = 1000;
