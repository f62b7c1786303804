//! `ranking`: many problems against every case of a library: the k most similar cases with the terms of their
//! similarity. mm, field frame; problems come as arrays.
//!
//! The similarity of a case is the weighted mean of its terms' local similarities, each a function of a
//! distance ([`casebase::Terms`]); what a problem does not know is treated by a rule of the caller.

use casebase::{Case, CaseBase, GoalEnd, PointMm, Presence, Problem, RetrievalSettings, Terms};
use protocol::RobotId;

/// Terms of a similarity, in their order: ball, robots, scopes, path.
pub const TERMS: [&str; 4] = ["ball", "robots", "scopes", "path"];
/// Most players of a case.
pub const PLAYERS: usize = casebase::TEAMMATES_MAX;

geometry::labels! {
    /// What an unknown attribute's term counts.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Unknown {
        /// Nothing: its weight is left out.
        Ignore = "ignore",
        /// As unlike.
        Worst = "worst",
        /// As alike.
        Best = "best",
    }
}

/// How similar two values at a distance are.
#[derive(Clone, Debug)]
pub enum Local {
    /// exp(−d²), the paper's.
    Gauss,
    /// 1 − d, at least 0.
    Linear,
    /// Values at every 1 / [`SAMPLES_PER_UNIT`] of the distance from 0, straight lines between them; beyond,
    /// the last.
    Table(Vec<f32>),
}

/// A similarity of the caller.
#[derive(Clone, Debug)]
pub struct Similarity {
    /// Weights of the [`TERMS`], 0 or more.
    pub weights: [f32; TERMS.len()],
    /// Their local similarities.
    pub local: [Local; TERMS.len()],
    /// What unknown attributes count.
    pub unknown: Unknown,
}

/// A problem of which parts may be unknown.
#[derive(Clone, Debug)]
pub struct PartialProblem {
    /// Its known parts, anything where they are unknown.
    problem: Problem,
    /// The ball, if it is given; else the ball of each case counts.
    pub ball: Option<PointMm>,
    /// The goal, and so the cases, if it is given.
    pub defending: Option<GoalEnd>,
    /// Whether teammates are given.
    pub teammates_known: bool,
    /// Whether opponents are given.
    pub opponents_known: bool,
    /// The authored case that is left out, with its copies.
    pub left_out: Option<usize>,
}

/// A case and its similarity.
#[derive(Clone, Debug)]
pub struct Ranked {
    /// Number of the stored case.
    pub id: u16,
    /// Weighted mean of the terms.
    pub similarity: f32,
    /// Local similarities of the [`TERMS`]; NaN for those that are unknown.
    pub terms: [f32; TERMS.len()],
    /// Robot that takes the part of each case robot.
    pub players: [i8; PLAYERS],
}

impl Local {
    fn at(&self, distance: f32) -> f32 {
        match self {
            Self::Gauss => (-distance * distance).exp(),
            Self::Linear => (1.0 - distance).max(0.0),
            Self::Table(values) => {
                let last = values.len().saturating_sub(1);
                let at = (distance * SAMPLES_PER_UNIT).min(last as f32);
                let (below, share) = (at as usize, at.fract());
                let [low, high] =
                    [below, (below + 1).min(last)].map(|n| values.get(n).copied().unwrap_or(0.0));
                low + (high - low) * share
            }
        }
    }
}

impl Similarity {
    /// The paper's weights and functions: all terms alike.
    pub const fn usual() -> Self {
        Self {
            weights: [1.0; TERMS.len()],
            local: [Local::Gauss, Local::Linear, Local::Gauss, Local::Gauss],
            unknown: Unknown::Ignore,
        }
    }

    /// The similarity of a case to a problem.
    fn of(&self, case: &Case<'_>, asked: &PartialProblem, settings: &RetrievalSettings) -> Ranked {
        let terms = if asked.ball.is_some() {
            casebase::terms(case, &asked.problem, settings)
        } else {
            let problem = Problem { ball: case.ball(), ..asked.problem.clone() };
            casebase::terms(case, &problem, settings)
        };
        let mut players = [-1; PLAYERS];
        for (to, player) in players.iter_mut().zip(&terms.players) {
            *to = i8::try_from(player.number()).unwrap_or(-1);
        }
        let found = self.locals(case, asked, settings, &terms);
        let (mut sum, mut weights) = (0.0, 0.0);
        for (value, weight) in found.iter().zip(self.weights) {
            let known = match self.unknown {
                Unknown::Ignore => *value,
                Unknown::Worst => Some(value.unwrap_or(0.0)),
                Unknown::Best => Some(value.unwrap_or(1.0)),
            };
            if let Some(value) = known {
                sum += weight * value;
                weights += weight;
            }
        }
        let similarity = if weights > 0.0 { sum / weights } else { 0.0 };
        Ranked { id: case.id().0, similarity, terms: found.map(|term| term.unwrap_or(f32::NAN)), players }
    }

    /// Local similarities; `None` for what the problem does not know, or the case has none of.
    fn locals(
        &self,
        case: &Case<'_>,
        asked: &PartialProblem,
        settings: &RetrievalSettings,
        terms: &Terms,
    ) -> [Option<f32>; TERMS.len()] {
        let [ball, robots, scopes, path] = &self.local;
        let reached = terms.robots.iter().map(|distance| robots.at(distance / settings.travel_max_mm));
        let met = terms.scopes.iter().enumerate().map(|(n, distance)| match case.presence(n) {
            Presence::Excluded => 1.0 - scopes.at(*distance),
            Presence::Preferred | Presence::Required => scopes.at(*distance),
        });
        [
            asked.ball.map(|_| ball.at(terms.ball)),
            asked.teammates_known.then(|| mean(reached, case.teammates())),
            (asked.opponents_known && !terms.scopes.is_empty()).then(|| mean(met, terms.scopes.len())),
            asked.opponents_known.then(|| 1.0 - path.at(terms.path)),
        ]
    }
}

