//! `set_piece`: restarts: ours with a kicker and teammates to pass to, theirs with a wall.

use geometry::{Attack, Point};
use protocol::{Duration, Instant};
use rules::{League, Phase, Side};

use super::super::order::{OrderReason, Role, Task};
use super::super::support::{self, Target};
use super::super::view::{ROBOTS_MAX, View, ViewBall};
use super::super::{defence, restart, roles};
use super::ahead::Ahead;
use super::cap::Cap;
use super::{Coach, Plan};

/// Time by which another robot must be sooner at the ball to become the kicker, s: more than in play, the
/// ball lies.
const KICKER_CHANGE_S: f32 = 1.0;
/// Mates are given this long to take their places before a restart is aimed, of the 5 s (A) that the rules
/// give: they are there since the ball was placed, and run on while the kicker goes around it.
const AIMED_AFTER: Duration = Duration::millis(200);
/// A target once chosen stands for this long: to walk around the ball, aim and kick.
const AIM_KEPT: Duration = Duration::millis(3000);
/// Nearer to our goal than this the defenders are the wall, m.
const WALL_BEYOND_M: f32 = 2.2;
/// Time by which another robot must be sooner at the ball to take a placement over, s: as long as fetching it
/// takes; and as usual of one that has not brought the ball nearer for this long.
const PLACER_CHANGE_S: f32 = 4.0;
const PLACER_STUCK_AFTER: Duration = Duration::millis(6_000);
/// A placer farther from the ball than this, m, has not reached it: another takes over that is so much
/// sooner, s, as a change costs no more than a turn.
const PLACER_AT_BALL_M: f32 = 0.6;
const PLACER_FAR_CHANGE_S: f32 = 0.8;
/// Time for which the robot that brings the ball is chosen anew: before, it was chosen for a stop.
const PLACER_CHOSEN_WITHIN: Duration = Duration::millis(100);
/// A ball that has come nearer to its place by this much counts as being placed, m.
const PLACING_GAIN_MIN_M: f32 = 0.1;
/// A ball that has not for this long is given up: the 30 s of a placement.
const PLACING_GIVEN_UP_AFTER: Duration = Duration::millis(30_000);
/// One that no robot can get at is given up as soon as it lies still.
const OUT_OF_REACH_GIVEN_UP_AFTER: Duration = Duration::millis(2_000);

/// Memory of our restart, or ball placement, that is running.
#[derive(Clone, Debug)]
pub(super) struct RestartState {
    /// Target of the restart, and since when.
    pub(super) aim: Option<(Instant, Target)>,
    /// The pass ahead that it is to be.
    pub(super) ahead: Option<Ahead>,
    pub(super) cap: Cap,
    /// A pass ahead was not completed in time at this restart.
    pub(super) gave_up: bool,
    /// Least distance of the ball from its place in our placement, m, and since when.
    placing: Option<(f32, Instant)>,
    /// Place of the ball when our kicker was ordered to it last.
    pub(super) ball_from: Option<Point<Attack>>,
}

impl RestartState {
    /// Memory without a restart, by a league's rules.
    pub(super) fn new(league: League) -> Self {
        Self { aim: None, ahead: None, cap: Cap::new(league), gave_up: false, placing: None, ball_from: None }
    }

    /// Drops aim and plans when another phase starts.
    pub(super) fn reset(&mut self) {
        (self.aim, self.ahead, self.placing) = (None, None, None);
        self.gave_up = false;
        self.cap.forget();
    }
}

impl Coach {
    /// Our ball placement: the nearest brings it, the others keep clear of it. One that gets nowhere is
    /// given up: all robots keep away from ball and target as at the opponents', until the referee goes on.
    pub(super) fn place_ball(&mut self, plan: &mut Plan<'_>) {
        let view = plan.view;
        if let (Some(ball), Some(at)) = (view.ball, view.placement)
            && !self.gives_up_placing(view, &ball, at)
        {
            let field_players = view.ours.iter().filter(|robot| robot.id != view.keeper);
            // Who backs off with the ball seems to get away from it: no robot takes over from one that makes
            // progress.
            let stuck =
                self.restart.placing.is_some_and(|(_, since)| view.now.since(since) > PLACER_STUCK_AFTER);
            let chosen = self.age(view) > PLACER_CHOSEN_WITHIN && !stuck;
            let placer = self.roles.ball_player.filter(|_| chosen).and_then(|id| view.our(id));
            let worth = match placer.map(|robot| robot.position.distance(ball.position)) {
                Some(off) if off < PLACER_AT_BALL_M => PLACER_CHANGE_S,
                Some(_) => PLACER_FAR_CHANGE_S,
                None => roles::WORTH,
            };
            let first = roles::choose(field_players, self.roles.ball_player, worth, |robot| {
                roles::time_to(robot, ball.position)
            });
            self.roles.ball_player = first.map(|(id, _)| id);
            if let Some((id, seconds)) = first
                && plan.take(id)
            {
                plan.order(id, Role::Kicker, Task::PlaceBall { at }, OrderReason::SoonestAtBall { seconds });
            }
        }
        self.defend(plan, false);
        self.spread(plan);
    }

