//! `coach`: the plan for each phase of the game: one order per robot of ours, every time the world model
//! changes (docs/architecture.md §3.3).
//!
//! In open play the keeper guards, two defenders stand before the area, and the robot that is first at the
//! ball shoots or passes where that is worth it; else it and all remaining robots play cases, which the
//! robots choose among themselves. While the ball is not in play the coach orders every robot. It remembers
//! which robot had which role (so that roles do not flicker), since when the phase lasts, and which robot
//! took our restart (it must not touch the ball twice). [`Tactics`] selects which parts of the second paper
//! it uses.

mod ahead;
mod attack;
mod cap;
mod defence;
mod open_play;
mod penalty;
mod plan;
mod rated_play;
mod set_piece;
mod uncover;

use casebase::CaseBase;
use geometry::{Attack, Point};
use motion::ball::BallModel;
use motion::ball::chip::ChipModel;
use protocol::{Duration, Instant, RobotId};
use rules::{League, Phase, Side, contact};

use super::bench::Bench;
use super::counters::Sent;
use super::opponents::{OpponentModel, Team};
use super::order::{Order, OrderReason, Role, Task};
use super::pass::{Kicks, PassConstants, Searches};
use super::possession::Possession;
use super::proposal::cases_of;
use super::rated::RatedList;
use super::support::{self, Target};
use super::tactics::Tactics;
use super::threat;
use super::view::{ROBOTS_MAX, View, ViewRobot, nearest};
use super::{restart, roles};
use ahead::Ahead;
use attack::Intent;
use cap::Cap;
use defence::Clearing;
use plan::Plan;
use rated_play::Chosen;
use uncover::Uncovering;

/// All orders of one moment, by robot.
pub type Orders = heapless::Vec<Order, ROBOTS_MAX>;
type Free = heapless::Vec<RobotId, ROBOTS_MAX>;

/// A pass whose ball is moving.
#[derive(Clone, Copy, Debug)]
struct Pass {
    receiver: RobotId,
    at: Point<Attack>,
    /// Shot on at this point at first touch.
    then: Option<Point<Attack>>,
    since: Instant,
}

/// Places for a pass that are kept for a while.
#[derive(Clone, Debug)]
struct Settled {
    /// Where the ball is, or will be.
    from: Point<Attack>,
    since: Instant,
    /// The places with their values, 0–1.
    places: heapless::Vec<(Point<Attack>, f32), ROBOTS_MAX>,
}

/// Chooses an order for every robot; see [`Coach::decide`].
#[derive(Clone, Debug)]
pub struct Coach {
    team: Team,
    /// Another team's open play, where it is not ours.
    model: Option<OpponentModel>,
    tactics: Tactics,
    /// Models of kicks and rolling balls, for the values of passes.
    kicks: Kicks,
    /// The cases that come with the league.
    cases: CaseBase<'static>,
    searches: Searches,
    threats: threat::Memory,
    bench: Bench,
    phase: Option<Phase<Side>>,
    since: Instant,
    /// The robot that goes for the ball, or takes our restart.
    first: Option<RobotId>,
    defenders: [Option<RobotId>; 2],
    others: [Option<RobotId>; OTHERS],
    /// What our restart is aimed at, since when.
    aim: Option<(Instant, Target)>,
    /// The pass ahead that our restart is to be.
    ahead: Option<Ahead>,
    cap: Cap,
    /// A pass ahead was not completed in time at this restart.
    gave_up: bool,
    /// The ball's distance to its place in our placement, m, and since when.
    placing: Option<(f32, Instant)>,
    /// Whether opponents have the ball.
    attacked: bool,
    /// Whether a primary defender has joined the attack.
    attacks: bool,
    /// The pass of our restart that is running.
    pass: Option<Pass>,
    /// Where the ball of our restart lay.
    ball_lay: Option<Point<Attack>>,
    /// A pass that has just left, until the caller takes it.
    sent: Option<Sent>,
    /// The robot that took our restart, until another robot touches the ball.
    double_touch_blocked: Option<RobotId>,
    /// The shot, pass or case chosen for the ball of open play.
    intent: Option<Intent>,
    /// The passer of open play that was at the ball last, and when.
    at_ball: Option<(RobotId, Instant)>,
    /// Who has the ball of open play.
    possession: Possession,
    /// The action chosen from the rated list.
    chosen: Option<Chosen>,
    /// The list that it was chosen from.
    list: RatedList,
    /// Whether the ball that is before our area is left to the keeper.
    keepers: Option<bool>,
    /// Where supporters stand while the ball is not in play.
    settled: Option<Settled>,
    /// Where supporters stood last in open play.
    stood: heapless::Vec<Point<Attack>, ROBOTS_MAX>,
    /// Target of the clearance of a ball in our area or before it.
    clearing: Option<Clearing>,
    /// The robot that makes way so that cameras see the ball.
    uncovering: Option<Uncovering>,
}

