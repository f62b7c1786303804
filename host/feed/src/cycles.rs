//! `cycles`: a team's cycles for the page. From its robots' own beacons, by arena's log.

use arena::{CycleEvent, CycleLog};
use casebase::{CaseBase, PROBLEM_OPPONENTS_MAX, PROBLEM_TEAMMATES_MAX, Problem};
use host::Host;
use host::world::Robot;
use page::{Cycle, DecisionNote, MatchEvent, MatchEventKind};
use protocol::decision::DecisionReport;
use protocol::quantized::WirePoint;
use protocol::team::CycleState;
use protocol::{CycleId, RobotId};
use rules::Colour;
use serde_json::Value;

use super::layers::Played;
use super::names::Names;
use super::{description, minds, team};

#[derive(Debug, Default)]
pub(crate) struct TeamCycles {
    log: CycleLog,
    newest: Option<(CycleState, f64)>,
    /// In open play a team without a fitting case retries again and again: reported once until a case is
    /// played.
    reported_none: bool,
    /// A decision whose problem its coordinator has not reported whole yet.
    awaited: Option<Awaited>,
    decided: Option<DecisionNote>,
    /// The decisions reported by the last call, with the times at which they were received.
    reported_decisions: Vec<(f64, DecisionNote)>,
}

/// A decision on the radio, with the event that tells of it.
#[derive(Debug)]
struct Awaited {
    id: CycleId,
    /// When it was received, s.
    at: f64,
    /// As the host saw the situation, in case no report comes.
    rebuilt: DecisionNote,
    /// Left out for one more "no case fits".
    event: Option<MatchEvent>,
}

/// A coordinator's report is waited for as long as this, s: it sends each part twice, within 0.2 s of the
/// decision even where beacons and telemetry take every second step.
const REPORT_WITHIN_S: f64 = 0.3;

impl TeamCycles {
    /// Takes the newest reports of the robots; new events go to `into`.
    pub(crate) fn receive(&mut self, host: &Host, t: f64, names: &Names, into: &mut Vec<MatchEvent>) {
        self.reported_decisions.clear();
        // A report may come with the beacon of the next decision.
        self.receive_report(host, t, into);
        for robot in RobotId::all() {
            let Some(state) = host.beacon(robot).and_then(|beacon| beacon.cycle.as_ref()) else { continue };
            if state.is_newer_than(self.newest.as_ref().map(|(state, _)| state)) {
                let same = self.newest.as_ref().filter(|(known, _)| known.id == state.id);
                let began = same.map_or(t, |(_, began)| *began);
                self.newest = Some((state.clone(), began));
            }
            let event = self.log.receive(t as f32, state);
            self.report(event, host, t, names, into);
        }
        self.receive_report(host, t, into);
    }

    /// Every decision that the last call of [`Self::receive`] reported, those without an event among them.
    pub(crate) fn reported_decisions(&self) -> &[(f64, DecisionNote)] {
        &self.reported_decisions
    }

    /// The decision whose report was still awaited at the end of a recording, as the host saw it.
    pub(crate) fn left(&self) -> Option<(f64, &DecisionNote)> {
        self.awaited.as_ref().map(|awaited| (awaited.at, &awaited.rebuilt))
    }

    /// The awaited decision's problem has come, or will not come any more.
    fn receive_report(&mut self, host: &Host, t: f64, into: &mut Vec<MatchEvent>) {
        let report = |awaited: &Awaited| {
            let of = |id: RobotId| host.decision(id).filter(|report| report.cycle == awaited.id);
            RobotId::all().find_map(|id| Some(reported(id, of(id)?)))
        };
        if let Some(note) = self.awaited.as_ref().and_then(report) {
            self.tell(Some(note), into);
        } else if self
            .awaited
            .as_ref()
            .is_some_and(|awaited| !(0.0..REPORT_WITHIN_S).contains(&(t - awaited.at)))
        {
            self.tell(None, into);
        }
    }

    /// Tells the awaited decision, with its own problem where there is one.
    fn tell(&mut self, own: Option<DecisionNote>, into: &mut Vec<MatchEvent>) {
        let Some(Awaited { at, rebuilt, event, .. }) = self.awaited.take() else { return };
        let note = own.unwrap_or(rebuilt);
        self.reported_decisions.push((at, note.clone()));
        self.decided = Some(note.clone());
        let tell = |event| MatchEvent { problem: note.problem.clone(), decided: Some(note), ..event };
        into.extend(event.map(tell));
    }

