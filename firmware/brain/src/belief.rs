//! `belief`: a robot's belief about the world, from its own sensors and its teammates' beacons, never from
//! the true state.
//!
//! SI units, field frame. Own sight of the ball comes first; when it is missing or stale, the report of the
//! teammate nearest the ball is used (its information is the most accurate, paper §4.1). A fresh snapshot of
//! the host overrides both ([`received`]).

#[cfg(feature = "legged")]
pub mod ball;
#[cfg(feature = "legged")]
pub mod camera;
#[cfg(feature = "legged")]
pub mod model;
#[cfg(feature = "legged")]
pub mod opponents;
#[cfg(feature = "legged")]
pub mod pose;
#[cfg(test)]
mod random;
pub mod received;

use geometry::{Field, GoalEnd, Point, Pose, Segment, Vector, math};
use motion::rolling::RollingBall;
use motion::trajectory::FreeLimits;
use protocol::host::{DriveLimits, RuleRole};
use protocol::robot_io::{OPPONENTS_MAX, OmniKick, SensorFrame};
use protocol::{Duration, Instant, RobotId};
use rules::{League, Phase, Side};

use crate::belief::received::Handling;
use crate::body::omni::LIMITS;
use crate::body::{self, BodySpec};
use crate::teammates::Teammates;

/// Own detections older than this are ignored.
const SIGHT_LEASE: Duration = Duration::millis(400);
/// A detection this precise needs no filter, m: over a walking robot's step of 40 ms it is 0.1 m/s.
const SHARP: f32 = 0.004;
/// Standard deviation that an estimate gains a second after its last sight, m/s: half the mean speed of a
/// short kick, as it may have been kicked.
const UNSEEN: f32 = 0.2;
/// Without a sight for longer, a teammate's report may be better than the own estimate: two steps' misses and
/// the head's glances are shorter.
#[cfg(feature = "legged")]
const BALL_STALE: Duration = Duration::millis(1200);
/// A ball slower than this may be grabbed, m/s.
const GRAB_SPEED: f32 = 0.4;
/// A ball slower than this is stationary, m/s: below the apparent speed that a walking body's sway gives a
/// stationary ball.
pub const REST_SPEED: f32 = 0.05;

/// Estimated state of the ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BelievedBall {
    /// Position of its centre, m.
    pub position: Point<Field>,
    /// Velocity along the ground, m/s.
    pub velocity: Vector<Field>,
    /// Stop position: cut at the first opponent on its path and at the lines of the field.
    pub rest: Point<Field>,
}

impl BelievedBall {
    /// Its way from where it is to where it stops.
    pub fn path(&self) -> Segment<Field> {
        Segment::new(self.position, self.rest)
    }

    /// Whether it is slow enough to count as stationary.
    pub fn is_at_rest(&self) -> bool {
        self.velocity.norm() < REST_SPEED
    }

    /// Seconds until it stops, slowing down evenly: twice the remaining distance over its speed.
    pub fn rolls_for(&self) -> f32 {
        if self.is_at_rest() { 0.0 } else { 2.0 * self.position.distance(self.rest) / self.velocity.norm() }
    }

    /// Whether it rolls towards `point`, so that its path comes within `reach` of it.
    pub fn rolls_towards(&self, point: Point<Field>, reach: f32) -> bool {
        !self.is_at_rest()
            && self.velocity.dot(point - self.position) > 0.0
            && geometry::Segment::new(self.position, self.rest).distance_to(point) < reach
    }
}

/// Other robots: two teams of the largest league, less this one.
pub const OTHERS_MAX: usize = 2 * OPPONENTS_MAX - 1;

/// Another robot as received from the host.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Other {
    /// Team of the robot.
    pub side: Side,
    /// Number in its team.
    pub id: RobotId,
    /// Position, m, and heading.
    pub pose: Pose<Field>,
    /// Velocity of its centre, m/s.
    pub velocity: Vector<Field>,
}

/// Phase of the game, and this robot's role in its team.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BelievedGame {
    /// The phase of the game.
    pub phase: Phase<Side>,
    /// Target of a ball placement, while one is running.
    pub placement: Option<Point<Field>>,
    /// Role under the rules, which allow it more than others.
    pub rule_role: RuleRole,
    /// The goal its team defends.
    pub defending: GoalEnd,
    /// Double touch: it has touched the ball in a restart and no other robot has since, so it must not touch
    /// it again.
    pub double_touch_blocked: bool,
}

