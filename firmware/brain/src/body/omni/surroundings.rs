//! `surroundings`: obstacles of a wheeled robot: all other robots, the rules' shapes, goal walls, and the
//! ball where it avoids it.
//!
//! Regions are for the robot's centre: grown by its radius and by what sight and wheels err. Field frame, m.

use geometry::{Field, GoalEnd, Point, Segment, Shape, Vector};
use motion::avoid::{OBSTACLES_MAX, Obstacle};
use rules::keep_out::{Forbidden, KeepOut, Situation, Why, keep_out};
use rules::limits::{BALL_RADIUS, ROBOT_RADIUS};
use rules::{Duty, FieldSpec, Phase, Side};

use super::Manner;
use crate::belief::Belief;

/// What stands around, and where the body may be.
#[derive(Clone, Debug)]
pub struct Surroundings {
    /// To be kept out of.
    pub obstacles: heapless::Vec<Obstacle<Field>, OBSTACLES_MAX>,
    /// To stay in.
    pub within: Shape<Field>,
}

impl Surroundings {
    /// Where nothing stands around; [`Surroundings::look`] comes next, for they are large to be handed around.
    pub fn none(field: &FieldSpec) -> Self {
        Self { obstacles: heapless::Vec::new(), within: field.carpet().grown(-BODY - BORDER) }
    }

    /// Takes in what matters to this robot on its way to `to`.
    pub fn look(&mut self, belief: &Belief, field: &FieldSpec, to: Point<Field>, manner: Manner) {
        let KeepOut { forbidden, within } = keep_out(&situation(belief, field));
        // Who goes for the ball may touch the boards: one in a corner is had no other way.
        self.within = within.grown(if manner == Manner::Shy { -BODY - BORDER } else { -BODY });
        let me = belief.pose.position;
        // The way it means to go, and the one on which it could come to rest.
        let way = Segment::new(me, to);
        let stops = Segment::new(me, me + belief.velocity * STOPS_IN);
        // A robot at a ball that lies beside an area may be as near as the rules let it.
        let rolls = belief.ball.map_or(0.0, |ball| ball.velocity.norm());
        let at_ball = belief.game.phase == Phase::Run
            && belief.ball.is_some_and(|ball| rolls < LIES && ball.position.distance(to) < AT_BALL);
        let grown = |region: &Forbidden| {
            let law = match region.why {
                Why::OpponentArea | Why::OwnArea if at_ball => LAW_AT_BALL,
                // It comes along with the ball.
                Why::Stadium => LAW + (LEADS * rolls).min(LEADS_MOST),
                _ => LAW,
            };
            region.shape.grown(BODY + law)
        };
        // Who must leave a region may have to leave by another way than the one it means to go: all of them count.
        let covers = |shape: Shape<Field>| shape.contains(me) || shape.contains(to);
        let leaves = forbidden.iter().any(|region| covers(grown(region)));
        for shape in forbidden.iter().map(grown) {
            if leaves || is_near(&shape, way) || is_near(&shape, stops) {
                self.add(Obstacle::region(shape));
            }
        }
        if let Some(lane) = kicking_lane(belief).filter(|lane| !lane.contains(to)) {
            self.add(Obstacle::region(lane));
        }
        if manner == Manner::Shy
            && let Some(ball) = belief.ball.filter(|_| !belief.ball_flies())
        {
            let shy = if belief.is_placing() { SHY_PLACING } else { SHY };
            let shape = Shape::Disc { center: ball.position, radius: BODY + BALL_RADIUS + shy };
            self.add(Obstacle::moving(shape, ball.velocity));
        }
        for goal in [GoalEnd::Negative, GoalEnd::Positive] {
            let near = |p: Point<Field>| p.x() * goal.sign() as f32 > 0.5 * field.length - NEAR_GOAL;
            let leaves_here = leaves && me.x() * goal.sign() as f32 >= 0.0;
            if leaves_here || near(me) || near(to) {
                self.add_goal(field, goal);
            }
        }
        // Close to the ball bodies touch: a robot that went around every opponent there would never have it.
        let margin = if manner == Manner::Shy { ROBOTS } else { ROBOTS_AT_BALL };
        let radius = 2.0 * BODY + margin;
        for other in &belief.others {
            let at = other.pose.position;
            let speed = other.velocity.x().abs() + other.velocity.y().abs();
            let reach = radius + ASIDE + ASIDE_FOR * speed;
            if leaves || way.distance_to(at) < reach || stops.distance_to(at) < reach {
                self.add(Obstacle::robot(at, other.velocity, radius + STRAYS_FOR * speed));
            }
        }
    }

