//! `watch`: outcome of a pass. It follows the field after a pass was ordered and gives one verdict, with its
//! evidence (Biswas et al. 2014 §3.2; failures by kind). Field frame, SI units.
//!
//! It uses snapshots only, so that a host, an arena or a replay can run it: any caller with a [`World`] every
//! few hundredths of a second. A touch is a robot near the ball and a ball that changes its direction there.

use geometry::{Field, Point, Vector};
use protocol::{Duration, Instant, RobotId, Who};
use rules::limits::{BALL_RADIUS, ROBOT_HEIGHT};
use rules::{Colour, FieldSpec, contact};

use super::conditions::ours_after;
use crate::world::{Ball, World};

/// A robot's centre this near the ball may touch it, m.
const TOUCHES_WITHIN_M: f32 = contact::PASS_TOUCHED_WITHIN;
/// Farther from the passer the ball has left it, m.
const LEFT_BEYOND_M: f32 = contact::PASS_LEFT_BEYOND;
/// A ball faster than this was kicked, m/s: slower than any pass, faster than a ball that is pushed along.
const KICKED_SPEED_MIN_M_S: f32 = 0.8;
/// A change of velocity that the field surface does not cause between two snapshots, m/s, and as a share of
/// the speed.
const SPEED_CHANGE_MIN_M_S: f32 = 0.3;
const SPEED_CHANGE_MIN_SHARE: f32 = 0.15;
/// A slower ball counts as stopped, m/s.
const STOPPED_SPEED_MAX_M_S: f32 = 0.15;
/// A kick is known by its speed only after a few snapshots, s.
const KICK_KNOWN_AFTER_S: f32 = 0.3;
/// Distance from x* within which a receiver counts as there, and a ball as arrived, m: two robots' radii and
/// the ball.
const ARRIVED_WITHIN_M: f32 = 0.2;
/// A pass that has not left by then counts as not kicked: the time in which it may be searched
/// ([`super::ahead::SEARCH_TIME`]), and a second for the kick.
const KICK_TIME_MAX: Duration = Duration::millis(5000);
/// Time in which a receiver that missed it may still reach it, s.
const COLLECTED_TIME_MAX_S: f32 = 1.5;

/// A pass that was ordered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ordered {
    /// Time of the order.
    pub at: Instant,
    /// Colour of the passing team.
    pub us: Colour,
    /// The robot that kicks.
    pub passer: RobotId,
    /// The robot that shall receive it.
    pub receiver: RobotId,
    /// x0: place of the ball at the order.
    pub from: Point<Field>,
    /// x*: place of reception.
    pub to: Point<Field>,
    /// T_b: predicted time of the ball from x0 to x*, s.
    pub flight: f32,
    /// Whether it is a chip.
    pub chip: bool,
    /// P(c1) … P(c5) as rated last before the kick.
    pub conditions: [f32; 5],
    /// Distance of the opponent nearest to x0, m.
    pub pressed: f32,
}

impl Ordered {
    /// P(we have it) as rated last before the kick.
    pub fn likely(&self) -> f32 {
        ours_after(self.conditions.iter().product())
    }
}

/// Outcome of a pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PassVerdict {
    /// The receiver has received it.
    Received {
        /// Distance from x*, m.
        off: f32,
        /// Time later than T_b after the kick, s; earlier if negative.
        late: f32,
    },
    /// Another teammate has received it.
    ByTeammate {
        /// The teammate that received it.
        by: RobotId,
        /// Distance from x*, m.
        off: f32,
    },
    /// An opponent touched it first.
    Intercepted {
        /// The opponent that touched it.
        by: RobotId,
        /// Distance along the path from x0, m.
        along: f32,
        /// Time after the kick, s.
        after: f32,
    },
    /// A ball that passed, or stopped short of, a receiver that was there.
    Missed {
        /// The ball's least distance from x*, m.
        by: f32,
    },
    /// A ball that passed x* before the receiver was there.
    Late {
        /// The receiver's distance from x* then, m.
        receiver_off: f32,
    },
    /// A ball that left the field before any robot touched it.
    Out {
        /// Place where it left the field.
        at: Point<Field>,
    },
    /// The ball never left the passer.
    NoKick {
        /// Time after the order, s.
        after: f32,
        /// An opponent took the ball away.
        lost_to: Option<RobotId>,
    },
}

impl PassVerdict {
    /// Our team has the ball.
    pub fn is_success(&self) -> bool {
        matches!(self, Self::Received { .. } | Self::ByTeammate { .. })
    }
}

/// Follows one pass; see [`PassWatch::observe`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassWatch {
    ordered: Ordered,
    flight: Option<Flight>,
}

/// A ball that has left the passer.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Flight {
    since: Instant,
    /// Least distance of the ball from x* so far, m.
    nearest: f32,
    /// When it passed x*: the receiver's distance, m.
    receiver_off: Option<f32>,
    /// The robot at the ball, since when, and the ball's velocity before.
    contact: Option<(Who, Vector<Field>)>,
    velocity: Vector<Field>,
}

impl PassWatch {
    /// A watch that starts with the order.
    pub fn new(ordered: Ordered) -> Self {
        Self { ordered, flight: None }
    }

    /// The pass it follows.
    pub fn ordered(&self) -> &Ordered {
        &self.ordered
    }

