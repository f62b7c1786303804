//! `report`: report of an evaluation. One page beside the paper's numbers, its plots as files, and its part
//! of the documentation. Runs on the PC.
//!
//! ```text
//! tables, paper, comparisons, claims, facts ─┬─► html()         one file: no network, no scripts; light, dark, paper
//! Mapper: trials played again ─► Map ────────┼─► figure_files() the same plots and maps, one SVG each
//!                                            └─► markdown()     docs/evaluation.md, between its markers
//! ```
//! Numbers come from `study::evaluation` and are printed, never changed: what a table prints is rounded for
//! the reader, and every interval and p stands beside its number.
#![forbid(unsafe_code)]

mod ablation;
mod columns;
mod facts;
mod labels;
mod map;
mod markdown;
mod page;
mod plot;
mod table;
mod versions;

use figures::FigureFile;
use study::evaluation::{CaseUse, Claim, Comparison, JudgementLine, TableRow};

pub use ablation::Ablation;
pub use facts::Facts;
pub use map::{Map, MapError, Mapper, Pass, PassKind, SQUARE_MM};
pub use markdown::{MarkerError, between_markers};
pub use versions::Versions;

/// Inputs of a report.
#[derive(Clone, Copy, Debug)]
pub struct Report<'a> {
    /// Our rows of the paper's tables.
    pub rows: &'a [TableRow],
    /// The paper's own rows of these tables.
    pub paper: &'a [TableRow],
    /// Ours compared with the paper's, measure by measure.
    pub with_paper: &'a [Comparison],
    /// Our approaches compared with each other, pair by pair.
    pub between: &'a [Comparison],
    /// The paper's approaches compared with each other.
    pub papers_between: &'a [Comparison],
    /// Uses and outcomes of each case.
    pub uses: &'a [CaseUse],
    /// The paper's claims in prose, and whether the numbers support them.
    pub claims: &'a [Claim],
    /// Lines of the pattern of the paper's results, each with its verdict.
    pub lines: &'a [JudgementLine],
    /// All settings that the trials depend on: parameters, options, hashes, commit.
    pub facts: &'a [Facts],
    /// Places of the ball and passes between robots, a map a cell.
    pub maps: &'a [Map],
}

impl Report<'_> {
    /// The whole report in one file.
    pub fn html(&self) -> String {
        page::page(self)
    }

    /// All figures: plots first, then maps.
    pub fn figure_files(&self) -> Vec<FigureFile> {
        let plots = plot::plots(self).into_iter().map(|(_, figure)| figure.file());
        plots.chain(map::sheets(self.maps)).collect()
    }

    /// Tables and claims for the documentation; figures are named relative to `figures_directory`, for
    /// example `evaluation/`.
    pub fn markdown(&self, figures_directory: &str) -> String {
        markdown::markdown(self, figures_directory)
    }
}
