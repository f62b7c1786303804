//! `scene`: input of the rule monitors. One clean moment of the world, with what the game makes of it.
//!
//! m, m/s, s, field frame.

use geometry::{Field, GoalEnd, Point};
use protocol::{Instant, Who};
use rules::{Colour, FieldSpec, Limits, Phase, limits};

use super::account::Accounts;
use super::event::{Event, What};
use super::observation::{BallSeen, CrashSeen, RobotSeen};

/// Both colours, in the order of the wire.
pub(super) const COLOURS: [Colour; 2] = [Colour::Yellow, Colour::Blue];

/// One moment.
pub(super) struct Scene<'a> {
    pub(super) now: Instant,
    pub(super) ball: BallSeen,
    /// Its greatest speed since the last moment, m/s.
    pub(super) fastest: f32,
    pub(super) robots: &'a [RobotSeen],
    pub(super) crashes: &'a [CrashSeen],
    pub(super) game: &'a GameView<'a>,
}

/// What holds in the game at that moment.
pub(super) struct GameView<'a> {
    pub(super) phase: Phase<Colour>,
    /// Teams rest, and may do as they like.
    pub(super) is_break: bool,
    /// The half has not begun: robots are on their way to their ends.
    pub(super) before_half: bool,
    /// When the phase began.
    pub(super) since: Instant,
    /// Where the ball was when the last command was given.
    pub(super) ball_at_command: Point<Field>,
    /// Where it is to be placed.
    pub(super) target: Option<Point<Field>>,
    pub(super) field: &'a FieldSpec,
    pub(super) limits: &'a Limits,
    pub(super) blue_on_positive: bool,
    pub(super) accounts: &'a Accounts,
    pub(super) judge_manual_fouls: bool,
}

impl GameView<'_> {
    /// The end at which that team's own goal stands.
    pub(super) fn own_end(&self, team: Colour) -> GoalEnd {
        own_end(self.blue_on_positive, team)
    }

    /// Seconds since the phase began.
    pub(super) fn age(&self, now: Instant) -> f32 {
        now.since(self.since).as_secs_f32()
    }

    /// Is somebody allowed to play the ball?
    pub(super) fn is_running(&self) -> bool {
        is_running(self.phase)
    }
}

/// The end at which a team's own goal stands.
pub(super) fn own_end(blue_on_positive: bool, team: Colour) -> GoalEnd {
    if (team == Colour::Blue) == blue_on_positive { GoalEnd::Positive } else { GoalEnd::Negative }
}

/// Is somebody allowed to play the ball? The match clock runs then.
pub(super) fn is_running(phase: Phase<Colour>) -> bool {
    matches!(phase, Phase::Run | Phase::FreeKick(_) | Phase::Kickoff(_) | Phase::Penalty(_))
}

impl Scene<'_> {
    pub(super) fn robot(&self, who: Who) -> Option<&RobotSeen> {
        self.robots.iter().find(|robot| robot.who == who)
    }

    /// From that robot's nearest side to the ball's centre, m (the rules' distance to the ball).
    pub(super) fn distance_to_ball(&self, robot: &RobotSeen) -> f32 {
        robot.pose.position.distance(self.ball.position) - limits::ROBOT_RADIUS
    }

    /// An event of a robot at a place.
    pub(super) fn by(&self, who: Who, place: Point<Field>, what: What) -> Event {
        Event { at: self.now, by: Some(who.colour), robot: Some(who.id), place, what }
    }

    /// An event of a team, or of nobody.
    pub(super) fn of(&self, team: Option<Colour>, place: Point<Field>, what: What) -> Event {
        Event { at: self.now, by: team, robot: None, place, what }
    }
}
