//! `matches`: learning from matches, for libraries of the Small Size League.
//!
//! ```text
//! beginnings of matches ─► evidence ─► proposals ─► scenes (halving) ─► finalists
//!                                                                          │ scenes of fresh matches, e-values
//! library ◄── accepted ◄── whole matches, paired by seed ◄── confirmed ◄───┘
//! ```
//! A match is a function of its seed and of the cases that our host and robots retrieve. So a match with an
//! edited library is, tick by tick, that with the library before, up to the first decision that the edit
//! touches, and the scenes from there on are a pair from an equal start, robots in motion. Opponents take
//! turns.

mod unit;
mod value;

use std::collections::BTreeSet;
use std::ops::Range;

use arena::CycleEnd;
use case_tools::Files;
use hil_sim::small_size::worlds::WorldChoice;

use crate::learning::betting::Wager;
use crate::learning::collected::Collected;
use crate::learning::competence::standings;
use crate::learning::edit::{Change, Edit};
use crate::learning::evidence::CasePlay;
use crate::learning::null_control;
use crate::learning::player::{Playable, Player};
use crate::learning::proposals::{Kind, Proposal, from_evidence};
use crate::learning::results::{Learned, Validation, Verdict};
use crate::learning::run::{Candidate, LearnError, LearnResult, Run, Screening, Testing, World};
use crate::learning::settings::LearnSettings;
use crate::learning::starts::StartStream;
use crate::learning::variant::Variant;

use unit::OPPONENTS;
pub use unit::{LearningMatch, Mark, MarkKind, MatchDecision, MatchUnit, MatchWork, SCENE_MS};
use value::{DIFFERENCE_MAX, value};

/// Learns from the files of a library of the Small Size League and what was collected of earlier play. Its
/// `budget` is of scenes: parts of matches of [`SCENE_MS`].
pub fn learn_matches(
    files: Files,
    earlier: Collected,
    settings: &LearnSettings,
    player: &mut impl for<'u> Player<MatchUnit<'u>>,
) -> Result<Learned, LearnError> {
    let start = Variant::new(files).map_err(LearnError::Library)?;
    let world = Matches { sizes: Sizes::of(settings.budget), player };
    Run::new(world, start, earlier.evidence, settings).learn()
}

/// Numbers of matches a round.
#[derive(Clone, Copy, Debug)]
struct Sizes {
    /// Length of a beginning, simulated ms.
    beginning_ms: u32,
    /// Beginnings that evidence and scenes are taken from.
    explore: u32,
    /// Fresh beginnings of a look of a test.
    look: u32,
    /// Whole matches of a validation.
    validate: u32,
    /// Proposals a kind that are screened.
    proposals: usize,
}

impl Sizes {
    /// Length of a beginning, simulated ms: three or four cases are played in it, and what goes before a
    /// scene is played again with every edited library.
    const BEGINNING_MS: u32 = 90_000;
    /// Length of a whole match, simulated ms.
    const WHOLE_MS: u32 = 600_000;
    /// Scenes that a whole match counts as.
    const WHOLE_SCENES: u64 = (Self::WHOLE_MS / SCENE_MS) as u64;
    /// Matches after which opponents and ends repeat.
    const TURN: u64 = 6;

    /// A sixth of the budget explores; one test takes up to two thirds of it, a validation an eighth. Every
    /// opponent is met as often from both ends.
    fn of(budget: u64) -> Self {
        let beginning = u64::from(Self::BEGINNING_MS).div_ceil(SCENE_MS.into());
        let explore = Self::turns(budget / 6 / beginning, 600);
        Self {
            beginning_ms: Self::BEGINNING_MS,
            explore,
            look: Self::turns(u64::from(explore) / 2, 300),
            validate: Self::turns(budget / 8 / Self::WHOLE_SCENES / 2, 120),
            proposals: (explore as usize / 24).clamp(3, 10),
        }
    }

    /// Whole turns of matches, one at least and `most` matches at most.
    fn turns(matches: u64, most: u64) -> u32 {
        (matches.clamp(Self::TURN, most) / Self::TURN * Self::TURN) as u32
    }

    /// Matches of a stream that are played at once, and where they are left, simulated ms.
    fn of_stream(self, stream: StartStream) -> (u32, u32) {
        match stream {
            StartStream::Exploration => (self.explore, self.beginning_ms),
            StartStream::Confirmation => (self.look, self.beginning_ms),
            StartStream::Validation | StartStream::HeldOut => (self.validate, Self::WHOLE_MS),
        }
    }
}

