//! `workbench`: requests of the case workbench, and the problems of the match that they are answered on. The
//! page passes them on: what a case is, it does not know.

use std::sync::Mutex;

use serde_json::Value;

use crate::archive::{Kept, look};
use crate::match_event::MatchEvent;
use crate::request::{PageTeam, Powers};

/// A request of the case workbench.
pub struct WorkbenchRequest {
    /// Request as the page sends it, JSON.
    pub text: String,
    /// The viewer brought the page's token, or none is needed.
    pub may_ask: bool,
    /// Requests that viewers may send to this match.
    pub powers: Powers,
    /// Gives the problems of the match so far, or of all of a recording.
    pub problems: Box<dyn Fn() -> Vec<MatchProblem> + Send>,
}

/// A problem that a team decided on.
#[derive(Clone, Debug, PartialEq)]
pub struct MatchProblem {
    /// The team that decided; `None` in a match of one.
    pub team: Option<PageTeam>,
    /// Seconds since the start.
    pub t: f64,
    /// The problem, as `onetwo cases explain` takes it.
    pub problem: Value,
}

/// The problems among the events that are kept.
pub(crate) fn problems(kept: &Mutex<Kept>) -> Vec<MatchProblem> {
    look(kept, |kept| kept.match_events.iter().filter_map(problem).collect())
}

/// The problem of a decision: the coordinator's own where it is known.
fn problem(event: &MatchEvent) -> Option<MatchProblem> {
    let own = event.decided.as_ref().and_then(|decided| decided.problem.as_ref());
    let problem = own.or(event.problem.as_ref())?.clone();
    Some(MatchProblem { team: event.team, t: event.t, problem })
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::match_event::DecisionNote;

    #[test]
    fn a_decisions_own_problem_takes_precedence_over_the_hosts() {
        let event =
            |t, problem, decided| MatchEvent { problem, decided, ..MatchEvent::fault(t, String::new()) };
        let own = |problem| Some(DecisionNote { problem, ..DecisionNote::default() });
        let kept = Mutex::new(Kept::default());
        look(&kept, |kept| {
            kept.match_events = vec![
                event(1.0, None, None),
                event(2.0, Some(json!("seen")), None),
                event(3.0, Some(json!("seen")), own(Some(json!("own")))),
                event(4.0, None, own(None)),
            ];
        });
        let found: Vec<_> = problems(&kept).into_iter().map(|one| (one.t, one.problem)).collect();
        assert_eq!(found, [(2.0, json!("seen")), (3.0, json!("own"))]);
    }
}
