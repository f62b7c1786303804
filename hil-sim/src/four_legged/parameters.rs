//! `parameters`: parameters of the four-legged simulator. The league's numbers, read from one file, checked,
//! with their sources beside them.
//!
//! `hil-sim/data/four-legged.toml` is that file; SI units, degrees where a name ends in `_deg`. No other code
//! of this crate contains physical constants. Dimensions of field, robots and ball are crate `rules`'; only
//! the ball's deceleration stands in both: brains use the value of `rules`, the simulated world the file's,
//! and a test checks that they agree.

use std::sync::LazyLock;

use serde::{Deserialize, Serialize};

use crate::parameters::{ParameterError, numbers, within};

/// The numbers of one league.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// The ball on the field surface.
    pub ball: BallParameters,
    /// Limits of walking without the ball.
    pub walk: WalkParameters,
    /// Walking with the ball.
    pub carry: CarryParameters,
    /// Duration, reach and success of a grab.
    pub grab: GrabParameters,
    /// Distances and scatter of the kicks.
    pub kick: KickParameters,
    /// Home regions of the scripted opponents.
    pub opponent: OpponentParameters,
    /// Ends of a trial, and its counts.
    pub referee: RefereeParameters,
    /// Perception of the real-robot profile.
    pub noise: Noise,
}

numbers! {
    /// The ball on the field surface.
    BallParameters in "ball" {
        /// m/s², constant until rest.
        deceleration: POSITIVE, LARGEST;
        /// Share of the closing speed that comes back from a robot.
        bounce: 0.0, 1.0;
    }
    /// Limits of walking without the ball.
    WalkParameters in "walk" {
        /// m/s, straight ahead, at most.
        forward: POSITIVE, LARGEST;
        /// m/s to the sides and backwards.
        sideways: POSITIVE, LARGEST;
        /// rad/s, greatest turning rate.
        turn: POSITIVE, LARGEST;
        /// m/s², speeding up and slowing down.
        acceleration: POSITIVE, LARGEST;
        /// rad/s², speeding up and slowing down a turn.
        turn_acceleration: POSITIVE, LARGEST;
    }
    /// Limits of walking with the ball.
    CarryParameters in "carry" {
        /// m/s in any direction.
        speed: POSITIVE, LARGEST;
        /// rad/s, greatest turning rate.
        turn: POSITIVE, LARGEST;
    }
    /// The grab: duration, reach, success.
    GrabParameters in "grab" {
        /// s from order to its end.
        duration: POSITIVE, LARGEST;
        /// m, centre to centre.
        reach: POSITIVE, LARGEST;
        /// rad to either side.
        half_angle: POSITIVE, LARGEST;
        /// m/s between ball and body.
        speed_limit: POSITIVE, LARGEST;
        /// Probability that a grab whose legs closed upon the ball keeps it.
        success: 0.0, 1.0;
        /// Probability that such a grab takes a ball out of another robot's grip, as a share of `success`.
        contest: 0.0, 1.0;
        /// m, centre to centre while held.
        hold_distance: POSITIVE, LARGEST;
        /// m that the ball rolls away from a failed grab.
        fumble: 0.0, LARGEST;
    }
    /// The kicks: distances and scatter.
    KickParameters in "kick" {
        /// s from order to ball contact.
        duration: POSITIVE, LARGEST;
        /// Standard deviation of the distance, as a share of it.
        distance_sd: 0.0, LARGEST;
        /// Standard deviation of the direction.
        angle_sd_deg: 0.0, LARGEST;
        /// Limit at which both are cut, in standard deviations.
        scatter_limit: POSITIVE, LARGEST;
        /// m that the ball rolls, soft kick.
        forward_soft: POSITIVE, LARGEST;
        /// m that the ball rolls, hard kick.
        forward_hard: POSITIVE, LARGEST;
        /// m that the ball rolls, side kick.
        side: POSITIVE, LARGEST;
        /// To the left of ahead; the right kick mirrors it.
        side_angle_deg: 0.0, LARGEST;
        /// m, the weakest pass.
        pass_min: POSITIVE, LARGEST;
        /// m, the strongest pass.
        pass_max: POSITIVE, LARGEST;
    }
    /// Places and time of a clearance.
    ClearParameters in "opponent.clear" {
        /// m within the lines at which a clearance should end.
        inside: 0.0, LARGEST;
        /// m from the ball on which no robot may stand in the kick's path.
        corridor: 0.0, LARGEST;
        /// s for which the ball is held at most.
        hold: 0.0, LARGEST;
    }
    /// Ends of a trial, and its counts.
    RefereeParameters in "referee" {
        /// m beside a goalpost that still count as close.
        close: 0.0, LARGEST;
        /// s without contact before a touch counts again.
        possession_gap: 0.0, LARGEST;
        /// s, against defender and goalie.
        time_limit_dg: POSITIVE, LARGEST;
        /// s, against two defenders.
        time_limit_2d: POSITIVE, LARGEST;
    }
    /// Perception of the real-robot profile; all zero: perception without noise.
    #[derive(Default)]
    Noise in "noise" {
        /// Width of the camera's view.
        field_of_view_deg: 0.0, 360.0;
        /// Standard deviation of an edge in the camera's image.
        pixel_deg: 0.0, LARGEST;
        /// Angle that the head turns to either side.
        pan_deg: 0.0, 180.0;
        /// s from one sweep of the head to the next.
        glance_every: 0.0, LARGEST;
        /// s of a sweep.
        glance_for: 0.0, LARGEST;
        /// s without a sight of the ball after which the head sweeps.
        lost_after: 0.0, LARGEST;
        /// Size by which a marker's range is measured, m.
        marker: 0.0, LARGEST;
        /// Size by which a goal's range is measured, m.
        goal: 0.0, LARGEST;
        /// Standard deviation of a range at no distance, m.
        range_floor: 0.0, LARGEST;
        /// Standard deviation of all bearings of a frame together, standing.
        joint_deg: 0.0, LARGEST;
        /// Added to it while walking.
        sway_deg: 0.0, LARGEST;
        /// Correlation time of the sway, s.
        sway_time: 0.0, LARGEST;
        /// Share of detections missed at no distance.
        miss: 0.0, 1.0;
        /// Distance at which the ball is no longer detected, m.
        ball_within: 0.0, LARGEST;
        /// Distance at which a landmark is no longer detected, m.
        landmark_within: 0.0, LARGEST;
        /// Standard deviation of the odometry's scale, by axis.
        odometry_scale: 0.0, 1.0;
        /// Standard deviation of slipping, as a share of the speed.
        odometry_slip: 0.0, 1.0;
        /// Correlation time of slipping, s.
        slip_time: 0.0, LARGEST;
        /// Standard deviation of the believed place at kick-off, m.
        placing: 0.0, LARGEST;
        /// Standard deviation of the believed heading at kick-off.
        placing_deg: 0.0, LARGEST;
        /// Standard deviation of an opponent's own position, m.
        localisation: 0.0, LARGEST;
        /// Standard deviation of an opponent's own heading.
        localisation_deg: 0.0, LARGEST;
        /// Correlation time of both, s.
        localisation_time: 0.0, LARGEST;
    }
}

