//! `claims`: the paper's claims in prose, tested against numbers. Ours, and the paper's own tables (Ros et
//! al. 2009 §5).
//!
//! A claim is a list of [`Point`]s, each two numbers and their expected order. Its verdict is computed from
//! table rows and nothing else: *supported* where every point is in the claimed order and significant (p <
//! 0.05 after Holm's correction over the claim's points), *contradicted* where one is in the opposite order
//! and significant, else *undecided*. Where no spread was printed there is no p, and the numbers alone
//! decide.

mod list;
mod point;

use serde::Serialize;

use super::tables::{Extent, TableRow};
use crate::statistics::holm_by_family;

pub use point::{ClaimPoint, Standing};
pub(super) use point::{Rows, p_text};

/// A claim of the paper about its results.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Claim {
    /// Short name in tables and JSON.
    pub id: &'static str,
    /// Section of the paper.
    pub section: &'static str,
    /// The claim, in our phrasing.
    pub sentence: &'static str,
    /// Verdict of all our trials.
    pub ours: Judgement,
    /// Verdict of as many of them as the paper's, where there were more: the first 30 of Table 6.
    pub ours_as_paper: Option<Judgement>,
    /// Verdict of the paper's own tables.
    pub paper: Judgement,
}

geometry::labels! {
    /// Verdict on a claim.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
    #[serde(rename_all = "lowercase")]
    pub enum ClaimVerdict {
        /// The numbers support it, in every point.
        Supported = "supported",
        /// The numbers contradict it, in one point at least.
        Contradicted = "contradicted",
        /// Neither: at least one point is not significant or not measured.
        Undecided = "undecided",
        /// No numbers for it.
        Unmeasured = "unmeasured",
    }
}

/// Verdict of numbers on a claim.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Judgement {
    /// Supported, contradicted or undecided.
    pub verdict: ClaimVerdict,
    /// The numbers, as text.
    pub evidence: String,
    /// The numbers, pair by pair.
    pub points: Vec<ClaimPoint>,
}

impl Judgement {
    /// Judges the points of a claim; `None` stands for one that was not measured.
    pub(super) fn new(points: Vec<Option<ClaimPoint>>) -> Self {
        let all = points.len();
        let mut points: Vec<ClaimPoint> = points.into_iter().flatten().collect();
        let tests: Vec<_> = points.iter().map(|point| ((), point.p)).collect();
        for (point, p) in points.iter_mut().zip(holm_by_family(&tests)) {
            point.p_holm = p;
            point.stand();
        }
        let stands = |standing| points.iter().filter(|point| point.stands == standing).count();
        let verdict = match () {
            () if points.is_empty() => ClaimVerdict::Unmeasured,
            () if stands(Standing::Against) > 0 => ClaimVerdict::Contradicted,
            () if stands(Standing::Holds) == all => ClaimVerdict::Supported,
            () => ClaimVerdict::Undecided,
        };
        let mut evidence = points.iter().map(ClaimPoint::to_string).collect::<Vec<_>>().join("; ");
        if points.len() < all && !points.is_empty() {
            evidence.push_str("; the rest was not played");
        }
        Self { verdict, evidence, points }
    }
}

/// Every claim, judged by our rows and by the paper's.
pub fn claims(ours: &[TableRow], paper: &[TableRow]) -> Vec<Claim> {
    let has_more = ours.iter().any(|row| row.sample == Extent::Large);
    let judged =
        |rows: &[TableRow], sample, points: list::Points| Judgement::new(points(&Rows { rows, sample }));
    let claims = list::CLAIMS.iter().map(|(id, section, sentence, points)| Claim {
        id,
        section,
        sentence,
        ours: judged(ours, Extent::Large, *points),
        ours_as_paper: (has_more && list::is_of_robots(section))
            .then(|| judged(ours, Extent::Paper, *points)),
        paper: judged(paper, Extent::Paper, *points),
    });
    claims.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluation::paper::paper;

    fn of_paper(id: &str) -> Judgement {
        let claims = claims(paper(), paper());
        let claim = claims.into_iter().find(|claim| claim.id == id);
        claim.unwrap_or_else(|| panic!("no claim {id}")).paper
    }

    #[test]
    fn the_papers_tables_bear_out_what_independent_tests_of_them_do() {
        // Two-proportion and Welch tests of the printed tables, computed apart
        // (`data/derived_cbr_vs_reactive_z.csv`), and the contradictions between tables and prose that its
        // transcription found.
        for (id, verdict) in [
            ("dg-to-goal", ClaimVerdict::Undecided),
            ("dg-to-goal-3-4", ClaimVerdict::Supported),
            ("dg-out", ClaimVerdict::Supported),
            ("dg-possession", ClaimVerdict::Supported),
            ("dg-time", ClaimVerdict::Supported),
            ("2d-to-goal", ClaimVerdict::Supported),
            ("2d-out", ClaimVerdict::Supported),
            ("2d-midfield", ClaimVerdict::Supported),
            ("2d-defender", ClaimVerdict::Undecided),
            ("2d-time", ClaimVerdict::Contradicted),
            ("2d-timeout", ClaimVerdict::Undecided),
            ("robots-3-out", ClaimVerdict::Supported),
            ("robots-3-to-goal", ClaimVerdict::Undecided),
            ("robots-4-to-goal", ClaimVerdict::Undecided),
            ("default-share", ClaimVerdict::Unmeasured),
        ] {
            let judged = of_paper(id);
            assert_eq!(judged.verdict, verdict, "{id}: {}", judged.evidence);
        }
    }

    #[test]
    fn a_claim_needs_every_point_and_one_against_it_is_enough() {
        let row = |scenario, approach, to_goal| {
            let mut row = TableRow::empty(1, scenario, approach);
            (row.trials, row.to_goal) = (500, Some(to_goal));
            row
        };
        use brain::Approach::{Cases, Reactive};
        use hil_sim::Scenario;
        let rows = |fourth: f64| {
            let mut rows: Vec<_> = Scenario::PAPER.into_iter().map(|s| row(s, Cases, 50.0)).collect();
            rows.extend(Scenario::PAPER.into_iter().map(|s| row(s, Reactive, 30.0)));
            rows[7].to_goal = Some(fourth);
            rows
        };
        let verdict = |rows: &[TableRow]| claims(rows, paper())[0].ours.clone();
        assert_eq!(verdict(&rows(30.0)).verdict, ClaimVerdict::Supported);
        assert_eq!(verdict(&rows(49.0)).verdict, ClaimVerdict::Undecided);
        assert_eq!(verdict(&rows(80.0)).verdict, ClaimVerdict::Contradicted);
        let lacking = verdict(&rows(30.0)[..7]);
        assert_eq!(lacking.verdict, ClaimVerdict::Undecided);
        assert!(lacking.evidence.ends_with("the rest was not played"), "{}", lacking.evidence);
        assert_eq!(verdict(&[]).verdict, ClaimVerdict::Unmeasured);
        assert!(
            verdict(&rows(30.0)).evidence.starts_with("scenario 1: cbr 50.0 > reactive 30.0 (p < 0.001)")
        );
    }
}
