//! `placement`: the referee's ball placement for our team, with its coach choosing who places. Success by the
//! referee's rule.

use geometry::{Field, Point, Segment};
use hil_sim::small_size::Ball;
use rules::League;
use rules::limits::PLACEMENT_TIME_MIN;
use rules::restart::{AfterPlacement, PlacementLack, placement_lack};

use super::drill::{Judge, Moment, RefereeOrder, Start, State, team_size};
use super::places::Places;

/// A ball, a place, both teams somewhere.
pub(super) struct Placement {
    target: Point<Field>,
}

impl Placement {
    pub(super) fn new(league: League, number: u32, seed: u64) -> (Start, Self) {
        let mut places = Places::new(league, seed);
        let (ball, kind) = match number % KINDS {
            0 => (places.inside(0.0), "on the field"),
            1 => (places.at_side(), "at a side board"),
            2 => (places.at_end(), "at an end board"),
            3 => (places.in_corner(), "in a corner"),
            _ => (places.behind_goal(), "behind a goal line"),
        };
        let mut target = places.in_play(INSIDE_LINES_M, OFF_AREAS_M);
        while target.distance(ball) < TARGET_DISTANCE_MIN_M {
            target = places.in_play(INSIDE_LINES_M, OFF_AREAS_M);
        }
        let team = usize::from(team_size(league));
        let near_ball = Segment::new(ball, ball);
        let ours = places.robots(team, near_ball, 0.3, &[]);
        // As the rules want it of opponents: off the line from ball to target.
        let theirs = places.robots(team - 1, Segment::new(ball, target), OFF_LINE_M, &ours);
        let description = format!(
            "ball {kind} at ({:.2}, {:.2}) to ({:.2}, {:.2})",
            ball.x(),
            ball.y(),
            target.x(),
            target.y()
        );
        let start = Start {
            description,
            ours: (0..).zip(ours).collect(),
            theirs,
            ball: Ball::at(ball),
            path: None,
            referee_order: RefereeOrder::Place(target),
            limit: LIMIT_S,
        };
        (start, Self { target })
    }

    fn lack(&self, moment: &Moment<'_>) -> Option<PlacementLack> {
        let ball = &moment.world.ball;
        let present = moment.world.robots().iter().filter(|robot| robot.present);
        let robots = present.map(|robot| robot.pose.position);
        placement_lack(ball.position, ball.speed(), self.target, robots, AfterPlacement::FreeKick)
    }
}

impl Judge for Placement {
    fn judge(&mut self, moment: &Moment<'_>) -> State {
        if moment.time >= PLACEMENT_TIME_MIN && self.lack(moment).is_none() {
            return State::Succeeded(moment.time);
        }
        State::Going
    }

    fn lacks(&self, moment: &Moment<'_>) -> String {
        let ball = moment.world.ball.position;
        let what = match self.lack(moment) {
            Some(PlacementLack::Distance(d)) => format!("the ball is {d:.2} m from its place"),
            Some(PlacementLack::Moving(speed)) => format!("the ball moves at {speed:.2} m/s"),
            Some(PlacementLack::Robot(d)) => format!("a robot is {d:.2} m from the ball"),
            None => "nothing lacks".to_owned(),
        };
        format!("{what}, at ({:.2}, {:.2}) after {:.0} s", ball.x(), ball.y(), moment.time)
    }
}

/// Kinds of starts that take turns.
const KINDS: u32 = 5;
/// Targets are this far inside the lines, m: where the rules let free kicks be.
const INSIDE_LINES_M: f32 = 0.2;
/// And this far from defence areas, m.
const OFF_AREAS_M: f32 = 0.3;
/// Nearer targets are no placement, m.
const TARGET_DISTANCE_MIN_M: f32 = 0.5;
/// Opponents stand this far from the line from ball to target, m: the rules' half metre and a body.
const OFF_LINE_M: f32 = 0.6;
/// A placement has failed after this, s: half of the rules' time.
const LIMIT_S: f32 = 15.0;
