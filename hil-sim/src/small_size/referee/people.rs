//! What do people at the field do? They put the ball down where no robot can or may, and take robots off for cards.
//!
//! m, field frame.

use std::collections::VecDeque;

use geometry::{Field, Point, Pose};
use protocol::{Instant, Who};
use rules::{Colour, Phase, limits};

use super::event::What;
use super::observation::RobotSeen;
use super::scene::{COLOURS, is_running};
use super::{InternalReferee, micros};

/// Something a person does to the world, to be carried out at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WorldOrder {
    /// Put the ball down here, at rest.
    PutBall(Point<Field>),
    /// Take this robot off the carpet.
    RemoveRobot(Who),
    /// A card is over: put this robot back, beside the touch line of its own half.
    ReturnRobot(Who, Pose<Field>),
}

/// What people have been asked to do.
#[derive(Clone, Debug, Default)]
pub(super) struct People {
    pub(super) orders: VecDeque<WorldOrder>,
    /// How often the ball was put down in this stop, and when last.
    put: u32,
    put_at: Option<Instant>,
    /// Since when each team has too many robots, in the order of [`COLOURS`].
    crowded: [Option<Instant>; 2],
    /// When a robot of each team was last taken off or put back.
    changed: [Option<Instant>; 2],
}

impl People {
    pub(super) fn command_given(&mut self) {
        self.put = 0;
        self.put_at = None;
    }

    /// The ball was put down so often that it makes no sense to try again.
    pub(super) fn have_given_up(&self) -> bool {
        self.put >= PUTS_MAX
    }
}

impl InternalReferee {
    /// Has a person put the ball down in this stop?
    pub(super) fn put_by_hand(&self) -> bool {
        self.people.put > 0
    }

    /// Puts the ball down once there is time and room; true while it has still to be done.
    pub(super) fn put_ball(&mut self, robots: &[RobotSeen], target: Point<Field>) -> bool {
        let near = self.ball.position.distance(target) <= limits::PLACEMENT_TOLERANCE;
        if near && self.ball.speed() <= limits::BALL_STILL || self.people.have_given_up() {
            return false;
        }
        let begun = self.people.put_at.unwrap_or(Instant(self.state.since()));
        let waited = self.now.since(begun);
        let stands = |robot: &RobotSeen| robot.pose.position.distance(target) < limits::ROBOT_RADIUS + ROOM;
        let room = !robots.iter().any(stands);
        if waited >= self.settings.person_delay && (room || waited >= self.settings.patience) {
            self.people.orders.push_back(WorldOrder::PutBall(target));
            self.people.put += 1;
            self.people.put_at = Some(self.now);
            self.watch.ball_was_put_down();
        }
        true
    }

    /// Sees to it that no team has more robots than it may, and gives back those whose time is over.
    pub(super) fn keep_numbers(&mut self, robots: &[RobotSeen]) {
        for (index, team) in COLOURS.into_iter().enumerate() {
            let ours = || robots.iter().filter(|robot| robot.who.colour == team);
            let (on_field, allowed) = (self.on_field(robots, team), self.allowed_now(team));
            let just_changed =
                self.people.changed[index].is_some_and(|at| self.now.since(at).0 < CHANGE_TIME);
            if on_field <= allowed {
                self.people.crowded[index] = None;
                if on_field < allowed && self.phase() == Phase::Stop && !just_changed {
                    self.give_back(index, team);
                }
                continue;
            }
            let since = *self.people.crowded[index].get_or_insert(self.now);
            let running = is_running(self.phase());
            // Who has left the field for it is taken off while the others play on (rules: sanctions, substitution).
            let has_left = ours().find(|robot| self.may_be_taken(robot.pose.position)).map(|robot| robot.who);
            let in_the_way = running && has_left.is_none();
            let time = if in_the_way {
                micros(limits::CARD_REMOVAL_TIME)
            } else {
                self.settings.person_delay.0 as i64
            };
            if just_changed || (self.now.since(since).0 as i64) < time {
                continue;
            }
            let places = ours().map(|robot| (robot.who, robot.pose.position));
            let taken = has_left.or_else(|| self.whom_to_take(team, places));
            if in_the_way {
                let ball = self.ball.position;
                let what = What::TooManyRobots { allowed, on_field, ball };
                self.judge(&self.event(Some(team), what));
            }
            if let Some(who) = taken {
                self.people.orders.push_back(WorldOrder::RemoveRobot(who));
                self.accounts.of_mut(team).taken_off.push(who.id);
                self.people.changed[index] = Some(self.now);
            }
        }
    }

    /// How many robots of a team count: those outside its goal substitution area.
    pub(super) fn on_field(&self, robots: &[RobotSeen], team: Colour) -> u32 {
        let own = self.own_end(team);
        let counts =
            |robot: &&RobotSeen| robot.who.colour == team && self.field.counts(own, robot.pose.position);
        robots.iter().filter(counts).count() as u32
    }

    /// In the centre substitution area, beside the touch line, and the ball is not near.
    fn may_be_taken(&self, place: Point<Field>) -> bool {
        place.x().abs() <= limits::SUBSTITUTION_REACH
            && place.y().abs() > self.field.width * 0.5
            && place.distance(self.ball.position) >= SUBSTITUTION_OFF_BALL
    }

    /// The last offender; else the robot farthest from the ball. The keeper only where there is no other.
    fn whom_to_take(&self, team: Colour, ours: impl Iterator<Item = (Who, Point<Field>)>) -> Option<Who> {
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
        self.people.orders.push_back(WorldOrder::ReturnRobot(Who { colour: team, id }, pose));
        self.people.changed[index] = Some(self.now);
    }
}

/// Room a person needs to put the ball down, m from a robot's side: a hand's breadth.
const ROOM: f32 = 0.1;
/// A person reaches onto the carpet only while the ball is at least this far away, m (rules: substitution).
const SUBSTITUTION_OFF_BALL: f32 = 0.5;
/// Tries after which the game goes on with the ball where it is: three, as nobody carries out the order.
const PUTS_MAX: u32 = 3;
/// Time in which a robot is taken off or put back, µs: two seconds, the game controller's tolerance in counting robots.
const CHANGE_TIME: u64 = 2_000_000;