impl Default for BelievedGame {
    /// Play (`Phase::Run`), the default without a host.
    fn default() -> Self {
        Self {
            phase: Phase::Run,
            placement: None,
            rule_role: RuleRole::Player,
            defending: GoalEnd::Negative,
            double_touch_blocked: false,
        }
    }
}

/// Limits of the drive that a host has set; the robot's own hold where they are stricter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveCap {
    /// Greatest speed, m/s; infinite: the robot's own.
    pub speed: f32,
    /// Greatest acceleration, m/s²; infinite: the robot's own.
    pub acceleration: f32,
}

impl Default for DriveCap {
    /// The robot's own limits.
    fn default() -> Self {
        Self { speed: f32::INFINITY, acceleration: f32::INFINITY }
    }
}

impl DriveCap {
    /// That of a host's message.
    pub fn of(limits: &DriveLimits) -> Self {
        let metres = |limit| match limit {
            DriveLimits::NONE => f32::INFINITY,
            millimetres => f32::from(millimetres) / 1e3,
        };
        Self { speed: metres(limits.speed), acceleration: metres(limits.acceleration) }
    }

    /// The stricter of `limits` and these.
    pub(crate) fn applied_to(self, limits: FreeLimits) -> FreeLimits {
        limits.slowed_to(self.speed).softened_to(self.acceleration)
    }
}

/// The robot's world model.
#[derive(Clone, Debug)]
pub struct Belief {
    /// Own position, m, and heading.
    pub pose: Pose<Field>,
    /// The ball; `None` if its position is unknown.
    pub ball: Option<BelievedBall>,
    /// Standard deviation of a coordinate of the ball's position, m; 0 where it is exact or the host's.
    pub ball_sigma: f32,
    /// Positions of the opponents.
    pub opponents: heapless::Vec<Point<Field>, OPPONENTS_MAX>,
    /// The robot holds the ball.
    pub holds_ball: bool,
    /// Its body is executing a grab or kick.
    pub busy: bool,
    /// Velocity of the own centre, m/s.
    pub velocity: Vector<Field>,
    /// Own turning rate, rad/s.
    pub angular: f32,
    /// Whether the kicker is charged.
    pub kicker_ready: bool,
    /// All other robots whose motion the host sends.
    pub others: heapless::Vec<Other, OTHERS_MAX>,
    /// Phase of the game, and its role in the team.
    pub game: BelievedGame,
    /// Limits of its drive that the host has set.
    pub drive_cap: DriveCap,
    /// Fixed target of the held ball: where it is kicked to, and how.
    pub resolved: Option<(Point<Field>, OmniKick)>,
    handling: Handling,
    sight: Option<Sight>,
    /// Estimators of a robot with a camera.
    #[cfg(feature = "legged")]
    perception: camera::Perception,
    /// Opponents' velocities are needed, also where frames give exact places.
    #[cfg(feature = "legged")]
    follows_opponents: bool,
    /// Its frames are a camera's, with errors.
    #[cfg(feature = "legged")]
    has_camera: bool,
    /// Consecutive detections of a loose ball slow enough to grab.
    slow_sights: u8,
    league: League,
    spec: &'static BodySpec,
}

#[derive(Clone, Copy, Debug)]
struct Sight {
    position: Point<Field>,
    velocity: Vector<Field>,
    at: Instant,
}

impl Belief {
    /// Limits with which a robot on wheels plans without the ball, within what the host allows it.
    pub fn limits_without_ball(&self) -> FreeLimits {
        self.drive_cap.applied_to(LIMITS)
    }

    /// A belief without any observation.
    pub fn new(league: League) -> Self {
        Self {
            pose: Pose::default(),
            ball: None,
            ball_sigma: 0.0,
            opponents: heapless::Vec::new(),
            holds_ball: false,
            busy: false,
            velocity: Vector::default(),
            angular: 0.0,
            kicker_ready: false,
            others: heapless::Vec::new(),
            game: BelievedGame::default(),
            drive_cap: DriveCap::default(),
            resolved: None,
            handling: Handling::default(),
            sight: None,
            #[cfg(feature = "legged")]
            perception: camera::Perception::default(),
            #[cfg(feature = "legged")]
            follows_opponents: false,
            #[cfg(feature = "legged")]
            has_camera: false,
            slow_sights: 0,
            league,
            spec: body::spec(league),
        }
    }

    /// A belief that knows only the goal its team defends.
    pub fn defending(league: League, defending: GoalEnd) -> Self {
        Self { game: BelievedGame { defending, ..BelievedGame::default() }, ..Self::new(league) }
    }

