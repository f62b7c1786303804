//! `surroundings`: obstacles of a wheeled robot: all other robots, the rules' shapes, goal walls, and the
//! ball where it avoids it.
//!
//! Regions are for the robot's centre: grown by its radius and by the errors of vision and wheels. Field
//! frame, m.

use geometry::{Field, GoalEnd, Point, Segment, Shape, Vector};
use motion::avoid::{OBSTACLES_MAX, Obstacle};
use rules::keep_out::{Forbidden, KeepOut, KeepOutReason, Situation, keep_out};
use rules::limits::{BALL_RADIUS, ROBOT_RADIUS};
use rules::{FieldSpec, Phase, RuleRole, Side};

use crate::belief::Belief;
use crate::body::omni::DriveMode;

/// Obstacles around the robot, and the region it must stay in.
#[derive(Clone, Debug)]
pub struct Surroundings {
    /// Regions and bodies to keep out of.
    pub obstacles: heapless::Vec<Obstacle<Field>, OBSTACLES_MAX>,
    /// Region to stay in.
    pub within: Shape<Field>,
    /// Number of obstacles that are no robots; they come first.
    pub fixed: usize,
    /// Number of those and of the robots near the robot or its path; others follow.
    pub near: usize,
}

impl Surroundings {
    /// An empty value to be filled by [`Surroundings::look`]; it is too large to be moved around.
    pub fn none(field: &FieldSpec) -> Self {
        let within = field.surface().grown(-BODY - BORDER);
        Self { obstacles: heapless::Vec::new(), within, fixed: 0, near: 0 }
    }

    /// Collects what matters to this robot on its path to `to`.
    pub fn look(&mut self, belief: &Belief, field: &FieldSpec, to: Point<Field>, mode: DriveMode) {
        let KeepOut { forbidden, within } = keep_out(&situation(belief, field));
        // A robot that goes for the ball may touch the boards: a ball in a corner cannot be reached
        // otherwise.
        self.within = within.grown(if mode == DriveMode::Avoiding { -BODY - BORDER } else { -BODY });
        let me = belief.pose.position;
        // The planned path, and the one on which it could stop.
        let path = Segment::new(me, to);
        let stops = Segment::new(me, me + belief.velocity * STOPS_IN);
        // A robot at a ball that lies beside an area may be as near as the rules allow.
        let rolls = belief.ball.map_or(0.0, |ball| ball.velocity.norm());
        let at_ball = belief.game.phase == Phase::Run
            && belief.ball.is_some_and(|ball| rolls < REST_SPEED_MAX && ball.position.distance(to) < AT_BALL);
        let grown = |region: &Forbidden| {
            let law = match region.why {
                KeepOutReason::OpponentArea | KeepOutReason::OwnArea if at_ball => LAW_AT_BALL,
                // The stadium moves with the ball.
                KeepOutReason::Stadium => LAW + (LEADS * rolls).min(LEADS_MOST),
                _ => LAW,
            };
            region.shape.grown(BODY + law)
        };
        // A robot that must leave a region may have to leave by another path than the planned one: all
        // regions count.
        let covers = |shape: Shape<Field>| shape.contains(me) || shape.contains(to);
        let leaves = forbidden.iter().any(|region| covers(grown(region)));
        for shape in forbidden.iter().map(grown) {
            if leaves || is_near(&shape, path) || is_near(&shape, stops) {
                self.add(Obstacle::region(shape));
            }
        }
        if let Some(lane) = kicking_lane(belief).filter(|lane| !lane.contains(to)) {
            self.add(Obstacle::region(lane));
        }
        if mode == DriveMode::Avoiding
            && let Some(ball) = belief.ball.filter(|_| !belief.ball_flies())
        {
            let avoiding = if belief.is_placing() { AVOIDING_PLACING } else { AVOIDING };
            let shape = Shape::Disc { center: ball.position, radius: BODY + BALL_RADIUS + avoiding };
            self.add(Obstacle::moving(shape, ball.velocity));
        }
        for goal in [GoalEnd::Negative, GoalEnd::Positive] {
            let near = |p: Point<Field>| p.x() * goal.sign() as f32 > 0.5 * field.length - NEAR_GOAL;
            let leaves_here = leaves && me.x() * goal.sign() as f32 >= 0.0;
            if leaves_here || near(me) || near(to) {
                self.add_goal(field, goal);
            }
        }
        self.fixed = self.obstacles.len();
        // Close to the ball bodies touch: a robot that went around every opponent there would never have it.
        let margin = if mode == DriveMode::Avoiding { ROBOTS } else { ROBOTS_AT_BALL };
        let radius = 2.0 * BODY + margin;
        // A robot that plays a ball meets opponents where they are: off all places that they may reach, it
        // would leave the ball to the first that comes.
        let contests = mode != DriveMode::Avoiding
            && belief.game.phase == Phase::Run
            && belief.ball.is_some_and(|ball| {
                let off = ball.position - me;
                off.dot(off) < CONTESTS_WITHIN * CONTESTS_WITHIN
            });
        // Out of a region all others count; first those that it could reach before it is planned again.
        for is_first in [true, false] {
            if !is_first {
                self.near = self.obstacles.len();
            }
            if !(is_first || leaves) {
                break;
            }
            for other in &belief.others {
                let at = other.pose.position;
                let speed = other.velocity.x().abs() + other.velocity.y().abs();
                let reach = radius + ASIDE + ASIDE_FOR * speed;
                let is_close = leaves && at.distance(me) < LEAVES_PAST
                    || path.distance_to(at) < reach
                    || stops.distance_to(at) < reach;
                if is_close == is_first {
                    let goes_on = if contests && other.side == Side::Theirs { 0.0 } else { 1.0 };
                    let strays = STRAYS_FOR * speed * goes_on;
                    self.add(Obstacle::robot(at, other.velocity * goes_on, radius + strays));
                }
            }
        }
    }

