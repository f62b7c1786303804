//! `cycles`: a team's cycles for the page. From its robots' own beacons, by arena's log.

use arena::{CycleEvent, CycleLog};
use casebase::CaseBase;
use host::Host;
use page::{Cycle, MatchEvent, MatchEventKind};
use protocol::team::{CycleState, Status};
use protocol::{Instant, RobotId};
use rules::Colour;
use serde_json::{Value, json};

use super::layers::Played;
use super::names::Names;
use super::{description, team};

/// Cycles of one team.
#[derive(Debug, Default)]
pub(super) struct TeamCycles {
    log: CycleLog,
    newest: Option<(CycleState, f64)>,
    /// In open play a team without a fitting case retries again and again: reported once until a case is
    /// played.
    reported_none: bool,
}

impl TeamCycles {
    /// Takes the newest reports of the robots; new events go to `into`.
    pub(super) fn receive(&mut self, host: &Host, t: f64, names: &Names, into: &mut Vec<MatchEvent>) {
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
    }

    fn report(&mut self, event: CycleEvent, host: &Host, t: f64, names: &Names, into: &mut Vec<MatchEvent>) {
        let us = host.settings().us;
        let mut add = |kind, description: String, at, problem| {
            into.push(MatchEvent { t, kind, team: Some(team(us)), description, at, problem });
        };
        let of = |i: usize| self.log.cycles().get(i);
        match event {
            CycleEvent::Decided(i) => {
                let Some(cycle) = of(i) else { return };
                if let Some(play) = &cycle.play {
                    self.reported_none = false;
                    let players: Vec<_> = play.robots.iter().map(|id| id.number().to_string()).collect();
                    let description =
                        format!("{}: {} by {}", us.label(), names.of(play.case), players.join(", "));
                    let ball: geometry::Point<geometry::Field> = play.ball.into();
                    add(
                        MatchEventKind::Case,
                        description,
                        Some([ball.x(), ball.y()]),
                        Some(problem(host, play.ball.into())),
                    );
                } else if cycle.no_case && !self.reported_none {
                    self.reported_none = true;
                    let ball = host.world().ball.map(|ball| ball.position);
                    let problem =
                        ball.map(|ball| problem(host, protocol::quantized::WirePoint::from(ball).into()));
                    add(MatchEventKind::Cycle, format!("{}: no case fits", us.label()), None, problem);
                }
            }
            CycleEvent::Ended(i) => {
                let Some(cycle) = of(i).filter(|cycle| cycle.play.is_some()) else { return };
                if let Some((_, end)) = cycle.end {
                    add(
                        MatchEventKind::Cycle,
                        format!("{}: case {}", us.label(), end.label().replace('-', " ")),
                        None,
                        None,
                    );
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
        })
    }

    /// The case that is played at the moment, if any.
    pub(super) fn played<'b>(&'b self, base: Option<&CaseBase<'b>>, names: &Names) -> Option<Played<'b>> {
        let (state, _) = self.newest.as_ref()?;
        Played::of(base?, |case| names.of(case), state.play()?)
    }
}

/// The situation that a team retrieves in, as `cases explain` takes it: robots that take part, and the ball
/// position that is sent.
fn problem(host: &Host, ball: casebase::PointMm) -> Value {
    let us = host.settings().us;
    let mm = |at: geometry::Point<geometry::Field>| {
        let at: protocol::quantized::WirePoint = at.into();
        [at.x, at.y]
    };
    let world = host.world();
    let now: Instant = world.time;
    let offers = |id: RobotId| {
        let received = host.quality(id).is_some_and(|quality| quality.is_present(now));
        received && host.beacon(id).is_some_and(|beacon| beacon.status.has(Status::AVAILABLE))
    };
    let teammates: serde_json::Map<String, Value> = world
        .ours(us)
        .filter(|robot| offers(robot.who.id))
        .map(|robot| (robot.who.id.number().to_string(), json!(mm(robot.pose.position))))
        .collect();
    let opponents: Vec<_> = world.theirs(us).map(|robot| mm(robot.pose.position)).take(11).collect();
    let game = host.game();
    let own = game.own_goal(us).unwrap_or(host.settings().defending);
    json!({
        "ball": [ball.x, ball.y],
        "defending": own.label(),
        "teammates": teammates,
        "opponents": opponents,
    })
}
