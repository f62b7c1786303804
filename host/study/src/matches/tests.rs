//! Tests: plans keep their worlds, and the sums are right.

use std::fs;
use std::path::Path;

use arena::game::StrategyReport;
use hil_sim::small_size::worlds::{WorldChoice, WorldPlan};
use host::strategy::Team;
use host::strategy::counters::CapCounters;

use super::*;
use crate::store::{Shard, in_words, to_csv};
use crate::testing::Directory;

/// Matches of our team against these opponents in division B.
fn plan(seed: u64, duration_s: f64, matches: u32, opponents: &[MatchTeam]) -> MatchPlan {
    MatchPlan {
        seed,
        league: "division-b".to_owned(),
        world: WorldPlan::default(),
        duration_s,
        pairings: MatchPlan::against(MatchTeam::ours(), opponents),
        matches,
        strategy: None,
        controller: None,
    }
}

fn matches(plan: MatchPlan) -> Matches {
    Matches {
        plan,
        base: case_library::division_b(),
        settings: RetrievalSettings::default(),
        program: "test".to_owned(),
        names: CaseNames::default(),
        refusals: None,
    }
}

#[test]
fn evaluations_of_different_worlds_differ_and_a_plan_keeps_its_world() {
    let of = |world| matches(MatchPlan { world, ..plan(4, 4.0, 2, &[Team::Reactive.into()]) });
    let named: WorldPlan = "grsim".parse().unwrap();
    let (nominal, grsim, random) = (of(WorldPlan::default()), of(named), of(WorldPlan::RandomPerMatch));
    let differences =
        |own: &Matches, other: &Matches| in_words(&own.identity().differences(&other.identity()));
    assert_eq!(differences(&nominal, &grsim), "world nominal, not grsim");
    assert_eq!(differences(&grsim, &random), "world grsim, not random");
    let planned = random.plan.get(1).unwrap();
    assert_eq!(random.config(&planned).unwrap().world, WorldChoice::Random(planned.seed));
    assert_eq!(grsim.config(&planned).unwrap().world.to_string(), "grsim");
    for matches in [nominal, grsim, random] {
        let json = serde_json::to_string(&matches.plan).unwrap();
        assert_eq!(serde_json::from_str::<MatchPlan>(&json).unwrap(), matches.plan);
        // A file of a version with a single world.
        let older = json.replace(&format!("\"world\":\"{}\",", matches.plan.world), "");
        assert_eq!(serde_json::from_str::<MatchPlan>(&older).unwrap().world, WorldPlan::default());
    }
}

fn row(number: usize, goals: [u32; 2], halves: [f32; 2], shots: [u32; 2]) -> MatchRow {
    MatchRow {
        number,
        own: MatchTeam::ours(),
        opponent: Team::Zone.into(),
        own_is_blue: true,
        seed: 1,
        ball_in_play: 0.5,
        sides: [
            MatchSide {
                goals: goals[0],
                other_half_s: halves[0],
                shots: shots[0],
                possession_s: 30.0,
                attack: "end.shot:3 end.tackle:1 kick.2-3/1-2/team:3 kick.2-3/1-2/lost:1 shot.open:2 shot.goal:1 left-ball:1"
                    .to_owned(),
                restart_passes: "flat.received:3 flat.out:1".to_owned(),
                calibration: "9:4:3.6:3".to_owned(),
                cap: CapCounters { attempts: 2, successes: 1, reuses: 1, reuse_successes: 0 },
                role_changes: 5,
                fouls: "bot_pushed_bot:2".to_owned(),
                cases: "center/pass@6:retrieved=2,pass=1,arrived=1,end.finished=1,end.timeout=1,then.goal=1,then.loss=1"
                    .to_owned(),
                ..MatchSide::default()
            },
            MatchSide {
                goals: goals[1],
                other_half_s: halves[1],
                shots: shots[1],
                possession_s: 10.0,
                restart_passes: "chip.received:1".to_owned(),
                calibration: "4:1:0.45:1".to_owned(),
                ..MatchSide::default()
            },
        ],
        trace_hash: String::new(),
    }
}

