//! `timers`: tests: tasks wake at their deadlines, by the board's own clock and interrupt.

use cortex_m::peripheral::SYST;
use embassy_executor::Spawner;

use crate::clock;

/// The board's executor for tests.
struct Executor;

impl Executor {
    #[allow(clippy::unused_self, reason = "the tests' attribute calls it on a value")]
    fn run(&'static mut self, init: impl FnOnce(Spawner)) -> ! {
        let core = cortex_m::Peripherals::take().expect("a test has the board for itself");
        let timer: SYST = core.SYST;
        clock::start(timer);
        clock::run(init)
    }
}

#[embedded_test::tests(executor = crate::timers::Executor)]
mod tests {
    use core::sync::atomic::{AtomicU32, Ordering};

    use embassy_futures::join::join;
    use embassy_time::{Duration, Instant, Ticker, Timer};

    #[test]
    async fn a_timer_rings_at_its_time_and_not_before() {
        for wanted in [1, 2, 10, 40] {
            let begun = Instant::now();
            Timer::after(Duration::from_millis(wanted)).await;
            let waited = begun.elapsed().as_micros();
            // The clock looks for alarms every millisecond; an emulator that is held up may be late, never
            // early.
            assert!(waited >= 1_000 * wanted, "{wanted} ms took {waited} us");
        }
    }

    #[test]
    async fn the_sooner_of_two_timers_rings_first() {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let late = async {
            Timer::after(Duration::from_millis(20)).await;
            NEXT.fetch_add(1, Ordering::Relaxed)
        };
        let soon = async {
            Timer::after(Duration::from_millis(5)).await;
            NEXT.fetch_add(1, Ordering::Relaxed)
        };
        assert_eq!(join(late, soon).await, (1, 0));
    }

    #[test]
    async fn a_ticker_keeps_its_pace_and_does_not_drift() {
        let begun = Instant::now();
        let mut ticker = Ticker::every(Duration::from_millis(10));
        for _ in 0..10 {
            ticker.next().await;
        }
        assert!(begun.elapsed() >= Duration::from_millis(100));
    }
}
