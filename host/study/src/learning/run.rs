//! `run`: rounds of learning: explore, propose, screen, confirm, validate; the same for trials and matches.
//!
//! ```text
//! exploration ─► evidence ─► proposals ─► screening (halving) ─► finalists
//!                                                                    │ fresh starts, sequential test
//! library ◄── accepted ◄── validation starts, paired by seed ◄── confirmed
//! ```
//! Screening chooses and proves nothing: only play on starts that no proposal was drawn from or chosen by
//! counts in a test. Everything is a function of the files, the settings and the outcomes of play. What is
//! played, and what a pair of plays is worth, is the [`World`]'s.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::learning::betting::Wager;
use crate::learning::edit::Edit;
use crate::learning::evidence::Evidence;
use crate::learning::player::PlayError;
use crate::learning::plays::PlayToWatch;
use crate::learning::proposals::{Proposal, Tried};
use crate::learning::results::{ChangeRecord, CurvePoint, Learned, Validation, Verdict, note_tried};
use crate::learning::settings::LearnSettings;
use crate::learning::starts::StartStream;
use crate::learning::variant::{Variant, VariantError};

pub(super) type LearnResult<T> = Result<T, LearnError>;

/// Error that ended learning without a result.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub enum LearnError {
    /// The library to learn from is refused.
    Library(VariantError),
    /// Trials could not be played.
    Play(#[from] PlayError),
}

/// Numbers of screening: proposals are tried in ever more pairs, and fewer of them each time.
pub(super) struct Screening {
    /// Situations or matches that a proposal must change to be tried.
    pub(super) touched_min: usize,
    /// Steps: pairs of a proposal so far, and of how many proposals one goes on.
    pub(super) steps: [(usize, usize); 3],
    /// Largest number of proposals of a round that are tested.
    pub(super) finalists: usize,
    /// Standard deviations above zero in screening from which on a proposal is tested.
    pub(super) finalist_z: f64,
}

pub(super) struct Testing {
    /// Looks that decide whether a test goes on, at most.
    pub(super) looks: usize,
    /// A test ends where the difference is below this at the first look, standard deviations.
    pub(super) hopeless_z: f64,
    /// Rise of that limit a look.
    pub(super) hopeless_step: f64,
}

/// Units that a run plays, and how it reads off them what a change is worth.
pub(super) trait World: Sized {
    /// Units of the newest library on starts of a stream, with what became of them.
    type Played;
    /// Situations or matches in which screening compares.
    type Ground;
    /// Plays with a change that a look at a test leaves for the library with it.
    type Changed;
    const SCREENING: Screening;
    const TESTING: Testing;
    /// Successive rounds without a proposal after which a run ends.
    const IDLE_ROUNDS: u32;

