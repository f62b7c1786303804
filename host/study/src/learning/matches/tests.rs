//! Tests: equal runs for any number of threads and after a kill, which play matches (run in release); a
//! harmful case and the null control, in a made-up world.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use crate::store::Shard;
use crate::testing::{Directory, on_threads};

use super::value::value;
use super::*;
use crate::learning::evidence::Evidence;
use crate::learning::journal::JournalPlayer;
use crate::learning::player::PlayError;
use crate::learning::starts::Worlds;
use crate::learning::trial::Situation;

static STOPPED: AtomicBool = AtomicBool::new(false);

fn authored() -> Files {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    Files::read(&root.join("../../casebase/library/cases/division-b")).unwrap()
}

fn settings(shuffle: bool) -> LearnSettings {
    LearnSettings {
        seed: 5,
        budget: 1,
        kinds: Kind::ALL.into(),
        worlds: Worlds::Simulated,
        error_rate: 0.1,
        tries: 10,
        refused: BTreeSet::new(),
        shuffle,
        dry_run: false,
    }
}

/// Short beginnings, so that a test takes seconds.
const SIZES: Sizes = Sizes { beginning_ms: 80_000, explore: 6, look: 6, validate: 6, proposals: 2 };

fn candidates(current: &Variant, explored: &Played, edits: &[(&str, Change)]) -> Vec<Candidate> {
    let candidate = |(case, change): &(&str, Change)| {
        let edit = Edit { case: (*case).to_owned(), change: change.clone() };
        let variant = current.edited(&edit).unwrap();
        let proposal = Proposal { kind: Kind::Actions, edit, reason: String::new(), weight: 1.0 };
        let touched = explored.touched(&proposal.edit);
        Candidate::new(proposal, variant, (touched, explored.matches.len()))
    };
    edits.iter().map(candidate).collect()
}

/// Matches of the authored library, and what edits of its most frequent cases make of them.
fn round(player: &mut impl for<'u> Player<MatchUnit<'u>>) -> String {
    let current = Variant::new(authored()).unwrap();
    let settings = settings(false);
    let world = Matches { sizes: SIZES, player };
    let mut run = Run::new(world, current.clone(), Evidence::default(), &settings);
    let explored = Matches::fresh(&mut run, StartStream::Exploration).unwrap();
    Matches::collect(&mut run, &explored);
    let edits = [
        ("front/shot-and-decoy", Change::Forget),
        ("front-side/near-post", Change::BallScope([400, 400])),
        ("center/kick-off", Change::Forget),
        ("center/one-two", Change::Forget),
        ("side/up-the-line", Change::Forget),
    ];
    let mut tried = candidates(&current, &explored, &edits);
    Matches::play_pairs(&mut run, &explored, &mut tried, 0..usize::MAX).unwrap();
    // A case that was never among the actions is forgotten without a trace.
    let rare = ["back/keeper-out", "corner/short", "center/third-man"].map(|case| (case, Change::Forget));
    let mut untouched = candidates(&current, &explored, &rare);
    let unlisted = |case: &str| (0..6).find(|i| !explored.listed[*i].contains(case));
    for one in &mut untouched {
        one.touched = unlisted(&one.proposal.edit.case).into_iter().collect();
    }
    Matches::play_pairs(&mut run, &explored, &mut untouched, 0..1).unwrap();
    let pairs: Vec<_> = untouched.iter().map(|one| one.wager).collect();
    assert!(pairs.iter().all(|wager| (wager.raised, wager.lowered) == (0, 0)), "{pairs:?}");
    let wagers: Vec<_> = tried.iter().map(|candidate| candidate.wager).collect();
    format!("{wagers:?} {} {:?}\n{}", run.spent, explored.matches, run.evidence.to_jsonl())
}

#[test]
fn threads_and_a_kill_change_nothing_and_a_match_is_that_beside_it_up_to_the_edit() {
    let Directory(directory) = &Directory::new("learning-matches");
    let in_journal = |threads| {
        on_threads(threads, || {
            let player =
                JournalPlayer::<LearningMatch>::open(directory, "{}", Shard::WHOLE, 5, &STOPPED, &|_| {});
            round(&mut player.unwrap())
        })
    };
    let first = in_journal(2);
    let file = directory.join("journal-1-of-1.jsonl");
    let text = std::fs::read(&file).unwrap();
    std::fs::write(&file, &text[..text.len() / 2]).unwrap();
    assert!(in_journal(1) == first, "killed in the middle of a line, and on one thread");
    let matches: Vec<LearningMatch> = String::from_utf8_lossy(&text)
        .lines()
        .skip(1)
        .map(|line| {
            serde_json::from_value(
                serde_json::from_str::<serde_json::Value>(line).unwrap()["trials"][0].clone(),
            )
            .unwrap()
        })
        .collect();
    let edited = matches.iter().filter(|played| played.same_until_s.is_some());
    assert!(edited.clone().count() > 0, "an edit that is felt");
    for played in edited {
        let same = played.same_until_s.unwrap() as usize;
        let beside = |other: &&LearningMatch| other.seconds[..same] == played.seconds[..same];
        assert!(matches.iter().filter(|other| other.same_until_s.is_none()).any(|other| beside(&other)));
        assert_eq!(played.seconds.len(), same + (SCENE_MS / 1000) as usize);
    }
}

