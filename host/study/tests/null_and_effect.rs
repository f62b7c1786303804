//! `null_and_effect`: the whole of learning on made-up outcomes whose truth is known: chance alone, or a
//! rule.

use std::collections::BTreeSet;
use std::path::Path;

use case_tools::Files;
use hil_sim::{Fnv, Stream, TrialOutcome};
use study::learning::{
    Collected, Evidence, Kind, LearnSettings, LearningTrial, PlayError, Player, Situation, TrialDecision,
    Unit, Variant, Verdict, Work, Worlds, learn,
};

/// Outcomes by a rule: the chance of a goal for a library and the case that is played.
struct Rule<F>(F);

impl<'u, F: Fn(&Variant, &str) -> f32> Player<Unit<'u>> for Rule<F> {
    fn play(&mut self, units: &[Unit<'u>]) -> Result<Vec<Vec<LearningTrial>>, PlayError> {
        let one = |unit: &Unit<'_>| {
            let numbers: Vec<u32> = match &unit.work {
                Work::Starts { indices, .. } => indices.clone(),
                Work::Situation { first, trials, .. } => (*first..first + trials).collect(),
            };
            numbers.iter().map(|number| trial(unit, *number, &self.0)).collect()
        };
        Ok(units.iter().map(one).collect())
    }
}

fn trial(unit: &Unit<'_>, number: u32, rule: &impl Fn(&Variant, &str) -> f32) -> LearningTrial {
    let mut hash = Fnv::default();
    // The situation is the start's; the outcome differs with what is played in it.
    let situation = match &unit.work {
        Work::Starts { stream, .. } => {
            hash.add(&[*stream as u8]);
            hash.add(&number.to_le_bytes());
            situation(hash.value())
        }
        Work::Situation { situation, .. } => {
            hash.add(&number.to_le_bytes());
            hash.add(&serde_json::to_vec(situation).unwrap());
            situation.clone()
        }
    };
    let base = unit.variant.base();
    let answer = unit.variant.answer(&base, &situation.problem());
    hash.add(format!("{answer:?}").as_bytes());
    let played = answer.as_ref().map_or("", |(name, _, _)| name);
    let goal = Stream::new(hash.value(), "outcome").chance(rule(unit.variant, played));
    let case = answer.as_ref().and_then(|(name, symmetry, _)| {
        let number = unit.variant.names().iter().position(|known| known == name)?;
        Some(4 * number as u16 + symmetry)
    });
    let outcome = if goal { TrialOutcome::Goal } else { TrialOutcome::Out };
    let decision = TrialDecision { situation, case, retrieved: true, end: Some(0) };
    LearningTrial { outcome, touches: 0, decisions: vec![decision] }
}

fn situation(seed: u64) -> Situation {
    let mut chance = Stream::new(seed, "situation");
    let mut place =
        |x: [f32; 2], y: [f32; 2]| [chance.between(x[0], x[1]) as i32, chance.between(y[0], y[1]) as i32];
    let ball = place([-2000.0, 1200.0], [-1400.0, 1400.0]);
    let [x, y] = ball.map(|value| value as f32);
    Situation {
        ball,
        defending_positive: false,
        teammates: vec![
            (1, [ball[0] - 300, ball[1]]),
            (2, place([x - 1200.0, x + 600.0], [y - 1200.0, y + 1200.0])),
        ],
        opponents: vec![place([900.0, 2050.0], [-1800.0, 1800.0]), place([2050.0, 2700.0], [-650.0, 650.0])],
    }
}

fn files() -> Files {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    Files::read(&root.join("../../casebase/library/cases/four-legged")).unwrap()
}

fn settings(seed: u64, budget: u64, kinds: &[Kind]) -> LearnSettings {
    LearnSettings {
        seed,
        budget,
        kinds: kinds.iter().copied().collect::<BTreeSet<_>>(),
        error_rate: 0.1,
        tries: 100,
        worlds: Worlds::Both,
        refused: BTreeSet::new(),
        shuffle: false,
        dry_run: false,
    }
}

#[test]
fn where_every_change_is_chance_hardly_any_is_accepted() {
    let (mut proposed, mut tested, mut accepted) = (0, 0, 0);
    for seed in 1..=6 {
        let mut player = Rule(|_: &Variant, _: &str| 0.4);
        let kinds = [Kind::Scopes, Kind::Forget];
        let learned =
            learn(files(), Collected::default(), &settings(seed, 60_000, &kinds), &mut player).unwrap();
        proposed += learned.changes.len();
        tested += learned.tests;
        accepted += learned.accepted().count();
    }
    assert!(proposed >= 100 && tested >= 20, "{proposed} proposed, {tested} tested");
    // The stated rate bounds the share of runs with a wrong change by 0.1: two of six have p = 0.11.
    assert!(accepted * 20 <= proposed && accepted <= 2, "{accepted} of {proposed}");
}

