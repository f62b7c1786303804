//! `hand`: one robot driven by hand: body speeds, dribbler and kick, which end 100 ms after the last order.
//! m, m/s, rad/s, attack frame.
//!
//! The protocol has places, not speeds: the target lies as far ahead as the robot needs to brake from the
//! ordered speed. So it drives at that speed, around obstacles, and stops there by itself if no more comes.

use geometry::{Angle, Attack, Point, Vector};
use protocol::host::KickOrder;
use protocol::{Duration, Instant, RobotId};
use rules::RobotSpec;

use super::{TestOrder, TestRefused};
use crate::strategy::view::ViewRobot;
use crate::strategy::{Task, View};

/// An order holds for this time: three orders of the page, which sends 30 a second, may be late.
pub const HAND_EXPIRY: Duration = Duration::millis(100);
/// Fastest drive, m/s: a person follows it with the eyes; robots reach 3.
pub const SPEED_MAX_M_S: f32 = 2.0;
/// Fastest turn, rad/s: likewise; robots reach 8.
pub const TURN_MAX_RAD_S: f32 = 6.0;
/// Slowest kick, m/s: slower ones look like a touch.
pub const KICK_MIN_M_S: f32 = 1.0;
/// From the camera frame to the wheels, s: measured in the simulator, so that 0.2 to 2 m/s are driven within
/// 2 %.
const LEAD_S: f32 = 0.013;
/// A ball within this distance of the dribbler is taken by a robot whose dribbler is on, m.
const TAKES_WITHIN_M: f32 = 0.3;
/// A ball within this distance of the dribbler is kicked, m: a ball's diameter.
const KICKS_WITHIN_M: f32 = 0.043;
/// A kick aims so far ahead, m: the direction of the front.
const AHEAD_M: f32 = 2.0;

/// The robot that is driven, and its newest order.
#[derive(Clone, Debug)]
pub(super) struct Hand {
    pub(super) robot: RobotId,
    velocity: [f32; 3],
    dribbler: bool,
    kick: Option<f32>,
    /// When the order ends; none: it has ended.
    until: Option<Instant>,
}

impl Hand {
    /// From an order to drive; none: another order.
    pub(super) fn of(order: TestOrder, now: Instant) -> Option<Self> {
        let TestOrder::Drive { robot, velocity, dribbler, kick } = order else { return None };
        let rests = velocity == [0.0; 3] && !dribbler && kick.is_none();
        let until = (!rests).then_some(now + HAND_EXPIRY);
        Some(Self { robot: RobotId::new(robot)?, velocity, dribbler, kick, until })
    }

    /// When the order ends, while it has not.
    pub(super) fn until(&self) -> Option<Instant> {
        self.until
    }

    /// Ends an order that is too old; true where it has ended now.
    pub(super) fn expire(&mut self, now: Instant) -> bool {
        self.until.take_if(|until| *until <= now).is_some()
    }

    /// The robot's task; none: it stands, and so do all others.
    pub(super) fn task(&self, view: &View) -> Option<Task> {
        self.until.filter(|until| view.now < *until)?;
        let robot = view.our(self.robot)?;
        let front = Vector::polar(RobotSpec::OURS.hull.ball_at(), robot.heading);
        let gap = view.ball.map_or(f32::INFINITY, |ball| ball.position.distance(robot.position + front));
        let holds = view.contact.has(self.robot);
        let ahead = robot.position + Vector::polar(AHEAD_M, robot.heading);
        if let Some(speed) = self.kick.filter(|_| holds || gap < KICKS_WITHIN_M) {
            return Some(Task::Kick { at: ahead, kick: KickOrder::Flat((speed * 100.0) as u16) });
        }
        if self.dribbler && !holds && gap < TAKES_WITHIN_M {
            return Some(Task::GetBall { face: ahead });
        }
        let (at, face) = self.target(robot, holds);
        Some(if self.dribbler && holds { Task::Dribble { at, face } } else { Task::GoTo { at, face } })
    }

    /// Where the robot comes to rest if the order ends now.
    fn target(&self, robot: &ViewRobot, holds: bool) -> (Point<Attack>, Angle) {
        let spec = &RobotSpec::OURS;
        let (drive, turn) =
            if holds { (&spec.plan_holding, &spec.turn_holding) } else { (&spec.plan, &spec.turn) };
        let [forwards, left, rate] = self.velocity;
        let along = Vector::<Attack>::new(forwards, left).clamped(SPEED_MAX_M_S).rotated(robot.heading);
        let at = robot.position + along * (along.norm() / (2.0 * drive.braking) + LEAD_S);
        let turned = rate * (rate.abs() / (2.0 * turn.acceleration) + LEAD_S);
        (at, robot.heading + Angle::new(turned))
    }
}

/// Whether these numbers are driven.
pub(super) fn check(velocity: [f32; 3], kick: Option<f32>) -> Result<(), TestRefused> {
    let [forwards, left, rate] = velocity.map(f32::abs);
    let kicks = KICK_MIN_M_S..=RobotSpec::OURS.kicker.fastest;
    if !(forwards.max(left) <= SPEED_MAX_M_S && rate <= TURN_MAX_RAD_S) {
        Err(TestRefused::Speed)
    } else if kick.is_some_and(|speed| !kicks.contains(&speed)) {
        Err(TestRefused::KickSpeed)
    } else {
        Ok(())
    }
}
