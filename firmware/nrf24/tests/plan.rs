//! `plan`: tests: a team's channel is changed while it runs, robots find their base station wherever it is,
//! both go back where they lose each other, counts of packets, and the scan of the channels. Times in µs.

mod common;

use common::channels::Channels;
use common::{ADDRESS, WARM_UP};
use nrf24::Rate;
use nrf24_model::Faults;
use protocol::TeamId;
use protocol::station::{RadioPlan, StationMessage};

/// Longest time in which robots find their base station: 158 places of 20 ms, each fourth turn at the last.
const FOUND_WITHIN: u64 = 5_000_000;

fn plan(channel: u8, megabits: u8) -> StationMessage {
    StationMessage::Plan(TeamId(1), RadioPlan { channel, megabits, address: ADDRESS })
}

#[test]
fn a_new_channel_and_rate_are_followed_without_a_power_cycle() {
    let mut worst = 0;
    for (seed, (channel, megabits)) in (1..).zip([(2, 2), (80, 1), (40, 1), (77, 2)]) {
        let mut channels = Channels::new(Faults { loss: 0.1, ..Faults::default() }, seed);
        channels.run(WARM_UP);
        channels.order(&plan(channel, megabits));
        channels.run(FOUND_WITHIN);
        let last = channels.all_heard_after(WARM_UP + 10_000).expect("every robot is found");
        worst = worst.max(last - WARM_UP);
        let report = channels.report().expect("the base station reports");
        assert_eq!((report.plan.channel, report.plan.megabits), (channel, megabits));
        assert_eq!(channels.wrong, 0, "a frame was believed twice or altered");
    }
    println!("all six robots were back after {worst} µs at most");
}

#[test]
fn a_base_station_that_no_robot_follows_goes_back_and_stays() {
    let mut channels = Channels::new(Faults::default(), 1);
    channels.run(WARM_UP);
    // The robots' chips have no supply, as if the new channel were jammed.
    channels.power_robots(false);
    channels.order(&plan(60, 2));
    channels.run(11_000_000);
    channels.power_robots(true);
    let back = channels.now;
    channels.order(&plan(60, 2));
    channels.run(1_000_000);
    assert_eq!(channels.report().expect("reports").plan.channel, 76, "where it came from");
    assert!(channels.all_heard_after(back).expect("all are back") < back + 500_000);
}

#[test]
fn packets_of_each_robot_are_counted_and_add_up() {
    let mut channels = Channels::new(Faults { loss: 0.3, ..Faults::default() }, 3);
    channels.run(3_000_000);
    channels.order(&plan(76, 2));
    channels.run(100_000);
    let counts: Vec<_> = channels.reports.iter().map(|report| report.packets).collect();
    assert_eq!(counts.len(), 6);
    for packets in counts {
        assert_eq!(packets.sent, packets.acknowledged + packets.lost, "{packets:?}");
        // A packet and its answer both come with 0.49: 0.51 of them fail, 0.51³ three times.
        let lost = f64::from(packets.lost) / f64::from(packets.sent);
        assert!(packets.sent > 200 && (0.08..0.2).contains(&lost), "{packets:?}");
        assert!(packets.repeats > packets.sent / 2, "{packets:?}");
    }
}

#[test]
fn a_scan_names_the_quietest_channels_and_is_refused_in_play() {
    let mut channels = Channels::new(Faults::default(), 5);
    let carriers = [(10, 1.0), (11, 0.6), (40, 0.3), (41, 0.9), (60, 0.2)];
    for (channel, share) in carriers {
        channels.air.carrier(channel, share);
    }
    channels.run(WARM_UP);
    channels.order(&StationMessage::Scan(50));
    channels.run(50_000);
    assert_eq!(channels.spectrum.take(), Some((0, Vec::new())), "frames of a host come");
    channels.is_silent = true;
    channels.run(1_500_000);
    channels.order(&StationMessage::Scan(50));
    channels.run(5_000_000);
    let (sweeps, counts) = channels.spectrum.take().expect("a spectrum");
    assert_eq!((sweeps, counts.len()), (50, 84));
    for (channel, count) in (0_u8..).zip(&counts) {
        let share = carriers.iter().find(|(of, _)| *of == channel).map_or(0.0, |(_, share)| *share);
        let measured = f32::from(*count) / f32::from(sweeps);
        assert!((measured - share).abs() < 0.25, "channel {channel}: {measured}, {share} planted");
        assert_eq!(*count == 0, share == 0.0, "channel {channel}");
    }
    // A host's frame ends a scan at once, and robots are led again.
    channels.order(&StationMessage::Scan(200));
    channels.run(20_000);
    channels.is_silent = false;
    let resumed = channels.now;
    channels.run(1_000_000);
    assert!(channels.all_heard_after(resumed).expect("all are led") < resumed + 500_000);
    assert_eq!(channels.spectrum.take(), None, "it was broken off");
}

#[test]
fn a_loss_of_30_percent_and_a_reset_send_no_robot_into_its_search() {
    for rate in [Rate::Mbps1, Rate::Mbps2] {
        let mut channels = Channels::at(rate, Faults { loss: 0.3, ..Faults::default() }, 9);
        channels.run(WARM_UP);
        channels.reset_base();
        for _ in 0..1_000 {
            channels.run(10_000);
            assert!(channels.robots_are_at(76), "{rate:?}");
        }
    }
}
