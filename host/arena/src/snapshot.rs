//! `snapshot`: a moment of the simulated field, kept to return to: ball and robots with their motion, from
//! the truth and not as cameras see it. m, m/s, rad, field frame.
//!
//! Hosts, robots' computers, score and clock are not in it: they go on, as where people carry robots and ball
//! back to their places.

use geometry::{Angle, Point, Pose, Vector};
use hil_sim::small_size::{Ball, World};
use protocol::{RobotId, Who};
use rules::{Colour, League};
use serde::{Deserialize, Serialize};

/// A moment of the field.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Snapshot {
    /// Name of the league.
    pub league: String,
    /// Simulated seconds since the start of the match that it was taken from.
    pub t: f64,
    /// The ball.
    pub ball: BallState,
    /// Robots on the field.
    pub robots: Vec<RobotState>,
}

/// A ball of a snapshot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BallState {
    /// Place on the ground, m.
    pub at: [f32; 2],
    /// Along the ground, m/s.
    pub velocity: [f32; 2],
    /// Height of its lowest point, m.
    #[serde(default)]
    pub height: f32,
    /// Upwards, m/s.
    #[serde(default)]
    pub climb: f32,
    /// The velocity at which its spin would roll, m/s.
    #[serde(default)]
    pub spin: [f32; 2],
    /// Landings since it last lay.
    #[serde(default)]
    pub hops: u32,
}

/// A robot of a snapshot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotState {
    /// Whether it is blue; else yellow.
    pub blue: bool,
    /// Number, 0 to 15.
    pub id: u8,
    /// Centre, m.
    pub at: [f32; 2],
    /// Heading, rad.
    pub heading: f32,
    /// m/s.
    #[serde(default)]
    pub velocity: [f32; 2],
    /// rad/s.
    #[serde(default)]
    pub turning: f32,
}

impl RobotState {
    /// Team and number; none where no robot can have the number.
    pub fn who(&self) -> Option<Who> {
        let colour = if self.blue { Colour::Blue } else { Colour::Yellow };
        Some(Who { colour, id: RobotId::new(self.id)? })
    }
}

/// Refusal of a snapshot.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SnapshotError {
    /// Not readable.
    #[error("no snapshot: {0}")]
    Malformed(String),
    /// A snapshot of another league.
    #[error("the snapshot is of {}", foreign::excerpt(.0, 20))]
    League(String),
    /// A number is too large, or none.
    #[error("the snapshot's {0} is out of range")]
    Range(&'static str),
}

impl Snapshot {
    /// The moment of that world.
    pub fn of(world: &World, league: League) -> Self {
        let Ball { position, height, velocity, climb, spin, hops } = world.ball;
        let pair = |v: Vector<geometry::Field>| [v.x(), v.y()];
        let ball = BallState {
            at: [position.x(), position.y()],
            velocity: pair(velocity),
            height,
            climb,
            spin: pair(spin),
            hops,
        };
        let robots = world.robots().iter().filter(|robot| robot.present && !robot.bystander);
        let robots = robots.map(|robot| RobotState {
            blue: robot.who.colour == Colour::Blue,
            id: robot.who.id.number(),
            at: [robot.pose.position.x(), robot.pose.position.y()],
            heading: robot.pose.heading.radians(),
            velocity: pair(robot.velocity),
            turning: robot.turning,
        });
        Self { league: league.name().to_owned(), t: world.time(), ball, robots: robots.collect() }
    }

    /// Its robots, as listed.
    pub fn present(&self) -> impl Iterator<Item = Who> + '_ {
        self.robots.iter().filter_map(RobotState::who)
    }

    /// From the JSON of a file, within what a field of that league can hold.
    pub fn from_json(json: &str, league: League) -> Result<Self, SnapshotError> {
        let read: Self =
            serde_json::from_str(json).map_err(|error| SnapshotError::Malformed(error.to_string()))?;
        if read.league != league.name() {
            return Err(SnapshotError::League(read.league));
        }
        let within = |values: &[f32], most: f32| values.iter().all(|value| value.abs() <= most);
        let BallState { at, velocity, height, climb, spin, .. } = read.ball;
        if !within(&at, FARTHEST) || !(0.0..=HIGHEST).contains(&height) {
            return Err(SnapshotError::Range("ball's place"));
        }
        if !within(&[velocity, spin].concat(), FASTEST) || !within(&[climb], FASTEST) {
            return Err(SnapshotError::Range("ball's velocity"));
        }
        if read.robots.len() > 2 * RobotId::COUNT {
            return Err(SnapshotError::Range("number of robots"));
        }
        for robot in &read.robots {
            let placed = within(&robot.at, FARTHEST) && within(&[robot.heading], TURNED);
            if !placed || RobotId::new(robot.id).is_none() {
                return Err(SnapshotError::Range("place or number of a robot"));
            }
            if !within(&robot.velocity, FASTEST) || !within(&[robot.turning], SPINNING) {
                return Err(SnapshotError::Range("velocity of a robot"));
            }
        }
        Ok(read)
    }

    /// Puts ball and robots back; robots that are not on the field now stay off it.
    pub fn restore(&self, world: &mut World) {
        for state in &self.robots {
            let Some(who) = state.who() else { continue };
            if !world.robot(who).is_some_and(|robot| robot.present) {
                continue;
            }
            let position = Point::new(state.at[0], state.at[1]);
            let pose = Pose { position, heading: Angle::new(state.heading) };
            world.put(who, pose).push(Vector::new(state.velocity[0], state.velocity[1]), state.turning);
        }
        let BallState { at, velocity, height, climb, spin, hops } = self.ball;
        world.put_ball(Ball {
            position: Point::new(at[0], at[1]),
            height,
            velocity: Vector::new(velocity[0], velocity[1]),
            climb,
            spin: Vector::new(spin[0], spin[1]),
            hops,
        });
    }
}

/// Largest coordinate of a place, m: no field is larger.
const FARTHEST: f32 = 20.0;
/// Highest ball, m.
const HIGHEST: f32 = 10.0;
/// Fastest ball or robot, m/s.
const FASTEST: f32 = 20.0;
/// Largest heading, rad: one that wraps is read too.
const TURNED: f32 = 1e3;
/// Fastest turn, rad/s.
const SPINNING: f32 = 100.0;

#[cfg(test)]
mod tests;
