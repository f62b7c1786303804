//! `penalty`: number of simulated penalties that a keeper saves. SI, field frame.
//!
//! The keeper is ours, controlled by its host and its brain, through cameras and radio as in a match; the
//! shooter is a body that a script moves, so that its shots do not depend on the keeper: it waits behind the
//! ball for a random time, turns to a random place near a random post, goes up to the ball, and the ball
//! leaves with a random speed. The keeper of the comparison is switched off as soon as it stands on its line.
//! Seeded: the same shots for both.

use geometry::{Angle, Field, GoalEnd, Point, Pose, Vector};
use hil_sim::NativeBackend;
use hil_sim::small_size::Ball;
use host::strategy::Team;
use protocol::{Duration, RobotId, Who};
use rules::limits::{BALL_RADIUS, ROBOT_RADIUS};
use rules::state::RefereeCommand;
use rules::{Colour, League, Phase};

use crate::statistics::Count;
use arena::game::{Game, GameConfig, GameError, NoWatcher};

/// The keeper in the goal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keeper {
    /// Our host and brain.
    Plays,
    /// The same body, left where it stands when the penalty starts.
    Stands,
}

/// One shot, the same for every keeper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PenaltyShot {
    /// From NORMAL_START to the moment at which the ball leaves, s.
    pub after: f64,
    /// Place where it crosses the goal line, m from the goal's middle.
    pub aim: f32,
    /// Speed of the ball when kicked, m/s.
    pub speed: f32,
    /// Duration before the kick in which the shooter goes up to the ball and turns to its aim, s.
    pub run_up: f64,
}

/// Outcome of a shot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PenaltyOutcome {
    /// The whole ball crossed the line between the posts.
    Goal,
    /// The ball did not cross it.
    Saved,
    /// No shot: the referee did not start the penalty, or ended it before.
    NoShot,
}

impl PenaltyShot {
    /// The shot of this seed.
    pub fn of(league: League, seed: u64) -> Self {
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        let mut share = || {
            // xorshift64*: small, and published.
            state ^= state >> 12;
            state ^= state << 25;
            state ^= state >> 27;
            (state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 40) as f32 / 16_777_216.0
        };
        let _warm = (share(), share());
        let inside = INSIDE_POST_MIN_M + share() * INSIDE_POST_SPREAD_M;
        let side = if share() < 0.5 { -1.0 } else { 1.0 };
        Self {
            after: 0.5 + 1.5 * f64::from(share()),
            aim: side * (0.5 * league.field().goal_width - inside),
            speed: SHOT_SPEED_MIN_M_S + share() * (SHOT_SPEED_MAX_M_S - SHOT_SPEED_MIN_M_S),
            run_up: RUN_UP_S[0] + (RUN_UP_S[1] - RUN_UP_S[0]) * f64::from(share()),
        }
    }
}

/// Number of penalties with these seeds that the keeper saves, and number of those that were shot.
pub fn saves(
    league: League,
    seeds: impl IntoIterator<Item = u64>,
    keeper: Keeper,
) -> Result<Count, GameError> {
    let mut count = Count { hits: 0, of: 0 };
    for seed in seeds {
        let outcome = shoot(league, seed, keeper)?;
        count.hits += u32::from(outcome == PenaltyOutcome::Saved);
        count.of += u32::from(outcome != PenaltyOutcome::NoShot);
    }
    Ok(count)
}

