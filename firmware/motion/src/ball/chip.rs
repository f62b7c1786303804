//! `chip`: prediction of a chipped ball. Hops without air, each shorter than the last, then it rolls; m, s,
//! m/s.

use geometry::{Point, Vector, math};

use super::BallModel;
use crate::rolling::RollingBall;
use crate::trajectory::State;

/// Share of its speed that a bounce leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChipModel {
    /// Share of the speed along the ground that the first touch leaves, 0 to 1.
    pub first: f32,
    /// Share that every other touch leaves.
    pub other: f32,
    /// Share of the speed downwards that a touch turns upwards, 0 to below 1.
    pub rise: f32,
}

impl Default for ChipModel {
    /// TIGERs' measured balls: 0.8 at the first touch, 0.85 later, 0.47 upwards.
    fn default() -> Self {
        Self { first: 0.8, other: 0.85, rise: 0.47 }
    }
}

impl ChipModel {
    /// From `BallModelChipFixedLoss` of the league's geometry packets. `None` where the numbers are not
    /// physical.
    pub fn from_wire(damping_xy_first_hop: f64, damping_xy_other_hops: f64, damping_z: f64) -> Option<Self> {
        let model = Self {
            first: damping_xy_first_hop as f32,
            other: damping_xy_other_hops as f32,
            rise: damping_z as f32,
        };
        let share = |x: f32| (0.0..=1.0).contains(&x);
        (share(model.first) && share(model.other) && (0.0..1.0).contains(&model.rise)).then_some(model)
    }

    /// The path of a ball chipped at `at` with `velocity` along the ground and `rise` m/s upwards. After the
    /// last hop it rolls by `ball`.
    pub fn chipped<F: Copy>(
        &self,
        at: Point<F>,
        velocity: Vector<F>,
        rise: f32,
        ball: &BallModel,
    ) -> ChipPath<F> {
        let usable = velocity.is_finite() && rise.is_finite() && at.is_finite();
        let (along, mut speed) = match velocity.unit() {
            Some(along) if usable => (along, velocity.norm()),
            _ => (Vector::new(1.0, 0.0), 0.0),
        };
        let mut rise = if usable { rise.max(0.0) } else { 0.0 };
        let mut path = ChipPath {
            from: if at.is_finite() { at } else { Point::default() },
            along,
            hops: [Hop::default(); HOPS_MAX],
            hop_count: 0,
            roll: RollingBall { deceleration: ball.roll },
            roll_time: 0.0,
            roll_distance: 0.0,
            roll_speed: 0.0,
        };
        let (mut time, mut distance) = (0.0, 0.0);
        for hop in &mut path.hops {
            if rise * rise < 2.0 * GRAVITY * HOP_MIN {
                break;
            }
            *hop = Hop { time, distance, speed, rise };
            time += hop.duration();
            distance += speed * hop.duration();
            speed *= if path.hop_count == 0 { self.first } else { self.other };
            rise *= self.rise;
            path.hop_count += 1;
        }
        (path.roll_time, path.roll_distance, path.roll_speed) = (time, distance, speed);
        path
    }
}

/// The speeds along the ground and upwards that land a ball `distance` m away at its first touch, kicked
/// upwards with this `slope` (rise over run: 1 for 45°), m/s.
pub fn launch(distance: f32, slope: f32) -> (f32, f32) {
    if distance > 0.0 && slope > 0.0 {
        let speed = math::sqrt(0.5 * GRAVITY * distance / slope);
        (speed, speed * slope)
    } else {
        (0.0, 0.0)
    }
}

/// A chipped ball's path until it stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChipPath<F> {
    from: Point<F>,
    along: Vector<F>,
    hops: [Hop; HOPS_MAX],
    hop_count: usize,
    roll: RollingBall,
    roll_time: f32,
    roll_distance: f32,
    roll_speed: f32,
}

#[derive(Clone, Copy, Debug, PartialEq, Default)]
struct Hop {
    /// Start of the hop, s.
    time: f32,
    distance: f32,
    speed: f32,
    rise: f32,
}

impl Hop {
    fn duration(&self) -> f32 {
        2.0 * self.rise / GRAVITY
    }
}

/// A chipped ball at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChipState<F> {
    /// State along the ground.
    pub ground: State<F>,
    /// Height of the ball above its position on the field surface, m.
    pub height: f32,
    /// Vertical velocity, upwards, m/s.
    pub rise: f32,
}

