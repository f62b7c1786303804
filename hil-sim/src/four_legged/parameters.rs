//! `parameters`: parameters of the four-legged simulator. The league's numbers, read from one file, checked,
//! with their sources beside them.
//!
//! `hil-sim/data/four-legged.toml` is that file; SI units, degrees where a name ends in `_deg`. No other code
//! of this crate contains physical constants. Dimensions of field, robots and ball are crate `rules`'; only
//! the ball's deceleration stands in both: brains use the value of `rules`, the simulated world the file's,
//! and a test checks that they agree.

use std::fmt;
use std::sync::LazyLock;

use serde::{Deserialize, Serialize};

/// The parameters of one league.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// The ball on the field surface.
    pub ball: BallParameters,
    /// Walking freely.
    pub walk: WalkParameters,
    /// Walking with the ball.
    pub carry: CarryParameters,
    /// Taking the ball.
    pub grab: GrabParameters,
    /// Kicking it.
    pub kick: KickParameters,
    /// The scripted opponents.
    pub opponent: OpponentParameters,
    /// When a trial ends and what counts.
    pub referee: RefereeParameters,
    /// Perception of the real-robot profile.
    pub noise: Noise,
}

/// The ball on the field surface.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct BallParameters {
    /// m/s², constant until it stops.
    pub deceleration: f32,
    /// Share of the closing speed that comes back from a robot.
    pub bounce: f32,
}

/// Limits of walking.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct WalkParameters {
    /// m/s ahead.
    pub forward: f32,
    /// m/s to the sides and backwards.
    pub sideways: f32,
    /// rad/s.
    pub turn: f32,
    /// m/s².
    pub acceleration: f32,
    /// rad/s².
    pub turn_acceleration: f32,
}

/// Limits of walking with the ball.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct CarryParameters {
    /// m/s in any direction.
    pub speed: f32,
    /// rad/s.
    pub turn: f32,
}

/// The grab.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct GrabParameters {
    /// s.
    pub duration: f32,
    /// m, centre to centre.
    pub reach: f32,
    /// rad to either side.
    pub half_angle: f32,
    /// m/s between ball and body.
    pub speed_limit: f32,
    /// Probability that a grab whose legs closed upon the ball keeps it.
    pub success: f32,
    /// Probability that such a grab takes a ball out of another robot's legs, as a share of `success`.
    pub contest: f32,
    /// m, centre to centre while held.
    pub hold_distance: f32,
    /// m that the ball rolls away from a failed grab.
    pub fumble: f32,
}

/// The kicks.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct KickParameters {
    /// s from order to ball contact.
    pub duration: f32,
    /// Standard deviation of the distance, as a share of it.
    pub distance_sd: f32,
    /// Standard deviation of the direction.
    pub angle_sd_deg: f32,
    /// Where both are cut, in standard deviations.
    pub scatter_limit: f32,
    /// m.
    pub forward_soft: f32,
    /// m.
    pub forward_hard: f32,
    /// m.
    pub side: f32,
    /// To the left of ahead; the right kick mirrors it.
    pub side_angle_deg: f32,
    /// m, the weakest pass.
    pub pass_min: f32,
    /// m, the strongest pass.
    pub pass_max: f32,
}

/// Where the scripted opponents play.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct OpponentParameters {
    /// Home of the defender.
    pub defender: Region,
    /// Home of the midfield defender.
    pub midfield: Region,
    /// Home of the goalie.
    pub goalie: Region,
}

/// A rectangle of the field, m: from and to along x and y.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Region {
    /// From, to.
    pub x: [f32; 2],
    /// From, to.
    pub y: [f32; 2],
}

/// When a trial ends and what counts.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct RefereeParameters {
    /// m beside a goalpost that still count as close.
    pub close: f32,
    /// s without contact before a touch counts as a new possession.
    pub possession_gap: f32,
    /// s, against defender and goalie.
    pub time_limit_dg: f32,
    /// s, against two defenders.
    pub time_limit_2d: f32,
}

