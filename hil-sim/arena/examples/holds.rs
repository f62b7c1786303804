//! Plays matches and prints who held the ball for how long: a line a match, then the whole.
//!
//! `cargo run --release -p arena --example holds -- OPPONENT FIRST_SEED COUNT SECONDS`; ours is blue.

use std::collections::BTreeMap;

use arena::game::{Game, GameConfig, GameReport, Watcher, play};
use hil_sim::NativeBackend;
use host::strategy::Team;
use rayon::prelude::*;
use rules::{League, Phase};

fn main() -> Result<(), String> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let usage = "usage: holds OPPONENT FIRST_SEED COUNT SECONDS, as in `holds marking 1 20 120`";
    let [opponent, first, count, seconds] = &arguments[..] else { return Err(usage.into()) };
    let teams = [Team::Ours, Team::Reactive, Team::Marking, Team::Zone, Team::Idle];
    let opponent = teams.into_iter().find(|team| team.word() == opponent).ok_or(usage)?;
    let number = |text: &str| text.parse::<u64>().map_err(|error| format!("{text}: {error}; {usage}"));
    let (first, count, seconds) = (number(first)?, number(count)?, number(seconds)?);
    let played: Vec<(GameReport, Waiting)> = (first..first + count)
        .into_par_iter()
        .map(|seed| one(seed, seconds as f64, opponent))
        .collect::<Result<_, _>>()?;
    let (reports, waiting): (Vec<_>, Vec<_>) = played.into_iter().unzip();
    for report in &reports {
        tell(report);
    }
    sum(&reports);
    let ticks = waiting.iter().map(|waiting| waiting.ticks).sum::<u32>().max(1) as f32;
    let speed = waiting.iter().map(|waiting| waiting.sum).sum::<f32>() / ticks;
    let fast = waiting.iter().map(|waiting| waiting.fast).sum::<u32>() as f32 / ticks;
    println!(
        "robots that wait during placements, from 3 s on: {speed:.2} m/s, faster than 1 m/s {:.1} % of the time",
        100.0 * fast
    );
    Ok(())
}

/// How those move who have nothing to do with a ball that is being placed.
#[derive(Default)]
struct Waiting {
    since: Option<f64>,
    ticks: u32,
    sum: f32,
    fast: u32,
}

impl Watcher for Waiting {
    fn tick(&mut self, game: &Game<'_>) {
        if !matches!(game.referee().phase(), Phase::BallPlacement(_)) {
            self.since = None;
            return;
        }
        let since = *self.since.get_or_insert(game.time());
        let ball = game.world().ball.position;
        let waits = game.world().robots().iter().filter(|robot| robot.pose.position.distance(ball) > 1.0);
        for robot in waits.filter(|robot| robot.present && game.time() - since > 3.0) {
            let speed = robot.velocity.norm();
            self.ticks += 1;
            self.sum += speed;
            self.fast += u32::from(speed > 1.0);
        }
    }
}

fn one(seed: u64, seconds: f64, opponent: Team) -> Result<(GameReport, Waiting), String> {
    let config = GameConfig::new(League::DivisionB, seed, seconds).between(Team::Ours, opponent);
    let mut backend = NativeBackend::new(case_library::division_b());
    let mut waiting = Waiting::default();
    let report = play(&config, &mut backend, &mut waiting).map_err(|error| error.to_string())?;
    Ok((report, waiting))
}

fn fouls(report: &GameReport) -> BTreeMap<&'static str, u32> {
    let mut all = report.fouls.blue.clone();
    for (kind, n) in &report.fouls.yellow {
        *all.entry(kind).or_default() += n;
    }
    all
}

fn tell(report: &GameReport) {
    let (blue, yellow) = (&report.metrics.blue, &report.metrics.yellow);
    println!(
        "seed {}: {}:{} goals, holds {:.1}/{:.1} s, {}+{} over 2.5 s, {} reversals, {} no progress, {:.0} % in play, shots {}:{}, {:?}",
        report.seed,
        report.score.blue,
        report.score.yellow,
        blue.longest_hold_s,
        yellow.longest_hold_s,
        blue.holds_over_2_5s,
        yellow.holds_over_2_5s,
        report.most_reversals,
        report.no_progress,
        100.0 * report.ball_in_play,
        blue.shots,
        yellow.shots,
        fouls(report)
    );
    for hold in &report.long_holds {
        let (team, robot) = (hold.team, hold.robot);
        println!(
            "    {team} {robot} from {:.2} s for {:.2} s, {} reversals",
            hold.from_s, hold.lasted_s, hold.reversals
        );
    }
}

fn sum(reports: &[GameReport]) {
    let n = reports.len() as f32;
    let mut longest: Vec<f32> = reports.iter().map(|report| report.longest_hold_s).collect();
    longest.sort_unstable_by(f32::total_cmp);
    let at = |share: f32| longest.get(((n - 1.0) * share).round() as usize).copied().unwrap_or(0.0);
    let mean = |of: &dyn Fn(&GameReport) -> f32| reports.iter().map(of).sum::<f32>() / n;
    println!(
        "{n} matches: longest hold max {:.2} p90 {:.2} median {:.2} s; holds over 2.5 s {:.2}:{:.2} a match; no progress {:.2}; in \
         play {:.1} % (least {:.1}); goals {:.2}:{:.2}; shots {:.1}:{:.1}; fouls {:.2}",
        at(1.0),
        at(0.9),
        at(0.5),
        mean(&|r| r.metrics.blue.holds_over_2_5s as f32),
        mean(&|r| r.metrics.yellow.holds_over_2_5s as f32),
        mean(&|r| r.no_progress as f32),
        100.0 * mean(&|r| r.ball_in_play),
        100.0 * reports.iter().map(|r| r.ball_in_play).fold(1.0, f32::min),
        mean(&|r| r.score.blue as f32),
        mean(&|r| r.score.yellow as f32),
        mean(&|r| r.metrics.blue.shots as f32),
        mean(&|r| r.metrics.yellow.shots as f32),
        mean(&|r| fouls(r).values().sum::<u32>() as f32)
    );
}
