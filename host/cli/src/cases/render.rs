//! `onetwo cases render`: figures of cases. An SVG or PNG, alone or all on one page (docs/case-format.md §3).

use std::io::{Read, stdin};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use arena::cases::{LibraryHandle, candidate, counted, problem};
use casebase::{Problem, Symmetry, rank_order};
use clap::{Args, ValueEnum};
use figures::{CasePicture, Overlay, Theme, case_picture, sheet};

use super::failure::{NoCase, ProblemError};
use super::lines::LINE_MAX;
use super::show::{find, unknown};
use crate::Failure;
use crate::args::{LibraryArgs, SettingsArgs};
use crate::destination;
use crate::output::print_text;
use crate::picture::{self, SnapshotError, Unwritten};

/// Arguments of `cases render`.
#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    /// `region/name` of a case (drawn as authored), or the id of a stored case; with --problem the retrieved
    /// one.
    #[arg(value_name = "NAME|ID", required_unless_present_any = ["problem", "all", "sheet"])]
    case: Option<String>,
    /// A situation to draw over the case: a file, - for stdin, or the line of JSON itself.
    #[arg(long, value_name = "FILE|-|JSON")]
    problem: Option<String>,
    /// Output file, an .svg or a .png; the SVG on stdout if left out. With --all a directory.
    #[arg(short, long, value_name = "FILE|DIR")]
    out: Option<PathBuf>,
    /// Draw every authored case into the directory --out, as region/name.svg.
    #[arg(long, requires = "out", conflicts_with_all = ["case", "problem"])]
    all: bool,
    /// Draw all authored cases small on one page, an .svg, or a .png if built with --features png.
    #[arg(long, value_name = "FILE", value_parser = picture_file, conflicts_with_all = ["case", "problem"])]
    sheet: Option<PathBuf>,
    /// What the figure is for.
    #[arg(long, value_enum, default_value = "light")]
    theme: ThemeLabel,
    #[command(flatten)]
    library: LibraryArgs,
    #[command(flatten)]
    settings: SettingsArgs,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum ThemeLabel {
    Light,
    Dark,
    Print,
}

impl From<ThemeLabel> for Theme {
    fn from(label: ThemeLabel) -> Self {
        match label {
            ThemeLabel::Light => Self::Light,
            ThemeLabel::Dark => Self::Dark,
            ThemeLabel::Print => Self::Print,
        }
    }
}

pub(super) fn run(args: &RenderArgs) -> Result<ExitCode, Failure> {
    let library_handle = crate::library::open(&args.library)?;
    if args.all || args.sheet.is_some() {
        return every(args, &library_handle);
    }
    let svg = one(args, &library_handle)?;
    if let Some(file) = &args.out {
        picture::named(&file.to_string_lossy(), &KINDS)
            .map_err(|error| Unwritten { file: file.clone(), error })?;
        let read = args.problem.as_ref().map(Path::new).filter(|file| file.exists());
        destination::check(&[(file, picture::kind(file))], read.as_slice())?;
        picture::write(file, &svg)?;
    } else {
        print_text(&svg)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// One case, alone or under a problem.
fn one(args: &RenderArgs, library_handle: &LibraryHandle) -> Result<String, Failure> {
    let chosen = args.settings.choose()?;
    let settings = &chosen.settings;
    let base = library_handle.base();
    let problem = args.problem.as_deref().map(read).transpose()?;
    let case = match (&args.case, &problem) {
        (Some(asked), _) => Some(find(library_handle, asked).ok_or_else(|| unknown(library_handle, asked))?),
        (None, Some(problem)) => {
            casebase::retrieve(&base, problem, settings).best.and_then(|best| base.case(best.case))
        }
        (None, None) => None,
    };
    let case = case.ok_or(NoCase::NoneFits)?;
    let mut verdicts = Vec::new();
    if let Some(problem) = &problem {
        casebase::explain(&base, problem, settings, |id, verdict| verdicts.push((id, verdict)));
    }
    let verdict = verdicts.iter().find(|(id, _)| *id == case.id()).map(|(_, verdict)| verdict);
    if problem.is_some() && verdict.is_none() {
        return Err(NoCase::OtherGoal(library_handle.name(case.id()).to_owned()).into());
    }
    let mut ranking: Vec<_> = verdicts.iter().filter_map(|(_, verdict)| candidate(verdict)).collect();
    ranking.sort_by(|a, b| rank_order(a, b, settings));
    let before = ranking.iter().position(|found| found.case == case.id());
    let rank = before.map(|before| (before + 1, ranking.len()));
    let overlay =
        problem.as_ref().zip(verdict).map(|(problem, verdict)| Overlay { problem, settings, verdict, rank });
    let intent = library_handle.intent(case.id()).unwrap_or_default();
    let (name, theme) = (library_handle.name(case.id()), args.theme.into());
    Ok(case_picture(&CasePicture { base, case, name, intent: &intent, overlay, theme }))
}

/// Every authored case: a file each, all on one page, or both.
fn every(args: &RenderArgs, library_handle: &LibraryHandle) -> Result<ExitCode, Failure> {
    let base = library_handle.base();
    if base.is_empty() {
        return Err(NoCase::EmptyLibrary(library_handle.league().to_owned()).into());
    }
    let authored: Vec<_> = base.cases().filter(|case| case.symmetry() == Symmetry::Identity).collect();
    let intents: Vec<_> =
        authored.iter().map(|case| library_handle.intent(case.id()).unwrap_or_default()).collect();
    let pictures: Vec<_> = authored
        .iter()
        .zip(&intents)
        .map(|(case, intent)| CasePicture {
            base,
            case: *case,
            name: library_handle.name(case.id()),
            intent,
            overlay: None,
            theme: args.theme.into(),
        })
        .collect();
    if let Some(directory) = args.out.as_ref().filter(|_| args.all) {
        for picture in &pictures {
            let file = directory.join(format!("{}.svg", picture.name));
            if let Some(directory) = file.parent() {
                destination::make_directory(directory)?;
            }
            picture::write(&file, &case_picture(picture))?;
        }
    }
    if let Some(file) = &args.sheet {
        let title = format!("{}: {}", library_handle.league(), counted(pictures.len(), "case"));
        picture::write(file, &sheet(&title, &pictures))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Reads the problem from the argument or from the file that it names.
fn read(argument: &str) -> Result<Problem, Failure> {
    let text = if argument.trim_start().starts_with('{') {
        argument.to_owned()
    } else if argument == "-" {
        let mut text = String::new();
        stdin().lock().take(LINE_MAX as u64 + 1).read_to_string(&mut text).map_err(Failure::Input)?;
        text
    } else {
        let file = Path::new(argument);
        foreign::read_text(file, LINE_MAX as u64)
            .map_err(|error| ProblemError::Unreadable(file.to_owned(), error))?
    };
    if text.len() > LINE_MAX {
        return Err(ProblemError::TooLong(LINE_MAX).into());
    }
    Ok(problem::parse(text.trim_start_matches('\u{feff}').trim()).map_err(ProblemError::Malformed)?)
}

fn picture_file(text: &str) -> Result<PathBuf, SnapshotError> {
    picture::named(text, &KINDS)
}

const KINDS: [&str; 2] = ["svg", "png"];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_faulty_problem_is_reported_with_its_place() {
        let error = read(r#"{"ball":[0]}"#).unwrap_err().to_string();
        assert!(error.starts_with("--problem: ball"), "{error}");
    }
}
