//! `story`: text log of a trial. Coordinator, case and its players, phases, kicks, possession, outcome; a
//! line each, with its time.

use std::fmt::Write as _;

use casebase::{Action, CaseRobot, PointMm, TurnTarget};
use hil_sim::four_legged::world::WorldEvent;
use hil_sim::{Configuration, Fault, OpponentRole, TrialOutcome};
use protocol::RobotId;
use protocol::robot_io::LeggedKick;
use protocol::team::{Play, Progress};

use crate::cycles::{CycleEvent, CycleSeen, shot_label};
use crate::names::symmetry;
use crate::report::TrialReport;
use crate::trial::{Moment, Watcher};

/// Writes the log of a trial while it runs.
#[derive(Clone, Debug, Default)]
pub struct TextLog {
    lines: Vec<(f32, String)>,
    /// Progress of each robot as last logged.
    progress: Vec<(RobotId, Progress)>,
    /// The last logged decision was that no case fits.
    without_case: bool,
    possessions: u32,
}

impl TextLog {
    /// The lines since the last call, in the order of their times: the field reports its events at the end of
    /// a tick, with the times within it.
    pub fn take_lines(&mut self) -> Vec<String> {
        let mut lines = std::mem::take(&mut self.lines);
        lines.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        lines.into_iter().map(|(_, line)| line).collect()
    }

    fn add(&mut self, time: f32, text: impl AsRef<str>) {
        self.lines.push((time, format!("{time:7.2} s  {}", text.as_ref())));
    }

    fn opening(&mut self, moment: &Moment<'_>) {
        let config = moment.config;
        let (scenario, title, seed) = (config.scenario, config.scenario.title(), config.seed);
        let what = if config.layout.is_some() {
            let opponents: Vec<_> = (0..moment.cast.opponents.len())
                .map(|i| moment.cast.name(moment.cast.attackers.len() + i))
                .collect();
            let against = if opponents.is_empty() { "nobody".to_owned() } else { opponents.join(" and ") };
            format!("a given situation against {against}")
        } else {
            let against = match config.opponents {
                Configuration::DefenderGoalie => "a defender and a goalie",
                Configuration::TwoDefenders => "a midfield defender and a defender",
            };
            if scenario.label() == title {
                format!("random scenario {seed} against {against}")
            } else {
                format!("scenario {scenario} ({title}) against {against}")
            }
        };
        let names: Vec<_> = moment
            .cast
            .attackers
            .iter()
            .map(|id| format!("{} is robot {id}", moment.cast.name_of(*id)))
            .collect();
        self.add(0.0, format!("{what}, seed {seed}; {}", names.join(", ")));
    }

    fn fault(&mut self, moment: &Moment<'_>, fault: &Fault) {
        let name = |id| moment.cast.name_of(id);
        let text = match fault {
            Fault::Crash(id) => format!("{} crashes", name(*id)),
            Fault::Return(id) => format!("{} restarts", name(*id)),
            Fault::Air(air) => format!("the air changes: {:.0} % loss", air.loss * 100.0),
            Fault::FlipOrderBit { robot, bit } => format!("bit {bit} of {}'s next order flips", name(*robot)),
        };
        self.add(moment.tick.time, text);
    }

    fn on_event(&mut self, moment: &Moment<'_>, event: CycleEvent) {
        let (CycleEvent::Began(i) | CycleEvent::Decided(i) | CycleEvent::Ended(i)) = event else { return };
        let Some(cycle) = moment.cycles.cycles().get(i) else { return };
        match (event, &cycle.play) {
            (CycleEvent::Decided(_), Some(play)) => self.decided(moment, cycle, play),
            (CycleEvent::Ended(_), Some(_)) => {
                let end = cycle.end.map_or("", |(_, end)| end.label());
                let shot = shot_label(cycle.shot).map_or(String::new(), |rule| format!(" (shot: {rule})"));
                self.add(moment.tick.time, format!("cycle {} is over: {end}{shot}", cycle.id));
            }
            _ if cycle.no_case && !self.without_case => {
                self.without_case = true;
                let coordinator = moment.cast.name_of(cycle.coordinator);
                let text = format!("{coordinator} retrieves no case: all robots play reactively");
                self.add(moment.tick.time, text);
            }
            _ => {}
        }
    }

