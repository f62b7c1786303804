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
mod challenge;
mod defence;
mod open_play;
mod pass_state;
mod penalty;
mod plan;
mod playable;
mod rated_play;
mod set_piece;
mod support;
mod uncover;

use casebase::CaseBase;
use motion::ball::BallModel;
use motion::ball::chip::ChipModel;
use protocol::{Duration, Instant, RobotId};
use rules::{League, Phase, Side};

use super::bench::Bench;
use super::counters::Sent;
use super::opponents::{OpponentModel, Team};
use super::order::{Order, OrderReason, Role, Task};
use super::pass::{Kicks, PassConstants, PassSearch};
use super::proposal::cases_of;
use super::roles::RoleMemory;
use super::tactics::Tactics;
use super::view::{ROBOTS_MAX, View};
use defence::DefenceState;
use open_play::OpenPlayState;
use pass_state::PassState;
use plan::Plan;
use set_piece::RestartState;
use support::SupportState;

/// A pass of the rated list arrives with this speed, m/s. In 20 matches of 120 s against itself the ball was
/// in play for 49 % at 3.5, 52 % at 2.5, and 54 % at 2 with two thirds of the goals.
const RATED_PASS_ARRIVAL_M_S: f32 = 2.5;
/// Seed of all searches for places: one seed, one match.
const SEARCH_SEED: u64 = 1;

/// All orders of one moment, by robot.
pub type Orders = heapless::Vec<Order, ROBOTS_MAX>;
type Free = heapless::Vec<RobotId, ROBOTS_MAX>;

/// Chooses an order for every robot; see [`Coach::decide`].
#[derive(Clone, Debug)]
pub struct Coach {
    team: Team,
    /// Another team's open play, where it is not ours.
    model: Option<OpponentModel>,
    tactics: Tactics,
    /// Values passes, with our kicks.
    passes: PassSearch,
    bench: Bench,
    /// The phase of the newest view, and since when it lasts.
    phase: Option<(Phase<Side>, Instant)>,
    roles: RoleMemory,
    restart: RestartState,
    pass: PassState,
    open_play: OpenPlayState,
    defence: DefenceState,
    support: SupportState,
}

impl Coach {
    /// The coach of `team`, by a league's rules; `tactics` applies to our own team only.
    pub fn new(team: Team, tactics: Tactics, league: League) -> Self {
        let tactics = if team == Team::Ours { tactics } else { Tactics::NONE };
        let mut constants = PassConstants::of(league);
        if tactics.rated {
            constants.arrival = RATED_PASS_ARRIVAL_M_S;
        }
        Self {
            team,
            model: OpponentModel::of(team),
            tactics,
            passes: PassSearch::new(
                Kicks::new(constants, BallModel::default(), ChipModel::default()),
                SEARCH_SEED,
            ),
            bench: Bench::default(),
            phase: None,
            roles: RoleMemory::default(),
            restart: RestartState::new(league),
            pass: PassState::default(),
            open_play: OpenPlayState::new(cases_of(league)),
            defence: DefenceState::default(),
            support: SupportState::default(),
        }
    }

    /// The same, retrieving from this case base in place of the one that comes with the league.
    #[must_use]
    pub fn playing(mut self, cases: CaseBase<'static>) -> Self {
        self.open_play.rated.cases = cases;
        self
    }

    /// Plays these tactics from now on; plans that run are given up.
    pub fn set_tactics(&mut self, tactics: Tactics, league: League) {
        let (ground, cases) = (*self.passes.kicks().ground(), self.open_play.rated.cases);
        *self = Self::new(self.team, tactics, league).playing(cases);
        self.set_ground(ground);
    }

    /// Sets the model of balls on this field's ground.
    pub fn set_ground(&mut self, ground: BallModel) {
        let constants = *self.passes.kicks().constants();
        self.passes.set_kicks(Kicks::new(constants, ground, ChipModel::default()));
    }

    /// Orders for all our robots of the view, one each, by id.
    pub fn decide(&mut self, view: &View) -> Orders {
        let stands = self.team == Team::Idle || matches!(view.phase, Phase::Halt | Phase::Timeout(_));
        let off = self.bench.choose(view, self.roles.ball_player);
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
                    plan.orders.extend(model.open_play(view, &mut plan.free, self.pass.double_touch_blocked));
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

    /// Updates phase, its age, the running pass, and the robot that must not touch the ball.
    fn remember(&mut self, view: &View) {
        if self.phase.map(|(phase, _)| phase) != Some(view.phase) {
            self.enter_phase(view);
        }
        self.pass.update(view);
    }

    fn enter_phase(&mut self, view: &View) {
        let taken = view.phase == Phase::Run
            && matches!(
                self.phase,
                Some((
                    Phase::FreeKick(Side::Ours) | Phase::Kickoff(Side::Ours) | Phase::Penalty(Side::Ours),
                    _
                ))
            );
        self.pass.double_touch_blocked = self.roles.ball_player.filter(|_| taken);
        self.pass.running = if taken { self.restart_pass(view) } else { None };
        self.phase = Some((view.phase, view.now));
        self.restart.reset();
        self.open_play.reset();
    }

    /// The pass that has left since the last call.
    pub fn take_sent(&mut self) -> Option<Sent> {
        self.pass.sent.take()
    }

    fn age(&self, view: &View) -> Duration {
        self.phase.map_or(Duration(0), |(_, since)| view.now.since(since))
    }
}

#[cfg(test)]
mod tests;
