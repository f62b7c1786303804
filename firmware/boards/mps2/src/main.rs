//! How does a robot's firmware run under QEMU? The image for the board MPS2 with AN386, a Cortex-M4F (DESIGN §7).
//!
//! The robot's tasks are `runtime`'s, the same that a real board starts. This board has no radio, no senses and no body
//! of its own: a simulator deals them out, one tick a frame, over Ethernet ([`lockstep`]), and the clock moves by ticks
//! alone ([`clock`]). A panic or fault ends the emulator with exit code 1 and its words on stderr.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod clock;
#[cfg(target_os = "none")]
mod eth;
#[cfg(target_os = "none")]
mod instructions;
#[cfg(target_os = "none")]
mod library;
#[cfg(target_os = "none")]
mod lockstep;
#[cfg(target_os = "none")]
mod start {
    use cortex_m_rt::{ExceptionFrame, entry, exception};
    use panic_semihosting as _;

    use crate::{eth, lockstep};

    #[entry]
    fn main() -> ! {
        lockstep::run()
    }

    /// The one interrupt that is on is the Ethernet controller's.
    #[exception]
    unsafe fn DefaultHandler(_number: i16) {
        eth::acknowledge();
    }

    #[exception]
    unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
        panic!("hard fault: {frame:?}");
    }
}

#[cfg(not(target_os = "none"))]
fn main() {}
