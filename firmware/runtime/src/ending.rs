//! `ending`: crash record of a robot's program. The source location of a panic or a fault, as numbers that
//! can outlive a reset (docs/architecture.md §6.2).
//!
//! Without `core::fmt`, whose formatting takes 7 kB of flash. The further reaction is the board's: motors
//! without current, a record kept, a restart.

use core::panic::Location;

/// Cause of the program's end.
#[derive(Clone, Copy, Debug)]
pub enum Ending<'a> {
    /// A panic, with its place as far as known.
    Panic(Option<&'a Location<'a>>),
    /// A hard fault, with the program counter.
    Fault(u32),
}

impl Ending<'_> {
    /// Writes the place into `text`, as far as it fits; returns the number of bytes.
    pub fn write(&self, text: &mut [u8]) -> usize {
        match self {
            Self::Panic(Some(place)) => fill(text, &[place.file().as_bytes(), b":", &digits(place.line())]),
            Self::Panic(None) => fill(text, &[b"an unknown place"]),
            Self::Fault(counter) => fill(text, &[b"a hard fault, program counter ", &digits(*counter)]),
        }
    }
}

fn fill(text: &mut [u8], pieces: &[&[u8]]) -> usize {
    let bytes = pieces.iter().flat_map(|piece| piece.iter());
    text.iter_mut().zip(bytes).map(|(to, from)| *to = *from).count()
}

/// A number in ten decimal digits, with leading zeros.
pub fn digits(number: u32) -> [u8; 10] {
    let (mut rest, mut text) = (number, [b'0'; 10]);
    for digit in text.iter_mut().rev() {
        *digit = b'0' + (rest % 10) as u8;
        rest /= 10;
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::format;

    #[test]
    fn a_crash_is_written_as_file_and_line_or_program_counter_as_far_as_it_fits() {
        let here = Location::caller();
        let mut text = [0; 96];
        let len = Ending::Panic(Some(here)).write(&mut text);
        assert_eq!(text[..len], *format!("{}:{:010}", here.file(), here.line()).as_bytes());
        let len = Ending::Fault(u32::MAX).write(&mut text);
        assert_eq!(text[..len], *b"a hard fault, program counter 4294967295");
        let len = Ending::Panic(None).write(&mut text);
        assert_eq!(text[..len], *b"an unknown place");
        assert_eq!(Ending::Panic(None).write(&mut text[..4]), 4);
        assert_eq!(text[..4], *b"an u");
    }
}
