//! `onetwo cases stats`: which cases carry a library, which are shadowed, and which could go (Smyth & McKenna
//! 2001; definitions in `case_tools::competence`). Suggestions come with their evidence and are never carried
//! out.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::process::ExitCode;

use case_tools::competence::{CompetenceRole, Shared, groups, roles, shared, thin_out};
use case_tools::coverage::{Area, COST_BIN_MM, CaseCounters, Counters, RINGS, VERDICTS};
use clap::Args;
use serde_json::{Value, json};

use super::survey::{SurveyArgs, Trial, class, percent};
use crate::Failure;
use crate::output;

/// Arguments of `cases stats`.
#[derive(Debug, Args)]
pub(crate) struct StatsArgs {
    #[command(flatten)]
    survey: SurveyArgs,
    /// Only this case: `region/name`.
    #[arg(long, value_name = "NAME")]
    case: Option<String>,
    /// One JSON object instead of tables.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &StatsArgs) -> Result<ExitCode, Failure> {
    let trial = Trial::open(&args.survey)?;
    let names = trial.library_handle.names();
    let only = match &args.case {
        None => None,
        Some(asked) => Some(
            names
                .iter()
                .position(|name| name == asked)
                .ok_or_else(|| super::show::unknown(&trial.library_handle, asked))?,
        ),
    };
    let (counters, _) = trial.count()?;
    let pairs = shared(&counters);
    let report = Report { roles: roles(&counters, &pairs), trial: &trial, names, counters: &counters, pairs };
    let mut output = output::lines();
    let written = match (only, args.json) {
        (Some(case), true) => writeln!(output, "{}", report.case_json(case)),
        (Some(case), false) => report.write_case(&mut output, case),
        (None, true) => writeln!(output, "{}", report.as_json()),
        (None, false) => report.write(&mut output),
    };
    written.and_then(|()| output.flush()).map_err(Failure::Output)?;
    Ok(ExitCode::SUCCESS)
}

struct Report<'r> {
    trial: &'r Trial<'r>,
    names: Vec<String>,
    counters: &'r Counters,
    pairs: Vec<Shared>,
    roles: Vec<CompetenceRole>,
}

