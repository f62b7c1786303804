//! `report`: result of a match: docs/case-format.md §5.2's JSON of `play`, filled from the referee's counts.

use std::collections::BTreeMap;

use hil_sim::small_size::referee::{Blocked, Kind, RefereeEvent};
use host::strategy::Team;
use host::strategy::counters::PlayCounters;
use rules::Colour;
use serde::{Deserialize, Serialize};

use super::holds::{Hold, Holds};
use super::{Game, GameConfig};
use crate::attack::AttackCounts;
use crate::ledger::CaseTable;
use crate::names::CaseNames;

/// Result of a match.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GameReport {
    /// Goals of each team.
    pub score: PerTeam<u32>,
    /// Length of the match, simulated s.
    pub duration_s: f64,
    /// Share of those seconds in which the ball was in play.
    pub ball_in_play: f32,
    /// Number of offences of each kind.
    pub fouls: PerTeam<BTreeMap<&'static str, u32>>,
    /// Times at which the match was blocked for longer than the referee's patience.
    pub blocked: Vec<BlockedReport>,
    /// The longest spell in play in which one robot held the ball (see [`Hold`]).
    pub longest_hold_s: f32,
    /// Number of spells that lasted for 2.5 s and longer.
    pub holds_over_2_5s: u32,
    /// Most changes of turning direction in one of these.
    pub most_reversals: u32,
    /// These spells, oldest first.
    pub long_holds: Vec<Hold>,
    /// Number of stops because the ball made no progress.
    pub no_progress: u32,
    /// Strategy of each side's open play.
    pub teams: PerTeam<Team>,
    /// Further counts of each team.
    pub metrics: PerTeam<TeamReport>,
    /// League, to play it again.
    pub league: &'static str,
    /// Seed, to play it again.
    pub seed: u64,
    /// The world it was played in, as `--world` takes it.
    pub world: String,
    /// The hash of all ticks (docs/architecture.md §2.5), 16 hexadecimal digits.
    pub trace_hash: String,
    /// The longest step of a brain, guest instructions; 0 where they cannot be counted.
    pub worst_step_instructions: u32,
}

/// A time at which the match was blocked.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BlockedReport {
    /// Start of the block, simulated s.
    pub from_s: f32,
    /// Duration of the block, s.
    pub lasted_s: f32,
    /// Team that blocked it last; `None` for the ball's place.
    pub team: Option<&'static str>,
    /// Robot that blocked it last.
    pub robot: Option<u8>,
    /// The reason, as a name for programs.
    pub reason: &'static str,
    /// The reason, with its numbers.
    #[serde(rename = "words")]
    pub description: String,
}

impl BlockedReport {
    fn of(block: &Blocked) -> Self {
        let obstacle = &block.obstacle;
        Self {
            from_s: block.since.as_secs_f32(),
            lasted_s: block.lasted.as_secs_f32(),
            team: obstacle.team.map(Colour::label),
            robot: obstacle.robot.map(protocol::RobotId::number),
            reason: obstacle.reason.label(),
            description: obstacle.to_string(),
        }
    }
}

/// A value for both teams.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PerTeam<T> {
    /// The value of team blue.
    pub blue: T,
    /// The value of team yellow.
    pub yellow: T,
}

impl<T> PerTeam<T> {
    fn of(each: impl Fn(Colour) -> T) -> Self {
        Self { blue: each(Colour::Blue), yellow: each(Colour::Yellow) }
    }
}

/// Answers of a strategy in another program.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct StrategyReport {
    /// Number of answers that were followed.
    pub used: u64,
    /// Number of answers that were refused.
    pub refused: u64,
    /// Why the last one was refused.
    pub refusal: Option<String>,
}

impl StrategyReport {
    fn of(host: &host::Host) -> Option<Self> {
        let (refused, error) = host.refused_answers();
        let used = host.used_answers();
        host.settings().external.then(|| Self { used, refused, refusal: error.map(ToString::to_string) })
    }

    /// Whether it answered, and no answer could be followed.
    pub const fn never_played(&self) -> bool {
        self.used == 0 && self.refused > 0
    }