#[test]
fn a_row_keeps_its_41_columns_and_is_read_as_it_was_written() {
    let written = row(7, [2, 1], [200.0, 100.5], [6, 2]);
    let csv = to_csv(std::slice::from_ref(&written)).unwrap();
    let mut reader = csv::Reader::from_reader(&csv[..]);
    let columns = reader.headers().unwrap().clone();
    assert_eq!(columns.len(), 41);
    let order =
        ["number", "own", "opponent", "own_is_blue", "seed", "goals", "goals_against", "ball_in_play"];
    assert_eq!(columns.iter().take(8).collect::<Vec<_>>(), order);
    let read: MatchRow = reader.deserialize().next().unwrap().unwrap();
    assert_eq!(read, written);
}

#[test]
fn ratios_goals_and_intervals_are_those_counted_by_hand() {
    let plan = MatchPlan { league: "ssl-2013".to_owned(), ..plan(1, 600.0, 3, &[Team::Zone.into()]) };
    let rows = [
        row(0, [2, 0], [200.0, 100.0], [6, 2]),
        row(1, [1, 1], [100.0, 100.0], [4, 4]),
        row(2, [3, 0], [300.0, 100.0], [5, 0]),
    ];
    let outcome = outcomes(&plan, &rows).remove(0);
    assert_eq!(outcome.won_drawn_lost, [2, 1, 0]);
    assert_eq!(outcome.goals, [6, 1]);
    let line = &outcome.cases[0].cases[0];
    assert_eq!((&*line.case, line.all.retrieved, line.all.ends["timeout"]), ("center/pass", 6, 3));
    assert_eq!(line.all.followed_by, [("goal".to_owned(), 3), ("loss".to_owned(), 3)].into());
    let table = case_table(outcome.own, &outcome.cases[0]);
    assert!(
        table.contains("| center/pass | 6 | 3 | 3 timeout | 3 | 3 | 3 | 0 | 3 | 0 | 0 | 6: 6 |"),
        "{table}"
    );
    assert_eq!(outcome.cases[1].retrieved, 0);
    // 2, 1 and 3: mean 2, spread 1; t(2) at 97.5 % is 4.3027, over √3 2.4841.
    let offence = outcome.offence_ratio.unwrap();
    assert!((offence.mean - 2.0).abs() < 1e-9);
    // Its lower end would be −0.4841: a ratio is never below 0.
    assert!((offence.high.unwrap() - 4.4841).abs() < 1e-3 && offence.low == Some(0.0));
    // 3 and 1; the third match has none.
    let attack = outcome.attack_ratio.unwrap();
    assert!((attack.mean - 2.0).abs() < 1e-9 && attack.matches == 2);
    assert!((outcome.attack_ratio_of_all.unwrap() - 2.5).abs() < 1e-9);
    // Differences 2, 0 and 3: mean 5/3, spread 1.5275, t = 1.8898, p of two sides with 2 degrees 0.1994.
    assert!((outcome.goals_p.unwrap() - 0.1994).abs() < 1e-3, "{:?}", outcome.goals_p);
    assert!((outcome.possession.unwrap().mean - 0.75).abs() < 1e-9);
    let played = |(row, ball_in_play): (&MatchRow, f32)| MatchRow { ball_in_play, ..row.clone() };
    let in_play: Vec<_> = rows.iter().zip([1.0, 0.5, 1.0]).map(played).collect();
    // 0.8333 ± 0.7171: no share is more than 1.
    let in_play = outcomes(&plan, &in_play).remove(0).ball_in_play.unwrap();
    assert!((in_play.low.unwrap() - 0.1162).abs() < 1e-3 && in_play.high == Some(1.0));
    assert_eq!(outcome.fouls[0]["bot_pushed_bot"], 6);
    let ours = our_passes(&rows);
    let text = markdown(std::slice::from_ref(&outcome), &[], &ours);
    assert!(text.contains("| ours | zone | 3 | 2, 1, 0 | 6 : 1 |"), "{text}");
    // Twelve flat passes of three matches, nine arrived: Wilson's 0.4677 to 0.9111. Six planned, half of
    // them.
    assert!(text.contains("| ours | zone | flat | 12 | 12 | 9 | 0.75 (0.47 to 0.91) |"), "{text}");
    assert!(text.contains("| zone | ours | chip | 3 | 3 | 3 | 1.00 (0.44 to 1.00) |"), "{text}");
    assert!(text.contains("| ours | zone | 3 | 6 | 3 | 0.50 (0.19 to 0.81) | 3 | 0 |"), "{text}");
    assert!(
        text.contains("| ours | zone | 4.0 | 0 % | 75 % | 0 % | 25 % | 0 % | 0 % | 0 % | 4.0 | 75 % | 2.0 | 0 % | 100 % | 0 % | 50 % | 1.0 |"),
        "{text}"
    );
    assert!(text.contains("| 0.9 to 1.0 | 12 | 0.90 | 9 | 0.75 (0.47 to 0.91) |"), "{text}");
    assert!(text.contains("Team F (RR)") && text.contains("| Team H | 1 | 11 | 11 |"), "{text}");
    assert!(plot(&[outcome]).contains("ours – zone"));
    let drawn = calibration_plot(&ours);
    assert!(drawn.contains(">12<") && drawn.matches("<ellipse").count() == 1, "{drawn}");
}

