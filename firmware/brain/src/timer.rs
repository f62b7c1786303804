//! `timer`: the table of a robot's deadlines, each named by an enum (docs/architecture.md §3.1, §5).

use protocol::{Duration, Instant};

/// A deadline, by its purpose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Timer {
    /// A booting robot has listened long enough to be present (one lease).
    Boot,
    /// Robots that booted together have received each other's presence: now they may propose.
    Settle,
    /// The coordinator has been silent about its decision for too long: propose again.
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
    /// An opponent has held the ball for too long to win it.
    OpponentHolds,
}

impl Timer {
    const COUNT: usize = Self::OpponentHolds as usize + 1;
}

/// Every deadline of one robot. A timer is idle, running or fired; it stays fired until set or cleared.
#[derive(Clone, Debug, Default)]
pub struct TimerTable {
    slots: [Slot; Timer::COUNT],
    /// The first deadline of those that run: read after every packet, changed far more rarely.
    first: Option<Instant>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Slot {
    #[default]
    Idle,
    Running(Instant),
    Fired,
}

impl TimerTable {
    /// Restarts `timer`, which fires at `deadline`.
    pub fn set(&mut self, timer: Timer, deadline: Instant) {
        self.put(timer, Slot::Running(deadline));
    }

    /// Starts `timer` unless it runs or has fired already.
    pub fn set_if_idle(&mut self, timer: Timer, now: Instant, after: Duration) {
        if self.slots[timer as usize] == Slot::Idle {
            self.set(timer, now + after);
        }
    }

    /// Makes `timer` idle: it neither runs nor has fired.
    pub fn clear(&mut self, timer: Timer) {
        self.put(timer, Slot::Idle);
    }

    /// Whether its deadline has come since it was set.
    pub fn has_fired(&self, timer: Timer) -> bool {
        self.slots[timer as usize] == Slot::Fired
    }

    /// Whether it is neither running nor fired.
    pub fn is_idle(&self, timer: Timer) -> bool {
        self.slots[timer as usize] == Slot::Idle
    }

    /// Fires all timers that are due.
    pub fn advance(&mut self, now: Instant) {
        if self.first.is_none_or(|first| first > now) {
            return;
        }
        for slot in &mut self.slots {
            if matches!(slot, Slot::Running(deadline) if *deadline <= now) {
                *slot = Slot::Fired;
            }
        }
        self.find_first();
    }

    /// The next deadline, if any timer runs.
    pub fn next(&self) -> Option<Instant> {
        self.first
    }

    fn put(&mut self, timer: Timer, slot: Slot) {
        let before = core::mem::replace(&mut self.slots[timer as usize], slot);
        if before != slot {
            self.find_first();
        }
    }

    fn find_first(&mut self) {
        let running = self.slots.iter().filter_map(|slot| match slot {
            Slot::Running(deadline) => Some(*deadline),
            Slot::Idle | Slot::Fired => None,
        });
        self.first = running.min();
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
    fn the_next_deadline_is_the_least_of_those_that_run_whatever_was_done() {
        const ALL: [Timer; 4] = [Timer::Boot, Timer::Retry, Timer::Action, Timer::OpponentHolds];
        let (mut timers, mut state, mut now) = (TimerTable::default(), 9_u64, 0);
        for _ in 0..10_000 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let (timer, time) = (ALL[(state >> 60) as usize & 3], (state >> 40) & 63);
            match (state >> 57) & 3 {
                0 => timers.set(timer, Instant(now + time)),
                1 => timers.set_if_idle(timer, Instant(now), Duration(time)),
                2 => timers.clear(timer),
                _ => {
                    now += time / 8;
                    timers.advance(Instant(now));
                }
            }
            let running = timers.slots.iter().filter_map(|slot| match slot {
                Slot::Running(deadline) => Some(*deadline),
                _ => None,
            });
            assert_eq!(timers.next(), running.min());
        }
    }

    #[test]
    fn a_running_timer_is_not_pushed_back() {
        let mut timers = TimerTable::default();
        timers.set_if_idle(Timer::Action, Instant(0), Duration(5));
        timers.set_if_idle(Timer::Action, Instant(3), Duration(5));
        assert_eq!(timers.next(), Some(Instant(5)));
    }
}
