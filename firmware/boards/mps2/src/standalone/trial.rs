//! `trial`: fault injection on the emulated board. A value that the emulator's loader puts into flash
//! requests it.

use core::sync::atomic::{AtomicBool, Ordering};

use embassy_time::{Duration, Timer};
use runtime::ending::digits;

use super::console::print;
use super::fault;
use super::stack;

/// Injects the requested fault: once since power-on, 1 a panic, 2 a task that hangs, both after 300 ms; 3
/// reports the deepest use of the stack every second.
pub(crate) async fn run() {
    // SAFETY: plain memory of the board above the firmware (build.rs), never written after the start.
    let requested = unsafe { (protocol::slot::TRIAL_ADDRESS as *const u32).read_volatile() };
    if requested == 3 {
        loop {
            Timer::after(Duration::from_secs(1)).await;
            print(&[b"stack ", &digits(stack::used())]);
        }
    }
    Timer::after(Duration::from_millis(300)).await;
    if fault::is_first_epoch() {
        match requested {
            1 => panic!(),
            2 => {
                while !WAKE_UP.load(Ordering::Relaxed) {
                    core::hint::spin_loop();
                }
            }
            _ => {}
        }
    }
}

/// Ends the hung task's loop; never set.
static WAKE_UP: AtomicBool = AtomicBool::new(false);
