//! `constants`: constants of pass selection. The constants that the paper names without values, in one table
//! (Biswas et al. 2014 §3.1). SI units.

use geometry::math;
use motion::trajectory::FreeLimits;
use rules::{League, RobotSpec};

/// Parameters of the conditions c1–c5 and c1'–c4' and of the kicks; [`PassConstants::of`] a league.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassConstants {
    /// Width of a condition on times, s: margins of this size are e : 1 likely. The differences between
    /// planned and achieved times of teams have this size (100 ms of latency, docs/papers.md D3).
    pub time_width: f32,
    /// Width of a condition on places, m: a robot's radius and the scatter of a kick over 2 m (D3).
    pub distance_width: f32,
    /// c1, c2: an opponent's limits. No team publishes more than our own robots have.
    pub opponent: FreeLimits,
    /// c1: the receiver's limits.
    pub receiver: FreeLimits,
    /// c2: an opponent detects a kick this late, s: camera, radio and one frame between two (TIGERs take 0 to
    /// 0.08).
    pub reaction: f32,
    /// c2: the share of chips over an opponent that arrive (Fig. 2's grey region; D8).
    pub chip_prior: f32,
    /// c3, t_min: a receiver needs this long to react, s (D8).
    pub shortest_time: f32,
    /// c4, d_max: no pass is accurate beyond, m (D8).
    pub longest: f32,
    /// c5: off a defence area that is forbidden, m (D8; the rules' 0.2 m).
    pub area_margin: f32,
    /// c5: off the lines, m (D8; Thunderbots take 0.3).
    pub line_margin: f32,
    /// c5: off teammates, m (D8; two bodies and a ball between).
    pub teammate_margin: f32,
    /// c5: whether attackers are kept out of the opponents' defence area. Until 2017 they were allowed to
    /// enter (c4' is about that), today a touch of the ball in it is an offence.
    pub their_area_forbidden: bool,
    /// c1', t_g: their keeper needs this long to any point of its goal, s (D12): half a goal of 1 m less body
    /// and ball, at 3.5 m/s² without braking, takes 0.4 s.
    pub keeper_time: f32,
    /// c2', p_gmin: probability of a goal where no angle is open now, as robots move (D12).
    pub closed_prior: f32,
    /// c2', θ_max: a wider open angle gives no further value, rad (10°: D12 and Thunderbots).
    pub open_enough: f32,
    /// c3', p_turn: probability that no opponent blocks while the receiver turns to the goal (D12).
    pub turn_prior: f32,
    /// c3': cosine of the largest angle between the pass and the shot that one touch turns a ball by (60°,
    /// D12).
    pub one_touch_cos: f32,
    /// c4', p_out: probability that no opponent steals the ball outside the opponents' area (D12).
    pub outside_prior: f32,
    /// A shot's speed, m/s: the rules' limit, less a kicker's error of 4 %.
    pub shot_speed: f32,
    /// Fastest pass along the ground, m/s: as shots.
    pub pass_fastest: f32,
    /// Slowest pass, m/s: below, a ball stays at the dribbler opening (D14).
    pub pass_slowest: f32,
    /// A receiver can control a ball that arrives with this speed, m/s (Thunderbots receive at 2 and less; an
    /// estimate).
    pub arrival: f32,
    /// Rise over run of a chip: 45°, as our robots' kickers chip.
    pub chip_slope: f32,
}

impl PassConstants {
    /// For a league's rules; leagues without a referee of the Small Size League play as division B does.
    pub fn of(league: League) -> Self {
        let limit = league.limits().map_or(DIVISION_B_BALL_SPEED, |limits| limits.ball_speed);
        let fastest = limit * KICK_SHARE;
        Self {
            their_area_forbidden: league != League::Ssl2013,
            shot_speed: fastest,
            pass_fastest: fastest,
            ..TODAY
        }
    }
}

/// Constants for division B of 2026.
const TODAY: PassConstants = PassConstants {
    time_width: 0.1,
    distance_width: 0.15,
    opponent: ROBOT,
    receiver: ROBOT,
    reaction: 0.1,
    chip_prior: 0.5,
    shortest_time: 0.3,
    longest: 5.0,
    area_margin: 0.2,
    line_margin: 0.3,
    teammate_margin: 0.5,
    their_area_forbidden: true,
    keeper_time: 0.4,
    closed_prior: 0.1,
    open_enough: 10.0 * (math::PI / 180.0),
    turn_prior: 0.4,
    one_touch_cos: 0.5,
    outside_prior: 0.7,
    shot_speed: DIVISION_B_BALL_SPEED * KICK_SHARE,
    pass_fastest: DIVISION_B_BALL_SPEED * KICK_SHARE,
    pass_slowest: 1.0,
    arrival: 2.0,
    chip_slope: RobotSpec::OURS.kicker.chip_slope,
};
/// Limits assumed of any robot of the league.
const ROBOT: FreeLimits = FreeLimits::of(&RobotSpec::OURS.assumed.pass);
/// m/s (rules 2026, offences).
const DIVISION_B_BALL_SPEED: f32 = 6.5;
/// Share of the limit that is asked of a kicker.
const KICK_SHARE: f32 = RobotSpec::OURS.assumed.kick_share;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attackers_enter_the_area_in_2013_only_and_shots_keep_the_leagues_limit() {
        let paper = PassConstants::of(League::Ssl2013);
        assert!(!paper.their_area_forbidden && (paper.shot_speed - 7.68).abs() < 1e-6);
        let today = PassConstants::of(League::DivisionA);
        assert!(today.their_area_forbidden && (today.shot_speed - 6.24).abs() < 1e-6);
        assert_eq!(PassConstants::of(League::FourLegged), PassConstants::of(League::DivisionB));
    }

    #[test]
    fn every_prior_is_a_probability_and_the_angles_are_those_of_the_reasons() {
        let c = PassConstants::of(League::DivisionB);
        for prior in [c.chip_prior, c.closed_prior, c.turn_prior, c.outside_prior] {
            assert!(prior > 0.0 && prior < 1.0);
        }
        // cos 60° = 1/2, sin 10° = 0.173648.
        assert_eq!(c.one_touch_cos, 0.5);
        assert!((math::sin_cos(c.open_enough).0 - 0.173_648).abs() < 1e-6);
        assert_eq!(c.receiver, FreeLimits::default());
    }
}
