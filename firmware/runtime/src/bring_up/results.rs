//! `results`: state of each check of a robot's first start, and the packets that report it to the host over
//! and over: a lost packet only delays, and a host that starts late still gets them all.

use protocol::bring_up::{BringUpReport, CHECKS, CheckState, Reporter};
use protocol::link::Packet;
use protocol::robot_log::{self, LogReport};
use protocol::{Duration, Instant, TeamId, pulses};

use super::{BenchStep, Kicks};

/// Period of the packets: each check is reported at least four times a second, in 2 kB/s.
pub const REPORT_EVERY: Duration = Duration::millis(20);

/// State of each check, reported by a robot that has its keys.
#[derive(Clone, Debug)]
pub struct Results {
    reporter: Reporter,
    counter: u32,
    states: [Option<CheckState>; CHECKS.len()],
    /// The check whose turn it is.
    next: usize,
    /// Interlock of its kicker.
    pub kicks: Kicks,
}

impl Results {
    /// Results of which none is known yet.
    pub const fn new(reporter: Reporter) -> Self {
        Self { reporter, counter: 0, states: [None; CHECKS.len()], next: 0, kicks: Kicks::new(reporter) }
    }

    /// Team of the robot.
    pub const fn team(&self) -> TeamId {
        self.reporter.team
    }

    /// Takes what a step of the checks has given.
    pub fn take(&mut self, step: &BenchStep) {
        if let Some(check) = step.check {
            self.put(check, CheckState::Running);
        }
        if let Some(report) = step.report {
            self.put(report.check, report.result.into());
        }
    }

    /// The next packet, to be sent every [`REPORT_EVERY`]: the checks that have started take turns. `host` is
    /// the epoch of the host that is received, 0 without one. `None` before the first check.
    pub fn packet(&mut self, host: u32) -> Option<Packet> {
        let turns = (self.next..CHECKS.len()).chain(0..self.next);
        let (number, check, state) = turns.into_iter().find_map(|number| self.started(number))?;
        self.next = (number + 1) % CHECKS.len();
        self.counter = self.counter.saturating_add(1);
        Some(self.reporter.seal(self.counter, &BringUpReport { host, check, state }))
    }

    /// The packet that reports the state of the kicker.
    pub fn kick_packet(&mut self, now: Instant, host: u32) -> Packet {
        self.counter = self.counter.saturating_add(1);
        self.reporter.seal_as(self.counter, pulses::KIND, &self.kicks.report(now, host))
    }

    /// The packet that carries that piece of the log.
    pub fn log_packet(&mut self, piece: &LogReport) -> Packet {
        self.counter = self.counter.saturating_add(1);
        self.reporter.seal_as(self.counter, robot_log::KIND, piece)
    }

    /// The check of this number with its state, once it has started.
    fn started(&self, number: usize) -> Option<(usize, super::Check, CheckState)> {
        Some((number, *CHECKS.get(number)?, (*self.states.get(number)?)?))
    }

    fn put(&mut self, check: super::Check, state: CheckState) {
        if let Some(place) = check.number().and_then(|number| self.states.get_mut(number)) {
            *place = Some(state);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::vec::Vec;

    use protocol::bring_up::open;
    use protocol::frame::TeamKey;
    use protocol::{RobotId, TeamId};

    use super::*;
    use crate::bring_up::bench::{Fault, play_steps};

    const KEY: TeamKey = TeamKey([3; 16]);

    fn reporter() -> Reporter {
        let robot = RobotId::new(6).unwrap();
        Reporter { team: TeamId(2), robot, key: KEY.of_robot(robot).host, epoch: 1 }
    }

    /// States by check as a receiver has them that loses that share of all packets, and as the robot has
    /// them; a second after the last check.
    fn received_and_own(fault: Fault, loses: f32) -> (BTreeMap<usize, CheckState>, Vec<CheckState>) {
        let (mut results, mut own, mut received) = (Results::new(reporter()), Vec::new(), BTreeMap::new());
        let (mut dice, mut steps) = (1_u32, 0_u32);
        let mut send = |results: &mut Results| {
            dice = dice.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let lost = (dice >> 8) as f32 / 16_777_216.0 < loses;
            if let Some(packet) = results.packet(5).filter(|_| !lost) {
                let (_, _, report) = open(&packet, TeamId(2), &KEY.of_team()).unwrap();
                assert_eq!(report.host, 5);
                received.insert(report.check.number().unwrap(), report.state);
            }
        };
        play_steps(fault, 1, |step| {
            results.take(step);
            own.extend(step.report.map(|report| CheckState::from(report.result)));
            steps += 1;
            if steps.is_multiple_of(20) {
                send(&mut results);
            }
        });
        for _ in 0..50 {
            send(&mut results);
        }
        (received, own)
    }

    #[test]
    fn every_result_reaches_the_host_with_any_fault_and_30_percent_of_packets_lost() {
        for fault in Fault::EXAMPLES.map(|(_, fault)| fault) {
            for loses in [0.0, 0.3] {
                let (received, own) = received_and_own(fault, loses);
                assert_eq!(own.len(), CHECKS.len());
                assert_eq!(received.into_values().collect::<Vec<_>>(), own, "{fault:?}, {loses}");
            }
        }
    }

    #[test]
    fn no_packet_precedes_the_first_check_and_a_running_check_is_reported_as_running() {
        let mut results = Results::new(reporter());
        assert_eq!(results.packet(0), None);
        let motors = crate::wheel::Motors::Released;
        results.take(&BenchStep { motors, report: None, check: Some(CHECKS[0]) });
        for _ in 0..2 {
            let packet = results.packet(0).unwrap();
            let (_, _, report) = open(&packet, TeamId(2), &KEY.of_team()).unwrap();
            assert_eq!((report.check, report.state), (CHECKS[0], CheckState::Running));
        }
    }
}
