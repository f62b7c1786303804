//! `ready`: obstacles to continuing the game, by the conditions of the league's game controller. m, m/s,
//! field frame.
//!
//! The conditions are those of `findIssuesForContinuation` (RoboCup-SSL/ssl-game-controller,
//! `internal/app/engine`, `process_continue_next_command.go`), with its tolerances: the controller issues no
//! command while one of them is not met, however long that takes. The centre circle at a kick-off is in the
//! rules alone; the controller leaves it to the human referee.

use std::fmt;

use geometry::{Field, GoalEnd, Point};
use protocol::{RobotId, Who};
use rules::{Colour, Phase, limits};

use super::InternalReferee;
use super::event::Restart;
use super::observation::RobotSeen;
use super::reason::Reason;

/// A condition that prevents the game from continuing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReadyObstacle {
    /// The team that caused it; `None` for the ball's position.
    pub team: Option<Colour>,
    /// The robot that caused it; `None` if no single one did.
    pub robot: Option<RobotId>,
    /// Condition that is not met, with the measured values.
    pub reason: Reason,
}

impl ReadyObstacle {
    fn ball(reason: Reason) -> Self {
        Self { team: None, robot: None, reason }
    }

    fn robot(who: Who, reason: Reason) -> Self {
        Self { team: Some(who.colour), robot: Some(who.id), reason }
    }

    /// The robot that caused it.
    pub fn who(&self) -> Option<Who> {
        Some(Who { colour: self.team?, id: self.robot? })
    }
}

impl fmt::Display for ReadyObstacle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.team, self.robot) {
            (Some(team), Some(robot)) => write!(f, "{} {robot}: {}", team.label(), self.reason),
            (Some(team), None) => write!(f, "{}: {}", team.label(), self.reason),
            _ => write!(f, "{}", self.reason),
        }
    }
}

impl InternalReferee {
    /// True for a robot that the game controller counts as on the field.
    pub(super) fn counts(&self, robot: &RobotSeen) -> bool {
        self.field.counts(self.own_end(robot.who.colour), robot.pose.position)
    }

    /// Obstacles to the end of this stop with `next`.
    pub(super) fn obstacles_in_stop(
        &self,
        robots: &[RobotSeen],
        next: Restart,
        target: Point<Field>,
    ) -> Vec<ReadyObstacle> {
        let (ball, speed) = (self.ball.position, self.ball.speed());
        let mut found = Vec::new();
        for team in Colour::ALL {
            let (on_field, allowed) = (self.on_field(robots, team), self.allowed_now(team));
            if on_field > allowed {
                let reason = Reason::TooManyRobots { allowed, on_field };
                found.push(ReadyObstacle { team: Some(team), robot: None, reason });
            }
        }
        // The team that continues with a free kick may be at the ball already, so that it can place the ball
        // and then kick.
        for robot in robots.iter().filter(|robot| next != Restart::FreeKick(robot.who.colour)) {
            let distance = robot.pose.position.distance(ball) - limits::ROBOT_RADIUS;
            if distance < limits::BALL_DISTANCE - DISTANCE_TOLERANCE {
                found.push(ReadyObstacle::robot(robot.who, Reason::NearBall { distance }));
            }
        }
        let distance = ball.distance(target);
        if distance > limits::PLACEMENT_SKIP_DISTANCE {
            found.push(ReadyObstacle::ball(Reason::BallOffPlace { distance }));
        }
        // On the field of 2013, which the controller does not support, marks and spots lie nearer than that.
        let least = limits::PLACEMENT_SKIP_AREA_DISTANCE;
        let distance = self.distance_to_areas(ball);
        if distance < least && self.distance_to_areas(target) >= least {
            found.push(ReadyObstacle::ball(Reason::BallNearArea { distance }));
        }
        if !self.field.contains(ball) {
            found.push(ReadyObstacle::ball(Reason::BallOut));
        }
        if speed >= BALL_STEADY_SPEED_MAX {
            found.push(ReadyObstacle::ball(Reason::BallMoves { speed }));
        }
        found
    }

    /// Distance from the nearer of both defence areas, m.
    fn distance_to_areas(&self, p: Point<Field>) -> f32 {
        let [one, other] =
            [GoalEnd::Negative, GoalEnd::Positive].map(|end| self.field.distance_to_area(end, p));
        one.min(other)
    }