#[test]
fn a_part_is_worth_what_the_side_with_it_was_ahead() {
    let without = MatchTeam::parse("ours-without-second-level").unwrap();
    let plan = plan(1, 600.0, 2, &[without, Team::Zone.into()]);
    let of = |row: MatchRow| MatchRow { opponent: without, ..row };
    let rows = [
        of(row(0, [2, 0], [200.0, 100.0], [7, 1])),
        of(row(1, [0, 1], [50.0, 400.0], [0, 0])),
        row(2, [9, 0], [9.0, 1.0], [9, 0]),
    ];
    let effects = effects(&plan, &rows);
    assert_eq!(effects.len(), 1, "another team lacks no part");
    let effect = &effects[0];
    assert_eq!((&*effect.part, effect.with, effect.matches), ("second-level", MatchTeam::ours(), 2));
    // 2 and −1: mean 0.5; 6 and 0: mean 3.
    assert!(
        (effect.goals.unwrap().mean - 0.5).abs() < 1e-9 && (effect.shots.unwrap().mean - 3.0).abs() < 1e-9
    );
    // √(2 · 1/8) = 0.5; √(7.5/1.5 · 0.5/0.5) = √5.
    assert!((effect.offence_ratio.unwrap().mean - 0.5).abs() < 1e-9);
    assert!((effect.attack_ratio.unwrap().mean - 5.0_f64.sqrt()).abs() < 1e-9);
    // 2 and −1 once more: spread 2.1213, t = 1/3 with 1 degree, p = 0.7952.
    assert!((effect.goals.unwrap().p.unwrap() - 0.7952).abs() < 1e-4);
    // The same from the other side.
    let turned = MatchPlan { pairings: vec![Pairing { own: without, opponent: MatchTeam::ours() }], ..plan };
    let rows = [row(0, [0, 2], [100.0, 200.0], [1, 7])].map(|row| MatchRow {
        own: without,
        opponent: MatchTeam::ours(),
        ..row
    });
    let effect = super::effects(&turned, &rows).remove(0);
    assert_eq!((effect.with, effect.goals.unwrap().mean), (MatchTeam::ours(), 2.0));
    assert!((effect.offence_ratio.unwrap().mean - 2.0).abs() < 1e-9 && effect.goals.unwrap().p.is_none());
    let text = markdown(&[], &[effect], &our_passes(&[]));
    assert!(text.contains("| second-level | ours | ours-without-second-level | 1 | 2.00 | – |"), "{text}");
}

#[test]
fn the_same_matches_by_two_programs_are_compared_match_by_match() {
    let identity = |program: &str, seed| MatchIdentity {
        program: program.to_owned(),
        case_base: "01234567".to_owned(),
        settings: Vec::new(),
        plan: plan(seed, 600.0, 3, &[Team::Zone.into()]),
    };
    let rows = |goals: [[u32; 2]; 3]| {
        let of = |(number, goals)| row(number, goals, [1.0, 1.0], [goals[0], 0]);
        goals.into_iter().enumerate().map(of).collect::<Vec<_>>()
    };
    let (before, after) = (rows([[1, 0], [2, 2], [0, 1]]), rows([[3, 0], [2, 1], [0, 1]]));
    check_same_matches(&identity("1", 5), &identity("2", 5)).expect("the same matches");
    let found = compare_matches(&identity("2", 5).plan, &before, &after);
    let [all] = &found[..] else { panic!("one opponent: {found:?}") };
    // 2, 1 and 0 goals better: mean 1, spread 1, t = √3 with 2 degrees, p = 0.2254.
    assert_eq!((all.goals_before, all.goals_after, all.goals.mean), ([3, 3], [5, 2], 1.0));
    assert!((all.goals.p.unwrap() - 0.2254).abs() < 1e-4, "{found:?}");
    assert!((all.detectable_goals.unwrap() - 2.802 / 3.0_f64.sqrt()).abs() < 1e-9);
    assert!((all.shots.mean - 2.0 / 3.0).abs() < 1e-9);
    let text = comparison_table(&found).markdown();
    assert!(
        text.contains("| ours | zone | 3 | 3 : 3 | 5 : 2 | 1.00 (-1.48 to 3.48) | 0.225 | 1.62 |"),
        "{text}"
    );
    // Other matches are refused, with what differs.
    let refused = check_same_matches(&identity("1", 5), &identity("2", 6)).unwrap_err();
    assert_eq!(in_words(&refused), "seed 5, not 6");
}

