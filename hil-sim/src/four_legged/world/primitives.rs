//! `primitives`: grabs and kicks. They take time, grabs fail, kicks scatter (Ros et al. 2009 §5.2); m, s,
//! rad.

use geometry::{Angle, Vector, math};
use protocol::robot_io::LeggedKick;

use super::{Hold, LeggedWorld, PrimitiveKind, STEP, WorldEvent};

impl LeggedWorld {
    /// A step of the robot's current primitive, if any.
    pub(super) fn progress(&mut self, robot: usize) {
        let Some(mut action) = self.walkers[robot].action else { return };
        action.left -= STEP;
        let ends = action.left < 0.5 * STEP;
        self.walkers[robot].action = (!ends).then_some(action);
        match action.what {
            PrimitiveKind::Grab => {
                if self.hold.is_none() && self.in_grasp(robot) {
                    self.hold = Some(Hold { robot, firm: false });
                }
                if ends {
                    self.end_grab(robot);
                }
            }
            PrimitiveKind::Kick(kick) if ends => {
                if self.holder() == Some(robot) {
                    self.kick(robot, kick);
                } else {
                    self.events.push(WorldEvent::KickedNothing { robot });
                }
            }
            PrimitiveKind::Kick(_) => {}
        }
    }

    /// The kicks of a body with their nominal result: direction from straight ahead and distance, m; the hard
    /// one first.
    pub fn nominal_kicks(&self) -> [(LeggedKick, Angle, f32); 4] {
        let p = &self.parameters.kick;
        let side = Angle::degrees(p.side_angle_deg);
        [
            (LeggedKick::ForwardHard, Angle::ZERO, p.forward_hard),
            (LeggedKick::Left, side, p.side),
            (LeggedKick::Right, -side, p.side),
            (LeggedKick::ForwardSoft, Angle::ZERO, p.forward_soft),
        ]
    }

    /// Ends a grab: decides whether the legs closed upon the ball, and whether they keep it.
    fn end_grab(&mut self, robot: usize) {
        match self.hold {
            Some(hold) if hold.robot == robot && hold.firm => {}
            Some(Hold { robot: from, .. }) if from != robot => self.fight(robot, from),
            Some(hold) if hold.robot == robot && self.grabs.chance(self.parameters.grab.success) => {
                self.hold = Some(Hold { robot, firm: true });
                self.events.push(WorldEvent::Grabbed { robot });
            }
            Some(hold) if hold.robot == robot => {
                let aside = Angle::new(self.grabs.between(-math::FRAC_PI_2, math::FRAC_PI_2));
                let direction = self.walkers[robot].pose.heading + aside;
                self.hold = None;
                self.leaving = Some(robot);
                let away = Vector::polar(self.parameters.grab.fumble, direction);
                self.ball.send(self.parameters.ball.deceleration, away);
                self.events.push(WorldEvent::GrabFailed { robot });
            }
            _ => self.events.push(WorldEvent::GrabFailed { robot }),
        }
    }

    /// The legs have closed upon a ball between another robot's legs.
    fn fight(&mut self, robot: usize, from: usize) {
        let grab = &self.parameters.grab;
        let odds = grab.success * grab.contest;
        if self.in_grasp(robot) && self.grabs.chance(odds) {
            self.hold = Some(Hold { robot, firm: true });
            self.events.push(WorldEvent::Stolen { by: robot, from });
            self.events.push(WorldEvent::Grabbed { robot });
        } else {
            self.events.push(WorldEvent::GrabFailed { robot });
        }
    }

    fn kick(&mut self, robot: usize, kick: LeggedKick) {
        let (p, heading) = (&self.parameters.kick, self.walkers[robot].pose.heading);
        let side = Angle::degrees(p.side_angle_deg);
        let (direction, distance) = match kick {
            LeggedKick::ForwardSoft => (heading, p.forward_soft),
            LeggedKick::ForwardHard => (heading, p.forward_hard),
            LeggedKick::Left => (heading + side, p.side),
            LeggedKick::Right => (heading - side, p.side),
            // `max` first: a NaN distance becomes the shortest pass.
            LeggedKick::Pass(distance) => (heading, distance.max(p.pass_min).min(p.pass_max)),
        };
        let stretch = 1.0 + p.distance_sd * self.kicks.normal_within(p.scatter_limit);
        let aside = Angle::degrees(p.angle_sd_deg * self.kicks.normal_within(p.scatter_limit));
        self.hold = None;
        self.leaving = Some(robot);
        let from = self.ball.position;
        let deceleration = self.parameters.ball.deceleration;
        self.ball.send(deceleration, Vector::polar(distance * stretch, direction + aside));
        let rest = self.ball.rest(deceleration);
        self.events.push(WorldEvent::Kicked { robot, kick, from, rest });
    }
}