    fn decided(&mut self, moment: &Moment<'_>, cycle: &CycleSeen, play: &Play) {
        self.without_case = false;
        let coordinator = moment.cast.name_of(cycle.coordinator);
        let (case, copy) = (moment.config.names.of(play.case), symmetry(play.case));
        let mut text = format!("cycle {}: {coordinator} coordinates and retrieves {case} ({copy})", cycle.id);
        for (i, id) in play.robots.iter().enumerate() {
            let actions: Vec<_> = (0..)
                .map_while(|n| action(moment, play, i, n))
                .map(|a| action_description(moment, play, a))
                .collect();
            let _ = write!(text, "\n             {} plays: {}", moment.cast.name_of(*id), actions.join(", "));
        }
        self.add(moment.tick.time, text);
    }

    fn progress(&mut self, moment: &Moment<'_>, id: RobotId, now: Progress, play: Option<&Play>) {
        let known = self.progress.iter().position(|(robot, _)| *robot == id);
        let place = known.unwrap_or_else(|| {
            self.progress.push((id, Progress::Idle));
            self.progress.len() - 1
        });
        let before = std::mem::replace(&mut self.progress[place].1, now);
        if before == now {
            return;
        }
        let name = moment.cast.name_of(id);
        let next = |done: u8| {
            let (play, part) = play.and_then(|play| Some((play, play.part_of(id)?)))?;
            action(moment, play, part, usize::from(done)).map(|a| action_description(moment, play, a))
        };
        let text = match now {
            Progress::Idle | Progress::WaitEnd { finished: false } => return,
            Progress::Adapt { arrived: false } => format!("{name} goes to its place"),
            Progress::Adapt { arrived: true } => format!("{name} is at its place"),
            Progress::Execute { done } => match next(done) {
                Some(action) => format!("{name}: {action}"),
                None => return,
            },
            Progress::WaitEnd { finished: true } => format!("{name} has done its part"),
        };
        self.add(moment.tick.time, text);
    }

    fn event(&mut self, moment: &Moment<'_>, time: f32, event: &WorldEvent) {
        let name = |robot| moment.cast.name(robot);
        let text = match *event {
            WorldEvent::Touched { .. } | WorldEvent::KickedNothing { .. } => return,
            WorldEvent::Grabbed { robot } => format!("{} has the ball", name(robot)),
            WorldEvent::GrabFailed { robot } => format!("{}'s grab fails", name(robot)),
            WorldEvent::Stolen { by, from } => format!("{} takes the ball off {}", name(by), name(from)),
            WorldEvent::Kicked { robot, kick, from, rest } => {
                let verb = match kick {
                    LeggedKick::Pass(_) => "passes",
                    LeggedKick::ForwardSoft => "kicks softly ahead",
                    LeggedKick::ForwardHard => "kicks hard ahead",
                    LeggedKick::Left => "kicks to its left",
                    LeggedKick::Right => "kicks to its right",
                };
                format!("{} {verb}, {:.1} m", name(robot), from.distance(rest))
            }
        };
        self.add(time, text);
    }
}

impl Watcher for TextLog {
    fn watch(&mut self, moment: &Moment<'_>) {
        if moment.tick.number == 0 {
            self.opening(moment);
        }
        for fault in &moment.tick.faults {
            self.fault(moment, fault);
        }
        for event in moment.events {
            self.on_event(moment, *event);
        }
        for (id, beacon) in moment.beacons {
            let play = beacon.cycle.as_ref().and_then(|cycle| cycle.play());
            self.progress(moment, *id, beacon.progress, play);
        }
        for (time, event) in &moment.tick.events {
            self.event(moment, *time, event);
        }
        let possessions = moment.referee.possessions(OpponentRole::Defender)
            + moment.referee.possessions(OpponentRole::Midfield);
        if possessions > self.possessions {
            let who = moment.referee.last_touch().map_or("an opponent", hil_sim::Party::label);
            self.add(moment.tick.time, format!("possession {possessions} of the opponents ({who})"));
            self.possessions = possessions;
        }
    }