impl PartialProblem {
    /// The `k` most similar cases, the most similar first; of equals the lower number.
    pub fn rank(
        &self,
        base: &CaseBase<'_>,
        similarity: &Similarity,
        settings: &RetrievalSettings,
        k: usize,
    ) -> Vec<Ranked> {
        let mut ranked: Vec<Ranked> = base
            .cases()
            .filter(|case| self.defending.is_none_or(|goal| goal == case.defending()))
            .filter(|case| self.left_out != Some(case.authored()))
            .map(|case| similarity.of(&case, self, settings))
            .collect();
        ranked.sort_by(|a, b| b.similarity.total_cmp(&a.similarity).then(a.id.cmp(&b.id)));
        ranked.truncate(k);
        ranked
    }

    /// The problem where every part is known, as retrieval needs it.
    pub fn whole(self) -> Option<Problem> {
        let known = self.ball.is_some() && self.defending.is_some();
        (known && self.teammates_known && self.opponents_known).then_some(self.problem)
    }
}

/// Arrays of problems, row by row: x and y of the ball; 0 or 1 for the goal; x and y of each robot. NaN is
/// unknown for a ball, and absent for a robot; other goals are unknown.
#[derive(Debug)]
pub struct Arrays {
    /// Two a problem.
    pub ball: Vec<f64>,
    /// One a problem.
    pub defending: Vec<f64>,
    /// Two for each robot of a problem.
    pub teammates: Option<Vec<f64>>,
    /// The same of opponents.
    pub opponents: Option<Vec<f64>>,
    /// One a problem: the authored case that is left out, -1 for none.
    pub left_out: Option<Vec<f64>>,
}

impl Arrays {
    /// Number of problems.
    pub fn len(&self) -> usize {
        self.defending.len()
    }

    /// The error of the first value that no problem has.
    pub fn check(&self) -> Result<(), String> {
        let parts = [("ball", Some(&self.ball)), ("teammates", self.teammates.as_ref())];
        for (name, values) in parts.into_iter().chain([("opponents", self.opponents.as_ref())]) {
            for (at, value) in values.into_iter().flatten().enumerate() {
                if value.abs() > PLACE_MAX_MM {
                    return Err(format!(
                        "{name}: number {at} is {value}; take mm within ±{PLACE_MAX_MM}, or NaN"
                    ));
                }
            }
        }
        for (name, values, most) in [
            ("teammates", self.teammates.as_ref(), casebase::PROBLEM_TEAMMATES_MAX),
            ("opponents", self.opponents.as_ref(), casebase::PROBLEM_OPPONENTS_MAX),
        ] {
            for number in 0..self.len() {
                let robots = values.map_or(0, |values| self.row(values, number).flatten().count());
                if robots > most {
                    return Err(format!("{name}: problem {number} has {robots} robots; take at most {most}"));
                }
            }
        }
        Ok(())
    }

    /// Robots of a problem, in their order; `None` for those that are absent.
    fn row<'a>(&self, values: &'a [f64], number: usize) -> impl Iterator<Item = Option<PointMm>> + 'a {
        let width = values.len() / self.len().max(1);
        let places = values.get(number * width..).unwrap_or_default().chunks_exact(2).take(width / 2);
        places.map(|at| point([at[0], at[1]]))
    }

    /// The problem of that number.
    pub fn problem(&self, number: usize) -> PartialProblem {
        let [mates, others] =
            [&self.teammates, &self.opponents].map(|side| side.as_deref().unwrap_or_default());
        let ball = point([self.ball[2 * number], self.ball[2 * number + 1]]);
        let defending = match self.defending[number] {
            0.0 => Some(GoalEnd::Negative),
            1.0 => Some(GoalEnd::Positive),
            _ => None,
        };
        let teammates = RobotId::all().zip(self.row(mates, number));
        let teammates = teammates.filter_map(|(id, at)| Some((id, at?)));
        let left_out = self.left_out.as_ref().map(|numbers| numbers[number]).filter(|case| *case >= 0.0);
        PartialProblem {
            problem: Problem {
                ball: ball.unwrap_or(PointMm::new(0, 0)),
                defending: defending.unwrap_or(GoalEnd::Negative),
                teammates: teammates.collect(),
                opponents: self.row(others, number).flatten().collect(),
            },
            ball,
            defending,
            teammates_known: self.teammates.is_some(),
            opponents_known: self.opponents.is_some(),
            left_out: left_out.map(|case| case as usize),
        }
    }
}

fn mean(values: impl Iterator<Item = f32>, count: usize) -> f32 {
    values.sum::<f32>() / count as f32
}

/// The rounded place; `None` where a coordinate is not a number.
fn point(at: [f64; 2]) -> Option<PointMm> {
    let [x, y] = at.map(|value| value.is_finite().then_some(value.round() as i32));
    Some(PointMm::new(x?, y?))
}

/// Samples of a local similarity for each unit of distance.
pub const SAMPLES_PER_UNIT: f32 = 64.0;
/// Samples of a local similarity: up to a distance of 4, where the paper's is 1e-7.
pub const SAMPLES: usize = 4 * SAMPLES_PER_UNIT as usize + 1;
/// Largest coordinate of a problem, mm: 1 km.
const PLACE_MAX_MM: f64 = 1e6;