    /// Whether the ball has not come nearer to its place for so long that it is given up.
    fn gives_up_placing(&mut self, view: &View, ball: &ViewBall, at: Point<Attack>) -> bool {
        let left = ball.position.distance(at);
        let (least, since) = *self.restart.placing.get_or_insert((left, view.now));
        if left < least - PLACING_GAIN_MIN_M {
            self.restart.placing = Some((left, view.now));
            return false;
        }
        let waited = view.now.since(since);
        waited > PLACING_GIVEN_UP_AFTER
            || waited > OUT_OF_REACH_GIVEN_UP_AFTER && restart::is_out_of_reach(view, ball.position)
    }

    /// Kick-off: ours with a kicker and teammates to pass to, theirs with all robots at home.
    pub(super) fn kickoff(&mut self, plan: &mut Plan<'_>, side: Side) {
        let view = plan.view;
        if side == Side::Ours {
            self.kicker(plan, matches!(view.phase, Phase::Kickoff(_)), Some(restart::kickoff_spot(view)));
            self.receiver(plan);
        }
        self.defend(plan, false);
        let places: heapless::Vec<_, ROBOTS_MAX> = restart::kickoff_places(view).into_iter().collect();
        self.fill(plan, &places, |i| (Role::Support(i as u8), OrderReason::Referee));
    }

    /// Free kick: ours with a kicker and teammates in free places, theirs with a wall and marked opponents.
    pub(super) fn free_kick(&mut self, plan: &mut Plan<'_>, side: Side) {
        let view = plan.view;
        let Some(ball) = view.ball else { return self.defend(plan, false) };
        if side == Side::Ours {
            self.kicker(plan, matches!(view.phase, Phase::FreeKick(_)), None);
            self.receiver(plan);
            self.defend(plan, false);
            return self.spread(plan);
        }
        self.roles.ball_player = None;
        let field_players = plan.free.iter().filter(|id| **id != view.keeper).count();
        let places =
            self.model.as_ref().and_then(|model| model.against_free_kick(view, &ball, field_players));
        if let Some(places) = places {
            plan.keeper_guards();
            let at: heapless::Vec<_, ROBOTS_MAX> = places.iter().map(|(at, _, _)| *at).collect();
            let what = |i: usize| {
                places.get(i).map_or((Role::Player, OrderReason::Referee), |place| (place.1, place.2))
            };
            self.fill(plan, &at, what);
            return self.spread(plan);
        }
        if self.tactics.second_level && self.tactics.threats {
            return self.their_free_kick(plan, &ball);
        }
        self.defend(plan, false);
        let mut places: heapless::Vec<_, ROBOTS_MAX> = heapless::Vec::new();
        let mut whom: heapless::Vec<_, ROBOTS_MAX> = heapless::Vec::new();
        // Near our area the defenders are the wall already.
        if ball.position.distance(view.our_goal()) > WALL_BEYOND_M {
            let _ = places.push(restart::wall(view, &ball));
            let _ = whom.push((Role::Wall, OrderReason::OnBallLine { y: view.our_goal().y() }));
        }
        for (i, (at, opponent)) in defence::marks(view).into_iter().enumerate() {
            let _ = places.push(at);
            let _ = whom.push((Role::Marker(i as u8), OrderReason::Marks { opponent }));
        }
        self.fill(plan, &places, |i| whom.get(i).copied().unwrap_or((Role::Player, OrderReason::Referee)));
        self.spread(plan);
    }