#[test]
fn a_harmful_case_is_forgotten_and_nothing_else_is() {
    let harmful = "center/close-in";
    // Its plays alone are worse, as a case in the library that harms where it is played.
    let rule = |_: &Variant, played: &str| if played == harmful { 0.3 } else { 0.55 };
    let mut player = Rule(rule);
    let learned =
        learn(files(), Collected::default(), &settings(3, 100_000, &[Kind::Forget]), &mut player).unwrap();
    let tried = learned.changes.iter().any(|change| change.proposal.edit.case == harmful);
    let accepted: Vec<_> = learned.accepted().map(|change| change.proposal.edit.case.as_str()).collect();
    assert_eq!(accepted, if tried { vec![harmful] } else { vec![] });
    assert!(tried, "the case with the most plays is tried");
    // Another case, or none, would take over from each.
    assert!(learned.changes.iter().all(|change| change.proposal.reason.contains("; in its place: ")));
    assert_eq!(learned.end.names().len(), 33);
    // A change that an author has refused is not proposed, and others are.
    let refused = BTreeSet::from([learned.accepted().next().unwrap().proposal.edit.clone()]);
    let settings = LearnSettings { refused, ..settings(3, 20_000, &[Kind::Forget]) };
    let without = learn(files(), Collected::default(), &settings, &mut Rule(rule)).unwrap();
    assert!(!without.changes.is_empty());
    assert!(without.changes.iter().all(|change| change.proposal.edit.case != harmful));
}

#[test]
fn a_confirmed_change_that_lowers_the_validation_starts_is_refused() {
    // The rule turns over on validation starts: what helps elsewhere harms there.
    struct Turned;
    impl Player<Unit<'_>> for Turned {
        fn play(&mut self, units: &[Unit<'_>]) -> Result<Vec<Vec<LearningTrial>>, PlayError> {
            let one = |unit: &Unit<'_>| {
                let turned = matches!(
                    &unit.work,
                    Work::Starts { stream: study::learning::StartStream::Validation, .. }
                );
                let few = unit.variant.names().len() < 34;
                let mut rule = Rule(|_: &Variant, _: &str| if few == turned { 0.3 } else { 0.55 });
                rule.play(std::slice::from_ref(unit)).map(|mut trials| trials.remove(0))
            };
            units.iter().map(one).collect()
        }
    }
    let learned =
        learn(files(), Collected::default(), &settings(5, 100_000, &[Kind::Forget]), &mut Turned).unwrap();
    assert!(learned.changes.iter().any(|change| change.verdict == Verdict::Lowers));
    // A change of which validation sees less than this many pairs that differ may pass by luck.
    let seen = |change: &study::learning::ChangeRecord| {
        change.validation.as_ref().is_some_and(|pairs| pairs.all.raised + pairs.all.lowered >= 10)
    };
    let confirmed = learned.changes.iter().filter(|change| seen(change));
    let verdicts: Vec<_> = confirmed.map(|change| change.verdict).collect();
    assert!(
        verdicts.len() >= 5 && verdicts.iter().all(|verdict| *verdict == Verdict::Lowers),
        "{verdicts:?}"
    );
}

#[test]
fn evidence_does_not_depend_on_the_order_of_shards() {
    let mut player = Rule(|_: &Variant, _: &str| 0.4);
    let dry = LearnSettings { dry_run: true, ..settings(1, 20_000, &[Kind::Scopes]) };
    let learned = learn(files(), Collected::default(), &dry, &mut player).unwrap();
    assert_eq!(learned.end.hash, learned.start.hash);
    assert!(learned.changes.iter().all(|change| change.verdict != Verdict::Accepted));
    let halves = learned.evidence.0.iter().enumerate().fold(
        [Evidence::default(), Evidence::default()],
        |mut halves, (i, (key, counts))| {
            halves[i % 2].0.insert(key.clone(), counts.clone());
            halves
        },
    );
    let [a, b] = halves;
    assert_eq!(a.clone().merge(b.clone()), learned.evidence);
    assert_eq!(b.merge(a).to_jsonl(), learned.evidence.to_jsonl());
}

#[test]
fn a_draft_of_recorded_play_is_tried_as_others_and_accepted_where_it_raises() {
    let play = r#"{"play":{"field":[5400,3600],"teammates":[[1,[-350,100]],[2,[900,-700]]],"opponents":[],
        "holdings":[{"robot":1,"got":[-150,100],"left":[-150,100]},{"robot":2,"got":[900,-700],"left":[900,-700]}],
        "end":{"shot":280},"goal":true}}"#;
    let recorded = Collected::from_jsonl(&play.replace('\n', " ")).unwrap();
    let empty = files().cases.iter().fold(files(), |files, case| files.without(&case.name));
    let run = |from: &Collected, better: f32| {
        let mut player =
            Rule(move |_: &Variant, played: &str| if played.contains("recorded-") { better } else { 0.4 });
        learn(empty.clone(), from.clone(), &settings(3, 20_000, &[Kind::New]), &mut player).unwrap()
    };
    let learned = run(&recorded, 0.9);
    let of = |verdict: Verdict| {
        let changes = learned.changes.iter().filter(move |change| change.verdict == verdict);
        changes.filter(|change| change.proposal.edit.case.contains("recorded-")).count()
    };
    assert!(of(Verdict::Accepted) > 0, "{:?}", learned.changes);
    assert!(learned.end.names().iter().any(|name| name.contains("recorded-")));
    assert_eq!(
        study::learning::json(&learned),
        study::learning::json(&run(&recorded, 0.9)),
        "the same result twice"
    );
    let worse = run(&recorded, 0.1);
    assert!(worse.end.names().iter().all(|name| !name.contains("recorded-")));
    let without = run(&Collected::default(), 0.9);
    assert!(without.changes.iter().all(|change| !change.proposal.edit.case.contains("recorded-")));
}
