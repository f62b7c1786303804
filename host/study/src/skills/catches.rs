//! `get-ball`, `receive`, `dribble` and `turn-with-ball`: having the ball, and keeping it. Judged by where
//! ball and robot truly are.

use geometry::{Angle, Field, Point, Segment, Vector};
use hil_sim::small_size::Ball;
use protocol::host::{Directive, RuleRole};
use rules::League;

use super::drill::{Judge, Moment, Start, State, player, pose};
use super::places::Places;

/// Our robot in all of these.
const ROBOT: u8 = 1;

/// Time for which, without a break, the robot has had the ball.
#[derive(Clone, Copy, Debug, Default)]
struct Had {
    since: Option<f32>,
}

impl Had {
    /// Whether it has had the ball for [`KEPT_FOR_S`].
    fn look(&mut self, moment: &Moment<'_>) -> bool {
        if !moment.has(ROBOT) {
            self.since = None;
            return false;
        }
        moment.time - *self.since.get_or_insert(moment.time) >= KEPT_FOR_S
    }
}

fn gap_text(moment: &Moment<'_>) -> String {
    match moment.at_dribbler(ROBOT) {
        Some([gap, beside]) => format!("the ball is {gap:.2} m before the dribbler, {beside:.2} m beside it"),
        None => "the robot is gone".to_owned(),
    }
}

/// Get a ball that rests, rolls, lies at a board or beside an opponent.
pub(super) struct GetBall {
    had: Had,
}

impl GetBall {
    pub(super) fn new(league: League, number: u32, seed: u64) -> (Start, Self) {
        let mut places = Places::new(league, seed);
        let mut theirs = Vec::new();
        let (ball, kind) = match number % GET_KINDS {
            0 => (Ball::at(places.in_play(0.2, 0.2)), "rests"),
            1 => {
                let from = places.in_play(0.5, 0.3);
                let to = places.in_play(0.5, 0.3);
                let speed = places.chance.between(0.5, 2.0);
                (Ball::rolling(from, Vector::polar(speed, from.direction_to(to))), "rolls")
            }
            2 => (Ball::at(places.at_side()), "lies at a board"),
            _ => {
                let at = places.in_play(0.5, 0.3);
                let away = places.direction();
                let other = at + Vector::polar(places.chance.between(0.115, 0.2), away);
                theirs.push(pose(other, away + Angle::HALF_TURN));
                (Ball::at(at), "lies before an opponent")
            }
        };
        let mut robot = places.in_play(0.2, 0.2);
        while !(0.5..2.5).contains(&robot.distance(ball.position)) {
            robot = places.in_play(0.2, 0.2);
        }
        let at = ball.position;
        let description = format!("ball {kind} at ({:.2}, {:.2})", at.x(), at.y());
        let robot = pose(robot, places.direction());
        let start = Start { theirs, ..Start::of(description, (ROBOT, robot), ball, GET_BALL_LIMIT_S) };
        (start, Self { had: Had::default() })
    }
}

impl Judge for GetBall {
    fn orders(&mut self, _: &Moment<'_>) -> Option<Vec<(u8, RuleRole, Directive)>> {
        Some(player(ROBOT, Directive::GetBall { face: None }))
    }

    fn judge(&mut self, moment: &Moment<'_>) -> State {
        if self.had.look(moment) { State::Succeeded(moment.time) } else { State::Going }
    }

    fn lacks(&self, moment: &Moment<'_>) -> String {
        gap_text(moment)
    }
}

/// Take a pass of some speed that comes a little askew.
pub(super) struct Receive {
    at: Point<Field>,
    had: Had,
}

impl Receive {
    pub(super) fn new(league: League, seed: u64) -> (Start, Self) {
        let mut places = Places::new(league, seed);
        let (mut from, mut at) = (places.in_play(0.5, 0.3), places.in_play(0.5, 0.3));
        while !(1.5..4.0).contains(&from.distance(at)) {
            (from, at) = (places.in_play(0.5, 0.3), places.in_play(0.5, 0.3));
        }
        let speed = places.chance.between(2.0, 5.5);
        let askew = places.chance.between(-ASKEW_DEG, ASKEW_DEG);
        let velocity = Vector::polar(speed, from.direction_to(at) + Angle::degrees(askew));
        // It stands about where it shall have the ball, facing anywhere within a right angle of it.
        let turned = Angle::degrees(places.chance.between(-90.0, 90.0));
        let robot = pose(at, at.direction_to(from) + turned);
        let description =
            format!("pass of {speed:.1} m/s over {:.1} m, {askew:.0}° askew", from.distance(at));
        let ball = Ball { velocity, ..Ball::at(from) };
        let start = Start {
            path: Some(Segment::new(from, at)),
            ..Start::of(description, (ROBOT, robot), ball, RECEIVE_LIMIT_S)
        };
        (start, Self { at, had: Had::default() })
    }
}

impl Judge for Receive {
    fn orders(&mut self, _: &Moment<'_>) -> Option<Vec<(u8, RuleRole, Directive)>> {
        Some(player(ROBOT, Directive::Receive { at: self.at.into(), then: None }))
    }

    fn judge(&mut self, moment: &Moment<'_>) -> State {
        if self.had.look(moment) { State::Succeeded(moment.time) } else { State::Going }
    }

    fn lacks(&self, moment: &Moment<'_>) -> String {
        gap_text(moment)
    }
}

/// Carry the ball a metre, and no farther at a time than the rules let.
pub(super) struct Dribble {
    to: Point<Field>,
    heading: Angle,
}

