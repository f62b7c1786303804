//! `upset`: tests: in mid-match a register of a chip is upset, or its supply goes, at a robot or at the base
//! station: no end is unheard for longer than 100 ms, and no frame is believed twice or altered.

mod common;

use common::{Outcome, Plan, UPSET_AT, Upset, UpsetKind, run};
use nrf24::Rate;
use nrf24_model::Faults;

/// Longest silence that an upset may cost, µs.
const SILENCE_MAX: u64 = 100_000;

/// Registers of the chip that can be written, events apart (PS 9.1).
const REGISTERS: [u8; 22] = [
    0x00, 0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x0a, 0x0b, 0x0c, 0x0d, 0x0e, 0x0f, 0x10, 0x11, 0x12, 0x13,
    0x14, 0x15, 0x16, 0x1c, 0x1d,
];

/// A team of six that plays until 0.5 s after the upset.
fn play(rate: Rate, loss: f32, upset: Option<Upset>) -> Outcome {
    let duration = UPSET_AT + 500_000;
    let plan = Plan { duration, upset, ..Plan::one_team(rate, Faults { loss, ..Faults::default() }) };
    let outcome = run(&plan);
    assert_eq!((outcome.altered, outcome.twice), (0, 0), "{upset:?}, {rate:?}");
    outcome
}

#[test]
fn every_register_upset_at_robot_or_base_costs_100_ms_of_silence_at_most() {
    let (mut restarts, mut longest) = (0, [0; 2]);
    for register in REGISTERS {
        for (at_base, mask, rate) in [
            (false, 0x3f, Rate::Mbps2),
            (true, 0x3f, Rate::Mbps2),
            (false, 0x01, Rate::Mbps1),
            (true, 0x01, Rate::Mbps1),
        ] {
            let kind = UpsetKind::Bits { register, mask };
            let outcome = play(rate, 0.0, Some(Upset { at_base, kind }));
            let gaps = outcome.longest_gap;
            longest = [0, 1].map(|way| gaps[way].max(longest[way]));
            assert!(gaps.iter().all(|gap| *gap <= SILENCE_MAX), "{register:#x}, {at_base}, {mask}: {gaps:?}");
            restarts += outcome.restarts;
        }
    }
    println!("longest silence at a robot and at the host: {longest:?} µs; {restarts} restarts");
    // Most upsets are of bits that were set, so that the chip had to be set up again.
    assert!(restarts > 50, "{restarts}");
}

#[test]
fn every_bit_of_mode_channel_and_rate_upset_is_set_right_in_100_ms() {
    for (register, bit) in [0x00, 0x05, 0x06].into_iter().flat_map(|at| (0..7).map(move |bit| (at, bit))) {
        for at_base in [false, true] {
            let kind = UpsetKind::Bits { register, mask: 1 << bit };
            let gaps = play(Rate::Mbps2, 0.0, Some(Upset { at_base, kind })).longest_gap;
            assert!(gaps.iter().all(|gap| *gap <= SILENCE_MAX), "{register:#x}, {at_base}, {bit}: {gaps:?}");
        }
    }
}

#[test]
fn a_reset_of_a_chip_at_a_loss_of_0_to_30_percent_costs_100_ms_at_most() {
    for loss in [0.0, 0.1, 0.2, 0.3] {
        for at_base in [false, true] {
            let reset = Upset { at_base, kind: UpsetKind::Supply { away: 0 } };
            let outcome = play(Rate::Mbps2, loss, Some(reset));
            let silence = outcome.longest_gap[0];
            println!("loss {loss}, at the base {at_base}: {silence} µs, restarts {}", outcome.restarts);
            assert!(outcome.restarts == 1 && silence <= SILENCE_MAX, "{loss}, {at_base}: {silence} µs");
        }
    }
}

#[test]
fn a_chip_without_supply_for_50_ms_is_back_100_ms_after_it_returned() {
    let away = 50_000;
    for at_base in [false, true] {
        let outcome = play(Rate::Mbps2, 0.0, Some(Upset { at_base, kind: UpsetKind::Supply { away } }));
        let gaps = outcome.longest_gap;
        assert!(gaps.iter().all(|gap| *gap <= away + SILENCE_MAX), "{at_base}: {gaps:?}");
        assert!(gaps[0] >= away / 2, "{at_base}: the supply was away: {gaps:?}");
    }
}