impl Report<'_> {
    fn write(&self, output: &mut impl Write) -> io::Result<()> {
        let counters = self.counters;
        let width = self.names.iter().map(String::len).max().unwrap_or(4);
        writeln!(
            output,
            "{}: {} problems, {} without a case\n",
            self.trial.library_handle.league(),
            counters.problems,
            counters.none
        )?;
        writeln!(
            output,
            "{:width$}  {:9}  {:>9}  {:>7}  {:>6}  {:>6}  {:>6}  {:>6}  beaten most by",
            "case", "role", "candidate", "wins", "loss", "ball", "thr_c", "path"
        )?;
        for case in self.by_loss() {
            let counts = &counters.cases[case];
            writeln!(
                output,
                "{:width$}  {:9}  {:>9}  {:>5.1} %  {:>6}  {:>6}  {:>6}  {:>6}  {}",
                self.names[case],
                self.roles[case].label(),
                counts.candidate(),
                percent(counts.wins, counters.won()),
                counts.sole,
                counts.verdicts[0],
                counts.verdicts[3],
                counts.verdicts[4],
                self.candidate(counts).map_or_else(String::new, |(name, times)| format!("{name} ({times})"))
            )?;
        }
        writeln!(output, "\nloss: problems left without any case when this file is deleted; least first")?;
        let cost = |bin: usize| format!("{:.0}", bin as f32 * COST_BIN_MM);
        writeln!(output, "\nwinners by similarity: {}", counted(&RINGS.map(str::to_owned), &counters.rings))?;
        let bins: Vec<String> = (0..counters.costs.len()).map(cost).collect();
        writeln!(output, "winners by cost from mm: {}", counted(&bins, &counters.costs))?;
        writeln!(
            output,
            "individual {:.1} %, cooperative {:.1} % of the wins",
            100.0 - self.cooperative(),
            self.cooperative()
        )?;
        writeln!(output, "\ncompetence groups")?;
        for (cases, problems) in groups(counters) {
            let names: Vec<&str> = cases.iter().map(|case| self.names[usize::from(*case)].as_str()).collect();
            writeln!(output, "{problems:>8} problems, {} cases: {}", names.len(), names.join(", "))?;
        }
        let twins: Vec<_> = self.near_twins().collect();
        if !twins.is_empty() {
            writeln!(output, "\nnear twins (candidates in nearly the same problems)")?;
        }
        for pair in twins {
            let [a, b] = pair.cases.map(|case| &self.names[usize::from(case)]);
            writeln!(output, "{:>5.1} %  {a}, {b}", 100.0 * pair.likeness())?;
        }
        writeln!(output, "\ncould go one after another for at most {LOSS_MAX_PER_MILLE} ‰ of all problems")?;
        for step in thin_out(counters, counters.problems * LOSS_MAX_PER_MILLE / 1000) {
            let name = &self.names[usize::from(step.case)];
            writeln!(output, "{name:width$}  loses {} (so far {})", step.lost, step.lost_so_far)?;
        }
        writeln!(output, "\nhints")?;
        for case in 0..self.names.len() {
            for hint in hints(&counters.cases[case], counters) {
                writeln!(output, "{:width$}  {hint}", self.names[case])?;
            }
        }
        Ok(())
    }

    fn write_case(&self, output: &mut impl Write, case: usize) -> io::Result<()> {
        let counts = &self.counters.cases[case];
        let (work, opponents) = class(&self.trial.library_handle, case);
        writeln!(
            output,
            "{}: {}, {work}, {opponents} opponents",
            self.names[case],
            self.roles[case].label()
        )?;
        writeln!(
            output,
            "problems by how far it came: {}",
            counted(&VERDICTS.map(str::to_owned), &counts.verdicts)
        )?;
        writeln!(
            output,
            "wins: {} ({:.1} % of all)",
            counts.wins,
            percent(counts.wins, self.counters.won())
        )?;
        writeln!(output, "candidate by similarity: {}", counted(&RINGS.map(str::to_owned), &counts.rings))?;
        writeln!(output, "winner by similarity: {}", counted(&RINGS.map(str::to_owned), &counts.rings_won))?;
        let areas = Area::ALL.map(|area| area.label().to_owned());
        writeln!(output, "lost if deleted: {} ({})", counts.sole, counted(&areas, &counts.sole_in))?;
        let mut rivals: Vec<_> = counts.beaten_by.iter().collect();
        rivals.sort_by_key(|(candidate, times)| (std::cmp::Reverse(**times), **candidate));
        for (candidate, times) in rivals {
            writeln!(output, "beaten {times} times by {}", self.names[usize::from(*candidate)])?;
        }
        for hint in hints(counts, self.counters) {
            writeln!(output, "hint: {hint}")?;
        }
        Ok(())
    }

    fn as_json(&self) -> Value {
        let counters = self.counters;
        let name = |case: u16| self.names[usize::from(case)].as_str();
        let group = |(cases, problems): (Vec<u16>, u64)| json!({"problems": problems, "cases": cases.into_iter().map(name).collect::<Vec<_>>()});
        let step = |step: case_tools::competence::Deletion| json!({"case": name(step.case), "lost": step.lost, "lost_so_far": step.lost_so_far});
        json!({
            "league": self.trial.library_handle.league(),
            "seed": self.trial.seed(),
            "settings": self.trial.chosen.changed.iter().cloned().collect::<BTreeMap<_, _>>(),
            "problems": counters.problems,
            "none": counters.none,
            "rings": object(&RINGS, &counters.rings),
            "costs": {"bin_mm": COST_BIN_MM, "counts": counters.costs},
            "cooperative_percent": self.cooperative(),
            "cases": self.by_loss().into_iter().map(|case| self.case_json(case)).collect::<Vec<_>>(),
            "groups": groups(counters).into_iter().map(group).collect::<Vec<_>>(),
            "near_twins": self.near_twins()
                .map(|pair| json!({"cases": pair.cases.map(name), "likeness": pair.likeness()})).collect::<Vec<_>>(),
            "thinned": thin_out(counters, counters.problems * LOSS_MAX_PER_MILLE / 1000).into_iter().map(step).collect::<Vec<_>>(),
        })
    }

    fn case_json(&self, case: usize) -> Value {
        let counts = &self.counters.cases[case];
        let rivals = counts
            .beaten_by
            .iter()
            .map(|(candidate, times)| (self.names[usize::from(*candidate)].clone(), *times));
        json!({
            "case": self.names[case],
            "role": self.roles[case].label(),
            "verdicts": object(&VERDICTS, &counts.verdicts),
            "wins": counts.wins,
            "beaten_by": rivals.collect::<BTreeMap<_, _>>(),
            "lost_if_deleted": counts.sole,
            "lost_in": object(&Area::ALL.map(Area::label), &counts.sole_in),
            "rings": object(&RINGS, &counts.rings),
            "rings_won": object(&RINGS, &counts.rings_won),
            "would_fill": counts.would_fill,
            "hints": hints(counts, self.counters),
        })
    }

    /// Authored cases, the least loss first (ties: the one that covers fewest).
    fn by_loss(&self) -> Vec<usize> {
        let mut cases: Vec<usize> = (0..self.names.len()).collect();
        cases.sort_by_key(|case| {
            (self.counters.cases[*case].sole, self.counters.cases[*case].candidate(), *case)
        });
        cases
    }

    fn candidate(&self, counts: &CaseCounters) -> Option<(&str, u64)> {
        let (candidate, times) = counts
            .beaten_by
            .iter()
            .max_by_key(|(candidate, times)| (**times, std::cmp::Reverse(**candidate)))?;
        Some((&self.names[usize::from(*candidate)], *times))
    }

    fn near_twins(&self) -> impl Iterator<Item = &Shared> {
        self.pairs.iter().filter(|pair| pair.likeness() >= NEAR_TWINS)
    }

    /// Share of the wins, percent.
    fn cooperative(&self) -> f64 {
        let wins = |(case, counts): (usize, &CaseCounters)| match class(&self.trial.library_handle, case) {
            ("cooperative", _) => counts.wins,
            _ => 0,
        };
        percent(self.counters.cases.iter().enumerate().map(wins).sum(), self.counters.won())
    }
}

