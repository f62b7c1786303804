//! `onetwo evaluate report`: the report of a played evaluation, written again; and how every evaluation gets
//! its own.
//!
//! Numbers come from the stored trials. The maps' trials are played again: they are bit-identical if this
//! program played them, and left out, with a message on stderr, if another did.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use arena::Setup;
use brain::{Approach, Positioning};
use casebase::RetrievalSettings;
use clap::Args;
use figures::FigureFile;
use report::{Ablation, Facts, Map, Report};
use study::evaluation::{Identity, Results, compare, paper};
use study::store::{StoredExperiment, in_words, merge};

use super::{merge as shards, work};
use crate::Failure;
use crate::args::{DirectoryArgs, LibraryArgs, NoSuchSetting, VERSION};
use crate::destination::{self, FileKind};
use crate::output::{note, print_text, printable_path};
use crate::{picture, setup};

/// Contents of a report.
#[derive(Debug, Args)]
pub(super) struct ReportArgs {
    /// Trials of each cell that are played again for the report's maps; 0 for none.
    #[arg(long, value_name = "N", default_value_t = 100)]
    maps: u32,
    /// Every plot as PNG too, beside its SVG.
    #[arg(long, value_parser = picture::flag)]
    png: bool,
}

/// The evaluation to report, and further outputs.
#[derive(Debug, Args)]
pub(super) struct AgainArgs {
    /// The directory an evaluation was written to.
    #[arg(value_name = "DIR")]
    directory: PathBuf,
    #[command(flatten)]
    report: ReportArgs,
    /// Put the tables between the markers of this Markdown file, and the plots into a directory of its name
    /// beside it.
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
}

/// Contents of an ablation's page, and further outputs for its table.
#[derive(Debug, Args)]
pub(super) struct PageArgs {
    /// The plot as PNG too, beside its SVG.
    #[arg(long, value_parser = picture::flag)]
    png: bool,
    /// Put the table between the markers of this Markdown file, and the plot into a directory of its name
    /// beside it.
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
}

/// Writes the page of a played ablation.
pub(super) fn write_ablation(
    ablation: &Ablation<'_>,
    directory: &Path,
    args: &PageArgs,
) -> Result<(), Failure> {
    let drawn = ablation.figure_file();
    write_page(directory, &ablation.html(), std::slice::from_ref(&drawn), args.png)?;
    match &args.markdown {
        Some(file) => {
            insert(file, ("evaluation", "ablations"), |directory| ablation.markdown(directory), vec![drawn])
        }
        None => Ok(()),
    }
}

/// `onetwo evaluate report`.
pub(super) fn run(args: &AgainArgs) -> Result<ExitCode, Failure> {
    let (identity, rows) = merge(shards::shards(&args.directory)?)?;
    let results = Results::new(identity, rows)?;
    let made = Made::new(&results, &args.report)?;
    made.write(&results, &args.directory, &args.report)?;
    if let Some(file) = &args.markdown {
        made.write_markdown(&results, file)?;
    }
    print_text(&format!("{}\n", printable_path(&args.directory.join(REPORT_FILE))))?;
    Ok(ExitCode::SUCCESS)
}

/// The report of an evaluation that was just played or merged.
pub(super) fn write(results: &Results, directory: &Path, args: &ReportArgs) -> Result<(), Failure> {
    Made::new(results, args)?.write(results, directory, args)
}

/// Parts of a report beside the results.
struct Made {
    facts: Vec<Facts>,
    maps: Vec<Map>,
    papers_between: Vec<study::evaluation::Comparison>,
}

impl Made {
    fn new(results: &Results, args: &ReportArgs) -> Result<Self, Failure> {
        Ok(Self {
            facts: Facts::of(&results.identity, &results.hash),
            maps: maps(&results.identity, args.maps)?,
            papers_between: compare(paper(), Approach::Cases, Approach::Reactive),
        })
    }

    fn report<'a>(&'a self, results: &'a Results) -> Report<'a> {
        Report {
            rows: &results.tables,
            paper: paper(),
            with_paper: &results.with_paper,
            between: &results.between_approaches,
            papers_between: &self.papers_between,
            uses: &results.uses,
            claims: &results.claims,
            lines: &results.lines,
            facts: &self.facts,
            maps: &self.maps,
        }
    }

    fn write(&self, results: &Results, directory: &Path, args: &ReportArgs) -> Result<(), Failure> {
        let report = self.report(results);
        write_page(directory, &report.html(), &report.figure_files(), args.png)
    }