    /// Obstacles to the NORMAL_START of that team's kick-off.
    pub(super) fn obstacles_at_kickoff(&self, robots: &[RobotSeen], team: Colour) -> Vec<ReadyObstacle> {
        let centre = Point::new(0.0, 0.0);
        let radius = self.field.center_radius;
        let mut found = Vec::new();
        let distance = self.ball.position.distance(centre);
        if distance > radius {
            found.push(ReadyObstacle::ball(Reason::BallOffPlace { distance }));
        }
        let mut kickers = 0;
        for robot in self.nearest_first(robots) {
            let place = robot.pose.position;
            let inside = place.x() * self.own_end(robot.who.colour).sign() as f32;
            if inside < limits::ROBOT_RADIUS {
                found.push(ReadyObstacle::robot(robot.who, Reason::OtherHalf { inside }));
                continue;
            }
            let distance = place.distance(centre);
            if distance < radius + limits::ROBOT_RADIUS - DISTANCE_TOLERANCE {
                kickers += u32::from(robot.who.colour == team);
                if robot.who.colour != team || kickers > 1 {
                    found.push(ReadyObstacle::robot(robot.who, Reason::CentreCircle { distance }));
                }
            }
        }
        found
    }

    /// Obstacles to the NORMAL_START of that team's penalty.
    pub(super) fn obstacles_at_penalty(&self, robots: &[RobotSeen], team: Colour) -> Vec<ReadyObstacle> {
        let keeper = Who { colour: team.other(), id: self.accounts.of(team.other()).keeper };
        let goal = self.own_end(team.other());
        let (sign, line) = (goal.sign() as f32, self.field.goal_line(goal));
        let ball = self.ball.position;
        let mut found = Vec::new();
        let distance = ball.distance(self.penalty_spot(team));
        if distance > limits::PLACEMENT_TOLERANCE {
            found.push(ReadyObstacle::ball(Reason::BallOffPlace { distance }));
        }
        match robots.iter().find(|robot| robot.who == keeper) {
            None => {
                found.push(ReadyObstacle { team: Some(team.other()), robot: None, reason: Reason::NoKeeper });
            }
            Some(robot) => {
                let place = robot.pose.position;
                let (from_line, across) = ((place.x() - line).abs(), place.y().abs());
                if from_line > limits::ROBOT_RADIUS || across > self.field.goal_width * 0.5 {
                    found.push(ReadyObstacle::robot(keeper, Reason::KeeperOffLine { from_line, across }));
                }
            }
        }
        let mut shooters = 0;
        for robot in self.nearest_first(robots) {
            let place = robot.pose.position;
            let behind = (ball.x() - place.x()) * sign;
            if robot.who == keeper || behind > limits::PENALTY_BEHIND {
                continue;
            }
            shooters += u32::from(robot.who.colour == team);
            if robot.who.colour != team || shooters > 1 {
                found.push(ReadyObstacle::robot(robot.who, Reason::NotBehindBall { behind }));
            }
        }
        found
    }

    /// The nearest robot to the ball is the kicker; every further one is one too many.
    fn nearest_first<'r>(&self, robots: &'r [RobotSeen]) -> Vec<&'r RobotSeen> {
        let distance = |robot: &RobotSeen| robot.pose.position.distance(self.ball.position);
        let mut robots: Vec<&RobotSeen> = robots.iter().collect();
        robots.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        robots
    }

    /// Obstacles to the next command of this phase; empty in phases that do not wait.
    pub(super) fn obstacles(&self, robots: &[RobotSeen]) -> Vec<ReadyObstacle> {
        match self.phase() {
            Phase::Stop => {
                let target = self.placement.unwrap_or(self.ball.position);
                self.obstacles_in_stop(robots, self.next.unwrap_or(Restart::ForceStart), target)
            }
            Phase::PrepareKickoff(team) => self.obstacles_at_kickoff(robots, team),
            Phase::PreparePenalty(team) => self.obstacles_at_penalty(robots, team),
            _ => Vec::new(),
        }
    }
}

/// Tolerance of the game controller in distances to the ball, m (`distanceThreshold`).
const DISTANCE_TOLERANCE: f32 = 0.05;
/// Speed below which the ball counts as lying still for the game controller, m/s (`ballSteadyThreshold`).
const BALL_STEADY_SPEED_MAX: f32 = 0.2;
