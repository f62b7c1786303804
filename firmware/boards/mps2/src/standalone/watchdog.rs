//! `watchdog`: watchdog driver. The board's watchdog (CMSDK APB watchdog, Arm DDI 0479): its first time-out
//! raises the NMI, its second resets the board.

use cortex_m_rt::exception;
use protocol::Duration;
use runtime::ports::Watchdog;

use super::{console::print, fault};
use crate::parts;

pub(crate) struct BoardWatchdog(());

/// Starts it; from now on it must be fed.
pub(crate) fn start() -> BoardWatchdog {
    LOCK.write(UNLOCKED);
    LOAD.write(TIMEOUT_TICKS);
    CONTROL.write(INTERRUPT | RESET);
    BoardWatchdog(())
}

impl Watchdog for BoardWatchdog {
    const TIMEOUT: Duration = TIMEOUT;

    fn feed(&mut self) {
        // Any value reloads the counter.
        CLEAR.write(1);
    }
}

pub(crate) fn has_bitten() -> bool {
    fault::was_bitten()
}

/// The first time-out: the current goes off at once, the second will reset the board.
#[exception]
unsafe fn NonMaskableInt() {
    parts::stop();
    fault::remember_bite();
    print(&[b"watchdog: a task hangs; motors off"]);
    // The interrupt stays pending until it is cleared, and clearing would feed the watchdog: wait for the
    // reset here.
    loop {
        core::hint::spin_loop();
    }
}

#[derive(Clone, Copy)]
struct Register(usize);

impl Register {
    fn write(self, value: u32) {
        // SAFETY: every register below is one of this board's watchdog (MPS2 AN386: at 0x4000_8000), 32 bits
        // wide.
        unsafe { ((BASE + self.0) as *mut u32).write_volatile(value) }
    }
}

const BASE: usize = 0x4000_8000;
const LOAD: Register = Register(0x00);
const CONTROL: Register = Register(0x08);
const CLEAR: Register = Register(0x0c);
const LOCK: Register = Register(0xc00);
const UNLOCKED: u32 = 0x1acc_e551;
const INTERRUPT: u32 = 1;
const RESET: u32 = 1 << 1;
/// Time until the first time-out.
const TIMEOUT: Duration = Duration::millis(100);
/// The same in ticks of 25 MHz.
const TIMEOUT_TICKS: u32 = 25 * TIMEOUT.0 as u32;
