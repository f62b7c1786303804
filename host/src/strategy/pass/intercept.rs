//! `intercept`: interception of a pass by an opponent. The least margin over all opponents and all places of
//! the path, for c2 (Biswas et al. 2014 §3.1, Fig. 2). Attack frame, SI units.
//!
//! An opponent's margin at a place is its time to touch a ball there, less the ball's time to it. Along the
//! path the margin first falls (the opponent nears its best place faster than the ball comes) and then rises;
//! the turning point is estimated from both speeds there, and margins are taken at it, at the nearest place
//! and at the end. A test compares this with a search through every centimetre.

use geometry::{Attack, Point, Vector, math};
use protocol::RobotId;

use super::kicks::{ChipKick, FlatKick};
use super::reach::Mover;

/// Largest margin returned, s: at a width of 0.1 s it is a certain pass (1 − exp(−6) = 0.998), below its
/// negative a lost one.
pub const SAFE: f32 = 0.6;
/// From this distance on the whole reaction counts, m: the scatter over 5 m of a kick of 0.5° to 1°; nearer,
/// a body is likely hit without moving.
const REACTION_FADES_M: f32 = 0.1;
/// 2 √(0.1 m / 3.5 m/s²), s.
const REACTION_TIME_S: f32 = 0.338;
/// At a restart no opponent touches a ball nearer to its place than this, m, without a start: the rules' 0.5
/// m and its body, less what it reaches.
const KEPT_OFF_M: f32 = 0.48;
/// Places nearer to each other than this count as equal, m.
const SAME_PLACE_WITHIN_M: f32 = 0.02;

/// An opponent that may intercept the ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassOpponent {
    /// The opponent's number in its team.
    pub id: RobotId,
    /// Motion and limits of the opponent.
    pub mover: Mover,
    /// Time for which it moves before the kick, s.
    pub head_start: f32,
}

/// The opponent with the least margin, and its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interceptor {
    /// The opponent's number in its team.
    pub id: RobotId,
    /// Time of the opponent there less the ball's, s.
    pub margin: f32,
    /// Distance along the path, m.
    pub along: f32,
}

/// The path of a pass.
#[derive(Clone, Copy, Debug)]
pub struct BallPath {
    /// Place of the ball at the kick.
    pub from: Point<Attack>,
    /// Direction of the pass, of length 1.
    pub along: Vector<Attack>,
    /// Length up to where it is received, m.
    pub length: f32,
    /// A body touches a ball that passes this near its centre, m.
    pub body: f32,
    /// Delay until an opponent detects the kick, s.
    pub reaction: f32,
    /// The end of the path that the receiver's body covers, m.
    pub covered: f32,
}

impl BallPath {
    /// The opponent with the least margin along a flat pass, if it is below [`SAFE`]; the first one below
    /// −[`SAFE`], which certainly has the ball.
    pub fn flat(&self, kick: &FlatKick, opponents: &[PassOpponent]) -> Option<Interceptor> {
        self.flat_until(kick, opponents, kick.at(self.length), -SAFE)
    }

    /// The same for a ball that is at the path's `end` at this time and speed, s and m/s; or the first one
    /// below `enough`: the caller needs no smaller one.
    pub fn flat_until(
        &self,
        kick: &FlatKick,
        opponents: &[PassOpponent],
        end: (f32, f32),
        enough: f32,
    ) -> Option<Interceptor> {
        self.worst(opponents, end.0, enough, |opponent, worst| {
            let length = self.open_to(opponent);
            let end = if length < self.length { kick.at(length) } else { end };
            self.stretch(opponent, (0.0, length), end, |s| kick.at(s), worst);
        })
    }

    /// The same along a chip: while it rises over a robot's height, and from where it comes down below it.
    pub fn chip(&self, kick: &ChipKick, opponents: &[PassOpponent]) -> Option<Interceptor> {
        let end = kick.at(self.length);
        let (up, down) = kick.over;
        self.worst(opponents, end.0, -SAFE, |opponent, worst| {
            let length = self.open_to(opponent);
            let end = if length < self.length { kick.at(length) } else { end };
            self.stretch(opponent, (0.0, up), kick.at(up), |s| kick.at(s), worst);
            self.stretch(opponent, (down, length), end, |s| kick.at(s), worst);
        })
    }

