//! `conduct`: plays matches and prints how they were played: a line a match, then the total: time in each
//! phase of the game, ball placements, the longest time that one robot held the ball, no-progress stops,
//! fouls, and how our robots handle the ball.
//!
//! `cargo run --release -p onetwo-study --example conduct -- LEAGUE WORLD OPPONENT FIRST_SEED COUNT SECONDS`,
//! as in `conduct division-b random ours 1 200 120`; ours is blue, and with `random` each match has the
//! random world of its own seed. `story` as a seventh argument adds each offence, each ball out and each stop
//! for no progress with the robots around it. `conduct LEAGUE WORLD` prints that world's numbers.

mod at_ball;
mod stoppages;

use std::collections::BTreeMap;

use arena::attack::AttackCounts;
use arena::game::{Game, GameConfig, GameReport, Watcher, play};
use at_ball::AtBall;
use casebase::CaseBase;
use hil_sim::NativeBackend;
use hil_sim::small_size::worlds::{WorldChoice, WorldModel};
use host::strategy::Team;
use rayon::prelude::*;
use rules::{Colour, League, Phase};
use stoppages::Stoppages;
use study::matches::{AttackRow, MatchTeam, attack_table};

const USAGE: &str = "usage: conduct LEAGUE WORLD OPPONENT FIRST_SEED COUNT SECONDS [story], as in `conduct division-b random ours 1 200 120`";

fn main() -> Result<(), String> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [league, world] = &arguments[..] {
        let world: WorldChoice = world.parse().map_err(|error| format!("{error}"))?;
        println!("{:#?}", WorldModel::of(named(league)?, &world));
        return Ok(());
    }
    let (story, arguments) = match arguments.split_last() {
        Some((last, before)) if last == "story" => (true, before),
        _ => (false, &arguments[..]),
    };
    let [league, world, opponent, first, count, seconds] = arguments else { return Err(USAGE.into()) };
    let league = named(league)?;
    let opponent = MatchTeam::parse(opponent)?;
    let number = |text: &str| text.parse::<u64>().map_err(|error| format!("{text}: {error}; {USAGE}"));
    let (first, count, seconds) = (number(first)?, number(count)?, number(seconds)?);
    let played: Vec<(GameReport, Account)> = (first..first + count)
        .into_par_iter()
        .map(|seed| {
            let mut config = GameConfig::new(league, seed, seconds as f64).between(Team::Ours, opponent.team);
            for team in config.teams.iter_mut().filter(|team| team.colour == Colour::Yellow) {
                (team.tactics, team.approach) = (opponent.host_tactics(), opponent.approach());
            }
            config.world = match world.as_str() {
                "random" => format!("random:{seed}").parse().map_err(|error| format!("{error}"))?,
                world => world.parse::<WorldChoice>().map_err(|error| format!("{error}"))?,
            };
            one(&config)
        })
        .collect::<Result<_, String>>()?;
    for (report, account) in &played {
        print_conduct(report, account);
        for line in account.stoppages.story.iter().filter(|_| story) {
            println!("    {line}");
        }
        for stoppage in account.stoppages.all.iter().filter(|_| story) {
            println!("    {}", stoppage.line());
        }
    }
    sum(&played, opponent);
    Ok(())
}

fn named(league: &str) -> Result<League, String> {
    let leagues = [League::Ssl2013, League::DivisionB, League::DivisionA];
    leagues.into_iter().find(|known| known.name() == league).ok_or_else(|| USAGE.to_string())
}

fn one(config: &GameConfig) -> Result<(GameReport, Account), String> {
    let base = match config.league {
        League::DivisionB => case_library::division_b(),
        _ => CaseBase::default(),
    };
    let mut account = Account::default();
    let report =
        play(config, &mut NativeBackend::new(base), &mut account).map_err(|error| error.to_string())?;
    account.stoppages.end();
    Ok((report, account))
}

/// Events of the referee, and the time in each phase.
#[derive(Clone, Debug, Default)]
struct Account {
    seen: usize,
    events: BTreeMap<&'static str, u32>,
    phases: BTreeMap<&'static str, f64>,
    stoppages: Stoppages,
    at_ball: AtBall,
}

impl Watcher for Account {
    fn tick(&mut self, game: &Game<'_>) {
        *self.phases.entry(name(game.referee().phase())).or_default() += 0.01;
        let events = game.referee().events();
        for event in &events[self.seen..] {
            *self.events.entry(event.what.kind().label()).or_default() += 1;
        }
        self.seen = events.len();
        self.stoppages.look(game);
        self.at_ball.look(game);
    }
}

impl Account {
    fn of(&self, event: &str) -> u32 {
        self.events.get(event).copied().unwrap_or(0)
    }
}

fn name(phase: Phase<Colour>) -> &'static str {
    match phase {
        Phase::Halt => "halt",
        Phase::Stop => "stop",
        Phase::Timeout(_) => "timeout",
        Phase::BallPlacement(_) => "placement",
        Phase::PrepareKickoff(_) => "prepare-kickoff",
        Phase::Kickoff(_) => "kickoff",
        Phase::PreparePenalty(_) => "prepare-penalty",
        Phase::Penalty(_) => "penalty",
        Phase::FreeKick(_) => "free-kick",
        Phase::Run => "run",
    }
}

fn fouls(report: &GameReport) -> BTreeMap<&'static str, u32> {
    let mut all = report.fouls.blue.clone();
    for (kind, n) in &report.fouls.yellow {
        *all.entry(kind).or_default() += n;
    }
    all
}