impl Dribble {
    pub(super) fn new(league: League, seed: u64) -> (Start, Self) {
        let mut places = Places::new(league, seed);
        let ball = places.in_play(1.8, 0.5);
        let heading = places.direction();
        let to = ball + Vector::polar(CARRY_LENGTH_M, places.direction());
        let robot = pose(ball - Vector::polar(AT_DRIBBLER + 0.02, heading), heading);
        let description =
            format!("ball at ({:.2}, {:.2}) to ({:.2}, {:.2})", ball.x(), ball.y(), to.x(), to.y());
        let start = Start {
            path: Some(Segment::new(ball, to)),
            ..Start::of(description, (ROBOT, robot), Ball::at(ball), CARRY_LIMIT_S)
        };
        (start, Self { to, heading: ball.direction_to(to) })
    }
}

impl Judge for Dribble {
    fn orders(&mut self, _: &Moment<'_>) -> Option<Vec<(u8, RuleRole, Directive)>> {
        let stands = pose(self.to - Vector::polar(AT_DRIBBLER, self.heading), self.heading);
        Some(player(ROBOT, Directive::Dribble { pose: stands.into() }))
    }

    fn judge(&mut self, moment: &Moment<'_>) -> State {
        let ball = &moment.world.ball;
        let from = moment.ours(ROBOT).and_then(|robot| robot.dribbling_from);
        if let Some(far) = from.map(|from| from.distance(ball.position)).filter(|far| *far > CARRY_LEGAL_M) {
            return State::Failed(format!("dribbled {far:.2} m"));
        }
        let there = ball.position.distance(self.to) < CARRIED_WITHIN_M && ball.speed() < BALL_STILL_M_S;
        if there { State::Succeeded(moment.time) } else { State::Going }
    }

    fn lacks(&self, moment: &Moment<'_>) -> String {
        format!("the ball is {:.2} m off", moment.world.ball.position.distance(self.to))
    }
}

/// Take the ball, and turn half around with it.
pub(super) struct Turn {
    lay: Point<Field>,
    heading: Angle,
    had: Had,
    /// The turn began, s.
    turns: Option<f32>,
}

impl Turn {
    pub(super) fn new(league: League, seed: u64) -> (Start, Self) {
        let mut places = Places::new(league, seed);
        let (lay, heading) = (places.in_play(1.0, 0.3), places.direction());
        let robot = pose(lay - Vector::polar(AT_DRIBBLER + 0.1, heading), heading);
        let description = format!("at ({:.2}, {:.2}), from {:.0}°", lay.x(), lay.y(), heading.to_degrees());
        let start = Start::of(description, (ROBOT, robot), Ball::at(lay), CARRY_LIMIT_S);
        (start, Self { lay, heading, had: Had::default(), turns: None })
    }
}

impl Judge for Turn {
    fn orders(&mut self, _: &Moment<'_>) -> Option<Vec<(u8, RuleRole, Directive)>> {
        let facing = if self.turns.is_some() { self.heading + Angle::HALF_TURN } else { self.heading };
        let face = self.lay + Vector::polar(FACED_POINT_M, facing);
        Some(player(ROBOT, Directive::GetBall { face: Some(face.into()) }))
    }

    fn judge(&mut self, moment: &Moment<'_>) -> State {
        let had = self.had.look(moment);
        let Some(began) = self.turns else {
            if had {
                (self.turns, self.had) = (Some(moment.time), Had::default());
            }
            return State::Going;
        };
        let rolled = moment.world.ball.position.distance(self.lay);
        if rolled > BALL_LOST_BEYOND_M {
            return State::Failed(format!("the ball was lost: {rolled:.2} m off"));
        }
        let off = moment.ours(ROBOT).map(|robot| (robot.pose.heading - self.heading).abs());
        let turned = off.is_some_and(|off| off > TURNED_DEG.to_radians());
        if turned && had { State::Succeeded(moment.time - began) } else { State::Going }
    }

    fn lacks(&self, moment: &Moment<'_>) -> String {
        let off = moment.ours(ROBOT).map_or(0.0, |robot| (robot.pose.heading - self.heading).to_degrees());
        format!("turned by {off:.0}°, {}", gap_text(moment))
    }
}

/// Time of uninterrupted contact after which the ball counts as taken, s.
const KEPT_FOR_S: f32 = 0.3;
/// Kinds of balls to get, which take turns.
const GET_KINDS: u32 = 4;
/// Time after which getting the ball has failed, s.
const GET_BALL_LIMIT_S: f32 = 8.0;
/// A pass misses its place by as much as this, degrees.
const ASKEW_DEG: f32 = 5.0;
/// Time after which receiving has failed, s: for the slowest pass and its keeping.
const RECEIVE_LIMIT_S: f32 = 4.0;
/// Distance from a robot's centre to a ball at its dribbler, m.
const AT_DRIBBLER: f32 = brain::body::omni::BALL_AT;
/// Distance over which the ball is carried, m.
const CARRY_LENGTH_M: f32 = 1.0;
/// Distance that the rules let a robot carry the ball, m.
const CARRY_LEGAL_M: f32 = 1.0;
/// Distance from its target at which the ball counts as carried there, m.
const CARRIED_WITHIN_M: f32 = 0.15;
/// Speed below which the ball counts as at rest, m/s.
const BALL_STILL_M_S: f32 = 0.1;
/// Time after which dribble and turn have failed, s.
const CARRY_LIMIT_S: f32 = 8.0;
/// Distance of the point to face, m.
const FACED_POINT_M: f32 = 3.0;
/// A ball this far from where it lay was lost, m.
const BALL_LOST_BEYOND_M: f32 = 0.5;
/// Turn that counts as half a turn, degrees: less what aiming errs.
const TURNED_DEG: f32 = 172.0;
