//! `methods`: how a ball is approached, pulled, pushed and kicked off walls.

use geometry::{Angle, Field, Point, Vector, math};
use protocol::robot_io::OmniKick;
use rules::FieldSpec;
use rules::limits::{PLACEMENT_TOLERANCE, ROBOT_RADIUS};

use super::{ASKEW, FOLLOWS, GAP, Placement};
use crate::belief::{Belief, BelievedBall};
use crate::body::Intent;
use crate::body::omni::{BALL_AT, Drive};
use crate::skills::wheels::get_ball::{Approach, approach, intercept_ball};
use crate::skills::wheels::wall::{LINE_UP_BEHIND_M, stands};

/// To the ball from the side of the place, or from behind it; at a wall from the field, at right angles to
/// it, or as it is kicked.
pub(super) fn fetch(
    placement: &Placement,
    belief: &Belief,
    ball: &BelievedBall,
    at: Point<Field>,
    kicks: Option<OffWall>,
) -> Intent {
    let rolls = ball.velocity.norm() > ROLLING;
    if rolls && placement.grip > FOLLOWS {
        return intercept_ball(belief, ball).into();
    }
    // Chased, a ball that the dribbler does not hold is only driven on: it is waited for where it will rest.
    let resting = BelievedBall { position: ball.rest, velocity: Vector::default(), rest: ball.rest };
    let ball = if rolls { &resting } else { ball };
    let wall = placement.wall(belief, ball, at);
    let face = match (kicks, wall) {
        (Some(kick), _) => kick.face,
        (None, Some(face)) => face,
        _ if placement.pushes(belief, ball, at) => ball.position.direction_to(at),
        _ if ball.position.distance(at) > PLACEMENT_TOLERANCE => at.direction_to(ball.position),
        _ => belief.pose.position.direction_to(ball.position),
    };
    let speed = if wall.is_some() { GO_IN_AT_WALL } else { GO_IN };
    match approach(belief, ball, face, speed) {
        Approach::Around(drive) => around(belief, ball.position, face, drive).into(),
        Approach::In(drive) => match kicks {
            Some(kick) => kick.with(drive).into(),
            None => Drive { dribbler: 1.0, ..drive }.into(),
        },
    }
}

/// Path to behind a ball at a wall: past it on the side that lies farther from the wall.
fn around(belief: &Belief, ball: Point<Field>, face: Angle, drive: Drive) -> Drive {
    let surface = belief.league().field().surface();
    let ahead = Vector::<Field>::polar(1.0, face);
    let left = Vector::new(-ahead.y(), ahead.x());
    let (one, other) = (ball + left * ASIDE, ball - left * ASIDE);
    let (near, far) = (surface.distance_to(one), surface.distance_to(other));
    let past = belief.pose.position - ball;
    let inwards = if near < far { left } else { -left };
    if near.max(far) < -NARROW || past.dot(ahead) < 0.0 || past.dot(inwards) > GOES_BY {
        return drive;
    }
    Drive { to: ball + inwards * ASIDE, ..drive }
}

/// Backwards with the ball: straight away from a wall, or to its place, with this share of the acceleration.
pub(super) fn pull(belief: &Belief, at: Point<Field>, out: Option<Angle>, placement: &Placement) -> Drive {
    let me = belief.pose.position;
    let grip = placement.grip;
    // What hardly holds still holds a ball that gets no faster.
    let speed = if grip < FOLLOWS { HELD_BALL_PULL_SPEED } else { placement.pace };
    let Some(out) = out else {
        // Facing away from the place; at the end the heading stays.
        let far = belief.dribbler_point().distance(at) > KEEPS_HEADING;
        let face = if far { at.direction_to(me) } else { belief.pose.heading };
        // Sideways a roller holds less than towards the robot.
        let share = if (face - belief.pose.heading).abs() > TURNING_ANGLE_MIN { SIDEWAYS } else { 1.0 };
        let to = at - Vector::polar(BALL_AT, face);
        return Drive { speed, acceleration_share: share * grip, ..Drive::holding(to, face) };
    };
    Drive { speed, acceleration_share: grip, ..Drive::holding(me - Vector::polar(CLEAR_OF_WALL, out), out) }
}

/// From behind, with what the dribbler holds.
pub(super) fn push(belief: &Belief, ball: &BelievedBall, at: Point<Field>, placement: &Placement) -> Intent {
    let face = ball.position.direction_to(at);
    // So slow that the ball rests at the place when it rolls on from here, and no slower than it starts at
    // all.
    let holds = SLOWS.iter().find(|(held, _)| !placement.stays && placement.grip > *held);
    let rolls = holds.map_or(ROLLS, |(_, brakes)| *brakes);
    let left = ball.position.distance(at) - PUSH_STOPS_SHORT_M - LAG * belief.velocity.norm();
    let speed = math::sqrt(2.0 * rolls * left.max(0.0)).clamp(CREEP, PUSH);
    let to = ball.position + Vector::polar(PUSH_AIM_AHEAD_M - BALL_AT, face);
    Drive { speed, acceleration_share: PUSHES, ..Drive::holding(to, face) }.into()
}