/// The world of matches, and who plays them.
struct Matches<'r> {
    sizes: Sizes,
    player: &'r mut dyn for<'u> Player<MatchUnit<'u>>,
}

/// Matches of a library.
struct Played {
    library: u64,
    works: Vec<MatchWork>,
    matches: Vec<LearningMatch>,
    /// Names of the cases that were among the actions, by match.
    listed: Vec<BTreeSet<String>>,
}

impl Played {
    fn new(variant: &Variant, works: Vec<MatchWork>, matches: Vec<LearningMatch>) -> Self {
        let name = |number: &u16| variant.names().get(usize::from(*number)).cloned();
        let listed = matches.iter().map(|played| played.listed.iter().filter_map(name).collect()).collect();
        Self { library: variant.hash, works, matches, listed }
    }

    /// The matches that an edit may change, by number: those in which its case was among the actions; of a
    /// scope that may hold more than before, all.
    fn touched(&self, edit: &Edit) -> Vec<usize> {
        let all = matches!(edit.change, Change::BallScope(_) | Change::OpponentScope(..));
        (0..self.matches.len()).filter(|i| all || self.listed[*i].contains(&edit.case)).collect()
    }
}

impl World for Matches<'_> {
    type Played = Played;
    type Ground = Played;
    type Changed = ();
    /// Each finalist's test takes up to half of the budget.
    const SCREENING: Screening =
        Screening { touched_min: 6, steps: [(12, 2), (36, 2), (96, 1)], finalists: 3, finalist_z: 1.0 };
    const TESTING: Testing = Testing { looks: 8, hopeless_z: -0.5, hopeless_step: 0.25 };
    const IDLE_ROUNDS: u32 = 1;

    fn fresh(run: &mut Run<'_, Self>, stream: StartStream) -> LearnResult<Played> {
        let (count, until_ms) = run.world.sizes.of_stream(stream);
        let first = run.take(stream, count);
        let works: Vec<_> =
            (first..first + count).map(|index| MatchWork { stream, index, until_ms }).collect();
        let current = run.current.clone();
        let matches = run.play_whole(&current, &works)?;
        Ok(Played::new(&current, works, matches))
    }

    /// Adds the plays of cases, as recorded matches are; in the null control with the goals of other plays.
    fn collect(run: &mut Run<'_, Self>, played: &Played) {
        let world = WorldChoice::default().to_string();
        let decisions = played.matches.iter().flat_map(|played| &played.decisions);
        let plays: Vec<_> = decisions.filter(|decision| decision.end.is_some()).collect();
        let mut goals: Vec<bool> = plays.iter().map(|decision| decision.goal).collect();
        let first = played.works.first().map_or(0, |work| work.index);
        null_control::shuffle(run.settings, first, &mut goals);
        for (decision, goal) in plays.into_iter().zip(goals) {
            let end = decision.end.and_then(|end| CycleEnd::LABELS.get(usize::from(end)).copied());
            let situation = &decision.situation;
            let play = CasePlay { situation, case: Some(decision.case), to_goal: goal, end };
            run.evidence.add_play(&run.current, &world, &situation.opponents.len().to_string(), &play);
        }
    }

    /// Proposals of the kinds that matches can try. Hosts retrieve with the default settings, so no order is
    /// tried; demands on a goalkeeper are for the four-legged league's opponents.
    fn propose(run: &mut Run<'_, Self>, _: &Played) -> LearnResult<Vec<Proposal>> {
        let known = standings(&run.evidence, &run.libraries);
        let LearnSettings { kinds, refused, .. } = run.settings;
        let mut proposals = Vec::new();
        for kind in
            [Kind::Scopes, Kind::Actions, Kind::Forget].into_iter().filter(|kind| kinds.contains(kind))
        {
            let mut of_kind = from_evidence(&run.current, &known, kind, &run.tried);
            of_kind.retain(|Proposal { edit, .. }| {
                !matches!(edit.change, Change::AddOpponent(..)) && !refused.contains(edit)
            });
            of_kind.truncate(run.world.sizes.proposals);
            proposals.extend(of_kind);
        }
        Ok(proposals)
    }

    fn ground(_: &Run<'_, Self>, played: Played) -> Played {
        played
    }

    fn touched(played: &Played, edit: &Edit, _: &Variant) -> (Vec<usize>, usize) {
        (played.touched(edit), played.matches.len())
    }

    /// Bets on the scenes from where matches change; a match that stays the same is an equal pair.
    fn play_pairs(
        run: &mut Run<'_, Self>,
        played: &Played,
        tried: &mut [Candidate],
        range: Range<usize>,
    ) -> LearnResult<()> {
        let mut units = Vec::new();
        for candidate in &*tried {
            let variant = &candidate.variant;
            units.extend(candidate.chosen(&range).into_iter().map(|i| {
                let beside = Some((played.library, &played.matches[i]));
                MatchUnit { variant, work: played.works[i], beside }
            }));
        }
        let with = run.play(&units)?;
        let mut with = with.iter();
        for candidate in tried {
            for (i, with) in candidate.chosen(&range).into_iter().zip(with.by_ref()) {
                let sign = sign(run.settings, &candidate.proposal.edit, &played.works[i]);
                let difference = with.same_until_s.map_or(0.0, |from_s| {
                    value(&with.marks, from_s * 1000) - value(&played.matches[i].marks, from_s * 1000)
                });
                candidate.wager.add_difference(sign * difference, DIFFERENCE_MAX);
            }
        }
        Ok(())
    }

    fn look(run: &mut Run<'_, Self>, candidate: &mut Candidate, block: &Played) -> LearnResult<()> {
        candidate.touched = block.touched(&candidate.proposal.edit);
        Self::play_pairs(run, block, std::slice::from_mut(candidate), 0..usize::MAX)
    }

    /// Whole matches are not lower against any opponent.
    fn validate(
        run: &mut Run<'_, Self>,
        candidate: &Candidate,
        _: &mut Option<Played>,
    ) -> LearnResult<(Verdict, Validation)> {
        let without = Self::fresh(run, StartStream::Validation)?;
        let with = run.play_whole(&candidate.variant, &without.works)?;
        let (mut all, mut against) = (Wager::default(), [Wager::default(); OPPONENTS.len()]);
        for ((work, with), without) in without.works.iter().zip(&with).zip(&without.matches) {
            let sign = sign(run.settings, &candidate.proposal.edit, work);
            let difference = sign * (ahead(with) - ahead(without));
            all.add_difference(difference, GOALS_MAX);
            against[work.opponent()].add_difference(difference, GOALS_MAX);
        }
        let lowered = against.iter().any(|wager| wager.z() < LOWERED_Z);
        let verdict = if lowered { Verdict::Lowers } else { Verdict::Accepted };
        let kinds = OPPONENTS.iter().zip(against).map(|(team, wager)| (team.label().to_owned(), wager));
        Ok((verdict, Validation { all, kinds: kinds.collect(), worlds: Vec::new() }))
    }

    /// Matches with the accepted library are others from some decision on: they are played afresh.
    fn renew(_: &mut Run<'_, Self>, _: &Candidate, blocks: &mut Vec<Played>, _: Vec<()>) -> LearnResult<()> {
        blocks.clear();
        Ok(())
    }

    fn opponents() -> Vec<String> {
        OPPONENTS.map(|team| team.label().to_owned()).to_vec()
    }
}