/// A made-up world in which a case loses the ball to a shot at our goal in three of four matches, and without
/// it we shoot.
struct WithHarm;

const HARMFUL: &str = "front/shot";

impl<'u> Player<MatchUnit<'u>> for WithHarm {
    fn play(&mut self, units: &[MatchUnit<'u>]) -> Result<Vec<Vec<LearningMatch>>, PlayError> {
        let played = units.iter().map(|MatchUnit { variant, work, beside }| {
            let id = |name: &str| variant.names().iter().position(|known| known == name).map(|n| n as u16);
            let harmed = id(HARMFUL).is_some();
            let situation = Situation {
                ball: [3000, 200],
                defending_positive: false,
                teammates: vec![(1, [2900, 200]), (2, [2500, 900])],
                opponents: vec![[4300, 0]],
            };
            let plays = [(HARMFUL, false), ("front/long-shot", true)].into_iter();
            let plays: Vec<_> = plays.filter_map(|(name, goal)| Some((id(name)?, goal))).collect();
            let decision = |(id, goal): &(u16, bool)| MatchDecision {
                situation: situation.clone(),
                case: 4 * id,
                end: Some(0),
                goal: *goal,
            };
            let felt = !harmed && beside.is_some();
            let ours = !harmed || work.index % 4 == 0;
            vec![LearningMatch {
                goals: [1 + u32::from(ours), 1],
                decisions: plays.iter().map(decision).collect(),
                listed: plays.iter().map(|(id, _)| *id).collect(),
                marks: vec![Mark { at_ms: 15_000, ours, kind: MarkKind::ShotOpen }],
                seconds: (0..90).map(|second| if second < 10 || harmed { second } else { !second }).collect(),
                same_until_s: felt.then_some(10),
            }]
        });
        Ok(played.collect())
    }
}

#[test]
fn a_harmful_case_is_forgotten_and_none_in_the_null_control() {
    let learned = |shuffle| {
        let settings = LearnSettings { budget: 1800, ..settings(shuffle) };
        learn_matches(authored(), Collected::default(), &settings, &mut WithHarm).unwrap()
    };
    let found = learned(false);
    let forgotten: Vec<_> = found.accepted().map(|change| change.proposal.edit.to_string()).collect();
    assert_eq!(forgotten, [format!("{HARMFUL}: forgotten")]);
    assert!(!found.end.names().iter().any(|name| name == HARMFUL));
    let validation = found.accepted().next().and_then(|change| change.validation.clone()).unwrap();
    assert!(validation.all.gain() > 0.0 && validation.kinds.len() == 3);
    assert!(crate::learning::page::json(&found).to_string().contains("\"starts\":\"marking\""));
    assert_eq!(learned(true).accepted().count(), 0, "null control");
}

#[test]
fn a_scene_is_worth_the_goals_expected_of_its_shots_and_goals_without_one() {
    let mark = |at_ms, ours, kind| Mark { at_ms, ours, kind };
    let marks = [
        mark(900, true, MarkKind::ShotOpen),
        mark(2_000, true, MarkKind::ShotPartlyOpen),
        mark(3_500, true, MarkKind::Goal),
        mark(9_000, false, MarkKind::ShotClosed),
        mark(30_000, false, MarkKind::Goal),
    ];
    assert!((value(&marks, 1_000) - 0.17).abs() < 1e-9);
    assert_eq!(value(&marks, 0), 0.5, "at most half a goal");
    assert_eq!(value(&marks, 20_000), -0.5, "a goal that no shot led to");
}

#[test]
fn opponents_and_ends_take_turns_and_no_two_matches_have_a_seed() {
    let mut seen = BTreeSet::new();
    for stream in [StartStream::Exploration, StartStream::Confirmation, StartStream::Validation] {
        seen.extend((0..60).map(|index| MatchWork { stream, index, until_ms: 1 }.seed(7)));
    }
    assert_eq!(seen.len(), 180);
}