    fn report(&mut self, event: CycleEvent, host: &Host, t: f64, names: &Names, into: &mut Vec<MatchEvent>) {
        let us = host.settings().us;
        let made = |kind, description: String, at| MatchEvent {
            at,
            ..MatchEvent::new(t, kind, Some(team(us)), description)
        };
        let of = |i: usize| self.log.cycles().get(i);
        match event {
            CycleEvent::Decided(i) => {
                let Some(cycle) = of(i) else { return };
                let (id, seen) = (cycle.id, host.world().ball.map(|ball| WirePoint::from(ball.position)));
                let mut rebuilt = DecisionNote {
                    by: cycle.coordinator.number(),
                    cycle: id.counter,
                    ..DecisionNote::default()
                };
                let event = if let Some(play) = &cycle.play {
                    rebuilt.id = Some(play.case.0);
                    rebuilt.problem = Some(problem(host, play.ball));
                    self.reported_none = false;
                    let players: Vec<_> = play.robots.iter().map(|id| id.number().to_string()).collect();
                    let description =
                        format!("{}: {} by {}", us.label(), names.of(play.case), players.join(", "));
                    let ball: geometry::Point<geometry::Field> = play.ball.into();
                    Some(made(MatchEventKind::Case, description, Some([ball.x(), ball.y()])))
                } else {
                    rebuilt.problem = seen.map(|ball| problem(host, ball));
                    let first = !std::mem::replace(&mut self.reported_none, true);
                    let description = || format!("{}: no case fits", us.label());
                    first.then(|| made(MatchEventKind::Cycle, description(), None))
                };
                self.tell(None, into);
                self.awaited = Some(Awaited { id, at: t, rebuilt, event });
            }
            CycleEvent::Ended(i) => {
                let Some(cycle) = of(i).filter(|cycle| cycle.play.is_some()) else { return };
                if let Some((_, end)) = cycle.end {
                    let description = format!("{}: case {}", us.label(), description::end_by(host, end));
                    let event = made(MatchEventKind::Cycle, description, None);
                    self.tell(None, into);
                    into.push(event);
                }
            }
            CycleEvent::Nothing | CycleEvent::Began(_) => {}
        }
    }

    /// The newest cycle, for the page.
    pub(super) fn rows(
        &self,
        us: Colour,
        t: f64,
        base: Option<&CaseBase<'_>>,
        names: &Names,
    ) -> Option<Cycle> {
        let (state, began) = self.newest.as_ref()?;
        // The case stays displayed while the end of its cycle is.
        let seen = self.log.cycles().iter().rev().find(|cycle| cycle.id == state.id);
        let play = seen.and_then(|cycle| cycle.play.as_ref());
        let case = play.and_then(|play| base?.case(play.case));
        Some(Cycle {
            team: Some(team(us)),
            number: state.id.counter,
            coordinator: state.coordinator.number(),
            state: description::decision(&state.decision),
            case: play.map(|play| names.of(play.case)).unwrap_or_default(),
            symmetry: case.map(|case| case.symmetry().label().to_owned()).unwrap_or_default(),
            meant: play.map(|play| names.meant(play.case)).unwrap_or_default(),
            players: play.map(|play| play.robots.iter().map(|id| id.number()).collect()).unwrap_or_default(),
            seconds: (t - began) as f32,
            decided: self.decided.clone(),
        })
    }

    /// The case that is played at the moment, if any.
    pub(super) fn played<'b>(&'b self, base: Option<&CaseBase<'b>>, names: &Names) -> Option<Played<'b>> {
        let (state, _) = self.newest.as_ref()?;
        Played::of(base?, |case| names.of(case), state.play()?)
    }
}

pub(crate) fn reported(by: RobotId, report: &DecisionReport) -> DecisionNote {
    DecisionNote {
        reported: true,
        by: by.number(),
        cycle: report.cycle.counter,
        id: report.case.map(|case| case.0),
        grounds: description::grounds(report.grounds),
        problem: Problem::of(report).map(|problem| arena::cases::problem::value(&problem)),
    }
}

/// The situation that a team retrieves in as its host sees it: robots that take part, and the ball
/// position that is sent.
fn problem(host: &Host, ball: WirePoint) -> Value {
    let us = host.settings().us;
    let world = host.world();
    let available = |id: RobotId| minds::is_available(host, id, world.time);
    let place = |robot: &Robot| WirePoint::from(robot.pose.position).into();
    let ours = world.ours(us).filter(|robot| available(robot.who.id));
    arena::cases::problem::value(&Problem {
        ball: ball.into(),
        defending: host.game().own_goal(us).unwrap_or(host.settings().defending),
        teammates: ours.map(|robot| (robot.who.id, place(robot))).take(PROBLEM_TEAMMATES_MAX).collect(),
        opponents: world.theirs(us).map(place).take(PROBLEM_OPPONENTS_MAX).collect(),
    })
}