    fn end(&mut self, _moment: &Moment<'_>, report: &TrialReport) {
        let text = match (report.outcome, report.opponents) {
            (TrialOutcome::Goal, Configuration::DefenderGoalie) => "goal".to_owned(),
            (TrialOutcome::Goal, Configuration::TwoDefenders) => {
                "goal: the ball is in the penalty area".to_owned()
            }
            (TrialOutcome::Close, _) => "close: out beside the goalpost".to_owned(),
            (TrialOutcome::Block, _) => "block: the goalie has the ball".to_owned(),
            (TrialOutcome::Out, _) => {
                format!("out, last touched by the {}", report.out_by.unwrap_or("nobody"))
            }
            (TrialOutcome::Timeout, _) => "time is up".to_owned(),
        };
        let counts = report.cases;
        self.add(report.time_s as f32, text);
        self.add(
            report.time_s as f32,
            format!(
                "{} individual and {} cooperative cases, {} times none; the opponents had the ball {} times",
                counts.individual,
                counts.cooperative,
                counts.none,
                report.possession.defender + report.possession.midfield
            ),
        );
    }
}

/// Action `n` of the list of the case robot at index `part`.
fn action(moment: &Moment<'_>, play: &Play, part: usize, n: usize) -> Option<Action> {
    moment.config.base.case(play.case)?.action(CaseRobot::new(part)?, n)
}

fn action_description(moment: &Moment<'_>, play: &Play, action: Action) -> String {
    let case = moment.config.base.case(play.case);
    let shift = case.map_or(PointMm::default(), |case| case.shift(play.ball.into()));
    let place = |p: PointMm| {
        let PointMm { x, y } = p.plus(shift);
        format!("({x}, {y})")
    };
    let teammate = |robot: CaseRobot| {
        play.robots.get(robot.index()).map_or_else(|| "nobody".to_owned(), |id| moment.cast.name_of(*id))
    };
    match action {
        Action::Wait => "wait".to_owned(),
        Action::GoToPoint(p) => format!("go to {}", place(p)),
        Action::Turn(TurnTarget::HeadingDeg(degrees)) => format!("turn to {degrees}°"),
        Action::Turn(TurnTarget::Face(p)) => format!("face {}", place(p)),
        Action::GetBall => "get the ball".to_owned(),
        Action::DribbleTo(p) => format!("dribble to {}", place(p)),
        Action::PassBall(to) => format!("pass to {}", teammate(to)),
        Action::ReceiveBall(from) => format!("receive from {}", teammate(from)),
        Action::Kick(_) => "kick".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use brain::Approach;
    use hil_sim::{NativeBackend, Scenario, ScheduledFault};

    use super::*;
    use crate::trial::{TrialConfig, run};

    fn reported(config: &TrialConfig<'static>) -> (Vec<String>, TrialReport) {
        let mut story = TextLog::default();
        let report = run(config, Box::new(NativeBackend::new(config.base)), &mut [&mut story]).unwrap();
        (story.take_lines(), report)
    }

    #[test]
    fn it_names_who_is_who_the_coordinator_the_case_its_phases_and_the_outcome() {
        let mut config =
            TrialConfig::new(Scenario::DefenderClose, Configuration::DefenderGoalie, Approach::Cases, 1);
        let robot = RobotId::new(2).unwrap();
        config.faults.push(ScheduledFault { tick: 100, fault: Fault::Crash(robot) });
        let (lines, report) = reported(&config);
        assert!(lines[0].contains("scenario 4") && lines[0].contains("A is robot 1, B is robot 2"));
        let played = report.cycles.iter().find_map(|cycle| cycle.case.clone()).unwrap();
        let retrieval = lines.iter().find(|line| line.contains("coordinates and retrieves")).unwrap();
        assert!(retrieval.contains(&played) && retrieval.contains("plays: get the ball"), "{retrieval}");
        for description in ["goes to its place", ": get the ball", "   4.00 s  B crashes"] {
            assert!(lines.iter().any(|line| line.contains(description)), "{description}");
        }
        let end = &lines[lines.len() - 2];
        assert!(end.starts_with(&format!("{:7.2} s", report.time_s)), "{end}");
    }

    #[test]
    fn a_reactive_team_has_a_story_without_cases() {
        let config = TrialConfig::new(Scenario::Random, Configuration::TwoDefenders, Approach::Reactive, 1);
        let (lines, _) = reported(&config);
        assert!(lines[0].contains("random scenario 1 against a midfield defender and a defender"));
        assert!(lines.iter().all(|line| !line.contains("retrieves")));
    }
}
