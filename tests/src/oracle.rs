//! `oracle`: independent, naive retrieval by docs/case-format.md §3.
//!
//! docs/case-format.md §3 (paper §3) in `f64`, case after case, every injection tried, nothing indexed.
//! **Invariant:** it uses no crate of the project, so that both cannot share an error. Field frame, mm.
//!
//! Two correct implementations may differ where a number falls on a threshold: every decision that depends on
//! a relative difference below [`NEAR`] is noted in the answer.

pub mod library;
pub mod problem;
pub mod walk;

use std::cell::Cell;
use std::cmp::Ordering;

use serde_json::{Map, Value, json};

use library::{Case, Library, Point, Radii};
use problem::Problem;
use walk::Leg;

/// The answer to a problem by docs/case-format.md §3.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The case to play; `None` when no case passes.
    pub winner: Option<Candidate>,
    /// Cases that pass filters 1–4.
    pub candidates: usize,
    /// The first decision that was nearly a tie.
    pub near_tie: Option<&'static str>,
}

/// A case that passes the filters, with all its ranking criteria.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// Id of the stored case.
    pub id: usize,
    /// Similarity of the ball.
    pub similarity: f64,
    /// Sum of the distances to the adapted positions (or the longest of them), mm.
    pub cost: f64,
    /// Number of opponent scopes that contain an opponent.
    pub conditions: usize,
    /// Robot id of tm1, tm2, …
    pub correspondence: Vec<u8>,
    /// Adapted position of tm1, tm2, …
    pub adapted: Vec<Point>,
}

/// The settings of docs/case-format.md §3.2 that change the correct answer, as far as that section specifies
/// how.
#[derive(Clone, Debug, PartialEq)]
pub struct Rules {
    /// Maximum distance to an adapted position, mm (`thr_c`; paper, Algorithm 1).
    pub furthest: f64,
    /// Threshold of a membership (`thr`; paper §3.1).
    pub membership: f64,
    /// Only correspondences within `thr_c` are searched (`correspondence = constrained`).
    pub constrained: bool,
    /// Opponent scopes stay where the case has them (`scopes = absolute`).
    pub scopes_absolute: bool,
    /// The cost is the longest distance, not the sum (`cost = max`).
    pub longest: bool,
    /// Order of the criteria (`ranking`).
    pub ranking: [Criterion; 3],
}

/// A step of the ranking.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// More occupied scopes first.
    Conditions,
    /// More case robots first.
    Teammates,
    /// The better interval of similarity first, then the lower cost.
    IntervalCost,
}

impl Default for Rules {
    fn default() -> Self {
        Self {
            furthest: 1500.0,
            membership: 0.367,
            constrained: false,
            scopes_absolute: false,
            longest: false,
            ranking: [Criterion::Conditions, Criterion::Teammates, Criterion::IntervalCost],
        }
    }
}

impl Rules {
    /// The exponent at which a membership ends.
    fn threshold(&self) -> f64 {
        -self.membership.ln()
    }
}

/// One line's answer as `onetwo cases retrieve` prints it (docs/case-format.md §5.1), line counted from 1;
/// `None` for a blank line. Numbers are not rounded, and an error's text is the oracle's own.
pub fn answer_line(library: &Library, number: usize, line: &str) -> Option<Value> {
    if line.trim().is_empty() {
        return None;
    }
    Some(match Problem::parse(line) {
        Ok(problem) => retrieve(library, &problem, &Rules::default()).to_json(library),
        Err(reason) => json!({ "error": format!("line {number}: {reason}") }),
    })
}

/// The answer to a problem.
pub fn retrieve(library: &Library, problem: &Problem, rules: &Rules) -> Answer {
    let (candidates, near_tie) = ranked(library, problem, rules);
    Answer { candidates: candidates.len(), winner: candidates.into_iter().next(), near_tie }
}

/// Every case that passes filters 1–4, in the order of the rank, and the first decision that was nearly a
/// tie.
pub fn ranked(library: &Library, problem: &Problem, rules: &Rules) -> (Vec<Candidate>, Option<&'static str>) {
    let mut teammates = problem.teammates.clone();
    teammates.sort_by_key(|(id, _)| *id);
    let problem = &Problem { teammates, ..problem.clone() };
    let close = Close::default();
    let mut candidates: Vec<Candidate> = library
        .cases
        .iter()
        .enumerate()
        .filter_map(|(id, case)| candidate(library, id, case, problem, rules, &close))
        .collect();
    candidates.sort_by(|a, b| rank(a, b, rules, &Close::default()));
    if let [first, others @ ..] = candidates.as_slice() {
        for other in others {
            rank(first, other, rules, &close);
        }
    }
    (candidates, close.0.get())
}

