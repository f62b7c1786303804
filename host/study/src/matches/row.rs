//! `row`: one row of `matches.csv`: the two teams, and every measure of both sides. s; `own` is the first of
//! the pair.

use host::strategy::counters::{CapCounters, PlayCounters};
use serde::{Deserialize, Serialize};

use super::MatchIdentity;
use super::match_team::MatchTeam;
use super::passes;
use super::plan::Planned;
use crate::evaluation::{Difference, Entry};
use arena::game::{GameReport, PerTeam};

/// Identity and measures of one match.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MatchRow {
    /// Its number in the plan, from 0.
    pub number: usize,
    /// The team whose numbers come first.
    pub own: MatchTeam,
    /// The team that it played against.
    pub opponent: MatchTeam,
    /// Whether the first of them played blue.
    pub own_is_blue: bool,
    /// Seed that replays it.
    pub seed: u64,
    /// Goals of the first team.
    pub goals: u32,
    /// Goals of the opponents.
    pub goals_against: u32,
    /// Share of the match in which the ball was in play.
    pub ball_in_play: f32,
    /// Seconds in play with the ball in the opponents' half.
    pub their_half_s: f32,
    /// Seconds in play with the ball in the own half.
    pub own_half_s: f32,
    /// Shots at the goal.
    pub shots: u32,
    /// Shots of the opponents at the goal.
    pub shots_against: u32,
    /// Shots that a keeper had to stop, that hit a post, or went in.
    pub chances: u32,
    /// Such shots of the opponents.
    pub chances_against: u32,
    /// Seconds with the ball.
    pub possession_s: f32,
    /// Seconds of the opponents with the ball.
    pub possession_against_s: f32,
    /// Number of passes that arrived.
    pub passes: u32,
    /// Number of the opponents' passes that arrived.
    pub passes_against: u32,
    /// Balls lost to the opponents.
    pub losses: u32,
    /// Balls that the opponents lost.
    pub losses_against: u32,
    /// How possessions ended, where kicks went, what shots were worth, and left balls: `end.shot:3
    /// kick.2-3/4-5/team:2 shot.volley:1 left-ball:1`.
    pub attack: String,
    /// The same of the opponents.
    pub attack_against: String,
    /// Passes of restarts as the host followed them, by kick and fate: `flat.received:3 chip.out:1`.
    pub restart_passes: String,
    /// Passes of the opponents' restarts, in the same form.
    pub restart_passes_against: String,
    /// Their P(we have it) by tenths: tenth, passes, sum of P(we have it), received, as in `9:12:11.2:10`.
    pub calibration: String,
    /// P(we have it) of the opponents' passes, in the same form.
    pub calibration_against: String,
    /// Passes of the Coerce and Attack Planner that left.
    pub cap_attempts: u32,
    /// … that arrived at a teammate.
    pub cap_successes: u32,
    /// … whose receiver had coerced an opponent before.
    pub cap_reuses: u32,
    /// … of those, that arrived.
    pub cap_reuse_successes: u32,
    /// The opponents' that left.
    pub cap_attempts_against: u32,
    /// … that arrived at a teammate.
    pub cap_successes_against: u32,
    /// … whose receiver had coerced an opponent before.
    pub cap_reuses_against: u32,
    /// … of those, that arrived.
    pub cap_reuse_successes_against: u32,
    /// Number of changes of a robot's role within a phase.
    pub role_changes: u32,
    /// Number of such changes of the opponents' robots.
    pub role_changes_against: u32,
    /// Offences: `kind:number`, a blank between two.
    pub fouls: String,
    /// Offences of the opponents, in the same form.
    pub fouls_against: String,
    /// Equal for equal matches.
    pub trace_hash: String,
    /// What became of every case, as [`CaseTable::column`](arena::ledger::CaseTable::column) writes it.
    pub cases: String,
    /// The same of the opponents' cases.
    pub cases_against: String,
}

