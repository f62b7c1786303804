//! `parameters`: parameters of the Small Size simulator. A league's numbers, read from one file, checked,
//! with their sources beside them.
//!
//! `hil-sim/data/{ssl-2013,division-b,division-a}.toml` are those files; SI units, degrees where a name ends
//! in `_deg`. Fields are crate `rules`'; no other code of this module's physics contains physical constants.

use std::sync::LazyLock;

use rules::{League, RobotSpec};
use serde::{Deserialize, Serialize};

use super::wheels::Wheels;
use crate::parameters::{ParameterError, numbers, within};

numbers! {
    /// The ball on the field surface and in the air.
    BallParameters in "ball" {
        /// m, of the ball.
        radius: 0.005, 0.2;
        /// kg, of the ball.
        mass: 0.001, 1.0;
        /// m/s² while it slides.
        slide: TINY, 100.0;
        /// m/s² while it rolls.
        roll: TINY, 10.0;
        /// m/s², downwards on a flying ball.
        gravity: 0.1, 100.0;
        /// Share of the speed along the ground that is kept at the first landing.
        hop_along: 0.0, 1.0;
        /// The same, later landings.
        hop_along_later: 0.0, 1.0;
        /// Share of the vertical speed that is kept at a landing.
        hop_up: 0.0, 0.95;
        /// Minimum height of a hop, m.
        hop_end: TINY, 0.1;
    }
    /// Boards and goals, besides the lengths of crate `rules`.
    FieldParameters in "field" {
        /// Height of the boards round the field surface, m; a ball above flies over.
        wall_height: 0.0, 100.0;
        /// m, thickness of the goals' bars; their upper edge is the goal's.
        bar: 0.0, 0.05;
    }
    /// Shares of the closing speed that come back, and friction.
    BounceParameters in "bounce" {
        /// Ball from a robot's hull.
        hull: 0.0, 0.95;
        /// Ball from its front.
        front: 0.0, 0.95;
        /// Ball from its front with the dribbler turning.
        dribbling: 0.0, 0.95;
        /// Ball from boards, posts and bars.
        wall: 0.0, 0.95;
        /// Ball within a goal.
        net: 0.0, 0.95;
        /// Robots from each other and from boards.
        robots: 0.0, 0.95;
        /// Coefficient along the surface.
        friction: 0.0, 2.0;
        /// Share of its roll that the ball keeps across an impact, along the normal.
        spin: 0.0, 1.0;
    }
    /// Accelerations and speeds of the wheels and the body.
    DriveParameters in "drive" {
        /// m/s², speeding up ahead or backwards.
        forward: 0.1, 100.0;
        /// m/s², speeding up to the sides.
        side: 0.1, 100.0;
        /// m/s², slowing down in any direction.
        brake: 0.1, 100.0;
        /// rad/s², speeding up and slowing down a turn.
        turn: 0.1, 1000.0;
        /// m/s, greatest speed of the centre.
        speed: 0.1, SPEED_MAX;
        /// rad/s, greatest turning rate.
        turn_speed: 0.1, 100.0;
        /// m/s of a wheel that runs free.
        rim_speed: 0.1, 100.0;
        /// m/s² of a wheel from standing.
        rim_acceleration: 0.1, 1000.0;
        /// s without an order until the robot brakes.
        order_lasts: 0.001, 1e6;
    }
    /// The kicker: speeds, scatter, charging.
    KickParameters in "kick" {
        /// m/s, the strongest flat kick.
        flat: 0.0, BALL_SPEED_MAX;
        /// m/s, the strongest chip, in 3-D.
        chip: 0.0, BALL_SPEED_MAX;
        /// Of a chip whose angle is not given.
        chip_deg: 0.0, 90.0;
        /// s from kick to kick.
        recharge: 0.0, 100.0;
        /// Standard deviation of the speed, as a share of it.
        speed_sd: 0.0, 0.3;
        /// Standard deviation of the direction.
        angle_sd_deg: 0.0, 90.0;
        /// Limit at which both are cut, in standard deviations.
        scatter_limit: 0.1, 3.0;
        /// m between ball and front.
        reach: 0.0, 0.1;
    }
    /// The dribbler's roller and its sensor.
    DribblerParameters in "dribbler" {
        /// m between ball and front where it still touches.
        reach: 0.0, 0.1;
        /// m/s² towards the robot, at full speed.
        pull: 0.0, 1000.0;
        /// Share of the pull lost for each m/s that the ball moves over the field surface.
        fade: 0.0, 10.0;
        /// m/s² along the roller.
        side: 0.0, 1000.0;
        /// 1/s, how quickly a gap closes.
        draw: 0.0, 500.0;
        /// Rate at which the ball moves to the middle, 1/s.
        center: 0.0, 500.0;
        /// rpm at full strength.
        full_rpm: 1.0, 1e6;
        /// m between ball and front where the break-beam sensor still detects it.
        barrier: 0.0, 0.1;
    }
    /// The battery: voltages and loads.
    BatteryParameters in "battery" {
        /// V at the terminals when full.
        full: 0.1, 1000.0;
        /// V at the terminals when empty.
        empty: 0.0, 1000.0;
        /// J from full to empty.
        energy: 1.0, 1e9;
        /// W of a standing robot.
        idle: 0.0, 1e4;
        /// W more at 1 m/s.
        drive: 0.0, 1e4;
        /// J of a single kick.
        kick: 0.0, 1e4;
    }
    /// Errors of cameras and sensors.
    NoiseParameters in "noise" {
        /// m, a ball's place.
        ball: 0.0, 1.0;
        /// m, a robot's place.
        robot: 0.0, 1.0;
        /// rad, a robot's heading.
        heading: 0.0, 3.2;
        /// Probability that a camera misses the ball in a frame.
        missing_ball: 0.0, 1.0;
        /// Probability that it misses a robot.
        missing_robot: 0.0, 1.0;
        /// Probability that it sees a ball where none is.
        ghost_ball: 0.0, 1.0;
        /// A ball with a smaller visible share is not detected.
        hidden_ball: 0.0, 1.0;
        /// Share of the measured speed.
        odometry: 0.0, 1.0;
        /// rad/s, of the measured turning rate.
        gyro: 0.0, 10.0;
    }
}

