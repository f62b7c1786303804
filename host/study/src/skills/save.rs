//! `save`: a shot between the posts, and the keeper alone, under the coach. Success: no goal.

use geometry::{Angle, Field, GoalEnd, Point, Segment, Vector};
use hil_sim::small_size::{Ball, World};
use rules::League;
use rules::limits::BALL_RADIUS;

use super::drill::{Judge, Moment, RefereeOrder, Start, State, pose};
use super::places::Places;

/// A ball at rest, and from [`SHOT_AT_S`] on a shot.
pub(super) struct Save {
    velocity: Vector<Field>,
    shot: bool,
}

impl Save {
    pub(super) fn new(league: League, seed: u64) -> (Start, Self) {
        let mut places = Places::new(league, seed);
        let goal = places.field.goal_center(GoalEnd::Negative);
        let aside = Angle::degrees(places.chance.between(-ASIDE_MAX_DEG, ASIDE_MAX_DEG));
        let distance = places.chance.between(SHOT_DISTANCE_MIN_M, SHOT_DISTANCE_MAX_M);
        let ball = goal + Vector::polar(distance, aside);
        let half = 0.5 * places.field.goal_width - INSIDE_POST_M;
        let aim = Point::new(goal.x(), places.chance.between(-half, half));
        let speed = places.chance.between(SHOT_SPEED_MIN_M_S, SHOT_SPEED_MAX_M_S);
        let keeper = pose(Point::new(goal.x() + 0.15, 0.0), Angle::ZERO);
        let description =
            format!("{speed:.1} m/s from ({:.2}, {:.2}) at y = {:.2}", ball.x(), ball.y(), aim.y());
        let start = Start {
            path: Some(Segment::new(ball, aim)),
            referee_order: RefereeOrder::Stop,
            ..Start::of(description, (0, keeper), Ball::at(ball), SHOT_AT_S + SHOT_LASTS_S)
        };
        (start, Self { velocity: Vector::polar(speed, ball.direction_to(aim)), shot: false })
    }
}

impl Judge for Save {
    fn happens(&mut self, time: f32, world: &mut World) -> Option<RefereeOrder> {
        if self.shot || time < SHOT_AT_S {
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
        let after = moment.time - SHOT_AT_S;
        // The ball goes to the goal no more: stopped, turned away, or past it.
        let comes = ball.velocity.x() < -COMING_SPEED_M_S;
        let past = ball.position.x() < -0.5 * field.length - 0.05;
        if after > 0.1 && (!comes || past) { State::Succeeded(after) } else { State::Going }
    }

    fn lacks(&self, _: &Moment<'_>) -> String {
        "undecided after 4 s: no goal, and the ball did not stop".to_owned()
    }
}

/// The keeper has this long to take its place, s.
const SHOT_AT_S: f32 = 1.5;
/// A shot is over after this, s.
const SHOT_LASTS_S: f32 = 4.0;
/// Distance of the ball from the goal's middle, m.
const SHOT_DISTANCE_MIN_M: f32 = 2.0;
const SHOT_DISTANCE_MAX_M: f32 = 4.0;
/// Angle between the shot's start and the field's length, seen from the goal, degrees.
const ASIDE_MAX_DEG: f32 = 50.0;
/// Speed of the shot as kicked, m/s.
const SHOT_SPEED_MIN_M_S: f32 = 3.0;
const SHOT_SPEED_MAX_M_S: f32 = 6.0;
/// Distance of the aim from a post, m.
const INSIDE_POST_M: f32 = 0.06;
/// A ball slower than this towards the goal line is stopped, m/s.
const COMING_SPEED_M_S: f32 = 0.2;
