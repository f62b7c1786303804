//! `onetwo cases coverage`: regions of the field where a library has no case. A heat map over the ball's
//! place, attack frame (the goal attacked is on the right), shares by area, region and class, and the worst
//! holes as problems.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use case_tools::coverage::{Area, CellCounters, Cells, Counters, VERDICTS};
use casebase::PointMm;
use clap::{Args, ValueEnum};
use feed::recording::problem_line;
use figures::{HeatMap, Scale, Theme, heat_maps};
use serde_json::{Value, json};

use super::survey::{SurveyArgs, Trial, class, percent, region};
use crate::Failure;
use crate::destination::{self, FileKind};
use crate::output;
use crate::picture::{self, SnapshotError};

/// Arguments of `cases coverage`.
#[derive(Debug, Args)]
pub(crate) struct CoverageArgs {
    #[command(flatten)]
    survey: SurveyArgs,
    /// Print the N worst holes as problems, one a line, as `cases retrieve` reads them; one of each cell, the
    /// largest share of problems without a case first, with --from the most such problems. Balls that no
    /// field player may play (out, in a goal, in a defence area) are left out.
    #[arg(long, value_name = "N", num_args = 0..=1, default_missing_value = "10", conflicts_with = "json")]
    gaps: Option<usize>,
    /// Print one JSON object instead of maps and tables.
    #[arg(long)]
    json: bool,
    /// Write the map as a figure (FILE.svg, FILE.png), or every cell as a table (FILE.csv).
    #[arg(short, long, value_name = "FILE", value_parser = picture_file)]
    out: Option<PathBuf>,
    /// What the figure displays.
    #[arg(long, value_enum, default_value = "holes")]
    map: Map,
}

/// Quantity that is drawn over the field.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Map {
    /// The share of problems without a candidate.
    Holes,
    /// The mean number of candidates.
    Candidates,
    /// The entropy of the retrieved case.
    Entropy,
    /// All three, beside each other.
    All,
}

pub(super) fn run(args: &CoverageArgs) -> Result<ExitCode, Failure> {
    if let Some(file) = &args.out {
        let kind = if picture::has_extension(file, "csv") { FileKind::Csv } else { picture::kind(file) };
        destination::check(&[(file, kind)], &args.survey.inputs())?;
    }
    let mut trial = Trial::open(&args.survey)?;
    if args.gaps.is_some() {
        trial.only_playable();
    }
    let (counters, cells) = trial.count()?;
    if let Some(file) = &args.out {
        let is_table = picture::has_extension(file, "csv");
        let text = if is_table { csv(&counters, cells) } else { drawn(&trial, &counters, cells, args.map) };
        if is_table {
            destination::write(file, FileKind::Csv, text.as_bytes())?;
        } else {
            picture::write(file, &text)?;
        }
    }
    let mut output = output::lines();
    let written = match (args.gaps, args.json) {
        (Some(count), _) => write_gaps(&mut output, &trial, &counters, count),
        (None, true) => writeln!(output, "{}", as_json(&trial, &counters, cells)),
        (None, false) => write_text(&mut output, &trial, &counters, cells),
    };
    written.and_then(|()| output.flush()).map_err(Failure::Output)?;
    Ok(ExitCode::SUCCESS)
}

/// The cells with holes, the largest share first (ties: more holes, then the lower cell); of played problems
/// the most holes first: a place counts by how often a team was there without a case.
fn worst(counters: &Counters, played: bool) -> Vec<(usize, &CellCounters)> {
    let mut cells: Vec<_> = counters.cells.iter().enumerate().filter(|(_, cell)| cell.none > 0).collect();
    // a/b against c/d without a division: a·d against c·b.
    let share = |a: &CellCounters, b: &CellCounters| (b.none * a.problems).cmp(&(a.none * b.problems));
    cells.sort_by(|(i, a), (j, b)| {
        let (most, largest) = (b.none.cmp(&a.none), share(a, b));
        let order = if played { most.then(largest) } else { largest.then(most) };
        order.then(i.cmp(j))
    });
    cells
}

fn write_gaps(
    output: &mut impl Write,
    trial: &Trial<'_>,
    counters: &Counters,
    count: usize,
) -> io::Result<()> {
    let holes = worst(counters, trial.is_recorded())
        .into_iter()
        .filter_map(|(_, cell)| trial.problem(cell.first_hole?));
    for problem in holes.take(count) {
        writeln!(output, "{}", problem_line(&problem))?;
    }
    Ok(())
}

