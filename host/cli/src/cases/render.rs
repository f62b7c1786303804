//! What does a case look like, and a problem over it? An SVG on stdout or in a file (DESIGN §4.3).

use std::io::{self, Read, Write, stdin, stdout};
use std::path::PathBuf;
use std::process::ExitCode;

use case_tools::draw::{CasePicture, Overlay, Theme, case_picture};
use casebase::{Problem, Verdict};
use clap::{Args, ValueEnum};

use super::problem;
use super::show::{find, unknown};
use crate::Failure;
use crate::args::{LibraryArgs, SettingsArgs};
use crate::library::Shelf;
use crate::picture;

/// What `cases render` may be told.
#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    /// `region/name` of a case (drawn as authored), or the id of a stored case; with --problem the retrieved one.
    #[arg(value_name = "NAME|ID", required_unless_present = "problem")]
    case: Option<String>,
    /// A situation to draw over the case: a file, - for stdin, or the line of JSON itself.
    #[arg(long, value_name = "FILE|-|JSON")]
    problem: Option<String>,
    /// Where to, an .svg or a .png; the SVG on stdout if left out.
    #[arg(long, value_name = "FILE", value_parser = picture_file)]
    out: Option<PathBuf>,
    /// What the picture is for.
    #[arg(long, value_enum, default_value = "light")]
    theme: ThemeWord,
    #[command(flatten)]
    library: LibraryArgs,
    #[command(flatten)]
    settings: SettingsArgs,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum ThemeWord {
    Light,
    Dark,
    Print,
}

pub(super) fn run(args: &RenderArgs) -> Result<ExitCode, Failure> {
    let chosen = args.settings.choose()?;
    let shelf = Shelf::open(&args.library)?;
    let base = shelf.base();
    let problem = args.problem.as_deref().map(read).transpose()?;
    let case = match (&args.case, &problem) {
        (Some(asked), _) => Some(find(&shelf, asked).ok_or_else(|| unknown(&shelf, asked))?),
        (None, Some(problem)) => {
            casebase::retrieve(&base, problem, &chosen.settings).best.and_then(|best| base.case(best.case))
        }
        (None, None) => None,
    };
    let case = case.ok_or(Failure::NoCaseFits)?;
    let mut verdict = None;
    if let Some(problem) = &problem {
        casebase::explain(&base, problem, &chosen.settings, |id, said| {
            if id == case.id() {
                verdict = Some(said);
            }
        });
        if verdict.is_none() {
            return Err(Failure::OtherGoal(shelf.name(case.id()).to_owned()));
        }
    }
    let overlay = problem.as_ref().zip(verdict.as_ref());
    let settings = &chosen.settings;
    let intent = shelf.intent(case.id()).unwrap_or_default();
    let svg = case_picture(&CasePicture {
        base,
        case,
        name: shelf.name(case.id()),
        intent: &intent,
        overlay: overlay.map(|(problem, verdict): (&Problem, &Verdict)| Overlay {
            problem,
            settings,
            verdict,
        }),
        theme: match args.theme {
            ThemeWord::Light => Theme::Light,
            ThemeWord::Dark => Theme::Dark,
            ThemeWord::Print => Theme::Print,
        },
    });
    if let Some(file) = &args.out {
        picture::write(file, &svg)?;
    } else {
        stdout().lock().write_all(svg.as_bytes()).map_err(Failure::Output)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The problem that the argument holds or names.
fn read(argument: &str) -> Result<Problem, Failure> {
    let text = if argument.trim_start().starts_with('{') {
        argument.to_owned()
    } else if argument == "-" {
        let mut text = String::new();
        stdin().lock().read_to_string(&mut text).map_err(Failure::Input)?;
        text
    } else {
        std::fs::read_to_string(argument)
            .map_err(|error: io::Error| Failure::Problem(format!("cannot read {argument}: {error}")))?
    };
    problem::parse(text.trim()).map_err(|error| Failure::Problem(format!("--problem: {error}")))
}

fn picture_file(text: &str) -> Result<PathBuf, String> {
    picture::named(text, &["svg", "png"])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_faulty_problem_is_told_with_its_place() {
        let error = read(r#"{"ball":[0]}"#).unwrap_err().to_string();
        assert!(error.starts_with("--problem: ball"), "{error}");
    }
}
