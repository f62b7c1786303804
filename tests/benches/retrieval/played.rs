//! `played`: problems for which robots retrieve in play. Those of whole trials, recorded as their
//! coordinators decided.
//!
//! No file keeps them: trials are seeded and fast, so the problems are those of today's library and brain.

use std::cell::RefCell;
use std::rc::Rc;

use arena::{TrialConfig, run};
use brain::{Approach, BrainConfig, Station};
use casebase::{CaseBase, Problem};
use hil_sim::{Backend, Configuration, Mcu, McuError, NativeMcu, Reply, Scenario};
use protocol::lockstep::TickIn;
use protocol::team::Decision;
use protocol::{CycleId, Instant};

/// The problems of `trials` trials: the paper's scenarios, both configurations, seed after seed.
pub(crate) fn problems(trials: usize) -> Vec<Problem> {
    let configurations = [Configuration::DefenderGoalie, Configuration::TwoDefenders];
    let each = (1..).flat_map(|seed| {
        Scenario::PAPER.into_iter().flat_map(move |scenario| configurations.map(|two| (scenario, two, seed)))
    });
    let mut problems = Vec::new();
    for (scenario, configuration, seed) in each.take(trials) {
        let config = TrialConfig::new(scenario, configuration, Approach::Cases, seed);
        let recorder = Recorder { base: config.base, problems: Rc::default() };
        let recorded = Rc::clone(&recorder.problems);
        run(&config, Box::new(recorder), &mut []).expect("a trial in this process");
        problems.append(&mut recorded.borrow_mut());
    }
    problems
}

/// Robots' computers in this process, whose decisions are recorded.
struct Recorder<'a> {
    base: CaseBase<'a>,
    problems: Rc<RefCell<Vec<Problem>>>,
}

impl<'a> Backend<'a> for Recorder<'a> {
    fn name(&self) -> &'static str {
        "recorder"
    }

    fn boot(&mut self, config: &BrainConfig) -> Result<Box<dyn Mcu + 'a>, McuError> {
        let native = NativeMcu::new(config, self.base);
        Ok(Box::new(Robot { native, decided: None, problems: Rc::clone(&self.problems) }))
    }
}

struct Robot<'a> {
    native: NativeMcu<'a>,
    decided: Option<CycleId>,
    problems: Rc<RefCell<Vec<Problem>>>,
}

/// After every event, before anything else is believed: has it just decided?
fn record(station: &Station<'_>, now: Instant, decided: &mut Option<CycleId>, problems: &mut Vec<Problem>) {
    let cycle = station.brain().cycle();
    let Some(state) = cycle.state().filter(|_| cycle.is_mine_to_decide()) else { return };
    if *decided == Some(state.id) || matches!(state.decision, Decision::Undecided | Decision::Closed(_)) {
        return;
    }
    *decided = Some(state.id);
    if let Some(problem) = station.brain().problem(now) {
        if let Decision::Play(play) = &state.decision {
            assert_eq!(play.ball, problem.ball.into(), "the problem is the one that was decided on");
        }
        problems.push(problem);
    }
}

impl Mcu for Robot<'_> {
    fn post(&mut self, tick: &TickIn<'_>) -> Result<(), McuError> {
        let mut problems = self.problems.borrow_mut();
        let decided = &mut self.decided;
        self.native.post_seen(tick, |station, now| record(station, now, decided, &mut problems));
        Ok(())
    }

    fn collect(&mut self) -> Result<Reply, McuError> {
        self.native.collect()
    }
}
