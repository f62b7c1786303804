//! `tries`: a match played several times with different seeds, outcomes beside each other. s from its start.

use hil_sim::NativeBackend;
use rayon::prelude::*;
use rules::{Colour, Phase};
use serde::Serialize;

use super::report::PerTeam;
use super::{Game, GameConfig, GameError, GameReport, LEAD_IN_TICKS, TICK_US, Watcher, play_until};

/// Outcome of one try.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TryOutcome {
    /// Random seed.
    pub seed: u64,
    /// Goals in this try.
    pub goals: PerTeam<u32>,
    /// Shots at the goal.
    pub shots: PerTeam<u32>,
    /// Passes that arrived.
    pub passes: PerTeam<u32>,
    /// The team whose robot touched the ball first: `blue` or `yellow`; none: no robot touched it.
    pub first_touch: Option<&'static str>,
    /// When that team lost the ball to the other one; none: it kept it, or play stopped first.
    pub lost_s: Option<f64>,
    /// The first shot.
    pub first_shot: Option<FirstShot>,
    /// When the referee stopped play first.
    pub stopped_s: Option<f64>,
    /// Hash of all ticks, 16 hexadecimal digits.
    pub trace_hash: String,
}

/// The first shot of a try.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FirstShot {
    /// Team that shot: `blue` or `yellow`.
    pub team: &'static str,
    /// When it was made.
    pub at_s: f64,
}

/// Plays the match once for each of `count` seeds from its own on, on all cores; tries that are missing when
/// `stop` is true are left out.
pub fn tries(
    config: &GameConfig,
    count: u32,
    stop: impl Fn() -> bool + Sync,
    done: impl Fn(&TryOutcome) + Sync,
) -> Result<Vec<TryOutcome>, GameError> {
    let seeds = (0..u64::from(count)).map(|number| config.seed.wrapping_add(number)).collect::<Vec<_>>();
    let outcomes = seeds.into_par_iter().filter(|_| !stop()).map(|seed| {
        let outcome = one(&GameConfig { seed, ..config.clone() }, &stop)?;
        outcome.iter().for_each(&done);
        Ok(outcome)
    });
    let outcomes: Result<Vec<_>, GameError> = outcomes.collect();
    Ok(outcomes?.into_iter().flatten().collect())
}

/// One try; none where it was stopped.
fn one(config: &GameConfig, stop: &impl Fn() -> bool) -> Result<Option<TryOutcome>, GameError> {
    let mut look = FirstLook::default();
    let mut backend = NativeBackend::new(config.cases.unwrap_or_default());
    let report = play_until(config, &mut backend, &mut look, stop)?;
    Ok((!stop()).then(|| look.outcome(&report)))
}

/// What came first in a match.
#[derive(Default)]
struct FirstLook {
    score: Option<[u32; 2]>,
    first_touch: Option<Colour>,
    lost_s: Option<f64>,
    first_shot: Option<FirstShot>,
    ran: bool,
    stopped_s: Option<f64>,
}

impl Watcher for FirstLook {
    fn tick(&mut self, game: &Game<'_>) {
        let score = COLOURS.map(|team| game.referee().accounts().of(team).score);
        self.score.get_or_insert(score);
        if game.now().0 <= u64::from(LEAD_IN_TICKS) * TICK_US && game.config().start.is_some() {
            return;
        }
        let (now, metrics) = (game.time(), game.referee().metrics());
        self.first_touch = self.first_touch.or_else(|| game.world().last_touch().map(|(who, _)| who.colour));
        for team in COLOURS {
            let counts = metrics.team(team);
            if counts.shots > 0 {
                self.first_shot.get_or_insert(FirstShot { team: team.label(), at_s: now });
            }
            if counts.losses > 0 && self.first_touch == Some(team) && self.stopped_s.is_none() {
                self.lost_s.get_or_insert(now);
            }
        }
        let runs = game.referee().phase() == Phase::Run;
        if self.ran && !runs {
            self.stopped_s.get_or_insert(now);
        }
        self.ran |= runs;
    }
}

impl FirstLook {
    fn outcome(self, report: &GameReport) -> TryOutcome {
        let GameReport { seed, score, metrics, trace_hash, .. } = report;
        let before = self.score.unwrap_or_default();
        let PerTeam { blue, yellow } = metrics;
        TryOutcome {
            seed: *seed,
            goals: PerTeam {
                blue: score.blue.saturating_sub(before[0]),
                yellow: score.yellow.saturating_sub(before[1]),
            },
            shots: PerTeam { blue: blue.shots, yellow: yellow.shots },
            passes: PerTeam { blue: blue.passes, yellow: yellow.passes },
            first_touch: self.first_touch.map(Colour::label),
            lost_s: self.lost_s,
            first_shot: self.first_shot,
            stopped_s: self.stopped_s,
            trace_hash: trace_hash.clone(),
        }
    }
}

const COLOURS: [Colour; 2] = [Colour::Blue, Colour::Yellow];