    /// Our kicker: behind the ball until it may kick, then the kick; behind the `mark` of a kick-off or a
    /// penalty.
    pub(super) fn kicker(&mut self, plan: &mut Plan<'_>, started: bool, mark: Option<Point<Attack>>) {
        let view = plan.view;
        let penalty = matches!(view.phase, Phase::Penalty(_));
        let Some(ball) = view.ball else { return };
        let field_players = view.ours.iter().filter(|robot| robot.id != view.keeper);
        let chosen = roles::choose(field_players, self.roles.ball_player, KICKER_CHANGE_S, |robot| {
            roles::time_to(robot, ball.position)
        });
        self.roles.ball_player = chosen.map(|(id, _)| id);
        let Some((id, seconds)) = chosen else { return };
        if !plan.take(id) {
            return;
        }
        if !started {
            let spot = mark.or(view.placement).unwrap_or(ball.position);
            let at = plan.kept_off(restart::kicker_waits(view, spot));
            return plan.order(
                id,
                Role::Kicker,
                plan.facing_ball(at),
                OrderReason::SoonestAtBall { seconds },
            );
        }
        self.restart.ball_from = Some(ball.position);
        if let Some((task, why)) = self.coerce(plan, id, &ball) {
            return plan.order(id, Role::Kicker, task, why);
        }
        // At a kick-off all have stood in their places since it was prepared.
        let free_kick = matches!(view.phase, Phase::FreeKick(_));
        let wait = if free_kick { AIMED_AFTER } else { Duration(0) };
        if self.tactics.rated
            && (free_kick && !self.tactics.pass_ahead || matches!(view.phase, Phase::Kickoff(_)))
            && self.age(view) >= wait
            && let Some((task, why)) = self.rated_restart(plan, id, &ball)
        {
            return plan.order(id, Role::Kicker, task, why);
        }
        let stands = self.restart.ahead.is_some()
            || self.restart.aim.is_some_and(|(since, _)| view.now.since(since) < AIM_KEPT);
        if self.age(view) >= wait && !stands {
            let target = if penalty {
                let (at, room) = support::best_shot(view, ball.position);
                Target::Shot { at, room }
            } else {
                self.target(view, id, &ball)
            };
            self.restart.aim = Some((view.now, target));
        }
        if let Some((task, why)) = self.pass_ahead(view, id, &ball) {
            return plan.order(id, Role::Kicker, task, why);
        }
        let (task, why) = restart::take(view, &ball, self.restart.aim.map(|(_, target)| target));
        plan.order(id, Role::Kicker, task, why);
    }

    /// The teammate that our restart is aimed at; of a pass ahead, as soon as it is its time.
    fn receiver(&mut self, plan: &mut Plan<'_>) {
        if let Some(ahead) = self.restart.ahead {
            if ahead.receiver_goes() && plan.take(ahead.receiver) {
                plan.order(ahead.receiver, Role::Receiver, ahead.reception(), ahead.why());
            }
            return;
        }
        if let Some((_, Target::Teammate { id, at, room })) = self.restart.aim
            && plan.take(id)
        {
            plan.order(
                id,
                Role::Receiver,
                Task::Receive { at, then: None },
                OrderReason::BestTarget { room },
            );
        }
    }

    /// Theirs against threats: a wall where it has room, all others as keeper, primary defender or
    /// against a second-level threat.
    fn their_free_kick(&mut self, plan: &mut Plan<'_>, ball: &ViewBall) {
        let view = plan.view;
        if ball.position.distance(view.our_goal()) > WALL_BEYOND_M {
            let at = plan.kept_off(restart::wall(view, ball));
            let primaries = self.primaries(plan);
            let near = view.ours.iter().filter(|robot| {
                plan.free.contains(&robot.id) && robot.id != view.keeper && !primaries.has(robot.id)
            });
            let wall =
                roles::choose(near, self.roles.placed[0], roles::WORTH, |robot| roles::time_to(robot, at));
            self.roles.placed[0] = wall.map(|(id, _)| id);
            if let Some((id, _)) = wall
                && plan.take(id)
            {
                plan.order(
                    id,
                    Role::Wall,
                    plan.facing_ball(at),
                    OrderReason::OnBallLine { y: view.our_goal().y() },
                );
            }
        }
        self.defend(plan, true);
        self.spread(plan);
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::tactics::Tactics;
    use super::super::super::view::tests::view;
    use super::*;
    use crate::strategy::Team;
    use geometry::Vector;
    use rules::League;

    #[test]
    fn a_sooner_robot_takes_a_placement_over_while_the_first_is_on_its_way() {
        for (off, takes_over) in [(3.0, true), (0.1, false)] {
            let mut coach = Coach::new(Team::Ours, Tactics::default(), League::DivisionB);
            let mut seen = view((2.0, 0.0), &[(-4.4, 0.0), (2.0 - off, 0.0), (-3.5, 2.0)], &[]);
            seen.phase = Phase::BallPlacement(Side::Ours);
            seen.placement = Some(Point::new(-1.0, 0.0));
            coach.decide(&seen);
            seen.now = Instant(seen.now.0 + 500_000);
            // The first moves off as fast as it backs away with a ball, the other has come.
            seen.ours[1].velocity = Vector::new(-2.0, 0.0);
            seen.ours[2].position = Point::new(2.0, 0.5);
            let orders = coach.decide(&seen);
            let placer = orders.iter().find(|order| matches!(order.task, Task::PlaceBall { .. })).unwrap();
            assert_eq!(placer.robot == seen.ours[2].id, takes_over, "{off} m off");
        }
    }
}
