//! `crash`: the record of panics and starts, kept over a reset in registers that a reset leaves alone
//! (docs/architecture.md §6.2).

use runtime::ending::Ending;

/// Words that outlive a reset, such as a calendar's backup registers: unlike memory they have no check bits
/// that a power-up would leave wrong.
pub trait KeptWords {
    /// Number of words, at least [`KEPT_WORDS_MIN`].
    const WORDS: usize;

    /// The word `n`, below [`Self::WORDS`].
    fn read(&self, n: usize) -> u32;

    /// Changes the word `n`, below [`Self::WORDS`].
    fn write(&mut self, n: usize, word: u32);
}

/// Record of the boot epochs before this one, since power-on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CrashRecord {
    /// Starts since power-on, this one included.
    pub boots: u32,
    /// Panics and faults since then.
    pub panics: u32,
    /// True if the watchdog ended the last boot epoch.
    pub bitten: bool,
    place: [u8; PLACE_LEN_MAX],
    place_len: usize,
}

impl CrashRecord {
    /// Counts this start; call once. `bitten`: the watchdog caused the last reset.
    pub fn begin(words: &mut impl KeptWords, bitten: bool) -> Self {
        if words.read(MAGIC_AT) != MAGIC {
            for n in 0..len(words) {
                words.write(n, 0);
            }
            words.write(MAGIC_AT, MAGIC);
        }
        words.write(BOOTS_AT, words.read(BOOTS_AT).wrapping_add(1));
        let mut place = [0; PLACE_LEN_MAX];
        for (n, bytes) in (PLACE_AT..len(words)).zip(place.as_chunks_mut::<4>().0) {
            *bytes = words.read(n).to_le_bytes();
        }
        Self {
            boots: words.read(BOOTS_AT),
            panics: words.read(PANICS_AT),
            bitten,
            place,
            place_len: words.read(LEN_AT) as usize,
        }
    }

    /// File and line of the last panic, as far as there was room.
    pub fn place(&self) -> &str {
        let place = self.place.get(..self.place_len).unwrap_or_default();
        core::str::from_utf8(place).unwrap_or("an unreadable place")
    }
}

/// The place of a panic or fault, as it was kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeptPlace {
    place: [u8; PLACE_LEN_MAX],
    len: usize,
}

impl KeptPlace {
    /// Keeps how the program ended, for the next start.
    pub fn keep(words: &mut impl KeptWords, how: Ending<'_>) -> Self {
        words.write(PANICS_AT, words.read(PANICS_AT).wrapping_add(1));
        let mut place = [0; PLACE_LEN_MAX];
        let room = 4 * len(words).saturating_sub(PLACE_AT);
        let len = place.get_mut(..room).map_or(0, |room| how.write(room));
        words.write(LEN_AT, len as u32);
        for (n, bytes) in (PLACE_AT..self::len(words)).zip(place.as_chunks::<4>().0) {
            words.write(n, u32::from_le_bytes(*bytes));
        }
        Self { place, len }
    }

    /// Text of the place, for the log.
    pub fn text(&self) -> &str {
        core::str::from_utf8(self.place.get(..self.len).unwrap_or_default()).unwrap_or_default()
    }
}

/// The words in use: more than [`WORDS_MAX`] are left alone.
fn len<W: KeptWords>(_: &W) -> usize {
    const { assert!(W::WORDS >= KEPT_WORDS_MIN, "too few words for a crash record") };
    W::WORDS.min(WORDS_MAX)
}

const MAGIC_AT: usize = 0;
const BOOTS_AT: usize = 1;
const PANICS_AT: usize = 2;
const LEN_AT: usize = 3;
const PLACE_AT: usize = 4;
/// The four counters and room for a short place, 16 bytes.
pub const KEPT_WORDS_MIN: usize = PLACE_AT + 4;
/// Largest number of words in use: that of an STM32H7 (RM0433, 46.6.20).
const WORDS_MAX: usize = 32;
/// Bytes of a place that are kept at most.
const PLACE_LEN_MAX: usize = 4 * (WORDS_MAX - PLACE_AT);
const MAGIC: u32 = 0x0121_fe51;

#[cfg(test)]
mod tests {
    use super::*;

    struct Registers([u32; 20]);

    impl KeptWords for Registers {
        const WORDS: usize = 20;
        fn read(&self, n: usize) -> u32 {
            self.0[n]
        }
        fn write(&mut self, n: usize, word: u32) {
            self.0[n] = word;
        }
    }

    #[test]
    fn a_panic_is_read_at_the_next_start_as_far_as_there_is_room() {
        let mut words = Registers([0xdead_beef; 20]);
        let first = CrashRecord::begin(&mut words, false);
        assert_eq!((first.boots, first.panics, first.place()), (1, 0, ""));
        let kept = KeptPlace::keep(&mut words, Ending::Fault(77));
        assert_eq!(kept.text(), "a hard fault, program counter 0000000077");
        let second = CrashRecord::begin(&mut words, true);
        assert_eq!((second.boots, second.panics, second.bitten), (2, 1, true));
        assert_eq!(second.place(), kept.text());
        let long = core::panic::Location::caller();
        KeptPlace::keep(&mut words, Ending::Panic(Some(long)));
        let third = CrashRecord::begin(&mut words, false);
        assert!(third.place().len() <= 64 && long.file().starts_with(&third.place()[..10]));
    }

    #[test]
    fn words_that_were_damaged_are_no_reason_to_fail() {
        let mut words = Registers([u32::MAX; 20]);
        words.0[MAGIC_AT] = MAGIC;
        let record = CrashRecord::begin(&mut words, false);
        assert_eq!((record.boots, record.place()), (0, ""));
    }
}