/// A pushed ball has got beside the robot, or the robot beside its path.
pub(super) fn strays(belief: &Belief, ball: &BelievedBall, at: Point<Field>) -> bool {
    let seen = belief.pose.to_body(ball.position);
    let askew = (ball.position.direction_to(at) - belief.pose.heading).abs();
    seen.x() < BALL_AT - GAP || seen.y().abs() > PUSHED_BALL_BESIDE_M || askew > ASKEW || seen.x() > ESCAPED
}

/// A kick that gets a ball off a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct OffWall {
    /// The heading of the kick.
    pub(super) face: Angle,
    /// Its speed, m/s.
    pub(super) speed: f32,
    /// The ball leaves along the only wall beside it.
    pub(super) one_wall: bool,
}

impl OffWall {
    /// The same path, with the kick.
    pub(super) fn with(self, drive: Drive) -> Drive {
        Drive { kick: OmniKick::Flat(self.speed), dribbler: 0.0, ..drive }
    }
}

/// The kick number `tries` of a ball at walls that lie towards `out`. One wall: askew, so that it leaves that
/// wall on the side of the place. Two walls, a net: straight into them, so that it comes back as the robot
/// backs off. `None` before a goal.
pub(super) fn kick_off(
    field: &FieldSpec,
    ball: Point<Field>,
    at: Point<Field>,
    out: Angle,
    tries: u8,
) -> Option<OffWall> {
    let ahead = Vector::<Field>::polar(1.0, out);
    let nth = f32::from(tries);
    let (line, post) = (0.5 * field.length, 0.5 * field.goal_width);
    if ball.y().abs() < post && ball.x().abs() > line {
        return Some(OffWall { face: out, speed: INTO_NET, one_wall: false });
    }
    if (ahead.x() * ahead.y()).abs() > ASKEW_OUT {
        return Some(OffWall { face: out, speed: INTO_CORNER + STRONGER * nth, one_wall: false });
    }
    let goal = post + field.goal_wall + ROBOT_RADIUS;
    if ball.y().abs() < post && ahead.x().abs() > 0.5 {
        return None;
    }
    // Away from a goal beside it.
    let towards = if ball.y().abs() < goal + ROLL_ALONG_WALL_M && ahead.x().abs() > 0.5 {
        Vector::new(0.0, ball.y())
    } else {
        at - ball
    };
    let side = if ahead.cross(towards) > 0.0 { 1.0 } else { -1.0 };
    let askew = KICKS_ASKEW.iter().cycle().skip(usize::from(tries)).take(KICKS_ASKEW.len());
    let faces = askew.map(|askew| out + Angle::new(side * askew));
    let fits = |face: &Angle| stands(field, ball - Vector::polar(LINE_UP_BEHIND_M, *face), -TIGHT);
    let face = { faces }.find(fits);
    let speed = if face.is_some() { OFF_WALL } else { INTO_CORNER };
    Some(OffWall { face: face.unwrap_or(out), speed: speed + STRONGER * nth, one_wall: face.is_some() })
}