    fn worst(
        &self,
        opponents: &[PassOpponent],
        arrival: f32,
        enough: f32,
        look: impl Fn(&PassOpponent, &mut Interceptor),
    ) -> Option<Interceptor> {
        let mut worst = Interceptor { id: RobotId::ZERO, margin: SAFE, along: 0.0 };
        for opponent in opponents {
            // An opponent that cannot be at the path by the ball's arrival plus the margin to beat is no
            // worse than the known one.
            let (foot, across) = self.seen(opponent);
            let beyond = (foot - self.length).max(-foot).max(0.0);
            let reach =
                opponent.mover.farthest_touched(arrival + worst.margin - self.reaction + opponent.head_start)
                    + self.body
                    + REACTION_FADES_M;
            if beyond * beyond + across * across <= reach * reach {
                look(opponent, &mut worst);
            }
            if worst.margin < enough {
                break;
            }
        }
        (worst.margin < SAFE).then_some(worst)
    }

    /// The part of the path on which the opponent may have the ball before the receiver, m.
    fn open_to(&self, opponent: &PassOpponent) -> f32 {
        if opponent.head_start > 0.0 { self.length } else { (self.length - self.covered).max(0.0) }
    }

    /// The opponent's position along the path, and beside it, m.
    #[inline]
    fn seen(&self, opponent: &PassOpponent) -> (f32, f32) {
        let off = opponent.mover.position - self.from;
        (off.dot(self.along), self.along.cross(off))
    }

    /// Takes the margins on a section of the path, whose end the ball reaches at `end` (s, m/s).
    #[inline]
    fn stretch(
        &self,
        opponent: &PassOpponent,
        (low, high): (f32, f32),
        end: (f32, f32),
        ball: impl Fn(f32) -> (f32, f32),
        worst: &mut Interceptor,
    ) {
        if high < low {
            return;
        }
        let (foot, across) = self.seen(opponent);
        let nearest = foot.max(low).min(high);
        let (time, speed) = ball(nearest);
        let touched = self.look(opponent, nearest, time, worst);
        // The opponent is nowhere sooner than at the nearest place, the ball nowhere later than at the end.
        if nearest >= high
            || (touched - end.0 >= worst.margin && opponent.mover.velocity == Vector::default())
        {
            return;
        }
        self.look(opponent, high, end.0, worst);
        // dD/ds = w / u at the turning point, D the distance to the place: s − foot = across · q / √(1 − q²),
        // q = w / u; and half the distance that the opponent's speed carries it along the ball's path in the
        // meantime.
        let pace = opponent.mover.pace(across.abs() - self.body);
        let q = pace / speed.max(1e-3);
        let drift = 0.5 * opponent.mover.velocity.dot(self.along) * touched;
        if q < 1.0 {
            let turning = foot + drift + across.abs() * q / math::sqrt(1.0 - q * q);
            if turning > low && turning < high && (turning - nearest).abs() > SAME_PLACE_WITHIN_M {
                self.look(opponent, turning, ball(turning).0, worst);
            }
        }
    }

    #[inline]
    fn look(&self, opponent: &PassOpponent, along: f32, ball_time: f32, worst: &mut Interceptor) -> f32 {
        let place = self.from + self.along * along;
        let mut time = touch_time(&opponent.mover, place, self.body, self.reaction);
        if opponent.head_start > 0.0 {
            // Until the kick it keeps the distance that the rules ask for.
            time = (time - opponent.head_start).max(opponent.mover.time_from_rest(KEPT_OFF_M - along));
        }
        if time - ball_time < worst.margin {
            *worst = Interceptor { id: opponent.id, margin: time - ball_time, along };
        }
        time
    }
}

