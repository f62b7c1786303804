//! Tests of a referee that falls silent: when robots halt, when they play again, and the operator's warnings.
//! Virtual time, µs.

use rules::League;
use ssl::referee::{Command as Wire, TeamInfo};

use super::*;

const MS: u64 = 1_000;
const S: u64 = 1_000_000;

fn packet(now: u64, who: &str) -> Referee {
    let team = |name: &str| TeamInfo { name: name.into(), ..TeamInfo::default() };
    Referee {
        packet_timestamp: 1_795_220_000 * S + now,
        command: Wire::ForceStart as i32,
        command_counter: 1,
        command_timestamp: 1_795_220_000 * S,
        yellow: team("yellow"),
        blue: team("blue"),
        source_identifier: Some(who.into()),
        ..Referee::default()
    }
}

/// FORCE_START every 25 ms, but not in `gap`; the phase and the warnings every 10 ms for 12 s.
fn play(
    on_silence: OnSilence,
    gap: std::ops::Range<u64>,
    second: bool,
) -> Vec<(u64, Phase<Colour>, Vec<String>)> {
    let mut listener =
        Listener::new(League::DivisionB.limits().unwrap(), None, Instant(0)).on_silence(on_silence);
    let mut seen = Vec::new();
    for now in (0..12 * S).step_by(5 * MS as usize) {
        if now.is_multiple_of(25 * MS) && !gap.contains(&now) {
            listener.receive(&packet(now, "a"), SenderAddress::INTERNAL, Instant(now), None);
        }
        if second && now.is_multiple_of(25 * MS) {
            listener.receive(&packet(now, "b"), SenderAddress::INTERNAL, Instant(now), None);
        }
        if now.is_multiple_of(10 * MS) {
            listener.tick(Instant(now), None);
            let description = listener.warnings(Instant(now)).iter().map(ToString::to_string).collect();
            seen.push((now, listener.game().phase, description));
        }
    }
    seen
}

#[test]
fn two_silent_seconds_of_the_referee_halt_and_its_return_stops_for_two_seconds() {
    // The last packet is that of 2.975 s.
    let seen = play(OnSilence::Halt, 3 * S..8 * S, false);
    for (now, phase, description) in &seen {
        let expected = match now {
            0..4_975_000 => Phase::Run,
            4_975_000..8_000_000 => Phase::Halt,
            8_000_000..10_000_000 => Phase::Stop,
            _ => Phase::Run,
        };
        assert_eq!(*phase, expected, "{now} µs");
        assert_eq!(description.is_empty(), expected != Phase::Halt, "{now} µs: {description:?}");
    }
    let description = &seen.iter().find(|(_, phase, _)| *phase == Phase::Halt).unwrap().2[0];
    assert!(
        description.contains("for 2 s: the robots halt") && description.contains("--referee-silence go-on"),
        "{description}"
    );
}

#[test]
fn a_pause_of_less_than_two_seconds_changes_nothing() {
    let seen = play(OnSilence::Halt, 3 * S..4_900 * MS, false);
    assert!(seen.iter().all(|(_, phase, description)| *phase == Phase::Run && description.is_empty()));
}

#[test]
fn if_configured_the_last_command_stands_and_the_silence_is_still_reported() {
    let seen = play(OnSilence::GoOn, 3 * S..8 * S, false);
    assert!(seen.iter().all(|(_, phase, _)| *phase == Phase::Run));
    let reported: Vec<_> = seen.iter().filter(|(_, _, description)| !description.is_empty()).collect();
    assert_eq!((reported[0].0, reported.last().unwrap().0), (4_980 * MS, 7_990 * MS));
    assert!(reported[0].2[0].contains("its last command stands"), "{:?}", reported[0].2);
}

#[test]
fn a_second_referee_that_says_the_same_keeps_the_game_going() {
    let seen = play(OnSilence::Halt, 3 * S..8 * S, true);
    assert!(seen.iter().all(|(_, phase, _)| *phase == Phase::Run));
}