    /// Leaves out the robots that only a detour could meet.
    pub fn leave_out_far(&mut self) {
        self.obstacles.truncate(self.near);
    }

    /// Without capacity for another obstacle it is left out: rules and goals are added first, and other
    /// robots keep their distance too.
    fn add(&mut self, obstacle: Obstacle<Field>) {
        let _ = self.obstacles.push(obstacle);
    }

    /// Leaves out the robots that are farthest from `me`, one by one, until the number of obstacles `fits` or
    /// no robot is left.
    pub fn leave_out_farthest(&mut self, me: Point<Field>, fits: impl Fn(usize) -> bool) {
        if fits(self.obstacles.len()) {
            return;
        }
        let mut distances = heapless::Vec::<f32, OBSTACLES_MAX>::new();
        for robot in self.obstacles.iter().skip(self.fixed) {
            let _ = distances.push(robot.shape.distance_to(me));
        }
        while !fits(self.obstacles.len()) {
            let farthest = distances.iter().enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b));
            let Some((i, _)) = farthest else { return };
            leave_out(&mut distances, i);
            leave_out(&mut self.obstacles, self.fixed + i);
        }
    }

    fn add_goal(&mut self, field: &FieldSpec, goal: GoalEnd) {
        let (line, sign) = (field.goal_line(goal), goal.sign() as f32);
        let (back, half) = (line + sign * (field.goal_depth + field.goal_wall), 0.5 * field.goal_width);
        let outer = half + field.goal_wall;
        let slab = |x: [f32; 2], y: [f32; 2]| {
            let low = Point::new(x[0].min(x[1]), y[0].min(y[1]));
            let high = Point::new(x[0].max(x[1]), y[0].max(y[1]));
            Obstacle::standing(Shape::Box { low, high }.grown(BODY + WALL))
        };
        self.add(slab([line, back], [half, outer]));
        self.add(slab([line, back], [-half, -outer]));
        self.add(slab([line + sign * field.goal_depth, back], [-outer, outer]));
    }
}

/// Whether a region comes near the path: tested at three points of it, each for its stretch.
fn is_near(shape: &Shape<Field>, path: Segment<Field>) -> bool {
    let along = path.vector();
    let stretch = SIXTH * (along.x().abs() + along.y().abs());
    [SIXTH, 0.5, 1.0 - SIXTH]
        .iter()
        .any(|share| shape.distance_to(path.from + along * *share) < stretch + ASIDE)
}

/// The path of a ball that a teammate is about to kick at our restart: a teammate behind the ball faces along
/// it. It must not be crossed; a robot that is sent into it waits there for the ball.
fn kicking_lane(belief: &Belief) -> Option<Shape<Field>> {
    let phase = belief.game.phase;
    let ours = matches!(
        phase,
        Phase::Kickoff(Side::Ours) | Phase::FreeKick(Side::Ours) | Phase::Penalty(Side::Ours)
    );
    if !ours || belief.game.rule_role == RuleRole::Kicker {
        return None;
    }
    let ball = belief.ball?.position;
    let kicks = belief.others.iter().filter(|other| other.side == Side::Ours).find(|other| {
        let at = other.pose.position;
        at.distance(ball) < KICKS_WITHIN && (at.direction_to(ball) - other.pose.heading).abs() < LOOKS_AT
    })?;
    let spine = Segment::new(ball, ball + Vector::polar(LANE, kicks.pose.heading));
    Some(Shape::Capsule { spine, radius: BODY + BALL_RADIUS + LANE_MARGIN })
}

