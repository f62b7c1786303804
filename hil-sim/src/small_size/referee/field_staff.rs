//! `field_staff`: manual acts at the field. The ball is placed by hand where no robot can or may, and robots
//! are taken off for cards where the rules permit: in a substitution area, or in a halt.
//!
//! m, field frame.

use std::collections::VecDeque;

use geometry::{Field, Point, Pose};
use protocol::{Instant, Who};
use rules::{Colour, Phase, limits};

use super::event::{Restart, What};
use super::observation::RobotSeen;
use super::scene::is_running;
use super::{InternalReferee, micros};

/// A manual act, to be carried out at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WorldOrder {
    /// Place the resting ball here.
    PutBall(Point<Field>),
    /// Take this robot off the field: it is in a substitution area, or the game is halted for it.
    RemoveRobot(Who),
    /// Place this robot of a team that does not drive there, in a halt.
    CarryRobot(Who, Pose<Field>),
    /// A card has expired: place this robot beside the touch line of its own half.
    ReturnRobot(Who, Pose<Field>),
}

/// Manual acts that wait to be carried out, with the times that they depend on.
#[derive(Clone, Debug, Default)]
pub(super) struct FieldStaff {
    pub(super) orders: VecDeque<WorldOrder>,
    /// Time of the last manual placement in this stop.
    put_at: Option<Instant>,
    /// Playing time for which each team has had too many robots, in the order of [`Colour::ALL`], µs.
    crowded: [u64; 2],
    /// True while the game is halted for a manual act.
    pub(super) called: bool,
    /// Time at which a robot of each team was last taken off or returned.
    changed: [Option<Instant>; 2],
}

impl FieldStaff {
    pub(super) fn command_given(&mut self) {
        self.put_at = None;
    }
}

impl InternalReferee {
    /// True where the ball was placed by hand in this stop.
    pub(super) fn put_by_hand(&self) -> bool {
        self.field_staff.put_at.is_some()
    }

    /// Places the ball once there is time and room; true while that is still to be done.
    pub(super) fn put_ball(&mut self, robots: &[RobotSeen], target: Point<Field>) -> bool {
        let near = self.ball.position.distance(target) <= limits::PLACEMENT_TOLERANCE;
        if near && self.ball.speed() <= limits::BALL_STILL {
            return false;
        }
        let begun = self.field_staff.put_at.unwrap_or(Instant(self.state.since()));
        let waited = self.now.since(begun);
        let near = limits::ROBOT_RADIUS + PLACEMENT_ROOM;
        let room = robots.iter().all(|robot| robot.pose.position.distance(target) >= near);
        if waited >= self.settings.person_delay && (room || waited >= self.settings.patience) {
            self.field_staff.orders.push_back(WorldOrder::PutBall(target));
            self.field_staff.put_at = Some(self.now);
            self.watch.ball_was_put_down();
        }
        true
    }

