//! `unit`: a match, or its beginning, as a unit of learning: who plays it, and what is kept of it.

use std::collections::{BTreeMap, BTreeSet};

use crate::matches::MatchTeam;
use arena::attack::{BallEvent, ShotCounts};
use arena::game::{Game, GameConfig, GameError, NoWatcher};
use arena::ledger::Followed;
use arena::{CycleEnd, CycleSeen};
use casebase::Problem;
use geometry::Pose;
use hil_sim::small_size::World;
use hil_sim::{Fnv, NativeBackend};
use host::strategy::Team;
use host::strategy::rated::Action;
use protocol::{CycleId, RobotId};
use rules::{Colour, League};
use serde::{Deserialize, Serialize};

use crate::learning::player::{PlayError, Playable};
use crate::learning::starts::StartStream;
use crate::learning::trial::Situation;
use crate::learning::variant::Variant;

/// The teams that are played against, in turn.
pub(crate) const OPPONENTS: [Team; 3] = Team::OPPONENTS;
/// Length of a scene, from where a change is felt, simulated ms: our attack, and theirs after a lost ball.
pub const SCENE_MS: u32 = 20_000;
/// Length of a match by its clock, s: that of evaluations, with half-time after 300 s.
pub(crate) const MATCH_S: f64 = 600.0;

/// A match from its kick-off on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct MatchWork {
    /// Use of the match.
    pub stream: StartStream,
    /// Number in the stream; opponent, colour and seed follow from it.
    pub index: u32,
    /// Time from its start at which it is left, simulated ms.
    pub until_ms: u32,
}

/// A library of the Small Size League and a match to play with it.
#[derive(Clone, Copy, Debug)]
pub struct MatchUnit<'a> {
    /// The library of our team.
    pub variant: &'a Variant,
    /// The match.
    pub work: MatchWork,
    /// The same match with another library, by the hash of that: this one is left a scene after it has become
    /// another, or where no whole scene can follow any more.
    pub beside: Option<(u64, &'a LearningMatch)>,
}

/// A decision of our team to play a case.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct MatchDecision {
    /// The problem that was decided on.
    #[serde(rename = "s")]
    pub situation: Situation,
    /// Id of the case, in the library of the match.
    #[serde(rename = "c")]
    pub case: u16,
    /// End of the play, by its place in [`CycleEnd::LABELS`].
    #[serde(rename = "e", default, skip_serializing_if = "Option::is_none")]
    pub end: Option<u8>,
    /// Whether a goal followed in the play's window of the ledger.
    #[serde(rename = "g", default, skip_serializing_if = "std::ops::Not::not")]
    pub goal: bool,
}

/// Shot or goal of a team.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MarkKind {
    /// A shot with no free line to the goal.
    ShotClosed,
    /// A shot with less than half of the lines free.
    ShotPartlyOpen,
    /// A shot with half of the lines free or more.
    ShotOpen,
    /// A goal.
    Goal,
}

/// A shot or goal, and its time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Mark {
    /// Time, simulated ms.
    #[serde(rename = "t")]
    pub at_ms: u32,
    /// Whether our team did it.
    #[serde(rename = "o")]
    pub ours: bool,
    /// Kind of shot, or a goal.
    #[serde(rename = "k")]
    pub kind: MarkKind,
}

/// Record of a match for learning.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LearningMatch {
    /// Goals, ours and theirs.
    pub goals: [u32; 2],
    /// Our plays of cases, oldest first.
    pub decisions: Vec<MatchDecision>,
    /// Numbers of the cases that were among the actions of the robot at the ball (docs/strategy.md), played
    /// or not.
    pub listed: BTreeSet<u16>,
    /// Shots and goals of both teams, oldest first.
    pub marks: Vec<Mark>,
    /// A hash of what is seen at each second, equal for equal play: the match's own trace differs from the
    /// first tick on where case bases do, as robots send their hash.
    pub seconds: Vec<u32>,
    /// The second up to which it was the same as the match beside it; none where it stayed the same, or had
    /// none beside it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub same_until_s: Option<u32>,
}

impl MatchWork {
    /// The opponent, by its place in [`OPPONENTS`].
    pub(crate) fn opponent(&self) -> usize {
        self.index as usize % OPPONENTS.len()
    }

    /// We play on either side as often.
    fn colour(&self) -> Colour {
        if (self.index as usize / OPPONENTS.len()).is_multiple_of(2) { Colour::Blue } else { Colour::Yellow }
    }

    /// The stream's number is hashed: no seed of another stream, or of an evaluation, gives the same but by
    /// chance.
    pub(super) fn seed(&self, seed: u64) -> u64 {
        let mut hash = Fnv::default();
        hash.add(b"learning's match");
        hash.add(&seed.to_le_bytes());
        hash.add(&[self.stream as u8]);
        hash.add(&self.index.to_le_bytes());
        // As long as the seeds of evaluated matches.
        hash.value() >> 16
    }

    fn config(&self, league: League, variant: &Variant, seed: u64) -> GameConfig {
        let (us, opponent) = (self.colour(), OPPONENTS[self.opponent()]);
        let (blue, yellow) = if us == Colour::Blue { (Team::Ours, opponent) } else { (opponent, Team::Ours) };
        let mut config = GameConfig::new(league, self.seed(seed), MATCH_S).between(blue, yellow);
        config.names = variant.case_names();
        config.cases = Some(variant.lasting_base());
        for setup in &mut config.teams {
            let plays = MatchTeam::from(setup.plays);
            (setup.tactics, setup.approach) = (plays.host_tactics(), plays.approach());
            setup.settings = variant.settings.clone();
        }
        config
    }
}

