//! `bad_line`: simulated faulty serial line. It drops some bytes, changes bits of others and duplicates
//! others, seeded.

use hil_sim::Stream;

/// One direction of a serial line.
#[derive(Debug)]
pub struct BadLine {
    chance: Stream,
    /// Error rates from now on.
    pub trouble: Trouble,
}

/// Error rates of a line, per thousand bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Trouble {
    /// Dropped bytes per thousand.
    pub dropped: f32,
    /// Changed in one bit.
    pub changed: f32,
    /// Duplicated bytes per thousand.
    pub doubled: f32,
}

impl Trouble {
    /// The same rate for each.
    pub fn of_each(of_thousand: f32) -> Self {
        Self { dropped: of_thousand, changed: of_thousand, doubled: of_thousand }
    }
}

impl BadLine {
    /// A line without errors.
    pub fn new(seed: u64, name: &str) -> Self {
        Self { chance: Stream::new(seed, name), trouble: Trouble::default() }
    }

    /// The bytes that come out for one byte: none, one or two.
    pub fn carry(&mut self, byte: u8) -> impl Iterator<Item = u8> + use<> {
        let Trouble { dropped, changed, doubled } = self.trouble;
        let [dropped, changed, doubled] =
            [dropped, changed, doubled].map(|share| self.chance.chance(share * 1e-3));
        let bit = self.chance.whole(0, 7);
        let byte = if changed { byte ^ (1 << bit) } else { byte };
        let copies = if dropped { 0 } else { 1 + usize::from(doubled) };
        std::iter::repeat_n(byte, copies)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bad_line_changes_bytes_with_its_probabilities_a_good_one_none() {
        let mut line = BadLine::new(1, "line");
        let text: Vec<u8> = (0..=255).cycle().take(10_000).collect();
        let carried =
            |line: &mut BadLine| text.iter().map(|byte| (*byte, line.carry(*byte).collect())).collect();
        let good: Vec<(u8, Vec<u8>)> = carried(&mut line);
        assert!(good.iter().all(|(byte, out)| *out == [*byte]));
        line.trouble = Trouble { dropped: 100.0, changed: 50.0, doubled: 20.0 };
        let bad: Vec<(u8, Vec<u8>)> = carried(&mut line);
        let count =
            |like: &dyn Fn(u8, &[u8]) -> bool| bad.iter().filter(|(byte, out)| like(*byte, out)).count();
        // Of 10,000, ± four standard deviations; changed and doubled where they were not dropped.
        assert!(count(&|_, out| out.is_empty()).abs_diff(1_000) < 120);
        assert!(count(&|byte, out| out.iter().any(|got| (got ^ byte).is_power_of_two())).abs_diff(450) < 85);
        assert!(count(&|_, out| out.len() == 2).abs_diff(180) < 54);
        assert!(bad.iter().all(|(byte, out)| out.iter().all(|got| (got ^ byte).count_ones() <= 1)));
    }
}
