//! `calibration`: deviations of robots and ball from what is ordered, configured or learned, applied to a
//! host's orders.

use protocol::RobotId;
use protocol::host::{Directive, KickOrder};

use super::Host;

/// A learned gain scales a kick's order by 0.8 to 1.7, not more: values beyond are an error of learning, or a
/// broken kicker.
const GAIN_MIN: f32 = 1.0 / 1.7;
const GAIN_MAX: f32 = 1.0 / 0.8;

impl Host {
    /// Sets the deceleration of a rolling ball, m/s².
    pub(super) fn roll_with(&mut self, roll: f32) {
        self.roll = Some(roll);
        self.coach.set_ground(self.tracker.set_roll(roll));
    }

    /// Takes vision's deceleration of a rolling ball, until another is set or learned.
    pub(super) fn roll_as_seen(&mut self) {
        self.roll = None;
        self.coach.set_ground(self.tracker.clear_roll());
    }

    /// Gain of that robot's kicker: the learned value, else the configured one; a value set while the host
    /// runs replaces what is learned.
    pub(super) fn kicks_by(&self, robot: RobotId) -> f32 {
        let learned = self.learned.kick(robot).filter(|_| self.settings.learns && !self.gain_set.has(robot));
        learned.map_or(self.settings.kick[robot.index()], |known| known.value.clamp(GAIN_MIN, GAIN_MAX))
    }

    /// The same directive, corrected for a kicker that kicks harder or softer than ordered.
    pub(super) fn calibrated(&self, robot: RobotId, mut directive: Directive) -> Directive {
        let factor = self.kicks_by(robot);
        if factor != 1.0
            && let Directive::Kick { kick, .. } | Directive::Pass { kick, .. } = &mut directive
        {
            let (KickOrder::Flat(speed) | KickOrder::Chip(speed)) = kick;
            *speed = (f32::from(*speed) / factor) as u16;
        }
        directive
    }
}
