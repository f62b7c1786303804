//! `received`: belief of a wheeled robot, from the host's snapshot, its break-beam sensor and its wheels
//! (docs/architecture.md §3.2).
//!
//! Field frame, SI. The ball is held while the break-beam sensor sees it; gaps of the sensor signal, as a
//! rolling ball flickers, are bridged while the host's snapshot has the ball at the dribbler opening. The
//! distance carried counts from the first touch until there is a visible gap between ball and opening (rules
//! 2026: dribbling).

use geometry::{Field, Point, Pose, Vector};
use motion::ball::BallModel;
use protocol::robot_io::SensorFrame;
use protocol::{Duration, Instant};
use rules::{FieldSpec, Phase, Side};

use crate::belief::{Belief, BelievedBall, Other};
use crate::body::omni::{BALL_AT, FRONT};
use crate::snapshot::{HostSnapshot, IN_THE_AIR};

/// Contact of this robot with the ball.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Handling {
    /// Last time the break-beam sensor saw the ball.
    touched: Option<Instant>,
    /// Ball position at the start of this touch.
    from: Option<Point<Field>>,
    /// Height of the ball, m.
    height: f32,
    /// Break-beam sensor in the present step.
    contact: bool,
    /// Since when the host's ball contradicts the break-beam sensor.
    contradicted: Option<Instant>,
    /// Start time of this touch.
    since: Option<Instant>,
    /// Duration of this touch, s.
    held: f32,
    /// Since when this robot and an opponent have both been at the ball.
    disputed: Option<Instant>,
    /// Duration of the dispute, s.
    dispute: f32,
}

impl Belief {
    /// Takes over the host's snapshot and what the wheels measure.
    pub fn show(&mut self, now: Instant, snapshot: &HostSnapshot, sensors: &SensorFrame) {
        if let Some(pose) = snapshot.own(now) {
            self.pose = pose;
        }
        let measured = sensors.odometry;
        if measured.linear.is_finite() && measured.angular.is_finite() {
            self.velocity = self.pose.vector_to_field(measured.linear);
            self.angular = measured.angular;
        }
        self.kicker_ready = sensors.health.kicker_ready;
        self.busy = sensors.busy;
        self.others.clear();
        self.opponents.clear();
        for received in snapshot.others(now) {
            let other = Other {
                side: received.who.side,
                id: received.who.id,
                pose: received.pose,
                velocity: received.velocity,
            };
            // Sixteen robots per team can be received, eleven play: robots over the capacity are dropped.
            let _ = self.others.push(other);
            if other.side == Side::Theirs {
                let _ = self.opponents.push(other.pose.position);
            }
        }
        self.handling.height = 0.0;
        self.ball = snapshot.ball(now).map(|ball| {
            self.handling.height = ball.height;
            rolling(ball.position, ball.velocity, &self.league.field())
        });
        self.handle(now, sensors.ball_contact);
    }

    /// Whether the break-beam sensor sees the ball in the present step.
    pub fn contact(&self) -> bool {
        self.handling.contact
    }

    /// Whether the break-beam sensor contradicts the host's ball for longer than play can: interrupted with
    /// the ball elsewhere, or free with the ball within the opening.
    pub fn doubts_break_beam(&self, now: Instant) -> bool {
        self.handling.contradicted.is_some_and(|since| now.since(since) >= CONTRADICTED_FOR)
    }

    /// Whether the ball flies.
    pub fn ball_flies(&self) -> bool {
        self.handling.height > IN_THE_AIR
    }

    /// Distance over which the ball has been carried since the first touch, m.
    pub fn carried(&self) -> f32 {
        match (self.handling.from, self.holds_ball) {
            (Some(from), true) => from.distance(self.dribbler_point()),
            _ => 0.0,
        }
    }

    /// Time for which the ball has been at its front, s: until there is a visible gap.
    pub fn held(&self) -> f32 {
        self.handling.held
    }

    /// Whether our team places the ball: there is time to do it carefully.
    pub fn is_placing(&self) -> bool {
        self.game.phase == Phase::BallPlacement(Side::Ours)
    }

    /// Time for which this robot and an opponent have both been at a slow ball, s, regardless of changes of
    /// possession.
    pub fn disputed(&self) -> f32 {
        self.handling.dispute
    }

