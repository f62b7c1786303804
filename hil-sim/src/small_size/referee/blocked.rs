//! `blocked`: detects that the match cannot continue, since when and why, and gives the manual acts that
//! resolve it. s, field frame.
//!
//! The game controller waits for ever. The rules allow few manual acts: stop a preparation whose ball is
//! displaced and place the ball by hand, and in a halt take out a team's surplus robots, or move those of a
//! team whose robots do not drive.

use geometry::{GoalEnd, Point, Pose};
use protocol::{Duration, Instant, Who};
use rules::restart::kickoff_places;
use rules::state::RefereeCommand;
use rules::{Colour, Phase, limits};

use super::InternalReferee;
use super::event::{RefereeEvent, Restart, What};
use super::field_staff::WorldOrder;
use super::observation::RobotSeen;
use super::ready::ReadyObstacle;
use super::reason::Reason;

/// A match that could not continue although enough time had passed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blocked {
    /// Since when an obstacle prevents it.
    pub since: Instant,
    /// Duration so far, or in total.
    pub lasted: Duration,
    /// Phase in which the match is blocked.
    pub phase: Phase<Colour>,
    /// The present or last obstacle.
    pub obstacle: ReadyObstacle,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Waiting {
    /// Since when there is an obstacle.
    since: Option<Instant>,
    /// True once the wait exceeded the patience and was reported.
    reported: bool,
}

impl InternalReferee {
    /// The obstacle that has blocked the match for longer than `patience`, while it does.
    pub fn blocked(&self) -> Option<&Blocked> {
        self.metrics.blocks.last().filter(|_| self.waiting.reported)
    }

    pub(super) fn wait_ends(&mut self) {
        self.waiting = Waiting::default();
    }

    /// Continues with `command` when there has been no obstacle for `preparation`; waits without a time limit
    /// while there is one.
    pub(super) fn go_on_when_clear(
        &mut self,
        robots: &[RobotSeen],
        obstacles: &[ReadyObstacle],
        preparation: Duration,
        command: RefereeCommand,
    ) {
        let Some(first) = obstacles.first() else {
            self.wait_ends();
            let since = *self.ready_since.get_or_insert(self.now);
            if self.now.since(since) >= preparation {
                self.give(command);
            }
            return;
        };
        self.ready_since = None;
        if !self.wait_for(robots, first) {
            return;
        }
        if self.phase() != Phase::Stop && first.reason.is_balls() {
            // The game is stopped manually, so that the ball can be placed by hand.
            self.give(RefereeCommand::Stop);
        } else if self.people_can_help(obstacles) {
            self.field_staff.called = true;
            self.give(RefereeCommand::Halt);
        }
    }

    /// Waits for this obstacle to go; true once it has lasted longer than the patience, which is reported.
    pub(super) fn wait_for(&mut self, robots: &[RobotSeen], first: &ReadyObstacle) -> bool {
        let since = *self.waiting.since.get_or_insert(self.now);
        let lasted = self.now.since(since);
        if lasted < self.settings.patience {
            return false;
        }
        let blocked = Blocked { since, lasted, phase: self.phase(), obstacle: *first };
        if let Some(last) = self.metrics.blocks.last_mut().filter(|_| self.waiting.reported) {
            *last = blocked;
        } else {
            self.waiting.reported = true;
            self.metrics.blocks.push(blocked);
            let place = first.who().and_then(|who| robots.iter().find(|robot| robot.who == who));
            let place = place.map_or(self.ball.position, |robot| robot.pose.position);
            let ReadyObstacle { team, robot, reason } = *first;
            self.judge(&RefereeEvent {
                at: self.now,
                by: team,
                robot,
                place,
                what: What::Blocked { reason },
            });
        }
        true
    }

    /// True where robot handlers could resolve an obstacle in a halt.
    fn people_can_help(&self, obstacles: &[ReadyObstacle]) -> bool {
        obstacles.iter().any(|obstacle| match (obstacle.reason, obstacle.team) {
            (Reason::TooManyRobots { .. }, _) => true,
            (_, Some(team)) => !self.settings.team(team).drives,
            _ => false,
        })
    }