impl Run<'_, Matches<'_>> {
    /// Plays units; the budget counts each once.
    fn play(&mut self, units: &[MatchUnit<'_>]) -> LearnResult<Vec<LearningMatch>> {
        let played = self.world.player.play(units)?;
        for (unit, played) in units.iter().zip(&played) {
            if self.asked.insert(unit.key()) {
                self.spent += unit.counts(played);
            }
        }
        Ok(played.into_iter().flatten().collect())
    }

    /// Plays matches to where their works leave them.
    fn play_whole(&mut self, variant: &Variant, works: &[MatchWork]) -> LearnResult<Vec<LearningMatch>> {
        let units = works.iter().map(|work| MatchUnit { variant, work: *work, beside: None });
        self.play(&units.collect::<Vec<_>>())
    }
}

/// −1 where chance swaps the sides of a pair of the null control; 1 in all other runs.
fn sign(settings: &LearnSettings, edit: &Edit, work: &MatchWork) -> f64 {
    if null_control::swaps(settings, edit, work.stream as u8, work.index) { -1.0 } else { 1.0 }
}

fn ahead(played: &LearningMatch) -> f64 {
    let [ours, theirs] = played.goals;
    f64::from(ours) - f64::from(theirs)
}

/// Matches against an opponent count as lowered from here on: p < 0.025 on one side.
const LOWERED_Z: f64 = -1.96;
/// Differences of whole matches beyond this count as this, goals.
const GOALS_MAX: f64 = 20.0;

#[cfg(test)]
mod tests;
