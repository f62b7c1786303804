//! `fault`: fault handler of the lockstep board. It prints the place on stderr and ends the emulator with
//! exit code 1.
//!
//! Only the place: the panic message would need the formatting of `core::fmt`, 7 kB of flash.

use core::panic::PanicInfo;

use cortex_m_rt::{ExceptionFrame, exception};
use cortex_m_semihosting::{debug, hio};
use runtime::ending::Ending;

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    ended(Ending::Panic(info.location()))
}

#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    ended(Ending::Fault(frame.pc()))
}

/// Prints the place, then ends the emulator.
fn ended(how: Ending<'_>) -> ! {
    let mut place = [0; PLACE_LEN];
    let len = how.write(&mut place);
    print(&[b"panic at ", place.get(..len).unwrap_or_default()]);
    end()
}

/// Writes the text and a line's end on stderr.
fn print(pieces: &[&[u8]]) {
    // If that fails too, no output is left.
    if let Ok(mut stderr) = hio::hstderr() {
        for piece in pieces.iter().chain([&&b"\n"[..]]) {
            let _ = stderr.write_all(piece);
        }
    }
}

/// Ends the emulator; on hardware without a debugger it stops here.
fn end() -> ! {
    loop {
        debug::exit(debug::EXIT_FAILURE);
    }
}

/// Bytes of a place that are printed.
const PLACE_LEN: usize = 128;
