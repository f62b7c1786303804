//! `budget`: size budget of a firmware image: the budget of docs/architecture.md §9, and the computers it is
//! compared with.

use std::fmt;

use super::Sizes;

/// Limits of a firmware image, bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// Largest size of the image in flash, bytes.
    pub flash: u64,
    /// RAM that is taken before the program starts.
    pub ram: u64,
}

impl Budget {
    /// Budget of a robot's firmware with its cases (docs/architecture.md §9).
    pub const IMAGE: Self = Self { flash: 160 * 1024, ram: 48 * 1024 };

    /// Whether `sizes` keep to it.
    pub fn check(self, sizes: &Sizes) -> Result<(), OverBudget> {
        if sizes.flash <= self.flash && sizes.ram <= self.ram {
            return Ok(());
        }
        let largest =
            sizes.symbols.iter().take(LARGEST).map(|part| (part.name.clone(), part.flash + part.ram));
        Err(OverBudget { budget: self, flash: sizes.flash, ram: sizes.ram, largest: largest.collect() })
    }
}

/// A firmware image that exceeds its budget.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OverBudget {
    /// The budget that is exceeded.
    pub budget: Budget,
    /// Bytes of flash used.
    pub flash: u64,
    /// Bytes of RAM used.
    pub ram: u64,
    /// Its largest symbols, and their bytes.
    pub largest: Vec<(String, u64)>,
}

impl fmt::Display for OverBudget {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { budget, flash, ram, .. } = self;
        write!(f, "{flash} of {} B flash, {ram} of {} B RAM; the largest:", budget.flash, budget.ram)?;
        self.largest.iter().try_for_each(|(name, bytes)| write!(f, "\n  {bytes:6} {name}"))
    }
}

impl std::error::Error for OverBudget {}

/// A computer that a robot may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chip {
    /// Name of the computer.
    pub name: &'static str,
    /// Flash, bytes; `None` where programs are loaded into RAM.
    pub flash: Option<u64>,
    /// Size of the RAM, bytes.
    pub ram: u64,
    /// Clock frequency of the core, Hz.
    pub clock: u64,
}

impl Chip {
    /// Computers that reports compare with: the first paper's robot, a credible minimum, and those of today's
    /// teams.
    pub const ALL: [Self; 3] = [
        // Sony AIBO ERS-7: MIPS R7000 at 576 MHz, 64 MB (its data sheet); programs run from RAM.
        Self { name: "AIBO ERS-7", flash: None, ram: 64 << 20, clock: 576_000_000 },
        // RM0090: 1 MiB flash, 128 KiB SRAM besides the 64 KiB that are tied to the core.
        Self { name: "STM32F405", flash: Some(1 << 20), ram: 192 << 10, clock: 168_000_000 },
        // RM0433: 2 MiB flash, 1 MiB RAM in all banks.
        Self { name: "STM32H743", flash: Some(2 << 20), ram: 1 << 20, clock: 480_000_000 },
    ];
}

/// Deepest stack that a program may use, bytes, measured by painting (docs/architecture.md §9): a tenth less
/// than the 16 KiB for which boards keep room, and with [`Budget::IMAGE`]'s RAM less than half of an
/// STM32F405's 128 KiB.
pub const STACK_BUDGET: u32 = 14_750;

/// Guest instructions that any brain step may take (docs/architecture.md §9), the tasks around the brain
/// included, whatever robot the image is built for and however long it plays.
pub const STEP_BUDGET: u32 = 40_000;

/// Number of symbols named where a budget is exceeded.
const LARGEST: usize = 12;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inspect::SizePart;

    #[test]
    fn a_byte_too_many_breaks_the_budget_and_the_largest_are_named() {
        let part = |name: &str, flash| SizePart { name: name.into(), flash, ram: 0 };
        let sizes = |flash, ram| Sizes { flash, ram, crates: vec![], symbols: vec![part("table", 7)] };
        assert_eq!(Budget::IMAGE.check(&sizes(163_840, 49_152)), Ok(()));
        let over = Budget::IMAGE.check(&sizes(163_841, 0)).unwrap_err().to_string();
        assert!(over.contains("163841 of 163840 B flash") && over.contains("table"), "{over}");
        assert!(Budget::IMAGE.check(&sizes(0, 49_153)).is_err());
    }
}
