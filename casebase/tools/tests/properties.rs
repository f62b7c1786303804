//! `properties`: property tests over random libraries and problems. Index against scan, symmetry, corrupted
//! bytes.

mod common;

use case_tools::{Library, Table};
use casebase::table::{HASHED_FROM, MAGIC_WORDS, content_hash};
use casebase::{
    Action, CaseBase, CaseVerdict, Match, PointMm, Presence, Problem, RetrievalSettings, Symmetry,
    TableError, explain, rank_order, retrieve, retrieve_best,
};
use common::Dice;
use protocol::CaseId;

/// The candidates of the plain order: every case under the goal, no index, no short cut.
fn scan(base: &CaseBase<'_>, problem: &Problem, settings: &RetrievalSettings) -> Vec<Match> {
    let mut candidates = Vec::new();
    explain(base, problem, settings, |_, verdict| {
        if let CaseVerdict::Candidate(candidate) = verdict {
            candidates.push(candidate);
        }
    });
    candidates
}

/// Settings that change the candidates or their ranking.
fn variants() -> Vec<RetrievalSettings> {
    let assignments: [&[(&str, &str)]; 10] = [
        &[],
        &[("correspondence", "constrained"), ("thr_c", "700")],
        &[("cost", "max")],
        &[("ranking", "teammates,conditions,interval-cost")],
        &[("ranking", "interval-cost,teammates,conditions")],
        &[("out_of_field", "clamp")],
        &[("out_of_field", "reject")],
        &[("scopes", "absolute")],
        &[("free_path", "fuzzy"), ("free_min", "0.3")],
        &[("thr", "0.2")],
    ];
    let with = |list: &[(&str, &str)]| {
        let mut settings = RetrievalSettings::default();
        for (name, value) in list {
            settings.set(name, value).unwrap();
        }
        settings
    };
    assignments.into_iter().map(with).collect()
}

#[test]
fn the_index_answers_as_a_plain_scan_does() {
    let variants = variants();
    let (mut problems, mut with_candidates, mut with_several) = (0, 0, 0);
    for seed in 0..40 {
        let mut dice = Dice::new(seed);
        let cases = 1 + dice.below(80) as usize;
        let library = dice.library(cases);
        let base = library.base();
        for round in 0..150 {
            let problem = dice.problem(&base);
            let settings =
                &variants[if round % 2 == 0 { 0 } else { dice.below(variants.len() as u64) as usize }];
            let truth = scan(&base, &problem, settings);
            let best = truth.iter().min_by(|a, b| rank_order(a, b, settings));
            let found = retrieve(&base, &problem, settings);
            assert_eq!(found.best.as_ref(), best, "seed {seed} round {round}: {problem:?} {settings:?}");
            assert_eq!(usize::from(found.candidates), truth.len(), "seed {seed} round {round}");
            assert_eq!(retrieve_best(&base, &problem, settings), found.best, "seed {seed} round {round}");
            problems += 1;
            with_candidates += usize::from(!truth.is_empty());
            with_several += usize::from(truth.len() > 1);
        }
    }
    // The draw must be meaningful: most problems have candidates, many have several.
    assert!(
        with_candidates * 2 > problems && with_several * 5 > problems,
        "{with_candidates}, {with_several} of {problems}"
    );
}

#[test]
fn a_ball_anywhere_finds_every_case_whose_scope_holds_it() {
    let mut dice = Dice::new(5);
    let library = dice.library(60);
    let base = library.base();
    for _ in 0..20_000 {
        let mut problem = dice.problem(&base);
        // On the field, around it, and far outside.
        let reach = [2700, 4000, 1_000_000][dice.below(3) as usize];
        problem.ball = PointMm::new(dice.between(-reach, reach), dice.between(-reach, reach));
        problem.opponents.clear();
        let lenient = RetrievalSettings { travel_max_mm: 1e9, ..RetrievalSettings::default() };
        let inside = base.cases().filter(|case| {
            // No opponent is there to stand where one is required.
            let required = |number| case.presence(number) == Presence::Required;
            let fits =
                case.teammates() <= problem.teammates.len() && !(0..case.opponents().count()).any(required);
            case.defending() == problem.defending && case.ball_in_scope(problem.ball) && fits
        });
        assert_eq!(
            usize::from(retrieve(&base, &problem, &lenient).candidates),
            inside.count(),
            "{:?}",
            problem.ball
        );
    }
}