fn write_text(
    output: &mut impl Write,
    trial: &Trial<'_>,
    counters: &Counters,
    cells: Cells,
) -> io::Result<()> {
    let total = counters.problems;
    writeln!(
        output,
        "{}: {total} problems, {:.1} % with a case, {} without; {:.2} candidates each\n",
        trial.library_handle.league(),
        percent(counters.won(), total),
        counters.none,
        counters.candidates as f64 / total as f64
    )?;
    writeln!(output, "no case ({} mm cells; attack to the right)", cells.edge_mm)?;
    write_map(output, counters, cells, |cell| match 100 * cell.none / cell.problems {
        0 if cell.none == 0 => '·',
        0..5 => '░',
        5..20 => '▒',
        20..50 => '▓',
        _ => '█',
    })?;
    writeln!(
        output,
        "· none  ░ < 5 %  ▒ < 20 %  ▓ < 50 %  █ more  (blank: no problem)\n\ncandidates, mean (+: 9.5 or more)"
    )?;
    write_map(output, counters, cells, |cell| digit(cell.candidates as f64 / cell.problems as f64))?;
    writeln!(output, "\nentropy of the winner, bits (0: one case always wins)")?;
    write_map(output, counters, cells, |cell| digit(cell.entropy_bits()))?;
    writeln!(output, "\n{:10}  {:>8}  {:>7}", "ball in", "problems", "no case")?;
    for (area, counts) in Area::ALL.into_iter().zip(counters.areas) {
        let none = percent(counts.none, counts.problems);
        writeln!(output, "{:10}  {:>8}  {none:>5.1} %", area.label(), counts.problems)?;
    }
    if counters.none > 0 {
        writeln!(output, "\nwithout a case, the best one failed at")?;
        for (label, count) in VERDICTS.into_iter().zip(counters.furthest).filter(|(_, count)| *count > 0) {
            writeln!(output, "{label:12}  {count:>6}  {:>5.1} %", percent(count, counters.none))?;
        }
    }
    for (title, shares) in [("region", by_region(trial, counters)), ("class", by_class(trial, counters))] {
        let width = shares.iter().map(|(name, ..)| name.len()).fold(title.len(), usize::max);
        writeln!(output, "\n{title:width$}  {:>5}  {:>7}", "cases", "wins")?;
        for (name, cases, wins) in shares {
            writeln!(output, "{name:width$}  {cases:>5}  {:>5.1} %", percent(wins, counters.won()))?;
        }
    }
    let names = trial.library_handle.names();
    let width = names.iter().map(String::len).max().unwrap_or(4);
    writeln!(output, "\n{:width$}  {:>7}", "case", "wins")?;
    for authored in winners(counters) {
        let wins = percent(counters.cases[authored].wins, counters.won());
        writeln!(output, "{:width$}  {wins:>5.1} %", names[authored])?;
    }
    Ok(())
}

/// Rows from +y down, as the field is seen from above.
fn write_map(
    output: &mut impl Write,
    counters: &Counters,
    cells: Cells,
    sign: impl Fn(&CellCounters) -> char,
) -> io::Result<()> {
    for row in counters.cells.chunks(cells.columns).rev() {
        let signs = row.iter().map(|cell| if cell.problems == 0 { ' ' } else { sign(cell) });
        let line: String = signs.flat_map(|sign| [sign, sign]).collect();
        writeln!(output, "|{line}|")?;
    }
    Ok(())
}

fn digit(value: f64) -> char {
    char::from_digit(value.round() as u32, 10).unwrap_or('+')
}

/// Authored cases, the one with most wins first.
fn winners(counters: &Counters) -> Vec<usize> {
    let mut cases: Vec<usize> = (0..counters.cases.len()).collect();
    cases.sort_by_key(|case| (std::cmp::Reverse(counters.cases[*case].wins), *case));
    cases
}

/// Name, cases and wins of each group.
type Shares = Vec<(String, usize, u64)>;

fn by_region(trial: &Trial<'_>, counters: &Counters) -> Shares {
    let names = trial.library_handle.names();
    grouped(counters, |authored| region(&names[authored]).to_owned())
}

fn by_class(trial: &Trial<'_>, counters: &Counters) -> Shares {
    grouped(counters, |authored| {
        let (work, opponents) = class(&trial.library_handle, authored);
        format!("{work}, {opponents} opponent{}", if opponents == 1 { "" } else { "s" })
    })
}

fn grouped(counters: &Counters, name: impl Fn(usize) -> String) -> Shares {
    let mut groups = std::collections::BTreeMap::<String, (usize, u64)>::new();
    for (authored, case) in counters.cases.iter().enumerate() {
        let group = groups.entry(name(authored)).or_default();
        group.0 += 1;
        group.1 += case.wins;
    }
    groups.into_iter().map(|(name, (cases, wins))| (name, cases, wins)).collect()
}

