//! `kick`: estimate of each robot's kick gain. From flat kicks that the host ordered with a speed and that
//! the tracker saw, by the ball's places 0.05–0.3 s after the kick. m, m/s, s.

use geometry::{Field, Point, Vector};
use protocol::host::{Directive, HostCommand, KickOrder};
use protocol::{Duration, Instant, RobotId, Who};
use rules::Colour;

use super::samples::{Estimate, Samples};
use crate::world::{Kick, World};

/// Samples kept for each robot: a half's kicks, so that a falling battery voltage is followed.
const KICKS_KEPT: usize = 15;
/// Number of kicks needed: of three, two with the same error determine the median.
const KICKS_MIN: usize = 5;
/// Number of kicks from which a test shows a gain while it goes on.
const KICKS_SHOWN_MIN: usize = 3;
/// A gain is known when its standard error is at most this. Chosen to exclude one estimate that was 20 % off
/// with an error of 0.047, from kicks that left slower than ordered for a reason that is not known; the
/// largest error of the ten right ones beside it was 0.040.
const GAIN_ERROR_MAX: f32 = 0.04;
/// Time in which an order reaches its robot: a kick sooner after a change of orders may be of either.
const ORDER_ARRIVES: Duration = Duration::millis(80);
/// Share by which an order of the same kick changes while the ball is approached.
const SAME_ORDER_WITHIN: f32 = 0.05;
/// An opponent whose centre is nearer to the kicked ball may have kicked it, m: both touch it at 0.11 m.
const OPPONENT_CLEAR_M: f32 = 0.2;
/// Two kicks of one robot are farther apart; the moment of one kick shifts by less while it becomes better
/// known.
const SAME_KICK_WITHIN: Duration = Duration::millis(200);
/// The ball is observed in this window after the kick: later than the filter needs, and before rolling
/// changes the deceleration (0.29 s at 4 m/s).
const OBSERVED_FROM: Duration = Duration::millis(50);
const OBSERVED_TO: Duration = Duration::millis(250);
/// Camera frames needed in that time.
const FRAMES_MIN: f32 = 6.0;
/// Slower orders may be touches of the dribbler instead of kicks, m/s.
const ORDER_SPEED_MIN_M_S: f32 = 1.5;
/// A ball that leaves its line by more has hit something, m (root of the mean square).
const LINE_RMS_MAX_M: f32 = 0.02;
/// No kicker is softer or harder than this.
const GAIN_MIN: f32 = 0.4;
const GAIN_MAX: f32 = 2.0;

/// Estimates of all robots' kick gains.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Kicks {
    /// What each robot is ordered, and was before.
    orders: [[Order; 2]; RobotId::COUNT],
    gains: [Samples<KICKS_KEPT>; RobotId::COUNT],
    watched: Option<Watched>,
    /// The kick that was watched last.
    known: Option<(Instant, Option<Who>)>,
    /// The newest measured kick: its robot, speed ordered and speed seen, m/s.
    newest: Option<(RobotId, [f32; 2])>,
}

/// An order of a robot.
#[derive(Clone, Copy, Debug, Default)]
struct Order {
    since: Instant,
    /// Speed of a flat kick, m/s; none: any other order.
    speed: Option<f32>,
}

/// A kick that has just been seen.
#[derive(Clone, Copy, Debug)]
struct Watched {
    robot: RobotId,
    ordered: f32,
    from: Point<Field>,
    along: Vector<Field>,
    at: Instant,
    newest: Instant,
    /// Sums of a straight line through (t, distance + what sliding took): number, t, t², distance,
    /// t·distance, distance².
    sums: [f32; 6],
}

impl Kicks {
    pub(crate) fn see(&mut self, now: Instant, world: &World, us: Colour, commands: &[HostCommand]) {
        self.watch(world, us);
        for command in commands {
            let speed = match command.directive {
                Directive::Kick { kick: KickOrder::Flat(speed), .. }
                | Directive::Pass { kick: KickOrder::Flat(speed), ready: true, .. } => {
                    Some(f32::from(speed) * 0.01)
                }
                _ => None,
            };
            let [current, before] = &mut self.orders[command.to.index()];
            if current.is_for(speed) {
                current.speed = speed;
            } else {
                *before = core::mem::replace(current, Order { since: now, speed });
            }
        }
    }

