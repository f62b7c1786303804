//! `snapshot`: the host's snapshot of the field as a robot receives it, put together from its parts and
//! carried forward to the present.
//!
//! Parts may be lost, doubled and reordered, and their numbers wrap: received parts are used, entries of lost
//! ones keep their last position for a moment. Positions hold at the moment of arrival (docs/architecture.md
//! §3.2); between snapshots the own pose is carried forward by odometry, other robots by their velocity, the
//! ball as it rolls. Field frame, SI.

use geometry::{Body, Field, Pose, Twist, Vector};
use motion::ball::BallModel;
use protocol::host::{PARTS_MAX, WireBall, WireRobot, WireWho, WorldPart};
use protocol::quantized::from_mm;
use protocol::{Duration, Instant, RobotId};
use rules::{Phase, Side};

/// Result of handling a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Taken {
    /// The first part received of a newer snapshot.
    Begun,
    /// One more part of the present snapshot.
    More,
    /// A part that was received before.
    Doubled,
    /// A part of an older snapshot: dropped.
    Late,
    /// A part beyond the last one, or of too many parts: dropped.
    Malformed,
}

/// A robot of the snapshot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReceivedPart {
    /// Team and number of the robot.
    pub who: WireWho,
    /// Position, m, and heading.
    pub pose: Pose<Field>,
    /// Velocity, m/s, field frame.
    pub velocity: Vector<Field>,
    at: Instant,
    snapshot: u8,
}

/// The ball of the snapshot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReceivedBall {
    /// Position above or on the ground, m.
    pub position: geometry::Point<Field>,
    /// Velocity along the ground, m/s.
    pub velocity: Vector<Field>,
    /// Height of the ball above the ground, m.
    pub height: f32,
    at: Instant,
}

/// Everything the host sends of the field, as far as it was received.
#[derive(Clone, Debug)]
pub struct HostSnapshot {
    me: RobotId,
    number: Option<u8>,
    /// Arrival of the newest part.
    received: Instant,
    /// Parts of this snapshot that were received, a bit each.
    parts: u8,
    /// Number of parts in which it was sent.
    parts_sent: u8,
    /// The phase of the game.
    phase: Option<Phase<Side>>,
    /// Target of a ball placement.
    placement: Option<geometry::Point<Field>>,
    ball: Option<ReceivedBall>,
    robots: [[Option<ReceivedPart>; RobotId::COUNT]; 2],
    own: Option<Own>,
    odometry: Twist<Body>,
    /// The same, averaged over a sixth of a second: what the host takes the motion for.
    average: Twist<Body>,
}

/// The own pose: received at one time, carried forward since.
#[derive(Clone, Copy, Debug)]
struct Own {
    pose: Pose<Field>,
    received_at: Instant,
    carried_to: Instant,
}

impl HostSnapshot {
    /// A snapshot without any part, for robot `me`.
    pub fn new(me: RobotId) -> Self {
        Self {
            me,
            number: None,
            received: Instant(0),
            parts: 0,
            parts_sent: 0,
            phase: None,
            placement: None,
            ball: None,
            robots: [[None; RobotId::COUNT]; 2],
            own: None,
            odometry: Twist::default(),
            average: Twist::default(),
        }
    }

    /// Handles a received part.
    pub fn handle_part(&mut self, now: Instant, part: &WorldPart) -> Taken {
        if part.parts == 0 || usize::from(part.parts) > PARTS_MAX || part.part >= part.parts {
            return Taken::Malformed;
        }
        let taken = self.place_of(now, part);
        match taken {
            Taken::Begun => (self.number, self.parts) = (Some(part.snapshot), 0),
            Taken::More => {}
            Taken::Doubled | Taken::Late | Taken::Malformed => return taken,
        }
        self.received = now;
        self.parts |= 1 << part.part;
        self.parts_sent = part.parts;
        self.phase = Some(part.phase);
        self.placement = part.placement.map(Into::into);
        if taken == Taken::Begun {
            self.ball = part.ball.map(|ball| received_ball(now, ball));
        }
        for robot in &part.robots {
            self.show(now, part.snapshot, robot);
        }
        let whole = (1_u16 << part.parts) - 1;
        if u16::from(self.parts) == whole {
            // A robot that is in no part of a whole snapshot is not on the field.
            for slot in self.robots.iter_mut().flatten() {
                if slot.as_ref().is_some_and(|robot| robot.snapshot != part.snapshot) {
                    *slot = None;
                }
            }
        }
        taken
    }