/// Standard deviations of what robots perceive.
#[derive(Clone, Copy, Debug, PartialEq, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Noise {
    /// Of the own position, m.
    pub pose: f32,
    /// Of the own heading.
    pub heading_deg: f32,
    /// Of the ball's position, as a share of its distance.
    pub ball_share: f32,
    /// Of the ball's position, m, at any distance.
    pub ball_floor: f32,
    /// Of an opponent's position, m.
    pub opponent: f32,
}

impl Noise {
    /// As in the paper's simulator: everything is seen where it is.
    pub const NONE: Self =
        Self { pose: 0.0, heading_deg: 0.0, ball_share: 0.0, ball_floor: 0.0, opponent: 0.0 };
}

impl Parameters {
    /// The parameters of the four-legged league.
    pub fn four_legged() -> &'static Self {
        &FOUR_LEGGED
    }

    /// Reads and checks a file in the format of `data/four-legged.toml`.
    pub fn from_toml(text: &str) -> Result<Self, ParameterError> {
        let read: Self = toml::from_str(text).map_err(|e| ParameterError::Syntax(e.to_string()))?;
        read.check().map(|()| read)
    }

    /// Checks every number against the limits of the physics.
    fn check(&self) -> Result<(), ParameterError> {
        let Self { ball, walk, carry, grab, kick, opponent, referee, noise } = self;
        let positive = [
            ("ball.deceleration", ball.deceleration),
            ("walk.forward", walk.forward),
            ("walk.sideways", walk.sideways),
            ("walk.turn", walk.turn),
            ("walk.acceleration", walk.acceleration),
            ("walk.turn_acceleration", walk.turn_acceleration),
            ("carry.speed", carry.speed),
            ("carry.turn", carry.turn),
            ("grab.duration", grab.duration),
            ("grab.reach", grab.reach),
            ("grab.half_angle", grab.half_angle),
            ("grab.speed_limit", grab.speed_limit),
            ("grab.hold_distance", grab.hold_distance),
            ("kick.duration", kick.duration),
            ("kick.scatter_limit", kick.scatter_limit),
            ("kick.forward_soft", kick.forward_soft),
            ("kick.forward_hard", kick.forward_hard),
            ("kick.side", kick.side),
            ("kick.pass_min", kick.pass_min),
            ("referee.time_limit_dg", referee.time_limit_dg),
            ("referee.time_limit_2d", referee.time_limit_2d),
        ];
        let not_negative = [
            ("grab.fumble", grab.fumble),
            ("kick.angle_sd_deg", kick.angle_sd_deg),
            ("kick.side_angle_deg", kick.side_angle_deg),
            ("referee.close", referee.close),
            ("referee.possession_gap", referee.possession_gap),
            ("noise.pose", noise.pose),
            ("noise.heading_deg", noise.heading_deg),
            ("noise.ball_share", noise.ball_share),
            ("noise.ball_floor", noise.ball_floor),
            ("noise.opponent", noise.opponent),
        ];
        let range = |name, value: f32, low: f32, high: f32| {
            if (low..=high).contains(&value) {
                Ok(())
            } else {
                Err(ParameterError::Range { name, value, low, high })
            }
        };
        for (name, value) in positive {
            range(name, value, f32::MIN_POSITIVE, LARGEST)?;
        }
        for (name, value) in not_negative {
            range(name, value, 0.0, LARGEST)?;
        }
        range("ball.bounce", ball.bounce, 0.0, 1.0)?;
        range("grab.success", grab.success, 0.0, 1.0)?;
        range("grab.contest", grab.contest, 0.0, 1.0)?;
        range("grab.hold_distance", grab.hold_distance, 0.0, grab.reach)?;
        // Beyond this a kick of −limit standard deviations would roll backwards.
        range("kick.distance_sd", kick.distance_sd, 0.0, 1.0 / kick.scatter_limit)?;
        range("kick.pass_max", kick.pass_max, kick.pass_min, LARGEST)?;
        let corners = [
            ("opponent.defender", opponent.defender),
            ("opponent.midfield", opponent.midfield),
            ("opponent.goalie", opponent.goalie),
        ];
        for (name, region) in corners {
            for [from, to] in [region.x, region.y] {
                range(name, from, -LARGEST, LARGEST)?;
                range(name, to, from, LARGEST)?;
            }
        }
        Ok(())
    }
}