impl NoiseParameters {
    /// Exact measurements, even of a ball behind a robot.
    pub const NONE: Self = Self::ZERO;
}

/// Dimensions and mass of a robot's body.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct BodyParameters {
    /// m, of the hull.
    pub radius: f32,
    /// m, of the hull above the field surface.
    pub height: f32,
    /// m, centre to the flat front.
    pub front: f32,
    /// m to either side of the middle of the front: the width of the dribbler opening.
    pub mouth: f32,
    /// kg, of the whole robot.
    pub mass: f32,
    /// Angles of the wheels, counter-clockwise from ahead: front right, back right, back left, front left; of
    /// a wheel that is not tangential that of the tangential one with the same direction.
    pub wheels_deg: [f32; 4],
    /// m, centre to wheel.
    pub wheel_distance: f32,
    /// Share of that distance by which each wheel turns the robot.
    #[serde(default = "all_of_it")]
    pub wheel_levers: [f32; 4],
    /// Wheels, 3 or 4; of three the last place is empty.
    #[serde(default = "four")]
    pub wheel_count: u8,
}

/// Each wheel stands at the distance, and is tangential.
fn all_of_it() -> [f32; 4] {
    [1.0; 4]
}

fn four() -> u8 {
    4
}

/// The cameras above the field.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct CameraParameters {
    /// 1, 2 (side by side along the length) or 4 (one a quarter).
    pub count: u32,
    /// Hz: frames per second of each camera.
    pub rate: f32,
    /// m above the field surface.
    pub height: f32,
    /// m that neighbours both see.
    pub overlap: f32,
    /// s from the camera frame to its packet.
    pub delay: f32,
    /// s of it that `t_sent` − `t_capture` reports.
    pub processing: f32,
    /// s between geometry packets.
    pub geometry_every: f32,
}

/// The parameters of one league.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// Robots of a team.
    pub robots: u8,
    /// The ball's size and its decelerations.
    pub ball: BallParameters,
    /// Boards and goals around the field.
    pub field: FieldParameters,
    /// Impacts of the ball, and of robots.
    pub bounce: BounceParameters,
    /// Dimensions and mass of each robot.
    pub robot: BodyParameters,
    /// Limits of its wheels' drive.
    pub drive: DriveParameters,
    /// Speeds and charging of its kicker.
    pub kick: KickParameters,
    /// The dribbler's hold on the ball.
    pub dribbler: DribblerParameters,
    /// Voltages and energy of its battery.
    pub battery: BatteryParameters,
    /// Number, rate and delay of the cameras.
    pub camera: CameraParameters,
    /// Errors of cameras and sensors.
    pub noise: NoiseParameters,
}

impl Parameters {
    /// A league's parameters, with robots as this build describes them; `None` for leagues without wheeled
    /// robots.
    pub fn of(league: League) -> Option<&'static Self> {
        Of::league(league).map(|of| &of.described)
    }

    /// The numbers of a league's own file, which is written for the reference robot.
    pub fn of_file(league: League) -> Option<&'static Self> {
        Of::league(league).map(|of| &of.file)
    }

    /// Reads and checks a file in the format of `data/division-b.toml`.
    pub fn from_toml(text: &str) -> Result<Self, ParameterError> {
        let read: Self = toml::from_str(text).map_err(|e| ParameterError::Syntax(e.to_string()))?;
        read.check().map(|()| read)
    }

    /// Checks every number against the limits of the physics.
    pub fn check(&self) -> Result<(), ParameterError> {
        self.ball.check()?;
        self.field.check()?;
        self.bounce.check()?;
        self.drive.check()?;
        self.kick.check()?;
        self.dribbler.check()?;
        self.battery.check()?;
        self.noise.check()?;
        self.robot.check()?;
        self.camera.check()?;
        within("robots", f32::from(self.robots), 1.0, 16.0)
    }
}

