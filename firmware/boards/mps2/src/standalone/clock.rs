//! `clock`: time source and executor wake-up of the free-running board. The system timer counts microseconds,
//! and the executor sleeps with WFI.
//!
//! Works on any Cortex-M whose core clock is a whole number of MHz. Embassy's own executor sleeps with WFE,
//! which QEMU runs as nothing: an idle robot would keep a whole core of the PC busy.

use core::cell::RefCell;
use core::ptr;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use core::task::Waker;

use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::peripheral::{SCB, SYST};
use critical_section::Mutex;
use embassy_executor::{Spawner, raw::Executor};
use embassy_time_driver::Driver;
use embassy_time_queue_utils::Queue;
use static_cell::StaticCell;

/// Starts the timer; call once.
pub(crate) fn start(mut timer: SYST) {
    timer.set_clock_source(SystClkSource::Core);
    timer.set_reload(PERIOD_TICKS - 1);
    timer.clear_current();
    timer.enable_counter();
    timer.enable_interrupt();
}

/// Runs the tasks that `init` starts, for ever.
pub(crate) fn run(init: impl FnOnce(Spawner)) -> ! {
    static EXECUTOR: StaticCell<Executor> = StaticCell::new();
    let executor = EXECUTOR.init(Executor::new(ptr::null_mut()));
    init(executor.spawner());
    loop {
        // Interrupts are masked between the check and the sleep; a masked one still ends it.
        cortex_m::interrupt::disable();
        let work = WORK.swap(false, Ordering::Acquire);
        if !work {
            cortex_m::asm::dsb();
            cortex_m::asm::wfi();
        }
        // SAFETY: no code here relies on interrupts being off.
        unsafe { cortex_m::interrupt::enable() };
        if work {
            // SAFETY: this is the only place that polls this executor, and no task calls this function.
            unsafe { executor.poll() };
        }
    }
}

struct Time {
    /// Whole milliseconds since the start; 49 days of them.
    millis: AtomicU32,
    alarms: Mutex<RefCell<Queue>>,
}

impl Driver for Time {
    fn now(&self) -> u64 {
        critical_section::with(|_| {
            let mut millis = self.millis.load(Ordering::Relaxed);
            let mut left = SYST::get_current();
            // The counter has wrapped, and its interrupt is pending.
            if SCB::is_pendst_pending() {
                left = SYST::get_current();
                millis = millis.wrapping_add(1);
            }
            u64::from(millis) * 1_000 + u64::from((PERIOD_TICKS - 1).saturating_sub(left) / TICKS_PER_US)
        })
    }

    fn schedule_wake(&self, at: u64, waker: &Waker) {
        // Whether the alarm is the first is checked with the next millisecond.
        critical_section::with(|cs| self.alarms.borrow_ref_mut(cs).schedule_wake(at, waker));
    }
}

embassy_time_driver::time_driver_impl!(static TIME: Time = Time {
    millis: AtomicU32::new(0),
    alarms: Mutex::new(RefCell::new(Queue::new())),
});

#[cortex_m_rt::exception]
fn SysTick() {
    let millis = TIME.millis.load(Ordering::Relaxed).wrapping_add(1);
    TIME.millis.store(millis, Ordering::Relaxed);
    let now = TIME.now();
    critical_section::with(|cs| TIME.alarms.borrow_ref_mut(cs).next_expiration(now));
}

/// True while some task is ready.
static WORK: AtomicBool = AtomicBool::new(true);

/// Embassy's executor calls this, by this name, when a task was woken.
#[unsafe(export_name = "__pender")]
fn pender(_executor: *mut ()) {
    WORK.store(true, Ordering::Release);
}

/// Timer ticks per microsecond: 25 MHz.
const TICKS_PER_US: u32 = 25;
/// Period of the timer in its ticks: a millisecond.
const PERIOD_TICKS: u32 = 1_000 * TICKS_PER_US;