impl<F: Copy> ChipPath<F> {
    fn hops(&self) -> &[Hop] {
        self.hops.get(..self.hop_count).unwrap_or(&[])
    }

    /// Time until it stops, s.
    pub fn duration(&self) -> f32 {
        self.roll_time + self.roll_speed / self.roll.deceleration
    }

    /// Time from which it rolls, s: from then on a robot may stop it.
    pub fn roll_time(&self) -> f32 {
        self.roll_time
    }

    /// Point from which it rolls.
    pub fn roll_point(&self) -> Point<F> {
        self.from + self.along * self.roll_distance
    }

    /// Where the ball stops, after the hops and the roll, m.
    pub fn rest(&self) -> Point<F> {
        self.from + self.along * (self.roll_distance + self.roll.rest_distance(self.roll_speed))
    }

    /// Place, speed and height after `time` seconds.
    pub fn at(&self, time: f32) -> ChipState<F> {
        let t = time.max(0.0);
        let state = |distance: f32, speed: f32, deceleration: f32| State {
            position: self.from + self.along * distance,
            velocity: self.along * speed,
            acceleration: self.along * -deceleration,
        };
        let flying = self.hops().iter().rev().find(|hop| t >= hop.time).filter(|_| t < self.roll_time);
        if let Some(hop) = flying {
            let t = t - hop.time;
            return ChipState {
                ground: state(hop.distance + hop.speed * t, hop.speed, 0.0),
                height: (hop.rise * t - 0.5 * GRAVITY * t * t).max(0.0),
                rise: hop.rise - GRAVITY * t,
            };
        }
        let left = (self.duration() - t).max(0.0);
        let speed = self.roll.deceleration * left;
        let rest = self.roll_distance + self.roll.rest_distance(self.roll_speed);
        let deceleration = if left > 0.0 { self.roll.deceleration } else { 0.0 };
        ChipState { ground: state(rest - 0.5 * speed * left, speed, deceleration), height: 0.0, rise: 0.0 }
    }

    /// When it has gone `distance` m along the ground, s; `None` where it stops before.
    pub fn time_to(&self, distance: f32) -> Option<f32> {
        if distance < 0.0 {
            return None;
        }
        if distance >= self.roll_distance {
            let rolled = self.roll.travel_time(self.roll_speed, distance - self.roll_distance)?;
            return Some(self.roll_time + rolled);
        }
        let hop = self.hops().iter().rev().find(|hop| distance >= hop.distance)?;
        Some(hop.time + (distance - hop.distance) / hop.speed)
    }

    /// Range of distances from the kick in which it flies higher than `height` m in its first hop: a robot of
    /// that height in between does not touch it. `None` where it never does.
    pub fn over(&self, height: f32) -> Option<(f32, f32)> {
        let hop = self.hops().first()?;
        let squared = hop.rise * hop.rise - 2.0 * GRAVITY * height;
        let root = (squared >= 0.0).then(|| math::sqrt(squared))?;
        Some((hop.speed * (hop.rise - root) / GRAVITY, hop.speed * (hop.rise + root) / GRAVITY))
    }
}

