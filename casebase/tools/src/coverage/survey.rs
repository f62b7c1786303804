//! `survey`: verdicts of a library on many problems. Every case is tested in every problem, as in `cases
//! explain`.

use casebase::{CaseBase, CaseVerdict, Match, Problem, RetrievalSettings, SettingError, explain, rank_order};

use super::area::Area;
use super::cells::Cells;
use super::counters::{COST_BIN_MM, COST_BINS, Counters, RINGS, Reach, VERDICTS};

/// A library, its retrieval settings, and the grid of the counters.
#[derive(Clone, Debug)]
pub struct Survey<'a> {
    base: CaseBase<'a>,
    settings: RetrievalSettings,
    /// Settings with scopes a fifth larger; opponents' paths widen too, so a case that passes these checks
    /// would pass with the ball's scope alone enlarged.
    wider: RetrievalSettings,
    cells: Cells,
}

impl<'a> Survey<'a> {
    /// A survey of a library; fails where the widened `thr` is refused as a setting.
    pub fn new(base: CaseBase<'a>, settings: &RetrievalSettings, cells: Cells) -> Result<Self, SettingError> {
        let mut wider = settings.clone();
        // exp(−k²·e) where the threshold is exp(−e).
        let threshold = f64::from(settings.threshold).powf(WIDER_FACTOR * WIDER_FACTOR);
        wider.set("thr", &format!("{threshold:.6}"))?;
        Ok(Self { base, settings: settings.clone(), wider, cells })
    }

    /// The grid of the heat map.
    pub const fn cells(&self) -> Cells {
        self.cells
    }

    /// The library that is surveyed.
    pub const fn base(&self) -> CaseBase<'a> {
        self.base
    }

    /// Counters at zero, of the size of this library and grid.
    pub fn empty(&self) -> Counters {
        Counters::new(self.base.len() / COPIES_PER_CASE, self.cells.len())
    }

    /// The counters of numbered problems.
    pub fn over(&self, problems: impl IntoIterator<Item = (u64, Problem)>) -> Counters {
        let mut counters = self.empty();
        for (number, problem) in problems {
            self.count(&mut counters, number, &problem);
        }
        counters
    }

    fn count(&self, counters: &mut Counters, number: u64, problem: &Problem) {
        // For each authored case: the last check that its better copy reached, and that copy's interval.
        let mut reached = vec![(0_usize, RINGS.len()); counters.cases.len()];
        let mut best: Option<Match> = None;
        let mut candidates = 0;
        explain(&self.base, problem, &self.settings, |id, verdict| {
            let Some((step, interval)) = reached.get_mut(usize::from(id.0) / COPIES_PER_CASE) else { return };
            *step = (*step).max(step_of(&verdict));
            if let CaseVerdict::Candidate(found) = verdict {
                candidates += 1;
                *interval = (*interval).min(ring(&found));
                if best.as_ref().is_none_or(|best| rank_order(&found, best, &self.settings).is_lt()) {
                    best = Some(found);
                }
            }
        });
        let area = Area::of(self.base.field(), problem.ball, problem.defending) as usize;
        let cell = &mut counters.cells[self.cells.cell(problem.ball, problem.defending)];
        counters.problems += 1;
        counters.candidates += candidates;
        counters.areas[area].problems += 1;
        cell.problems += 1;
        cell.candidates += candidates;
        let winner = best.as_ref().map(|best| best.case.0 / COPIES_PER_CASE as u16);
        let mut reach = Vec::new();
        for (authored, (counts, (step, interval))) in (0_u16..).zip(counters.cases.iter_mut().zip(&reached)) {
            counts.verdicts[*step] += 1;
            if *step == CANDIDATE_INDEX {
                reach.push(authored);
                counts.rings[*interval] += 1;
                match winner {
                    Some(winner) if winner != authored => *counts.beaten_by.entry(winner).or_default() += 1,
                    _ => {}
                }
            }
        }
        if let (Some(best), Some(winner)) = (&best, winner) {
            let counts = &mut counters.cases[usize::from(winner)];
            counts.wins += 1;
            counts.rings_won[ring(best)] += 1;
            *cell.wins.entry(winner).or_default() += 1;
            counters.rings[ring(best)] += 1;
            counters.costs[((best.cost / COST_BIN_MM) as usize).min(COST_BINS - 1)] += 1;
        } else {
            counters.none += 1;
            counters.areas[area].none += 1;
            cell.none += 1;
            cell.first_hole = cell.first_hole.into_iter().chain([number]).min();
            counters.furthest[reached.iter().map(|(step, _)| *step).max().unwrap_or(0)] += 1;
            self.who_would_fill(counters, problem);
        }
        if let [only] = reach[..] {
            let counts = &mut counters.cases[usize::from(only)];
            counts.sole += 1;
            counts.sole_in[area] += 1;
        }
        let reach = counters.reaches.entry(reach).or_insert(Reach { problems: 0, first: number });
        reach.problems += 1;
        reach.first = reach.first.min(number);
    }

    fn who_would_fill(&self, counters: &mut Counters, problem: &Problem) {
        let mut last = None;
        let mut fills = Vec::new();
        explain(&self.base, problem, &self.wider, |id, verdict| {
            let authored = usize::from(id.0) / COPIES_PER_CASE;
            if matches!(verdict, CaseVerdict::Candidate(_)) && last != Some(authored) {
                last = Some(authored);
                fills.push(authored);
            }
        });
        for authored in fills {
            counters.cases[authored].would_fill += 1;
        }
    }
}

/// The last check that a copy reached: an index of [`VERDICTS`].
fn step_of(verdict: &CaseVerdict) -> usize {
    VERDICTS.iter().position(|label| *label == verdict.label()).unwrap_or(0)
}

/// The similarity interval: an index of [`RINGS`].
fn ring(found: &Match) -> usize {
    INTERVALS.iter().filter(|end| found.similarity < **end).count()
}

/// Number of stored copies of an authored case.
const COPIES_PER_CASE: usize = casebase::Symmetry::ALL.len();
/// The index of "candidate" in [`VERDICTS`].
const CANDIDATE_INDEX: usize = VERDICTS.len() - 1;
/// The ends of H, h and l (Ros et al. 2009, §3.4).
const INTERVALS: [f32; 3] = [0.8, 0.6, 0.4];
/// Factor of the enlarged radii that are tried for a hole.
const WIDER_FACTOR: f64 = 1.2;