    /// Takes off surplus robots of a team, and returns those whose cards have expired.
    pub(super) fn keep_numbers(&mut self, robots: &[RobotSeen], passed_us: u64) {
        for (index, team) in Colour::ALL.into_iter().enumerate() {
            let ours = || robots.iter().filter(|robot| robot.who.colour == team);
            let (on_field, allowed) = (self.on_field(robots, team), self.allowed_now(team));
            let just_changed =
                self.field_staff.changed[index].is_some_and(|at| self.now.since(at).0 < CHANGE_TIME);
            // A robot in the strip is not behind the ball at a penalty: the controller would wait for ever.
            let penalty = self.next == Some(Restart::Penalty(team.other())) && self.phase() == Phase::Stop;
            let in_strip = ours().find(|robot| !self.counts(robot)).map(|robot| robot.who);
            if let Some(who) = in_strip.filter(|_| penalty && !just_changed) {
                self.take_off(who);
                self.field_staff.changed[index] = Some(self.now);
                continue;
            }
            if on_field <= allowed {
                self.field_staff.crowded[index] = 0;
                let room = (ours().count() as u32) < allowed;
                if room && self.phase() == Phase::Stop && !just_changed {
                    self.give_back(index, team);
                }
                continue;
            }
            // A robot that has left the field for it is taken off during play (rules: sanctions,
            // substitution).
            let has_left = ours().find(|robot| self.may_be_taken(robot.pose.position)).map(|robot| robot.who);
            let open = !matches!(self.phase(), Phase::Halt | Phase::Timeout(_));
            if let Some(who) = has_left.filter(|_| open && !just_changed) {
                self.take_off(who);
                self.field_staff.changed[index] = Some(self.now);
                continue;
            }
            if !is_running(self.phase()) {
                continue;
            }
            let crowded = &mut self.field_staff.crowded[index];
            *crowded += passed_us;
            if *crowded as i64 >= micros(limits::CARD_REMOVAL_TIME) {
                // Again after the controller's two seconds, where it continues although there are still too
                // many.
                *crowded -= CHANGE_TIME;
                let ball = self.ball.position;
                let what = What::TooManyRobots { allowed, on_field, ball };
                self.judge(&self.event(Some(team), what));
            }
        }
    }

    pub(super) fn take_off(&mut self, who: Who) {
        self.field_staff.orders.push_back(WorldOrder::RemoveRobot(who));
        self.metrics.taken_off += 1;
        self.accounts.of_mut(who.colour).taken_off.push(who.id);
    }

    /// Number of a team's robots that count: those outside its goal substitution area.
    pub(super) fn on_field(&self, robots: &[RobotSeen], team: Colour) -> u32 {
        let own = self.own_end(team);
        let counts =
            |robot: &&RobotSeen| robot.who.colour == team && self.field.counts(own, robot.pose.position);
        robots.iter().filter(counts).count() as u32
    }

    /// In the centre substitution area, beside the touch line, with the ball not near.
    fn may_be_taken(&self, place: Point<Field>) -> bool {
        place.x().abs() <= limits::SUBSTITUTION_REACH
            && place.y().abs() > self.field.width * 0.5
            && place.distance(self.ball.position) >= limits::SUBSTITUTION_BALL_DISTANCE
    }

    /// The last offender; else the robot farthest from the ball. The keeper only where there is no other
    /// robot.
    pub(super) fn whom_to_take(
        &self,
        team: Colour,
        ours: impl Iterator<Item = (Who, Point<Field>)>,
    ) -> Option<Who> {
        let account = self.accounts.of(team);
        let worth = |(who, place): &(Who, Point<Field>)| {
            let keeper = who.id == account.keeper;
            let offender = account.last_offender == Some(who.id);
            (!keeper, offender, place.distance(self.ball.position))
        };
        ours.max_by(|a, b| {
            let ((a1, a2, a3), (b1, b2, b3)) = (worth(a), worth(b));
            (a1, a2).cmp(&(b1, b2)).then(a3.total_cmp(&b3)).then(b.0.cmp(&a.0))
        })
        .map(|(who, _)| who)
    }

    fn give_back(&mut self, index: usize, team: Colour) {
        let Some(id) = self.accounts.of_mut(team).taken_off.pop() else { return };
        let side = self.own_end(team).sign() as f32;
        let place = Point::new(
            side * limits::SUBSTITUTION_REACH * 0.5,
            self.field.width * 0.5 + self.field.margin * 0.5,
        );
        let pose = Pose { position: place, heading: place.direction_to(Point::new(0.0, 0.0)) };
        self.field_staff.orders.push_back(WorldOrder::ReturnRobot(Who { colour: team, id }, pose));
        self.field_staff.changed[index] = Some(self.now);
    }
}

/// Minimum distance from a robot's side, m, for placing the ball by hand: a hand's breadth.
const PLACEMENT_ROOM: f32 = 0.1;
/// Time for taking off or returning a robot, µs: two seconds, the game controller's tolerance in counting
/// robots.
const CHANGE_TIME: u64 = 2_000_000;
