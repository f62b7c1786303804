//! `report`: report of an evaluation. One page beside the paper's numbers, its plots as files, and its part
//! of the documentation. Runs on the PC.
//!
//! ```text
//! tables, paper, comparisons, claims, facts ─┬─► html()      one file: no network, no scripts; light, dark, paper
//! Mapper: trials played again ─► Map ────────┼─► pictures()  the same plots and maps, one SVG each
//!                                            └─► markdown()  docs/results/evaluation.md, between its markers
//! ```
//! Numbers come from `study::evaluation` and are printed, never changed: what a table prints is rounded for
//! the reader, and every interval and p stands beside its number.
#![forbid(unsafe_code)]

mod ablation;
mod columns;
mod description;
mod facts;
mod map;
mod markdown;
mod numbers;
mod page;
mod plot;
mod style;
mod table;

use std::fs;
use std::io;
use std::path::Path;

use study::evaluation::{CaseUse, Claim, Comparison, JudgementLine, TableRow};

pub use ablation::Ablation;
pub use facts::Facts;
pub use map::{EDGE, Map, MapError, Mapper, Pass, PassKind};
pub use markdown::{MarkerError, between_markers};

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
    /// Whether the pattern of its results is reproduced.
    pub lines: &'a [JudgementLine],
    /// All settings that the trials depend on: parameters, options, hashes, commit.
    pub facts: &'a [Facts],
    /// Where the ball was and the passes between robots, one a cell.
    pub maps: &'a [Map],
}

/// A figure with the name of its file, without an extension.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Name such as `table-1-outcomes`, unique in the report.
    pub name: String,
    /// The figure as SVG.
    pub svg: String,
}

impl Report<'_> {
    /// The whole report in one file.
    pub fn html(&self) -> String {
        page::page(self).into_string()
    }

    /// All figures: plots first, then maps.
    pub fn pictures(&self) -> Vec<Picture> {
        let plots = plot::figures(self).into_iter().map(|figure| figure.picture());
        plots.chain(map::sheets(self.maps)).collect()
    }

    /// Tables and claims for the documentation; figures are named relative to `pictures`, for example
    /// `pictures/`.
    pub fn markdown(&self, pictures: &str) -> String {
        markdown::markdown(self, pictures)
    }

    /// `report.html` and `plots/*.svg` under `directory`; returns the figures.
    pub fn write(&self, directory: &Path) -> io::Result<Vec<Picture>> {
        let plots = directory.join("plots");
        fs::create_dir_all(&plots)?;
        let pictures = self.pictures();
        for picture in &pictures {
            fs::write(plots.join(format!("{}.svg", picture.name)), &picture.svg)?;
        }
        fs::write(directory.join("report.html"), self.html())?;
        Ok(pictures)
    }
}
