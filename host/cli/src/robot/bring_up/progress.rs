//! `progress`: what a robot has told of the checks of its first start. Sans-IO: packets in, events out.
//!
//! Reports that name this host, or none, are taken; one robot is followed, and a newer start of it begins the
//! list anew.

use std::collections::BTreeSet;

use protocol::bring_up::{self, BringUpReport, CHECKS, Check, CheckState};
use protocol::frame::{Frame, Refusal, Sender, Sessions, TeamKey, TeamKeys, open_report};
use protocol::pulses::{self, PulseReport};
use protocol::robot_log::{self, LogReport};
use protocol::{RobotId, TeamId};

/// A change since the packet before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Event {
    /// The first report of a start of this robot.
    Started { robot: RobotId, start: u32 },
    /// A check runs, or has ended.
    Check { robot: RobotId, check: Check, state: CheckState },
}

/// Kind of a packet.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Taken {
    /// A report of the robot that is followed, new or repeated.
    pub(super) is_report: bool,
    pub(super) events: Vec<Event>,
    /// State of its kicker, with the robot's start.
    pub(super) kicker: Option<(u32, PulseReport)>,
    /// A piece of its log, likewise.
    pub(super) log: Option<(u32, LogReport)>,
}

/// Report of a robot.
enum Report {
    Check(BringUpReport),
    Kicker(PulseReport),
    Log(LogReport),
}

/// Counts of the list.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Summary {
    pub(super) robot: RobotId,
    pub(super) passed: usize,
    pub(super) failed: usize,
    /// Numbers from 1 of checks without a result.
    pub(super) open: Vec<usize>,
    /// The robot has named this host's epoch: its reports are no recording.
    pub(super) hears_us: bool,
}

/// The list of the robot that is followed.
#[derive(Debug)]
struct List {
    robot: RobotId,
    start: u32,
    states: [Option<CheckState>; CHECKS.len()],
    hears_us: bool,
}

/// All that came.
#[derive(Debug)]
pub(super) struct Progress {
    team: TeamId,
    keys: TeamKeys,
    epoch: u32,
    only: Option<RobotId>,
    sessions: Sessions,
    list: Option<List>,
    /// Robots whose frames carry no report: they run another image.
    others: BTreeSet<RobotId>,
    /// Robots that report and are not followed.
    not_followed: BTreeSet<RobotId>,
    wrong_tags: u32,
    other_team: Option<TeamId>,
    other_host: Option<u32>,
    unreadable: u32,
}

impl Progress {
    pub(super) fn new(team: TeamId, key: &TeamKey, epoch: u32, only: Option<RobotId>) -> Self {
        Self {
            team,
            keys: key.of_team(),
            epoch,
            only,
            sessions: Sessions::default(),
            list: None,
            others: BTreeSet::new(),
            not_followed: BTreeSet::new(),
            wrong_tags: 0,
            other_team: None,
            other_host: None,
            unreadable: 0,
        }
    }

    pub(super) fn take(&mut self, packet: &[u8]) -> Taken {
        match self.read(packet) {
            Ok(taken) => taken,
            Err(refusal) => {
                match refusal {
                    Refusal::Tag => self.wrong_tags = self.wrong_tags.saturating_add(1),
                    Refusal::Team(team) => self.other_team = Some(team),
                    Refusal::Payload | Refusal::Version(_) => {
                        self.unreadable = self.unreadable.saturating_add(1);
                    }
                    _ => {}
                }
                Taken::default()
            }
        }
    }

