//! `table`: the counts of a ledger by case and by the number of opponents in its problems; as a column of
//! `matches.csv`, and summed over matches.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::attack::PossessionEnd;
use crate::cycles::CycleEnd;

geometry::labels! {
    /// Event that followed a play; the greater counts where several did.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Followed {
        /// Nothing in its window.
        Nothing = "nothing",
        /// The referee stopped play for another reason than a goal or a ball that went out.
        Stop = "stop",
        /// The team's ball went out.
        Out = "out",
        /// The opponents got the ball, by a kick to them, a tackle, or because it was left.
        Loss = "loss",
        /// A shot without a goal.
        Shot = "shot",
        /// A goal.
        Goal = "goal",
    }
}

impl From<PossessionEnd> for Followed {
    fn from(end: PossessionEnd) -> Self {
        match end {
            PossessionEnd::Goal | PossessionEnd::Shot => Self::Shot,
            PossessionEnd::KickToOpponent | PossessionEnd::Tackle | PossessionEnd::Left => Self::Loss,
            PossessionEnd::Out => Self::Out,
            PossessionEnd::Referee => Self::Stop,
        }
    }
}

/// All that may follow, in the order of tables.
pub const FOLLOWED: [Followed; 6] =
    [Followed::Goal, Followed::Shot, Followed::Loss, Followed::Out, Followed::Stop, Followed::Nothing];

/// Counts of a case's plays.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct CaseTally {
    /// Number of decisions to play it.
    pub retrieved: u32,
    /// Plays in which every robot completed its part.
    pub finished: u32,
    /// Plays by their end ([`CycleEnd::label`], or `running`); ends that none had are left out.
    pub ends: BTreeMap<String, u32>,
    /// Passes kicked in these plays.
    pub passes: u32,
    /// Passes of these that a teammate received.
    pub passes_arrived: u32,
    /// Plays by what followed ([`Followed::label`]); what followed none is left out.
    pub followed_by: BTreeMap<String, u32>,
}

impl CaseTally {
    pub(super) fn count(&mut self, end: &str, (passes, arrived): (u32, u32), followed: Followed) {
        self.retrieved += 1;
        self.finished += u32::from(end == CycleEnd::FINISHED);
        self.passes += passes;
        self.passes_arrived += arrived;
        add(&mut self.ends, end, 1);
        add(&mut self.followed_by, followed.label(), 1);
    }

    fn add(&mut self, other: &Self) {
        self.retrieved += other.retrieved;
        self.finished += other.finished;
        self.passes += other.passes;
        self.passes_arrived += other.passes_arrived;
        for (mine, theirs) in [(&mut self.ends, &other.ends), (&mut self.followed_by, &other.followed_by)] {
            for (name, n) in theirs {
                add(mine, name, *n);
            }
        }
    }

    /// Number of plays that were followed by this.
    pub fn followed(&self, by: Followed) -> u32 {
        self.followed_by.get(by.label()).copied().unwrap_or(0)
    }
}

/// A name is stored once: most plays count under names that are known.
pub(super) fn add(counts: &mut BTreeMap<String, u32>, name: &str, n: u32) {
    match counts.get_mut(name) {
        Some(count) => *count += n,
        None => drop(counts.insert(name.to_owned(), n)),
    }
}

/// Ends and what followed, with their names in a column.
fn outcome_counts(ends: &Counts, followed_by: &Counts) -> impl Iterator<Item = (String, u32)> {
    let ends = ends.iter().map(|(end, n)| (format!("end.{end}"), *n));
    ends.chain(followed_by.iter().map(|(what, n)| (format!("then.{what}"), *n)))
}

/// Adds what [`outcome_counts`] names; other names are left out.
fn read_outcome(ends: &mut Counts, followed_by: &mut Counts, name: &str, n: u32) {
    match name.split_once('.') {
        Some(("end", end)) => add(ends, end, n),
        Some(("then", what)) => add(followed_by, what, n),
        _ => {}
    }
}

/// Counts by name.
type Counts = BTreeMap<String, u32>;

