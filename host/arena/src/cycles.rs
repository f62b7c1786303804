//! `cycles`: log of a team's retrieve–reuse cycles. Derived from overheard beacons alone (paper §4;
//! docs/architecture.md §5).

use protocol::team::{Closure, CycleState, Decision, Play, ShotRule};
use protocol::{CycleId, RobotId};

/// A cycle as seen from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct CycleSeen {
    /// Id of the cycle, as in its beacons.
    pub id: CycleId,
    /// The robot that coordinates the cycle.
    pub coordinator: RobotId,
    /// The play, if a case was found.
    pub play: Option<Play>,
    /// The coordinator reported that no case fits.
    pub no_case: bool,
    /// Seconds from kick-off at which its first beacon was received.
    pub start: f32,
    /// Time and kind of its end, once it has ended.
    pub end: Option<(f32, CycleEnd)>,
    /// The rule of its last shot at goal, made or prepared.
    pub shot: ShotRule,
}

/// End of a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CycleEnd {
    /// Closed, as its robots reported.
    Closed(Closure),
    /// A newer one started before it was closed.
    Superseded,
    /// The trial was over first.
    TrialOver,
}

impl CycleEnd {
    /// The label of a play whose robots have done their parts.
    pub const FINISHED: &'static str = "finished";
    /// The labels of all ends that a play of a case can have.
    pub const LABELS: [&'static str; 14] = [
        Self::FINISHED,
        "ball-out-of-scope",
        "path-blocked",
        "robot-lost",
        "action-failed",
        "opponent-on-ball",
        "ball-at-rest",
        "timeout",
        "no-decision",
        "unknown-case",
        "reassigned",
        "game-stopped",
        "superseded",
        "trial-over",
    ];

    /// Label in reports.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Closed(Closure::Finished) => Self::FINISHED,
            Self::Closed(Closure::NoCase) => "no-case",
            Self::Closed(Closure::Aborted { reason, .. }) => reason.label(),
            Self::Superseded => "superseded",
            Self::TrialOver => "trial-over",
        }
    }
}

/// The label of the rule of a shot; none where it did not come to one.
pub(crate) const fn shot_label(rule: ShotRule) -> Option<&'static str> {
    match rule {
        ShotRule::NoShot => None,
        rule => Some(rule.label()),
    }
}

/// All cycles of a team, in the order of their ids.
#[derive(Clone, Debug, Default)]
pub struct CycleLog {
    cycles: Vec<CycleSeen>,
}

/// Change of the log by a beacon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CycleEvent {
    /// No change: the beacon repeats known state.
    Nothing,
    /// A cycle started, by its place in [`CycleLog::cycles`].
    Began(usize),
    /// The coordinator of a cycle decided: its place in [`CycleLog::cycles`].
    Decided(usize),
    /// A cycle ended: its place in [`CycleLog::cycles`].
    Ended(usize),
}

impl CycleLog {
    /// A robot reported `state` of its newest cycle at `time` seconds.
    pub fn receive(&mut self, time: f32, state: &CycleState) -> CycleEvent {
        let place = self.cycles.binary_search_by_key(&state.id, |cycle| cycle.id);
        let (place, began) = match place {
            Ok(place) => (place, false),
            Err(place) => {
                // A late beacon of an older, unknown cycle: it is over already.
                let end = (place < self.cycles.len()).then_some((time, CycleEnd::Superseded));
                let CycleState { id, coordinator, .. } = *state;
                for older in &mut self.cycles[..place] {
                    older.end = older.end.or(Some((time, CycleEnd::Superseded)));
                }
                let shot = ShotRule::NoShot;
                let cycle = CycleSeen { id, coordinator, play: None, no_case: false, start: time, end, shot };
                self.cycles.insert(place, cycle);
                (place, true)
            }
        };
        let cycle = &mut self.cycles[place];
        let decided_before = cycle.play.is_some() || cycle.no_case;
        let mut ended = false;
        match &state.decision {
            Decision::Undecided => {}
            Decision::NoCase => cycle.no_case = true,
            Decision::Play(play) if cycle.play.is_none() => cycle.play = Some(play.clone()),
            Decision::Play(_) => {}
            Decision::Closed(closure) => {
                ended = !matches!(cycle.end, Some((_, CycleEnd::Closed(_))));
                cycle.no_case |= *closure == Closure::NoCase;
                if ended {
                    cycle.end = Some((cycle.end.map_or(time, |(at, _)| at), CycleEnd::Closed(*closure)));
                }
            }
        }
        match () {
            () if ended => CycleEvent::Ended(place),
            () if !decided_before && (cycle.play.is_some() || cycle.no_case) => CycleEvent::Decided(place),
            () if began => CycleEvent::Began(place),
            () => CycleEvent::Nothing,
        }
    }

