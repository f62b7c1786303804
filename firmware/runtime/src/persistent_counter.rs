//! `persistent_counter`: persistent counter of starts in the robot's flash. Every start must use a larger
//! epoch than all before it (docs/architecture.md §6.1): hosts and teammates accept nothing of an older one.
//! Sans-IO.
//!
//! Two halves, each erased as a whole, of cells that are written once: a start finds the largest epoch and
//! writes the next one into the next empty cell. After a full half the other is used, which is erased first;
//! until the new cell is written the old half still holds every epoch needed. A cell that was only partly
//! written when the power went is skipped.
//!
//! A cell: `magic 4 "1-2B" | epoch 4 LE | the epoch's bits inverted 4 LE`, padded with 0xff.

/// Bytes of a cell: the unit in which an STM32H7 writes its flash.
pub const CELL_LEN: usize = 32;
const MAGIC: [u8; 4] = *b"1-2B";

/// Content of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CounterCell {
    /// Erased flash: not written since the last erase.
    Empty,
    /// A start with this epoch.
    Epoch(u32),
    /// Other content, or unreadable.
    Damaged,
}

impl CounterCell {
    /// Decodes a cell's bytes.
    pub fn of(bytes: &[u8; CELL_LEN]) -> Self {
        let [m0, m1, m2, m3, e0, e1, e2, e3, i0, i1, i2, i3, rest @ ..] = *bytes;
        let epoch = u32::from_le_bytes([e0, e1, e2, e3]);
        let inverted = u32::from_le_bytes([i0, i1, i2, i3]);
        if bytes.iter().all(|byte| *byte == ERASED) {
            Self::Empty
        } else if [m0, m1, m2, m3] == MAGIC && epoch == !inverted && rest.iter().all(|byte| *byte == ERASED) {
            Self::Epoch(epoch)
        } else {
            Self::Damaged
        }
    }
}

/// The bytes of a cell with this epoch.
pub fn cell(epoch: u32) -> [u8; CELL_LEN] {
    let mut bytes = [ERASED; CELL_LEN];
    let content = MAGIC.into_iter().chain(epoch.to_le_bytes()).chain((!epoch).to_le_bytes());
    bytes.iter_mut().zip(content).for_each(|(to, from)| *to = from);
    bytes
}

/// Position of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CounterPlace {
    /// Half, 0 or 1.
    pub half: usize,
    /// Index of the cell in its half.
    pub index: usize,
}

/// Steps of a start before it sends anything.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WritePlan {
    /// Epoch of this start.
    pub epoch: u32,
    /// Cell to write it to.
    pub at: CounterPlace,
    /// True if that half must be erased first.
    pub erase: bool,
}

/// Reads all cells, `cells` in each half; `None` after 2³² starts.
pub fn plan(cells: usize, mut read: impl FnMut(CounterPlace) -> CounterCell) -> Option<WritePlan> {
    let (mut newest, mut active) = (0, 0);
    // The first cell of each half behind all written ones.
    let mut free = [0; 2];
    for (half, free) in free.iter_mut().enumerate() {
        for index in 0..cells {
            match read(CounterPlace { half, index }) {
                CounterCell::Empty => continue,
                CounterCell::Epoch(epoch) if epoch > newest => (newest, active) = (epoch, half),
                CounterCell::Epoch(_) | CounterCell::Damaged => {}
            }
            *free = index + 1;
        }
    }
    let epoch = newest.checked_add(1)?;
    let [first, second] = free;
    let index = if active == 0 { first } else { second };
    Some(if index < cells {
        WritePlan { epoch, at: CounterPlace { half: active, index }, erase: false }
    } else {
        WritePlan { epoch, at: CounterPlace { half: 1 - active, index: 0 }, erase: true }
    })
}

/// Value of an erased byte.
const ERASED: u8 = 0xff;

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec;
    use std::vec::Vec;

    const CELLS: usize = 4;

    /// A flash of two halves with a simulated loss of power.
    struct Flash(Vec<[u8; CELL_LEN]>);

    impl Flash {
        fn new() -> Self {
            Self(vec![[ERASED; CELL_LEN]; 2 * CELLS])
        }

        fn plan(&self) -> WritePlan {
            plan(CELLS, |at| CounterCell::of(&self.0[at.half * CELLS + at.index])).unwrap()
        }

        /// A start that loses its power after `steps` steps: erasing, half a cell, the whole cell.
        fn start(&mut self, steps: usize) -> Option<u32> {
            let WritePlan { epoch, at, erase } = self.plan();
            if erase {
                if steps == 0 {
                    // Erasing was interrupted: some cells are erased, and some are undefined.
                    self.0[at.half * CELLS] = [0xf0; CELL_LEN];
                    self.0[at.half * CELLS + 1] = [ERASED; CELL_LEN];
                    return None;
                }
                self.0[at.half * CELLS..][..CELLS].fill([ERASED; CELL_LEN]);
            }
            let to = &mut self.0[at.half * CELLS + at.index];
            assert_eq!(*to, [ERASED; CELL_LEN], "a cell is written once");
            let whole = cell(epoch);
            if steps < 2 {
                to[..6].copy_from_slice(&whole[..6]);
                return None;
            }
            *to = whole;
            Some(epoch)
        }
    }

    #[test]
    fn every_start_has_a_larger_epoch_than_all_before() {
        let mut flash = Flash::new();
        let epochs: Vec<_> = (0..40).map(|_| flash.start(2).unwrap()).collect();
        assert_eq!(epochs, (1..=40).collect::<Vec<_>>());
    }

    #[test]
    fn power_that_goes_at_any_moment_never_brings_an_epoch_back() {
        // Every pattern of six starts, three endings each, twice over.
        for pattern in 0..3_usize.pow(6) {
            let (mut flash, mut last) = (Flash::new(), 0);
            for n in 0..12 {
                let steps = pattern / 3_usize.pow(n % 6) % 3;
                if let Some(epoch) = flash.start(steps) {
                    assert!(epoch > last, "pattern {pattern}, start {n}: {epoch} after {last}");
                    last = epoch;
                }
            }
        }
    }

    #[test]
    fn a_cell_is_what_was_written_and_nothing_else() {
        assert_eq!(CounterCell::of(&cell(7)), CounterCell::Epoch(7));
        assert_eq!(&cell(0x0102_0304)[..12], [0x31, 0x2d, 0x32, 0x42, 4, 3, 2, 1, 0xfb, 0xfc, 0xfd, 0xfe]);
        assert_eq!(CounterCell::of(&[ERASED; CELL_LEN]), CounterCell::Empty);
        for bit in 0..8 * CELL_LEN {
            let mut bytes = cell(7);
            bytes[bit / 8] ^= 1 << (bit % 8);
            assert_eq!(CounterCell::of(&bytes), CounterCell::Damaged, "bit {bit}");
        }
        let full =
            |at: CounterPlace| if at.index == 0 { CounterCell::Epoch(u32::MAX) } else { CounterCell::Empty };
        assert_eq!(plan(CELLS, full), None);
    }
}