/// Home regions of the scripted opponents.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct OpponentParameters {
    /// Home of the defender.
    pub defender: Region,
    /// Home of the midfield defender.
    pub midfield: Region,
    /// Home of the goalie.
    pub goalie: Region,
    /// Clearing the ball.
    pub clear: ClearParameters,
}

/// A rectangle of the field, m: from and to along x and y.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Region {
    /// Smallest and largest x, m.
    pub x: [f32; 2],
    /// Smallest and largest y, m.
    pub y: [f32; 2],
}

impl Noise {
    /// As in the paper's simulator: everything is seen where it is.
    pub const NONE: Self = Self::ZERO;

    /// True for perception without noise.
    pub fn is_none(&self) -> bool {
        *self == Self::NONE
    }
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
        ball.check()?;
        walk.check()?;
        carry.check()?;
        grab.check()?;
        kick.check()?;
        referee.check()?;
        noise.check()?;
        opponent.clear.check()?;
        within("grab.hold_distance", grab.hold_distance, 0.0, grab.reach)?;
        // Beyond this a kick of −limit standard deviations would roll backwards.
        within("kick.distance_sd", kick.distance_sd, 0.0, 1.0 / kick.scatter_limit)?;
        within("noise.marker", noise.marker, POSITIVE, LARGEST)?;
        within("noise.goal", noise.goal, POSITIVE, LARGEST)?;
        within("kick.pass_max", kick.pass_max, kick.pass_min, LARGEST)?;
        let corners = [
            ("opponent.defender", opponent.defender),
            ("opponent.midfield", opponent.midfield),
            ("opponent.goalie", opponent.goalie),
        ];
        for (name, region) in corners {
            for [from, to] in [region.x, region.y] {
                within(name, from, -LARGEST, LARGEST)?;
                within(name, to, from, LARGEST)?;
            }
        }
        Ok(())
    }
}

/// The file, part of the program so that a binary alone can play.
pub const FOUR_LEGGED_TOML: &str = include_str!("../../data/four-legged.toml");

/// Smallest value that the physics divides by.
const POSITIVE: f32 = f32::MIN_POSITIVE;
/// No length, speed or time of this world is larger: a bound against nonsense, in the unit of each number.
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
