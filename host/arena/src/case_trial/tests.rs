//! Tests: drawn situations are those of their cases, and attempts are repeatable and reported correctly.

use brain::Approach;
use casebase::{PointMm, Symmetry};
use hil_sim::{Configuration, OpponentRole, Parameters, Scenario};

use super::*;
use crate::trial::TrialConfig;

fn case_trial(trials: u32) -> CaseTrial<'static> {
    let config = TrialConfig::new(Scenario::Random, Configuration::DefenderGoalie, Approach::Cases, 0);
    CaseTrial {
        league: League::FourLegged,
        base: config.base,
        names: config.names,
        settings: RetrievalSettings::default(),
        trials,
        seed: 5,
    }
}

fn number(case_trial: &CaseTrial<'_>, name: &str) -> usize {
    (0..case_trial.base.len() / 4)
        .find(|&n| case_trial.names.of(case_trial.case(n).unwrap().id()) == name)
        .unwrap()
}

#[test]
fn a_drawn_situation_lies_in_the_cores_of_its_scopes_and_no_one_touches_anybody() {
    let case_trial = case_trial(0);
    let (field, parameters) = (League::FourLegged.field(), Parameters::four_legged());
    for case in case_trial.base.cases().filter(|case| case.symmetry() == Symmetry::Identity) {
        for seed in 0..20 {
            let layout = four_legged::layout(&case, Opposition::Playing, seed);
            let away = PointMm::from(layout.ball);
            assert!(case.ball_scope().exponent(away.minus(case.ball())) <= 0.2232 + 0.002, "{away:?}");
            let opponents: Vec<_> = layout.opponents.iter().map(|placed| placed.pose.position).collect();
            let places: Vec<_> =
                layout.attackers.iter().map(|pose| pose.position).chain(opponents.clone()).collect();
            for (i, a) in places.iter().enumerate() {
                assert!(field.contains(*a) && a.distance(layout.ball) > 0.17, "{a:?}");
                assert!(places[..i].iter().all(|b| a.distance(*b) > 0.25), "{places:?}");
            }
            for placed in layout.opponents {
                let home = match placed.conduct {
                    hil_sim::Conduct::Within(region) => region,
                    _ => placed.role.home(parameters),
                };
                assert!(home.contains(placed.pose.position), "{:?}", placed.role);
            }
        }
    }
}

#[test]
fn opponents_have_the_role_whose_home_they_stand_in() {
    let case_trial = case_trial(0);
    let case = case_trial.case(number(&case_trial, "center/wing-switch")).unwrap();
    let layout = four_legged::layout(&case, Opposition::Standing, 1);
    let roles: Vec<_> = layout.opponents.iter().map(|placed| placed.role).collect();
    assert_eq!(roles, [OpponentRole::Midfield, OpponentRole::Defender]);
    assert!(layout.opponents.iter().all(|placed| placed.conduct == hil_sim::Conduct::Standing));
}

#[test]
fn an_attempt_is_its_seed_and_its_number_whoever_else_plays() {
    let case_trial = case_trial(6);
    let case = case_trial.case(number(&case_trial, "front/shot")).unwrap();
    let all = case_trial.play(&case, Opposition::Playing, &|| ()).unwrap();
    let fifth = case_trial.attempt(&case, Opposition::Playing, 5, None).unwrap();
    assert_eq!(all[5], fifth);
    let other = CaseTrial { seed: 6, ..case_trial.clone() };
    assert_ne!(other.play(&case, Opposition::Playing, &|| ()).unwrap(), all);
}

#[test]
fn an_attempt_that_is_kept_is_the_same_and_its_tape_shows_the_ball_on_its_way() {
    let case_trial = case_trial(6);
    let case = case_trial.case(number(&case_trial, "front/shot")).unwrap();
    let mut tape = Tape::default();
    let kept = case_trial.attempt(&case, Opposition::Playing, 5, Some(&mut tape)).unwrap();
    assert_eq!(kept, case_trial.attempt(&case, Opposition::Playing, 5, None).unwrap());
    let [first, last] = [tape.samples.first().unwrap(), tape.samples.last().unwrap()];
    assert!((last.ball.x() - first.ball.x() - kept.progress).abs() < 0.05, "{kept:?}");
    assert!(tape.samples.is_sorted_by(|a, b| a.time < b.time));
    assert_eq!(first.robots.len(), case.teammates() + case.opponents().count());
}

#[test]
fn a_free_shot_is_retrieved_played_and_brings_the_ball_forward() {
    let case_trial = case_trial(20);
    let case = case_trial.case(number(&case_trial, "front/shot")).unwrap();
    let attempts = case_trial.play(&case, Opposition::Standing, &|| ()).unwrap();
    let score = Score::of("front/shot".to_owned(), "standing", &attempts);
    assert_eq!(score.retrieved + score.instead.values().sum::<usize>(), 20, "{score:?}");
    assert!(score.completed >= 12 && score.progress_m.unwrap() > 0.5, "{score:?}");
    assert_eq!(score.outcomes.values().sum::<usize>(), score.completed);
    assert_eq!(score.completed + score.aborted.values().sum::<usize>(), score.retrieved);
}

#[test]
fn a_score_counts_what_was_retrieved_instead_and_why_gameplays_ended() {
    let attempt = |retrieved, end| Attempt { retrieved, end, duration: 2.0, outcome: None, progress: 0.5 };
    let finished = CycleEnd::Closed(protocol::team::Closure::Finished);
    let attempts = [
        attempt(Retrieved::Own, Some(finished)),
        attempt(Retrieved::Own, Some(CycleEnd::Superseded)),
        attempt(Retrieved::Other("side/draw-out".to_owned()), None),
        attempt(Retrieved::None, None),
    ];
    let score = Score::of("front/shot".to_owned(), "playing", &attempts);
    assert_eq!((score.retrieved, score.completed, score.completed_percent()), (2, 1, 25.0));
    let row =
        "| front/shot | playing | 50 | 25 | none 1, side/draw-out 1, superseded 1 | 2.0 | 0.5 | play 1 |";
    assert!(markdown(&[score]).ends_with(&format!("{row}\n")));
}