    /// Plays starts of a stream that no other step has seen.
    fn fresh(run: &mut Run<'_, Self>, stream: StartStream) -> LearnResult<Self::Played>;

    /// Adds what was played to the evidence; in the null control with the outcomes of other plays.
    fn collect(run: &mut Run<'_, Self>, played: &Self::Played);

    /// Changes that are worth a try, by the evidence.
    fn propose(run: &mut Run<'_, Self>, played: &Self::Played) -> LearnResult<Vec<Proposal>>;

    /// Situations or matches in which a round's proposals are screened.
    fn ground(run: &Run<'_, Self>, played: Self::Played) -> Self::Ground;

    /// Numbers of the situations or matches that an edit may change, and how many there are.
    fn touched(ground: &Self::Ground, edit: &Edit, edited: &Variant) -> (Vec<usize>, usize);

    /// Plays the pairs of candidates in a range of the situations that each may change, and bets on them.
    fn play_pairs(
        run: &mut Run<'_, Self>,
        ground: &Self::Ground,
        tried: &mut [Candidate],
        range: Range<usize>,
    ) -> LearnResult<()>;

    /// Looks once at a test: bets on a block of starts as the newest library plays them.
    fn look(
        run: &mut Run<'_, Self>,
        candidate: &mut Candidate,
        block: &Self::Played,
    ) -> LearnResult<Self::Changed>;

    /// Judges a confirmed candidate on validation starts; `kept` holds those that another candidate was
    /// judged on.
    fn validate(
        run: &mut Run<'_, Self>,
        candidate: &Candidate,
        kept: &mut Option<Self::Played>,
    ) -> LearnResult<(Verdict, Validation)>;

    /// Makes the blocks those of the library with the accepted candidate.
    fn renew(
        run: &mut Run<'_, Self>,
        candidate: &Candidate,
        blocks: &mut Vec<Self::Played>,
        changed: Vec<Self::Changed>,
    ) -> LearnResult<()>;

    /// Measures a new library on held-out starts, for the learning curve.
    fn measure(_: &mut Run<'_, Self>) -> LearnResult<()> {
        Ok(())
    }

    /// Held-out starts that only the learned library brings to goal.
    fn plays_to_watch(_: &Run<'_, Self>) -> Vec<PlayToWatch> {
        Vec::new()
    }

    /// The opponents of matches; empty where trials are played.
    fn opponents() -> Vec<String> {
        Vec::new()
    }
}

/// A run of learning: its world, and what it knows so far.
pub(super) struct Run<'s, W> {
    pub(super) world: W,
    pub(super) settings: &'s LearnSettings,
    /// The newest library.
    pub(super) current: Variant,
    /// The present round, from 1.
    pub(super) round: u32,
    pub(super) evidence: Evidence,
    /// Hashes of the libraries so far, oldest first.
    pub(super) libraries: Vec<u64>,
    pub(super) tried: Tried,
    /// Part of the budget that was used.
    pub(super) spent: u64,
    /// Keys of units that the budget counts once, however often they are asked for.
    pub(super) asked: BTreeSet<u64>,
    pub(super) tests: u32,
    pub(super) accepted: u32,
    /// Starts of each stream that were used up.
    used: BTreeMap<StartStream, u32>,
    pub(super) changes: Vec<ChangeRecord>,
    pub(super) curve: Vec<CurvePoint>,
}

pub(super) struct Candidate {
    pub(super) proposal: Proposal,
    pub(super) variant: Variant,
    pub(super) wager: Wager,
    /// The same by group of situations, where the world tells groups apart.
    pub(super) groups: Vec<Wager>,
    /// Numbers of the drawn situations or matches that it may change.
    pub(super) touched: Vec<usize>,
    pub(super) share: f64,
}

impl Candidate {
    /// A candidate that changes `touched` of `drawn` situations or matches.
    pub(super) fn new(proposal: Proposal, variant: Variant, (touched, drawn): (Vec<usize>, usize)) -> Self {
        let share = touched.len() as f64 / drawn.max(1) as f64;
        Self { proposal, variant, wager: Wager::default(), groups: Vec::new(), touched, share }
    }

    /// Numbers of the touched situations in a range.
    pub(super) fn chosen(&self, range: &Range<usize>) -> Vec<usize> {
        let end = range.end.min(self.touched.len());
        self.touched[range.start.min(end)..end].to_vec()
    }

    /// Estimate of its worth: its gain where it changes play less a standard error, times the share of such
    /// situations. Validation refuses what lowers one kind of starts, so in no group may the gain be below
    /// zero by more than a standard error.
    pub(super) fn promise(&self) -> f64 {
        let groups = self.groups.iter().filter(|wager| wager.pairs > 0);
        let worst = groups.map(|wager| wager.bounded_gain(1.0)).fold(f64::INFINITY, f64::min);
        let gain = self.wager.bounded_gain(-1.0).min(worst);
        // A pessimistic gain below zero is not made better by being rare.
        if gain > 0.0 { gain * self.share } else { gain }
    }
}

impl<'s, W: World> Run<'s, W> {
    pub(super) fn new(world: W, start: Variant, evidence: Evidence, settings: &'s LearnSettings) -> Self {
        Self {
            world,
            settings,
            current: start,
            round: 0,
            evidence,
            libraries: Vec::new(),
            tried: Tried::new(),
            spent: 0,
            asked: BTreeSet::new(),
            tests: 0,
            accepted: 0,
            used: BTreeMap::new(),
            changes: Vec::new(),
            curve: Vec::new(),
        }
    }

    /// Learns until the budget is used up or nothing is left to try.
    pub(super) fn learn(mut self) -> LearnResult<Learned> {
        let (start, settings) = (self.current.clone(), self.settings);
        self.libraries.push(start.hash);
        W::measure(&mut self)?;
        let mut idle = 0;
        for round in 1.. {
            self.round = round;
            let (before, hash) = (self.changes.len(), self.current.hash);
            self.play_round()?;
            if self.current.hash != hash {
                self.libraries.push(self.current.hash);
                W::measure(&mut self)?;
            } else if let Some(last) = self.curve.last().cloned() {
                self.curve.push(CurvePoint { round, spent: self.spent, ..last });
            }
            idle = if self.changes.len() == before { idle + 1 } else { 0 };
            let exhausted = idle == W::IDLE_ROUNDS || self.tests >= settings.tries;
            if settings.dry_run || exhausted || self.spent >= settings.budget {
                break;
            }
        }
        Ok(Learned {
            settings: settings.clone(),
            start,
            plays: W::plays_to_watch(&self),
            end: self.current,
            evidence: self.evidence,
            changes: self.changes,
            curve: self.curve,
            spent: self.spent,
            tests: self.tests,
            opponents: W::opponents(),
        })
    }

    fn play_round(&mut self) -> LearnResult<()> {
        let explored = W::fresh(self, StartStream::Exploration)?;
        W::collect(self, &explored);
        let proposals = W::propose(self, &explored)?;
        let (before, library) = (self.changes.len(), self.current.clone());
        let ground = W::ground(self, explored);
        let finalists = self.screen(&ground, proposals)?;
        if !self.settings.dry_run {
            self.judge(finalists)?;
            note_tried(&mut self.tried, &library, &self.changes[before..]);
        }
        Ok(())
    }

    /// Takes `count` starts of a stream that no step has seen; returns the number of the first.
    pub(super) fn take(&mut self, stream: StartStream, count: u32) -> u32 {
        let used = self.used.entry(stream).or_default();
        *used += count;
        *used - count
    }
}
