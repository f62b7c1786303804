//! `opponents`: tests: the opponent teams can score. Whole matches against a side whose robots stand.

use arena::game::{GameConfig, NoWatcher, play};
use hil_sim::NativeBackend;
use host::strategy::Team;
use rules::League;

/// Goals for and against in a match of ten minutes against the side that stands.
fn goals(team: Team, seed: u64) -> [u32; 2] {
    let base = case_library::division_b();
    let config = GameConfig::new(League::DivisionB, seed, 600.0).between(team, Team::Idle);
    let report = play(&config, &mut NativeBackend::new(base), &mut NoWatcher).unwrap();
    assert_eq!((report.teams.blue, report.teams.yellow), (team, Team::Idle));
    [report.score.blue, report.score.yellow]
}

#[test]
fn every_opponent_scores_more_than_three_goals_against_a_side_that_stands() {
    let played: Vec<_> = Team::OPPONENTS
        .into_iter()
        .flat_map(|team| (1..=2).map(move |seed| (team.label(), seed, goals(team, seed))))
        .collect();
    println!("{played:?}");
    assert!(played.iter().all(|(_, _, [own, idle])| *own > 3 && *idle == 0), "{played:?}");
}