fn mirrored(problem: &Problem, symmetry: Symmetry) -> Problem {
    Problem {
        ball: symmetry.point(problem.ball),
        defending: symmetry.goal(problem.defending),
        teammates: problem.teammates.iter().map(|(id, at)| (*id, symmetry.point(*at))).collect(),
        opponents: problem.opponents.iter().map(|at| symmetry.point(*at)).collect(),
    }
}

#[test]
fn in_a_mirror_the_mirrored_case_is_retrieved_with_the_same_numbers() {
    let settings = RetrievalSettings::default();
    for seed in 0..20 {
        let mut dice = Dice::new(100 + seed);
        let library = dice.library(40);
        let base = library.base();
        for _ in 0..100 {
            let problem = dice.problem(&base);
            let straight = scan(&base, &problem, &settings);
            for symmetry in Symmetry::ALL {
                let mut seen = scan(&base, &mirrored(&problem, symmetry), &settings);
                for candidate in &mut seen {
                    candidate.case = CaseId(candidate.case.0 ^ symmetry.bits());
                }
                seen.sort_by_key(|candidate| candidate.case);
                assert_eq!(seen, straight, "seed {seed}, {symmetry}: {problem:?}");
            }
        }
    }
}

#[test]
fn the_copies_of_a_case_are_mirror_images_of_it() {
    let mut dice = Dice::new(7);
    let library = dice.library(50);
    let base = library.base();
    for case in base.cases() {
        let authored = base.case(CaseId(case.id().0 & !3)).unwrap();
        let image = |at: PointMm| case.symmetry().point(at);
        assert_eq!(case.defending(), case.symmetry().goal(authored.defending()));
        assert_eq!((case.ball(), case.ball_scope()), (image(authored.ball()), authored.ball_scope()));
        assert!(case.opponents().eq(authored.opponents().map(|(at, scope)| (image(at), scope))));
        for robot in case.robots() {
            assert_eq!(case.position(robot), image(authored.position(robot)));
            let points = |case: &casebase::Case<'_>| -> Vec<PointMm> {
                let point = |action| match action {
                    Action::GoToPoint(at) | Action::DribbleTo(at) => Some(at),
                    _ => None,
                };
                case.gameplay(robot).filter_map(point).collect()
            };
            let images: Vec<_> = points(&authored).into_iter().map(image).collect();
            assert_eq!(points(&case), images);
        }
        let sign = |at: PointMm| [at.x as f32, at.y as f32];
        let [sx, sy] = sign(image(PointMm::new(1, 1)));
        let ends = |leg: casebase::Leg| [leg.from, leg.to].map(|[x, y]| [x * sx, y * sy]);
        let ours = case.legs(case.ball()).map(ends);
        assert!(ours.eq(authored.legs(authored.ball()).map(|leg| [leg.from, leg.to])), "{:?}", case.id());
    }
}

/// Calls every accessor of a table; the problem's ball is placed where a case of this table has it.
fn exercise(base: &CaseBase<'_>, problem: &Problem, dice: &mut Dice) {
    for case in base.cases() {
        for robot in case.robots() {
            for (index, _) in case.gameplay(robot).enumerate() {
                let _ = (case.action(robot, index), case.partner_of(robot, index));
            }
        }
        let _ = (case.getter(), case.ball_scope(), case.opponents().count(), case.legs(case.ball()).count());
    }
    if !base.is_empty() {
        let case = base.case(CaseId(dice.below(base.len() as u64) as u16)).expect("an id of the base");
        let problem = Problem { ball: case.ball(), defending: case.defending(), ..problem.clone() };
        for settings in variants() {
            let _ = (retrieve(base, &problem, &settings), scan(base, &problem, &settings));
        }
    }
}