#[test]
fn the_papers_rows_are_those_it_printed() {
    let goals = PAPER.iter().fold([0, 0], |sum, game| [sum[0] + game.goals[0], sum[1] + game.goals[1]]);
    // Without the game against an empty field and without shoot-outs.
    assert_eq!(goals, [20, 3]);
    assert_eq!(PAPER_PASSES.iter().map(|row| row.attempts).sum::<u32>(), 48);
    assert_eq!(PAPER_PASSES.iter().map(|row| row.successes).sum::<u32>(), 37);
}

/// A host proposes no case to robots whose case base is not its own, and these seldom retrieve one alone.
#[test]
fn a_host_retrieves_from_the_library_that_its_robots_have() {
    let built_in = case_library::league("division-b").unwrap();
    let kept = built_in.names.iter().zip(built_in.sources).filter(|(name, _)| **name != "corner/short");
    let cases: Vec<_> = kept.map(|(name, text)| (*name, *text)).collect();
    let files = case_tools::Files::from_texts(built_in.name, built_in.rules, &cases);
    let library = Box::leak(Box::new(case_tools::build_without_warnings(&files).unwrap()));
    assert_ne!(library.base().hash(), built_in.base().hash());
    // One to seven in each two minutes; none where the host retrieves from another base.
    let plan = plan(11, 120.0, 4, &[Team::Reactive.into(), Team::Zone.into()]);
    let matches = Matches { base: library.base(), ..matches(plan) };
    let played = matches.play_all(&|| ()).unwrap();
    let retrieved: Vec<_> =
        played.iter().map(|row| arena::ledger::CaseTable::read(&row.sides[0].cases).retrieved).collect();
    assert!(retrieved.iter().sum::<u32>() >= 16, "{retrieved:?}");
}

fn opened(matches: &Path) -> RefusalFile {
    RefusalFile::beside(matches).open(matches).unwrap()
}

fn refusal(number: usize, refused: u64, reason: &str) -> Refusal {
    let refusal = Some(reason.to_owned());
    Refusal { number, is_blue: true, answers: StrategyReport { used: 1, refused, refusal } }
}

#[test]
fn refused_answers_outlive_an_interrupt_and_are_summed_by_match() {
    let directory = Directory::new("matches-refusals");
    let matches = directory.file(Shard::WHOLE);
    let file = opened(&matches);
    assert_eq!(RefusedAnswers::of(&file.read().unwrap()), RefusedAnswers::default());
    file.append(&refusal(3, 2, "unknown key")).unwrap();
    file.append(&refusal(1, 5, "not JSON")).unwrap();
    // Interrupted before the match was stored: it is played again.
    fs::write(&matches, "").unwrap();
    let path = matches.with_file_name("refusals-1-of-1.jsonl");
    let torn = [fs::read(&path).unwrap(), b"{\"number\":4,".to_vec()].concat();
    fs::write(&path, torn).unwrap();
    let file = opened(&matches);
    file.append(&refusal(1, 6, "not JSON")).unwrap();
    let all = file.read().unwrap();
    assert_eq!(all.iter().map(|refusal| refusal.number).collect::<Vec<_>>(), [1, 3]);
    let expected = RefusedAnswers { matches: 2, refused: 8, refusal: Some("not JSON".to_owned()) };
    assert_eq!(RefusedAnswers::of(&all), expected);
    // Without the matches they are of another run.
    fs::remove_file(&matches).unwrap();
    assert_eq!(opened(&matches).read().unwrap(), []);
}
