//! Which plan does the phase of the game ask for? One order per robot of ours, every time the picture changes (DESIGN §3).
//!
//! In open play the keeper guards, two defenders stand before the area, and everybody else plays cases; the robots choose them among
//! themselves. While the ball is not in play everything is said from here. The coach remembers who had which role (so that nobody
//! flickers), since when the phase lasts, and who took our restart (it must not touch the ball twice).

use geometry::{Angle, Attack, Point};
use protocol::{Duration, Instant, RobotId};
use rules::{Phase, Side};

use super::opponents::{Rival, Team};
use super::order::{Order, Role, Task, Why};
use super::support::Target;
use super::view::{ROBOTS_MAX, View, nearest};
use super::{defence, restart, roles, support};

/// All orders of one moment, by robot.
pub type Orders = heapless::Vec<Order, ROBOTS_MAX>;
type Free = heapless::Vec<RobotId, ROBOTS_MAX>;

/// A pass on its way.
#[derive(Clone, Copy, Debug)]
struct Pass {
    receiver: RobotId,
    at: Point<Attack>,
    since: Instant,
}

/// Chooses what everybody does; see [`Coach::decide`].
#[derive(Clone, Debug, Default)]
pub struct Coach {
    team: Team,
    /// Another team's open play, where it is not ours.
    rival: Option<Rival>,
    phase: Option<Phase<Side>>,
    since: Instant,
    /// Who goes for the ball, or takes our restart.
    first: Option<RobotId>,
    defenders: [Option<RobotId>; 2],
    others: [Option<RobotId>; OTHERS],
    /// What our restart is aimed at, since when.
    aim: Option<(Instant, Target)>,
    /// The pass of our restart that is on its way.
    pass: Option<Pass>,
    /// Took our restart; nobody else has touched the ball since.
    barred: Option<RobotId>,
}

impl Coach {
    /// Of that team.
    pub fn of(team: Team) -> Self {
        Self { team, rival: Rival::of(team), ..Self::default() }
    }

    /// Orders for all our robots of the view, one each, by id.
    pub fn decide(&mut self, view: &View) -> Orders {
        self.remember(view);
        let mut plan = Plan { view, orders: Orders::new(), free: view.ours.iter().map(|r| r.id).collect() };
        if !matches!(view.phase, Phase::Halt | Phase::Timeout(_)) {
            plan.send_off_surplus();
        }
        match view.phase {
            _ if self.team == Team::Idle => plan.everybody(Role::Player, Task::Stand, Why::Idle),
            Phase::Halt | Phase::Timeout(_) => plan.everybody(Role::Player, Task::Stand, Why::Referee),
            Phase::Run => match &mut self.rival {
                Some(rival) => plan.orders.extend(rival.open_play(view, &mut plan.free, self.barred)),
                None => self.open_play(&mut plan),
            },
            Phase::BallPlacement(Side::Ours) => self.place_ball(&mut plan),
            Phase::PreparePenalty(side) | Phase::Penalty(side) => self.penalty(&mut plan, side),
            Phase::PrepareKickoff(side) | Phase::Kickoff(side) => self.kickoff(&mut plan, side),
            Phase::FreeKick(side) => self.free_kick(&mut plan, side),
            Phase::Stop | Phase::BallPlacement(Side::Theirs) => match view.next {
                Some(Phase::PreparePenalty(side) | Phase::Penalty(side)) => self.penalty(&mut plan, side),
                Some(Phase::PrepareKickoff(side) | Phase::Kickoff(side)) => self.kickoff(&mut plan, side),
                Some(Phase::FreeKick(side)) => self.free_kick(&mut plan, side),
                _ => self.free_kick(&mut plan, Side::Theirs),
            },
        }
        plan.everybody(Role::Player, Task::Stand, Why::NoBall);
        plan.orders.sort_unstable_by_key(|order| order.robot);
        plan.orders
    }