#[test]
fn no_byte_of_a_table_can_make_it_panic() {
    let mut dice = Dice::new(11);
    let library = dice.library(6);
    damage(&mut dice, &library, library.table.bytes().len(), 20_000);
}

#[test]
fn no_byte_of_a_table_with_words_can_make_it_panic() {
    let mut dice = Dice::new(12);
    let library = dice.library(500);
    assert_eq!(library.table.bytes()[4..8], MAGIC_WORDS[1].to_ne_bytes(), "a table with words");
    // Words and bitmaps are its first sections.
    damage(&mut dice, &library, 30_000, 200);
}

/// Reads a library's table `rounds` times with some of the first `within` bytes changed, and uses what is
/// accepted.
fn damage(dice: &mut Dice, library: &Library, within: usize, rounds: u64) {
    let good = library.table.bytes();
    let (mut accepted, mut refused) = (0, 0);
    for round in 0..rounds {
        let mut bytes = good.to_vec();
        for _ in 0..=dice.below(3) {
            let at = dice.below(within as u64) as usize;
            bytes[at] = [0, 1, 127, 128, 255, dice.below(256) as u8][dice.below(6) as usize];
        }
        if dice.below(8) == 0 {
            bytes.truncate(dice.below(bytes.len() as u64) as usize);
        }
        // A forged table would have a correct hash.
        if bytes.len() > HASHED_FROM {
            let hash = content_hash(&bytes[HASHED_FROM..]);
            bytes[HASHED_FROM - 4..HASHED_FROM].copy_from_slice(&hash.to_ne_bytes());
        }
        let table = Table::aligned(&bytes);
        match CaseBase::from_bytes(table.bytes()) {
            Ok(base) => {
                accepted += 1;
                if round % 4 == 0 {
                    let problem = dice.problem(&library.base());
                    exercise(&base, &problem, dice);
                }
            }
            Err(_) => refused += 1,
        }
    }
    // Both outcomes occur: harmless changes pass, harmful ones do not.
    assert!(accepted > rounds / 20 && refused > rounds / 20, "{accepted} accepted, {refused} refused");
}

#[test]
fn a_damaged_table_and_a_foreign_one_give_different_errors() {
    let library = Dice::new(3).library(3);
    let good = library.table.bytes();
    let read = |bytes: &[u8]| CaseBase::from_bytes(Table::aligned(bytes).bytes()).err();
    let changed = |at: usize| {
        let mut bytes = good.to_vec();
        bytes[at] ^= 1;
        read(&bytes)
    };
    assert_eq!(read(good), None);
    assert_eq!(changed(0), Some(TableError::Magic));
    // Version 2 instead of 3.
    assert_eq!(changed(4), Some(TableError::Magic));
    assert_eq!(changed(good.len() - 1), Some(TableError::Hash));
    assert_eq!(read(&good[..good.len() - 1]), Some(TableError::Length));
    assert_eq!(read(&[good, &[0]].concat()), Some(TableError::Length));
    assert_eq!(read(&[]), Some(TableError::Length));
    let shifted = [&[0], good].concat();
    let odd = Table::aligned(&shifted);
    assert_eq!(CaseBase::from_bytes(&odd.bytes()[1..]).err(), Some(TableError::Misaligned));
}

#[test]
fn a_large_random_library_needs_at_most_96_bytes_a_stored_case() {
    // The paper's cases: one robot or two, no opponent or two, a pass or a kick.
    let coop = common::PASS_AROUND;
    let alone = common::single("[100, 200]", "[450, 300]", ", { kick = \"forward\" }");
    let texts: Vec<_> = (0..400)
        .map(|i| {
            let text = if i % 2 == 0 { coop.to_owned() } else { alone.clone() };
            (format!("drawn/{i:03}"), text)
        })
        .collect();
    let borrowed: Vec<_> = texts.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    let library = common::library(&borrowed);
    let bytes = library.base().bytes_per_case();
    assert!(bytes <= 96.0, "{bytes} bytes a stored case");
}
