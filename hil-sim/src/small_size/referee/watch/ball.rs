//! `ball`: ball offences: too fast, dribbled too far, touched twice, held by the keeper, no progress. Rules:
//! offenses.
//!
//! m, m/s, s, field frame.

use geometry::{Field, Point};
use protocol::{Instant, Who};
use rules::{Colour, Phase, legality, limits};

use super::super::event::{RefereeEvent, What};
use super::super::scene::Scene;
use super::{Episodes, Touches};

/// Monitor of speed, dribbling, double touch, keeper and progress.
#[derive(Clone, Debug, Default)]
pub(super) struct BallWatch {
    too_fast: Episodes<Who>,
    dribbled: Episodes<(Who, [u32; 2])>,
    kicker: Kicker,
    /// The team whose defence area holds the ball, and since when.
    held: Option<(Colour, Instant)>,
    /// Position at which the ball stays, and since when.
    rests: Option<(Point<Field>, Instant)>,
}

/// The kicker of the kick-off or free kick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Kicker {
    /// No double touch is possible: no such restart, or another robot has touched the ball since.
    #[default]
    None,
    /// No robot has touched the ball yet.
    Awaited,
    /// This robot touched it, and no other after it.
    Is(Who),
}

impl BallWatch {
    pub(super) fn command_given(&mut self) {
        self.kicker = Kicker::Awaited;
        self.held = None;
        self.rests = None;
        self.dribbled.clear();
        self.too_fast.clear();
    }

    pub(super) fn look(&mut self, scene: &Scene<'_>, touches: &Touches, events: &mut Vec<RefereeEvent>) {
        if !scene.game.is_running() {
            return;
        }
        events.extend(self.speed(scene, touches));
        events.extend(self.dribbling(scene, touches));
        events.extend(self.double_touch(scene, touches));
        events.extend(self.keeper_held(scene));
        events.extend(self.no_progress(scene));
    }

    fn speed(&mut self, scene: &Scene<'_>, touches: &Touches) -> Option<RefereeEvent> {
        let touch = touches.last()?;
        let speed = scene.fastest;
        let chipped = scene.ball.climb > 0.0 || scene.ball.height > limits::BALL_RADIUS;
        let holds = legality::kicked_too_fast(scene.game.limits, speed - SPEED_ROUNDING);
        let raised = self.too_fast.raise(touch.who, holds, scene.now);
        raised.then(|| scene.by(touch.who, touch.ball, What::BallTooFast { speed, chipped }))
    }

    fn dribbling(&mut self, scene: &Scene<'_>, touches: &Touches) -> Option<RefereeEvent> {
        let end = scene.ball.position;
        for (who, contact) in touches.contacts() {
            let far = legality::dribbled_too_far(scene.game.limits, contact.start, end);
            let start = [contact.start.x().to_bits(), contact.start.y().to_bits()];
            if self.dribbled.raise((who, start), far, scene.now) {
                return Some(scene.by(who, contact.start, What::DribbledTooFar { end }));
            }
        }
        None
    }

    fn double_touch(&mut self, scene: &Scene<'_>, touches: &Touches) -> Option<RefereeEvent> {
        let mut touching = scene.robots.iter().filter(|robot| robot.touches_ball).map(|robot| robot.who);
        match (self.kicker, scene.game.phase) {
            (Kicker::Awaited, Phase::FreeKick(team) | Phase::Kickoff(team)) => {
                let first = touching.next()?;
                let alone = first.colour == team && touching.next().is_none();
                self.kicker = if alone { Kicker::Is(first) } else { Kicker::None };
                None
            }
            (Kicker::Awaited, _) => {
                self.kicker = Kicker::None;
                None
            }
            (Kicker::Is(kicker), _) => {
                if touching.any(|who| who != kicker) {
                    self.kicker = Kicker::None;
                    return None;
                }
                let (place, ball) = (scene.game.ball_at_command, scene.ball.position);
                let again = scene.robot(kicker).is_some_and(|robot| robot.touches_ball)
                    && touches.has_contact(kicker)
                    && legality::double_touch(place, ball, false);
                again.then(|| {
                    self.kicker = Kicker::None;
                    scene.by(kicker, scene.ball.position, What::DoubleTouch)
                })
            }
            (Kicker::None, _) => None,
        }
    }

    fn keeper_held(&mut self, scene: &Scene<'_>) -> Option<RefereeEvent> {
        let game = scene.game;
        let within = |team: &Colour| game.field.in_penalty_area(game.own_end(*team), scene.ball.position);
        let Some(team) = Colour::ALL.into_iter().find(within) else {
            self.held = None;
            return None;
        };
        let since = self.held.filter(|(owner, _)| *owner == team).map_or(scene.now, |(_, since)| since);
        self.held = Some((team, since));
        let duration = scene.now.since(since).as_secs_f32();
        (duration > game.limits.keeper_hold).then(|| {
            self.held = None;
            scene.of(Some(team), scene.ball.position, What::KeeperHeldBall { duration })
        })
    }

    fn no_progress(&mut self, scene: &Scene<'_>) -> Option<RefereeEvent> {
        let place = scene.ball.position;
        let (rest, since) = self.rests.unwrap_or((place, scene.now));
        // The kicker has its own time limit before this one starts.
        if scene.game.phase != Phase::Run || rest.distance(place) > NO_PROGRESS_DISTANCE {
            self.rests = Some((place, scene.now));
            return None;
        }
        self.rests = Some((rest, since));
        let duration = scene.now.since(since).as_secs_f32();
        (duration > scene.game.limits.no_progress).then(|| {
            self.rests = None;
            scene.of(None, place, What::NoProgress { duration })
        })
    }
}

/// Rounding tolerance, m/s: a kick ordered at exactly the limit is legal.
const SPEED_ROUNDING: f32 = 0.01;
/// Radius within which the ball makes no progress, m: the game controller's tolerance.
const NO_PROGRESS_DISTANCE: f32 = 0.1;
