//! `small_size`: physics of the Small Size League. Robots on wheels and a golf ball in three dimensions, 1 ms
//! a step (docs/architecture.md §2.3, §7.1).
//!
//! A step of the [`World`]: wheels drive (`robot`), bodies part (`crowd`), kickers and dribblers act (`mouth`), the ball
//! moves (`ball`) and bounces (`contact`), light barriers look. What happened comes out as [`Event`]s. SI units, field
//! frame; heights are those of the ball's lowest point above the carpet.
//!
//! **Invariants.** No clock and no unseeded chance; robots are kept in order of colour and number, so who was put down first
//! decides nothing; `geometry::math` only; nothing of `motion`'s models.

mod ball;
pub mod camera;
mod contact;
mod crowd;
mod event;
mod mouth;
mod order;
mod parameters;
mod pitch;
pub mod quirks;
pub mod referee;
mod robot;
mod senses;
pub mod server;
mod surface;
mod trace;
mod wheels;
pub mod worlds;

pub use ball::Ball;
pub use event::Event;
pub use order::{Drive, Kick, Order};
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

use crate::rng::Stream;
use senses::Senses;
use surface::Slab;
use worlds::{Latency, LinkModel, RobotSpread, WorldModel};

/// The true state of everything on the carpet.
#[derive(Clone, Debug)]
pub struct World {
    /// The ball.
    pub ball: Ball,
    robots: Vec<Robot>,
    /// Where each slot's robot stands in that list.
    places: [Option<u8>; SLOTS],
    senses: Vec<Senses>,
    step: u64,
    parameters: Parameters,
    pitch: Pitch,
    seed: u64,
    kicks: Stream,
    spread: RobotSpread,
    latency: Latency,
    events: Vec<Event>,
    last_touch: Option<(Who, u64)>,
    ball_drag: Option<BallDrag>,
    /// Of each pair of slots the step after the one in which they last touched; 0: never.
    crashes: Vec<u64>,
    pairs: Vec<(u8, u8)>,
    pairs_until: u64,
    near_until: u64,
    /// Robots that the ball could meet before the next look, and robots that could meet a board or goal.
    near_ball: Vec<u8>,
    near_edge: Vec<u8>,
    /// Where the ball was after the last step: it may have been moved by hand since.
    ball_was: Point<Field>,
    goal_walls: [Slab; 3],
    /// m from the middle along x: nearer no goal is in anybody's way.
    goal_zone: f32,
    /// m.
    highest_robot: f32,
}

/// The ball is pulled.
#[derive(Clone, Copy, Debug, PartialEq)]
struct BallDrag {
    to: Point<Field>,
    /// The step in which it ends; `None`: it lasts until it is ended.
    until: Option<u64>,
}

impl World {
    /// A ball in the middle and nobody there; chance comes from `seed`.
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

    /// The same in a world of the family: robots differ, and what brains order comes late. Bystanders come when they are told to.
    pub fn of_model(league: League, model: &WorldModel, seed: u64) -> Self {
        let world = Self::new(league, &model.parameters, seed);
        Self { spread: model.robots, latency: Latency::new(&model.link, seed), ..world }
    }

    /// Another field under the same robots and ball.
    pub fn set_pitch(&mut self, pitch: Pitch) {
        self.pitch = pitch;
        self.goal_walls = pitch.goal_walls();
        self.goal_zone = pitch.field.length * 0.5 - GOAL_ZONE;
        self.look_again();
    }

    /// What was near what may have changed.
    fn look_again(&mut self) {
        (self.pairs_until, self.near_until) = (0, 0);
    }

    /// Puts a robot there, at rest; it is made where it has never been.
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

    /// Takes a robot off the carpet; it keeps its body and its battery.
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

    /// Another ball or carpet from the next step on; to be checked before.
    pub(crate) fn set_ball_parameters(&mut self, ball: BallParameters) {
        self.parameters.ball = ball;
    }

    /// Puts the ball somewhere, moving or not; nobody pulls it any longer.
    pub fn put_ball(&mut self, ball: Ball) {
        self.ball = ball;
        self.ball_drag = None;
    }

    /// Moves robots off the ball, by the shortest way.
    pub fn make_room_for_ball(&mut self) {
        let (ball, radius) = (self.ball.position, self.parameters.ball.radius);
        for robot in self.robots.iter_mut().filter(|robot| robot.present) {
            let away = robot.pose.position - ball;
            let room = robot.body.radius + radius + ROOM;
            if self.ball.height < robot.body.height && away.dot(away) < room * room {
                let direction = away.unit().unwrap_or(Vector::new(-1.0, 0.0));
                robot.pose.position = ball + direction * room;
            }
        }
        self.look_again();
    }

    /// A hand pulls the ball there along the carpet, through what gives way, for [`DRAG_STEPS`] at most.
    pub fn drag_ball(&mut self, to: Point<Field>) {
        self.ball_drag = Some(BallDrag { to, until: Some(self.step + DRAG_STEPS) });
    }

