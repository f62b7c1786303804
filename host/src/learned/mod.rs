//! `learned`: what a host learns of its robots and its field while it plays: how hard each robot kicks, how late it moves, how balls roll.
//! Online, bounded, and robust: medians of the last samples, each of which is checked against what can be. SI units.
//!
//! | module | from | gives |
//! |---|---|---|
//! | `kick` | flat kicks that were ordered with a speed, and the ball after them | speed of the ball over speed ordered, by robot |
//! | `latency` | orders to go that meet a robot at rest, and when it moves | time from the order to the motion, s, by robot |
//! | `friction` | balls that roll with no robot near | their deceleration, m/s² |
//!
//! [`Learned::see`] is called with every snapshot. [`crate::HostSettings::learns`] sets whether the host also
//! uses the result.

mod file;
mod friction;
mod kick;
mod latency;
mod samples;

use protocol::host::Command;
use protocol::{Instant, RobotId};
use rules::{Colour, Phase, Side};

use crate::world::World;

pub use file::kept;
pub use samples::Estimate;

/// What is learned.
#[derive(Clone, Debug, Default)]
pub struct Learned {
    kicks: kick::Kicks,
    latencies: latency::Latencies,
    friction: friction::Friction,
}

impl Learned {
    /// A snapshot of the field as the newest camera frame showed it, not carried forward, and what our robots were ordered at `now`
    /// because of it, with kicks as they went out.
    pub fn see(
        &mut self,
        now: Instant,
        (world, us): (&World, Colour),
        phase: Phase<Side>,
        commands: &[Command],
    ) {
        self.kicks.see(now, world, us, commands);
        self.latencies.see(now, world, us, phase, commands);
        self.friction.see(world);
    }

    /// Ball speed over speed ordered of that robot, 0.4–2.
    pub fn kick(&self, robot: RobotId) -> Option<Estimate> {
        self.kicks.gain(robot)
    }

    /// From an order to the motion of that robot, s, 0–0.3.
    pub fn latency(&self, robot: RobotId) -> Option<Estimate> {
        self.latencies.latency(robot)
    }

    /// Deceleration of a rolling ball, m/s², 0.05–1.5.
    pub fn friction(&self) -> Option<Estimate> {
        self.friction.deceleration()
    }
}

#[cfg(test)]
impl Learned {
    /// With what is known of one robot's kicker.
    pub(crate) fn of_kick(robot: RobotId, gain: f32) -> Self {
        let mut learned = Self::default();
        learned.kicks.know(robot, gain);
        learned
    }
}