    /// Another host sends the field from now on: any snapshot is a new one.
    pub fn restart(&mut self) {
        self.number = None;
    }

    /// Carries the pose forward to `now` by the body's measured motion.
    pub fn handle_odometry(&mut self, now: Instant, odometry: Twist<Body>) {
        let finite = odometry.linear.is_finite() && odometry.angular.is_finite();
        self.odometry = if finite { odometry } else { Twist::default() };
        self.average.linear += (self.odometry.linear - self.average.linear) * AVERAGES;
        self.average.angular += (self.odometry.angular - self.average.angular) * AVERAGES;
        self.carry_own_to(now);
    }

    /// Arrival of the newest part; `None` before the first.
    pub fn received(&self) -> Option<Instant> {
        self.number.map(|_| self.received)
    }

    /// Number of parts in which the newest snapshot was sent; `None` before the first.
    pub fn parts_sent(&self) -> Option<u8> {
        self.number.map(|_| self.parts_sent)
    }

    /// The phase in the newest part.
    pub fn phase(&self) -> Option<Phase<Side>> {
        self.phase
    }

    /// Target of a ball placement, while one is running.
    pub fn placement(&self) -> Option<geometry::Point<Field>> {
        self.placement
    }

    /// The own pose; `None` where the host has not sent it for too long.
    pub fn own(&self, now: Instant) -> Option<Pose<Field>> {
        self.own.filter(|own| now.since(own.received_at) <= OWN_LEASE).map(|own| own.pose)
    }

    /// Time since the host sent the own pose; `None` before the first.
    pub fn own_age(&self, now: Instant) -> Option<Duration> {
        self.own.map(|own| now.since(own.received_at))
    }

    /// The ball, where it will be `now`; `None` where the host sends none.
    pub fn ball(&self, now: Instant) -> Option<ReceivedBall> {
        let ball = self.ball.filter(|ball| now.since(ball.at) <= BALL_LEASE)?;
        let time = now.since(ball.at).as_secs_f32();
        if ball.height > IN_THE_AIR {
            return Some(ReceivedBall { position: ball.position + ball.velocity * time, ..ball });
        }
        let path = BallModel::default().rolling(ball.position, ball.velocity);
        let (travelled, speed) = path.progress(time);
        Some(ReceivedBall {
            position: path.from() + path.along() * travelled,
            velocity: path.along() * speed,
            ..ball
        })
    }

    /// Every robot received but this one, where it will be `now`: ours first, lowest id first.
    pub fn others(&self, now: Instant) -> impl Iterator<Item = ReceivedPart> {
        let fresh = move |robot: &&ReceivedPart| now.since(robot.at) <= ROBOT_LEASE;
        self.robots.iter().flatten().flatten().filter(fresh).filter(|robot| !self.is_me(robot.who)).map(
            move |robot| {
                let time = now.since(robot.at).as_secs_f32();
                let position = robot.pose.position + robot.velocity * time;
                ReceivedPart { pose: Pose { position, ..robot.pose }, ..*robot }
            },
        )
    }

    fn is_me(&self, who: WireWho) -> bool {
        who.side == Side::Ours && who.id == self.me
    }

    fn place_of(&self, now: Instant, part: &WorldPart) -> Taken {
        let Some(number) = self.number else { return Taken::Begun };
        match part.snapshot.wrapping_sub(number) {
            0 if self.parts & (1 << part.part) != 0 => Taken::Doubled,
            0 => Taken::More,
            1..128 => Taken::Begun,
            // A host that has restarted counts from anywhere.
            _ if now.since(self.received) > SILENCE => Taken::Begun,
            _ => Taken::Late,
        }
    }

    fn show(&mut self, now: Instant, snapshot: u8, robot: &WireRobot) {
        let velocity = Vector::new(from_mm(i32::from(robot.vx)), from_mm(i32::from(robot.vy)));
        let received_at =
            ReceivedPart { who: robot.who, pose: robot.pose.into(), velocity, at: now, snapshot };
        if self.is_me(robot.who) {
            self.correct_own(now, received_at.pose);
        }
        self.robots[(robot.who.side == Side::Theirs) as usize][robot.who.id.index()] = Some(received_at);
    }

