//! `words`: words that outlive a reset: the calendar's backup registers.

use board_kit::crash::KeptWords;
use embassy_stm32::pac;

/// `N` backup registers of the chip.
#[derive(Clone, Copy, Debug, Default)]
pub struct BackupRegisters<const N: usize>(());

impl<const N: usize> BackupRegisters<N> {
    /// Enables writing of the registers; clocks must run.
    pub fn open() -> Self {
        pac::PWR.cr1().modify(|power| power.set_dbp(true));
        Self(())
    }
}

impl<const N: usize> KeptWords for BackupRegisters<N> {
    const WORDS: usize = N;

    fn read(&self, n: usize) -> u32 {
        pac::RTC.bkpr(n.min(N - 1)).read().bkp()
    }

    fn write(&mut self, n: usize, word: u32) {
        pac::RTC.bkpr(n.min(N - 1)).write(|kept| kept.set_bkp(word));
    }
}
