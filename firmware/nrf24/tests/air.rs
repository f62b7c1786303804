//! `air`: tests: the real driver over modelled chips, with a match's traffic: what arrives under loss, that
//! nothing is believed twice or altered, and that arithmetic and model agree on the air's budget.

mod common;

use common::{Kind, Plan, demand, run};
use nrf24::Rate;
use nrf24_model::Faults;

#[test]
fn no_frame_is_believed_twice_or_altered_whatever_the_air_does() {
    for (loss, seed) in [(0.0, 1), (0.05, 2), (0.1, 3), (0.2, 4), (0.3, 5)] {
        for rate in [Rate::Mbps1, Rate::Mbps2] {
            let faults = Faults { loss, damage: 0.01, copies: 0.02 };
            let outcome = run(&Plan { seed, duration: 4_000_000, ..Plan::one_team(rate, faults) });
            assert_eq!((outcome.altered, outcome.twice), (0, 0), "{rate:?}, {loss}");
            // The faults did happen: receivers refused frames by their tags.
            assert!(outcome.refused > 10, "{rate:?}, {loss}: {} refused", outcome.refused);
            assert!(outcome.tallies[&Kind::Command].share() > 0.5, "{rate:?}, {loss}");
        }
    }
}

#[test]
fn by_loss_alone_the_radio_hands_out_no_frame_twice_and_none_that_is_refused() {
    for loss in [0.0, 0.05, 0.1, 0.2, 0.3] {
        let outcome = run(&Plan::one_team(Rate::Mbps2, Faults { loss, ..Faults::default() }));
        let found = (outcome.handed_twice, outcome.refused, outcome.altered, outcome.twice);
        assert_eq!(found, (0, 0, 0, 0), "{loss}");
        // A part is three fragments of 31 bytes and one of 20, none of them repeated.
        let parts = outcome.tallies[&Kind::Part].share();
        let expected = f64::from(1.0 - loss).powi(4);
        assert!((parts - expected).abs() < 0.05, "{loss}: {parts} of parts, {expected} by arithmetic");
    }
}

#[test]
fn without_loss_a_team_has_room_at_100_hz_on_a_channel_of_2_megabit() {
    let outcome = run(&Plan::one_team(Rate::Mbps2, Faults::default()));
    for (kind, tally) in &outcome.tallies {
        assert!(tally.expected > 500 && tally.share() > 0.99, "{kind:?}: {}", tally.share());
    }
    assert_eq!(outcome.late, 0);
    assert!(outcome.longest_silence < 20_000, "{} µs", outcome.longest_silence);
}

#[test]
fn at_1_megabit_every_command_and_welcome_arrives_however_few_snapshots_there_are() {
    for hertz in [100, 60, 30] {
        let plan = Plan { period: 1_000_000 / hertz, ..Plan::one_team(Rate::Mbps1, Faults::default()) };
        let outcome = run(&plan);
        for kind in [Kind::Command, Kind::Welcome] {
            let tally = &outcome.tallies[&kind];
            assert!(tally.expected > 500 && tally.share() > 0.995, "{hertz} Hz, {kind:?}: {}", tally.share());
        }
    }
}

#[test]
fn arithmetic_and_model_agree_on_what_a_team_takes_of_the_air() {
    for (rate, hertz) in [(Rate::Mbps1, 60), (Rate::Mbps1, 90), (Rate::Mbps2, 100)] {
        let plan = Plan { period: 1_000_000 / hertz, ..Plan::one_team(rate, Faults::default()) };
        let measured = run(&plan).air.occupied as f64 / (plan.duration as f64 * 1e3);
        let computed = demand(rate, hertz) as f64 / 1e9;
        // The model asks robots besides: those with more to say, and numbers that are not there.
        assert!((-0.02..0.2).contains(&(measured - computed)), "{rate:?} {hertz}: {measured}, {computed}");
    }
}

#[test]
fn two_teams_do_not_fit_on_one_channel_of_1_megabit_at_100_hz() {
    let plan = Plan { teams: 2, same_channel: true, ..Plan::one_team(Rate::Mbps1, Faults::default()) };
    assert!(2 * demand(Rate::Mbps1, 100) > 1_900_000_000);
    let outcome = run(&plan);
    assert!(outcome.tallies[&Kind::Part].share() < 0.5, "{}", outcome.tallies[&Kind::Part].share());
    assert_eq!((outcome.altered, outcome.twice), (0, 0));
}