    /// A warning, where answers were refused.
    pub fn warning(&self) -> Option<String> {
        let Self { used, refused, refusal } = self;
        let reason = refusal.as_ref()?;
        let all = used + refused;
        Some(format!(
            "{refused} of {all} answers of the strategy were refused, the last one because {reason} (docs/strategy-protocol.md)"
        ))
    }
}

/// Results of one team.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TeamReport {
    /// Answers of its strategy, where another program plays.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strategy: Option<StrategyReport>,
    /// Time in which the team had the ball, s.
    pub possession_s: f32,
    /// Seconds in play with the ball in the opponents' half.
    pub ball_in_their_half_s: f32,
    /// Shots at the goal (Biswas et al. 2014: what the attack ratio counts).
    pub shots: u32,
    /// Shots that a keeper had to stop, that hit a post, or went in.
    pub chances: u32,
    /// Number of passes that arrived.
    pub passes: u32,
    /// Balls lost to the opponents.
    pub losses: u32,
    /// Time of the ball in the opponents' half over that in the own.
    pub offence_ratio: Option<f32>,
    /// Own shots over the opponents'.
    pub attack_ratio: Option<f32>,
    /// The longest spell in play in which one of its robots held the ball.
    pub longest_hold_s: f32,
    /// Number of its spells that lasted for 2.5 s and longer.
    pub holds_over_2_5s: u32,
    /// Ends of its possessions, its kicks, shots and left balls.
    pub attack: AttackCounts,
    /// Passes of its restarts as its host followed them, planned free kicks, and changes of role.
    pub play: PlayCounters,
    /// Plays of every case of its robots and what followed.
    pub cases: CaseTable,
}

impl TeamReport {
    fn of(game: &Game<'_>, holds: &Holds, names: &CaseNames, team: Colour) -> Self {
        let metrics = game.referee().metrics();
        let own = metrics.team(team);
        Self {
            strategy: StrategyReport::of(game.host(team)),
            possession_s: own.possession_s,
            ball_in_their_half_s: own.ball_in_their_half_s,
            shots: own.shots,
            chances: own.chances,
            passes: own.passes,
            losses: own.losses,
            offence_ratio: metrics.offence_ratio(team),
            attack_ratio: metrics.attack_ratio(team),
            longest_hold_s: holds.longest(team),
            holds_over_2_5s: holds.over(team),
            attack: game.ledger().attack().of(team).clone(),
            play: *game.host(team).counters(),
            cases: game.ledger().table(team, names, true),
        }
    }
}

impl GameReport {
    /// The report of a match in its current state.
    pub fn of(config: &GameConfig, game: &Game<'_>) -> Self {
        let (accounts, metrics) = (game.referee().accounts(), game.referee().metrics());
        let holds = game.holds().closed();
        let no_progress = |event: &&RefereeEvent| event.what.kind() == Kind::NoProgress;
        Self {
            score: PerTeam::of(|team| accounts.of(team).score),
            duration_s: game.time(),
            ball_in_play: metrics.ball_in_play(),
            fouls: PerTeam::of(|team| {
                metrics.offences.team(team).map(|(kind, n)| (kind.label(), n)).collect()
            }),
            blocked: metrics.blocks.iter().map(BlockedReport::of).collect(),
            longest_hold_s: COLOURS.map(|team| holds.longest(team)).into_iter().fold(0.0, f32::max),
            holds_over_2_5s: COLOURS.map(|team| holds.over(team)).into_iter().sum(),
            most_reversals: holds.long().iter().map(|hold| hold.reversals).max().unwrap_or(0),
            long_holds: holds.long().to_vec(),
            no_progress: game.referee().events().iter().filter(no_progress).count() as u32,
            teams: PerTeam::of(|team| config.plays(team)),
            metrics: PerTeam::of(|team| TeamReport::of(game, &holds, &config.names, team)),
            league: config.league.name(),
            seed: config.seed,
            world: config.world.to_string(),
            trace_hash: game.trace().digits(),
            worst_step_instructions: game.worst_instructions(),
        }
    }
}

const COLOURS: [Colour; 2] = [Colour::Blue, Colour::Yellow];
