//! `save`: a shot between the posts, and the keeper alone, under the coach. Success: no goal.

use geometry::{Angle, Field, GoalEnd, Point, Segment, Vector};
use hil_sim::small_size::{Ball, World};
use protocol::host::{Directive, RuleRole};
use rules::League;
use rules::limits::BALL_RADIUS;

use super::drill::{Judge, Moment, RefereeOrder, Start, State, pose};
use super::places::Places;

/// A ball at rest, and from [`SHOT_AT`] on a shot.
pub(super) struct Save {
    start: Start,
    velocity: Vector<Field>,
    shot: bool,
}

impl Save {
    pub(super) fn new(league: League, seed: u64) -> Self {
        let mut places = Places::new(league, seed);
        let goal = places.field.goal_center(GoalEnd::Negative);
        let aside = Angle::degrees(places.chance.between(-MOST_ASIDE_DEG, MOST_ASIDE_DEG));
        let distance = places.chance.between(NEAREST, FARTHEST);
        let ball = goal + Vector::polar(distance, aside);
        let half = 0.5 * places.field.goal_width - INSIDE_POST;
        let aim = Point::new(goal.x(), places.chance.between(-half, half));
        let speed = places.chance.between(SLOWEST, FASTEST);
        let keeper = pose(Point::new(goal.x() + 0.15, 0.0), Angle::ZERO);
        let description =
            format!("{speed:.1} m/s from ({:.2}, {:.2}) at y = {:.2}", ball.x(), ball.y(), aim.y());
        let start = Start {
            description,
            ours: vec![(0, keeper)],
            theirs: Vec::new(),
            ball: Ball::at(ball),
            path: Some(Segment::new(ball, aim)),
            referee_order: RefereeOrder::Stop,
            limit: SHOT_AT + LASTS,
        };
        Self { start, velocity: Vector::polar(speed, ball.direction_to(aim)), shot: false }
    }
}

impl Judge for Save {
    fn start(&self) -> &Start {
        &self.start
    }

    fn orders(&mut self, _: &Moment<'_>) -> Option<Vec<(u8, RuleRole, Directive)>> {
        None
    }

    fn happens(&mut self, time: f32, world: &mut World) -> Option<RefereeOrder> {
        if self.shot || time < SHOT_AT {
            return None;
        }
        self.shot = true;
        world.put_ball(Ball { velocity: self.velocity, ..Ball::at(world.ball.position) });
        Some(RefereeOrder::Run)
    }

    fn judge(&mut self, moment: &Moment<'_>) -> State {
        let (ball, field) = (&moment.world.ball, &moment.world.pitch().field);
        let beyond = -0.5 * field.length - BALL_RADIUS;
        if ball.position.x() < beyond && ball.position.y().abs() < 0.5 * field.goal_width {
            return State::Failed(format!("a goal at y = {:.2}", ball.position.y()));
        }
        let after = moment.time - SHOT_AT;
        // It goes to the goal no more: stopped, turned away, or past it.
        let comes = ball.velocity.x() < -COMES;
        let past = ball.position.x() < -0.5 * field.length - 0.05;
        if after > 0.1 && (!comes || past) { State::Succeeded(after) } else { State::Going }
    }

    fn lacks(&self, _: &Moment<'_>) -> String {
        "the ball neither came nor went".to_owned()
    }
}

/// The keeper has this long to take its place, s.
const SHOT_AT: f32 = 1.5;
/// A shot is over after this, s.
const LASTS: f32 = 4.0;
/// From the goal's middle, m.
const NEAREST: f32 = 2.0;
const FARTHEST: f32 = 4.0;
/// Off the field's length, degrees.
const MOST_ASIDE_DEG: f32 = 50.0;
/// As kicked, m/s.
const SLOWEST: f32 = 3.0;
const FASTEST: f32 = 6.0;
/// From a post, m.
const INSIDE_POST: f32 = 0.06;
/// A ball slower than this towards the goal line is stopped, m/s.
const COMES: f32 = 0.2;
