//! `counters`: counters over many problems. Whole numbers only, so that they merge exactly, in any order.

use std::collections::BTreeMap;

use super::area::Area;

/// Last check that a case reached in a problem, in the order of retrieval's checks; the better of its two
/// copies counts.
pub const VERDICTS: [&str; 6] = ["ball", "robots", "out_of_field", "thr_c", "path", "candidate"];
/// The similarity intervals, best first.
pub const RINGS: [&str; 4] = ["H", "h", "l", "L"];
/// Width of a bin of the histogram of costs, mm.
pub const COST_BIN_MM: f32 = 250.0;
/// Number of bins of costs; the last extends to infinity (four robots with 1500 mm each make 6000 mm).
pub const COST_BINS: usize = 25;

/// Counts over some problems.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Number of problems that were counted.
    pub problems: u64,
    /// Number of problems without a candidate.
    pub none: u64,
    /// Number of stored candidates, over all problems.
    pub candidates: u64,
    /// Counters by authored case, indexed by its number.
    pub cases: Vec<CaseCounters>,
    /// Counts by cell of the grid.
    pub cells: Vec<CellCounters>,
    /// Counters by [`Area`], in the order of [`Area::ALL`].
    pub areas: [AreaCounters; Area::ALL.len()],
    /// Winners by similarity interval ([`RINGS`]).
    pub rings: [u64; RINGS.len()],
    /// Winners by cost, in bins of [`COST_BIN_MM`].
    pub costs: [u64; COST_BINS],
    /// Problems without a candidate, by the last check that the best case reached ([`VERDICTS`]).
    pub furthest: [u64; VERDICTS.len()],
    /// Problems by their reachability set: the authored cases that are candidates, in rising order.
    pub reaches: BTreeMap<Vec<u16>, Reach>,
}

/// Counters of one authored case.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CaseCounters {
    /// Problems by the last check it reached ([`VERDICTS`]).
    pub verdicts: [u64; VERDICTS.len()],
    /// Number of problems it won.
    pub wins: u64,
    /// Number of problems in which it is the only authored candidate: they are lost when its file is deleted.
    pub sole: u64,
    /// Problems of which it is the only candidate, by the ball's [`Area`].
    pub sole_in: [u64; Area::ALL.len()],
    /// Winners of the problems in which it was a candidate and did not win.
    pub beaten_by: BTreeMap<u16, u64>,
    /// Times candidate by the interval of its best copy ([`RINGS`]).
    pub rings: [u64; RINGS.len()],
    /// Times winner by interval.
    pub rings_won: [u64; RINGS.len()],
    /// Number of problems without any candidate for which it would be one if its ball scope were a fifth
    /// larger.
    pub would_fill: u64,
}

/// Counters of the balls of one cell.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CellCounters {
    /// Number of problems with the ball there.
    pub problems: u64,
    /// Problems without a candidate.
    pub none: u64,
    /// Number of stored candidates.
    pub candidates: u64,
    /// Wins by authored case.
    pub wins: BTreeMap<u16, u64>,
    /// Number of the first problem without a candidate.
    pub first_hole: Option<u64>,
}

/// Counters of one strategic area.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AreaCounters {
    /// Number of problems with the ball there.
    pub problems: u64,
    /// Problems without a candidate.
    pub none: u64,
}

/// Problems with the same candidates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reach {
    /// Number of such problems.
    pub problems: u64,
    /// The number of the first.
    pub first: u64,
}

impl Counters {
    /// Counters at zero, for this number of authored cases and of cells.
    pub fn new(cases: usize, cells: usize) -> Self {
        Self {
            cases: vec![CaseCounters::default(); cases],
            cells: vec![CellCounters::default(); cells],
            ..Self::default()
        }
    }

    /// The sum of both; they must be of the same library and grid.
    #[must_use]
    pub fn merge(mut self, other: Self) -> Self {
        self.problems += other.problems;
        self.none += other.none;
        self.candidates += other.candidates;
        for (mine, theirs) in self.cases.iter_mut().zip(other.cases) {
            mine.add(theirs);
        }
        for (mine, theirs) in self.cells.iter_mut().zip(other.cells) {
            mine.add(theirs);
        }
        for (mine, theirs) in self.areas.iter_mut().zip(other.areas) {
            mine.problems += theirs.problems;
            mine.none += theirs.none;
        }
        add(&mut self.rings, other.rings);
        add(&mut self.costs, other.costs);
        add(&mut self.furthest, other.furthest);
        for (cases, theirs) in other.reaches {
            let mine = self.reaches.entry(cases).or_insert(Reach { problems: 0, first: theirs.first });
            mine.problems += theirs.problems;
            mine.first = mine.first.min(theirs.first);
        }
        self
    }

    /// Number of problems with a winner.
    pub const fn won(&self) -> u64 {
        self.problems - self.none
    }
}

impl CaseCounters {
    /// Number of problems in which it is a candidate: the size of its coverage set.
    pub const fn candidate(&self) -> u64 {
        self.verdicts[VERDICTS.len() - 1]
    }

    fn add(&mut self, other: Self) {
        add(&mut self.verdicts, other.verdicts);
        self.wins += other.wins;
        self.sole += other.sole;
        add(&mut self.sole_in, other.sole_in);
        add_map(&mut self.beaten_by, other.beaten_by);
        add(&mut self.rings, other.rings);
        add(&mut self.rings_won, other.rings_won);
        self.would_fill += other.would_fill;
    }
}

impl CellCounters {
    /// Entropy of the winner, bits: 0 where one case always wins, 1 where two share evenly; 0 without a
    /// winner.
    pub fn entropy_bits(&self) -> f64 {
        entropy_bits(self.wins.values().copied())
    }

    fn add(&mut self, other: Self) {
        self.problems += other.problems;
        self.none += other.none;
        self.candidates += other.candidates;
        add_map(&mut self.wins, other.wins);
        self.first_hole = self.first_hole.into_iter().chain(other.first_hole).min();
    }
}

/// Shannon's entropy of the shares of these counts, bits.
pub fn entropy_bits(counts: impl Iterator<Item = u64> + Clone) -> f64 {
    let total = counts.clone().sum::<u64>() as f64;
    counts
        .filter(|count| *count > 0)
        .map(|count| count as f64 / total)
        .map(|share| -share * share.log2())
        .sum::<f64>()
        // A single case gives −0.
        .max(0.0)
}

fn add<const N: usize>(mine: &mut [u64; N], theirs: [u64; N]) {
    for (mine, theirs) in mine.iter_mut().zip(theirs) {
        *mine += theirs;
    }
}

fn add_map(mine: &mut BTreeMap<u16, u64>, theirs: BTreeMap<u16, u64>) {
    for (case, count) in theirs {
        *mine.entry(case).or_default() += count;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entropy_agrees_with_a_calculation_by_hand() {
        let of = |counts: &[u64]| entropy_bits(counts.iter().copied());
        assert_eq!(of(&[]), 0.0);
        assert_eq!(of(&[7]), 0.0);
        assert_eq!(of(&[5, 5]), 1.0);
        assert_eq!(of(&[2, 0, 2, 2, 2]), 2.0);
        // 1/2 · 1 + 1/4 · 2 + 1/4 · 2
        assert_eq!(of(&[4, 2, 2]), 1.5);
    }
}