fn as_json(trial: &Trial<'_>, counters: &Counters, cells: Cells) -> Value {
    let names = trial.library_handle.names();
    let share = |wins: u64| wins as f64 / counters.won().max(1) as f64;
    let groups = |shares: Shares| -> Vec<Value> {
        let row =
            |(name, cases, wins)| json!({"name": name, "cases": cases, "wins": wins, "share": share(wins)});
        shares.into_iter().map(row).collect()
    };
    let cell = |(index, cell): (usize, &CellCounters)| {
        let PointMm { x, y } = cells.middle(index);
        json!({"middle": [x, y], "problems": cell.problems, "none": cell.none, "candidates": cell.candidates,
            "entropy_bits": cell.entropy_bits()})
    };
    json!({
        "league": trial.library_handle.league(),
        "seed": trial.seed(),
        "settings": trial.chosen.changed.iter().cloned().collect::<std::collections::BTreeMap<_, _>>(),
        "problems": counters.problems,
        "none": counters.none,
        "candidates": counters.candidates,
        "furthest": VERDICTS.into_iter().zip(counters.furthest).collect::<std::collections::BTreeMap<_, _>>(),
        "areas": Area::ALL.into_iter().zip(counters.areas)
            .map(|(area, counts)| json!({"area": area.label(), "problems": counts.problems, "none": counts.none}))
            .collect::<Vec<_>>(),
        "regions": groups(by_region(trial, counters)),
        "classes": groups(by_class(trial, counters)),
        "cases": winners(counters).into_iter()
            .map(|case| json!({"case": names[case], "wins": counters.cases[case].wins, "share": share(counters.cases[case].wins)}))
            .collect::<Vec<_>>(),
        "grid": {"columns": cells.columns, "rows": cells.rows, "edge_mm": cells.edge_mm},
        "cells": counters.cells.iter().enumerate().map(cell).collect::<Vec<_>>(),
    })
}

fn csv(counters: &Counters, cells: Cells) -> String {
    let mut text = "x_mm,y_mm,problems,none,candidates,entropy_bits\n".to_owned();
    for (index, cell) in counters.cells.iter().enumerate() {
        let PointMm { x, y } = cells.middle(index);
        let CellCounters { problems, none, candidates, .. } = cell;
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{x},{y},{problems},{none},{candidates},{:.4}", cell.entropy_bits());
    }
    text
}

fn drawn(trial: &Trial<'_>, counters: &Counters, cells: Cells, map: Map) -> String {
    let kinds = match map {
        Map::All => vec![Map::Holes, Map::Candidates, Map::Entropy],
        one => vec![one],
    };
    let caption = format!(
        "{} problems, {:.1} % with a case. Cells of {} mm over the ball's place; the goal attacked is on the right.",
        counters.problems,
        percent(counters.won(), counters.problems),
        cells.edge_mm
    );
    let panels: Vec<_> = kinds.into_iter().map(|map| Panel::of(map, trial, counters)).collect();
    let corner = |count: usize| count as i32 * cells.edge_mm / 2;
    let (x, y) = (corner(cells.columns), corner(cells.rows));
    let maps: Vec<_> = panels
        .iter()
        .map(|panel| HeatMap {
            title: &panel.title,
            caption: &caption,
            field: trial.library_handle.base().field(),
            area: [PointMm::new(-x, -y), PointMm::new(x, y)],
            columns: cells.columns,
            rows: cells.rows,
            values: &panel.values,
            scale: Scale::Continuous { low: 0.0, high: panel.highest, unit: panel.unit },
            theme: Theme::default(),
        })
        .collect();
    heat_maps(&maps)
}

/// One map: a value for each cell that had a problem.
struct Panel {
    title: String,
    unit: &'static str,
    values: Vec<Option<f64>>,
    highest: f64,
}

impl Panel {
    fn of(map: Map, trial: &Trial<'_>, counters: &Counters) -> Self {
        let (what, unit) = match map {
            Map::Holes | Map::All => ("problems without a case", " %"),
            Map::Candidates => ("candidates, mean", ""),
            Map::Entropy => ("entropy of the winner", " bits"),
        };
        let value = |cell: &CellCounters| {
            let problems = cell.problems as f64;
            (cell.problems > 0).then(|| match map {
                Map::Holes | Map::All => 100.0 * cell.none as f64 / problems,
                Map::Candidates => cell.candidates as f64 / problems,
                Map::Entropy => cell.entropy_bits(),
            })
        };
        let values: Vec<_> = counters.cells.iter().map(value).collect();
        let highest = values.iter().flatten().copied().fold(1.0, f64::max).ceil();
        Self { title: format!("{}: {what}", trial.library_handle.league()), unit, values, highest }
    }
}

fn picture_file(text: &str) -> Result<PathBuf, SnapshotError> {
    picture::named(text, &["svg", "png", "csv"])
}
