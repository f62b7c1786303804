//! `small_size`: physics of the Small Size League. Robots on wheels and a golf ball in three dimensions, 1 ms
//! a step (docs/architecture.md §2.3, §7.1).
//!
//! A step of the [`World`]: wheels drive (`robot`), bodies are pushed apart (`collisions`), kickers and
//! dribblers act (`dribbler`), the ball moves (`ball`) and bounces (`contact`), break-beam sensors measure.
//! What happened is returned as [`PhysicsEvent`]s. SI units, field frame; heights are those of the ball's
//! lowest point above the field surface.
//!
//! **Invariants.** No clock and no unseeded randomness; robots are kept in order of colour and number, so the
//! order in which they were placed has no effect; `geometry::math` only; no use of `motion`'s models.

mod ball;
pub mod camera;
mod collisions;
pub mod compatibility;
mod contact;
mod described;
mod dribbler;
mod event;
pub mod network;
mod order;
mod parameters;
mod pitch;
pub mod referee;
mod robot;
mod saved;
mod senses;
pub mod server;
mod surface;
mod trace;
mod wheels;
pub mod worlds;

pub use ball::Ball;
pub use event::PhysicsEvent;
pub use order::{Drive, KickCommand, Order};
pub use parameters::{
    BallParameters, BatteryParameters, BodyParameters, BounceParameters, CameraParameters,
    DribblerParameters, DriveParameters, FieldParameters, KickParameters, NoiseParameters, Parameters,
};
pub use pitch::Pitch;
pub use robot::Robot;

use geometry::{Angle, Field, Point, Pose, Vector};
use protocol::robot_io::ActuatorFrame;
use protocol::{RobotId, Who};
use rules::League;
use serde::{Deserialize, Serialize};

use crate::rng::Stream;
use senses::Senses;
use surface::Slab;
use worlds::{Latency, LinkModel, RobotSpread, WorldModel};

/// The true state of ball and robots.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct World {
    /// True state of the ball.
    pub ball: Ball,
    robots: Vec<Robot>,
    /// Index of each slot's robot in that list.
    places: [Option<u8>; SLOTS],
    senses: Vec<Senses>,
    step: u64,
    parameters: Parameters,
    pitch: Pitch,
    seed: u64,
    kicks: Stream,
    spread: RobotSpread,
    latency: Latency,
    events: Vec<PhysicsEvent>,
    last_touch: Option<(Who, u64)>,
    ball_drag: Option<BallDrag>,
    /// For each pair of slots, the step after the one in which they last touched; 0: never.
    crashes: Vec<u64>,
    pairs: Vec<(u8, u8)>,
    pairs_until: u64,
    near_until: u64,
    /// Robots that the ball could touch before the next search, and robots that could touch a board or goal.
    near_ball: Vec<u8>,
    near_edge: Vec<u8>,
    /// Position of the ball after the last step: it may have been moved manually since.
    ball_was: Point<Field>,
    goal_walls: [Slab; 3],
    /// Distance from the middle along x, m, below which no robot or ball can touch a goal.
    goal_zone: f32,
    /// Height of the highest robot, m.
    highest_robot: f32,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct BallDrag {
    to: Point<Field>,
    /// The step in which it ends; `None`: it lasts until it is released.
    until: Option<u64>,
}

impl World {
    /// A ball in the middle and no robots; random streams come from `seed`.
    pub fn new(league: League, parameters: &Parameters, seed: u64) -> Self {
        let pitch = Pitch { field: league.field(), around: parameters.field };
        let mut world = Self {
            ball: Ball::default(),
            robots: Vec::new(),
            places: [None; SLOTS],
            senses: Vec::new(),
            step: 0,
            parameters: parameters.clone(),
            pitch,
            seed,
            kicks: Stream::new(seed, "small size kicks"),
            spread: RobotSpread::NONE,
            latency: Latency::new(&LinkModel::IDEAL, seed),
            events: Vec::new(),
            last_touch: None,
            ball_drag: None,
            crashes: vec![0; SLOTS * SLOTS],
            pairs: Vec::new(),
            pairs_until: 0,
            near_until: 0,
            near_ball: Vec::new(),
            near_edge: Vec::new(),
            ball_was: Point::default(),
            goal_walls: pitch.goal_walls(),
            goal_zone: 0.0,
            highest_robot: 0.0,
        };
        world.set_pitch(pitch);
        world
    }

    /// The same with a random world model: robots differ, and brains' orders arrive late. Bystanders are
    /// added by a separate call.
    pub fn of_model(league: League, model: &WorldModel, seed: u64) -> Self {
        let world = Self::new(league, &model.parameters, seed);
        Self { spread: model.robots, latency: Latency::new(&model.link, seed), ..world }
    }

    /// Another field for the same robots and ball.
    pub fn set_pitch(&mut self, pitch: Pitch) {
        self.pitch = pitch;
        self.goal_walls = pitch.goal_walls();
        self.goal_zone = pitch.field.length * 0.5 - GOAL_ZONE;
        self.look_again();
    }