/// When a robot touches a ball that passes `place`, s, by a `body` this wide and after this `reaction`. No
/// reaction is needed for a ball that comes to it; that gain fades out with the distance it has to drive.
#[inline]
pub fn touch_time(mover: &Mover, place: Point<Attack>, body: f32, reaction: f32) -> f32 {
    let time = mover.time_to_touch(place, body);
    // Time and distance are proportional here; 0.24 s are 0.1 m from standstill.
    time + reaction * (time * (1.0 / REACTION_TIME_S)).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use motion::trajectory::FreeLimits;
    use rand_core::{RngCore, SeedableRng};
    use rand_xoshiro::Xoshiro128PlusPlus;
    use rules::League;

    use super::super::kicks::Kicks;

    fn opponent(id: u8, at: (f32, f32), velocity: (f32, f32)) -> PassOpponent {
        let (at, velocity) = (Point::new(at.0, at.1), Vector::new(velocity.0, velocity.1));
        let mover = Mover::new(at, velocity, &FreeLimits::default());
        PassOpponent { id: RobotId::new(id).unwrap(), mover, head_start: 0.0 }
    }

    fn path(length: f32) -> BallPath {
        let (from, along) = (Point::new(0.0, 0.0), Vector::new(1.0, 0.0));
        BallPath { from, along, length, body: 0.1115, reaction: 0.1, covered: 0.0 }
    }

    fn kicks() -> Kicks {
        Kicks::of(League::DivisionB)
    }

    #[test]
    fn a_body_on_the_path_has_the_ball_and_one_far_off_never() {
        let kick = kicks().flat(3.0);
        let on_it = path(3.0).flat(&kick, &[opponent(4, (1.5, 0.05), (0.0, 0.0))]).unwrap();
        // It covers every place up to 1.5 + √(0.1115² − 0.05²); the end it has to drive to.
        assert!(on_it.id.number() == 4 && on_it.margin < -0.4, "{on_it:?}");
        assert_eq!(path(3.0).flat(&kick, &[opponent(4, (1.5, 4.0), (0.0, 0.0))]), None);
    }

    #[test]
    fn the_margin_beside_the_path_by_hand() {
        // 3 m with 3.317774 m/s take 1.299743 s (see `kicks`). At (2.4, 0.6115) a body is √(0.6² + 0.6115²) −
        // 0.1115 = 0.745192 m from touching a ball at the end: 2 √(0.745192 / 3.5) + 0.1 = 1.022853 s, which
        // is 0.276890 s sooner than the ball.
        let kick = kicks().flat(3.0);
        let found = path(3.0).flat(&kick, &[opponent(2, (2.4, 0.6115), (0.0, 0.0))]).unwrap();
        assert!((found.margin + 0.276_890).abs() < 1e-4 && found.along == 3.0, "{found:?}");
    }

    #[test]
    fn a_chip_passes_over_whom_a_flat_pass_would_meet() {
        let kicks = kicks();
        let chip = kicks.chip(3.0).unwrap();
        let under_the_arch = [opponent(1, (1.0, 0.0), (0.0, 0.0))];
        let over = path(3.0).chip(&chip, &under_the_arch).map_or(SAFE, |found| found.margin);
        let flat = path(3.0).flat(&kicks.flat(3.0), &under_the_arch).unwrap().margin;
        assert!(over > 0.0 && flat < -0.1, "{over} {flat}");
        // Where it comes down it is stopped.
        let where_it_lands = [opponent(1, (chip.lands + 0.2, 0.0), (0.0, 0.0))];
        assert!(path(3.0).chip(&chip, &where_it_lands).unwrap().margin < -0.5);
    }

    #[test]
    fn the_margin_is_that_of_the_search_through_every_centimetre() {
        let kicks = kicks();
        let mut rng = Xoshiro128PlusPlus::seed_from_u64(6);
        let mut within = |range: f32| ((rng.next_u32() >> 8) as f32 / 8_388_608.0 - 1.0) * range;
        let (mut counted, mut far, mut sum, mut worst) = (0, 0, 0.0_f32, 0.0_f32);
        for round in 0..2_000 {
            let length = 2.6 + within(2.0);
            let path = path(length);
            let speed = if round % 2 == 0 { 0.0 } else { 1.5 };
            let opponents: Vec<_> = (0..4)
                .map(|i| {
                    let at = (length * 0.5 + within(length), within(2.5));
                    opponent(i, at, (within(1.0) * speed, within(1.0) * speed))
                })
                .collect();
            for chip in [None, kicks.chip(length)] {
                let flat = kicks.flat(length);
                let (found, touchable): (_, Box<dyn Fn(f32) -> Option<f32>>) = match chip {
                    None => (path.flat(&flat, &opponents), Box::new(|s| Some(flat.at(s).0))),
                    Some(chip) => (
                        path.chip(&chip, &opponents),
                        Box::new(move |s| (s < chip.over.0 || s > chip.over.1).then(|| chip.at(s).0)),
                    ),
                };
                let mut truth = SAFE;
                for step in 0..=(length * 100.0) as u32 {
                    let s = (step as f32 * 0.01).min(length);
                    let Some(ball) = touchable(s) else { continue };
                    for opponent in &opponents {
                        let place = Point::new(s, 0.0);
                        truth =
                            truth.min(touch_time(&opponent.mover, place, path.body, path.reaction) - ball);
                    }
                }
                let found = found.map_or(SAFE, |found| found.margin).max(-SAFE);
                let truth = truth.max(-SAFE);
                // Margins that matter are below three widths.
                if truth < 0.3 {
                    let off = found - truth;
                    far += u32::from(off.abs() > 0.1);
                    (counted, sum, worst) = (counted + 1, sum + off.abs(), worst.max(off.abs()));
                }
            }
        }
        let mean = sum / counted as f32;
        // The few that are off stand within half a metre and move across the path, or away from it.
        assert!(counted > 1_000 && mean < 0.01 && worst < 0.4, "{counted}: {mean} {worst}");
        assert!(far * 100 < counted, "{far} of {counted} are off by more than a width");
    }
}
