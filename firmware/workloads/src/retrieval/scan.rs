//! `scan`: reference retrieval that scans every case: a direct implementation of docs/case-format.md §3 with
//! its default settings.
//!
//! It shares only the records and the ranking with the measured retrieval: no index, no bound, and the
//! correspondence by enumeration. Lengths in mm.

use casebase::{
    Case, CaseBase, Correspondence, Match, Problem, Retrieval, RetrievalSettings, blocked_leg, rank_order,
};
use geometry::math;
use protocol::RobotId;

/// The best case and the number of candidates.
pub fn scan(base: &CaseBase<'_>, problem: &Problem) -> Retrieval {
    let settings = RetrievalSettings::default();
    let mut team = problem.teammates.clone();
    team.sort_unstable_by_key(|(id, _)| *id);
    let mut best: Option<Match> = None;
    let mut candidates = 0;
    for case in base.cases().filter(|case| case.defending() == problem.defending) {
        let Some(found) = candidate(base, &case, problem, &team, &settings) else { continue };
        candidates += 1;
        if best.as_ref().is_none_or(|best| rank_order(&found, best, &settings).is_lt()) {
            best = Some(found);
        }
    }
    Retrieval { best, candidates }
}

fn candidate(
    base: &CaseBase<'_>,
    case: &Case<'_>,
    problem: &Problem,
    team: &[(RobotId, casebase::PointMm)],
    settings: &RetrievalSettings,
) -> Option<Match> {
    let ball = problem.ball;
    if !case.ball_in_scope(ball) || case.teammates() > team.len() {
        return None;
    }
    let players = Search::new(case, problem, team).cheapest()?;
    if players.farthest > settings.travel_max_mm
        || blocked_leg(case, base, ball, &problem.opponents, settings).is_some()
    {
        return None;
    }
    let shift = case.shift(ball);
    let holds = |(at, scope): &(casebase::PointMm, casebase::Scope)| {
        let inside = |opponent: &casebase::PointMm| {
            scope.exponent(opponent.minus(at.plus(shift))) < casebase::settings::SCOPE_EXPONENT
        };
        problem.opponents.iter().any(inside)
    };
    let exponent = case.ball_scope().exponent(shift);
    Some(Match {
        case: case.id(),
        similarity: math::exp(-exponent),
        exponent,
        cost: players.cost,
        free: 1.0,
        conditions: case.opponents().filter(holds).count() as u8,
        teammates: case.teammates() as u8,
        correspondence: players.ids,
    })
}

/// The players of all parts, and their cost.
struct Players {
    ids: Correspondence,
    cost: f32,
    farthest: f32,
}

/// Every injective map from parts to robots, in the order of the robots' ids.
struct Search<'s> {
    team: &'s [(RobotId, casebase::PointMm)],
    /// Distances by part, then by robot, mm.
    distances: heapless::Vec<heapless::Vec<f32, 11>, 4>,
    best: Option<(u64, heapless::Vec<usize, 4>)>,
}

impl<'s> Search<'s> {
    fn new(case: &Case<'_>, problem: &Problem, team: &'s [(RobotId, casebase::PointMm)]) -> Self {
        let row = |robot| {
            let place = case.adapted(robot, problem.ball).minus(problem.ball).to_f32();
            let distance = |(_, at): &(RobotId, casebase::PointMm)| {
                let at = at.minus(problem.ball).to_f32();
                math::hypot(at[0] - place[0], at[1] - place[1])
            };
            team.iter().map(distance).collect()
        };
        Self { team, distances: case.robots().map(row).collect(), best: None }
    }

    fn cheapest(mut self) -> Option<Players> {
        self.choose(&mut heapless::Vec::new(), 0);
        let (_, chosen) = self.best?;
        let mut players = Players { ids: Correspondence::new(), cost: 0.0, farthest: 0.0 };
        for (row, robot) in self.distances.iter().zip(chosen) {
            let distance = *row.get(robot)?;
            players.ids.push(self.team.get(robot)?.0).ok()?;
            players.cost += distance;
            players.farthest = players.farthest.max(distance);
        }
        Some(players)
    }

    /// Extends a partial map; of equal sums the first is kept, which is the lexicographically smallest.
    fn choose(&mut self, chosen: &mut heapless::Vec<usize, 4>, sum: u64) {
        if self.best.as_ref().is_some_and(|(least, _)| sum >= *least) {
            return;
        }
        let Some(row) = self.distances.get(chosen.len()).cloned() else {
            self.best = Some((sum, chosen.clone()));
            return;
        };
        for (robot, distance) in row.iter().enumerate() {
            if !chosen.contains(&robot) && chosen.push(robot).is_ok() {
                // In whole 1/256 mm, so that equal sums are equal in any order of adding; cut off at 2 km.
                let fixed = ((distance * 256.0 + 0.5) as u64).min(1 << 29);
                self.choose(chosen, sum + fixed);
                chosen.pop();
            }
        }
    }
}
