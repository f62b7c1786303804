//! `start`: start positions of ball and robots, from the seed alone. m, rad.

use geometry::{Angle, Field, Point, Pose, Vector};
use hil_sim::Stream;
use hil_sim::small_size::{Ball, World};
use protocol::{RobotId, Who};
use rules::Colour;

use crate::settings::Settings;
use crate::task::Place;

/// Ball and robots at the task's places, apart from each other.
pub fn line_up(world: &mut World, settings: &Settings, seed: u64) {
    let spec = settings.task.spec();
    let field = world.pitch().field;
    let half = [field.length * 0.5 - EDGE, field.width * 0.5 - EDGE];
    let mut draw = Stream::new(seed, "python start");
    let ball = place(&mut draw, half, spec.ball, Point::default());
    world.put_ball(Ball::at(ball));
    let mut taken = vec![ball];
    for (colour, places) in [(Colour::Blue, spec.own_places), (Colour::Yellow, spec.opponent_places)] {
        for (n, id) in RobotId::all().take(settings.count(colour)).enumerate() {
            let Some(wanted) = places.get(n).or(places.last()) else { continue };
            let mut at = Point::default();
            for _ in 0..DRAWS_MAX {
                at = place(&mut draw, half, *wanted, ball);
                if taken.iter().all(|other| other.distance(at) > START_APART_MIN) {
                    break;
                }
            }
            taken.push(at);
            let heading = match wanted {
                Place::Within(..) => Angle::new(draw.between(-geometry::math::PI, geometry::math::PI)),
                _ => at.direction_to(ball),
            };
            world.put(Who { colour, id }, Pose { position: at, heading });
        }
    }
}

/// A draw of that place; `half` is the way from the centre to where places end, m.
fn place(draw: &mut Stream, half: [f32; 2], place: Place, ball: Point<Field>) -> Point<Field> {
    let [length, width] = half;
    match place {
        Place::Within([x0, x1], [y0, y1]) => {
            Point::new(draw.between(x0 * length, x1 * length), draw.between(y0 * width, y1 * width))
        }
        Place::BehindBall(distance) => ball - Vector::new(distance, 0.0),
        Place::AroundBall(distance) => {
            let direction = Angle::new(draw.between(-geometry::math::PI, geometry::math::PI));
            let at = ball + Vector::polar(distance, direction);
            Point::new(at.x().clamp(-length, length), at.y().clamp(-width, width))
        }
        Place::InGoal => Point::new(length + EDGE - IN_GOAL_AHEAD, 0.0),
    }
}

/// Distance of a start position in the goal from the goal line, m: two radii of a robot.
const IN_GOAL_AHEAD: f32 = 0.2;
/// Least distance of start positions from the field's lines, m.
const EDGE: f32 = 0.3;
/// Least distance between start positions, m: three robots' radii.
const START_APART_MIN: f32 = 0.27;
/// Draws for a start position; after that the last one is taken, and the physics parts the robots.
const DRAWS_MAX: usize = 100;