    /// Position of a held ball: at the dribbler opening.
    pub fn dribbler_point(&self) -> Point<Field> {
        self.pose.position + Vector::polar(BALL_AT, self.pose.heading)
    }

    pub(crate) fn dispute(&mut self, now: Instant) {
        let both = self.ball.is_some_and(|ball| {
            let opponent = self.nearest_opponent(ball.position).is_some_and(|(_, off)| off < AT_BALL);
            opponent
                && self.pose.position.distance(ball.position) < AT_BALL
                && ball.velocity.norm() < STUCK_SPEED_MAX
        });
        self.handling.disputed = both.then_some(self.handling.disputed.unwrap_or(now));
        self.handling.dispute = self.handling.disputed.map_or(0.0, |since| now.since(since).as_secs_f32());
    }

    fn handle(&mut self, now: Instant, contact: bool) {
        self.dispute(now);
        self.handling.contact = contact;
        if contact {
            self.handling.touched = Some(now);
        }
        let received = self.ball.map(|ball| ball.position);
        let contradicts = received.is_some_and(|at| {
            if contact {
                self.pose.position.distance(at) > BEAM_ENDS
            } else {
                let seen = self.pose.to_body(at);
                !self.ball_flies()
                    && seen.x() < BALL_AT
                    && seen.x() > FRONT
                    && seen.y().abs() < BEAM_HALF_WIDTH
            }
        });
        let handling = &mut self.handling;
        handling.contradicted = contradicts.then_some(handling.contradicted.unwrap_or(now));
        let at_dribbler = received.is_some_and(|at| is_at_dribbler(self.pose, at));
        let recent = self.handling.touched.is_some_and(|last| now.since(last) <= BRIDGED);
        self.holds_ball = contact || (recent && at_dribbler);
        let dribbler_point = self.dribbler_point();
        if self.holds_ball {
            self.handling.from.get_or_insert(dribbler_point);
            let since = *self.handling.since.get_or_insert(now);
            self.handling.held = now.since(since).as_secs_f32();
            // A ball that the break-beam sensor sees is at the opening; cameras report it later.
            if contact {
                self.ball = Some(BelievedBall {
                    position: dribbler_point,
                    velocity: self.velocity,
                    rest: dribbler_point,
                });
            }
        } else if received.is_none_or(|at| at.distance(dribbler_point) > VISIBLE_GAP) {
            (self.handling.from, self.handling.since, self.handling.held) = (None, None, 0.0);
            self.resolved = None;
        }
    }
}

/// A ball that rolls freely, its path cut just beyond the lines; whether it still slides is unknown.
fn rolling(position: Point<Field>, velocity: Vector<Field>, field: &FieldSpec) -> BelievedBall {
    let rest = BallModel::default().rolling(position, velocity).rest();
    let offset = rest - position;
    // The share of the path that stays between two lines; 1 for a ball that is outside already.
    let share = |at: f32, by: f32, line: f32| {
        let (line, at) = (line + BEYOND_LINES_M, if by < 0.0 { -at } else { at });
        if at < line && at + by.abs() > line { (line - at) / by.abs() } else { 1.0 }
    };
    let inside = share(position.x(), offset.x(), 0.5 * field.length).min(share(
        position.y(),
        offset.y(),
        0.5 * field.width,
    ));
    BelievedBall { position, velocity, rest: position + offset * inside }
}

/// Whether the ball is in front of the flat front, within the noise of the snapshot.
fn is_at_dribbler(pose: Pose<Field>, ball: Point<Field>) -> bool {
    let seen = pose.to_body(ball);
    (FRONT - 0.01..BALL_AT + AT_DRIBBLER_AHEAD).contains(&seen.x()) && seen.y().abs() < AT_DRIBBLER_BESIDE
}

