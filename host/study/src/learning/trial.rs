//! `trial`: what learning keeps of a trial: how it ended, and every decision with its situation.

use arena::{CycleEnd, Moment, TEAM, TrialConfig, TrialReport, Watcher, run};
use casebase::{PointMm, Problem};
use geometry::GoalEnd;
use hil_sim::{NativeBackend, SimulationError, TrialOutcome};
use protocol::decision::{DecisionReport, Grounds};
use protocol::{CycleId, RobotId};
use serde::{Deserialize, Serialize};

/// Positions of everything when a robot decided, mm, field frame.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Situation {
    /// The ball.
    #[serde(rename = "b")]
    pub ball: [i32; 2],
    /// Whether the goal at +x is defended.
    #[serde(rename = "g", default, skip_serializing_if = "std::ops::Not::not")]
    pub defending_positive: bool,
    /// The robots of the team that can play, by id.
    #[serde(rename = "t")]
    pub teammates: Vec<(u8, [i32; 2])>,
    /// The opponents.
    #[serde(rename = "o")]
    pub opponents: Vec<[i32; 2]>,
}

/// One decision of a trial.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TrialDecision {
    /// The situation it was made in.
    #[serde(rename = "s")]
    pub situation: Situation,
    /// Id of the case played, in the library of the trial; none if no case was.
    #[serde(rename = "c")]
    pub case: Option<u16>,
    /// Whether it is retrieval's answer alone.
    #[serde(rename = "r")]
    pub retrieved: bool,
    /// End of the play, by its place in [`CycleEnd::LABELS`].
    #[serde(rename = "e")]
    pub end: Option<u8>,
}

/// A trial's outcome and decisions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LearningTrial {
    /// End of the trial.
    #[serde(rename = "o")]
    pub outcome: TrialOutcome,
    /// Times that the defender had the ball.
    #[serde(rename = "p")]
    pub touches: u32,
    /// Decisions, in order; empty where they are not recorded.
    #[serde(rename = "d", default, skip_serializing_if = "Vec::is_empty")]
    pub decisions: Vec<TrialDecision>,
}

impl LearningTrial {
    /// The paper's "to goal": goal or close.
    pub fn to_goal(&self) -> bool {
        matches!(self.outcome, TrialOutcome::Goal | TrialOutcome::Close)
    }
}

/// Limits of a ball in play along x and y, mm: inside the lines of 2700 and 1800 mm.
const BALL_INSIDE: [i32; 2] = [2650, 1750];

impl Situation {
    /// Whether a trial can be played from here: both robots and both opponents are known, the goal at -x is
    /// defended, and the ball is in play.
    pub fn is_usable(&self) -> bool {
        let [x, y] = self.ball;
        !self.defending_positive
            && self.teammates.len() == 2
            && self.opponents.len() == 2
            && x.abs() < BALL_INSIDE[0]
            && y.abs() < BALL_INSIDE[1]
    }

    /// The problem of retrieval; robots with faulty ids and those above the largest team are left out.
    pub fn problem(&self) -> Problem {
        let point = |[x, y]: [i32; 2]| PointMm { x, y };
        Problem {
            ball: point(self.ball),
            defending: if self.defending_positive { GoalEnd::Positive } else { GoalEnd::Negative },
            teammates: (self.teammates.iter())
                .filter_map(|(id, at)| Some((RobotId::new(*id)?, point(*at))))
                .take(casebase::PROBLEM_TEAMMATES_MAX)
                .collect(),
            opponents: (self.opponents.iter())
                .map(|at| point(*at))
                .take(casebase::PROBLEM_OPPONENTS_MAX)
                .collect(),
        }
    }

    /// The situation of a problem.
    pub fn of(problem: &Problem) -> Self {
        let point = |at: PointMm| [at.x, at.y];
        Self {
            ball: point(problem.ball),
            defending_positive: problem.defending == GoalEnd::Positive,
            teammates: problem.teammates.iter().map(|(id, at)| (id.number(), point(*at))).collect(),
            opponents: problem.opponents.iter().map(|at| point(*at)).collect(),
        }
    }
}

/// Plays a trial; with its decisions if `record` is set.
pub(crate) fn play(config: &TrialConfig<'_>, record: bool) -> Result<LearningTrial, SimulationError> {
    let mut recorder = Recorder::default();
    let mut watchers: Vec<&mut dyn Watcher> = Vec::new();
    if record {
        watchers.push(&mut recorder);
    }
    debug_assert_eq!(TEAM.0, 1, "the attackers' team");
    let report = run(config, Box::new(NativeBackend::new(config.base)), &mut watchers)?;
    Ok(recorder.trial(&report))
}

/// Keeps the decisions of a trial, as a [`Watcher`].
#[derive(Clone, Debug, Default)]
pub(crate) struct Recorder {
    decisions: Vec<(CycleId, TrialDecision)>,
}

impl Recorder {
    pub(crate) fn trial(self, report: &TrialReport) -> LearningTrial {
        LearningTrial {
            outcome: report.outcome,
            touches: report.possession.defender + report.possession.midfield,
            decisions: self.decisions.into_iter().map(|(_, decision)| decision).collect(),
        }
    }

    fn add(&mut self, report: &DecisionReport) {
        let Some(problem) = Problem::of(report) else { return };
        let decision = TrialDecision {
            situation: Situation::of(&problem),
            case: report.case.map(|case| case.0),
            retrieved: report.grounds == Grounds::Retrieved,
            end: None,
        };
        self.decisions.push((report.cycle, decision));
    }
}

impl Watcher for Recorder {
    fn watch(&mut self, moment: &Moment<'_>) {
        for (_, report) in moment.decisions {
            self.add(report);
        }
    }

    fn end(&mut self, moment: &Moment<'_>, _report: &TrialReport) {
        for (id, decision) in &mut self.decisions {
            let cycle = moment.cycles.cycles().iter().find(|cycle| cycle.id == *id);
            let end = cycle.and_then(|cycle| cycle.end).map_or(CycleEnd::TrialOver, |(_, end)| end);
            let place = CycleEnd::LABELS.iter().position(|label| *label == end.label());
            decision.end = place.and_then(|place| u8::try_from(place).ok());
        }
    }
}