/// Filters 1–4, and the numbers of the rank.
fn candidate(
    library: &Library,
    id: usize,
    case: &Case,
    problem: &Problem,
    rules: &Rules,
    close: &Close,
) -> Option<Candidate> {
    if case.defending != problem.defending {
        return None;
    }
    let exponent = scope_exponent(case.ball, case.scope, problem.ball);
    if !close.less("ball", exponent, rules.threshold()) {
        return None;
    }
    let shift = Point { x: problem.ball.x - case.ball.x, y: problem.ball.y - case.ball.y };
    let shifted = |p: Point| Point { x: p.x + shift.x, y: p.y + shift.y };
    let legs = walk::legs(library, case, problem.ball).ok()?;
    let blocked = |leg: &Leg| problem.opponents.iter().any(|&opponent| inside(leg, opponent, rules, close));
    if legs.iter().any(blocked) {
        return None;
    }
    // After the free path, which is cheaper; which of the two rejects a case is irrelevant.
    let adapted: Vec<Point> = case.robots.iter().map(|robot| shifted(robot.at)).collect();
    let (correspondence, cost) = correspondence(&adapted, &problem.teammates, rules, close)?;
    let occupied = |&&(centre, radii): &&(Point, Radii)| {
        let centre = if rules.scopes_absolute { centre } else { shifted(centre) };
        let within = |&opponent: &Point| {
            close.less("condition", scope_exponent(centre, radii, opponent), rules.threshold())
        };
        problem.opponents.iter().any(within)
    };
    Some(Candidate {
        id,
        similarity: (-exponent).exp(),
        cost,
        conditions: case.opponents.iter().filter(occupied).count(),
        correspondence,
        adapted,
    })
}

/// The injection of minimum cost, unless one of its robots exceeds the travel limit.
fn correspondence(
    adapted: &[Point],
    present: &[(u8, Point)],
    rules: &Rules,
    close: &Close,
) -> Option<(Vec<u8>, f64)> {
    let moves: Vec<Vec<f64>> =
        adapted.iter().map(|&place| present.iter().map(|&(_, at)| distance(at, place)).collect()).collect();
    let all = |chosen: &[usize]| chosen.iter().zip(&moves).map(|(&robot, moves)| moves[robot]).collect();
    let reachable = |moves: &Vec<f64>| moves.iter().all(|&moved| !close.less("thr_c", rules.furthest, moved));
    let mut best: Option<(Vec<usize>, f64)> = None;
    let mut second = f64::INFINITY;
    // In ascending order, so that of equal costs the lexicographically smallest list of ids is kept.
    injections(adapted.len(), present.len(), &mut Vec::new(), &mut |chosen| {
        let moves = chosen.iter().zip(&moves).map(|(&robot, moves)| moves[robot]);
        let cost = if rules.longest { moves.fold(0.0, f64::max) } else { moves.sum() };
        if rules.constrained && !reachable(&all(chosen)) {
            return;
        }
        match &best {
            Some((_, least)) if cost >= least * (1.0 - ROUNDING) => second = second.min(cost),
            _ => {
                second = best.as_ref().map_or(second, |(_, least)| *least);
                best = Some((chosen.to_vec(), cost));
            }
        }
    });
    let (chosen, cost) = best?;
    if second.is_finite() {
        close.less("correspondence", cost, second);
    }
    reachable(&all(&chosen)).then(|| (chosen.iter().map(|&robot| present[robot].0).collect(), cost))
}

/// Calls `visit` with every injection of `places` places into `present` robots, lexicographically.
fn injections(places: usize, present: usize, chosen: &mut Vec<usize>, visit: &mut impl FnMut(&[usize])) {
    if chosen.len() == places {
        visit(chosen);
        return;
    }
    for robot in 0..present {
        if !chosen.contains(&robot) {
            chosen.push(robot);
            injections(places, present, chosen, visit);
            chosen.pop();
        }
    }
}