    /// Where there is no room for another one it is left out: rules and goals come first, and robots leave room.
    fn add(&mut self, obstacle: Obstacle<Field>) {
        let _ = self.obstacles.push(obstacle);
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

/// Whether a region comes near the way: looked at from three places on it, each for its stretch.
fn is_near(shape: &Shape<Field>, way: Segment<Field>) -> bool {
    let along = way.vector();
    let stretch = SIXTH * (along.x().abs() + along.y().abs());
    [SIXTH, 0.5, 1.0 - SIXTH]
        .iter()
        .any(|share| shape.distance_to(way.from + along * *share) < stretch + ASIDE)
}

/// Where the ball goes that a teammate is about to kick at our restart: a teammate behind it looks over it. Not to be crossed; who
/// is sent into it waits there for the ball.
fn kicking_lane(belief: &Belief) -> Option<Shape<Field>> {
    let phase = belief.game.phase;
    let ours = matches!(
        phase,
        Phase::Kickoff(Side::Ours) | Phase::FreeKick(Side::Ours) | Phase::Penalty(Side::Ours)
    );
    if !ours || belief.game.duty == Duty::Taker {
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

/// The rules' question, as this robot sees it.
pub fn situation<'f>(belief: &Belief, field: &'f FieldSpec) -> Situation<'f> {
    let game = &belief.game;
    Situation {
        field,
        own: game.defending,
        phase: game.phase,
        duty: game.duty,
        ball: belief.ball.map(|ball| ball.position),
        placement: game.placement,
        ball_in_play: matches!(game.phase, Phase::Run),
    }
}

/// Of a way.
const SIXTH: f32 = 1.0 / 6.0;
/// The robot's own radius, m.
const BODY: f32 = ROBOT_RADIUS;
/// More than the rules' distances, m: vision's noise, its delay at walking pace, and what wheels overshoot.
const LAW: f32 = 0.04;
/// Beside areas at a ball that lies, m: what wheels overshoot at 0.35 m/s.
const LAW_AT_BALL: f32 = 0.01;
/// A placement's stadium swings with the ball by what it rolls in so long, s: picture, radio, and what wheels take to follow; …
const LEADS: f32 = 0.15;
/// … no more than this, m: who stands where hosts send it is 0.15 m clear.
const LEADS_MOST: f32 = 0.3;
/// A slower ball lies, m/s.
const LIES: f32 = 0.3;
/// This near the ball its way ends, m: lining up behind it.
const AT_BALL: f32 = 0.2;
/// From the carpet's edge, m.
const BORDER: f32 = 0.02;
/// From goal walls, m.
const WALL: f32 = 0.01;
/// From a ball that is not to be touched, m.
const SHY: f32 = 0.03;
/// The same while it is placed: what touches it then rolls away.
const SHY_PLACING: f32 = 0.055;
/// From other robots, m.
const ROBOTS: f32 = 0.03;
/// From other robots beside the ball, m.
const ROBOTS_AT_BALL: f32 = 0.0;
/// A teammate this near the ball of our restart is about to kick it, m: 0.18 m where it lines up, and room for a swing.
const KICKS_WITHIN: f32 = 0.35;
/// It looks at the ball within this, rad.
const LOOKS_AT: f32 = 0.35;
/// The lane ends so far from the ball, m: short of who waits for a pass of a metre.
const LANE: f32 = 0.9;
/// Beside the ball's way, m.
const LANE_MARGIN: f32 = 0.03;
/// Who stands farther beside the way than this is in nobody's way, m: a way around one robot keeps nearer.
const ASIDE: f32 = 0.3;
/// Who moves may come nearer for so long, s.
const ASIDE_FOR: f32 = 0.4;
/// Who moves may be elsewhere than it was shown, by this much of its way, s: two images' worth of its velocity's error.
const STRAYS_FOR: f32 = 0.025;
/// At 3 m/s and 3.5 m/s² a robot comes to rest in 0.43 s times its speed, s.
const STOPS_IN: f32 = 0.5;
/// Goal walls matter within this distance of the goal line, m.
const NEAR_GOAL: f32 = 0.7;
