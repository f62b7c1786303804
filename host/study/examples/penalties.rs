//! `penalties`: plays penalties against our keeper and against one that stands, the same shots for both, and
//! prints the shares of saves with Wilson's intervals.
//!
//! `cargo run --release -p onetwo-study --example penalties -- LEAGUE FIRST_SEED COUNT`

use rules::League;
use study::penalty::{Keeper, saves};
use study::statistics::{Count, newcombe, wilson};

fn main() -> Result<(), String> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let usage = "usage: penalties LEAGUE FIRST_SEED COUNT, as in `penalties division-b 1000 200`";
    let [league, first, count] = &arguments[..] else { return Err(usage.into()) };
    let leagues = [League::Ssl2013, League::DivisionB, League::DivisionA];
    let league = leagues.into_iter().find(|known| known.name() == league).ok_or(usage)?;
    let number = |text: &str| text.parse::<u64>().map_err(|error| format!("{text}: {error}; {usage}"));
    let (first, count) = (number(first)?, number(count)?);
    let of = |keeper| saves(league, first..first + count, keeper).map_err(|error| error.to_string());
    let reported = |name: &str, count: Count| {
        let interval = wilson(count, CONFIDENCE);
        let percent =
            |share: Option<f64>| share.map_or("–".into(), |share| format!("{:.1}", 100.0 * share));
        let (low, high) = (interval.map(|at| at.low), interval.map(|at| at.high));
        println!(
            "{name}: {} of {} saved, {} % (95 %: {} to {})",
            count.hits,
            count.of,
            percent(count.share()),
            percent(low),
            percent(high)
        );
    };
    println!("{} penalties of {}, seeds {first} to {}", count, league.name(), first + count - 1);
    let (plays, stands) = (of(Keeper::Plays)?, of(Keeper::Stands)?);
    reported("our keeper", plays);
    reported("one that stands", stands);
    if let Some(more) = newcombe(plays, stands, CONFIDENCE) {
        println!("more: {:.1} points at least, {:.1} at most", 100.0 * more.low, 100.0 * more.high);
    }
    Ok(())
}

const CONFIDENCE: f64 = 0.95;
