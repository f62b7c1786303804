//! `clock`: time of the lockstep board. Time moves by ticks from outside, tasks run until all of them wait.
//!
//! [`Clock::advance`] stops at every alarm in between, so that each deadline runs at its own time, however
//! far apart the ticks are and however slow the machine is that emulates the board.

use core::cell::{Cell, RefCell};
use core::ptr;
use core::sync::atomic::{AtomicBool, Ordering};
use core::task::Waker;

use critical_section::Mutex;
use embassy_executor::{Spawner, raw::Executor};
use embassy_time_driver::Driver;
use embassy_time_queue_utils::Queue;
use protocol::Instant;
use static_cell::StaticCell;

pub(crate) struct Clock {
    executor: &'static Executor,
}

impl Clock {
    /// A clock at zero, without tasks; call once.
    pub(crate) fn new() -> Self {
        static EXECUTOR: StaticCell<Executor> = StaticCell::new();
        Self { executor: EXECUTOR.init(Executor::new(ptr::null_mut())) }
    }

    /// For starting tasks; they first run with the next [`Clock::settle`].
    pub(crate) fn spawner(&self) -> Spawner {
        self.executor.spawner()
    }

    /// Moves time to `to`; every alarm up to then fires at its own time.
    pub(crate) fn advance(&self, to: Instant) {
        loop {
            self.settle();
            let next = TIME.ring();
            if WORK.load(Ordering::Acquire) {
                continue;
            }
            if next > to.0 {
                break;
            }
            TIME.set(next);
        }
        TIME.set(to.0);
    }

    /// Runs the tasks until all of them wait. Alarms that are due fire with the next [`Clock::advance`].
    pub(crate) fn settle(&self) {
        while WORK.swap(false, Ordering::Acquire) {
            // SAFETY: this is the only place that polls this executor, and no task calls this function.
            unsafe { self.executor.poll() }
        }
    }
}

/// Embassy's time driver: a number and a queue of alarms.
struct Time {
    now: Mutex<Cell<u64>>,
    alarms: Mutex<RefCell<Queue>>,
}

impl Time {
    /// Moves forward; never backwards.
    fn set(&self, to: u64) {
        critical_section::with(|cs| {
            let now = self.now.borrow(cs);
            now.set(now.get().max(to));
        });
    }

    /// Wakes the alarms that are due and returns when the next is; `u64::MAX` if there is none.
    fn ring(&self) -> u64 {
        critical_section::with(|cs| self.alarms.borrow_ref_mut(cs).next_expiration(self.now.borrow(cs).get()))
    }
}

impl Driver for Time {
    fn now(&self) -> u64 {
        critical_section::with(|cs| self.now.borrow(cs).get())
    }

    fn schedule_wake(&self, at: u64, waker: &Waker) {
        // No task waits for the alarm itself: `Clock` asks for the next one.
        critical_section::with(|cs| self.alarms.borrow_ref_mut(cs).schedule_wake(at, waker));
    }
}

embassy_time_driver::time_driver_impl!(static TIME: Time = Time {
    now: Mutex::new(Cell::new(0)),
    alarms: Mutex::new(RefCell::new(Queue::new())),
});

/// True while some task is ready.
static WORK: AtomicBool = AtomicBool::new(false);

/// Embassy's executor calls this, by this name, when a task was woken.
#[unsafe(export_name = "__pender")]
fn pender(_executor: *mut ()) {
    WORK.store(true, Ordering::Release);
}
