//! `onetwo cases check`: soundness of a library. Every error and warning as `file:line: error[CODE]: message;
//! hint`, then one line of summary a league (docs/case-format.md §1.2), or with `--json` one list of
//! findings. Exit 1 on errors, and with `--strict` on warnings.

use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

use arena::cases::{counted, write_line};
use case_library::{LEAGUES, League};
use case_tools::{CODES, Files, Finding, Library, Severity, never_retrieved};
use clap::Args;
use serde::Serialize;

use crate::Failure;
use crate::args::DirectoryArgs;
use crate::output;

use super::failure::SurveyError;
use super::survey;

/// Arguments of `cases check`.
#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    directory: DirectoryArgs,
    /// Warnings fail too.
    #[arg(long)]
    strict: bool,
    /// One JSON list of findings instead of lines.
    #[arg(long)]
    json: bool,
    /// Number of problems that are drawn to find cases that are never retrieved.
    #[arg(long, value_name = "N", default_value_t = 20_000, value_parser = clap::value_parser!(u64).range(..=100_000_000))]
    problems: u64,
    /// Random seed: the same seed draws the same problems.
    #[arg(short, long, default_value_t = 1)]
    seed: u64,
    /// Explain a code of a finding, or `all` of them, and check nothing.
    #[arg(long, value_name = "CODE", value_parser = known_code)]
    explain: Option<String>,
}

/// One finding as data.
#[derive(Debug, Serialize)]
struct Row<'a> {
    league: &'a str,
    severity: String,
    code: &'a str,
    file: String,
    line: u32,
    message: &'a str,
    #[serde(rename = "mend")]
    hint: &'a str,
}

const ALL_CODES: &str = "all";

fn known_code(text: &str) -> Result<String, String> {
    if text == ALL_CODES || case_tools::entry(text).is_some() {
        return Ok(text.to_owned());
    }
    let codes: Vec<_> = CODES.iter().map(|entry| entry.code).collect();
    Err(format!("no such code; take all or one of: {}", codes.join(", ")))
}

fn explain(code: &str, output: &mut impl Write) -> io::Result<()> {
    for entry in CODES.iter().filter(|entry| code == ALL_CODES || entry.code == code) {
        writeln!(output, "{}[{}]: {}", entry.severity, entry.code, entry.meaning)?;
    }
    output.flush()
}

pub(super) fn run(args: &CheckArgs) -> Result<ExitCode, Failure> {
    if let Some(code) = &args.explain {
        let mut output = output::lines();
        explain(code, &mut output).and_then(|()| output.flush()).map_err(Failure::Output)?;
        return Ok(ExitCode::SUCCESS);
    }
    let reports = match &args.directory.library {
        Some(directory) => vec![Report::of(directory, args)?],
        None => LEAGUES.iter().map(|league| Report::built_in(league, args)).collect::<Result<_, _>>()?,
    };
    let mut output = output::lines();
    let written = if args.json {
        let rows: Vec<_> = reports.iter().flat_map(Report::rows).collect();
        write_line(&mut output, &rows)
    } else {
        reports.iter().try_for_each(|report| report.write(&mut output))
    };
    written.and_then(|()| output.flush()).map_err(Failure::Output)?;
    let fails = |finding: &Finding| args.strict || finding.severity == Severity::Error;
    let failed = reports.iter().flat_map(|report| &report.findings).any(fails);
    Ok(if failed { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

/// Findings that only drawn problems reveal; the same for any number of threads.
fn doubts_of_draw(library: &Library, args: &CheckArgs) -> Result<Vec<Finding>, Failure> {
    let fail = |error| SurveyError::Setting(error);
    let (survey, sampler) = (library.survey().map_err(fail)?, library.sampler(args.seed));
    let counters = survey::counters(&survey, args.problems, |number| Some(sampler.problem(number)));
    Ok(never_retrieved(library, &counters))
}

/// Findings of the check of one library.
struct Report {
    league: String,
    /// Case files and stored cases, unless the library was refused.
    sizes: Option<[usize; 2]>,
    findings: Vec<Finding>,
}

impl Report {
    fn of(directory: &Path, args: &CheckArgs) -> Result<Self, Failure> {
        if !directory.is_dir() {
            return Err(Failure::missing_directory(directory));
        }
        let absolute = directory.canonicalize().unwrap_or_else(|_| directory.to_owned());
        let league = absolute.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Self::new(league, crate::library::load(directory), args)
    }

    /// From the texts in this program; the build refused errors, so only warnings are left.
    fn built_in(league: &League, args: &CheckArgs) -> Result<Self, Failure> {
        let cases: Vec<_> = league.names.iter().copied().zip(league.sources.iter().copied()).collect();
        let files = Files::from_texts(league.name, league.rules, &cases);
        Self::new(league.name.to_owned(), case_tools::build(&files), args)
    }

    fn new(
        league: String,
        outcome: Result<Library, Vec<Finding>>,
        args: &CheckArgs,
    ) -> Result<Self, Failure> {
        Ok(match outcome {
            Ok(mut library) => {
                library.note(doubts_of_draw(&library, args)?);
                let sizes = Some([library.names.len(), library.base().len()]);
                Self { league: library.league, sizes, findings: library.findings }
            }
            Err(findings) => Self { league, sizes: None, findings },
        })
    }

    fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.findings.iter().map(|finding| Row {
            league: &self.league,
            severity: finding.severity.to_string(),
            code: finding.code,
            file: finding.file.display().to_string(),
            line: finding.line,
            message: &finding.message,
            hint: &finding.hint,
        })
    }

    fn write(&self, output: &mut impl Write) -> io::Result<()> {
        for finding in &self.findings {
            writeln!(output, "{finding}")?;
        }
        let of = |severity| self.findings.iter().filter(|finding| finding.severity == severity).count();
        let counts = [(of(Severity::Error), "error"), (of(Severity::Warning), "warning")];
        let [errors, warnings] = counts.map(|(count, what)| counted(count, what));
        let what = match self.sizes {
            Some([files, stored]) => {
                format!("{}, {}", counted(files, "case file"), counted(stored, "stored case"))
            }
            None => "refused".to_owned(),
        };
        writeln!(output, "{}: {what}; {errors}, {warnings}", self.league)
    }
}