impl Coach {
    /// The coach of `team`, by a league's rules; `tactics` applies to our own team only.
    pub fn new(team: Team, tactics: Tactics, league: League) -> Self {
        let tactics = if team == Team::Ours { tactics } else { Tactics::NONE };
        let mut constants = PassConstants::of(league);
        if tactics.rated {
            constants.arrival = ARRIVES_WITH;
        }
        Self {
            team,
            model: OpponentModel::of(team),
            tactics,
            kicks: Kicks::new(constants, BallModel::default(), ChipModel::default()),
            cases: cases_of(league),
            searches: Searches::new(SEARCH_SEED),
            threats: threat::Memory::default(),
            bench: Bench::default(),
            phase: None,
            since: Instant::default(),
            first: None,
            defenders: [None; 2],
            others: [None; OTHERS],
            aim: None,
            ahead: None,
            cap: Cap::new(league),
            ball_lay: None,
            sent: None,
            gave_up: false,
            placing: None,
            attacked: false,
            attacks: false,
            pass: None,
            double_touch_blocked: None,
            intent: None,
            at_ball: None,
            possession: Possession::Free,
            chosen: None,
            list: RatedList::new(),
            keepers: None,
            settled: None,
            stood: heapless::Vec::new(),
            clearing: None,
            uncovering: None,
        }
    }

    /// The same, retrieving from this case base in place of the one that comes with the league.
    #[must_use]
    pub fn playing(self, cases: CaseBase<'static>) -> Self {
        Self { cases, ..self }
    }

    /// Plays these tactics from now on; plans that run are given up.
    pub fn set_tactics(&mut self, tactics: Tactics, league: League) {
        let (ground, cases) = (*self.kicks.ground(), self.cases);
        *self = Self::new(self.team, tactics, league).playing(cases);
        self.set_ground(ground);
    }

    /// Sets the model of balls on this field's ground.
    pub fn set_ground(&mut self, ground: BallModel) {
        self.kicks = Kicks::new(*self.kicks.constants(), ground, ChipModel::default());
    }

    /// Orders for all our robots of the view, one each, by id.
    pub fn decide(&mut self, view: &View) -> Orders {
        let stands = self.team == Team::Idle || matches!(view.phase, Phase::Halt | Phase::Timeout(_));
        let off = self.bench.choose(view, self.first);
        if stands || off.is_empty() {
            return self.direct(view);
        }
        // A robot off the field takes no part: no role, no pass, no place.
        let playing = view.without(off);
        let leaving = self.bench.orders(view);
        let mut orders = self.direct(&playing);
        orders.extend(leaving);
        orders.sort_unstable_by_key(|order| order.robot);
        orders
    }

