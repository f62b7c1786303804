//! `scene`: input of the rule monitors. One checked observation of the world, with the game state.
//!
//! m, m/s, s, field frame.

use geometry::{Field, GoalEnd, Point};
use protocol::{Instant, Who};
use rules::{Colour, FieldSpec, Limits, Phase, limits};

use super::account::Accounts;
use super::event::{RefereeEvent, What};
use super::observation::{BallSeen, CrashSeen, RobotSeen};

pub(super) struct Scene<'a> {
    pub(super) now: Instant,
    pub(super) ball: BallSeen,
    /// The ball's maximum speed since the last observation, m/s.
    pub(super) fastest: f32,
    pub(super) robots: &'a [RobotSeen],
    pub(super) crashes: &'a [CrashSeen],
    pub(super) game: &'a GameView<'a>,
}

pub(super) struct GameView<'a> {
    pub(super) phase: Phase<Colour>,
    /// Break: no rule applies to the teams.
    pub(super) is_break: bool,
    /// The half has not started: robots are driving to their ends.
    pub(super) before_half: bool,
    /// Start time of the phase.
    pub(super) since: Instant,
    /// Position of the ball at the last command, m.
    pub(super) ball_at_command: Point<Field>,
    /// Target position of a placement, m.
    pub(super) target: Option<Point<Field>>,
    pub(super) field: &'a FieldSpec,
    pub(super) limits: &'a Limits,
    pub(super) blue_on_positive: bool,
    pub(super) accounts: &'a Accounts,
    pub(super) judge_manual_fouls: bool,
}

impl GameView<'_> {
    pub(super) fn own_end(&self, team: Colour) -> GoalEnd {
        own_end(self.blue_on_positive, team)
    }

    /// Seconds since the start of the phase.
    pub(super) fn age(&self, now: Instant) -> f32 {
        now.since(self.since).as_secs_f32()
    }

    /// True where a team may play the ball.
    pub(super) fn is_running(&self) -> bool {
        is_running(self.phase)
    }
}

pub(super) fn own_end(blue_on_positive: bool, team: Colour) -> GoalEnd {
    if (team == Colour::Blue) == blue_on_positive { GoalEnd::Positive } else { GoalEnd::Negative }
}

/// True where a team may play the ball; the match clock runs then.
pub(super) fn is_running(phase: Phase<Colour>) -> bool {
    matches!(phase, Phase::Run | Phase::FreeKick(_) | Phase::Kickoff(_) | Phase::Penalty(_))
}

impl Scene<'_> {
    pub(super) fn robot(&self, who: Who) -> Option<&RobotSeen> {
        self.robots.iter().find(|robot| robot.who == who)
    }

    /// Distance from that robot's nearest side to the ball's centre, m (the rules' distance to the ball).
    pub(super) fn distance_to_ball(&self, robot: &RobotSeen) -> f32 {
        robot.pose.position.distance(self.ball.position) - limits::ROBOT_RADIUS
    }

    pub(super) fn by(&self, who: Who, place: Point<Field>, what: What) -> RefereeEvent {
        RefereeEvent { at: self.now, by: Some(who.colour), robot: Some(who.id), place, what }
    }

    pub(super) fn of(&self, team: Option<Colour>, place: Point<Field>, what: What) -> RefereeEvent {
        RefereeEvent { at: self.now, by: team, robot: None, place, what }
    }
}