    /// Searches again for near robots, after a change.
    fn look_again(&mut self) {
        (self.pairs_until, self.near_until) = (0, 0);
    }

    /// Places a resting robot; it is created where it was never placed before.
    pub fn put(&mut self, who: Who, pose: Pose<Field>) -> &mut Robot {
        let place = match self.place_of(who) {
            Ok(place) => place,
            Err(place) => {
                let mut robot = Robot::new(who, pose, &self.parameters);
                if self.spread != RobotSpread::NONE {
                    robot.set_traits(self.spread.of(self.seed, who));
                }
                self.robots.insert(place, robot);
                self.senses.insert(place, Senses::new(self.parameters.noise, self.seed, who));
                for (place, robot) in self.robots.iter().enumerate() {
                    self.places[robot.who.slot()] = Some(place as u8);
                }
                place
            }
        };
        self.look_again();
        self.highest_robot = self.robots.iter().map(|robot| robot.body.height).fold(0.0, f32::max);
        let robot = &mut self.robots[place];
        robot.present = true;
        robot.place(pose);
        robot
    }

    /// Takes a robot off the field; it keeps its body and its battery.
    pub fn remove(&mut self, who: Who) {
        if let Ok(place) = self.place_of(who) {
            let robot = &mut self.robots[place];
            robot.present = false;
            robot.dragged = None;
            robot.leave_ball();
            robot.push(Vector::default(), 0.0);
            self.look_again();
        }
    }

    /// Changes a robot's body, limits or kicker.
    pub fn alter(&mut self, who: Who, change: impl FnOnce(&mut Robot)) {
        if let Ok(place) = self.place_of(who) {
            change(&mut self.robots[place]);
            self.look_again();
            self.highest_robot = self.robots.iter().map(|robot| robot.body.height).fold(0.0, f32::max);
        }
    }

    /// Other parameters of ball and field surface from the next step on; the caller has checked them.
    pub(crate) fn set_ball_parameters(&mut self, ball: BallParameters) {
        self.parameters.ball = ball;
    }

    /// Places the ball, resting or moving; any pull on it ends.
    pub fn put_ball(&mut self, ball: Ball) {
        self.ball = ball;
        self.ball_drag = None;
    }

    /// Moves robots off the ball, by the shortest displacement.
    pub fn make_room_for_ball(&mut self) {
        let (ball, radius) = (self.ball.position, self.parameters.ball.radius);
        for robot in self.robots.iter_mut().filter(|robot| robot.present) {
            let away = robot.pose.position - ball;
            let room = robot.body.radius + radius + BALL_ROOM;
            if self.ball.height < robot.body.height && away.dot(away) < room * room {
                let direction = away.unit().unwrap_or(Vector::new(-1.0, 0.0));
                robot.pose.position = ball + direction * room;
            }
        }
        self.look_again();
    }

    /// Pulls the ball along the field surface to a position, pushing movable bodies aside, for at most
    /// [`DRAG_STEPS`].
    pub fn drag_ball(&mut self, to: Point<Field>) {
        self.ball_drag = Some(BallDrag { to, until: Some(self.step + DRAG_STEPS) });
    }

    /// Pulls the ball along the field surface to a position, and holds it there until [`World::let_go_ball`].
    pub fn pull_ball(&mut self, to: Point<Field>) {
        self.ball_drag = Some(BallDrag { to, until: None });
    }

    /// The position to which the ball is pulled now.
    pub fn ball_pulled_to(&self) -> Option<Point<Field>> {
        self.ball_drag.map(|drag| drag.to)
    }

    /// Ends the pull on the ball.
    pub fn let_go_ball(&mut self) {
        self.ball_drag = None;
    }

    /// Pulls a robot to a position, for at most [`DRAG_STEPS`].
    pub fn drag_robot(&mut self, who: Who, to: Point<Field>, heading: Option<Angle>) {
        let until = Some(self.step + DRAG_STEPS);
        self.drag(who, Some(robot::Drag { to, heading, until }));
    }

    /// Pulls a robot to a position, and holds it there until [`World::let_go_robot`].
    pub fn pull_robot(&mut self, who: Who, to: Point<Field>, heading: Option<Angle>) {
        self.drag(who, Some(robot::Drag { to, heading, until: None }));
    }

    /// Ends the pull on that robot.
    pub fn let_go_robot(&mut self, who: Who) {
        self.drag(who, None);
    }

    fn drag(&mut self, who: Who, drag: Option<robot::Drag>) {
        if let Ok(place) = self.place_of(who) {
            self.robots[place].dragged = drag;
        }
    }

    /// Gives a robot's body its brain's order, after the world's latency; false where there is no such robot.
    pub fn command(&mut self, who: Who, frame: &ActuatorFrame) -> bool {
        self.send_order(who, Order::from_actuators(frame, &self.parameters))
    }

