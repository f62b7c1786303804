//! `watch`: monitors of an automatic referee. One monitor per rule, one event per offence.
//!
//! Rules 2026, chapters on offenses, ball leaves the field and scoring goals. m, m/s, s, field frame.

mod areas;
mod ball;
mod bodies;
mod episodes;
mod lines;
mod penalty;
mod stop_rules;
mod touches;

use geometry::{Field, Point};

use super::event::RefereeEvent;
use super::scene::Scene;
use areas::Areas;
use ball::BallWatch;
use bodies::Bodies;
use episodes::Episodes;
use lines::Lines;
use penalty::PenaltyWatch;
use protocol::Who;
use stop_rules::StopRules;
use touches::Touches;

#[derive(Clone, Debug, Default)]
pub(super) struct Watch {
    touches: Touches,
    lines: Lines,
    ball: BallWatch,
    areas: Areas,
    stop_rules: StopRules,
    bodies: Bodies,
    penalty: PenaltyWatch,
}

impl Watch {
    /// Adds the events since the last observation.
    pub(super) fn look(&mut self, scene: &Scene<'_>, events: &mut Vec<RefereeEvent>) {
        self.touches.look(scene);
        self.penalty.look(scene, &self.touches, events);
        self.lines.look(scene, &self.touches, events);
        self.ball.look(scene, &self.touches, events);
        self.areas.look(scene, events);
        self.stop_rules.look(scene, events);
        self.bodies.look(scene, events);
    }

    /// A command was issued: monitors of a restart or stop are reset.
    pub(super) fn command_given(&mut self) {
        self.ball.command_given();
        self.areas.command_given();
        self.stop_rules.command_given();
        self.penalty.command_given();
    }

    /// The robot that touched the ball last, and the ball's position then.
    pub(super) fn last_touch(&self) -> Option<(Who, Point<Field>)> {
        self.touches.last().map(|touch| (touch.who, touch.ball))
    }

    /// The ball was placed by hand: earlier touches no longer count.
    pub(super) fn ball_was_put_down(&mut self) {
        self.touches = Touches::default();
        self.lines = Lines::default();
    }
}