/// The ball's path is cut this far beyond the lines, m: a ball on the line is still in the field.
const BEYOND_LINES_M: f32 = 0.1;
/// The break-beam sensor may miss the ball for at most this time: a few turns of the ball on the roller.
const BRIDGED: Duration = Duration::millis(60);
/// A robot whose centre is this near the ball is at it, m: half a body more than where it touches.
const AT_BALL: f32 = 0.2;
/// A faster ball is not stuck between two robots, m/s.
const STUCK_SPEED_MAX: f32 = 0.5;
/// Ball and break-beam sensor contradict each other for this time before the sensor is doubted: five times
/// the host's delay of 0.1 s (estimate; judged in matches).
const CONTRADICTED_FOR: Duration = Duration::millis(500);
/// No ball whose centre is this far from the robot's interrupts the beam, m: almost five diameters of a ball
/// before the dribbler opening.
const BEAM_ENDS: f32 = BALL_AT + 0.2;
/// A ball this far beside the middle interrupts the beam certainly, m: a dribbler opening of 35 mm reaches
/// 17 mm to each side, less vision's noise.
const BEAM_HALF_WIDTH: f32 = 0.015;
/// A gap between ball and dribbler opening that counts as visible by the rules, m.
const VISIBLE_GAP: f32 = 0.05;
/// How far before the roller the host may show a ball that is held, m: noise, and 30 ms of its delay.
const AT_DRIBBLER_AHEAD: f32 = 0.03;
/// How far beside the middle, m: half the width of the opening.
const AT_DRIBBLER_BESIDE: f32 = 0.05;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::belief::Belief;
    use geometry::Twist;
    use protocol::RobotId;
    use protocol::host::{WireBall, WorldPart};
    use protocol::quantized::{WirePoint, WirePose};
    use protocol::robot_io::Health;
    use rules::{League, Phase};

    fn sensors(ball_contact: bool) -> SensorFrame {
        SensorFrame {
            pose: None,
            ball: None,
            opponents: heapless::Vec::new(),
            ball_contact,
            busy: false,
            odometry: Twist::default(),
            health: Health::default(),
            camera: None,
        }
    }

    fn snapshot(now: Instant, ball: (i16, i16)) -> HostSnapshot {
        let me = RobotId::new(1).unwrap();
        let mut snapshot = HostSnapshot::new(me);
        let who = protocol::host::WireWho { side: Side::Ours, id: me };
        let own = protocol::host::WireRobot { who, pose: WirePose::default(), vx: 0, vy: 0 };
        snapshot.handle_part(
            now,
            &WorldPart {
                snapshot: 1,
                part: 0,
                parts: 1,
                phase: Phase::Run,
                placement: None,
                ball: Some(WireBall { at: WirePoint { x: ball.0, y: ball.1 }, height: 0, vx: 0, vy: 0 }),
                robots: [own].into_iter().collect(),
            },
        );
        snapshot
    }

    #[test]
    fn break_beam_flicker_is_bridged_while_the_ball_is_seen_at_the_dribbler() {
        let mut belief = Belief::new(League::DivisionB);
        belief.show(Instant(0), &snapshot(Instant(0), (95, 0)), &sensors(true));
        assert!(belief.holds_ball && belief.contact());
        let later = Instant(50_000);
        belief.show(later, &snapshot(later, (110, 0)), &sensors(false));
        assert!(belief.holds_ball && !belief.contact());
        belief.show(later, &snapshot(later, (160, 0)), &sensors(false));
        assert!(!belief.holds_ball, "seen away from the dribbler");
        let long = Instant(70_000);
        belief.show(long, &snapshot(long, (95, 0)), &sensors(false));
        assert!(!belief.holds_ball, "missed for too long");
    }

    #[test]
    fn the_way_of_a_ball_ends_just_beyond_the_line_it_crosses() {
        let field = League::DivisionB.field();
        // 3 m/s would roll 12.9 m; the goal line is at 4.5 m.
        let out = rolling(Point::new(0.0, 0.0), Vector::new(-3.0, 0.0), &field);
        assert!((out.rest.x() + 4.6).abs() < 1e-4 && out.rest.y() == 0.0, "{:?}", out.rest);
        let aslant = rolling(Point::new(0.0, 2.0), Vector::new(2.0, 2.0), &field);
        assert!((aslant.rest.y() - 3.1).abs() < 1e-4 && (aslant.rest.x() - 1.1).abs() < 1e-4);
        let outside = rolling(Point::new(4.8, 0.0), Vector::new(0.7, 0.0), &field);
        assert!((outside.rest.x() - 5.5).abs() < 1e-4);
    }
}
