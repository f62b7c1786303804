//! `task`: the tasks as data: robots, start, ends and reward of each. m, s; own robots attack the goal at +x.

use hil_sim::Scenario;
use serde::{Deserialize, Serialize};

use crate::driver::Driver;

geometry::labels! {
    /// A task of the one engine.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    pub enum Task {
        /// Get the ball and score.
        Score = "score",
        /// Score against a keeper, from a ball at hand.
        ShootAtKeeper = "shoot-at-keeper",
        /// The first robot passes, the second receives.
        PassAndReceive = "pass-and-receive",
        /// Get a ball that an opponent wants too, and hold it.
        ContestedBall = "contested-ball",
        /// Keep the ball from two opponents, within a square.
        KeepAway = "keep-away",
        /// A match under the referee, three a side.
        ThreeASide = "3v3",
        /// A match under the referee, six a side.
        SixASide = "6v6",
        /// The first paper's first scenario, in the four-legged league.
        Scenario1 = "scenario-1",
        /// Its second.
        Scenario2 = "scenario-2",
        /// Its third.
        Scenario3 = "scenario-3",
        /// Its fourth.
        Scenario4 = "scenario-4",
        /// The same with places drawn from the seed.
        ScenarioRandom = "scenario-random",
    }
}

/// Data of a task.
#[derive(Clone, Copy, Debug)]
pub struct TaskSpec {
    /// Number of own robots, unless the caller sets another.
    pub own: usize,
    /// Number of opponents, unless the caller sets another.
    pub opponents: usize,
    /// Who moves the opponents, unless the caller sets another.
    pub opponents_by: Driver,
    /// Simulated time after which an episode is cut off, s.
    pub time_limit_s: f64,
    /// Place of the ball at the start.
    pub ball: Place,
    /// Places of own robots in their order; the last is that of all others too.
    pub own_places: &'static [Place],
    /// The same of the opponents.
    pub opponent_places: &'static [Place],
    /// True where opponent 0 keeps the goal.
    pub keeper: bool,
    /// True where the referee judges, as in a match; places and ends are then its own.
    pub referee: bool,
    /// The first paper's scenario, whose places, robots and ends these are then.
    pub scenario: Option<Scenario>,
    /// What ends an episode besides goals, a ball off the field and time.
    pub ends: Ends,
    /// What a step earns.
    pub reward: Reward,
}

/// Ends of an episode besides goals, a ball off the field and time.
#[derive(Clone, Copy, Debug)]
pub struct Ends {
    /// True where an opponent's touch of the ball ends it: "lost".
    pub touch_loses: bool,
    /// Distance that the ball must travel from robot 0 before robot 1 has it, m: "received". 0: no such end.
    pub pass_m: f32,
    /// Time for which one side must hold the ball, s: "won" or "lost". 0: no such end.
    pub hold_s: f32,
    /// Half the sides of the rectangle around the middle that the ball must not leave, m: "out".
    pub region: Option<[f32; 2]>,
}

/// Weights of a reward. Those of distances weigh their decrease.
#[derive(Clone, Copy, Debug)]
pub struct Reward {
    /// Of the distance from the ball to the opponents' goal, 1/m.
    pub to_goal: f32,
    /// Of the distance from the ball to the nearest own robot, 1/m.
    pub to_ball: f32,
    /// Of the distance from the ball to own robot 1, 1/m.
    pub to_receiver: f32,
    /// For each second of the episode.
    pub per_s: f32,
    /// For each second in which only own robots hold the ball; minus for opponents.
    pub held_per_s: f32,
    /// For a goal, and minus for an own goal.
    pub goal: f32,
    /// For "received" and "won".
    pub success: f32,
    /// For "lost".
    pub lost: f32,
    /// For "out".
    pub out: f32,
}

/// A place at the start.
#[derive(Clone, Copy, Debug)]
pub enum Place {
    /// Anywhere in a rectangle, with any heading: shares of the way from the centre to the field's lines,
    /// from and to.
    Within([f32; 2], [f32; 2]),
    /// That far from the ball towards the own goal, facing it, m.
    BehindBall(f32),
    /// That far from the ball in any direction, facing it, m.
    AroundBall(f32),
    /// In the middle of the goal at +x.
    InGoal,
}

impl Task {
    /// Its data.
    pub const fn spec(self) -> &'static TaskSpec {
        match self {
            Self::Score => &SCORE,
            Self::ShootAtKeeper => &SHOOT_AT_KEEPER,
            Self::PassAndReceive => &PASS_AND_RECEIVE,
            Self::ContestedBall => &CONTESTED_BALL,
            Self::KeepAway => &KEEP_AWAY,
            Self::ThreeASide => &THREE_A_SIDE,
            Self::SixASide => &SIX_A_SIDE,
            Self::Scenario1 => const { &scenario(Scenario::MiddleBack) },
            Self::Scenario2 => const { &scenario(Scenario::LeftSide) },
            Self::Scenario3 => const { &scenario(Scenario::DefenderAhead) },
            Self::Scenario4 => const { &scenario(Scenario::DefenderClose) },
            Self::ScenarioRandom => const { &scenario(Scenario::Random) },
        }
    }
}

