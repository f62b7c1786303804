//! How does the game go on? What the game controller and its operators do in each phase, and the longest time of each.
//!
//! Rules 2026, referee commands; m, m/s, field frame.

use geometry::{Field, Point};
use protocol::{Duration, Instant, Who};
use rules::restart::{AfterPlacement, placement_lack, placement_needless};
use rules::state::{Command, Stage};
use rules::{Colour, FieldSpec, Phase, limits};

use super::InternalReferee;
use super::event::{Kind, PenaltyEnd, Restart, What};
use super::observation::RobotSeen;

/// Who brings the ball to its place.
enum Placer {
    /// It lies well enough.
    Nobody,
    Team(Colour),
    Person,
}

impl InternalReferee {
    pub(super) fn go_on(&mut self, robots: &[RobotSeen]) {
        if self.end_stage() || self.held {
            return;
        }
        let age = self.now.since(Instant(self.state.since()));
        match self.phase() {
            Phase::Halt => {
                if !self.stage.is_break() && age >= self.settings.halt {
                    self.give(Command::Stop);
                }
            }
            Phase::Timeout(team) => {
                let account = self.accounts.of_mut(team);
                if account.timeout_left <= 0 || account.timeout_wanted.is_none_or(|left| left <= 0) {
                    account.timeout_wanted = None;
                    self.give(Command::Stop);
                }
            }
            Phase::Stop => self.go_on_from_stop(robots, age),
            Phase::BallPlacement(team) => self.see_placement(robots, team, age),
            Phase::PrepareKickoff(team) => {
                let ready = self.is_ready_for_kickoff(robots, team);
                self.start_when(ready, age);
            }
            Phase::PreparePenalty(team) => {
                let ready = self.is_ready_for_penalty(robots, team);
                self.start_when(ready, age);
            }
            Phase::Penalty(team) => {
                if self.action_left <= 0 {
                    let what = What::PenaltyFailed { reason: PenaltyEnd::TimeUp };
                    self.judge(&self.event(Some(team), what));
                }
            }
            Phase::Run | Phase::Kickoff(_) | Phase::FreeKick(_) => {
                let lost = self.now.since(self.ball_seen_at);
                if lost >= BALL_LOST {
                    let what = What::NoProgress { duration: lost.as_secs_f32() };
                    self.judge(&self.event(None, what));
                }
            }
        }
    }

    fn go_on_from_stop(&mut self, robots: &[RobotSeen], age: Duration) {
        if self.stage == Stage::PostGame || age < HEARD {
            return;
        }
        for team in super::scene::COLOURS {
            let account = self.accounts.of_mut(team);
            if account.timeout_wanted.is_some() && account.timeouts > 0 {
                account.timeouts -= 1;
                return self.give(Command::Timeout(team));
            }
        }
        let next = self.next.unwrap_or(Restart::ForceStart);
        let target = self.placement.unwrap_or(self.ball.position);
        match self.placer(next, target) {
            Placer::Team(team) => return self.give(Command::BallPlacement(team)),
            Placer::Person => {
                if self.put_ball(robots, target) {
                    self.ready_since = None;
                    return;
                }
            }
            Placer::Nobody => {}
        }
        let clear = self.is_clear(robots, next, target);
        let since = clear.then(|| *self.ready_since.get_or_insert(self.now));
        if since.is_none() {
            self.ready_since = None;
        }
        // A team that placed the ball for its own free kick takes it at once.
        let placed = self
            .recent
            .iter()
            .any(|event| event.what.kind() == Kind::PlacementSucceeded && event.by == next.team());
        let preparation = if placed { Duration(0) } else { self.settings.person_delay };
        let ready = since.is_some_and(|since| self.now.since(since) >= preparation);
        // People have their own patience with the ball; after that with the robots.
        let patience = self.settings.patience + self.settings.person_delay * u64::from(self.put_by_hand());
        if ready || age >= patience {
            self.give(match next {
                Restart::Kickoff(team) => Command::PrepareKickoff(team),
                Restart::Penalty(team) => Command::PreparePenalty(team),
                Restart::FreeKick(team) => Command::FreeKick(team),
                Restart::ForceStart => Command::ForceStart,
            });
        }
    }