    /// Phase, its age, and who must not touch the ball.
    fn remember(&mut self, view: &View) {
        if self.phase != Some(view.phase) {
            let taken = matches!(
                self.phase,
                Some(Phase::FreeKick(Side::Ours) | Phase::Kickoff(Side::Ours) | Phase::Penalty(Side::Ours))
            );
            self.barred = if view.phase == Phase::Run && taken { self.first } else { None };
            self.pass = match self.aim {
                Some((_, Target::Mate { id, at, .. })) if view.phase == Phase::Run && taken => {
                    Some(Pass { receiver: id, at, since: view.now })
                }
                _ => None,
            };
            self.phase = Some(view.phase);
            self.aim = None;
            self.since = view.now;
        }
        if let (Some(pass), Some(ball)) = (self.pass, view.ball) {
            let age = view.now.since(pass.since);
            let had = |robots: &[super::view::Robot], who: &dyn Fn(RobotId) -> bool| {
                nearest(robots.iter().filter(|robot| who(robot.id)), ball.position)
                    .is_some_and(|(_, d)| d < TOUCHING)
            };
            let over = age > PASS_LASTS
                || (age > PASS_BEGINS && ball.velocity.norm() < PASS_STOPPED)
                || had(&view.theirs, &|_| true)
                || had(&view.ours, &|id| id == pass.receiver);
            if over {
                self.pass = None;
            }
        }
        if let (Some(barred), Some(ball)) = (self.barred, view.ball) {
            let others = view.ours.iter().filter(|robot| robot.id != barred).chain(view.theirs.iter());
            if nearest(others, ball.position).is_some_and(|(_, distance)| distance < TOUCHING) {
                self.barred = None;
            }
        }
    }

    fn age(&self, view: &View) -> Duration {
        view.now.since(self.since)
    }

    /// Open play: keeper, who is first at the ball, two defenders, the rest.
    fn open_play(&mut self, plan: &mut Plan<'_>) {
        let view = plan.view;
        let Some(ball) = view.ball else {
            plan.keeper();
            return self.defend(plan);
        };
        plan.keeper();
        if let Some(barred) = self.barred
            && plan.take(barred)
        {
            let (at, worth) = best_place(view, ball.position);
            plan.order(barred, Role::Barred, plan.facing_ball(at), Why::FreePlace { worth });
        }
        if let Some(pass) = self.pass
            && plan.take(pass.receiver)
        {
            self.first = Some(pass.receiver);
            let why = Why::BestTarget { room: support::worth(view, ball.position, pass.at) };
            plan.order(pass.receiver, Role::Receiver, Task::Receive { at: pass.at }, why);
            self.defend(plan);
            return plan.everybody(Role::Player, Task::Gameplay, Why::OpenPlay);
        }
        if view.in_their_area(ball.position, 0.0) || view.in_our_area(ball.position, 0.0) {
            // Nobody but a keeper may touch it there.
            self.first = None;
            self.defend(plan);
            return self.support(plan, ball.position);
        }
        let candidates = view.ours.iter().filter(|robot| plan.free.contains(&robot.id));
        let soonest = roles::choose(candidates, self.first, roles::WORTH, |robot| {
            let bound = if view.in_play.has(robot.id) { BOUND } else { 0.0 };
            roles::time_to(robot, ball.rest) - bound
        });
        self.first = soonest.map(|(id, _)| id);
        if let Some((id, seconds)) = soonest
            && plan.take(id)
        {
            plan.order(id, Role::Player, Task::Gameplay, Why::SoonestAtBall { seconds: seconds.max(0.0) });
        }
        // Who plays a case plays it to its end.
        for robot in view.ours.iter().filter(|robot| view.in_play.has(robot.id)) {
            if plan.free.len() > 2 && plan.take(robot.id) {
                plan.order(robot.id, Role::Player, Task::Gameplay, Why::OpenPlay);
            }
        }
        self.defend(plan);
        plan.everybody(Role::Player, Task::Gameplay, Why::OpenPlay);
    }