/// Plays one penalty, with the shot that `seed` draws.
pub fn shoot(league: League, seed: u64, keeper: Keeper) -> Result<PenaltyOutcome, GameError> {
    let shot = PenaltyShot::of(league, seed);
    let mut config = GameConfig::new(league, seed, MATCH_S).between(Team::Idle, Team::Ours);
    for team in &mut config.teams {
        team.robots = 2;
    }
    config.referee.person_delay = Duration::millis(500);
    // Blue shoots at yellow's goal.
    let own = if config.referee.blue_on_positive_half { GoalEnd::Negative } else { GoalEnd::Positive };
    let mut backend = NativeBackend::new(case_library::division_b());
    let mut game = Game::new(&config, &mut backend)?;
    let ours = Who { colour: Colour::Yellow, id: RobotId::ZERO };
    let shooter = Who { colour: Colour::Blue, id: RobotId::all().nth(1).unwrap_or(RobotId::ZERO) };
    let other = Who { colour: Colour::Blue, id: RobotId::ZERO };
    let field = league.field();
    let (spot, line) = (field.penalty_spot(own), field.goal_line(own));
    let target = Point::<Field>::new(line, shot.aim);
    let behind =
        |distance: f32, face: Angle| Pose { position: spot - Vector::polar(distance, face), heading: face };
    let straight = spot.direction_to(field.goal_center(own));
    let (mut asked, mut begun, mut left) = (false, None, None);
    while game.time() < MATCH_S {
        let phase = game.referee().phase();
        if !asked && game.time() > 1.0 {
            asked = game.command(RefereeCommand::PreparePenalty(Colour::Blue));
        }
        // The script's robots stand at their required places at all times.
        game.put_robot(other, behind(2.0, straight));
        let running = phase == Phase::Penalty(Colour::Blue);
        if running && begun.is_none() {
            begun = Some(game.time());
            if keeper == Keeper::Stands {
                game.power(ours, false, &mut backend)?;
            }
        }
        let until = begun.map_or(f64::INFINITY, |begun| begun + shot.after - game.time());
        if left.is_none() {
            let turn = (1.0 - until / shot.run_up).clamp(0.0, 1.0) as f32;
            let aimed = spot.direction_to(target);
            let face = straight + Angle::new((aimed - straight).radians() * turn);
            game.put_robot(
                shooter,
                behind(SHOOTER_WAITS_M - (SHOOTER_WAITS_M - SHOOTER_AT_BALL_M) * turn, face),
            );
            if until <= 0.0 && running {
                let velocity = (target - game.world().ball.position).unit().unwrap_or_default() * shot.speed;
                game.kick_ball(velocity);
                left = Some(game.time());
            } else if begun.is_some() && !running {
                return Ok(PenaltyOutcome::NoShot);
            }
        }
        if let Some(left) = left {
            let ball: &Ball = &game.world().ball;
            let over = (ball.position.x() - line) * own.sign() as f32 > BALL_RADIUS;
            if over && ball.position.y().abs() < 0.5 * field.goal_width {
                return Ok(PenaltyOutcome::Goal);
            }
            let turned = ball.velocity.x() * (own.sign() as f32) <= 0.0;
            if turned || game.time() - left > FLIGHT_MAX_S {
                return Ok(PenaltyOutcome::Saved);
            }
        }
        game.step(&mut NoWatcher)?;
    }
    Ok(PenaltyOutcome::NoShot)
}

/// Longest penalty, simulated s.
const MATCH_S: f64 = 40.0;
/// Longest flight of a ball, s: 8 m at 4 m/s take 2.6 s.
const FLIGHT_MAX_S: f64 = 4.0;
/// Shots are aimed this far inside a post, m, and up to [`INSIDE_POST_SPREAD_M`] farther.
const INSIDE_POST_MIN_M: f32 = 0.06;
const INSIDE_POST_SPREAD_M: f32 = 0.2;
/// Least and greatest speed of shots, m/s.
const SHOT_SPEED_MIN_M_S: f32 = 4.0;
const SHOT_SPEED_MAX_M_S: f32 = 6.3;
/// Least and greatest time in which the shooter goes up to the ball and turns to its target, s.
const RUN_UP_S: [f64; 2] = [0.1, 0.4];
/// Distance at which the shooter waits, m from centre to centre.
const SHOOTER_WAITS_M: f32 = 0.35;
/// Distance at which it touches the ball, m from centre to centre.
const SHOOTER_AT_BALL_M: f32 = ROBOT_RADIUS + BALL_RADIUS + 0.005;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shots_are_seeded_and_go_near_both_posts() {
        let league = League::DivisionB;
        assert_eq!(PenaltyShot::of(league, 7), PenaltyShot::of(league, 7));
        let shots: Vec<PenaltyShot> = (0..200).map(|seed| PenaltyShot::of(league, seed)).collect();
        let left = shots.iter().filter(|shot| shot.aim > 0.0).count();
        assert!((70..130).contains(&left), "{left}");
        assert!(shots.iter().all(|shot| (0.24..0.45).contains(&shot.aim.abs())));
        assert!(shots.iter().all(|shot| (4.0..=6.3).contains(&shot.speed)));
    }
}