/// Whether an opponent is within the fuzzy trapezoid of a leg.
fn inside(leg: &Leg, opponent: Point, rules: &Rules, close: &Close) -> bool {
    let (dx, dy) = (leg.to.0 - leg.from.0, leg.to.1 - leg.from.1);
    let length = dx.hypot(dy);
    if length == 0.0 {
        return false;
    }
    let (px, py) = (opponent.x as f64 - leg.from.0, opponent.y as f64 - leg.from.1);
    let along = (px * dx + py * dy) / length;
    let across = (py * dx - px * dy) / length;
    let r_min = leg.corridor.r_min as f64;
    let radius = r_min + (leg.corridor.r_max as f64 - r_min) * along / length;
    if close.less_by("leg start", along, 0.0, length) || close.less("leg end", length, along) {
        return false;
    }
    close.less("leg", (across / radius).powi(2), rules.threshold())
}

/// Better candidates first.
fn rank(a: &Candidate, b: &Candidate, rules: &Rules, close: &Close) -> Ordering {
    let by = |criterion| match criterion {
        Criterion::Conditions => b.conditions.cmp(&a.conditions),
        Criterion::Teammates => b.correspondence.len().cmp(&a.correspondence.len()),
        Criterion::IntervalCost => interval(a.similarity, close)
            .cmp(&interval(b.similarity, close))
            .then_with(|| close.order("cost", a.cost, b.cost)),
    };
    let [first, second, third] = rules.ranking;
    by(first)
        .then_with(|| by(second))
        .then_with(|| by(third))
        .then_with(|| close.order("similarity", b.similarity, a.similarity))
        .then(a.id.cmp(&b.id))
}

/// 0 = H, 1 = h, 2 = l, 3 = L.
fn interval(similarity: f64, close: &Close) -> u8 {
    [0.8, 0.6, 0.4].iter().filter(|&&bound| close.less("interval", similarity, bound)).count() as u8
}

/// (Δx/τx)² + (Δy/τy)².
fn scope_exponent(centre: Point, radii: Radii, point: Point) -> f64 {
    let x = (point.x - centre.x) as f64 / radii.x as f64;
    let y = (point.y - centre.y) as f64 / radii.y as f64;
    x * x + y * y
}

fn distance(a: Point, b: Point) -> f64 {
    ((a.x - b.x) as f64).hypot((a.y - b.y) as f64)
}

/// Relative difference of sums of the same numbers in another order: those are equal.
const ROUNDING: f64 = 1e-13;

/// Relative difference below which two correct implementations may decide differently.
pub const NEAR: f64 = 1e-4;

/// Remembers the first comparison that was nearly a tie.
#[derive(Default)]
struct Close(Cell<Option<&'static str>>);

impl Close {
    fn less(&self, what: &'static str, a: f64, b: f64) -> bool {
        self.less_by(what, a, b, a.abs().max(b.abs()))
    }

    fn less_by(&self, what: &'static str, a: f64, b: f64, scale: f64) -> bool {
        if (a - b).abs() <= NEAR * scale && self.0.get().is_none() {
            self.0.set(Some(what));
        }
        a < b
    }

    fn order(&self, what: &'static str, a: f64, b: f64) -> Ordering {
        self.less(what, a, b);
        a.total_cmp(&b)
    }
}

impl Answer {
    /// As `onetwo cases retrieve` prints it, without rounding.
    pub fn to_json(&self, library: &Library) -> Value {
        let Some(winner) = &self.winner else {
            return json!({ "case": null, "candidates": self.candidates });
        };
        let case = &library.cases[winner.id];
        let robots = || winner.correspondence.iter().zip(&winner.adapted).enumerate();
        let matched: Map<String, Value> =
            robots().map(|(i, (id, _))| ((i + 1).to_string(), json!(id))).collect();
        let adapted: Map<String, Value> =
            robots().map(|(_, (id, at))| (id.to_string(), json!([at.x, at.y]))).collect();
        json!({
            "case": case.name,
            "id": winner.id,
            "symmetry": case.symmetry,
            "similarity": winner.similarity,
            "cost": winner.cost,
            "conditions": winner.conditions,
            "teammates": winner.correspondence.len(),
            "match": matched,
            "adapted": adapted,
            "candidates": self.candidates,
        })
    }
}

#[cfg(test)]
mod tests;