    fn read(&mut self, packet: &[u8]) -> Result<Taken, Refusal> {
        let frame = Frame::parse(packet, self.team)?;
        let who = (self.team, &self.keys);
        let (robot, host, report) = match (frame.sender, frame.payload.first()) {
            (Sender::Robot(robot), Some(&bring_up::KIND)) => {
                let (_, _, report) = bring_up::open(packet, self.team, &self.keys)?;
                (robot, report.host, Report::Check(report))
            }
            (Sender::Robot(robot), Some(&pulses::KIND)) => {
                let (_, _, report) = open_report::<PulseReport>(packet, who, pulses::KIND)?;
                (robot, report.host, Report::Kicker(report))
            }
            (Sender::Robot(robot), Some(&robot_log::KIND)) => {
                let (_, _, report) = open_report::<LogReport>(packet, who, robot_log::KIND)?;
                (robot, report.host, Report::Log(report))
            }
            (sender, _) => {
                self.others.extend(sender.robot());
                return Ok(Taken::default());
            }
        };
        self.sessions.check(&frame)?;
        if host != 0 && host != self.epoch {
            self.other_host = Some(host);
            return Ok(Taken::default());
        }
        let followed = self.list.as_ref().map(|list| list.robot).or(self.only);
        if followed.is_some_and(|followed| followed != robot) {
            self.not_followed.insert(robot);
            return Ok(Taken::default());
        }
        self.sessions.accept(&frame);
        let mut taken = Taken { is_report: true, ..Taken::default() };
        match report {
            Report::Check(report) => taken.events = self.follow(robot, frame.epoch, &report),
            Report::Kicker(report) => taken.kicker = Some((frame.epoch, report)),
            // Which robot is followed, a check decides.
            Report::Log(piece) => taken.log = followed.map(|_| (frame.epoch, piece)),
        }
        Ok(taken)
    }

    fn follow(&mut self, robot: RobotId, start: u32, report: &BringUpReport) -> Vec<Event> {
        let mut events = Vec::new();
        if self.list.as_ref().is_none_or(|list| list.start != start) {
            self.list = Some(List { robot, start, states: [None; CHECKS.len()], hears_us: false });
            events.push(Event::Started { robot, start });
        }
        let (check, state) = (report.check, report.state);
        if let Some(list) = &mut self.list
            && let Some(known) = check.number().and_then(|number| list.states.get_mut(number))
        {
            list.hears_us |= report.host == self.epoch;
            // NaN equals nothing: compared by value, such a report would count as new each time.
            let text = |state: &CheckState| format!("{state:?}");
            if known.as_ref().map(text) != Some(text(&state)) {
                *known = Some(state);
                events.push(Event::Check { robot, check, state });
            }
        }
        events
    }

    pub(super) fn is_complete(&self) -> bool {
        self.summary().is_some_and(|summary| summary.open.is_empty())
    }

    /// Counts so far; `None` before the first report.
    pub(super) fn summary(&self) -> Option<Summary> {
        let list = self.list.as_ref()?;
        let count =
            |is: fn(&CheckState) -> bool| list.states.iter().flatten().filter(|state| is(state)).count();
        let is_open = |state: &Option<CheckState>| matches!(state, None | Some(CheckState::Running));
        Some(Summary {
            robot: list.robot,
            passed: count(|state| matches!(state, CheckState::Passed(_))),
            failed: count(|state| matches!(state, CheckState::Failed(_))),
            open: (1..)
                .zip(&list.states)
                .filter(|(_, state)| is_open(state))
                .map(|(number, _)| number)
                .collect(),
            hears_us: list.hears_us,
        })
    }

