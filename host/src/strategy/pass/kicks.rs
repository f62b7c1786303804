//! `kicks`: kick speed and ball times of a pass. Flat kicks in closed form, chips from a table that is
//! computed once for a field surface. SI units.
//!
//! A flat pass is as fast as the receiver can still control at its end (T_b is the least over the kicks
//! allowed, Algorithm 1); a chip starts to roll just where it is received.

use geometry::{Attack, Point, Vector, math};
use motion::ball::BallModel;
use motion::ball::chip::{ChipModel, launch};
use protocol::host::KickOrder;
use rules::League;

use super::constants::PassConstants;

/// Time of a ball that never arrives, s.
pub const NEVER_S: f32 = 1e3;
/// Chips in the table, and the distance between two of them, m: up to 7.3 m; a chip of 6.2 m/s rolls from 6
/// m.
const CHIPS: usize = 64;
const CHIP_STEP_M: f32 = 0.1;
/// Shortest chip, m: its first hop of 0.65 m is 0.16 m high, just over a robot.
const CHIP_LENGTH_MIN_M: f32 = 1.0;
/// First estimate of the share of a chip's distance up to the first touch: 1 / (1 + 0.8 · 0.47 + 0.68 · 0.22)
/// of TIGERs' balls.
const FIRST_HOP_SHARE: f32 = 0.65;
/// The ratio changes only where a hop becomes too low to count; it is constant after one round between such
/// places.
const ROUNDS: u32 = 6;

/// A kick of a pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PassKick {
    /// A kick along the ground.
    Flat {
        /// Speed at the kick, m/s.
        speed: f32,
    },
    /// A kick through the air.
    Chip {
        /// Speed at the kick in three dimensions, m/s.
        speed: f32,
        /// Distance to its first touch-down, m.
        lands: f32,
    },
}

impl PassKick {
    /// The kick as an order of the protocol.
    pub fn order(self) -> KickOrder {
        match self {
            Self::Flat { speed } => KickOrder::Flat((speed * 100.0) as u16),
            Self::Chip { speed, .. } => KickOrder::Chip((speed * 100.0) as u16),
        }
    }

    /// Speed at the kick, m/s.
    pub fn speed(self) -> f32 {
        match self {
            Self::Flat { speed } | Self::Chip { speed, .. } => speed,
        }
    }

    /// Whether it leaves the ground.
    pub fn is_chip(self) -> bool {
        matches!(self, Self::Chip { .. })
    }
}

/// A ball on the ground, kicked with some speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatKick {
    /// Speed at the kick, m/s.
    pub speed: f32,
    slide: f32,
    roll: f32,
    /// Distance, time and speed at which it starts to roll.
    slide_distance: f32,
    slide_time: f32,
    roll_speed: f32,
}

impl FlatKick {
    /// A kick with `speed`, m/s.
    #[inline]
    pub fn new(speed: f32, ball: &BallModel) -> Self {
        let roll_speed = speed * ball.switch;
        let per_slide = 1.0 / ball.slide;
        Self {
            speed,
            slide: ball.slide,
            roll: ball.roll,
            slide_distance: 0.5 * (speed * speed - roll_speed * roll_speed) * per_slide,
            slide_time: (speed - roll_speed) * per_slide,
            roll_speed,
        }
    }

    /// Time at which it is `distance` m off, s, and its speed there, m/s; where it stops before, a long time
    /// and 0.
    #[inline]
    pub fn at(&self, distance: f32) -> (f32, f32) {
        let (start, ball_path, deceleration, before) = if distance <= self.slide_distance {
            (self.speed, distance, self.slide, 0.0)
        } else {
            (self.roll_speed, distance - self.slide_distance, self.roll, self.slide_time)
        };
        let squared = start * start - 2.0 * deceleration * ball_path;
        if squared < 0.0 {
            return (NEVER_S, 0.0);
        }
        let speed = math::sqrt(squared);
        // (start − speed) / deceleration, without cancellation.
        (before + 2.0 * ball_path / (start + speed).max(1e-6), speed)
    }
}

