//! `onetwo cases explain`: why a case was retrieved and the others were not. For each problem on stdin the
//! verdict on every case listed under the goal: the first check it fails, in the order ball, robot count,
//! thr_c, free path, with its margin; candidates with their rank (docs/case-format.md §3.3, §5.2). Lengths in
//! mm; robots of a case, legs and opponents are counted from 1.

use std::io::{Write, stdin};
use std::process::ExitCode;

use arena::cases::{Answer, Chosen, Explanation, LibraryHandle, NEAREST, candidate, reason, write_line};
use casebase::{CaseBase, Match, Problem, rank_order};
use clap::Args;
use protocol::CaseId;

use super::diff::{self, Difference};
use super::lines::for_each_problem;
use crate::Failure;
use crate::args::{LibraryArgs, SettingsArgs};
use crate::{library, output};

/// Arguments of `cases explain`.
#[derive(Debug, Args)]
pub(crate) struct ExplainArgs {
    #[command(flatten)]
    library: LibraryArgs,
    #[command(flatten)]
    settings: SettingsArgs,
    /// One JSON object a problem instead of a table.
    #[arg(long)]
    json: bool,
    /// Explain every case, not only the candidates and the nearest misses.
    #[arg(long)]
    all: bool,
    /// Compute what would make each losing case win, in JSON and with --all for every case: about 100
    /// retrievals a case.
    #[arg(long, conflicts_with = "diff")]
    what_if: bool,
    /// Only these two, side by side: ids, region/name, or region/name/symmetry.
    #[arg(long, num_args = 2, value_names = ["A", "B"], conflicts_with = "all")]
    diff: Option<Vec<String>>,
}

pub(super) fn run(args: &ExplainArgs) -> Result<ExitCode, Failure> {
    let chosen = args.settings.choose()?;
    let library_handle = library::open(&args.library)?;
    let base = library_handle.base();
    let pair = args.diff.as_deref().map(|pair| -> Result<_, Failure> {
        Ok([
            diff::find(&library_handle, base.len(), &pair[0])?,
            diff::find(&library_handle, base.len(), &pair[1])?,
        ])
    });
    let pair = pair.transpose()?;
    let mut output = output::lines();
    for_each_problem(stdin().lock(), &mut output, |output, number, problem| match problem {
        Ok(problem) => {
            if let Some(pair) = pair {
                let difference = difference(&library_handle, &base, &problem, &chosen, pair);
                return if args.json {
                    write_line(output, &difference)
                } else {
                    difference.write(output, number)
                };
            }
            let mut explanation = Explanation::new(&|id| library_handle.name(id), &base, &problem, &chosen);
            let chosen_rows = explanation.listed_first(args.all);
            // A table is read by the operator, a few problems at a time: it has these lines by default, for a
            // handful of cases.
            let asked = match (args.what_if, args.json) {
                (true, _) => chosen_rows.len(),
                (false, false) => chosen_rows.len().min(explanation.candidates + NEAREST),
                (false, true) => 0,
            };
            if asked > 0 || args.what_if {
                let asked = &chosen_rows[..asked];
                explanation.ask_what_if(&|id| library_handle.name(id), &base, &problem, &chosen, asked);
            }
            if args.json {
                write_line(output, &explanation)
            } else {
                explanation.write_table(output, number, &chosen_rows)
            }
        }
        Err(error) if args.json => write_line(output, &Answer::Malformed { error }),
        Err(error) => writeln!(output, "{error}\n"),
    })?;
    Ok(ExitCode::SUCCESS)
}

/// Two cases on one problem.
fn difference<'a>(
    library_handle: &'a LibraryHandle,
    base: &CaseBase<'_>,
    problem: &Problem,
    chosen: &Chosen,
    pair: [CaseId; 2],
) -> Difference<'a> {
    let mut verdicts = Vec::new();
    casebase::explain(base, problem, &chosen.settings, |id, verdict| verdicts.push((id, verdict)));
    let mut ranking: Vec<&Match> = verdicts.iter().filter_map(|(_, verdict)| candidate(verdict)).collect();
    ranking.sort_by(|a, b| rank_order(a, b, &chosen.settings));
    let chosen_rows = pair.map(|id| {
        let verdict = verdicts.iter().find(|(other, _)| *other == id).map(|(_, verdict)| verdict);
        let rank = ranking.iter().position(|found| found.case == id).map_or(0, |before| before + 1);
        let reason =
            verdict.zip(base.case(id)).map(|(verdict, case)| reason(verdict, rank, &case, problem, chosen));
        (id, verdict, reason.unwrap_or_else(|| "it defends the other goal".to_owned()))
    });
    Difference::new(library_handle, chosen_rows, &chosen.settings)
}