    /// A robot of cycle `id` reported by what rule it shoots.
    pub fn shoots(&mut self, id: CycleId, rule: ShotRule) {
        if rule != ShotRule::NoShot
            && let Ok(place) = self.cycles.binary_search_by_key(&id, |cycle| cycle.id)
        {
            self.cycles[place].shot = rule;
        }
    }

    /// Ends the trial; running cycles end with it.
    pub fn finish(&mut self, time: f32) {
        for cycle in &mut self.cycles {
            cycle.end = cycle.end.or(Some((time, CycleEnd::TrialOver)));
        }
    }

    /// The known cycles, in the order of ids.
    pub fn cycles(&self) -> &[CycleSeen] {
        &self.cycles
    }
}

#[cfg(test)]
mod tests {
    use protocol::CaseId;
    use protocol::quantized::WirePoint;
    use protocol::team::AbortReason;

    use super::*;

    fn robot(n: u8) -> RobotId {
        RobotId::new(n).unwrap()
    }

    fn state(counter: u32, decision: Decision) -> CycleState {
        CycleState { id: CycleId { counter, proposer: robot(1) }, coordinator: robot(2), decision }
    }

    fn play() -> Decision {
        let robots = [robot(2), robot(1)].into_iter().collect();
        Decision::Play(Play { case: CaseId(9), ball: WirePoint::default(), robots })
    }

    #[test]
    fn a_cycle_begins_is_decided_and_ends() {
        let mut log = CycleLog::default();
        assert_eq!(log.receive(0.4, &state(1, Decision::Undecided)), CycleEvent::Began(0));
        assert_eq!(log.receive(0.44, &state(1, play())), CycleEvent::Decided(0));
        assert_eq!(log.receive(0.48, &state(1, play())), CycleEvent::Nothing);
        assert_eq!(log.receive(5.0, &state(1, Decision::Closed(Closure::Finished))), CycleEvent::Ended(0));
        assert_eq!(log.receive(5.04, &state(1, Decision::Closed(Closure::Finished))), CycleEvent::Nothing);
        let cycle = &log.cycles()[0];
        assert_eq!((cycle.start, cycle.end.unwrap().0), (0.4, 5.0));
        assert_eq!(cycle.end.unwrap().1.label(), "finished");
        assert_eq!(cycle.play.as_ref().unwrap().case, CaseId(9));
    }

    #[test]
    fn a_newer_cycle_ends_an_older_one_until_its_late_closure() {
        let mut log = CycleLog::default();
        log.receive(0.0, &state(1, play()));
        log.receive(2.0, &state(2, Decision::Undecided));
        assert_eq!(log.cycles()[0].end, Some((2.0, CycleEnd::Superseded)));
        let closure = Closure::Aborted { by: robot(2), reason: AbortReason::OpponentOnBall };
        assert_eq!(log.receive(2.1, &state(1, Decision::Closed(closure))), CycleEvent::Ended(0));
        assert_eq!(log.cycles()[0].end.map(|(at, end)| (at, end.label())), Some((2.0, "opponent-on-ball")));
        log.finish(3.0);
        assert_eq!(log.cycles()[1].end, Some((3.0, CycleEnd::TrialOver)));
    }

    #[test]
    fn a_closure_for_want_of_a_case_counts_as_no_case() {
        let mut log = CycleLog::default();
        log.receive(0.0, &state(1, Decision::Closed(Closure::NoCase)));
        assert!(log.cycles()[0].no_case && log.cycles()[0].play.is_none());
        assert_eq!(log.cycles()[0].end.unwrap().1.label(), "no-case");
    }

    #[test]
    fn the_list_of_labels_has_every_end_of_a_play() {
        let aborted = |reason| CycleEnd::Closed(Closure::Aborted { by: robot(1), reason });
        let aborted = AbortReason::ALL.map(aborted);
        let all = [CycleEnd::Closed(Closure::Finished)].into_iter().chain(aborted);
        let all = all.chain([CycleEnd::Superseded, CycleEnd::TrialOver]);
        assert_eq!(all.map(CycleEnd::label).collect::<Vec<_>>(), CycleEnd::LABELS);
    }

    #[test]
    fn a_straggler_of_an_unknown_older_cycle_is_filed_before_the_newer() {
        let mut log = CycleLog::default();
        log.receive(1.0, &state(5, Decision::Undecided));
        log.receive(1.1, &state(4, play()));
        assert_eq!(log.cycles().iter().map(|c| c.id.counter).collect::<Vec<_>>(), [4, 5]);
        assert_eq!(log.cycles()[0].end, Some((1.1, CycleEnd::Superseded)));
        assert_eq!(log.cycles()[1].end, None);
    }
}