/// Suggested changes to a case, with their reasons.
fn hints(case: &CaseCounters, counters: &Counters) -> Vec<String> {
    let mut hints = Vec::new();
    let (candidate, wins) = (case.candidate(), case.wins);
    if candidate == 0 {
        hints.push(format!(
            "never a candidate in {} problems: enlarge its scope, or take it out",
            counters.problems
        ));
    } else if wins * SHADOWED_ONE_WIN_IN < candidate {
        hints.push(format!("shadowed: {wins} wins in {candidate} problems where it is a candidate"));
    }
    if case.rings[3] >= HINT_PROBLEMS_MIN && case.rings_won[3] == 0 && wins > 0 {
        hints.push(format!(
            "shrink its ball scope? a candidate {} times in the ring L, never a winner there",
            case.rings[3]
        ));
    }
    if case.would_fill >= HINT_PROBLEMS_MIN && case.would_fill * WORTH_ENLARGING >= counters.none {
        let share = percent(case.would_fill, counters.none);
        hints.push(format!(
            "enlarge its ball scope? a fifth more fills {} of the problems without a case ({share:.1} %)",
            case.would_fill
        ));
    }
    hints
}

fn counted(labels: &[String], counts: &[u64]) -> String {
    let pairs = labels.iter().zip(counts).filter(|(_, count)| **count > 0);
    pairs.map(|(label, count)| format!("{label} {count}")).collect::<Vec<_>>().join(", ")
}

fn object(labels: &[&str], counts: &[u64]) -> Value {
    labels
        .iter()
        .zip(counts)
        .map(|(label, count)| ((*label).to_owned(), json!(count)))
        .collect::<serde_json::Map<_, _>>()
        .into()
}

/// A case with fewer wins than one in this number of candidacies is shadowed: another case wins nearly all of
/// its problems.
const SHADOWED_ONE_WIN_IN: u64 = 50;
/// Least number of problems for a hint: fewer may be chance.
const HINT_PROBLEMS_MIN: u64 = 20;
/// A larger scope is worth a hint where it fills at least one in this number of the problems without a case.
const WORTH_ENLARGING: u64 = 25;
/// Jaccard's index of coverage sets from which two cases count as near twins.
const NEAR_TWINS: f64 = 0.8;
/// Problems that removing cases may lose, per thousand.
const LOSS_MAX_PER_MILLE: u64 = 1;