/// Why a file of parameters cannot be used.
#[derive(Clone, Debug, PartialEq)]
pub enum ParameterError {
    /// Not TOML, or a key unknown, missing or of a wrong type.
    Syntax(String),
    /// A number outside the limits of the physics.
    Range {
        /// Name of the number, as in the file.
        name: &'static str,
        /// Its value.
        value: f32,
        /// Its minimum.
        low: f32,
        /// Its maximum.
        high: f32,
    },
}

impl fmt::Display for ParameterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Syntax(message) => write!(f, "parameters: {message}"),
            Self::Range { name, value, low, high } => {
                write!(f, "parameters: {name} is {value}, must be within {low} to {high}")
            }
        }
    }
}

impl std::error::Error for ParameterError {}

/// The file, embedded in the program so that the binary needs no file to run.
pub const FOUR_LEGGED_TOML: &str = include_str!("../../data/four-legged.toml");

/// Upper bound of every length, speed and time, in the unit of each number: rejects nonsense.
const LARGEST: f32 = 10_000.0;

static FOUR_LEGGED: LazyLock<Parameters> = LazyLock::new(|| {
    Parameters::from_toml(FOUR_LEGGED_TOML).expect("the built-in parameters are checked by a test")
});

#[cfg(test)]
mod tests {
    use geometry::GoalEnd;
    use rules::League;

    use super::*;

    #[test]
    fn the_built_in_file_is_valid_and_agrees_with_what_brains_believe() {
        let parameters = Parameters::from_toml(FOUR_LEGGED_TOML).unwrap();
        assert_eq!(parameters.ball.deceleration, League::FourLegged.ball().rolling_deceleration);
    }

    #[test]
    fn the_goalies_home_is_the_penalty_area_and_the_defender_stays_out_of_it() {
        let (field, homes) = (League::FourLegged.field(), &Parameters::four_legged().opponent);
        let goal_x = field.goal_center(GoalEnd::Positive).x();
        assert_eq!(homes.goalie.x[1], goal_x);
        assert!((homes.goalie.x[0] - (goal_x - field.penalty_depth)).abs() < 1e-6);
        assert_eq!(homes.goalie.y, [-field.penalty_width / 2.0, field.penalty_width / 2.0]);
        assert!(homes.defender.x[1] <= homes.goalie.x[0]);
    }

    #[test]
    fn nonsense_is_refused_by_name() {
        let refuse = |from: &str, to: &str| {
            assert!(FOUR_LEGGED_TOML.contains(from), "{from}");
            Parameters::from_toml(&FOUR_LEGGED_TOML.replace(from, to)).unwrap_err().to_string()
        };
        assert!(refuse("deceleration = 0.35", "deceleration = 0.0").contains("ball.deceleration"));
        assert!(refuse("deceleration = 0.35", "deceleration = nan").contains("ball.deceleration"));
        assert!(refuse("success = 0.75", "success = 1.5").contains("grab.success"));
        assert!(refuse("distance_sd = 0.3", "distance_sd = 0.6").contains("kick.distance_sd"));
        assert!(refuse("x = [0.9, 2.05]", "x = [2.05, 0.9]").contains("opponent.defender"));
        assert!(refuse("bounce = 0.3", "bonce = 0.3").contains("bonce"));
    }
}
