//! What does the emulated board do when its program cannot go on? It tells the place on stderr and ends the emulator with
//! exit code 1.
//!
//! Only the place: what a panic says besides would need the formatting of `core::fmt`, 7 kB of an image.

use core::panic::PanicInfo;

use cortex_m_rt::{ExceptionFrame, exception};
use cortex_m_semihosting::{debug, hio};

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    match info.location() {
        Some(place) => say(&[b"panic at ", place.file().as_bytes(), b":", &Digits::of(place.line()).text()]),
        None => say(&[b"panic"]),
    }
    end()
}

#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    say(&[b"hard fault, program counter ", &Digits::of(frame.pc()).text()]);
    end()
}

/// Writes the words and a line's end on stderr.
fn say(words: &[&[u8]]) {
    // Nobody is left to be told where even that fails.
    if let Ok(mut stderr) = hio::hstderr() {
        for word in words.iter().chain([&&b"\n"[..]]) {
            let _ = stderr.write_all(word);
        }
    }
}

/// Ends the emulator; on hardware, where nobody listens, it stands still.
fn end() -> ! {
    loop {
        debug::exit(debug::EXIT_FAILURE);
    }
}

/// A number in decimal digits, without `core::fmt`.
struct Digits(u32);

impl Digits {
    const fn of(number: u32) -> Self {
        Self(number)
    }

    /// Ten digits with leading zeros.
    fn text(&self) -> [u8; 10] {
        let mut rest = self.0;
        let mut text = [b'0'; 10];
        for digit in text.iter_mut().rev() {
            *digit = b'0' + (rest % 10) as u8;
            rest /= 10;
        }
        text
    }
}
