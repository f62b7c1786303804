//! `spots`: restart positions by `rules::restart`, for every kind of event. m, field frame.

use geometry::{Field, GoalEnd, Point};
use rules::Colour;
use rules::legality::{BoundaryLine, Crossing};
use rules::restart::{after_out, nearest_free_kick_spot};

use super::event::{RefereeEvent, ShotEvent, What};
use super::{InternalReferee, Kind};

impl InternalReferee {
    /// Position of the ball after this event; `None` where it changes nothing.
    pub(super) fn spot_after(&self, event: &RefereeEvent) -> Option<Point<Field>> {
        let free_kick = |place| Some(nearest_free_kick_spot(&self.field, &self.limits, place));
        match &event.what {
            What::LeftTouchLine => {
                let line = BoundaryLine::Touch { positive: event.place.y() > 0.0 };
                Some(self.after_line(line, event.place, event.by))
            }
            What::LeftGoalLine => {
                Some(self.after_line(BoundaryLine::Goal(end_at(event.place)), event.place, event.by))
            }
            What::InvalidGoal { shot, .. } => {
                let touched = kicking_team(shot, event.by);
                Some(self.after_line(BoundaryLine::Goal(end_at(event.place)), event.place, touched))
            }
            What::PenaltyFailed { .. } => {
                // A goal kick of the defenders, wherever the ball was when the penalty failed.
                let end = self.own_end(event.by?.other());
                let place = Point::new(self.field.goal_line(end), event.place.y());
                Some(self.after_line(BoundaryLine::Goal(end), place, event.by))
            }
            What::Goal { .. } => Some(Point::new(0.0, 0.0)),
            What::DefenderInArea { .. } => Some(self.penalty_spot(event.by?.other())),
            What::AimlessKick { from } => free_kick(*from),
            What::AttackerTooClose { ball, .. } | What::TooManyRobots { ball, .. } => free_kick(*ball),
            What::Pushed { .. } => free_kick(self.ball.position),
            What::KeeperHeldBall { .. }
            | What::BoundaryCrossing
            | What::DribbledTooFar { .. }
            | What::DoubleTouch
            | What::HeldBall { .. }
            | What::NoProgress { .. } => free_kick(event.place),
            _ => None,
        }
    }

    pub(super) fn penalty_spot(&self, team: Colour) -> Point<Field> {
        self.field.penalty_spot(self.own_end(team).opposite())
    }

    fn after_line(&self, line: BoundaryLine, at: Point<Field>, touched: Option<Colour>) -> Point<Field> {
        let crossing = Crossing { line, at };
        // No known touch: as if the attackers had touched it.
        let own = match (touched, line) {
            (Some(team), _) => self.own_end(team),
            (None, BoundaryLine::Goal(end) | BoundaryLine::GoalOpening(end)) => end.opposite(),
            (None, BoundaryLine::Touch { .. }) => GoalEnd::Negative,
        };
        let spot = after_out(&self.field, &self.limits, crossing, own, None).spot;
        nearest_free_kick_spot(&self.field, &self.limits, spot)
    }
}

/// The team that sent the ball into the goal that did not count.
pub(super) fn kicking_team(shot: &ShotEvent, scorer: Option<Colour>) -> Option<Colour> {
    shot.kicker.map(|kicker| kicker.colour).or(scorer)
}

/// The team that gets the ball after an event that a team caused, where that is not simply the other team.
pub(super) fn blamed(event: &RefereeEvent) -> Option<Colour> {
    match &event.what {
        What::InvalidGoal { shot, .. } => kicking_team(shot, event.by),
        _ => event.by,
    }
}

/// True for an event that leads to a restart of neither team: a ball that left the field without any touch.
pub(super) fn is_nobodys(kind: Kind, by: Option<Colour>) -> bool {
    by.is_none() && kind.is_ball_out()
}

fn end_at(place: Point<Field>) -> GoalEnd {
    if place.x() > 0.0 { GoalEnd::Positive } else { GoalEnd::Negative }
}
