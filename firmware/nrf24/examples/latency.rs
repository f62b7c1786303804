//! `latency`: prints how long frames take through the modelled air, and how many arrive, by loss: the tables
//! of README.md. Times in ms.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Kind, Plan, demand, run};
use nrf24::Rate;
use nrf24_model::Faults;

fn main() {
    println!("| air | loss | what | arrive | p50, ms | p95, ms | max, ms |");
    println!("|---|---:|---|---:|---:|---:|---:|");
    for rate in [Rate::Mbps1, Rate::Mbps2] {
        for loss in [0.0, 0.05, 0.1, 0.2, 0.3] {
            let outcome = run(&Plan::one_team(rate, Faults { loss, ..Faults::default() }));
            for (kind, tally) in &outcome.tallies {
                let what = match kind {
                    Kind::Part => "part of a snapshot",
                    Kind::Command => "command",
                    Kind::Welcome => "welcome",
                    Kind::Beacon => "beacon to the base",
                    Kind::Telemetry => "telemetry",
                    Kind::Relayed => "beacon passed on",
                };
                println!(
                    "| {rate:?} | {:.0} % | {what} | {:.1} % | {:.2} | {:.2} | {:.2} |",
                    loss * 100.0,
                    tally.share() * 100.0,
                    tally.quantile(0.5),
                    tally.quantile(0.95),
                    tally.quantile(1.0),
                );
            }
        }
    }
    println!();
    println!(
        "| teams | air | snapshots, Hz | asked, % | on the air, % | parts | commands | beacons up | longest silence, ms |"
    );
    println!("|---|---|---:|---:|---:|---:|---:|---:|---:|");
    for (teams, same_channel, label) in [(2, true, "two on one channel"), (2, false, "two, a channel each")] {
        for rate in [Rate::Mbps1, Rate::Mbps2] {
            for hertz in [100, 60, 30] {
                let plan = Plan {
                    teams,
                    same_channel,
                    period: 1_000_000 / hertz,
                    ..Plan::one_team(rate, Faults::default())
                };
                let outcome = run(&plan);
                let channels = if same_channel { 1.0 } else { f64::from(teams) };
                let share = |kind| outcome.tallies[&kind].share() * 100.0;
                println!(
                    "| {label} | {rate:?} | {hertz} | {:.0} | {:.0} | {:.1} % | {:.1} % | {:.1} % | {:.0} |",
                    demand(rate, hertz) as f64 * f64::from(teams) / channels / 1e7,
                    outcome.air.occupied as f64 / plan.duration as f64 / 10.0 / channels,
                    share(Kind::Part),
                    share(Kind::Command),
                    share(Kind::Beacon),
                    outcome.longest_silence as f64 / 1e3,
                );
            }
        }
    }
}