    /// Gives a robot an order after the world's latency; false where there is no such robot.
    pub fn send_order(&mut self, who: Who, order: Order) -> bool {
        if self.latency.is_none() {
            return self.order(who, order);
        }
        self.latency.send(self.step, who, order);
        self.robot(who).is_some_and(|robot| robot.present)
    }

    /// Gives a robot an order; false where there is no such robot.
    pub fn order(&mut self, who: Who, order: Order) -> bool {
        let now = self.step;
        self.place_of(who).is_ok_and(|place| {
            self.robots[place].obey(order, now, self.parameters.kick.recharge);
            self.robots[place].present
        })
    }

    /// Lays a robot on its side, or sets it upright.
    pub fn tip(&mut self, who: Who, tipped: bool) {
        if let Ok(place) = self.place_of(who) {
            self.robots[place].tipped = tipped;
        }
    }

    /// Advances by 1 ms.
    pub fn step(&mut self) {
        while let Some((who, order)) = self.latency.arrived(self.step) {
            self.order(who, order);
        }
        self.step += 1;
        let now = self.step;
        if now >= self.near_until || self.ball.position != self.ball_was {
            self.look_around();
        }
        for robot in &mut self.robots {
            if robot.present {
                robot.drive(now, &self.parameters.battery);
                if robot.dragged.and_then(|drag| drag.until).is_some_and(|until| until <= now) {
                    robot.dragged = None;
                }
            }
        }
        self.part_robots();
        self.kick();
        self.dribble();
        self.follow_drag();
        self.move_ball();
        self.read_break_beams();
        self.ball_was = self.ball.position;
    }

    fn follow_drag(&mut self) {
        let Some(drag) = self.ball_drag else { return };
        let offset = drag.to - self.ball.position;
        let arrived = offset.dot(offset) < DRAG_ARRIVED_DISTANCE * DRAG_ARRIVED_DISTANCE;
        if drag.until.is_some_and(|until| arrived || until <= self.step) {
            self.ball_drag = None;
        }
        let velocity = if arrived { Vector::default() } else { (offset * DRAG_RATE).clamped(DRAG_SPEED) };
        self.ball = Ball::rolling(self.ball.position, velocity);
    }

    /// The sensor frame of robot `who`; `None` where there is no such robot.
    pub fn sensors(&mut self, who: Who) -> Option<protocol::robot_io::SensorFrame> {
        let place = self.place_of(who).ok()?;
        let (now, battery) = (self.step, self.parameters.battery);
        let robot = &mut self.robots[place];
        robot.present.then(|| self.senses[place].look(robot, now, &battery))
    }

    /// Appends the events since the last call, in order, to `into`.
    pub fn take_events(&mut self, into: &mut Vec<PhysicsEvent>) {
        into.append(&mut self.events);
    }

    /// All robots that were ever placed, by colour and number.
    pub fn robots(&self) -> &[Robot] {
        &self.robots
    }

    /// That robot, on the field or not.
    pub fn robot(&self, who: Who) -> Option<&Robot> {
        self.place_of(who).ok().map(|place| &self.robots[place])
    }

    /// Number of steps so far; one is 1 ms.
    pub fn now(&self) -> u64 {
        self.step
    }

    /// Simulated time since the start, s.
    pub fn time(&self) -> f64 {
        self.step as f64 * 0.001
    }

    /// The robot that touched the ball last, and in which step.
    pub fn last_touch(&self) -> Option<(Who, u64)> {
        self.last_touch
    }

    /// The parameters of the physics.
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// The field and what stands around it.
    pub fn pitch(&self) -> &Pitch {
        &self.pitch
    }

    fn place_of(&self, who: Who) -> Result<usize, usize> {
        match self.places[who.slot()] {
            Some(place) => Ok(usize::from(place)),
            None => Err(self.robots.partition_point(|robot| robot.who < who)),
        }
    }
}

/// Seconds in a step of physics (docs/architecture.md §2.3: Small Size, every 1 ms).
pub const STEP: f32 = 0.001;
/// Maximum number of robots, both colours together.
pub const SLOTS: usize = 2 * RobotId::COUNT;
/// Minimum number of steps without contact before robot and ball, or two robots, count as touching again.
pub const TOUCH_GAP_STEPS: u64 = 50;
/// Maximum duration of one manual pull, steps: the user interface repeats the target long before.
pub const DRAG_STEPS: u64 = 500;
/// Distance from the goal line, m, where contacts with goals are checked: a robot's radius and a step.
const GOAL_ZONE: f32 = 0.15;
/// Gap between a ball and robots that were moved off it, m.
const BALL_ROOM: f32 = 0.001;
/// Distance, m, at which a pulled ball has arrived.
const DRAG_ARRIVED_DISTANCE: f32 = 0.002;
/// Rate at which a pull closes the gap, 1/s.
const DRAG_RATE: f32 = 10.0;
/// Maximum speed of a pull, m/s.
const DRAG_SPEED: f32 = 3.0;

#[cfg(test)]
mod tests;
