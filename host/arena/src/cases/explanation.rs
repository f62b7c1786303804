//! `explanation`: why a case was retrieved and the others were not. The verdict on every case listed under
//! the goal: the first check it fails, in the order ball, robot count, thr_c, free path, with its margin;
//! candidates with their rank (docs/case-format.md §3.3, §5.2). Lengths in mm; robots of a case, legs and
//! opponents are counted from 1.

use std::collections::HashMap;
use std::io::{self, Write};

use casebase::{Case, CaseBase, CaseVerdict, Match, Presence, Problem, rank_order};
use protocol::CaseId;
use serde::Serialize;

use super::answer::{as_object, cost, roles, rounded, similarity};
use super::problem::parse;
use super::whatif::WhatIf;
use super::{Chosen, NameOf, counted};

/// Number of cases that are explained without being candidates: those that miss by the least.
pub const NEAREST: usize = 5;

/// The explanation of a problem's line as JSON, over any case base, whose cases have these names; or the
/// error in the line.
pub fn explained_by<'a>(
    base: &CaseBase<'_>,
    name_of: NameOf<'a, '_>,
    chosen: &'a Chosen,
    line: &str,
) -> Result<String, String> {
    let problem = parse(line).map_err(|malformed| malformed.to_string())?;
    let explanation = Explanation::new(name_of, base, &problem, chosen);
    serde_json::to_string(&explanation).map_err(|error| error.to_string())
}

/// Every case's verdict on one problem.
#[derive(Debug, Serialize)]
pub struct Explanation<'a> {
    winner: Option<u16>,
    /// Number of cases that may be played.
    pub candidates: usize,
    cases: Vec<Row<'a>>,
    /// For candidates that lose and the nearest misses (with `--all`: for all): what would make them win.
    /// Only on request.
    #[serde(skip_serializing_if = "Option::is_none")]
    counterfactuals: Option<Vec<WhatIf>>,
    /// Settings that differ from retrieval's defaults; left out where nothing does.
    #[serde(skip_serializing_if = "<[_]>::is_empty", serialize_with = "as_object")]
    settings: &'a [(String, String)],
}

/// One case's verdict.
#[derive(Debug, Serialize)]
struct Row<'a> {
    id: u16,
    case: &'a str,
    symmetry: &'static str,
    verdict: &'static str,
    #[serde(flatten)]
    evidence: Evidence,
}

#[derive(Debug, Serialize)]
#[serde(untagged)]
enum Evidence {
    Candidate {
        rank: usize,
        similarity: f64,
        cost: f64,
        conditions: u8,
        teammates: u8,
        #[serde(rename = "match", serialize_with = "as_object")]
        roles: Vec<(u8, u8)>,
    },
    Ball {
        similarity: f64,
        threshold: f32,
        /// Distance by which the ball would have to be nearer to the case's ball, mm.
        outside_mm: f64,
    },
    Robots {
        needed: usize,
        present: usize,
    },
    OutOfField {
        case_robot: u8,
    },
    TooFar {
        case_robot: u8,
        robot: u8,
        distance_mm: f64,
        over_mm: f64,
    },
    Path {
        leg: usize,
        opponent: usize,
        inside_mm: f64,
    },
    Opponents {
        case_opponent: usize,
        presence: Presence,
        opponent: Option<usize>,
    },
}

impl<'a> Explanation<'a> {
    /// Asks for every case's verdict.
    pub fn new(name_of: NameOf<'a, '_>, base: &CaseBase<'_>, problem: &Problem, chosen: &'a Chosen) -> Self {
        let mut verdicts = Vec::new();
        casebase::explain(base, problem, &chosen.settings, |id, verdict| verdicts.push((id, verdict)));
        let mut ranking: Vec<&Match> =
            verdicts.iter().filter_map(|(_, verdict)| candidate(verdict)).collect();
        ranking.sort_by(|a, b| rank_order(a, b, &chosen.settings));
        let ranks: HashMap<CaseId, usize> = ranking.iter().map(|found| found.case).zip(1..).collect();
        let row = |(id, verdict): &(_, CaseVerdict)| {
            let case = base.case(*id)?;
            let rank = ranks.get(id).copied().unwrap_or(0);
            Some(Row {
                id: id.0,
                case: name_of(*id),
                symmetry: case.symmetry().label(),
                verdict: verdict.label(),
                evidence: Evidence::of(verdict, rank, &case, problem, chosen),
            })
        };
        Self {
            winner: ranking.first().map(|found| found.case.0),
            candidates: ranking.len(),
            cases: verdicts.iter().filter_map(row).collect(),
            counterfactuals: None,
            settings: &chosen.changed,
        }
    }

