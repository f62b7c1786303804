//! `hosted`: what the host has sent, its age, and what follows for this robot: snapshot, command, phase,
//! double touch.
//!
//! A directive is held until the next one, and stale after 100 ms without a command (the governor's
//! [`SILENCE`]); the phase is that of the newest frame. A frame counts as received on arrival if it is at
//! most [`LATENCY_MAX`] old, and earlier by its excess age otherwise (`received_at`).

use geometry::{Field, Point};
use protocol::host::{Directive, DriveLimits, HostCommand, HostMessage, RuleRole};
use protocol::robot_io::SensorFrame;
use protocol::{Duration, Instant, RobotId};
use rules::{Phase, Side, contact};

use crate::belief::{Belief, BelievedGame, DriveCap};
use crate::governor::{Hearing, LATENCY_MAX, SILENCE};
use crate::snapshot::{HostSnapshot, Taken};

/// A robot's view of its host, from the frames received.
#[derive(Clone, Debug)]
pub struct Hosted {
    me: RobotId,
    snapshot: HostSnapshot,
    command: Option<(Instant, HostCommand)>,
    frame: Option<Instant>,
    /// Arrival of the last frame, of any age.
    arrived: Option<Instant>,
    phase: Option<Phase<Side>>,
    limits: Option<DriveLimits>,
    restart: Restart,
}

/// Touch state of our restart (rules 2026: the kicker touches the ball once, until another robot has).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Restart {
    /// No restart of ours with a touch.
    #[default]
    None,
    /// This robot has touched the ball as the kicker of the restart; the ball lay here.
    Touched(Point<Field>),
    /// The ball has moved away from it: no second touch before another robot's.
    DoubleTouchBlocked,
}

/// Age of the own pose from which on a snapshot is opened whatever else a step has to do: three frames of 100
/// Hz.
const OWN_POSE_AGE_MAX: Duration = Duration::millis(30);

impl Hosted {
    /// The state of robot `me` before any frame of a host.
    pub fn new(me: RobotId) -> Self {
        Self {
            me,
            snapshot: HostSnapshot::new(me),
            command: None,
            frame: None,
            arrived: None,
            phase: None,
            limits: None,
            restart: Restart::None,
        }
    }

    /// Handles a message of the host that was sent at most `age` ago. Returns when it counts as received, if
    /// it was for this robot, and new.
    pub fn handle(&mut self, now: Instant, age: Duration, message: &HostMessage) -> Option<Instant> {
        let received = received_at(now, age);
        match message {
            HostMessage::World(part) => match self.snapshot.handle_part(now, part) {
                Taken::Begun | Taken::More => self.phase = Some(part.phase),
                Taken::Doubled | Taken::Late | Taken::Malformed => return None,
            },
            HostMessage::Command(command) => {
                if command.to != self.me {
                    return None;
                }
                self.phase = Some(command.phase);
                self.command = Some((
                    self.command.as_ref().map_or(received, |(last, _)| received.max(*last)),
                    command.clone(),
                ));
            }
            HostMessage::Limits(limits) => {
                if limits.to != self.me {
                    return None;
                }
                self.limits = Some(*limits);
            }
            HostMessage::Welcome(_) => {}
        }
        self.arrived = Some(now);
        self.frame = Some(self.frame.map_or(received, |last| received.max(last)));
        self.frame
    }

    /// Another host than before has welcomed this robot: its snapshots have numbers of their own, and the
    /// limits of the one before no longer hold.
    pub fn restart(&mut self) {
        self.limits = None;
        self.snapshot.restart();
    }

    /// Carries the snapshot forward by what the wheels measured, and copies it into `belief`.
    pub fn see(&mut self, now: Instant, sensors: &SensorFrame, belief: &mut Belief) {
        self.snapshot.handle_odometry(now, sensors.odometry);
        belief.show(now, &self.snapshot, sensors);
        let rule_role = self.command.as_ref().map_or(RuleRole::Player, |(_, command)| command.rule_role);
        let defending = self.command.as_ref().map_or(belief.game.defending, |(_, command)| command.defending);
        // A robot without a received phase does nothing.
        let phase = self.phase.unwrap_or(Phase::Halt);
        self.watch_touches(phase, rule_role, belief);
        belief.game = BelievedGame {
            phase,
            placement: self.snapshot.placement(),
            rule_role,
            defending,
            double_touch_blocked: self.restart == Restart::DoubleTouchBlocked,
        };
        belief.drive_cap = self.limits.as_ref().map_or_else(DriveCap::default, DriveCap::of);
    }

