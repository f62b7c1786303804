//! `flow`: course of the game. What the game controller and its operators do in each phase, and the time
//! limit of each phase that has one.
//!
//! Rules 2026, referee commands; m, m/s, field frame.

use geometry::{Field, Point};
use protocol::{Duration, Instant};
use rules::restart::{AfterPlacement, placement_lack, placement_needless};
use rules::state::{RefereeCommand, Stage};
use rules::{Colour, FieldSpec, Phase, limits};

use super::InternalReferee;
use super::event::{Kind, PenaltyEnd, Restart, What};
use super::observation::RobotSeen;
use super::ready::ReadyObstacle;
use super::reason::Reason;

enum Placer {
    /// The ball lies near enough.
    Nobody,
    Team(Colour),
    Person,
}

impl InternalReferee {
    pub(super) fn go_on(&mut self, robots: &[RobotSeen]) {
        if self.end_stage() {
            if matches!(self.stage, Stage::SecondHalfPre | Stage::ExtraSecondHalfPre) {
                self.carry_over(robots);
            }
            return;
        }
        if self.held {
            return;
        }
        let age = self.now.since(Instant(self.state.since()));
        match self.phase() {
            Phase::Halt => {
                if !self.stage.is_break() && age >= self.settings.halt && !self.field_staff.called {
                    self.give(RefereeCommand::Stop);
                }
            }
            Phase::Timeout(team) => {
                let account = self.accounts.of_mut(team);
                if account.timeout_left <= 0 || account.timeout_wanted.is_none_or(|left| left <= 0) {
                    account.timeout_wanted = None;
                    self.give(RefereeCommand::Stop);
                }
            }
            Phase::Stop => self.go_on_from_stop(robots, age),
            Phase::BallPlacement(team) => self.see_placement(robots, team, age),
            Phase::PrepareKickoff(_) | Phase::PreparePenalty(_) => {
                let (obstacles, preparation) = (self.obstacles(robots), self.settings.person_delay);
                self.go_on_when_clear(robots, &obstacles, preparation, RefereeCommand::NormalStart);
            }
            Phase::Penalty(team) => {
                if self.action_left <= 0 {
                    let what = What::PenaltyFailed { reason: PenaltyEnd::TimeUp };
                    self.judge(&self.event(Some(team), what));
                }
            }
            Phase::Run | Phase::Kickoff(_) | Phase::FreeKick(_) => {
                let lost = self.now.since(self.ball_seen_at);
                if lost >= BALL_LOST_AFTER {
                    let what = What::NoProgress { duration: lost.as_secs_f32() };
                    self.judge(&self.event(None, what));
                }
            }
        }
    }

    fn go_on_from_stop(&mut self, robots: &[RobotSeen], age: Duration) {
        if self.stage == Stage::PostGame || age < STOP_MIN {
            return;
        }
        for team in Colour::ALL {
            let account = self.accounts.of_mut(team);
            if account.timeout_wanted.is_some() && account.timeouts > 0 {
                account.timeouts -= 1;
                return self.give(RefereeCommand::Timeout(team));
            }
        }
        let next = self.next.unwrap_or(Restart::ForceStart);
        let target = self.placement.unwrap_or(self.ball.position);
        let to_be_put = match self.placer(next, target) {
            Placer::Team(team) => return self.give(RefereeCommand::BallPlacement(team)),
            Placer::Person => self.put_ball(robots, target),
            Placer::Nobody => false,
        };
        let mut obstacles = self.obstacles(robots);
        if to_be_put {
            let distance = self.ball.position.distance(target);
            let reason = Reason::BallNotPut { distance };
            obstacles.insert(0, ReadyObstacle { team: None, robot: None, reason });
        }
        // A team that placed the ball for its own free kick kicks at once.
        let placed = self
            .recent
            .iter()
            .any(|event| event.what.kind() == Kind::PlacementSucceeded && event.by == next.team());
        let preparation = if placed { Duration(0) } else { self.settings.person_delay };
        let command = match next {
            Restart::Kickoff(team) => RefereeCommand::PrepareKickoff(team),
            Restart::Penalty(team) => RefereeCommand::PreparePenalty(team),
            Restart::FreeKick(team) => RefereeCommand::FreeKick(team),
            Restart::ForceStart => RefereeCommand::ForceStart,
        };
        self.go_on_when_clear(robots, &obstacles, preparation, command);
    }