    /// Our ball placement: the nearest brings it, the others keep out of its way.
    fn place_ball(&mut self, plan: &mut Plan<'_>) {
        let view = plan.view;
        if let (Some(ball), Some(at)) = (view.ball, view.placement) {
            let field_players = view.ours.iter().filter(|robot| robot.id != view.keeper);
            let first = roles::choose(field_players, self.first, roles::WORTH, |robot| {
                roles::time_to(robot, ball.position)
            });
            self.first = first.map(|(id, _)| id);
            if let Some((id, seconds)) = first
                && plan.take(id)
            {
                plan.order(id, Role::Taker, Task::PlaceBall { at }, Why::SoonestAtBall { seconds });
            }
        }
        plan.keeper_guards();
        self.defend(plan);
        self.spread(plan);
    }

    /// Kick-off: ours with a taker and mates to pass to, theirs with everybody at home.
    fn kickoff(&mut self, plan: &mut Plan<'_>, side: Side) {
        let view = plan.view;
        plan.keeper_guards();
        if side == Side::Ours {
            self.taker(plan, matches!(view.phase, Phase::Kickoff(_)), false);
            self.receiver(plan);
        }
        self.defend(plan);
        let places: heapless::Vec<_, ROBOTS_MAX> = restart::kickoff_places(view).into_iter().collect();
        self.fill(plan, &places, |i| (Role::Support(i as u8), Why::Referee));
    }

    /// Free kick: ours with a taker and mates in free places, theirs with a wall and marked opponents.
    fn free_kick(&mut self, plan: &mut Plan<'_>, side: Side) {
        let view = plan.view;
        plan.keeper_guards();
        let Some(ball) = view.ball else { return self.defend(plan) };
        if side == Side::Ours {
            self.taker(plan, matches!(view.phase, Phase::FreeKick(_)), false);
            self.receiver(plan);
            self.defend(plan);
            return self.spread(plan);
        }
        self.first = None;
        self.defend(plan);
        let mut places: heapless::Vec<_, ROBOTS_MAX> = heapless::Vec::new();
        let mut whom: heapless::Vec<_, ROBOTS_MAX> = heapless::Vec::new();
        // Near our area the defenders are the wall already.
        if ball.position.distance(view.our_goal()) > WALL_BEYOND {
            let _ = places.push(restart::wall(view, &ball));
            let _ = whom.push((Role::Wall, Why::OnBallLine { y: view.our_goal().y() }));
        }
        for (i, (at, opponent)) in defence::marks(view).into_iter().enumerate() {
            let _ = places.push(at);
            let _ = whom.push((Role::Marker(i as u8), Why::Marks { opponent }));
        }
        self.fill(plan, &places, |i| whom.get(i).copied().unwrap_or((Role::Player, Why::Referee)));
        self.spread(plan);
    }

    /// Penalty: taker or keeper, everybody else behind the ball.
    fn penalty(&mut self, plan: &mut Plan<'_>, side: Side) {
        let view = plan.view;
        let started = matches!(view.phase, Phase::Penalty(_));
        if side == Side::Ours {
            self.taker(plan, started, true);
            plan.keeper_guards();
        } else if plan.take(view.keeper) {
            plan.order(view.keeper, Role::Keeper, defence::keeper_on_goal_line(view), Why::Referee);
        }
        let Some(ball) = view.ball else { return };
        let places: heapless::Vec<_, ROBOTS_MAX> = (0..plan.free.len())
            .map(|slot| restart::behind_penalty(view, &ball, side == Side::Ours, slot))
            .collect();
        self.fill(plan, &places, |i| (Role::Support(i as u8), Why::Referee));
    }