    /// Whether the own pose is so old that the next snapshot matters more than a plan.
    pub fn needs_snapshot(&self, now: Instant) -> bool {
        self.snapshot.own_age(now).is_none_or(|age| age > OWN_POSE_AGE_MAX)
    }

    /// Number of parts of the newest snapshot; `None` before the first.
    pub fn parts_of_snapshot(&self) -> Option<u8> {
        self.snapshot.parts_sent()
    }

    /// The directive, while it is fresh.
    pub fn directive(&self, now: Instant) -> Option<&Directive> {
        let (at, command) = self.command.as_ref()?;
        (now.since(*at) < SILENCE).then_some(&command.directive)
    }

    /// The phase of the newest frame.
    pub fn phase(&self) -> Option<Phase<Side>> {
        self.phase
    }

    /// Arrival of the last frame, of any age.
    pub fn arrived(&self) -> Option<Instant> {
        self.arrived
    }

    /// When the last frame and command count as received.
    pub fn hearing(&self) -> Hearing {
        Hearing { frame: self.frame, command: self.command.as_ref().map(|(at, _)| *at) }
    }

    /// Whether the host's snapshot has a current pose of this robot.
    pub fn shows_me(&self, now: Instant) -> bool {
        self.snapshot.own(now).is_some()
    }

    fn watch_touches(&mut self, phase: Phase<Side>, rule_role: RuleRole, belief: &Belief) {
        let others_touch = || {
            belief.ball.is_some_and(|ball| {
                belief
                    .others
                    .iter()
                    .any(|other| other.pose.position.distance(ball.position) < contact::TOUCHES_WITHIN)
            })
        };
        let ours = matches!(phase, Phase::FreeKick(Side::Ours) | Phase::Kickoff(Side::Ours))
            && rule_role == RuleRole::Kicker;
        self.restart = match (phase, self.restart) {
            (Phase::Run, Restart::Touched(_)) if belief.contact() => self.restart,
            (Phase::Run, Restart::Touched(_)) => Restart::DoubleTouchBlocked,
            (Phase::Run, Restart::DoubleTouchBlocked) if others_touch() => Restart::None,
            (Phase::Run, same) => same,
            (_, Restart::None) if ours && belief.contact() => {
                belief.ball.map_or(Restart::None, |ball| Restart::Touched(ball.position))
            }
            // Before the ball is in play it may be touched again: contact at the break-beam sensor alone has
            // not moved it.
            (_, Restart::Touched(lay)) if ours && !belief.contact() && gone(belief, lay) => {
                Restart::DoubleTouchBlocked
            }
            (_, Restart::Touched(_) | Restart::DoubleTouchBlocked) if ours => self.restart,
            _ => Restart::None,
        };
    }
}

/// When a frame of that age counts as received.
fn received_at(now: Instant, age: Duration) -> Instant {
    now - Duration(age.0.saturating_sub(LATENCY_MAX.0))
}

/// Whether the ball has left its place `lay`.
fn gone(belief: &Belief, lay: Point<Field>) -> bool {
    belief.ball.is_none_or(|ball| ball.position.distance(lay) > RESTART_BALL_MOVED_M)
}