    /// A force pulls the ball there along the carpet, and holds it there until [`World::let_go_ball`].
    pub fn pull_ball(&mut self, to: Point<Field>) {
        self.ball_drag = Some(BallDrag { to, until: None });
    }

    /// Where the ball is pulled to now.
    pub fn ball_pulled_to(&self) -> Option<Point<Field>> {
        self.ball_drag.map(|drag| drag.to)
    }

    /// Nothing pulls the ball any longer.
    pub fn let_go_ball(&mut self) {
        self.ball_drag = None;
    }

    /// A hand pulls a robot there, for [`DRAG_STEPS`] at most.
    pub fn drag_robot(&mut self, who: Who, to: Point<Field>, heading: Option<Angle>) {
        let until = Some(self.step + DRAG_STEPS);
        self.drag(who, Some(robot::Drag { to, heading, until }));
    }

    /// A force pulls a robot there, and holds it there until [`World::let_go_robot`].
    pub fn pull_robot(&mut self, who: Who, to: Point<Field>, heading: Option<Angle>) {
        self.drag(who, Some(robot::Drag { to, heading, until: None }));
    }

    /// Nothing pulls that robot any longer.
    pub fn let_go_robot(&mut self, who: Who) {
        self.drag(who, None);
    }

    fn drag(&mut self, who: Who, drag: Option<robot::Drag>) {
        if let Ok(place) = self.place_of(who) {
            self.robots[place].dragged = drag;
        }
    }

    /// What a robot's brain wants of its body, after the world's latency; false where no such robot is.
    pub fn command(&mut self, who: Who, frame: &ActuatorFrame) -> bool {
        let order = Order::from_actuators(frame, &self.parameters);
        if self.latency.is_none() {
            return self.order(who, order);
        }
        self.latency.send(self.step, who, order);
        self.robot(who).is_some_and(|robot| robot.present)
    }

    /// What a robot shall do; false where no such robot is.
    pub fn order(&mut self, who: Who, order: Order) -> bool {
        let now = self.step;
        self.place_of(who).is_ok_and(|place| {
            self.robots[place].obey(order, now, self.parameters.kick.recharge);
            self.robots[place].present
        })
    }

    /// A robot lies on its side, or stands again.
    pub fn tip(&mut self, who: Who, tipped: bool) {
        if let Ok(place) = self.place_of(who) {
            self.robots[place].tipped = tipped;
        }
    }

    /// 1 ms passes.
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
        self.look_into_mouths();
        self.ball_was = self.ball.position;
    }

    fn follow_drag(&mut self) {
        let Some(drag) = self.ball_drag else { return };
        let way = drag.to - self.ball.position;
        let arrived = way.dot(way) < ARRIVED * ARRIVED;
        if drag.until.is_some_and(|until| arrived || until <= self.step) {
            self.ball_drag = None;
        }
        let velocity = if arrived { Vector::default() } else { (way * DRAG_RATE).clamped(DRAG_SPEED) };
        self.ball = Ball::rolling(self.ball.position, velocity);
    }

    /// What robot `who` perceives now of itself; `None` where no such robot is.
    pub fn sensors(&mut self, who: Who) -> Option<protocol::robot_io::SensorFrame> {
        let place = self.place_of(who).ok()?;
        let (now, battery) = (self.step, self.parameters.battery);
        let robot = &mut self.robots[place];
        robot.present.then(|| self.senses[place].look(robot, now, &battery))
    }

    /// What happened since the last call, in order, to the end of `into`.
    pub fn take_events(&mut self, into: &mut Vec<Event>) {
        into.append(&mut self.events);
    }

    /// All robots that ever were there, by colour and number.
    pub fn robots(&self) -> &[Robot] {
        &self.robots
    }

    /// That robot, present or not.
    pub fn robot(&self, who: Who) -> Option<&Robot> {
        self.place_of(who).ok().map(|place| &self.robots[place])
    }

    /// Steps so far; one is 1 ms.
    pub fn now(&self) -> u64 {
        self.step
    }

    /// Seconds so far.
    pub fn time(&self) -> f64 {
        self.step as f64 * 0.001
    }

    /// Who touched the ball last, and in which step.
    pub fn last_touch(&self) -> Option<(Who, u64)> {
        self.last_touch
    }

    /// How it behaves.
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// What stands around.
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
/// Robots of both colours that there can be.
pub const SLOTS: usize = 2 * RobotId::COUNT;
/// Steps apart after which robot and ball, or two robots, touch anew.
pub const TOUCH_GAP_STEPS: u64 = 50;
/// Steps that a hand pulls at most: it says where again long before.
pub const DRAG_STEPS: u64 = 500;
/// m before the goal line where goals begin to be in the way: a robot's radius and a step.
const GOAL_ZONE: f32 = 0.15;
/// m between a ball and robots that were moved off it.
const ROOM: f32 = 0.001;
/// m: a ball that is pulled has arrived.
const ARRIVED: f32 = 0.002;
/// 1/s: how quickly somebody who pulls the ball closes the gap.
const DRAG_RATE: f32 = 10.0;
/// m/s: and no faster.
const DRAG_SPEED: f32 = 3.0;

#[cfg(test)]
mod tests;