    /// Rows in the order of the table: candidates by rank, then misses, the nearest first.
    pub fn listed_first(&self, all: bool) -> Vec<usize> {
        let mut order: Vec<_> = (0..self.cases.len()).collect();
        let place = |at: &usize| self.cases[*at].evidence.place();
        order.sort_by(|a, b| place(a).0.cmp(&place(b).0).then(place(a).1.total_cmp(&place(b).1)));
        if !all {
            order.truncate(self.candidates + NEAREST);
        }
        order
    }

    /// Finds what would make the cases of these rows win: about 100 retrievals a case.
    pub fn ask_what_if(
        &mut self,
        name_of: NameOf<'_, '_>,
        base: &CaseBase<'_>,
        problem: &Problem,
        chosen: &Chosen,
        chosen_rows: &[usize],
    ) {
        let what_if = |at: &usize| {
            let id = self.cases[*at].id;
            let found = case_tools::counterfactual(base, problem, &chosen.settings, CaseId(id))?;
            WhatIf::new(name_of, id, &found)
        };
        self.counterfactuals = Some(chosen_rows.iter().filter_map(what_if).collect());
    }

    /// Writes these rows as a table for people.
    pub fn write_table(&self, output: &mut impl Write, line: u64, chosen_rows: &[usize]) -> io::Result<()> {
        let candidates = counted(self.candidates, "candidate");
        match self.cases.iter().find(|row| Some(row.id) == self.winner) {
            Some(row) => writeln!(
                output,
                "line {line}: {} ({}), id {}, of {candidates}",
                row.case, row.symmetry, row.id
            )?,
            None => writeln!(output, "line {line}: no case fits")?,
        }
        for (name, value) in self.settings {
            writeln!(output, "with {name}={value}")?;
        }
        let what_ifs = self.counterfactuals.as_deref().unwrap_or_default();
        let what_ifs: HashMap<u16, &WhatIf> = what_ifs.iter().map(|one| (one.id(), one)).collect();
        let printable_path: Vec<_> = chosen_rows.iter().map(|at| &self.cases[*at]).collect();
        let width = printable_path.iter().map(|row| row.case.chars().count()).fold("case".len(), usize::max);
        writeln!(output, "{:>5}  {:width$}  {:8}  {:9}  why", "id", "case", "symmetry", "verdict")?;
        for row in &printable_path {
            let (id, case, why) = (row.id, row.case, row.evidence.text());
            writeln!(output, "{id:>5}  {case:width$}  {:8}  {:9}  {why}", row.symmetry, row.verdict)?;
            if let Some(what_if) = what_ifs.get(&id) {
                writeln!(output, "{:>5}  {}", "", what_if.text())?;
            }
        }
        if let Some(rest) = self.cases.len().checked_sub(printable_path.len()).filter(|rest| *rest > 0) {
            writeln!(output, "and {} farther off; list them with --all", counted(rest, "case"))?;
        }
        writeln!(output)
    }
}

/// The evidence of one verdict in words, for people; `rank` counts from 1.
pub fn reason(
    verdict: &CaseVerdict,
    rank: usize,
    case: &Case<'_>,
    problem: &Problem,
    chosen: &Chosen,
) -> String {
    Evidence::of(verdict, rank, case, problem, chosen).text()
}

/// The match of a case that may be played.
pub fn candidate(verdict: &CaseVerdict) -> Option<&Match> {
    match verdict {
        CaseVerdict::Candidate(found) => Some(found),
        _ => None,
    }
}