/// From ball to the centre of who goes past it, m, and from where on it is past.
const ASIDE: f32 = 0.22;
const GOES_BY: f32 = 0.16;
/// With this much room on both sides it may go freely, m.
const NARROW: f32 = 0.2;
/// How fast it comes to the ball, m/s.
const GO_IN: f32 = 0.3;
/// The same at a wall, m/s: a body that comes on for a centimetre squeezes the ball out of the dribbler.
const GO_IN_AT_WALL: f32 = 0.12;
/// A faster ball is met, m/s.
const ROLLING: f32 = 0.3;
/// The ball is there, m: less than the rules' 0.15.
pub(super) const PLACED_M: f32 = 0.12;
/// With this a ball is kicked off a wall, m/s: it leaves a board with 0.4 to 0.8 across and rests within a
/// metre; …
const OFF_WALL: f32 = 2.2;
/// … and this much more for each earlier try, m/s.
const STRONGER: f32 = 0.5;
/// So far along a wall it rolls then, m: not before a goal.
const ROLL_ALONG_WALL_M: f32 = 1.0;
/// Off the wall's normal, rad: 40°, more leaves no room for the body; beside goals there is room for less
/// only, and with less the ball comes back to the body.
const KICKS_ASKEW: [f32; 3] = [0.7, 0.45, 0.25];
/// Into a corner of boards, m/s: it comes back with 0.3 to 0.6 of it, as fast as a robot backs off by then.
const INTO_CORNER: f32 = 1.0;
/// Into a net, m/s, which gives back a twentieth to a tenth.
const INTO_NET: f32 = 6.0;
/// Product of a direction's shares along two walls, beyond which it points between them.
const ASKEW_OUT: f32 = 0.2;
/// How fast a ball is pushed at first, m/s.
const PUSH: f32 = 2.0;
/// How fast a ball is pulled off a wall that does not follow, m/s.
const HELD_BALL_PULL_SPEED: f32 = 0.16;
/// A ball before the front does not get lost by speeding up: share of the acceleration.
const PUSHES: f32 = 1.6;
/// A pushed ball that no roller holds is slowed down by this on its path, m/s²: about as field surfaces do,
/// so that it stays near the front.
const ROLLS: f32 = 0.35;
/// The same of one that followed with such a share of the acceleration or more, m/s².
const SLOWS: [(f32, f32); 3] = [(0.3, 1.0), (0.15, 0.7), (0.0, 0.55)];
/// The slowest push, m/s.
const CREEP: f32 = 0.2;
/// The ball is ahead of where it is shown by how far it moves in this time, s: camera frame, radio, a step;
/// estimate.
const LAG: f32 = 0.05;
/// A push ends this far before the place, m: within what the rules allow, and half a second sooner.
const PUSH_STOPS_SHORT_M: f32 = 0.07;
/// A push aims this far ahead on the ball's path, m: no less than a robot takes to brake.
const PUSH_AIM_AHEAD_M: f32 = 0.9;
/// A pushed ball this far beside the middle is lost, m; ahead, m.
const PUSHED_BALL_BESIDE_M: f32 = 0.07;
const ESCAPED: f32 = 0.5;
/// Room that a kick needs less than going around, m.
const TIGHT: f32 = 0.02;
/// How far it is pulled off a wall before anything else, m.
const CLEAR_OF_WALL: f32 = 0.3;
/// While it turns by more than this a ball is pulled with this share of the acceleration, rad.
const TURNING_ANGLE_MIN: f32 = 0.3;
const SIDEWAYS: f32 = 0.7;
/// Nearer than this to the place the heading stays, m.
const KEEPS_HEADING: f32 = 0.15;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skills::wheels::testing::belief;
    use crate::skills::wheels::wall::wall;
    use rules::League;

    #[test]
    fn a_ball_is_kicked_off_a_wall_beside_the_place_and_straight_into_corners_and_nets() {
        let field = League::DivisionB.field();
        let at = Point::new(0.0, 0.0);
        let kick = |ball: Point<Field>, tries: u8| {
            kick_off(&field, ball, at, wall(&field, ball, at, true, 0.0)?, tries)
        };
        let face = |ball: (f32, f32), tries: u8| {
            kick(Point::new(ball.0, ball.1), tries).map(|kick| kick.face.to_degrees())
        };
        assert!((face((2.0, 3.27), 0).unwrap() - 130.1).abs() < 0.1);
        assert!((face((2.0, 3.27), 1).unwrap() - 115.8).abs() < 0.1, "no try is like the one before");
        let corner = kick(Point::new(4.75, 3.25), 0).unwrap();
        assert!((corner.face.to_degrees() - 45.0).abs() < 0.1 && corner.speed < 1.5, "{corner:?}");
        let net = kick(Point::new(4.6, 0.2), 0).unwrap();
        assert!(net.face.abs() < 1e-3 && net.speed > 5.0, "{net:?}");
        assert_eq!(kick(Point::new(4.45, 0.2), 0), None, "it would go into the goal");
        // Beside the goal: away from it.
        assert!(face((4.7, 0.75), 0).unwrap() > 30.0);
        // Between the goal's wall and the board: into that pocket.
        assert!((face((-4.78, 0.57), 0).unwrap() + 135.0).abs() < 0.1);
    }

    #[test]
    fn the_ball_is_fetched_from_the_side_of_the_place() {
        let b = belief((0.0, 0.0, 0.0), (1.0, 0.0));
        let at = Point::new(1.0, -1.0);
        let Intent::Drive(drive) = fetch(&Placement::default(), &b, &b.ball.unwrap(), at, None) else {
            panic!("drives")
        };
        // South of the ball, looking north.
        assert!(drive.to.y() < -0.1 && (drive.face.to_degrees() - 90.0).abs() < 1e-3, "{drive:?}");
    }

    #[test]
    fn a_push_ends_so_slowly_that_the_ball_rests_at_its_place() {
        let b = belief((0.0, 0.0, 0.0), (BALL_AT, 0.0));
        let stays = Placement { stays: true, ..Placement::default() };
        let Intent::Drive(drive) = push(&b, &b.ball.unwrap(), Point::new(BALL_AT + 0.08, 0.0), &stays) else {
            panic!("drives")
        };
        assert!(drive.speed * drive.speed / (2.0 * ROLLS) < 0.09, "{}", drive.speed);
    }
}