    /// The same with the velocities of opponents, where they are needed.
    #[must_use]
    pub fn following_opponents(self, needed: bool) -> Self {
        #[cfg(feature = "legged")]
        let belief = Self { follows_opponents: needed, ..self };
        #[cfg(not(feature = "legged"))]
        let (_, belief) = (needed, self);
        belief
    }

    /// Takes in what the body perceives and what teammates report.
    pub fn update(&mut self, now: Instant, me: RobotId, sensors: &SensorFrame, teammates: &Teammates) {
        self.holds_ball = sensors.ball_contact;
        self.busy = sensors.busy;
        let own = self.own_ball(now, sensors);
        let slow = own.is_some_and(|ball| ball.velocity.norm() < GRAB_SPEED) && !self.holds_ball;
        self.slow_sights = if slow { self.slow_sights.saturating_add(1) } else { 0 };
        let reported = self.reported_ball(now, me, teammates, own.is_some());
        self.ball = reported.or(own);
    }

    /// The own ball of a sensor frame, after pose and opponents.
    fn own_ball(&mut self, now: Instant, sensors: &SensorFrame) -> Option<BelievedBall> {
        #[cfg(feature = "legged")]
        if let Some(camera) = &sensors.camera {
            self.has_camera = true;
            return self.perceive(now, sensors, camera);
        }
        if let Some(pose) = sensors.pose.filter(|pose| pose.position.is_finite()) {
            self.pose = pose;
        }
        #[cfg(feature = "legged")]
        if self.follows_opponents {
            self.perception.follow(now, &sensors.opponents);
        }
        self.opponents.clear();
        // Fewer in a frame than opponents have room.
        for seen in sensors.opponents.iter().filter(|p| p.is_finite()) {
            let _room = self.opponents.push(*seen);
        }
        if let Some(ball) = sensors.ball.filter(|b| b.position.is_finite()) {
            self.see(now - ball.age, ball.position, ball.sigma);
        }
        let sight = self.sight.filter(|s| now.since(s.at) <= SIGHT_LEASE)?;
        Some(self.cut_at_opponents(rolling(sight.position, sight.velocity, self.league)))
    }

    /// Where an opponent at `place` will be after `seconds` at its present velocity; stays where nothing
    /// tells that.
    pub fn opponent_after(&self, place: Point<Field>, seconds: f32) -> Point<Field> {
        let theirs = self.others.iter().filter(|other| other.side == Side::Theirs);
        let sent = theirs.map(|other| (other.pose.position, other.velocity));
        #[cfg(feature = "legged")]
        let sent = sent.chain(self.perception.opponents.iter().map(|track| (track.place, track.velocity)));
        let found = sent.into_iter().find(|(at, _)| *at == place);
        found.map_or(place, |(at, velocity)| at + velocity * seconds)
    }

    /// The opponent whose centre is nearest to `point`, and its distance.
    pub fn nearest_opponent(&self, point: Point<Field>) -> Option<(Point<Field>, f32)> {
        nearest(self.opponents.iter().copied(), point)
    }

    /// Whether an opponent is on the ball and none of us disputes it.
    pub fn opponent_on_ball(&self, now: Instant, teammates: &Teammates) -> bool {
        let Some(ball) = self.ball else { return false };
        let ours = |at: Point<Field>| at.distance(ball.position) < self.spec.disputed_within;
        !ours(self.pose.position)
            && !teammates.present(now).any(|(_, teammate)| ours(teammate.pose().position))
            && self.nearest_opponent(ball.position).is_some_and(|(_, d)| d < self.spec.opponent_holds_within)
    }

    /// Whether the ball lies still enough to be grabbed; a ball that has just left the legs does not, though
    /// its speed is unknown.
    pub fn may_grab(&self) -> bool {
        self.slow_sights >= 2
    }

    /// League of the robot.
    pub fn league(&self) -> League {
        self.league
    }

    /// Velocity by an alpha–beta filter; a precise detection (σ ≤ [`SHARP`]) is used unfiltered.
    fn see(&mut self, at: Instant, position: Point<Field>, sigma: f32) {
        let Some(before) = self.sight else {
            self.sight = Some(Sight { position, velocity: Vector::default(), at });
            return;
        };
        let dt = at.since(before.at).as_secs_f32();
        if dt <= 0.0 {
            return;
        }
        let (alpha, beta) = if sigma > SHARP { (0.5, 0.2) } else { (1.0, 1.0) };
        let predicted = before.position + before.velocity * dt;
        let miss = position - predicted;
        let velocity = before.velocity + miss * (beta / dt);
        self.sight = Some(Sight { position: predicted + miss * alpha, velocity, at });
    }

