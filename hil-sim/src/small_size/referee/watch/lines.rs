//! `lines`: ball left the field, and goals. Rules: ball leaves the field, scoring goals, boundary crossing.
//!
//! m, field frame.

use geometry::{Field, GoalEnd, Point};
use protocol::Instant;
use rules::legality::{self, BoundaryLine, Crossing};
use rules::restart::{OutKind, after_out};
use rules::{Colour, Phase, limits};

use super::super::event::{PenaltyEnd, RefereeEvent, ShotEvent, What};
use super::super::observation::RobotSeen;
use super::super::scene::{GameView, Scene};
use super::Touches;
use super::touches::Touch;

/// Monitor of balls that cross a line or the wall.
#[derive(Clone, Debug, Default)]
pub(super) struct Lines {
    before: Option<Point<Field>>,
    /// The kick that sent the ball out: the ball may still fly over the wall.
    sent_out: Option<(RefereeEvent, Instant)>,
}

impl Lines {
    pub(super) fn look(&mut self, scene: &Scene<'_>, touches: &Touches, events: &mut Vec<RefereeEvent>) {
        let now = scene.ball.position;
        let before = self.before.replace(now).unwrap_or(now);
        if !scene.game.is_running() {
            events.extend(self.over_the_wall(scene));
            return;
        }
        self.sent_out = None;
        // A ball that was outside when play started, because it was not brought back, has not left.
        if legality::ball_is_out(scene.game.field, before) {
            return;
        }
        let Some(crossing) = legality::crossing(scene.game.field, before, now) else { return };
        let event = judge(scene, touches, crossing);
        if let (Some(touch), true) = (touches.last(), event.what.kind().is_ball_out()) {
            let what = What::BoundaryCrossing;
            self.sent_out = Some((scene.by(touch.who, touch.ball, what), scene.now));
        }
        events.push(event);
    }

    /// The ball that left flies on over the wall before any robot touches it.
    fn over_the_wall(&mut self, scene: &Scene<'_>) -> Option<RefereeEvent> {
        let (event, at) = self.sent_out.take()?;
        let touched = scene.robots.iter().any(|robot| robot.touches_ball);
        if touched || scene.now.since(at).as_secs_f32() > FLIGHT_TIME_MAX {
            return None;
        }
        if scene.game.field.surface().distance_to(scene.ball.position) > limits::BALL_RADIUS {
            return Some(RefereeEvent { at: scene.now, ..event });
        }
        self.sent_out = Some((event, at));
        None
    }
}

fn judge(scene: &Scene<'_>, touches: &Touches, crossing: Crossing) -> RefereeEvent {
    let (game, place, last) = (scene.game, crossing.at, touches.last());
    if let BoundaryLine::GoalOpening(end) = crossing.line
        && scene.ball.height < game.field.goal_height
    {
        let scorer = if game.own_end(Colour::Blue) == end { Colour::Yellow } else { Colour::Blue };
        if !matches!(game.phase, Phase::Penalty(team) if team != scorer) {
            return scene.of(Some(scorer), place, What::PossibleGoal { shot: shot(scene, touches, scorer) });
        }
    }
    if let Phase::Penalty(team) = game.phase {
        return scene.of(Some(team), place, What::PenaltyFailed { reason: PenaltyEnd::Out });
    }
    let what = match crossing.line {
        BoundaryLine::Touch { .. } => What::LeftTouchLine,
        BoundaryLine::Goal(end) | BoundaryLine::GoalOpening(end) => match last {
            Some(touch) if is_aimless(game, touch, end, place) => What::AimlessKick { from: touch.ball },
            _ => What::LeftGoalLine,
        },
    };
    match last {
        Some(touch) => scene.by(touch.who, place, what),
        None => scene.of(None, place, what),
    }
}

/// True for a ball that crossed the goal line after a kick from the own half (division B).
fn is_aimless(game: &GameView<'_>, touch: Touch, end: GoalEnd, place: Point<Field>) -> bool {
    let own = game.own_end(touch.who.colour);
    let from_kickoff = touch.ball.distance(Point::new(0.0, 0.0)) < limits::IN_PLAY_DISTANCE;
    let crossing = Crossing { line: BoundaryLine::Goal(end), at: place };
    let out = after_out(game.field, game.limits, crossing, own, (!from_kickoff).then_some(touch.ball));
    out.kind == OutKind::AimlessKick
}

fn shot(scene: &Scene<'_>, touches: &Touches, scorer: Colour) -> ShotEvent {
    let (last, game) = (touches.last(), scene.game);
    let own = game.own_end(scorer);
    let counts =
        |robot: &&RobotSeen| robot.who.colour == scorer && game.field.counts(own, robot.pose.position);
    ShotEvent {
        kicker: last.map(|touch| touch.who),
        from: last.map_or(scene.ball.position, |touch| touch.ball),
        max_height: touches.height_since(scorer),
        last_touch: touches.last_of(scorer),
        robots: scene.robots.iter().filter(counts).count() as u32,
    }
}

/// Maximum time in which a ball that left may fly over the wall, s: a chip at 6.5 m/s is in the air for less
/// than 1 s.
const FLIGHT_TIME_MAX: f32 = 2.0;