/// Acceleration of gravity, m/s².
const GRAVITY: f32 = 9.81;
/// A hop lower than this is rolling, m (TIGERs).
const HOP_MIN: f32 = 0.01;
/// Most hops of a path: a chip of 8 m/s at 45° has 5 on the published ball that bounces most.
const HOPS_MAX: usize = 8;

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::Field;

    fn chipped(model: ChipModel) -> ChipPath<Field> {
        model.chipped(Point::new(1.0, 2.0), Vector::new(3.0, 0.0), 4.0, &BallModel::default())
    }

    #[test]
    fn a_chip_of_four_metres_per_second_upwards_by_hand() {
        let path = chipped(ChipModel::default());
        // Up for 4/9.81 s; 16/19.62 m high; lands after 3 · 8/9.81 m.
        let top = path.at(4.0 / 9.81);
        assert!((top.height - 0.815_49).abs() < 1e-4 && top.rise.abs() < 1e-5);
        let landed = 8.0 / 9.81;
        assert!((path.at(landed - 1e-4).ground.position.x() - (1.0 + 3.0 * landed)).abs() < 1e-3);
        let second = path.at(landed + 0.01);
        assert!((second.ground.velocity.x() - 2.4).abs() < 1e-6);
        assert!((second.rise - (1.88 - 0.0981)).abs() < 1e-3);
        // Rises of 4, 1.88, 0.8836 m/s hop (0.8836²/19.62 = 40 mm), 0.415 does not (8.8 mm).
        assert_eq!(path.hop_count, 3);
        assert!((path.roll_speed - 3.0 * 0.8 * 0.85 * 0.85).abs() < 1e-5);
    }

    #[test]
    fn it_moves_as_small_steps_do() {
        let model = ChipModel { first: 0.715, other: 1.0, rise: 0.566 };
        let path = chipped(model);
        let (mut x, mut v, mut h, mut rise, mut touches) = (1.0_f64, 3.0_f64, 0.0_f64, 4.0_f64, 0);
        let (dt, mut t) = (1e-5, 0.0_f64);
        let mut worst = 0.0_f64;
        while v > 0.0 {
            if rise != 0.0 || h > 0.0 {
                rise -= 9.81 * dt;
                h += rise * dt;
                if h <= 0.0 && rise < 0.0 {
                    v *= f64::from(if touches == 0 { model.first } else { model.other });
                    (h, rise, touches) = (0.0, -rise * f64::from(model.rise), touches + 1);
                    if rise * rise < 2.0 * 9.81 * 0.01 {
                        rise = 0.0;
                    }
                }
            } else {
                v -= 0.35 * dt;
            }
            x += v * dt;
            t += dt;
            let state = path.at(t as f32);
            worst = worst.max((f64::from(state.ground.position.x()) - x).abs());
            worst = worst.max((f64::from(state.height) - h).abs());
        }
        assert!(worst < 2e-3, "{worst} m apart");
        assert!(
            (f64::from(path.rest().x()) - x).abs() < 2e-3 && (f64::from(path.duration()) - t).abs() < 1e-2
        );
    }

    #[test]
    fn the_time_to_a_distance_is_the_inverse_of_the_way() {
        let path = chipped(ChipModel::default());
        for distance in [0.0, 0.5, 2.0, 2.446, 3.0, 4.0, 6.0] {
            let time = path.time_to(distance).unwrap();
            assert!((path.at(time).ground.position.x() - 1.0 - distance).abs() < 2e-3, "{distance}");
        }
        assert_eq!(path.time_to(100.0), None);
    }

    #[test]
    fn it_flies_over_a_robot_that_stands_under_its_arch() {
        let (up, down) = launch(2.0, 1.0);
        let path = ChipModel::default().chipped(
            Point::<Field>::new(0.0, 0.0),
            Vector::new(up, 0.0),
            down,
            &BallModel::default(),
        );
        let (from, to) = path.over(0.15).unwrap();
        for (x, over) in [(from - 0.02, false), (from + 0.02, true), (to - 0.02, true), (to + 0.02, false)] {
            assert_eq!(path.at(path.time_to(x).unwrap()).height > 0.15, over, "{x}");
        }
        // It lands where it was aimed at.
        assert!((path.hops[1].distance - 2.0).abs() < 1e-4);
        assert_eq!(path.over(1.0), None);
    }

    #[test]
    fn nonsense_rests_or_rolls_and_never_hops_for_ever() {
        let ball = BallModel::default();
        let at = Point::<Field>::new(0.0, 0.0);
        assert_eq!(ChipModel::from_wire(0.8, 0.85, 1.0), None);
        assert_eq!(ChipModel::from_wire(f64::NAN, 0.85, 0.5), None);
        assert!(ChipModel::from_wire(0.715, 1.0, 0.566).is_some());
        let endless = ChipModel { first: 1.0, other: 1.0, rise: 1.0 };
        assert_eq!(endless.chipped(at, Vector::new(1.0, 0.0), 5.0, &ball).hop_count, HOPS_MAX);
        let path = ChipModel::default().chipped(at, Vector::new(1.0, 0.0), f32::NAN, &ball);
        assert_eq!((path.duration(), path.rest()), (0.0, at));
        let flat = ChipModel::default().chipped(at, Vector::new(1.0, 0.0), 0.0, &ball);
        assert!((flat.rest().x() - 1.0 / 0.7).abs() < 1e-4);
    }
}
