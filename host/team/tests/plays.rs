//! `plays`: the example team plays lawful matches in the simulator, in this process.

#[allow(dead_code, reason = "its main serves standard input")]
#[path = "../examples/fifty_lines.rs"]
mod fifty_lines;

use arena::game::{GameConfig, NoWatcher, play};
use fifty_lines::FiftyLines;
use hil_sim::NativeBackend;
use host::strategy::Team;
use rules::{Colour, League};
use team::{Strategy, StrategyAnswer, StrategyLink, StrategyStarter, StrategyView, answers};

/// A match of blue by the strategy against yellow that only stands; goals and fouls of blue, goals of yellow.
fn against_idle(
    seed: u64,
    seconds: f64,
    strategy: impl Fn() -> Box<dyn StrategyLink> + Send + Sync + 'static,
) -> [u32; 3] {
    let mut config = GameConfig::new(League::DivisionB, seed, seconds).between(Team::Ours, Team::Idle);
    config.teams[Colour::Blue as usize].strategy = Some(StrategyStarter::new("test", move || Ok(strategy())));
    let base = case_library::division_b();
    let report = play(&config, &mut NativeBackend::new(base), &mut NoWatcher).expect("it plays");
    [report.score.blue, report.fouls.blue.values().sum(), report.score.yellow]
}

fn linked(mut strategy: impl Strategy + Send + 'static) -> Box<dyn StrategyLink> {
    Box::new(move |view: &str| Some(answers(&mut strategy, view).expect("a view")))
}

/// A robot may slide into their area or into one that stands: 3 fouls in 20 such matches.
#[test]
fn the_fifty_line_team_wins_each_match_against_one_that_stands_and_hardly_fouls() {
    let mut fouls = 0;
    for seed in 1..=16 {
        let [goals, fouls_here, against] = against_idle(seed, 120.0, || linked(FiftyLines::default()));
        assert!(goals >= 1 && against == 0, "seed {seed}: {goals}:{against}");
        fouls += fouls_here;
    }
    assert!(fouls <= 4, "{fouls} fouls in sixteen matches");
}

/// Orders nothing.
struct Nothing;

impl Strategy for Nothing {
    fn answer(&mut self, _view: &StrategyView) -> StrategyAnswer {
        StrategyAnswer::default()
    }
}

#[test]
fn a_strategy_that_orders_nothing_plays_as_our_coach_does() {
    let [goals, _, against] = against_idle(1, 120.0, || linked(Nothing));
    assert!(goals >= 1 && against == 0, "{goals}:{against}");
}

#[test]
fn a_view_of_another_version_ends_the_program_with_an_error_that_names_both() {
    let view = r#"{"version":2,"league":"division-b","time":0,"phase":{"name":"run"},"next":null,"placement":null,
        "ball":null,"ours":[],"theirs":[],"keeper":0,"their_keeper":0,"bound":[],"usual":[],
        "field":{"length":9,"width":6,"goal_width":1,"area_depth":1,"area_width":2}}"#;
    let error = answers(&mut Nothing, view).unwrap_err().to_string();
    assert!(error.contains("version 2") && error.contains("reads 1"), "{error}");
}