    /// The ball with its path ended by an opponent on it.
    fn cut_at_opponents(&self, mut ball: BelievedBall) -> BelievedBall {
        let within = self.spec.opponent_holds_within;
        let path = ball.path();
        let stops =
            |o: &Point<Field>| path.distance_to(*o) < within && (*o - ball.position).dot(path.vector()) > 0.0;
        let first = self.opponents.iter().filter(|o| stops(o)).map(|o| path.share_of(*o)).reduce(f32::min);
        if let Some(share) = first {
            let length = path.vector().norm();
            let free = math::clamp(share * length - within, 0.0, length);
            ball.rest = ball.position + path.vector() * (free / length.max(f32::MIN_POSITIVE));
        }
        ball
    }

    /// The ball of a teammate's report, where it is better than the own estimate: intersection of
    /// covariances. Reports have one standard deviation for both axes, so the intersection of least trace is
    /// the estimate with the smaller one. A ball that was just seen is the own one: skills need it in the
    /// body's frame.
    fn reported_ball(
        &mut self,
        now: Instant,
        me: RobotId,
        teammates: &Teammates,
        own: bool,
    ) -> Option<BelievedBall> {
        if own && !self.is_ball_stale(now) {
            return None;
        }
        let others = teammates.present(now).filter(|(id, _)| *id != me);
        let reports = others.filter_map(|(_, teammate)| {
            let report = teammate.beacon.ball?;
            let age = report.quality.age() + now.since(teammate.received);
            let grown = report.quality.sigma() + UNSEEN * age.as_secs_f32();
            Some((report, age, grown))
        });
        let (report, age, sigma) =
            reports.min_by(|a, b| a.2.total_cmp(&b.2).then(a.0.distance.cmp(&b.0.distance)))?;
        if own && sigma >= self.ball_sigma {
            return None;
        }
        self.ball_sigma = sigma;
        let velocity = report.quality.velocity();
        let ball = rolling(Point::from(report.at), velocity, self.league);
        // Where it has rolled to since, at most to its stop.
        let rolled = (velocity * age.as_secs_f32()).clamped(ball.position.distance(ball.rest));
        Some(BelievedBall { position: ball.position + rolled, ..ball })
    }

    /// Whether the own estimate of the ball has lacked sights for so long that a teammate's may be better.
    #[cfg(feature = "legged")]
    fn is_ball_stale(&self, now: Instant) -> bool {
        self.has_camera && self.perception.ball_age(now) > BALL_STALE
    }

    /// Whether the own estimate of the ball has lacked sights for so long that a teammate's may be better.
    #[cfg(not(feature = "legged"))]
    #[expect(clippy::unused_self, reason = "as with legs")]
    fn is_ball_stale(&self, _now: Instant) -> bool {
        false
    }

    /// Age of the own estimate of the ball.
    pub fn ball_age(&self, now: Instant) -> Duration {
        #[cfg(feature = "legged")]
        if self.has_camera {
            return self.perception.ball_age(now);
        }
        let _ = now;
        Duration(0)
    }

    /// Standard deviation of a coordinate of an opponent's position, m; 0 where it is exact or the host's.
    pub fn opponent_sigma(&self) -> f32 {
        #[cfg(feature = "legged")]
        if self.has_camera {
            return model::REPORTED;
        }
        0.0
    }
}

/// The nearest of `points` to `to`; the first of equals.
pub(crate) fn nearest(
    points: impl Iterator<Item = Point<Field>>,
    to: Point<Field>,
) -> Option<(Point<Field>, f32)> {
    points.map(|p| (p, p.distance(to))).reduce(|best, next| if next.1 < best.1 { next } else { best })
}

fn rolling(position: Point<Field>, velocity: Vector<Field>, league: League) -> BelievedBall {
    let model = RollingBall { deceleration: league.ball().rolling_deceleration };
    let speed = velocity.norm();
    let rest = match velocity.unit() {
        Some(direction) if speed >= REST_SPEED => position + direction * model.rest_distance(speed),
        _ => position,
    };
    BelievedBall { position, velocity, rest: league.field().clamp(rest, 0.0) }
}

#[cfg(test)]
mod tests;
