//! `ledger`: the counter of starts in flash, for any flash with two erasable halves
//! (`runtime::persistent_counter`).

use runtime::persistent_counter::{self, CounterCell, CounterPlace};

/// Flash that holds the two halves of the counter.
pub trait LedgerFlash {
    /// Number of cells in a half.
    const CELLS: usize;

    /// The content of a cell; a cell that was written while the power went is no valid cell, never a fault.
    fn read(&self, at: CounterPlace) -> CounterCell;

    /// Erases a half; whether that succeeded. May take seconds.
    fn erase(&mut self, half: usize) -> bool;

    /// Writes an epoch into an erased cell; whether that succeeded.
    fn write(&mut self, at: CounterPlace, epoch: u32) -> bool;
}

/// Reason why no epoch is available.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CounterError {
    /// All 2³² epochs are used.
    Full,
    /// The flash did not keep the written value in three attempts.
    Worn,
}

/// Records this start: its epoch, larger than all before. Seconds where a half has to be erased, once in
/// [`LedgerFlash::CELLS`] starts.
pub fn begin<F: LedgerFlash>(flash: &mut F) -> Result<u32, CounterError> {
    for _ in 0..WRITE_ATTEMPTS {
        let plan = persistent_counter::plan(F::CELLS, |at| flash.read(at)).ok_or(CounterError::Full)?;
        let erased = !plan.erase || flash.erase(plan.at.half);
        let written = erased && flash.write(plan.at, plan.epoch);
        if written && flash.read(plan.at) == CounterCell::Epoch(plan.epoch) {
            return Ok(plan.epoch);
        }
    }
    Err(CounterError::Worn)
}

/// Number of attempts: a cell that does not keep its value is skipped.
const WRITE_ATTEMPTS: usize = 3;

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    /// Flash of two halves of four cells; `dead` is a cell that keeps nothing.
    struct Memory {
        cells: [Vec<CounterCell>; 2],
        dead: Option<(usize, usize)>,
        stuck: bool,
    }

    impl LedgerFlash for Memory {
        const CELLS: usize = 4;
        fn read(&self, at: CounterPlace) -> CounterCell {
            self.cells[at.half][at.index]
        }
        fn erase(&mut self, half: usize) -> bool {
            self.cells[half].fill(CounterCell::Empty);
            true
        }
        fn write(&mut self, at: CounterPlace, epoch: u32) -> bool {
            let dead = self.stuck || self.dead == Some((at.half, at.index));
            self.cells[at.half][at.index] =
                if dead { CounterCell::Damaged } else { CounterCell::Epoch(epoch) };
            true
        }
    }

    fn memory(dead: Option<(usize, usize)>, stuck: bool) -> Memory {
        let half = || std::vec![CounterCell::Empty; 4];
        Memory { cells: [half(), half()], dead, stuck }
    }

    #[test]
    fn every_start_has_a_larger_epoch_past_a_dead_cell_and_over_both_halves() {
        let mut memory = memory(Some((0, 2)), false);
        let mut last = 0;
        for _ in 0..30 {
            let epoch = begin(&mut memory).unwrap();
            assert!(epoch > last || last == 0, "{epoch} after {last}");
            last = epoch;
        }
    }

    #[test]
    fn flash_that_keeps_nothing_gives_no_epoch() {
        assert_eq!(begin(&mut memory(None, true)), Err(CounterError::Worn));
    }
}
