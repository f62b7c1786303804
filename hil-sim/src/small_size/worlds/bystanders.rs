//! `bystanders`: robots that stand on or beside the field: seen by every camera, obstacles to ball and
//! robots, commanded by no computer and counted by no referee.
//!
//! They are robots of both teams alternately with the highest free numbers, as are left standing on
//! simulators and fields alike. Their positions are drawn once: outside the lines, or on the field where no
//! rule places ball or robots. A real referee would count them and have them removed; this referee ignores
//! them, so that the match goes on.

use geometry::{Angle, Field, Point, Pose};
use protocol::{RobotId, Who};
use rules::Colour;

use crate::rng::Stream;
use crate::small_size::World;

impl World {
    /// Places `count` bystanders, or as many as there are free ids and free positions; to be called when the
    /// players stand.
    pub fn add_bystanders(&mut self, count: u8) {
        let mut chance = Stream::new(self.seed, "bystanders");
        let mut left = [Colour::Blue, Colour::Yellow].map(|colour| {
            let ids = RobotId::all().map(|id| Who { colour, id });
            ids.filter(|who| self.robot(*who).is_none()).collect::<Vec<_>>()
        });
        for n in 0..usize::from(count) {
            let Some(who) = left[n % 2].pop().or_else(|| left[(n + 1) % 2].pop()) else { return };
            let Some(place) = self.room_for_bystander(&mut chance) else { return };
            let heading = Angle::new(chance.between(-geometry::math::PI, geometry::math::PI));
            self.put(who, Pose { position: place, heading }).bystander = true;
        }
    }

    fn room_for_bystander(&self, chance: &mut Stream) -> Option<Point<Field>> {
        let field = &self.pitch.field;
        let [x, y] = self.pitch.corner();
        let radius = self.parameters.robot.radius;
        let inside = chance.chance(ON_FIELD_SHARE);
        for _ in 0..DRAWS_MAX {
            let place =
                Point::new(chance.between(radius - x, x - radius), chance.between(radius - y, y - radius));
            let (ahead, aside) = (place.x().abs(), place.y().abs());
            let (to_goal, to_touch) = (field.length * 0.5 - ahead, field.width * 0.5 - aside);
            let edge = to_goal.min(to_touch);
            let right = if inside {
                edge >= LINE_CLEAR_DISTANCE
                    && place.distance(Point::default()) >= field.center_radius + CLEAR_DISTANCE
                    && (to_goal >= field.penalty_depth + LINE_CLEAR_DISTANCE
                        || aside >= field.penalty_width * 0.5 + LINE_CLEAR_DISTANCE)
                    && place.distance(Point::new(0.0, place.y())) >= CLEAR_DISTANCE
            } else {
                // Beside the field, and not behind a goal.
                edge <= -(radius + LINE_GAP) && aside >= field.goal_width * 0.5 + CLEAR_DISTANCE
            };
            let taken = self.robots.iter().any(|robot| {
                robot.present && robot.pose.position.distance(place) < 2.0 * radius + BYSTANDERS_APART_MIN
            });
            if right && !taken && self.ball.position.distance(place) >= CLEAR_DISTANCE {
                return Some(place);
            }
        }
        None
    }
}

/// Share of those that stand on the field, not beside it; estimate.
const ON_FIELD_SHARE: f32 = 0.4;
/// Minimum distance to the lines and areas, m: the nearest positions where balls are placed are 0.2 m from
/// them, and two robots fit between.
const LINE_CLEAR_DISTANCE: f32 = 0.7;
/// Minimum distance to the ball, the circle and the goals, m: more than a robot's width, so that a robot that
/// plays there can pass.
const CLEAR_DISTANCE: f32 = 0.3;
/// Distance between a bystander beside the field and the line, m.
const LINE_GAP: f32 = 0.02;
/// Minimum distance between bystanders and other robots, m: a robot fits through.
const BYSTANDERS_APART_MIN: f32 = 0.25;
/// Maximum number of draws of a position; a field without room has none.
const DRAWS_MAX: usize = 400;
