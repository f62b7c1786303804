//! `driver`: who moves robots that have no orders of the caller, and the script that needs nothing but the
//! true state. m, s, rad.

use geometry::{Angle, Field, Point, Twist, Vector};
use hil_sim::small_size::{Drive, KickCommand, Order, Robot, World};
use host::strategy::Team;
use protocol::{RobotId, Who};
use rules::Colour;
use serde::{Deserialize, Serialize};

geometry::labels! {
    /// Who moves robots that have no orders of the caller.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    pub enum Driver {
        /// They stand still, or do what the caller orders.
        None = "none",
        /// A script on the true state: the nearest goes for the ball, a keeper keeps the goal.
        Scripted = "scripted",
        /// Our own play: brains, cases and coach, with cameras and radio.
        Coach = "coach",
        /// The same with the open play of the reactive team.
        Reactive = "reactive",
        /// The same with man-to-man defence.
        Marking = "marking",
        /// The same with a wall between ball and goal.
        Zone = "zone",
        /// The first paper's midfield and defender, where `Scripted` is its defender and goalie.
        TwoDefenders = "two-defenders",
    }
}

impl Driver {
    /// The team whose computers and host play, where there are any.
    pub const fn team(self) -> Option<Team> {
        match self {
            Self::None | Self::Scripted | Self::TwoDefenders => None,
            Self::Coach => Some(Team::Ours),
            Self::Reactive => Some(Team::Reactive),
            Self::Marking => Some(Team::Marking),
            Self::Zone => Some(Team::Zone),
        }
    }
}

/// Orders of the script for robots of a side.
pub struct Script {
    /// The side.
    pub colour: Colour,
    /// Its robots from this number to below that one.
    pub robots: std::ops::Range<usize>,
    /// True where robot 0 keeps the goal.
    pub keeper: bool,
    /// True where the robot with the ball shoots; else it holds it.
    pub shoots: bool,
}

impl Script {
    /// Gives them.
    pub fn order(&self, world: &mut World) {
        let ids = self.robots.clone().filter_map(|n| RobotId::new(n as u8));
        let players: Vec<Who> = ids.map(|id| Who { colour: self.colour, id }).collect();
        let ball = world.ball.position;
        let field_players = players.iter().filter(|who| !self.keeps(**who));
        let distances =
            field_players.filter_map(|who| Some((who, world.robot(*who)?.pose.position.distance(ball))));
        let first = distances.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(who, _)| *who);
        for (place, who) in players.into_iter().enumerate() {
            let Some(robot) = world.robot(who) else { continue };
            let order = if self.keeps(who) {
                keep(robot, world)
            } else if Some(who) == first {
                chase(robot, world, self.shoots)
            } else {
                cover(robot, place, world)
            };
            world.send_order(who, order);
        }
    }

    fn keeps(&self, who: Who) -> bool {
        self.keeper && who.id == RobotId::ZERO
    }
}

/// Follows the ball along the goal line: to where it arrives if it comes, else between it and the goal.
fn keep(robot: &Robot, world: &World) -> Order {
    let (ball, field, side) = (&world.ball, world.pitch().field, own_side(robot));
    let line = side * (0.5 * field.length - KEEPER_AHEAD_M);
    let ahead = (line - ball.position.x()) * side;
    let speed = ball.velocity.x() * side;
    let y = if speed > SHOT_MIN_M_S && ahead > 0.0 {
        ball.position.y() + ball.velocity.y() * ahead / speed
    } else {
        ball.position.y() * KEEPER_AHEAD_M / (ahead + KEEPER_AHEAD_M).max(KEEPER_AHEAD_M)
    };
    let half = 0.5 * field.goal_width;
    drive_to(robot, Point::new(line, y.clamp(-half, half)), ball.position, KEEPER_M_S)
}

/// Gets the ball, turns with it to the goal that it attacks, and shoots if it may.
fn chase(robot: &Robot, world: &World, shoots: bool) -> Order {
    let ball = world.ball.position;
    let goal = Point::new(-own_side(robot) * 0.5 * world.pitch().field.length, 0.0);
    if !robot.ball_contact {
        return Order { dribbler: 1.0, ..drive_to(robot, ball, ball, CHASE_M_S) };
    }
    let aimed = shoots && turn_to(robot, goal).abs() < AIMED_RAD;
    let kick = aimed.then_some(KickCommand { speed: SHOT_M_S, angle: 0.0 });
    Order { dribbler: 1.0, kick, ..drive_to(robot, robot.pose.position, goal, CHASE_M_S) }
}

/// Half-way between the ball and an adversary, each another one, but not the one nearest to the ball.
fn cover(robot: &Robot, place: usize, world: &World) -> Order {
    let ball = world.ball.position;
    let others =
        world.robots().iter().filter(|r| r.present && !r.bystander && r.who.colour != robot.who.colour);
    let mut others: Vec<Point<Field>> = others.map(|other| other.pose.position).collect();
    others.sort_by(|a, b| a.distance(ball).total_cmp(&b.distance(ball)));
    let own_goal = Point::new(own_side(robot) * 0.5 * world.pitch().field.length, 0.0);
    let covered = others.get(1 + place % others.len().max(2).saturating_sub(1)).copied().unwrap_or(own_goal);
    drive_to(robot, ball + (covered - ball) * 0.5, ball, CHASE_M_S)
}

fn drive_to(robot: &Robot, to: Point<Field>, facing: Point<Field>, speed: f32) -> Order {
    let linear: Vector<Field> = ((to - robot.pose.position) * APPROACH_PER_S).clamped(speed);
    let angular = (turn_to(robot, facing).radians() * TURN_PER_S).clamp(-TURN_RAD_S, TURN_RAD_S);
    Order { drive: Drive::Global(Twist { linear, angular }), ..Order::default() }
}

/// From its heading to the direction of a point.
fn turn_to(robot: &Robot, point: Point<Field>) -> Angle {
    robot.pose.position.direction_to(point) - robot.pose.heading
}

/// The sign of x at its own goal.
fn own_side(robot: &Robot) -> f32 {
    if robot.who.colour == Colour::Blue { -1.0 } else { 1.0 }
}

/// Distance of the scripted keeper's centre from its goal line, m: two radii of a robot.
const KEEPER_AHEAD_M: f32 = 0.2;
/// A slower ball is no shot, m/s.
const SHOT_MIN_M_S: f32 = 0.5;
/// Speeds of the script, m/s: slower than robots can drive, so that a learner can win.
const KEEPER_M_S: f32 = 2.0;
const CHASE_M_S: f32 = 1.5;
/// Speed of its shots, m/s.
const SHOT_M_S: f32 = 4.0;
/// It shoots where its heading misses the goal's middle by less, rad: a third of the goal from 3 m.
const AIMED_RAD: f32 = 0.1;
/// Shares of distance and angle that it closes, 1/s; estimates that do not overshoot at periods to 100 ms.
const APPROACH_PER_S: f32 = 5.0;
const TURN_PER_S: f32 = 5.0;
/// Fastest turn of the script, rad/s.
const TURN_RAD_S: f32 = 6.0;