    fn placer(&mut self, next: Restart, target: Point<Field>) -> Placer {
        let (ball, speed) = (self.ball.position, self.ball.speed());
        if next.is_set_by_hand() || self.put_by_hand() {
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
        let may = |team: &Colour| self.accounts.of(*team).places();
        [favoured, favoured.other()].into_iter().find(may).map_or(Placer::Person, Placer::Team)
    }

    fn is_reachable(&self, ball: Point<Field>) -> bool {
        is_reachable(&self.field, ball)
    }

    /// Nothing speaks against going on: ball still, at its place and in the field, robots away from it, not too many.
    fn is_clear(&self, robots: &[RobotSeen], next: Restart, target: Point<Field>) -> bool {
        let (ball, speed) = (self.ball.position, self.ball.speed());
        let mut numbers = super::scene::COLOURS
            .into_iter()
            .map(|team| self.on_field(robots, team) <= self.allowed_now(team));
        // The team that goes on with a free kick may be at the ball already, so that it can do so after its placement.
        let must_keep_away = |robot: &&RobotSeen| match next {
            Restart::FreeKick(team) => robot.who.colour != team,
            _ => true,
        };
        let distance = limits::BALL_DISTANCE - DISTANCE_TOLERANCE;
        let away = |robot: &RobotSeen| robot.pose.position.distance(ball) - limits::ROBOT_RADIUS >= distance;
        numbers.all(|fine| fine)
            && speed <= limits::BALL_STILL
            && ball.distance(target) <= limits::PLACEMENT_SKIP_DISTANCE
            && self.field.contains(ball)
            && robots.iter().filter(must_keep_away).all(away)
    }

    fn see_placement(&mut self, robots: &[RobotSeen], team: Colour, age: Duration) {
        let Some(target) = self.placement else { return self.give(Command::Stop) };
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
        // People help where robots cannot.
        let interfered = self.recent.iter().filter(|event| event.what.kind() == Kind::InterferedPlacement);
        let stuck = !self.is_reachable(ball) && self.ball.speed() <= limits::BALL_STILL;
        if stuck || interfered.count() > INTERFERENCES_MAX {
            return self.give(Command::Stop);
        }
        if self.action_left <= 0 {
            let ours = robots.iter().filter(|robot| robot.who.colour == team);
            let nearest = ours.map(|robot| robot.pose.position.distance(target)).reduce(f32::min);
            let what =
                What::PlacementFailed { remaining: ball.distance(target), nearest: nearest.unwrap_or(-1.0) };
            self.judge(&self.event(Some(team), what));
        }
    }

    /// NORMAL_START when everybody has been ready for a while, or has had time enough.
    fn start_when(&mut self, ready: bool, age: Duration) {
        if !ready {
            self.ready_since = None;
        }
        let since = ready.then(|| *self.ready_since.get_or_insert(self.now));
        let prepared = since.is_some_and(|since| self.now.since(since) >= self.settings.person_delay);
        if prepared || age >= self.settings.patience {
            self.give(Command::NormalStart);
        }
    }

    fn is_ready_for_kickoff(&self, robots: &[RobotSeen], team: Colour) -> bool {
        let radius = self.field.center_radius;
        let centre = Point::new(0.0, 0.0);
        let mut kickers = 0;
        let mut lawful = |robot: &RobotSeen| {
            let place = robot.pose.position;
            let side = self.own_end(robot.who.colour).sign() as f32;
            let in_circle = place.distance(centre) < radius + limits::ROBOT_RADIUS - DISTANCE_TOLERANCE;
            if in_circle && robot.who.colour == team {
                kickers += 1;
                return kickers == 1;
            }
            !in_circle && place.x() * side > limits::ROBOT_RADIUS - DISTANCE_TOLERANCE
        };
        self.ball.position.distance(centre) <= radius && robots.iter().all(&mut lawful)
    }

    fn is_ready_for_penalty(&self, robots: &[RobotSeen], team: Colour) -> bool {
        let keeper = Who { colour: team.other(), id: self.accounts.of(team.other()).keeper };
        let goal = self.own_end(team.other());
        let sign = goal.sign() as f32;
        let line = self.field.goal_line(goal);
        let ball = self.ball.position;
        let mut shooters = 0;
        let mut lawful = |robot: &RobotSeen| {
            let place = robot.pose.position;
            if robot.who == keeper {
                return (place.x() - line).abs() <= limits::ROBOT_RADIUS
                    && place.y().abs() <= self.field.goal_width * 0.5;
            }
            let behind = (ball.x() - place.x()) * sign >= limits::PENALTY_BEHIND - DISTANCE_TOLERANCE;
            shooters += u32::from(!behind && robot.who.colour == team);
            behind || robot.who.colour == team && shooters == 1
        };
        let spot = self.penalty_spot(team);
        ball.distance(spot) <= limits::PLACEMENT_TOLERANCE && robots.iter().all(&mut lawful)
    }
}

/// Robots can get at the ball: it is neither in or behind a goal nor in a corner of the carpet (rules: ball placement).
pub(super) fn is_reachable(field: &FieldSpec, ball: Point<Field>) -> bool {
    let (x, y) = (ball.x().abs(), ball.y().abs());
    let goal = field.goal_width * 0.5 + field.goal_wall + limits::ROBOT_RADIUS;
    let behind = x > field.length * 0.5 && y < goal;
    let from_wall = (field.length * 0.5 + field.goal_line_margin - x, field.width * 0.5 + field.margin - y);
    let corner = from_wall.0 < CORNER && from_wall.1 < CORNER;
    !behind && !corner && from_wall.0 > 0.0 && from_wall.1 > 0.0
}

/// A stop lasts at least this long, so that nobody misses it: two packets.
const HEARD: Duration = Duration::millis(50);
/// A ball that nobody has seen for so long in play is looked for by people: as long as the rules' graces.
const BALL_LOST: Duration = Duration::millis(2_000);
/// What the game controller tolerates in distances before it goes on, m.
const DISTANCE_TOLERANCE: f32 = 0.05;
/// Interferences with one placement after which people place the ball (rules: the referee is encouraged to).
const INTERFERENCES_MAX: usize = 3;
/// A ball this near to two walls is in a corner, m: a robot's diameter.
const CORNER: f32 = 2.0 * limits::ROBOT_RADIUS;