/// Counts of the possessions that began in one situation.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SituationTally {
    /// Number of possessions.
    pub possessions: u32,
    /// Possessions in which robots played a case.
    pub with_case: u32,
    /// Plays of cases in them; one that lasts longer counts for the first.
    pub plays: u32,
    /// Plays of these by their end (the words of [`CaseTally`]).
    pub ends: BTreeMap<String, u32>,
    /// Possessions by what followed; what followed none is left out.
    pub followed_by: BTreeMap<String, u32>,
}

impl SituationTally {
    fn add(&mut self, other: &Self) {
        self.possessions += other.possessions;
        self.with_case += other.with_case;
        self.plays += other.plays;
        for (mine, theirs) in [(&mut self.ends, &other.ends), (&mut self.followed_by, &other.followed_by)] {
            for (name, n) in theirs {
                add(mine, name, *n);
            }
        }
    }
}

/// A case and its plays.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct CaseLine {
    /// `region/name`.
    pub case: String,
    /// All of its plays.
    #[serde(flatten)]
    pub all: CaseTally,
    /// Plays by the number of opponents in the problem.
    pub by_opponents: BTreeMap<u8, CaseTally>,
}

/// All cases that a team played, and the decisions without one.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct CaseTable {
    /// Number of decisions to play a case.
    pub retrieved: u32,
    /// Number of decisions to play no case.
    pub no_case: u32,
    /// These by the number of opponents in the problem.
    pub no_case_by_opponents: BTreeMap<u8, u32>,
    /// These by the reason: `none-fits`, `ball-rolls`, `ball-is-held`, `shoots-sooner`, `no-ball`, or
    /// `unreported`.
    pub no_case_because: BTreeMap<String, u32>,
    /// The cases, those that were retrieved most first.
    pub cases: Vec<CaseLine>,
    /// Possessions by how they began ([`Situation`](super::Situation)), with and without a case.
    #[serde(default)]
    pub by_situation: BTreeMap<String, SituationTally>,
}

impl CaseTable {
    pub(super) fn add(&mut self, case: &str, opponents: usize, tally: &CaseTally) {
        let place = self.cases.iter().position(|line| line.case == case).unwrap_or_else(|| {
            self.cases.push(CaseLine { case: case.to_owned(), ..CaseLine::default() });
            self.cases.len() - 1
        });
        self.retrieved += tally.retrieved;
        let line = &mut self.cases[place];
        line.all.add(tally);
        line.by_opponents.entry(opponents as u8).or_default().add(tally);
        self.cases.sort_by(|a, b| b.all.retrieved.cmp(&a.all.retrieved).then_with(|| a.case.cmp(&b.case)));
    }

    pub(super) fn add_no_case(&mut self, opponents: usize, because: &str) {
        self.no_case += 1;
        add(&mut self.no_case_because, because, 1);
        *self.no_case_by_opponents.entry(opponents as u8).or_default() += 1;
    }

    /// Adds the plays of another match.
    pub fn merge(&mut self, other: &Self) {
        for line in &other.cases {
            for (opponents, tally) in &line.by_opponents {
                self.add(&line.case, usize::from(*opponents), tally);
            }
        }
        self.no_case += other.no_case;
        for (because, n) in &other.no_case_because {
            add(&mut self.no_case_because, because, *n);
        }
        for (opponents, n) in &other.no_case_by_opponents {
            *self.no_case_by_opponents.entry(*opponents).or_default() += n;
        }
        for (situation, tally) in &other.by_situation {
            self.by_situation.entry(situation.clone()).or_default().add(tally);
        }
    }

    /// `cases: 41 started, 17 completed; 12 decisions without a case`.
    pub fn summary(&self) -> String {
        let finished: u32 = self.cases.iter().map(|line| line.all.finished).sum();
        let Self { retrieved, no_case, .. } = self;
        format!("cases: {retrieved} started, {finished} completed; {no_case} decisions without a case")
    }

