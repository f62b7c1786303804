//! `row`: one row of `matches.csv`: the two teams, and every measure of both sides.

use std::collections::BTreeMap;

use host::strategy::counters::{CapCounters, PlayCounters};
use serde::{Deserialize, Serialize};

use super::match_team::MatchTeam;
use super::plan::Planned;
use super::{MatchIdentity, passes};
use crate::store::{Difference, Row};
use arena::game::{GameReport, TeamReport};

/// Identity and measures of one match.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "Line", into = "Line")]
pub struct MatchRow {
    /// Number in the plan, from 0.
    pub number: usize,
    /// The team whose numbers come first.
    pub own: MatchTeam,
    /// The team that it played against.
    pub opponent: MatchTeam,
    /// Whether the first of them played blue.
    pub own_is_blue: bool,
    /// Seed that replays it.
    pub seed: u64,
    /// Share of the match in which the ball was in play.
    pub ball_in_play: f32,
    /// Measures of the first team and of its opponent.
    pub sides: [MatchSide; 2],
    /// Equal for equal matches.
    pub trace_hash: String,
}

/// Measures of one team in a match.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MatchSide {
    /// Goals of the team.
    pub goals: u32,
    /// Seconds in play with the ball in the other team's half.
    pub other_half_s: f32,
    /// Shots at the goal.
    pub shots: u32,
    /// Shots that a keeper had to stop, that hit a post, or went in.
    pub chances: u32,
    /// Seconds with the ball.
    pub possession_s: f32,
    /// Number of passes that arrived.
    pub passes: u32,
    /// Balls lost to the other team.
    pub losses: u32,
    /// Ends of possessions, where kicks went, what shots were worth, and left balls: `end.shot:3
    /// kick.2-3/4-5/team:2 shot.volley:1 left-ball:1`.
    pub attack: String,
    /// Passes of restarts as the host followed them, by kick and fate: `flat.received:3 chip.out:1`.
    pub restart_passes: String,
    /// Their P(we have it) by tenths: tenth, passes, sum of P(we have it), received, as in `9:12:11.2:10`.
    pub calibration: String,
    /// Passes of the Coerce and Attack Planner.
    pub cap: CapCounters,
    /// Number of changes of a robot's role within a phase.
    pub role_changes: u32,
    /// Offences: `kind:number`, a blank between two.
    pub fouls: String,
    /// Plays of every case and what followed, in the form of
    /// [`CaseTable::column`](arena::ledger::CaseTable::column).
    pub cases: String,
}

/// Makes [`Line`] of a table of columns: name, type and place in a row or in one of its sides.
macro_rules! columns {
    (($row:ident, $own:ident, $theirs:ident) $($column:ident: $type:ty = $place:expr;)*) => {
        /// A row as the file has it.
        #[derive(Clone, Serialize, Deserialize)]
        struct Line {
            $($column: $type,)*
        }

        impl From<MatchRow> for Line {
            fn from($row: MatchRow) -> Self {
                let [$own, $theirs] = $row.sides;
                Self { $($column: $place,)* }
            }
        }

        impl From<Line> for MatchRow {
            fn from(line: Line) -> Self {
                let [mut $own, mut $theirs] = [MatchSide::default(), MatchSide::default()];
                let mut $row = Self::empty();
                $($place = line.$column;)*
                $row.sides = [$own, $theirs];
                $row
            }
        }
    };
}

columns! {
    (row, own, theirs)
    number: usize = row.number;
    own: MatchTeam = row.own;
    opponent: MatchTeam = row.opponent;
    own_is_blue: bool = row.own_is_blue;
    seed: u64 = row.seed;
    goals: u32 = own.goals;
    goals_against: u32 = theirs.goals;
    ball_in_play: f32 = row.ball_in_play;
    their_half_s: f32 = own.other_half_s;
    own_half_s: f32 = theirs.other_half_s;
    shots: u32 = own.shots;
    shots_against: u32 = theirs.shots;
    chances: u32 = own.chances;
    chances_against: u32 = theirs.chances;
    possession_s: f32 = own.possession_s;
    possession_against_s: f32 = theirs.possession_s;
    passes: u32 = own.passes;
    passes_against: u32 = theirs.passes;
    losses: u32 = own.losses;
    losses_against: u32 = theirs.losses;
    attack: String = own.attack;
    attack_against: String = theirs.attack;
    restart_passes: String = own.restart_passes;
    restart_passes_against: String = theirs.restart_passes;
    calibration: String = own.calibration;
    calibration_against: String = theirs.calibration;
    cap_attempts: u32 = own.cap.attempts;
    cap_successes: u32 = own.cap.successes;
    cap_reuses: u32 = own.cap.reuses;
    cap_reuse_successes: u32 = own.cap.reuse_successes;
    cap_attempts_against: u32 = theirs.cap.attempts;
    cap_successes_against: u32 = theirs.cap.successes;
    cap_reuses_against: u32 = theirs.cap.reuses;
    cap_reuse_successes_against: u32 = theirs.cap.reuse_successes;
    role_changes: u32 = own.role_changes;
    role_changes_against: u32 = theirs.role_changes;
    fouls: String = own.fouls;
    fouls_against: String = theirs.fouls;
    trace_hash: String = row.trace_hash;
    cases: String = own.cases;
    cases_against: String = theirs.cases;
}