    fn placer(&mut self, next: Restart, target: Point<Field>) -> Placer {
        let (ball, speed) = (self.ball.position, self.ball.speed());
        let by_hand = self.blocked().is_some_and(|blocked| blocked.obstacle.reason.is_balls());
        if next.is_set_by_hand() || self.put_by_hand() || by_hand {
            return Placer::Person;
        }
        if self.recent.iter().any(|event| event.what.kind() == Kind::PlacementSucceeded) {
            return Placer::Nobody;
        }
        if placement_needless(&self.field, ball, speed, target) {
            return Placer::Nobody;
        }
        if !self.is_reachable(ball) {
            return Placer::Person;
        }
        let failed: Vec<Colour> = self.failed_placements().collect();
        let interfered = self.recent.iter().filter(|event| event.what.kind() == Kind::InterferedPlacement);
        if failed.len() > 1 || interfered.count() > INTERFERENCES_MAX {
            return Placer::Person;
        }
        let may = |team: Colour| self.accounts.of(team).places();
        if let [team] = failed[..] {
            return if may(team.other()) { Placer::Team(team.other()) } else { Placer::Person };
        }
        let favoured = next.team().or(self.drawn);
        let favoured =
            favoured.unwrap_or_else(|| if self.chance.chance(0.5) { Colour::Yellow } else { Colour::Blue });
        self.drawn = Some(favoured);
        [favoured, favoured.other()]
            .into_iter()
            .find(|team| self.accounts.of(*team).places())
            .map_or(Placer::Person, Placer::Team)
    }

    fn is_reachable(&self, ball: Point<Field>) -> bool {
        is_reachable(&self.field, ball)
    }

    fn see_placement(&mut self, robots: &[RobotSeen], team: Colour, age: Duration) {
        let Some(target) = self.placement else { return self.give(RefereeCommand::Stop) };
        let after = match self.next {
            Some(Restart::FreeKick(favoured)) if favoured == team => AfterPlacement::FreeKick,
            _ => AfterPlacement::ForceStart,
        };
        let ball = self.ball.position;
        let places = robots.iter().map(|robot| robot.pose.position);
        let lack = placement_lack(ball, self.ball.speed(), target, places, after);
        if lack.is_none() && age.as_secs_f32() >= limits::PLACEMENT_TIME_MIN {
            let what = What::PlacementSucceeded {
                took: age.as_secs_f32(),
                precision: ball.distance(target),
                distance: self.ball_at_command.distance(target),
            };
            return self.judge(&self.event(Some(team), what));
        }
        // The ball is placed by hand where robots cannot do it.
        let interfered = self.recent.iter().filter(|event| event.what.kind() == Kind::InterferedPlacement);
        let stuck = !self.is_reachable(ball) && self.ball.speed() <= limits::BALL_STILL;
        if stuck || interfered.count() > INTERFERENCES_MAX {
            return self.give(RefereeCommand::Stop);
        }
        if self.action_left <= 0 {
            let ours = robots.iter().filter(|robot| robot.who.colour == team);
            let nearest = ours.map(|robot| robot.pose.position.distance(target)).reduce(f32::min);
            let what =
                What::PlacementFailed { remaining: ball.distance(target), nearest: nearest.unwrap_or(-1.0) };
            self.judge(&self.event(Some(team), what));
        }
    }
}

/// True for a ball that robots can reach: it is neither in or behind a goal nor in a corner of the field
/// surface (rules: ball placement).
pub(super) fn is_reachable(field: &FieldSpec, ball: Point<Field>) -> bool {
    let (x, y) = (ball.x().abs(), ball.y().abs());
    let goal = field.goal_width * 0.5 + field.goal_wall + limits::ROBOT_RADIUS;
    let behind = x > field.length * 0.5 && y < goal;
    let from_wall = (field.length * 0.5 + field.goal_line_margin - x, field.width * 0.5 + field.margin - y);
    let corner = from_wall.0 < CORNER_DISTANCE && from_wall.1 < CORNER_DISTANCE;
    !behind && !corner && from_wall.0 > 0.0 && from_wall.1 > 0.0
}

/// Minimum duration of a stop, so that every receiver sees it: two packets.
const STOP_MIN: Duration = Duration::millis(50);
/// Time without detection after which a ball in play is searched for and placed by hand: as long as the
/// rules' graces.
const BALL_LOST_AFTER: Duration = Duration::millis(2_000);
/// Number of interferences with one placement after which the ball is placed by hand (rules: the referee is
/// encouraged to).
const INTERFERENCES_MAX: usize = 3;
/// Distance from two walls, m, below which a ball is in a corner: a robot's diameter.
const CORNER_DISTANCE: f32 = 2.0 * limits::ROBOT_RADIUS;