/// Goals and the way to them: a goal is worth more than any way across the field adds up to, m, and the
/// ball's way to the goal more than a robot's to the ball.
const SHOTS: Reward = Reward { to_goal: 1.0, to_ball: 0.5, goal: 10.0, ..NO_REWARD };
const NO_REWARD: Reward = Reward {
    to_goal: 0.0,
    to_ball: 0.0,
    to_receiver: 0.0,
    per_s: 0.0,
    held_per_s: 0.0,
    goal: 0.0,
    success: 0.0,
    lost: 0.0,
    out: 0.0,
};
const NO_ENDS: Ends = Ends { touch_loses: false, pass_m: 0.0, hold_s: 0.0, region: None };
/// The middle of the field, half its length and width.
const MIDDLE: Place = Place::Within([-0.5, 0.5], [-0.5, 0.5]);

const SCORE: TaskSpec = TaskSpec {
    own: 1,
    opponents: 0,
    opponents_by: Driver::None,
    time_limit_s: 30.0,
    ball: MIDDLE,
    own_places: &[Place::Within([0.0, -1.0], [-1.0, 1.0])],
    opponent_places: &[Place::Within([0.0, 1.0], [-1.0, 1.0])],
    keeper: false,
    referee: false,
    scenario: None,
    ends: NO_ENDS,
    reward: SHOTS,
};

const SHOOT_AT_KEEPER: TaskSpec = TaskSpec {
    opponents: 1,
    opponents_by: Driver::Scripted,
    time_limit_s: 10.0,
    ball: Place::Within([0.3, 0.7], [-0.5, 0.5]),
    own_places: &[Place::BehindBall(0.3)],
    opponent_places: &[Place::InGoal],
    keeper: true,
    ends: Ends { touch_loses: true, ..NO_ENDS },
    ..SCORE
};

const PASS_AND_RECEIVE: TaskSpec = TaskSpec {
    own: 2,
    time_limit_s: 10.0,
    own_places: &[Place::BehindBall(0.3), Place::AroundBall(2.5)],
    ends: Ends { pass_m: 1.0, ..NO_ENDS },
    reward: Reward { to_receiver: 1.0, to_ball: 0.5, success: 10.0, out: -5.0, ..NO_REWARD },
    ..SCORE
};

const CONTESTED_BALL: TaskSpec = TaskSpec {
    opponents: 1,
    opponents_by: Driver::Scripted,
    time_limit_s: 10.0,
    own_places: &[Place::AroundBall(1.0)],
    opponent_places: &[Place::AroundBall(1.0)],
    ends: Ends { hold_s: 1.0, ..NO_ENDS },
    reward: Reward {
        to_ball: 0.5,
        held_per_s: 1.0,
        goal: 10.0,
        success: 10.0,
        lost: -10.0,
        out: -5.0,
        ..NO_REWARD
    },
    ..SCORE
};

const KEEP_AWAY: TaskSpec = TaskSpec {
    own: 3,
    opponents: 2,
    opponents_by: Driver::Scripted,
    time_limit_s: 20.0,
    ball: Place::Within([-0.1, 0.1], [-0.1, 0.1]),
    own_places: &[Place::BehindBall(0.3), Place::AroundBall(1.5)],
    opponent_places: &[Place::AroundBall(1.5)],
    ends: Ends { touch_loses: true, region: Some([2.0, 2.0]), ..NO_ENDS },
    reward: Reward { per_s: 1.0, lost: -5.0, out: -5.0, ..NO_REWARD },
    ..SCORE
};

const THREE_A_SIDE: TaskSpec = TaskSpec {
    own: 3,
    opponents: 3,
    opponents_by: Driver::Coach,
    time_limit_s: 120.0,
    keeper: true,
    referee: true,
    ..SCORE
};

const SIX_A_SIDE: TaskSpec = TaskSpec { own: 6, opponents: 6, ..THREE_A_SIDE };

/// A trial of the first paper: two attackers against two opponents, for the 60 s of its trials against two
/// defenders (§5.2.2).
const fn scenario(scenario: Scenario) -> TaskSpec {
    TaskSpec {
        own: 2,
        opponents: 2,
        opponents_by: Driver::Scripted,
        time_limit_s: 60.0,
        scenario: Some(scenario),
        ..SCORE
    }
}