    /// The next camera frame. A verdict ends the watch.
    pub fn observe(&mut self, world: &World, field: &FieldSpec) -> Option<PassVerdict> {
        let Some(ball) = world.ball else { return self.over(world.time) };
        match self.flight {
            None => self.before(world, &ball),
            Some(mut flight) => {
                let verdict = self.during(&mut flight, world, &ball, field);
                self.flight = Some(flight);
                verdict.or_else(|| self.over(world.time))
            }
        }
    }

    fn before(&mut self, world: &World, ball: &Ball) -> Option<PassVerdict> {
        let passer = Who { colour: self.ordered.us, id: self.ordered.passer };
        let off =
            world.robot(passer).map_or(f32::INFINITY, |robot| robot.pose.position.distance(ball.position));
        let after = world.time.since(self.ordered.at).as_secs_f32();
        if let Some((robot, distance)) = world.nearest(ball.position)
            && robot.who.colour != self.ordered.us
            && distance < TOUCHES_WITHIN_M
            && off > TOUCHES_WITHIN_M
        {
            return Some(PassVerdict::NoKick { after, lost_to: Some(robot.who.id) });
        }
        if off > LEFT_BEYOND_M && ball.velocity.norm() > KICKED_SPEED_MIN_M_S {
            self.flight = Some(Flight {
                since: world.time,
                nearest: ball.position.distance(self.ordered.to),
                receiver_off: None,
                contact: None,
                velocity: ball.velocity,
            });
            return None;
        }
        (after > KICK_TIME_MAX.as_secs_f32()).then_some(PassVerdict::NoKick { after, lost_to: None })
    }

    fn during(
        &self,
        flight: &mut Flight,
        world: &World,
        ball: &Ball,
        field: &FieldSpec,
    ) -> Option<PassVerdict> {
        let Ordered { us, receiver, from, to, .. } = self.ordered;
        let before = core::mem::replace(&mut flight.velocity, ball.velocity);
        let after = world.time.since(flight.since).as_secs_f32();
        let off = ball.position.distance(to);
        flight.nearest = flight.nearest.min(off);
        let path = to - from;
        let passed = (ball.position - to).dot(path) >= 0.0;
        if passed && flight.receiver_off.is_none() {
            let robot = world.robot(Who { colour: us, id: receiver });
            flight.receiver_off = Some(robot.map_or(f32::INFINITY, |robot| robot.pose.position.distance(to)));
        }
        if let Some(who) = self.touch(flight, before, world, ball) {
            return Some(match (who.colour == us, who.id) {
                (true, id) if id == receiver => {
                    PassVerdict::Received { off, late: after - self.ordered.flight }
                }
                (true, by) => PassVerdict::ByTeammate { by, off },
                (false, by) => {
                    let along = path.unit().map_or(0.0, |along| (ball.position - from).dot(along));
                    PassVerdict::Intercepted { by, along, after }
                }
            });
        }
        let out = BALL_RADIUS;
        if field.clamp(ball.position, -out).distance(ball.position) > 0.0 {
            return Some(PassVerdict::Out { at: ball.position });
        }
        let stopped = ball.velocity.norm() < STOPPED_SPEED_MAX_M_S && after > KICK_KNOWN_AFTER_S;
        stopped.then(|| flight.end())
    }

    /// The robot that has just touched the ball; the passer's own kick does not count.
    fn touch(&self, flight: &mut Flight, before: Vector<Field>, world: &World, ball: &Ball) -> Option<Who> {
        let near = world
            .nearest(ball.position)
            .filter(|(_, distance)| *distance < TOUCHES_WITHIN_M && ball.height < ROBOT_HEIGHT)
            .map(|(robot, _)| robot.who)
            .filter(|who| *who != Who { colour: self.ordered.us, id: self.ordered.passer });
        match (near, flight.contact) {
            (Some(who), Some((same, came))) if who == same => {
                let change = (ball.velocity - came).norm();
                (change > SPEED_CHANGE_MIN_M_S + SPEED_CHANGE_MIN_SHARE * came.norm()).then_some(who)
            }
            (Some(who), _) => {
                flight.contact = Some((who, before));
                let change = (ball.velocity - before).norm();
                (change > SPEED_CHANGE_MIN_M_S + SPEED_CHANGE_MIN_SHARE * before.norm()).then_some(who)
            }
            // It left the robot again: a touch, if it changed its direction.
            (None, Some((who, came))) => {
                flight.contact = None;
                let change = (ball.velocity - came).norm();
                (change > SPEED_CHANGE_MIN_M_S + SPEED_CHANGE_MIN_SHARE * came.norm()).then_some(who)
            }
            (None, None) => None,
        }
    }

    /// A ball that no camera saw again, or that rolls on without a receiver.
    fn over(&self, now: Instant) -> Option<PassVerdict> {
        match self.flight {
            None => {
                let after = now.since(self.ordered.at);
                let after = (after > KICK_TIME_MAX).then_some(after.as_secs_f32())?;
                Some(PassVerdict::NoKick { after, lost_to: None })
            }
            Some(flight) => {
                let after = now.since(flight.since).as_secs_f32();
                (after > self.ordered.flight + COLLECTED_TIME_MAX_S).then(|| flight.end())
            }
        }
    }
}

impl Flight {
    /// The verdict where no robot received it: late or missed.
    fn end(&self) -> PassVerdict {
        match self.receiver_off {
            Some(receiver_off) if receiver_off > ARRIVED_WITHIN_M && self.nearest <= ARRIVED_WITHIN_M => {
                PassVerdict::Late { receiver_off }
            }
            _ => PassVerdict::Missed { by: self.nearest },
        }
    }
}

#[cfg(test)]
mod tests;