impl Playable for MatchUnit<'_> {
    type Played = LearningMatch;

    fn key(&self) -> u64 {
        let mut hash = Fnv::default();
        hash.add(&self.variant.hash.to_le_bytes());
        // Plain data: it always serialises.
        hash.add(&serde_json::to_vec(&self.work).unwrap_or_default());
        if let Some((library, _)) = self.beside {
            hash.add(&library.to_le_bytes());
        }
        hash.value()
    }

    fn play(&self, seed: u64) -> Result<Vec<LearningMatch>, PlayError> {
        let field = self.variant.base().field();
        let league = arena::cases::league_of(field, &self.variant.files.league);
        let league = league.unwrap_or(League::DivisionB);
        let config = self.work.config(league, self.variant, seed);
        Ok(vec![self.run(&config).map_err(PlayError::Match)?])
    }

    /// Scenes, begun ones as whole.
    fn counts(&self, played: &[LearningMatch]) -> u64 {
        played.iter().map(|played| (played.seconds.len() as u64 * 1000).div_ceil(SCENE_MS.into())).sum()
    }
}

impl MatchUnit<'_> {
    fn run(&self, config: &GameConfig) -> Result<LearningMatch, GameError> {
        let us = self.work.colour();
        let mut game = Game::new(config, &mut NativeBackend::new(self.variant.base()))?;
        let mut recorder = Recorder::default();
        let mut until_ms = self.work.until_ms;
        if self.beside.is_some() {
            until_ms = until_ms.saturating_sub(SCENE_MS);
        }
        while !game.is_over() && ms(&game) < until_ms {
            game.step(&mut NoWatcher)?;
            recorder.look(&game, us);
            let Some((_, other)) = self.beside.filter(|_| recorder.same_until_s.is_none()) else { continue };
            let Some(last) = recorder.seconds.len().checked_sub(1) else { continue };
            if recorder.seconds.get(last) != other.seconds.get(last) {
                // The second before the hash that differs.
                recorder.same_until_s = Some(last as u32);
                until_ms = last as u32 * 1000 + SCENE_MS;
            }
        }
        Ok(recorder.finish(&game, us))
    }
}

fn ms(game: &Game<'_>) -> u32 {
    (game.time() * 1e3).round() as u32
}

/// A hash of where everything is.
fn seen(world: &World) -> u32 {
    let mut hash = Fnv::default();
    let mut add = |value: f32| hash.add(&value.to_bits().to_le_bytes());
    for robot in world.robots() {
        let Pose { position, heading } = robot.pose;
        [position.x(), position.y(), heading.radians()].into_iter().for_each(&mut add);
    }
    [world.ball.position.x(), world.ball.position.y()].into_iter().for_each(&mut add);
    hash.value() as u32
}

#[derive(Debug, Default)]
struct Recorder {
    newest: [Option<CycleId>; RobotId::COUNT],
    decisions: Vec<(CycleId, MatchDecision)>,
    shots: [ShotCounts; 2],
    marks: Vec<Mark>,
    listed: BTreeSet<u16>,
    seconds: Vec<u32>,
    same_until_s: Option<u32>,
}

impl Recorder {
    fn look(&mut self, game: &Game<'_>, us: Colour) {
        let at_ms = ms(game);
        if at_ms >= 1000 * (self.seconds.len() as u32 + 1) {
            self.seconds.push(seen(game.world()));
        }
        for rated in game.host(us).rated().map_or(&[][..], |(_, list)| list) {
            if let Action::Case(cast) = rated.action {
                self.listed.insert(cast.case.0 / 4);
            }
        }
        for (robot, report) in game.decisions(us) {
            if self.newest[robot.index()].replace(report.cycle) == Some(report.cycle) {
                continue;
            }
            let (Some(problem), Some(case)) = (Problem::of(&report), report.case) else { continue };
            let situation = Situation::of(&problem);
            let decision = MatchDecision { situation, case: case.0, end: None, goal: false };
            self.decisions.push((report.cycle, decision));
        }
        let attack = game.ledger().attack();
        for (team, known) in [us, us.other()].into_iter().zip(&mut self.shots) {
            let (before, now) = (*known, attack.of(team).shots);
            *known = now;
            let kinds = [
                (MarkKind::ShotClosed, now.closed - before.closed),
                (MarkKind::ShotPartlyOpen, now.partly_open - before.partly_open),
                (MarkKind::ShotOpen, now.open - before.open),
            ];
            for (kind, count) in kinds {
                self.marks.extend((0..count).map(|_| Mark { at_ms, ours: team == us, kind }));
            }
        }
        for event in attack.events() {
            if let BallEvent::Goal { team } = *event {
                self.marks.push(Mark { at_ms, ours: team == us, kind: MarkKind::Goal });
            }
        }
    }

    fn finish(self, game: &Game<'_>, us: Colour) -> LearningMatch {
        let plays: BTreeMap<CycleId, (&CycleSeen, Followed)> =
            game.ledger().team(us).plays().map(|(cycle, followed)| (cycle.id, (cycle, followed))).collect();
        let ended = |(id, decision): (CycleId, MatchDecision)| {
            let Some((cycle, followed)) = plays.get(&id) else { return decision };
            let end = cycle.end.map_or(CycleEnd::TrialOver, |(_, end)| end);
            let place = CycleEnd::LABELS.iter().position(|label| *label == end.label());
            let end = place.and_then(|place| u8::try_from(place).ok());
            MatchDecision { end, goal: *followed == Followed::Goal, ..decision }
        };
        let score = |team: Colour| game.referee().accounts().of(team).score;
        LearningMatch {
            goals: [score(us), score(us.other())],
            decisions: self.decisions.into_iter().map(ended).collect(),
            listed: self.listed,
            marks: self.marks,
            seconds: self.seconds,
            same_until_s: self.same_until_s,
        }
    }
}
