//! `retrieval`: retrieval by the coordinator. Beliefs to a problem, a retrieval to a decision.
//!
//! The ball of the problem is at its stop position: robots that adapt to a place a rolling ball has left
//! would only abort. For a stationary ball it is the paper's own ball position.

use casebase::{CaseBase, GoalEnd, Problem, RetrievalSettings};
use protocol::decision::Grounds;
use protocol::host::Hint;
use protocol::team::{Decision, Play};
use protocol::{Instant, RobotId};

use crate::belief::Belief;
use crate::teammates::Teammates;

/// The problem from this robot's belief, with opponents where they will be after `lookahead_s`; `None` while
/// no ball is known.
pub fn problem(
    now: Instant,
    me: RobotId,
    base: &CaseBase<'_>,
    defending: GoalEnd,
    belief: &Belief,
    teammates: &Teammates,
    lookahead_s: f32,
) -> Option<Problem> {
    let ball = belief.ball?;
    let mut problem = Problem {
        ball: ball.rest.into(),
        defending,
        teammates: heapless::Vec::new(),
        opponents: heapless::Vec::new(),
    };
    // Robots that carry another case base could not look the case up.
    let able = teammates
        .present(now)
        .filter(|(_, teammate)| teammate.beacon.case_base == base.hash())
        .map(|(id, teammate)| (id, teammate.pose().position));
    for (id, position) in able.chain([(me, belief.pose.position)]) {
        // A team larger than a problem holds is cut at its limit.
        let _ = problem.teammates.push((id, position.into()));
    }
    for opponent in &belief.opponents {
        let at = if lookahead_s > 0.0 { belief.opponent_after(*opponent, lookahead_s) } else { *opponent };
        let _ = problem.opponents.push(at.into());
    }
    Some(problem)
}

/// The host's proposal as a decision: its case exists, takes as many robots as it names, and all of them are
/// present, each once. It is for the ball as it will be had: where its way comes nearest to the case's.
pub fn accept(
    base: &CaseBase<'_>,
    problem: &Problem,
    hint: &Hint,
    holder: Option<RobotId>,
    belief: &Belief,
) -> Option<Decision> {
    let case = base.case(hint.case)?;
    let present = |id: &RobotId| problem.teammates.iter().any(|(teammate, _)| teammate == id);
    let once = |id: &RobotId| hint.robots.iter().filter(|other| *other == id).count() == 1;
    let all = hint.robots.iter().all(|id| present(id) && once(id));
    let getter = hint.robots.get(case.getter().index()).copied();
    let fits = case.robots().count() == hint.robots.len() && case.defending() == problem.defending;
    (all && fits && (holder.is_none() || holder == getter)).then(|| {
        let ball = belief.ball.map_or(problem.ball, |ball| ball.path().closest_to(case.ball().into()).into());
        Decision::Play(Play { case: hint.case, ball: ball.into(), robots: hint.robots.clone() })
    })
}

/// The coordinator's decision about `problem`, and what it rests on.
///
/// A robot that holds the ball can give it away only by a kick: a case in which another robot must get the
/// ball first cannot start, and counts as none.
pub fn decide(
    base: &CaseBase<'_>,
    problem: &Problem,
    settings: &RetrievalSettings,
    holder: Option<RobotId>,
) -> (Decision, Grounds) {
    let Some(best) = casebase::retrieve_best(base, problem, settings) else {
        return (Decision::NoCase, Grounds::Retrieved);
    };
    let getter =
        base.case(best.case).and_then(|case| best.correspondence.get(case.getter().index()).copied());
    if let Some(holder) = holder.filter(|_| holder != getter) {
        return (Decision::NoCase, Grounds::Holds(holder));
    }
    let mut robots = heapless::Vec::new();
    for robot in &best.correspondence {
        // As many as a case may have, in both.
        let _room = robots.push(*robot);
    }
    let play = Play { case: best.case, ball: problem.ball.into(), robots };
    (Decision::Play(play), Grounds::Retrieved)
}