    /// In a halt for that purpose, once robots must stand: takes out surplus robots and moves those that do
    /// not drive.
    pub(super) fn help(&mut self, robots: &[RobotSeen]) {
        let age = self.now.since(Instant(self.state.since())).as_secs_f32();
        if !self.field_staff.called || self.phase() != Phase::Halt || age < limits::GRACE {
            return;
        }
        self.field_staff.called = false;
        for team in Colour::ALL {
            let mut left: Vec<RobotSeen> = robots
                .iter()
                .copied()
                .filter(|robot| robot.who.colour == team && self.counts(robot))
                .collect();
            while left.len() as u32 > self.allowed_now(team) {
                let places = left.iter().map(|robot| (robot.who, robot.pose.position));
                let Some(who) = self.whom_to_take(team, places) else { break };
                left.retain(|robot| robot.who != who);
                self.take_off(who);
            }
        }
        self.carry(robots, &self.blamed(robots));
    }

    /// Robots of teams that do not drive which are obstacles to the next restart.
    fn blamed(&self, robots: &[RobotSeen]) -> Vec<Who> {
        let all = self.obstacles_to_come(robots);
        all.iter()
            .filter_map(ReadyObstacle::who)
            .filter(|who| !self.settings.team(who.colour).drives)
            .collect()
    }

    /// Obstacles in the coming stop and in the preparation after it.
    fn obstacles_to_come(&self, robots: &[RobotSeen]) -> Vec<ReadyObstacle> {
        let next = self.next.unwrap_or(Restart::ForceStart);
        let mut all = self.obstacles_in_stop(robots, next, self.placement.unwrap_or(self.ball.position));
        match next {
            Restart::Kickoff(team) => all.extend(self.obstacles_at_kickoff(robots, team)),
            Restart::Penalty(team) => all.extend(self.obstacles_at_penalty(robots, team)),
            _ => {}
        }
        all
    }

    /// Between the halves, robots that do not drive are moved by hand to their own half.
    pub(super) fn carry_over(&mut self, robots: &[RobotSeen]) {
        let stand = robots.iter().map(|robot| robot.who);
        let stand = stand.filter(|who| !self.settings.team(who.colour).drives).collect::<Vec<_>>();
        self.carry(robots, &stand);
    }

    /// Moves these robots to positions where they are no obstacle to the next restart.
    fn carry(&mut self, robots: &[RobotSeen], whom: &[Who]) {
        let mut robots = robots.to_vec();
        for who in whom {
            let Some(index) = robots.iter().position(|robot| robot.who == *who) else { continue };
            let own = self.own_end(who.colour);
            let ends: [GoalEnd; 2] = [own, own.opposite()];
            let places = ends.into_iter().flat_map(|end| kickoff_places(&self.field, end, false));
            let fits = places.into_iter().find(|place| {
                let mut then = robots.clone();
                then[index].pose.position = *place;
                let free = |other: &RobotSeen| {
                    other.who == *who || other.pose.position.distance(*place) > CARRIED_APART_MIN
                };
                let is_keeper = self.accounts.is_keeper(*who);
                let on_line = place.x().abs() > self.field.length * 0.5 - 3.0 * limits::ROBOT_RADIUS;
                then.iter().all(free)
                    && is_keeper == on_line
                    && !self.obstacles_to_come(&then).iter().any(|left| left.who() == Some(*who))
            });
            let Some(place) = fits.or_else(|| self.keeper_place(*who)) else { continue };
            robots[index].pose.position = place;
            let pose = Pose { position: place, heading: place.direction_to(Point::new(0.0, 0.0)) };
            self.field_staff.orders.push_back(WorldOrder::CarryRobot(*who, pose));
        }
    }

    /// Position on the goal line where a penalty's keeper has to be.
    fn keeper_place(&self, who: Who) -> Option<Point<geometry::Field>> {
        self.accounts.is_keeper(who).then(|| self.field.goal_center(self.own_end(who.colour)))
    }
}

/// Minimum distance between robots placed by hand, centre to centre, m: two diameters.
const CARRIED_APART_MIN: f32 = 4.0 * limits::ROBOT_RADIUS;