    fn write_markdown(&self, results: &Results, file: &Path) -> Result<(), Failure> {
        let report = self.report(results);
        insert(file, ("evaluation", "figures"), |directory| report.markdown(directory), report.figure_files())
    }
}

/// Writes a page, and its figures into `plots` beside it; with `png` as pictures too.
fn write_page(directory: &Path, html: &str, figures: &[FigureFile], png: bool) -> Result<(), Failure> {
    let plots = directory.join("plots");
    destination::make_directory(&plots)?;
    for drawn in figures {
        let file = plots.join(&drawn.name);
        picture::write(&file.with_extension("svg"), &drawn.svg)?;
        if png {
            picture::write(&file.with_extension("png"), &drawn.svg)?;
        }
    }
    work::write(&directory.join(REPORT_FILE), FileKind::Html, html.as_bytes())
}

/// Longest Markdown file that is read, bytes.
const MARKDOWN_LEN_MAX: u64 = 1 << 24;

/// Inserts text between the markers of that task and name in a file, and writes the figures that it refers to
/// beside the file. `text_with` takes the directory that the figures are written to.
pub(super) fn insert(
    file: &Path,
    (task, name): (&str, &str),
    text_with: impl Fn(&str) -> String,
    figures: Vec<FigureFile>,
) -> Result<(), Failure> {
    let beside = format!("{}/", file.file_stem().unwrap_or_default().to_string_lossy());
    let text = foreign::read_text(file, MARKDOWN_LEN_MAX).map_err(|error| unwritten(file, error))?;
    let inserted = text_with(&beside);
    let text = report::between_markers(&text, task, name, &inserted)
        .map_err(|error| Failure::Markdown { file: file.to_owned(), error })?;
    let directory = file.with_extension("");
    destination::make_directory(&directory)?;
    for figure in figures {
        if inserted.contains(&format!("{beside}{}.svg", figure.name)) {
            picture::write(&directory.join(figure.name).with_extension("svg"), &figure.svg)?;
        }
    }
    Ok(destination::replace(file, &text)?)
}

fn unwritten(file: &Path, error: std::io::Error) -> Failure {
    picture::Unwritten { file: file.to_owned(), error: picture::SnapshotError::Write(error) }.into()
}

/// The maps of the first trials of each cell, if this program plays identical ones.
fn maps(identity: &Identity, trials: u32) -> Result<Vec<Map>, Failure> {
    if trials == 0 {
        return Ok(Vec::new());
    }
    let setup = setup_of(identity)?;
    let library_handle =
        match crate::library::open_reduced(&library(&identity.library), setup::reduction(&setup)) {
            Ok(library_handle) => library_handle,
            Err(failure) => {
                note!("no maps, as the cases of these trials are not here: {failure}");
                return Ok(Vec::new());
            }
        };
    let evaluation =
        work::evaluation(identity.plan.clone(), setup, &library_handle, identity.library.clone());
    let differences = evaluation.identity().differences(identity);
    if differences.is_empty() {
        return Ok(Map::of(&evaluation, trials)?);
    }
    let (what, program) = (in_words(&differences), &identity.program);
    note!("no maps: {program} played these trials, this is {VERSION}; what differs here: {what}");
    Ok(Vec::new())
}

/// The attackers' set-up that is recorded in an evaluation's files.
fn setup_of(identity: &Identity) -> Result<Setup, Failure> {
    let mut settings = RetrievalSettings::default();
    for (name, value) in &identity.settings {
        settings.set(name, value).map_err(|error| NoSuchSetting::new(name, value, error))?;
    }
    let independent = identity.positioning == arena::positioning_label(Positioning::Independent);
    Ok(Setup {
        settings,
        positioning: if independent { Positioning::Independent } else { Positioning::Dependent },
        retrievers: identity.retrievers,
        loss: identity.loss,
        symmetry: identity.symmetry,
        opponents: identity.case_opponents,
        opponents_pause: identity.opponents_pause,
    })
}

/// A built-in league by its name; any other argument is a directory.
fn library(label: &str) -> LibraryArgs {
    let built_in = case_library::league(label).is_some();
    let library = (!built_in).then(|| PathBuf::from(label));
    LibraryArgs { directory: DirectoryArgs { library }, league: label.to_owned() }
}

const REPORT_FILE: &str = "report.html";