impl Evidence {
    fn of(verdict: &CaseVerdict, rank: usize, case: &Case<'_>, problem: &Problem, chosen: &Chosen) -> Self {
        match verdict {
            CaseVerdict::Candidate(found) => Self::Candidate {
                rank,
                similarity: similarity(found),
                cost: cost(found),
                conditions: found.conditions,
                teammates: found.teammates,
                roles: roles(found),
            },
            CaseVerdict::Ball { similarity, .. } => Self::Ball {
                similarity: rounded(*similarity, 1e4),
                threshold: chosen.settings.threshold,
                outside_mm: ball_outside(case, problem, chosen),
            },
            CaseVerdict::Robots { needed, present } => Self::Robots { needed: *needed, present: *present },
            CaseVerdict::OutOfField { robot } => Self::OutOfField { case_robot: robot.number() },
            CaseVerdict::TooFar { robot, player, distance, margin } => Self::TooFar {
                case_robot: robot.number(),
                robot: player.number(),
                distance_mm: rounded(*distance, 1e2),
                over_mm: rounded(*margin, 1e2),
            },
            CaseVerdict::Path { index, opponent, inside_mm, .. } => {
                Self::Path { leg: index + 1, opponent: opponent + 1, inside_mm: rounded(*inside_mm, 1e2) }
            }
            CaseVerdict::Opponents { scope, presence, opponent } => Self::Opponents {
                case_opponent: scope + 1,
                presence: *presence,
                opponent: opponent.map(|index| index + 1),
            },
        }
    }

    /// Sort key of the table: candidates by rank, misses by mm, then those without a measure.
    fn place(&self) -> (u8, f64) {
        match self {
            Self::Candidate { rank, .. } => (0, *rank as f64),
            Self::Ball { outside_mm: mm, .. }
            | Self::TooFar { over_mm: mm, .. }
            | Self::Path { inside_mm: mm, .. } => (1, *mm),
            Self::Robots { .. } | Self::OutOfField { .. } | Self::Opponents { .. } => (2, 0.0),
        }
    }

    fn text(&self) -> String {
        match self {
            Self::Candidate { rank, similarity, cost, conditions, teammates, roles } => {
                let counts =
                    [counted((*conditions).into(), "condition"), counted((*teammates).into(), "teammate")];
                let roles: Vec<_> =
                    roles.iter().map(|(tm, robot)| format!("tm{tm} = robot {robot}")).collect();
                let (counts, roles) = (counts.join(", "), roles.join(", "));
                format!("rank {rank}: {counts}, similarity {similarity}, cost {cost} mm; {roles}")
            }
            Self::Ball { similarity, threshold, outside_mm } => {
                format!(
                    "similarity {similarity}, threshold {threshold}: the ball lies {outside_mm} mm outside the scope"
                )
            }
            Self::Robots { needed, present } => {
                format!("needs {}, present {present}", counted(*needed, "robot"))
            }
            Self::OutOfField { case_robot } => format!("tm{case_robot}'s place lies outside the field"),
            Self::TooFar { case_robot, robot, distance_mm, over_mm } => {
                format!("tm{case_robot} = robot {robot}: {distance_mm} mm to go, {over_mm} mm too far")
            }
            Self::Path { leg, opponent, inside_mm } => {
                format!("opponent {opponent} stands {inside_mm} mm inside leg {leg}")
            }
            Self::Opponents { case_opponent, opponent, .. } => match opponent {
                Some(opponent) => format!("opponent {opponent} stands where opp{case_opponent} excludes one"),
                None => format!("no opponent stands where opp{case_opponent} requires one"),
            },
        }
    }
}

/// Distance of the ball outside the ball's scope, mm, on the line to its centre.
fn ball_outside(case: &Case<'_>, problem: &Problem, chosen: &Chosen) -> f64 {
    let from_centre = case.shift(problem.ball);
    let exponent = f64::from(case.ball_scope().exponent(from_centre));
    let distance = f64::from(from_centre.x).hypot(f64::from(from_centre.y));
    let edge = (f64::from(chosen.settings.limit()) / exponent).sqrt();
    ((1.0 - edge) * distance * 100.0).round() / 100.0
}
