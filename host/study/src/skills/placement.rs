//! `placement`: the referee's ball placement for our team, with its coach choosing who places. Success by the
//! referee's rule.

use geometry::{Field, Point, Segment};
use hil_sim::small_size::Ball;
use protocol::host::{Directive, RuleRole};
use rules::League;
use rules::limits::PLACEMENT_TIME_MIN;
use rules::restart::{AfterPlacement, PlacementLack, placement_lack};

use super::drill::{Judge, Moment, RefereeOrder, Start, State, team_size};
use super::places::Places;

/// A ball, a place, both teams somewhere.
pub(super) struct Placement {
    start: Start,
    target: Point<Field>,
}

impl Placement {
    pub(super) fn new(league: League, number: u32, seed: u64) -> Self {
        let mut places = Places::new(league, seed);
        let (ball, kind) = match number % KINDS {
            0 => (places.inside(0.0), "on the field"),
            1 => (places.at_side(), "at a side board"),
            2 => (places.at_end(), "at an end board"),
            3 => (places.in_corner(), "in a corner"),
            _ => (places.behind_goal(), "behind a goal line"),
        };
        let mut target = places.in_play(FROM_LINES, FROM_AREAS);
        while target.distance(ball) < LEAST {
            target = places.in_play(FROM_LINES, FROM_AREAS);
        }
        let team = usize::from(team_size(league));
        let near_ball = Segment::new(ball, ball);
        let ours = places.robots(team, near_ball, 0.3, &[]);
        // As the rules want it of opponents: off the line from ball to target.
        let theirs = places.robots(team - 1, Segment::new(ball, target), OFF_LINE, &ours);
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
            limit: LIMIT,
        };
        Self { start, target }
    }

    fn lack(&self, moment: &Moment<'_>) -> Option<PlacementLack> {
        let ball = &moment.world.ball;
        let present = moment.world.robots().iter().filter(|robot| robot.present);
        let robots = present.map(|robot| robot.pose.position);
        placement_lack(ball.position, ball.speed(), self.target, robots, AfterPlacement::FreeKick)
    }
}

impl Judge for Placement {
    fn start(&self) -> &Start {
        &self.start
    }

    fn orders(&mut self, _: &Moment<'_>) -> Option<Vec<(u8, RuleRole, Directive)>> {
        None
    }

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
const FROM_LINES: f32 = 0.2;
/// And this far from defence areas, m.
const FROM_AREAS: f32 = 0.3;
/// Nearer targets are no placement, m.
const LEAST: f32 = 0.5;
/// Opponents stand this far from the line from ball to target, m: the rules' half metre and a body.
const OFF_LINE: f32 = 0.6;
/// A placement has failed after this, s: half of the rules' time.
const LIMIT: f32 = 15.0;
