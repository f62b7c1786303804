//! `settings`: what an episode is started with, and how it may end. m, s.

use hil_sim::TEAM;
use hil_sim::small_size::worlds::WorldPlan;
use rules::{Colour, League};
use serde::{Deserialize, Serialize};

use crate::computers::{self, TICK_MS};
use crate::driver::Driver;
use crate::legged;
use crate::task::Task;

/// Task, league, robots and times of an episode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// What is to be done.
    pub task: Task,
    /// League, whose field and physics are simulated.
    pub league: League,
    /// Number of own robots.
    pub own: usize,
    /// Number of opponents.
    pub opponents: usize,
    /// Number of own robots, from 0, that the caller moves.
    pub agents: usize,
    /// Who moves the other own robots.
    pub teammates_by: Driver,
    /// Who moves the opponents.
    pub opponents_by: Driver,
    /// The world of each seed.
    pub world: WorldPlan,
    /// What is observed.
    pub observation: Observation,
    /// Control period, ms: orders stay as they are in between.
    pub period_ms: u32,
    /// Simulated time after which the episode ends, s.
    pub time_limit_s: f64,
}

impl Settings {
    /// Leagues with wheeled robots.
    pub const LEAGUES: [League; 3] = [League::DivisionB, League::DivisionA, League::Ssl2013];

    /// The control period unless the caller sets another, ms: a multiple of computers' steps where they play.
    pub fn default_period_ms(&self) -> u32 {
        match self.tick_ms() {
            TICK_MS => COMPUTERS_PERIOD_MS,
            1 => PERIOD_MS,
            tick => tick,
        }
    }

    /// Time that the simulator is advanced by at once, ms.
    pub fn tick_ms(&self) -> u32 {
        match self.task.spec().scenario {
            Some(_) => legged::TICK_MS,
            None if computers::are_needed(self) => TICK_MS,
            None => 1,
        }
    }

    /// The error of the first value that cannot be played, which it names.
    pub fn check(&self) -> Result<(), String> {
        let Self { league, own, opponents, agents, period_ms, time_limit_s, .. } = *self;
        if self.task.spec().scenario.is_some() {
            self.check_trial()?;
        } else if [self.teammates_by, self.opponents_by].contains(&Driver::TwoDefenders) {
            return Err(
                "opponents_by \"two-defenders\": only in the tasks \"scenario-1\" and following".to_owned()
            );
        } else if !Self::LEAGUES.contains(&league) {
            let known = Self::LEAGUES.map(League::name).join(" or ");
            return Err(format!("league {:?}: take {known}", league.name()));
        }
        if !(1..=ROBOTS_MAX).contains(&own) || opponents > ROBOTS_MAX {
            return Err(format!(
                "own {own}, opponents {opponents}: take 1 to {ROBOTS_MAX} own robots and at most {ROBOTS_MAX} opponents"
            ));
        }
        if !(1..=own).contains(&agents) {
            return Err(format!("agents {agents}: take 1 to {own}, the number of own robots"));
        }
        if self.task == Task::PassAndReceive && own < 2 {
            return Err(format!("own {own}: pass-and-receive takes 2 own robots at least"));
        }
        if !(1..=PERIOD_MAX_MS).contains(&period_ms) {
            return Err(format!("period_ms {period_ms}: take 1 to {PERIOD_MAX_MS} ms"));
        }
        let tick_ms = self.tick_ms();
        if !period_ms.is_multiple_of(tick_ms) {
            return Err(format!(
                "period_ms {period_ms}: robots' computers and referee step every {tick_ms} ms; take a multiple of it"
            ));
        }
        if time_limit_s.is_nan() || time_limit_s <= 0.0 {
            return Err(format!("time_limit_s {time_limit_s}: take more than 0 s"));
        }
        Ok(())
    }

