//! `learned`: online estimates of each robot's kick gain and latency, and of the deceleration of rolling
//! balls. Bounded and robust: medians of the last samples, each of which is checked against a plausible
//! range. SI units.
//!
//! | module | from | gives |
//! |---|---|---|
//! | `kick` | flat kicks ordered with a speed, and the ball after them | speed of the ball over speed ordered, by robot |
//! | `latency` | orders to move to robots at standstill, and the start of their motion | time from the order to the motion, s, by robot |
//! | `friction` | balls that roll with no robot near | their deceleration, m/s² |
//!
//! [`Learned::see`] is called with every snapshot. [`crate::HostSettings::learns`] sets whether the host also
//! uses the result.

mod file;
mod friction;
mod kick;
mod latency;
mod samples;

use protocol::host::HostCommand;
use protocol::{Instant, RobotId};
use rules::{Colour, Phase, Side};

use crate::world::World;

pub use file::kept;
pub(crate) use kick::Kicks;
pub use samples::Estimate;

/// Estimates of kick gains, latencies and friction, with their samples.
#[derive(Clone, Debug, Default)]
pub struct Learned {
    kicks: Kicks,
    latencies: latency::Latencies,
    friction: friction::Friction,
}

impl Learned {
    /// A snapshot of the field at the newest camera frame, not extrapolated, and the orders of our robots at
    /// `now` because of it, with kicks as they went out.
    pub fn see(
        &mut self,
        now: Instant,
        (world, us): (&World, Colour),
        phase: Phase<Side>,
        commands: &[HostCommand],
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
    /// With that gain for one robot's kicker.
    pub(crate) fn of_kick(robot: RobotId, gain: f32) -> Self {
        let mut learned = Self::default();
        learned.kicks.know(robot, gain);
        learned
    }
}