fn print_conduct(report: &GameReport, account: &Account) {
    let (blue, yellow) = (&report.metrics.blue, &report.metrics.yellow);
    println!(
        "seed {}: {:.0} % in play, {}:{} goals, shots {}:{}, placed {} of {}, longest hold {:.1} s, {} over 2.5 s, {} reversals, \
         {} no progress, {:?}",
        report.seed,
        100.0 * report.ball_in_play,
        report.score.blue,
        report.score.yellow,
        blue.shots,
        yellow.shots,
        account.of("placement_succeeded"),
        account.of("placement_succeeded") + account.of("placement_failed"),
        report.longest_hold_s,
        report.holds_over_2_5s,
        report.most_reversals,
        report.no_progress,
        fouls(report)
    );
    for hold in report.long_holds.iter().filter(|hold| hold.lasted_s > 4.0) {
        let (team, robot) = (hold.team, hold.robot);
        println!(
            "    {team} {robot} held it from {:.2} s for {:.2} s, {} reversals",
            hold.from_s, hold.lasted_s, hold.reversals
        );
    }
}

/// The counts of one colour's attack, over all matches.
fn attack_of(
    played: &[(GameReport, Account)],
    of: impl Fn(&GameReport) -> &AttackCounts,
) -> BTreeMap<String, u32> {
    let mut sum = BTreeMap::new();
    for (name, n) in played.iter().flat_map(|(report, _)| of(report).named()) {
        *sum.entry(name).or_default() += n;
    }
    sum
}

fn sum(played: &[(GameReport, Account)], opponent: MatchTeam) {
    let n = played.len() as f32;
    let sorted = |of: &dyn Fn(&GameReport) -> f32| {
        let mut values: Vec<f32> = played.iter().map(|(report, _)| of(report)).collect();
        values.sort_unstable_by(f32::total_cmp);
        values
    };
    let at =
        |values: &[f32], share: f32| values.get(((n - 1.0) * share).round() as usize).copied().unwrap_or(0.0);
    let mean = |of: &dyn Fn(&GameReport) -> f32| played.iter().map(|(report, _)| of(report)).sum::<f32>() / n;
    let (holds, in_play) = (sorted(&|r| r.longest_hold_s), sorted(&|r| 100.0 * r.ball_in_play));
    let (mut events, mut phases) = (BTreeMap::<&str, f32>::new(), BTreeMap::<&str, f64>::new());
    for (_, account) in played {
        for (kind, count) in &account.events {
            *events.entry(kind).or_default() += *count as f32 / n;
        }
        for (phase, seconds) in &account.phases {
            *phases.entry(phase).or_default() += seconds;
        }
    }
    let all: f64 = phases.values().sum();
    println!("{n} matches");
    println!(
        "in play: least {:.0}, worst decile {:.0}, median {:.0} %",
        in_play.first().copied().unwrap_or(0.0),
        at(&in_play, 0.1),
        at(&in_play, 0.5)
    );
    let share = |seconds: &f64| format!("{:.1} %", 100.0 * seconds / all.max(0.01));
    println!("phases: {:?}", phases.iter().map(|(phase, s)| (*phase, share(s))).collect::<Vec<_>>());
    println!(
        "longest hold: max {:.2}, p90 {:.2}, median {:.2} s; over 2.5 s {:.2} a match",
        at(&holds, 1.0),
        at(&holds, 0.9),
        at(&holds, 0.5),
        mean(&|r| r.holds_over_2_5s as f32)
    );
    println!(
        "a match: goals {:.2}, shots {:.2}, no progress {:.2}, fouls {:.2}",
        mean(&|r| (r.score.blue + r.score.yellow) as f32),
        mean(&|r| (r.metrics.blue.shots + r.metrics.yellow.shots) as f32),
        mean(&|r| r.no_progress as f32),
        mean(&|r| fouls(r).values().sum::<u32>() as f32)
    );
    let count = |kind: &str| played.iter().map(|(_, account)| account.of(kind)).sum::<u32>();
    let (placed, failed) = (count("placement_succeeded"), count("placement_failed"));
    println!(
        "placements: {placed} of {} ({:.1} %)",
        placed + failed,
        100.0 * placed as f32 / (placed + failed).max(1) as f32
    );
    println!("events a match: {events:.2?}");
    let blue = attack_of(played, |report| &report.metrics.blue.attack);
    let yellow = attack_of(played, |report| &report.metrics.yellow.attack);
    let row = |team, against, counts| AttackRow { team, against, counts, matches: played.len() as u32 };
    let ours = MatchTeam::ours();
    println!("{}", attack_table(&[row(ours, opponent, &blue), row(opponent, ours, &yellow)]));
    let mut passes = host::strategy::pass::PassCounters::default();
    for (report, _) in played {
        passes.add(&report.metrics.blue.play.passes);
    }
    println!(
        "our passes: flat {:?}, chip {:?}, calibration error {:?}",
        passes.flat,
        passes.chip,
        passes.calibration_error()
    );
    for (tenth, bin) in passes.calibration.iter().enumerate().filter(|(_, bin)| bin.passes > 0) {
        println!(
            "    P {tenth}: {} predicted {:.2} seen {:.2}",
            bin.passes,
            bin.predicted / f64::from(bin.passes),
            f64::from(bin.received) / f64::from(bin.passes)
        );
    }
    at_ball::print(played.iter().map(|(_, account)| &account.at_ball));
    stoppages::print(played.len(), all, played.iter().map(|(_, account)| &account.stoppages));
}