/// The ball has left, m: in play after 0.05 m by the rules, and the dribbler that located it errs by a
/// centimetre.
const RESTART_BALL_MOVED_M: f32 = 0.06;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::belief::{BelievedBall, Other};
    use geometry::{Point, Pose, Twist, Vector};
    use protocol::robot_io::Health;
    use rules::League;

    fn id(n: u8) -> RobotId {
        RobotId::new(n).unwrap()
    }

    fn command(to: u8, directive: Directive) -> HostMessage {
        HostMessage::Command(HostCommand {
            to: id(to),
            defending: geometry::GoalEnd::Negative,
            phase: Phase::Run,
            rule_role: RuleRole::Player,
            directive,
        })
    }

    #[test]
    fn a_command_for_another_robot_is_ignored_and_ones_own_is_stale_after_100_ms() {
        let mut hosted = Hosted::new(id(3));
        assert_eq!(hosted.handle(Instant(0), Duration(0), &command(4, Directive::Stand)), None);
        assert_eq!(
            (hosted.directive(Instant(0)), hosted.phase(), hosted.hearing().frame),
            (None, None, None)
        );
        let get = command(3, Directive::GetBall { face: None });
        assert_eq!(hosted.handle(Instant(1_000), Duration(0), &get), Some(Instant(1_000)));
        assert!(hosted.directive(Instant(100_999)).is_some());
        assert_eq!(hosted.directive(Instant(101_000)), None);
    }

    #[test]
    fn drive_limits_hold_until_new_ones_or_another_host_come_others_limits_are_ignored() {
        let mut hosted = Hosted::new(id(3));
        let mut belief = Belief::new(League::DivisionB);
        let sensors = nothing();
        let limits =
            |to, speed, acceleration| HostMessage::Limits(DriveLimits { to: id(to), speed, acceleration });
        let mut cap = |hosted: &mut Hosted| {
            hosted.see(Instant(0), &sensors, &mut belief);
            (belief.drive_cap.speed, belief.drive_cap.acceleration)
        };
        assert_eq!(hosted.handle(Instant(0), Duration(0), &limits(4, 400, 600)), None);
        assert_eq!(cap(&mut hosted), (f32::INFINITY, f32::INFINITY));
        hosted.handle(Instant(0), Duration(0), &limits(3, 1500, DriveLimits::NONE));
        assert_eq!(cap(&mut hosted), (1.5, f32::INFINITY));
        hosted.handle(Instant(1), Duration(0), &limits(3, DriveLimits::NONE, 2000));
        assert_eq!(cap(&mut hosted), (f32::INFINITY, 2.0));
        hosted.restart();
        assert_eq!(cap(&mut hosted), (f32::INFINITY, f32::INFINITY));
    }

    #[test]
    fn a_command_that_was_long_on_its_way_is_stale_200_ms_after_it_was_sent() {
        for (age_ms, fresh_for_ms) in [(0, 100), (100, 100), (120, 80), (150, 50), (199, 1)] {
            let mut hosted = Hosted::new(id(3));
            let came = Instant(5_000_000);
            hosted.handle(came, Duration::millis(age_ms), &command(3, Directive::Stand));
            let until = came + Duration::millis(fresh_for_ms);
            assert!(hosted.directive(until - Duration(1)).is_some(), "{age_ms} ms old");
            assert_eq!(hosted.directive(until), None, "{age_ms} ms old");
            assert_eq!(hosted.arrived(), Some(came));
        }
    }

    fn nothing() -> SensorFrame {
        SensorFrame {
            pose: None,
            ball: None,
            opponents: heapless::Vec::new(),
            ball_contact: false,
            busy: false,
            odometry: Twist::default(),
            health: Health::default(),
            camera: None,
        }
    }

    fn with_ball(x: f32) -> Belief {
        let mut belief = Belief::new(League::DivisionB);
        let at = Point::new(x, 0.0);
        belief.ball = Some(BelievedBall { position: at, velocity: Vector::default(), rest: at });
        belief
    }

    #[test]
    fn the_kicker_of_our_free_kick_may_not_touch_the_ball_again_before_another_robot() {
        let mut hosted = Hosted::new(id(3));
        let mut held = with_ball(0.0);
        let sensors = SensorFrame { ball_contact: true, ..nothing() };
        held.show(Instant(0), &HostSnapshot::new(id(3)), &sensors);
        let free_kick = Phase::FreeKick(Side::Ours);
        hosted.watch_touches(free_kick, RuleRole::Player, &held);
        assert_eq!(hosted.restart, Restart::None, "only the taker's touch counts");
        hosted.watch_touches(free_kick, RuleRole::Kicker, &held);
        assert!(matches!(hosted.restart, Restart::Touched(_)));
        hosted.watch_touches(free_kick, RuleRole::Kicker, &with_ball(0.5));
        assert_eq!(hosted.restart, Restart::DoubleTouchBlocked);
        hosted.watch_touches(Phase::Run, RuleRole::Player, &with_ball(1.0));
        assert_eq!(hosted.restart, Restart::DoubleTouchBlocked, "in play it may still not");
        let mut teammate_has_it = with_ball(1.0);
        let pose = Pose { position: Point::new(1.1, 0.0), ..Pose::default() };
        let other = Other { side: Side::Theirs, id: id(1), pose, velocity: Vector::default() };
        let _ = teammate_has_it.others.push(other);
        hosted.watch_touches(Phase::Run, RuleRole::Player, &teammate_has_it);
        assert_eq!(hosted.restart, Restart::None);
    }

    #[test]
    fn a_stop_ends_the_bar() {
        let mut hosted = Hosted { restart: Restart::DoubleTouchBlocked, ..Hosted::new(id(3)) };
        hosted.watch_touches(Phase::Stop, RuleRole::Kicker, &with_ball(1.0));
        assert_eq!(hosted.restart, Restart::None);
    }
}
