//! `touches`: ball contacts. Contacts start with a touch and end with a visible separation.
//!
//! m, field frame.

use std::collections::BTreeMap;

use geometry::{Field, Point};
use protocol::{Instant, Who};
use rules::{Colour, limits};

use super::super::observation::RobotSeen;
use super::super::scene::Scene;

#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    pub(super) who: Who,
    /// Position of the ball when the contact was last seen.
    pub(super) ball: Point<Field>,
}

/// Contact that has not ended by a visible separation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    /// Position of the ball when it started.
    pub(super) start: Point<Field>,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Touches {
    last: Option<Touch>,
    contacts: BTreeMap<Who, Contact>,
    /// Maximum height since each team's last touch, in the order of [`Colour::ALL`], m.
    heights: [f32; 2],
    /// Time of each team's last touch.
    times: [Option<Instant>; 2],
}

impl Touches {
    pub(super) fn look(&mut self, scene: &Scene<'_>) {
        let ball = scene.ball;
        self.contacts.retain(|who, _| scene.robot(*who).is_some_and(|robot| is_close(scene, robot)));
        let mut next: Option<(bool, f32, Who)> = None;
        for robot in scene.robots.iter().filter(|robot| robot.touches_ball) {
            let new = !self.contacts.contains_key(&robot.who);
            if is_close(scene, robot) {
                self.contacts.entry(robot.who).or_insert(Contact { start: ball.position });
            }
            // A new toucher takes precedence over one that still touches; of two, the nearer one.
            let distance = robot.pose.position.distance(ball.position);
            if next.is_none_or(|(was_new, least, _)| (new, -distance) > (was_new, -least)) {
                next = Some((new, distance, robot.who));
            }
            let team = index(robot.who.colour);
            self.heights[team] = 0.0;
            self.times[team] = Some(scene.now);
        }
        if let Some((_, _, who)) = next {
            self.last = Some(Touch { who, ball: ball.position });
        }
        for height in &mut self.heights {
            *height = height.max(ball.height);
        }
    }

    pub(super) fn last(&self) -> Option<Touch> {
        self.last
    }

    /// Robots that have been in contact without a separation.
    pub(super) fn contacts(&self) -> impl Iterator<Item = (Who, Contact)> + '_ {
        self.contacts.iter().map(|(who, contact)| (*who, *contact))
    }

    pub(super) fn has_contact(&self, who: Who) -> bool {
        self.contacts.contains_key(&who)
    }

    /// Maximum height of the ball since that team's last touch, m.
    pub(super) fn height_since(&self, team: Colour) -> f32 {
        self.heights[index(team)]
    }

    pub(super) fn last_of(&self, team: Colour) -> Option<Instant> {
        self.times[index(team)]
    }
}

/// True without a visible separation between that robot and the ball.
fn is_close(scene: &Scene<'_>, robot: &RobotSeen) -> bool {
    scene.distance_to_ball(robot) - limits::BALL_RADIUS <= SEPARATION_GAP_MIN
        && scene.ball.height <= limits::ROBOT_HEIGHT
}

fn index(team: Colour) -> usize {
    usize::from(team == Colour::Blue)
}

/// Gap between hull and ball that a camera sees, m: about the ball's radius, estimated. (The dribbler opening
/// lies some 17 mm inside a robot's hull, so that a ball at the dribbler is 17 mm "within".)
const SEPARATION_GAP_MIN: f32 = 0.02;