    fn watch(&mut self, world: &World, us: Colour) {
        let Some(ball) = &world.ball else {
            self.watched = None;
            return;
        };
        let kick = ball.kicked.filter(|kick| !kick.is_chip());
        if let Some(kick) = kick.filter(|kick| self.is_new(kick)) {
            self.known = Some((kick.at, kick.by));
            self.watched = self.begin(&kick, world, us);
        }
        let Some(watched) = &mut self.watched else { return };
        if kick.is_none() || ball.height > 0.0 {
            // It flies, or has hit something.
            self.watched = None;
            return;
        }
        let age = ball.seen.since(watched.at);
        if age.0 > OBSERVED_TO.0 {
            if let Some(gain) = watched.gain() {
                self.gains[watched.robot.index()].add(gain);
                self.newest = Some((watched.robot, [watched.ordered, gain * watched.ordered]));
            }
            self.watched = None;
        } else if ball.seen > watched.newest && age.0 >= OBSERVED_FROM.0 {
            watched.newest = ball.seen;
            let t = age.as_secs_f32();
            let distance =
                (ball.position - watched.from).dot(watched.along) + 0.5 * world.models.ground.slide * t * t;
            watched.add(t, distance);
        }
    }

    fn is_new(&self, kick: &Kick) -> bool {
        self.known.is_none_or(|(at, by)| {
            let apart = if kick.at > at { kick.at.since(at) } else { at.since(kick.at) };
            by != kick.by || apart.0 > SAME_KICK_WITHIN.0
        })
    }

    fn begin(&self, kick: &Kick, world: &World, us: Colour) -> Option<Watched> {
        let who = kick.by.filter(|who| who.colour == us)?;
        let [current, before] = self.orders[who.id.index()];
        let order = if kick.at < current.since { before } else { current };
        let arrived = kick.at.since(order.since).0 >= ORDER_ARRIVES.0;
        let ordered = order.speed.filter(|speed| arrived && *speed >= ORDER_SPEED_MIN_M_S)?;
        let mut opponents = world.theirs(us).map(|robot| robot.pose.position.distance(kick.from));
        let along = kick.velocity.unit().filter(|_| opponents.all(|away| away >= OPPONENT_CLEAR_M))?;
        Some(Watched {
            robot: who.id,
            ordered,
            from: kick.from,
            along,
            at: kick.at,
            newest: kick.at,
            sums: [0.0; 6],
        })
    }

    #[cfg(test)]
    pub(super) fn know(&mut self, robot: RobotId, gain: f32) {
        for _ in 0..KICKS_MIN {
            self.gains[robot.index()].add(gain);
        }
    }

    pub(super) fn gain(&self, robot: RobotId) -> Option<Estimate> {
        self.gains[robot.index()].estimate(KICKS_MIN).filter(|gain| gain.error() <= GAIN_ERROR_MAX)
    }

    /// The same from the third kick on, however far the kicks scatter: for who looks at each of them.
    pub(crate) fn estimate(&self, robot: RobotId) -> Option<Estimate> {
        self.gains[robot.index()].estimate(KICKS_SHOWN_MIN)
    }

    /// The kick measured since this was last asked: its robot, speed ordered and speed seen, m/s.
    pub(crate) fn take_newest(&mut self) -> Option<(RobotId, [f32; 2])> {
        self.newest.take()
    }
}

impl Order {
    fn is_for(&self, speed: Option<f32>) -> bool {
        match (self.speed, speed) {
            (Some(ours), Some(speed)) => (speed - ours).abs() <= SAME_ORDER_WITHIN * ours,
            (None, None) => true,
            _ => false,
        }
    }
}

impl Watched {
    fn add(&mut self, t: f32, distance: f32) {
        let terms = [1.0, t, t * t, distance, t * distance, distance * distance];
        for (sum, term) in self.sums.iter_mut().zip(terms) {
            *sum += term;
        }
    }

