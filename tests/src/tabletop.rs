//! `tabletop`: ideal test world for brains. Bodies that obey at once, grabs that succeed, kicks without
//! scatter, radio that delivers every beacon in the next step: every failure is caused by the test.
//!
//! SI units, field frame; a step is 40 ms. The simulator itself has physics and randomness; here a test
//! places everything.

use brain::{Brain, BrainConfig};
use casebase::CaseBase;
use geometry::{Field, Point, Pose, Twist, Vector};
use protocol::robot_io::{ActuatorFrame, BallSight, LeggedKick, LeggedPrimitive, SensorFrame};
use protocol::team::{Beacon, Closure, CycleState, Decision, TeamMessage};
use protocol::{CycleId, Duration, Instant, RobotId};

/// Robots and a ball in the ideal world.
pub struct Tabletop<'a> {
    /// Number of steps taken, 40 ms each.
    pub steps: u64,
    /// The robots, in rising order of their ids.
    pub robots: Vec<Robot<'a>>,
    /// Position of the ball, m.
    pub ball: Point<Field>,
    /// Velocity of the ball, m/s.
    pub velocity: Vector<Field>,
    /// Opponents, where the test places them.
    pub opponents: Vec<Point<Field>>,
    /// Every kick so far: the robot, the kick and its displacement.
    pub kicks: Vec<(RobotId, LeggedKick, Vector<Field>)>,
    /// Ends of cycles, as reported by any robot.
    pub ends: Vec<(CycleId, Closure)>,
    air: Vec<(RobotId, TeamMessage)>,
}

/// One of our robots.
pub struct Robot<'a> {
    /// Number of the robot in its team.
    pub id: RobotId,
    /// The robot's brain under test.
    pub brain: Brain<'a>,
    /// Its position and heading.
    pub pose: Pose<Field>,
    /// Whether it has the ball.
    pub holds: bool,
    /// Its newest beacon; `None` before the first.
    pub beacon: Option<Beacon>,
    /// Switched off: it neither moves nor sends.
    pub dead: bool,
}

impl<'a> Tabletop<'a> {
    /// With these robots resting, booting now.
    pub fn new(base: CaseBase<'a>, ball: (f32, f32), robots: &[(BrainConfig, Pose<Field>)]) -> Self {
        let robots = robots.iter().map(|(config, pose)| Robot {
            id: config.robot,
            brain: Brain::new(Instant(0), config, base),
            pose: *pose,
            holds: false,
            beacon: None,
            dead: false,
        });
        Self {
            steps: 0,
            robots: robots.collect(),
            ball: Point::new(ball.0, ball.1),
            velocity: Vector::default(),
            opponents: Vec::new(),
            kicks: Vec::new(),
            ends: Vec::new(),
            air: Vec::new(),
        }
    }

    /// Time of the present step, µs since the start.
    pub fn now(&self) -> Instant {
        Instant(self.steps * STEP.0)
    }

    /// The robot of that number.
    pub fn robot(&mut self, number: u8) -> &mut Robot<'a> {
        self.robots.iter_mut().find(|robot| robot.id.number() == number).expect("a robot on the table")
    }

    /// One step of everything.
    pub fn step(&mut self) {
        self.steps += 1;
        let now = self.now();
        let received = std::mem::take(&mut self.air);
        let (ball, opponents) = (self.ball, self.opponents.clone());
        let mut orders = Vec::new();
        for robot in self.robots.iter_mut().filter(|robot| !robot.dead) {
            while let Some(due) = robot.brain.poll_timeout().filter(|due| *due <= now) {
                robot.brain.handle_timeout(due);
            }
            for (from, message) in received.iter().filter(|(from, _)| *from != robot.id) {
                robot.brain.handle_team_message(now, *from, message);
            }
            let sensors = SensorFrame {
                pose: Some(robot.pose),
                ball: Some(BallSight { position: ball, sigma: 0.0, age: Duration(0) }),
                opponents: opponents.iter().copied().collect(),
                ball_contact: robot.holds,
                ..SensorFrame::default()
            };
            robot.brain.handle_sensors(now, &sensors);
            while let Some(message) = robot.brain.poll_message(now) {
                let TeamMessage::Beacon(beacon) = &message else { continue };
                robot.beacon = Some(beacon.clone());
                if let Some(CycleState { id, decision: Decision::Closed(end), .. }) = &beacon.cycle
                    && !self.ends.contains(&(*id, *end))
                {
                    self.ends.push((*id, *end));
                }
                self.air.push((robot.id, message));
            }
            orders.push((robot.id, robot.brain.poll_actuators(now)));
        }
        for (id, order) in orders {
            if let Some(ActuatorFrame::Legged { walk, primitive }) = order {
                self.obey(id, walk, primitive);
            }
        }
        let speed = (self.velocity.norm() - DECELERATION * DT).max(0.0);
        self.velocity = self.velocity.unit().map_or(Vector::default(), |direction| direction * speed);
        self.ball += self.velocity * DT;
    }

    /// Steps until `done`, at most for `seconds`; whether it was reached.
    pub fn until(&mut self, seconds: f32, mut done: impl FnMut(&mut Self) -> bool) -> bool {
        let last = self.steps + (seconds / DT) as u64;
        while self.steps < last {
            self.step();
            if done(self) {
                return true;
            }
        }
        false
    }

    fn obey(&mut self, id: RobotId, walk: Twist<geometry::Body>, primitive: LeggedPrimitive) {
        let Some(robot) = self.robots.iter_mut().find(|robot| robot.id == id) else { return };
        robot.pose.position += robot.pose.vector_to_field(walk.linear) * DT;
        robot.pose.heading = robot.pose.heading + geometry::Angle::new(walk.angular * DT);
        match primitive {
            LeggedPrimitive::Grab => {
                robot.holds = true;
                self.velocity = Vector::default();
            }
            LeggedPrimitive::Kick(kick) if robot.holds => {
                robot.holds = false;
                let (angle, distance) = brain::body::legged::nominal(kick);
                let speed = geometry::math::sqrt(2.0 * DECELERATION * distance);
                self.velocity = Vector::polar(speed, robot.pose.heading + angle);
                self.kicks.push((id, kick, self.velocity));
            }
            LeggedPrimitive::Kick(_) | LeggedPrimitive::None => {}
        }
        if robot.holds {
            self.ball = robot.pose.position + Vector::polar(HOLD_AHEAD, robot.pose.heading);
        }
    }
}

/// Period of a brain's step.
pub const STEP: Duration = Duration::millis(40);
/// Period of a brain's step, s.
const DT: f32 = 0.04;
/// Deceleration of the league's ball on the field surface, m/s².
const DECELERATION: f32 = 0.35;
/// Distance of a held ball ahead of the body's centre, m.
const HOLD_AHEAD: f32 = 0.13;
