//! `latency`: estimate of each robot's latency. The onset is taken from when it has moved by 10 mm and by 90
//! mm: at any constant acceleration the second takes three times as long as the first, which gives
//! t₀ = (3 t₁ − t₂) / 2. m, s.
//!
//! Times of places are those of the camera frames, so that the result excludes vision's own delay; it
//! includes radio, brain and motors.

use geometry::{Field, Point};
use protocol::host::{Directive, HostCommand};
use protocol::{Duration, Instant, RobotId, Who};
use rules::{Colour, Phase, Side};

use super::samples::{Estimate, Samples};
use crate::world::World;

/// Samples kept for each robot.
const STARTS_KEPT: usize = 15;
/// Number of starts needed.
const STARTS_MIN: usize = 3;
/// A robot whose place stays within this stands still, m: noise of 3 mm.
const STILL_WITHIN_M: f32 = 0.008;
/// Time for which it must stay there to stand still.
const STILL_FOR: Duration = Duration::millis(300);
/// Least distance of the place ordered at which it starts with its full acceleration, m.
const ORDER_DISTANCE_MIN_M: f32 = 0.4;
/// The distances moved from which the onset is computed, m: above the noise, and nine times that.
const MOVED_FIRST_M: f32 = 0.010;
const MOVED_LAST_M: f32 = 0.090;
/// Range of plausible latencies from order to motion, s; a clearly negative one is an error of the clocks.
const ONSET_MIN_S: f32 = -0.03;
const ONSET_MAX_S: f32 = 0.3;
/// A robot that has not moved 90 mm by then is obstructed, s after the order.
const WAITED_MAX_S: f32 = 0.8;

/// Estimates of all robots' latencies.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Latencies {
    robots: [Robot; RobotId::COUNT],
}

#[derive(Clone, Copy, Debug, Default)]
struct Robot {
    samples: Samples<STARTS_KEPT>,
    /// Stop position, and since when it stands there.
    rests: Option<(Point<Field>, Instant)>,
    /// Whether its last order was not to go anywhere.
    was_idle: bool,
    start: Option<Start>,
}

/// A robot that stood still and has been ordered to move.
#[derive(Clone, Copy, Debug)]
struct Start {
    ordered: Instant,
    from: Point<Field>,
    /// Newest place: distance moved, and time, s after the order.
    newest: (f32, f32),
    /// When it had moved by [`MOVED_FIRST_M`].
    near: Option<f32>,
}

impl Latencies {
    pub(super) fn see(
        &mut self,
        now: Instant,
        world: &World,
        us: Colour,
        phase: Phase<Side>,
        commands: &[HostCommand],
    ) {
        let may_go = !matches!(phase, Phase::Halt | Phase::Timeout(_));
        for id in RobotId::all() {
            let robot = &mut self.robots[id.index()];
            let Some(seen) = world.robot(Who { colour: us, id }) else {
                (robot.rests, robot.start) = (None, None);
                continue;
            };
            let place = seen.pose.position;
            robot.follow(world.time, place);
            let to = commands.iter().find(|command| command.to == id).and_then(|command| {
                match command.directive {
                    Directive::GoTo { pose } if may_go => Some(geometry::Pose::<Field>::from(pose).position),
                    _ => None,
                }
            });
            robot.order(now, world.time, place, to);
        }
    }

    pub(super) fn latency(&self, robot: RobotId) -> Option<Estimate> {
        self.robots[robot.index()].samples.estimate(STARTS_MIN)
    }
}

impl Robot {
    /// Takes the robot's place at that time.
    fn follow(&mut self, at: Instant, place: Point<Field>) {
        if let Some(mut start) = self.start.take() {
            let (travelled, t) = (start.from.distance(place), signed(start.ordered, at));
            let crossing = |mark: f32| {
                let ((w0, t0), (w1, t1)) = (start.newest, (travelled, t));
                (w0 < mark && w1 >= mark).then(|| t0 + (t1 - t0) * (mark - w0) / (w1 - w0))
            };
            start.near = start.near.or(crossing(MOVED_FIRST_M));
            let far = crossing(MOVED_LAST_M);
            start.newest = (travelled, t);
            if let (Some(near), Some(far)) = (start.near, far) {
                let onset = 0.5 * (3.0 * near - far);
                if (ONSET_MIN_S..=ONSET_MAX_S).contains(&onset) {
                    self.samples.add(onset.max(0.0));
                }
            } else if t < WAITED_MAX_S {
                self.start = Some(start);
            }
        }
        self.rests = match self.rests {
            Some((rest, since)) if rest.distance(place) < STILL_WITHIN_M => Some((rest, since)),
            _ => Some((place, at)),
        };
    }