    /// Ball speed at the kick over speed ordered, if the ball moved straight and the ratio is plausible.
    fn gain(&self) -> Option<f32> {
        let [n, t, tt, s, ts, ss] = self.sums;
        let spread = n * tt - t * t;
        if n < FRAMES_MIN || spread <= 0.0 {
            return None;
        }
        let speed = (n * ts - t * s) / spread;
        let offset = (s - speed * t) / n;
        let residual = (ss - offset * s - speed * ts) / n;
        let gain = speed / self.ordered;
        (residual < LINE_RMS_MAX_M * LINE_RMS_MAX_M && (GAIN_MIN..=GAIN_MAX).contains(&gain)).then_some(gain)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::{Ball, BallModels};
    use protocol::host::RuleRole;

    const US: Colour = Colour::Blue;

    fn id() -> RobotId {
        RobotId::new(4).unwrap()
    }

    /// Kicks of `speed` m/s ordered, seen as `kicked` m/s by a camera of 75 Hz with noise of `noise`, each
    /// flying where `chip`.
    fn learn(kicks: &[(f32, f32)], noise: f32, chip: bool) -> Kicks {
        let (mut learned, models) = (Kicks::default(), BallModels::default());
        let mut time = 1_000_000_u64;
        for (n, (ordered, kicked)) in kicks.iter().enumerate() {
            let command = HostCommand {
                to: id(),
                defending: geometry::GoalEnd::Negative,
                phase: rules::Phase::Run,
                rule_role: RuleRole::Player,
                directive: Directive::Kick {
                    at: Point::<Field>::new(3.0, 0.0).into(),
                    kick: KickOrder::Flat((ordered * 100.0) as u16),
                },
            };
            let mut lies = World::empty(Instant(time), models);
            lies.ball = Some(Ball::at_rest(Point::new(0.0, 0.0), Instant(time)));
            learned.see(Instant(time), &lies, US, &[command]);
            let at = time + 100_000;
            let path = models.ground.kicked(Point::<Field>::new(0.0, 0.0), Vector::new(*kicked, 0.0));
            for step in 1..60_u64 {
                use motion::trajectory::Motion;
                let now = at + step * 13_333;
                let state = path.at((now - at) as f32 * 1e-6);
                let jitter = noise * [(-1.0_f32), 0.6, 0.9, -0.5][(step as usize + n) % 4];
                let kick = Kick {
                    by: Some(Who { colour: US, id: id() }),
                    from: Point::new(0.0, 0.0),
                    velocity: Vector::new(*kicked * 0.9, 0.0),
                    climb: if chip { 2.0 } else { 0.0 },
                    at: Instant(at),
                };
                let ball = Ball {
                    velocity: state.velocity,
                    kicked: Some(kick),
                    ..Ball::at_rest(state.position + Vector::new(jitter, 0.0), Instant(now))
                };
                let mut world = World::empty(Instant(now), models);
                world.ball = Some(ball);
                learned.see(Instant(now), &world, US, &[]);
            }
            time = at + 2_000_000;
        }
        learned
    }

    #[test]
    fn a_kicker_that_gives_72_percent_is_known_within_three_percent_after_five_kicks() {
        let kicks: Vec<_> =
            [3.0, 3.5, 4.0, 4.8, 5.5].into_iter().map(|speed| (speed, 0.72 * speed)).collect();
        assert_eq!(learn(&kicks[..4], 0.003, false).gain(id()), None, "four are too few");
        let gain = learn(&kicks, 0.003, false).gain(id()).unwrap();
        assert!((gain.value - 0.72).abs() < 0.03, "{gain:?}");
        assert_eq!(learn(&kicks, 0.003, false).gain(RobotId::ZERO), None);
    }

    #[test]
    fn a_ball_that_was_deflected_once_and_a_chip_teach_nothing() {
        let mut kicks = vec![(4.0, 4.0); 7];
        kicks[2] = (4.0, 0.5);
        kicks[4] = (4.0, 12.0);
        let gain = learn(&kicks, 0.003, false).gain(id()).unwrap();
        assert!((gain.value - 1.0).abs() < 0.03 && gain.samples == 5, "{gain:?}");
        assert_eq!(learn(&kicks, 0.003, true).gain(id()), None);
    }

    #[test]
    fn kicks_that_differ_widely_teach_nothing() {
        let gains = [0.6, 1.2, 0.9, 0.7, 1.1, 0.8];
        let kicks: Vec<_> = gains.into_iter().map(|gain| (4.0, gain * 4.0)).collect();
        assert_eq!(learn(&kicks, 0.003, false).gain(id()), None);
    }
}