    /// Writes a column: for each case and number of opponents its counts,
    /// `center/pass@6:retrieved=3,end.timeout=1`, and for each situation those of its possessions,
    /// `situation.corner:possessions=2,with_case=1,plays=1,end.timeout=1,then.goal=1`.
    pub fn column(&self) -> String {
        let entry = |case: &str, opponents: u8, counts: &[(String, u32)]| {
            let counts = counts.iter().filter(|(_, n)| *n > 0).map(|(name, n)| format!("{name}={n}"));
            format!("{case}@{opponents}:{}", counts.collect::<Vec<_>>().join(","))
        };
        let mut entries = Vec::new();
        for line in &self.cases {
            for (opponents, tally) in &line.by_opponents {
                let mut counts = vec![
                    ("retrieved".to_owned(), tally.retrieved),
                    ("pass".to_owned(), tally.passes),
                    ("arrived".to_owned(), tally.passes_arrived),
                ];
                counts.extend(outcome_counts(&tally.ends, &tally.followed_by));
                entries.push(entry(&line.case, *opponents, &counts));
            }
        }
        let none = self.no_case_by_opponents.iter();
        entries
            .extend(none.map(|(opponents, n)| entry(NO_CASE, *opponents, &[("retrieved".to_owned(), *n)])));
        if !self.no_case_because.is_empty() {
            let because = self.no_case_because.iter().map(|(because, n)| format!("{because}={n}"));
            entries.push(format!("{NO_CASE}:{}", because.collect::<Vec<_>>().join(",")));
        }
        for (situation, tally) in &self.by_situation {
            let counts =
                [("possessions", tally.possessions), ("with_case", tally.with_case), ("plays", tally.plays)];
            let counts = counts.iter().filter(|(_, n)| *n > 0).map(|(name, n)| format!("{name}={n}"));
            let outcomes = outcome_counts(&tally.ends, &tally.followed_by);
            let counts: Vec<_> = counts.chain(outcomes.map(|(name, n)| format!("{name}={n}"))).collect();
            entries.push(format!("{SITUATION}{situation}:{}", counts.join(",")));
        }
        entries.join(" ")
    }

    /// Parses a column; what is none of it is left out.
    pub fn read(column: &str) -> Self {
        let mut table = Self::default();
        for entry in column.split_whitespace() {
            let Some((place, counts)) = entry.rsplit_once(':') else { continue };
            let counts = counts.split(',').filter_map(|count| {
                let (name, n) = count.split_once('=')?;
                Some((name, n.parse::<u32>().ok()?))
            });
            if place == NO_CASE {
                counts.for_each(|(because, n)| add(&mut table.no_case_because, because, n));
                continue;
            }
            if let Some(situation) = place.strip_prefix(SITUATION) {
                let tally = table.by_situation.entry(situation.to_owned()).or_default();
                for (name, n) in counts {
                    match name {
                        "possessions" => tally.possessions += n,
                        "with_case" => tally.with_case += n,
                        "plays" => tally.plays += n,
                        _ => read_outcome(&mut tally.ends, &mut tally.followed_by, name, n),
                    }
                }
                continue;
            }
            let Some((case, opponents)) = place.rsplit_once('@') else { continue };
            let Ok(opponents) = opponents.parse::<u8>() else { continue };
            let mut tally = CaseTally::default();
            for (name, n) in counts {
                match name {
                    "retrieved" => tally.retrieved += n,
                    "pass" => tally.passes += n,
                    "arrived" => tally.passes_arrived += n,
                    _ => read_outcome(&mut tally.ends, &mut tally.followed_by, name, n),
                }
            }
            tally.finished = tally.ends.get(CycleEnd::FINISHED).copied().unwrap_or(0);
            if case == NO_CASE {
                table.no_case += tally.retrieved;
                *table.no_case_by_opponents.entry(opponents).or_default() += tally.retrieved;
            } else {
                table.add(case, usize::from(opponents), &tally);
            }
        }
        table
    }
}

/// Name of decisions without a case in a column; no case has it, as it has no region.
const NO_CASE: &str = "no-case";
/// What the names of situations begin with in a column.
const SITUATION: &str = "situation.";