    /// Takes the robot's order to a place, or to none.
    fn order(&mut self, now: Instant, at: Instant, place: Point<Field>, to: Option<Point<Field>>) {
        let goes = to.is_some_and(|to| to.distance(place) > ORDER_DISTANCE_MIN_M);
        let Some((from, since)) = self.rests else { return };
        match (goes, self.start) {
            // It has stood still without an order to move for long enough, and now has one.
            (true, None) if self.was_idle && at.since(since) >= STILL_FOR => {
                self.start = Some(Start { ordered: now, from, newest: (0.0, signed(now, at)), near: None });
            }
            // The order is taken back.
            (false, Some(_)) => self.start = None,
            _ => {}
        }
        self.was_idle = !goes;
    }
}

/// From one moment to another, s; negative where the other is earlier.
fn signed(from: Instant, to: Instant) -> f32 {
    if to >= from { to.since(from).as_secs_f32() } else { -from.since(to).as_secs_f32() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::{self, BallModels};
    use protocol::host::RuleRole;

    const US: Colour = Colour::Yellow;

    fn id() -> RobotId {
        RobotId::new(2).unwrap()
    }

    /// Starts from standstill with that acceleration, `latency` s after each order, seen at 60 Hz with 2 mm
    /// of noise, 20 ms late.
    fn learn(latency: f32, acceleration: f32, starts: usize) -> Option<Estimate> {
        let mut learned = Latencies::default();
        let mut noise = 12_345_u32;
        for n in 0..starts {
            let begin = n as u64 * 10_000_000;
            // The order changes between two frames.
            let ordered = begin + 1_000_000 + n as u64 * 3_100;
            for frame in 0..150_u64 {
                let now = begin + frame * 16_667;
                let captured = now.saturating_sub(20_000);
                let moving = (captured as f32 - ordered as f32) * 1e-6 - latency;
                let travelled = if moving > 0.0 { 0.5 * acceleration * moving * moving } else { 0.0 };
                noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let jitter = 0.002 * ((noise >> 16) as f32 / 32_768.0 - 1.0);
                let robot = world::Robot {
                    who: Who { colour: US, id: id() },
                    pose: geometry::Pose {
                        position: Point::new(travelled + jitter, 0.0),
                        ..geometry::Pose::default()
                    },
                    velocity: geometry::Vector::default(),
                    angular: 0.0,
                    confidence: 1.0,
                    seen: Instant(captured),
                };
                let mut world = World::empty(Instant(captured), BallModels::default());
                world.put(robot);
                let x = if now >= ordered { 2.0 } else { 0.0 };
                let pose = geometry::Pose { position: Point::new(x, 0.0), ..geometry::Pose::default() };
                let command = HostCommand {
                    to: id(),
                    defending: geometry::GoalEnd::Negative,
                    phase: Phase::Stop,
                    rule_role: RuleRole::Player,
                    directive: Directive::GoTo { pose: pose.into() },
                };
                learned.see(Instant(now), &world, US, Phase::Stop, &[command]);
            }
        }
        learned.latency(id())
    }

    #[test]
    fn latencies_of_5_to_150_ms_are_known_within_15_ms_whatever_the_acceleration() {
        for latency in [0.005_f32, 0.03, 0.06, 0.15] {
            for acceleration in [1.5, 3.0, 5.0] {
                let known = learn(latency, acceleration, 9).unwrap();
                // Frames are 17 ms apart, and orders between two of them count from the next.
                let off = known.value - latency;
                assert!((-0.020..=0.015).contains(&off), "{latency} s, {acceleration} m/s²: {known:?}");
            }
        }
    }

    #[test]
    fn two_starts_are_too_few_and_a_robot_that_stays_teaches_nothing() {
        assert_eq!(learn(0.05, 3.0, 2), None);
        assert_eq!(learn(0.05, 0.0, 9), None);
        assert_eq!(learn(0.6, 3.0, 9), None, "no robot is as late as that");
    }
}
