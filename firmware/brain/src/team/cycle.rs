//! `cycle`: this robot's part in the running cycle.

use protocol::team::{AbortReason, Closure, CycleState, Decision, Play, Progress};
use protocol::{CycleId, RobotId};

/// The newest cycle known and this robot's place in it.
#[derive(Clone, Debug)]
pub struct Cycle {
    me: RobotId,
    state: Option<CycleState>,
    /// It may have begun before this robot booted: what an earlier boot epoch of this robot did in it is
    /// unknown.
    may_be_older: bool,
    /// Own progress in the cycle.
    pub progress: Progress,
    /// Some robot of the case has touched the ball.
    pub touched: bool,
}

/// Effect of adopting a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CycleEvent {
    /// The state was known.
    Known,
    /// More about the same cycle, without another gameplay.
    More,
    /// A gameplay starts, or is replaced or ended.
    Gameplay,
}

impl Cycle {
    /// A robot that knows no cycle.
    pub fn new(me: RobotId) -> Self {
        Self { me, state: None, may_be_older: false, progress: Progress::Idle, touched: false }
    }

    /// The newest cycle state known.
    pub fn state(&self) -> Option<&CycleState> {
        self.state.as_ref()
    }

    /// The newest cycle's id.
    pub fn id(&self) -> Option<CycleId> {
        self.state.as_ref().map(|s| s.id)
    }

    /// The running gameplay; `None` outside of one.
    pub fn play(&self) -> Option<&Play> {
        self.state.as_ref().and_then(CycleState::play)
    }

    /// The end of the newest cycle, if it has ended.
    pub fn closure(&self) -> Option<Closure> {
        match self.state.as_ref()?.decision {
            Decision::Closed(closure) => Some(closure),
            _ => None,
        }
    }

    /// Whether this robot is the coordinator of an open cycle that it has received from its start in this
    /// boot epoch.
    pub fn is_mine_to_decide(&self) -> bool {
        !self.may_be_older && self.state.as_ref().is_some_and(|s| s.coordinator == self.me)
    }

    /// Whether an earlier boot epoch of this robot may have taken part in the running gameplay.
    pub fn is_of_an_earlier_epoch(&self) -> bool {
        self.may_be_older
    }

    /// Adopts `state` if it is newer than the known one; `from_start`: its cycle began in this boot epoch.
    pub fn adopt(&mut self, state: &CycleState, from_start: bool) -> CycleEvent {
        if !state.is_newer_than(self.state.as_ref()) {
            return CycleEvent::Known;
        }
        if self.id() != Some(state.id) {
            self.may_be_older = !from_start;
        }
        let gameplay = self.play() != state.play();
        self.state = Some(state.clone());
        if gameplay {
            self.touched = false;
            self.progress = match self.play() {
                Some(play) if play.part_of(self.me).is_some() => Progress::Adapt { arrived: false },
                Some(_) => Progress::WaitEnd { finished: false },
                None => Progress::Idle,
            };
            CycleEvent::Gameplay
        } else {
            CycleEvent::More
        }
    }

    /// Ends the open cycle; `None` if there is none.
    #[must_use]
    pub fn closed(&self, closure: Closure) -> Option<CycleState> {
        let state = self.state.as_ref()?;
        (self.closure().is_none())
            .then(|| CycleState { decision: Decision::Closed(closure), ..state.clone() })
    }

    /// The open cycle, aborted by this robot.
    #[must_use]
    pub fn aborted(&self, reason: AbortReason) -> Option<CycleState> {
        self.closed(Closure::Aborted { by: self.me, reason })
    }

    /// The open cycle with the coordinator's decision.
    #[must_use]
    pub fn decided(&self, decision: Decision) -> Option<CycleState> {
        self.state.as_ref().map(|state| CycleState { decision, ..state.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::CaseId;
    use protocol::quantized::WirePoint;

    fn robot(n: u8) -> RobotId {
        RobotId::new(n).unwrap()
    }

    fn state(counter: u32, decision: Decision) -> CycleState {
        CycleState { id: CycleId { counter, proposer: robot(1) }, coordinator: robot(2), decision }
    }

    fn play(case: u16) -> Decision {
        let robots = [robot(2), robot(3)].into_iter().collect();
        Decision::Play(Play { case: CaseId(case), ball: WirePoint::default(), robots })
    }

    #[test]
    fn a_robot_of_the_case_adapts_and_another_waits() {
        let (mut involved, mut other) = (Cycle::new(robot(3)), Cycle::new(robot(4)));
        assert_eq!(involved.adopt(&state(1, play(5)), true), CycleEvent::Gameplay);
        assert_eq!(involved.progress, Progress::Adapt { arrived: false });
        other.adopt(&state(1, play(5)), true);
        assert_eq!(other.progress, Progress::WaitEnd { finished: false });
    }

    #[test]
    fn a_late_message_of_an_old_cycle_is_harmless() {
        let mut cycle = Cycle::new(robot(3));
        cycle.adopt(&state(2, play(5)), true);
        let abort = Closure::Aborted { by: robot(2), reason: AbortReason::Timeout };
        assert_eq!(cycle.adopt(&state(1, Decision::Closed(abort)), true), CycleEvent::Known);
        assert!(cycle.play().is_some());
    }

    #[test]
    fn a_coordinator_does_not_decide_a_cycle_that_may_be_older_than_its_boot() {
        let mut cycle = Cycle::new(robot(2));
        cycle.adopt(&state(7, Decision::Undecided), false);
        assert!(!cycle.is_mine_to_decide());
        cycle.adopt(&state(8, Decision::Undecided), true);
        assert!(cycle.is_mine_to_decide());
    }

    #[test]
    fn a_closed_cycle_stays_closed() {
        let mut cycle = Cycle::new(robot(2));
        cycle.adopt(&state(1, play(5)), true);
        let end = cycle.aborted(AbortReason::PathBlocked).unwrap();
        assert_eq!(cycle.adopt(&end, true), CycleEvent::Gameplay);
        assert_eq!(cycle.aborted(AbortReason::Timeout), None);
        assert_eq!(cycle.adopt(&state(1, play(5)), true), CycleEvent::Known);
        assert_eq!(cycle.progress, Progress::Idle);
    }
}