impl MatchRow {
    /// The row of a played match.
    pub(super) fn new(planned: &Planned, report: &GameReport) -> Self {
        fn sides<T>(blue_first: bool, of: &PerTeam<T>) -> (&T, &T) {
            if blue_first { (&of.blue, &of.yellow) } else { (&of.yellow, &of.blue) }
        }
        let blue = planned.own_is_blue;
        let (own, theirs) = sides(blue, &report.metrics);
        let (goals, goals_against) = sides(blue, &report.score);
        let (fouls, fouls_against) = sides(blue, &report.fouls);
        Self {
            number: planned.number,
            own: planned.pairing.own,
            opponent: planned.pairing.opponent,
            own_is_blue: blue,
            seed: planned.seed,
            goals: *goals,
            goals_against: *goals_against,
            ball_in_play: report.ball_in_play,
            their_half_s: own.ball_in_their_half_s,
            own_half_s: theirs.ball_in_their_half_s,
            shots: own.shots,
            shots_against: theirs.shots,
            chances: own.chances,
            chances_against: theirs.chances,
            possession_s: own.possession_s,
            possession_against_s: theirs.possession_s,
            passes: own.passes,
            passes_against: theirs.passes,
            losses: own.losses,
            losses_against: theirs.losses,
            attack: listed(own.attack.named()),
            attack_against: listed(theirs.attack.named()),
            restart_passes: passes::fates_column(&own.play.passes),
            restart_passes_against: passes::fates_column(&theirs.play.passes),
            calibration: passes::calibration_column(&own.play.passes),
            calibration_against: passes::calibration_column(&theirs.play.passes),
            cap_attempts: own.play.cap.attempts,
            cap_successes: own.play.cap.successes,
            cap_reuses: own.play.cap.reuses,
            cap_reuse_successes: own.play.cap.reuse_successes,
            cap_attempts_against: theirs.play.cap.attempts,
            cap_successes_against: theirs.play.cap.successes,
            cap_reuses_against: theirs.play.cap.reuses,
            cap_reuse_successes_against: theirs.play.cap.reuse_successes,
            role_changes: own.play.role_changes,
            role_changes_against: theirs.play.role_changes,
            fouls: listed(fouls.iter().map(|(kind, n)| (*kind, *n))),
            fouls_against: listed(fouls_against.iter().map(|(kind, n)| (*kind, *n))),
            trace_hash: report.trace_hash.clone(),
            cases: own.cases.column(),
            cases_against: theirs.cases.column(),
        }
    }

    /// The paper's offence ratio (§6): time of the ball in their half over that in the own; `None` where it
    /// never was in the own.
    pub fn offence_ratio(&self) -> Option<f64> {
        (self.own_half_s > 0.0).then(|| f64::from(self.their_half_s) / f64::from(self.own_half_s))
    }

    /// The paper's attack ratio (§6): own shots over the opponents'; `None` where those never shot.
    pub fn attack_ratio(&self) -> Option<f64> {
        (self.shots_against > 0).then(|| f64::from(self.shots) / f64::from(self.shots_against))
    }

    /// Counts of the two hosts: own, theirs.
    pub fn play(&self) -> [PlayCounters; 2] {
        let own = CapCounters {
            attempts: self.cap_attempts,
            successes: self.cap_successes,
            reuses: self.cap_reuses,
            reuse_successes: self.cap_reuse_successes,
        };
        let theirs = CapCounters {
            attempts: self.cap_attempts_against,
            successes: self.cap_successes_against,
            reuses: self.cap_reuses_against,
            reuse_successes: self.cap_reuse_successes_against,
        };
        [
            PlayCounters {
                passes: passes::read(&self.restart_passes, &self.calibration),
                cap: own,
                role_changes: self.role_changes,
            },
            PlayCounters {
                passes: passes::read(&self.restart_passes_against, &self.calibration_against),
                cap: theirs,
                role_changes: self.role_changes_against,
            },
        ]
    }

    /// Own share of the time in which a team had the ball.
    pub fn possession(&self) -> Option<f64> {
        let both = f64::from(self.possession_s) + f64::from(self.possession_against_s);
        (both > 0.0).then(|| f64::from(self.possession_s) / both)
    }
}

impl Entry for MatchRow {
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
