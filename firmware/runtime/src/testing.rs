//! `testing`: test executor and test clock: a small executor, and embassy's clock under its control.

use std::boxed::Box;
use std::future::Future;
use std::pin::Pin;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Wake, Waker};
use std::vec;
use std::vec::Vec;

/// A small executor on a clock that moves only by calls; one at a time, because embassy has one clock a
/// program.
pub(crate) struct World {
    tasks: Vec<Pin<Box<dyn Future<Output = ()>>>>,
    woken: Arc<Flag>,
    _turn: MutexGuard<'static, ()>,
}

impl World {
    pub(crate) fn new() -> Self {
        let turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        *CLOCK.lock() = Time { now: 0, alarms: vec![] };
        Self { tasks: vec![], woken: Arc::default(), _turn: turn }
    }

    pub(crate) fn spawn<F: Future + 'static>(&mut self, task: F) {
        self.tasks.push(Box::pin(async move {
            task.await;
        }));
        self.woken.0.store(true, Ordering::Relaxed);
    }

    /// Polls until no task is ready.
    pub(crate) fn settle(&mut self) {
        let waker = Waker::from(self.woken.clone());
        while self.woken.0.swap(false, Ordering::Relaxed) {
            for task in &mut self.tasks {
                assert!(task.as_mut().poll(&mut Context::from_waker(&waker)).is_pending(), "a task ended");
            }
        }
    }

    /// Moves time to `to`, stopping at every alarm in between.
    pub(crate) fn advance(&mut self, to: u64) {
        while let Some(alarm) = CLOCK.next_alarm(to) {
            alarm.wake();
            self.settle();
        }
        CLOCK.lock().now = to;
    }
}

#[derive(Default)]
struct Flag(AtomicBool);
impl Wake for Flag {
    fn wake(self: Arc<Self>) {
        self.0.store(true, Ordering::Relaxed);
    }
}

struct Clock(Mutex<Time>);
pub(crate) struct Time {
    pub(crate) now: u64,
    alarms: Vec<(u64, Waker)>,
}

impl Clock {
    fn lock(&self) -> MutexGuard<'_, Time> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Moves to the first alarm not after `to`, and removes it.
    fn next_alarm(&self, to: u64) -> Option<Waker> {
        let mut time = self.lock();
        let first = time.alarms.iter().enumerate().min_by_key(|(_, (at, _))| *at)?.0;
        if time.alarms[first].0 > to {
            return None;
        }
        let (at, waker) = time.alarms.remove(first);
        time.now = time.now.max(at);
        Some(waker)
    }
}

impl embassy_time_driver::Driver for Clock {
    fn now(&self) -> u64 {
        self.lock().now
    }

    fn schedule_wake(&self, at: u64, waker: &Waker) {
        let mut time = self.lock();
        if at <= time.now {
            waker.wake_by_ref();
        } else if !time.alarms.iter().any(|(set, by)| *set == at && by.will_wake(waker)) {
            time.alarms.push((at, waker.clone()));
        }
    }
}

/// The clock of all tests, locked.
pub(crate) fn clock() -> MutexGuard<'static, Time> {
    CLOCK.lock()
}

embassy_time_driver::time_driver_impl!(static CLOCK: Clock = Clock(Mutex::new(Time { now: 0, alarms: Vec::new() })));
static TURN: Mutex<()> = Mutex::new(());