    /// Orders for all robots that play.
    fn direct(&mut self, view: &View) -> Orders {
        self.remember(view);
        self.observe(view);
        let mut plan = Plan::new(view);
        match view.phase {
            _ if self.team == Team::Idle => plan.all_robots(Role::Player, Task::Stand, OrderReason::Idle),
            Phase::Halt | Phase::Timeout(_) => {
                plan.all_robots(Role::Player, Task::Stand, OrderReason::Referee);
            }
            Phase::Run => match &mut self.model {
                Some(model) => {
                    plan.orders.extend(model.open_play(view, &mut plan.free, self.double_touch_blocked));
                }
                None if self.tactics.attack && self.tactics.rated => self.rated_play(&mut plan),
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
        plan.stay_legal();
        plan.orders.sort_unstable_by_key(|order| order.robot);
        plan.orders
    }

    /// Updates phase, its age, and the robot that must not touch the ball.
    fn remember(&mut self, view: &View) {
        if self.phase != Some(view.phase) {
            let taken = matches!(
                self.phase,
                Some(Phase::FreeKick(Side::Ours) | Phase::Kickoff(Side::Ours) | Phase::Penalty(Side::Ours))
            );
            self.double_touch_blocked = if view.phase == Phase::Run && taken { self.first } else { None };
            self.pass = match self.aim {
                _ if view.phase != Phase::Run || !taken => None,
                Some((_, Target::Teammate { id, at, .. })) => {
                    self.sent = self.sent(view, id, at);
                    let shot = self.ahead.map(|ahead| ahead.rating.shot).filter(|shot| shot.one_touch);
                    Some(Pass { receiver: id, at, then: shot.map(|shot| shot.aim), since: view.now })
                }
                _ => self.passing().map(|pass| self.leaves(view, pass)),
            };
            self.phase = Some(view.phase);
            self.aim = None;
            (self.intent, self.chosen, self.possession) = (None, None, Possession::Free);
            self.placing = None;
            (self.ahead, self.gave_up) = (None, false);
            self.cap.forget();
            self.since = view.now;
        }
        if let (Some(pass), Some(ball)) = (self.pass, view.ball) {
            let age = view.now.since(pass.since);
            let had = |robots: &[ViewRobot], who: &dyn Fn(RobotId) -> bool| {
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
        if let (Some(double_touch_blocked), Some(ball)) = (self.double_touch_blocked, view.ball) {
            let others =
                view.ours.iter().filter(|robot| robot.id != double_touch_blocked).chain(view.theirs.iter());
            if nearest(others, ball.position).is_some_and(|(_, distance)| distance < TOUCHING) {
                self.double_touch_blocked = None;
            }
        }
    }

    /// The pass that has left since the last call.
    pub fn take_sent(&mut self) -> Option<Sent> {
        self.sent.take()
    }

    fn age(&self, view: &View) -> Duration {
        view.now.since(self.since)
    }

    /// Sends all remaining robots to places where a pass can come; off the ball while it is not in play.
    fn spread(&mut self, plan: &mut Plan<'_>) {
        let view = plan.view;
        let from = view.placement.or(view.ball.map(|ball| ball.position)).unwrap_or_default();
        self.support(plan, from);
    }

    /// Sends all remaining robots to the best places for a pass from `from`. While the ball is not in play
    /// they are held for a while: the opponents stand where our robots are, and ours go where they are not,
    /// so that both would move for the whole stop.
    fn support(&mut self, plan: &mut Plan<'_>, from: Point<Attack>) {
        let (view, wanted) = (plan.view, plan.free.len());
        let settled = self.settled.take().filter(|settled| {
            view.phase != Phase::Run
                && settled.places.len() >= wanted
                && settled.from.distance(from) < SETTLED_FROM
                && view.now.since(settled.since) < SETTLED_FOR
        });
        let settled = settled.unwrap_or_else(|| Settled {
            from,
            since: view.now,
            places: support::places(view, from, wanted),
        });
        self.fill_support(plan, settled);
    }

    /// Sends all remaining robots to where a pass from `from` by `passer` would be worth most.
    fn support_pass(&mut self, plan: &mut Plan<'_>, from: Point<Attack>, passer: Option<RobotId>) {
        let (view, wanted) = (plan.view, plan.free.len());
        if wanted == 0 {
            return;
        }
        let settled = self.settled.take().filter(|settled| {
            settled.places.len() >= wanted
                && settled.from.distance(from) < SETTLED_FROM
                && view.now.since(settled.since) < MOVES_EVERY
        });
        let settled = settled.unwrap_or_else(|| {
            let free: heapless::Vec<RobotId, ROBOTS_MAX> = plan.free.iter().copied().collect();
            let others = view.without(&free);
            let places = support::pass_places(&others, &self.kicks, from, passer, wanted, &self.stood);
            self.stood = places.iter().map(|(at, _)| *at).collect();
            Settled { from, since: view.now, places }
        });
        self.fill_support(plan, settled);
    }

    /// Sends remaining robots to these places as supporters, and keeps the places.
    fn fill_support(&mut self, plan: &mut Plan<'_>, settled: Settled) {
        let rated = settled.places.clone();
        self.settled = Some(settled);
        let places: heapless::Vec<_, ROBOTS_MAX> = rated.iter().map(|(at, _)| *at).collect();
        self.fill(plan, &places, |i| {
            (
                Role::Support(i as u8),
                OrderReason::FreePlace { worth: rated.get(i).map_or(0.0, |(_, worth)| *worth) },
            )
        });
    }

    /// Sends remaining robots to places in order; a robot that had a place keeps it.
    fn fill(
        &mut self,
        plan: &mut Plan<'_>,
        places: &[Point<Attack>],
        what: impl Fn(usize) -> (Role, OrderReason),
    ) {
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

/// A pass of the rated list arrives with this speed, m/s. In 20 matches of 120 s against itself the ball was
/// in play for 49 % at 3.5, 52 % at 2.5, and 54 % at 2 with two thirds of the goals.
const ARRIVES_WITH: f32 = 2.5;
/// Most robots that get a place in order: all field players, as behind a penalty of the opponents.
const OTHERS: usize = 10;
/// A robot's centre this near the ball touches it, m.
const TOUCHING: f32 = contact::COACH_TOUCHES_WITHIN;
/// A pass is not waited for longer: 5 m take 2.5 s.
const PASS_LASTS: Duration = Duration::millis(3000);
/// Before this its speed is not used: the ball is known to have moved, but not yet how fast.
const PASS_BEGINS: Duration = Duration::millis(300);
/// A ball slower than this counts as stopped, m/s.
const PASS_STOPPED: f32 = 0.3;

/// Places are kept while the ball, or where it is placed, is within this of where it was, m …
const SETTLED_FROM: f32 = 0.5;
/// … and no longer than this: to cross half of division A's field and stop.
const SETTLED_FOR: Duration = Duration::millis(6000);
/// In open play places are searched again at this interval.
const MOVES_EVERY: Duration = Duration::millis(200);
/// Seed of all searches for places: one seed, one match.
const SEARCH_SEED: u64 = 1;

#[cfg(test)]
mod tests;