    /// Why no report came, as far as other frames tell.
    pub(super) fn hint(&self) -> Option<String> {
        let robots = |robots: &BTreeSet<RobotId>| {
            let robots: Vec<_> = robots.iter().map(RobotId::to_string).collect();
            robots.join(", ")
        };
        if self.wrong_tags > 0 {
            return Some(
                "reports come in with a wrong tag: --key-file is not the key that its page was made from"
                    .to_owned(),
            );
        }
        if !self.not_followed.is_empty() {
            return Some(format!(
                "reports come in of robot {}; leave --robot out, or name it",
                robots(&self.not_followed)
            ));
        }
        if let Some(epoch) = self.other_host {
            return Some(format!(
                "reports come in that name another host (epoch {epoch}): end `onetwo control`, or they are a recording"
            ));
        }
        if self.unreadable > 0 {
            return Some("frames come in that cannot be read: flash the robot with this release".to_owned());
        }
        if !self.others.is_empty() {
            return Some(format!(
                "robot {} runs another image than bring_up: flash that",
                robots(&self.others)
            ));
        }
        self.other_team.map(|team| format!("frames of team {} come in: give --team as in its page", team.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::bring_up::{Finding, Reporter};
    use protocol::link::{Link, Packet};
    use protocol::team::{Handshake, TeamMessage};

    const TEAM: TeamId = TeamId(2);
    const KEY: TeamKey = TeamKey([4; 16]);
    const US: u32 = 77;

    fn robot(n: u8) -> RobotId {
        RobotId::new(n).unwrap()
    }

    fn packet(key: TeamKey, start: u32, counter: u32, host: u32, number: usize, state: CheckState) -> Packet {
        let key = key.of_robot(robot(3)).host;
        let reporter = Reporter { team: TEAM, robot: robot(3), key, epoch: start };
        reporter.seal(counter, &BringUpReport { host, check: CHECKS[number], state })
    }

    fn progress() -> Progress {
        Progress::new(TEAM, &KEY, US, None)
    }

    #[test]
    fn a_result_is_told_once_however_often_it_comes_and_the_last_one_completes_the_list() {
        let mut all = progress();
        let ended = |counter, number, state| packet(KEY, 1, counter, US, number, state);
        for round in 0..2 {
            for (number, check) in CHECKS.into_iter().enumerate() {
                let nan = CheckState::Failed(Finding::Speed(f32::NAN, 1.0));
                let state = if number == 4 { nan } else { CheckState::Passed(1.0) };
                let taken = all.take(&ended(1 + round * 20 + number as u32, number, state));
                assert!(taken.is_report);
                let told = taken.events.iter().filter(|event| matches!(event, Event::Check { .. })).count();
                assert_eq!(told, usize::from(round == 0), "{check}");
                assert_eq!(all.is_complete(), round == 1 || number == CHECKS.len() - 1);
            }
        }
        let summary = all.summary().unwrap();
        assert_eq!((summary.passed, summary.failed, summary.hears_us), (11, 1, true));
    }

    #[test]
    fn a_new_start_begins_the_list_anew_and_an_older_one_changes_nothing() {
        let mut all = progress();
        let _ = all.take(&packet(KEY, 5, 9, 0, 0, CheckState::Passed(15.0)));
        assert_eq!(all.take(&packet(KEY, 4, 10, 0, 1, CheckState::Running)), Taken::default());
        assert_eq!(all.take(&packet(KEY, 5, 9, 0, 1, CheckState::Running)), Taken::default());
        let taken = all.take(&packet(KEY, 6, 1, US, 0, CheckState::Running));
        assert_eq!(taken.events[0], Event::Started { robot: robot(3), start: 6 });
        let summary = all.summary().unwrap();
        assert_eq!((summary.passed, summary.open.len()), (0, CHECKS.len()));
    }

    #[test]
    fn what_comes_instead_of_reports_is_named() {
        let hint = |only: Option<RobotId>, packet: &[u8]| {
            let mut all = Progress::new(TEAM, &KEY, US, only);
            assert_eq!(all.take(packet), Taken::default());
            assert!(all.summary().is_none());
            all.hint().unwrap_or_default()
        };
        let running = |key, host| packet(key, 1, 1, host, 0, CheckState::Running);
        assert!(hint(None, &running(TeamKey([5; 16]), US)).contains("--key-file"));
        assert!(hint(None, &running(KEY, US - 1)).contains("onetwo control"));
        assert!(hint(Some(robot(4)), &running(KEY, US)).contains("robot 3"));
        let beacon = TeamMessage::Handshake(Handshake::default());
        let playing = Link::new(TEAM, robot(3), KEY.of_robot(robot(3)), 1).seal(&beacon);
        assert!(hint(None, &playing).contains("bring_up"));
        let other = Link::new(TeamId(9), robot(3), KEY.of_robot(robot(3)), 1).seal(&beacon);
        assert!(hint(None, &other).contains("team 9"));
        assert_eq!(hint(None, b"noise"), "");
    }
}
