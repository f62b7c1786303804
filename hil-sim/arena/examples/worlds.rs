//! Plays the same match of ours against ours in several worlds and prints where play breaks: share in play, goals, shots,
//! placements, no-progress stops and the longest time that one robot had the ball.
//!
//! `cargo run --release -p arena --example worlds -- LEAGUE SECONDS SEED WORLD...`; `--model` before the league prints the worlds.

use arena::game::{Game, GameConfig, Watcher, play};
use casebase::CaseBase;
use hil_sim::NativeBackend;
use hil_sim::small_size::worlds::{WorldChoice, WorldModel};
use protocol::Who;
use rules::{League, Phase};

/// How long one robot had the ball at its front while it was in play.
#[derive(Default)]
struct Holds {
    /// Who, since when, and when last.
    now: Option<(Who, f64, f64)>,
    longest: (f64, Option<Who>, f64),
}

impl Watcher for Holds {
    fn tick(&mut self, game: &Game<'_>) {
        let in_play = matches!(game.referee().phase(), Phase::Run | Phase::FreeKick(_));
        let holder = game.world().robots().iter().find(|robot| robot.present && robot.ball_contact);
        let time = game.time();
        if !in_play {
            self.now = None;
            return;
        }
        self.now = match (self.now, holder.map(|robot| robot.who)) {
            (Some((who, since, _)), Some(holder)) if who == holder => Some((who, since, time)),
            (_, Some(holder)) => Some((holder, time, time)),
            (Some(held), None) if time - held.2 < GAP => Some(held),
            (_, None) => None,
        };
        if let Some((who, since, last)) = self.now
            && last - since > self.longest.0
        {
            self.longest = (last - since, Some(who), since);
        }
    }
}

/// s without contact that do not end a hold.
const GAP: f64 = 0.3;

fn main() -> Result<(), String> {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let show = arguments.first().is_some_and(|first| first == "--model");
    if show {
        arguments.remove(0);
    }
    let usage = "usage: worlds [--model] LEAGUE SECONDS SEED WORLD..., as in `worlds division-b 120 1 grsim random:7`";
    let [league, seconds, seed, worlds @ ..] = &arguments[..] else { return Err(usage.into()) };
    let leagues = [League::Ssl2013, League::DivisionB, League::DivisionA];
    let league = leagues.into_iter().find(|known| known.name() == league).ok_or(usage)?;
    let seconds: f64 = seconds.parse().map_err(|_| usage)?;
    let seed: u64 = seed.parse().map_err(|_| usage)?;
    println!(
        "| world | in play, % | goals | shots | placed | failed | no progress | longest hold, s | by | fouls |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---|---:|");
    for world in worlds {
        let choice: WorldChoice = world.parse().map_err(|error| format!("{error}"))?;
        if show {
            println!("{:#?}", WorldModel::of(league, &choice));
        }
        let mut config = GameConfig::new(league, seed, seconds);
        config.world = choice;
        let base = match league {
            League::DivisionB => case_library::division_b(),
            _ => CaseBase::default(),
        };
        let (mut holds, mut told) = (Holds::default(), Told::default());
        let mut both = arena::game::Crowd(vec![&mut holds, &mut told]);
        let report =
            play(&config, &mut NativeBackend::new(base), &mut both).map_err(|error| error.to_string())?;
        let fouls: u32 = [&report.fouls.blue, &report.fouls.yellow].iter().flat_map(|of| of.values()).sum();
        let (held, who, since) = holds.longest;
        println!(
            "| {choice} | {:.1} | {}:{} | {} | {} | {} | {} | {held:.1} | {} | {fouls} |",
            report.ball_in_play * 100.0,
            report.score.blue,
            report.score.yellow,
            report.metrics.blue.shots + report.metrics.yellow.shots,
            told.placed,
            told.failed,
            told.stuck,
            who.map_or("–".into(), |who| format!("{} {} at {since:.0} s", who.colour.word(), who.id)),
        );
    }
    Ok(())
}

/// What the referee noted.
#[derive(Default)]
struct Told {
    seen: usize,
    placed: u32,
    failed: u32,
    stuck: u32,
}

impl Watcher for Told {
    fn tick(&mut self, game: &Game<'_>) {
        let events = game.referee().events();
        for event in &events[self.seen..] {
            match event.what.kind().word() {
                "placement_succeeded" => self.placed += 1,
                "placement_failed" => self.failed += 1,
                "no_progress_in_game" => self.stuck += 1,
                _ => {}
            }
        }
        self.seen = events.len();
    }
}