    /// Our taker: behind the ball until it may kick, then the kick.
    fn taker(&mut self, plan: &mut Plan<'_>, started: bool, penalty: bool) {
        let view = plan.view;
        let Some(ball) = view.ball else { return };
        let field_players = view.ours.iter().filter(|robot| robot.id != view.keeper);
        let chosen = roles::choose(field_players, self.first, TAKER_WORTH, |robot| {
            roles::time_to(robot, ball.position)
        });
        self.first = chosen.map(|(id, _)| id);
        let Some((id, seconds)) = chosen else { return };
        if !plan.take(id) {
            return;
        }
        if !started {
            let at = plan.kept_off(restart::taker_waits(view, view.placement.unwrap_or(ball.position)));
            return plan.order(id, Role::Taker, plan.facing_ball(at), Why::SoonestAtBall { seconds });
        }
        let wait = if penalty { Duration(0) } else { MATES_GET_READY };
        let stands = self.aim.is_some_and(|(since, _)| view.now.since(since) < AIM_STANDS);
        if self.age(view) >= wait && !stands {
            let target = if penalty {
                let (at, room) = support::best_shot(view, ball.position);
                Target::Shot { at, room }
            } else {
                support::target(view, id, ball.position)
            };
            self.aim = Some((view.now, target));
        }
        let (task, why) = restart::take(view, &ball, self.aim.map(|(_, target)| target));
        plan.order(id, Role::Taker, task, why);
    }

    /// The mate that our restart is aimed at.
    fn receiver(&mut self, plan: &mut Plan<'_>) {
        if let Some((_, Target::Mate { id, at, room })) = self.aim
            && plan.take(id)
        {
            plan.order(id, Role::Receiver, Task::Receive { at }, Why::BestTarget { room });
        }
    }

    /// Two defenders before our area.
    fn defend(&mut self, plan: &mut Plan<'_>) {
        let (places, why) = defence::defenders(plan.view);
        let places = places.map(|at| plan.kept_off(at));
        self.defenders = roles::assign(plan.view, &mut plan.free, &places, &self.defenders);
        for (i, id) in self.defenders.into_iter().enumerate() {
            if let Some(id) = id {
                plan.order(id, Role::Defender(i as u8), plan.facing_ball(places[i]), why);
            }
        }
    }

    /// Everybody left, to places where a pass can come; off the ball while it is not in play.
    fn spread(&mut self, plan: &mut Plan<'_>) {
        let view = plan.view;
        let from = view.placement.or(view.ball.map(|ball| ball.position)).unwrap_or_default();
        self.support(plan, from);
    }

    /// Everybody left, to the best places for a pass from `from`.
    fn support(&mut self, plan: &mut Plan<'_>, from: Point<Attack>) {
        let rated = support::places(plan.view, from, plan.free.len());
        let places: heapless::Vec<_, ROBOTS_MAX> = rated.iter().map(|(at, _)| *at).collect();
        self.fill(plan, &places, |i| {
            (Role::Support(i as u8), Why::FreePlace { worth: rated.get(i).map_or(0.0, |(_, worth)| *worth) })
        });
    }

    /// Robots left to places in order; who had a place keeps it.
    fn fill(&mut self, plan: &mut Plan<'_>, places: &[Point<Attack>], what: impl Fn(usize) -> (Role, Why)) {
        let places: heapless::Vec<_, ROBOTS_MAX> = places.iter().map(|at| plan.kept_off(*at)).collect();
        let wanted = places.len().min(plan.free.len());
        self.others = roles::assign(plan.view, &mut plan.free, &places[..wanted], &self.others);
        for (i, id) in self.others.into_iter().enumerate() {
            if let (Some(id), Some(at)) = (id, places.get(i)) {
                let (role, why) = what(i);
                plan.order(id, role, plan.facing_ball(*at), why);
            }
        }
    }
}

/// Orders being written, and who has none yet.
struct Plan<'v> {
    view: &'v View,
    orders: Orders,
    free: Free,
}