/// A chip that starts to roll at some distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChipKick {
    /// Speed at the kick in three dimensions, m/s.
    pub speed: f32,
    /// Along the ground until it first comes down, m/s.
    pub along: f32,
    /// Distance at which it first comes down, m, and time, s.
    pub lands: f32,
    /// Time of the first touch-down, s.
    pub lands_at: f32,
    /// Between these distances it flies over robots, m.
    pub over: (f32, f32),
    /// Time at which it rolls, s, …
    pub rolls_at: f32,
    /// Distance from which it rolls and is received, m.
    pub rolls: f32,
}

impl ChipKick {
    /// Time at which it is `distance` m off, s, and its speed there, m/s: between touches at the mean speed
    /// of all hops after the first.
    #[inline]
    pub fn at(&self, distance: f32) -> (f32, f32) {
        if distance <= self.lands || self.rolls <= self.lands {
            return (distance / self.along, self.along);
        }
        let speed = (self.rolls - self.lands) / (self.rolls_at - self.lands_at);
        (self.lands_at + (distance - self.lands) / speed, speed)
    }
}

/// The kicks of a team on a field surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Kicks {
    constants: PassConstants,
    ground: BallModel,
    chip: ChipModel,
    /// Chips by the distance where they roll, [`CHIP_STEP_M`] apart from [`CHIP_LENGTH_MIN_M`] on.
    chips: heapless::Vec<ChipKick, CHIPS>,
}

impl Kicks {
    /// A league's kicks, with the default models of balls.
    pub fn of(league: League) -> Self {
        Self::new(PassConstants::of(league), BallModel::default(), ChipModel::default())
    }

    /// Computed once for a league and a field surface.
    pub fn new(constants: PassConstants, ground: BallModel, chip: ChipModel) -> Self {
        let mut kicks = Self { constants, ground, chip, chips: heapless::Vec::new() };
        for i in 0..CHIPS {
            let rolls = CHIP_LENGTH_MIN_M + i as f32 * CHIP_STEP_M;
            let Some(kick) = chip_that_rolls(rolls, &constants, &ground, &chip) else { break };
            if kick.speed > constants.pass_fastest || kicks.chips.push(kick).is_err() {
                break;
            }
        }
        kicks
    }

    /// The constants they are computed with.
    pub fn constants(&self) -> &PassConstants {
        &self.constants
    }

    /// Model of rolling balls on this field surface.
    pub fn ground(&self) -> &BallModel {
        &self.ground
    }

    /// Model of chipped balls on this field surface.
    pub fn chips_as(&self) -> &ChipModel {
        &self.chip
    }

    /// The fastest flat kick over `distance` m that the receiver can control.
    #[inline]
    pub fn flat(&self, distance: f32) -> FlatKick {
        let c = &self.constants;
        let speed = self.ground.kick_speed(distance, c.arrival);
        FlatKick::new(speed.max(c.pass_slowest).min(c.pass_fastest), &self.ground)
    }

    /// A shot at the goal.
    #[inline]
    pub fn shot(&self) -> FlatKick {
        FlatKick::new(self.constants.shot_speed, &self.ground)
    }

    /// The chip that rolls from `distance` m off, between two of the table; `None` where it is too near or
    /// too far.
    #[inline]
    pub fn chip(&self, distance: f32) -> Option<ChipKick> {
        let place = (distance - CHIP_LENGTH_MIN_M) * (1.0 / CHIP_STEP_M);
        if place < 0.0 {
            return None;
        }
        let (low, high) = (self.chips.get(place as usize)?, self.chips.get(place as usize + 1)?);
        let share = place - (place as usize) as f32;
        let mix = |low: f32, high: f32| low + (high - low) * share;
        Some(ChipKick {
            speed: mix(low.speed, high.speed),
            along: mix(low.along, high.along),
            lands: mix(low.lands, high.lands),
            lands_at: mix(low.lands_at, high.lands_at),
            over: (mix(low.over.0, high.over.0), mix(low.over.1, high.over.1)),
            rolls_at: mix(low.rolls_at, high.rolls_at),
            rolls: distance,
        })
    }
}

