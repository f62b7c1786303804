//! `played`: problems for which robots retrieve in play. Those of whole trials, recorded as their
//! coordinators decided.
//!
//! No file keeps them: trials are seeded and fast, so the problems are those of today's library and brain.

use std::cell::RefCell;
use std::rc::Rc;

use arena::{TrialConfig, run};
use brain::{Approach, BrainConfig, Station};
use casebase::{CaseBase, Problem};
use hil_sim::{Backend, Configuration, Mcu, McuError, Reply, Scenario};
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
        let station = Station::new(Instant(0), config, self.base);
        let problems = Rc::clone(&self.problems);
        Ok(Box::new(Robot { station, reply: Reply::default(), decided: None, problems }))
    }
}

struct Robot<'a> {
    station: Station<'a>,
    reply: Reply,
    /// The last cycle it decided.
    decided: Option<CycleId>,
    problems: Rc<RefCell<Vec<Problem>>>,
}

impl Robot<'_> {
    /// Called after every event, before the next one: checks for a new decision, and sends the messages.
    fn after(&mut self, now: Instant) {
        self.record(now);
        while let Some(packet) = self.station.poll_packet(now) {
            let _dropped = self.reply.packets.push(packet);
            self.record(now);
        }
    }

    fn record(&mut self, now: Instant) {
        let cycle = self.station.brain().cycle();
        let Some(state) = cycle.state().filter(|_| cycle.is_mine_to_decide()) else { return };
        if self.decided == Some(state.id)
            || matches!(state.decision, Decision::Undecided | Decision::Closed(_))
        {
            return;
        }
        self.decided = Some(state.id);
        if let Some(problem) = self.station.brain().problem(now) {
            if let Decision::Play(play) = &state.decision {
                assert_eq!(play.ball, problem.ball.into(), "the problem is the one that was decided on");
            }
            self.problems.borrow_mut().push(problem);
        }
    }
}

impl Mcu for Robot<'_> {
    fn post(&mut self, tick: &TickIn<'_>) -> Result<(), McuError> {
        self.reply = Reply::default();
        while let Some(due) = self.station.poll_timeout().filter(|due| *due <= tick.now) {
            self.station.handle_timeout(due);
            self.after(due);
        }
        for packet in &tick.air {
            self.station.handle_packet(tick.now, packet);
            self.after(tick.now);
        }
        self.station.handle_sensors(tick.now, &tick.sensors);
        self.after(tick.now);
        self.reply.actuators = self.station.poll_actuators(tick.now);
        Ok(())
    }

    fn collect(&mut self) -> Result<Reply, McuError> {
        Ok(std::mem::take(&mut self.reply))
    }
}
