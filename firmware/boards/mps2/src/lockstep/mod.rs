//! `lockstep`: firmware in lockstep with the simulator. Tick by tick, with the tasks a real board starts
//! (docs/architecture.md §7.2).
//!
//! The robot's tasks are `runtime`'s. This board has no radio, no sensors and no body of its own: the
//! simulator provides them, one tick a frame, over Ethernet ([`ticks`]), and the clock moves by ticks alone
//! ([`clock`]). A panic or fault ends the emulator with exit code 1 and its place on stderr ([`fault`]).

mod clock;
mod eth;
mod fault;
mod instructions;
#[path = "../lan9118.rs"]
mod lan9118;
mod library;
#[path = "../register.rs"]
mod register;
#[path = "../stack.rs"]
mod stack;
mod ticks;

use cortex_m_rt::{entry, exception};

#[entry]
fn main() -> ! {
    ticks::run()
}

/// Only the Ethernet controller's interrupt is enabled.
#[exception]
unsafe fn DefaultHandler(_number: i16) {
    lan9118::acknowledge();
}
