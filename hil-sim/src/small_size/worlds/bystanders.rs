//! `bystanders`: robots that stand about: seen by every camera, obstacles to ball and robots, commanded by no
//! computer and counted by no referee.
//!
//! They are robots of both teams by turns with the highest numbers that are free, as are left standing on simulators and
//! fields alike. Where they stand is drawn once: outside the lines, or on the field where no rule puts ball or robots down. A real
//! referee would have them carried off, as he would count them; here he looks through them, so that the match goes on.

use geometry::{Angle, Field, Point, Pose};
use protocol::{RobotId, Who};
use rules::Colour;

use crate::rng::Stream;
use crate::small_size::World;

impl World {
    /// Puts down so many, or as many as ids are left and room is found; to be called when the players stand.
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
        let inside = chance.chance(ON_FIELD);
        for _ in 0..DRAWS {
            let place =
                Point::new(chance.between(radius - x, x - radius), chance.between(radius - y, y - radius));
            let (ahead, aside) = (place.x().abs(), place.y().abs());
            let (to_goal, to_touch) = (field.length * 0.5 - ahead, field.width * 0.5 - aside);
            let edge = to_goal.min(to_touch);
            let right = if inside {
                edge >= CLEAR_OF_LINES
                    && place.distance(Point::default()) >= field.center_radius + CLEAR
                    && (to_goal >= field.penalty_depth + CLEAR_OF_LINES
                        || aside >= field.penalty_width * 0.5 + CLEAR_OF_LINES)
                    && place.distance(Point::new(0.0, place.y())) >= CLEAR
            } else {
                // Beside the field, and not behind a goal.
                edge <= -(radius + BESIDE) && aside >= field.goal_width * 0.5 + CLEAR
            };
            let taken = self
                .robots
                .iter()
                .any(|robot| robot.present && robot.pose.position.distance(place) < 2.0 * radius + APART);
            if right && !taken && self.ball.position.distance(place) >= CLEAR {
                return Some(place);
            }
        }
        None
    }
}

/// Share of those that stand on the field, not beside it; estimate.
const ON_FIELD: f32 = 0.4;
/// m to the lines and areas: the nearest places where balls are put down are 0.2 m from them, and two robots fit between.
const CLEAR_OF_LINES: f32 = 0.7;
/// m to the ball, the circle and the goals: more than a robot's width, so that a robot that plays there gets round.
const CLEAR: f32 = 0.3;
/// m between a bystander beside the field and the line.
const BESIDE: f32 = 0.02;
/// m between bystanders and other robots: a robot fits through.
const APART: f32 = 0.25;
/// Draws of a place; a field without room has none.
const DRAWS: usize = 400;