impl BodyParameters {
    /// Kinematics of its wheels; `None` where they cannot drive in every direction.
    pub(super) fn wheels(&self) -> Option<Wheels> {
        let levers = self.wheel_levers.map(|share| self.wheel_distance * share);
        Wheels::new(self.wheels_deg, levers, self.wheel_count)
    }

    /// Checks a body against the limits of the physics; specifications of the simulation protocol are checked
    /// here too.
    pub fn check(&self) -> Result<(), ParameterError> {
        within("robot.radius", self.radius, 0.02, 1.0)?;
        within("robot.height", self.height, 0.01, 1.0)?;
        // The front cuts the disc, and the ball lies beyond the wheels.
        within("robot.front", self.front, self.radius * 0.3, self.radius)?;
        within("robot.mouth", self.mouth, 0.0, self.radius)?;
        within("robot.mass", self.mass, 0.1, 100.0)?;
        within("robot.wheel_distance", self.wheel_distance, 0.01, self.radius)?;
        for angle in self.wheels_deg {
            within("robot.wheels_deg", angle, -360.0, 360.0)?;
        }
        for lever in self.wheel_levers {
            within("robot.wheel_levers", lever, 0.0, 1.0)?;
        }
        within("robot.wheel_count", f32::from(self.wheel_count), 3.0, 4.0)?;
        let solved = self.wheels().is_some();
        within("robot.wheels_deg (directions the wheels can drive in)", f32::from(u8::from(solved)), 1.0, 1.0)
    }
}

impl CameraParameters {
    fn check(&self) -> Result<(), ParameterError> {
        let count = self.count as f32;
        if ![1, 2, 4].contains(&self.count) {
            return Err(ParameterError::Range {
                name: "camera.count (1, 2 or 4)",
                value: count,
                low: 1.0,
                high: 4.0,
            });
        }
        within("camera.rate", self.rate, 1.0, 1000.0)?;
        within("camera.height", self.height, 0.5, 100.0)?;
        within("camera.overlap", self.overlap, 0.0, 10.0)?;
        within("camera.delay", self.delay, 0.0, 1.0)?;
        within("camera.processing", self.processing, 0.0, self.delay)?;
        within("camera.geometry_every", self.geometry_every, 0.01, 1e6)
    }
}

/// Nothing divides by less.
const TINY: f32 = 1e-4;
/// Maximum speed of a robot, m/s: steps of 1 ms stay small against bodies.
const SPEED_MAX: f32 = 10.0;
/// Maximum speed of a ball, m/s.
pub(super) const BALL_SPEED_MAX: f32 = 20.0;

/// A league's file, and the same for the robot that is described.
struct Of {
    file: Parameters,
    described: Parameters,
}

static SSL_2013: LazyLock<Of> = LazyLock::new(|| Of::new(include_str!("../../data/ssl-2013.toml")));
static DIVISION_B: LazyLock<Of> = LazyLock::new(|| Of::new(include_str!("../../data/division-b.toml")));
static DIVISION_A: LazyLock<Of> = LazyLock::new(|| Of::new(include_str!("../../data/division-a.toml")));

impl Of {
    fn new(text: &str) -> Self {
        let file = Parameters::from_toml(text).expect("the built-in parameters are checked by a test");
        Self { described: file.for_robot(&RobotSpec::OURS), file }
    }

    fn league(league: League) -> Option<&'static Self> {
        match league {
            League::FourLegged => None,
            League::Ssl2013 => Some(&SSL_2013),
            League::DivisionB => Some(&DIVISION_B),
            League::DivisionA => Some(&DIVISION_A),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_built_in_files_are_valid_and_agree_with_what_brains_believe() {
        for league in [League::Ssl2013, League::DivisionB, League::DivisionA] {
            let parameters = Parameters::of(league).unwrap();
            assert_eq!(parameters.check(), Ok(()));
            assert_eq!(parameters.ball.roll, league.ball().rolling_deceleration);
            assert_eq!(parameters.ball.radius, league.ball().radius);
            assert!(parameters.robot.radius <= league.robot().radius);
        }
        assert!(Parameters::of(League::FourLegged).is_none());
    }

    #[test]
    fn nonsense_is_refused_by_name() {
        let file = include_str!("../../data/division-b.toml");
        let refuse = |from: &str, to: &str| {
            assert!(file.contains(from), "{from}");
            Parameters::from_toml(&file.replace(from, to)).unwrap_err().to_string()
        };
        assert!(refuse("slide = 3.9", "slide = 0.0").contains("ball.slide"));
        assert!(refuse("pull = 6.0", "pull = nan").contains("dribbler.pull"));
        assert!(refuse("front = 0.073", "front = 0.1").contains("robot.front"));
        assert!(refuse("count = 2", "count = 3").contains("camera.count"));
        assert!(refuse("missing_ball = 0.05", "missing_ball = 1.5").contains("noise.missing_ball"));
        assert!(refuse("[-60.0, -135.0, 135.0, 60.0]", "[0.0, 180.0, 0.0, 180.0]").contains("wheels_deg"));
        assert!(refuse("hop_up = 0.5", "hop_upp = 0.5").contains("hop_upp"));
    }
}