    /// Weighted mean of the host's pose and odometry: the host's noise is a millimetre, the odometry's drift
    /// grows.
    fn correct_own(&mut self, now: Instant, received_at: Pose<Field>) {
        self.carry_own_to(now);
        // A part that waited holds the pose of its time: the pose has moved since.
        let carried_to = self.own.map_or(now, |own| own.carried_to.max(now));
        let received_at = self.carried(received_at, carried_to.since(now).as_secs_f32());
        let changes = CHANGES_TURN * (self.odometry.angular - self.average.angular);
        let turning = 1.0 / (1.0 + changes * changes);
        let changes = (self.odometry.linear - self.average.linear) * CHANGES_SPEED;
        let moving = 1.0 / (1.0 + changes.dot(changes));
        let near = |own: &Own| {
            own.pose.position.distance(received_at.position) * moving < JUMP
                && (own.pose.heading - received_at.heading).abs() * turning < JUMP_TURN
                && now.since(own.received_at) <= OWN_LEASE
        };
        let (turning, moving) = (SHARE * turning, SHARE * moving);
        let pose = match self.own.filter(near) {
            Some(Own { pose, .. }) => Pose {
                position: pose.position + (received_at.position - pose.position) * moving,
                heading: pose.heading
                    + geometry::Angle::new((received_at.heading - pose.heading).radians() * turning),
            },
            None => received_at,
        };
        self.own = Some(Own { pose, received_at: now, carried_to });
    }

    fn carry_own_to(&mut self, now: Instant) {
        if let Some(own) = self.own.filter(|own| own.carried_to < now) {
            let pose = self.carried(own.pose, now.since(own.carried_to).as_secs_f32());
            self.own = Some(Own { pose, carried_to: now, ..own });
        }
    }

    /// The pose after `time` seconds of the motion that was measured last.
    fn carried(&self, mut pose: Pose<Field>, time: f32) -> Pose<Field> {
        if time > 0.0 {
            let Twist { linear, angular } = self.odometry;
            let turned = angular * time;
            let midway = Pose { heading: pose.heading + geometry::Angle::new(0.5 * turned), ..pose };
            pose.position += midway.vector_to_field(linear * time);
            pose.heading = pose.heading + geometry::Angle::new(turned);
        }
        pose
    }
}

fn received_ball(now: Instant, ball: WireBall) -> ReceivedBall {
    ReceivedBall {
        position: ball.at.into(),
        velocity: Vector::new(from_mm(i32::from(ball.vx)), from_mm(i32::from(ball.vy))),
        height: from_mm(i32::from(ball.height)),
        at: now,
    }
}

/// A robot that the newest parts left out keeps its place for this time: a few snapshots at 60 Hz.
const ROBOT_LEASE: Duration = Duration::millis(200);
/// The same for the ball; longer, as it is hidden often.
const BALL_LEASE: Duration = Duration::millis(500);
/// Maximum time for which odometry alone carries the own pose: at 3 m/s and 3 % of slip it errs by 5 cm (an
/// estimate).
const OWN_LEASE: Duration = Duration::millis(500);
/// After this silence any snapshot is a new one.
const SILENCE: Duration = Duration::millis(300);
/// Weight of the host's pose in the own pose: at 60 Hz the odometry's part has decayed after half a second,
/// in which it errs by millimetres. The host's pose was carried forward over cameras' and radio's delay with
/// a velocity that lags in every turn and every start: a larger share brings that error into the control
/// loop, and bodies sway (4° and 2 cm with 0.4).
const SHARE: f32 = 0.1;
/// The change of the turn, rad/s, is weighed with this, s/rad: the host's error over the delay of 0.08 s in
/// noise of a degree. One and the square divide the share: a turning robot that took the host's heading was
/// 20° off.
const CHANGES_TURN: f32 = 4.0;
/// The same for the change of the velocity, s/m: 0.06 s in 1.5 cm, which wheels that slip err by themselves.
const CHANGES_SPEED: f32 = 4.0;
/// Weight of a step's motion in the average of a sixth of a second: steps of 10 ms.
const AVERAGES: f32 = 0.06;
/// Distance between the host's pose and the own one from which the host's replaces it, m. More than vision's
/// noise, less than a push.
const JUMP: f32 = 0.1;
/// The same for the heading, rad; both while the motion is steady.
const JUMP_TURN: f32 = 0.2;
/// A ball higher than this is in the air, m: more than vision's error of height for a ball on the ground.
pub const IN_THE_AIR: f32 = 0.05;

#[cfg(test)]
mod tests;
