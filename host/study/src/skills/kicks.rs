//! `kicks`: tries of `kick` and `chip`: the ball passes a point near enough, and over a robot.

use geometry::{Field, Point, Segment, Vector};
use hil_sim::small_size::{Ball, PhysicsEvent};
use protocol::host::{Directive, KickOrder, RuleRole};
use rules::{Colour, League};

use super::drill::{Judge, Moment, Start, State, US, player, pose};
use super::places::Places;

/// A ball that lies, and a point to kick it past.
pub(super) struct Kick {
    from: Point<Field>,
    target: Point<Field>,
    order: KickOrder,
    within: f32,
    /// Time of the kick, s.
    kicked: Option<f32>,
}

impl Kick {
    /// Three metres along the ground.
    pub(super) fn flat(league: League, seed: u64) -> (Start, Self) {
        Self::new(league, seed, KickOrder::Flat(FLAT_CM_S), FLAT_DISTANCE_M, FLAT_WITHIN_M)
    }

    /// Over a robot half a metre off.
    pub(super) fn chip(league: League, seed: u64) -> (Start, Self) {
        Self::new(league, seed, KickOrder::Chip(CHIP_CM_S), CHIP_DISTANCE_M, CHIP_WITHIN_M)
    }

    fn new(league: League, seed: u64, order: KickOrder, distance: f32, within: f32) -> (Start, Self) {
        let mut places = Places::new(league, seed);
        let from = places.in_play(0.6, 0.3);
        let mut along = places.direction();
        while !places.field.contains(from + Vector::polar(distance, along)) {
            along = places.direction();
        }
        let target = from + Vector::polar(distance, along);
        let robot = from + Vector::polar(places.chance.between(0.3, 0.8), places.direction());
        let theirs = match order {
            KickOrder::Flat(_) => Vec::new(),
            KickOrder::Chip(_) => vec![pose(from + Vector::polar(OBSTACLE_AT_M, along), along)],
        };
        let apart = |at: Point<Field>| theirs.iter().all(|other| other.position.distance(at) > 0.25);
        let robot = if apart(robot) { robot } else { from - Vector::polar(0.4, along) };
        let description =
            format!("ball at ({:.2}, {:.2}) to ({:.2}, {:.2})", from.x(), from.y(), target.x(), target.y());
        let robot = pose(robot, places.direction());
        let start = Start {
            theirs,
            path: Some(Segment::new(from, target)),
            ..Start::of(description, (1, robot), Ball::at(from), LIMIT_S)
        };
        (start, Self { from, target, order, within, kicked: None })
    }
}

impl Judge for Kick {
    fn orders(&mut self, _: &Moment<'_>) -> Option<Vec<(u8, RuleRole, Directive)>> {
        // Once is enough: who kicked stands.
        let kicks = Directive::Kick { at: self.target.into(), kick: self.order };
        Some(player(1, if self.kicked.is_some() { Directive::Stand } else { kicks }))
    }

    fn judge(&mut self, moment: &Moment<'_>) -> State {
        for event in moment.events {
            match event {
                PhysicsEvent::Kicked { robot, .. } if robot.colour == US => {
                    // It was dribbled before: aimed from where it is kicked.
                    (self.kicked, self.from) = (Some(moment.time), moment.world.ball.position);
                }
                PhysicsEvent::Touched { robot, .. }
                    if robot.colour == Colour::Blue && self.kicked.is_some() =>
                {
                    return State::Failed("the ball met the robot that it was to fly over".to_owned());
                }
                _ => {}
            }
        }
        let Some(kicked) = self.kicked else { return State::Going };
        let ball = &moment.world.ball;
        let line = Segment::new(self.from, self.target);
        let along = (ball.position - self.from).dot(line.vector()) / line.vector().norm().max(0.01);
        if along < line.vector().norm() {
            let stopped = ball.speed() < 0.05;
            let description = || format!("the ball stopped {:.2} m short", line.vector().norm() - along);
            return if stopped { State::Failed(description()) } else { State::Going };
        }
        let beside = line.vector().cross(ball.position - self.from).abs() / line.vector().norm().max(0.01);
        if beside <= self.within {
            State::Succeeded(kicked)
        } else {
            State::Failed(format!("the ball passed {beside:.2} m beside the point"))
        }
    }

    fn lacks(&self, _: &Moment<'_>) -> String {
        if self.kicked.is_some() { "the ball did not come there" } else { "no kick" }.to_owned()
    }
}

/// A flat kick's order, cm/s; its point's distance, m; and how near it must pass it, m: half a robot.
const FLAT_CM_S: u16 = 400;
const FLAT_DISTANCE_M: f32 = 3.0;
const FLAT_WITHIN_M: f32 = 0.1;
/// The same of a chip: it lands, hops and rolls askew.
const CHIP_CM_S: u16 = 500;
const CHIP_DISTANCE_M: f32 = 2.0;
const CHIP_WITHIN_M: f32 = 0.15;
/// The robot that a chip must clear stands so far from the ball, m.
const OBSTACLE_AT_M: f32 = 0.5;
/// For finding the ball, kicking and rolling, s.
const LIMIT_S: f32 = 8.0;