impl MatchRow {
    pub(super) fn new(planned: &Planned, report: &GameReport) -> Self {
        let [blue, yellow] = [
            MatchSide::new(&report.metrics.blue, report.score.blue, &report.fouls.blue),
            MatchSide::new(&report.metrics.yellow, report.score.yellow, &report.fouls.yellow),
        ];
        Self {
            number: planned.number,
            own: planned.pairing.own,
            opponent: planned.pairing.opponent,
            own_is_blue: planned.own_is_blue,
            seed: planned.seed,
            ball_in_play: report.ball_in_play,
            sides: if planned.own_is_blue { [blue, yellow] } else { [yellow, blue] },
            trace_hash: report.trace_hash.clone(),
        }
    }

    fn empty() -> Self {
        Self {
            number: 0,
            own: MatchTeam::ours(),
            opponent: MatchTeam::ours(),
            own_is_blue: true,
            seed: 0,
            ball_in_play: 0.0,
            sides: Default::default(),
            trace_hash: String::new(),
        }
    }

    /// Difference of a count of the two teams, the first less its opponent.
    pub(super) fn ahead(&self, count: fn(&MatchSide) -> u32) -> f64 {
        let [own, theirs] = self.sides.each_ref().map(|side| f64::from(count(side)));
        own - theirs
    }

    /// The paper's offence ratio (§6): time of the ball in their half over that in the own; `None` where it
    /// never was in the own.
    pub fn offence_ratio(&self) -> Option<f64> {
        let [own, theirs] = self.sides.each_ref().map(|side| f64::from(side.other_half_s));
        (theirs > 0.0).then(|| own / theirs)
    }

    /// The paper's attack ratio (§6): own shots over the opponents'; `None` where those never shot.
    pub fn attack_ratio(&self) -> Option<f64> {
        let [own, theirs] = self.sides.each_ref().map(|side| f64::from(side.shots));
        (theirs > 0.0).then(|| own / theirs)
    }

    /// Own share of the time in which a team had the ball.
    pub fn possession(&self) -> Option<f64> {
        let [own, theirs] = self.sides.each_ref().map(|side| f64::from(side.possession_s));
        (own + theirs > 0.0).then(|| own / (own + theirs))
    }
}

impl MatchSide {
    fn new(metrics: &TeamReport, goals: u32, fouls: &BTreeMap<&'static str, u32>) -> Self {
        Self {
            goals,
            other_half_s: metrics.ball_in_their_half_s,
            shots: metrics.shots,
            chances: metrics.chances,
            possession_s: metrics.possession_s,
            passes: metrics.passes,
            losses: metrics.losses,
            attack: listed(metrics.attack.named()),
            restart_passes: passes::fates_column(&metrics.play.passes),
            calibration: passes::calibration_column(&metrics.play.passes),
            cap: metrics.play.cap,
            role_changes: metrics.play.role_changes,
            fouls: listed(fouls.iter().map(|(kind, n)| (*kind, *n))),
            cases: metrics.cases.column(),
        }
    }

    /// Counts of the team's host.
    pub fn play(&self) -> PlayCounters {
        PlayCounters {
            passes: passes::read(&self.restart_passes, &self.calibration),
            cap: self.cap,
            role_changes: self.role_changes,
        }
    }
}

impl Row for MatchRow {
    type Identity = MatchIdentity;
    const MARK: &'static str = "# onetwo matches 4 ";
    fn number(&self) -> usize {
        self.number
    }
    fn is_planned(&self, identity: &MatchIdentity) -> bool {
        identity.plan.get(self.number).is_some_and(|planned| {
            (self.own, self.opponent) == (planned.pairing.own, planned.pairing.opponent)
                && (self.own_is_blue, self.seed) == (planned.own_is_blue, planned.seed)
        })
    }
    fn planned(identity: &MatchIdentity) -> usize {
        identity.plan.len()
    }
    fn differences(own: &MatchIdentity, other: &MatchIdentity) -> Vec<Difference> {
        own.differences(other)
    }
}

fn listed<T: std::fmt::Display>(counts: impl Iterator<Item = (T, u32)>) -> String {
    let texts: Vec<_> = counts.map(|(name, n)| format!("{name}:{n}")).collect();
    texts.join(" ")
}
