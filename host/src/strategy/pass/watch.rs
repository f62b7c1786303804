//! `watch`: outcome of a pass. A watch that follows the field after a pass was ordered and gives one verdict,
//! with its evidence (Biswas et al. 2014 §3.2; failures by kind). Field frame, SI units.
//!
//! It looks at pictures alone, so that a host, an arena or a replay can hold it: whoever has a [`World`] every few hundredths of a
//! second. A touch is a robot near the ball and a ball that changes its way there.

use geometry::{Field, Point, Vector};
use protocol::{Duration, Instant, RobotId, Who};
use rules::limits::{BALL_RADIUS, ROBOT_HEIGHT};
use rules::{Colour, FieldSpec, contact};

use crate::world::{Ball, World};

/// A pass that was ordered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ordered {
    /// When.
    pub at: Instant,
    /// Whose.
    pub us: Colour,
    /// Who kicks.
    pub passer: RobotId,
    /// Who shall have it.
    pub receiver: RobotId,
    /// x0.
    pub from: Point<Field>,
    /// x*.
    pub to: Point<Field>,
    /// T_b, s.
    pub flight: f32,
    /// Through the air.
    pub chip: bool,
    /// P(receive), as it was rated.
    pub likely: f32,
}

/// What became of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// The receiver has it.
    Received {
        /// This far from x*, m.
        off: f32,
        /// This much later than T_b after the kick, s; earlier if negative.
        late: f32,
    },
    /// Another mate has it.
    ByMate {
        /// Who.
        by: RobotId,
        /// This far from x*, m.
        off: f32,
    },
    /// An opponent touched it first.
    Intercepted {
        /// Who.
        by: RobotId,
        /// So far along the way from x0, m.
        along: f32,
        /// So long after the kick, s.
        after: f32,
    },
    /// It went by, or stopped short of, a receiver that was there.
    Missed {
        /// The ball's least distance from x*, m.
        by: f32,
    },
    /// It came by x* before the receiver.
    Late {
        /// Where the receiver was then: this far from x*, m.
        receiver_off: f32,
    },
    /// It left the field before anybody touched it.
    Out {
        /// Where.
        at: Point<Field>,
    },
    /// The ball never left the passer.
    NoKick {
        /// So long after the order, s.
        after: f32,
        /// An opponent took the ball away.
        lost_to: Option<RobotId>,
    },
}

impl Verdict {
    /// Our team has the ball.
    pub fn is_success(&self) -> bool {
        matches!(self, Self::Received { .. } | Self::ByMate { .. })
    }
}

/// Follows one pass; see [`PassWatch::observe`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassWatch {
    ordered: Ordered,
    flight: Option<Flight>,
}

/// A ball on its way.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Flight {
    since: Instant,
    /// Its least distance from x* so far, m.
    nearest: f32,
    /// When it came by x*: how far off the receiver was, m.
    receiver_off: Option<f32>,
    /// Who is at the ball, since when, and how the ball went before.
    contact: Option<(Who, Vector<Field>)>,
    velocity: Vector<Field>,
}

impl PassWatch {
    /// Begins with the order.
    pub fn new(ordered: Ordered) -> Self {
        Self { ordered, flight: None }
    }

    /// The pass it follows.
    pub fn ordered(&self) -> &Ordered {
        &self.ordered
    }

    /// Whether the ball has left.
    pub fn is_on_its_way(&self) -> bool {
        self.flight.is_some()
    }

