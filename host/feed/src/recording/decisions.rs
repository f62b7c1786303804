//! `decisions`: decisions of the robots in a trace, with their problems, and what became of the cases that
//! they played. s since the start.

use std::collections::BTreeMap;

use arena::CaseNames;
use arena::cases::{LibraryHandle, problem::parse};
use arena::game::TICK_US;
use arena::ledger::{CaseTable, MatchLedger};
use casebase::Problem;
use host::Host;
use page::DecisionNote;
use protocol::{CaseId, Instant, RobotId};
use rules::Colour;
use serde::Serialize;

use crate::cycles::{TeamCycles, reported};
use crate::names::Names;

/// A report may come after this many newer decisions of both teams: teams decide at most every tick or so,
/// and a report takes 0.1 s.
const LATE_MAX: usize = 20;

/// A decision of a team's coordinator.
#[derive(Debug, PartialEq, Serialize)]
pub struct Decision {
    pub(super) at_s: f64,
    /// The coordinator's team, "blue" or "yellow".
    pub team: &'static str,
    /// `region/name` of the case that is played; none where no case is.
    pub(super) case: Option<String>,
    #[serde(flatten)]
    /// The decision itself.
    pub note: DecisionNote,
}

impl Decision {
    /// The problem as `cases retrieve` reads it; none where the coordinator knew of no ball.
    pub fn problem_line(&self) -> Option<String> {
        let mut problem = parse(&self.note.problem.as_ref()?.to_string()).ok()?;
        // As the robots had them; an object of JSON has an order of its own.
        problem.teammates.sort_unstable_by_key(|(id, _)| *id);
        Some(problem_line(&problem))
    }
}

/// Follows the hosts of a trace.
pub struct Decisions {
    names: Names,
    case_names: CaseNames,
    ledger: MatchLedger,
    cycles: [TeamCycles; 2],
    /// Number of the tick that is being fed.
    tick: u64,
    /// Every decision so far, in the order of time.
    pub all: Vec<Decision>,
}

impl Decisions {
    /// Names cases as the library does.
    pub fn new(library_handle: Option<&LibraryHandle>) -> Self {
        Self {
            names: Names::new(library_handle),
            case_names: CaseNames::new(library_handle.map_or_else(Vec::new, LibraryHandle::names)),
            ledger: MatchLedger::default(),
            cycles: Default::default(),
            tick: 0,
            all: Vec::new(),
        }
    }

    /// Before a record of `at` is fed: looks at the hosts where it begins another tick of 10 ms.
    pub fn look(&mut self, at: Instant, feed: &Host, hosts: &[&Host]) {
        let tick = at.0 / TICK_US;
        if tick <= self.tick {
            return;
        }
        self.tick = tick;
        self.observe((tick * TICK_US) as f64 * 1e-6, feed, hosts);
    }

    fn observe(&mut self, t: f64, feed: &Host, hosts: &[&Host]) {
        self.ledger.look_through(feed, hosts, t);
        for host in hosts {
            let us = host.settings().us;
            let cycles = &mut self.cycles[us as usize];
            cycles.receive(host, t, &self.names, &mut Vec::new());
            let reported: Vec<_> = cycles.reported_decisions().to_vec();
            self.all.extend(reported.into_iter().map(|(at, note)| decision(&self.case_names, us, at, note)));
            self.receive_late(host);
        }
    }

    /// Reports of decisions that others have followed already.
    fn receive_late(&mut self, host: &Host) {
        let us = host.settings().us.label();
        for (robot, report) in RobotId::all().filter_map(|robot| Some((robot, host.decision(robot)?))) {
            let own = |decision: &&mut Decision| {
                let note = &decision.note;
                decision.team == us && (note.by, note.cycle) == (robot.number(), report.cycle.counter)
            };
            let newest = self.all.iter_mut().rev().take(LATE_MAX);
            if let Some(decision) = newest.filter(|decision| !decision.note.reported).find(own) {
                decision.note = reported(robot, report);
            }
        }
    }

    /// After the last record.
    pub fn finish(&mut self, feed: &Host, hosts: &[&Host]) {
        self.observe(((self.tick + 1) * TICK_US) as f64 * 1e-6, feed, hosts);
        for host in hosts {
            let us = host.settings().us;
            if let Some((at, note)) = self.cycles[us as usize].left() {
                self.all.push(decision(&self.case_names, us, at, note.clone()));
            }
        }
        self.all.sort_by(|a, b| a.at_s.total_cmp(&b.at_s));
    }

    /// Results of every play.
    pub fn ledger(&self) -> &MatchLedger {
        &self.ledger
    }

    /// Results of every case, by team.
    pub fn tables(&self, hosts: &[&Host]) -> BTreeMap<&'static str, CaseTable> {
        self.ledger.tables(hosts, &self.case_names, true)
    }
}

/// A problem as `cases retrieve` reads it.
pub fn problem_line(problem: &Problem) -> String {
    let robots = problem.teammates.iter().map(|(id, at)| format!("\"{}\":[{},{}]", id.number(), at.x, at.y));
    let opponents = problem.opponents.iter().map(|at| format!("[{},{}]", at.x, at.y));
    format!(
        "{{\"ball\":[{},{}],\"defending\":\"{}\",\"teammates\":{{{}}},\"opponents\":[{}]}}",
        problem.ball.x,
        problem.ball.y,
        problem.defending.label(),
        robots.collect::<Vec<_>>().join(","),
        opponents.collect::<Vec<_>>().join(",")
    )
}

fn decision(names: &CaseNames, us: Colour, at_s: f64, note: DecisionNote) -> Decision {
    Decision { at_s, team: us.label(), case: note.id.map(|id| names.of(CaseId(id))), note }
}
