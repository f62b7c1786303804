//! Which deadlines does a robot have? All of them in one table, named by an enum (DESIGN §3, §5).

use protocol::{Duration, Instant};

/// A deadline and what it is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Timer {
    /// A booting robot has listened long enough to be present (one lease).
    Boot,
    /// Robots that booted together have heard that each other are present: now they may propose.
    Settle,
    /// The coordinator has been silent about its decision for too long: propose anew.
    NoDecision,
    /// There was no case; close the cycle and try again.
    Retry,
    /// The robots have stood still long enough after a cycle.
    Pause,
    /// The gameplay has taken longer than it may.
    Reuse,
    /// The running action has taken longer than it may.
    Action,
    /// The passer has waited long enough for its receiver.
    PassPatience,
    /// An opponent has held the ball for too long to hope for it.
    OpponentHolds,
}

impl Timer {
    const COUNT: usize = Self::OpponentHolds as usize + 1;
}

/// Every deadline of one robot. A timer is idle, running or fired; it stays fired until set or cleared.
#[derive(Clone, Debug, Default)]
pub struct TimerTable {
    slots: [Slot; Timer::COUNT],
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Slot {
    #[default]
    Idle,
    Running(Instant),
    Fired,
}

impl TimerTable {
    /// Starts `timer` anew.
    pub fn set(&mut self, timer: Timer, deadline: Instant) {
        self.slots[timer as usize] = Slot::Running(deadline);
    }

    /// Starts `timer` unless it runs or has fired already.
    pub fn set_if_idle(&mut self, timer: Timer, now: Instant, after: Duration) {
        if self.slots[timer as usize] == Slot::Idle {
            self.set(timer, now + after);
        }
    }

    /// Makes `timer` idle.
    pub fn clear(&mut self, timer: Timer) {
        self.slots[timer as usize] = Slot::Idle;
    }

    /// Whether its deadline has come since it was set.
    pub fn has_fired(&self, timer: Timer) -> bool {
        self.slots[timer as usize] == Slot::Fired
    }

    /// Whether it is neither running nor fired.
    pub fn is_idle(&self, timer: Timer) -> bool {
        self.slots[timer as usize] == Slot::Idle
    }

    /// Fires what is due.
    pub fn advance(&mut self, now: Instant) {
        for slot in &mut self.slots {
            if matches!(slot, Slot::Running(deadline) if *deadline <= now) {
                *slot = Slot::Fired;
            }
        }
    }

    /// The next deadline, if any timer runs.
    pub fn next(&self) -> Option<Instant> {
        self.slots
            .iter()
            .filter_map(|slot| match slot {
                Slot::Running(deadline) => Some(*deadline),
                _ => None,
            })
            .min()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fired_timer_is_no_longer_announced_but_stays_fired() {
        let mut timers = TimerTable::default();
        timers.set(Timer::Boot, Instant(10));
        timers.set(Timer::Retry, Instant(20));
        assert_eq!(timers.next(), Some(Instant(10)));
        timers.advance(Instant(10));
        assert!(timers.has_fired(Timer::Boot));
        assert_eq!(timers.next(), Some(Instant(20)));
        timers.clear(Timer::Boot);
        assert!(timers.is_idle(Timer::Boot));
    }

    #[test]
    fn a_running_timer_is_not_pushed_back() {
        let mut timers = TimerTable::default();
        timers.set_if_idle(Timer::Action, Instant(0), Duration(5));
        timers.set_if_idle(Timer::Action, Instant(3), Duration(5));
        assert_eq!(timers.next(), Some(Instant(5)));
    }
}