    /// The same of a trial of the first paper.
    fn check_trial(&self) -> Result<(), String> {
        let Self { task, own, opponents, teammates_by, opponents_by, .. } = self;
        let wrong = if self.league != League::FourLegged {
            format!("league {:?}: take \"four-legged\"", self.league.name())
        } else if *own > TEAM || *opponents > legged::OPPONENTS_MAX {
            let most = legged::OPPONENTS_MAX;
            format!("own {own}, opponents {opponents}: take at most {TEAM} own robots and {most} opponents")
        } else if !matches!(teammates_by, Driver::None | Driver::Coach) {
            format!("teammates_by {:?}: take none or coach", teammates_by.label())
        } else if !matches!(opponents_by, Driver::None | Driver::Scripted | Driver::TwoDefenders) {
            format!("opponents_by {:?}: take scripted, two-defenders or none", opponents_by.label())
        } else if self.world != WorldPlan::default() {
            "world: take nominal".to_owned()
        } else if self.observation != Observation::Truth {
            format!("observation {:?}: take truth", self.observation.label())
        } else {
            return Ok(());
        };
        Err(format!("{wrong} in the task {:?}", task.label()))
    }

    /// Number of robots of a side.
    pub fn count(&self, side: Colour) -> usize {
        side.pick(self.opponents, self.own)
    }

    /// Who moves a side's robots that the caller does not.
    pub fn driver(&self, side: Colour) -> Driver {
        side.pick(self.opponents_by, self.teammates_by)
    }

    /// Number of values in the caller's orders to a side.
    pub fn action_len(&self, side: Colour) -> usize {
        ACTION_LEN * side.pick(self.opponents, self.agents)
    }

    /// Number of values in an observation.
    pub fn observation_len(&self) -> usize {
        let referee = if self.task.spec().referee { REFEREE_LEN } else { 0 };
        BALL_LEN + ROBOT_LEN * (self.own + self.opponents) + referee
    }
}

geometry::labels! {
    /// End of an episode.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    pub enum End {
        /// The ball is in the opponents' goal.
        Goal = "goal",
        /// The ball is in the own goal.
        OwnGoal = "own_goal",
        /// The ball left the field elsewhere, or its region.
        Out = "out",
        /// The pass has been received.
        Received = "received",
        /// Own robots have held the ball long enough.
        Won = "won",
        /// Opponents have touched the ball, or held it long enough.
        Lost = "lost",
        /// The time limit is reached.
        Time = "time",
        /// The ball left the field beside the opponents' goal, in a trial of the first paper.
        Close = "close",
    }
}

geometry::labels! {
    /// What is observed.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    pub enum Observation {
        /// The true state.
        Truth = "truth",
        /// What a host estimates from cameras, and robots' own reports of ball contact.
        Sensed = "sensed",
    }
}

/// Whose observation: that side is "own" and attacks +x, its robot `first` comes first.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// The side.
    pub side: Colour,
    /// Number of the robot that comes first.
    pub first: usize,
}

/// Robots of a team, as division A has them.
const ROBOTS_MAX: usize = 11;
/// Default control period, ms: about a camera's frame and the radio's latency; the multiple of 10 next to it.
const PERIOD_MS: u32 = 25;
const COMPUTERS_PERIOD_MS: u32 = 30;
/// Longest control period, ms: robots brake where an order is older (`order_lasts`).
const PERIOD_MAX_MS: u32 = 100;
/// Values of an order: forward, left, turn, kick, dribbler.
pub const ACTION_LEN: usize = 5;
/// Values of the ball in an observation: x, y, height, velocity along x and y.
pub const BALL_LEN: usize = 5;
/// Values of a robot: x, y, sine and cosine of the heading, velocity along x and y, turning rate, ball
/// contact.
pub const ROBOT_LEN: usize = 8;
/// Values of the referee, under one: whether the ball is in play, whose restart it is (1 this side's, -1 the
/// other's), goals ahead, share of the time that is left.
pub const REFEREE_LEN: usize = 4;