impl Plan<'_> {
    fn order(&mut self, robot: RobotId, role: Role, task: Task, why: Why) {
        // One order a robot, and as many places as robots.
        let _ = self.orders.push(Order { robot, role, task, why });
    }

    /// Takes a robot out of those without an order; false if it is not among them.
    fn take(&mut self, id: RobotId) -> bool {
        let before = self.free.len();
        self.free.retain(|other| *other != id);
        self.free.len() < before
    }

    /// Those with the highest numbers leave while we are too many; the keeper stays.
    fn send_off_surplus(&mut self) {
        let view = self.view;
        let surplus = self.free.len().saturating_sub(view.allowed);
        let leaving: Free = view
            .ours
            .iter()
            .rev()
            .map(|robot| robot.id)
            .filter(|id| *id != view.keeper)
            .take(surplus)
            .collect();
        for (i, id) in leaving.into_iter().enumerate() {
            self.take(id);
            let at = Point::new(0.25 * i as f32, -view.field.width * 0.5 - LEAVE_BEYOND);
            self.order(id, Role::Leaving, self.facing_ball(at), Why::TooMany { allowed: view.allowed });
        }
    }

    fn keeper(&mut self) {
        if self.take(self.view.keeper) {
            let (task, why) = defence::keeper(self.view);
            self.order(self.view.keeper, Role::Keeper, task, why);
        }
    }

    fn keeper_guards(&mut self) {
        if self.take(self.view.keeper) {
            self.order(self.view.keeper, Role::Keeper, defence::keeper_line(self.view), Why::Referee);
        }
    }

    fn everybody(&mut self, role: Role, task: Task, why: Why) {
        for id in core::mem::take(&mut self.free) {
            self.order(id, role, task, why);
        }
    }

    fn facing_ball(&self, at: Point<Attack>) -> Task {
        let face = self.view.ball.map_or(Angle::ZERO, |ball| at.direction_to(ball.position));
        Task::GoTo { at, face }
    }

    /// Off the ball unless it is in play.
    fn kept_off(&self, at: Point<Attack>) -> Point<Attack> {
        if self.view.phase == Phase::Run { at } else { restart::kept_off(self.view, at) }
    }
}

fn best_place(view: &View, ball: Point<Attack>) -> (Point<Attack>, f32) {
    support::places(view, ball, 1).first().copied().unwrap_or((Point::new(0.0, 0.0), 0.0))
}

/// Robots that leave stand this far beyond the touch line, m: off the playing area, on the carpet.
const LEAVE_BEYOND: f32 = 0.15;
/// Field players besides keeper, first and defenders.
const OTHERS: usize = 8;
/// A robot that plays a case counts as this much nearer to the ball, s: changing hands would end the case.
const BOUND: f32 = 1.0;
/// How much sooner another robot must be at the ball to become the taker, s: more than in play, the ball lies.
const TAKER_WORTH: f32 = 1.0;
/// A robot's centre this near the ball touches it, m: radii of body and ball, and a centimetre and a half.
const TOUCHING: f32 = 0.126;
/// Mates are given this long to take their places before a restart is aimed, of the 5 s (A) that the rules give: they are there since
/// the ball was placed, and run on while the taker goes around it.
const MATES_GET_READY: Duration = Duration::millis(200);
/// A pass is not waited for longer: 5 m take 2.5 s.
const PASS_LASTS: Duration = Duration::millis(3000);
/// It has not begun before this: the ball is known to have moved, but not yet how fast.
const PASS_BEGINS: Duration = Duration::millis(300);
/// A ball slower than this goes nowhere any more, m/s.
const PASS_STOPPED: f32 = 0.3;
/// A target once chosen stands for this long: to walk around the ball, aim and kick.
const AIM_STANDS: Duration = Duration::millis(3000);
/// Nearer to our goal than this the defenders are the wall, m.
const WALL_BEYOND: f32 = 2.2;

#[cfg(test)]
mod tests;