    /// The next picture. A verdict ends the watch.
    pub fn observe(&mut self, world: &World, field: &FieldSpec) -> Option<Verdict> {
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

    fn before(&mut self, world: &World, ball: &Ball) -> Option<Verdict> {
        let passer = Who { colour: self.ordered.us, id: self.ordered.passer };
        let off =
            world.robot(passer).map_or(f32::INFINITY, |robot| robot.pose.position.distance(ball.position));
        let after = world.time.since(self.ordered.at).as_secs_f32();
        if let Some((robot, distance)) = world.nearest(ball.position)
            && robot.who.colour != self.ordered.us
            && distance < TOUCHING
            && off > TOUCHING
        {
            return Some(Verdict::NoKick { after, lost_to: Some(robot.who.id) });
        }
        if off > LEFT && ball.velocity.norm() > KICKED {
            self.flight = Some(Flight {
                since: world.time,
                nearest: ball.position.distance(self.ordered.to),
                receiver_off: None,
                contact: None,
                velocity: ball.velocity,
            });
            return None;
        }
        (after > KICK_WITHIN.as_secs_f32()).then_some(Verdict::NoKick { after, lost_to: None })
    }

    fn during(&self, flight: &mut Flight, world: &World, ball: &Ball, field: &FieldSpec) -> Option<Verdict> {
        let Ordered { us, receiver, from, to, .. } = self.ordered;
        let before = core::mem::replace(&mut flight.velocity, ball.velocity);
        let after = world.time.since(flight.since).as_secs_f32();
        let off = ball.position.distance(to);
        flight.nearest = flight.nearest.min(off);
        let way = to - from;
        let passed = (ball.position - to).dot(way) >= 0.0;
        if passed && flight.receiver_off.is_none() {
            let robot = world.robot(Who { colour: us, id: receiver });
            flight.receiver_off = Some(robot.map_or(f32::INFINITY, |robot| robot.pose.position.distance(to)));
        }
        if let Some(who) = self.touch(flight, before, world, ball) {
            return Some(match (who.colour == us, who.id) {
                (true, id) if id == receiver => Verdict::Received { off, late: after - self.ordered.flight },
                (true, by) => Verdict::ByMate { by, off },
                (false, by) => {
                    let along = way.unit().map_or(0.0, |along| (ball.position - from).dot(along));
                    Verdict::Intercepted { by, along, after }
                }
            });
        }
        let out = BALL_RADIUS;
        if field.clamp(ball.position, -out).distance(ball.position) > 0.0 {
            return Some(Verdict::Out { at: ball.position });
        }
        let stopped = ball.velocity.norm() < STOPPED && after > MOVES_FOR;
        stopped.then(|| flight.end())
    }

    /// Who has just touched the ball; the passer's own kick is none.
    fn touch(&self, flight: &mut Flight, before: Vector<Field>, world: &World, ball: &Ball) -> Option<Who> {
        let near = world
            .nearest(ball.position)
            .filter(|(_, distance)| *distance < TOUCHING && ball.height < ROBOT_HEIGHT)
            .map(|(robot, _)| robot.who)
            .filter(|who| *who != Who { colour: self.ordered.us, id: self.ordered.passer });
        match (near, flight.contact) {
            (Some(who), Some((same, came))) if who == same => {
                let change = (ball.velocity - came).norm();
                (change > CHANGE + CHANGE_SHARE * came.norm()).then_some(who)
            }
            (Some(who), _) => {
                flight.contact = Some((who, before));
                let change = (ball.velocity - before).norm();
                (change > CHANGE + CHANGE_SHARE * before.norm()).then_some(who)
            }
            // It left the robot again: by a touch, where it changed its way.
            (None, Some((who, came))) => {
                flight.contact = None;
                let change = (ball.velocity - came).norm();
                (change > CHANGE + CHANGE_SHARE * came.norm()).then_some(who)
            }
            (None, None) => None,
        }
    }

    /// A ball that nobody saw again, or that rolls on for nobody.
    fn over(&self, now: Instant) -> Option<Verdict> {
        match self.flight {
            None => {
                let after = now.since(self.ordered.at);
                let after = (after > KICK_WITHIN).then_some(after.as_secs_f32())?;
                Some(Verdict::NoKick { after, lost_to: None })
            }
            Some(flight) => {
                let after = now.since(flight.since).as_secs_f32();
                (after > self.ordered.flight + COLLECTED_WITHIN).then(|| flight.end())
            }
        }
    }
}

impl Flight {
    /// Nobody has it: because of whom?
    fn end(&self) -> Verdict {
        match self.receiver_off {
            Some(receiver_off) if receiver_off > THERE && self.nearest <= THERE => {
                Verdict::Late { receiver_off }
            }
            _ => Verdict::Missed { by: self.nearest },
        }
    }
}

/// A robot's centre this near the ball may touch it, m.
const TOUCHING: f32 = contact::PASS_TOUCHED_WITHIN;
/// Farther from the passer the ball has left it, m.
const LEFT: f32 = contact::PASS_LEFT_BEYOND;
/// … when it is faster than this, m/s: slower than any pass, faster than a ball that is pushed along.
const KICKED: f32 = 0.8;
/// A change of velocity that carpet does not make between two pictures, m/s, and as a share of the speed.
const CHANGE: f32 = 0.3;
const CHANGE_SHARE: f32 = 0.15;
/// A slower ball is on its way to nobody, m/s.
const STOPPED: f32 = 0.15;
/// A kick is known by its speed only after a few pictures, s.
const MOVES_FOR: f32 = 0.3;
/// Within this distance of x* a receiver is there, and a ball comes to it, m: two robots' radii and the ball.
const THERE: f32 = 0.2;
/// A pass that has not left by then is none: what it may be sought for ([`super::ahead::SEARCH_TIME`]), and a second for the kick.
const KICK_WITHIN: Duration = Duration::millis(5000);
/// A receiver that missed it may still run after it, s.
const COLLECTED_WITHIN: f32 = 1.5;

#[cfg(test)]
mod tests;