/// The chip that starts to roll `rolls` m off: all its hops grow with the first one, except those too low to
/// count.
fn chip_that_rolls(
    rolls: f32,
    constants: &PassConstants,
    ground: &BallModel,
    model: &ChipModel,
) -> Option<ChipKick> {
    let mut lands = rolls * FIRST_HOP_SHARE;
    let mut found = None;
    for _ in 0..ROUNDS {
        let (along, rise) = launch(lands, constants.chip_slope);
        let from = Point::<Attack>::new(0.0, 0.0);
        let path = model.chipped(from, Vector::new(along, 0.0), rise, ground);
        let (reached, rolls_at) = (path.roll_point().x(), path.roll_time());
        let lands_at = lands / along;
        found = path.over(rules::limits::ROBOT_HEIGHT).filter(|_| reached > 0.0).map(|over| ChipKick {
            speed: math::hypot(along, rise),
            along,
            lands,
            lands_at,
            over,
            rolls_at,
            rolls,
        });
        lands *= rolls / reached.max(1e-3);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use motion::trajectory::Motion;

    fn kicks() -> Kicks {
        Kicks::of(League::DivisionB)
    }

    #[test]
    fn a_pass_over_three_metres_leaves_with_the_speed_that_arrives_with_two_by_hand() {
        // v² = (4 + 2 · 0.35 · 3) / (0.510204 + 0.489796 · 0.35/3.9) = 6.1 / 0.554160: 3.317774 m/s. It
        // slides (1 − 5/7) v / 3.9 = 0.243060 s over 0.489796 v² / 7.8 = 0.691216 m, then rolls from 2.369839
        // to 2: 0.369839 / 0.35 = 1.056683 s more.
        let kick = kicks().flat(3.0);
        assert!((kick.speed - 3.317_774).abs() < 1e-4, "{kick:?}");
        let (time, speed) = kick.at(3.0);
        assert!((time - 1.299_743).abs() < 1e-4 && (speed - 2.0).abs() < 1e-4, "{time} {speed}");
    }

    #[test]
    fn flat_balls_are_where_the_ball_model_has_them() {
        let model = BallModel::default();
        for speed in [1.0, 2.5, 6.0] {
            let path = model.kicked(Point::<Attack>::new(0.0, 0.0), Vector::new(speed, 0.0));
            let kick = FlatKick::new(speed, &model);
            for step in 0..40 {
                let distance = step as f32 * 0.15;
                let (time, now) = kick.at(distance);
                match path.time_to(distance) {
                    Some(truth) => {
                        assert!((time - truth).abs() < 1e-3, "{speed} {distance}");
                        assert!((path.at(truth).velocity.x() - now).abs() < 2e-3, "{speed} {distance}");
                    }
                    None => assert_eq!((time, now), (NEVER_S, 0.0)),
                }
            }
        }
    }

    #[test]
    fn a_chip_rolls_where_it_is_received_and_flies_as_its_model_does() {
        let (kicks, chip, ground) = (kicks(), ChipModel::default(), BallModel::default());
        for distance in [1.05, 1.5, 2.55, 4.0, 5.0] {
            let kick = kicks.chip(distance).unwrap();
            let (along, rise) = launch(kick.lands, 1.0);
            let path = chip.chipped(Point::<Attack>::new(0.0, 0.0), Vector::new(along, 0.0), rise, &ground);
            assert!((path.roll_point().x() - distance).abs() < 0.05 * distance, "{distance} {path:?}");
            assert!((path.roll_time() - kick.rolls_at).abs() < 0.05, "{distance}");
            for share in [0.1, 0.3, 0.6, 0.8, 0.95] {
                let off = kick.at(share * distance).0 - path.time_to(share * distance).unwrap();
                assert!(off.abs() < 0.06, "{distance} {share}: {off} s");
            }
            let (from, to) = path.over(0.15).unwrap();
            assert!((kick.over.0 - from).abs() < 0.02 && (kick.over.1 - to).abs() < 0.02);
        }
        assert_eq!(kicks.chip(0.9), None);
        assert_eq!(kicks.chip(8.0), None);
    }

    #[test]
    fn the_longest_chip_is_one_that_the_rules_allow() {
        let kicks = kicks();
        let longest = kicks.chips.last().unwrap();
        assert!(longest.speed <= kicks.constants().pass_fastest && longest.rolls > 4.0, "{longest:?}");
        assert_eq!(
            PassKick::Chip { speed: longest.speed, lands: longest.lands }.order(),
            KickOrder::Chip((longest.speed * 100.0) as u16)
        );
    }
}