/// Input of `rules::keep_out` from this robot's belief.
pub fn situation<'f>(belief: &Belief, field: &'f FieldSpec) -> Situation<'f> {
    let game = &belief.game;
    Situation {
        field,
        own: game.defending,
        phase: game.phase,
        rule_role: game.rule_role,
        ball: belief.ball.map(|ball| ball.position),
        placement: game.placement,
        ball_in_play: matches!(game.phase, Phase::Run),
    }
}

/// Share of the path's length.
const SIXTH: f32 = 1.0 / 6.0;
/// The robot's radius, m.
const BODY: f32 = ROBOT_RADIUS;
/// Added to the rules' distances, m: vision's noise, its delay at walking pace, and overshoot of the wheels.
const LAW: f32 = 0.04;
/// Added beside areas at a ball that lies, m: overshoot of the wheels at 0.35 m/s.
const LAW_AT_BALL: f32 = 0.01;
/// A placement's stadium moves with the ball by what it rolls in this time, s: snapshot and radio latency,
/// and the lag of the wheels; …
const LEADS: f32 = 0.15;
/// … at most this, m: the places that hosts order are 0.15 m clear of it.
const LEADS_MOST: f32 = 0.3;
/// A slower ball counts as stationary, m/s.
const REST_SPEED_MAX: f32 = 0.3;
/// A robot whose path ends this near the ball lines up behind it, m.
const AT_BALL: f32 = 0.2;
/// Distance kept from the edge of the field surface, m.
const BORDER: f32 = 0.02;
/// Distance kept from goal walls, m.
const WALL: f32 = 0.01;
/// Distance kept from a ball that must not be touched, m.
const AVOIDING: f32 = 0.03;
/// The same while it is placed: a ball that is touched then rolls away.
const AVOIDING_PLACING: f32 = 0.055;
/// Distance kept from other robots, m.
const ROBOTS: f32 = 0.03;
/// Distance kept from other robots beside the ball, m.
const ROBOTS_AT_BALL: f32 = 0.0;
/// A teammate this near the ball of our restart is about to kick it, m: 0.18 m where it lines up, and room
/// for a swing.
const KICKS_WITHIN: f32 = 0.35;
/// Heading tolerance within which it faces the ball, rad.
const LOOKS_AT: f32 = 0.35;
/// The lane ends this far from the ball, m: short of a robot that waits for a pass of a metre.
const LANE: f32 = 0.9;
/// Beside the ball's path, m.
const LANE_MARGIN: f32 = 0.03;
/// A ball this near is played, m: braking from 1.7 m/s ends at it.
const CONTESTS_WITHIN: f32 = 0.5;
/// A robot that stands farther beside the path than this is no obstacle, m: a path around one robot keeps
/// nearer.
const ASIDE: f32 = 0.3;
/// Time for which a moving robot may come nearer, s.
const ASIDE_FOR: f32 = 0.4;
/// A moving robot may be elsewhere than received, by its velocity's error over this time, s: two camera
/// frames.
const STRAYS_FOR: f32 = 0.1;
/// At 3 m/s and 3.5 m/s² a robot stops in 0.43 s times its speed, s.
const STOPS_IN: f32 = 0.5;
/// Others within this distance count first for a robot that leaves a region, m: half a second's way.
const LEAVES_PAST: f32 = 1.5;
/// Goal walls matter within this distance of the goal line, m.
const NEAR_GOAL: f32 = 0.7;

/// Puts the last of a list in place of the `i`th; unlike `swap_remove` it has no panic in flash.
fn leave_out<T, const N: usize>(list: &mut heapless::Vec<T, N>, i: usize) {
    if let Some(last) = list.pop()
        && let Some(left_out) = list.get_mut(i)
    {
        *left_out = last;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rules::League;

    #[test]
    fn robots_are_left_out_farthest_first_and_regions_of_the_rules_never() {
        let field = League::DivisionB.field();
        let region = Obstacle::region(Shape::Disc { center: Point::new(4.0, 3.0), radius: 0.5 });
        let robot = |x: f32| Obstacle::robot(Point::new(x, 0.0), Vector::default(), 0.2);
        let mut around = Surroundings { fixed: 1, ..Surroundings::none(&field) };
        for obstacle in [region, robot(1.0), robot(3.0), robot(2.0)] {
            around.add(obstacle);
        }
        let me = Point::new(0.0, 0.0);
        for left in [[1.0, 2.0].as_slice(), &[1.0], &[]] {
            around.leave_out_farthest(me, |number| number <= 1 + left.len());
            assert_eq!(around.obstacles[0], region);
            assert!(around.obstacles[1..].iter().copied().eq(left.iter().map(|x| robot(*x))), "{around:?}");
        }
        around.leave_out_farthest(me, |_| false);
        assert_eq!(around.obstacles, [region]);
    }
}
